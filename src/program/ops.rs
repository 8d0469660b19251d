//! Evaluation of operations in `f64` and in `f32`, and the arithmetic that the
//! table of operators names but no library has.
//!
//! The `f32` meaning is the exact result rounded to nearest. Basic operations
//! are that by IEEE 754; the others are computed in `f64` (by the portable
//! `libm`, so that every machine gets the same bits) and rounded once.
//!
//! `min` and `max` are spelled out for the same reason: the standard library
//! leaves open which zero they return of two, and it differs between machines
//! and between scalar and vector code. Here it is the first operand.

use super::operators::{BinaryOp, TernaryOp, UnaryOp};
use super::pool::Comparison;

/// A floating-point type that programs can be evaluated in.
pub trait Real: Copy + PartialOrd + std::fmt::Debug + 'static {
    /// Rounds to this type.
    fn from_f64(value: f64) -> Self;
    /// Widens, exactly.
    fn to_f64(self) -> f64;
    /// An operation on one number.
    fn unary(op: UnaryOp, a: Self) -> Self;
    /// An operation on two numbers.
    fn binary(op: BinaryOp, a: Self, b: Self) -> Self;
    /// An operation on three numbers.
    fn ternary(op: TernaryOp, a: Self, b: Self, c: Self) -> Self;
}

impl UnaryOp {
    /// The operation in `f64`.
    pub fn apply(self, a: f64) -> f64 {
        f64::unary(self, a)
    }
}

impl BinaryOp {
    /// The operation in `f64`.
    pub fn apply(self, a: f64, b: f64) -> f64 {
        f64::binary(self, a, b)
    }
}

impl TernaryOp {
    /// The operation in `f64`.
    pub fn apply(self, a: f64, b: f64, c: f64) -> f64 {
        f64::ternary(self, a, b, c)
    }
}

impl Comparison {
    /// Returns whether the comparison holds; never, if an operand is NaN.
    pub fn holds<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Equal => a == b,
        }
    }
}

/// The larger number; the first of equal ones, and the other one of a NaN.
#[inline]
pub(super) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a || is_nan(&a) { b } else { a }
}

/// The smaller number; the first of equal ones, and the other one of a NaN.
#[inline]
pub(super) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if b < a || is_nan(&a) { b } else { a }
}

#[inline]
#[allow(clippy::eq_op)]
fn is_nan<T: PartialOrd>(a: &T) -> bool {
    a != a
}

/// -1, 0 or 1; NaN of NaN.
#[inline]
pub(super) fn sign(a: f64) -> f64 {
    if a > 0.0 {
        1.0
    } else if a < 0.0 {
        -1.0
    } else {
        a * 0.0
    }
}

