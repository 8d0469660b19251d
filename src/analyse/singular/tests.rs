//! What is found in formulas as they are printed.

use crate::analyse::found;

fn check(inputs: &str, value: &str) -> Vec<String> {
    let inputs: Vec<String> = inputs
        .split_whitespace()
        .map(|input| {
            let (name, range) = input.split_once(':').expect("name:from..to");
            let (from, to) = range.split_once("..").expect("from..to");
            format!(r#""{name}": Range(from: {from}, to: {to})"#)
        })
        .collect();
    found(&format!(
        r#"Table(language: 1, name: "f", hit_policy: First, inputs: {{{}}}, output: Number(),
            cases: [Case(id: 1, when: "true", value: "{value}")], default: 0)"#,
        inputs.join(", ")
    ))
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
    assert_eq!(
        check(CELL, c4),
        [
            "U0551 `f` divides by zero at `s = -1`, where its value is finite",
            "U0551 `f` divides by zero at `s = 1`, where its value is finite",
        ]
    );
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
            "U0551 `f` divides by zero at `b - a = 0`, where its value is finite",
            "U0551 `f` divides by zero at `lambda = 0`, where its value is finite",
            "U0554 `f` overflows on the way to a value that is finite",
        ]
    );
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
