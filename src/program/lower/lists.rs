//! Lists in the making: items that are there in any case, items that are there if a condition
//! holds, lists behind each other.
//!
//! A list has a name, is an argument and is joined with others as what it consists of. Only when it
//! is tied to an output it becomes the components that a [`Program`](crate::program::Program) has
//! for it, a length and items. That is done from the back: with the components of what follows
//! known, an item in front moves them by one place, and where it is there under a condition, each
//! component is chosen by that. So what lists have in common is shared, lengths are choices between
//! constants, and conditions are tested in the order written.

use std::collections::HashMap;
use std::rc::Rc;

use super::output::Part as Tied;
use super::scope::Env;
use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::Scalar;
use crate::program::operators::BinaryOp;
use crate::program::pool::{CondId, ExprId, Node};
use crate::table::Output;
use crate::table::expr::{Expr, ExprKind};

/// Most parts of a list, those on both sides of a choice included.
const MAX_PARTS: usize = 512;

/// A list, by its parts.
#[derive(Debug, Clone, Default)]
pub(super) struct List {
    parts: Rc<Vec<Part>>,
    /// The number of parts, those inside of others included.
    size: usize,
}

/// A part of a list.
#[derive(Debug, Clone)]
pub(super) enum Part {
    /// One item, with its place.
    Item(Term, Span),
    /// The items of one of two lists.
    If(CondId, List, List),
    /// The items of a result, which is given by its components.
    Result(Rc<Output<SetId>>, Vec<ExprId>),
}

impl List {
    /// The list of one item.
    pub(super) fn of(item: Term, span: Span) -> Self {
        Self { parts: Rc::new(vec![Part::Item(item, span)]), size: 1 }
    }

    /// The list that a result is.
    pub(super) fn of_result(output: &Output<SetId>, components: &[ExprId]) -> Self {
        Self { parts: Rc::new(vec![Part::Result(Rc::new(output.clone()), components.to_vec())]), size: 1 }
    }

    /// The parts.
    pub(super) fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// One of two lists.
    pub(super) fn either(condition: CondId, then: List, other: List, span: Span) -> Result<Self> {
        let size = then.size + other.size + 1;
        Self { parts: Rc::new(vec![Part::If(condition, then, other)]), size }.bounded(span)
    }

    /// Two lists, one behind the other.
    fn join(mut self, after: &List, span: Span) -> Result<Self> {
        self.size += after.size;
        let list = self.bounded(span)?;
        let parts = list.parts.iter().chain(after.parts.iter()).cloned().collect();
        Ok(Self { parts: Rc::new(parts), ..list })
    }

    fn bounded(self, span: Span) -> Result<Self> {
        if self.size <= MAX_PARTS {
            return Ok(self);
        }
        Err(Diagnostic::error(codes::TOO_DEEP, format!("a list that is made of {} parts", self.size))
            .at(span, format!("at most {MAX_PARTS}"))
            .help("every item counts, on both sides of a choice, whether it is there or not"))
    }
}

impl Part {
    /// The expressions and conditions that it consists of.
    pub(super) fn parts(&self, exprs: &mut Vec<ExprId>, conditions: &mut Vec<CondId>) {
        match self {
            Part::Item(term, _) => term.parts(exprs, conditions),
            Part::If(condition, then, other) => {
                conditions.push(*condition);
                [then, other].into_iter().flat_map(List::parts).for_each(|part| part.parts(exprs, conditions));
            }
            Part::Result(_, components) => exprs.extend(components),
        }
    }
}

