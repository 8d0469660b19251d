//! Layered depth images: for each pixel all surfaces that a ray through its centre crosses, sorted.
//!
//! Two passes over the triangles: the first counts, sums of the counts say where each pixel's
//! list begins, and the second writes. So nothing is too long for its place, and the memory is
//! known before it is taken.

use glam::{DVec2, DVec3};

use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::Scene;

/// Most crossings of a picture: 24 bytes each.
const MOST: u64 = 1 << 27;

/// A surface at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Its depth.
    pub depth: f64,
    /// Set if it faces the viewer.
    pub front: bool,
    /// The triangle, counted through the scene.
    pub triangle: u32,
    /// The object.
    pub object: u32,
}

/// The crossings of all pixels.
#[derive(Debug, Clone, Default)]
pub struct Layers {
    /// The place in `crossings` at which each pixel's list begins, and its end.
    pub first: Vec<usize>,
    /// The lists, one behind the other.
    pub crossings: Vec<Crossing>,
}

/// A triangle on the picture.
struct Flat {
    corners: [DVec2; 3],
    /// Depths, or their inverses where those are linear.
    depths: [f64; 3],
    front: bool,
    triangle: u32,
    object: u32,
}

impl Layers {
    /// The layers of a scene.
    ///
    /// # Errors
    /// When there are more than can be kept.
    pub fn new(scene: &Scene, view: &SlabView) -> Result<Self, Failure> {
        let triangles = flat(scene, view);
        let (width, height) = view.size;
        let mut counts = vec![0_u32; width as usize * height as usize];
        for triangle in &triangles {
            triangle.fragments(view, |pixel, _| counts[pixel] += 1);
        }
        let total: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        if total > MOST {
            let message = format!("{total} crossings of surfaces are more than the {MOST} that are kept");
            let error = Diagnostic::error(codes::RENDER, message);
            return Err(Failure::bare("", error.help("make the picture smaller, or the scene simpler")));
        }
        let mut first = Vec::with_capacity(counts.len() + 1);
        let mut sum = 0;
        for count in &counts {
            first.push(sum);
            sum += *count as usize;
        }
        first.push(sum);
        let nothing = Crossing { depth: 0.0, front: false, triangle: 0, object: 0 };
        let mut crossings = vec![nothing; sum];
        let mut next = first.clone();
        for triangle in &triangles {
            triangle.fragments(view, |pixel, depth| {
                let Flat { front, triangle, object, .. } = *triangle;
                crossings[next[pixel]] = Crossing { depth, front, triangle, object };
                next[pixel] += 1;
            });
        }
        let mut layers = Self { first, crossings };
        layers.sort();
        Ok(layers)
    }

    /// Sorts every list: by depth, what faces the viewer first, then by triangle.
    fn sort(&mut self) {
        for pixel in 0..self.first.len().saturating_sub(1) {
            self.crossings[self.first[pixel]..self.first[pixel + 1]].sort_by(|a, b| {
                a.depth.total_cmp(&b.depth).then(b.front.cmp(&a.front)).then(a.triangle.cmp(&b.triangle))
            });
        }
    }

    /// The list of a pixel.
    pub fn of(&self, pixel: usize) -> &[Crossing] {
        &self.crossings[self.first[pixel]..self.first[pixel + 1]]
    }

    /// The least and the largest depth; `None` where nothing is seen.
    pub fn depths(&self) -> Option<(f64, f64)> {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let span = self.crossings.iter().fold(start, |(lo, hi), c| (lo.min(c.depth), hi.max(c.depth)));
        (span.0 <= span.1).then_some(span)
    }
}

/// The triangles that are before the viewer, cut at the nearest depth.
fn flat(scene: &Scene, view: &SlabView) -> Vec<Flat> {
    let mut all = Vec::new();
    for (index, (object, triangle)) in scene.triangles().enumerate() {
        let seen = triangle.corners.map(|corner| view.seen(corner));
        let polygon = cut(&seen, view.near());
        let Some((head, rest)) = polygon.split_first() else { continue };
        for pair in rest.windows(2) {
            let seen = [*head, pair[0], pair[1]];
            let corners = seen.map(|corner| view.pixel(corner));
            // Corners go anticlockwise seen from outside, and y points down.
            let area = (corners[1] - corners[0]).perp_dot(corners[2] - corners[0]);
            if area != 0.0 && area.is_finite() {
                let depths = seen.map(|corner| if view.is_parallel() { corner.z } else { 1.0 / corner.z });
                all.push(Flat { corners, depths, front: area < 0.0, triangle: index as u32, object: object as u32 });
            }
        }
    }
    all
}

/// The part of a triangle that is no nearer than `near`.
fn cut(corners: &[DVec3; 3], near: f64) -> Vec<DVec3> {
    let mut out = Vec::with_capacity(4);
    for (i, from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % 3];
        if from.z >= near {
            out.push(*from);
        }
        if (from.z >= near) != (to.z >= near) {
            out.push(from.lerp(to, (near - from.z) / (to.z - from.z)));
        }
    }
    out
}

impl Flat {
    /// Calls for every pixel whose centre is inside, with the depth there.
    ///
    /// An edge is evaluated in the same order of its ends by both triangles that share it, and a centre on it counts as
    /// a little to the right of it, then below: so each centre belongs to exactly one of them.
    fn fragments(&self, view: &SlabView, mut each: impl FnMut(usize, f64)) {
        let [a, b, c] = self.corners;
        let (lo, hi) = (a.min(b).min(c), a.max(b).max(c));
        let range = |lo: f64, hi: f64, size: u32| {
            let clamped = |at: f64| at.clamp(0.0, f64::from(size)) as u32;
            clamped((lo - 0.5).floor())..clamped((hi + 0.5).ceil())
        };
        let twice = (b - a).perp_dot(c - a);
        let sign = twice.signum();
        for y in range(lo.y, hi.y, view.size.1) {
            for x in range(lo.x, hi.x, view.size.0) {
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let sides = [(b, c), (c, a), (a, b)].map(|(from, to)| side(from, to, at));
                if sides.iter().all(|(_, left)| *left == (sign > 0.0)) {
                    let total: f64 = sides.iter().map(|(part, _)| part).sum();
                    let mixed = (0..3).map(|i| sides[i].0 * self.depths[i]).sum::<f64>() / total;
                    let depth = if total == 0.0 { self.depths[0] } else { mixed };
                    each((y * view.size.0 + x) as usize, if view.is_parallel() { depth } else { 1.0 / depth });
                }
            }
        }
    }
}

/// Twice the area that an edge spans with a place, and whether the place is to its left (y points down).
fn side(from: DVec2, to: DVec2, at: DVec2) -> (f64, bool) {
    let swapped = (to.x, to.y) < (from.x, from.y);
    let (a, b) = if swapped { (to, from) } else { (from, to) };
    let edge = b - a;
    let value = edge.perp_dot(at - a);
    let left = if value != 0.0 {
        value > 0.0
    } else if edge.y != 0.0 {
        edge.y < 0.0
    } else {
        edge.x > 0.0
    };
    if swapped { (-value, !left) } else { (value, left) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_on_an_edge_belongs_to_one_side() {
        let ends = [DVec2::new(0.5, 0.5), DVec2::new(4.5, 0.5), DVec2::new(0.5, 3.5), DVec2::new(2.5, 2.5)];
        for a in ends {
            for b in ends.into_iter().filter(|b| *b != a) {
                for at in [a, b, 0.5 * (a + b)] {
                    assert_ne!(side(a, b, at).1, side(b, a, at).1, "{a} {b} {at}");
                }
            }
        }
    }
}
