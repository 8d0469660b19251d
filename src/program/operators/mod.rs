//! The one table of operators.
//!
//! A row says everything about an operator that is not arithmetic of a
//! particular kind: its name in tables, its line of documentation, its meaning
//! in `f64` and `f32`, the image of intervals, and its spelling in each
//! language that is printed. Parsing, lowering, printing, the interpreters, the
//! analyses and `docs/language.md` read it. Two meanings stand elsewhere, each
//! in an exhaustive match: what WGSL's accuracy rules admit
//! (`eval/interval.rs`), and many bits (`eval/precise.rs`).

mod arithmetic;
mod form;
mod images;
mod row;
mod table;

use crate::table::expr as ast;

pub use form::{Notation, Spelling, Spellings};
pub use images::{ANY, Bounded, Bounds};
pub use row::{Ascending, Binary, BinaryAlgebra, Image, Operands, Ternary, TernaryAlgebra, Unary, UnaryAlgebra};
pub use table::{BinaryOp, TernaryOp, UnaryOp};

/// Comparison of two numbers. `a > b` is stored as `b < a`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Comparison {
    Less,
    LessEqual,
    Equal,
}

/// An operator of any arity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Operator {
    Unary(UnaryOp),
    Binary(BinaryOp),
    Ternary(TernaryOp),
}

impl Operator {
    /// All operators, those with fewer operands first.
    pub fn all() -> impl Iterator<Item = Self> {
        let unary = UnaryOp::ALL.iter().copied().map(Self::Unary);
        let binary = BinaryOp::ALL.iter().copied().map(Self::Binary);
        unary.chain(binary).chain(TernaryOp::ALL.iter().copied().map(Self::Ternary))
    }

    /// The operators that are called as functions, with their names.
    pub fn functions() -> impl Iterator<Item = (&'static str, Self)> {
        Self::all().filter_map(|op| match op.notation() {
            Notation::Function(name, _) => Some((name, op)),
            Notation::Prefix(_) | Notation::Infix(_) => None,
        })
    }

    /// The operator that is called as a function with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::functions().find(|(known, _)| *known == name).map(|(_, op)| op)
    }

    /// Its form in a table.
    pub fn notation(self) -> Notation {
        match self {
            Self::Unary(op) => op.row().notation,
            Self::Binary(op) => op.row().notation,
            Self::Ternary(op) => op.row().notation,
        }
    }

    /// Its meaning in a few words; empty for what is written as a symbol.
    pub fn doc(self) -> &'static str {
        match self {
            Self::Unary(op) => op.row().doc,
            Self::Binary(op) => op.row().doc,
            Self::Ternary(op) => op.row().doc,
        }
    }
}

impl BinaryOp {
    /// The operator that is written as this symbol; none for those of conditions.
    pub fn of_symbol(symbol: ast::BinaryOp) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.row().notation == Notation::Infix(symbol))
    }
}

impl TernaryOp {
    /// The two operands that must ascend and do not, as far as operands are known.
    pub fn misordered(self, operands: [Option<f64>; 3]) -> Option<(f64, f64)> {
        let Ascending { lower, upper, strictly } = self.row().ascending?;
        let (lo, hi) = (operands[lower]?, operands[upper]?);
        (lo > hi || strictly && lo == hi).then_some((lo, hi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_has_a_name_of_its_own_and_a_line_of_documentation() {
        let mut names = std::collections::BTreeSet::new();
        for (name, op) in Operator::functions() {
            assert!(names.insert(name) && !op.doc().is_empty(), "{name}");
            assert_eq!(Operator::named(name), Some(op));
        }
        assert_eq!(Operator::all().count() - names.len(), 6, "negation and five infix operators");
    }
}
