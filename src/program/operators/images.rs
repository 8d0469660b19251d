//! Images of intervals of real numbers under the operators: exact results only, so that a square root at 0 is 0.

use std::f64::consts::PI;

/// An interval, both ends included.
pub type Bounds = (f64, f64);

/// An image, and if there may be no finite result, why: as the end of a sentence.
pub type Bounded = (Bounds, Option<&'static str>);

/// Everything: what is left once an operation failed.
pub const ANY: Bounds = (f64::NEG_INFINITY, f64::INFINITY);

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
        /// The nature of an operand there, as the end of a sentence.
        what: &'static str,
    },
    /// The distance from the whole number below.
    Sawtooth,
    /// A word, which never decreases or never increases as long as operands are words.
    Words,
}

impl Image {
    /// The image of an interval under a function with this course.
    pub(super) fn of(self, of: fn(f64) -> f64, (lo, hi): Bounds) -> Bounded {
        match self {
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
            Image::Words if are_words((lo, hi)) => ((of(lo).min(of(hi)), of(lo).max(of(hi))), None),
            Image::Words => (WORDS, None),
        }
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

fn are_whole((lo, hi): Bounds) -> bool {
    lo.fract() == 0.0 && hi.fract() == 0.0
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

/// Whole numbers are 1 apart at least, so a quotient is no larger than the dividend; by zero it is the dividend.
pub(super) fn whole_quotient(a: Bounds, b: Bounds) -> Bounded {
    if has_zero(b) {
        let most = a.0.abs().max(a.1.abs());
        return (if are_whole(b) { (-most, most) } else { ANY }, None);
    }
    let (bounds, what) = hull([a.0 / b.0, a.0 / b.1, a.1 / b.0, a.1 / b.1]);
    ((bounds.0.trunc(), bounds.1.trunc()), what)
}

pub(super) fn whole_remainder(a: Bounds, b: Bounds) -> Bounded {
    let below = if are_whole(a) && are_whole(b) { 1.0 } else { 0.0 };
    let most = a.0.abs().max(a.1.abs()).min((b.0.abs().max(b.1.abs()) - below).max(0.0));
    ((if a.0 < 0.0 { -most } else { 0.0 }, if a.1 > 0.0 { most } else { 0.0 }), None)
}

/// All words.
const WORDS: Bounds = (0.0, u32::MAX as f64);

/// Returns whether bounds are words, between which nothing wraps.
fn are_words(bounds: Bounds) -> bool {
    bounds.0 >= 0.0 && bounds.1 <= WORDS.1 && are_whole(bounds)
}

/// The image of words under an operation that wraps, given that of numbers.
fn wrapped(a: Bounds, b: Bounds, image: Bounds) -> Bounded {
    (if are_words(a) && are_words(b) && are_words(image) { image } else { WORDS }, None)
}

/// The image of single words under an operation on bits, or else what `other` says of words.
fn on_bits(a: Bounds, b: Bounds, of: fn(u32, u32) -> u32, other: impl Fn() -> Bounds) -> Bounded {
    if !(are_words(a) && are_words(b)) {
        return (WORDS, None);
    }
    let single = a.0 == a.1 && b.0 == b.1;
    let word = f64::from(of(a.0 as u32, b.0 as u32));
    (if single { (word, word) } else { other() }, None)
}

/// The word of ones that covers another.
fn ones(most: f64) -> f64 {
    f64::from(u32::MAX.checked_shr((most as u32).leading_zeros()).unwrap_or(0))
}

pub(super) fn word_sum(a: Bounds, b: Bounds) -> Bounded {
    if a.0 == a.1 && b.0 == b.1 {
        return on_bits(a, b, u32::wrapping_add, || WORDS);
    }
    wrapped(a, b, (a.0 + b.0, a.1 + b.1))
}

pub(super) fn word_difference(a: Bounds, b: Bounds) -> Bounded {
    if a.0 == a.1 && b.0 == b.1 {
        return on_bits(a, b, u32::wrapping_sub, || WORDS);
    }
    wrapped(a, b, (a.0 - b.1, a.1 - b.0))
}

pub(super) fn word_product(a: Bounds, b: Bounds) -> Bounded {
    if a.0 == a.1 && b.0 == b.1 {
        return on_bits(a, b, u32::wrapping_mul, || WORDS);
    }
    wrapped(a, b, (a.0 * b.0, a.1 * b.1))
}

/// No larger than the dividend, which it is by zero.
pub(super) fn word_quotient(a: Bounds, b: Bounds) -> Bounded {
    match b.0 > 0.0 {
        true => wrapped(a, b, ((a.0 / b.1).floor(), (a.1 / b.0).floor())),
        false => on_bits(a, b, super::words::quotient, || (0.0, a.1)),
    }
}

pub(super) fn word_remainder(a: Bounds, b: Bounds) -> Bounded {
    match a.1 < b.0 {
        true => wrapped(a, b, a),
        false => on_bits(a, b, super::words::remainder, || (0.0, a.1.min((b.1 - 1.0).max(0.0)))),
    }
}

pub(super) fn word_and(a: Bounds, b: Bounds) -> Bounded {
    on_bits(a, b, |a, b| a & b, || (0.0, a.1.min(b.1)))
}

pub(super) fn word_or(a: Bounds, b: Bounds) -> Bounded {
    on_bits(a, b, |a, b| a | b, || (a.0.max(b.0), ones(a.1.max(b.1))))
}

pub(super) fn word_xor(a: Bounds, b: Bounds) -> Bounded {
    on_bits(a, b, |a, b| a ^ b, || (0.0, ones(a.1.max(b.1))))
}

/// Of more than 31 places, nothing is known here.
pub(super) fn shift_left(a: Bounds, b: Bounds) -> Bounded {
    if b.0 == b.1 && a.0 == a.1 {
        return on_bits(a, b, u32::wrapping_shl, || WORDS);
    }
    match b.1 < 32.0 {
        true => wrapped(a, b, (a.0 * b.0.exp2(), a.1 * b.1.exp2())),
        false => (WORDS, None),
    }
}

pub(super) fn shift_right(a: Bounds, b: Bounds) -> Bounded {
    match b.1 < 32.0 {
        true => wrapped(a, b, ((a.0 / b.1.exp2()).floor(), (a.1 / b.0.exp2()).floor())),
        false => on_bits(a, b, u32::wrapping_shr, || (0.0, a.1)),
    }
}

pub(super) fn word_minimum(a: Bounds, b: Bounds) -> Bounded {
    wrapped(a, b, (a.0.min(b.0), a.1.min(b.1)))
}

pub(super) fn word_maximum(a: Bounds, b: Bounds) -> Bounded {
    wrapped(a, b, (a.0.max(b.0), a.1.max(b.1)))
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
