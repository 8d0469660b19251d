//! Differences of antiderivatives, without the difference.
//!
//! With the mean `m` and half the difference `h` of the bounds,
//!
//! ```text
//!   sin(a x + t) |  =   2 a h cos(a m + t) sinc(a h)
//!   cos(a x + t) |  =  -2 a h sin(a m + t) sinc(a h)
//!            x   |  =   2 h
//!        x g(x)  |  =   m (g |)  +  h (g at both bounds, summed)
//! ```
//!
//! and what does not depend on `x` is gone. Where the antiderivative was
//! divided by `a`, the factor `a` on the right cancels it: no division is left.

use super::kernel::SINC;
use super::poly::{Atom, Mono, Poly, multiply};
use crate::program::rational::Rational;

/// `sum | variable = mid - half .. mid + half`.
pub(super) fn between(sum: &Poly, variable: &str, mid: &str, half: &str) -> Result<Poly, String> {
    let (mid, half) = (Poly::var(mid), Poly::var(half));
    let mut total = Poly::default();
    for (mono, factor) in &sum.0 {
        let (inside, outside): (Mono, Mono) =
            mono.iter().map(|(a, p)| (a.clone(), *p)).partition(|(atom, _)| atom.mentions(variable));
        if inside.is_empty() {
            continue;
        }
        let unknown = || "between its bounds stands something other than x, sin, cos and their products".to_owned();
        let difference = term(&inside, variable, &mid, &half).ok_or_else(unknown)?;
        let rest = Poly([(outside, *factor)].into());
        let scaled = rest.times(&difference).ok_or_else(unknown)?;
        total = total.plus(&scaled).ok_or_else(unknown)?;
    }
    Ok(total)
}

/// The difference of one product that depends on the variable.
fn term(inside: &Mono, variable: &str, mid: &Poly, half: &Poly) -> Option<Poly> {
    let own = Atom::Var(variable.to_owned());
    let power = inside.get(&own).copied().unwrap_or(0);
    let others = multiply(inside, &Mono::from([(own, -power)]));
    let mut others = others.iter();
    match (power, others.next(), others.next()) {
        (1, None, None) => half.times_number(Rational::whole(2)),
        (2, None, None) => mid.times(half)?.times_number(Rational::whole(4)),
        (0 | 1, Some((Atom::Fun(name, arguments), 1)), None) => {
            let [argument] = arguments.as_slice() else { return None };
            let (slope, phase) = argument.linear_in(variable)?;
            let at_mid = slope.times(mid)?.plus(&phase)?;
            let reach = slope.times(half)?;
            let (other, sign) = match name.as_str() {
                "sin" => ("cos", 1),
                "cos" => ("sin", -1),
                _ => return None,
            };
            let product = reach.times_number(Rational::whole(2 * sign))?;
            let difference =
                product.times(&Poly::fun(other, at_mid.clone()))?.times(&Poly::fun(SINC, reach.clone()))?;
            if power == 0 {
                return Some(difference);
            }
            let both = Poly::fun(name, at_mid).times(&Poly::fun("cos", reach))?.times_number(Rational::whole(2))?;
            mid.times(&difference)?.plus(&half.times(&both)?)
        }
        _ => None,
    }
}
