//! Intervals of the `f32` results that WGSL's accuracy rules admit.
//!
//! An [`Interval`] has `f32` endpoints, kept as `f64` so that the exact image of
//! an operation can be bounded before it is rounded outward. Every operation
//! contains the exact result for every choice of operands, so composed
//! operations contain each way of computing them that rounds less often, such
//! as a fused multiply-add.
//!
//! - *Correctly rounded* fixes no direction: a result between two `f32`
//!   admits both, a representable one only itself.
//! - Errors in ULP are of the exact result, in the wider sense where
//!   subnormals do not exist, since they may be flushed.
//! - Wherever a subnormal is admitted, so is zero; the sign of zero is ignored.
//! - Overflow, and operands outside the range for which an accuracy is stated,
//!   admit anything: [`Interval::ANY`], which includes infinities and NaN.

use std::f64::consts::PI;

use crate::program::{BinaryOp, Comparison, TernaryOp, UnaryOp};

/// A closed interval of admissible `f32` values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    lo: f64,
    hi: f64,
}

/// Smallest normal `f32`.
const NORMAL: f64 = f32::MIN_POSITIVE as f64;

/// The magnitudes for which the accuracy of a quotient is stated: 2^±126.
const DIVISOR: (f64, f64) = (NORMAL, 1.0 / NORMAL);

/// The error that a result may have.
#[derive(Debug, Clone, Copy)]
enum Error {
    Absolute(f64),
    Ulp(f64),
}

impl Interval {
    /// Any value at all, also infinite or NaN.
    pub const ANY: Self = Self { lo: f64::NEG_INFINITY, hi: f64::INFINITY };

    /// Exactly this value.
    pub fn exactly(value: f32) -> Self {
        Self::around(f64::from(value), f64::from(value))
    }

    /// A constant of the table; where no `f32` equals it, both its neighbours.
    pub fn constant(value: f64) -> Self {
        Self::around(value, value)
    }

    /// Exactly this number, a word or another whole one.
    pub fn word(word: f64) -> Self {
        Self { lo: word, hi: word }
    }

    /// Any value from `slack` below this one to `slack` above.
    pub fn near(value: f32, slack: f64) -> Self {
        Self::around(f64::from(value) - slack, f64::from(value) + slack)
    }

    /// The smallest admissible value.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// The largest admissible value.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// Returns whether anything is admissible.
    pub fn is_any(self) -> bool {
        self.lo == f64::NEG_INFINITY
    }

    /// Returns whether `value` is admissible.
    pub fn contains(self, value: f32) -> bool {
        self.is_any() || (self.lo..=self.hi).contains(&f64::from(value))
    }

    /// Returns whether all of `other` is admissible.
    pub fn covers(self, other: Self) -> bool {
        self.is_any() || (self.lo <= other.lo && other.hi <= self.hi)
    }

    /// All that `f32` has between two numbers, and the nearest below and above.
    pub(super) fn between(lo: f64, hi: f64) -> Self {
        Self::around(lo, hi)
    }

    /// The smallest interval with both.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Bounds of an exact image, rounded outward; with zero if a subnormal is among them.
    fn around(lo: f64, hi: f64) -> Self {
        let (mut lo, mut hi) = (floor_f32(lo), ceil_f32(hi));
        // Written so that NaN ends here too.
        if !(lo >= f64::from(f32::MIN) && hi <= f64::from(f32::MAX)) {
            return Self::ANY;
        }
        if lo > 0.0 && lo < NORMAL {
            lo = 0.0;
        }
        if hi < 0.0 && hi > -NORMAL {
            hi = 0.0;
        }
        Self { lo, hi }
    }

    /// The image of a function that does not decrease and is exact in `f64`.
    fn steps(self, f: impl Fn(f64) -> f64) -> Self {
        if self.is_any() { self } else { Self::around(f(self.lo), f(self.hi)) }
    }

    /// The image of a function that does not decrease and that the portable library computes.
    fn grows(self, f: impl Fn(f64) -> f64, error: Error) -> Self {
        if self.is_any() { self } else { Self::computed(f(self.lo), f(self.hi), error) }
    }

