//! Arithmetic of words, the unsigned integers of 32 bits.
//!
//! `f64` has every word as a number. An `f32` has not, so it carries a word by its bits, as a
//! buffer does; whatever calculates with it knows from the form of an expression that it is one.

/// The word that a whole number is, modulo 2^32.
#[inline]
pub(super) fn of(number: f64) -> u32 {
    // Exact: a number that is no word is a whole one within 2^24 of zero.
    number as i64 as u32
}

/// The largest `f32` that is below 2^32.
const LARGEST: f64 = 4_294_967_040.0;

/// The whole part of a number from 0 to [`LARGEST`]; of others, that of the nearest one, and 0 of what is none.
#[inline]
pub(super) fn of_number(number: f64) -> u32 {
    // What is no number stays none, and becomes 0.
    number.clamp(0.0, LARGEST) as u32
}

/// A word as a number.
#[inline]
pub(super) fn wide(word: u32) -> f64 {
    f64::from(word)
}

/// The quotient without its fraction; by zero, the dividend, as in WGSL.
#[inline]
pub(super) fn quotient(a: u32, b: u32) -> u32 {
    a.checked_div(b).unwrap_or(a)
}

/// The rest of that quotient; by zero, nothing.
#[inline]
pub(super) fn remainder(a: u32, b: u32) -> u32 {
    a.checked_rem(b).unwrap_or(0)
}

/// The meanings, in `f64` and in `f32`, of an operation on two words.
macro_rules! both {
    ($operation:expr) => {{
        fn wide(a: f64, b: f64) -> f64 {
            let operation: fn(u32, u32) -> u32 = $operation;
            f64::from(operation($crate::program::operators::words::of(a), $crate::program::operators::words::of(b)))
        }
        fn narrow(a: f32, b: f32) -> f32 {
            let operation: fn(u32, u32) -> u32 = $operation;
            f32::from_bits(operation(a.to_bits(), b.to_bits()))
        }
        (wide as fn(f64, f64) -> f64, narrow as fn(f32, f32) -> f32)
    }};
}
pub(super) use both;

#[cfg(test)]
mod tests {
    use crate::program::{BinaryOp, Real, UnaryOp};

    /// The image of an interval of words has the result for every word of it.
    #[test]
    fn images_contain_the_results() {
        let ends = [0, 1, 2, 7, 8, 15, 16, 31, 32, 1000, 0xffff, 0x0001_0000, 0x7fff_ffff, 0x8000_0000, u32::MAX];
        let all = ends.iter().flat_map(|lo| ends.iter().map(move |hi| (*lo, *hi))).filter(|(lo, hi)| lo <= hi);
        let all: Vec<(u32, u32)> = all.collect();
        let inside = |(lo, hi): (u32, u32)| [lo, lo + (hi - lo) / 3, hi - (hi - lo) / 2, hi];
        let bounds = |(lo, hi): (u32, u32)| (f64::from(lo), f64::from(hi));
        for op in BinaryOp::ALL.iter().copied().filter(|op| op.row().is_on_words) {
            for (x, y) in all.iter().flat_map(|x| all.iter().map(move |y| (*x, *y))) {
                let ((lo, hi), fails) = op.image(bounds(x), bounds(y));
                assert_eq!(fails, None);
                for (a, b) in inside(x).into_iter().flat_map(|a| inside(y).map(|b| (a, b))) {
                    let value = op.apply(f64::from(a), f64::from(b));
                    assert!(
                        (lo..=hi).contains(&value),
                        "{op:?} of {a} in {x:?}, {b} in {y:?}: {value}, not {lo} to {hi}"
                    );
                }
                if x.0 == x.1 && y.0 == y.1 {
                    assert_eq!(lo, hi, "{op:?} of {x:?} and {y:?}");
                }
            }
        }
        for x in all {
            let (lo, hi) = UnaryOp::WordNot.image(bounds(x)).0;
            assert!(inside(x).iter().all(|a| (lo..=hi).contains(&f64::from(!a))), "{x:?}");
        }
    }

    /// Words in `f64`, as numbers, and in `f32`, as bits, are the same words, those that are no numbers in `f32` among them.
    #[test]
    fn both_types_carry_the_same_words() {
        let words = [0, 1, 2, 31, 0x7f80_0000, 0x7f80_0001, 0x7fff_ffff, 0x8000_0000, 0xff80_0001, u32::MAX];
        for op in BinaryOp::ALL.iter().copied().filter(|op| op.row().is_on_words) {
            for (a, b) in words.iter().flat_map(|a| words.iter().map(move |b| (*a, *b))) {
                let wide = f64::binary(op, f64::from_word(a), f64::from_word(b)).to_word();
                let narrow = f32::binary(op, f32::from_word(a), f32::from_word(b)).to_word();
                assert_eq!(wide, narrow, "{op:?} of {a} and {b}");
            }
        }
        for word in words {
            assert_eq!(f64::unary(UnaryOp::WordNot, f64::from_word(word)).to_word(), !word);
            assert_eq!(f32::unary(UnaryOp::WordNot, f32::from_word(word)).to_word(), !word);
            assert_eq!(f64::unary(UnaryOp::NumberOfWord, f64::from_word(word)), f64::from(word));
            assert_eq!(f32::unary(UnaryOp::NumberOfWord, f32::from_word(word)), word as f32);
        }
        assert_eq!(f32::unary(UnaryOp::WordOfWhole, -1.0).to_word(), u32::MAX);
        assert_eq!(f32::unary(UnaryOp::WordOfNumber, -1.0).to_word(), 0);
        assert_eq!(f32::unary(UnaryOp::WordOfNumber, 2.75).to_word(), 2);
        assert_eq!(f64::unary(UnaryOp::WordOfNumber, 1e300), 4_294_967_040.0);
        assert_eq!(f32::unary(UnaryOp::WordOfNumber, f32::NAN).to_word(), 0);
    }
}
