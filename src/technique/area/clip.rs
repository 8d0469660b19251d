//! Clipping a convex polygon against a half-space, by the table `clip_step`.
//!
//! A point is on the inner side of a plane where its height above it is positive.
//! The place where an edge crosses the plane is always computed from the end above
//! towards the end below, so that the two sides of one cut share it bit for bit.

use super::scalar::{Scalar, Vector, minus, plus, times};
use super::tabulated::Tabulated;
use crate::diag::Failure;
use crate::technique::tables::CLIP_STEP;

/// Clips polygons.
#[derive(Debug, Clone)]
pub(super) struct Clipper {
    /// The side of an edge's start times 3, and of its end, both 0 outside, 1 on the plane and 2 inside → the items of
    /// `clip_step`.
    steps: Vec<Vec<Step>>,
}

/// A point that an edge adds: a level of the table's set `point`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Start,
    Crossing,
}

/// The side of a plane that a point lies on: a level of the table's set `side`.
fn side<T: Scalar>(height: T) -> usize {
    let zero = T::from_f64(0.0);
    if height > zero {
        2
    } else if height < zero {
        0
    } else {
        1
    }
}

impl Clipper {
    /// A clipper by the table that comes with Umbrage.
    ///
    /// # Errors
    /// Never for that table, which is tested.
    pub(super) fn new() -> Result<Self, Failure> {
        let table = Tabulated::new(&CLIP_STEP, &["a", "b"])?;
        let step = |item: &u8| if *item == 0 { Step::Start } else { Step::Crossing };
        let steps = (0..9).map(|sides| table.list(&[sides / 3, sides % 3]).iter().map(step).collect());
        Ok(Self { steps: steps.collect() })
    }

    /// The part of a polygon on the inner side of a plane, by the height of each corner above it. Empty, if it has no
    /// area.
    pub(super) fn inside<T: Scalar>(&self, corners: &[Vector<T>], heights: &[T]) -> Vec<Vector<T>> {
        self.part(corners, heights, |side| side)
    }

    /// The part on the outer side.
    pub(super) fn outside<T: Scalar>(&self, corners: &[Vector<T>], heights: &[T]) -> Vec<Vector<T>> {
        self.part(corners, heights, |side| 2 - side)
    }

    fn part<T: Scalar>(&self, corners: &[Vector<T>], heights: &[T], seen: impl Fn(usize) -> usize) -> Vec<Vector<T>> {
        let mut part = Vec::with_capacity(corners.len() + 1);
        for (index, (corner, height)) in corners.iter().zip(heights).enumerate() {
            let next = (index + 1) % corners.len();
            let sides = (seen(side(*height)), seen(side(heights[next])));
            for step in &self.steps[3 * sides.0 + sides.1] {
                part.push(match step {
                    Step::Start => *corner,
                    Step::Crossing => crossing((*corner, *height), (corners[next], heights[next])),
                });
            }
        }
        if part.len() < 3 {
            part.clear();
        }
        part
    }
}

/// The place between two points, on either side of a plane, where it is crossed.
pub(super) fn crossing<T: Scalar>(a: (Vector<T>, T), b: (Vector<T>, T)) -> Vector<T> {
    let ((above, up), (below, down)) = if a.1 > T::from_f64(0.0) { (a, b) } else { (b, a) };
    plus(above, times(minus(below, above), up / (up - down)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [Vector<f64>; 4] = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]];

    fn clipper() -> Clipper {
        Clipper::new().unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn the_two_sides_of_a_cut_share_its_ends() {
        let heights = SQUARE.map(|[x, y, _]| x + 0.5 * y - 0.7);
        let (inside, outside) = (clipper().inside(&SQUARE, &heights), clipper().outside(&SQUARE, &heights));
        let ends: Vec<_> = inside.iter().filter(|at| !SQUARE.contains(at)).collect();
        assert_eq!(ends.len(), 2);
        assert!(ends.iter().all(|end| outside.contains(end)), "{inside:?} {outside:?}");
    }

    #[test]
    fn corners_on_the_plane_belong_to_both_sides_and_a_side_without_area_is_empty() {
        let diagonal = SQUARE.map(|[x, y, _]| x - y);
        assert_eq!(clipper().inside(&SQUARE, &diagonal), [SQUARE[0], SQUARE[1], SQUARE[2]]);
        assert_eq!(clipper().outside(&SQUARE, &diagonal), [SQUARE[0], SQUARE[2], SQUARE[3]]);
        let edge = SQUARE.map(|[x, ..]| x);
        assert_eq!(clipper().inside(&SQUARE, &edge), SQUARE);
        assert!(clipper().outside(&SQUARE, &edge).is_empty());
    }
}
