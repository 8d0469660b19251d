//! Algebra of sines and cosines of sums: substitution, derivatives, sums as
//! products, multiple angles.
//!
//! Arguments begin with a positive term, so that `cos(a - b)` and `cos(b - a)`
//! are one atom and differences of equal things vanish.

use std::collections::BTreeMap;

use super::poly::{Atom, Mono, Poly, multiply};
use crate::program::rational::Rational;

/// `sin` or `cos` of an argument, with its sign outside.
pub(super) fn wave(name: &str, argument: &Poly) -> Option<Poly> {
    let Some((_, lead, _)) = argument.content() else {
        return Some(if name == "cos" { Poly::whole(1) } else { Poly::default() });
    };
    if !lead.is_negative() {
        return Some(Poly::fun(name, argument.clone()));
    }
    let turned = Poly::fun(name, argument.times_number(-Rational::ONE)?);
    if name == "cos" { Some(turned) } else { turned.times_number(-Rational::ONE) }
}

/// The argument of a sine or cosine.
pub(super) fn angle(atom: &Atom) -> Option<(&str, &Poly)> {
    match atom {
        Atom::Fun(name, arguments) if name == "sin" || name == "cos" => Some((name, arguments.first()?)),
        _ => None,
    }
}

/// The product of what `value` makes of each atom of each term, added up.
pub(super) fn replace(sum: &Poly, value: &dyn Fn(&Atom) -> Option<Poly>) -> Option<Poly> {
    let mut total = Poly::default();
    for (mono, factor) in &sum.0 {
        let mut product = Poly::number(*factor);
        for (atom, power) in mono {
            let value = value(atom)?;
            let value = if *power < 0 { value.reciprocal()? } else { value };
            for _ in 0..power.unsigned_abs() {
                product = product.times(&value)?;
            }
        }
        total = total.plus(&product)?;
    }
    Some(total)
}

/// The sum with variables replaced, everywhere; `None` if that divides by zero.
pub(super) fn substitute(sum: &Poly, by: &BTreeMap<String, Poly>) -> Option<Poly> {
    replace(sum, &|atom| match atom {
        Atom::Var(name) => Some(by.get(name).cloned().unwrap_or_else(|| Poly::var(name))),
        Atom::Over(under) => substitute(under, by)?.reciprocal(),
        Atom::Fun(name, arguments) => {
            let arguments = arguments.iter().map(|a| substitute(a, by)).collect::<Option<Vec<_>>>()?;
            match arguments.as_slice() {
                [one] if angle(atom).is_some() => wave(name, one),
                _ => Some(Poly::atom(Atom::Fun(name.clone(), arguments))),
            }
        }
    })
}

/// The derivative with respect to a variable; `None` if it occurs in more than powers, sines and cosines.
pub(super) fn derivative(sum: &Poly, variable: &str) -> Option<Poly> {
    let mut total = Poly::default();
    for (mono, factor) in &sum.0 {
        for (atom, power) in mono.iter().filter(|(atom, _)| atom.mentions(variable)) {
            let inner = match atom {
                Atom::Var(_) => Poly::whole(1),
                atom => {
                    let (name, argument) = angle(atom)?;
                    let outer = if name == "sin" {
                        wave("cos", argument)?
                    } else {
                        wave("sin", argument)?.times_number(-Rational::ONE)?
                    };
                    outer.times(&derivative(argument, variable)?)?
                }
            };
            let rest = multiply(mono, &Mono::from([(atom.clone(), -1)]));
            let rest = Poly([(rest, factor.times(Rational::whole((*power).into()))?)].into());
            total = total.plus(&rest.times(&inner)?)?;
        }
    }
    Some(total)
}

/// The sum with pairs such as `cos(a) - cos(b)` written as products, as long as there are any.
pub(super) fn products(sum: &Poly) -> Option<Poly> {
    let mut sum = sum.clone();
    while let Some((one, other, product)) = pair(&sum) {
        sum.0.remove(&one);
        sum.0.remove(&other);
        sum = sum.plus(&product)?;
    }
    Some(sum)
}

