//! What each operation means, in `f64` and in `f32`.
//!
//! The `f32` meaning is the exact result rounded to nearest. Basic operations
//! are that by IEEE 754; the others are computed in `f64` (by the portable
//! `libm`, so that every machine gets the same bits) and rounded once.

use super::pool::{BinaryOp, Comparison, TernaryOp, UnaryOp};

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
    /// Whether the comparison holds; never, if an operand is NaN.
    pub fn holds<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Equal => a == b,
        }
    }
}

// `f64::clamp` would pass NaN on and panics on reversed bounds.
#[allow(clippy::manual_clamp)]
impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn to_f64(self) -> f64 {
        self
    }

    fn unary(op: UnaryOp, a: f64) -> f64 {
        match op {
            UnaryOp::Negate => -a,
            UnaryOp::Abs => a.abs(),
            UnaryOp::Acos => libm::acos(a),
            UnaryOp::Acosh => libm::acosh(a),
            UnaryOp::Asin => libm::asin(a),
            UnaryOp::Asinh => libm::asinh(a),
            UnaryOp::Atan => libm::atan(a),
            UnaryOp::Atanh => libm::atanh(a),
            UnaryOp::Ceil => a.ceil(),
            UnaryOp::Cos => libm::cos(a),
            UnaryOp::Cosh => libm::cosh(a),
            UnaryOp::Degrees => a.to_degrees(),
            UnaryOp::Exp => libm::exp(a),
            UnaryOp::Exp2 => libm::exp2(a),
            UnaryOp::Floor => a.floor(),
            UnaryOp::Fract => a - a.floor(),
            UnaryOp::InverseSqrt => 1.0 / a.sqrt(),
            UnaryOp::Log => libm::log(a),
            UnaryOp::Log2 => libm::log2(a),
            UnaryOp::Radians => a.to_radians(),
            UnaryOp::Round => a.round_ties_even(),
            UnaryOp::Saturate => a.max(0.0).min(1.0),
            UnaryOp::Sign if a > 0.0 => 1.0,
            UnaryOp::Sign if a < 0.0 => -1.0,
            UnaryOp::Sign => a * 0.0,
            UnaryOp::Sin => libm::sin(a),
            UnaryOp::Sinh => libm::sinh(a),
            UnaryOp::Sqrt => a.sqrt(),
            UnaryOp::Tan => libm::tan(a),
            UnaryOp::Tanh => libm::tanh(a),
            UnaryOp::Trunc => a.trunc(),
        }
    }

    fn binary(op: BinaryOp, a: f64, b: f64) -> f64 {
        match op {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide => a / b,
            BinaryOp::Remainder => a % b,
            BinaryOp::Atan2 => libm::atan2(a, b),
            BinaryOp::Max => a.max(b),
            BinaryOp::Min => a.min(b),
            BinaryOp::Pow => libm::pow(a, b),
            BinaryOp::Step => f64::from(u8::from(a <= b)),
        }
    }

    fn ternary(op: TernaryOp, a: f64, b: f64, c: f64) -> f64 {
        match op {
            TernaryOp::Clamp => a.max(b).min(c),
            TernaryOp::Fma => a.mul_add(b, c),
            TernaryOp::Mix => a * (1.0 - c) + b * c,
            TernaryOp::Smoothstep => {
                let t = ((c - a) / (b - a)).max(0.0).min(1.0);
                t * t * (3.0 - 2.0 * t)
            }
        }
    }
}

#[allow(clippy::manual_clamp)]
impl Real for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    fn unary(op: UnaryOp, a: f32) -> f32 {
        match op {
            UnaryOp::Negate => -a,
            UnaryOp::Abs => a.abs(),
            UnaryOp::Sqrt => a.sqrt(),
            _ => f64::unary(op, f64::from(a)) as f32,
        }
    }

    fn binary(op: BinaryOp, a: f32, b: f32) -> f32 {
        match op {
            BinaryOp::Add => a + b,
            BinaryOp::Subtract => a - b,
            BinaryOp::Multiply => a * b,
            BinaryOp::Divide => a / b,
            BinaryOp::Max => a.max(b),
            BinaryOp::Min => a.min(b),
            _ => f64::binary(op, f64::from(a), f64::from(b)) as f32,
        }
    }

    fn ternary(op: TernaryOp, a: f32, b: f32, c: f32) -> f32 {
        match op {
            TernaryOp::Clamp => a.max(b).min(c),
            TernaryOp::Fma => a.mul_add(b, c),
            _ => f64::ternary(op, f64::from(a), f64::from(b), f64::from(c)) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wgsl_corner_cases() {
        assert_eq!(f32::unary(UnaryOp::Round, 2.5), 2.0);
        assert_eq!(f32::unary(UnaryOp::Round, -3.5), -4.0);
        assert_eq!(f32::unary(UnaryOp::Sign, 0.0), 0.0);
        assert_eq!(f32::binary(BinaryOp::Step, 0.5, 0.5), 1.0);
        assert_eq!(f32::binary(BinaryOp::Remainder, -5.5, 2.0), -1.5);
        assert_eq!(f32::ternary(TernaryOp::Mix, 1.0, 3.0, 0.25), 1.5);
        assert!(f32::unary(UnaryOp::Sign, f32::NAN).is_nan());
        assert!(!Comparison::LessEqual.holds(f32::NAN, 0.0));
    }
}
