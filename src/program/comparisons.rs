//! The outcomes of comparisons, and those of others that follow from them.
//!
//! `x < c`, `x <= c`, `x == c`, `x >= c` and `x > c` are one question about `x` and `c`, whose answer is
//! less, equal, greater, or unordered where `x` is no number; and constants have an order, so that
//! `x < 1` says `x < 2` as well. Two numbers of which neither is a constant are one question, too.
//!
//! Whatever is said here to follow does so in `f32`, with constants rounded to `f32`, as generated code
//! has them. Of constants that a device may take for 0, being subnormal, nothing follows. A number is
//! unordered unless its range says that it is finite ([`Facts::range`](super::Facts)).

use std::rc::Rc;

use super::operators::ANY;
use super::{Comparison, ExprId, Pool};

/// The subject of a comparison: a number that is compared with constants, or two numbers of which
/// the difference is, with 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Subject(ExprId, Option<ExprId>);

impl Subject {
    /// Returns whether it is ordered with every constant, never being something other than a number.
    pub(crate) fn is_ordered(self, pool: &Pool) -> bool {
        let finite = |expr: ExprId| pool.expr_facts(expr).range != ANY;
        finite(self.0) && self.1.is_none_or(finite)
    }

    /// The number that is compared with constants.
    pub(crate) fn number(self) -> Option<ExprId> {
        self.1.is_none().then_some(self.0)
    }
}

/// The relation of a subject to a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Relation {
    Below,
    AtMost,
    Equal,
    AtLeast,
    Above,
}

/// A comparison as a question about a subject: its relation to a constant. None if both are constants,
/// and if the constant is not the same number on every device.
pub(crate) fn question(pool: &Pool, op: Comparison, a: ExprId, b: ExprId) -> Option<(Subject, Relation, f32)> {
    let constant = |expr: ExprId| pool.constant(expr).map(|constant| constant as f32);
    let (subject, relation, constant) = related(op, (a, constant(a)), (b, constant(b)))?;
    (constant == 0.0 || constant.is_normal()).then_some((subject, relation, constant))
}

/// The same of two numbers, either of which may be a constant.
fn related(
    op: Comparison,
    (a, of_a): (ExprId, Option<f32>),
    (b, of_b): (ExprId, Option<f32>),
) -> Option<(Subject, Relation, f32)> {
    let relation = match op {
        Comparison::Less => Relation::Below,
        Comparison::LessEqual => Relation::AtMost,
        Comparison::Equal => Relation::Equal,
    };
    let flipped = match op {
        Comparison::Less => Relation::Above,
        Comparison::LessEqual => Relation::AtLeast,
        Comparison::Equal => Relation::Equal,
    };
    match (of_a, of_b) {
        (Some(_), Some(_)) => None,
        (None, Some(constant)) => Some((Subject(a, None), relation, constant)),
        (Some(constant), None) => Some((Subject(b, None), flipped, constant)),
        (None, None) if a <= b => Some((Subject(a, Some(b)), relation, 0.0)),
        (None, None) => Some((Subject(b, Some(a)), flipped, 0.0)),
    }
}

/// An end of what is possible.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    at: f32,
    /// True if it is itself not possible.
    open: bool,
}

/// The values that a subject can still have.
#[derive(Debug, Clone, PartialEq)]
struct Possible {
    lo: Option<End>,
    hi: Option<End>,
    /// Constants that it is not equal to.
    apart: Vec<f32>,
    /// True if it may be no number.
    unordered: bool,
}

impl Possible {
    /// The outcome of a comparison, if it is the same for all that is possible.
    fn decides(&self, relation: Relation, constant: f32) -> Option<bool> {
        // Nothing is left but what is no number, and that fails every comparison.
        if let (Some(lo), Some(hi)) = (self.lo, self.hi)
            && (lo.at > hi.at || lo.at == hi.at && (lo.open || hi.open))
        {
            return Some(false);
        }
        let all_above = self.lo.is_some_and(|End { at, open }| at > constant || at == constant && open);
        let all_below = self.hi.is_some_and(|End { at, open }| at < constant || at == constant && open);
        let none_below = self.lo.is_some_and(|end| end.at >= constant);
        let none_above = self.hi.is_some_and(|end| end.at <= constant);
        let (holds, fails) = match relation {
            Relation::Below => (all_below, none_below),
            Relation::AtMost => (none_above, all_above),
            Relation::Equal => (none_below && none_above, all_below || all_above || self.apart.contains(&constant)),
            Relation::AtLeast => (none_below, all_below),
            Relation::Above => (all_above, none_above),
        };
        match (holds && !self.unordered, fails) {
            (true, _) => Some(true),
            (false, true) => Some(false),
            (false, false) => None,
        }
    }

