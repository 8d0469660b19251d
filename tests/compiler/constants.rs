//! Constants of a program: whatever they arise from, shaders can contain them.

use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use umbrage::diag::{Failure, Source};
use umbrage::emit;
use umbrage::plan::{Plan, Shape};
use umbrage::program::{BinaryOp, Cond, ExprId, Node, Program};
use umbrage::prove::is_unsuitable;
use umbrage::table::Table;

/// Numbers near the ends of `f32`, and numbers that differ, or are not zero, in `f64` only.
const EXTREMES: &[&str] = &[
    "0",
    "1",
    "-1",
    "0.5",
    "3",
    "0.1",
    "0.1000000001",
    "16777217",
    "1e19",
    "1e30",
    "-1e30",
    "1e38",
    "3.4e38",
    "3.5e38",
    "1e200",
    "1e308",
    "1e-19",
    "1e-30",
    "1e-38",
    "1e-45",
    "-1e-45",
    "1e-46",
    "1e-200",
];

fn constant() -> impl Strategy<Value = String> {
    let extreme = prop::sample::select(EXTREMES);
    let modest = prop::sample::select(&["0.5", "3", "0.1", "-2", "1"][..]);
    prop_oneof![1 => extreme, 2 => modest].prop_map(str::to_owned)
}

/// A number that may stand somewhere, or now and then any.
fn declared(usual: &'static str) -> impl Strategy<Value = String> {
    prop_oneof![7 => Just(usual.to_owned()), 1 => constant()]
}

/// An expression over constants and two inputs, with every way in which a table makes constants.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![5 => constant(), 1 => Just("x".to_owned()), 1 => Just("y".to_owned()), 1 => Just("f32(e)".to_owned())];
    leaf.prop_recursive(3, 16, 4, |inner| {
        let symbol = prop::sample::select(&["+", "-", "*", "/", "%"][..]);
        let one =
            prop::sample::select(&["sqrt", "exp", "log", "inverseSqrt", "abs", "degrees", "inv", "part", "tan"][..]);
        let two = prop::sample::select(&["min", "max", "pow", "atan2", "step"][..]);
        let three = prop::sample::select(&["clamp", "fma", "mix", "smoothstep"][..]);
        let parts = || prop::collection::vec(inner.clone(), 6);
        let vectors = prop::sample::select(
            &[
                "length(vec3(a, b, c))",
                "dot(vec3(a, b, c), vec3(d, e, f))",
                "distance(vec2(a, b), vec2(c, d))",
                "normalize(vec3(a, b, c)).y",
                "cross(vec3(a, b, c), vec3(d, e, f)).x",
                "(vec2(a, b) / vec2(c, d)).y",
                "poly(a, [b, c, d])",
                "poly(a, list)",
                "sum(i in 0 .. 3, a * i + b)",
                "sum(i in list, a / i)",
                "(t * a / b | t = c .. d)",
                "(if a < b { c } else { d })",
                "select(a, b, c == d)",
            ][..],
        );
        prop_oneof![
            3 => (inner.clone(), symbol, inner.clone()).prop_map(|(a, op, b)| format!("({a} {op} {b})")),
            1 => (one, inner.clone()).prop_map(|(f, a)| format!("{f}({a})")),
            1 => (two, inner.clone(), inner.clone()).prop_map(|(f, a, b)| format!("{f}({a}, {b})")),
            2 => (three, parts()).prop_map(|(f, p)| format!("{f}({}, {}, {})", p[0], p[1], p[2])),
            5 => (vectors, parts()).prop_map(|(form, p)| fill(form, &p)),
        ]
    })
}

/// A form with its single letters from `a` to `f` replaced.
fn fill(form: &str, parts: &[String]) -> String {
    let letters: Vec<char> = form.chars().collect();
    let alone = |at: usize| {
        let is_part = |c: Option<&char>| c.is_some_and(|c| c.is_ascii_alphanumeric());
        !is_part(at.checked_sub(1).and_then(|before| letters.get(before))) && !is_part(letters.get(at + 1))
    };
    let text = letters.iter().enumerate().map(|(at, letter)| match letter {
        'a'..='f' if alone(at) => parts[*letter as usize - 'a' as usize].clone(),
        other => other.to_string(),
    });
    text.collect()
}

