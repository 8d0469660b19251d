//! Tables that lowering accepts, and refusals of others.

use super::*;
use crate::diag::Source;
use crate::program::print::Printer;

/// A table with some inputs; `rest` are its other fields.
fn check(names: &str, rest: &str) -> std::result::Result<Program, Failure> {
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"a": Bool(), "H": Levels(values: {{"none": 0, "right": 0.25, "left": 0.5}}),
                      "x": Range(from: 0, to: 1), "n": Int(from: 0, to: 3)}},
            names: {{{names}}}, default: 0, {rest})"#
    );
    Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table))
}

fn first_error(result: std::result::Result<Program, Failure>) -> String {
    result.map_or_else(|f| f.diagnostics[0].message.clone(), |_| "none".to_owned())
}

const PLAIN: &str = r#"output: Number(), cases: [Case(id: 1, when: "a", value: "x")]"#;

#[test]
fn chains_of_names_do_not_overflow_the_stack() {
    let forms = [
        "N",
        "-N",
        "N + 1",
        "min(N, 1)",
        "mix(0, 1, N)",
        "if a { N } else { 1 }",
        "select(1, N, a)",
        "let q = N; q",
        "f32(N < 1)",
        "f32((if N < 1 { H } else { left }) == H)",
        "vec3(N).x",
        "f32(H in {left} && !(N == 1))",
    ];
    for form in forms {
        let links: String =
            (0..2_000).map(|i| format!("\"n{i}\": \"{}\",\n", form.replace('N', &format!("n{}", i + 1)))).collect();
        let found = first_error(check(&format!("{links} \"n2000\": \"x\""), PLAIN));
        assert_eq!(found, "names and references are nested too deeply", "{form}");
    }
}

#[test]
fn shared_names_cost_no_exponential_time() {
    let doubling = |first: &str, next: fn(usize) -> String| {
        let rest: String = (0..30).map(|i| format!(", \"n{}\": \"{}\"", i + 1, next(i))).collect();
        format!("\"n0\": \"{first}\"{rest}")
    };
    // Levels that share parts.
    let names = doubling("if a { H } else { left }", |i| format!("if x < 0.{i}1 {{ n{i} }} else {{ n{i} }}"));
    let rest = r#"output: Number(), cases: [Case(id: 1, when: "n30 == left", value: "x")]"#;
    assert_eq!(first_error(check(&names, rest)), "none");
    // Names that are lowered again for a reference.
    let names = doubling("x < 0.5", |i| format!("n{i} && n{i}"));
    let rest = r#"output: Number(), cases: [
        Case(id: 1, when: "a", value: "case(2, x = 0.25)"), Case(id: 2, when: "n30", lines: [(1, "n30")])]"#;
    assert_eq!(first_error(check(&names, rest)), "none");
    // Vectors are bounded like numbers.
    let names = doubling("vec2(x, x)", |i| format!("n{i} * n{i}"));
    assert_eq!(first_error(check(&names, PLAIN)), "the value is too large once names and references are written out");
}

#[test]
fn levels_are_named_by_code_as_well() {
    let symmetric = r#"output: Number(), symmetries: {"m": Symmetry(map: {"H": {0.5: 0.25, "right": "left"}})},
        cases: [Case(id: 1, when: {"H": 0.5}, value: 1), Case(id: 2, is: (case: 1, under: "m"))]"#;
    let program = check("", symmetric).unwrap_or_else(|e| panic!("{e}"));
    let printer = Printer { pool: &program.pool, inputs: &program.inputs };
    assert_eq!(printer.cond(program.rows[1].guard), "H == right");

    let named = r#"output: List(of: "n", max: 2), cases: [Case(id: 1, when: "a", value: "[0, n]")]"#;
    let failure = check("", named).expect_err("the default is a number");
    assert_eq!(failure.diagnostics.len(), 1, "{failure}");
}