    /// Bounds of an exact image as the portable library computes them, widened by the error of each value in it.
    fn computed(lo: f64, hi: f64, error: Error) -> Self {
        let largest = lo.abs().max(hi.abs());
        let reach = |value: f64| match error {
            Error::Absolute(error) => error,
            Error::Ulp(count) => {
                // Just above a power of two the error doubles, so values inside can reach further than this end.
                let inside = value.abs() + count * ulp(value);
                count * ulp(inside.min(largest))
            }
        };
        Self::around(below(lo) - reach(lo), above(hi) + reach(hi))
    }

    /// Returns whether all values are between the bounds.
    fn within(self, lo: f64, hi: f64) -> bool {
        lo <= self.lo && self.hi <= hi
    }

    /// Returns whether all magnitudes are between the bounds.
    fn magnitude_within(self, (lo, hi): (f64, f64)) -> bool {
        self.within(lo, hi) || self.within(-hi, -lo)
    }

    /// An operation on one number.
    #[must_use]
    pub fn unary(op: UnaryOp, a: Self) -> Self {
        use UnaryOp as Op;
        let one = Self::constant(1.0);
        match op {
            _ if a.is_any() => Self::ANY,
            Op::Negate => Self { lo: -a.hi, hi: -a.lo },
            Op::Abs if a.lo >= 0.0 => a,
            Op::Abs if a.hi <= 0.0 => a.negate(),
            Op::Abs => Self { lo: 0.0, hi: a.hi.max(-a.lo) },
            Op::Ceil => a.steps(f64::ceil),
            Op::Floor => a.steps(f64::floor),
            Op::Round => a.steps(f64::round_ties_even),
            Op::Trunc => a.steps(f64::trunc),
            // Monotonous, and a word is any number of 32 bits.
            Op::WordOfNumber => Self { lo: op.apply(a.lo), hi: op.apply(a.hi) },
            Op::WordNot => Self { lo: op.apply(a.hi), hi: op.apply(a.lo) },
            // Whole numbers are always known.
            Op::WordOfWhole if a.lo == a.hi => Self::word(op.apply(a.lo)),
            Op::WordOfWhole => Self::ANY,
            Op::NumberOfWord => Self::around(a.lo, a.hi),
            Op::Sign => a.steps(|a| if a == 0.0 { 0.0 } else { a.signum() }),
            Op::Saturate => a.steps(|a| a.clamp(0.0, 1.0)),
            Op::Fract if a.lo.floor() == a.hi.floor() => a.subtract(Self::constant(a.lo.floor())),
            // Up to 1, which a small negative operand rounds to.
            Op::Fract => Self { lo: 0.0, hi: 1.0 },
            Op::Degrees => a.multiply(Self::constant(180.0 / PI)),
            Op::Radians => a.multiply(Self::constant(PI / 180.0)),
            Op::InverseSqrt if a.lo <= 0.0 => Self::ANY,
            Op::InverseSqrt => a.negate().grows(|a| 1.0 / (-a).sqrt(), Error::Ulp(2.0)),
            Op::Sqrt => one.divide(Self::unary(Op::InverseSqrt, a)),
            Op::Exp => a.grows(libm::exp, a.exponential()),
            Op::Exp2 => a.grows(libm::exp2, a.exponential()),
            Op::Log => a.logarithm(libm::log),
            Op::Log2 => a.logarithm(libm::log2),
            Op::Sin => a.wave(libm::sin, PI / 2.0),
            Op::Cos => a.wave(libm::cos, 0.0),
            Op::PortableSin => a.portable(libm::sin, PI / 2.0),
            Op::PortableCos => a.portable(libm::cos, 0.0),
            Op::Tan => Self::unary(Op::Sin, a).divide(Self::unary(Op::Cos, a)),
            Op::Atan => a.grows(libm::atan, Error::Ulp(4096.0)),
            Op::Acos if !a.within(-1.0, 1.0) => Self::ANY,
            Op::Acos => {
                let absolute = a.negate().grows(|a| libm::acos(-a), Error::Absolute(6.77e-5));
                absolute.hull(Self::binary(BinaryOp::Atan2, a.cosine_to_sine(), a))
            }
            Op::Asin if !a.within(-1.0, 1.0) => Self::ANY,
            Op::Asin => {
                let absolute = a.grows(libm::asin, Error::Absolute(6.81e-5));
                absolute.hull(Self::binary(BinaryOp::Atan2, a, a.cosine_to_sine()))
            }
            Op::Sinh => a.exp().subtract(a.negate().exp()).multiply(Self::constant(0.5)),
            Op::Cosh => a.exp().add(a.negate().exp()).multiply(Self::constant(0.5)),
            Op::Tanh => {
                let absolute = a.grows(libm::tanh, Error::Absolute(1e-5));
                absolute.hull(Self::unary(Op::Sinh, a).divide(Self::unary(Op::Cosh, a)))
            }
            Op::Asinh => Self::unary(Op::Log, a.add(Self::unary(Op::Sqrt, a.multiply(a).add(one)))),
            Op::Acosh if a.lo < 1.0 => Self::ANY,
            Op::Acosh => Self::unary(Op::Log, a.add(Self::unary(Op::Sqrt, a.multiply(a).subtract(one)))),
            Op::Atanh => {
                let quotient = one.add(a).divide(one.subtract(a));
                Self::unary(Op::Log, quotient).multiply(Self::constant(0.5))
            }
        }
    }

