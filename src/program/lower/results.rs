//! The image of a result under a symmetry, component by component.
//!
//! A map is written for the kind of result that it changes: an expression in `value` for
//! numbers, vectors and conditions; for levels and whole numbers, of which there are few,
//! an expression or a list of the new ones, which is kept as a table from old to new. The
//! items of a list are mapped one by one, the fields of a record as far as they are named.

use std::collections::HashMap;
use std::sync::Arc;

use super::scope::Env;
use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::LevelTerm;
use crate::program::operators::Comparison;
use crate::program::pool::{CondId, ExprId, Node};
use crate::table::expr::Expr;
use crate::table::{Output, ResultMap};

/// Most whole numbers that a map is tabulated for.
const MAX_TABULATED: i64 = 4096;

/// A result of which a part is mapped: `value` stands for all of it.
struct Whole<'w> {
    output: &'w Output<SetId>,
    components: &'w [ExprId],
    /// The first component of the part.
    at: usize,
}

/// The new values of few, which begin with some number.
struct Tabulated {
    first: i64,
    new: Vec<i64>,
}

impl Lowering<'_> {
    /// The components of the mapped result in terms of [`Node::Result`].
    pub(super) fn result_map(&mut self, map: &ResultMap) -> Result<Vec<ExprId>> {
        let output = self.output.clone();
        let components: Vec<ExprId> = (0..output.size()).map(|component| self.pool.result(component)).collect();
        self.mapped(&output, map, &components, &Env::default())
    }

    /// Applies the result map of a symmetry to a value.
    pub(super) fn apply_result(&mut self, map: &ResultMap, value: Term, span: Span, env: &Env) -> Result<Term> {
        let output = self.output.clone();
        let components: Vec<ExprId> = self.components(value, span)?.into_iter().map(|part| part.value).collect();
        let mapped = self.mapped(&output, map, &components, env)?;
        Ok(self.term_of(&output, &mapped))
    }

    fn mapped(
        &mut self,
        output: &Output<SetId>,
        map: &ResultMap,
        components: &[ExprId],
        env: &Env,
    ) -> Result<Vec<ExprId>> {
        if !matches!(output, Output::Number(_)) {
            self.table.since(2, map.span(), "a map of a result that is no number")?;
        }
        let (fields, parts) = match (output, map) {
            (Output::Record(fields), ResultMap::Parts(_, parts)) => (fields, parts),
            (Output::Record(_), ResultMap::Expr(expr)) => {
                return Err(Diagnostic::error(codes::SYMMETRY, "a record is mapped field by field")
                    .at(expr.span, "an expression")
                    .help("result: {\"angle\": \"1 - value.angle\", \"side\": {\"left\": \"right\", \"right\": \"left\"}}"));
            }
            (_, map) => return self.part(output, map, Whole { output, components, at: 0 }, env),
        };
        for (index, (name, _)) in parts.iter().enumerate() {
            if !fields.iter().any(|(field, _)| *field == name.value) {
                let known = fields.iter().map(|(field, _)| field.as_str()).collect::<Vec<_>>().join(", ");
                return Err(Diagnostic::error(codes::UNKNOWN_NAME, format!("the result has no `{}`", name.value))
                    .at(name.span, "not a field of the output")
                    .help(format!("the fields are: {known}")));
            }
            twice(name, parts[..index].iter().map(|(other, _)| other))?;
        }
        let mut all = components.to_vec();
        let mut at = 0;
        for (name, of) in fields {
            if let Some((_, map)) = parts.iter().find(|(part, _)| part.value == *name) {
                let new = self.part(of, map, Whole { output, components, at }, env)?;
                all[at..at + of.size()].copy_from_slice(&new);
            }
            at += of.size();
        }
        Ok(all)
    }

    /// A part of a result, mapped.
    fn part(&mut self, of: &Output<SetId>, map: &ResultMap, whole: Whole<'_>, env: &Env) -> Result<Vec<ExprId>> {
        let own = &whole.components[whole.at..whole.at + of.size()];
        match (of, map) {
            (Output::Int(from, to), ResultMap::Expr(expr)) => {
                let (from, to) = (i64::from(*from), i64::from(*to));
                if to - from >= MAX_TABULATED {
                    let message = format!("a map of {} whole numbers", to - from + 1);
                    return Err(Diagnostic::error(codes::SYMMETRY, message)
                        .at(expr.span, format!("at most {MAX_TABULATED} are mapped one by one")));
                }
                let table = self.tabulated(from..=to, &whole, expr, env, |me, env| {
                    let term = me.term(expr, env, Expected::Anything)?;
                    let value = if let Term::Number(value) = term { Some(value) } else { me.whole_of(&term) };
                    let value = value.ok_or_else(|| me.no_number(&term, expr.span))?;
                    match me.pool.constant(value) {
                        Some(new) if new.fract() == 0.0 && (from as f64..=to as f64).contains(&new) => Ok(new as i64),
                        Some(new) => {
                            let message = format!("the map gives {new}, which is no result");
                            Err(Diagnostic::error(codes::SYMMETRY, message)
                                .at(expr.span, format!("a whole number from {from} to {to} is expected")))
                        }
                        None => Err(depends(expr)),
                    }
                })?;
                Ok(vec![self.renumbered(own[0], &table, &mut HashMap::new())])
            }
            (Output::Enumeration(set), ResultMap::Expr(expr)) => {
                let count = self.sets[set.0].count() as i64;
                let table = self.tabulated(0..=count - 1, &whole, expr, env, |me, env| {
                    let level = me.level_term(*set, expr, env, "expected a level of the output")?;
                    me.fixed_level(&level).map(i64::from).ok_or_else(|| depends(expr))
                })?;
                Ok(vec![self.renumbered(own[0], &table, &mut HashMap::new())])
            }
            (Output::Enumeration(set), ResultMap::Parts(span, levels)) => {
                let table = self.level_table(*set, *span, levels)?;
                Ok(vec![self.renumbered(own[0], &table, &mut HashMap::new())])
            }
            (Output::List { of: item, max, .. }, map) => {
                let own = own.to_vec();
                let mut all = vec![own[0]];
                for index in 0..*max {
                    let from = 1 + index * item.size();
                    let components = &own[from..from + item.size()];
                    let new = self.part(item, map, Whole { output: item, components, at: 0 }, env)?;
                    // Behind the last item nothing changes.
                    let is_item = self.is_more(own[0], index as f64, &mut HashMap::new());
                    let chosen = new.into_iter().zip(components).map(|(new, old)| self.pool.select(is_item, new, *old));
                    all.extend(chosen.collect::<Vec<_>>());
                }
                Ok(all)
            }
            (_, ResultMap::Parts(span, _)) => {
                let message = format!("the result is {}, which has no levels to map", self.resolved(of).describe());
                Err(Diagnostic::error(codes::SYMMETRY, message)
                    .at(*span, "a map of levels")
                    .help("write an expression in `value`"))
            }
            (_, ResultMap::Expr(expr)) => {
                let value = self.term_of(whole.output, whole.components);
                let term = self.term(expr, &with_value(expr, value, env), Expected::Anything)?;
                let mut parts = Vec::new();
                self.tie(of, term, expr.span, "the mapped result", &mut parts)?;
                Ok(parts.into_iter().map(|part| part.value).collect())
            }
        }
    }

    /// The level that a term is, if it depends on nothing.
    fn fixed_level(&self, term: &LevelTerm) -> Option<u8> {
        match term {
            LevelTerm::Const(level) => Some(*level),
            LevelTerm::Input(_) => None,
            LevelTerm::If(condition, then, other) => {
                self.fixed_level(if self.pool.truth(*condition)? { then } else { other })
            }
            LevelTerm::Map(inner, map) => map.get(usize::from(self.fixed_level(inner)?)).copied(),
        }
    }

    /// The new value of every old one, found by putting it in. It is a permutation, since
    /// a symmetry leads back.
    fn tabulated(
        &mut self,
        range: std::ops::RangeInclusive<i64>,
        whole: &Whole<'_>,
        expr: &Expr,
        env: &Env,
        mut new: impl FnMut(&mut Self, &Env) -> Result<i64>,
    ) -> Result<Tabulated> {
        let mut components = whole.components.to_vec();
        let mut table = Tabulated { first: *range.start(), new: Vec::new() };
        for old in range {
            components[whole.at] = self.pool.number(old as f64);
            let value = self.term_of(whole.output, &components);
            table.new.push(new(self, &with_value(expr, value, env))?);
        }
        table.checked(expr.span)
    }

    /// A map of levels as it is written: old name, new name; the others stay.
    fn level_table(&mut self, set: SetId, span: Span, levels: &[(Spanned<String>, ResultMap)]) -> Result<Tabulated> {
        let mut new: Vec<i64> = (0..self.sets[set.0].count() as i64).collect();
        for (index, (old, to)) in levels.iter().enumerate() {
            twice(old, levels[..index].iter().map(|(other, _)| other))?;
            let Some(level) = self.sets[set.0].find(&old.value) else {
                return Err(self.unknown_level(set, &old.value, old.span));
            };
            let ResultMap::Expr(expr) = to else {
                return Err(Diagnostic::error(codes::SYMMETRY, "a level is mapped to a level").at(to.span(), "a map"));
            };
            match self.literal_level(set, expr, &Env::default())? {
                Some(to) => new[usize::from(level)] = i64::from(to),
                None => {
                    return Err(Diagnostic::error(codes::SYMMETRY, "a level is mapped to a level")
                        .at(expr.span, "expected the name of a level"));
                }
            }
        }
        Tabulated { first: 0, new }.checked(span)
    }

    /// A whole number in a new numbering. Choices stay choices.
    fn renumbered(&mut self, expr: ExprId, table: &Tabulated, known: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if let Some(done) = known.get(&expr) {
            return *done;
        }
        let new = match self.pool.node(expr) {
            Node::Const(number) => {
                let place = usize::try_from(number.get() as i64 - table.first).ok();
                let new = place.and_then(|place| table.new.get(place));
                new.map_or(expr, |new| self.pool.number(*new as f64))
            }
            Node::Select(condition, then, other) => {
                let [then, other] = [then, other].map(|part| self.renumbered(part, table, known));
                self.pool.select(condition, then, other)
            }
            Node::Word(_)
            | Node::Result(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => {
                let changed = table.new.iter().zip(table.first..).filter(|(new, old)| *new != old);
                changed.fold(expr, |rest, (new, old)| {
                    let (old, new) = (self.pool.number(old as f64), self.pool.number(*new as f64));
                    let is_old = self.pool.compare(Comparison::Equal, expr, old);
                    self.pool.select(is_old, new, rest)
                })
            }
        };
        known.insert(expr, new);
        new
    }

    /// The condition that a whole number is more than another. Choices stay choices.
    pub(super) fn is_more(&mut self, expr: ExprId, than: f64, known: &mut HashMap<ExprId, CondId>) -> CondId {
        if let Some(done) = known.get(&expr) {
            return *done;
        }
        let condition = match self.pool.node(expr) {
            Node::Select(condition, then, other) => {
                let [then, other] = [then, other].map(|part| self.is_more(part, than, known));
                self.pool.cond_if(condition, then, other)
            }
            Node::Const(_)
            | Node::Word(_)
            | Node::Result(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => {
                let than = self.pool.number(than);
                self.pool.compare(Comparison::Less, than, expr)
            }
        };
        known.insert(expr, condition);
        condition
    }

    /// The level that has an index.
    pub(super) fn level_with_index(
        &mut self,
        set: SetId,
        index: ExprId,
        known: &mut HashMap<ExprId, Arc<LevelTerm>>,
    ) -> Arc<LevelTerm> {
        if let Some(done) = known.get(&index) {
            return done.clone();
        }
        let level = match self.pool.node(index) {
            Node::Const(number) => LevelTerm::Const(number.get() as u8),
            Node::Select(condition, then, other) => {
                let [then, other] = [then, other].map(|part| self.level_with_index(set, part, known));
                LevelTerm::If(condition, then, other)
            }
            Node::Word(_)
            | Node::Result(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => {
                let last = self.sets[set.0].count() as u8 - 1;
                (0..last).rev().fold(LevelTerm::Const(last), |rest, level| {
                    let [own, rest] = [LevelTerm::Const(level), rest].map(|term| self.memo.level(term));
                    let number = self.pool.number(f64::from(level));
                    let is_level = self.pool.compare(Comparison::Equal, index, number);
                    LevelTerm::If(is_level, own, rest)
                })
            }
        };
        let level = self.memo.level(level);
        known.insert(index, level.clone());
        level
    }
}

impl Tabulated {
    /// The table, if it is a permutation.
    fn checked(self, span: Span) -> Result<Self> {
        let mut seen = vec![false; self.new.len()];
        for new in &self.new {
            let place = usize::try_from(new - self.first).unwrap_or(usize::MAX);
            if seen.get_mut(place).is_none_or(|seen| std::mem::replace(seen, true)) {
                return Err(Diagnostic::error(codes::SYMMETRY, "the map of the result is no permutation")
                    .at(span, "two results have the same image, or one has none")
                    .help("a symmetry can be undone: every result is the image of exactly one"));
            }
        }
        Ok(self)
    }
}

/// The environment in which `value` is the result that a map changes.
fn with_value(map: &Expr, value: Term, env: &Env) -> Env {
    env.with_local(&Spanned::new(map.span, "value".to_owned()), value)
}

fn depends(map: &Expr) -> Diagnostic {
    Diagnostic::error(codes::SYMMETRY, "the map of a level or whole number depends on that alone")
        .at(map.span, "depends on something else")
}

/// Refuses a name that was given before.
fn twice<'n>(name: &Spanned<String>, mut before: impl Iterator<Item = &'n Spanned<String>>) -> Result<()> {
    match before.find(|other| other.value == name.value) {
        None => Ok(()),
        Some(first) => Err(Diagnostic::error(codes::DUPLICATE, format!("`{}` is mapped twice", name.value))
            .at(name.span, "again")
            .at(first.span, "first here")),
    }
}
