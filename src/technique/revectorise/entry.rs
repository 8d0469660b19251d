//! The variants as techniques: entries of the registry, and the executor that interprets.

use std::sync::Arc;

use super::settings::{BIAS, PCF_KERNEL, PLAN, SEARCH_LIMIT, SHADOW_MAP, SLOPE_BIAS, WALK_BIAS, settings};
use super::shadow::{Shadow, inputs, layers};
use super::{Settings, Variant, cpu};
use crate::diag::Failure;
use crate::program::Program;
use crate::scene::light::Lights;
use crate::technique::tables::{self, BuiltIn};
use crate::technique::{Ability, Executor, Frame, Inputs, Prepared, Progress, Rendered, Setting, Technique, reference};

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
