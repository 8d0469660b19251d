//! Area lights as techniques: peeling, its exact reference, and what it is compared with.

use std::sync::Arc;

#[cfg(feature = "gpu")]
use super::gpu::Peeling;
use super::lit::{Lit, OCCLUDERS};
use super::picture::{Pixels, peeled};
use super::received::Received;
use super::sampling::{Filter, estimates, ratio};
use crate::diag::Failure;
#[cfg(feature = "gpu")]
use crate::gpu::timing::Stopwatch;
use crate::scene::light::Lights;
use crate::scene::rays::Rays;
#[cfg(feature = "gpu")]
use crate::technique::Executor;
#[cfg(feature = "gpu")]
use crate::technique::prepared::{Detail, Pass};
use crate::technique::setting::{Range, SEED, Value};
use crate::technique::tables::{
    BOX_SILHOUETTE, BuiltIn, CLIP_STEP, EDGE_INTEGRAL, EDGE_SILHOUETTE, HORIZON_CLIP, LTC, LTC_ALBEDO, LTC_MATRIX,
};
use crate::technique::{Ability, Frame, Prepared, Progress, Rendered, Samples, Setting, Technique};

/// Rays to each light.
pub const SAMPLES: Setting = Setting {
    name: "rays",
    doc: "rays of a pixel to each light",
    default: Value::Whole(16),
    range: Range::Whole(1, 1 << 16),
    label: "",
};

/// Reach of the filter of `area_ratio`.
pub const RADIUS: Setting = Setting {
    name: "filter_radius",
    doc: "pixels to each side that the filter of shadows takes in",
    default: Value::Whole(6),
    range: Range::Whole(0, 64),
    label: "",
};

/// Layer of the convex pieces that lights were cut into.
pub const PIECES: &str = "pieces";
/// Layer of the clips of a polygon against a plane.
pub const CLIPS: &str = "clips";
/// Layer of the pixels beyond the bounds that are set aside: 1 there, else 0.
pub const OVERFLOW: &str = "overflow";

static TABLES: [&BuiltIn; 8] =
    [&HORIZON_CLIP, &CLIP_STEP, &BOX_SILHOUETTE, &EDGE_SILHOUETTE, &EDGE_INTEGRAL, &LTC_MATRIX, &LTC_ALBEDO, &LTC];
/// Those of surfaces only.
static OF_SURFACES: [&BuiltIn; 3] = [&LTC_MATRIX, &LTC_ALBEDO, &LTC];

/// A way to the light of polygons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Peel,
    Exact,
    Samples,
    Ratio,
    Unshadowed,
}

/// A technique for polygonal lights.
#[derive(Debug)]
pub struct Entry(Way);

/// The visible part of each light, cut out exactly, in single precision.
pub static PEEL: Entry = Entry(Way::Peel);
/// The same in double precision: the truth of the others.
pub static EXACT: Entry = Entry(Way::Exact);
/// Rays to stratified places on each light.
pub static AREA_SAMPLES: Entry = Entry(Way::Samples);
/// The ratio estimator.
pub static AREA_RATIO: Entry = Entry(Way::Ratio);
/// Light without shadows.
pub static AREA_UNSHADOWED: Entry = Entry(Way::Unshadowed);

const EXACT_NAME: &str = "area_exact";

impl Technique for Entry {
    fn name(&self) -> &'static str {
        match self.0 {
            Way::Peel => "peel",
            Way::Exact => EXACT_NAME,
            Way::Samples => "area_samples",
            Way::Ratio => "area_ratio",
            Way::Unshadowed => "area_unshadowed",
        }
    }

    fn doc(&self) -> &'static str {
        match self.0 {
            Way::Peel => "light of polygons past polygons, boxes and meshes, whose visible part is cut out",
            Way::Exact => "the same in double precision, on the CPU: the truth of area lights",
            Way::Samples => "light of polygons by rays to stratified places on each, on the CPU",
            Way::Ratio => "exact light without shadows times a filtered ratio of sampled light, on the CPU",
            Way::Unshadowed => "light of polygons without shadows, on the CPU",
        }
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        match self.0 {
            Way::Samples => &OF_SURFACES,
            Way::Peel | Way::Exact | Way::Ratio | Way::Unshadowed => &TABLES,
        }
    }

    fn lights(&self) -> Lights {
        Lights::POLYGON
    }

    fn settings(&self) -> &'static [Setting] {
        match self.0 {
            Way::Peel | Way::Exact => &[OCCLUDERS],
            Way::Unshadowed => &[],
            Way::Samples => &[SAMPLES, SEED],
            Way::Ratio => &[SAMPLES, SEED, RADIUS],
        }
    }

    fn abilities(&self) -> &'static [Ability] {
        &[Ability::FormFactors, Ability::Passes]
    }

    fn truth(&self) -> Option<&'static str> {
        (self.0 != Way::Exact).then_some(EXACT_NAME)
    }

    fn needs_device(&self) -> bool {
        self.0 == Way::Peel
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Area::new(self.0, frame)?))
    }
}

