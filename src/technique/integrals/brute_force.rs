//! The truth of the integrals: sums over so many directions that more change little.

use std::sync::Arc;

use rayon::prelude::*;

use super::picture::{brute_force, directions};
use super::seen::Seen;
use crate::diag::Failure;
use crate::scene::light::Lights;
use crate::technique::rendered::LIGHT;
use crate::technique::setting::{Range, Value};
use crate::technique::tables::BuiltIn;
use crate::technique::{Ability, Frame, Prepared, Progress, Rendered, Setting, Technique};

/// The technique's name.
pub(super) const NAME: &str = "brute_force";

/// The fineness of the sum.
pub const DIRECTIONS: Setting = Setting {
    name: "directions",
    doc: "directions from pole to pole of a sum; twice as many go around",
    default: Value::Whole(128),
    range: Range::Whole(4, 2048),
    label: "",
};

/// The technique.
#[derive(Debug)]
pub struct BruteForce;

/// Sums over directions.
pub static BRUTE_FORCE: BruteForce = BruteForce;

impl Technique for BruteForce {
    fn name(&self) -> &'static str {
        NAME
    }

    fn doc(&self) -> &'static str {
        "light of distant Gaussians by a sum over directions, on the CPU: the truth of integrals"
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        &[]
    }

    fn lights(&self) -> Lights {
        Lights::GAUSSIAN
    }

    fn settings(&self) -> &'static [Setting] {
        &[DIRECTIONS]
    }

    fn abilities(&self) -> &'static [Ability] {
        &[]
    }

    fn truth(&self) -> Option<&'static str> {
        None
    }

    fn needs_device(&self) -> bool {
        false
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Sums::new(frame)?))
    }
}

/// A frame and the fineness of its sums.
struct Sums {
    seen: Arc<Seen>,
    fineness: u32,
}

impl Sums {
    fn new(frame: &Frame<'_>) -> Result<Self, Failure> {
        Ok(Self { seen: Seen::of(frame)?, fineness: frame.settings.whole(&DIRECTIONS) })
    }
}

impl<'s> Prepared<'s> for Sums {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let Seen { surroundings, surfaces, .. } = &*self.seen;
        let directions = directions(&surroundings.lobes, self.fineness);
        let width = surfaces.len().div_ceil(self.seen.height.max(1) as usize).max(1);
        let rows = surfaces.par_chunks(width).flat_map_iter(|row| {
            let light = |surface| brute_force(surroundings, surface, &directions);
            let row: Vec<_> = row.iter().map(|surface| surface.as_ref().map(light)).collect();
            progress(1);
            row
        });
        Ok(Rendered::default().with(LIGHT, self.seen.layer(rows.collect())))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(frame)?;
        Ok(())
    }
}
