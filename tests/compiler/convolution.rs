//! The tables of convolution shadows: numbers of their specification in double precision, and what holds of them besides.

use std::path::Path;

use crate::support::OrPanic as _;
use umbrage::analyse;
use umbrage::eval::Interpreter;
use umbrage::program::{Domain, Program, Reading, Value};

const TABLES: [&str; 7] = ["policies", "slab", "ellipse", "kernels", "light_kernel", "shade", "noise"];

fn programs(table: &str) -> Vec<Program> {
    Program::read_all(format!("tables/{table}.ron")).or_panic()
}

/// One function of a table, asked with numbers and words.
struct Function(Program);

impl Function {
    fn of(table: &str, name: &str) -> Self {
        Self(Program::read_function(Path::new("tables").join(format!("{table}.ron")), Some(name)).or_panic())
    }

    /// The results by name; that of a function that returns no record is called `value`.
    fn at(&self, given: &[(&str, f64)]) -> Vec<(String, f64)> {
        let point: Vec<Option<Value>> = self
            .0
            .inputs
            .iter()
            .map(|input| {
                let value = given.iter().find(|(name, _)| *name == input.name).map(|(_, value)| *value);
                value
                    .map(|value| match &input.domain {
                        Domain::Continuous { .. } | Domain::Word => Value::Number(value),
                        Domain::Discrete(_) => input.parse(&value.to_string()).unwrap(),
                    })
                    .or(input.default)
            })
            .collect();
        let values = Interpreter::<f64>::new(&self.0).evaluate(&point).unwrap().values;
        let number = |reading: Reading<'_>| match reading {
            Reading::Number(number) => number,
            Reading::Bool(holds) => f64::from(holds),
            Reading::Int(whole) => whole as f64,
            other => panic!("{other:?}"),
        };
        match self.0.output.read(&values) {
            Reading::Record(fields) => fields.into_iter().map(|(name, of)| (name.to_owned(), number(of))).collect(),
            one => vec![("value".to_owned(), number(one))],
        }
    }

    fn number(&self, given: &[(&str, f64)], name: &str) -> f64 {
        self.at(given).into_iter().find(|(known, _)| known == name).unwrap().1
    }
}

/// Examples are rounded to `f32` when a table is checked; in double precision they hold to their last digits.
#[test]
fn the_numbers_of_the_specification() {
    let mut count = 0;
    for table in TABLES {
        for program in programs(table) {
            let mut interpreter = Interpreter::<f64>::new(&program);
            for example in &program.examples {
                let got = interpreter.evaluate(&example.inputs).unwrap().values;
                for (got, expected) in got.iter().zip(&example.expected) {
                    // What was worked with 40 digits stands there with 14 at least.
                    let allowed = 4e-14 * expected.abs().max(1.0);
                    // The sum over nodes of microfacet_g is made for single precision.
                    let allowed = if program.name.contains("microfacet") { 5e-11 } else { allowed };
                    assert!(
                        (got - expected).abs() <= allowed,
                        "{}:{} {got} {expected}",
                        program.name,
                        program.line(example.span)
                    );
                }
                count += 1;
            }
        }
    }
    assert!(count > 180, "{count}");
}

#[test]
fn the_ellipse_is_its_own_mirror_image() {
    let (variance, ratio, inverse) =
        (Function::of("ellipse", "variance"), Function::of("ellipse", "ratio"), Function::of("ellipse", "axis_ratio"));
    let of = |function: &Function, name: &str, value: f64| function.number(&[(name, value)], "value");
    let mut last = 0.0;
    for i in 0..=240 {
        // From 1e-6 to 1e6.
        let b = libm::exp10(f64::from(i) / 20.0 - 6.0);
        let sum = of(&variance, "b", b) + of(&variance, "b", 1.0 / b);
        assert!((sum - 1.0).abs() < 1e-15, "{b}: {sum}");
        let r = of(&ratio, "b", b);
        assert!(r > last, "{b}");
        last = r;
        let back = of(&inverse, "r", r);
        assert!((back / b - 1.0).abs() < 1e-13, "{b}: {back}");
    }
    // By the sum over angles, which nobody transformed.
    for b in [0.5, 0.9, 0.999, 1.0, 1.001, 3.0] {
        let at = |i: i32| {
            let (s, c) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 4096.0);
            (s * s, libm::hypot(c, b * s))
        };
        let (squares, lengths) = (0..4096).map(at).fold((0.0, 0.0), |(q, l), (s, w)| (q + s * w, l + w));
        assert!((of(&variance, "b", b) - squares / lengths).abs() < 1e-13, "{b}");
    }
}

