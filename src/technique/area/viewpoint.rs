//! The point that things are seen from: positions relative to it, in a unit of the light's own size.

use glam::DVec3;

use super::scalar::{Scalar, Vector, rounded};

/// A point, and the unit that lengths are measured in around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Viewpoint {
    place: DVec3,
    /// One over the unit: a power of two, so that nothing is rounded.
    scale: f64,
    /// The distance from the point within which it may truly be.
    blur: f64,
}

impl Viewpoint {
    /// A light whose corners are all nearer than this is no light, whatever its size.
    const NEAREST: f64 = 1e-30;

    /// The point with the unit in which the farthest corner of a light is about 1 away; `None` if it is in the same
    /// place.
    pub(super) fn new(place: DVec3, light: &[DVec3], blur: f64) -> Option<Self> {
        let reach = light.iter().map(|corner| (*corner - place).abs().max_element()).fold(0.0, f64::max);
        let (_, exponent) = libm::frexp(reach);
        (reach > Self::NEAREST).then(|| Self { place, scale: libm::ldexp(1.0, -exponent), blur })
    }

    /// A place as seen from the point: relative to it before it is rounded.
    pub(super) fn see<T: Scalar>(&self, at: DVec3) -> Vector<T> {
        rounded(((at - self.place) * self.scale).to_array())
    }

    /// The height of the point above a plane with a unit normal, by a place in it.
    #[cfg(feature = "gpu")]
    pub(super) fn height(&self, normal: DVec3, at: DVec3) -> f64 {
        normal.dot(self.place - at)
    }

    /// A direction with a length.
    pub(super) fn along<T: Scalar>(&self, vector: DVec3) -> Vector<T> {
        rounded((vector * self.scale).to_array())
    }

    /// The distance from the point within which it may truly be.
    pub(super) fn blur(&self) -> f64 {
        self.length(self.blur)
    }

    /// A length.
    pub(super) fn length(&self, length: f64) -> f64 {
        length * self.scale
    }
}
