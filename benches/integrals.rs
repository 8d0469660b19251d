//! Printed integrals, what `umbrage stabilise` makes of them, and the forms to compute with: evaluations per
//! second in `f32` by the batch interpreter, by emitted Rust and on a device, beside the errors.
//!
//! Half of the cells are visible as a whole, which is the usual cell of a renderer (`k = 0`). The truth about a
//! cell is its defining integral by quadrature in `f64`.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::process::Command;
use std::time::Instant;

use umbrage::diag::{Failure, Source};
use umbrage::emit;
use umbrage::emit::kernel::columns::Entry;
use umbrage::eval::{Batch, Columns, Results};
use umbrage::gpu::bench::{Timed, Workload};
use umbrage::gpu::timing::{Protocol, Stopwatch, Times, interleaved};
use umbrage::gpu::{AdapterChoice, Gpu, Kernel, Language};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Value};
use umbrage::table::Table;

/// Points of the batch interpreter and of emitted Rust.
const COUNT: usize = 4096;
/// How often they are repeated for a device.
const COPIES: usize = 8;
const PROTOCOL: Protocol = Protocol { warm_up: 1, rounds: 9 };

/// A function in one of its forms.
struct Form {
    label: String,
    program: Program,
    points: Vec<Vec<f32>>,
    /// What a point should give, and what an error is measured by.
    exact: Vec<(f64, f64)>,
}

fn main() -> Result<(), Failure> {
    // `cargo test` runs benchmarks too, only to see whether they run.
    if !std::env::args().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let forms = forms()?;
    let gpu = Gpu::open(&AdapterChoice::Any)?;
    let columns: Vec<Columns<f32>> = forms.iter().map(|form| columns(form, 1)).collect();
    let mut batches: Vec<Batch<'_, f32>> = forms.iter().map(|form| Batch::new(&form.program)).collect();
    let mut results: Vec<Results<f32>> = forms.iter().map(|_| Results::default()).collect();
    let batch = interleaved(PROTOCOL, forms.len(), |form| {
        let start = Instant::now();
        let done = batches[form].evaluate_into(&columns[form], &mut results[form]);
        done.map(|()| start.elapsed())
    });
    let batch = batch.unwrap_or_else(|missing| panic!("{missing:?}"));
    let rust = emitted_rust(&forms)?;
    let (device, on_device) = device(&gpu, &forms, &columns)?;

    println!("device: {}", gpu.describe());
    println!("millions of evaluations per second; errors relative to the measure of the cell or value\n");
    println!("| form | interpreter | Rust | device | not finite | median error | worst error | worst on device |");
    println!("|---|---|---|---|---|---|---|---|");
    for (index, form) in forms.iter().enumerate() {
        let errors = Errors::new(form, results[index].values(0));
        let there = Errors::new(form, &on_device[index]);
        let speed = |seconds: f64, count: usize| count as f64 / seconds / 1e6;
        println!(
            "| {} | {:.2} | {:.2} | {:.2} | {:.0} % | {:.1e} | {:.1e} | {:.1e} |",
            form.label,
            speed(batch[index].median(), COUNT),
            1e3 / rust[index],
            speed(device[index].median(), COUNT * COPIES),
            100.0 * errors.not_finite,
            errors.median,
            errors.worst,
            there.worst
        );
    }
    Ok(())
}

/// How far results are from what they should be.
struct Errors {
    not_finite: f64,
    median: f64,
    worst: f64,
}

impl Errors {
    fn new(form: &Form, got: &[f32]) -> Self {
        let all = got.iter().zip(&form.exact).map(|(got, (exact, scale))| (f64::from(*got) - exact).abs() / scale);
        let mut finite: Vec<f64> = all.filter(|error| error.is_finite()).collect();
        finite.sort_by(f64::total_cmp);
        let at = |place: usize| finite.get(place).copied().unwrap_or(f64::NAN);
        Self {
            not_finite: 1.0 - finite.len() as f64 / form.exact.len() as f64,
            median: at(finite.len() / 2),
            worst: at(finite.len().saturating_sub(1)),
        }
    }
}

