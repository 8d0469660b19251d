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
mod words;

use crate::table::expr as ast;

pub use form::{Notation, Spelling, Spellings};
pub use images::{ANY, Bounded, Bounds, Image};
pub use row::{Ascending, Binary, BinaryAlgebra, Operands, Ternary, TernaryAlgebra, Unary, UnaryAlgebra};
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
            Notation::Shared(_) | Notation::Prefix(_) | Notation::Infix(_) => None,
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

impl UnaryOp {
    /// Returns whether the result for a number that `f32` has is one again, so that nothing is rounded.
    pub(crate) fn is_exact(self) -> bool {
        let row = self.row();
        match row.algebra {
            UnaryAlgebra::Negate | UnaryAlgebra::Absolute | UnaryAlgebra::Saturate => true,
            // Steps are whole numbers.
            UnaryAlgebra::Opaque => row.image == Image::Steps,
        }
    }

    /// The image of an interval.
    pub fn image(self, (lo, hi): Bounds) -> Bounded {
        // What failed inside has been reported already.
        if lo == f64::NEG_INFINITY || hi == f64::INFINITY {
            return (ANY, None);
        }
        let row = self.row();
        if let Some(operands) = row.operands.filter(|operands| !operands.contain(lo, hi)) {
            return (ANY, Some(operands.outside));
        }
        row.image.of(row.wide, (lo, hi))
    }
}

impl BinaryOp {
    /// Returns whether the result for numbers that `f32` has is one again, so that nothing is rounded.
    pub(crate) fn is_exact(self) -> bool {
        match self.row().algebra {
            BinaryAlgebra::Minimum | BinaryAlgebra::Maximum => true,
            BinaryAlgebra::Sum | BinaryAlgebra::Difference | BinaryAlgebra::Product | BinaryAlgebra::Quotient => false,
            BinaryAlgebra::Opaque => matches!(self, Self::Step | Self::WholeQuotient | Self::WholeRemainder),
        }
    }

    /// The image of two intervals.
    pub fn image(self, a: Bounds, b: Bounds) -> Bounded {
        // What failed inside has been reported already.
        if a == ANY || b == ANY { (ANY, None) } else { (self.row().image)(a, b) }
    }

    /// The operator that is written as this symbol; none for those of conditions.
    pub fn of_symbol(symbol: ast::BinaryOp) -> Option<Self> {
        Self::ALL.iter().copied().find(|op| op.row().notation == Notation::Infix(symbol))
    }
}

impl TernaryOp {
    /// Returns whether the result for numbers that `f32` has is one again, so that nothing is rounded.
    pub(crate) fn is_exact(self) -> bool {
        self.row().algebra == TernaryAlgebra::Clamp
    }

    /// The image of three intervals.
    pub fn image(self, a: Bounds, b: Bounds, c: Bounds) -> Bounded {
        (self.row().image)(a, b, c)
    }

    /// The two operands that must ascend and do not, as far as operands are known: as
    /// numbers, or as what is left of them in `f32`.
    pub fn misordered(self, operands: [Option<f64>; 3]) -> Option<(f64, f64)> {
        let Ascending { lower, upper, strictly } = self.row().ascending?;
        let (lo, hi) = (operands[lower]?, operands[upper]?);
        (lo > hi || strictly && lo as f32 == hi as f32).then_some((lo, hi))
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_function_has_a_name_of_its_own_and_a_line_of_documentation() {
        let mut names = std::collections::BTreeSet::new();
        for (name, op) in Operator::functions() {
            assert!(names.insert(name) && !op.doc().is_empty(), "{name}");
            assert_eq!(Operator::named(name), Some(op));
        }
        assert_eq!(
            Operator::all().count() - names.len(),
            24,
            "two prefix and seventeen infix operators, five that share a name"
        );
    }

    /// An operand: an interval, and points of it.
    fn operand() -> impl Strategy<Value = (Bounds, Vec<f64>)> {
        let start =
            prop_oneof![6 => -4.0_f64..4.0, 2 => -100.0_f64..100.0, 1 => Just(0.0), 1 => Just(1.0), 1 => -1e6_f64..1e6];
        let width = prop_oneof![1 => Just(0.0), 3 => 0.0_f64..1.0, 3 => 0.0_f64..10.0, 1 => 0.0_f64..1000.0];
        (start, width, prop::collection::vec(0.0_f64..=1.0, 6)).prop_map(|(lo, width, shares)| {
            let hi = lo + width;
            let points = shares.into_iter().map(|share| (lo + share * width).clamp(lo, hi));
            ((lo, hi), points.chain([lo, hi]).collect())
        })
    }

    /// Fails if a value at a point is outside of an image that is said to be one.
    fn contains(image: Bounded, value: f64, what: impl Fn() -> String) -> Result<(), TestCaseError> {
        let ((lo, hi), trouble) = image;
        // Of the portable library no function is known to be monotone to the last digit.
        let slack = 1e-12 * value.abs().max(1.0);
        let inside = lo - slack <= value && value <= hi + slack;
        prop_assert!(trouble.is_some() || inside, "{}: {value} is not in {lo} to {hi}", what());
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

        /// The image of an interval contains the value at every point of it, for every operator, or trouble is reported.
        #[test]
        fn images_contain_the_values((x, xs) in operand(), (y, ys) in operand(), (z, zs) in operand()) {
            for op in UnaryOp::ALL.iter().copied() {
                let image = op.image(x);
                for a in &xs {
                    contains(image, op.apply(*a), || format!("{op:?} of {a} in {x:?}"))?;
                }
            }
            for op in BinaryOp::ALL.iter().copied() {
                let image = op.image(x, y);
                for (a, b) in xs.iter().flat_map(|a| ys.iter().map(move |b| (*a, *b))) {
                    contains(image, op.apply(a, b), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}"))?;
                }
            }
            for op in TernaryOp::ALL.iter().copied() {
                let image = op.image(x, y, z);
                for (a, (b, c)) in xs.iter().flat_map(|a| ys.iter().zip(&zs).map(move |rest| (*a, rest))) {
                    contains(image, op.apply(a, *b, *c), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}, {c} in {z:?}"))?;
                }
            }
        }
    }
}
