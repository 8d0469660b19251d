//! Integrals by Gauss-Legendre sums, as text: the densities, the rules, and up
//! to where each rule is good.
//!
//! Of a wave that turns by S over half an interval, the rule with n nodes
//! leaves out at most
//!
//! ```text
//!   2^(2n) n!^4 / ((2n + 1) (2n)!^3)  S^2n
//! ```
//!
//! of its amplitude times the length. Where the amplitude itself vanishes, in
//! the middle of an interval between two sides that touch, its slope counts:
//! 2n/S more, by Leibniz' rule. A rule is used where this is below 2^-24; beyond
//! the last one the closed form stays, whose terms are then no longer thin.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::kernel::SINC;
use super::names::Taken;
use super::poly::{Atom, Mono, Poly};
use super::print::Printer;
use super::read::Bounds;
use super::sides::{Density, Names};
use crate::program::rational::Rational;

/// Numbers of nodes.
const RULES: [usize; 3] = [4, 8, 16];

/// The part that may be left out, relative to the amplitude.
const LEFT_OUT: f64 = 1.0 / 16_777_216.0;

/// Names of the lists of nodes and weights, one for each rule.
pub(super) fn rules(taken: &mut Taken) -> [String; 3] {
    RULES.map(|count| taken.free_everywhere(&[&format!("gauss_{count}"), &format!("gauss_rule_{count}")]))
}

/// Nodes and weights on [-1, 1], by Newton's method on the Legendre polynomial.
fn rule(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |i: usize| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        for _ in 0..50 {
            let (mut last, mut here) = (1.0, x);
            for j in 2..=count {
                let j = j as f64;
                (last, here) = (here, ((2.0 * j - 1.0) * x * here - (j - 1.0) * last) / j);
            }
            slope = n * (x * here - last) / (x * x - 1.0);
            x -= here / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    // One half is computed, the other is its image.
    let half: Vec<(f64, f64)> = (0..count / 2).map(node).collect();
    let image = half.iter().rev().map(|(x, weight)| (-x, *weight));
    half.iter().copied().chain(image).collect()
}

/// Bound of what a rule leaves out of a wave that turns by `turn` over half the interval.
fn left_out(count: usize, turn: f64) -> f64 {
    let n = count as f64;
    // 4^n n!^4 / (2n)!^3 factor by factor, with two of `turn` for each.
    let product: f64 = (1..=count)
        .map(|j| {
            let j = j as f64;
            let grown = (2.0 * j) * (2.0 * j - 1.0);
            4.0 * j.powi(4) * turn * turn / grown.powi(3)
        })
        .product();
    product / (2.0 * n + 1.0) * (1.0 + 2.0 * n / turn)
}

/// Up to which turn a rule is good, to two digits.
fn good_to(count: usize) -> f64 {
    let steps = (1..400).map(|step| f64::from(step) * 0.05);
    let good = steps.take_while(|turn| left_out(count, *turn) <= LEFT_OUT).last().unwrap_or(0.0);
    (good * 100.0).round() / 100.0
}

/// The rules as constants of a table.
pub(super) fn constants(rules: &[String; 3], indent: &str) -> String {
    let mut text = String::new();
    for (count, name) in RULES.into_iter().zip(rules) {
        let _ = writeln!(
            text,
            "{indent}// Nodes and weights of the Gauss-Legendre rule with {count} nodes: off by at most 2^-24 of the\n\
             {indent}// amplitude of what turns by up to {} over half the interval.",
            good_to(count)
        );
        let nodes: Vec<String> = rule(count).iter().map(|(x, weight)| format!("({x}, {weight})")).collect();
        let lines: Vec<String> = nodes.chunks(2).map(|two| two.join(", ")).collect();
        let _ = writeln!(text, "{indent}\"{name}\": [{}],", lines.join(&format!(",\n{indent}    ")));
    }
    text
}

/// A density as a helper of the table, with its name in front: its declaration, and how to call it.
pub(super) fn helper(name: &str, density: &Density, names: &Names, sinc: &str, indent: &str) -> String {
    let printer = Printer { group_by: &[], sinc };
    format!(
        "{indent}// What is integrated: the sides are {sum} + {difference} and {sum} - {difference}.\n\
         {indent}\"{name}({variables})\": \"\n\
         {indent}    let {sum} = {half_sum};\n\
         {indent}    let {difference} = {half_difference};\n\
         {indent}    {value}\",\n",
        sum = names.sum,
        difference = names.difference,
        variables = parameters(density, names).join(", "),
        half_sum = printer.sum(&density.sum),
        half_difference = printer.sum(&density.difference),
        value = printer.sum(&density.value),
    )
}

/// The parameters of a density, its variable first.
fn parameters(density: &Density, names: &Names) -> Vec<String> {
    let mut all = vec![names.variable.clone()];
    for sum in [&density.sum, &density.difference, &density.value] {
        sum.variables(&mut all);
    }
    all.retain(|name| *name != names.sum && *name != names.difference);
    all
}

/// The names of the parts of an integral.
pub(super) struct Called<'a> {
    /// The density.
    pub(super) helper: &'a str,
    /// The name of the turn over half the interval.
    pub(super) turn: &'a str,
    /// A node and its weight.
    pub(super) node: &'a str,
    /// The lists of nodes and weights.
    pub(super) rules: &'a [String; 3],
}

