//! Claims of a table about its constants, helpers and functions.

use super::{ExprId, InputId, Program};
use crate::diag::Span;

/// The claims of a table. They never change what it means.
#[derive(Debug, Clone)]
pub struct Claims {
    /// The expressions that they are made of, over all inputs of the table; it has no rows.
    pub program: Program,
    /// The claims, in the order written.
    pub all: Vec<Claim>,
}

/// A claim that two values are the same, or close to each other.
#[derive(Debug, Clone)]
pub struct Claim {
    /// Its name.
    pub name: String,
    /// Its description.
    pub doc: String,
    /// Its place.
    pub span: Span,
    /// The numbers that are compared.
    pub pairs: Vec<ClaimedPair>,
    /// The most that they may differ by; nothing but rounding, if absent.
    pub by: Option<ExprId>,
    /// The inputs that it is claimed for all values of.
    pub inputs: Vec<InputId>,
}

/// Two numbers that are claimed to be equal.
#[derive(Debug, Clone)]
pub struct ClaimedPair {
    /// The part of the values that they are, such as `.x`; empty for values that are numbers.
    pub part: String,
    /// The number on the left.
    pub left: ExprId,
    /// The number on the right.
    pub right: ExprId,
}
