//! The table itself: an entry per operator.

use std::f64::consts::FRAC_PI_2;

use super::arithmetic::{larger, portable_sincos, sign, smaller, smoothstep, whole_quotient, whole_remainder};
use super::images::{self, Image};
use super::row::{Ascending, Binary, BinaryAlgebra, Operands, Ternary, TernaryAlgebra, Unary, UnaryAlgebra};
use super::{Notation, Spelling, Spellings, words};
use crate::table::expr as ast;

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

            /// The facts about the operator.
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
use Image::{Decreasing, Increasing, Poles, Sawtooth, Steps, Valley, Wave, Words};
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
    // Of words, which `f64` has as numbers, and `f32` carries as bits.
    WordNot = Unary::word(Notation::Prefix(ast::UnaryOp::BitNot), |a| words::wide(!words::of(a)),
        |a| f32::from_bits(!a.to_bits()), Words, Spellings { rust: Text("(!{a})"), ..Spellings::SYMBOL });
    // Of a number from 0 to the largest one below 2^32, the whole part: nothing else is made a word.
    WordOfNumber = Unary::word(Notation::Shared("u32"), |a| words::wide(words::of_number(a)),
        |a| f32::from_bits(words::of_number(f64::from(a))), Steps,
        Spellings { wgsl: Call("u32"), glsl: Call("uint"), rust: Text("({a} as u32)") });
    // Of a whole number, which code has as an integer; a negative one wraps.
    WordOfWhole = Unary::word(Notation::Shared("u32"), |a| words::wide(words::of(a)),
        |a| f32::from_bits(words::of(f64::from(a))), Words,
        Spellings { wgsl: Call("u32"), glsl: Call("uint"), rust: Text("({a} as u32)") });
    NumberOfWord = Unary {
        notation: Notation::Shared("f32"),
        spellings: Spellings { wgsl: Call("f32"), glsl: Call("float"), rust: Text("({a} as f32)") },
        ..Unary::function("", "", |a| a, Increasing, Symbol).narrow(|a| a.to_bits() as f32).plain()
    };
    Trunc = Unary::function("trunc", "nearest integer towards 0", f64::trunc, Steps, Call("f32::trunc")).plain();
}

