//! Functions of one variable that a formula writes as 0/0, and their two lines:
//! a series near zero, the closed form elsewhere.
//!
//! A group of terms that differ in a function of one quantity `u` only, such as
//! `cosh(u)/u^2 - sinh(u)/u^3`, is collected and its power series is computed.
//! If the terms have negative powers of `u`, or cancel at `u = 0`, the group is
//! written as `c u^n K(u)` with a kernel K that is 1 at 0.
//!
//! The place where the lines meet follows from bounds of their errors in `f32`: the rest that the
//! series leaves out, and the digits that the closed form cancels.

use std::collections::BTreeMap;

use super::names::Taken;
use super::poly::{Atom, Mono, Poly, multiply};
use super::series::{ORDER, series};
use crate::program::rational::Rational;

/// Half a unit in the last place of 1 in `f32`.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// An error that need not be improved on.
const GOOD: f64 = 4.0 * UNIT;

/// Roundings that the closed form is charged with, for each of its terms.
const ROUNDINGS: f64 = 2.0;

/// A product of a power of x and of functions of multiples of x.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Term {
    pub(super) factor: Rational,
    pub(super) power: i32,
    pub(super) functions: Vec<(String, Rational)>,
}

/// A function with a removable singularity at 0, where it is 1.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Kernel {
    /// Its name as a helper of the table.
    pub(super) name: String,
    /// The closed form: this sum divided by a power of x.
    pub(super) terms: Vec<Term>,
    pub(super) divisor: i32,
    /// Coefficients of the series.
    pub(super) series: Vec<Rational>,
    /// Below this magnitude the series is used.
    pub(super) threshold: f64,
    /// Bound of the relative error of the series, and of the closed form at the threshold.
    pub(super) bounds: (f64, f64),
}

/// The name that the rules have for sin(x)/x. In the table it may have another one.
pub(super) const SINC: &str = "sinc";

/// The kernels of a table, each once.
#[derive(Debug)]
pub(super) struct Kernels {
    pub(super) all: Vec<Kernel>,
    /// The name of sin(x)/x in the table.
    pub(super) sinc: String,
    /// The name of the variable of each.
    pub(super) variable: String,
    taken: Taken,
}

/// A quantity that kernels are functions of.
#[derive(Debug, Clone)]
pub(super) struct Argument {
    /// Its value.
    pub(super) value: Poly,
    /// The name it is given, unless it is a variable already.
    pub(super) name: String,
}

impl Kernels {
    /// None yet, in a table where these names are taken.
    pub(super) fn new(taken: &mut Taken) -> Self {
        let sinc = taken.free_everywhere(&[SINC, "sine_over"]);
        let variable = taken.free_parameter(&["x", "z"]);
        Self { all: Vec::new(), sinc, variable, taken: taken.clone() }
    }

    /// The kernel sin(x)/x.
    pub(super) fn sinc(&mut self) -> Option<String> {
        let sine = Term { factor: Rational::ONE, power: 0, functions: vec![("sin".to_owned(), Rational::ONE)] };
        self.kernel(vec![sine], 1, 0).map(|(name, _)| name)
    }

    /// The kernel of a sum whose terms have no negative powers, divided by x^`divisor`: the name that the rules have
    /// for it, and what it was divided by to be 1 at 0.
    fn kernel(&mut self, terms: Vec<Term>, divisor: usize, skip: usize) -> Option<(String, Rational)> {
        let all = series(&terms)?;
        let lead = *all.get(divisor + skip)?;
        let scaled = |value: Rational| value.over(lead);
        let terms: Vec<Term> =
            terms.into_iter().map(|t| Some(Term { factor: scaled(t.factor)?, ..t })).collect::<Option<_>>()?;
        let divisor = (divisor + skip) as i32;
        let is_sinc =
            divisor == 1 && matches!(terms.as_slice(), [t] if t.functions == [("sin".to_owned(), Rational::ONE)]);
        let of_rules = |name: &str| if is_sinc { SINC.to_owned() } else { name.to_owned() };
        if let Some(known) = self.all.iter().find(|known| known.terms == terms && known.divisor == divisor) {
            return Some((of_rules(&known.name), lead));
        }
        let coefficients: Vec<Rational> = all[divisor as usize..].iter().map(|c| scaled(*c)).collect::<Option<_>>()?;
        let (count, threshold, bounds) = switch(&terms, divisor, &coefficients);
        let letters: Vec<String> = ('a'..='z').map(|letter| format!("kernel_{letter}")).collect();
        let letters: Vec<&str> = letters.iter().map(String::as_str).collect();
        let name = if is_sinc { self.sinc.clone() } else { self.taken.free_everywhere(&letters) };
        let series = coefficients[..count].to_vec();
        self.all.push(Kernel { name: name.clone(), terms, divisor, series, threshold, bounds });
        Some((of_rules(&name), lead))
    }
}

