//! True hard shadows, antialiased: the ground truth of all techniques.
//!
//! The value of a pixel is the share of its area that is lit, of the surface at
//! its centre: a technique is asked about one surface per pixel, too. Samples
//! follow a low-discrepancy sequence and are doubled until that changes nothing
//! that could be seen.

use std::ops::Range;

use rayon::prelude::*;

use super::stage::Stage;
use crate::scene::rays::SurfacePoint;
use crate::scene::surfaces::Surfaces;
use crate::scene::view::View;

/// How many samples a pixel gets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Samples {
    /// As many at first in a pixel near a silhouette.
    pub first: u32,
    /// No more than these.
    pub most: u32,
}

impl Default for Samples {
    fn default() -> Self {
        Self { first: 256, most: 4096 }
    }
}

/// Doubling the samples of a pixel is over when it changes less than this, twice in a row.
const SETTLED: f32 = 0.4 / 255.0;

/// The visibility of every pixel. `done` is told about every row, twice.
pub fn visibility(stage: &Stage<'_>, surfaces: &Surfaces, samples: Samples, done: &(dyn Fn(u64) + Sync)) -> Vec<f32> {
    let width = surfaces.width as usize;
    let sampler = Sampler {
        stage,
        view: stage.scene.camera.view(surfaces.width, surfaces.height),
        size: [f64::from(surfaces.width), f64::from(surfaces.height)],
    };
    let rows = |value: &(dyn Fn(usize) -> f32 + Sync)| -> Vec<f32> {
        let row = |y: usize| {
            let values: Vec<f32> = (y * width..(y + 1) * width).map(value).collect();
            done(1);
            values
        };
        (0..surfaces.height as usize).into_par_iter().flat_map_iter(row).collect()
    };
    // A few samples tell whether a silhouette is anywhere near.
    let coarse = rows(&|pixel| match &surfaces.points[pixel] {
        Some(point) => {
            let mut tally = Tally::default();
            sampler.count(&mut tally, point, pixel, 0..5);
            tally.mean()
        }
        None => 1.0,
    });
    let is_near = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let same_object = |other: usize| {
            let object = |pixel: usize| surfaces.points[pixel].as_ref().map(|point| point.object);
            object(other) == object(pixel)
        };
        let (right, below) = ((x + 1).min(width - 1), (y + 1).min(surfaces.height as usize - 1));
        let around =
            (y.saturating_sub(1)..=below).flat_map(|y| (x.saturating_sub(1)..=right).map(move |x| y * width + x));
        let mut around = around.filter(|other| same_object(*other));
        !matches!(coarse[pixel], 0.0 | 1.0) || around.any(|other| coarse[other] != coarse[pixel])
    };
    rows(&|pixel| match &surfaces.points[pixel] {
        Some(point) if is_near(pixel) => sampler.settled(point, pixel, samples),
        _ => coarse[pixel],
    })
}

/// Samples taken so far.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    lit: u32,
    all: u32,
}

impl Tally {
    fn mean(self) -> f32 {
        self.lit as f32 / self.all.max(1) as f32
    }
}

struct Sampler<'a> {
    stage: &'a Stage<'a>,
    view: View,
    size: [f64; 2],
}

impl Sampler<'_> {
    /// Doubles the samples of a pixel until its mean has settled.
    fn settled(&self, point: &SurfacePoint, pixel: usize, samples: Samples) -> f32 {
        let mut tally = Tally::default();
        self.count(&mut tally, point, pixel, 0..samples.first);
        let (mut count, mut quiet) = (samples.first, 0);
        while quiet < 2 && count < samples.most {
            let before = tally.mean();
            self.count(&mut tally, point, pixel, count..2 * count);
            quiet = if (tally.mean() - before).abs() < SETTLED { quiet + 1 } else { 0 };
            count *= 2;
        }
        tally.mean()
    }

    /// Adds some samples of the sequence. A surface that faces away from the light gets none of it.
    fn count(&self, tally: &mut Tally, point: &SurfacePoint, pixel: usize, indices: Range<u32>) {
        if !self.stage.faces_light(point) {
            return;
        }
        for sample in indices.filter_map(|index| self.sample(point, pixel, index)) {
            tally.lit += u32::from(self.stage.is_lit(&sample));
            tally.all += 1;
        }
    }

    /// A place within the pixel, on the surface that its centre shows.
    fn sample(&self, point: &SurfacePoint, pixel: usize, index: u32) -> Option<SurfacePoint> {
        let (x, y) = (pixel % self.size[0] as usize, pixel / self.size[0] as usize);
        // The additive sequence of the plastic number; its first term is the centre of the pixel.
        let term = |step: f64| (0.5 + f64::from(index) * step).fract();
        let (dx, dy) = (term(0.754_877_666_246_692_8), term(0.569_840_290_998_053_3));
        let ray = self.view.ray((x as f64 + dx) / self.size[0], (y as f64 + dy) / self.size[1]);
        let on_triangle = self.stage.rays.point_on(point.triangle, ray).filter(|at| self.stage.rays.is_inside(at));
        let at = match on_triangle {
            Some(at) => at,
            None => self.stage.rays.see(ray)?,
        };
        (at.object == point.object && self.stage.faces_light(&at)).then_some(at)
    }
}