operators! {
    /// Operations on two numbers.
    BinaryOp, Binary:
    Add = Binary::symbol(ast::BinaryOp::Add, |a, b| a + b, Two::Sum, images::sum).narrow(|a, b| a + b).plain().whole();
    Subtract = Binary::symbol(ast::BinaryOp::Subtract, |a, b| a - b, Two::Difference, images::difference).narrow(|a, b| a - b).plain().whole();
    Multiply = Binary::symbol(ast::BinaryOp::Multiply, |a, b| a * b, Two::Product, images::product).narrow(|a, b| a * b).plain().whole();
    Divide = Binary::symbol(ast::BinaryOp::Divide, |a, b| a / b, Two::Quotient, images::quotient).narrow(|a, b| a / b);
    Remainder = Binary::symbol(ast::BinaryOp::Remainder, |a, b| a % b, Two::Opaque, images::remainder).in_glsl(Own("remainder"));
    // Of whole numbers, which code computes as such. No table divides one by zero.
    WholeQuotient = Binary::symbol(ast::BinaryOp::Divide, whole_quotient, Two::Opaque, images::whole_quotient)
        .plain().whole();
    WholeRemainder = Binary::symbol(ast::BinaryOp::Remainder, whole_remainder, Two::Opaque, images::whole_remainder)
        .plain().whole();
    // Of words. No table divides one by zero, or shifts one by more than 31 places.
    WordAdd = Binary::words(ast::BinaryOp::Add, words::both!(u32::wrapping_add), images::word_sum,
        Text("u32::wrapping_add({a:bare}, {b:bare})"));
    WordSubtract = Binary::words(ast::BinaryOp::Subtract, words::both!(u32::wrapping_sub), images::word_difference,
        Text("u32::wrapping_sub({a:bare}, {b:bare})"));
    WordMultiply = Binary::words(ast::BinaryOp::Multiply, words::both!(u32::wrapping_mul), images::word_product,
        Text("u32::wrapping_mul({a:bare}, {b:bare})"));
    WordQuotient = Binary::words(ast::BinaryOp::Divide, words::both!(words::quotient), images::word_quotient, Symbol);
    WordRemainder = Binary::words(ast::BinaryOp::Remainder, words::both!(words::remainder), images::word_remainder,
        Symbol);
    WordAnd = Binary::words(ast::BinaryOp::BitAnd, words::both!(|a, b| a & b), images::word_and, Symbol);
    WordOr = Binary::words(ast::BinaryOp::BitOr, words::both!(|a, b| a | b), images::word_or, Symbol);
    WordXor = Binary::words(ast::BinaryOp::BitXor, words::both!(|a, b| a ^ b), images::word_xor, Symbol);
    ShiftLeft = Binary::words(ast::BinaryOp::ShiftLeft, words::both!(u32::wrapping_shl), images::shift_left, Symbol);
    ShiftRight = Binary::words(ast::BinaryOp::ShiftRight, words::both!(u32::wrapping_shr), images::shift_right,
        Symbol);
    WordMax = Binary::on_words(Notation::Shared("max"), words::both!(u32::max), images::word_maximum,
        Spellings::shared(Call("u32::max")));
    WordMin = Binary::on_words(Notation::Shared("min"), words::both!(u32::min), images::word_minimum,
        Spellings::shared(Call("u32::min")));
    Atan2 = Binary::function("atan2", "a, b", "angle of the point (b, a)", libm::atan2, Two::Opaque, images::angle, Wide("atan2"))
        .in_glsl(Call("atan"));
    Max = Binary::function("max", "a, b", "the larger", larger, Two::Maximum, images::maximum, Call("f32::max"))
        .narrow(larger).plain().whole();
    Min = Binary::function("min", "a, b", "the smaller", smaller, Two::Minimum, images::minimum, Call("f32::min"))
        .narrow(smaller).plain().whole();
    Pow = Binary::function("pow", "a, b", "a^b", libm::pow, Two::Opaque, images::power, Wide("powf")).exponential();
    Step = Binary::function("step", "e, a", "1 if e <= a, else 0", |e, a| f64::from(u8::from(e <= a)), Two::Opaque, images::step,
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
        image: images::clamp,
        ascending: Some(Ascending { lower: 1, upper: 2, strictly: false }),
        algebra: Three::Clamp,
        spellings: Spellings::shared(Text("f32::min(f32::max({a:bare}, {b:bare}), {c:bare})")),
    };
    Fma = Ternary {
        notation: Notation::Function("fma", "a, b, c"),
        doc: "a b + c",
        wide: f64::mul_add,
        narrow: Some(f32::mul_add),
        image: images::product_and_sum,
        ascending: None,
        algebra: Three::ProductAndSum,
        spellings: Spellings { glsl: Text("({a} * {b} + {c})"), ..Spellings::shared(Call("f32::mul_add")) },
    };
    Mix = Ternary {
        notation: Notation::Function("mix", "a, b, t"),
        doc: "a (1 - t) + b t",
        wide: |a, b, t| a * (1.0 - t) + b * t,
        narrow: None,
        image: images::mix,
        ascending: None,
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
        image: images::smoothstep,
        ascending: Some(Ascending { lower: 0, upper: 1, strictly: true }),
        algebra: Three::Opaque,
        // Shading languages leave their own undefined where the first bound is not below the second.
        spellings: Spellings::own("smoothstep", Text(
            "({ let t = ((f64::from({c} as f32) - f64::from({a} as f32)) / (f64::from({b} as f32) - f64::from({a} as f32))).max(0.0).min(1.0); (t * t * (3.0 - 2.0 * t)) as f32 })",
        )),
    };
}
