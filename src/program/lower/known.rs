//! The knowledge of one side of a choice: inside of it, its condition need not be asked again.
//!
//! Lists that are put together choose between components by the same few conditions, or by ones that
//! exclude each other, over and over. What an outer choice has decided is left out of the inner ones.

use std::collections::HashMap;

use super::Lowering;
use crate::program::InputId;
use crate::program::bits::LevelSet;
use crate::program::pool::{Cond, CondId, ExprId, Node, Pool};

/// Conditions whose outcome is known.
#[derive(Default)]
struct Known {
    outcomes: HashMap<CondId, bool>,
    /// The levels that inputs can still have.
    levels: HashMap<InputId, u64>,
}

impl Known {
    fn learn(&mut self, pool: &Pool, condition: CondId, holds: bool) {
        self.outcomes.insert(condition, holds);
        match pool.cond(condition) {
            Cond::Not(inner) => self.learn(pool, *inner, !holds),
            Cond::And(parts) if holds => parts.iter().for_each(|part| self.learn(pool, *part, true)),
            Cond::Or(parts) if !holds => parts.iter().for_each(|part| self.learn(pool, *part, false)),
            Cond::Level(input, levels) => {
                *self.levels.entry(*input).or_insert(u64::MAX) &= if holds { levels.0 } else { !levels.0 };
            }
            Cond::Const(_) | Cond::Compare(..) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {}
        }
    }

    fn decide(&self, pool: &Pool, condition: CondId) -> Option<bool> {
        if let Some(known) = self.outcomes.get(&condition) {
            return Some(*known);
        }
        let all = |parts: &[CondId], stop: bool| {
            let mut open = false;
            for part in parts {
                match self.decide(pool, *part) {
                    Some(holds) if holds == stop => return Some(stop),
                    Some(_) => {}
                    None => open = true,
                }
            }
            (!open).then_some(!stop)
        };
        match pool.cond(condition) {
            Cond::Const(holds) => Some(*holds),
            Cond::Level(input, LevelSet(asked)) => match self.levels.get(input)? {
                left if left & asked == 0 => Some(false),
                left if left & !asked == 0 => Some(true),
                _ => None,
            },
            Cond::Not(inner) => self.decide(pool, *inner).map(|holds| !holds),
            Cond::And(parts) => all(parts, false),
            Cond::Or(parts) => all(parts, true),
            Cond::If(condition, then, other) => {
                let side = if self.decide(pool, *condition)? { then } else { other };
                self.decide(pool, *side)
            }
            Cond::Compare(..) => None,
        }
    }
}

impl Lowering<'_> {
    /// Components that are chosen one by one, without asking inside of a side for what the choice has decided.
    pub(super) fn either(&mut self, condition: CondId, then: &[ExprId], other: &[ExprId]) -> Vec<ExprId> {
        let [then, other] = [(then, true), (other, false)].map(|(side, holds)| self.side(condition, holds, side));
        then.into_iter().zip(other).map(|(then, other)| self.pool.select(condition, then, other)).collect()
    }

    /// Components where a condition holds.
    pub(super) fn where_it_holds(&mut self, condition: CondId, components: &[ExprId]) -> Vec<ExprId> {
        self.side(condition, true, components)
    }

    fn side(&mut self, condition: CondId, holds: bool, components: &[ExprId]) -> Vec<ExprId> {
        let mut known = Known::default();
        known.learn(&self.pool, condition, holds);
        let mut done = HashMap::new();
        components.iter().map(|expr| self.within(*expr, &known, &mut done)).collect()
    }

    /// An expression where something is known.
    fn within(&mut self, expr: ExprId, known: &Known, done: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if let Some(new) = done.get(&expr) {
            return *new;
        }
        let Node::Select(condition, then, other) = self.pool.node(expr) else { return expr };
        let new = match known.decide(&self.pool, condition) {
            Some(true) => self.within(then, known, done),
            Some(false) => self.within(other, known, done),
            None => {
                let [then, other] = [then, other].map(|side| self.within(side, known, done));
                self.pool.select(condition, then, other)
            }
        };
        done.insert(expr, new);
        new
    }
}
