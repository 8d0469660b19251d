//! Sums of products: the algebra in which formulas are rewritten.
//!
//! A [`Poly`] is a sum of monomials with exact rational coefficients. A
//! monomial is a product of powers of atoms: variables, functions of sums, and
//! reciprocals of sums. Equal formulas that differ in order, grouping or
//! distribution of factors become the same sum, which is what lets rules see
//! that terms cancel.

use std::collections::BTreeMap;

use crate::program::rational::Rational;

/// A factor of a monomial.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Atom {
    /// A parameter, a local, or a call that is kept as it is written.
    Var(String),
    /// A function of sums.
    Fun(String, Vec<Poly>),
    /// One divided by a sum of several terms; its powers are positive.
    Over(Poly),
}

/// Powers of atoms; no power is zero.
pub(super) type Mono = BTreeMap<Atom, i32>;

/// A sum of monomials; no coefficient is zero.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(super) struct Poly(pub(super) BTreeMap<Mono, Rational>);

/// Most terms of a sum; beyond it rewriting is given up.
const MAX_TERMS: usize = 512;

impl Poly {
    pub(super) fn number(value: Rational) -> Self {
        if value.is_zero() { Self::default() } else { Self(BTreeMap::from([(Mono::new(), value)])) }
    }

    pub(super) fn whole(value: i64) -> Self {
        Self::number(Rational::whole(value))
    }

    pub(super) fn atom(atom: Atom) -> Self {
        Self(BTreeMap::from([(Mono::from([(atom, 1)]), Rational::ONE)]))
    }

    pub(super) fn var(name: &str) -> Self {
        Self::atom(Atom::Var(name.to_owned()))
    }

    pub(super) fn fun(name: &str, argument: Poly) -> Self {
        Self::atom(Atom::Fun(name.to_owned(), vec![argument]))
    }

    pub(super) fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The number it is, if it is one.
    pub(super) fn constant(&self) -> Option<Rational> {
        match self.0.iter().next() {
            None => Some(Rational::ZERO),
            Some((mono, factor)) if mono.is_empty() && self.0.len() == 1 => Some(*factor),
            Some(_) => None,
        }
    }

    /// Its only term, if it has one.
    pub(super) fn single(&self) -> Option<(&Mono, Rational)> {
        let (mono, factor) = self.0.iter().next()?;
        (self.0.len() == 1).then_some((mono, *factor))
    }

    pub(super) fn add_term(&mut self, mono: Mono, factor: Rational) -> Option<()> {
        let sum = self.0.get(&mono).copied().unwrap_or(Rational::ZERO).plus(factor)?;
        if sum.is_zero() {
            self.0.remove(&mono);
        } else {
            self.0.insert(mono, sum);
        }
        (self.0.len() <= MAX_TERMS).then_some(())
    }

    pub(super) fn plus(&self, other: &Self) -> Option<Self> {
        let mut sum = self.clone();
        for (mono, factor) in &other.0 {
            sum.add_term(mono.clone(), *factor)?;
        }
        Some(sum)
    }

    pub(super) fn times_number(&self, factor: Rational) -> Option<Self> {
        if factor.is_zero() {
            return Some(Self::default());
        }
        let terms = self.0.iter().map(|(mono, f)| Some((mono.clone(), f.times(factor)?)));
        Some(Self(terms.collect::<Option<_>>()?))
    }

    pub(super) fn minus(&self, other: &Self) -> Option<Self> {
        self.plus(&other.times_number(-Rational::ONE)?)
    }

    /// The product; a sum and its reciprocal cancel.
    pub(super) fn times(&self, other: &Self) -> Option<Self> {
        let divides = |sum: &Self| sum.0.keys().any(|mono| mono.keys().any(|atom| matches!(atom, Atom::Over(_))));
        if divides(self) { self.distribute(other) } else { other.distribute(self) }
    }

