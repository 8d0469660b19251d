//! Tables whose formulas divide by zero, rewritten so that they do not.
//!
//! The rules know two patterns in which closed forms of integrals come to 0/0:
//!
//! - *differences of antiderivatives*, `F | x = lo .. hi` with sines and cosines
//!   in F: [`between`] writes them as products in which the divisor is gone;
//! - *quotients that are functions of one quantity*, such as sinh(y)/y: [`kernel`]
//!   collects them and gives them a series near zero. An exponential in front of
//!   sinh and cosh takes their growth first, so that nothing overflows.
//!
//! Both work on sums of products ([`poly`]), in which equal terms cancel exactly.
//! A function that neither divides nor takes a difference stays as it is
//! written; it gains from the functions it calls. What else makes a formula
//! inaccurate, above all differences between functions, no rule touches: the
//! certificate says what was reached.

mod between;
mod certify;
mod edit;
mod kernel;
mod poly;
mod print;
mod read;
mod series;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::program::normal::Rational;
use crate::table::Table;
use kernel::{Argument, Kernels};
use num_traits::One;
use poly::{Atom, Mono, Poly, multiply};
use print::Printer;
use read::Reader;

pub use certify::{Certificate, Measured};

/// A table with a form that can be computed.
#[derive(Debug)]
pub struct Stabilised {
    /// Its text.
    pub text: String,
    /// What became of each function, in the order written.
    pub functions: Vec<(String, Outcome)>,
    /// Names of the functions of one variable that were added.
    pub kernels: Vec<String>,
}

/// What became of a function.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It has a new formula.
    Rewritten,
    /// It neither divides nor takes a difference between bounds.
    AsWritten,
    /// No rule applies, for this reason.
    Left(String),
}

/// Rewrites the functions of a table.
///
/// # Errors
/// If the table has no functions, or if what was written is not a table again.
pub fn stabilise(table: &Table) -> Result<Stabilised, Failure> {
    if table.functions.is_empty() {
        let error = Diagnostic::error(codes::NO_FUNCTIONS, "the table has no functions to stabilise")
            .at(table.name.span, "this table")
            .help("`stabilise` rewrites formulas of functions; `umbrage check` finds singularities of cases");
        return Err(Failure { source: table.source.clone(), diagnostics: vec![error] });
    }
    let mut kernels = Kernels::default();
    let mut values = Vec::new();
    let mut functions = Vec::new();
    for function in &table.functions {
        let outcome = match value(table, function, &mut kernels) {
            Ok(Some(value)) => {
                values.push((function, value));
                Outcome::Rewritten
            }
            Ok(None) => Outcome::AsWritten,
            Err(reason) => Outcome::Left(reason),
        };
        functions.push((function.name.value.clone(), outcome));
    }
    let text = edit::apply(table, &values, &kernels);
    // What is written must mean something; an error here is a defect of the rules.
    Table::parse(Source::new(format!("{} (stabilised)", table.source.name), text.clone()))?;
    Ok(Stabilised { text, functions, kernels: kernels.0.into_iter().map(|kernel| kernel.name).collect() })
}

/// The new formula of a function, if it needs one.
fn value(table: &Table, function: &crate::table::Function, kernels: &mut Kernels) -> Result<Option<String>, String> {
    if !read::is_singular(table, function) {
        return Ok(None);
    }
    let mut reader = Reader::new(table);
    let sum = reader.function(function)?;
    let too_large = || "it becomes too large".to_owned();
    let mut sum = sum.reduced().and_then(|sum| tame(&sum)).ok_or_else(too_large)?;
    let mut lets = Vec::new();
    let group_by: Vec<String> = reader.bounds.iter().flat_map(|b| [b.mid.clone(), b.half.clone()]).collect();
    let printer = Printer { group_by: &group_by };
    for argument in arguments(&sum, table) {
        let rewritten = kernel::extract(&sum, &argument, kernels);
        if let Some(rewritten) = rewritten.filter(|rewritten| *rewritten != sum) {
            if argument.value != Poly::var(&argument.name) {
                lets.push(format!("let {} = {};", argument.name, printer.sum(&argument.value)));
            }
            sum = rewritten;
        }
    }
    if functions_of(&sum).iter().any(|(name, _)| name == "sinc") {
        kernels.sinc();
    }
    let used = |name: &str| sum.mentions(name);
    let mut all: Vec<String> = Vec::new();
    for bounds in &reader.bounds {
        let half = Poly::number(Rational::new(1, 2));
        let mean = bounds.lo.plus(&bounds.hi).and_then(|s| s.times(&half)).ok_or_else(too_large)?;
        let reach = bounds.hi.minus(&bounds.lo).and_then(|s| s.times(&half)).ok_or_else(too_large)?;
        for (name, value) in [(&bounds.mid, mean), (&bounds.half, reach)] {
            if used(name) || lets.iter().any(|l| l.contains(name.as_str())) {
                all.push(format!("let {name} = {};", printer.sum(&value)));
            }
        }
    }
    all.extend(lets);
    all.push(printer.sum(&sum));
    match sum.0.keys().any(|mono| mono.iter().any(|(atom, power)| divides(atom, *power))) {
        true => Err("a division is left that no rule removes".to_owned()),
        false => Ok(Some(all.join(" "))),
    }
}

