//! The one table of operators.
//!
//! A row says everything about an operator that is not arithmetic of a
//! particular kind: its name in tables, its line of documentation, its meaning
//! in `f64` and `f32`, the image of an interval, and its spelling in each
//! language that is printed. Parsing, lowering, printing, the interpreters, the
//! analyses and `docs/language.md` read it. Two meanings stand elsewhere, each
//! in an exhaustive match: what WGSL's accuracy rules admit
//! (`eval/interval.rs`), and many bits (`eval/precise.rs`).

use std::f64::consts::FRAC_PI_2;

use super::ops::{larger, portable_sincos, sign, smaller, smoothstep};
use crate::table::expr as ast;

/// An operator's form in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notation {
    /// A call of a function: its name and the names of its arguments.
    Function(&'static str, &'static str),
    /// A symbol before the operand.
    Prefix(ast::UnaryOp),
    /// A symbol between the operands.
    Infix(ast::BinaryOp),
}

impl Notation {
    /// The name of the function, or the symbol.
    pub fn name(self) -> &'static str {
        match self {
            Notation::Function(name, _) => name,
            Notation::Prefix(op) => op.symbol(),
            Notation::Infix(op) => op.symbol(),
        }
    }
}

/// An operator's form in generated code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spelling {
    /// A call of a function with the name that it has in tables.
    Same,
    /// A call of a function with another name.
    Call(&'static str),
    /// The symbol that it has in tables; in parentheses, as some front ends refuse what others accept without.
    Symbol,
    /// A template: `{a}`, `{b}` and `{c}` are operands, `{a:bare}` one without its outer parentheses.
    Text(&'static str),
    /// Rust only: a method of `f64`, rounded once; for functions that are not correctly rounded in `f32`.
    Wide(&'static str),
    /// A call of a function that the generated module defines.
    Own(&'static str),
    /// The first or the second of the two numbers that the module's function for sine and cosine returns.
    OfSincos {
        /// The cosine rather than the sine.
        second: bool,
    },
}

/// An operator's form in each language that is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spellings {
    /// WGSL.
    pub wgsl: Spelling,
    /// GLSL, every version.
    pub glsl: Spelling,
    /// Rust.
    pub rust: Spelling,
}

impl Spellings {
    /// The symbols of the table's language in every language.
    const SYMBOL: Self = Self { wgsl: Spelling::Symbol, glsl: Spelling::Symbol, rust: Spelling::Symbol };

    /// The name of the table's language in shading languages.
    const fn shared(rust: Spelling) -> Self {
        Self { wgsl: Spelling::Same, glsl: Spelling::Same, rust }
    }
}

/// The course of a function of one number, from which the image of an interval follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Image {
    /// Never decreases.
    Increasing,
    /// Never decreases, and has whole results only.
    Steps,
    /// Never increases.
    Decreasing,
    /// The same for `-a` as for `a`, and never decreases from 0 on.
    Valley,
    /// Falls from 1 at `peak` to -1 half a turn later, and so on with every turn.
    Wave {
        /// A place where it is 1.
        peak: f64,
    },
    /// Increases between poles that are half a turn apart.
    Poles {
        /// The place of a pole.
        pole: f64,
        /// What an operand there is, as the end of a sentence.
        what: &'static str,
    },
    /// The distance from the whole number below.
    Sawtooth,
}

/// The operands for which there is a result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operands {
    /// The smallest.
    pub lo: f64,
    /// The largest.
    pub hi: f64,
    /// Leaves out the bounds themselves.
    pub open: bool,
    /// What an operation on others is, as the end of a sentence.
    pub outside: &'static str,
}

impl Operands {
    const fn from(lo: f64, outside: &'static str) -> Self {
        Self { lo, hi: f64::INFINITY, open: false, outside }
    }

    const fn above(lo: f64, outside: &'static str) -> Self {
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
    /// The operator that functions with a claimed accuracy use instead, where WGSL promises too little for this one.
    pub portable: Option<UnaryOp>,
    /// Its form in generated code.
    pub spellings: Spellings,
}

impl Unary {
    const fn function(
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
            portable: None,
            spellings: Spellings::shared(rust),
        }
    }

    const fn portable(self, portable: UnaryOp) -> Self {
        Self { portable: Some(portable), ..self }
    }

    const fn narrow(self, narrow: fn(f32) -> f32) -> Self {
        Self { narrow: Some(narrow), ..self }
    }

