//! The numbers that an expression lies between where some inputs have known levels.
//!
//! For questions that are asked before there is a program: can a divisor be zero, can a result
//! leave its range? Levels are gone through one by one; what else is open is taken as it comes,
//! so an answer is never too narrow.

use std::collections::HashMap;

use super::bits::InputSet;
use super::operators::{ANY, Bounds, Comparison};
use super::pool::{Cond, CondId, ExprId, Node, Pool};
use super::{BinaryOp, InputId, Real};

/// Most combinations of levels that are gone through, times what is asked of each.
const MAX_COMBINATIONS: usize = 1 << 16;

/// An answer, with the levels at which it was found; nothing, if there is none anywhere.
pub(super) type Found<T> = Option<(T, Vec<(InputId, u8)>)>;

/// Levels of some inputs, and what follows from them.
pub(super) struct Spans<'p> {
    pool: &'p Pool,
    /// By input, its level, where it is known.
    levels: Vec<Option<u8>>,
    spans: HashMap<ExprId, Bounds>,
    truths: HashMap<CondId, Option<bool>>,
}

impl<'p> Spans<'p> {
    /// The outcome of a condition, if the known levels decide it.
    pub(super) fn truth(&mut self, condition: CondId) -> Option<bool> {
        if let Some(known) = self.truths.get(&condition) {
            return *known;
        }
        let pool = self.pool;
        let truth = match pool.cond(condition) {
            Cond::Const(value) => Some(*value),
            Cond::Level(input, levels) => self.levels[input.index()].map(|level| levels.contains(level)),
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.span(*a), self.span(*b));
                match op {
                    Comparison::Less if a.1 < b.0 => Some(true),
                    Comparison::LessEqual if a.1 <= b.0 => Some(true),
                    Comparison::Equal if a.0 == a.1 && a == b => Some(true),
                    Comparison::Less if a.0 >= b.1 => Some(false),
                    Comparison::LessEqual if a.0 > b.1 => Some(false),
                    Comparison::Equal if a.1 < b.0 || b.1 < a.0 => Some(false),
                    Comparison::Less | Comparison::LessEqual | Comparison::Equal => None,
                }
            }
            Cond::Not(a) => self.truth(*a).map(|value| !value),
            Cond::And(parts) => self.junction(parts, false),
            Cond::Or(parts) => self.junction(parts, true),
            Cond::If(c, a, b) => match self.truth(*c) {
                Some(chosen) => self.truth(if chosen { *a } else { *b }),
                None => None,
            },
        };
        self.truths.insert(condition, truth);
        truth
    }

    fn junction(&mut self, parts: &[CondId], deciding: bool) -> Option<bool> {
        let outcomes: Vec<Option<bool>> = parts.iter().map(|part| self.truth(*part)).collect();
        match outcomes.contains(&Some(deciding)) {
            true => Some(deciding),
            false => (!outcomes.contains(&None)).then_some(!deciding),
        }
    }

    /// The numbers that an expression lies between; everything where that is not known.
    pub(super) fn span(&mut self, expr: ExprId) -> Bounds {
        if let Some(known) = self.spans.get(&expr) {
            return *known;
        }
        let pool = self.pool;
        let (bounds, fails) = match pool.node(expr) {
            Node::Const(number) => ((number.get(), number.get()), None),
            Node::Word(word) => ((f64::from(word), f64::from(word)), None),
            Node::Index(input) => match self.levels[input.index()] {
                Some(level) => ((f64::from(level), f64::from(level)), None),
                None => (pool.expr_facts(expr).range, None),
            },
            Node::Input(_) | Node::Result(_) => (pool.expr_facts(expr).range, None),
            Node::Unary(op, a) => op.image(self.span(a)),
            Node::Binary(op, a, b) => match (op, self.span(a), self.span(b)) {
                // Of known numbers, what they come to.
                (BinaryOp::WholeQuotient | BinaryOp::WholeRemainder, a, b) if a.0 == a.1 && b.0 == b.1 => {
                    let value = op.apply(a.0, b.0);
                    ((value, value), None)
                }
                (op, a, b) => op.image(a, b),
            },
            Node::Ternary(op, a, b, c) => op.image(self.span(a), self.span(b), self.span(c)),
            Node::Select(condition, a, b) => match self.truth(condition) {
                Some(chosen) => (self.span(if chosen { a } else { b }), None),
                None => {
                    let (a, b) = (self.span(a), self.span(b));
                    ((a.0.min(b.0), a.1.max(b.1)), None)
                }
            },
        };
        let bounds = if fails.is_some() { ANY } else { bounds };
        self.spans.insert(expr, bounds);
        bounds
    }

    /// Goes through all levels of some discrete inputs, each with its number of levels, until `found` has an
    /// answer; of each it asks so many questions. `None` if they are too many.
    pub(super) fn search<T>(
        pool: &'p Pool,
        (inputs, questions): (InputSet, usize),
        counts: &[Option<usize>],
        mut found: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Found<T>> {
        let digits: Vec<(InputId, usize)> =
            inputs.iter().filter_map(|input| Some((input, counts[input.index()]?))).collect();
        let all = digits.iter().try_fold(1_usize, |all, (_, count)| all.checked_mul(*count))?;
        if all.saturating_mul(questions) > MAX_COMBINATIONS {
            return None;
        }
        for number in 0..all {
            let mut spans =
                Self { pool, levels: vec![None; counts.len()], spans: HashMap::new(), truths: HashMap::new() };
            let mut rest = number;
            let mut chosen = Vec::with_capacity(digits.len());
            for (input, count) in &digits {
                let level = (rest % count) as u8;
                spans.levels[input.index()] = Some(level);
                chosen.push((*input, level));
                rest /= count;
            }
            if let Some(answer) = found(&mut spans) {
                return Some(Some((answer, chosen)));
            }
        }
        Some(None)
    }
}

