//! Printed formulas, and what becomes of them.

mod layouts;

use super::{Outcome, Stabilised, stabilise};
use crate::diag::Source;
use crate::table::Table;

const INTEGRALS: &str = r#"Table(
    language: 1,
    name: "f_printed",
    inputs: {
        "phi0": Range(from: 0, to: 1.5),
        "phi1": Range(from: 0, to: 3),
        "p": Range(from: -4, to: 4),
        "s": Range(from: -12, to: 12),
        "t": Range(from: -8, to: 8),
        "k": Range(from: -4, to: 4),
        "b": Range(from: -4, to: 4),
    },
    functions: {
        "c0": Function(parameters: ["phi0", "phi1"], value: "phi1 - phi0"),
        "c1": Function(parameters: ["phi0", "phi1", "p"], value: "-cos(phi + p) | phi = phi0 .. phi1"),
        "c2": Function(parameters: ["phi0", "phi1", "s", "t"], value: "sin(s * phi + t) / s | phi = phi0 .. phi1"),
        "c3": Function(parameters: ["phi0", "phi1", "p"],
            value: "sin(phi + p) - phi * cos(phi + p) | phi = phi0 .. phi1"),
        "c4": Function(parameters: ["phi0", "phi1", "p", "s", "t"],
            value: "0.5 * (sin((1 - s) * phi + p - t) / (1 - s) - sin((1 + s) * phi + p + t) / (1 + s)) | phi = phi0 .. phi1"),
        "a1": Function(parameters: ["phi0", "phi1", "k", "b"],
            value: "-(2 * (k * phi + b) + sin(2 * k * phi + 2 * b)) / (8 * k) | phi = phi0 .. phi1"),
        "b3": Function(parameters: ["phi0", "phi1", "k", "b"],
            value: "-(c2(s = 3 * k, t = 3 * b) + 3 * c2(s = k, t = b)) / 12"),
        "odd": Function(parameters: ["phi0", "s"], value: "tan(s * phi0) / s"),
    },
)
"#;

const GAUSSIAN: &str = r#"Table(
    language: 1,
    name: "g",
    inputs: {
        "mu": Range(from: 0, to: 2),
        "lambda": Range(from: 0, to: 1000),
        "a": Range(from: -1, to: 1),
        "b": Range(from: -1, to: 1),
    },
    helpers: {
        "c(mu, lambda, a, b)": "mu * exp(lambda * ((a + b) / 2 - 1))",
    },
    functions: {
        "r0": Function(parameters: ["mu", "lambda", "a", "b"], let: {"y": "lambda * (b - a) / 2"},
            value: "c(mu, lambda, a, b) * sinh(y) / y", domain: {"order": "a <= b"}),
        "r1": Function(parameters: ["mu", "lambda", "a", "b"], let: {"y": "lambda * (b - a) / 2"},
            value: "3 * c(mu, lambda, a, b) * (y * cosh(y) - sinh(y)) / (y * y)", domain: {"order": "a <= b"}),
        "alpha": Function(parameters: ["mu", "lambda", "a", "b"], value: "r0() - r1() * (a + b) / (b - a)",
            domain: {"order": "a <= b"}),
        "beta": Function(parameters: ["mu", "lambda", "a", "b"], value: "2 * r1() / (b - a)",
            domain: {"order": "a <= b"}),
    },
)
"#;

fn run(text: &str) -> (Table, Stabilised) {
    let table = Table::parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let stabilised = stabilise(&table).unwrap_or_else(|e| panic!("{e}"));
    (table, stabilised)
}

#[test]
fn differences_of_antiderivatives_become_products() {
    let (table, stabilised) = run(INTEGRALS);
    insta::assert_snapshot!("integrals", stabilised.text);
    let outcome = |name: &str| stabilised.functions.iter().find(|(n, _)| n == name).map(|(_, o)| o.clone());
    assert_eq!(outcome("c0"), Some(Outcome::AsWritten));
    assert_eq!(outcome("b3"), Some(Outcome::AsWritten));
    assert_eq!(outcome("c4"), Some(Outcome::Rewritten));
    assert_eq!(outcome("odd"), Some(Outcome::Left("a division is left that no rule removes".to_owned())));
    for certificate in stabilised.certify(&table).unwrap_or_else(|e| panic!("{e}")) {
        let after = &certificate.after;
        if certificate.name != "odd" {
            assert_eq!(after.not_finite, 0, "{certificate:?}");
            assert!(after.error < 2e-5, "{certificate:?}");
        }
        if certificate.name == "c4" {
            assert!(certificate.before.not_finite > 0 && certificate.before.error > 1e-2, "{certificate:?}");
        }
    }
}

