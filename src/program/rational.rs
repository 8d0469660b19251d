//! Exact fractions in which no overflow goes unnoticed.
//!
//! Numerators and denominators have 127 bits. Every operation that can leave
//! that range returns `None`, and there are no operators beside the sign: what
//! would panic or wrap around does not compile. Whoever gets `None` gives up and
//! says so, or takes the answer that claims nothing.

use std::cmp::Ordering;
use std::hash::{Hash, Hasher};
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

/// The same of numbers of 64 bits, which processors divide themselves.
fn small_gcd(mut a: u64, mut b: u64) -> u64 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// A fraction in lowest terms; its numerator is never the smallest `i128`, so that it has a negative.
///
/// Nearly all that occur are small. Where numerators and denominators fit into 64 bits, sums, products and
/// comparisons are made there, and equality and hashes look at the two numbers, as each fraction has one form:
/// the ways of [`Ratio`] divide numbers of 128 bits again and again.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rational(Ratio<i128>);

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        self.0.numer() == other.0.numer() && self.0.denom() == other.0.denom()
    }
}

impl Eq for Rational {}

impl Hash for Rational {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.numer().hash(state);
        self.0.denom().hash(state);
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        match (self.small(), other.small()) {
            (Some((a, b)), Some((c, d))) => (i128::from(a) * i128::from(d)).cmp(&(i128::from(c) * i128::from(b))),
            _ => self.0.cmp(&other.0),
        }
    }
}

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
        let small = self.small().zip(other.small());
        small.and_then(|(a, b)| Self::sum(a, b)).or_else(|| self.0.checked_add(&other.0).and_then(Self::kept))
    }

    pub(crate) fn minus(self, other: Self) -> Option<Self> {
        let small = self.small().zip((-other).small());
        small.and_then(|(a, b)| Self::sum(a, b)).or_else(|| self.0.checked_sub(&other.0).and_then(Self::kept))
    }

    pub(crate) fn times(self, other: Self) -> Option<Self> {
        let (Some((a, b)), Some((c, d))) = (self.small(), other.small()) else {
            return self.0.checked_mul(&other.0).and_then(Self::kept);
        };
        // What has no common divisor crosswise has none afterwards. A divisor of a positive number is no larger.
        let (across, back) =
            (small_gcd(a.unsigned_abs(), d as u64) as i64, small_gcd(c.unsigned_abs(), b as u64) as i64);
        let product = |one: i64, other: i64| i128::from(one) * i128::from(other);
        Some(Self(Ratio::new_raw(product(a / across, c / back), product(b / back, d / across))))
    }

    /// Numerator and denominator, if they fit into 64 bits.
    fn small(self) -> Option<(i64, i64)> {
        Some((i64::try_from(*self.0.numer()).ok()?, i64::try_from(*self.0.denom()).ok()?))
    }

    /// The sum of small fractions, if its parts are small before they are reduced.
    fn sum((a, b): (i64, i64), (c, d): (i64, i64)) -> Option<Self> {
        let numerator = a.checked_mul(d)?.checked_add(c.checked_mul(b)?)?;
        let denominator = b.checked_mul(d)?;
        let common = small_gcd(numerator.unsigned_abs(), denominator as u64) as i64;
        let (numerator, denominator) = (numerator / common, denominator / common);
        Some(Self(Ratio::new_raw(i128::from(numerator), i128::from(denominator))))
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
            // The short ways lead where the long ones do.
            prop_assert_eq!(a.plus(b), a.0.checked_add(&b.0).and_then(Rational::kept));
            prop_assert_eq!(a.minus(b), a.0.checked_sub(&b.0).and_then(Rational::kept));
            prop_assert_eq!(a.times(b), a.0.checked_mul(&b.0).and_then(Rational::kept));
            prop_assert_eq!((a.cmp(&b), a == b), (a.0.cmp(&b.0), a.0 == b.0));
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