    /// Every monomial of `self` times `sum`, which may be what the monomial is divided by.
    fn distribute(&self, sum: &Self) -> Option<Self> {
        let content = if sum.0.len() > 1 { sum.content() } else { None };
        let mut product = Self::default();
        for (mono, factor) in &self.0 {
            if let Some((shared, lead, rest)) = &content {
                let over = Atom::Over(rest.clone());
                if mono.contains_key(&over) {
                    let without = multiply(mono, &Mono::from([(over, -1)]));
                    product.add_term(multiply(&without, shared), factor.times(*lead)?)?;
                    continue;
                }
            }
            for (other, by) in &sum.0 {
                product.add_term(multiply(mono, other), factor.times(*by)?)?;
            }
        }
        Some(product)
    }

    /// The quotient of two sums.
    pub(super) fn over(&self, divisor: &Self) -> Option<Self> {
        self.times(&divisor.reciprocal()?)
    }

    /// One divided by the sum; `None` for zero.
    pub(super) fn reciprocal(&self) -> Option<Self> {
        let (mono, factor, rest) = self.content()?;
        let mut inverse = Mono::new();
        let mut result = Self::number(factor.reciprocal()?);
        for (atom, power) in mono {
            match atom {
                Atom::Over(sum) => {
                    for _ in 0..power {
                        result = result.times(&sum)?;
                    }
                }
                atom => {
                    inverse.insert(atom, -power);
                }
            }
        }
        if rest.constant() != Some(Rational::ONE) {
            inverse.insert(Atom::Over(rest), 1);
        }
        result.times(&Self(BTreeMap::from([(inverse, Rational::ONE)])))
    }

    /// Factors that all terms share, the rational one among them, and what is left.
    pub(super) fn content(&self) -> Option<(Mono, Rational, Self)> {
        let mut shared = self.0.keys().next()?.clone();
        for mono in self.0.keys() {
            shared.retain(|atom, power| match mono.get(atom) {
                Some(other) => {
                    *power = (*power).min(*other);
                    true
                }
                None => false,
            });
        }
        let inverse: Mono = shared.iter().map(|(atom, power)| (atom.clone(), -power)).collect();
        let rest = Self(self.0.iter().map(|(mono, factor)| (multiply(mono, &inverse), *factor)).collect());
        // What is left begins with the coefficient 1, so that equal sums look equal.
        let lead = *rest.0.values().next()?;
        Some((shared, lead, rest.times_number(lead.reciprocal()?)?))
    }

    /// The sum with variables of divisors gone from what is divided: `x / (x - y)` is `1 + y / (x - y)`. What
    /// contains a divisor as a factor loses the division.
    pub(super) fn reduced(&self) -> Option<Self> {
        let mut sum = self.clone();
        for _ in 0..MAX_TERMS * 8 {
            let found = sum.0.iter().find_map(|(mono, factor)| {
                let (over, variable, lead, rest) = mono.keys().find_map(|atom| {
                    let Atom::Over(divisor) = atom else { return None };
                    let (variable, lead, rest) = divisor.variable()?;
                    mono.get(&variable).is_some_and(|power| *power > 0).then(|| (atom.clone(), variable, lead, rest))
                })?;
                Some((mono.clone(), *factor, over, variable, lead, rest))
            });
            let Some((mono, factor, over, variable, lead, rest)) = found else { return Some(sum) };
            sum.0.remove(&mono);
            let without = multiply(&mono, &Mono::from([(variable, -1)]));
            let factor = factor.over(lead)?;
            sum.add_term(multiply(&without, &Mono::from([(over, -1)])), factor)?;
            for (other, by) in &rest.0 {
                sum.add_term(multiply(&without, other), -factor.times(*by)?)?;
            }
        }
        None
    }

    /// A variable that occurs in one term and by itself, its coefficient, and the other terms.
    fn variable(&self) -> Option<(Atom, Rational, Self)> {
        self.0.iter().find_map(|(mono, factor)| {
            let mut atoms = mono.iter();
            let (Some((atom @ Atom::Var(name), 1)), None) = (atoms.next(), atoms.next()) else { return None };
            let mut rest = self.clone();
            rest.0.remove(mono);
            (!rest.mentions(name)).then(|| (atom.clone(), *factor, rest))
        })
    }

