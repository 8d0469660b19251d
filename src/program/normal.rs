//! Normal forms over the reals: two expressions with the same normal form are
//! equal wherever they are defined.
//!
//! A normal form is a minimum of maxima of affine forms with exact rational
//! coefficients. Sums and multiples of such forms are such forms again, and
//! the free distributive law makes the form unique up to order; everything
//! that is not affine, minimum or maximum is an opaque term over normal forms.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use super::operators::{BinaryAlgebra, Bounds, TernaryAlgebra, UnaryAlgebra};
use super::rational::Rational;
use super::{BinaryOp, ExprId, InputId, Node, Pool, TernaryOp, UnaryOp};

/// Most affine forms in one normal form; beyond it the form is given up.
const MAX_FORMS: usize = 256;

/// Number of a normal form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct NormalId(u32);

/// The atoms that an affine form is linear in.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Term {
    Input(InputId),
    /// A constant without an exact rational in range.
    Constant(u64),
    Unary(UnaryOp, NormalId),
    Binary(BinaryOp, NormalId, NormalId),
    Ternary(TernaryOp, [NormalId; 3]),
}

/// A constant plus multiples of terms.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Affine {
    pub(crate) terms: BTreeMap<Term, Rational>,
    pub(crate) constant: Rational,
}

/// A minimum of maxima; both lists are sorted and not empty.
pub(crate) type Lattice = Vec<Vec<Affine>>;

/// Makes normal forms. Selections must have been resolved before.
#[derive(Debug, Default)]
pub(crate) struct Normaliser {
    forms: Vec<Lattice>,
    index: HashMap<Lattice, NormalId>,
    memo: HashMap<ExprId, Option<NormalId>>,
}

impl Normaliser {
    /// The normal form of an expression without selections, unless it gets too large.
    pub(crate) fn normal(&mut self, pool: &Pool, expr: ExprId) -> Option<NormalId> {
        if let Some(done) = self.memo.get(&expr) {
            return *done;
        }
        let result = self.lattice(pool, expr).map(|form| self.intern(form));
        self.memo.insert(expr, result);
        result
    }

    /// The lattice that a normal form is.
    pub(crate) fn lattice_of(&self, id: NormalId) -> &Lattice {
        &self.forms[id.0 as usize]
    }

    /// The expression as one affine form, if it is one.
    pub(crate) fn affine(&mut self, pool: &Pool, expr: ExprId) -> Option<Affine> {
        let id = self.normal(pool, expr)?;
        match self.forms[id.0 as usize].as_slice() {
            [clause] => match clause.as_slice() {
                [affine] => Some(affine.clone()),
                _ => None,
            },
            _ => None,
        }
    }

    /// The expression as a minimum of maxima of affine forms.
    pub(crate) fn forms(&mut self, pool: &Pool, expr: ExprId) -> Option<&[Vec<Affine>]> {
        let id = self.normal(pool, expr)?;
        Some(&self.forms[id.0 as usize])
    }

    /// The value of an affine form where inputs have these numbers, and the sum of the magnitudes of its terms.
    pub(crate) fn value(&self, form: &Affine, numbers: &[f64]) -> (f64, f64) {
        let start = form.constant.to_f64();
        form.terms.iter().fold((start, start.abs()), |(sum, size), (term, factor)| {
            let value = factor.to_f64() * self.value_of_term(term, numbers);
            (sum + value, size + value.abs())
        })
    }

    /// Bounds of an affine form where inputs have these bounds; nothing if an operation in it may fail there.
    pub(crate) fn bounds(&self, form: &Affine, of: &dyn Fn(InputId) -> Bounds) -> Option<Bounds> {
        let start = form.constant.to_f64();
        form.terms.iter().try_fold((start, start), |(lo, hi), (term, factor)| {
            let ((from, to), factor) = (self.bounds_of_term(term, of)?, factor.to_f64());
            Some((lo + (from * factor).min(to * factor), hi + (from * factor).max(to * factor)))
        })
    }