    fn restrict(&mut self, relation: Relation, constant: f32, holds: bool) {
        self.unordered &= !holds;
        let (lo, hi) = match (relation, holds) {
            (Relation::Below, true) | (Relation::AtLeast, false) => (None, Some(true)),
            (Relation::AtMost, true) | (Relation::Above, false) => (None, Some(false)),
            (Relation::AtLeast, true) | (Relation::Below, false) => (Some(false), None),
            (Relation::Above, true) | (Relation::AtMost, false) => (Some(true), None),
            (Relation::Equal, true) => (Some(false), Some(false)),
            (Relation::Equal, false) => {
                self.apart.push(constant);
                (None, None)
            }
        };
        if let Some(open) = lo
            && self.lo.is_none_or(|end| end.at < constant || end.at == constant && open)
        {
            self.lo = Some(End { at: constant, open });
        }
        if let Some(open) = hi
            && self.hi.is_none_or(|end| end.at > constant || end.at == constant && open)
        {
            self.hi = Some(End { at: constant, open });
        }
        for end in [&mut self.lo, &mut self.hi].into_iter().flatten() {
            end.open |= self.apart.contains(&end.at);
        }
    }
}

/// The outcomes of comparisons so far. Copies share what they have in common.
#[derive(Debug, Clone, Default)]
pub(crate) struct Comparisons {
    newest: Option<Rc<Known>>,
}

/// The knowledge of a subject, and what was known before.
#[derive(Debug)]
struct Known {
    subject: Subject,
    possible: Possible,
    before: Option<Rc<Known>>,
}

impl Comparisons {
    fn of(&self, subject: Subject) -> Option<&Possible> {
        let mut at = self.newest.as_deref();
        while let Some(known) = at {
            if known.subject == subject {
                return Some(&known.possible);
            }
            at = known.before.as_deref();
        }
        None
    }

    /// The outcome of a comparison, if it follows from the others.
    pub(crate) fn decide(&self, pool: &Pool, op: Comparison, a: ExprId, b: ExprId) -> Option<bool> {
        let (subject, relation, constant) = question(pool, op, a, b)?;
        self.of(subject)?.decides(relation, constant)
    }

    /// Remembers the outcome of a comparison.
    pub(crate) fn learn(&mut self, pool: &Pool, op: Comparison, a: ExprId, b: ExprId, holds: bool) {
        let Some((subject, relation, constant)) = question(pool, op, a, b) else { return };
        let mut possible = self.of(subject).cloned().unwrap_or_else(|| Possible {
            lo: None,
            hi: None,
            apart: Vec::new(),
            unordered: !subject.is_ordered(pool),
        });
        possible.restrict(relation, constant, holds);
        self.newest = Some(Rc::new(Known { subject, possible, before: self.newest.take() }));
    }
}

