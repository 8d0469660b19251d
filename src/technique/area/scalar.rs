//! Precisions: what is computed in `f64`, as a reference, and in `f32`, as GPUs do, is written once.

use std::ops::Neg;

use num_traits::NumOps;

use crate::program::Real;

/// A precision that the visible part of a light is computed in.
pub trait Scalar: Real + NumOps + Neg<Output = Self> + Send + Sync {
    /// A relative error that rounding may leave in a difference of products of a few coordinates.
    const NOISE: f64;
    /// The function of the table `edge_integral` that is accurate in this precision.
    const TERM: &'static str;
    /// True where a sum over the edges of a light that is small for its distance loses the digits that matter.
    const CANCELS: bool;
}

impl Scalar for f32 {
    const NOISE: f64 = 1e-6;
    const TERM: &'static str = "term";
    const CANCELS: bool = true;
}

impl Scalar for f64 {
    const NOISE: f64 = 1e-14;
    const TERM: &'static str = "term_exact";
    const CANCELS: bool = false;
}

/// Three coordinates.
pub(super) type Vector<T> = [T; 3];

/// A vector rounded to a precision.
pub(super) fn rounded<T: Scalar>(v: Vector<f64>) -> Vector<T> {
    v.map(T::from_f64)
}

/// The difference of two vectors.
pub(super) fn minus<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The sum of two vectors.
pub(super) fn plus<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// A vector in the opposite direction.
pub(super) fn negated<T: Scalar>(a: Vector<T>) -> Vector<T> {
    a.map(T::neg)
}

/// A vector times a number.
pub(super) fn times<T: Scalar>(a: Vector<T>, factor: T) -> Vector<T> {
    a.map(|x| x * factor)
}

/// The scalar product.
pub(super) fn dot<T: Scalar>(a: Vector<T>, b: Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector product.
pub(super) fn cross<T: Scalar>(a: Vector<T>, b: Vector<T>) -> Vector<T> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector area of a closed loop: normal to it, towards the side from which it goes counter-clockwise, and as long
/// as its area is large.
pub(super) fn area<T: Scalar>(corners: &[Vector<T>]) -> Vector<T> {
    let none = [T::from_f64(0.0); 3];
    let Some((first, rest)) = corners.split_first() else { return none };
    let sides = rest.windows(2).map(|pair| cross(minus(pair[0], *first), minus(pair[1], *first)));
    times(sides.fold(none, plus), T::from_f64(0.5))
}

/// The mean of the corners of a loop.
pub(super) fn middle<T: Scalar>(corners: &[Vector<T>]) -> Vector<T> {
    let sum = corners.iter().copied().fold([T::from_f64(0.0); 3], plus);
    times(sum, T::from_f64(1.0 / corners.len().max(1) as f64))
}

/// The length of a vector.
pub(super) fn length<T: Scalar>(a: Vector<T>) -> f64 {
    let a = a.map(T::to_f64);
    (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt()
}
