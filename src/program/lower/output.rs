//! The output: its level sets found, its kind inferred for a function, and values tied to it.

use std::convert::Infallible;
use std::rc::Rc;

use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program;
use crate::program::operators::TernaryOp;
use crate::program::pool::ExprId;
use crate::table::Output;

/// A component of a value that is tied to the output, and the bounds that it is still to be clamped to.
pub(super) struct Part {
    pub(super) value: ExprId,
    pub(super) clamp: Option<(f64, f64)>,
}

impl Lowering<'_> {
    /// Finds the level sets of the output that a table declares.
    pub(super) fn declare_output(&mut self) -> Result<()> {
        let table = self.table;
        self.output = Rc::new(table.output.value.try_map(&mut |name| self.find_named_set(name))?);
        Ok(())
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
            set => Ok(set),
        }
    }

    /// Infers the output of a function from its value.
    pub(super) fn infer_output(&mut self, term: &Term, span: Span) -> Result<()> {
        self.output = Rc::new(match term {
            Term::Number(_) => Output::Number(None),
            Term::Vector(parts) => Output::Vector(parts.len(), None),
            Term::Record(parts) => {
                Output::Record(parts.iter().map(|(name, _)| (name.clone(), Output::Number(None))).collect())
            }
            Term::Bool(_) | Term::Level(..) | Term::List(_) => {
                let message = format!("a function returns numbers, but this is {}", self.describe(term));
                return Err(Diagnostic::error(codes::OUTPUTS, message)
                    .at(span, "not a number, vector or record")
                    .help("`f32(...)` gives the number of a level or condition"));
            }
        });
        Ok(())
    }

    /// An output with its levels, as programs have it.
    pub(super) fn resolved(&self, output: &Output<SetId>) -> program::Output {
        let Ok(output) = output.try_map(&mut |set| Ok::<_, Infallible>(self.sets[set.0].clone()));
        output
    }

    /// The expectation of a value that is to be tied to the output.
    pub(super) fn expected_output(&self) -> Expected {
        match &*self.output {
            Output::Number(_) | Output::Vector(..) | Output::Record(_) => Expected::Anything,
            Output::Enumeration(of) => Expected::Level(*of),
            Output::List { of, max } => Expected::List(*of, *max),
        }
    }

    /// Ties a value to the output: the components, not clamped yet.
    pub(super) fn components(&mut self, term: Term, span: Span) -> Result<Vec<Part>> {
        let mut parts = Vec::new();
        let output = self.output.clone();
        self.tie(&output, term, span, &mut parts)?;
        Ok(parts)
    }

    fn tie(&mut self, output: &Output<SetId>, term: Term, span: Span, parts: &mut Vec<Part>) -> Result<()> {
        let free = |value: ExprId| Part { value, clamp: None };
        match (output, term) {
            (Output::Number(clamp), Term::Number(value)) => parts.push(Part { value, clamp: *clamp }),
            (Output::Vector(size, clamp), Term::Vector(values)) if values.len() == *size => {
                parts.extend(values.into_iter().map(|value| Part { value, clamp: *clamp }));
            }
            (Output::Enumeration(of), Term::Level(set, term)) if set == *of => {
                parts.push(free(self.level_number(set, &term, |_, level| f64::from(level))));
            }
            (Output::List { .. }, Term::List(values)) => parts.extend(values.into_iter().map(free)),
            (Output::Record(fields), Term::Record(values))
                if values.iter().map(|(name, _)| name).eq(fields.iter().map(|(name, _)| name)) =>
            {
                for ((_, field), (_, value)) in fields.iter().zip(values) {
                    self.tie(field, Term::Number(value), span, parts)?;
                }
            }
            (_, term) => {
                let (found, wanted) = (self.describe(&term), self.resolved(output).describe());
                let declared = match self.table.functions.is_empty() {
                    true => "what the table returns is declared under `output`",
                    false => "what a function returns is of the kind of its value, or of its default if it has cases",
                };
                return Err(Diagnostic::error(codes::TYPE, format!("the output is {wanted}, but this is {found}"))
                    .at(span, format!("this is {found}"))
                    .help(declared));
            }
        }
        Ok(())
    }

    /// Ties a value to the output: the components, clamped.
    pub(super) fn result(&mut self, term: Term, span: Span) -> Result<Vec<ExprId>> {
        let parts = self.components(term, span)?;
        let clamped = parts.into_iter().map(|Part { value, clamp }| match clamp {
            None => value,
            Some((lo, hi)) => {
                let (lo, hi) = (self.pool.number(lo), self.pool.number(hi));
                self.pool.ternary(TernaryOp::Clamp, value, lo, hi)
            }
        });
        Ok(clamped.collect())
    }
}