/// Terms that depend on one discrete input alone, at one of its levels.
pub(super) struct Tabulation<'p, T> {
    pool: &'p Pool,
    input: InputId,
    level: u8,
    numbers: HashMap<ExprId, T>,
    truths: HashMap<CondId, bool>,
}

impl<'p, T: Real> Tabulation<'p, T> {
    pub(super) fn new(pool: &'p Pool, input: InputId, level: u8) -> Self {
        Self { pool, input, level, numbers: HashMap::new(), truths: HashMap::new() }
    }

    /// The value of an expression; no number, if another input is in it.
    pub(super) fn number(&mut self, expr: ExprId) -> T {
        if let Some(known) = self.numbers.get(&expr) {
            return *known;
        }
        let value = match self.pool.node(expr) {
            Node::Const(number) => T::from_f64(number.get()),
            Node::Word(word) => T::from_word(word),
            Node::Index(input) if input == self.input => T::from_f64(f64::from(self.level)),
            Node::Index(_) | Node::Input(_) | Node::Result(_) => T::from_f64(f64::NAN),
            Node::Unary(op, a) => T::unary(op, self.number(a)),
            Node::Binary(op, a, b) => T::binary(op, self.number(a), self.number(b)),
            Node::Ternary(op, a, b, c) => T::ternary(op, self.number(a), self.number(b), self.number(c)),
            Node::Select(condition, a, b) => {
                let chosen = if self.holds(condition) { a } else { b };
                self.number(chosen)
            }
        };
        self.numbers.insert(expr, value);
        value
    }

    fn holds(&mut self, condition: CondId) -> bool {
        if let Some(known) = self.truths.get(&condition) {
            return *known;
        }
        let pool = self.pool;
        let holds = match pool.cond(condition) {
            Cond::Const(value) => *value,
            Cond::Level(_, levels) => levels.contains(self.level),
            Cond::Compare(op, a, b) => op.holds_of(pool.is_word(*a), self.number(*a), self.number(*b)),
            Cond::Not(a) => !self.holds(*a),
            Cond::And(parts) => parts.iter().all(|part| self.holds(*part)),
            Cond::Or(parts) => parts.iter().any(|part| self.holds(*part)),
            Cond::If(c, a, b) => {
                let chosen = if self.holds(*c) { a } else { b };
                self.holds(*chosen)
            }
        };
        self.truths.insert(condition, holds);
        holds
    }
}