#[test]
fn points_of_an_arc_are_equally_far_apart() {
    let point = Function::of("ellipse", "arc_point");
    for (a, b) in [(3.0, 2.0), (2.0, 3.0), (1.0, 1.0), (5.0, 0.01), (0.0, 2.0)] {
        let at = |i: u32| {
            let given = [("a", a), ("b", b), ("f", f64::from(i) / 40_000.0)];
            (point.number(&given, "x"), point.number(&given, "y"))
        };
        let apart = |i: u32| {
            let ((x, y), (u, v)) = (at(i), at(i + 1));
            libm::hypot(u - x, v - y)
        };
        let first = apart(5_000);
        for i in [100, 5_001, 9_000, 12_345, 25_000, 33_333, 39_000] {
            assert!((apart(i) / first - 1.0).abs() < 2e-3, "{a} {b} {i}: {} {first}", apart(i));
        }
        assert!((at(0).1 - b).abs() < 1e-12 && (at(10_000).0 - a).abs() < 1e-12 && (at(20_000).1 + b).abs() < 1e-12);
    }
}

#[test]
fn rings_keep_their_covariance_at_every_phase_and_under_every_map() {
    let ring = Function::of("kernels", "ring_affine");
    let mut seed = 1_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for n in [3.0, 4.0, 7.0] {
        for _ in 0..1000 {
            let (phase, a) = (random(), [random() - 0.5, random() - 0.5, random() - 0.5, random() - 0.5]);
            let mut sums = [0.0; 6];
            for k in 0..n as u32 {
                let given = [("N", n), ("k", f64::from(k)), ("phase", phase)];
                let [x, y, w] = ["x", "y", "w"].map(|name| ring.number(&given, name));
                let (u, v) = (a[0] * x + a[1] * y, a[2] * x + a[3] * y);
                for (sum, part) in sums.iter_mut().zip([1.0, u, v, u * u, u * v, v * v]) {
                    *sum += w * part;
                }
            }
            let [p, q, r, s] = a;
            let expected = [1.0, 0.0, 0.0, p * p + q * q, p * r + q * s, r * r + s * s];
            assert!(
                sums.iter().zip(expected).all(|(sum, expected)| (sum - expected).abs() < 1e-14),
                "{sums:?} {expected:?}"
            );
        }
    }
}

#[test]
fn golden_phases_are_those_of_32_bit_words() {
    let program = Function::of("kernels", "golden").0;
    let (mut wide, mut narrow) = (Interpreter::<f64>::new(&program), Interpreter::<f32>::new(&program));
    for slab in (0..5000).chain([65_535, 65_536, 1_048_575]) {
        let expected = f64::from((slab as u32).wrapping_mul(0x9E37_79B9)) / 4_294_967_296.0;
        let point = [Some(Value::Number(f64::from(slab)))];
        assert_eq!(wide.evaluate(&point).unwrap().values, [expected], "{slab}");
        assert_eq!(narrow.evaluate(&point).unwrap().values, [expected as f32], "{slab}");
    }
}

/// The cases of a slab against the crossings played through one by one.
#[test]
fn slabs_are_what_their_crossings_make_of_them() {
    let program = Program::read("tables/slab.ron").or_panic();
    assert_eq!(program.rows.len(), 8);
    assert!(analyse::overlaps(&program).is_empty());
    let mut interpreter = Interpreter::<f64>::new(&program);
    for coverage in ["full", "exact"] {
        for inside in [false, true] {
            for crossings in (0..40).chain([1 << 20, i32::MAX as u32 - 1, i32::MAX as u32]) {
                let words = [inside.to_string(), crossings.to_string(), coverage.to_owned()];
                let point: Vec<_> =
                    program.inputs.iter().zip(&words).map(|(input, word)| Some(input.parse(word).unwrap())).collect();
                let outcome = interpreter.evaluate(&point).unwrap();
                assert!(outcome.row.is_some(), "{words:?}: no case");
                let Reading::Record(fields) = program.output.read(&outcome.values) else { panic!("a record") };
                let field = |name: &str| fields.iter().find(|(known, _)| *known == name).unwrap().1.clone();
                let level = |name: &str| match field(name) {
                    Reading::Level(_, level) => level,
                    other => panic!("{other:?}"),
                };
                let after = inside != (crossings % 2 == 1);
                let kind = match (inside, crossings) {
                    (false, 0) => "empty",
                    (true, 0) => "interior",
                    (false, 1) => "enter",
                    (true, 1) => "exit",
                    (false, _) if after => "multi_enter",
                    (false, _) => "thin",
                    (true, _) if after => "gap",
                    (true, _) => "multi_exit",
                };
                let place = match (kind, coverage) {
                    ("empty", _) => "nowhere",
                    ("interior", "full") => "jittered",
                    ("interior", _) => "middle",
                    ("enter" | "exit", "full") => "crossing",
                    ("enter" | "exit", _) => "inside_middle",
                    (_, "full") => "hit",
                    _ => "longest_middle",
                };
                assert_eq!((level("kind"), level("sampled_at")), (kind, place), "{words:?}");
                assert_eq!(field("inside_after"), Reading::Bool(after), "{words:?}");
                assert_eq!(field("surface"), Reading::Bool(crossings > 0), "{words:?}");
            }
        }
    }
}

