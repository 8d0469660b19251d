//! Peeling: the part of a polygon that no cone hides, as disjoint convex pieces.
//!
//! A plane of a cone splits what is left of a polygon: the outer part survives the
//! cone and goes on to the next one, the inner part to the cone's next plane, and
//! what is inside all planes is hidden. Both sides of a cut share the same points,
//! so that rounding moves area by slivers only: no decision can lose a region or
//! count it twice. Cones that miss a polygon are passed over before anything is cut.

use super::clip::Clipper;
use super::cone::Cone;
use super::scalar::{Scalar, Vector, dot};

/// The sizes that are set aside where memory is not allocated, as on a GPU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bounds {
    /// Most corners of a piece.
    pub corners: usize,
    /// Most cones that have cut what one piece is left of.
    pub depth: usize,
    /// Most clips of a polygon against a plane.
    pub clips: u64,
}

impl Bounds {
    /// Twice what was met in random scenes with up to twelve occluders, and within what WGSL grants to every function.
    pub const PORTABLE: Self = Self { corners: 16, depth: 16, clips: 4096 };
}

/// The work of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Work {
    /// Pieces.
    pub pieces: u64,
    /// Clips of a polygon against a plane.
    pub clips: u64,
    /// True if it went beyond [`Bounds::PORTABLE`].
    pub overflow: bool,
}

/// A polygon that is being split by the planes of a cone.
struct Split<T> {
    rest: Vec<Vector<T>>,
    cone: usize,
    plane: usize,
}

/// Gives every piece of a convex polygon that none of the cones hides, and counts.
///
/// Memory is bounded by the number of cones.
pub(super) fn peel<T: Scalar>(
    clipper: &Clipper,
    corners: Vec<Vector<T>>,
    cones: &[Cone<T>],
    work: &mut Work,
    mut give: impl FnMut(&[Vector<T>]),
) {
    let mut stack: Vec<Split<T>> = Vec::new();
    let mut peeling = Peeling { clipper, cones, work, give: &mut give };
    peeling.arrive(corners, 0, &mut stack);
    while let Some(top) = stack.last_mut() {
        let (cone, plane) = (top.cone, top.plane);
        let heights = heights(&top.rest, cones[cone].planes[plane]);
        let outside = clipper.outside(&top.rest, &heights);
        top.rest = clipper.inside(&top.rest, &heights);
        top.plane += 1;
        if top.rest.is_empty() || top.plane == cones[cone].planes.len() {
            stack.pop();
        }
        peeling.work.clips += 2;
        peeling.arrive(outside, cone + 1, &mut stack);
    }
    let clips = peeling.work.clips;
    peeling.work.overflow |= clips > Bounds::PORTABLE.clips;
}

struct Peeling<'a, T, G> {
    clipper: &'a Clipper,
    cones: &'a [Cone<T>],
    work: &'a mut Work,
    give: &'a mut G,
}

impl<T: Scalar, G: FnMut(&[Vector<T>])> Peeling<'_, T, G> {
    /// Takes a polygon to the next cone that meets it, or gives it where there is none.
    fn arrive(&mut self, corners: Vec<Vector<T>>, first: usize, stack: &mut Vec<Split<T>>) {
        if corners.is_empty() {
            return;
        }
        self.work.overflow |= corners.len() > Bounds::PORTABLE.corners;
        match (first..self.cones.len()).find(|cone| !self.misses(&corners, *cone)) {
            None => {
                self.work.pieces += 1;
                (self.give)(&corners);
            }
            Some(cone) => {
                stack.push(Split { rest: corners, cone, plane: 0 });
                self.work.overflow |= stack.len() > Bounds::PORTABLE.depth;
            }
        }
    }

    fn misses(&mut self, corners: &[Vector<T>], cone: usize) -> bool {
        let cone = &self.cones[cone];
        if cone.is_apart(corners) {
            return true;
        }
        let mut rest = corners.to_vec();
        for plane in &cone.planes {
            let heights = heights(&rest, *plane);
            rest = self.clipper.inside(&rest, &heights);
            self.work.clips += 1;
            if rest.is_empty() {
                return true;
            }
        }
        false
    }
}

fn heights<T: Scalar>(corners: &[Vector<T>], plane: Vector<T>) -> Vec<T> {
    corners.iter().map(|corner| dot(plane, *corner)).collect()
}
