//! True hard shadows, antialiased: the ground truth of all techniques.
//!
//! The value of a pixel is the share of its area that is lit, of the surface at
//! its centre: a technique is asked about one surface per pixel, too. Samples
//! follow a low-discrepancy sequence and are doubled until that changes nothing
//! that could be seen.

use rayon::prelude::*;

use super::passes::{Picture, Stage};
use super::trace::SurfacePoint;
use super::view::View;

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
        Self { first: 64, most: 2048 }
    }
}

/// Doubling the samples of a pixel is over when it changes less than this, twice in a row.
const SETTLED: f32 = 0.4 / 255.0;

/// The visibility of every pixel. `done` is told about every row, twice.
pub fn visibility(stage: &Stage<'_>, picture: &Picture, samples: Samples, done: &(dyn Fn(u64) + Sync)) -> Vec<f32> {
    let width = picture.width as usize;
    let sampler = Sampler {
        stage,
        view: stage.scene.camera.view(picture.width, picture.height),
        size: [f64::from(picture.width), f64::from(picture.height)],
    };
    let rows = |value: &(dyn Fn(usize) -> f32 + Sync)| -> Vec<f32> {
        let row = |y: usize| {
            let values: Vec<f32> = (y * width..(y + 1) * width).map(value).collect();
            done(1);
            values
        };
        (0..picture.height as usize).into_par_iter().flat_map_iter(row).collect()
    };
    // A few samples tell whether a silhouette is anywhere near.
    let coarse = rows(&|pixel| match &picture.points[pixel] {
        Some(point) => sampler.mean(point, pixel, 0, 5).unwrap_or(0.0),
        None => 1.0,
    });
    let is_near = |pixel: usize| {
        let (x, y) = (pixel % width, pixel / width);
        let same_object = |other: usize| {
            let object = |pixel: usize| picture.points[pixel].as_ref().map(|point| point.object);
            object(other) == object(pixel)
        };
        let (right, below) = ((x + 1).min(width - 1), (y + 1).min(picture.height as usize - 1));
        let around =
            (y.saturating_sub(1)..=below).flat_map(|y| (x.saturating_sub(1)..=right).map(move |x| y * width + x));
        let mut around = around.filter(|other| same_object(*other));
        !matches!(coarse[pixel], 0.0 | 1.0) || around.any(|other| coarse[other] != coarse[pixel])
    };
    rows(&|pixel| match &picture.points[pixel] {
        Some(point) if is_near(pixel) => sampler.settled(point, pixel, samples),
        _ => coarse[pixel],
    })
}

struct Sampler<'a> {
    stage: &'a Stage<'a>,
    view: View,
    size: [f64; 2],
}

impl Sampler<'_> {
    /// Doubles the samples of a pixel until its mean has settled.
    fn settled(&self, point: &SurfacePoint, pixel: usize, samples: Samples) -> f32 {
        let mut count = samples.first;
        let Some(mut mean) = self.mean(point, pixel, 0, count) else { return 0.0 };
        let mut quiet = 0;
        while quiet < 2 && count < samples.most {
            let more = self.mean(point, pixel, count, count).unwrap_or(mean);
            let doubled = (mean + more) / 2.0;
            quiet = if (doubled - mean).abs() < SETTLED { quiet + 1 } else { 0 };
            mean = doubled;
            count *= 2;
        }
        mean
    }

    /// The mean over some samples of the sequence. A surface that faces away from the light gets none.
    fn mean(&self, point: &SurfacePoint, pixel: usize, from: u32, count: u32) -> Option<f32> {
        if !self.stage.faces_light(point) {
            return None;
        }
        let (mut lit, mut all) = (0_u32, 0_u32);
        for index in from..from + count {
            if let Some(sample) = self.sample(point, pixel, index) {
                lit += u32::from(self.stage.is_lit(&sample));
                all += 1;
            }
        }
        Some(match all {
            0 => f32::from(u8::from(self.stage.is_lit(point))),
            _ => lit as f32 / all as f32,
        })
    }

    /// A place within the pixel, on the surface that its centre shows.
    fn sample(&self, point: &SurfacePoint, pixel: usize, index: u32) -> Option<SurfacePoint> {
        let (x, y) = (pixel % self.size[0] as usize, pixel / self.size[0] as usize);
        // The additive sequence of the plastic number; its first term is the centre of the pixel.
        let term = |step: f64| (0.5 + f64::from(index) * step).fract();
        let (dx, dy) = (term(0.754_877_666_246_692_8), term(0.569_840_290_998_053_3));
        let ray = self.view.ray((x as f64 + dx) / self.size[0], (y as f64 + dy) / self.size[1]);
        let on_triangle = self.stage.tracer.point_on(point.triangle, ray).filter(|at| self.stage.tracer.is_inside(at));
        let at = match on_triangle {
            Some(at) => at,
            None => self.stage.tracer.see(ray)?,
        };
        (at.object == point.object && self.stage.faces_light(&at)).then_some(at)
    }
}
