//! The integral expansions as a technique.

use std::sync::Arc;

use super::picture::{inputs, shade};
use super::seen::Seen;
use super::{NAME, Settings, Shaded, Tables, brute_force};
use crate::diag::Failure;
#[cfg(feature = "gpu")]
use crate::gpu::timing::Stopwatch;
use crate::scene::light::Lights;
#[cfg(feature = "gpu")]
use crate::technique::prepared::{Detail, Pass};
use crate::technique::rendered::LIGHT;
use crate::technique::setting::{Range, Value};
use crate::technique::tables::{self, BuiltIn};
use crate::technique::{Ability, Executor, Frame, Inputs, Prepared, Progress, Rendered, Samples, Setting, Technique};

/// [`Settings::border`]
pub const BORDER: Setting = Setting {
    name: "border_threshold",
    doc: "largest error of the border of visibility in a cell, in radians",
    default: Value::Number(Settings::DEFAULT.border),
    range: Range::Number(0.001, 10.0),
    label: "",
};

/// [`Settings::lobe`]
pub const LOBE: Setting = Setting {
    name: "lobe_threshold",
    doc: "largest error of a lobe in a cell, relative to its largest value",
    default: Value::Number(Settings::DEFAULT.lobe),
    range: Range::Number(0.001, 10.0),
    label: "",
};

/// [`Settings::depth`]
pub const DEPTH: Setting = Setting {
    name: "depth",
    doc: "most divisions of a cell of the base grid",
    default: Value::Whole(Settings::DEFAULT.depth),
    range: Range::Whole(0, 12),
    label: "",
};

/// Layer of the cells with a visible part.
pub const CELLS: &str = "cells";
/// Layer of the edges that were integrated.
pub const EDGES: &str = "edges";

static TABLES: [&BuiltIn; 2] = [&tables::DOUBLE_PRODUCT, &tables::SPHERICAL_GAUSSIAN];

/// The technique.
#[derive(Debug)]
pub struct Entry;

/// Integral expansions.
pub static INTEGRALS: Entry = Entry;

impl Technique for Entry {
    fn name(&self) -> &'static str {
        NAME
    }

    fn doc(&self) -> &'static str {
        "light of distant Gaussians by integral expansions, behind balls and flat polygons"
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        &TABLES
    }

    fn lights(&self) -> Lights {
        Lights::GAUSSIAN
    }

    fn settings(&self) -> &'static [Setting] {
        &[BORDER, LOBE, DEPTH]
    }

    fn abilities(&self) -> &'static [Ability] {
        &[Ability::Inputs, Ability::Passes]
    }

    fn truth(&self) -> Option<&'static str> {
        Some(brute_force::NAME)
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Integrals::new(frame)?))
    }
}

/// A frame whose tables are read and whose shader is compiled.
struct Integrals<'s> {
    shader: Shader<'s>,
    tables: Tables,
    seen: Arc<Seen>,
    settings: Settings,
}

/// The machine that divides the directions and evaluates the tables.
enum Shader<'s> {
    /// The batch interpreter, and plain Rust around it.
    Interpreter,
    #[cfg(feature = "gpu")]
    Gpu(Box<super::gpu::LightPipeline<'s>>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'s std::convert::Infallible),
}

fn settings(frame: &Frame<'_>) -> Settings {
    Settings {
        border: frame.settings.number(&BORDER),
        lobe: frame.settings.number(&LOBE),
        depth: frame.settings.whole(&DEPTH),
    }
}

impl<'s> Integrals<'s> {
    fn new(frame: &Frame<'s>) -> Result<Self, Failure> {
        let (tables, seen) = (Tables::new()?, Seen::of(frame)?);
        let shader = match frame.on {
            Executor::Cpu => Shader::Interpreter,
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) => {
                Shader::Gpu(Box::new(super::gpu::LightPipeline::new(gpu, &tables, &seen.surroundings)?))
            }
        };
        Ok(Self { shader, tables, seen, settings: settings(frame) })
    }

    fn shade(&self) -> Result<Shaded, Failure> {
        let Seen { surroundings, surfaces, .. } = &*self.seen;
        match &self.shader {
            Shader::Interpreter => shade(surroundings, &self.tables, &self.settings, surfaces),
            #[cfg(feature = "gpu")]
            Shader::Gpu(pipeline) => pipeline.shade(surroundings, &self.settings, surfaces),
            #[cfg(not(feature = "gpu"))]
            Shader::Never(never) => match **never {},
        }
    }
}

impl<'s> Prepared<'s> for Integrals<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let Shaded { light, cells, edges } = self.shade()?;
        progress(u64::from(self.seen.height));
        Ok(Rendered::default()
            .with(LIGHT, self.seen.layer(light))
            .with(CELLS, Samples::Counts(cells))
            .with(EDGES, Samples::Counts(edges)))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        let seen = Seen::of(frame)?;
        let fits = match &self.shader {
            Shader::Interpreter => true,
            #[cfg(feature = "gpu")]
            Shader::Gpu(pipeline) => pipeline.fits(&seen.surroundings),
            #[cfg(not(feature = "gpu"))]
            Shader::Never(never) => match **never {},
        };
        if fits {
            (self.seen, self.settings) = (seen, settings(frame));
        } else {
            *self = Self::new(frame)?;
        }
        Ok(())
    }

    fn inputs(&mut self) -> Result<Vec<Inputs<'s>>, Failure> {
        inputs(&self.seen.surroundings, &self.tables, &self.settings, &self.seen.surfaces)
    }

    #[cfg(feature = "gpu")]
    fn passes(&mut self, _: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let Seen { surroundings, surfaces, .. } = &*self.seen;
        Ok(vec![match &self.shader {
            Shader::Interpreter => Pass::on_cpu(NAME, "light", || self.shade().map(drop)),
            Shader::Gpu(pipeline) => {
                let portions = pipeline.bind(surroundings, &self.settings, surfaces)?;
                let time =
                    move |stopwatch: &Stopwatch<'_>| portions.iter().map(|one| pipeline.time(one, stopwatch)).sum();
                Pass::new(NAME, "compute", None, time)
            }
        }])
    }
}
