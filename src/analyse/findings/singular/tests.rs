//! Findings in formulas as they are printed.

use crate::analyse::found;
use crate::analyse::sets::budget::{Budget, STEPS};

/// The singularities among the findings.
fn check(inputs: &str, value: &str) -> Vec<String> {
    let inputs: Vec<String> = inputs
        .split_whitespace()
        .map(|input| {
            let (name, range) = input.split_once(':').expect("name:from..to");
            let (from, to) = range.split_once("..").expect("from..to");
            format!(r#""{name}": Range(from: {from}, to: {to})"#)
        })
        .collect();
    let all = found(&format!(
        r#"Table(language: 1, name: "f", hit_policy: First, inputs: {{{}}}, output: Number(),
            cases: [Case(id: 1, when: "true", value: "{value}")], default: 0)"#,
        inputs.join(", ")
    ));
    all.into_iter().filter(|finding| finding.starts_with("U055")).collect()
}

const CELL: &str = "phi0:0..1.5 phi1:2..3 s:-12..12 t:-7..7";

#[test]
fn a_difference_of_antiderivatives() {
    assert_eq!(
        check(CELL, "sin(s * phi1 + t) / s - sin(s * phi0 + t) / s"),
        ["U0551 `f` divides by zero at `s = 0`, where its value is finite"]
    );
    let c4 = "0.5 * (sin((1 - s) * phi1 - t) / (1 - s) - sin((1 - s) * phi0 - t) / (1 - s)
        - sin((1 + s) * phi1 + t) / (1 + s) + sin((1 + s) * phi0 + t) / (1 + s))";
    assert_eq!(check(CELL, c4), ["U0551 `f` divides by zero at `s = -1`, `s = 1`, where its value is finite"]);
    // 2/3 is no `f32`, but its neighbour is a zero in `f32`.
    assert_eq!(
        check(CELL, "(sin((3 * s - 2) * phi1 + t) - sin((3 * s - 2) * phi0 + t)) / (3 * s - 2)"),
        ["U0551 `f` divides by zero at `s = 0.6666667`, where its value is finite"]
    );
}

#[test]
fn terms_that_cancel_on_paper() {
    let a1 = "-(2 * (s * phi1 + t) + sin(2 * s * phi1 + 2 * t)) / (8 * s)
        + (2 * (s * phi0 + t) + sin(2 * s * phi0 + 2 * t)) / (8 * s)";
    let a1 = format!("({a1}) - 0 * t");
    // Written as a difference of two quotients, as `F |` is.
    let difference = "(2 * (s * phi1 + t) + sin(2 * s * phi1 + 2 * t)) / (8 * s)
        - (2 * (s * phi0 + t) + sin(2 * s * phi0 + 2 * t)) / (8 * s)";
    assert_eq!(check(CELL, &a1).len(), 1, "a sum is not recognised");
    assert_eq!(
        check(CELL, difference),
        [
            "U0551 `f` divides by zero at `s = 0`, where its value is finite",
            "U0553 in `f` the term `2 * t / (8 * s)` cancels on paper only",
        ]
    );
}

#[test]
fn a_mean_of_exponentials() {
    let inputs = "mu:0..1 lambda:0..1000 a:-1..1 b:-1..1";
    let r0 = "mu * exp(lambda * ((a + b) / 2 - 1)) * sinh(lambda * (b - a) / 2) / (lambda * (b - a) / 2)";
    assert_eq!(
        check(inputs, r0),
        [
            "U0551 `f` divides by zero at `b - a = 0`, `lambda = 0`, where its value is finite",
            "U0554 `f` overflows on the way to a value that is finite",
        ]
    );
}

#[test]
fn what_is_declared_of_the_domain_counts() {
    let table = |from: f64| {
        format!(
            r#"Table(language: 1, name: "f", inputs: {{"k": Range(from: -4, to: 4), "b": Range(from: -8, to: 8)}},
                functions: {{"f": Function(parameters: ["k", "b"], value: "sin(3 * k - 2) / (3 * k - 2) + b",
                    domain: {{"sum": "k + b > {from} && k + b < 7.5"}})}})"#
        )
    };
    let found = |text: &str| {
        let table =
            crate::table::Table::parse(crate::diag::Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let programs = crate::program::Program::check_all(&table).unwrap_or_else(|e| panic!("{e}"));
        let places: Vec<String> = super::singularities(&programs[0]).into_iter().map(|s| s.place).collect();
        places
    };
    assert_eq!(found(&table(7.0)), ["`k = 0.6666667`"]);
    assert_eq!(found(&table(9.0)), [""; 0]);
}

