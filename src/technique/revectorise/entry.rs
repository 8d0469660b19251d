//! The variants as techniques: entries of the registry, and the executor that interprets.

#[cfg(feature = "gpu")]
use std::rc::Rc;
use std::sync::Arc;

#[cfg(feature = "gpu")]
use super::settings::bias;
use super::settings::{BIAS, PCF_KERNEL, PLAN, SEARCH_LIMIT, SHADOW_MAP, SLOPE_BIAS, WALK_BIAS, settings};
use super::shadow::{Shadow, inputs, layers};
#[cfg(feature = "gpu")]
use super::stage::Stage;
use super::{Variant, Visibility, cpu};
use crate::diag::Failure;
use crate::program::Program;
use crate::scene::light::Lights;
#[cfg(feature = "gpu")]
use crate::technique::prepared::{Detail, Pass};
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
const OF_TABLE: &[Ability] = &[Ability::Visibility, Ability::Cases, Ability::Inputs, Ability::Passes, Ability::Plans];

/// One depth test per pixel.
pub static HARD: Entry = Entry {
    variant: Variant::Hard,
    doc: "one depth test: jagged where texels are large",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS],
    abilities: &[Ability::Visibility, Ability::Passes],
};

/// Percentage-closer filtering.
pub static PCF: Entry = Entry {
    variant: Variant::Pcf,
    doc: "percentage-closer filtering: the mean of n x n depth tests",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, PCF_KERNEL],
    abilities: &[Ability::Visibility, Ability::Passes],
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
    abilities: &[Ability::Visibility, Ability::Cases, Ability::Inputs, Ability::Passes],
};

/// The formulation without cases.
pub static CASE_FREE: Entry = Entry {
    variant: Variant::CaseFree,
    doc: "the filtered formulation without cases that the authors published later",
    tables: &[],
    settings: &[SHADOW_MAP, BIAS, SLOPE_BIAS, SEARCH_LIMIT, WALK_BIAS],
    abilities: &[Ability::Visibility, Ability::Passes],
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
    frame: Frame<'s>,
    shadow: Arc<Shadow>,
}

impl<'s> OnCpu<'s> {
    fn new(variant: Variant, frame: &Frame<'s>) -> Result<Self, Failure> {
        let program = variant.table().map(|table| frame.program(table)).transpose()?;
        let shadow = Shadow::of(frame, variant)?;
        Ok(Self { variant, program, frame: frame.clone(), shadow })
    }

    fn visibility(&self, progress: &Progress<'_>) -> Result<Visibility, Failure> {
        let Shadow { map, receivers } = &*self.shadow;
        let query = cpu::Query { map, receivers, settings: &settings(&self.frame) };
        cpu::visibility(self.variant, self.program, query, progress)
    }
}

impl<'s> Prepared<'s> for OnCpu<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        Ok(layers(self.visibility(progress)?, self.program.is_some()))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        *self = Self::new(self.variant, frame)?;
        Ok(())
    }

    fn table(&self) -> Option<&'s Program> {
        self.program
    }

    fn inputs(&mut self) -> Result<Vec<Inputs<'s>>, Failure> {
        let program = self.program.map(|program| inputs(program, &self.shadow, &settings(&self.frame)));
        program.unwrap_or_else(|| Ok(Vec::new()))
    }

    #[cfg(feature = "gpu")]
    fn passes(&mut self, _: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let name = self.variant.name();
        let stage = Rc::new(Stage::with_rays(self.frame.scene, Arc::clone(&self.frame.rays), name)?);
        let (size, bias) = (self.frame.settings.whole(&SHADOW_MAP), bias(&self.frame));
        let (seen_by_light, surfaces) = (Rc::clone(&stage), &self.frame.surfaces);
        let shadow_map = move || {
            seen_by_light.shadow_map(size, bias);
            Ok(())
        };
        let receivers = move || {
            stage.receivers(surfaces, size);
            Ok(())
        };
        Ok(vec![
            Pass::on_cpu(name, "shadow map", shadow_map),
            Pass::on_cpu(name, "receivers", receivers),
            Pass::on_cpu(name, "visibility", || self.visibility(&|_| {}).map(drop)),
        ])
    }
}
