//! Expressions of the table language → typed terms.
//!
//! Types are inferred bottom-up, except that a bare level name takes its type
//! from what it is compared with or where it ends up.

use std::rc::Rc;
use std::sync::Arc;

use super::lists::List;
use super::scope::Env;
use super::{Lowering, Result, SINCE, SetId};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::LevelTerm;
use crate::program::operators::Comparison;
use crate::program::operators::{BinaryOp, UnaryOp};
use crate::program::pool::{self, CondId, ExprId};
use crate::table::Output;
use crate::table::expr::{self as ast, Expr, ExprKind};

/// Deepest and largest value of one row, references included.
const MAX_DEPTH: u32 = 640;
const MAX_SIZE: u32 = 50_000;
/// Most different terms of a table or of one of its functions.
const MAX_TERMS: usize = 100_000;

/// Most expressions that may be open at once while names and references are
/// followed. An unoptimised build needs some 10 KiB of stack for each, of the
/// 2 MiB that a thread has.
const MAX_OPEN: u32 = 100;

/// A typed value.
#[derive(Debug, Clone)]
pub(super) enum Term {
    Number(ExprId),
    /// A whole number, which is no real one before it is made one.
    Whole(ExprId),
    /// A word, which is neither.
    Word(ExprId),
    Vector(Vec<ExprId>),
    Bool(CondId),
    Level(SetId, Arc<LevelTerm>),
    /// A list, by its parts.
    List(List),
    /// Values with names.
    Record(Vec<(String, Term)>),
}

/// The expectation of an expression; guides bare level names, records and lists.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Expected {
    Anything,
    Level(SetId),
    /// A record or a list.
    Result(Rc<Output<SetId>>),
}

impl Term {
    /// The numbers that it consists of; none for a condition or level.
    pub(super) fn numbers(&self) -> Vec<ExprId> {
        let (mut exprs, mut conditions) = (Vec::new(), Vec::new());
        self.parts(&mut exprs, &mut conditions);
        exprs
    }

    /// The expressions and conditions that it consists of; levels have none.
    pub(super) fn parts(&self, exprs: &mut Vec<ExprId>, conditions: &mut Vec<CondId>) {
        match self {
            Term::Number(expr) | Term::Whole(expr) | Term::Word(expr) => exprs.push(*expr),
            Term::Vector(parts) => exprs.extend(parts),
            Term::List(list) => list.parts().iter().for_each(|part| part.parts(exprs, conditions)),
            Term::Bool(condition) => conditions.push(*condition),
            Term::Level(..) => {}
            Term::Record(parts) => parts.iter().for_each(|(_, part)| part.parts(exprs, conditions)),
        }
    }
}

/// A call as it is written.
#[derive(Clone, Copy)]
pub(super) struct Call<'c> {
    pub(super) arguments: &'c [Expr],
    pub(super) span: Span,
    pub(super) env: &'c Env,
    pub(super) expected: &'c Expected,
}

