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
mod names;
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
use crate::program::Program;
use crate::program::rational::Rational;
use crate::table::{Function, FunctionBody, Table};
use kernel::{Argument, Kernels, SINC};
use names::Taken;
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
    // Rules are for tables that mean something.
    Program::check_all(table)?;
    let mut added = Added::to(table);
    let (values, functions) = rewrite(table, &mut added);
    let text = edit::apply(table, &values, &added).ok_or_else(|| {
        let error = Diagnostic::error(codes::RON, "the text of the table cannot be taken apart");
        Failure::new(table.source.clone(), error.help("`umbrage fmt` writes it in the usual layout"))
    })?;
    // What is written must mean something; an error here is a defect of the rules.
    let stable = Table::parse(Source::new(format!("{} (stabilised)", table.source.name), text.clone()))?;
    Program::check_all(&stable)?;
    Ok(Stabilised { text, functions, kernels: added.kernels.all.into_iter().map(|kernel| kernel.name).collect() })
}

/// The new values of functions, and the outcome of each.
type Rewritten<'t> = (Vec<(&'t Function, String)>, Vec<(String, Outcome)>);

/// Finds new values.
fn rewrite<'t>(table: &'t Table, added: &mut Added) -> Rewritten<'t> {
    let sides = Sides::of(table, &added.taken);
    let mut values = Vec::new();
    let mut functions = Vec::new();
    for function in &table.functions {
        let outcome = match closed_form(table, function, added) {
            Err(reason) => Outcome::Left(reason),
            Ok(closed) => {
                let integral = if sides.take(function) { integral(table, function, &closed, added) } else { None };
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
    (values, functions)
}

/// The additions to the new table besides new formulas.
#[derive(Debug)]
struct Added {
    kernels: Kernels,
    /// Densities, as text.
    densities: Vec<String>,
    /// Names of the lists of nodes that they are integrated with.
    rules: [String; 3],
    /// The names that are in use.
    taken: Taken,
}

impl Added {
    /// Nothing yet.
    fn to(table: &Table) -> Self {
        let mut taken = Taken::by(table);
        let rules = gauss::rules(&mut taken);
        Self { kernels: Kernels::new(&mut taken), densities: Vec::new(), rules, taken }
    }
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
    fn of(table: &'t Table, taken: &Taken) -> Self {
        let subtracts = |f: &&Function| density(table, f, &mut Kernels::new(&mut taken.clone()), taken).is_some();
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
fn density(
    table: &Table,
    function: &Function,
    kernels: &mut Kernels,
    taken: &Taken,
) -> Option<(Density, Names, Bounds)> {
    let mut reader = Reader::new(table, taken);
    let names = Names {
        variable: reader.taken.free(&["x", "at", "along"]),
        sum: reader.taken.free(&["sigma", "half_sum", "sum_of_sides"]),
        difference: reader.taken.free(&["delta", "half_difference", "difference_of_sides"]),
    };
    let (f, bounds) = integrand::integrand(&mut reader, function, &names.variable).ok()?;
    let density = sides::density(&f, &names, kernels)?;
    Some((density, names, reader.bounds.swap_remove(bounds)))
}

/// A function as an integral of a product, by `closed` or as it is written where no rule is good enough.
fn integral(table: &Table, function: &Function, closed: &Option<Formula>, added: &mut Added) -> Option<Formula> {
    let (density, names, bounds) = density(table, function, &mut added.kernels, &added.taken)?;
    let FunctionBody::Value(written) = &function.body else { return None };
    let mut here = added.taken.clone();
    let (turn, node) = (here.free(&["turn", "turns", "turned"]), here.free(&["n", "node", "gauss_node"]));
    let as_written = match closed {
        Some(closed) => closed.value.clone(),
        // A formula with names of its own keeps them.
        None if function.bindings.is_empty() => {
            let text = &table.source.text[written.span.start..written.span.end];
            text.trim_matches('"').split_whitespace().collect::<Vec<_>>().join(" ")
        }
        None => return None,
    };
    let name = &function.name.value;
    let helper = added.taken.free_everywhere(&[&format!("{name}_density"), &format!("{name}_of_sides")]);
    let sinc = &added.kernels.sinc;
    added.densities.push(gauss::helper(&helper, &density, &names, sinc, "        "));
    let called = gauss::Called { helper: &helper, turn: &turn, node: &node, rules: &added.rules };
    let (turns, value) = gauss::integral(&called, &density, &names, &bounds, &as_written);
    let mut lets = bounds.text(sinc)?;
    let others = closed.iter().flat_map(|closed| &closed.lets).filter(|l| !lets.contains(l));
    let others: Vec<String> = others.cloned().collect();
    lets.extend(others);
    lets.push(turns);
    Some(Formula { lets, value })
}

impl Bounds {
    /// Mean and half difference, by their names.
    fn text(&self, sinc: &str) -> Option<Vec<String>> {
        let half = Poly::number(Rational::HALF);
        let (mean, reach) = (self.lo.plus(&self.hi)?.times(&half)?, self.hi.minus(&self.lo)?.times(&half)?);
        let printer = Printer { group_by: &[self.mid.clone(), self.half.clone()], sinc };
        let text = |(name, value): (&String, Poly)| format!("let {name} = {};", printer.sum(&value));
        Some([(&self.mid, mean), (&self.half, reach)].map(text).to_vec())
    }
}

/// The new formula of a function in closed form, if it needs one.
fn closed_form(table: &Table, function: &Function, added: &mut Added) -> Result<Option<Formula>, String> {
    if !read::is_singular(table, function) {
        return Ok(None);
    }
    let mut reader = Reader::new(table, &added.taken);
    let kernels = &mut added.kernels;
    let sinc = kernels.sinc.clone();
    let sum = reader.function(function)?;
    let too_large = || "it becomes too large".to_owned();
    let mut sum = sum.reduced().and_then(|sum| tame(&sum)).ok_or_else(too_large)?;
    let mut lets = Vec::new();
    let group_by: Vec<String> = reader.bounds.iter().flat_map(|b| [b.mid.clone(), b.half.clone()]).collect();
    let printer = Printer { group_by: &group_by, sinc: &sinc };
    for argument in arguments(&sum, &mut reader.taken) {
        let rewritten = kernel::extract(&sum, &argument, kernels);
        if let Some(rewritten) = rewritten.filter(|rewritten| *rewritten != sum) {
            if argument.value != Poly::var(&argument.name) {
                lets.push(format!("let {} = {};", argument.name, printer.sum(&argument.value)));
            }
            sum = rewritten;
        }
    }
    if functions_of(&sum).iter().any(|(name, _)| name == SINC) {
        kernels.sinc();
    }
    let mut all: Vec<String> = Vec::new();
    for bounds in &reader.bounds {
        let names = [&bounds.mid, &bounds.half];
        let words =
            |text: &str, name: &str| text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(|w| w == name);
        let used = |name: &str| sum.mentions(name) || lets.iter().any(|text| words(text, name));
        let texts = bounds.text(&sinc).ok_or_else(too_large)?;
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
fn arguments(sum: &Poly, taken: &mut Taken) -> Vec<Argument> {
    let reciprocals: BTreeSet<&Atom> =
        sum.0.keys().flat_map(|mono| mono.keys()).filter(|atom| matches!(atom, Atom::Over(_))).collect();
    let mut all: Vec<Argument> = Vec::new();
    for (name, argument) in functions_of(sum) {
        if !matches!(name.as_str(), "sin" | "cos" | "exp" | "sinh" | "cosh" | SINC) {
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
        let name = match (is_variable, value.single()) {
            (true, Some((mono, _))) => match mono.keys().next() {
                Some(Atom::Var(variable)) => variable.clone(),
                _ => continue,
            },
            _ => taken.free(&["y", "u", "arg", "quantity"]),
        };
        all.push(Argument { value, name });
    }
    all
}