/// Two terms that differ in one sine or one cosine only, and what they come to.
fn pair(sum: &Poly) -> Option<(Mono, Mono, Poly)> {
    let terms: Vec<(&Mono, &Rational)> = sum.0.iter().collect();
    for (i, (one, factor)) in terms.iter().enumerate() {
        for (other, second) in &terms[i + 1..] {
            if factor.abs() != second.abs() {
                continue;
            }
            let inverse = |mono: &Mono| -> Mono { mono.iter().map(|(atom, power)| (atom.clone(), -power)).collect() };
            let ratio = multiply(one, &inverse(other));
            let mut parts = ratio.iter();
            let (Some(a), Some(b), None) = (parts.next(), parts.next(), parts.next()) else { continue };
            let ((over, 1), (under, -1)) = (if *a.1 > 0 { (a, b) } else { (b, a) }) else { continue };
            let (Some((name, x)), Some((second_name, y))) = (angle(over), angle(under)) else { continue };
            if name != second_name {
                continue;
            }
            let common = multiply(one, &Mono::from([(over.clone(), -1)]));
            let half = Rational::HALF;
            let (mean, apart) = (x.plus(y)?.times_number(half)?, x.minus(y)?.times_number(half)?);
            let (first, last, sign) = match (name, *factor == *second) {
                ("cos", true) => ("cos", "cos", 2),
                ("cos", false) => ("sin", "sin", -2),
                (_, true) => ("sin", "cos", 2),
                (_, false) => ("cos", "sin", 2),
            };
            let product = wave(first, &mean)?.times(&wave(last, &apart)?)?.times_number(Rational::whole(sign))?;
            let rest = Poly([(common, **factor)].into());
            return Some(((*one).clone(), (*other).clone(), rest.times(&product)?));
        }
    }
    None
}

/// `sin` or `cos` of `count (a + sign b)` in powers of the sines and cosines of a and b.
pub(super) fn multiple(name: &str, count: usize, a: &Poly, b: &Poly, sign: i64) -> Option<Poly> {
    let ((sin_a, cos_a), (sin_b, cos_b)) = (powers(a, count)?, powers(b, count)?);
    let sin_b = sin_b.times_number(Rational::whole(sign))?;
    match name {
        "sin" => sin_a.times(&cos_b)?.plus(&cos_a.times(&sin_b)?),
        _ => cos_a.times(&cos_b)?.minus(&sin_a.times(&sin_b)?),
    }
}

/// Sine and cosine of `count a` in powers of those of a.
fn powers(a: &Poly, count: usize) -> Option<(Poly, Poly)> {
    let (sine, cosine) = (Poly::fun("sin", a.clone()), Poly::fun("cos", a.clone()));
    let (mut sin, mut cos) = (Poly::default(), Poly::whole(1));
    for _ in 0..count {
        let next = sin.times(&cosine)?.plus(&cos.times(&sine)?)?;
        cos = cos.times(&cosine)?.minus(&sin.times(&sine)?)?;
        sin = next;
    }
    Some((sin, cos))
}

/// The sum with `cos^2` of any argument written as `1 - sin^2`: equal polynomials of sines and cosines look equal.
pub(super) fn without_squared_cosines(sum: &Poly) -> Option<Poly> {
    let mut done = Poly::default();
    let mut open = sum.clone();
    while let Some((mono, factor)) = open.0.pop_first() {
        let squared = mono.iter().find_map(|(atom, power)| match angle(atom) {
            Some(("cos", argument)) if *power >= 2 => Some((atom.clone(), argument.clone())),
            _ => None,
        });
        let Some((cosine, argument)) = squared else {
            done.add_term(mono, factor)?;
            continue;
        };
        let rest = multiply(&mono, &Mono::from([(cosine, -2)]));
        let sine = Mono::from([(Atom::Fun("sin".to_owned(), vec![argument]), 2)]);
        open.add_term(multiply(&rest, &sine), -factor)?;
        open.add_term(rest, factor)?;
    }
    Some(done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_become_products_and_multiples_powers() {
        let (a, b) = (Poly::var("a"), Poly::var("b"));
        let cos = |x: &Poly| wave("cos", x).expect("small");
        let difference = cos(&a.minus(&b).expect("small")).minus(&cos(&a.plus(&b).expect("small"))).expect("small");
        let product = wave("sin", &a).and_then(|x| x.times(&wave("sin", &b)?)?.times_number(Rational::whole(2)));
        assert_eq!(products(&difference), product);
        // cos(3 a) = cos(a) - 4 cos(a) sin(a)^2, and a sum and its parts agree.
        let triple = multiple("cos", 3, &a, &Poly::default(), 1).and_then(|c| substitute(&c, &BTreeMap::new()));
        let sine = wave("sin", &a).expect("small");
        let expected =
            sine.times(&sine).and_then(|s| Poly::whole(1).minus(&s.times_number(Rational::whole(4))?)?.times(&cos(&a)));
        assert_eq!(triple.and_then(|c| without_squared_cosines(&c)), expected);
        assert_eq!(cos(&a.minus(&b).expect("small")), cos(&b.minus(&a).expect("small")));
    }

    #[test]
    fn divisors_cancel_in_derivatives() {
        let (x, s) = (Poly::var("x"), Poly::var("s"));
        let angle = x.times(&s).expect("small");
        let closed = wave("sin", &angle).and_then(|sine| sine.over(&s)).expect("small");
        assert_eq!(derivative(&closed, "x"), wave("cos", &angle));
    }
}