/// Number of coefficients and threshold with the smallest bound of the error, or with one that is good enough.
fn switch(terms: &[Term], divisor: i32, coefficients: &[Rational]) -> (usize, f64, (f64, f64)) {
    let series: Vec<f64> = coefficients.iter().map(|c| c.to_f64()).collect();
    let even = series.iter().skip(1).step_by(2).all(|c| *c == 0.0);
    let step = if even { 2 } else { 1 };
    let mut best: Option<(usize, f64, (f64, f64))> = None;
    for count in (3 * step..=(14 * step).min(series.len() - 2 * step)).step_by(step) {
        for tenths in 2..40 {
            let x = f64::from(tenths) * 0.1;
            let left_out: f64 =
                series[count..].iter().enumerate().map(|(j, c)| c.abs() * x.powi((count + j) as i32)).sum();
            let value = value(terms, divisor, x);
            let bounds = (left_out / value.abs() + 2.0 * UNIT, cancellation(terms, divisor, x));
            let error = bounds.0.max(bounds.1);
            let better = best.as_ref().is_none_or(|(_, _, known)| {
                let known = known.0.max(known.1);
                // More terms and a further threshold only where they help.
                known > GOOD && error < 0.8 * known
            });
            if better {
                best = Some((count, x, bounds));
            }
        }
    }
    best.unwrap_or((series.len(), 1.0, (f64::INFINITY, f64::INFINITY)))
}

fn magnitude(term: &Term, x: f64) -> f64 {
    let functions = term.functions.iter().map(|(name, rate)| {
        let x = rate.to_f64() * x;
        match name.as_str() {
            "exp" => libm::exp(x),
            "cosh" => libm::cosh(x),
            "sinh" => libm::sinh(x),
            "cos" => libm::cos(x),
            _ => libm::sin(x),
        }
    });
    term.factor.to_f64() * x.powi(term.power) * functions.product::<f64>()
}

fn value(terms: &[Term], divisor: i32, x: f64) -> f64 {
    terms.iter().map(|term| magnitude(term, x)).sum::<f64>() / x.powi(divisor)
}

/// Bound of the relative error of the closed form in `f32`.
fn cancellation(terms: &[Term], divisor: i32, x: f64) -> f64 {
    let sum: f64 = terms.iter().map(|term| magnitude(term, x).abs()).sum();
    ROUNDINGS * UNIT * (sum / (value(terms, divisor, x) * x.powi(divisor)).abs() + 1.0)
}

/// Writes the groups of terms that are functions of `argument` with kernels, where that is needed.
pub(super) fn extract(sum: &Poly, argument: &Argument, kernels: &mut Kernels) -> Option<Poly> {
    let pivot = Pivot::of(&argument.value)?;
    let mut groups: BTreeMap<Mono, Vec<Term>> = BTreeMap::new();
    let mut originals: BTreeMap<Mono, Poly> = BTreeMap::new();
    for (mono, factor) in &sum.0 {
        let (rest, term) = pivot.split(mono, *factor, &argument.value)?;
        groups.entry(rest.clone()).or_default().push(term);
        originals.entry(rest).or_default().add_term(mono.clone(), *factor)?;
    }
    let mut result = Poly::default();
    for (rest, terms) in groups {
        let replaced = group(terms, argument, kernels)
            .and_then(|kernel| Poly([(rest.clone(), Rational::ONE)].into()).times(&kernel));
        result = result.plus(&replaced.unwrap_or_else(|| originals[&rest].clone()))?;
    }
    Some(result)
}

