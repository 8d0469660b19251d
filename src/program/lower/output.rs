//! The output: its level sets found, its kind inferred for a function, and values tied to it.

use std::collections::{HashMap, HashSet};
use std::convert::Infallible;
use std::rc::Rc;

use super::lists::List;
use super::terms::{Expected, Term};
use super::whole::whole_components;
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program;
use crate::program::Scalar;
use crate::program::domain::LevelKind;
use crate::program::operators::TernaryOp;
use crate::program::pool::{Component, ExprId, Node};
use crate::table::Output;

/// The largest whole number of a function, whose range is not declared.
const MAX_WHOLE: i32 = 1 << 24;

/// A component of a value that is tied to the output, and the bounds that it is still to be clamped to.
pub(super) struct Part {
    pub(super) value: ExprId,
    pub(super) clamp: Option<(f64, f64)>,
}

impl Expected {
    /// The expectation of a value that is to be tied to an output.
    pub(super) fn of(output: &Output<SetId>) -> Self {
        match output {
            Output::Number(_) | Output::Vector(..) | Output::Bool | Output::Int(..) | Output::U32 => Expected::Anything,
            Output::Enumeration(of) => Expected::Level(*of),
            Output::Record(_) | Output::List { .. } => Expected::Result(Rc::new(output.clone())),
        }
    }
}