    fn bounds_of_term(&self, term: &Term, of: &dyn Fn(InputId) -> Bounds) -> Option<Bounds> {
        let at = |id: &NormalId| {
            let largest = |clause: &Vec<Affine>| {
                let parts = clause.iter().map(|form| self.bounds(form, of));
                let join = |all: Bounds, part: Option<Bounds>| part.map(|(lo, hi)| (all.0.max(lo), all.1.max(hi)));
                parts.into_iter().try_fold((f64::NEG_INFINITY, f64::NEG_INFINITY), join)
            };
            let join = |all: Bounds, part: Option<Bounds>| part.map(|(lo, hi)| (all.0.min(lo), all.1.min(hi)));
            self.lattice_of(*id).iter().map(largest).try_fold((f64::INFINITY, f64::INFINITY), join)
        };
        let (bounds, fails) = match term {
            Term::Input(input) => return Some(of(*input)),
            Term::Constant(bits) => return Some((f64::from_bits(*bits), f64::from_bits(*bits))),
            Term::Unary(op, a) => op.image(at(a)?),
            Term::Binary(op, a, b) => op.image(at(a)?, at(b)?),
            Term::Ternary(op, [a, b, c]) => op.image(at(a)?, at(b)?, at(c)?),
        };
        (fails.is_none() && bounds.0.is_finite() && bounds.1.is_finite()).then_some(bounds)
    }

    fn value_of_term(&self, term: &Term, numbers: &[f64]) -> f64 {
        let at = |id: &NormalId| {
            let clauses = self.lattice_of(*id).iter();
            let largest = |clause: &Vec<Affine>| {
                clause.iter().map(|form| self.value(form, numbers).0).fold(f64::NEG_INFINITY, f64::max)
            };
            clauses.map(largest).fold(f64::INFINITY, f64::min)
        };
        match term {
            Term::Input(input) => numbers[input.index()],
            Term::Constant(bits) => f64::from_bits(*bits),
            Term::Unary(op, a) => op.apply(at(a)),
            Term::Binary(op, a, b) => op.apply(at(a), at(b)),
            Term::Ternary(op, [a, b, c]) => op.apply(at(a), at(b), at(c)),
        }
    }

    fn intern(&mut self, form: Lattice) -> NormalId {
        if let Some(id) = self.index.get(&form) {
            return *id;
        }
        let id = NormalId(self.forms.len() as u32);
        self.forms.push(form.clone());
        self.index.insert(form, id);
        id
    }

    fn get(&mut self, pool: &Pool, expr: ExprId) -> Option<Lattice> {
        let id = self.normal(pool, expr)?;
        Some(self.forms[id.0 as usize].clone())
    }

    fn lattice(&mut self, pool: &Pool, expr: ExprId) -> Option<Lattice> {
        match pool.node(expr) {
            Node::Const(number) => Some(constant(number.get())),
            Node::Word(word) => Some(constant(f64::from(word))),
            Node::Input(input) => Some(single(Term::Input(input))),
            Node::Index(_) | Node::Result(_) | Node::Select(..) => None,
            Node::Unary(op, a) => {
                let form = self.get(pool, a)?;
                match op.row().algebra {
                    UnaryAlgebra::Negate => scale(&form, -Rational::ONE),
                    UnaryAlgebra::Absolute => maximum(form.clone(), scale(&form, -Rational::ONE)?),
                    UnaryAlgebra::Saturate => maximum(minimum(form, constant(1.0))?, constant(0.0)),
                    UnaryAlgebra::Opaque => Some(single(Term::Unary(op, self.intern(form)))),
                }
            }
            Node::Binary(op, a, b) => {
                let (left, right) = (self.get(pool, a)?, self.get(pool, b)?);
                match op.row().algebra {
                    BinaryAlgebra::Sum => sum(&left, &right),
                    BinaryAlgebra::Difference => sum(&left, &scale(&right, -Rational::ONE)?),
                    BinaryAlgebra::Product => self.product(left, right),
                    BinaryAlgebra::Quotient => match value(&right) {
                        Some(divisor) if !divisor.is_zero() => scale(&left, divisor.reciprocal()?),
                        _ => Some(self.opaque(op, left, right)),
                    },
                    BinaryAlgebra::Minimum => minimum(left, right),
                    BinaryAlgebra::Maximum => maximum(left, right),
                    BinaryAlgebra::Opaque => Some(self.opaque(op, left, right)),
                }
            }
            Node::Ternary(op, a, b, c) => {
                let (x, y, z) = (self.get(pool, a)?, self.get(pool, b)?, self.get(pool, c)?);
                match op.row().algebra {
                    TernaryAlgebra::Clamp => minimum(maximum(x, y)?, z),
                    TernaryAlgebra::ProductAndSum => {
                        let product = self.product(x, y)?;
                        sum(&product, &z)
                    }
                    TernaryAlgebra::Mix => {
                        let rest = sum(&constant(1.0), &scale(&z, -Rational::ONE)?)?;
                        let (first, second) = (self.product(x, rest)?, self.product(y, z)?);
                        sum(&first, &second)
                    }
                    TernaryAlgebra::Opaque => {
                        let ids = [self.intern(x), self.intern(y), self.intern(z)];
                        Some(single(Term::Ternary(op, ids)))
                    }
                }
            }
        }
    }

