//! A polygonal light as a shading point sees it.

use glam::DVec3;

use super::clip::Clipper;
use super::scalar::{Scalar, Vector, area, cross, dot, length, middle, rounded};
use super::tabulated::{Tabulated, lists};
use super::viewpoint::Viewpoint;
use crate::diag::Failure;
use crate::technique::tables::HORIZON_CLIP;

/// A convex polygon, relative to a point that it is seen from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Panel<T> {
    /// Its corners, counter-clockwise as seen from the point.
    pub(super) corners: Vec<Vector<T>>,
    /// Normal towards the point, as long as its area is large.
    pub(super) normal: Vector<T>,
    /// True if the point lies on the side of its plane from which its corners, as given, go counter-clockwise.
    pub(super) in_front: bool,
}

impl<T: Scalar> Panel<T> {
    /// A polygon as seen from a point; `None` if it has no area, or the point lies in its plane.
    pub(super) fn new(corners: &[DVec3], from: &Viewpoint) -> Option<Self> {
        let seen: Vec<Vector<f64>> = corners.iter().map(|corner| from.see(*corner)).collect();
        let (normal, reach) = (area(&seen), seen.iter().map(|corner| length(*corner)).fold(0.0, f64::max));
        let height = dot(normal, middle(&seen));
        // In the plane of the light, by the definition of the specification, in every precision.
        if length(normal) == 0.0 || height.abs() <= 1e-7 * length(normal) * reach {
            return None;
        }
        let in_front = height < 0.0;
        let mut corners: Vec<Vector<T>> = seen.into_iter().map(rounded).collect();
        if !in_front {
            corners.reverse();
        }
        let normal = area(&corners);
        Some(Self { corners, normal, in_front })
    }

    /// The heights of points above its plane, on the side of the point that it is seen from.
    pub(super) fn heights(&self, points: &[Vector<T>]) -> Vec<T> {
        let level = self.level();
        points.iter().map(|at| dot(self.normal, *at) - level).collect()
    }

    /// The product of its normal with any point of its plane; negative.
    pub(super) fn level(&self) -> T {
        dot(self.normal, middle(&self.corners))
    }

    /// The height below which a point is taken to lie in its plane.
    pub(super) fn slack(&self, points: &[Vector<T>]) -> T {
        let reach = points.iter().chain(&self.corners).map(|at| length(*at)).fold(0.0, f64::max);
        T::from_f64(T::NOISE * length(self.normal) * reach)
    }

    /// The inward normals of the planes through the point and its edges.
    pub(super) fn sides(&self) -> impl Iterator<Item = Vector<T>> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(from, to)| cross(*to, *from))
    }

    /// The share of its area that a part of it has; negative if the part goes the other way round.
    pub(super) fn share(&self, part: &[Vector<T>]) -> f64 {
        let wide = |vector: Vector<T>| vector.map(T::to_f64);
        let normal = wide(self.normal);
        dot(wide(area(part)), normal) / dot(normal, normal)
    }

    /// Returns whether it is so small for its distance that a sum over its edges cancels.
    pub(super) fn is_far(&self) -> bool {
        let centre = middle(&self.corners);
        let extent = self.corners.iter().map(|at| length(super::scalar::minus(*at, centre))).fold(0.0, f64::max);
        T::CANCELS && extent < 1e-2 * length(centre)
    }
}

/// Clips lights against the horizon.
#[derive(Debug, Clone)]
pub(super) struct Horizon {
    /// The bits of the corners above, the first one highest → the loops of `horizon_clip`.
    quads: Vec<Vec<Vec<usize>>>,
}

impl Horizon {
    /// A horizon by the table that comes with Umbrage.
    ///
    /// # Errors
    /// Never for that table, which is tested.
    pub(super) fn new() -> Result<Self, Failure> {
        let table = Tabulated::new(&HORIZON_CLIP, &["above_0", "above_1", "above_2", "above_3"])?;
        let state = |bits: usize| {
            let levels: Vec<usize> = (0..4).map(|corner| bits >> (3 - corner) & 1).collect();
            lists(table.at(&levels), 2)
        };
        Ok(Self { quads: (0..16).map(state).collect() })
    }

    /// The part of a light above the horizon of a point with a normal. Of a flat convex polygon it is one loop.
    pub(super) fn above<T: Scalar>(
        &self,
        clipper: &Clipper,
        corners: &[Vector<T>],
        normal: Vector<T>,
    ) -> Vec<Vector<T>> {
        let heights: Vec<T> = corners.iter().map(|corner| dot(normal, *corner)).collect();
        let [a, b, c, d] = *corners else { return clipper.inside(corners, &heights) };
        let bits = heights.iter().fold(0, |bits, height| 2 * bits + usize::from(*height > T::from_f64(0.0)));
        let Some(points) = self.quads[bits].first() else { return Vec::new() };
        let quad = [a, b, c, d];
        let at = |point: &usize| match point {
            0..4 => quad[*point],
            crossing => {
                let (from, to) = (crossing - 4, (crossing - 3) % 4);
                super::clip::crossing((quad[from], heights[from]), (quad[to], heights[to]))
            }
        };
        points.iter().map(at).collect()
    }
}