fn forms() -> Result<Vec<Form>, Failure> {
    let read = |name: &str| Table::read(format!("{}/tables/{name}.ron", env!("CARGO_MANIFEST_DIR")));
    let stabilised = |name: &str| {
        let text = umbrage::stabilise::stabilise(&read(name)?)?.text;
        Table::parse(Source::new("stabilised", text))
    };
    let tables = [
        ("printed", read("double_product_printed")?, &["C4", "C5", "A", "B"][..]),
        ("stabilised", stabilised("double_product_printed")?, &["C4", "C5", "A", "B"]),
        ("recommended", read("double_product")?, &["C4", "C5", "A", "B", "moments"]),
        ("printed", read("spherical_gaussian_printed")?, &["beta"]),
        ("stabilised", stabilised("spherical_gaussian_printed")?, &["beta"]),
        ("recommended", read("spherical_gaussian")?, &["beta"]),
    ];
    let mut forms = Vec::new();
    for (label, table, names) in tables {
        let programs = Program::check_all(&table)?;
        for program in programs {
            let name = program.function.as_ref().map_or(String::new(), |function| function.name.clone());
            if names.contains(&name.as_str()) {
                let inputs: Vec<&str> = program.inputs.iter().map(|input| input.name.as_str()).collect();
                let points: Vec<Vec<f32>> = (0..COUNT).map(|row| point(&inputs, row)).collect();
                let exact = points.iter().map(|point| exact(&name, &inputs, point)).collect();
                forms.push(Form { label: format!("{name} {label}"), program, points, exact });
            }
        }
    }
    forms.sort_by_key(|form| form.label.split(' ').next().map(str::to_owned));
    Ok(forms)
}

/// A point of a function: small cells, as a renderer has them.
fn point(inputs: &[&str], row: usize) -> Vec<f32> {
    // The additive sequence of the generalised golden ratio in each place.
    let part =
        |place: usize| (0.5 + (row + 1) as f64 * (0.618_033_988_75 + 0.137_213_1 * place as f64).fract()).fract();
    let k = if row.is_multiple_of(2) { 0.0 } else { part(4) - 0.45 };
    let (phi0, theta, width) = (5.0 * part(1), 0.3 + 2.0 * part(2), 0.02 + 0.33 * part(3));
    // Above the other side at both ends.
    let boundary = theta + 0.02 + 0.3 * part(5) - (k * width).min(0.0);
    let [z, turn] = [2.0 * part(6) - 1.0, 2.0 * PI * part(7)];
    let flat = (1.0 - z * z).sqrt();
    let number = |name: &str| match name {
        "phi0" => phi0,
        "phi1" => phi0 + width,
        "theta0" => theta,
        "theta_a" => boundary,
        "theta_b" => boundary + k * width,
        "k" | "s" => k,
        "b" => boundary - k * phi0,
        "nx" => flat * turn.cos(),
        "ny" => flat * turn.sin(),
        "nz" => z,
        "px" => 0.48,
        "py" => -0.6,
        "pz" => 0.64,
        "p" | "q" | "t" => 6.0 * part(8) - 3.0,
        "lambda" => 100.0 * part(9),
        "a" => 0.9 * part(10),
        "b_of_lobe" => 0.9 * part(10) + 0.1 * part(11),
        _ => 1.0,
    };
    let is_lobe = inputs.contains(&"lambda");
    inputs.iter().map(|name| number(if is_lobe && *name == "b" { "b_of_lobe" } else { name }) as f32).collect()
}

/// The defining integral at a point, and the measure that errors are relative to.
fn exact(function: &str, inputs: &[&str], point: &[f32]) -> (f64, f64) {
    let at = |name: &str| inputs.iter().position(|input| *input == name).map_or(0.0, |place| f64::from(point[place]));
    let [phi0, phi1, p, q, s, t] = ["phi0", "phi1", "p", "q", "s", "t"].map(at);
    let line = |f: &dyn Fn(f64) -> f64| integral(phi0, phi1, f);
    let cell = |f: &dyn Fn([f64; 3]) -> f64| {
        line(&|phi| {
            let end = match inputs.contains(&"theta_a") {
                true => at("theta_a") + (at("theta_b") - at("theta_a")) * (phi - phi0) / (phi1 - phi0),
                false => at("k") * phi + at("b"),
            };
            integral(at("theta0"), end, &|theta| {
                f([phi.cos() * theta.sin(), phi.sin() * theta.sin(), theta.cos()]) * theta.sin()
            })
        })
    };
    let dot = |names: [&str; 3], w: [f64; 3]| names.into_iter().zip(w).map(|(name, w)| at(name) * w).sum::<f64>();
    let n = |w: [f64; 3]| dot(["nx", "ny", "nz"], w);
    match function {
        "C4" => (line(&|phi| (phi + p).sin() * (s * phi + t).sin()), phi1 - phi0),
        "C5" => (line(&|phi| (phi + p).sin() * (phi + q).sin() * (s * phi + t).cos()), phi1 - phi0),
        "A" => (cell(&n), cell(&|_| 1.0)),
        "B" => (cell(&|w| n(w) * dot(["px", "py", "pz"], w)), cell(&|_| 1.0)),
        "moments" => (cell(&|w| w[0]), cell(&|_| 1.0)),
        _ => {
            let [mu, lambda, a, b] = ["mu", "lambda", "a", "b"].map(at);
            // The projection onto the second Legendre polynomial.
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let moment = integral(a, b, &|x| mu * (lambda * (x - 1.0)).exp() * (x - middle));
            let beta = 1.5 * moment / half.powi(3);
            (beta, beta)
        }
    }
}

