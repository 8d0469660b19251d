//! How accurate the tables of integrals are in `f32`, against quadrature of what they stand for.
//!
//! The error of every result must stay below a small multiple of what the
//! inputs' own rounding can change, plus half a unit in the last place of the
//! natural scale. Inputs are random of every size, and at and beside every
//! place where the printed formulas divide by zero.

mod inputs;
mod oracle;

use std::collections::BTreeMap;

use crate::support::OrPanic as _;
use inputs::{Cell, Random, SLOPES, cell};
use oracle::{EPSILON, Rules, sensitivity};
use umbrage::diag::Source;
use umbrage::eval::{Interpreter, Precise};
use umbrage::program::{Program, Value};
use umbrage::table::Table;

/// A function of a table, called by names of parameters.
struct Function(Program);

impl Function {
    fn read(table: &str, name: &str) -> Self {
        let path = format!("{}/tables/{table}.ron", env!("CARGO_MANIFEST_DIR"));
        Self(Program::read_function(path, Some(name)).or_panic())
    }

    /// A function of what a printed table becomes by itself.
    fn stabilised(table: &str, name: &str) -> Self {
        let path = format!("{}/tables/{table}_printed.ron", env!("CARGO_MANIFEST_DIR"));
        let printed = Table::read(path).or_panic();
        let text = umbrage::stabilise::stabilise(&printed).or_panic().text;
        let table = Table::parse(Source::new("stable.ron", text)).or_panic();
        let programs = Program::check_all(&table).or_panic();
        let named = |program: &Program| program.function.as_ref().is_some_and(|f| f.name == name);
        Self(programs.into_iter().find(named).expect("the table has this function"))
    }

    fn point(&self, named: &[(&str, f32)]) -> Vec<Option<Value>> {
        let value = |name: &str| named.iter().find(|(n, _)| *n == name).map(|(_, v)| Value::Number(f64::from(*v)));
        self.0.inputs.iter().map(|input| value(&input.name)).collect()
    }

    fn call(&self, named: &[(&str, f32)]) -> Vec<f64> {
        let point = self.point(named);
        let outcome = Interpreter::<f32>::new(&self.0).evaluate(&point).expect("every parameter is given");
        outcome.values.iter().map(|v| f64::from(*v)).collect()
    }

    /// Its only or first number at each point.
    fn values(&self, executor: &Executor, points: &[Vec<(&str, f32)>]) -> Vec<f64> {
        match executor {
            Executor::Interpreter => points.iter().map(|named| self.call(named)[0]).collect(),
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) => {
                use umbrage::{emit, eval::Columns, gpu, plan};
                let rows = points.iter().map(|named| self.point(named));
                let columns = Columns::<f32>::from_rows(&self.0, rows).unwrap_or_else(|e| panic!("{e:?}"));
                let proved = plan::Plan::proved(&self.0, plan::Shape::Ladder).or_panic();
                let entry = emit::kernel::columns::Entry::Levels;
                let kernel = gpu::Kernel::new(gpu, &proved, entry, gpu::Language::Wgsl);
                let outputs = kernel.and_then(|kernel| kernel.run(&columns)).or_panic();
                outputs.values[0].iter().map(|v| f64::from(*v)).collect()
            }
        }
    }
}

/// What computes.
enum Executor {
    Interpreter,
    #[cfg(feature = "gpu")]
    Gpu(Box<umbrage::gpu::Gpu>),
}

impl Executor {
    /// An adapter, if there is one.
    #[cfg(feature = "gpu")]
    fn gpu() -> Option<Self> {
        crate::support::adapter().map(Box::new).map(Self::Gpu)
    }
}