impl Drop for Known {
    /// One after the other: dropped by themselves, long lists would nest.
    fn drop(&mut self) {
        let mut next = self.before.take();
        while let Some(mut known) = next.and_then(|known| Rc::try_unwrap(known).ok()) {
            next = known.before.take();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::random::Random;
    use crate::program::{InputId, UnaryOp};

    const OPS: [Comparison; 3] = [Comparison::Less, Comparison::LessEqual, Comparison::Equal];

    /// Numbers between and at the constants, and none: everything that follows from true outcomes
    /// is true in `f32`, also of constants that only `f64` tells apart, and whatever was asked is known.
    #[test]
    fn what_follows_is_true_at_every_point() {
        let constants = [0.0, 0.1, 0.1 + 1e-12, 0.25, 0.5, 0.500_000_001, 1.0, 1e-40];
        let mut values: Vec<f64> =
            constants.iter().flat_map(|c| [*c, c - 0.01, c + 0.01, f64::from(*c as f32)]).collect();
        values.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]);
        let mut random = Random::new(5);
        let (mut decided, mut open) = (0, 0);
        for round in 0..4000 {
            let mut pool = Pool::default();
            pool.declare(InputId::new(0), (-1.0, 2.0));
            pool.declare(InputId::new(1), (-1.0, 2.0));
            let input = pool.input(InputId::new(0));
            let subject = if round % 2 == 0 { input } else { pool.unary(UnaryOp::Sqrt, input) };
            let value = values[random.below(values.len())];
            let finite = Subject(subject, None).is_ordered(&pool);
            assert_eq!(finite, round % 2 == 0);
            if finite && !value.is_finite() {
                continue;
            }
            let mut known = Comparisons::default();
            for _ in 0..6 {
                let (op, constant) = (OPS[random.below(3)], constants[random.below(constants.len())]);
                let number = pool.number(constant);
                let flipped = random.below(2) == 0;
                let (a, b) = if flipped { (number, subject) } else { (subject, number) };
                let (x, y) = if flipped { (constant, value) } else { (value, constant) };
                let holds = op.holds(x as f32, y as f32);
                match known.decide(&pool, op, a, b) {
                    Some(said) => {
                        assert_eq!(said, holds, "{op:?} {x} {y}");
                        decided += 1;
                    }
                    None => {
                        open += 1;
                        known.learn(&pool, op, a, b, holds);
                        let normal = constant == 0.0 || (constant as f32).is_normal();
                        assert_eq!(known.decide(&pool, op, a, b), normal.then_some(holds));
                    }
                }
            }
        }
        assert!(decided > 4000 && open > 4000, "{decided} {open}");
    }

    #[test]
    fn one_constant_is_one_question_and_constants_have_an_order() {
        let mut pool = Pool::default();
        pool.declare(InputId::new(0), (0.0, 1.0));
        pool.declare(InputId::new(1), (0.0, 1.0));
        let (x, y) = (pool.input(InputId::new(0)), pool.input(InputId::new(1)));
        let root = pool.unary(UnaryOp::Sqrt, x);
        let (half, one) = (pool.number(0.5), pool.number(1.0));
        use Comparison::{Equal, Less, LessEqual};
        let mut known = Comparisons::default();
        known.learn(&pool, Less, x, half, false);
        for (op, a, b, outcome) in [
            (LessEqual, half, x, Some(true)),
            (Less, half, x, None),
            (Equal, x, half, None),
            (LessEqual, x, half, None),
            (Less, x, one, None),
            (Less, one, x, None),
        ] {
            assert_eq!(known.decide(&pool, op, a, b), outcome, "{op:?}");
        }
        known.learn(&pool, Equal, x, half, false);
        assert_eq!(known.decide(&pool, LessEqual, x, half), Some(false));
        // A root may be no number, which is below nothing and not above it, either.
        known.learn(&pool, Less, root, half, false);
        assert_eq!(known.decide(&pool, LessEqual, half, root), None);
        assert_eq!(known.decide(&pool, Less, root, half), Some(false));
        let mut neither = known.clone();
        neither.learn(&pool, LessEqual, half, root, false);
        for (op, a, b) in [(Less, root, one), (Less, one, root), (Equal, root, one)] {
            assert_eq!(neither.decide(&pool, op, a, b), Some(false));
        }
        known.learn(&pool, LessEqual, half, root, true);
        assert_eq!(known.decide(&pool, Less, root, half), Some(false));
        // Two numbers, either way round.
        known.learn(&pool, Less, x, y, true);
        assert_eq!(known.decide(&pool, LessEqual, y, x), Some(false));
        assert_eq!(known.decide(&pool, Equal, y, x), Some(false));
        assert_eq!(known.decide(&pool, LessEqual, x, y), Some(true));
    }

    #[test]
    fn long_lists_are_dropped_without_nesting() {
        let mut pool = Pool::default();
        let x = pool.input(InputId::new(0));
        let mut known = Comparisons::default();
        for i in 0..300_000 {
            let number = pool.number(f64::from(i));
            known.learn(&pool, Comparison::Less, x, number, false);
        }
        drop(known);
    }
}
