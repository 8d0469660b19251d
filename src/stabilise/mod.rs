//! Tables whose formulas divide by zero, rewritten so that they do not.
//!
//! The rules know three patterns in which closed forms of integrals lose their
//! digits:
//!
//! - *differences of antiderivatives*, `F | x = lo .. hi` with sines and cosines
//!   in F: `between` writes them as products in which the divisor is gone;
//! - *quotients that are functions of one quantity*, such as sinh(y)/y: `kernel`
//!   collects them and gives them a series near zero. An exponential in front of
//!   sinh and cosh takes their growth first, so that nothing overflows;
//! - *an upper side minus a lower one*, spread over several such differences:
//!   `integrand` finds what is integrated, `sides` writes it as a product,
//!   `gauss` integrates it by as many nodes as it takes.
//!
//! All work on sums of products (`poly`), in which equal terms cancel exactly.
//! A function that no pattern fits stays as it is written; it gains from the
//! functions it calls. What was reached the certificate says.

mod between;
mod certify;
mod edit;
mod gauss;
mod integrand;
mod kernel;
mod poly;
mod print;
mod read;
mod series;
mod sides;
#[cfg(test)]
mod tests;
mod trig;

use std::collections::BTreeSet;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::program::rational::Rational;
use crate::table::{Function, FunctionBody, Table};
use kernel::{Argument, Kernels};
use poly::{Atom, Mono, Poly, multiply};
use print::Printer;
use read::{Bounds, Reader};
use sides::{Density, Names};

pub use certify::{Certificate, Measured};

/// A table with a form that can be computed.
#[derive(Debug)]
pub struct Stabilised {
    /// Its text.
    pub text: String,
    /// The outcome of each function, in the order written.
    pub functions: Vec<(String, Outcome)>,
    /// Names of the functions of one variable that were added.
    pub kernels: Vec<String>,
}

/// The outcome of a function.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// It has a new formula.
    Rewritten,
    /// It integrates a product instead of subtracting integrals.
    Integrated,
    /// It neither divides nor takes a difference between bounds.
    AsWritten,
    /// No rule applies, for this reason.
    Left(String),
}

/// Rewrites the functions of a table.
///
/// # Errors
/// If the table has no functions, or if what was written is not a table again.
///
/// ```
/// use umbrage::stabilise::stabilise;
/// use umbrage::table::Table;
///
/// let printed = Table::read("tables/double_product_printed.ron")?;
/// let stable = stabilise(&printed)?;
/// assert!(stable.text.contains("functions: {"));
/// assert_eq!(stable.functions.len(), printed.functions.len());
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn stabilise(table: &Table) -> Result<Stabilised, Failure> {
    if table.functions.is_empty() {
        let error = Diagnostic::error(codes::NO_FUNCTIONS, "the table has no functions to stabilise")
            .at(table.name.span, "this table")
            .help("`stabilise` rewrites formulas of functions; `umbrage check` finds singularities of cases");
        return Err(Failure { source: table.source.clone(), diagnostics: vec![error] });
    }
    let sides = Sides::of(table);
    let mut added = Added::default();
    let mut values = Vec::new();
    let mut functions = Vec::new();
    for function in &table.functions {
        let outcome = match closed_form(table, function, &mut added.kernels) {
            Err(reason) => Outcome::Left(reason),
            Ok(closed) => {
                let integral = if sides.take(function) { integral(table, function, &closed, &mut added) } else { None };
                match (integral, closed) {
                    (Some(integral), _) => {
                        values.push((function, integral.text()));
                        Outcome::Integrated
                    }
                    (None, Some(closed)) => {
                        values.push((function, closed.text()));
                        Outcome::Rewritten
                    }
                    (None, None) => Outcome::AsWritten,
                }
            }
        };
        functions.push((function.name.value.clone(), outcome));
    }
    let text = edit::apply(table, &values, &added);
    // What is written must mean something; an error here is a defect of the rules.
    Table::parse(Source::new(format!("{} (stabilised)", table.source.name), text.clone()))?;
    Ok(Stabilised { text, functions, kernels: added.kernels.0.into_iter().map(|kernel| kernel.name).collect() })
}

/// The additions to the new table besides new formulas.
#[derive(Debug, Default)]
struct Added {
    kernels: Kernels,
    /// Densities, as text.
    densities: Vec<String>,
}

/// A formula as text.
#[derive(Debug)]
struct Formula {
    lets: Vec<String>,
    value: String,
}

impl Formula {
    fn text(&self) -> String {
        let parts = self.lets.iter().map(String::as_str).chain([self.value.as_str()]);
        parts.collect::<Vec<_>>().join(" ")
    }
}

/// The functions that subtract one side from another.
struct Sides<'t> {
    table: &'t Table,
    subtract: BTreeSet<&'t str>,
}

impl<'t> Sides<'t> {
    fn of(table: &'t Table) -> Self {
        let subtracts = |f: &&Function| density(table, f, &mut Kernels::default()).is_some();
        Self { table, subtract: table.functions.iter().filter(subtracts).map(|f| f.name.value.as_str()).collect() }
    }