/// A sum of functions of the argument as `c u^n K(u)`, if it needs that form.
fn group(mut terms: Vec<Term>, argument: &Argument, kernels: &mut Kernels) -> Option<Poly> {
    if terms.iter().all(|term| term.functions.is_empty()) {
        return None;
    }
    let many = terms.len() > 1;
    // sin(x)/x is written out, so that it can cancel against other terms.
    for term in &mut terms {
        for (name, rate) in &mut term.functions {
            if name == SINC {
                *name = "sin".to_owned();
                term.power -= 1;
                term.factor = term.factor.over(*rate)?;
            }
        }
        term.functions.sort();
    }
    terms.sort_by(|a, b| (a.power, &a.functions).cmp(&(b.power, &b.functions)));
    let lowest = terms.iter().map(|term| term.power).min()?;
    terms.iter_mut().for_each(|term| term.power -= lowest);
    let skip = series(&terms)?.iter().position(|c| !c.is_zero())?;
    let power = lowest + skip as i32;
    // A single product without a negative power says what it means already.
    let needed = skip > 0 && (many || lowest < -1 || power < 0) || lowest < 0 && !many && power >= 0;
    if !needed || power < 0 || skip >= ORDER / 2 {
        return None;
    }
    let (name, lead) = kernels.kernel(terms, 0, skip)?;
    let variable = Poly::var(&argument.name);
    let mut product = Poly::number(lead);
    for _ in 0..power {
        product = product.times(&variable)?;
    }
    product.times(&Poly::fun(&name, variable))
}

/// The form in which powers of an argument show in a monomial.
enum Pivot {
    /// The argument is this variable.
    Variable(Atom),
    /// The argument is a number times these factors times a sum, whose reciprocal shows.
    Sum { over: Atom, factor: Rational, shared: Mono },
}

impl Pivot {
    fn of(argument: &Poly) -> Option<Self> {
        let (shared, factor, rest) = argument.content()?;
        if rest.constant().is_none() {
            return Some(Pivot::Sum { over: Atom::Over(rest), factor, shared });
        }
        let mut atoms = shared.iter();
        match (atoms.next(), atoms.next()) {
            (Some((atom @ Atom::Var(_), 1)), None) if factor == Rational::ONE => Some(Pivot::Variable(atom.clone())),
            _ => None,
        }
    }

    /// A monomial as a function of the argument, and what is left of it.
    fn split(&self, mono: &Mono, mut factor: Rational, argument: &Poly) -> Option<(Mono, Term)> {
        let mut rest = Mono::new();
        let mut functions = Vec::new();
        let mut power = 0;
        let mut compensate = Mono::new();
        for (atom, exponent) in mono {
            match (self, atom) {
                (Pivot::Variable(variable), atom) if atom == variable => power += exponent,
                (Pivot::Sum { over, factor: lead, shared }, atom) if atom == over => {
                    power -= exponent;
                    for _ in 0..*exponent {
                        factor = factor.times(*lead)?;
                        compensate = multiply(&compensate, shared);
                    }
                }
                (_, Atom::Fun(name, arguments)) if *exponent > 0 => {
                    let known = matches!(name.as_str(), "sin" | "cos" | "exp" | "sinh" | "cosh" | SINC);
                    match arguments.as_slice() {
                        [inner] if known => match inner.ratio(argument) {
                            Some(rate) => (0..*exponent).for_each(|_| functions.push((name.clone(), rate))),
                            None => drop(rest.insert(atom.clone(), *exponent)),
                        },
                        _ => drop(rest.insert(atom.clone(), *exponent)),
                    }
                }
                _ => drop(rest.insert(atom.clone(), *exponent)),
            }
        }
        Some((multiply(&rest, &compensate), Term { factor, power, functions }))
    }
}