/// Errors in units of what is allowed.
#[derive(Default)]
struct Errors(BTreeMap<&'static str, Vec<f64>>);

impl Errors {
    fn add(
        &mut self,
        name: &'static str,
        got: f64,
        exact: f64,
        sensitivity: f64,
        scale: f64,
        inputs: &dyn std::fmt::Debug,
    ) {
        assert!(got.is_finite(), "{name} is {got} at {inputs:?}, exact is {exact}");
        // A subnormal result may be off by the smallest normal number.
        let allowed = sensitivity + EPSILON * scale + f64::from(f32::MIN_POSITIVE);
        let units = (got - exact).abs() / allowed;
        if units > 16.0 {
            println!("{name}: {units:.1} units at {inputs:?}: {got:e} instead of {exact:e}");
        }
        self.0.entry(name).or_default().push(units);
    }

    /// Checks that 99.5 % of the errors are within `target` and all within `limit`.
    fn check(&self, target: f64, limit: f64) {
        let mut bad = Vec::new();
        for (name, units) in &self.0 {
            let mut units = units.clone();
            units.sort_by(f64::total_cmp);
            let (most, worst) = (units[units.len() * 995 / 1000], units[units.len() - 1]);
            println!("{name:<8} {:>6} inputs, 99.5 % within {most:.2} units, worst {worst:.2}", units.len());
            if most > target || worst > limit {
                bad.push(format!("{name}: {most:.2} and {worst:.2}"));
            }
        }
        assert!(bad.is_empty(), "beyond {target} and {limit} units: {bad:?}");
    }
}

const C: [&str; 6] = ["C0", "C1", "C2", "C3", "C4", "C5"];

fn c_input(random: &mut Random) -> [f32; 6] {
    let width = random.pick(&[0.0, 1.0, 1.0, 1.0]) * random.by_size(1e-4, 1.55);
    let phi0 = random.between(-1.0, 6.25 - width) as f32;
    let phi1 = (f64::from(phi0) + width) as f32;
    let s = match random.pick(&[0, 1]) {
        0 => random.between(-12.0, 12.0) as f32,
        _ => random.near(&[0.0, 1.0, -1.0, 2.0, -2.0]),
    };
    let angle = |random: &mut Random| random.between(-3.2, 3.2) as f32;
    [phi0, phi1, angle(random), angle(random), s, random.between(-8.0, 8.0) as f32]
}

fn check_c_functions(functions: &[Function; 6], executor: &Executor) {
    let (rules, mut random, mut errors) = (Rules::new(), Random::new(1), Errors::default());
    for (index, name) in C.into_iter().enumerate() {
        let inputs: Vec<[f32; 6]> = (0..1500).map(|_| c_input(&mut random)).collect();
        let named = |input: &[f32; 6]| ["phi0", "phi1", "p", "q", "s", "t"].into_iter().zip(*input).collect();
        let points: Vec<Vec<(&str, f32)>> = inputs.iter().map(named).collect();
        for (input, got) in inputs.into_iter().zip(functions[index].values(executor, &points)) {
            let [phi0, phi1, ..] = input;
            let f = |input: [f64; 6]| [rules.c(index, input)];
            let exact = f(input.map(f64::from));
            let sens = sensitivity(input, exact, f)[0];
            let width = f64::from(phi1) - f64::from(phi0);
            let scale = if index == 3 { width * f64::from(phi0.abs().max(phi1.abs())) } else { width };
            errors.add(name, got, exact[0], sens, scale, &input);
        }
    }
    errors.check(4.0, 16.0);
}

#[test]
fn the_c_functions() {
    check_c_functions(&C.map(|name| Function::read("double_product", name)), &Executor::Interpreter);
}

#[test]
fn the_stabilised_c_functions() {
    check_c_functions(&C.map(|name| Function::stabilised("double_product", name)), &Executor::Interpreter);
}

const PARTS: [&str; 9] = ["A0", "A1", "A", "B0", "B1", "B2", "B3", "B", "Lo"];

/// Parameters of a cell with its vectors.
fn cell_input(random: &mut Random) -> [f32; 12] {
    let Cell { phi0, phi1, theta0, k, b } = cell(random);
    let ([nx, ny, nz], [px, py, pz]) = (random.vector(), random.vector());
    [phi0, phi1, theta0, k, b, nx, ny, nz, px, py, pz, random.between(-1.0, 1.0) as f32]
}

const CELL: [&str; 12] = ["phi0", "phi1", "theta0", "k", "b", "nx", "ny", "nz", "px", "py", "pz", "alpha_star"];

/// All parts, and the solid angle, at the parameters [`CELL`].
fn cell_parts(rules: &Rules, input: [f64; 12]) -> ([f64; 9], f64) {
    let [phi0, phi1, theta0, k, b, nx, ny, nz, px, py, pz, alpha] = input;
    let moments = Cell::moments(rules, [phi0, phi1, theta0, k, b]);
    (moments.parts([nx, ny, nz], [px, py, pz], alpha), moments.solid)
}

/// The scales of the parts.
fn scales(input: &[f64; 12], solid: f64) -> [f64; 9] {
    let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (n, p) = (size(&input[5..8]), size(&input[8..11]));
    let plain = solid;
    [plain, plain, plain * n, plain, plain, plain, plain, plain * n * p, plain * n * (p + input[11].abs())]
}

/// Errors of A0 to Lo.
fn errors_of_parts(functions: &[Function; 9], executor: &Executor) -> Errors {
    let (rules, mut random, mut errors) = (Rules::new(), Random::new(2), Errors::default());
    let inputs: Vec<[f32; 12]> = (0..1200).map(|_| cell_input(&mut random)).collect();
    let points: Vec<Vec<(&str, f32)>> = inputs.iter().map(|input| CELL.into_iter().zip(*input).collect()).collect();
    let got: Vec<Vec<f64>> = functions.iter().map(|function| function.values(executor, &points)).collect();
    for (at, input) in inputs.into_iter().enumerate() {
        let wide = input.map(f64::from);
        let (exact, solid) = cell_parts(&rules, wide);
        let sens = sensitivity(input, exact, |input| cell_parts(&rules, input).0);
        let scales = scales(&wide, solid);
        for (i, name) in PARTS.into_iter().enumerate() {
            errors.add(name, got[i][at], exact[i], sens[i], scales[i], &input);
        }
    }
    errors
}

/// Form G of the specification, in moments.
#[test]
fn the_parts_of_a_and_b() {
    errors_of_parts(&PARTS.map(|name| Function::read("double_product", name)), &Executor::Interpreter).check(2.0, 4.0);
}

/// No formula of this form was written by hand.
#[test]
fn the_stabilised_parts_of_a_and_b() {
    errors_of_parts(&PARTS.map(|name| Function::stabilised("double_product", name)), &Executor::Interpreter)
        .check(2.0, 4.0);
}

/// The same inputs and the same bounds for generated WGSL on an adapter.
#[cfg(feature = "gpu")]
#[test]
fn the_integrals_on_an_adapter() {
    let Some(gpu) = Executor::gpu() else { return };
    check_c_functions(&C.map(|name| Function::read("double_product", name)), &gpu);
    check_c_functions(&C.map(|name| Function::stabilised("double_product", name)), &gpu);
    errors_of_parts(&PARTS.map(|name| Function::read("double_product", name)), &gpu).check(2.0, 4.0);
}

#[test]
fn the_light_of_a_cell_between_two_ends() {
    let (rules, mut random, mut errors) = (Rules::new(), Random::new(3), Errors::default());
    let function = Function::read("double_product", "Lo_ends");
    for _ in 0..1200 {
        let mut input = cell_input(&mut random);
        let ends = [input[0], input[1]].map(|phi| (input[3] * phi + input[4]).clamp(0.0, std::f32::consts::PI));
        [input[3], input[4]] = ends;
        let f = |input: [f64; 12]| {
            let [phi0, phi1, theta0, theta_a, theta_b, nx, ny, nz, px, py, pz, alpha] = input;
            let slope = if phi1 == phi0 { 0.0 } else { (theta_b - theta_a) / (phi1 - phi0) };
            let moments = rules.moments((phi0, phi1), theta0, |phi| theta_a + slope * (phi - phi0));
            ([moments.parts([nx, ny, nz], [px, py, pz], alpha)[8]], moments.solid)
        };
        let wide = input.map(f64::from);
        let (exact, solid) = f(wide);
        let sens = sensitivity(input, exact, |input| f(input).0);
        let mut named: Vec<(&str, f32)> = CELL.into_iter().zip(input).collect();
        (named[3].0, named[4].0) = ("theta_a", "theta_b");
        let got = function.call(&named)[0];
        errors.add("Lo_ends", got, exact[0], sens[0], scales(&wide, solid)[8], &input);
    }
    errors.check(2.0, 16.0);
}

const GAUSSIAN: [&str; 6] = ["r0", "r1", "alpha", "beta", "e1", "e2"];

/// Errors of r0, r1, alpha and beta, and of e1 and e2; of as many of them as there are functions.
fn errors_of_gaussians(functions: &[Function], executor: &Executor) -> [Errors; 2] {
    let (rules, mut random) = (Rules::new(), Random::new(4));
    let mut errors = [Errors::default(), Errors::default()];
    let inputs: Vec<[f32; 4]> = (0..2000)
        .map(|i| {
            let width = random.pick(&[0.0, 1.0, 1.0, 1.0]) * random.by_size(1e-5, 2.0);
            let b = random.between(-1.0 + width, 1.0) as f32;
            let a = ((f64::from(b) - width) as f32).max(-1.0);
            let lambda = match i % 10 {
                0 => 0.0,
                1 => 1e6,
                _ => random.by_size(1e-3, 1e3),
            } as f32;
            [random.between(0.0, 2.0) as f32, lambda, a, b]
        })
        .collect();
    let named = |input: &[f32; 4]| ["mu", "lambda", "a", "b"].into_iter().zip(*input).collect();
    let points: Vec<Vec<(&str, f32)>> = inputs.iter().map(named).collect();
    let got: Vec<Vec<f64>> = functions.iter().map(|function| function.values(executor, &points)).collect();
    for (at, input) in inputs.into_iter().enumerate() {
        let f = |[mu, lambda, a, b]: [f64; 4]| {
            let [r0, r1, alpha, beta] = oracle::linear([mu, lambda, a, b]);
            let [e1, e2] = oracle::error(&rules, [mu, lambda, a, b]);
            [r0, r1, alpha, beta, e1, e2]
        };
        let wide = input.map(f64::from);
        let exact = f(wide);
        let sens = sensitivity(input, exact, |[mu, lambda, a, b]| f([mu, lambda.max(0.0), a.min(b), b]));
        // A subnormal exponential may be flushed before it is multiplied by these.
        let flushed = f64::from(f32::MIN_POSITIVE) * wide[0].max(1.0) * wide[1].max(1.0);
        for (j, got) in got.iter().enumerate() {
            let p = 0.5 * (wide[2] + wide[3]);
            let name = GAUSSIAN[j];
            let scale = if name == "alpha" { exact[0].abs() + (exact[3] * p).abs() } else { exact[j].abs() };
            errors[usize::from(j >= 4)].add(name, got[at], exact[j], sens[j] + flushed, scale, &input);
        }
    }
    errors
}

#[test]
fn the_linear_approximation_of_a_gaussian() {
    let functions = GAUSSIAN.map(|name| Function::read("spherical_gaussian", name));
    let [close, wide] = errors_of_gaussians(&functions, &Executor::Interpreter);
    close.check(2.0, 4.0);
    wide.check(8.0, 32.0);
}

/// The printed table has no errors e1 and e2.
#[test]
fn the_stabilised_approximation_of_a_gaussian() {
    let functions = ["r0", "r1", "alpha", "beta"].map(|name| Function::stabilised("spherical_gaussian", name));
    errors_of_gaussians(&functions, &Executor::Interpreter)[0].check(2.0, 4.0);
}

/// WGSL promises less of `exp`, so more is allowed.
#[cfg(feature = "gpu")]
#[test]
fn gaussians_on_an_adapter() {
    let Some(gpu) = Executor::gpu() else { return };
    let functions = GAUSSIAN.map(|name| Function::read("spherical_gaussian", name));
    let [close, wide] = errors_of_gaussians(&functions, &gpu);
    close.check(8.0, 16.0);
    wide.check(8.0, 32.0);
}

#[test]
fn the_interval_of_a_cell() {
    let mut random = Random::new(5);
    let function = Function::read("spherical_gaussian", "interval");
    for _ in 0..400 {
        let (phi0, theta0) = (random.between(-3.0, 6.0) as f32, random.pick(&[0.0, 0.4, 1.5, 3.0]) as f32);
        let phi1 = phi0 + random.by_size(1e-3, 3.0) as f32;
        let theta1 = (theta0 + random.by_size(1e-3, 2.0) as f32).min(std::f32::consts::PI);
        let axis = random.vector();
        let length = axis.iter().map(|x| x * x).sum::<f32>().sqrt();
        let [ax, ay, az] = axis.map(|x| x / length);
        let got = function.call(&[
            ("phi0", phi0),
            ("phi1", phi1),
            ("theta0", theta0),
            ("theta1", theta1),
            ("ax", ax),
            ("ay", ay),
            ("az", az),
        ]);
        // The extremes of a fine grid are inside, and not farther inside than its step allows.
        let (mut lo, mut hi) = (f64::INFINITY, f64::NEG_INFINITY);
        let steps = 64;
        for i in 0..=steps * steps + 2 * steps {
            let (x, y) = (i % (steps + 1), i / (steps + 1));
            let at = |from: f32, to: f32, part: i32| {
                f64::from(from) + (f64::from(to) - f64::from(from)) * f64::from(part) / f64::from(steps)
            };
            let (phi, theta) = (at(phi0, phi1, x), at(theta0, theta1, y));
            let cosine = f64::from(ax) * phi.cos() * theta.sin()
                + f64::from(ay) * phi.sin() * theta.sin()
                + f64::from(az) * theta.cos();
            (lo, hi) = (lo.min(cosine), hi.max(cosine));
        }
        let cell = f64::from(phi1 - phi0).max(f64::from(theta1 - theta0)) / f64::from(steps);
        let slack = 0.5 * cell * cell + 1e-6;
        assert!(
            got[0] <= lo + 1e-6 && got[0] >= lo - slack,
            "{got:?} {lo} {phi0} {phi1} {theta0} {theta1} {ax} {ay} {az}"
        );
        assert!(
            got[1] >= hi - 1e-6 && got[1] <= hi + slack,
            "{got:?} {hi} {phi0} {phi1} {theta0} {theta1} {ax} {ay} {az}"
        );
    }
}

/// The printed closed forms in 384 bits, singular points by their limits, are the integrals; so the
/// quadrature above is right as well.
#[test]
fn the_printed_forms_are_the_integrals() {
    let (rules, mut random) = (Rules::new(), Random::new(6));
    for (i, name) in PARTS.into_iter().enumerate() {
        let function = Function::read("double_product_printed", name);
        let mut precise = Precise::new(&function.0).expect("memory");
        for round in 0..6 {
            let mut input = cell_input(&mut random);
            // Without a horizontal part a vector has no phase, and the parts by themselves no value.
            while input[0] == input[1] || (input[5], input[6]) == (0.0, 0.0) || (input[8], input[9]) == (0.0, 0.0) {
                input = cell_input(&mut random);
            }
            if round % 2 == 0 {
                let slope = SLOPES[random.pick(&[0, 1, 2, 3, 4, 9, 10])] as f32;
                let middle = 0.5 * (input[0] + input[1]);
                (input[4], input[3]) = (input[4] + (input[3] - slope) * middle, slope);
            }
            let (exact, _) = cell_parts(&rules, input.map(f64::from));
            let named: Vec<(&str, f32)> = CELL.into_iter().zip(input).collect();
            let limit = precise.limit(&function.point(&named));
            let got = limit.unwrap_or_else(|e| panic!("{name} at {input:?}: {e:?}"))[0];
            let solid = cell_parts(&rules, input.map(f64::from)).1;
            assert!((got - exact[i]).abs() <= 1e-11 * solid.max(1e-3), "{name} at {input:?}: {got} {}", exact[i]);
        }
    }
}