#[test]
fn a_bare_level_takes_its_set_from_either_alternative() {
    let guard = |condition: &str| {
        let rest = format!("output: Number(), cases: [Case(id: 1, when: \"{condition}\", value: 1)]");
        let program = check("", &rest).unwrap_or_else(|e| panic!("{condition}: {e}"));
        Printer { pool: &program.pool, inputs: &program.inputs }.cond(program.rows[0].guard)
    };
    let same = [
        "(if a { left } else { H }) == right",
        "(if a { 0.5 } else { H }) == right",
        "(if a { 0.5 } else { H }) == 0.25",
        "right == (if a { left } else { H })",
        "select(H, left, a) == right",
        "(if a { if a { left } else { none } } else { H }) == right",
        "select(H, select(none, left, a), a) in {right}",
    ];
    for condition in &same[..5] {
        assert_eq!(guard(condition), guard(same[0]), "{condition}");
    }
    for condition in &same[5..] {
        guard(condition);
    }
    assert_eq!(guard("0.5 == H"), guard("H == left"));
    assert_eq!(guard("(if a { left } else { right }) == H"), guard("select(right, left, a) == H"));
    guard("f32(if a { left } else { H }) < 0.5");
    guard("(if a { 1 } else { x }) < 0.5");

    let with = |value: &str| {
        let rest = format!("output: Number(), cases: [Case(id: 1, when: \"a\", value: \"{value}\")]");
        first_error(check("", &rest))
    };
    assert_eq!(with("f32(if a { lft } else { H })"), "there is no level `lft`");
    assert_eq!(with("f32(if a { 7 } else { H })"), "there is no level `7`");
    assert_eq!(with("f32(if a { left } else { right })"), "`left` is not defined");
    assert_eq!(with("if a { left } else { x }"), "`left` is not defined");

    let text = |value: &str| {
        format!(
            r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"a": Bool(),
                "H": Levels(values: {{"none": 0, "left": 0.5}})}}, output: Enumeration(of: "H"),
                cases: [Case(id: 1, when: "a", value: "{value}")], default: "none")"#
        )
    };
    for value in ["select(left, none, a)", "select(H, 0.5, a)", "if a { select(none, H, a) } else { left }"] {
        let program = Table::parse(Source::new("t", text(value))).and_then(|table| Program::check(&table));
        assert!(program.is_ok(), "{value}: {}", first_error(program));
    }
}

#[test]
fn only_constants_as_written_are_held_against_a_range() {
    // Case 3 is never evaluated where `2 * x` leaves the range, though the image makes it a constant.
    let rest = r#"output: Number(), symmetries: {"m": Symmetry(map: {"x": "1"})}, cases: [
        Case(id: 1, when: "n == 0", value: "x"),
        Case(id: 2, when: "n == 1", value: "if x < 0.5 { case(1, x = 2 * x) } else { 0 }"),
        Case(id: 3, is: (case: 2, under: "m"))]"#;
    assert_eq!(first_error(check("", rest)), "none");
    assert_eq!(first_error(check("", &rest.replace("2 * x", "2 * 1"))), "2 is not in the range 0 to 1 of `x`");
}

#[test]
fn the_result_map_sees_the_replaced_inputs() {
    let rest = r#"output: Number(), symmetries: {"m": Symmetry(map: {"a": "!a"}, result: "value + x")}, cases: [
        Case(id: 1, when: "a", value: 1), Case(id: 2, is: (case: 1, under: "m")),
        Case(id: 3, when: "n == 1", value: "case(2, x = 0.5)")]"#;
    let program = check("", rest).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(program.pool.constant(program.rows[2].lines[0].values[0]), Some(1.5));
}

#[test]
fn extreme_declarations_are_refused() {
    let with = |input: &str| {
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"a": Bool(), "i": {input}}},
               output: Number(), cases: [Case(id: 1, when: "a", value: 1)], default: 0)"#
        );
        first_error(Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table)))
    };
    assert!(with("Int(from: -9223372036854775808, to: -9223372036854775807)").starts_with("an integer input"));
    assert_eq!(with(r#"Levels(values: {"p": inf, "q": 0})"#), "the code inf of `p` is not exact in f32");
    assert_eq!(with(r#"Levels(values: {"p": -0.0, "q": 0})"#), "`q` and `p` have the same code 0");
}

/// The deepest accepted nesting, and one beyond any bound.
#[test]
fn long_chains_of_names_are_refused_in_time() {
    let nested = format!("{}x{}", "if s { ".repeat(20), " } else { 0 }".repeat(20));
    let chain = |length: usize| -> String {
        (0..length).map(|i| format!("\"n{i}\": \"{}\",", nested.replace('x', &format!("n{}", i + 1)))).collect()
    };
    for (length, fits) in [(3, true), (1_000, false)] {
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Bool(), "x": Range(from: 0, to: 1)}},
                names: {{{} "n{length}": "x"}},
                output: Number(), cases: [Case(id: 1, when: "s", value: "n0")], default: 0)"#,
            chain(length)
        );
        let program = Table::parse(Source::new("t", text)).and_then(|table| Program::check(&table));
        assert_eq!(program.is_ok(), fits, "{:?}", program.err().map(|e| e.diagnostics[0].message.clone()));
    }
}