    /// An operation on two numbers.
    #[must_use]
    pub fn binary(op: BinaryOp, a: Self, b: Self) -> Self {
        match op {
            _ if a.is_any() || b.is_any() => Self::ANY,
            BinaryOp::Add => a.add(b),
            BinaryOp::Subtract => a.subtract(b),
            BinaryOp::Multiply => a.multiply(b),
            BinaryOp::Divide => a.divide(b),
            BinaryOp::Remainder => a.subtract(b.multiply(Self::unary(UnaryOp::Trunc, a.divide(b)))),
            // Whole numbers are computed as such, and are always known.
            BinaryOp::WholeQuotient | BinaryOp::WholeRemainder if a.lo == a.hi && b.lo == b.hi => {
                Self::constant(op.apply(a.lo, b.lo))
            }
            BinaryOp::WholeQuotient | BinaryOp::WholeRemainder => Self::ANY,
            BinaryOp::WordAdd
            | BinaryOp::WordSubtract
            | BinaryOp::WordMultiply
            | BinaryOp::WordQuotient
            | BinaryOp::WordRemainder
            | BinaryOp::WordAnd
            | BinaryOp::WordOr
            | BinaryOp::WordXor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::WordMax
            | BinaryOp::WordMin => {
                let ((lo, hi), _) = op.image((a.lo, a.hi), (b.lo, b.hi));
                Self { lo, hi }
            }
            BinaryOp::Max => Self { lo: a.lo.max(b.lo), hi: a.hi.max(b.hi) },
            BinaryOp::Min => Self { lo: a.lo.min(b.lo), hi: a.hi.min(b.hi) },
            BinaryOp::Atan2 => a.angle(b),
            BinaryOp::Pow => Self::unary(UnaryOp::Exp2, b.multiply(Self::unary(UnaryOp::Log2, a))),
            BinaryOp::Step => match a.compare(Comparison::LessEqual, b) {
                Some(holds) => Self::constant(f64::from(u8::from(holds))),
                None => Self { lo: 0.0, hi: 1.0 },
            },
        }
    }

