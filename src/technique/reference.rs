//! True hard shadows, antialiased: the ground truth of all techniques.
//!
//! The value of a pixel is the share of its area that is lit, of the surface at
//! its centre: a technique is asked about one surface per pixel, too. Samples
//! follow a low-discrepancy sequence and are doubled until that changes nothing
//! that could be seen.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::rendered::VALUE;
use super::shade::faces;
use super::tables::BuiltIn;
use super::{Ability, Frame, Prepared, Progress, Rendered, Setting, Technique, setting};
use crate::diag::Failure;
use crate::scene::Scene;
use crate::scene::light::{Lights, Punctual};
use crate::scene::rays::{Rays, SurfacePoint};
use crate::scene::surfaces::Surfaces;
use crate::scene::view::View;

/// The name of the technique.
pub const NAME: &str = "reference";

/// [`Samples::first`]
pub const FIRST_SAMPLES: Setting = Setting {
    name: "first_samples",
    doc: "samples at first in a pixel near a silhouette",
    default: setting::Value::Whole(Samples::DEFAULT.first),
    range: setting::Range::Whole(1, 1 << 20),
    label: "",
};

/// [`Samples::most`]
pub const MOST_SAMPLES: Setting = Setting {
    name: "most_samples",
    doc: "most samples of a pixel",
    default: setting::Value::Whole(Samples::DEFAULT.most),
    range: setting::Range::Whole(1, 1 << 20),
    label: "",
};

/// The true shadow as a technique.
#[derive(Debug)]
pub struct Entry;

/// Rays towards the light.
pub static REFERENCE: Entry = Entry;

impl Technique for Entry {
    fn name(&self) -> &'static str {
        NAME
    }

    fn doc(&self) -> &'static str {
        "the true hard shadow, antialiased: rays towards the light, on the CPU"
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        &[]
    }

    fn lights(&self) -> Lights {
        Lights::PUNCTUAL
    }

    fn settings(&self) -> &'static [Setting] {
        &[FIRST_SAMPLES, MOST_SAMPLES]
    }

    fn abilities(&self) -> &'static [Ability] {
        &[Ability::Visibility]
    }

    fn truth(&self) -> Option<&'static str> {
        None
    }

    fn needs_device(&self) -> bool {
        false
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(ByRays::new(frame)?))
    }
}

/// A frame that rays are cast for.
struct ByRays<'s> {
    scene: &'s Scene,
    light: Punctual,
    rays: Arc<Rays>,
    surfaces: Arc<Surfaces>,
    samples: Samples,
}

impl<'s> ByRays<'s> {
    fn new(frame: &Frame<'s>) -> Result<Self, Failure> {
        let samples =
            Samples { first: frame.settings.whole(&FIRST_SAMPLES), most: frame.settings.whole(&MOST_SAMPLES) };
        Ok(Self {
            scene: frame.scene,
            light: frame.scene.punctual(NAME)?,
            rays: Arc::clone(&frame.rays),
            surfaces: Arc::clone(&frame.surfaces),
            samples,
        })
    }
}

impl<'s> Prepared<'s> for ByRays<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let values = visibility(self.scene, &self.light, &self.rays, &self.surfaces, self.samples, progress);
        Ok(Rendered::default().with(VALUE, super::Samples::Numbers(values)))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(frame)?;
        Ok(())
    }
}

/// The numbers of samples of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Samples {
    /// As many at first in a pixel near a silhouette.
    pub first: u32,
    /// No more than these.
    pub most: u32,
}

impl Samples {
    /// So many that twice as many change nothing that could be seen.
    pub const DEFAULT: Samples = Samples { first: 256, most: 4096 };
}

impl Default for Samples {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Doubling the samples of a pixel is over when it changes less than this, twice in a row.
const SETTLED: f32 = 0.4 / 255.0;

/// The visibility of every pixel.
pub fn visibility(
    scene: &Scene,
    light: &Punctual,
    rays: &Rays,
    surfaces: &Surfaces,
    samples: Samples,
    progress: &Progress<'_>,
) -> Vec<f32> {
    let width = surfaces.width as usize;
    let sampler = Sampler {
        rays,
        light,
        view: scene.camera.view(surfaces.width, surfaces.height),
        size: [f64::from(surfaces.width), f64::from(surfaces.height)],
    };
    let rows = |value: &(dyn Fn(usize) -> f32 + Sync), done: u64| -> Vec<f32> {
        let row = |y: usize| {
            let values: Vec<f32> = (y * width..(y + 1) * width).map(value).collect();
            progress(done);
            values
        };
        (0..surfaces.height as usize).into_par_iter().flat_map_iter(row).collect()
    };
    // A few samples tell whether a silhouette is anywhere near.
    let coarse = |pixel: usize| match &surfaces.points[pixel] {
        Some(point) => {
            let mut tally = Tally::default();
            sampler.count(&mut tally, point, pixel, 0..5);
            tally.mean()
        }
        None => 1.0,
    };
    let coarse = rows(&coarse, 0);
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
    let fine = |pixel: usize| match &surfaces.points[pixel] {
        Some(point) if is_near(pixel) => sampler.settled(point, pixel, samples),
        _ => coarse[pixel],
    };
    rows(&fine, 1)
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
    rays: &'a Rays,
    light: &'a Punctual,
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
        if !faces(self.light, point) {
            return;
        }
        for sample in indices.filter_map(|index| self.sample(point, pixel, index)) {
            tally.lit += u32::from(self.is_lit(&sample));
            tally.all += 1;
        }
    }

    /// Returns whether a point is in the light.
    fn is_lit(&self, point: &SurfacePoint) -> bool {
        let (direction, distance) = (self.light.direction(point.place), self.light.distance(point.place));
        faces(self.light, point) && self.rays.sees_light(point, -direction, distance)
    }

    /// A place within the pixel, on the surface that its centre shows.
    fn sample(&self, point: &SurfacePoint, pixel: usize, index: u32) -> Option<SurfacePoint> {
        let (x, y) = (pixel % self.size[0] as usize, pixel / self.size[0] as usize);
        // The additive sequence of the plastic number; its first term is the centre of the pixel.
        let term = |step: f64| (0.5 + f64::from(index) * step).fract();
        let (dx, dy) = (term(0.754_877_666_246_692_8), term(0.569_840_290_998_053_3));
        let ray = self.view.ray((x as f64 + dx) / self.size[0], (y as f64 + dy) / self.size[1]);
        let on_triangle = self.rays.point_on(point.triangle, ray).filter(|at| self.rays.is_inside(at));
        let at = match on_triangle {
            Some(at) => at,
            None => self.rays.see(ray)?,
        };
        (at.object == point.object && faces(self.light, &at)).then_some(at)
    }
}