impl Lowering<'_> {
    /// Finds the level sets of the output that a table declares.
    pub(super) fn declare_output(&mut self) -> Result<()> {
        let table = self.table;
        self.output = Rc::new(table.output.value.try_map(&mut |name| self.find_named_set(name))?);
        self.check_collected()?;
        let mut ranges = Vec::new();
        whole_components(&self.output, &mut ranges);
        let known = |(component, range): (program::Component, Option<(i32, i32)>)| match (component.scalar, range) {
            (Scalar::Word, _) => Component::Word,
            (_, Some((from, to))) => Component::Whole((f64::from(from), f64::from(to))),
            (_, None) => Component::Any,
        };
        self.pool.declare_results(self.output.components().into_iter().zip(ranges).map(known).collect());
        self.check_columns(table.output.span)
    }

    /// A level set that a result can be of. A condition has no levels in an expression.
    fn find_named_set(&mut self, name: &Spanned<String>) -> Result<SetId> {
        match self.find_set(name)? {
            SetId::BOOL => Err(Diagnostic::error(
                codes::DOMAIN,
                format!("`{}` is a condition, it has no levels", name.value),
            )
            .at(name.span, "expected named levels or integers")
            .help("declare levels for the output under `levels`, for instance \"answer\": {\"no\": 0, \"yes\": 1}")),
            set if self.is_wide(set) => Err(Diagnostic::error(
                codes::DOMAIN,
                format!("`{}` has more integers than a result can be one of", name.value),
            )
            .at(name.span, "more than 64")
            .help("declare the result as `Int(from: ..., to: ...)`")),
            set => Ok(set),
        }
    }

    /// Infers the output of a function from its value.
    pub(super) fn infer_output(&mut self, term: &Term, span: Span) -> Result<()> {
        self.output = Rc::new(self.inferred(term, span)?);
        self.check_columns(span)
    }

    /// The kind of result that a value is.
    pub(super) fn inferred(&self, term: &Term, span: Span) -> Result<Output<SetId>> {
        let version_2 = |what: &str| self.table.since(2, span, &format!("a function that returns {what}"));
        Ok(match term {
            Term::Number(_) => Output::Number(None),
            Term::Whole(_) => {
                version_2("a whole number")?;
                Output::Int(-MAX_WHOLE, MAX_WHOLE)
            }
            Term::Word(_) => {
                version_2("a U32")?;
                Output::U32
            }
            Term::Vector(parts) => Output::Vector(parts.len(), None),
            Term::Record(parts) => {
                let field = |(name, part): &(String, Term)| Ok((name.clone(), self.inferred(part, span)?));
                Output::Record(parts.iter().map(field).collect::<Result<_>>()?)
            }
            Term::Bool(_) => {
                version_2("a condition")?;
                Output::Bool
            }
            Term::Level(set, _) => {
                version_2("a level")?;
                Output::Enumeration(*set)
            }
            Term::List(_) => {
                let message = format!("a function returns no list, but this is {}", self.describe(term));
                return Err(Diagnostic::error(codes::OUTPUTS, message)
                    .at(span, "a list")
                    .help("what a list is of and how long it gets is declared with the `output` of a table of cases"));
            }
        })
    }

    /// Refuses fields whose components would have the same name in data or in generated code.
    fn check_columns(&self, span: Span) -> Result<()> {
        let mut seen = HashSet::new();
        let components: Vec<String> = self.output.components().into_iter().map(|component| component.name).collect();
        // A list fills one column, which has a name of its own.
        let columns = self.output.columns();
        let lists: Vec<String> = columns.into_iter().filter(|name| !components.contains(name)).collect();
        let twice = components.into_iter().chain(lists).find(|name| !seen.insert(name.clone()));
        match twice {
            None => Ok(()),
            Some(name) => {
                Err(Diagnostic::error(codes::DUPLICATE, format!("two parts of the result are called `{name}`"))
                    .at(span, "of this output")
                    .help("the parts of a field are called after it: `at_x` is the first number of a vector `at`"))
            }
        }
    }

    /// An output with its levels, as programs have it.
    pub(super) fn resolved(&self, output: &Output<SetId>) -> program::Output {
        let Ok(output) = output.try_map(&mut |set| Ok::<_, Infallible>(self.sets[set.0].clone()));
        output
    }

    /// The expectation of a value that is to be tied to the output.
    pub(super) fn expected_output(&self) -> Expected {
        Expected::of(&self.output)
    }

    /// Ties a value to the output: the components, not clamped yet.
    pub(super) fn components(&mut self, term: Term, span: Span) -> Result<Vec<Part>> {
        let mut parts = Vec::new();
        let output = self.output.clone();
        let term = self.as_items(term, span);
        self.tie(&output, term, span, "the output", &mut parts)?;
        Ok(parts)
    }

    /// Ties a value to an output or to a part of one, which `what` names.
    pub(super) fn tie(
        &mut self,
        output: &Output<SetId>,
        term: Term,
        span: Span,
        what: &str,
        parts: &mut Vec<Part>,
    ) -> Result<()> {
        let free = |value: ExprId| Part { value, clamp: None };
        match (output, term) {
            (Output::Number(clamp), Term::Number(value)) => parts.push(Part { value, clamp: *clamp }),
            (Output::Vector(size, clamp), Term::Vector(values)) if values.len() == *size => {
                parts.extend(values.into_iter().map(|value| Part { value, clamp: *clamp }));
            }
            (Output::Bool, Term::Bool(condition)) => {
                let (one, zero) = (self.pool.number(1.0), self.pool.number(0.0));
                parts.push(free(self.pool.select(condition, one, zero)));
            }
            (Output::U32, term @ (Term::Word(_) | Term::Number(_) | Term::Whole(_)))
                if matches!(term, Term::Word(_)) || self.constant_value(&term).is_some() =>
            {
                parts.push(free(self.word_of(&term, span)?));
            }
            (Output::Int(from, to), Term::Number(value)) => {
                parts.push(free(self.whole_result(value, (*from, *to), span, what)?))
            }
            // The range of what is calculated is judged when rows are complete, where they are taken.
            (Output::Int(..), Term::Whole(value)) => parts.push(free(value)),
            (Output::Int(..), Term::Level(set, _)) if self.is_wide(set) => return Err(self.too_wide(set, span)),
            (Output::Int(..), Term::Level(set, level)) if self.sets[set.0].kind == LevelKind::Int => {
                let value = self.level_number(set, &level, |me, level| me.sets[set.0].codes[usize::from(level)]);
                parts.push(free(value));
            }
            (Output::Enumeration(of), Term::Level(set, term)) if set == *of => {
                parts.push(free(self.level_number(set, &term, |_, level| f64::from(level))));
            }
            (Output::List { of, max, .. }, Term::List(list)) => {
                parts.extend(self.list_components(&list, (of, *max), span)?.into_iter().map(free));
            }
            (Output::Record(fields), Term::Record(values))
                if values.len() == fields.len()
                    && fields.iter().all(|(name, _)| values.iter().any(|(other, _)| name == other)) =>
            {
                for (name, field) in fields {
                    let Some((_, value)) = values.iter().find(|(other, _)| name == other) else { continue };
                    self.tie(field, value.clone(), span, &format!("`{name}`"), parts)?;
                }
            }
            (_, term) => {
                let (found, wanted) = (self.describe(&term), self.resolved(output).describe());
                let declared = match self.table.functions.is_empty() {
                    true => "what the table returns is declared under `output`",
                    false => "what a function returns is of the kind of its value, or of its default if it has cases",
                };
                return Err(Diagnostic::error(codes::TYPE, format!("{what} is {wanted}, but this is {found}"))
                    .at(span, format!("this is {found}"))
                    .help(declared));
            }
        }
        Ok(())
    }

    /// A number that chooses between whole numbers of a range.
    fn whole_result(&self, value: ExprId, (from, to): (i32, i32), span: Span, what: &str) -> Result<ExprId> {
        let mut open = vec![value];
        while let Some(expr) = open.pop() {
            match self.pool.node(expr) {
                Node::Const(number) if number.get().fract() == 0.0 => {
                    let whole = number.get();
                    if !(f64::from(from)..=f64::from(to)).contains(&whole) {
                        return Err(Diagnostic::error(
                            codes::DOMAIN,
                            format!("{whole} is not between {from} and {to}"),
                        )
                        .at(span, "a result out of its range")
                        .at(self.table.output.span, "declared here"));
                    }
                }
                Node::Select(_, then, other) => open.extend([then, other]),
                Node::Const(_)
                | Node::Word(_)
                | Node::Input(_)
                | Node::Index(_)
                | Node::Result(_)
                | Node::Unary(..)
                | Node::Binary(..)
                | Node::Ternary(..) => {
                    return Err(Diagnostic::error(
                        codes::TYPE,
                        format!("{what} is a whole number, but this is a real number"),
                    )
                    .at(span, "not a choice between whole numbers")
                    .help("write whole numbers, `Int` inputs, and choices between them"));
                }
            }
        }
        Ok(value)
    }

    /// Ties a value to the output: the components, clamped.
    pub(super) fn result(&mut self, term: Term, span: Span) -> Result<Vec<ExprId>> {
        let parts = self.components(term, span)?;
        Ok(parts.into_iter().map(|part| self.clamped(part)).collect())
    }

    pub(super) fn clamped(&mut self, Part { value, clamp }: Part) -> ExprId {
        match clamp {
            None => value,
            Some((lo, hi)) => {
                let (lo, hi) = (self.pool.number(lo), self.pool.number(hi));
                self.pool.ternary(TernaryOp::Clamp, value, lo, hi)
            }
        }
    }

    /// The value that consists of some components.
    pub(super) fn term_of(&mut self, output: &Output<SetId>, components: &[ExprId]) -> Term {
        match output {
            Output::Number(_) => Term::Number(components[0]),
            Output::Int(..) => Term::Whole(components[0]),
            Output::U32 => Term::Word(components[0]),
            Output::Vector(..) => Term::Vector(components.to_vec()),
            Output::Bool => Term::Bool(self.is_more(components[0], 0.0, &mut HashMap::new())),
            Output::Enumeration(set) => {
                let level = self.level_with_index(*set, components[0], &mut HashMap::new());
                Term::Level(*set, level)
            }
            Output::List { .. } => Term::List(List::of_result(output, components)),
            Output::Record(fields) => {
                let mut rest = components;
                let part = |(name, of): &(String, Output<SetId>)| {
                    let (own, others) = rest.split_at(of.size());
                    rest = others;
                    (name.clone(), self.term_of(of, own))
                };
                Term::Record(fields.iter().map(part).collect())
            }
        }
    }
}