    /// Returns whether a function is the innermost one that does: what calls it gains from it.
    fn take(&self, function: &Function) -> bool {
        self.subtract.contains(function.name.value.as_str()) && !self.inside(function)
    }

    fn inside(&self, function: &Function) -> bool {
        let called = |name: &str| self.table.functions.iter().find(|f| f.name.value == name);
        integrand::callees(self.table, function)
            .into_iter()
            .any(|name| self.subtract.contains(name) || called(name).is_some_and(|callee| self.inside(callee)))
    }
}

/// The integrand of a function that is one side less another.
fn density(table: &Table, function: &Function, kernels: &mut Kernels) -> Option<(Density, Names, Bounds)> {
    let names = Names {
        variable: free(table, &["x", "at", "along"]),
        sum: free(table, &["sigma", "half_sum", "sum_of_sides"]),
        difference: free(table, &["delta", "half_difference", "difference_of_sides"]),
    };
    let mut reader = Reader::new(table);
    let (f, bounds) = integrand::integrand(&mut reader, function, &names.variable).ok()?;
    let density = sides::density(&f, &names, kernels)?;
    Some((density, names, reader.bounds.swap_remove(bounds)))
}

/// The first of these names that the table does not use; the last one at worst.
fn free(table: &Table, names: &[&str]) -> String {
    let known = |name: &str| {
        table.inputs.iter().any(|i| i.name.value == name)
            || table.names.iter().any(|n| n.name.value == name)
            || table.constants.iter().any(|c| c.name.value == name)
            || table.helpers.iter().any(|h| h.name.value == name)
            || table.functions.iter().any(|f| f.name.value == name)
    };
    let found = names.iter().find(|name| !known(name)).or(names.last());
    found.map_or_else(String::new, |name| (*name).to_owned())
}

/// A function as an integral of a product, by `closed` or as it is written where no rule is good enough.
fn integral(table: &Table, function: &Function, closed: &Option<Formula>, added: &mut Added) -> Option<Formula> {
    let (density, names, bounds) = density(table, function, &mut added.kernels)?;
    let FunctionBody::Value(written) = &function.body else { return None };
    let name = &function.name.value;
    let helper = free(table, &[&format!("{name}_density"), &format!("{name}_of_sides"), &format!("{name}_integrand")]);
    let (turn, node) = (free(table, &["turn", "turns", "turned"]), free(table, &["n", "node", "gauss_node"]));
    let as_written = match closed {
        Some(closed) => closed.value.clone(),
        // A formula with names of its own keeps them.
        None if function.bindings.is_empty() => {
            let text = &table.source.text[written.span.start..written.span.end];
            text.trim_matches('"').split_whitespace().collect::<Vec<_>>().join(" ")
        }
        None => return None,
    };
    added.densities.push(gauss::helper(&helper, &density, &names, "        "));
    let (turns, value) = gauss::integral(&helper, &density, &names, &bounds, &as_written, (&turn, &node));
    let mut lets = bounds.text()?;
    let others = closed.iter().flat_map(|closed| &closed.lets).filter(|l| !lets.contains(l));
    let others: Vec<String> = others.cloned().collect();
    lets.extend(others);
    lets.push(turns);
    Some(Formula { lets, value })
}

impl Bounds {
    /// Mean and half difference, by their names.
    fn text(&self) -> Option<Vec<String>> {
        let half = Poly::number(Rational::HALF);
        let (mean, reach) = (self.lo.plus(&self.hi)?.times(&half)?, self.hi.minus(&self.lo)?.times(&half)?);
        let printer = Printer { group_by: &[self.mid.clone(), self.half.clone()] };
        let text = |(name, value): (&String, Poly)| format!("let {name} = {};", printer.sum(&value));
        Some([(&self.mid, mean), (&self.half, reach)].map(text).to_vec())
    }
}

/// The new formula of a function in closed form, if it needs one.
fn closed_form(table: &Table, function: &Function, kernels: &mut Kernels) -> Result<Option<Formula>, String> {
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
    let mut all: Vec<String> = Vec::new();
    for bounds in &reader.bounds {
        let names = [&bounds.mid, &bounds.half];
        let used = |name: &str| sum.mentions(name) || lets.iter().any(|l| l.contains(name));
        let texts = bounds.text().ok_or_else(too_large)?;
        all.extend(names.into_iter().zip(texts).filter(|(name, _)| used(name)).map(|(_, text)| text));
    }
    all.extend(lets);
    match sum.0.keys().any(|mono| mono.iter().any(|(atom, power)| divides(atom, *power))) {
        true => Err("a division is left that no rule removes".to_owned()),
        false => Ok(Some(Formula { lets: all, value: printer.sum(&sum) })),
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
        let fallen = Poly::fun("exp", y.times_number(Rational::whole(-2))?).times_number(Rational::whole(sign))?;
        let product = grown.times(&Poly::whole(1).plus(&fallen)?)?.times_number(factor.times(Rational::HALF)?)?;
        result = result.plus(&Poly([(rest, Rational::ONE)].into()).times(&product)?)?;
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
                let half = -Rational::HALF;
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
