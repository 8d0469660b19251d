//! The rows of the table of operators: one per operator, of a kind per arity.

use super::images::{Bounded, Bounds, Image};
use super::{Notation, Spelling, Spellings, UnaryOp};
use crate::table::expr as ast;

/// The operands for which there is a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operands {
    /// The smallest.
    pub lo: f64,
    /// The largest.
    pub hi: f64,
    /// Leaves out the bounds themselves.
    pub open: bool,
    /// The name of an operation on other operands, as the end of a sentence.
    pub outside: &'static str,
}

impl Operands {
    pub(super) const fn from(lo: f64, outside: &'static str) -> Self {
        Self { lo, hi: f64::INFINITY, open: false, outside }
    }

    pub(super) const fn above(lo: f64, outside: &'static str) -> Self {
        Self { lo, hi: f64::INFINITY, open: true, outside }
    }

    /// Returns whether all of an interval is among them.
    pub fn contain(&self, lo: f64, hi: f64) -> bool {
        if self.open { self.lo < lo && hi < self.hi } else { self.lo <= lo && hi <= self.hi }
    }
}

/// A function of one number as combination of sums, multiples, minima and maxima.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum UnaryAlgebra {
    /// `-a`
    Negate,
    /// `max(a, -a)`
    Absolute,
    /// `max(min(a, 1), 0)`
    Saturate,
    /// No such combination.
    Opaque,
}

/// A function of two numbers as combination of sums, multiples, minima and maxima.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum BinaryAlgebra {
    Sum,
    Difference,
    Product,
    Quotient,
    Minimum,
    Maximum,
    /// No such combination.
    Opaque,
}

/// A function of three numbers as combination of sums, multiples, minima and maxima.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TernaryAlgebra {
    /// `min(max(a, b), c)`
    Clamp,
    /// `a b + c`
    ProductAndSum,
    /// `a (1 - c) + b c`
    Mix,
    /// No such combination.
    Opaque,
}

/// The row of an operator with one operand.
#[derive(Debug, Clone, Copy)]
pub struct Unary {
    /// Its form in a table.
    pub notation: Notation,
    /// Its meaning in a few words.
    pub doc: &'static str,
    /// Its meaning.
    pub wide: fn(f64) -> f64,
    /// Its meaning in `f32`, where that is not [`Self::wide`] rounded once.
    pub narrow: Option<fn(f32) -> f32>,
    /// The image of an interval.
    pub image: Image,
    /// The operands that have a result, if not all have.
    pub operands: Option<Operands>,
    /// Its meaning over the reals.
    pub algebra: UnaryAlgebra,
    /// Cheap, with a finite result for all finite operands that are not huge.
    pub is_plain: bool,
    /// Has results that no `f32` can hold already for moderate operands.
    pub is_exponential: bool,
    /// Has a word for a result.
    pub gives_word: bool,
    /// The operator that functions with a claimed accuracy use instead, where WGSL promises too little for this one.
    pub portable: Option<UnaryOp>,
    /// Its form in generated code.
    pub spellings: Spellings,
}

impl Unary {
    pub(super) const fn function(
        name: &'static str,
        doc: &'static str,
        wide: fn(f64) -> f64,
        image: Image,
        rust: Spelling,
    ) -> Self {
        Self {
            notation: Notation::Function(name, "a"),
            doc,
            wide,
            narrow: None,
            image,
            operands: None,
            algebra: UnaryAlgebra::Opaque,
            is_plain: false,
            is_exponential: false,
            gives_word: false,
            portable: None,
            spellings: Spellings::shared(rust),
        }
    }

    pub(super) const fn portable(self, portable: UnaryOp) -> Self {
        Self { portable: Some(portable), ..self }
    }

    /// The row of an operator that makes a word.
    pub(super) const fn word(
        notation: Notation,
        wide: fn(f64) -> f64,
        narrow: fn(f32) -> f32,
        image: Image,
        spellings: Spellings,
    ) -> Self {
        let row = Self::function("", "", wide, image, Spelling::Same).narrow(narrow).plain();
        Self { notation, spellings, gives_word: true, ..row }
    }

    pub(super) const fn narrow(self, narrow: fn(f32) -> f32) -> Self {
        Self { narrow: Some(narrow), ..self }
    }

    pub(super) const fn on(self, operands: Operands) -> Self {
        Self { operands: Some(operands), ..self }
    }

    pub(super) const fn algebra(self, algebra: UnaryAlgebra) -> Self {
        Self { algebra, ..self }
    }

    pub(super) const fn plain(self) -> Self {
        Self { is_plain: true, ..self }
    }

    pub(super) const fn exponential(self) -> Self {
        Self { is_exponential: true, ..self }
    }

    pub(super) const fn spelled(self, wgsl: Spelling, glsl: Spelling) -> Self {
        Self { spellings: Spellings { wgsl, glsl, rust: self.spellings.rust }, ..self }
    }
}