    const fn on(self, operands: Operands) -> Self {
        Self { operands: Some(operands), ..self }
    }

    const fn algebra(self, algebra: UnaryAlgebra) -> Self {
        Self { algebra, ..self }
    }

    const fn plain(self) -> Self {
        Self { is_plain: true, ..self }
    }

    const fn exponential(self) -> Self {
        Self { is_exponential: true, ..self }
    }

    const fn spelled(self, wgsl: Spelling, glsl: Spelling) -> Self {
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
    /// Its meaning over the reals.
    pub algebra: BinaryAlgebra,
    /// Cheap, with a finite result for all finite operands that are not huge.
    pub is_plain: bool,
    /// Has results that no `f32` can hold already for moderate operands.
    pub is_exponential: bool,
    /// Its form in generated code.
    pub spellings: Spellings,
}

impl Binary {
    const fn symbol(op: ast::BinaryOp, wide: fn(f64, f64) -> f64, algebra: BinaryAlgebra) -> Self {
        Self {
            notation: Notation::Infix(op),
            doc: "",
            wide,
            narrow: None,
            algebra,
            is_plain: false,
            is_exponential: false,
            spellings: Spellings::SYMBOL,
        }
    }

    const fn function(
        name: &'static str,
        arguments: &'static str,
        doc: &'static str,
        wide: fn(f64, f64) -> f64,
        algebra: BinaryAlgebra,
        rust: Spelling,
    ) -> Self {
        Self {
            notation: Notation::Function(name, arguments),
            doc,
            wide,
            narrow: None,
            algebra,
            is_plain: false,
            is_exponential: false,
            spellings: Spellings::shared(rust),
        }
    }

    const fn narrow(self, narrow: fn(f32, f32) -> f32) -> Self {
        Self { narrow: Some(narrow), ..self }
    }

    const fn plain(self) -> Self {
        Self { is_plain: true, ..self }
    }

    const fn exponential(self) -> Self {
        Self { is_exponential: true, ..self }
    }

    const fn in_glsl(self, glsl: Spelling) -> Self {
        Self { spellings: Spellings { glsl, ..self.spellings }, ..self }
    }
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
    /// Its meaning over the reals.
    pub algebra: TernaryAlgebra,
    /// Its form in generated code.
    pub spellings: Spellings,
}

/// Declares the operators of one arity: the enumeration, all of its values, and their rows.
macro_rules! operators {
    ($(#[$meta:meta])* $Op:ident, $Row:ident: $($Name:ident = $row:expr;)*) => {
        $(#[$meta])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[allow(missing_docs)]
        pub enum $Op { $($Name),* }

        impl $Op {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$Name),*];

            /// What is known of the operator.
            #[inline]
            pub const fn row(self) -> &'static $Row {
                static ROWS: &[$Row] = &[$($row),*];
                // There is a row for each, in the same order.
                &ROWS[self as usize]
            }
        }
    };
}

use BinaryAlgebra as Two;
use Image::{Decreasing, Increasing, Poles, Sawtooth, Steps, Valley, Wave};
use Spelling::{Call, OfSincos, Own, Symbol, Text, Wide};
use TernaryAlgebra as Three;
use UnaryAlgebra as One;

const WITHIN_ONE: Operands = Operands { lo: -1.0, hi: 1.0, open: false, outside: "can have an operand beyond -1 to 1" };
const BETWEEN_ONES: Operands =
    Operands { lo: -1.0, hi: 1.0, open: true, outside: "can have an operand that is not between -1 and 1" };
const LOGARITHM: Operands = Operands::above(0.0, "can be the logarithm of a number that is not positive");