    /// Adds the variables that occur anywhere, each once.
    pub(super) fn variables(&self, all: &mut Vec<String>) {
        for atom in self.0.keys().flat_map(Mono::keys) {
            match atom {
                Atom::Var(name) if !all.contains(name) => all.push(name.clone()),
                Atom::Var(_) => {}
                Atom::Fun(_, arguments) => arguments.iter().for_each(|a| a.variables(all)),
                Atom::Over(sum) => sum.variables(all),
            }
        }
    }

    /// Returns whether a variable occurs anywhere.
    pub(super) fn mentions(&self, name: &str) -> bool {
        self.0.keys().any(|mono| mono.keys().any(|atom| atom.mentions(name)))
    }

    /// The sum as `a x + b` in a variable x, if it has that form.
    pub(super) fn linear_in(&self, name: &str) -> Option<(Self, Self)> {
        let variable = Atom::Var(name.to_owned());
        let (mut slope, mut rest) = (Self::default(), Self::default());
        for (mono, factor) in &self.0 {
            let mut other = mono.clone();
            let power = other.remove(&variable).unwrap_or(0);
            if other.keys().any(|atom| atom.mentions(name)) {
                return None;
            }
            match power {
                0 => rest.add_term(other, *factor)?,
                1 => slope.add_term(other, *factor)?,
                _ => return None,
            }
        }
        Some((slope, rest))
    }

    /// The number `r` with `self = r other`, if there is one.
    pub(super) fn ratio(&self, other: &Self) -> Option<Rational> {
        let (first, lead) = other.0.iter().next()?;
        let ratio = self.0.get(first)?.over(*lead)?;
        (other.times_number(ratio)? == *self).then_some(ratio)
    }
}

impl Atom {
    pub(super) fn mentions(&self, name: &str) -> bool {
        match self {
            Atom::Var(var) => var == name,
            Atom::Fun(_, arguments) => arguments.iter().any(|a| a.mentions(name)),
            Atom::Over(sum) => sum.mentions(name),
        }
    }
}

/// The product of two monomials.
pub(super) fn multiply(a: &Mono, b: &Mono) -> Mono {
    let mut product = a.clone();
    for (atom, power) in b {
        let sum = product.get(atom).copied().unwrap_or(0) + power;
        if sum == 0 {
            product.remove(atom);
        } else {
            product.insert(atom.clone(), sum);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_formulas_become_equal_sums() {
        let (a, b) = (Poly::var("a"), Poly::var("b"));
        let sum = a.plus(&b).expect("small");
        let square = sum.times(&sum).expect("small");
        let by_parts =
            a.times(&a).and_then(|x| x.plus(&b.times(&b)?)?.plus(&a.times(&b)?.times_number(Rational::whole(2))?));
        assert_eq!(Some(square), by_parts);
        // 4 (a - b) / (2 b - 2 a) keeps the sign and the factor outside of the reciprocal.
        let difference = a.minus(&b).expect("small");
        let other = b.minus(&a).and_then(|d| d.times_number(Rational::whole(2))).expect("small");
        let (one, two) = (difference.reciprocal().expect("not zero"), other.reciprocal().expect("not zero"));
        assert_eq!(two.times_number(Rational::whole(-2)), Some(one.clone()));
        assert_eq!(Poly::default().reciprocal(), None);
        let tripled = Poly::var("k").times_number(Rational::whole(3)).expect("small");
        assert_eq!(tripled.over(&tripled), Some(Poly::whole(1)));
        // (a c - b c) / (a - b)
        let c = Poly::var("c");
        let parts = a.times(&c).and_then(|x| x.times(&one)?.minus(&b.times(&c)?.times(&one)?));
        assert_eq!(parts.and_then(|parts| parts.reduced()), Some(c));
    }
}