    /// An operation on three numbers.
    #[must_use]
    pub fn ternary(op: TernaryOp, a: Self, b: Self, c: Self) -> Self {
        let one = Self::constant(1.0);
        match op {
            _ if a.is_any() || b.is_any() || c.is_any() => Self::ANY,
            TernaryOp::Clamp => {
                // Either definition; both grow with each operand. They differ only if the bounds are exchanged.
                let nested = |a: f64, b: f64, c: f64| a.max(b).min(c);
                let median = |a: f64, b: f64, c: f64| a.min(b).max(a.max(b).min(c));
                let image =
                    |f: &dyn Fn(f64, f64, f64) -> f64| Self { lo: f(a.lo, b.lo, c.lo), hi: f(a.hi, b.hi, c.hi) };
                image(&nested).hull(image(&median))
            }
            TernaryOp::Fma => a.multiply(b).add(c),
            // As WGSL has it, and as drivers have it.
            TernaryOp::Mix => {
                let by_parts = a.multiply(one.subtract(c)).add(b.multiply(c));
                by_parts.hull(a.add(c.multiply(b.subtract(a))))
            }
            TernaryOp::Smoothstep => {
                let t = Self::unary(UnaryOp::Saturate, c.subtract(a).divide(b.subtract(a)));
                let (two, three) = (Self::constant(2.0), Self::constant(3.0));
                t.multiply(t).multiply(three.subtract(two.multiply(t)))
            }
        }
    }

    /// Returns whether the comparison holds for all values or for none; `None` if that depends on which are taken.
    pub fn compare(self, op: Comparison, other: Self) -> Option<bool> {
        if self.is_any() || other.is_any() {
            return None;
        }
        let (always, never) = match op {
            Comparison::Less => (self.hi < other.lo, self.lo >= other.hi),
            Comparison::LessEqual => (self.hi <= other.lo, self.lo > other.hi),
            Comparison::Equal => {
                let one_value = self.lo == self.hi && other.lo == other.hi && self.lo == other.lo;
                (one_value, self.hi < other.lo || other.hi < self.lo)
            }
        };
        (always || never).then_some(always)
    }

    fn negate(self) -> Self {
        Self::unary(UnaryOp::Negate, self)
    }

    fn exp(self) -> Self {
        Self::unary(UnaryOp::Exp, self)
    }

    fn add(self, other: Self) -> Self {
        if self.is_any() || other.is_any() {
            return Self::ANY;
        }
        Self::around(sum(self.lo, other.lo).0, sum(self.hi, other.hi).1)
    }

    fn subtract(self, other: Self) -> Self {
        self.add(other.negate())
    }