/// The row of an operator with two operands.
#[derive(Debug, Clone, Copy)]
pub struct Binary {
    /// Its form in a table.
    pub notation: Notation,
    /// Its meaning in a few words.
    pub doc: &'static str,
    /// Its meaning.
    pub wide: fn(f64, f64) -> f64,
    /// Its meaning in `f32`, where that is not [`Self::wide`] rounded once.
    pub narrow: Option<fn(f32, f32) -> f32>,
    /// The image of intervals, neither of which is everything.
    pub image: fn(Bounds, Bounds) -> Bounded,
    /// Its meaning over the reals.
    pub algebra: BinaryAlgebra,
    /// Cheap, with a finite result for all finite operands that are not huge.
    pub is_plain: bool,
    /// Has results that no `f32` can hold already for moderate operands.
    pub is_exponential: bool,
    /// Has a whole result for whole operands.
    pub keeps_whole: bool,
    /// Has two words for operands, and a word for a result.
    pub is_on_words: bool,
    /// Its form in generated code.
    pub spellings: Spellings,
}

/// The meanings of an operation on two numbers, in `f64` and in `f32`.
type Meanings = (fn(f64, f64) -> f64, fn(f32, f32) -> f32);

impl Binary {
    pub(super) const fn symbol(
        op: ast::BinaryOp,
        wide: fn(f64, f64) -> f64,
        algebra: BinaryAlgebra,
        image: fn(Bounds, Bounds) -> Bounded,
    ) -> Self {
        Self::bare(Notation::Infix(op), "", wide, algebra, image, Spellings::SYMBOL)
    }

    pub(super) const fn function(
        name: &'static str,
        arguments: &'static str,
        doc: &'static str,
        wide: fn(f64, f64) -> f64,
        algebra: BinaryAlgebra,
        image: fn(Bounds, Bounds) -> Bounded,
        rust: Spelling,
    ) -> Self {
        Self::bare(Notation::Function(name, arguments), doc, wide, algebra, image, Spellings::shared(rust))
    }

    /// A row of which the rest is as most operators have it.
    const fn bare(
        notation: Notation,
        doc: &'static str,
        wide: fn(f64, f64) -> f64,
        algebra: BinaryAlgebra,
        image: fn(Bounds, Bounds) -> Bounded,
        spellings: Spellings,
    ) -> Self {
        Self {
            notation,
            doc,
            wide,
            narrow: None,
            image,
            algebra,
            is_plain: false,
            is_exponential: false,
            keeps_whole: false,
            is_on_words: false,
            spellings,
        }
    }

    /// The row of an operation on words, which languages write as tables do unless Rust says otherwise.
    pub(super) const fn words(
        op: ast::BinaryOp,
        of: Meanings,
        image: fn(Bounds, Bounds) -> Bounded,
        rust: Spelling,
    ) -> Self {
        Self::on_words(Notation::Infix(op), of, image, Spellings { rust, ..Spellings::SYMBOL })
    }

    /// The row of an operation on words: its meanings in `f64` and in `f32`, and all that it is written as.
    pub(super) const fn on_words(
        notation: Notation,
        (wide, narrow): Meanings,
        image: fn(Bounds, Bounds) -> Bounded,
        spellings: Spellings,
    ) -> Self {
        let row = Self::bare(notation, "", wide, BinaryAlgebra::Opaque, image, spellings);
        Self { is_on_words: true, ..row.narrow(narrow).plain() }
    }

    pub(super) const fn narrow(self, narrow: fn(f32, f32) -> f32) -> Self {
        Self { narrow: Some(narrow), ..self }
    }

    pub(super) const fn plain(self) -> Self {
        Self { is_plain: true, ..self }
    }

    pub(super) const fn exponential(self) -> Self {
        Self { is_exponential: true, ..self }
    }

    pub(super) const fn whole(self) -> Self {
        Self { keeps_whole: true, ..self }
    }

    pub(super) const fn in_glsl(self, glsl: Spelling) -> Self {
        Self { spellings: Spellings { glsl, ..self.spellings }, ..self }
    }
}

/// Two of three operands, by their places, that must be in order.
#[derive(Debug, Clone, Copy)]
pub struct Ascending {
    /// The one that is not above the other.
    pub lower: usize,
    /// The other.
    pub upper: usize,
    /// They are not equal, either.
    pub strictly: bool,
}

/// The row of an operator with three operands; all are functions, and none fails for a finite operand.
#[derive(Debug, Clone, Copy)]
pub struct Ternary {
    /// Its form in a table.
    pub notation: Notation,
    /// Its meaning in a few words.
    pub doc: &'static str,
    /// Its meaning.
    pub wide: fn(f64, f64, f64) -> f64,
    /// Its meaning in `f32`, where that is not [`Self::wide`] rounded once.
    pub narrow: Option<fn(f32, f32, f32) -> f32>,
    /// The image of intervals.
    pub image: fn(Bounds, Bounds, Bounds) -> Bounded,
    /// The operands that must ascend, as shading languages define no result otherwise.
    pub ascending: Option<Ascending>,
    /// Its meaning over the reals.
    pub algebra: TernaryAlgebra,
    /// Its form in generated code.
    pub spellings: Spellings,
}
