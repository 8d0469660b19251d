//! The cone of directions that an occluder hides, as planes through the shading point.

use super::scalar::{Scalar, Vector, cross, dot, length};

/// A convex cone: the directions on the inner side of all of its planes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cone<T> {
    /// Normals of the planes, to the inner side; at least one.
    pub(super) planes: Vec<Vector<T>>,
}

impl<T: Scalar> Cone<T> {
    /// The cone of a loop of corners that go counter-clockwise as seen from the point; `None` if it has no inside.
    pub(super) fn of_loop(corners: &[Vector<T>]) -> Option<Self> {
        let next = corners.iter().cycle().skip(1);
        Self::of_edges(corners.iter().copied().zip(next.copied()))
    }

    /// The cone of a silhouette, as edges in any order, each counter-clockwise as seen from the point.
    pub(super) fn of_edges(edges: impl IntoIterator<Item = (Vector<T>, Vector<T>)>) -> Option<Self> {
        // An edge of no angular length has no direction: a plane of noise would cut anywhere.
        let plane = |(from, to): (Vector<T>, Vector<T>)| {
            let normal = cross(to, from);
            (length(normal) > T::NOISE * length(from) * length(to)).then_some(normal)
        };
        Self::of_planes(edges.into_iter().filter_map(plane).collect())
    }

    /// The cone between planes; `None` without any.
    pub(super) fn of_planes(planes: Vec<Vector<T>>) -> Option<Self> {
        (!planes.is_empty()).then_some(Self { planes })
    }

    /// Returns whether one of its planes alone tells that it misses a polygon.
    pub(super) fn is_apart(&self, corners: &[Vector<T>]) -> bool {
        let outside = |plane: &Vector<T>| corners.iter().all(|corner| dot(*plane, *corner) <= T::from_f64(0.0));
        self.planes.iter().any(outside)
    }
}