fn divides(atom: &Atom, power: i32) -> bool {
    power < 0 || matches!(atom, Atom::Over(_))
}

/// `exp(e) sinh(y)` as `exp(e + y) (1 - exp(-2 y)) / 2`, and cosh likewise: no overflow for positive y.
fn tame(sum: &Poly) -> Option<Poly> {
    let mut result = Poly::default();
    for (mono, factor) in &sum.0 {
        let single = |name: &str| {
            mono.iter().find_map(|(atom, power)| match atom {
                Atom::Fun(known, arguments) if known == name && *power == 1 => {
                    Some((atom.clone(), arguments[0].clone()))
                }
                _ => None,
            })
        };
        let hyperbolic = single("sinh").map(|f| (f, -1)).or_else(|| single("cosh").map(|f| (f, 1)));
        let (Some((exp, exponent)), Some(((other, y), sign))) = (single("exp"), hyperbolic) else {
            result.add_term(mono.clone(), *factor)?;
            continue;
        };
        let rest = multiply(mono, &Mono::from([(exp, -1), (other, -1)]));
        let grown = Poly::fun("exp", exponent.plus(&y)?);
        let fallen = Poly::fun("exp", y.times_number((-2).into())?).times_number(sign.into())?;
        let product = grown.times(&Poly::whole(1).plus(&fallen)?)?.times_number(*factor / Rational::from_integer(2))?;
        result = result.plus(&Poly([(rest, Rational::one())].into()).times(&product)?)?;
    }
    Some(result)
}

/// Names and arguments of the functions of one variable in a sum.
fn functions_of(sum: &Poly) -> BTreeSet<(String, Poly)> {
    let mut all = BTreeSet::new();
    for atom in sum.0.keys().flat_map(|mono| mono.keys()) {
        if let Atom::Fun(name, arguments) = atom
            && let [argument] = arguments.as_slice()
        {
            all.insert((name.clone(), argument.clone()));
        }
    }
    all
}

/// The quantities that kernels may be functions of, each up to a factor.
fn arguments(sum: &Poly, table: &Table) -> Vec<Argument> {
    let reciprocals: BTreeSet<&Atom> =
        sum.0.keys().flat_map(|mono| mono.keys()).filter(|atom| matches!(atom, Atom::Over(_))).collect();
    let mut all: Vec<Argument> = Vec::new();
    for (name, argument) in functions_of(sum) {
        if !matches!(name.as_str(), "sin" | "cos" | "exp" | "sinh" | "cosh" | "sinc") {
            continue;
        }
        let Some((shared, _, rest)) = argument.content() else { continue };
        let (value, is_variable) = match (rest.constant(), shared.iter().next()) {
            (Some(_), Some((Atom::Var(variable), 1))) if shared.len() == 1 => (Poly::var(variable), true),
            (None, _) if reciprocals.contains(&Atom::Over(rest.clone())) => {
                // What falls like exp(-2 y) is a function of y.
                let half = Rational::new(-1, 2);
                let value = if name == "exp" { argument.times_number(half) } else { Some(argument) };
                let Some(value) = value else { continue };
                (value, false)
            }
            _ => continue,
        };
        if all.iter().any(|known| value.ratio(&known.value).is_some()) {
            continue;
        }
        let taken = |name: &str| {
            table.inputs.iter().any(|i| i.name.value == name)
                || table.names.iter().any(|n| n.name.value == name)
                || table.constants.iter().any(|c| c.name.value == name)
                || all.iter().any(|a| a.name == name)
        };
        let name = match (is_variable, value.single()) {
            (true, Some((mono, _))) => match mono.keys().next() {
                Some(Atom::Var(variable)) => variable.clone(),
                _ => continue,
            },
            _ => ["y", "u", "arg"].into_iter().find(|name| !taken(name)).unwrap_or("quantity").to_owned(),
        };
        all.push(Argument { value, name });
    }
    all
}
