//! Claims of a table about its constants and functions, as written.

use serde::Deserialize;

use super::expr::Expr;
use crate::diag::{Diagnostic, Span, Spanned};
use crate::text::raw::{Raw, Reader};

type Result<T> = std::result::Result<T, Diagnostic>;

/// A claim that two values are the same, or close to each other.
#[derive(Debug, Clone)]
pub struct Claim {
    /// Its name.
    pub name: Spanned<String>,
    /// The whole claim.
    pub span: Span,
    /// One of the values.
    pub left: Expr,
    /// The other one.
    pub right: Expr,
    /// The most that they may differ by; nothing but rounding, if absent.
    pub by: Option<Expr>,
    /// The inputs that it is claimed for all values of.
    pub inputs: Vec<Spanned<String>>,
    /// Its description.
    pub doc: String,
}

impl Claim {
    /// The expressions in it.
    pub fn exprs(&self) -> impl Iterator<Item = &Expr> {
        [&self.left, &self.right].into_iter().chain(&self.by)
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum ClaimRon<'a> {
    Equal {
        #[serde(borrow)]
        left: Raw<'a>,
        right: Raw<'a>,
        #[serde(default)]
        tolerance: Option<Raw<'a>>,
        #[serde(default, rename = "for")]
        inputs: Vec<Raw<'a>>,
        #[serde(default)]
        doc: String,
    },
    Within {
        left: Raw<'a>,
        right: Raw<'a>,
        by: Raw<'a>,
        #[serde(default, rename = "for")]
        inputs: Vec<Raw<'a>>,
        #[serde(default)]
        doc: String,
    },
}

impl<'a> Reader<'a> {
    /// `"mean": Equal(left: "sum(k in ring3, k.z * k.x)", right: 0, tolerance: 1e-12)`
    pub(super) fn claim(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Claim> {
        let (left, right, by, inputs, doc) = match self.get(raw)? {
            ClaimRon::Equal { left, right, tolerance, inputs, doc } => (left, right, tolerance, inputs, doc),
            ClaimRon::Within { left, right, by, inputs, doc } => (left, right, Some(by), inputs, doc),
        };
        Ok(Claim {
            name: self.word(name)?,
            span: self.span(raw),
            left: self.expr(left)?,
            right: self.expr(right)?,
            by: by.map(|by| self.expr(by)).transpose()?,
            inputs: inputs.into_iter().map(|input| self.word(input)).collect::<Result<_>>()?,
            doc,
        })
    }
}
