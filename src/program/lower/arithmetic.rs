//! Operations on terms, component by component, and the constants that they make.
//!
//! Whatever makes an operation while a table is lowered makes it here: what is written,
//! and what a function is expanded to. So there is one place at which constants are
//! judged, and it judges them as `f32`, which is what shaders compute in.

use super::terms::{Term, type_error};
use super::{Lowering, Result, SINCE};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::InputId;
use crate::program::bits::LevelSet;
use crate::program::operators::{BinaryOp, Comparison, TernaryAlgebra, TernaryOp, UnaryOp};
use crate::program::pool::{CondId, ExprId, Node};
use crate::program::spans::Tabulation;

/// Most operations of a comparison that is looked at level by level.
const MAX_TABULATED: u32 = 2_000;

/// Refuses a constant that no shader can contain.
fn check_finite(value: f64, span: Span) -> Result<()> {
    if (value as f32).is_finite() {
        return Ok(());
    }
    let shown = if value.is_nan() { "not a number".to_owned() } else { format!("{value:e}") };
    Err(Diagnostic::error(codes::NOT_FINITE, format!("a constant here is {shown}"))
        .at(span, "not a finite f32 number")
        .help("constants are folded by the compiler; shading languages refuse such a constant"))
}

impl Lowering<'_> {
    /// A constant that is written, or counted by the compiler.
    pub(super) fn constant(&mut self, value: f64, span: Span) -> Result<ExprId> {
        let expr = self.pool.number(value);
        self.finite(expr, span)
    }

    /// Refuses constants that no shader can contain.
    fn finite(&self, expr: ExprId, span: Span) -> Result<ExprId> {
        self.pool.constant(expr).map_or(Ok(()), |value| check_finite(value, span))?;
        Ok(expr)
    }

    /// An operation on one number. In a function that is called with constants,
    /// what they make constant is computed when the shader runs, unless the result is bit-identical.
    pub(super) fn unary_number(&mut self, op: UnaryOp, a: ExprId, span: Span) -> Result<ExprId> {
        let result = match self.calling.is_empty() {
            true => self.pool.unary(op, a),
            false => self.pool.rebuild(Node::Unary(op, a)),
        };
        self.finite(result, span)
    }

    /// An operation on two numbers; see [`Self::unary_number`].
    pub(super) fn binary_number(&mut self, op: BinaryOp, a: ExprId, b: ExprId, span: Span) -> Result<ExprId> {
        self.check_divisor(op, b, span)?;
        let result = match self.calling.is_empty() {
            true => self.pool.binary(op, a, b),
            false => self.pool.rebuild(Node::Binary(op, a, b)),
        };
        self.finite(result, span)
    }

    /// Refuses to divide by a constant that is zero in `f32`. What a function does with its
    /// arguments may be undefined there, as long as it says so.
    pub(super) fn check_divisor(&self, op: BinaryOp, divisor: ExprId, span: Span) -> Result<()> {
        let divides = matches!(op, BinaryOp::Divide | BinaryOp::Remainder) && self.calling.is_empty();
        match self.pool.constant(divisor).filter(|value| divides && *value as f32 == 0.0) {
            None => Ok(()),
            Some(value) => {
                let error = Diagnostic::error(codes::DIVISION_BY_ZERO, "division by zero");
                Err(match value == 0.0 {
                    true => error.at(span, "this is always zero"),
                    false => error
                        .at(span, format!("this is always {value:e}, which is zero in f32"))
                        .help("the smallest number that f32 tells from zero is about 1.4e-45"),
                })
            }
        }
    }

    /// An operation on three numbers; see [`Self::unary_number`].
    pub(super) fn ternary_number(&mut self, op: TernaryOp, [a, b, c]: [ExprId; 3], span: Span) -> Result<ExprId> {
        if let Some((lo, hi)) = op.misordered([a, b, c].map(|part| self.pool.constant(part))) {
            let mut error =
                Diagnostic::error(codes::DOMAIN, format!("the lower bound {lo} is not below the upper bound {hi}"))
                    .at(span, "shading languages leave this undefined");
            if lo < hi {
                error = error.help("they are the same number in f32");
            }
            return Err(error);
        }
        // Not every language has the operation: some compute the product by itself.
        if let (TernaryAlgebra::ProductAndSum, Some(x), Some(y)) =
            (op.row().algebra, self.pool.constant(a), self.pool.constant(b))
        {
            check_finite(x * y, span)?;
        }
        let result = match self.calling.is_empty() {
            true => self.pool.ternary(op, a, b, c),
            false => self.pool.rebuild(Node::Ternary(op, a, b, c)),
        };
        self.finite(result, span)
    }

    /// A comparison of two numbers; see [`Self::unary_number`].
    pub(super) fn comparison(&mut self, op: Comparison, a: ExprId, b: ExprId) -> CondId {
        if let Some(decided) = self.decided_by_level(op, a, b) {
            return decided;
        }
        match self.calling.is_empty() {
            true => self.pool.compare(op, a, b),
            false => self.pool.recompare(op, a, b),
        }
    }

    /// A comparison that the level of one input decides, as the levels for which it holds.
    fn decided_by_level(&mut self, op: Comparison, a: ExprId, b: ExprId) -> Option<CondId> {
        let words = self.pool.is_word(a);
        let facts = [a, b].map(|side| self.pool.expr_facts(side));
        let inputs: Vec<InputId> = facts[0].inputs.or(facts[1].inputs).iter().collect();
        let [input] = *inputs.as_slice() else { return None };
        let set = self.input_sets[input.index()].filter(|_| self.table.language.value >= SINCE)?;
        if facts[0].size.saturating_add(facts[1].size) > MAX_TABULATED {
            return None;
        }
        let count = self.sets[set.0].count();
        let mut levels = LevelSet(0);
        for level in 0..count as u8 {
            let wide = [a, b].map(|side| Tabulation::<f64>::new(&self.pool, input, level).number(side));
            let narrow = [a, b].map(|side| Tabulation::<f32>::new(&self.pool, input, level).number(side));
            let holds = op.holds_of(words, wide[0], wide[1]);
            let told = wide.iter().all(|side| side.is_finite()) && narrow.iter().all(|side| side.is_finite());
            // What is no number has findings of its own, and where f32 decides otherwise, code has to.
            if !(told || words) || holds != op.holds_of(words, narrow[0], narrow[1]) {
                return None;
            }
            if holds {
                levels.0 |= LevelSet::one(level).0;
            }
        }
        Some(self.pool.level(input, levels, count))
    }

    pub(super) fn map1(&mut self, op: UnaryOp, a: Term, span: Span) -> Result<Term> {
        if let Some(word) = self.word_unary(op, &a, span)? {
            return Ok(word);
        }
        if let Some([a]) = self.wholes([&a], span)? {
            return self.whole_unary(op, a, span);
        }
        match a {
            Term::Number(a) => Ok(Term::Number(self.unary_number(op, a, span)?)),
            Term::Vector(parts) => {
                Ok(Term::Vector(parts.into_iter().map(|a| self.unary_number(op, a, span)).collect::<Result<_>>()?))
            }
            Term::Record(parts) => {
                let parts = parts.into_iter().map(|(name, a)| Ok((name, self.map1(op, a, span)?)));
                Ok(Term::Record(parts.collect::<Result<_>>()?))
            }
            other @ (Term::Whole(_) | Term::Word(_) | Term::Bool(_) | Term::Level(..) | Term::List(_)) => {
                Err(self.no_number(&other, span))
            }
        }
    }

    pub(super) fn map2(&mut self, op: BinaryOp, a: Term, b: Term, span: Span) -> Result<Term> {
        // Records go with records of the same names, and with numbers.
        match (&a, &b) {
            (Term::Record(x), Term::Record(y)) if !x.iter().map(|p| &p.0).eq(y.iter().map(|p| &p.0)) => {
                let message = format!("{} and {} do not go together", self.describe(&a), self.describe(&b));
                return Err(Diagnostic::error(codes::TYPE, message).at(span, "in this operation"));
            }
            (Term::Record(x), Term::Record(y)) => {
                let pairs = x.iter().zip(y);
                let pairs =
                    pairs.map(|((name, a), (_, b))| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(pairs.collect::<Result<_>>()?));
            }
            (Term::Record(x), Term::Number(_) | Term::Whole(_) | Term::Word(_)) => {
                let parts = x.iter().map(|(name, a)| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(parts.collect::<Result<_>>()?));
            }
            (Term::Number(_) | Term::Whole(_) | Term::Word(_), Term::Record(y)) => {
                let parts = y.iter().map(|(name, b)| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(parts.collect::<Result<_>>()?));
            }
            _ => {}
        }
        if let Some(word) = self.word_binary(op, &a, &b, span)? {
            return Ok(word);
        }
        if let Some(limited) = self.wide_binary(op, &a, &b, span)? {
            return Ok(limited);
        }
        if let Some([a, b]) = self.wholes([&a, &b], span)? {
            return self.whole_binary(op, a, b, span);
        }
        let mut parts = Vec::new();
        let (a, b, scalar) = self.broadcast(a, b, span)?;
        for (a, b) in a.into_iter().zip(b) {
            parts.push(self.binary_number(op, a, b, span)?);
        }
        Ok(if scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    pub(super) fn map3(&mut self, op: TernaryOp, a: Term, b: Term, c: Term, span: Span) -> Result<Term> {
        if let Some(word) = self.word_ternary(op, [&a, &b, &c], span)? {
            return Ok(word);
        }
        if let Some(limited) = self.wide_ternary(op, [&a, &b, &c], span)? {
            return Ok(limited);
        }
        if let Some(operands) = self.wholes([&a, &b, &c], span)? {
            return self.whole_ternary(op, operands, span);
        }
        let (b, c, scalar) = self.broadcast(b, c, span)?;
        let wrap = |parts: Vec<ExprId>| if parts.len() == 1 { Term::Number(parts[0]) } else { Term::Vector(parts) };
        let (a, b, also_scalar) = self.broadcast(a, wrap(b), span)?;
        let n = a.len();
        let c = if c.len() == 1 { vec![c[0]; n] } else { c };
        if c.len() != n {
            return Err(type_error(span, "vectors of different sizes", "operands must have the same size"));
        }
        let mut parts = Vec::new();
        for ((a, b), c) in a.into_iter().zip(b).zip(c) {
            parts.push(self.ternary_number(op, [a, b, c], span)?);
        }
        Ok(if scalar && also_scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// Components of two operands; a number goes with a vector of any size.
    pub(super) fn broadcast(&self, a: Term, b: Term, span: Span) -> Result<(Vec<ExprId>, Vec<ExprId>, bool)> {
        match (a, b) {
            (Term::Number(a), Term::Number(b)) => Ok((vec![a], vec![b], true)),
            (Term::Vector(a), Term::Number(b)) => {
                let n = a.len();
                Ok((a, vec![b; n], false))
            }
            (Term::Number(a), Term::Vector(b)) => Ok((vec![a; b.len()], b, false)),
            (Term::Vector(a), Term::Vector(b)) if a.len() == b.len() => Ok((a, b, false)),
            (a @ (Term::Number(_) | Term::Vector(_)), b) | (b, a @ (Term::Number(_) | Term::Vector(_))) => {
                let message = format!("{} and {} do not go together", self.describe(&a), self.describe(&b));
                let error = Diagnostic::error(codes::TYPE, message).at(span, "in this operation");
                Err(match b {
                    Term::Level(..) | Term::Bool(_) => {
                        self.later(&b, error.help("`f32(...)` gives the number of a level or condition"))
                    }
                    Term::Number(_)
                    | Term::Whole(_)
                    | Term::Word(_)
                    | Term::Vector(_)
                    | Term::List(_)
                    | Term::Record(_) => error,
                })
            }
            (a, _) => Err(self.no_number(&a, span)),
        }
    }
}
