//! Levels that depend on inputs: where they are written, how they compare, and
//! what they become, which is a condition or a number.

use std::collections::HashMap;
use std::sync::Arc;

use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::InputId;
use crate::program::pool::{Comparison, CondId, ExprId, LevelSet};
use crate::table::expr::{self as ast, Expr, ExprKind};

/// A level that depends on inputs.
#[derive(Debug, Clone, PartialEq)]
pub enum LevelTerm {
    /// A fixed level.
    Const(u8),
    /// The level of an input.
    Input(InputId),
    /// One of two levels.
    If(CondId, Arc<LevelTerm>, Arc<LevelTerm>),
    /// A level, renamed through a list indexed by the old level.
    Map(Arc<LevelTerm>, Arc<[u8]>),
}

impl Lowering<'_> {
    pub(super) fn equality(&mut self, a: &Expr, b: &Expr, env: &Env) -> Result<CondId> {
        // A bare level name or code takes its meaning from the other side.
        let is_known = match &a.kind {
            ExprKind::Name(name) => matches!(name.as_str(), "true" | "false") || self.is_defined(name, env),
            _ => true,
        };
        let (known, other) = if is_known { (a, b) } else { (b, a) };
        let left = self.term(known, env, Expected::Anything)?;
        if let Term::Level(set, term) = &left {
            if let Some(level) = self.literal_level(*set, other, env)? {
                return Ok(self.level_in(*set, term, LevelSet::one(level)));
            }
            let right = self.term(other, env, Expected::Level(*set))?;
            let Term::Level(right_set, right_term) = &right else {
                return Err(type_error(other.span, &self.describe(&right), "expected a level, as on the other side"));
            };
            if right_set != set {
                return Err(type_error(other.span, &self.describe(&right), "the other side has other levels"));
            }
            let both: Vec<CondId> = (0..self.sets[set.0].count() as u8)
                .map(|level| {
                    let parts = [term, right_term].map(|t| self.level_in(*set, t, LevelSet::one(level)));
                    self.pool.and(parts)
                })
                .collect();
            return Ok(self.pool.or(both));
        }
        let right = self.term(other, env, Expected::Anything)?;
        match (&left, &right) {
            (Term::Number(a), Term::Number(b)) => Ok(self.pool.compare(Comparison::Equal, *a, *b)),
            (Term::Bool(a), Term::Bool(b)) => {
                let (a, b) = (*a, *b);
                let not_b = self.pool.not(b);
                Ok(self.pool.cond_if(a, b, not_b))
            }
            _ => {
                let message = format!("the other side of the comparison is {}", self.describe(&left));
                Err(type_error(other.span, &self.describe(&right), &message))
            }
        }
    }

    /// A level written as a name that means nothing else, or as its code.
    pub(super) fn literal_level(&mut self, set: SetId, expr: &Expr, env: &Env) -> Result<Option<u8>> {
        let word = match &expr.kind {
            ExprKind::Name(name) if self.sets[set.0].names.contains(name) => name.clone(),
            ExprKind::Name(name) if self.is_defined(name, env) => return Ok(None),
            ExprKind::Name(name) => name.clone(),
            ExprKind::Number(number) => format!("{number}"),
            ExprKind::Unary(ast::UnaryOp::Negate, inner) => match inner.kind {
                ExprKind::Number(number) => format!("{}", -number),
                _ => return Ok(None),
            },
            _ => return Ok(None),
        };
        match self.sets[set.0].find(&word) {
            Some(level) => Ok(Some(level)),
            None => Err(self.unknown_level(set, &word, expr.span)),
        }
    }

    pub(super) fn unknown_level(&self, set: SetId, word: &str, span: Span) -> Diagnostic {
        let levels = &self.sets[set.0];
        let error = Diagnostic::error(codes::UNKNOWN_LEVEL, format!("there is no level `{word}`"))
            .at(span, "not one of the levels here");
        let error = match crate::table::nearest(word, levels.names.iter().map(String::as_str)) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => error,
        };
        error.help(format!("the levels are: {}", levels.describe()))
    }

    pub(super) fn membership(&mut self, value: &Expr, levels: &[Spanned<String>], env: &Env) -> Result<Term> {
        let term = self.term(value, env, Expected::Anything)?;
        let (set, term) = match term {
            Term::Level(set, term) => (set, term),
            Term::Bool(condition) => {
                let term = LevelTerm::If(condition, Arc::new(LevelTerm::Const(1)), Arc::new(LevelTerm::Const(0)));
                (SetId::BOOL, Arc::new(term))
            }
            other => return Err(type_error(value.span, &self.describe(&other), "only discrete inputs have levels")),
        };
        let mut mask = 0;
        for word in levels {
            match self.sets[set.0].find(&word.value) {
                Some(level) => mask |= LevelSet::one(level).0,
                None => return Err(self.unknown_level(set, &word.value, word.span)),
            }
        }
        Ok(Term::Bool(self.level_in(set, &term, LevelSet(mask))))
    }

    /// The condition that a level term lies in a set of levels.
    pub(super) fn level_in(&mut self, set: SetId, term: &LevelTerm, levels: LevelSet) -> CondId {
        self.level_in_known(set, term, levels, &mut HashMap::new())
    }

    /// Terms share parts; `known` keeps a part from being visited once per path to it.
    pub(super) fn level_in_known(
        &mut self,
        set: SetId,
        term: &LevelTerm,
        levels: LevelSet,
        known: &mut HashMap<(*const LevelTerm, LevelSet), CondId>,
    ) -> CondId {
        let key = (std::ptr::from_ref(term), levels);
        if let Some(condition) = known.get(&key) {
            return *condition;
        }
        let condition = match term {
            LevelTerm::Const(level) => self.pool.always(levels.contains(*level)),
            LevelTerm::Input(input) => {
                let count = self.sets[set.0].count();
                self.pool.level(*input, levels, count)
            }
            LevelTerm::If(condition, then, other) => {
                let then = self.level_in_known(set, then, levels, known);
                let other = self.level_in_known(set, other, levels, known);
                self.pool.cond_if(*condition, then, other)
            }
            LevelTerm::Map(inner, map) => {
                let preimage = map.iter().enumerate().filter(|(_, to)| levels.contains(**to));
                let preimage = LevelSet(preimage.fold(0, |mask, (from, _)| mask | 1 << from));
                let from = self.set_of(inner);
                self.level_in_known(from, inner, preimage, known)
            }
        };
        known.insert(key, condition);
        condition
    }

    /// The level set that a term ranges over.
    pub(super) fn set_of(&self, term: &LevelTerm) -> SetId {
        match term {
            LevelTerm::Input(input) => self.input_sets[input.index()].unwrap_or(SetId::BOOL),
            LevelTerm::If(_, then, _) => self.set_of(then),
            LevelTerm::Map(inner, _) => self.set_of(inner),
            LevelTerm::Const(_) => SetId::BOOL,
        }
    }

    /// The number that stands for a level, or its index.
    pub(super) fn level_number(&mut self, set: SetId, term: &LevelTerm, number: impl Fn(&Self, u8) -> f64) -> ExprId {
        let last = self.sets[set.0].count() as u8 - 1;
        let value = number(self, last);
        let mut result = self.pool.number(value);
        for level in (0..last).rev() {
            let condition = self.level_in(set, term, LevelSet::one(level));
            let value = number(self, level);
            let value = self.pool.number(value);
            result = self.pool.select(condition, value, result);
        }
        result
    }
}
