//! The variants on a GPU, behind the interface of techniques.

use std::sync::Arc;

use super::gpu::{GpuFrame, Output, Passes, Shader, Skeleton};
use super::settings::{PLAN, settings};
use super::shadow::{Shadow, inputs, layers};
use super::{Settings, Variant};
use crate::diag::Failure;
use crate::gpu::Gpu;
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::prove::Proved;
use crate::technique::prepared::{Costs, Detail, Pass};
use crate::technique::rendered::{READS, STEPS};
use crate::technique::{Frame, Inputs, Prepared, Progress, Rendered, Samples};

/// A variant as shaders.
pub(super) struct OnGpu<'s> {
    gpu: &'s Gpu,
    variant: Variant,
    table: Option<Planned<'s>>,
    record: Shader<'s>,
    /// Made when they are asked for first.
    count: Option<Shader<'s>>,
    timed: Vec<(&'static str, Skeleton, [Shader<'s>; 2])>,
    shadow: Arc<Shadow>,
    frame: Arc<GpuFrame>,
    settings: Settings,
}

/// The plan of a table.
enum Planned<'s> {
    /// Made here, with this shape.
    Own(Shape, Box<Proved<'s>>),
    /// Given with the frame.
    Given(&'s Proved<'s>),
}

impl<'s> Planned<'s> {
    fn of(variant: Variant, frame: &Frame<'s>) -> Result<Option<Self>, Failure> {
        let Some(table) = variant.table() else { return Ok(None) };
        if let Some(given) = frame.plans.iter().find(|proved| proved.plan().program.name == table.name) {
            return Ok(Some(Self::Given(given)));
        }
        let shape = frame.settings.plan(&PLAN);
        let proved = Plan::proved(frame.program(table)?, shape)?;
        Ok(Some(Self::Own(shape, Box::new(proved))))
    }

    fn proved(&self) -> &Proved<'s> {
        match self {
            Self::Own(_, proved) => proved,
            Self::Given(proved) => proved,
        }
    }

    fn program(&self) -> &'s Program {
        self.proved().plan().program
    }

    /// Returns whether the plan is the one that a frame asks for.
    fn fits(&self, variant: Variant, frame: &Frame<'s>) -> Result<bool, Failure> {
        let Some(table) = variant.table() else { return Ok(false) };
        Ok(match self {
            Self::Given(proved) => frame.plans.iter().any(|given| std::ptr::eq(*given, *proved)),
            Self::Own(shape, _) => {
                frame.plans.iter().all(|given| given.plan().program.name != table.name)
                    && frame.settings.plan(&PLAN) == *shape
                    && std::ptr::eq(frame.program(table)?, self.program())
            }
        })
    }
}

impl<'s> OnGpu<'s> {
    pub(super) fn new(variant: Variant, gpu: &'s Gpu, frame: &Frame<'s>) -> Result<Self, Failure> {
        let table = Planned::of(variant, frame)?;
        let proved = table.as_ref().map(Planned::proved);
        let record = Shader::new(gpu, variant, proved, Skeleton::EXACT, Output::Record)?;
        let (shadow, on_device) = Self::bind(variant, gpu, frame)?;
        Ok(Self {
            gpu,
            variant,
            table,
            record,
            count: None,
            timed: Vec::new(),
            shadow,
            frame: on_device,
            settings: settings(frame),
        })
    }

    /// The map and the receivers, here and on the device.
    fn bind(variant: Variant, gpu: &Gpu, frame: &Frame<'s>) -> Result<(Arc<Shadow>, Arc<GpuFrame>), Failure> {
        let shadow = Shadow::of(frame, variant)?;
        let on_device = frame.shared(Shadow::key(frame), || GpuFrame::new(gpu, &shadow.map, &shadow.receivers))?;
        Ok((shadow, on_device))
    }