impl Lowering<'_> {
    /// `[a, b if c]`
    pub(super) fn list(&mut self, items: &[Expr], span: Span, env: &Env, expected: &Expected) -> Result<Term> {
        let of = if let Expected::Result(output) = expected
            && let Output::List { of, max, .. } = &**output
        {
            let certain = items.iter().filter(|item| !matches!(item.kind, ExprKind::Optional(..))).count();
            if certain > *max {
                return Err(Diagnostic::error(codes::TYPE, format!("the list has {certain} items"))
                    .at(span, format!("the output allows at most {max}")));
            }
            Some(of)
        } else {
            self.check_free_list(span)?;
            None
        };
        let mut list = List::default();
        for item in items {
            let (value, condition) = if let ExprKind::Optional(value, condition) = &item.kind {
                self.scopes[env.scope].since(2, item.span, "an item with a condition")?;
                (&**value, Some(self.condition(condition, env)?))
            } else {
                (item, None)
            };
            let term = self.term(value, env, of.map_or(Expected::Anything, |of| Expected::of(of)))?;
            if let Some(of) = of {
                // Tied again with the whole list, this tells a mistake where it stands.
                self.tie(of, term.clone(), value.span, "an item", &mut Vec::new())?;
            }
            let own = List::of(term, value.span);
            let own = match condition.map(|condition| (condition, self.pool.truth(condition))) {
                None | Some((_, Some(true))) => own,
                Some((_, Some(false))) => continue,
                Some((condition, None)) => List::either(condition, own, List::default(), item.span)?,
            };
            list = list.join(&own, span)?;
        }
        Ok(Term::List(list))
    }

    /// Refuses a list where nothing says what it is of, if the language or the output of the table has no use for it.
    fn check_free_list(&self, span: Span) -> Result<()> {
        if !self.output.has_list() {
            return Err(Diagnostic::error(
                codes::TYPE,
                "only a table with `output: List(...)` has lists as values, but this is a list",
            )
            .at(span, "this is a list"));
        }
        if self.table.language.value < 2 {
            return Err(Diagnostic::error(codes::TYPE, "a list stands here, where none is expected")
                .at(span, "a list")
                .help("lists stand where the output has one; from version 2 on they have names and are joined, too"));
        }
        Ok(())
    }

    /// `a ++ b`
    pub(super) fn joined_lists(
        &mut self,
        [a, b]: [&Expr; 2],
        span: Span,
        env: &Env,
        expected: &Expected,
    ) -> Result<Term> {
        self.scopes[env.scope].since(2, span, "`++`")?;
        let side = |me: &mut Self, expr: &Expr| match me.term(expr, env, expected.clone())? {
            Term::List(list) => Ok(list),
            other @ (Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::Level(..)
            | Term::Record(_)) => {
                let found = me.describe(&other);
                Err(Diagnostic::error(codes::TYPE, format!("`++` joins lists, but this is {found}"))
                    .at(expr.span, format!("this is {found}"))
                    .help("a list of one item is written in brackets, `[a]`"))
            }
        };
        let (a, b) = (side(self, a)?, side(self, b)?);
        a.join(&b, span).map(Term::List)
    }

    /// The components of a list of at most so many items: its length, its items, and zeros. A list of more
    /// has its real length and the first of its items; that this does not happen is for analyses to show.
    pub(super) fn list_components(
        &mut self,
        list: &List,
        (of, max): (&Output<SetId>, usize),
        span: Span,
    ) -> Result<Vec<ExprId>> {
        let (zero, word) = (self.pool.number(0.0), self.pool.constant_word(0));
        let scalars = of.components().into_iter().map(|component| component.scalar);
        let nothing: Vec<ExprId> = scalars.map(|scalar| if scalar == Scalar::Word { word } else { zero }).collect();
        let nothing = std::iter::once(zero).chain(nothing.repeat(max)).collect();
        let components = self.in_front(list, (of, max), nothing)?;
        match self.pool.constant(components[0]) {
            Some(length) if length > max as f64 => {
                Err(Diagnostic::error(codes::TYPE, format!("the list has {length} items"))
                    .at(span, format!("the output allows at most {max}")))
            }
            _ => Ok(components),
        }
    }

    /// The components of a list in front of another one.
    fn in_front(&mut self, list: &List, to: (&Output<SetId>, usize), rest: Vec<ExprId>) -> Result<Vec<ExprId>> {
        let (of, max) = to;
        list.parts.iter().rev().try_fold(rest, |rest, part| match part {
            Part::Item(term, span) => {
                self.check_room(*span)?;
                let mut own: Vec<Tied> = Vec::new();
                self.tie(of, term.clone(), *span, "an item", &mut own)?;
                for part in &own {
                    self.check_item(of, part.value, *span)?;
                }
                let own: Vec<ExprId> = own.into_iter().map(|part| self.clamped(part)).collect();
                Ok(self.with_first(&own, &rest))
            }
            Part::If(condition, then, other) => {
                let then = self.in_front(then, to, rest.clone())?;
                let other = self.in_front(other, to, rest)?;
                Ok(self.either(*condition, &then, &other))
            }
            Part::Result(output, components) => {
                let Output::List { of: own, max: most, .. } = &**output else { return Ok(rest) };
                if **own == *of && *most == max && self.pool.constant(rest[0]) == Some(0.0) {
                    return Ok(components.clone());
                }
                (0..*most).rev().try_fold(rest, |rest, index| {
                    self.check_room(Span::default())?;
                    let item = &components[1 + index * own.size()..][..own.size()];
                    let more = match **own == *of {
                        true => self.with_first(item, &rest),
                        false => {
                            let item = List::of(self.term_of(own, item), Span::default());
                            self.in_front(&item, to, rest.clone())?
                        }
                    };
                    let is_item = self.is_more(components[0], index as f64, &mut HashMap::new());
                    Ok(self.either(is_item, &more, &rest))
                })
            }
        })
    }

    /// The components of a list with an item in front.
    fn with_first(&mut self, item: &[ExprId], list: &[ExprId]) -> Vec<ExprId> {
        let length = self.one_more(list[0], &mut HashMap::new());
        let rest = list[1..].iter().copied();
        std::iter::once(length).chain(item.iter().copied()).chain(rest).take(list.len()).collect()
    }

    /// A length and one more. Choices stay choices.
    fn one_more(&mut self, length: ExprId, known: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if let Some(done) = known.get(&length) {
            return *done;
        }
        let more = match self.pool.node(length) {
            Node::Const(number) => self.pool.number(number.get() + 1.0),
            Node::Select(condition, then, other) => {
                let [then, other] = [then, other].map(|part| self.one_more(part, known));
                self.pool.select(condition, then, other)
            }
            Node::Word(_)
            | Node::Result(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => {
                let one = self.pool.number(1.0);
                self.pool.binary(BinaryOp::Add, length, one)
            }
        };
        known.insert(length, more);
        more
    }

    /// The components of the lists of two results, one behind the other.
    pub(super) fn behind(
        &mut self,
        output: &Output<SetId>,
        first: &[ExprId],
        rest: Vec<ExprId>,
    ) -> Result<Vec<ExprId>> {
        let Output::List { of, max, .. } = output else { return Ok(rest) };
        self.in_front(&List::of_result(output, first), (of, *max), rest)
    }
}