#[test]
fn poles_and_what_guards_exclude() {
    assert_eq!(check("x:-1..1", "1 / x"), ["U0552 `f` divides by zero at `x = 0`, and has no limit there"]);
    assert_eq!(check("x:-1..1", "if abs(x) < 0.01 { 1 } else { sin(x) / x }"), [""; 0]);
    assert_eq!(check("x:1..2", "sin(x) / x"), [""; 0]);
    // Searched for, as the divisor is not affine.
    assert_eq!(
        check("x:0..2", "(exp(x) - 2) * 0.5 / (exp(x) - 2)"),
        ["U0551 `f` divides by zero at `exp(x) - 2 = 0`, where its value is finite"]
    );
}

fn programs(name: &str, text: &str) -> Vec<crate::program::Program> {
    crate::table::Table::parse(crate::diag::Source::new(name, text))
        .and_then(|table| crate::program::Program::check_all(&table))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// The places that the findings of a function with a code are about.
fn messages(programs: &[crate::program::Program], function: &str, code: crate::diag::Code) -> String {
    let named = |p: &&crate::program::Program| p.function.as_ref().is_some_and(|f| f.name == function);
    let program = programs.iter().find(named).expect("the table has this function");
    let found = super::findings(program, &Budget::new(STEPS)).into_iter().filter(|finding| finding.code == code);
    found.map(|finding| finding.message).collect::<Vec<_>>().join("\n")
}

#[test]
fn the_errata_of_the_printed_integrals_are_found() {
    use crate::diag::codes::{CANCELS, REMOVABLE};
    let printed = programs("printed.ron", include_str!("../../../../tables/double_product_printed.ron"));
    let expect = |function: &str, places: &[&str]| {
        let message = messages(&printed, function, REMOVABLE);
        for place in places {
            assert!(message.contains(place), "{function} {place}: {message}");
        }
        let count = message.matches('`').count() / 2 - 1 + usize::from(message.contains("every point"));
        assert_eq!(count, places.len(), "{message}");
    };
    let thirds = "`k = 0.33333334`";
    // E1 and E5, E2, E3, E4.
    expect("B0", &["every point", "`k = 0`", "`k = 0.6666667`", "`k = -0.6666667`", "`k = 2`", "`k = -2`"]);
    expect("A1", &["`k = 0`"]);
    expect("B3", &["`k = 0`"]);
    expect("A0", &["`k = 0.5`", "`k = -0.5`"]);
    for function in ["B1", "B2"] {
        expect(function, &["`k = 1`", "`k = -1`", thirds, "`k = -0.33333334`"]);
    }
    // E6
    let cancels = messages(&printed, "A1", CANCELS);
    assert_eq!(cancels, "in `A1` the term `-2 * b / (8 * k)` cancels on paper only");
    for fine in ["C0", "C1", "C3"] {
        expect_nothing(&printed, fine);
    }
}

fn expect_nothing(programs: &[crate::program::Program], function: &str) {
    assert_eq!(messages(programs, function, crate::diag::codes::REMOVABLE), "");
}

#[test]
fn the_errata_of_the_printed_gaussian_are_found() {
    use crate::diag::codes::{OVERFLOW, REMOVABLE};
    let printed = programs("printed.ron", include_str!("../../../../tables/spherical_gaussian_printed.ron"));
    // E7: 0/0 at two places, and an overflow on the way.
    for function in ["r0", "r1", "alpha", "beta"] {
        let message = messages(&printed, function, REMOVABLE);
        assert!(message.contains("`lambda = 0`") && message.contains(" = 0`"), "{function}: {message}");
        assert!(message.matches(" = 0`").count() == 2, "{function}: {message}");
        assert_ne!(messages(&printed, function, OVERFLOW), "", "{function}");
    }
}
