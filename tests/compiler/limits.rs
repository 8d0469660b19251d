//! Tables at their limits: what a table may be, it may be to the end.

use crate::support::{OrPanic as _, parsed};
use umbrage::diag::codes;
use umbrage::emit::{self, Target};
use umbrage::eval::Interpreter;
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Value};

/// A polynomial of all the coefficients that one may have is checked, proved, emitted for every target, and evaluated.
#[test]
fn the_longest_polynomial() {
    let coefficients: Vec<String> =
        (0..256).map(|power| if power % 85 == 0 { "1" } else { "0.5" }.to_owned()).collect();
    let program = parsed(format!(
        r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"x": Range(from: -1, to: 1), "d": Bool()}},
            output: Number(), cases: [Case(id: 1, when: "d && x < 0.75", value: "poly(x, [{}])")], default: 0)"#,
        coefficients.join(", ")
    ));
    // That a state is left to the default is a note; nothing was given up.
    let found = umbrage::analyse::findings(&program);
    assert!(found.iter().all(|finding| finding.code == codes::UNCOVERED), "{found:?}");
    for shape in [Shape::Ladder, Shape::Switch] {
        let proved = Plan::proved(&program, shape).or_panic();
        for target in Target::ALL {
            emit::emit(&proved, target).or_panic();
        }
    }
    // 0.5 (1 + x + ... + x^255) and 0.5 (1 + x^85 + x^170 + x^255) at 0.5, as good as 1 + 0.5.
    let point = [Some(Value::Number(0.5)), Some(Value::Level(1))];
    assert_eq!(Interpreter::<f32>::new(&program).evaluate(&point).unwrap().values, [1.5]);
}

/// A table that is imported many times, directly and by way of others, is one table.
#[test]
fn imports_of_one_file() {
    let directory = tempfile::tempdir().unwrap();
    let write = |name: &str, text: String| std::fs::write(directory.path().join(name), text).unwrap();
    let functions: Vec<String> =
        (0..50).map(|i| format!(r#""g{i}": Function(parameters: ["x"], value: "x * {i} + 1")"#)).collect();
    let head = |name: &str| format!(r#"Table(language: 1, name: "{name}", inputs: {{"x": Range(from: 0, to: 1)}}"#);
    write("link0.ron", format!("{}, functions: {{{}}})", head("link0"), functions.join(", ")));
    // Each imports the one before twelve times: 12^6 ways lead to the first.
    for link in 1..7 {
        let imports: Vec<String> = (0..12).map(|i| format!(r#""a{i}": "link{}.ron""#, link - 1)).collect();
        let terms: Vec<String> = (0..12).map(|i| format!("a{i}.g{i}(x)")).collect();
        let functions: Vec<String> = (0..12)
            .map(|i| format!(r#""g{i}": Function(parameters: ["x"], value: "{}")"#, terms.join(" + ")))
            .collect();
        let (imports, functions) = (imports.join(", "), functions.join(", "));
        write(
            &format!("link{link}.ron"),
            format!("{}, imports: {{{imports}}}, functions: {{{functions}}})", head(&format!("link{link}"))),
        );
    }
    let programs = Program::read_all(directory.path().join("link6.ron")).or_panic();
    assert_eq!((programs.len(), programs[0].imported.len()), (12, 6));
    // At x = 0 each of the 12 functions of the first is 1.
    let outcome = Interpreter::<f32>::new(&programs[0]).evaluate(&[Some(Value::Number(0.0))]).unwrap();
    assert_eq!(outcome.values, [12.0_f32.powi(6)]);
    // The chain is bounded however often a table in it was read before.
    for link in 7..9 {
        let text = format!(
            r#"{}, imports: {{"a": "link{}.ron"}}, functions: {{"g0": Function(parameters: ["x"], value: "a.g0(x)")}})"#,
            head(&format!("link{link}")),
            link - 1
        );
        write(&format!("link{link}.ron"), text);
    }
    let known = r#""first": "link7.ron", "then": "link8.ron""#;
    write(
        "all.ron",
        format!(
            r#"{}, imports: {{{known}}}, functions: {{"f": Function(parameters: ["x"], value: "x")}})"#,
            head("all")
        ),
    );
    let failure = Program::read_all(directory.path().join("all.ron")).expect_err("ten tables in a chain");
    assert!(failure.to_string().contains("more than 8 tables import each other"), "{failure}");
}

/// The codes of what is found in a table of such cases over two numbers of 0 to 1.
fn codes_of(extra: &str, case: impl Fn(usize) -> String, count: usize) -> Vec<&'static str> {
    let cases: Vec<String> = (0..count).map(case).collect();
    let program = parsed(format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}}, {extra}
            output: Number(), cases: [{}], default: 0)"#,
        cases.join(", ")
    ));
    let mut codes: Vec<_> = umbrage::analyse::findings(&program).iter().map(|finding| finding.code.0).collect();
    codes.dedup();
    codes
}

/// Intervals side by side leave the end of the range to the default, and nothing is too intricate.
#[test]
fn a_thousand_intervals() {
    let interval = |i: usize| {
        let (from, to) = (i as f64 / 1000.0, (i + 1) as f64 / 1000.0);
        format!(r#"Case(id: {i}, when: "x >= {from} && x < {to}", value: "{i} + y")"#)
    };
    let codes = codes_of("", interval, 1000);
    assert!(codes.contains(&"U0503") && !codes.contains(&"U0530"), "{codes:?}");
}

/// Cases side by side that are declared to be continuous: each border is looked at, not each pair of cases.
#[test]
fn a_hundred_steps() {
    let step =
        |i: usize| format!(r#"Case(id: {i}, when: "x < {}", value: "x + {} * y")"#, (i + 1) as f64 / 128.0, i % 2);
    let codes = codes_of(r#"continuity: {"c": Switch(of: ["x"])},"#, step, 128);
    assert!(codes.contains(&"U0516") && !codes.contains(&"U0530"), "{codes:?}");
}

/// A name that is used twice by the next, twelve times over, is 4,096 operations written out, and twelve to compute.
#[test]
fn names_that_double() {
    let names: Vec<String> = (0..12)
        .map(|i| match i {
            0 => r#""q0": "x * y""#.to_owned(),
            _ => format!(r#""q{i}": "0.5 * q{0} + abs(q{0} - 0.{i})""#, i - 1),
        })
        .collect();
    let extra = format!(r#"names: {{{}}}, continuity: {{"c": Switch(of: ["x"])}},"#, names.join(", "));
    let case = |i: usize| match i {
        0 => r#"Case(id: 0, when: "x < 0.5", value: "sqrt(q11)")"#.to_owned(),
        _ => r#"Case(id: 1, when: "q11 < 0.5", value: 1)"#.to_owned(),
    };
    let start = std::time::Instant::now();
    let codes = codes_of(&extra, case, 2);
    assert!(codes.contains(&"U0516"), "{codes:?}");
    // It took a minute; a second is usual, and other tests run beside this one.
    assert!(start.elapsed() < std::time::Duration::from_secs(30), "{:?}", start.elapsed());
}