/// Functions, helpers and constants that use the next one twice, each with a term of its own kind as argument.
#[test]
fn calls_that_double_cost_no_exponential_time() {
    let check = |rest: String| {
        let text = format!(
            r#"Table(language: 1, name: "t", inputs: {{"x": Range(from: 0, to: 1), "b": Bool(),
                "H": Levels(values: {{"none": 0, "right": 1, "left": 2}})}}, {rest})"#
        );
        Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check_all(&table))
    };
    let chain = |last: &str, call: fn(usize) -> String| -> String {
        let helpers: String = (0..40).map(|i| format!("\"h{i}(a)\": \"{}\", ", call(i + 1))).collect();
        format!("helpers: {{{helpers} \"h40(a)\": \"{last}\"}}, ")
    };
    let value =
        |value: &str| format!("functions: {{\"f\": Function(parameters: [\"x\", \"b\", \"H\"], value: \"{value}\")}}");
    let forms = [
        (chain("a", |i| format!("h{i}(a) + h{i}(a)")), "h0(x)"),
        (chain("a", |i| format!("h{i}(a) * h{i}(a)")), "h0(vec2(x, 1)).y"),
        (chain("a", |i| format!("h{i}({{u: a.u, v: 1}}) + h{i}({{u: a.u, v: 1}})")), "h0({u: x, v: x}).v"),
        (chain("a", |i| format!("h{i}(a) || h{i}(!a)")), "f32(h0(b))"),
        // Equal levels that are made anew each time.
        (
            chain("f32(a)", |i| {
                format!("h{i}(if x9 {{ a }} else {{ a }}) + h{i}(if x9 {{ a }} else {{ a }})").replace("x9", "1 < 2")
            }),
            "h0(H)",
        ),
        (
            chain("f32(a)", |i| {
                format!("h{i}(if a == left {{ a }} else {{ a }}) + h{i}(if a == left {{ a }} else {{ a }})")
            }),
            "h0(H)",
        ),
    ];
    for (helpers, call) in forms {
        let result = check(helpers.clone() + &value(call));
        assert!(result.is_ok(), "{call}: {}\n{helpers}", result.err().map_or(String::new(), |f| f.to_string()));
    }
    let functions: String = (0..40)
        .map(|i| format!("\"q{i}\": Function(parameters: [\"x\"], value: \"q{0}(x) + q{0}(x)\"), ", i + 1))
        .collect();
    assert!(check(format!("functions: {{{functions} \"q40\": Function(parameters: [\"x\"], value: \"x\")}}")).is_ok());
    let constants: String = (1..60).map(|i| format!(", \"c{i}\": \"c{0} + c{0} - c{0}\"", i - 1)).collect();
    let constants = format!("constants: {{\"c0\": 1{constants}, \"nodes\": [\"c59\", \"c59 + c58\"]}}, ");
    let result = check(constants + &value("c59 * x + sum(n in nodes, n * x)"));
    assert!(result.is_ok(), "{}", result.err().map_or(String::new(), |f| f.to_string()));
    // What differs each time is refused where it gets too much.
    let result = check(chain("a", |i| format!("h{i}(2 * a) + h{i}(a + {i})")) + &value("h0(x)"));
    assert!(result.is_err_and(|failure| failure.to_string().contains("U0202")));
}

/// All coefficients that a polynomial may have, in the value of a case.
#[test]
fn a_polynomial_may_be_as_long_as_it_may() {
    let of = |count: usize| {
        let coefficients: Vec<String> = (1..=count).map(|i| format!("0.{i}")).collect();
        let value = format!("0.5 + 0.25 * poly(x * x + 1, [{}])", coefficients.join(", "));
        first_error(check("", &format!("output: Number(), cases: [Case(id: 1, when: \"a\", value: \"{value}\")]")))
    };
    assert_eq!((of(256), of(257)), ("none".to_owned(), "a polynomial of 257 terms".to_owned()));
}
