//! Terms of one program in another: each input means something else there.
//!
//! This is how a table of cases is called by another one, and how a table is made of which some
//! inputs are decided. Constants that arise are folded as in calls: only if nobody can tell.

use std::collections::HashMap;

use super::bits::LevelSet;
use super::pool::{Cond, CondId, ExprId, Node, Pool};
use super::{InputId, Line, Program};

/// The place that terms are carried to, and what inputs mean there.
pub(super) trait Meanings {
    /// The pool of the new terms.
    fn pool(&mut self) -> &mut Pool;
    /// The meaning of a continuous input.
    fn number(&mut self, input: InputId) -> ExprId;
    /// The index of the level of a discrete input.
    fn index(&mut self, input: InputId) -> ExprId;
    /// The condition that an input has one of some levels.
    fn level(&mut self, input: InputId, levels: LevelSet) -> CondId;
}

/// A way from the terms of a program to those of another.
pub(super) struct Substitution<'p, M> {
    from: &'p Program,
    to: M,
    exprs: HashMap<ExprId, ExprId>,
    conds: HashMap<CondId, CondId>,
}

impl<'p, M: Meanings> Substitution<'p, M> {
    pub(super) fn new(from: &'p Program, to: M) -> Self {
        Self { from, to, exprs: HashMap::new(), conds: HashMap::new() }
    }

    /// The place that terms are carried to.
    pub(super) fn to(&mut self) -> &mut M {
        &mut self.to
    }

    /// The same, when all is done.
    pub(super) fn into_to(self) -> M {
        self.to
    }

    /// An expression, with its label.
    pub(super) fn expr(&mut self, id: ExprId) -> ExprId {
        if let Some(done) = self.exprs.get(&id) {
            return *done;
        }
        let new = match self.from.pool.node(id) {
            Node::Input(input) => self.to.number(input),
            Node::Index(input) => self.to.index(input),
            Node::Select(condition, then, other) => {
                let condition = self.cond(condition);
                // A side that is never chosen is no part of the new program.
                match self.to.pool().truth(condition) {
                    Some(true) => self.expr(then),
                    Some(false) => self.expr(other),
                    None => {
                        let (then, other) = (self.expr(then), self.expr(other));
                        self.to.pool().select(condition, then, other)
                    }
                }
            }
            node @ (Node::Const(_)
            | Node::Word(_)
            | Node::Result(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)) => {
                let node = node.map(|part| self.expr(part));
                self.to.pool().rebuild(node)
            }
        };
        if let Some(label) = self.from.pool.label(id) {
            self.to.pool().set_label(new, label);
        }
        self.exprs.insert(id, new);
        new
    }

    /// A condition.
    pub(super) fn cond(&mut self, id: CondId) -> CondId {
        if let Some(done) = self.conds.get(&id) {
            return *done;
        }
        let from = self.from;
        let new = match from.pool.cond(id) {
            Cond::Const(value) => self.to.pool().always(*value),
            Cond::Level(input, levels) => self.to.level(*input, *levels),
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.expr(*a), self.expr(*b));
                self.to.pool().recompare(*op, a, b)
            }
            Cond::Not(a) => {
                let a = self.cond(*a);
                self.to.pool().not(a)
            }
            Cond::And(parts) => {
                let parts: Vec<CondId> = parts.iter().map(|part| self.cond(*part)).collect();
                self.to.pool().and(parts)
            }
            Cond::Or(parts) => {
                let parts: Vec<CondId> = parts.iter().map(|part| self.cond(*part)).collect();
                self.to.pool().or(parts)
            }
            Cond::If(condition, then, other) => {
                let [condition, then, other] = [condition, then, other].map(|part| self.cond(*part));
                self.to.pool().cond_if(condition, then, other)
            }
        };
        self.conds.insert(id, new);
        new
    }

    /// Several expressions.
    pub(super) fn exprs(&mut self, all: &[ExprId]) -> Vec<ExprId> {
        all.iter().map(|expr| self.expr(*expr)).collect()
    }

    /// The result of the whole program, one expression per component: choices between the values of its rows.
    pub(super) fn result(&mut self) -> Vec<ExprId> {
        let from = self.from;
        let default = self.exprs(&from.default);
        from.rows.iter().rev().fold(default.clone(), |rest, row| {
            let guard = self.cond(row.guard);
            if self.to.pool().truth(guard) == Some(false) {
                return rest;
            }
            let value = row.lines.iter().rev().fold(default.clone(), |rest, line| self.line(line, &rest));
            self.either(guard, &value, &rest)
        })
    }

    fn line(&mut self, line: &Line, rest: &[ExprId]) -> Vec<ExprId> {
        let condition = self.cond(line.condition);
        let values = self.exprs(&line.values);
        self.either(condition, &values, rest)
    }

    fn either(&mut self, condition: CondId, then: &[ExprId], other: &[ExprId]) -> Vec<ExprId> {
        then.iter().zip(other).map(|(then, other)| self.to.pool().select(condition, *then, *other)).collect()
    }
}