/// A strip between a line and a constant side, in sines and with what is left of the angles themselves.
const SIDES: &str = r#"Table(
    language: 1,
    name: "strip_printed",
    exhibit: "as printed",
    inputs: {
        "phi0": Range(from: 0, to: 1.5),
        "phi1": Range(from: 0, to: 3),
        "theta0": Range(from: 0, to: 3.1),
        "k": Range(from: -4, to: 4),
        "b": Range(from: -4, to: 4),
        "p": Range(from: -4, to: 4),
        "s": Range(from: -12, to: 12),
        "t": Range(from: -8, to: 8),
    },
    functions: {
        "c0": Function(parameters: ["phi0", "phi1"], value: "phi | phi = phi0 .. phi1"),
        "c1": Function(parameters: ["phi0", "phi1", "p"], value: "-cos(phi + p) | phi = phi0 .. phi1"),
        "c2": Function(parameters: ["phi0", "phi1", "s", "t"], value: "sin(s * phi + t) / s | phi = phi0 .. phi1"),
        "c3": Function(parameters: ["phi0", "phi1", "p"],
            value: "sin(phi + p) - phi * cos(phi + p) | phi = phi0 .. phi1"),
        "c4": Function(parameters: ["phi0", "phi1", "p", "s", "t"],
            value: "0.5 * (sin((1 - s) * phi + p - t) / (1 - s) - sin((1 + s) * phi + p + t) / (1 + s)) | phi = phi0 .. phi1"),
        "area": Function(parameters: ["phi0", "phi1", "theta0", "k", "b"],
            error: (times: 4, scale: "abs(phi1 - phi0) * abs(0.5 * k * (phi0 + phi1) + b - theta0) + abs(k) * abs(phi1 - phi0) * abs(phi1 - phi0)"),
            value: "cos(theta0) * c0() - c2(s = k, t = b)"),
        "sector": Function(parameters: ["phi0", "phi1", "theta0", "k", "b", "p"],
            error: (times: 4, scale: "abs(phi1 - phi0) * abs(0.5 * k * (phi0 + phi1) + b - theta0) + abs(k) * abs(phi1 - phi0) * abs(phi1 - phi0)"),
            value: "(2 * k * c3() - c4(s = 2 * k, t = 2 * b) + (2 * b - 2 * theta0 + sin(2 * theta0)) * c1()) / 4"),
        "both": Function(parameters: ["phi0", "phi1", "theta0", "k", "b", "p"], value: "area() + sector()"),
        "same": Function(parameters: ["phi0", "phi1", "k", "b"], value: "c2(s = k, t = b) + c0()"),
    },
)
"#;

#[test]
fn differences_of_sides_become_products() {
    let (table, stabilised) = run(SIDES);
    insta::assert_snapshot!("sides", stabilised.text);
    let outcome = |name: &str| stabilised.functions.iter().find(|(n, _)| n == name).map(|(_, o)| o.clone());
    assert_eq!(outcome("area"), Some(Outcome::Integrated));
    assert_eq!(outcome("sector"), Some(Outcome::Integrated));
    // It gains from both, and nothing vanishes in the last one.
    assert_eq!(outcome("both"), Some(Outcome::AsWritten));
    assert_eq!(outcome("same"), Some(Outcome::AsWritten));
    for certificate in stabilised.certify(&table).unwrap_or_else(|e| panic!("{e}")) {
        if matches!(certificate.name.as_str(), "area" | "sector") {
            assert!(certificate.is_met(), "{certificate:?}");
            assert!(certificate.before.units > 1e3, "{certificate:?}");
        }
    }
}

#[test]
fn quotients_of_one_quantity_become_kernels() {
    let (table, stabilised) = run(GAUSSIAN);
    insta::assert_snapshot!("gaussian", stabilised.text);
    for certificate in stabilised.certify(&table).unwrap_or_else(|e| panic!("{e}")) {
        assert_eq!(certificate.after.not_finite, 0, "{certificate:?}");
        assert!(certificate.after.units < 8.0, "{certificate:?}");
        assert!(certificate.before.not_finite > 0, "{certificate:?}");
    }
}

#[test]
fn a_table_of_cases_is_refused() {
    let text = r#"Table(language: 1, name: "t", hit_policy: First, inputs: {"x": Range(from: 0, to: 1)},
        output: Number(), cases: [Case(id: 1, when: "true", value: "x")], default: 0)"#;
    let table = Table::parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let error = stabilise(&table).err().map(|e| e.diagnostics[0].message.clone());
    assert_eq!(error.as_deref(), Some("the table has no functions to stabilise"));
}
