//! The upper side minus the lower side, as a product.
//!
//! A closed form of an integral over two variables takes a function of the
//! upper bound of one of them, `X = k x + b`, minus the same function of the
//! lower bound Y, and integrates along x. Of thin regions little is left. What is
//! integrated along x is found again by differentiation, in which divisions by
//! slopes cancel. With the half sum and the half difference of both bounds,
//!
//! ```text
//!   X = sigma + delta,   Y = sigma - delta,
//! ```
//!
//! all of it is a polynomial of the sines and cosines of sigma and delta. Its
//! coefficients are exact, so whatever cancels at X = Y cancels here, and a
//! power of sin(delta) is left as a factor: nothing is subtracted any more.
//! Terms such as `delta - sin(delta) cos(delta)` become kernels.

use std::collections::{BTreeMap, BTreeSet};

use super::kernel::{self, Argument, Kernels};
use super::poly::{Atom, Mono, Poly};
use super::trig::{angle, multiple, replace, substitute, without_squared_cosines};
use crate::program::rational::Rational;

/// Largest multiple of an angle that is written out.
const MOST: i128 = 8;

/// The integrand along a variable, in a form that does not cancel.
#[derive(Debug, Clone)]
pub(super) struct Density {
    /// In terms of [`Names::sum`] and [`Names::difference`].
    pub(super) value: Poly,
    /// Half the sum of both sides.
    pub(super) sum: Poly,
    /// Half their difference.
    pub(super) difference: Poly,
    /// The largest factors by which each of these grows along the variable: how fast anything can turn.
    pub(super) speed: BTreeMap<Mono, Rational>,
}

/// The names of the parts.
#[derive(Debug, Clone)]
pub(super) struct Names {
    /// The variable.
    pub(super) variable: String,
    /// Half the sum of the sides.
    pub(super) sum: String,
    /// Half their difference.
    pub(super) difference: String,
}

/// The integrand `f` as a difference of two sides, if it is one.
pub(super) fn density(f: &Poly, names: &Names, kernels: &mut Kernels) -> Option<Density> {
    let speed = speed(f, &names.variable)?;
    let (shared, lead, rest) = f.content()?;
    let angles: BTreeSet<&Poly> = rest.0.keys().flat_map(Mono::keys).filter_map(|a| angle(a).map(|(_, x)| x)).collect();
    let (upper, lower): (Vec<&Poly>, Vec<&Poly>) = angles.into_iter().partition(|x| x.mentions(&names.variable));
    let bases = |all: &[&Poly]| -> Vec<Poly> {
        let of = |x: &&Poly| [1, 2, 3].map(|b| x.times_number(Rational::fraction(1, b)?));
        all.iter().flat_map(of).flatten().collect()
    };
    for x in bases(&upper) {
        for y in bases(&lower) {
            let Some(product) = product(&rest, &x, &y, names) else { continue };
            let Some(tamed) = kernels_of(&product, &names.difference, kernels) else { continue };
            let outside = Poly([(shared, lead)].into());
            let half = Rational::HALF;
            return Some(Density {
                value: outside.times(&tamed)?,
                sum: x.plus(&y)?.times_number(half)?,
                difference: x.minus(&y)?.times_number(half)?,
                speed,
            });
        }
    }
    None
}