    fn multiply(self, other: Self) -> Self {
        if self.is_any() || other.is_any() {
            return Self::ANY;
        }
        // Exact: two `f32` have a product with at most 48 digits.
        let corners = [self.lo * other.lo, self.lo * other.hi, self.hi * other.lo, self.hi * other.hi];
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        Self::around(lo, corners.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    fn divide(self, other: Self) -> Self {
        if self.is_any() || !other.magnitude_within(DIVISOR) {
            return Self::ANY;
        }
        let corners = [self.lo / other.lo, self.lo / other.hi, self.hi / other.lo, self.hi / other.hi];
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self::computed(lo, hi, Error::Ulp(2.5))
    }

    /// 2^-21 absolute on [0.5, 2], else 3 ULP.
    fn logarithm(self, f: fn(f64) -> f64) -> Self {
        if self.is_any() || self.lo <= 0.0 {
            return Self::ANY;
        }
        let relative = self.grows(f, Error::Ulp(3.0));
        let absolute = self.grows(f, Error::Absolute(2_f64.powi(-21)));
        if self.within(0.5, 2.0) {
            absolute
        } else if self.lo > 2.0 || self.hi < 0.5 {
            relative
        } else {
            absolute.hull(relative)
        }
    }

    /// 3 + 2·|x| ULP.
    fn exponential(self) -> Error {
        Error::Ulp(3.0 + 2.0 * self.lo.abs().max(self.hi.abs()))
    }

    /// Sine or cosine: 2^-11 absolute on [-π, π]. `peak` is where the function is 1; it is -1 at `peak` ± π.
    fn wave(self, f: fn(f64) -> f64, peak: f64) -> Self {
        // The ends of the range are the `f32` nearest to ±π.
        let pi = f64::from(std::f32::consts::PI);
        if !self.within(-pi, pi) {
            return Self::ANY;
        }
        let (a, b) = (f(self.lo), f(self.hi));
        let (mut lo, mut hi) = (a.min(b), a.max(b));
        for turn in [-PI, 0.0, PI] {
            if (self.lo..=self.hi).contains(&(peak + turn)) {
                let extreme = if turn == 0.0 { 1.0 } else { -1.0 };
                (lo, hi) = (lo.min(extreme), hi.max(extreme));
            }
        }
        Self::computed(lo, hi, Error::Absolute(2_f64.powi(-11)))
    }

    /// The portable sine or cosine: 3e-7 absolute, and 4 ULP where the argument is not reduced.
    /// `peak` is where the function is 1.
    fn portable(self, f: fn(f64) -> f64, peak: f64) -> Self {
        if !self.within(-8192.0, 8192.0) {
            return Self::ANY;
        }
        let (a, b) = (f(self.lo), f(self.hi));
        let (mut lo, mut hi) = (a.min(b), a.max(b));
        let turns = |value: f64| (value - peak) / PI;
        let (first, last) = (turns(self.lo).ceil(), turns(self.hi).floor());
        for turn in [first, first + 1.0] {
            if turn <= last {
                let extreme = if turn % 2.0 == 0.0 { 1.0 } else { -1.0 };
                (lo, hi) = (lo.min(extreme), hi.max(extreme));
            }
        }
        let reduced = !self.within(-0.78, 0.78) || peak == 0.0;
        Self::computed(lo, hi, if reduced { Error::Absolute(3e-7) } else { Error::Ulp(4.0) })
    }

    /// The angle of the point with abscissa `x` and this ordinate: 4096 ULP away from the axes.
    fn angle(self, x: Self) -> Self {
        if self.is_any() || !x.magnitude_within(DIVISOR) || !self.magnitude_within((NORMAL, f64::MAX)) {
            return Self::ANY;
        }
        // Inside a quadrant the angle has no extremes but at the corners.
        let corners =
            [(self.lo, x.lo), (self.lo, x.hi), (self.hi, x.lo), (self.hi, x.hi)].map(|(y, x)| libm::atan2(y, x));
        let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
        let hi = corners.into_iter().fold(f64::NEG_INFINITY, f64::max);
        Self::computed(lo, hi, Error::Ulp(4096.0))
    }

    /// sqrt(1 - x²)
    fn cosine_to_sine(self) -> Self {
        Self::unary(UnaryOp::Sqrt, Self::constant(1.0).subtract(self.multiply(self)))
    }
}

/// Largest `f32` that is not above.
fn floor_f32(value: f64) -> f64 {
    let near = value as f32;
    f64::from(if f64::from(near) > value { near.next_down() } else { near })
}

/// Smallest `f32` that is not below.
fn ceil_f32(value: f64) -> f64 {
    let near = value as f32;
    f64::from(if f64::from(near) < value { near.next_up() } else { near })
}

/// Below the exact result that the portable library computes as `value`: its functions err by less than 1 ULP.
fn below(value: f64) -> f64 {
    value.next_down().next_down()
}

/// Above the exact result that the portable library computes as `value`.
fn above(value: f64) -> f64 {
    value.next_up().next_up()
}

/// Bounds of the exact sum: equal if `f64` can hold it.
fn sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    // The rounding error, exactly (Knuth's two-sum).
    let b_part = sum - a;
    let error = (a - (sum - b_part)) + (b - b_part);
    if error < 0.0 {
        (sum.next_down(), sum)
    } else if error > 0.0 {
        (sum, sum.next_up())
    } else {
        (sum, sum)
    }
}

/// WGSL's ULP: the smallest distance of two `f32`, subnormals left out, with the value between them.
fn ulp(value: f64) -> f64 {
    let magnitude = value.abs();
    if magnitude.is_nan() || magnitude > f64::from(f32::MAX) {
        return f64::INFINITY;
    }
    if magnitude <= NORMAL {
        return NORMAL;
    }
    let below = floor_f32(magnitude) as f32;
    if f64::from(below) == magnitude {
        // At a power of two the gap below is the smaller one.
        return f64::from(below) - f64::from(below.next_down());
    }
    f64::from(below.next_up()) - f64::from(below)
}