    fn shader(&self, variant: Variant, skeleton: Skeleton, output: Output) -> Result<Shader<'s>, Failure> {
        let proved = self.table.as_ref().map(Planned::proved);
        Shader::new(self.gpu, variant, proved, skeleton, output)
    }

    /// The names and skeletons of the passes that are measured: first the one that is used.
    fn skeletons(&self, detail: Detail) -> Vec<(&'static str, Skeleton)> {
        let name = self.variant.name();
        let one_pass = Skeleton { passes: Passes::One, ..Skeleton::FAST };
        let used = match self.variant {
            Variant::Hard | Variant::Pcf => one_pass,
            Variant::Smsr | Variant::Rsmss | Variant::Rpcf => Skeleton::FAST,
            Variant::CaseFree => Skeleton::PUBLISHED,
        };
        match (self.variant, detail) {
            (Variant::Rsmss, Detail::Variants) => {
                vec![(name, used), ("rsmss_one_pass", one_pass), ("rsmss_2015", Skeleton::PUBLISHED)]
            }
            _ => vec![(name, used)],
        }
    }
}

/// The kinds of passes that are measured.
const PASSES: [Output; 2] = [Output::Compute, Output::Fragment];

impl<'s> Prepared<'s> for OnGpu<'s> {
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure> {
        let (visibility, costs) = self.record.record(&self.frame, &self.settings)?;
        progress(u64::from(self.shadow.receivers.height));
        let rendered = layers(visibility, self.table.is_some());
        Ok(rendered.with(READS, Samples::Counts(costs.reads)).with(STEPS, Samples::Counts(costs.steps)))
    }

    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure> {
        let fits = match &self.table {
            Some(table) => table.fits(self.variant, frame)?,
            None => true,
        };
        if !fits {
            *self = Self::new(self.variant, self.gpu, frame)?;
            return Ok(());
        }
        (self.shadow, self.frame) = Self::bind(self.variant, self.gpu, frame)?;
        self.settings = settings(frame);
        Ok(())
    }

    fn table(&self) -> Option<&'s Program> {
        self.table.as_ref().map(Planned::program)
    }

    fn inputs(&mut self) -> Result<Vec<Inputs<'s>>, Failure> {
        let program = self.table().map(|program| inputs(program, &self.shadow, &self.settings));
        program.unwrap_or_else(|| Ok(Vec::new()))
    }

    fn counts(&mut self) -> Result<Option<Vec<u64>>, Failure> {
        if self.table.is_none() {
            return Ok(None);
        }
        if self.count.is_none() {
            // What rpcf filters is what rsmss gives, and one evaluation is counted per pixel.
            let counted = if self.variant == Variant::Rpcf { Variant::Rsmss } else { self.variant };
            self.count = Some(self.shader(counted, Skeleton::EXACT, Output::Count)?);
        }
        self.count.as_ref().map(|shader| shader.counts(&self.frame, &self.settings)).transpose()
    }

    fn passes(&mut self, detail: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        for (name, skeleton) in self.skeletons(detail) {
            if !self.timed.iter().any(|(known, ..)| *known == name) {
                let [compute, fragment] = PASSES.map(|output| self.shader(self.variant, skeleton, output));
                self.timed.push((name, skeleton, [compute?, fragment?]));
            }
        }
        let mut passes = Vec::new();
        for (name, skeleton, shaders) in &self.timed {
            let costs = match detail {
                Detail::Plain => None,
                Detail::Variants => {
                    let record = self.shader(self.variant, *skeleton, Output::Record)?;
                    let (_, costs) = record.record(&self.frame, &self.settings)?;
                    Some(Costs::new(&costs.reads, &costs.steps, self.shadow.receivers.width as usize))
                }
            };
            for (output, shader) in PASSES.into_iter().zip(shaders) {
                let bound = shader.bind(&self.frame, &self.settings)?;
                passes.push(Pass::new(name, output.name(), costs, move |stopwatch| bound.time(stopwatch)));
            }
        }
        Ok(passes)
    }
}
