//! The facts known on the way to a step, and the terms that they simplify.

use std::collections::HashMap;

use crate::program::comparisons::Comparisons;
use crate::program::{Comparison, Cond, CondId, ExprId, InputId, InputSet, LevelSet, Node, Pool, Program};

/// The facts that hold at a step.
#[derive(Debug, Clone)]
pub(super) struct Knowledge {
    /// Inputs that were fetched.
    pub(super) fetched: InputSet,
    /// Levels that each discrete input may still have.
    levels: Vec<LevelSet>,
    /// The outcomes of comparisons.
    compared: Comparisons,
    /// Other conditions that were tested.
    tested: Vec<(CondId, bool)>,
}

impl Knowledge {
    /// Nothing is known.
    pub(super) fn none(program: &Program) -> Self {
        let levels = (0..program.inputs.len())
            .map(|i| LevelSet::all(program.levels(InputId::new(i)).map_or(0, |levels| levels.count())))
            .collect();
        Self { fetched: InputSet::default(), levels, compared: Comparisons::default(), tested: Vec::new() }
    }

    /// Restricts the levels of an input.
    pub(super) fn restrict(&mut self, input: InputId, levels: LevelSet) {
        self.levels[input.index()].0 &= levels.0;
    }

    /// The same, with more inputs fetched.
    pub(super) fn with_fetched(&self, inputs: InputSet) -> Self {
        Self { fetched: self.fetched.or(inputs), ..self.clone() }
    }

    /// The same, with a condition found to be `value`.
    pub(super) fn with(&self, pool: &Pool, condition: CondId, value: bool) -> Self {
        let mut next = self.clone();
        next.assume(pool, condition, value);
        next
    }

    /// The same, with the outcome of conditions that were taken apart.
    pub(super) fn with_outcome(&self, conditions: [CondId; 2], value: bool) -> Self {
        let mut next = self.clone();
        for condition in conditions {
            if !next.tested.contains(&(condition, value)) {
                next.tested.push((condition, value));
            }
        }
        next
    }

    fn assume(&mut self, pool: &Pool, condition: CondId, value: bool) {
        match pool.cond(condition) {
            Cond::Level(input, levels) => {
                let allowed = if value { levels.0 } else { !levels.0 };
                self.restrict(*input, LevelSet(allowed));
            }
            Cond::Not(inner) => self.assume(pool, *inner, !value),
            Cond::And(parts) if value => parts.iter().for_each(|part| self.assume(pool, *part, true)),
            Cond::Or(parts) if !value => parts.iter().for_each(|part| self.assume(pool, *part, false)),
            Cond::Compare(op, a, b) => self.compared.learn(pool, *op, *a, *b, value),
            Cond::Const(_) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => self.tested.push((condition, value)),
        }
    }

    /// The outcome of a comparison, as far as other comparisons say.
    pub(super) fn compared(&self, pool: &Pool, op: Comparison, a: ExprId, b: ExprId) -> Option<bool> {
        self.compared.decide(pool, op, a, b)
    }

    /// A condition, with everything known put in.
    pub(super) fn cond(&self, pool: &mut Pool, condition: CondId) -> CondId {
        if let Some((_, value)) = self.tested.iter().find(|(known, _)| *known == condition) {
            return pool.always(*value);
        }
        match pool.cond(condition).clone() {
            Cond::Const(_) => condition,
            Cond::Level(input, levels) => {
                let possible = self.levels[input.index()];
                match possible.0 & levels.0 {
                    0 => pool.always(false),
                    some if some == possible.0 => pool.always(true),
                    _ => condition,
                }
            }
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.expr(pool, a), self.expr(pool, b));
                match self.compared.decide(pool, op, a, b) {
                    Some(outcome) => pool.always(outcome),
                    None => pool.recompare(op, a, b),
                }
            }
            Cond::Not(a) => {
                let a = self.cond(pool, a);
                pool.not(a)
            }
            Cond::And(parts) => {
                let parts: Vec<CondId> = parts.into_iter().map(|part| self.cond(pool, part)).collect();
                pool.and(parts)
            }
            Cond::Or(parts) => {
                let parts: Vec<CondId> = parts.into_iter().map(|part| self.cond(pool, part)).collect();
                pool.or(parts)
            }
            Cond::If(c, a, b) => {
                let (c, a, b) = (self.cond(pool, c), self.cond(pool, a), self.cond(pool, b));
                pool.cond_if(c, a, b)
            }
        }
    }

    /// An expression, with everything known put in. Only selections are
    /// resolved; arithmetic stays as it is, so that rounding does. What becomes
    /// constant is folded if nobody can tell; otherwise it is computed when the
    /// shader runs: `1 / f32(n)` with `n` known to be 0 would be a constant that
    /// shading languages refuse.
    pub(super) fn expr(&self, pool: &mut Pool, expr: ExprId) -> ExprId {
        self.expr_memo(pool, expr, &mut HashMap::new())
    }

    fn expr_memo(&self, pool: &mut Pool, expr: ExprId, memo: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if let Some(done) = memo.get(&expr) {
            return *done;
        }
        let result = match pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Result(_) => expr,
            Node::Index(input) => match self.levels[input.index()] {
                one if one.0.is_power_of_two() => pool.number(f64::from(one.0.trailing_zeros())),
                _ => expr,
            },
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.expr_memo(pool, part, memo));
                pool.settle(node)
            }
            Node::Select(c, a, b) => {
                let c = self.cond(pool, c);
                match pool.truth(c) {
                    Some(true) => self.expr_memo(pool, a, memo),
                    Some(false) => self.expr_memo(pool, b, memo),
                    None => {
                        // Each side knows how the choice went.
                        let (yes, no) = (self.with(pool, c, true), self.with(pool, c, false));
                        let (a, b) = (yes.expr(pool, a), no.expr(pool, b));
                        pool.select(c, a, b)
                    }
                }
            }
        };
        memo.insert(expr, result);
        result
    }
}
