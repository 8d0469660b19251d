//! Evaluation of operations in `f64` and in `f32`, by their rows in the table of operators.
//!
//! The `f32` meaning is the exact result rounded to nearest. Basic operations
//! are that by IEEE 754; the others are computed in `f64` (by the portable
//! `libm`, so that every machine gets the same bits) and rounded once.

use super::operators::{BinaryOp, Comparison, TernaryOp, UnaryOp};

/// A floating-point type that programs can be evaluated in.
pub trait Real: Copy + PartialOrd + std::fmt::Debug + 'static {
    /// Rounds to this type.
    fn from_f64(value: f64) -> Self;
    /// Widens, exactly.
    fn to_f64(self) -> f64;
    /// Carries a word: as the number that it is, or, where not all words are numbers, by its bits.
    fn from_word(word: u32) -> Self;
    /// The word that is carried.
    fn to_word(self) -> u32;
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
    /// Returns whether the comparison of two words holds, or of two numbers.
    #[inline]
    pub fn holds_of<T: Real>(self, words: bool, a: T, b: T) -> bool {
        if words { self.holds(a.to_word(), b.to_word()) } else { self.holds(a, b) }
    }

    /// Returns whether the comparison holds; never, if an operand is NaN.
    pub fn holds<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Comparison::Less => a < b,
            Comparison::LessEqual => a <= b,
            Comparison::Equal => a == b,
        }
    }
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
    fn from_word(word: u32) -> Self {
        f64::from(word)
    }

    #[inline]
    fn to_word(self) -> u32 {
        self as u32
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
    fn from_word(word: u32) -> Self {
        f32::from_bits(word)
    }

    #[inline]
    fn to_word(self) -> u32 {
        self.to_bits()
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