impl Lowering<'_> {
    /// Lowers an expression.
    pub(super) fn term(&mut self, expr: &Expr, env: &Env, expected: Expected) -> Result<Term> {
        // Names and references lead from one expression into the next, so the
        // limit of the parser alone does not bound the stack.
        if self.depth == MAX_OPEN {
            let message = "names and references are nested too deeply";
            return Err(Diagnostic::error(codes::TOO_DEEP, message)
                .at(expr.span, "not followed any further")
                .help(format!("through all of them, expressions nest at most {MAX_OPEN} deep")));
        }
        self.follow(1, expr.span)?;
        self.depth += 1;
        let term = self.term_inner(expr, env, expected);
        self.depth -= 1;
        let term = term?;
        self.check_size(&term, expr.span)?;
        Ok(term)
    }

    /// Refuses more different operations than a table may have.
    pub(super) fn check_room(&self, span: Span) -> Result<()> {
        if self.pool.len().max(self.pool.conditions()) <= MAX_TERMS {
            return Ok(());
        }
        let message = "with names, references and calls written out, the table is too large";
        Err(Diagnostic::error(codes::TOO_DEEP, message)
            .at(span, "too much from here on")
            .help(format!("at most {MAX_TERMS} different operations")))
    }

    pub(super) fn check_size(&self, term: &Term, span: Span) -> Result<()> {
        let (mut exprs, mut conditions) = (Vec::new(), Vec::new());
        term.parts(&mut exprs, &mut conditions);
        let exprs = exprs.into_iter().map(|expr| self.pool.expr_facts(expr));
        let facts: Vec<pool::Facts> = exprs.chain(conditions.into_iter().map(|c| self.pool.cond_facts(c))).collect();
        if facts.is_empty() {
            return Ok(());
        }
        self.check_room(span)?;
        // What functions share is counted once, so their trees may be large.
        let max_size = if self.table.functions.is_empty() { MAX_SIZE } else { u32::MAX };
        for facts in facts {
            if facts.depth > MAX_DEPTH || facts.size > max_size {
                let message = "the value is too large once names and references are written out";
                return Err(Diagnostic::error(codes::TOO_DEEP, message)
                    .at(span, format!("{} operations, {} deep", facts.size, facts.depth))
                    .help(format!("at most {max_size} operations, {MAX_DEPTH} deep")));
            }
        }
        Ok(())
    }

    pub(super) fn term_inner(&mut self, expr: &Expr, env: &Env, expected: Expected) -> Result<Term> {
        let span = expr.span;
        // A level is written by its name or by its code.
        if let Expected::Level(set) = expected
            && matches!(&expr.kind, ExprKind::Number(_) | ExprKind::Unary(ast::UnaryOp::Negate, _))
            && let Some(level) = self.literal_level(set, expr, env)?
        {
            return Ok(self.level_of(set, LevelTerm::Const(level)));
        }
        match &expr.kind {
            ExprKind::Number(value) => Ok(Term::Number(self.constant(*value, span)?)),
            ExprKind::Name(name) => self.name(name, span, env, expected),
            ExprKind::Level(set, level) => self.typed_level(set, level, span, env.scope),
            ExprKind::Unary(ast::UnaryOp::Not, a) => {
                let a = self.condition(a, env)?;
                Ok(Term::Bool(self.pool.not(a)))
            }
            ExprKind::Unary(ast::UnaryOp::Negate, a) => {
                let a = self.term(a, env, Expected::Anything)?;
                self.map1(UnaryOp::Negate, a, span)
            }
            ExprKind::Unary(ast::UnaryOp::BitNot, a) => {
                self.scopes[env.scope].since(SINCE, span, "`~`")?;
                let a = self.term(a, env, Expected::Anything)?;
                self.map1(UnaryOp::WordNot, a, span)
            }
            ExprKind::Binary(ast::BinaryOp::Join, a, b) => self.joined_lists([a, b], span, env, &expected),
            ExprKind::Binary(op, a, b) => self.binary(*op, a, b, span, env),
            ExprKind::In(value, levels) => self.membership(value, levels, env),
            ExprKind::Call(function, arguments) => {
                self.call(function, Call { arguments, span, env, expected: &expected })
            }
            ExprKind::Swizzle(value, letters) => {
                let value = self.term(value, env, Expected::Anything)?;
                self.swizzle(value, &letters.value, letters.span)
            }
            ExprKind::Case(id, set) => self.case_value(id, set, env),
            ExprKind::If(condition, then, other) => {
                let condition = self.condition(condition, env)?;
                let (then_term, other_term) = self.alternatives(then, other, env, expected)?;
                let term = self.choose(condition, then_term, other_term, other.span)?;
                if env.scope == 0 {
                    self.note_choice(span, condition, &term);
                }
                Ok(term)
            }
            ExprKind::Let(name, value, body) => {
                self.check_local(name, env)?;
                let term = self.term(value, env, Expected::Anything)?;
                self.label(&term, &name.value);
                self.term(body, &env.with_local(name, term), expected)
            }
            ExprKind::With(function, given) => {
                if let Some(callee) = self.callee(&function.value, env.scope) {
                    return self.call_with(callee, given, span, env);
                }
                if let Some(fetch) = self.fetch_named(&function.value, env) {
                    return self.fetch_with(fetch, given, span, env);
                }
                match self.called_table(&function.value, env.scope) {
                    Some(table) => self.table_with(table, given, span, env),
                    None => Err(self.unknown_function(function, env)),
                }
            }
            ExprKind::Between(body, variable, lo, hi) => self.between(body, variable, [lo, hi], span, env),
            ExprKind::Sum(variable, over, term) => self.sum(variable, over, term, span, env),
            ExprKind::Iterate(count, variable, start, step) => self.iterate(count, variable, [start, step], span, env),
            ExprKind::Index(list, indices) => self.item(list, indices, span, env),
            ExprKind::Record(fields) => self.record(fields, span, env, &expected),
            ExprKind::List(items) => self.list(items, span, env, &expected),
            ExprKind::Optional(..) => Err(Diagnostic::error(codes::TYPE, "an item with a condition stands in a list")
                .at(span, "not in a list of results")),
        }
    }

    /// Lowers an expression that must be a condition.
    pub(super) fn condition(&mut self, expr: &Expr, env: &Env) -> Result<CondId> {
        match self.term(expr, env, Expected::Anything)? {
            Term::Bool(condition) => Ok(condition),
            other @ (Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Level(..)
            | Term::List(_)
            | Term::Record(_)) => Err(type_error(expr.span, &self.describe(&other), "expected a condition")),
        }
    }

    /// Lowers an expression that must be a number.
    pub(super) fn numeric(&mut self, expr: &Expr, env: &Env) -> Result<ExprId> {
        match self.term(expr, env, Expected::Anything)? {
            Term::Number(number) => Ok(number),
            other @ (Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::Level(..)
            | Term::List(_)
            | Term::Record(_)) => Err(self.no_number(&other, expr.span)),
        }
    }

    pub(super) fn no_number(&self, term: &Term, span: Span) -> Diagnostic {
        let error = type_error(span, &self.describe(term), "expected a number");
        match term {
            Term::Level(..) | Term::Bool(_) => {
                self.later(term, error.help("`f32(...)` gives the number that stands for it"))
            }
            Term::Whole(_) => error.help("`f32(...)` makes a number of a whole one"),
            Term::Word(_) => error.help("`f32(...)` makes a number of a U32"),
            Term::Number(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => error,
        }
    }

    pub(super) fn describe(&self, term: &Term) -> String {
        match term {
            Term::Number(_) => "a number".to_owned(),
            Term::Whole(_) => "a whole number".to_owned(),
            Term::Word(_) => "a U32".to_owned(),
            Term::Vector(parts) => format!("a vector of {}", parts.len()),
            Term::Bool(_) => "a condition".to_owned(),
            Term::Level(set, _) => format!("one of the levels {}", self.sets[set.0].names.join(", ")),
            Term::List(_) => "a list".to_owned(),
            Term::Record(parts) => {
                format!("a record of {}", parts.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", "))
            }
        }
    }

    pub(super) fn binary(&mut self, op: ast::BinaryOp, a: &Expr, b: &Expr, span: Span, env: &Env) -> Result<Term> {
        use ast::BinaryOp as Op;
        match op {
            Op::And | Op::Or => {
                let parts = [self.condition(a, env)?, self.condition(b, env)?];
                Ok(Term::Bool(if op == Op::And { self.pool.and(parts) } else { self.pool.or(parts) }))
            }
            Op::Equal | Op::NotEqual => {
                let equal = self.equality(a, b, env)?;
                Ok(Term::Bool(if op == Op::Equal { equal } else { self.pool.not(equal) }))
            }
            Op::Less | Op::LessEqual | Op::Greater | Op::GreaterEqual => {
                let strict = matches!(op, Op::Less | Op::Greater);
                let comparison = if strict { Comparison::Less } else { Comparison::LessEqual };
                let sides = if matches!(op, Op::Less | Op::LessEqual) { [a, b] } else { [b, a] };
                Ok(Term::Bool(self.compared(comparison, sides, span, env)?))
            }
            Op::Add
            | Op::Subtract
            | Op::Multiply
            | Op::Divide
            | Op::Remainder
            | Op::Join
            | Op::BitAnd
            | Op::BitOr
            | Op::BitXor
            | Op::ShiftLeft
            | Op::ShiftRight => {
                if op.is_on_bits() {
                    let since = self.scopes[env.scope].since(SINCE, span, &format!("`{}`", op.symbol()));
                    since.map_err(|error| error.help("logical operators are written `&&` and `||`"))?;
                }
                let Some(op) = BinaryOp::of_symbol(op) else {
                    return Err(type_error(span, &format!("`{}`", op.symbol()), "expected an operation on numbers"));
                };
                let left = self.term(a, env, Expected::Anything)?;
                let right = self.term(b, env, Expected::Anything)?;
                // In a function, what is constant whatever it is called with is a mistake all the same.
                let calling = match self.is_constant(b, env) {
                    true => std::mem::take(&mut self.calling),
                    false => Vec::new(),
                };
                let divisors = right.numbers().into_iter().try_for_each(|part| self.check_divisor(op, part, b.span));
                self.calling.extend(calling);
                divisors?;
                self.map2(op, left, right, span)
            }
        }
    }

    /// Returns whether an expression is written with nothing but constants.
    fn is_constant(&self, expr: &Expr, env: &Env) -> bool {
        match &expr.kind {
            ExprKind::Number(_) => true,
            ExprKind::Name(name) => {
                let hidden = env.locals.iter().any(|(local, _)| local.value == *name);
                !hidden && self.scopes[env.scope].constants.iter().any(|constant| constant.name.value == *name)
            }
            ExprKind::Unary(..) | ExprKind::Binary(..) | ExprKind::Swizzle(..) => {
                expr.parts().into_iter().all(|part| self.is_constant(part, env))
            }
            ExprKind::In(..)
            | ExprKind::Call(..)
            | ExprKind::Case(..)
            | ExprKind::If(..)
            | ExprKind::Let(..)
            | ExprKind::Level(..)
            | ExprKind::List(_)
            | ExprKind::Optional(..)
            | ExprKind::With(..)
            | ExprKind::Between(..)
            | ExprKind::Sum(..)
            | ExprKind::Iterate(..)
            | ExprKind::Index(..)
            | ExprKind::Record(_) => false,
        }
    }

    pub(super) fn choose(&mut self, condition: CondId, then: Term, other: Term, span: Span) -> Result<Term> {
        let zip = |me: &mut Self, a: &[ExprId], b: &[ExprId]| -> Vec<ExprId> {
            a.iter().zip(b).map(|(a, b)| me.pool.select(condition, *a, *b)).collect()
        };
        if let Some([a, b]) = self.words([&then, &other], false, span)? {
            return Ok(Term::Word(self.pool.select(condition, a, b)));
        }
        // Integers that are of one set stay levels.
        let is_one_set = matches!((&then, &other), (Term::Level(a, _), Term::Level(b, _)) if a == b);
        if !is_one_set && let Some([a, b]) = self.wholes([&then, &other], span)? {
            return Ok(Term::Whole(self.pool.select(condition, a, b)));
        }
        match (&then, &other) {
            (Term::Number(a), Term::Number(b)) => Ok(Term::Number(self.pool.select(condition, *a, *b))),
            (Term::Bool(a), Term::Bool(b)) => Ok(Term::Bool(self.pool.cond_if(condition, *a, *b))),
            (Term::Vector(a), Term::Vector(b)) if a.len() == b.len() => Ok(Term::Vector(zip(self, a, b))),
            (Term::List(a), Term::List(b)) => Ok(Term::List(match self.pool.truth(condition) {
                Some(true) => a.clone(),
                Some(false) => b.clone(),
                None => List::either(condition, a.clone(), b.clone(), span)?,
            })),
            (Term::Record(a), Term::Record(b)) if a.iter().map(|p| &p.0).eq(b.iter().map(|p| &p.0)) => {
                let parts = a.iter().zip(b);
                let part = |((name, a), (_, b)): (&(String, Term), &(String, Term))| {
                    Ok((name.clone(), self.choose(condition, a.clone(), b.clone(), span)?))
                };
                Ok(Term::Record(parts.map(part).collect::<Result<_>>()?))
            }
            (Term::Level(s, a), Term::Level(t, b)) if s == t => {
                Ok(self.level_of(*s, LevelTerm::If(condition, a.clone(), b.clone())))
            }
            _ => {
                let message = format!("the other side is {}", self.describe(&then));
                let error = type_error(span, &self.describe(&other), &message);
                Err(match (&then, &other) {
                    (Term::Level(a, _), Term::Level(b, _)) => self.unlike(error, *a, *b),
                    _ => error,
                })
            }
        }
    }
}

pub(super) fn type_error(span: Span, found: &str, message: &str) -> Diagnostic {
    Diagnostic::error(codes::TYPE, format!("{message}, but this is {found}")).at(span, format!("this is {found}"))
}
