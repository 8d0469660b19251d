//! Expressions of the table language → typed terms.
//!
//! Types are inferred bottom-up, except that a bare level name takes its type
//! from what it is compared with or where it ends up. References to other
//! cases and symmetric images are lowered by *substitution*: the referenced
//! row is lowered again in an environment in which some inputs mean something
//! else. That is the whole treatment of `case(…)` and of `is:`.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use super::InputId;
use super::lower::{Lowering, SetId};
use super::pool::{self, BinaryOp, Comparison, CondId, ExprId, LevelSet, TernaryOp, UnaryOp};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::table::expr::{self as ast, Expr, ExprKind};

pub(super) type Result<T> = std::result::Result<T, Diagnostic>;

/// Deepest and largest value of one row, references included.
const MAX_DEPTH: u32 = 200;
const MAX_SIZE: u32 = 50_000;

/// How many expressions may be open at once while names and references are
/// followed. An unoptimised build needs some 10 KiB of stack for each, of the
/// 2 MiB that a thread has.
const MAX_OPEN: u32 = 100;

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

/// A typed value.
#[derive(Debug, Clone)]
pub(super) enum Term {
    Number(ExprId),
    Vector(Vec<ExprId>),
    Bool(CondId),
    Level(SetId, Arc<LevelTerm>),
    /// A length and items, padded to the output's maximum.
    List(Vec<ExprId>),
}

/// What an expression is expected to be; guides bare level names and lists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Expected {
    Anything,
    Level(SetId),
    List(SetId, usize),
}

/// What names mean at some point.
#[derive(Clone, Default)]
pub(super) struct Env {
    /// Inputs that mean something else here.
    overrides: Arc<HashMap<InputId, Term>>,
    /// What named values became under these overrides.
    names: Rc<RefCell<HashMap<usize, Term>>>,
    /// Names bound by `let`, innermost last.
    locals: Vec<(String, Term)>,
    /// Which cases are being lowered, outermost first.
    cases: Vec<u32>,
    /// Whether this is the value of a referenced case, where no further reference is allowed.
    referenced: bool,
}

impl Env {
    /// The environment of a row of its own.
    pub(super) fn of_case(id: u32) -> Self {
        Self { cases: vec![id], ..Self::default() }
    }