    fn opaque(&mut self, op: BinaryOp, left: Lattice, right: Lattice) -> Lattice {
        let (a, b) = (self.intern(left), self.intern(right));
        single(Term::Binary(op, a, b))
    }

    fn product(&mut self, left: Lattice, right: Lattice) -> Option<Lattice> {
        match (value(&left), value(&right)) {
            (Some(factor), _) => scale(&right, factor),
            (_, Some(factor)) => scale(&left, factor),
            (None, None) => {
                let (a, b) = (self.intern(left), self.intern(right));
                Some(single(Term::Binary(BinaryOp::Multiply, a.min(b), a.max(b))))
            }
        }
    }
}

fn constant(value: f64) -> Lattice {
    match Rational::exact(value) {
        Some(constant) => vec![vec![Affine { terms: BTreeMap::new(), constant }]],
        None => single(Term::Constant(value.to_bits())),
    }
}

fn single(term: Term) -> Lattice {
    vec![vec![Affine { terms: BTreeMap::from([(term, Rational::ONE)]), constant: Rational::ZERO }]]
}

/// The number a form is, if it is one.
fn value(form: &Lattice) -> Option<Rational> {
    match form.as_slice() {
        [clause] => match clause.as_slice() {
            [affine] if affine.terms.is_empty() => Some(affine.constant),
            _ => None,
        },
        _ => None,
    }
}

impl Affine {
    pub(crate) fn plus(&self, other: &Affine) -> Option<Affine> {
        let mut terms = self.terms.clone();
        for (term, factor) in &other.terms {
            let sum = terms.get(term).copied().unwrap_or(Rational::ZERO).plus(*factor)?;
            if sum.is_zero() {
                terms.remove(term);
            } else {
                terms.insert(term.clone(), sum);
            }
        }
        Some(Affine { terms, constant: self.constant.plus(other.constant)? })
    }

    pub(crate) fn times(&self, factor: Rational) -> Option<Affine> {
        let terms = self.terms.iter().map(|(term, f)| Some((term.clone(), f.times(factor)?)));
        Some(Affine { terms: terms.collect::<Option<_>>()?, constant: self.constant.times(factor)? })
    }

    /// Returns whether this is at least `other` everywhere: they differ by a number that is not negative.
    fn dominates(&self, other: &Affine) -> bool {
        if self.terms == other.terms {
            return self.constant >= other.constant;
        }
        let extreme = |form: &Affine| form.terms.keys().any(|term| matches!(term, Term::Constant(_)));
        (extreme(self) || extreme(other))
            && other.times(-Rational::ONE).and_then(|other| self.plus(&other)?.order()) == Some(Ordering::Greater)
    }

    /// The order of the form and zero, if it is a number that tells: one that has no exact fraction here
    /// is known to fifteen digits.
    pub(crate) fn order(&self) -> Option<Ordering> {
        if self.terms.is_empty() {
            return Some(self.constant.cmp(&Rational::ZERO));
        }
        let (mut sum, mut size) = (self.constant.to_f64(), self.constant.to_f64().abs());
        for (term, factor) in &self.terms {
            let Term::Constant(bits) = term else { return None };
            let summand = factor.to_f64() * f64::from_bits(*bits);
            (sum, size) = (sum + summand, size + summand.abs());
        }
        (size.is_finite() && sum.abs() > 1e-9 * size).then(|| sum.total_cmp(&0.0))
    }
}

/// The one form of a minimum of maxima: no affine form or clause that another makes superfluous.
fn tidy(form: Lattice) -> Option<Lattice> {
    let mut clauses: Vec<Vec<Affine>> = Vec::new();
    for clause in form {
        let mut kept: Vec<Affine> = Vec::new();
        for affine in clause {
            if kept.iter().any(|k| k.dominates(&affine)) {
                continue;
            }
            kept.retain(|k| !affine.dominates(k));
            kept.push(affine);
        }
        kept.sort();
        // A clause is superfluous if it is everywhere at least as large as another one.
        let at_least = |big: &[Affine], small: &[Affine]| small.iter().all(|s| big.iter().any(|b| b.dominates(s)));
        if clauses.iter().any(|c| at_least(&kept, c)) {
            continue;
        }
        clauses.retain(|c| !at_least(c, &kept));
        clauses.push(kept);
    }
    clauses.sort();
    (clauses.iter().map(Vec::len).sum::<usize>() <= MAX_FORMS).then_some(clauses)
}

