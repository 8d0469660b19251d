//! Layered depth images: for each pixel all surfaces that a ray through its centre crosses, sorted.
//!
//! Two passes over the triangles: the first counts, sums of the counts say where each pixel's
//! list begins, and the second writes. So nothing is too long for its place, and the memory is
//! known before it is taken.

use super::flat::{Flats, Fragment};
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::Scene;

/// Most crossings of a picture: 20 bytes each.
const MOST: u64 = 1 << 27;

/// A surface at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Its depth, relative to the base of the layers.
    pub depth: f32,
    /// Set if it faces the viewer.
    pub front: bool,
    /// The triangle, counted through the scene.
    pub triangle: u32,
    /// The object.
    pub object: u32,
    /// The direction of its normal, as a word of [`octahedron`](super::octahedron).
    pub normal: u32,
}

/// The crossings of all pixels.
#[derive(Debug, Clone, Default)]
pub struct Layers {
    /// The depth that depths are relative to.
    pub base: f64,
    /// The place in `crossings` at which each pixel's list begins, and its end.
    pub first: Vec<usize>,
    /// The lists, one behind the other.
    pub crossings: Vec<Crossing>,
}

impl Layers {
    /// The layers of a scene.
    ///
    /// # Errors
    /// When there are more than can be kept.
    pub fn new(scene: &Scene, view: &SlabView) -> Result<Self, Failure> {
        let flats = Flats::new(scene, view);
        let (width, height) = view.size;
        let pixel = |[x, y]: [u32; 2]| y as usize * width as usize + x as usize;
        let mut counts = vec![0_u32; width as usize * height as usize];
        for flat in &flats.all {
            flat.fragments(flats.parallel, |fragment| counts[pixel(fragment.pixel)] += 1);
        }
        let total: u64 = counts.iter().map(|count| u64::from(*count)).sum();
        if total > MOST {
            return Err(too_many(&total.to_string(), MOST));
        }
        let mut first = Vec::with_capacity(counts.len() + 1);
        let mut sum = 0;
        for count in &counts {
            first.push(sum);
            sum += *count as usize;
        }
        first.push(sum);
        let nothing = Crossing { depth: 0.0, front: false, triangle: 0, object: 0, normal: 0 };
        let mut crossings = vec![nothing; sum];
        let mut next = first.clone();
        for flat in &flats.all {
            flat.fragments(flats.parallel, |Fragment { pixel: at, depth, normal }| {
                let next = &mut next[pixel(at)];
                let (triangle, object) = (flat.triangle, flat.object);
                crossings[*next] = Crossing { depth, front: flat.front, triangle, object, normal };
                *next += 1;
            });
        }
        let mut layers = Self { base: flats.base, first, crossings };
        for pixel in 0..counts.len() {
            sort(&mut layers.crossings[layers.first[pixel]..layers.first[pixel + 1]]);
        }
        Ok(layers)
    }

    /// The list of a pixel.
    pub fn of(&self, pixel: usize) -> &[Crossing] {
        &self.crossings[self.first[pixel]..self.first[pixel + 1]]
    }

    /// The least and the largest depth; `None` where nothing is seen.
    pub fn depths(&self) -> Option<(f32, f32)> {
        let start = (f32::INFINITY, f32::NEG_INFINITY);
        let span = self.crossings.iter().fold(start, |(lo, hi), c| (lo.min(c.depth), hi.max(c.depth)));
        (span.0 <= span.1).then_some(span)
    }
}

/// Sorts the list of a pixel: by depth, what faces the viewer first, then by triangle.
pub(super) fn sort(list: &mut [Crossing]) {
    list.sort_unstable_by(|a, b| {
        a.depth.total_cmp(&b.depth).then(b.front.cmp(&a.front)).then(a.triangle.cmp(&b.triangle))
    });
}

/// The complaint about more crossings than there is room for.
pub(super) fn too_many(total: &str, most: u64) -> Failure {
    let message = format!("{total} crossings of surfaces are more than the {most} that are kept");
    let error = Diagnostic::error(codes::RENDER, message);
    Failure::bare("", error.help("make the picture smaller, or the scene simpler"))
}