    /// The same environment with one more name.
    pub(super) fn with_local(&self, name: &str, term: Term) -> Self {
        let mut env = self.clone();
        env.locals.push((name.to_owned(), term));
        env
    }
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
        self.depth += 1;
        let term = self.term_inner(expr, env, expected);
        self.depth -= 1;
        let term = term?;
        self.check_size(&term, expr.span)?;
        Ok(term)
    }

    fn check_size(&self, term: &Term, span: Span) -> Result<()> {
        let facts: Vec<pool::Facts> = match term {
            Term::Number(e) => vec![self.pool.expr_facts(*e)],
            Term::Vector(parts) | Term::List(parts) => parts.iter().map(|e| self.pool.expr_facts(*e)).collect(),
            Term::Bool(c) => vec![self.pool.cond_facts(*c)],
            Term::Level(..) => return Ok(()),
        };
        for facts in facts {
            if facts.depth > MAX_DEPTH || facts.size > MAX_SIZE {
                let message = "the value is too large once names and references are written out";
                return Err(Diagnostic::error(codes::TOO_DEEP, message)
                    .at(span, format!("{} operations, {} deep", facts.size, facts.depth))
                    .help(format!("at most {MAX_SIZE} operations, {MAX_DEPTH} deep")));
            }
        }
        Ok(())
    }

    fn term_inner(&mut self, expr: &Expr, env: &Env, expected: Expected) -> Result<Term> {
        let span = expr.span;
        // A level is written by its name or by its code.
        if let Expected::Level(set) = expected
            && matches!(&expr.kind, ExprKind::Number(_) | ExprKind::Unary(ast::UnaryOp::Negate, _))
            && let Some(level) = self.literal_level(set, expr, env)?
        {
            return Ok(Term::Level(set, Arc::new(LevelTerm::Const(level))));
        }
        match &expr.kind {
            ExprKind::Number(value) => Ok(Term::Number(self.constant(*value, span)?)),
            ExprKind::Name(name) => self.name(name, span, env, expected),
            ExprKind::Unary(ast::UnaryOp::Not, a) => {
                let a = self.condition(a, env)?;
                Ok(Term::Bool(self.pool.not(a)))
            }
            ExprKind::Unary(ast::UnaryOp::Negate, a) => {
                let a = self.term(a, env, Expected::Anything)?;
                self.map1(UnaryOp::Negate, a, span)
            }
            ExprKind::Binary(op, a, b) => self.binary(*op, a, b, span, env),
            ExprKind::In(value, levels) => self.membership(value, levels, env),
            ExprKind::Call(function, arguments) => self.call(function, arguments, span, env),
            ExprKind::Swizzle(value, letters) => {
                let value = self.term(value, env, Expected::Anything)?;
                self.swizzle(value, &letters.value, letters.span)
            }
            ExprKind::Case(id, set) => self.case_value(id, set, env),
            ExprKind::If(condition, then, other) => {
                let condition = self.condition(condition, env)?;
                let then_term = self.term(then, env, expected)?;
                let expected = match (&then_term, expected) {
                    (Term::Level(set, _), Expected::Anything) => Expected::Level(*set),
                    _ => expected,
                };
                let other_term = self.term(other, env, expected)?;
                self.choose(condition, then_term, other_term, other.span)
            }
            ExprKind::Let(name, value, body) => {
                crate::table::names::check(&name.value, "a local value", name.span)?;
                let term = self.term(value, env, Expected::Anything)?;
                self.label(&term, &name.value);
                self.term(body, &env.with_local(&name.value, term), expected)
            }
            ExprKind::List(items) => match expected {
                Expected::List(set, max) => self.list(items, set, max, span, env),
                _ => Err(type_error(span, "a list", "only a table with `output: List(...)` has lists as values")),
            },
        }
    }

    /// Remembers a name for generated code.
    pub(super) fn label(&mut self, term: &Term, name: &str) {
        if let Term::Number(expr) = term {
            self.pool.set_label(*expr, name);
        }
    }

    fn constant(&mut self, value: f64, span: Span) -> Result<ExprId> {
        let expr = self.pool.number(value);
        self.finite(expr, span)
    }

    /// Refuses constants that no shader can contain.
    fn finite(&mut self, expr: ExprId, span: Span) -> Result<ExprId> {
        match self.pool.constant(expr) {
            Some(value) if !(value as f32).is_finite() => {
                let shown = if value.is_nan() { "not a number".to_owned() } else { format!("{value:e}") };
                Err(Diagnostic::error(codes::NOT_FINITE, format!("this constant is {shown}"))
                    .at(span, "not a finite f32 number")
                    .help("constants are folded by the compiler; shading languages refuse such a constant"))
            }
            _ => Ok(expr),
        }
    }

    fn name(&mut self, name: &str, span: Span, env: &Env, expected: Expected) -> Result<Term> {
        match name {
            "true" => return Ok(Term::Bool(self.pool.always(true))),
            "false" => return Ok(Term::Bool(self.pool.always(false))),
            _ => {}
        }
        if let Some(term) = self.resolve(name, env)? {
            return Ok(term);
        }
        // A level, where one is expected.
        if let Expected::Level(set) = expected {
            return match self.sets[set.0].find(name) {
                Some(level) => Ok(Term::Level(set, Arc::new(LevelTerm::Const(level)))),
                None => Err(self.unknown_level(set, name, span)),
            };
        }
        // `v.xy`: components of something that has a name.
        if let Some((base, letters)) = name.rsplit_once('.')
            && let Some(term) = self.resolve(base, env)?
        {
            return self.swizzle(term, letters, span);
        }
        Err(self.unknown_name(name, span, env))
    }

    fn resolve(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        if let Some((_, term)) = env.locals.iter().rev().find(|(n, _)| n == name) {
            return Ok(Some(term.clone()));
        }
        if let Some(input) = self.input_named(name) {
            return Ok(Some(self.input_term(input, env)));
        }
        self.named(name, env)
    }

    /// Whether a name stands for something by itself, as levels do not.
    fn is_defined(&self, name: &str, env: &Env) -> bool {
        env.locals.iter().any(|(local, _)| local == name)
            || self.input_named(name).is_some()
            || self.named_index.contains_key(name)
    }

    /// What an input means in an environment.
    pub(super) fn input_term(&mut self, input: InputId, env: &Env) -> Term {
        if let Some(term) = env.overrides.get(&input) {
            return term.clone();
        }
        match self.input_sets[input.index()] {
            None => Term::Number(self.pool.input(input)),
            Some(SetId::BOOL) => Term::Bool(self.pool.level(input, LevelSet::one(1), 2)),
            Some(set) => Term::Level(set, Arc::new(LevelTerm::Input(input))),
        }
    }

    /// A condition or value with a name of its own.
    fn named(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        let Some(index) = self.named_index.get(name).copied() else { return Ok(None) };
        // Without overrides a name means the same everywhere, so it is lowered once.
        // Case references inside it depend on where it is used: then it is lowered anew.
        let cacheable = env.overrides.is_empty() && !env.referenced;
        if cacheable && let Some(term) = &self.named_terms[index] {
            return Ok(Some(term.clone()));
        }
        if let Some(term) = env.names.borrow().get(&index) {
            return Ok(Some(term.clone()));
        }
        let entry = &self.table.names[index];
        if self.resolving.contains(&index) {
            let chain = self.resolving.iter().chain([&index]).map(|i| self.table.names[*i].name.value.as_str());
            let chain = chain.collect::<Vec<_>>().join(" -> ");
            return Err(Diagnostic::error(codes::CIRCULAR_NAME, format!("`{name}` is defined by itself"))
                .at(entry.value.span, chain)
                .help("a name stands for something else: write out one of the definitions"));
        }
        self.resolving.push(index);
        let inner = Env { locals: Vec::new(), ..env.clone() };
        let term = self.term(&entry.value, &inner, Expected::Anything);
        self.resolving.pop();
        let term = term?;
        self.label(&term, name);
        if cacheable {
            self.named_terms[index] = Some(term.clone());
        }
        env.names.borrow_mut().insert(index, term.clone());
        Ok(Some(term))
    }

    /// Lowers an expression that must be a condition.
    pub(super) fn condition(&mut self, expr: &Expr, env: &Env) -> Result<CondId> {
        match self.term(expr, env, Expected::Anything)? {
            Term::Bool(condition) => Ok(condition),
            other => Err(type_error(expr.span, &self.describe(&other), "expected a condition")),
        }
    }

    /// Lowers an expression that must be a number.
    pub(super) fn numeric(&mut self, expr: &Expr, env: &Env) -> Result<ExprId> {
        match self.term(expr, env, Expected::Anything)? {
            Term::Number(number) => Ok(number),
            other => Err(self.no_number(&other, expr.span)),
        }
    }

    fn no_number(&self, term: &Term, span: Span) -> Diagnostic {
        let error = type_error(span, &self.describe(term), "expected a number");
        match term {
            Term::Level(..) | Term::Bool(_) => error.help("`f32(...)` gives the number that stands for it"),
            _ => error,
        }
    }

    fn describe(&self, term: &Term) -> String {
        match term {
            Term::Number(_) => "a number".to_owned(),
            Term::Vector(parts) => format!("a vector of {}", parts.len()),
            Term::Bool(_) => "a condition".to_owned(),
            Term::Level(set, _) => format!("one of the levels {}", self.sets[set.0].names.join(", ")),
            Term::List(_) => "a list".to_owned(),
        }
    }

    fn binary(&mut self, op: ast::BinaryOp, a: &Expr, b: &Expr, span: Span, env: &Env) -> Result<Term> {
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
                let (x, y) = (self.numeric(a, env)?, self.numeric(b, env)?);
                let condition = match op {
                    Op::Less => self.pool.compare(Comparison::Less, x, y),
                    Op::LessEqual => self.pool.compare(Comparison::LessEqual, x, y),
                    Op::Greater => self.pool.compare(Comparison::Less, y, x),
                    _ => self.pool.compare(Comparison::LessEqual, y, x),
                };
                Ok(Term::Bool(condition))
            }
            Op::Add | Op::Subtract | Op::Multiply | Op::Divide | Op::Remainder => {
                let op = match op {
                    Op::Add => BinaryOp::Add,
                    Op::Subtract => BinaryOp::Subtract,
                    Op::Multiply => BinaryOp::Multiply,
                    Op::Divide => BinaryOp::Divide,
                    _ => BinaryOp::Remainder,
                };
                let left = self.term(a, env, Expected::Anything)?;
                let right = self.term(b, env, Expected::Anything)?;
                if matches!(op, BinaryOp::Divide | BinaryOp::Remainder) && self.has_zero(&right) {
                    return Err(Diagnostic::error(codes::DIVISION_BY_ZERO, "division by zero")
                        .at(b.span, "this is always zero"));
                }
                self.map2(op, left, right, span)
            }
        }
    }

    fn has_zero(&self, term: &Term) -> bool {
        match term {
            Term::Number(e) => self.pool.constant(*e) == Some(0.0),
            Term::Vector(parts) => parts.iter().any(|e| self.pool.constant(*e) == Some(0.0)),
            _ => false,
        }
    }

    fn equality(&mut self, a: &Expr, b: &Expr, env: &Env) -> Result<CondId> {
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
    fn literal_level(&mut self, set: SetId, expr: &Expr, env: &Env) -> Result<Option<u8>> {
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

    fn unknown_name(&self, name: &str, span: Span, env: &Env) -> Diagnostic {
        let inputs = self.table.inputs.iter().map(|i| i.name.value.as_str());
        let names = self.table.names.iter().map(|n| n.name.value.as_str());
        let locals = env.locals.iter().map(|(n, _)| n.as_str());
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{name}` is not defined")).at(span, "unknown name");
        if self.sets.iter().any(|set| set.names.iter().any(|n| n == name)) {
            return error.help(format!("`{name}` is a level: compare an input with it, as in `input == {name}`"));
        }
        match crate::table::nearest(name, inputs.clone().chain(names).chain(locals)) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => error.help(format!("the inputs are: {}", inputs.collect::<Vec<_>>().join(", "))),
        }
    }

    fn membership(&mut self, value: &Expr, levels: &[Spanned<String>], env: &Env) -> Result<Term> {
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
    fn level_in_known(
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
    fn set_of(&self, term: &LevelTerm) -> SetId {
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

    fn choose(&mut self, condition: CondId, then: Term, other: Term, span: Span) -> Result<Term> {
        let zip = |me: &mut Self, a: &[ExprId], b: &[ExprId]| -> Vec<ExprId> {
            a.iter().zip(b).map(|(a, b)| me.pool.select(condition, *a, *b)).collect()
        };
        match (&then, &other) {
            (Term::Number(a), Term::Number(b)) => Ok(Term::Number(self.pool.select(condition, *a, *b))),
            (Term::Bool(a), Term::Bool(b)) => Ok(Term::Bool(self.pool.cond_if(condition, *a, *b))),
            (Term::Vector(a), Term::Vector(b)) if a.len() == b.len() => Ok(Term::Vector(zip(self, a, b))),
            (Term::List(a), Term::List(b)) => Ok(Term::List(zip(self, a, b))),
            (Term::Level(s, a), Term::Level(t, b)) if s == t => {
                Ok(Term::Level(*s, Arc::new(LevelTerm::If(condition, a.clone(), b.clone()))))
            }
            _ => {
                let message = format!("the other side is {}", self.describe(&then));
                Err(type_error(span, &self.describe(&other), &message))
            }
        }
    }

    fn list(&mut self, items: &[Expr], set: SetId, max: usize, span: Span, env: &Env) -> Result<Term> {
        if items.len() > max {
            return Err(Diagnostic::error(codes::TYPE, format!("the list has {} items", items.len()))
                .at(span, format!("the output allows at most {max}")));
        }
        let mut parts = vec![self.pool.number(items.len() as f64)];
        for item in items {
            match self.term(item, env, Expected::Level(set))? {
                Term::Level(found, term) if found == set => {
                    parts.push(self.level_number(set, &term, |_, level| f64::from(level)));
                }
                other => return Err(type_error(item.span, &self.describe(&other), "expected a level of the output")),
            }
        }
        let zero = self.pool.number(0.0);
        parts.resize(max + 1, zero);
        Ok(Term::List(parts))
    }

    fn map1(&mut self, op: UnaryOp, a: Term, span: Span) -> Result<Term> {
        match a {
            Term::Number(a) => {
                let result = self.pool.unary(op, a);
                Ok(Term::Number(self.finite(result, span)?))
            }
            Term::Vector(parts) => {
                let parts = parts.into_iter().map(|a| {
                    let result = self.pool.unary(op, a);
                    self.finite(result, span)
                });
                Ok(Term::Vector(parts.collect::<Result<_>>()?))
            }
            other => Err(self.no_number(&other, span)),
        }
    }

    fn map2(&mut self, op: BinaryOp, a: Term, b: Term, span: Span) -> Result<Term> {
        let mut parts = Vec::new();
        let (a, b, scalar) = self.broadcast(a, b, span)?;
        for (a, b) in a.into_iter().zip(b) {
            let result = self.pool.binary(op, a, b);
            parts.push(self.finite(result, span)?);
        }
        Ok(if scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// Components of two operands; a number goes with a vector of any size.
    fn broadcast(&self, a: Term, b: Term, span: Span) -> Result<(Vec<ExprId>, Vec<ExprId>, bool)> {
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
                        error.help("`f32(...)` gives the number of a level or condition")
                    }
                    _ => error,
                })
            }
            (a, _) => Err(self.no_number(&a, span)),
        }
    }

    fn swizzle(&mut self, value: Term, letters: &str, span: Span) -> Result<Term> {
        let Term::Vector(parts) = &value else {
            return Err(type_error(span, &self.describe(&value), "only vectors have components"));
        };
        let pick =
            |letter: char| "xyzw".find(letter).or_else(|| "rgba".find(letter)).and_then(|i| parts.get(i).copied());
        let picked: Option<Vec<ExprId>> = letters.chars().map(pick).collect();
        match picked {
            Some(picked) if picked.len() == 1 => Ok(Term::Number(picked[0])),
            Some(picked) if (2..=4).contains(&picked.len()) => Ok(Term::Vector(picked)),
            _ => Err(Diagnostic::error(codes::TYPE, format!("`.{letters}` is not a component"))
                .at(span, format!("of {}", self.describe(&value)))),
        }
    }

    fn call(&mut self, function: &Spanned<String>, arguments: &[Expr], span: Span, env: &Env) -> Result<Term> {
        let name = function.value.as_str();
        let arity = |expected: usize| -> Result<()> {
            if arguments.len() == expected {
                return Ok(());
            }
            let plural = if expected == 1 { "" } else { "s" };
            Err(Diagnostic::error(
                codes::CALL,
                format!("`{name}` takes {expected} argument{plural}, not {}", arguments.len()),
            )
            .at(span, "wrong number of arguments"))
        };
        match name {
            "f32" => {
                arity(1)?;
                return self.number_of(&arguments[0], env);
            }
            "select" => {
                arity(3)?;
                let condition = self.condition(&arguments[2], env)?;
                let other = self.term(&arguments[0], env, Expected::Anything)?;
                let then = self.term(&arguments[1], env, Expected::Anything)?;
                return self.choose(condition, then, other, span);
            }
            _ => {}
        }
        if let Some((_, op)) = pool::UNARY_FUNCTIONS.iter().find(|(n, _)| *n == name) {
            arity(1)?;
            let a = self.term(&arguments[0], env, Expected::Anything)?;
            return self.map1(*op, a, span);
        }
        if let Some((_, op)) = pool::BINARY_FUNCTIONS.iter().find(|(n, _)| *n == name) {
            arity(2)?;
            let a = self.term(&arguments[0], env, Expected::Anything)?;
            let b = self.term(&arguments[1], env, Expected::Anything)?;
            return self.map2(*op, a, b, span);
        }
        if let Some((_, op)) = pool::TERNARY_FUNCTIONS.iter().find(|(n, _)| *n == name) {
            arity(3)?;
            let terms = [0, 1, 2].map(|i| self.term(&arguments[i], env, Expected::Anything));
            let [a, b, c] = terms;
            return self.map3(*op, a?, b?, c?, span);
        }
        self.vector_call(function, arguments, span, env, arity)
    }

    fn map3(&mut self, op: TernaryOp, a: Term, b: Term, c: Term, span: Span) -> Result<Term> {
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
            let bounds = match op {
                TernaryOp::Clamp => (self.pool.constant(b), self.pool.constant(c)),
                TernaryOp::Smoothstep => (self.pool.constant(a), self.pool.constant(b)),
                _ => (None, None),
            };
            if let (Some(lo), Some(hi)) = bounds
                && (lo > hi || (lo == hi && op == TernaryOp::Smoothstep))
            {
                return Err(Diagnostic::error(
                    codes::DOMAIN,
                    format!("the lower bound {lo} is not below the upper bound {hi}"),
                )
                .at(span, "shading languages leave this undefined"));
            }
            let result = self.pool.ternary(op, a, b, c);
            parts.push(self.finite(result, span)?);
        }
        Ok(if scalar && also_scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// `f32(level)`, `f32(condition)`, `f32(number)`.
    fn number_of(&mut self, argument: &Expr, env: &Env) -> Result<Term> {
        match self.term(argument, env, Expected::Anything)? {
            Term::Number(number) => Ok(Term::Number(number)),
            Term::Level(set, term) => {
                Ok(Term::Number(self.level_number(set, &term, |me, level| me.sets[set.0].codes[usize::from(level)])))
            }
            Term::Bool(condition) => {
                let (one, zero) = (self.pool.number(1.0), self.pool.number(0.0));
                Ok(Term::Number(self.pool.select(condition, one, zero)))
            }
            other => {
                Err(type_error(argument.span, &self.describe(&other), "expected a level, a condition or a number"))
            }
        }
    }

    /// Vectors are expanded here, by WGSL's definitions of the functions.
    fn vector_call(
        &mut self,
        function: &Spanned<String>,
        arguments: &[Expr],
        span: Span,
        env: &Env,
        arity: impl Fn(usize) -> Result<()>,
    ) -> Result<Term> {
        let name = function.value.as_str();
        let size = match name {
            "vec2" => Some(2),
            "vec3" => Some(3),
            "vec4" => Some(4),
            "dot" | "distance" | "cross" => {
                arity(2)?;
                None
            }
            "length" | "normalize" => {
                arity(1)?;
                None
            }
            _ => return Err(self.unknown_function(function)),
        };
        let mut terms = Vec::new();
        for argument in arguments {
            terms.push(match self.term(argument, env, Expected::Anything)? {
                Term::Number(number) => vec![number],
                Term::Vector(parts) => parts,
                other => return Err(self.no_number(&other, argument.span)),
            });
        }
        if let Some(size) = size {
            let mut parts: Vec<ExprId> = terms.concat();
            if parts.len() == 1 {
                parts = vec![parts[0]; size];
            }
            if parts.len() != size {
                return Err(Diagnostic::error(
                    codes::CALL,
                    format!("`{name}` needs {size} components, not {}", parts.len()),
                )
                .at(span, "wrong number of components"));
            }
            return Ok(Term::Vector(parts));
        }
        if terms.len() == 2 && terms[0].len() != terms[1].len() {
            return Err(type_error(span, "vectors of different sizes", "operands must have the same size"));
        }
        match name {
            "dot" => Ok(Term::Number(self.dot(&terms[0], &terms[1]))),
            "length" => Ok(Term::Number(self.length(&terms[0]))),
            "distance" => {
                let pairs = terms[0].iter().zip(&terms[1]);
                let difference: Vec<_> = pairs.map(|(a, b)| self.pool.binary(BinaryOp::Subtract, *a, *b)).collect();
                Ok(Term::Number(self.length(&difference)))
            }
            "normalize" => {
                let length = self.length(&terms[0]);
                let parts = terms[0].iter().map(|a| self.pool.binary(BinaryOp::Divide, *a, length));
                Ok(Term::Vector(parts.collect()))
            }
            _ if terms[0].len() == 3 => {
                let (a, b) = (&terms[0], &terms[1]);
                let mut part = |i: usize, j: usize| {
                    let (x, y) = (
                        self.pool.binary(BinaryOp::Multiply, a[i], b[j]),
                        self.pool.binary(BinaryOp::Multiply, a[j], b[i]),
                    );
                    self.pool.binary(BinaryOp::Subtract, x, y)
                };
                Ok(Term::Vector(vec![part(1, 2), part(2, 0), part(0, 1)]))
            }
            _ => Err(type_error(span, "a vector of another size", "`cross` needs vectors of 3")),
        }
    }

    fn dot(&mut self, a: &[ExprId], b: &[ExprId]) -> ExprId {
        let mut sum = self.pool.binary(BinaryOp::Multiply, a[0], b[0]);
        for (x, y) in a.iter().zip(b).skip(1) {
            let product = self.pool.binary(BinaryOp::Multiply, *x, *y);
            sum = self.pool.binary(BinaryOp::Add, sum, product);
        }
        sum
    }

    fn length(&mut self, a: &[ExprId]) -> ExprId {
        if let [only] = a {
            return self.pool.unary(UnaryOp::Abs, *only);
        }
        let square = self.dot(a, a);
        self.pool.unary(UnaryOp::Sqrt, square)
    }

    fn unknown_function(&self, function: &Spanned<String>) -> Diagnostic {
        let known = || {
            let named =
                pool::UNARY_FUNCTIONS.iter().map(|(n, _)| *n).chain(pool::BINARY_FUNCTIONS.iter().map(|(n, _)| *n));
            let named = named.chain(pool::TERNARY_FUNCTIONS.iter().map(|(n, _)| *n));
            named.chain(["f32", "select", "vec2", "vec3", "vec4", "dot", "length", "distance", "normalize", "cross"])
        };
        let error = Diagnostic::error(codes::CALL, format!("there is no function `{}`", function.value))
            .at(function.span, "unknown function");
        match crate::table::nearest(&function.value, known()) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => error.help(format!("the functions are: {}", known().collect::<Vec<_>>().join(", "))),
        }
    }

    /// `case(11, V = none)`: the value of another row, its guard not tested.
    fn case_value(&mut self, id: &Spanned<u32>, set: &[(Spanned<String>, Expr)], env: &Env) -> Result<Term> {
        if env.cases.contains(&id.value) {
            let chain = env.cases.iter().chain([&id.value]).map(u32::to_string).collect::<Vec<_>>().join(" -> ");
            return Err(Diagnostic::error(codes::CIRCULAR_CASE, format!("case {} refers to itself", id.value))
                .at(id.span, format!("closes the circle {chain}"))
                .help("write out the value of one of these cases"));
        }
        if env.referenced {
            let from = env.cases.last().copied().unwrap_or_default();
            return Err(Diagnostic::error(
                codes::REFERENCE_DEPTH,
                format!("case {from} is referred to and refers to case {}", id.value),
            )
            .at(id.span, "references are one deep")
            .help("write out the value of one of the two"));
        }
        let mut overrides = (*env.overrides).clone();
        for (name, value) in set {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "only inputs can be replaced"));
            };
            let term = self.term_for_input(input, value, env)?;
            overrides.insert(input, term);
        }
        let mut inner =
            Env { overrides: Arc::new(overrides), cases: env.cases.clone(), referenced: true, ..Env::default() };
        inner.cases.push(id.value);
        let (_, lines, result) = self.row_parts(id, &inner)?;
        // The default applies where no line does; the guard is not part of the value.
        let mut term = self.default_term(&inner)?;
        for line in lines.iter().rev() {
            let span = line.span;
            let value = match &result {
                Some(map) => self.apply_result(map, line.value.clone(), &inner)?,
                None => line.value.clone(),
            };
            term = match self.pool.truth(line.condition) {
                Some(true) => value,
                _ => self.choose(line.condition, value, term, span)?,
            };
        }
        Ok(term)
    }

    /// Lowers an expression that replaces an input.
    pub(super) fn term_for_input(&mut self, input: InputId, value: &Expr, env: &Env) -> Result<Term> {
        match self.input_sets[input.index()] {
            None => Ok(Term::Number(self.numeric(value, env)?)),
            Some(SetId::BOOL) => Ok(Term::Bool(self.condition(value, env)?)),
            Some(set) => {
                if let Some(level) = self.literal_level(set, value, env)? {
                    return Ok(Term::Level(set, Arc::new(LevelTerm::Const(level))));
                }
                match self.term(value, env, Expected::Level(set))? {
                    Term::Level(found, term) if found == set => Ok(Term::Level(set, term)),
                    other => Err(type_error(value.span, &self.describe(&other), "this input has other levels")),
                }
            }
        }
    }

    /// Applies the result map of a symmetry.
    pub(super) fn apply_result(&mut self, map: &Expr, value: Term, env: &Env) -> Result<Term> {
        match value {
            Term::Number(_) => Ok(Term::Number(self.numeric(map, &env.with_local("value", value))?)),
            other => Err(type_error(map.span, &self.describe(&other), "only a single number can be mapped")),
        }
    }

    /// An environment in which inputs mean their images under a symmetry.
    pub(super) fn mapped_env(&self, images: HashMap<InputId, Term>, env: &Env) -> Env {
        let mut overrides = (*env.overrides).clone();
        overrides.extend(images);
        Env { overrides: Arc::new(overrides), names: Rc::default(), ..env.clone() }
    }
}

fn type_error(span: Span, found: &str, message: &str) -> Diagnostic {
    Diagnostic::error(codes::TYPE, format!("{message}, but this is {found}")).at(span, format!("this is {found}"))
}