/// 0 up to `lo`, 1 from `hi` on, and a smooth step between.
#[inline]
pub(super) fn smoothstep(lo: f64, hi: f64, a: f64) -> f64 {
    let t = smaller(larger((a - lo) / (hi - lo), 0.0), 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Sine and cosine from additions, products and a rounding, in the order in
/// which generated code has them. WGSL promises only 2^-11 for its own; this is
/// within 1e-7 for arguments up to 100, and as accurate in relation to a small argument.
///
/// The argument is reduced by multiples of a quarter turn, which is subtracted
/// in three parts, the first two so short that their products are exact.
pub(super) fn portable_sincos(x: f32) -> (f32, f32) {
    let quarters = (x * std::f32::consts::FRAC_2_PI).round_ties_even();
    let r = ((x - quarters * 1.570_312_5) - quarters * 4.837_513e-4) - quarters * 7.549_79e-8;
    let z = r * r;
    let sin = r + r * z * (-0.166_666_55 + z * (0.008_332_161 - z * 1.951_529_6e-4));
    let cos = (1.0 - 0.5 * z) + z * z * (0.041_666_646 + z * (-0.001_388_731_6 + z * 2.443_315_7e-5));
    // Which of the two, and with which sign, by products that are exact.
    let odd = quarters - 2.0 * (quarters * 0.5).floor();
    let half = |quarters: f32| {
        let halves = (quarters * 0.5).floor();
        1.0 - 2.0 * (halves - 2.0 * (halves * 0.5).floor())
    };
    let even = 1.0 - odd;
    ((sin * even + cos * odd) * half(quarters), (cos * even + sin * odd) * half(quarters + 1.0))
}

impl Real for f64 {
    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self
    }

    #[inline]
    fn unary(op: UnaryOp, a: f64) -> f64 {
        (op.row().wide)(a)
    }

    #[inline]
    fn binary(op: BinaryOp, a: f64, b: f64) -> f64 {
        (op.row().wide)(a, b)
    }

    #[inline]
    fn ternary(op: TernaryOp, a: f64, b: f64, c: f64) -> f64 {
        (op.row().wide)(a, b, c)
    }
}

impl Real for f32 {
    #[inline]
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline]
    fn unary(op: UnaryOp, a: f32) -> f32 {
        match op.row().narrow {
            Some(narrow) => narrow(a),
            None => f64::unary(op, f64::from(a)) as f32,
        }
    }

    #[inline]
    fn binary(op: BinaryOp, a: f32, b: f32) -> f32 {
        match op.row().narrow {
            Some(narrow) => narrow(a, b),
            None => f64::binary(op, f64::from(a), f64::from(b)) as f32,
        }
    }

    #[inline]
    fn ternary(op: TernaryOp, a: f32, b: f32, c: f32) -> f32 {
        match op.row().narrow {
            Some(narrow) => narrow(a, b, c),
            None => f64::ternary(op, f64::from(a), f64::from(b), f64::from(c)) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_portable_sine_is_accurate() {
        let (mut absolute, mut relative) = (0.0_f64, 0.0_f64);
        for step in -200_000..=200_000 {
            let x = step as f32 * 5e-4;
            for (op, exact) in
                [(UnaryOp::PortableSin, libm::sin(x.into())), (UnaryOp::PortableCos, libm::cos(x.into()))]
            {
                absolute = absolute.max((f64::from(f32::unary(op, x)) - exact).abs());
            }
            let small = x * 1e-3;
            let exact = libm::sin(small.into());
            if small != 0.0 {
                let error = f64::from(f32::unary(UnaryOp::PortableSin, small)) - exact;
                relative = relative.max((error / exact).abs());
            }
        }
        assert!(absolute < 1e-7, "{absolute:e}");
        assert!(relative < 1.2e-7, "{relative:e}");
    }

    #[test]
    fn wgsl_corner_cases() {
        assert_eq!(f32::unary(UnaryOp::Round, 2.5), 2.0);
        assert_eq!(f32::unary(UnaryOp::Round, -3.5), -4.0);
        assert_eq!(f32::unary(UnaryOp::Sign, 0.0), 0.0);
        assert_eq!(f32::binary(BinaryOp::Step, 0.5, 0.5), 1.0);
        assert_eq!(f32::binary(BinaryOp::Remainder, -5.5, 2.0), -1.5);
        assert_eq!(f32::ternary(TernaryOp::Mix, 1.0, 3.0, 0.25), 1.5);
        assert!(f32::unary(UnaryOp::Sign, f32::NAN).is_nan());
        assert_eq!(f32::binary(BinaryOp::Max, 0.0, -0.0).to_bits(), 0.0_f32.to_bits());
        assert_eq!(f32::binary(BinaryOp::Max, -0.0, 0.0).to_bits(), (-0.0_f32).to_bits());
        assert_eq!(f32::binary(BinaryOp::Min, f32::NAN, 1.0), 1.0);
        assert_eq!(f32::binary(BinaryOp::Min, 1.0, f32::NAN), 1.0);
        assert!(!Comparison::LessEqual.holds(f32::NAN, 0.0));
    }
}
