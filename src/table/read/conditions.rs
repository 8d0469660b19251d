//! Conditions: expressions, and guards written as data.

use serde::Deserialize;

use super::Result;
use crate::diag::{Diagnostic, codes};
use crate::table::expr::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::table::parse::expression;
use crate::text::raw::{Raw, RawMap, Reader, Shape};

#[derive(Deserialize)]
pub(in crate::table) enum CombinedRon<'a> {
    #[serde(borrow)]
    All(Vec<Raw<'a>>),
    Any(Vec<Raw<'a>>),
    Not(Raw<'a>),
}

impl<'a> Reader<'a> {
    /// A condition: an expression, or guards as data.
    ///
    /// `{"H": ["left", "right"], "b": "entering"}` is a conjunction; `All`, `Any` and
    /// `Not` combine. The result is the same tree that the infix form gives.
    pub(super) fn condition(&self, raw: Raw<'a>) -> Result<Expr> {
        let span = self.span(raw);
        match self.shape(raw) {
            Shape::Map => {
                let map: RawMap<'a> = self.get(raw)?;
                let atoms = map.0.iter().map(|(n, l)| self.atom(*n, *l)).collect::<Result<Vec<_>>>()?;
                self.chain(BinaryOp::And, atoms, raw)
            }
            Shape::Variant(word @ ("All" | "Any")) => {
                let items = match self.get::<CombinedRon<'a>>(raw)? {
                    CombinedRon::All(items) | CombinedRon::Any(items) => items,
                    CombinedRon::Not(item) => vec![item],
                };
                let items = items.into_iter().map(|item| self.condition(item)).collect::<Result<Vec<_>>>()?;
                self.chain(if word == "All" { BinaryOp::And } else { BinaryOp::Or }, items, raw)
            }
            Shape::Variant("Not") => match self.get::<CombinedRon<'a>>(raw)? {
                CombinedRon::Not(item) => {
                    Ok(Expr { span, kind: ExprKind::Unary(UnaryOp::Not, Box::new(self.condition(item)?)) })
                }
                CombinedRon::All(_) | CombinedRon::Any(_) => Err(self.no_condition(raw)),
            },
            Shape::Text | Shape::Other | Shape::Word("true" | "false") => self.expr(raw),
            _ => Err(self.no_condition(raw)),
        }
    }

    fn no_condition(&self, raw: Raw<'a>) -> Diagnostic {
        Diagnostic::error(codes::STRUCTURE, "expected a condition").at(self.span(raw), "not a condition").help(
            "write \"H == left && tV == dual_positive\", {\"H\": [\"left\", \"right\"]}, All([...]), Any([...]) or Not(...)",
        )
    }

    /// Joins conditions, balanced, so that long lists stay shallow.
    fn chain(&self, op: BinaryOp, mut items: Vec<Expr>, raw: Raw<'a>) -> Result<Expr> {
        if items.is_empty() {
            return Err(Diagnostic::error(codes::STRUCTURE, "an empty list of conditions")
                .at(self.span(raw), "expected at least one condition"));
        }
        while items.len() > 1 {
            let mut next = Vec::with_capacity(items.len().div_ceil(2));
            let mut pairs = items.into_iter();
            while let Some(left) = pairs.next() {
                next.push(match pairs.next() {
                    Some(right) => {
                        let span = left.span.to(right.span);
                        Expr { span, kind: ExprKind::Binary(op, Box::new(left), Box::new(right)) }
                    }
                    None => left,
                });
            }
            items = next;
        }
        Ok(items.remove(0))
    }

    /// `"H": "left"` or `"H": ["left", "right"]`
    fn atom(&self, name: Raw<'a>, levels: Raw<'a>) -> Result<Expr> {
        let name = self.word(name)?;
        let span = name.span.to(self.span(levels));
        let levels = match self.shape(levels) {
            Shape::List => {
                self.get::<Vec<Raw<'a>>>(levels)?.into_iter().map(|l| self.word(l)).collect::<Result<Vec<_>>>()?
            }
            _ => vec![self.word(levels)?],
        };
        let input = match name.value.contains('(') {
            true => expression(&name.value, name.span.start + 1)?,
            false => Expr { span: name.span, kind: ExprKind::Name(name.value) },
        };
        Ok(Expr { span, kind: ExprKind::In(Box::new(input), levels) })
    }
}