/// The integral by the rule that is good enough, or by `closed` where none is.
pub(super) fn integral(
    called: &Called<'_>,
    density: &Density,
    names: &Names,
    bounds: &Bounds,
    closed: &str,
) -> (String, String) {
    let Called { helper, turn, node, rules } = called;
    let Bounds { mid, half, .. } = bounds;
    let turns = format!("let {turn} = abs({half}) * {};", speed(&density.speed));
    let mut text = String::new();
    for (count, rule) in RULES.into_iter().zip(*rules) {
        let _ = write!(
            text,
            "if {turn} < {} {{ {half} * sum({node} in {rule}, {node}.y * {helper}({} = {mid} + {half} * {node}.x)) }} else ",
            good_to(count),
            names.variable,
        );
    }
    let _ = write!(text, "{{ {closed} }}");
    (turns, text)
}

/// An upper bound of how fast anything turns, as a factor.
fn speed(speed: &BTreeMap<Mono, Rational>) -> String {
    let mut sum = Poly::default();
    for (factors, by) in speed {
        let sized = factors.iter().map(|(atom, power)| match atom {
            Atom::Var(name) => (Atom::Fun("abs".to_owned(), vec![Poly::var(name)]), *power),
            other => (other.clone(), *power),
        });
        let _ = sum.add_term(sized.collect(), *by);
    }
    let text = Printer { group_by: &[], sinc: SINC }.sum(&sum);
    if sum.0.len() > 1 { format!("({text})") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_integrate_waves_as_well_as_they_say() {
        for count in RULES {
            let nodes = rule(count);
            let power = |p: i32| nodes.iter().map(|(x, weight)| weight * x.powi(p)).sum::<f64>();
            for p in 0..2 * count as i32 {
                let exact = if p % 2 == 0 { 2.0 / f64::from(p + 1) } else { 0.0 };
                assert!((power(p) - exact).abs() < 1e-14, "{count} {p}");
            }
            for tenths in 1..=10 {
                let turn = good_to(count) * f64::from(tenths) / 10.0;
                let sum: f64 = nodes.iter().map(|(x, weight)| weight * libm::cos(turn * x)).sum();
                let error = (sum - 2.0 * libm::sin(turn) / turn).abs() / 2.0;
                assert!(error <= left_out(count, turn) + 1e-15 && error <= LEFT_OUT, "{count} {turn} {error:e}");
            }
        }
        assert!(good_to(4) > 0.5 && good_to(8) > 3.5 && good_to(16) > 12.0);
    }
}
