//! Images of intervals of real numbers under the operators: exact results only, so that a square root at 0 is 0.

use std::f64::consts::PI;

use super::{BinaryOp, Image, TernaryOp, UnaryOp};

/// An interval, both ends included.
pub type Bounds = (f64, f64);

/// An image, and if there may be no finite result, why: as the end of a sentence.
pub type Bounded = (Bounds, Option<&'static str>);

/// Everything: what is left once an operation failed.
pub const ANY: Bounds = (f64::NEG_INFINITY, f64::INFINITY);

impl UnaryOp {
    /// The image of an interval.
    pub fn image(self, (lo, hi): Bounds) -> Bounded {
        // What failed inside has been reported already.
        if lo == f64::NEG_INFINITY || hi == f64::INFINITY {
            return (ANY, None);
        }
        let row = self.row();
        if let Some(operands) = row.operands.filter(|operands| !operands.contain(lo, hi)) {
            return (ANY, Some(operands.outside));
        }
        let of = row.wide;
        match row.image {
            Image::Increasing | Image::Steps => finite(of(lo), of(hi)),
            Image::Decreasing => finite(of(hi), of(lo)),
            Image::Valley => {
                let least = if lo <= 0.0 && hi >= 0.0 { 0.0 } else { lo.abs().min(hi.abs()) };
                finite(of(least), of(lo.abs().max(hi.abs())))
            }
            Image::Wave { peak } => (wave(lo, hi, of, peak), None),
            Image::Poles { pole, what } => {
                let turns = |x: f64| ((x - pole) / PI).floor();
                if turns(lo) == turns(hi) { finite(of(lo), of(hi)) } else { (ANY, Some(what)) }
            }
            Image::Sawtooth if lo.floor() == hi.floor() => ((of(lo), of(hi)), None),
            Image::Sawtooth => ((0.0, 1.0), None),
        }
    }
}

impl BinaryOp {
    /// The image of two intervals.
    pub fn image(self, a: Bounds, b: Bounds) -> Bounded {
        // What failed inside has been reported already.
        if a == ANY || b == ANY { (ANY, None) } else { (self.row().image)(a, b) }
    }
}

impl TernaryOp {
    /// The image of three intervals.
    pub fn image(self, a: Bounds, b: Bounds, c: Bounds) -> Bounded {
        (self.row().image)(a, b, c)
    }
}

/// An image, unless it is more than an `f32` can hold.
fn finite(lo: f64, hi: f64) -> Bounded {
    let largest = f64::from(f32::MAX);
    let what = (lo < -largest || hi > largest).then_some("can be larger than any f32");
    ((lo, hi), what)
}

fn wave(lo: f64, hi: f64, f: fn(f64) -> f64, peak: f64) -> Bounds {
    let has = |place: f64| ((hi - place) / (2.0 * PI)).floor() >= ((lo - place) / (2.0 * PI)).ceil();
    let (a, b) = (f(lo), f(hi));
    (if has(peak + PI) { -1.0 } else { a.min(b) }, if has(peak) { 1.0 } else { a.max(b) })
}

fn hull(corners: [f64; 4]) -> Bounded {
    let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
    finite(lo, corners.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

fn has_zero((lo, hi): Bounds) -> bool {
    lo <= 0.0 && hi >= 0.0
}

pub(super) fn sum(a: Bounds, b: Bounds) -> Bounded {
    finite(a.0 + b.0, a.1 + b.1)
}

pub(super) fn difference(a: Bounds, b: Bounds) -> Bounded {
    finite(a.0 - b.1, a.1 - b.0)
}

pub(super) fn product(a: Bounds, b: Bounds) -> Bounded {
    hull([a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1])
}

const DIVIDES_BY_ZERO: Bounded = (ANY, Some("can be a division by zero"));

pub(super) fn quotient(a: Bounds, b: Bounds) -> Bounded {
    if has_zero(b) { DIVIDES_BY_ZERO } else { hull([a.0 / b.0, a.0 / b.1, a.1 / b.0, a.1 / b.1]) }
}

pub(super) fn remainder(a: Bounds, b: Bounds) -> Bounded {
    if has_zero(b) {
        return DIVIDES_BY_ZERO;
    }
    let most = a.0.abs().max(a.1.abs()).min(b.0.abs().max(b.1.abs()));
    ((if a.0 < 0.0 { -most } else { 0.0 }, if a.1 > 0.0 { most } else { 0.0 }), None)
}

pub(super) fn minimum(a: Bounds, b: Bounds) -> Bounded {
    ((a.0.min(b.0), a.1.min(b.1)), None)
}

pub(super) fn maximum(a: Bounds, b: Bounds) -> Bounded {
    ((a.0.max(b.0), a.1.max(b.1)), None)
}

pub(super) fn step(edge: Bounds, a: Bounds) -> Bounded {
    let image = match (edge.1 <= a.0, edge.0 > a.1) {
        (true, _) => (1.0, 1.0),
        (_, true) => (0.0, 0.0),
        _ => (0.0, 1.0),
    };
    (image, None)
}

pub(super) fn angle(a: Bounds, b: Bounds) -> Bounded {
    match (has_zero(a), has_zero(b)) {
        (true, true) => (ANY, Some("can be the angle of the origin")),
        (true, false) if b.0 <= 0.0 => ((-PI, PI), None),
        _ => hull([libm::atan2(a.0, b.0), libm::atan2(a.0, b.1), libm::atan2(a.1, b.0), libm::atan2(a.1, b.1)]),
    }
}

pub(super) fn power(a: Bounds, b: Bounds) -> Bounded {
    if a.0 < 0.0 {
        (ANY, Some("can be a power of a negative number"))
    } else if a.0 == 0.0 && b.0 <= 0.0 {
        (ANY, Some("can be zero to a power that is not positive"))
    } else {
        hull([libm::pow(a.0, b.0), libm::pow(a.0, b.1), libm::pow(a.1, b.0), libm::pow(a.1, b.1)])
    }
}

pub(super) fn clamp(a: Bounds, b: Bounds, c: Bounds) -> Bounded {
    if b == ANY || c == ANY {
        return (ANY, None);
    }
    // The bounds hold whatever becomes of the operand between them.
    if a == ANY {
        return ((b.0.min(c.0), c.1), None);
    }
    ((a.0.max(b.0).min(c.0), a.1.max(b.1).min(c.1)), None)
}

pub(super) fn product_and_sum(a: Bounds, b: Bounds, c: Bounds) -> Bounded {
    if [a, b, c].contains(&ANY) {
        return (ANY, None);
    }
    let (product, what) = product(a, b);
    if what.is_some() { (ANY, what) } else { sum(product, c) }
}

/// Between the two for shares from 0 to 1, and linear in each operand anyway.
pub(super) fn mix(a: Bounds, b: Bounds, c: Bounds) -> Bounded {
    if [a, b, c].contains(&ANY) {
        return (ANY, None);
    }
    let mix = |a: f64, b: f64, c: f64| a * (1.0 - c) + b * c;
    let ends = [c.0, c.1];
    let low = ends.map(|c| mix(if c <= 1.0 { a.0 } else { a.1 }, if c >= 0.0 { b.0 } else { b.1 }, c));
    let high = ends.map(|c| mix(if c <= 1.0 { a.1 } else { a.0 }, if c >= 0.0 { b.1 } else { b.0 }, c));
    finite(low[0].min(low[1]), high[0].max(high[1]))
}

pub(super) fn smoothstep(lo: Bounds, hi: Bounds, a: Bounds) -> Bounded {
    if [lo, hi, a].contains(&ANY) {
        return (ANY, None);
    }
    if lo.1 >= hi.0 {
        return (ANY, Some("can have a first bound that is not below the second"));
    }
    ((0.0, 1.0), None)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// An operand: an interval, and points of it.
    fn operand() -> impl Strategy<Value = (Bounds, Vec<f64>)> {
        let start =
            prop_oneof![6 => -4.0_f64..4.0, 2 => -100.0_f64..100.0, 1 => Just(0.0), 1 => Just(1.0), 1 => -1e6_f64..1e6];
        let width = prop_oneof![1 => Just(0.0), 3 => 0.0_f64..1.0, 3 => 0.0_f64..10.0, 1 => 0.0_f64..1000.0];
        (start, width, prop::collection::vec(0.0_f64..=1.0, 6)).prop_map(|(lo, width, shares)| {
            let hi = lo + width;
            let points = shares.into_iter().map(|share| (lo + share * width).clamp(lo, hi));
            ((lo, hi), points.chain([lo, hi]).collect())
        })
    }

    /// Fails if a value at a point is outside of an image that is said to be one.
    fn contains(image: Bounded, value: f64, what: impl Fn() -> String) -> Result<(), TestCaseError> {
        let ((lo, hi), trouble) = image;
        // Of the portable library no function is known to be monotone to the last digit.
        let slack = 1e-12 * value.abs().max(1.0);
        let inside = lo - slack <= value && value <= hi + slack;
        prop_assert!(trouble.is_some() || inside, "{}: {value} is not in {lo} to {hi}", what());
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

        /// The image of an interval contains the value at every point of it, for every operator, or trouble is reported.
        #[test]
        fn images_contain_the_values((x, xs) in operand(), (y, ys) in operand(), (z, zs) in operand()) {
            for op in UnaryOp::ALL.iter().copied() {
                let image = op.image(x);
                for a in &xs {
                    contains(image, op.apply(*a), || format!("{op:?} of {a} in {x:?}"))?;
                }
            }
            for op in BinaryOp::ALL.iter().copied() {
                let image = op.image(x, y);
                for (a, b) in xs.iter().flat_map(|a| ys.iter().map(move |b| (*a, *b))) {
                    contains(image, op.apply(a, b), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}"))?;
                }
            }
            for op in TernaryOp::ALL.iter().copied() {
                let image = op.image(x, y, z);
                for (a, (b, c)) in xs.iter().flat_map(|a| ys.iter().zip(&zs).map(move |rest| (*a, rest))) {
                    contains(image, op.apply(a, *b, *c), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}, {c} in {z:?}"))?;
                }
            }
        }
    }
}