// Rust is written in blocks where an operand in place would occur twice, and nested ones exponentially often.
operators! {
    /// Operations on one number.
    UnaryOp, Unary:
    Negate = Unary {
        notation: Notation::Prefix(ast::UnaryOp::Negate),
        spellings: Spellings::SYMBOL,
        ..Unary::function("", "", |a| -a, Decreasing, Symbol).narrow(|a| -a).algebra(One::Negate).plain()
    };
    Abs = Unary::function("abs", "a without its sign", f64::abs, Valley, Call("f32::abs"))
        .narrow(f32::abs).algebra(One::Absolute).plain();
    Acos = Unary::function("acos", "arc cosine, in radians", libm::acos, Decreasing, Wide("acos")).on(WITHIN_ONE);
    Acosh = Unary::function("acosh", "inverse of `cosh` from 1 on", libm::acosh, Increasing, Wide("acosh"))
        .on(Operands::from(1.0, "can have an operand below 1"));
    Asin = Unary::function("asin", "arc sine, in radians", libm::asin, Increasing, Wide("asin")).on(WITHIN_ONE);
    Asinh = Unary::function("asinh", "inverse of `sinh`", libm::asinh, Increasing, Wide("asinh"));
    Atan = Unary::function("atan", "arc tangent, in radians", libm::atan, Increasing, Wide("atan"));
    Atanh = Unary::function("atanh", "inverse of `tanh`", libm::atanh, Increasing, Wide("atanh")).on(BETWEEN_ONES);
    Ceil = Unary::function("ceil", "nearest integer above", f64::ceil, Steps, Call("f32::ceil")).plain();
    Cos = Unary::function("cos", "cosine of an angle in radians", libm::cos, Wave { peak: 0.0 }, Wide("cos"))
        .portable(UnaryOp::PortableCos);
    Cosh = Unary::function("cosh", "hyperbolic cosine", libm::cosh, Valley, Wide("cosh")).exponential();
    Degrees = Unary::function("degrees", "from radians to degrees", f64::to_degrees, Increasing, Wide("to_degrees"))
        .plain();
    Exp = Unary::function("exp", "e^a", libm::exp, Increasing, Wide("exp")).exponential();
    Exp2 = Unary::function("exp2", "2^a", libm::exp2, Increasing, Wide("exp2")).exponential();
    Floor = Unary::function("floor", "nearest integer below", f64::floor, Steps, Call("f32::floor")).plain();
    Fract = Unary::function("fract", "a - floor(a)", |a| a - a.floor(), Sawtooth,
        Text("({ let t: f32 = {a:bare}; t - f32::floor(t) })")).plain();
    InverseSqrt = Unary::function("inverseSqrt", "one over the square root", |a| 1.0 / a.sqrt(), Decreasing,
        Text("((1.0 / f64::sqrt(f64::from({a} as f32))) as f32)"))
        .on(Operands::above(0.0, "can be the inverse root of a number that is not positive"))
        .spelled(Spelling::Same, Call("inversesqrt"));
    Log = Unary::function("log", "natural logarithm", libm::log, Increasing, Wide("ln")).on(LOGARITHM);
    Log2 = Unary::function("log2", "binary logarithm", libm::log2, Increasing, Wide("log2")).on(LOGARITHM);
    PortableCos = Unary::function("portableCos",
        "`cos` from additions and products: within 1e-7 for angles up to 100",
        libm::cos, Wave { peak: 0.0 }, OfSincos { second: true })
        .narrow(|a| portable_sincos(a).1)
        .spelled(OfSincos { second: true }, OfSincos { second: true });
    PortableSin = Unary::function("portableSin",
        "`sin` from additions and products: within 1e-7 for angles up to 100",
        libm::sin, Wave { peak: FRAC_PI_2 }, OfSincos { second: false })
        .narrow(|a| portable_sincos(a).0)
        .spelled(OfSincos { second: false }, OfSincos { second: false });
    Radians = Unary::function("radians", "from degrees to radians", f64::to_radians, Increasing, Wide("to_radians"))
        .plain();
    Round = Unary::function("round", "nearest integer, ties to the even one", f64::round_ties_even, Steps,
        Call("f32::round_ties_even")).spelled(Spelling::Same, Call("roundEven")).plain();
    Saturate = Unary::function("saturate", "clamp(a, 0, 1)", |a| smaller(larger(a, 0.0), 1.0), Increasing,
        Text("f32::min(f32::max({a:bare}, 0.0), 1.0)"))
        .spelled(Spelling::Same, Text("clamp({a:bare}, 0.0, 1.0)")).algebra(One::Saturate).plain();
    Sign = Unary::function("sign", "-1, 0 or 1", sign, Steps,
        Text("({ let t: f32 = {a:bare}; if t > 0.0 { 1.0 } else if t < 0.0 { -1.0 } else { t * 0.0 } })")).plain();
    Sin = Unary::function("sin", "sine of an angle in radians", libm::sin, Wave { peak: FRAC_PI_2 }, Wide("sin"))
        .portable(UnaryOp::PortableSin);
    Sinh = Unary::function("sinh", "hyperbolic sine", libm::sinh, Increasing, Wide("sinh")).exponential();
    Sqrt = Unary::function("sqrt", "square root", f64::sqrt, Increasing, Call("f32::sqrt"))
        .on(Operands::from(0.0, "can be the root of a negative number")).narrow(f32::sqrt);
    Tan = Unary::function("tan", "tangent of an angle in radians", libm::tan,
        Poles { pole: FRAC_PI_2, what: "can be the tangent of a right angle" }, Wide("tan"));
    Tanh = Unary::function("tanh", "hyperbolic tangent", libm::tanh, Increasing, Wide("tanh"));
    Trunc = Unary::function("trunc", "nearest integer towards 0", f64::trunc, Steps, Call("f32::trunc")).plain();
}