/// Combines every affine form of one side with every one of the other.
fn sum(left: &Lattice, right: &Lattice) -> Option<Lattice> {
    if left.len() * right.len() > MAX_FORMS {
        return None;
    }
    let mut form = Vec::new();
    for a in left {
        for b in right {
            let clause = a.iter().flat_map(|x| b.iter().map(move |y| x.plus(y)));
            form.push(clause.collect::<Option<Vec<_>>>()?);
        }
    }
    tidy(form)
}

fn scale(form: &Lattice, factor: Rational) -> Option<Lattice> {
    if factor.is_zero() {
        return Some(constant(0.0));
    }
    let scaled: Option<Lattice> =
        form.iter().map(|clause| clause.iter().map(|affine| affine.times(factor)).collect()).collect();
    let scaled = scaled?;
    if factor.is_positive() {
        return tidy(scaled);
    }
    // Minimum and maximum change places; distribute to get a minimum of maxima again.
    let mut result: Lattice = vec![Vec::new()];
    for clause in scaled {
        let mut next = Vec::new();
        for partial in &result {
            for affine in &clause {
                let mut longer = partial.clone();
                longer.push(affine.clone());
                next.push(longer);
            }
        }
        if next.len() > MAX_FORMS {
            return None;
        }
        result = next;
    }
    tidy(result)
}

fn minimum(left: Lattice, right: Lattice) -> Option<Lattice> {
    tidy(left.into_iter().chain(right).collect())
}

fn maximum(left: Lattice, right: Lattice) -> Option<Lattice> {
    if left.len() * right.len() > MAX_FORMS {
        return None;
    }
    let pairs = left.iter().flat_map(|a| right.iter().map(move |b| a.iter().chain(b).cloned().collect()));
    tidy(pairs.collect())
}

#[cfg(test)]
mod tests {
    use super::super::InputId;
    use super::*;

    struct Forms {
        pool: Pool,
        normaliser: Normaliser,
    }

    impl Forms {
        fn equal(&mut self, a: ExprId, b: ExprId) -> bool {
            let a = self.normaliser.normal(&self.pool, a).expect("small");
            a == self.normaliser.normal(&self.pool, b).expect("small")
        }
    }

    /// Numbers far beyond fractions of 127 bits, and the limits that are made of them.
    #[test]
    fn extreme_constants_have_an_order() {
        let mut f = Forms { pool: Pool::default(), normaliser: Normaliser::default() };
        let p = &mut f.pool;
        let (x, half, tiny) = (p.input(InputId::new(0)), p.number(0.5), p.number(1e-40));
        let (lo, hi) = (p.number(-1e30), p.number(1e30));
        let zero = p.number(0.0);
        let nothing = p.binary(BinaryOp::Multiply, zero, x);
        let sum = p.binary(BinaryOp::Add, half, nothing);
        let clamped = p.ternary(TernaryOp::Clamp, sum, lo, hi);
        let above = p.binary(BinaryOp::Max, sum, tiny);
        let limited = p.ternary(TernaryOp::Clamp, x, lo, hi);
        assert!(f.equal(clamped, half) && f.equal(above, half));
        assert!(!f.equal(limited, x) && !f.equal(above, tiny));
    }

    #[test]
    fn complement_of_a_clamped_maximum_is_a_clamped_minimum() {
        let mut f = Forms { pool: Pool::default(), normaliser: Normaliser::default() };
        let p = &mut f.pool;
        let (x, y, d) = (p.input(InputId::new(0)), p.input(InputId::new(1)), p.input(InputId::new(2)));
        let (zero, one) = (p.number(0.0), p.number(1.0));
        // 1 - clamp(max(d - x, 1 - y)) and clamp(min(1 + x - d, y))
        let a = p.binary(BinaryOp::Subtract, d, x);
        let b = p.binary(BinaryOp::Subtract, one, y);
        let m = p.binary(BinaryOp::Max, a, b);
        let m = p.ternary(TernaryOp::Clamp, m, zero, one);
        let left = p.binary(BinaryOp::Subtract, one, m);
        let c = p.binary(BinaryOp::Add, one, x);
        let c = p.binary(BinaryOp::Subtract, c, d);
        let n = p.binary(BinaryOp::Min, c, y);
        let right = p.unary(UnaryOp::Saturate, n);
        assert!(f.equal(left, right));
        let wrong = f.pool.binary(BinaryOp::Min, c, x);
        let wrong = f.pool.unary(UnaryOp::Saturate, wrong);
        assert!(!f.equal(left, wrong));
    }
}
