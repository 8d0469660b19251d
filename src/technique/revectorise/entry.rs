//! The variants as techniques: settings, and what is compiled once for a frame.

use std::sync::Arc;

use super::stage::{Bias, Stage};
use super::{Receivers, Settings, ShadowMap, Variant, Visibility, cpu};
use crate::diag::Failure;
use crate::program::Program;
use crate::scene::light::Lights;
use crate::technique::rendered::{CASE, STATE, VALUE};
use crate::technique::setting::{Range, Value};
use crate::technique::tables::{self, BuiltIn};
use crate::technique::{
    Ability, Executor, Frame, Inputs, Prepared, Progress, Rendered, Samples, Setting, Technique, reference,
};

/// Largest side of a shadow map.
pub const MAX_MAP: u32 = 16384;

/// Texels per side of the shadow map.
pub const SHADOW_MAP: Setting = Setting {
    name: "shadow_map",
    doc: "texels per side of the shadow map",
    default: Value::Whole(1024),
    range: Range::Whole(1, MAX_MAP),
    label: "map",
};

/// [`Bias::constant`]
pub const BIAS: Setting = Setting {
    name: "bias",
    doc: "depth bias, in units of 2^-22 of the light's range",
    default: Value::Number(Bias::DEFAULT.constant as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Bias::slope`]
pub const SLOPE_BIAS: Setting = Setting {
    name: "slope_bias",
    doc: "depth bias, times the slope of the surface",
    default: Value::Number(Bias::DEFAULT.slope as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Settings::search_limit`]
pub const SEARCH_LIMIT: Setting = Setting {
    name: "search_limit",
    doc: "longest run that is revectorised, in texels",
    default: Value::Whole(Settings::DEFAULT.search_limit),
    range: Range::Whole(1, 4096),
    label: "search limit",
};

/// [`Settings::walk_bias`]
pub const WALK_BIAS: Setting = Setting {
    name: "walk_bias",
    doc: "depth bias along walks, as a share of the light's range",
    default: Value::Number(Settings::DEFAULT.walk_bias as f64),
    range: Range::Number(0.0, 1e6),
    label: "",
};

/// [`Settings::pcf`]
pub const PCF_KERNEL: Setting = Setting {
    name: "pcf",
    doc: "side of the kernel, in texels",
    default: Value::Whole(Settings::DEFAULT.pcf),
    range: Range::Odd(1, 31),
    label: "",
};

/// The code shape of the table on a GPU.
pub const PLAN: Setting = Setting {
    name: "plan",
    doc: "code shape of the table on a GPU",
    default: Value::Plan(crate::plan::Shape::Ladder),
    range: Range::Plan,
    label: "",
};

/// A variant as a technique.
#[derive(Debug)]
pub struct Entry {
    variant: Variant,
    doc: &'static str,
    tables: &'static [&'static BuiltIn],
    settings: &'static [Setting],
    abilities: &'static [Ability],
}

/// Of a variant that evaluates a table at each pixel.
const OF_TABLE: &[Ability] = &[Ability::Cases, Ability::Inputs, Ability::Passes, Ability::Plans];

/// One depth test per pixel.
pub static HARD: Entry = Entry {
    variant: Variant::Hard,
    doc: "one depth test: jagged where texels are large",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS],
    abilities: &[Ability::Passes],
};

/// Percentage-closer filtering.
pub static PCF: Entry = Entry {
    variant: Variant::Pcf,
    doc: "percentage-closer filtering: the mean of n x n depth tests",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, PCF_KERNEL],
    abilities: &[Ability::Passes],
};

/// Silhouette revectorisation.
pub static SMSR: Entry = Entry {
    variant: Variant::Smsr,
    doc: "silhouette revectorisation: the staircase becomes a line",
    tables: &[&tables::SMSR],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, SEARCH_LIMIT, WALK_BIAS, PLAN],
    abilities: OF_TABLE,
};

/// Revectorised soft silhouettes.
pub static RSMSS: Entry = Entry {
    variant: Variant::Rsmss,
    doc: "revectorised soft silhouettes: the line, antialiased",
    tables: &[&tables::RSMSS],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, SEARCH_LIMIT, WALK_BIAS, PLAN],
    abilities: OF_TABLE,
};

/// Revectorisation, then filtering.
pub static RPCF: Entry = Entry {
    variant: Variant::Rpcf,
    doc: "the mean of n x n results of rsmss",
    tables: &[&tables::RSMSS],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, SEARCH_LIMIT, WALK_BIAS, PCF_KERNEL, PLAN],
    abilities: &[Ability::Cases, Ability::Inputs, Ability::Passes],
};

/// The formulation without cases.
pub static CASE_FREE: Entry = Entry {
    variant: Variant::CaseFree,
    doc: "the filtered formulation without cases that the authors published later",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, SEARCH_LIMIT, WALK_BIAS],
    abilities: &[Ability::Passes],
};