#[test]
fn iterated_and_correct_shadows_differ_most_where_the_specification_says() {
    let half_plane = Function::of("light_kernel", "half_plane");
    for (ratio, most, at) in [(2.0_f64, 0.083_032_037_49, 0.832_554_611_2), (4.0, 0.161_337_284_4, 0.679_777_993_4)] {
        let difference = |u: f64| {
            let given = [("at", u * ratio), ("d", ratio), ("mu", 0.0), ("sigma", 1.0), ("d1", 1.0)];
            half_plane.number(&given, "iterated") - half_plane.number(&given, "correct")
        };
        let largest = (0..4000).map(|i| difference(f64::from(i) * 1e-3)).fold(0.0, f64::max);
        assert!((largest - most).abs() < 1e-7 && (difference(at) - most).abs() < 1e-10, "{largest}");
        // As large on the other side of the right distance.
        let given = [("at", -at / ratio.sqrt()), ("d", 1.0 / ratio), ("mu", 0.0), ("sigma", 1.0), ("d1", 1.0)];
        let near = half_plane.number(&given, "iterated") - half_plane.number(&given, "correct");
        assert!((near - most).abs() < 1e-10, "{near}");
    }
    // A split light is nearer to what is right.
    let (part, node) =
        (Function::of("light_kernel", "half_plane_of_part"), Function::of("light_kernel", "split_nodes"));
    let worst = |count: u32, rho: f64| {
        let nodes: Vec<f64> =
            (0..count).map(|k| node.number(&[("M", f64::from(count)), ("k", f64::from(k))], "x")).collect();
        let mut worst = 0.0_f64;
        for i in 0..=16 {
            let d = libm::exp2(f64::from(i) / 4.0 - 2.0);
            for j in -60..=60 {
                let given =
                    [("at", f64::from(j) * 0.05 * d), ("d", d), ("mu", 0.0), ("sigma", 1.0), ("d1", 1.0), ("rho", rho)];
                let one = |x: &f64| part.number(&[&given[..], &[("node", *x)]].concat(), "value");
                let split = nodes.iter().map(one).sum::<f64>() / f64::from(count);
                worst = worst.max((split - half_plane.number(&given, "correct")).abs());
            }
        }
        worst
    };
    let (one, sixteen) = (worst(1, 1.0), worst(16, 0.15));
    assert!((one - 0.1613).abs() < 1e-3 && sixteen < 0.055, "{one} {sixteen}");
}

#[test]
fn light_on_slopes_is_the_same_by_both_forms_and_falls_with_the_root_of_the_thickness() {
    let slope = Function::of("light_kernel", "slope_light");
    let at = |e: f64| slope.number(&[("c", 1.0), ("mu_n", 0.0), ("sigma_n", 1.0), ("e", e), ("d1", 1.0)], "iterated");
    let ratio = at(1.0 / 1024.0) / at(1.0 / 4096.0);
    assert!((ratio - 2.0).abs() < 0.05, "a quarter of the thickness: {ratio}");
    // The forms meet at a drift of 2.
    let beside =
        |e: f64| slope.number(&[("c", 2.0), ("mu_n", 0.0), ("sigma_n", 1.0), ("e", e), ("d1", 1.0)], "iterated");
    assert!((beside(1.0 - 1e-12) - beside(1.0 + 1e-12)).abs() < 1e-12);
}

/// Noise against the published algorithm, played through with the permutation as it is printed.
#[test]
fn noise_is_that_of_its_permutation() {
    let text = std::fs::read_to_string("tables/noise_permutation.csv").unwrap();
    let words: Vec<u32> =
        text.lines().filter(|line| !line.starts_with('#')).map(|line| line.parse().unwrap()).collect();
    let permutation: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let mut sorted = permutation.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, (0..=255).collect::<Vec<u8>>());
    let permuted = |i: i64| i64::from(permutation[i.rem_euclid(256) as usize]);
    let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let slope = |hash: i64, [x, y, z]: [f64; 3]| {
        let h = hash & 15;
        let u = if h < 8 { x } else { y };
        let v = if h < 4 {
            y
        } else if h == 12 || h == 14 {
            x
        } else {
            z
        };
        (if h & 1 == 0 { u } else { -u }) + (if h & 2 == 0 { v } else { -v })
    };
    let expected = |p: [f64; 3]| {
        let cell = p.map(|c| c.floor() as i64);
        let f = p.map(|c| c - c.floor());
        let mut sum = 0.0;
        for corner in 0..8_i64 {
            let at = [corner & 1, corner >> 1 & 1, corner >> 2];
            let hash = permuted(permuted(permuted(cell[0] + at[0]) + cell[1] + at[1]) + cell[2] + at[2]);
            let away = [0, 1, 2].map(|i| f[i] - at[i] as f64);
            let weight: f64 = (0..3).map(|i| if at[i] == 1 { fade(f[i]) } else { 1.0 - fade(f[i]) }).product();
            sum += weight * slope(hash, away);
        }
        sum
    };
    let noise = Function::of("noise", "perlin3");
    for i in 0..500 {
        let p = [0.731, 1.177, 2.319].map(|step| (f64::from(i) * step * 7.3).rem_euclid(600.0) - 300.0);
        let got = noise.number(&[("px", p[0]), ("py", p[1]), ("pz", p[2])], "value");
        assert!((got - expected(p)).abs() < 1e-12, "{p:?}: {got} {}", expected(p));
    }
}