/// The machine that peels.
enum Machine<'s> {
    /// Plain Rust, with the tables looked up or by the batch interpreter.
    Cpu,
    #[cfg(feature = "gpu")]
    Gpu(Box<Peeling<'s>>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'s std::convert::Infallible),
}

/// A frame under polygonal lights.
struct Area<'s> {
    way: Way,
    machine: Machine<'s>,
    lit: Arc<Lit>,
    rays: Arc<Rays>,
    samples: u32,
    seed: u32,
    filter: Filter,
}

impl<'s> Area<'s> {
    fn new(way: Way, frame: &Frame<'s>) -> Result<Self, Failure> {
        let machine = match frame.on {
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) if way == Way::Peel => Machine::Gpu(Box::new(Peeling::new(gpu)?)),
            _ => Machine::Cpu,
        };
        Ok(Self {
            way,
            machine,
            lit: Lit::of(frame, Entry(way).name())?,
            rays: Arc::clone(&frame.rays),
            samples: frame.settings.whole(&SAMPLES),
            seed: frame.settings.whole(&SEED),
            filter: Filter { radius: frame.settings.whole(&RADIUS) },
        })
    }

    fn pixels(&self, progress: &Progress<'_>) -> Result<Pixels, Failure> {
        let lit = &*self.lit;
        let sampled = |progress: &Progress<'_>| estimates(lit, &self.rays, self.samples, self.seed, progress);
        match self.way {
            Way::Peel => match &self.machine {
                Machine::Cpu => peeled::<f32>(lit, progress),
                #[cfg(feature = "gpu")]
                Machine::Gpu(peeling) => {
                    let pixels = peeling.light(lit, &peeling.place(lit)?);
                    progress(u64::from(lit.surfaces.height));
                    pixels
                }
                #[cfg(not(feature = "gpu"))]
                Machine::Never(never) => match **never {},
            },
            Way::Exact => peeled::<f64>(lit, progress),
            Way::Samples => {
                let received = sampled(progress).into_iter().map(|estimate| estimate.shadowed).collect();
                Ok(Pixels { received, ..Pixels::new(lit.surfaces.points.len()) })
            }
            Way::Ratio => {
                let unshadowed = self.unshadowed(&|_| {})?;
                let received = ratio(lit, &sampled(progress), &unshadowed, self.filter);
                Ok(Pixels { received, ..Pixels::new(lit.surfaces.points.len()) })
            }
            Way::Unshadowed => {
                let received = self.unshadowed(progress)?;
                Ok(Pixels { received, ..Pixels::new(lit.surfaces.points.len()) })
            }
        }
    }

    fn unshadowed(&self, progress: &Progress<'_>) -> Result<Vec<Received>, Failure> {
        Ok(peeled::<f64>(&self.lit.without_occluders(), progress)?.received)
    }
}

impl<'s> Prepared<'s> for Area<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let pixels = self.pixels(progress)?;
        let rendered = self.lit.rendered(&pixels.received);
        Ok(match self.way {
            Way::Peel | Way::Exact => rendered
                .with(PIECES, Samples::Counts(pixels.work.iter().map(|work| work.pieces as u32).collect()))
                .with(CLIPS, Samples::Counts(pixels.work.iter().map(|work| work.clips as u32).collect()))
                .with(OVERFLOW, Samples::Counts(pixels.work.iter().map(|work| u32::from(work.overflow)).collect())),
            Way::Samples | Way::Ratio | Way::Unshadowed => rendered,
        })
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(self.way, frame)?;
        Ok(())
    }

    #[cfg(feature = "gpu")]
    fn passes(&mut self, _: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let own = &*self;
        let name = Entry(own.way).name();
        Ok(vec![match &own.machine {
            Machine::Cpu => Pass::on_cpu(name, "light", move || own.pixels(&|_| {}).map(drop)),
            Machine::Gpu(peeling) => {
                let placed = peeling.place(&own.lit)?;
                Pass::new(name, "compute", None, move |stopwatch: &Stopwatch<'_>| peeling.time(&placed, stopwatch))
            }
        }])
    }
}
