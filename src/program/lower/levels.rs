//! Levels that depend on inputs: where they are written, how they compare, and
//! what they become, which is a condition or a number.

use std::collections::HashMap;
use std::sync::Arc;

use super::built_in::{self, Kind};
use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::InputId;
use crate::program::bits::LevelSet;
use crate::program::operators::{BinaryOp, Comparison};
use crate::program::pool::{CondId, ExprId};
use crate::table::expr::{Expr, ExprKind};
use crate::text::closest::nearest;

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
    /// A term of a level.
    pub(super) fn level_of(&mut self, set: SetId, term: LevelTerm) -> Term {
        Term::Level(set, self.memo.level(term))
    }

    /// The level of a `Bool` that a condition is.
    pub(super) fn truth_as_level(&mut self, condition: CondId) -> LevelTerm {
        let [no, yes] = [0, 1].map(|level| self.memo.level(LevelTerm::Const(level)));
        LevelTerm::If(condition, yes, no)
    }

    pub(super) fn equality(&mut self, a: &Expr, b: &Expr, env: &Env) -> Result<CondId> {
        // A bare level name or code takes its meaning from the other side, but integers of any range are no levels.
        for (integer, constant) in [(a, b), (b, a)] {
            if let Some(value) = constant.literal()
                && integer.name().is_some_and(|name| self.has_meaning(name, env))
                && let term = self.term(integer, env, Expected::Anything)?
                && let Some((set, term)) = self.wide_of(&term)
            {
                return Ok(self.wide_comparison(Comparison::Equal, (set, &term), value, false));
            }
        }
        let swap = self.is_bare(a, env) && !self.is_bare(b, env);
        let (known, other) = if swap { (b, a) } else { (a, b) };
        let mut left = self.term(known, env, Expected::Anything)?;
        let right = match &left {
            Term::Level(set, _) => self.level_operand(*set, other, env)?,
            Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::List(_)
            | Term::Record(_) => self.term(other, env, Expected::Anything)?,
        };
        if let (Term::Number(_), Term::Level(set, _)) = (&left, &right) {
            left = self.level_operand(*set, known, env)?;
        }
        if let Some([a, b]) = self.words([&left, &right], false, a.span.to(b.span))? {
            return Ok(self.comparison(Comparison::Equal, a, b));
        }
        if let Some(condition) = self.wide_compared(Comparison::Equal, [&left, &right], a.span.to(b.span))? {
            return Ok(condition);
        }
        let is_one_set = matches!((&left, &right), (Term::Level(a, _), Term::Level(b, _)) if a == b);
        if !is_one_set && let Some([a, b]) = self.compared_wholes([&left, &right], a.span.to(b.span))? {
            return Ok(self.comparison(Comparison::Equal, a, b));
        }
        match (&left, &right) {
            (Term::Number(a), Term::Number(b)) => Ok(self.comparison(Comparison::Equal, *a, *b)),
            (Term::Bool(a), Term::Bool(b)) => {
                let (a, b) = (*a, *b);
                let not_b = self.pool.not(b);
                Ok(self.pool.cond_if(a, b, not_b))
            }
            (Term::Level(set, a), Term::Level(other_set, b)) if set == other_set => Ok(self.same_level(*set, a, b)),
            (Term::Level(set, _), Term::Level(other_set, _)) => {
                let error = type_error(other.span, &self.describe(&right), "the other side has other levels");
                Err(self.unlike(error, *set, *other_set))
            }
            (Term::Level(..), _) => {
                Err(type_error(other.span, &self.describe(&right), "expected a level, as on the other side"))
            }
            _ => {
                let message = format!("the other side of the comparison is {}", self.describe(&left));
                Err(type_error(other.span, &self.describe(&right), &message))
            }
        }
    }

    /// The condition that two terms are the same level.
    fn same_level(&mut self, set: SetId, a: &LevelTerm, b: &LevelTerm) -> CondId {
        match (a, b) {
            (term, LevelTerm::Const(level)) | (LevelTerm::Const(level), term) => {
                self.level_in(set, term, LevelSet::one(*level))
            }
            _ => {
                let levels = 0..self.sets[set.0].count() as u8;
                let both: Vec<CondId> = levels
                    .map(|level| {
                        let parts = [a, b].map(|t| self.level_in(set, t, LevelSet::one(level)));
                        self.pool.and(parts)
                    })
                    .collect();
                self.pool.or(both)
            }
        }
    }

    /// Lowers an expression that must be a level of a set; `expected` says so where it is none.
    pub(super) fn level_term(&mut self, set: SetId, expr: &Expr, env: &Env, expected: &str) -> Result<Arc<LevelTerm>> {
        let term = self.term(expr, env, Expected::Level(set))?;
        let error = match &term {
            Term::Level(found, level) if *found == set => return Ok(level.clone()),
            Term::Level(found, _)
                if self.is_integer(set) && self.is_integer(*found) && !self.is_wide(set) && !self.is_wide(*found) =>
            {
                let whole = self.whole_of(&term);
                let Some(whole) = whole else {
                    return Err(type_error(expr.span, &self.describe(&term), expected));
                };
                return self.level_of_whole(set, whole, expr.span);
            }
            Term::Level(found, _) => {
                let error = type_error(expr.span, &self.describe(&term), expected);
                self.unlike(error, set, *found)
            }
            Term::Whole(whole) if self.is_integer(set) && !self.is_wide(set) => {
                return self.level_of_whole(set, *whole, expr.span);
            }
            Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::List(_)
            | Term::Record(_) => type_error(expr.span, &self.describe(&term), expected),
        };
        Err(error)
    }

    /// Lowers an expression where a level of a set is expected; the name of a level wins.
    fn level_operand(&mut self, set: SetId, expr: &Expr, env: &Env) -> Result<Term> {
        match self.literal_level(set, expr, env)? {
            Some(level) => Ok(self.level_of(set, LevelTerm::Const(level))),
            None => self.term(expr, env, Expected::Level(set)),
        }
    }

    /// Lowers two alternatives. Where nothing else says of which set a bare level
    /// or code is, the other alternative does.
    pub(super) fn alternatives(&mut self, a: &Expr, b: &Expr, env: &Env, expected: Expected) -> Result<(Term, Term)> {
        let swap = expected == Expected::Anything && self.is_bare(a, env) && !self.is_bare(b, env);
        let (first, second) = if swap { (b, a) } else { (a, b) };
        let mut first_term = self.term(first, env, expected.clone())?;
        let second_expected = match (&first_term, expected) {
            // An integer that is none of the levels is a whole number all the same.
            (Term::Level(set, _), Expected::Anything)
                if self.is_integer(*set) && second.literal().is_some_and(|n| !self.sets[set.0].codes.contains(&n)) =>
            {
                Expected::Anything
            }
            (Term::Level(set, _), Expected::Anything) => Expected::Level(*set),
            (_, expected) => expected,
        };
        let second_term = self.term(second, env, second_expected)?;
        if let (Term::Number(_), Term::Level(set, _)) = (&first_term, &second_term) {
            first_term = self.term(first, env, Expected::Level(*set))?;
        }
        Ok(if swap { (second_term, first_term) } else { (first_term, second_term) })
    }

    /// Returns whether an expression consists of names that mean nothing by themselves, as those of levels do.
    fn is_bare(&self, expr: &Expr, env: &Env) -> bool {
        if let Some(name) = expr.name() {
            return !(matches!(name, "true" | "false") || self.has_meaning(name, env));
        }
        let sides: Vec<&Expr> = if let ExprKind::If(_, a, b) = &expr.kind {
            vec![a, b]
        } else if let ExprKind::Call(function, arguments) = &expr.kind
            && let Some(built_in) = built_in::named(&function.value)
        {
            let parameters = arguments.iter().zip(built_in.parameters);
            parameters.filter(|(_, (_, kind))| *kind == Kind::Alternative).map(|(argument, _)| argument).collect()
        } else {
            Vec::new()
        };
        !sides.is_empty() && sides.into_iter().all(|side| self.is_bare(side, env))
    }

    /// Says how inputs come to have the same levels, if two sets look alike.
    pub(super) fn unlike(&self, error: Diagnostic, a: SetId, b: SetId) -> Diagnostic {
        let (first, second) = (&self.sets[a.0], &self.sets[b.0]);
        if a == b || first.names != second.names || first.codes != second.codes {
            return error;
        }
        let of =
            |set: SetId| self.input_sets.iter().position(|s| *s == Some(set)).map(|i| self.inputs[i].name.as_str());
        match (of(a.min(b)), of(a.max(b))) {
            (Some(one), Some(two)) => error.help(format!(
                "the levels look alike, but each list is a set of its own; declare `{two}` as `Levels(of: \"{one}\")`"
            )),
            _ => {
                error.help("the levels look alike, but each list is a set of its own; share one with `Levels(of: ...)`")
            }
        }
    }

    /// A level written as a name that means nothing else, or as its code.
    pub(super) fn literal_level(&mut self, set: SetId, expr: &Expr, env: &Env) -> Result<Option<u8>> {
        let word = match (expr.name(), expr.literal()) {
            (Some(name), _) => {
                let is_level = self.sets[set.0].names.iter().any(|level| level == name);
                if !is_level && self.has_meaning(name, env) {
                    return Ok(None);
                }
                name.to_owned()
            }
            (None, Some(number)) => format!("{number}"),
            (None, None) => return Ok(None),
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
        let error = match nearest(word, levels.names.iter().map(String::as_str)) {
            Some(close) => error.did_you_mean(word, close),
            None => error,
        };
        error.help(format!("the levels are: {}", levels.describe()))
    }

    pub(super) fn membership(&mut self, value: &Expr, levels: &[Spanned<String>], env: &Env) -> Result<Term> {
        if let Some(group) = self.group_named(value, env) {
            return self.matches(group, levels, env).map(Term::Bool);
        }
        let term = self.term(value, env, Expected::Anything)?;
        let (set, term) = match term {
            Term::Level(set, term) if self.is_wide(set) => {
                return self.wide_among((set, &term), levels).map(Term::Bool);
            }
            Term::Level(set, term) => (set, term),
            Term::Bool(condition) => (SetId::BOOL, Arc::new(self.truth_as_level(condition))),
            Term::Whole(expr) => return self.whole_among(expr, levels).map(Term::Bool),
            Term::Word(word) => return self.word_among(word, levels).map(Term::Bool),
            other @ (Term::Number(_) | Term::Vector(_) | Term::List(_) | Term::Record(_)) => {
                return Err(type_error(value.span, &self.describe(&other), "only discrete inputs have levels"));
            }
        };
        let mut mask = 0;
        for word in levels {
            mask |= LevelSet::one(self.listed_level(set, word, env.scope)?).0;
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
        if let Some(spaced) = self.spaced(set, term, &number) {
            return spaced;
        }
        let last = self.sets[set.0].count() as u8 - 1;
        let value = number(self, last);
        let mut result = self.pool.number(value);
        for level in (0..last).rev() {
            let condition = self.level_in(set, term, LevelSet::one(level));
            let value = number(self, level);
            let value = self.pool.number(value);
            result = self.pool.select(condition, value, result);
            self.note_level_choice(term, condition, result);
        }
        result
    }

    /// The same where the numbers of an input's levels are evenly spaced: computed from the index, if `f32` does so
    /// exactly.
    fn spaced(&mut self, set: SetId, term: &LevelTerm, number: &impl Fn(&Self, u8) -> f64) -> Option<ExprId> {
        let (input, numbers): (InputId, Vec<f64>) = match term {
            LevelTerm::Input(input) => {
                (*input, (0..self.sets[set.0].count() as u8).map(|level| number(self, level)).collect())
            }
            LevelTerm::Map(inner, map) => {
                let LevelTerm::Input(input) = **inner else { return None };
                (input, map.iter().map(|level| number(self, *level)).collect())
            }
            LevelTerm::Const(_) | LevelTerm::If(..) => return None,
        };
        let [first, second, _, ..] = *numbers.as_slice() else { return None };
        let step = second - first;
        let exact = |index: usize, number: f64| {
            let product = index as f32 * step as f32;
            f64::from(product) == index as f64 * step
                && f64::from(product + first as f32) == number
                && first + index as f64 * step == number
        };
        if step == 0.0 || !numbers.iter().enumerate().all(|(index, number)| exact(index, *number)) {
            return None;
        }
        let mut result = self.pool.index(input);
        if step != 1.0 {
            let step = self.pool.number(step);
            result = self.pool.binary(BinaryOp::Multiply, result, step);
        }
        if first != 0.0 {
            let op = if first < 0.0 { BinaryOp::Subtract } else { BinaryOp::Add };
            let first = self.pool.number(first.abs());
            result = self.pool.binary(op, result, first);
        }
        Some(result)
    }
}
