//! Arithmetic that the table of operators names but no library has.
//!
//! `min` and `max` are spelled out because the standard library leaves open
//! which zero they return of two, and it differs between machines and between
//! scalar and vector code. Here it is the first operand.

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

/// The quotient of whole numbers without its fraction; by zero, the dividend, as in WGSL.
#[inline]
pub(super) fn whole_quotient(a: f64, b: f64) -> f64 {
    if b == 0.0 { a } else { (a / b).trunc() }
}

/// The rest that the quotient of whole numbers leaves, with the sign of the dividend; by zero, nothing.
#[inline]
pub(super) fn whole_remainder(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a % b }
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
