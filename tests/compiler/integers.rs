//! Integers: arithmetic as 64-bit integers have it, classes of any range, and the code of both.

use umbrage::diag::Source;
use umbrage::emit::{Target, emit, rust, wgsl};
use umbrage::eval::{Batch, Columns, Interpreter, IntervalInterpreter};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Real, Value};
use umbrage::table::Table;

fn program(text: &str) -> Program {
    let table = Table::parse(Source::new("t.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    Program::check(&table).unwrap_or_else(|e| panic!("{e}"))
}

/// Results that are calculated, as expressions and as what they come to.
type Result = (&'static str, fn(i64, i64) -> i64);

const RESULTS: &[Result] = &[
    ("k + j * 3 - 1", |k, j| k + j * 3 - 1),
    ("k / 3", |k, _| k / 3),
    ("k % 3", |k, _| k % 3),
    ("(k - 20) / (2 * j + 1)", |k, j| (k - 20) / (2 * j + 1)),
    ("(k - 20) % (abs(j) + 2)", |k, j| (k - 20) % (j.abs() + 2)),
    ("-k * k + min(k, j)", |k, j| -k * k + k.min(j)),
    ("clamp(k - j, -4, max(j, 3))", |k, j| (k - j).max(-4).min(j.max(3))),
    ("if k > 2 * j { k } else { j / 2 }", |k, j| if k > 2 * j { k } else { j / 2 }),
    ("count(k < j, k % 2 == 0, j in {-3, 1})", |k, j| {
        i64::from(k < j) + i64::from(k % 2 == 0) + i64::from(j == -3 || j == 1)
    }),
    ("case(2, k = 10 + k % 4) + index(b)", |k, j| 7 * (10 + k % 4) + j + 1),
    ("(k + 1) % 5 * (k / 7) / 2 % 4", |k, _| (k + 1) % 5 * (k / 7) / 2 % 4),
];

fn arithmetic(result: &str) -> Program {
    program(&format!(
        r#"Table(language: 2, name: "t", hit_policy: First,
            inputs: {{"k": Int(from: 0, to: 40), "j": Int(from: -3, to: 4), "b": Bool(), "f": Int(from: -2, to: 2, fetched: (cost: 1))}},
            output: Int(from: -9999, to: 9999),
            cases: [
                Case(id: 1, when: "b && f < 2", value: "{result}"),
                Case(id: 2, when: "b", value: "7 * k + j"),
            ],
            default: "f % 2 - 3")"#
    ))
}

fn agree<T: Real>(program: &Program, result: fn(i64, i64) -> i64) {
    let (mut interpreter, mut batch) = (Interpreter::<T>::new(program), Batch::<T>::new(program));
    let mut points = Vec::new();
    for (k, j, b, f) in (0..=40).flat_map(|k| (0..8).flat_map(move |j| (0..2).map(move |b| (k, j, b, (k + j) % 5)))) {
        points.push([k, j, b, f].map(|level| Some(Value::Level(level))));
    }
    let columns = Columns::from_rows(program, &points).unwrap();
    let results = batch.evaluate(&columns).unwrap();
    for (row, point) in points.iter().enumerate() {
        let [k, j, b, f] = point.map(|value| match value {
            Some(Value::Level(level)) => i64::from(level),
            other => panic!("{other:?}"),
        });
        let (j, f) = (j - 3, f - 2);
        let expected = match (b == 1, f < 2) {
            (true, true) => result(k, j),
            (true, false) => 7 * k + j,
            (false, _) => f % 2 - 3,
        };
        let one = interpreter.evaluate(point).unwrap();
        assert_eq!(one.values[0].to_f64(), expected as f64, "k = {k}, j = {j}, f = {f}");
        assert_eq!(results.outcome(row), one);
    }
}

#[test]
fn interpreters_calculate_as_integers_do() {
    for (text, result) in RESULTS {
        let program = arithmetic(text);
        agree::<f32>(&program, *result);
        agree::<f64>(&program, *result);
        // Nothing rounds, so nothing else is admitted, in whatever order code computes.
        let mut intervals = IntervalInterpreter::new(&program);
        intervals.reordering(true);
        for k in [0, 7, 19, 40] {
            let point = [k, 2, 1, 0].map(|level| Some(Value::Level(level)));
            let expected = result(i64::from(k), -1) as f32;
            let admitted = intervals.admissible(&point).unwrap();
            assert!(admitted.contains(Some(0), &[expected]), "{text}: {admitted:?}");
            assert!(!admitted.contains(Some(0), &[expected + 1.0]), "{text}: {admitted:?}");
        }
    }
}

#[test]
fn every_plan_of_integers_is_proved_and_emitted() {
    for (text, _) in RESULTS {
        let program = arithmetic(text);
        for shape in [Shape::Ladder, Shape::Switch, Shape::Tree, Shape::Gathered] {
            let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{text}: {e}"));
            let code = wgsl(&proved);
            assert!(code.contains("value: i32"), "{code}");
            assert!(code.contains("fn t_k_level(integer: i32) -> u32"), "{code}");
        }
    }
}

#[test]
fn integers_are_computed_as_such() {
    let program = arithmetic("(k - 20) / (abs(j) + 2) + k % 3");
    let proved = Plan::proved(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
    let (wgsl, rust) = (wgsl(&proved), rust(&proved));
    for part in ["((i32(k) - 20i) / (abs(i32(j) - 3i) + 2i)) + (i32(k) % 3i)", "t_f_level(t_fetch_f(site))"] {
        assert!(wgsl.contains(part), "{part} is not in:\n{wgsl}");
    }
    assert!(rust.contains("fn f(&mut self) -> i32;"), "{rust}");
}

const CROSSINGS: &str = r#"Table(language: 2, name: "slab", hit_policy: Unique,
    inputs: {"p": Bool(), "k": Int(from: 0), "m": Int(fetched: (cost: 1))}, output: Int(from: 0, to: 7),
    cases: [
        Case(id: 0, when: "k == 0", value: "min(k, 4)"),
        Case(id: 1, when: "k == 1", value: 1),
        Case(id: 2, when: "k % 2 == 0 && k >= 2", value: "2 + min(k, 4)"),
        Case(id: 3, when: "k % 2 == 1 && 3 <= k && m < -7", value: 3),
        Case(id: 4, when: "k % 2 == 1 && 3 <= k && !(m < -7)", value: "clamp(m, -1, 2) + 1 + m % 3 * 0"),
    ],
    default: 7)"#;

#[test]
fn all_integers_are_of_the_class_that_they_are_tested_as() {
    let program = program(CROSSINGS);
    let (k, m) = (program.input("k").unwrap(), program.input("m").unwrap());
    let mut interpreter = Interpreter::<f32>::new(&program);
    let integers = (0..60).chain([99, 1000, 1001, i64::from(i32::MAX) - 1, i64::from(i32::MAX)]);
    for n in integers {
        for other in [i64::from(i32::MIN), -9, -8, -7, -2, -1, 0, 1, 2, 3, 1000] {
            let level = |input: umbrage::program::InputId, integer: i64| {
                program.inputs[input.index()].parse(&integer.to_string()).unwrap()
            };
            let point = [Some(Value::Level(0)), Some(level(k, n)), Some(level(m, other))];
            let outcome = interpreter.evaluate(&point).unwrap();
            let expected = match (n, n % 2) {
                (0, _) => 0,
                (1, _) => 1,
                (_, 0) => 2 + n.min(4),
                _ if other < -7 => 3,
                _ => other.clamp(-1, 2) + 1,
            };
            assert_eq!(outcome.values, [expected as f32], "{n}, {other}");
        }
    }
    assert!(program.inputs[k.index()].parse("-1").is_err() && program.inputs[k.index()].parse("1.5").is_err());
    for shape in [Shape::Ladder, Shape::Switch, Shape::Tree] {
        let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{e}"));
        assert!(wgsl(&proved).contains("fn slab_k_level(integer: i32) -> u32"));
    }
}

/// The least integer is no literal with a sign: its magnitude is no integer.
#[test]
fn the_least_integer_is_valid_in_every_language() {
    let program = program(
        r#"Table(language: 2, name: "ends", hit_policy: First, inputs: {"k": Int()}, output: Number(),
            cases: [Case(id: 1, when: "k == -2147483648", value: 1), Case(id: 2, when: "k > 2147483646", value: 2)],
            default: 0)"#,
    );
    let proved = Plan::proved(&program, Shape::Tree).unwrap_or_else(|e| panic!("{e}"));
    for target in Target::ALL {
        let emitted = emit(&proved, target);
        assert!(emitted.is_ok(), "{}: {}", target.name(), emitted.err().map_or(String::new(), |e| e.to_string()));
    }
    assert!(wgsl(&proved).contains("-2147483647i - 1i") && !wgsl(&proved).contains("-2147483648i"));
}

/// A number for each of 64 integers, in two guards.
#[test]
fn codes_in_a_row_are_one_conversion() {
    let program = program(
        r#"Table(language: 1, name: "ages", hit_policy: First,
            inputs: { "i": Int(from: 0, to: 63), "j": Int(from: -32, to: 31), "x": Range(from: 0, to: 1) },
            output: Number(),
            cases: [
                Case(id: 1, when: "f32(i) * 2 < f32(j)", value: "f32(i) + x * f32(j)"),
                Case(id: 2, when: "f32(i) + f32(j) > 40", value: "mix(f32(i), f32(j), x)"),
            ],
            default: "x")"#,
    );
    let proved = Plan::proved(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
    let code = wgsl(&proved);
    assert!(code.lines().count() <= 66, "{} lines:\n{code}", code.lines().count());
    assert!(code.contains("(f32(i) * 2.0) < (f32(j) - 32.0)"), "{code}");
}