impl Technique for Entry {
    fn name(&self) -> &'static str {
        self.variant.name()
    }

    fn doc(&self) -> &'static str {
        self.doc
    }

    fn tables(&self) -> &'static [&'static BuiltIn] {
        self.tables
    }

    fn lights(&self) -> Lights {
        Lights::PUNCTUAL
    }

    fn settings(&self) -> &'static [Setting] {
        self.settings
    }

    fn abilities(&self) -> &'static [Ability] {
        self.abilities
    }

    fn truth(&self) -> Option<&'static str> {
        Some(reference::NAME)
    }

    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        match frame.on {
            Executor::Cpu => Ok(Box::new(OnCpu::new(self.variant, frame)?)),
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) => Ok(Box::new(super::device::OnGpu::new(self.variant, gpu, frame)?)),
        }
    }
}

/// A frame as seen by the variants: the light's depths, and where the camera's surfaces lie in them.
#[derive(Debug)]
pub(super) struct Shadow {
    pub(super) map: ShadowMap,
    pub(super) receivers: Receivers,
}

impl Shadow {
    /// The key of what is made for a frame's settings.
    pub(super) fn key(frame: &Frame<'_>) -> (u32, [u32; 2], bool) {
        let Bias { constant, slope } = bias(frame);
        (frame.settings.whole(&SHADOW_MAP), [constant, slope].map(f32::to_bits), frame.by_rays)
    }

    /// The shadow map and the receivers of a frame, made once for all variants.
    pub(super) fn of(frame: &Frame<'_>) -> Result<Arc<Self>, Failure> {
        frame.shared(Self::key(frame), || {
            let stage = Stage::with_rays(frame.scene, Arc::clone(&frame.rays))?;
            let size = frame.settings.whole(&SHADOW_MAP);
            let map = match frame.on {
                #[cfg(feature = "gpu")]
                Executor::Gpu(gpu) if !frame.by_rays => {
                    super::gpu::Raster::new(gpu, &stage)?.shadow_map(size, bias(frame))?
                }
                #[cfg(feature = "gpu")]
                Executor::Gpu(_) => stage.shadow_map(size, bias(frame)),
                Executor::Cpu => stage.shadow_map(size, bias(frame)),
            };
            Ok(Self { map, receivers: stage.receivers(&frame.surfaces, size) })
        })
    }
}

fn bias(frame: &Frame<'_>) -> Bias {
    let [constant, slope] = [&BIAS, &SLOPE_BIAS].map(|setting| frame.settings.number(setting) as f32);
    Bias { constant, slope }
}

/// How variants search and filter in a frame.
pub(super) fn settings(frame: &Frame<'_>) -> Settings {
    Settings {
        search_limit: frame.settings.whole(&SEARCH_LIMIT),
        walk_bias: frame.settings.number(&WALK_BIAS) as f32,
        pcf: frame.settings.whole(&PCF_KERNEL),
    }
}

/// Visibility as layers. Those of cases are there if a table was evaluated.
pub(super) fn layers(visibility: Visibility, has_table: bool) -> Rendered {
    let rendered = Rendered::default().with(VALUE, Samples::Numbers(visibility.value));
    if !has_table {
        return rendered;
    }
    rendered.with(CASE, Samples::Counts(visibility.case)).with(STATE, Samples::Counts(visibility.state))
}

/// The inputs of a table in every pixel that asks it, found by the search on the CPU.
pub(super) fn inputs<'s>(
    program: &'s Program,
    shadow: &Shadow,
    settings: &Settings,
) -> Result<Vec<Inputs<'s>>, Failure> {
    let query = cpu::Query { map: &shadow.map, receivers: &shadow.receivers, settings };
    let cpu::Evaluations { columns, pixels } = cpu::evaluations(program, query)?;
    Ok(vec![Inputs { program, columns, pixels }])
}

/// A variant by the interpreter.
struct OnCpu<'s> {
    variant: Variant,
    program: Option<&'s Program>,
    shadow: Arc<Shadow>,
    settings: Settings,
}

impl<'s> OnCpu<'s> {
    fn new(variant: Variant, frame: &Frame<'s>) -> Result<Self, Failure> {
        let program = variant.table().map(|table| frame.program(table)).transpose()?;
        Ok(Self { variant, program, shadow: Shadow::of(frame)?, settings: settings(frame) })
    }
}

impl<'s> Prepared<'s> for OnCpu<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let Shadow { map, receivers } = &*self.shadow;
        let query = cpu::Query { map, receivers, settings: &self.settings };
        Ok(layers(cpu::visibility(self.variant, self.program, query, progress)?, self.program.is_some()))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(self.variant, frame)?;
        Ok(())
    }

    fn table(&self) -> Option<&'s Program> {
        self.program
    }

    fn inputs(&mut self) -> Result<Vec<Inputs<'s>>, Failure> {
        let program = self.program.map(|program| inputs(program, &self.shadow, &self.settings));
        program.unwrap_or_else(|| Ok(Vec::new()))
    }
}
