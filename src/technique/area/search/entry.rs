//! The search as a technique.

use std::sync::Arc;

use super::super::lit::Lit;
use super::super::picture::fractions;
#[cfg(feature = "gpu")]
use super::gpu::Searching;
use super::picture::{Coherence, Picture, Pixels};
use super::settings::{AGAINST, BOUNDARY_RAYS, BULGES, COHERENCE, GAP, SPACING, TOLERANCE};
use super::{Options, Rule, TABLES};
use crate::diag::Failure;
#[cfg(feature = "gpu")]
use crate::gpu::timing::Stopwatch;
use crate::scene::light::Lights;
use crate::scene::rays::Rays;
use crate::scene::surfaces::Surfaces;
#[cfg(feature = "gpu")]
use crate::technique::Executor;
#[cfg(feature = "gpu")]
use crate::technique::prepared::{Detail, Pass};
use crate::technique::rendered::NONE;
use crate::technique::setting::SEED;
use crate::technique::tables::BuiltIn;
use crate::technique::{Ability, Frame, Prepared, Progress, Rendered, Samples, Setting, Technique};

/// Layer of the configuration of the first light's first triangle.
pub const CONFIGURATION: &str = "configuration";
/// Layer of tests of visibility.
pub const TESTS: &str = "tests";
/// Layer of the visible share of the lights, from 0 to 1.
pub const FRACTION: &str = "fraction";
/// Layer of the error of that share.
pub const ERROR: &str = "error";

/// Area lights by search, as a technique.
#[derive(Debug)]
pub struct Entry;

/// Area lights by search.
pub static DISCONTINUITY: Entry = Entry;

impl Technique for Entry {
    fn name(&self) -> &'static str {
        "discontinuity"
    }

    fn doc(&self) -> &'static str {
        "light of polygons past anything, whose visible part is searched for by tests of visibility"
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        &TABLES
    }

    fn lights(&self) -> Lights {
        Lights::POLYGON
    }

    fn settings(&self) -> &'static [Setting] {
        const ALL: [Setting; 8] = [BOUNDARY_RAYS, SEED, TOLERANCE, GAP, SPACING, BULGES, COHERENCE, AGAINST];
        &ALL
    }

    fn abilities(&self) -> &'static [Ability] {
        &[Ability::Passes]
    }

    fn truth(&self) -> Option<&'static str> {
        Some(super::super::EXACT.name())
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Searched::new(frame)?))
    }
}

/// The truth about a pixel's lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Against {
    Nothing,
    Exact,
    Rays,
}

/// The machine that searches.
enum Machine<'s> {
    Cpu,
    #[cfg(feature = "gpu")]
    Gpu(Box<Searching<'s>>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'s std::convert::Infallible),
}

/// A frame under polygonal lights.
struct Searched<'s> {
    machine: Machine<'s>,
    lit: Arc<Lit>,
    rays: Arc<Rays>,
    options: Options,
    seed: u32,
    coherence: Coherence,
    against: Against,
}

impl<'s> Searched<'s> {
    fn new(frame: &Frame<'s>) -> Result<Self, Failure> {
        let settings = &frame.settings;
        // Rays meet balls and cones exactly, and so the surfaces of the frame, which are triangles, do not do.
        let rays = frame.shared("exact", || Ok(Rays::exact(frame.scene)))?;
        let lit = frame.shared("searched", || {
            let (width, height) = frame.size();
            let surfaces = Surfaces::new(frame.scene, &rays, width, height);
            Lit::of(frame, DISCONTINUITY.name())?.with_surfaces(Arc::new(surfaces))
        })?;
        let machine = match frame.on {
            // The shader knows no gloss.
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) if lit.glosses.iter().all(Option::is_none) => {
                Machine::Gpu(Box::new(Searching::new(gpu)?))
            }
            _ => Machine::Cpu,
        };
        Ok(Self {
            machine,
            lit,
            rays,
            options: Options {
                rays: settings.whole(&BOUNDARY_RAYS),
                tolerance: settings.number(&TOLERANCE),
                gap: settings.number(&GAP),
                spacing: settings.number(&SPACING),
                rule: if settings.word(&BULGES) == "chord" { Rule::Chord } else { Rule::Line },
            },
            seed: settings.whole(&SEED),
            coherence: match settings.word(&COHERENCE) {
                "checkerboard" => Coherence::Checkerboard,
                "none" => Coherence::None,
                _ => Coherence::Lines,
            },
            against: match settings.word(&AGAINST) {
                "exact" => Against::Exact,
                "rays" => Against::Rays,
                _ => Against::Nothing,
            },
        })
    }

    fn picture(&self) -> Picture<'_> {
        let Self { lit, rays, options, seed, .. } = self;
        Picture { lit, rays, options: *options, seed: *seed }
    }

    /// Returns whether a device lets pixels learn from their neighbours, which it does on a checkerboard.
    #[cfg(feature = "gpu")]
    fn learns(&self) -> bool {
        self.coherence != Coherence::None
    }

    fn pixels(&self, progress: &Progress<'_>) -> Result<Pixels, Failure> {
        match &self.machine {
            Machine::Cpu => self.picture().pixels(self.coherence, progress),
            #[cfg(feature = "gpu")]
            Machine::Gpu(searching) => {
                let picture = self.picture();
                let pixels = searching.pixels(&picture, &searching.place(&picture, self.learns())?);
                progress(u64::from(self.lit.surfaces.height));
                pixels
            }
            #[cfg(not(feature = "gpu"))]
            Machine::Never(never) => match **never {},
        }
    }

    fn truth(&self) -> Result<Option<Vec<f64>>, Failure> {
        match self.against {
            Against::Nothing => Ok(None),
            Against::Exact => fractions(&self.lit).map(Some),
            Against::Rays => Ok(Some(super::super::sampling::fractions(&self.lit, &self.rays))),
        }
    }
}

impl<'s> Prepared<'s> for Searched<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let pixels = self.pixels(progress)?;
        let rendered = self
            .lit
            .rendered(&pixels.received)
            .with(
                CONFIGURATION,
                Samples::Counts(pixels.configuration.iter().map(|found| found.unwrap_or(NONE)).collect()),
            )
            .with(TESTS, Samples::Counts(pixels.tests.iter().map(|tests| *tests as u32).collect()))
            .with(FRACTION, Samples::Numbers(pixels.fraction.iter().map(|fraction| *fraction as f32).collect()));
        let error = |truth: Vec<f64>| {
            let off = pixels.fraction.iter().zip(truth).map(|(found, truth)| (found - truth) as f32);
            Samples::Numbers(off.collect())
        };
        Ok(match self.truth()?.map(error) {
            Some(error) => rendered.with(ERROR, error),
            None => rendered,
        })
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(frame)?;
        Ok(())
    }

    #[cfg(feature = "gpu")]
    fn passes(&mut self, _: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let own = &*self;
        let name = DISCONTINUITY.name();
        Ok(vec![match &own.machine {
            Machine::Cpu => Pass::on_cpu(name, "light", move || own.pixels(&|_| {}).map(drop)),
            Machine::Gpu(searching) => {
                let placed = searching.place(&own.picture(), own.learns())?;
                Pass::new(name, "compute", None, move |stopwatch: &Stopwatch<'_>| searching.time(&placed, stopwatch))
            }
        }])
    }
}