/// A sum in which the upper side is `x` and the lower one `y`, in terms of half their sum and difference; `None`
/// if it does not vanish where they meet.
fn product(rest: &Poly, x: &Poly, y: &Poly, names: &Names) -> Option<Poly> {
    let (sum, difference) = (Poly::var(&names.sum), Poly::var(&names.difference));
    // Outside of sines and cosines the sides show as one of their variables, which stands alone.
    let mut plain = BTreeMap::new();
    for (side, turned) in [(x, sum.plus(&difference)?), (y, sum.minus(&difference)?)] {
        if let Some((variable, factor)) = lone(side, &names.variable) {
            let others = side.minus(&Poly::var(&variable).times_number(factor)?)?;
            plain.insert(variable, turned.minus(&others)?.times_number(factor.reciprocal()?)?);
        }
    }
    let turned = replace(rest, &|atom| {
        if let Some((name, argument)) = angle(atom) {
            for (side, sign) in [(x, 1), (y, -1)] {
                if let Some(count) = argument.ratio(side) {
                    let count = count.integer().filter(|count| (1..=MOST).contains(count))?;
                    let count = usize::try_from(count).ok()?;
                    return multiple(name, count, &sum, &difference, sign);
                }
            }
            return Some(Poly::atom(atom.clone()));
        }
        substitute(&Poly::atom(atom.clone()), &plain)
    })?;
    let turned = without_squared_cosines(&turned)?;
    let met = replace(&turned, &|atom| match (angle(atom), atom) {
        (Some(("sin", a)), _) if *a == difference => Some(Poly::default()),
        (Some(("cos", a)), _) if *a == difference => Some(Poly::whole(1)),
        (None, Atom::Var(name)) if *name == names.difference => Some(Poly::default()),
        _ => Some(Poly::atom(atom.clone())),
    })?;
    let plain_variable = turned.0.keys().any(|mono| mono.contains_key(&Atom::Var(names.variable.clone())));
    (without_squared_cosines(&met)?.is_zero() && !plain_variable && !turned.is_zero()).then_some(turned)
}

/// A variable that is a term of a sum by itself, and its factor.
fn lone(sum: &Poly, except: &str) -> Option<(String, Rational)> {
    sum.0.iter().find_map(|(mono, factor)| match mono.iter().next() {
        Some((Atom::Var(name), 1)) if mono.len() == 1 && name != except => Some((name.clone(), *factor)),
        _ => None,
    })
}

/// Groups of terms in which the difference itself is a factor, as kernels; the others stay. `None` if such a
/// factor is left: its terms cancel against others, which smaller angles may bring together.
fn kernels_of(sum: &Poly, difference: &str, kernels: &mut Kernels) -> Option<Poly> {
    let own = Atom::Var(difference.to_owned());
    let rest_of = |mono: &Mono| -> Mono {
        mono.iter().filter(|(atom, _)| !atom.mentions(difference)).map(|(a, p)| (a.clone(), *p)).collect()
    };
    let plain: BTreeSet<Mono> = sum.0.keys().filter(|mono| mono.contains_key(&own)).map(rest_of).collect();
    let (with, without): (BTreeMap<_, _>, BTreeMap<_, _>) =
        sum.0.clone().into_iter().partition(|(mono, _)| plain.contains(&rest_of(mono)));
    if with.is_empty() {
        return Some(sum.clone());
    }
    let argument = Argument { value: Poly::var(difference), name: difference.to_owned() };
    let tamed = kernel::extract(&Poly(with), &argument, kernels)?;
    let left = |mono: &Mono| mono.contains_key(&own) && !mono.keys().any(|a| *a != own && a.mentions(difference));
    if tamed.0.keys().any(left) { None } else { tamed.plus(&Poly(without)) }
}

/// The speed at which the sines and cosines of a sum turn together along a variable, term by term the most.
fn speed(f: &Poly, variable: &str) -> Option<BTreeMap<Mono, Rational>> {
    let mut all: BTreeMap<Mono, Rational> = BTreeMap::new();
    for mono in f.0.keys() {
        let mut here: BTreeMap<Mono, Rational> = BTreeMap::new();
        for (atom, power) in mono.iter().filter(|(atom, _)| atom.mentions(variable)) {
            let Some((_, argument)) = angle(atom) else {
                // A power of the variable itself does not turn.
                if matches!(atom, Atom::Var(_)) {
                    continue;
                }
                return None;
            };
            let (slope, _) = argument.linear_in(variable)?;
            for (factors, factor) in slope.0 {
                let variables = factors.iter().all(|(atom, power)| matches!(atom, Atom::Var(_)) && *power > 0);
                if !variables || *power < 0 {
                    return None;
                }
                let by = factor.abs().times(Rational::whole((*power).into()))?;
                let sum = here.entry(factors).or_insert(Rational::ZERO);
                *sum = sum.plus(by)?;
            }
        }
        for (factors, by) in here {
            let known = all.entry(factors).or_insert(Rational::ZERO);
            *known = by.max(*known);
        }
    }
    (!all.is_empty()).then_some(all)
}