/// By ten Gauss nodes, which is exact to the last digits for such small cells.
fn integral(from: f64, to: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    const NODES: [(f64, f64); 5] = [
        (0.148_874_338_981_631_22, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * NODES.iter().map(|(x, weight)| weight * (f(middle - half * x) + f(middle + half * x))).sum::<f64>()
}

fn columns(form: &Form, copies: usize) -> Columns<f32> {
    let rows = form.points.iter().cycle().take(COUNT * copies);
    let rows = rows.map(|point| point.iter().map(|v| Some(Value::Number(f64::from(*v)))).collect::<Vec<_>>());
    Columns::from_rows(&form.program, rows).unwrap_or_else(|error| panic!("{error}"))
}

/// Nanoseconds per evaluation in emitted Rust, compiled by itself with optimisation.
fn emitted_rust(forms: &[Form]) -> Result<Vec<f64>, Failure> {
    let folder = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let (mut modules, mut calls) = (String::new(), String::new());
    for (index, form) in forms.iter().enumerate() {
        let proved = Plan::proved(&form.program, Shape::Ladder)?;
        let _ = writeln!(modules, "mod form_{index} {{\n{}\n}}", emit::rust(&proved));
        let arguments: Vec<String> = (0..form.program.inputs.len()).map(|i| format!("row[{i}]")).collect();
        let (name, arguments) = (&form.program.name, arguments.join(", "));
        let _ = writeln!(
            calls,
            "time({index}, {}, |row| {{ black_box(form_{index}::{name}::{name}({arguments})); }});",
            form.program.inputs.len()
        );
        let bytes: Vec<u8> = form.points.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        std::fs::write(folder.path().join(index.to_string()), bytes).unwrap_or_else(|error| panic!("{error}"));
    }
    let source = format!(
        "#![allow(warnings)]\nuse std::hint::black_box;\nuse std::time::Instant;\n{modules}\n\
         fn time(index: usize, width: usize, f: impl Fn(&[f32])) {{\n\
             let bytes = std::fs::read(index.to_string()).unwrap();\n\
             let numbers: Vec<f32> = bytes.chunks(4).map(|b| f32::from_le_bytes(b.try_into().unwrap())).collect();\n\
             let mut times: Vec<f64> = (0..{}).map(|_| {{\n\
                 let start = Instant::now();\n\
                 for row in numbers.chunks_exact(width) {{ f(black_box(row)); }}\n\
                 1e9 * start.elapsed().as_secs_f64() / (numbers.len() / width) as f64\n\
             }}).collect();\n\
             times.sort_by(f64::total_cmp);\n\
             println!(\"{{}}\", times[times.len() / 2]);\n\
         }}\n\
         fn main() {{\n{calls}}}\n",
        PROTOCOL.warm_up + PROTOCOL.rounds
    );
    let (file, binary) = (folder.path().join("main.rs"), folder.path().join("main"));
    std::fs::write(&file, source).unwrap_or_else(|error| panic!("{error}"));
    let mut rustc = Command::new("rustc");
    rustc.args(["--edition", "2021", "-C", "opt-level=3", "-o"]).arg(&binary).arg(&file);
    let built = rustc.output().unwrap_or_else(|error| panic!("rustc: {error}"));
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let said = Command::new(&binary).current_dir(folder.path()).output().unwrap_or_else(|error| panic!("{error}"));
    Ok(String::from_utf8_lossy(&said.stdout).lines().filter_map(|line| line.parse().ok()).collect())
}

/// Times of passes on a device, which read the points from memory, and the first number of each result.
fn device(gpu: &Gpu, forms: &[Form], few: &[Columns<f32>]) -> Result<(Vec<Times>, Vec<Vec<f32>>), Failure> {
    let watch = Stopwatch::new(gpu);
    let (mut passes, mut values) = (Vec::new(), Vec::new());
    for (form, few) in forms.iter().zip(few) {
        let proved = Plan::proved(&form.program, Shape::Ladder)?;
        values.push(Kernel::new(gpu, &proved, Entry::Levels, Language::Wgsl)?.run(few)?.values.swap_remove(0));
        let load = Workload::new(gpu, &form.program, &columns(form, COPIES))?;
        passes.push((Timed::plan(gpu, &proved, 1)?, load));
    }
    let times = interleaved(PROTOCOL, forms.len(), |form| {
        let (plan, load) = &passes[form];
        plan.time(gpu, &watch, load, 4)
    })?;
    Ok((times, values))
}