/// A table with a value, a condition, and constants wherever else there are any.
fn table() -> impl Strategy<Value = String> {
    let bounds = (declared("-1e30"), declared("1e30"), declared("2"), declared("0.5"), declared("-3"));
    (expression(), expression(), bounds).prop_map(|(value, other, n)| {
        let calls = [&value, &other].iter().any(|text| text.contains("inv(") || text.contains("part("));
        let helpers =
            if calls { r#""inv(a)": "1 / (1 - a)", "part(a)": [("1", "abs(a) < 0.5"), "a * a / a"]"# } else { "" };
        format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
    inputs: {{"x": Range(from: -1e30, to: 1e30), "y": Range(from: {}, to: {}),
              "e": Levels(values: {{"one": 1, "other": {}}})}},
    constants: {{"list": [1, "{}"]}},
    helpers: {{{helpers}}},
    output: Number(clamp: ({}, 1e38)),
    cases: [Case(id: 1, when: "{other} < x", value: "{value}")],
    default: 0)"#,
            n.0, n.1, n.2, n.3, n.4
        )
    })
}

fn check(text: &str) -> Result<Program, Failure> {
    Table::parse(Source::new("t.ron", text)).and_then(|table| Program::check(&table))
}

/// Every expression that the program is made of.
fn reached(program: &Program) -> Vec<ExprId> {
    let pool = &program.pool;
    let mut open: Vec<ExprId> = program.default.clone();
    let mut conditions = Vec::new();
    for row in &program.rows {
        conditions.push(row.guard);
        for line in &row.lines {
            conditions.push(line.condition);
            open.extend(&line.values);
        }
    }
    let (mut seen, mut asked) = (std::collections::HashSet::new(), std::collections::HashSet::new());
    loop {
        if let Some(condition) = conditions.pop() {
            if asked.insert(condition) {
                let cond: &Cond = pool.cond(condition);
                open.extend(cond.compared());
                conditions.extend(cond.children());
            }
        } else if let Some(expr) = open.pop() {
            if seen.insert(expr) {
                open.extend(pool.node(expr).children());
                conditions.extend(pool.node(expr).condition());
            }
        } else {
            return seen.into_iter().collect();
        }
    }
}

/// Judges a table with constants from everywhere: it is refused, each time at a place, or shaders can have what it says.
fn judge(text: &str) -> Result<bool, TestCaseError> {
    let program = match check(text) {
        Ok(program) => program,
        Err(failure) => {
            for error in &failure.diagnostics {
                let place = error.labels.first().map(|label| label.span);
                prop_assert!(place.is_some_and(|span| span.end > span.start), "no place: {failure}");
            }
            return Ok(false);
        }
    };
    for expr in reached(&program) {
        let finite = program.pool.constant(expr).is_none_or(|value| (value as f32).is_finite());
        prop_assert!(finite, "{:?}\n{text}", program.pool.node(expr));
        if let Node::Binary(BinaryOp::Divide | BinaryOp::Remainder, _, divisor) = program.pool.node(expr) {
            let zero = program.pool.constant(divisor).is_some_and(|value| value as f32 == 0.0);
            // A function may divide by what is zero only because of how it is called.
            let called = text.contains("inv(") || text.contains("part(");
            prop_assert!(!zero || called, "a division by zero\n{text}");
        }
    }
    for shape in [Shape::Ladder, Shape::Switch] {
        match Plan::proved(&program, shape) {
            Ok(proved) => {
                let result = emit::emit(&proved, emit::Target::Wgsl);
                prop_assert!(result.is_ok(), "{}\n{text}", result.err().map_or(String::new(), |f| f.to_string()));
            }
            Err(failure) => prop_assert!(is_unsuitable(&failure), "{failure}\n{text}"),
        }
    }
    Ok(true)
}

/// Extreme constants in every position: the table is refused at a place, or shaders can have all that is left of it.
#[test]
fn constants_are_finite_or_refused_with_a_place() {
    let config = ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() };
    let accepted = std::cell::Cell::new(0);
    let result = TestRunner::new(config).run(&table(), |text| {
        accepted.set(accepted.get() + usize::from(judge(&text)?));
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(accepted.get() > 100, "only {} tables had a meaning", accepted.get());
}
