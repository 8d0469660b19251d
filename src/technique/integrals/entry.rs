//! The integral expansions as a technique.

use std::sync::Arc;

use super::picture::shade;
use super::{NAME, Settings, Shaded, Surface, Surroundings, Tables};
use crate::diag::Failure;
use crate::scene::light::Lights;
use crate::scene::rays::Rays;
use crate::scene::surfaces::Surfaces;
use crate::technique::rendered::LIGHT;
use crate::technique::setting::{Range, Value};
use crate::technique::tables::{self, BuiltIn};
use crate::technique::{Ability, Executor, Frame, Prepared, Progress, Rendered, Samples, Setting, Technique};

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
        &[]
    }

    fn truth(&self) -> Option<&'static str> {
        None
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        Ok(Box::new(Integrals::new(frame)?))
    }
}

/// A frame whose tables are read and whose shader is compiled.
struct Integrals<'s> {
    shader: Shader<'s>,
    tables: Tables,
    surroundings: Surroundings,
    surfaces: Vec<Option<Surface>>,
    background: [f32; 3],
    height: u32,
    settings: Settings,
}

/// What divides the directions and evaluates the tables.
enum Shader<'s> {
    /// The batch interpreter, and plain Rust around it.
    Interpreter,
    #[cfg(feature = "gpu")]
    Gpu(super::gpu::LightPipeline<'s>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'s std::convert::Infallible),
}

impl<'s> Integrals<'s> {
    fn new(frame: &Frame<'s>) -> Result<Self, Failure> {
        let tables = Tables::new()?;
        let surroundings = Surroundings::new(frame.scene)?;
        let shader = match frame.on {
            Executor::Cpu => Shader::Interpreter,
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) => Shader::Gpu(super::gpu::LightPipeline::new(gpu, &tables, &surroundings)?),
        };
        // Balls are traced exactly, so the surfaces of the frame, which are triangles, do not do.
        let rays: Arc<Rays> = frame.shared("exact", || Ok(Rays::exact(frame.scene)))?;
        let (width, height) = frame.size();
        let surfaces = surroundings.surfaces(&rays, &Surfaces::new(frame.scene, &rays, width, height));
        let settings = Settings {
            border: frame.settings.number(&BORDER),
            lobe: frame.settings.number(&LOBE),
            depth: frame.settings.whole(&DEPTH),
        };
        let background = frame.scene.background.map(|channel| channel as f32);
        Ok(Self { shader, tables, surroundings, surfaces, background, height, settings })
    }
}

impl<'s> Prepared<'s> for Integrals<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let Shaded { light, cells, edges } = match &self.shader {
            Shader::Interpreter => shade(&self.surroundings, &self.tables, &self.settings, &self.surfaces)?,
            #[cfg(feature = "gpu")]
            Shader::Gpu(pipeline) => pipeline.shade(&self.surroundings, &self.settings, &self.surfaces)?,
            #[cfg(not(feature = "gpu"))]
            Shader::Never(never) => match **never {},
        };
        progress(u64::from(self.height));
        let colour = |light: Option<glam::DVec3>| light.map_or(self.background, |light| light.as_vec3().to_array());
        Ok(Rendered::default()
            .with(LIGHT, Samples::Colours(light.into_iter().map(colour).collect()))
            .with(CELLS, Samples::Counts(cells))
            .with(EDGES, Samples::Counts(edges)))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(frame)?;
        Ok(())
    }
}
