//! Exact fractions in which no overflow goes unnoticed.
//!
//! Numerators and denominators have 127 bits. Every operation that can leave
//! that range returns `None`, and there are no operators beside the sign: what
//! would panic or wrap around does not compile. Whoever gets `None` gives up and
//! says so, or takes the answer that claims nothing.

use std::ops::Neg;

use num_rational::Ratio;
use num_traits::{CheckedAdd, CheckedMul, CheckedSub, Signed, Zero};

/// The greatest common divisor; zero only of zeros.
pub(crate) fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A fraction in lowest terms; its numerator is never the smallest `i128`, so that it has a negative.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Rational(Ratio<i128>);

impl Rational {
    pub(crate) const ZERO: Self = Self(Ratio::new_raw(0, 1));
    pub(crate) const ONE: Self = Self(Ratio::new_raw(1, 1));

    /// A whole number.
    pub(crate) fn whole(value: i64) -> Self {
        Self(Ratio::from_integer(i128::from(value)))
    }

    /// A fraction; `None` if the denominator is zero or a number is too large.
    pub(crate) fn fraction(numerator: i128, denominator: i128) -> Option<Self> {
        let moderate = |number: i128| number != i128::MIN;
        (denominator != 0 && moderate(numerator) && moderate(denominator))
            .then(|| Self(Ratio::new(numerator, denominator)))
    }

    /// The exact value of a double, if numerator and denominator are moderate.
    pub(crate) fn exact(value: f64) -> Option<Self> {
        if value == 0.0 {
            return Some(Self::ZERO);
        }
        let bits = value.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32;
        if exponent == 0 || exponent == 0x7ff {
            return None;
        }
        let mantissa = i128::from(bits & ((1 << 52) - 1) | 1 << 52) * if value < 0.0 { -1 } else { 1 };
        let power = exponent - 1075;
        match power {
            0..=40 => Self::fraction(mantissa << power, 1),
            -100..=-1 => {
                let shift = (-power).min(mantissa.trailing_zeros() as i32);
                let rest = -power - shift;
                if rest <= 60 { Self::fraction(mantissa >> shift, 1 << rest) } else { None }
            }
            _ => None,
        }
    }

    /// The nearest double, or one beside it.
    pub(crate) fn to_f64(self) -> f64 {
        *self.0.numer() as f64 / *self.0.denom() as f64
    }

    pub(crate) fn numerator(self) -> i128 {
        *self.0.numer()
    }

    /// The denominator, which is positive.
    pub(crate) fn denominator(self) -> i128 {
        *self.0.denom()
    }

    pub(crate) fn plus(self, other: Self) -> Option<Self> {
        self.0.checked_add(&other.0).and_then(Self::kept)
    }

    pub(crate) fn minus(self, other: Self) -> Option<Self> {
        self.0.checked_sub(&other.0).and_then(Self::kept)
    }

    pub(crate) fn times(self, other: Self) -> Option<Self> {
        self.0.checked_mul(&other.0).and_then(Self::kept)
    }

    /// One divided by the number; `None` for zero.
    pub(crate) fn reciprocal(self) -> Option<Self> {
        Self::fraction(self.denominator(), self.numerator())
    }

    pub(crate) fn abs(self) -> Self {
        Self(self.0.abs())
    }

    /// The nearest whole number.
    pub(crate) fn round(self) -> Self {
        Self(self.0.round())
    }

    pub(crate) fn is_zero(self) -> bool {
        self.0.is_zero()
    }

    pub(crate) fn is_positive(self) -> bool {
        self.0.is_positive()
    }

    pub(crate) fn is_negative(self) -> bool {
        self.0.is_negative()
    }

    fn kept(value: Ratio<i128>) -> Option<Self> {
        (*value.numer() != i128::MIN).then_some(Self(value))
    }
}

/// Operations that only the rewriting of formulas needs.
#[cfg(any(feature = "precise", test))]
impl Rational {
    pub(crate) const HALF: Self = Self(Ratio::new_raw(1, 2));

    /// The decimal that a double is written as in its shortest form, exactly: 1/10 of `0.1`.
    pub(crate) fn decimal(value: f64) -> Option<Self> {
        let text = value.to_string();
        let (whole, places) = text.split_once('.').unwrap_or((&text, ""));
        let digits = format!("{whole}{places}").parse().ok()?;
        Self::fraction(digits, 10_i128.checked_pow(u32::try_from(places.len()).ok()?)?)
    }

    /// The quotient; `None` also if the divisor is zero.
    pub(crate) fn over(self, other: Self) -> Option<Self> {
        other.reciprocal().and_then(|reciprocal| self.times(reciprocal))
    }

    /// The whole number it is, if it is one.
    pub(crate) fn integer(self) -> Option<i128> {
        (self.denominator() == 1).then_some(self.numerator())
    }
}

impl Neg for Rational {
    type Output = Self;

    fn neg(self) -> Self {
        Self(-self.0)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn doubles_and_decimals_are_exact() {
        let of = |numerator, denominator| Rational::fraction(numerator, denominator);
        assert_eq!(Rational::exact(0.375), of(3, 8));
        assert_eq!(Rational::exact(-6.0), of(-6, 1));
        assert_eq!(Rational::exact(0.1), of(3_602_879_701_896_397, 1 << 55));
        assert_eq!(Rational::exact(1e300), None);
        assert_eq!(Rational::decimal(0.1), of(1, 10));
        assert_eq!(Rational::decimal(-12.5), of(-25, 2));
        assert_eq!(Rational::decimal(f64::NAN), None);
        assert_eq!(of(1, 0), None);
    }

    /// Numbers near every border: small, halves of the range, the ends.
    fn number() -> impl Strategy<Value = i128> {
        prop_oneof![
            -20_i128..20,
            any::<i64>().prop_map(i128::from),
            any::<i128>(),
            (0_i128..4).prop_map(|off| i128::MAX - off),
            (0_i128..4).prop_map(|off| i128::MIN + off),
        ]
    }

    fn fraction() -> impl Strategy<Value = Rational> {
        (number(), number()).prop_filter_map("a fraction", |(top, bottom)| Rational::fraction(top, bottom))
    }

    proptest! {
        /// Checked by going back: what an operation returns undoes to what went in, if that can be computed.
        #[test]
        fn an_operation_is_right_or_refused(a in fraction(), b in fraction()) {
            if let Some(back) = a.plus(b).and_then(|sum| sum.minus(b)) {
                prop_assert_eq!(back, a);
            }
            if let Some(back) = a.times(b).and_then(|product| product.over(b)) {
                prop_assert_eq!(back, a);
            }
            prop_assert_eq!(-(-a), a);
            prop_assert_eq!(a.plus(-a), Some(Rational::ZERO));
            prop_assert_eq!(a.cmp(&b), (-b).cmp(&-a));
            if let Some(difference) = a.minus(b) {
                prop_assert_eq!(difference.is_positive(), a > b);
                prop_assert_eq!(difference.is_zero(), a == b);
            }
            let (x, y) = (a.to_f64(), b.to_f64());
            if let Some(sum) = a.plus(b) {
                prop_assert!((sum.to_f64() - (x + y)).abs() <= 1e-14 * (x.abs() + y.abs()));
            }
            if let Some(product) = a.times(b) {
                prop_assert!((product.to_f64() - x * y).abs() <= 1e-14 * (x * y).abs());
            }
        }
    }
}
