//! Sums and products in any order.
//!
//! WGSL lets an implementation reassociate: whatever is the same over the reals it may
//! compute instead. Mesa's compiler does, for one: `a * b + a * c` becomes `a * (b + c)`, and
//! `mix(a, b, t)` may be `a + t * (b - a)`, and the parts of a remainder `a - b * trunc(a / b)`
//! or of a step `1 - (0 or 1)` are added to what stands beside them. Where large terms cancel the results are far apart,
//! and both are right.
//!
//! However a sum of products is computed, each operation adds at most one rounding of the sum
//! of the magnitudes of all products (Higham, Accuracy and Stability of Numerical Algorithms,
//! chapter 3). So a [`Free`] is the exact value, that sum, and the number of operations. A
//! rounding counts twice what rounding to nearest errs by: WGSL fixes no direction, and some
//! orders take more operations than were written. Quotients multiply by a reciprocal;
//! everything else is opaque, and a new beginning.

use super::interval::Interval;
use crate::program::Comparison;

/// The error of one operation, relative to its result: WGSL fixes no direction of rounding.
const UNIT: f64 = 1.0 / 8_388_608.0;

/// Operations that a quotient counts for: 2.5 units in the last place, rounded up, and the product.
const QUOTIENT: u32 = 4;

/// A sum of products that may be computed in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Free {
    /// The exact value, for any values of what it is made of.
    lo: f64,
    hi: f64,
    /// The sum of the magnitudes of all its products.
    size: f64,
    /// The operations.
    count: u32,
}

impl Free {
    /// A value that is not looked into.
    pub(super) fn leaf(value: Interval) -> Self {
        let (lo, hi) = (value.lo(), value.hi());
        Self { lo, hi, size: lo.abs().max(hi.abs()), count: 0 }
    }

    /// With another sign, which is exact.
    pub(super) fn negate(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo, ..self }
    }

    pub(super) fn add(self, other: Self) -> Self {
        let count = self.count + other.count + 1;
        Self { lo: self.lo + other.lo, hi: self.hi + other.hi, size: self.size + other.size, count }
    }

    pub(super) fn subtract(self, other: Self) -> Self {
        self.add(other.negate())
    }

    pub(super) fn multiply(self, other: Self) -> Self {
        let corners = [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self { lo, hi, size: self.size * other.size, count: self.count + other.count + 1 }
    }

    /// By a divisor that is not looked into.
    pub(super) fn over(self, divisor: Interval) -> Self {
        if divisor.is_any() || divisor.lo() <= 0.0 && divisor.hi() >= 0.0 {
            return Self::leaf(Interval::ANY);
        }
        let (a, b) = (1.0 / divisor.hi(), 1.0 / divisor.lo());
        let reciprocal = Self { lo: a, hi: b, size: a.abs().max(b.abs()), count: QUOTIENT - 1 };
        self.multiply(reciprocal)
    }

    /// `a (1 - t) + b t`
    pub(super) fn mix(a: Self, b: Self, t: Self) -> Self {
        let one = Self::leaf(Interval::constant(1.0));
        a.multiply(one.subtract(t)).add(b.multiply(t))
    }

    /// 0 or 1 as one less its opposite, as compilers have `step`.
    pub(super) fn one_less(value: Interval) -> Self {
        let one = Interval::constant(1.0);
        Self::leaf(one).subtract(Self::leaf(Interval::between(1.0 - value.hi(), 1.0 - value.lo())))
    }

    /// Bounds of the value in any order of operations; `None` if there are not several of them.
    pub(super) fn interval(self) -> Option<Interval> {
        if self.count < 2 {
            return None;
        }
        let off = self.off();
        Some(Interval::between(self.lo - off, self.hi + off))
    }

    /// Returns whether a comparison holds, if it does or does not in any order of operations, of those on both of its
    /// sides together: `a < b + c` may be `a - b < c`.
    pub(super) fn compare(self, op: Comparison, other: Self) -> Option<bool> {
        let difference = other.subtract(self);
        let off = difference.off();
        let (lo, hi) = (difference.lo - off, difference.hi + off);
        match op {
            // Also where it is not known, since something is infinite.
            _ if !(lo.is_finite() && hi.is_finite()) => None,
            Comparison::Less | Comparison::LessEqual if lo > 0.0 => Some(true),
            Comparison::Less | Comparison::LessEqual if hi < 0.0 => Some(false),
            Comparison::Equal if lo > 0.0 || hi < 0.0 => Some(false),
            Comparison::Less | Comparison::LessEqual | Comparison::Equal => None,
        }
    }

    /// Returns whether nothing was computed.
    pub(super) fn is_leaf(self) -> bool {
        self.count == 0
    }

    /// The sum of all rounding errors, and those of this computation, which are far smaller.
    fn off(self) -> f64 {
        let count = f64::from(self.count);
        let share = count * UNIT;
        self.size * (share / (1.0 - share.min(0.5)) + count * f64::EPSILON)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(value: f32) -> Free {
        Free::leaf(Interval::exactly(value))
    }

    #[test]
    fn any_order_is_contained() {
        let (a, b, c) = (1.0e8_f32, 3.1_f32, -1.0e8_f32);
        let sum = of(a).add(of(b)).add(of(c)).interval().expect("two operations");
        for value in [(a + b) + c, a + (b + c), (a + c) + b, b] {
            assert!(sum.contains(value), "{value} in {sum:?}");
        }
        assert!(!sum.contains(100.0));
        let (a, b, t) = (0.7_f32, 1.0e6_f32, 0.999_999_9_f32);
        let mixed = Free::mix(of(a), of(b), of(t)).interval().expect("several operations");
        for value in [a * (1.0 - t) + b * t, a + t * (b - a), t.mul_add(b - a, a), t.mul_add(b, a * (1.0 - t))] {
            assert!(mixed.contains(value), "{value} in {mixed:?}");
        }
        // A single operation has one order.
        assert_eq!((of(a).add(of(b)).interval(), of(a).is_leaf()), (None, true));
        assert_eq!(of(a).over(Interval::constant(0.0)).add(of(b)).add(of(c)).interval(), Some(Interval::ANY));
    }

    #[test]
    fn comparisons_are_open_where_an_order_decides() {
        let (a, b, c) = (of(1.0), of(1.0e8), of(-1.0e8));
        assert_eq!(a.compare(Comparison::Less, b.add(c)), None);
        assert_eq!(a.compare(Comparison::Less, b.add(of(1.0))), Some(true));
        assert_eq!(b.add(c).compare(Comparison::LessEqual, of(-100.0)), Some(false));
        assert_eq!(b.add(c).compare(Comparison::Equal, of(-100.0)), Some(false));
        assert_eq!(b.add(c).compare(Comparison::Equal, of(0.0)), None);
    }
}