operators! {
    /// Operations on two numbers.
    BinaryOp, Binary:
    Add = Binary::symbol(ast::BinaryOp::Add, |a, b| a + b, Two::Sum).narrow(|a, b| a + b).plain();
    Subtract = Binary::symbol(ast::BinaryOp::Subtract, |a, b| a - b, Two::Difference).narrow(|a, b| a - b).plain();
    Multiply = Binary::symbol(ast::BinaryOp::Multiply, |a, b| a * b, Two::Product).narrow(|a, b| a * b).plain();
    Divide = Binary::symbol(ast::BinaryOp::Divide, |a, b| a / b, Two::Quotient).narrow(|a, b| a / b);
    Remainder = Binary::symbol(ast::BinaryOp::Remainder, |a, b| a % b, Two::Opaque).in_glsl(Own("remainder"));
    Atan2 = Binary::function("atan2", "a, b", "angle of the point (b, a)", libm::atan2, Two::Opaque, Wide("atan2"))
        .in_glsl(Call("atan"));
    Max = Binary::function("max", "a, b", "the larger", larger, Two::Maximum, Call("f32::max"))
        .narrow(larger).plain();
    Min = Binary::function("min", "a, b", "the smaller", smaller, Two::Minimum, Call("f32::min"))
        .narrow(smaller).plain();
    Pow = Binary::function("pow", "a, b", "a^b", libm::pow, Two::Opaque, Wide("powf")).exponential();
    Step = Binary::function("step", "e, a", "1 if e <= a, else 0", |e, a| f64::from(u8::from(e <= a)), Two::Opaque,
        Text("(if {a} <= {b} { 1.0 } else { 0.0 })")).plain();
}

operators! {
    /// Operations on three numbers.
    TernaryOp, Ternary:
    Clamp = Ternary {
        notation: Notation::Function("clamp", "a, lo, hi"),
        doc: "min(max(a, lo), hi)",
        wide: |a, lo, hi| smaller(larger(a, lo), hi),
        narrow: Some(|a, lo, hi| smaller(larger(a, lo), hi)),
        algebra: Three::Clamp,
        spellings: Spellings::shared(Text("f32::min(f32::max({a:bare}, {b:bare}), {c:bare})")),
    };
    Fma = Ternary {
        notation: Notation::Function("fma", "a, b, c"),
        doc: "a b + c",
        wide: f64::mul_add,
        narrow: Some(f32::mul_add),
        algebra: Three::ProductAndSum,
        spellings: Spellings { glsl: Text("({a} * {b} + {c})"), ..Spellings::shared(Call("f32::mul_add")) },
    };
    Mix = Ternary {
        notation: Notation::Function("mix", "a, b, t"),
        doc: "a (1 - t) + b t",
        wide: |a, b, t| a * (1.0 - t) + b * t,
        narrow: None,
        algebra: Three::Mix,
        spellings: Spellings::shared(Text(
            "((f64::from({a} as f32) * (1.0 - f64::from({c} as f32)) + f64::from({b} as f32) * f64::from({c} as f32)) as f32)",
        )),
    };
    Smoothstep = Ternary {
        notation: Notation::Function("smoothstep", "lo, hi, a"),
        doc: "t² (3 - 2t) with t = saturate((a - lo) / (hi - lo))",
        wide: smoothstep,
        narrow: None,
        algebra: Three::Opaque,
        spellings: Spellings::shared(Text(
            "({ let t = ((f64::from({c} as f32) - f64::from({a} as f32)) / (f64::from({b} as f32) - f64::from({a} as f32))).max(0.0).min(1.0); (t * t * (3.0 - 2.0 * t)) as f32 })",
        )),
    };
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
