//! Which machine evaluates a technique: the interpreter on the CPU, or the compiled table on a GPU.

#[cfg(feature = "gpu")]
use super::revectorise::gpu;
use super::revectorise::stage::{Bias, Stage};
use super::revectorise::{Receivers, Settings, ShadowMap, Technique, Visibility, cpu};
use crate::diag::Failure;
#[cfg(feature = "gpu")]
use crate::gpu::Gpu;
#[cfg(feature = "gpu")]
use crate::plan::{Plan, Shape};

/// Evaluates techniques.
#[derive(Debug)]
pub enum Executor {
    /// In plain Rust, with the interpreter.
    Cpu,
    /// As a shader, with the table compiled as a ladder.
    #[cfg(feature = "gpu")]
    Gpu(Box<Gpu>),
}

impl Executor {
    /// What the light sees: by rays on the CPU, by a depth pass on a GPU. They differ at borders of triangles only.
    ///
    /// # Errors
    /// When the map is beyond the device's limits, or the device fails.
    pub fn shadow_map(&self, stage: &Stage<'_>, size: u32, bias: Bias) -> Result<ShadowMap, Failure> {
        match self {
            Executor::Cpu => Ok(stage.shadow_map(size, bias)),
            #[cfg(feature = "gpu")]
            Executor::Gpu(device) => gpu::Raster::new(device, stage)?.shadow_map(size, bias),
        }
    }

    /// The visibility of every pixel. `done` is told about every row that the CPU has finished.
    ///
    /// # Errors
    /// When the frame is beyond the device's limits, or the device fails.
    pub fn visibility(
        &self,
        technique: Technique,
        map: &ShadowMap,
        receivers: &Receivers,
        settings: &Settings,
        done: &(dyn Fn(u64) + Sync),
    ) -> Result<Visibility, Failure> {
        let program = cpu::table(technique)?;
        match self {
            Executor::Cpu => {
                cpu::visibility(technique, program.as_ref(), cpu::Frame { map, receivers, settings }, done)
            }
            #[cfg(feature = "gpu")]
            Executor::Gpu(device) => {
                let proved = program.as_ref().map(|program| Plan::proved(program, Shape::Ladder)).transpose()?;
                let visibility = gpu::visibility(device, technique, proved.as_ref(), map, receivers, settings)?;
                done(u64::from(receivers.height));
                Ok(visibility)
            }
        }
    }

    /// What it runs on, in words.
    pub fn describe(&self) -> String {
        match self {
            Executor::Cpu => "CPU".to_owned(),
            #[cfg(feature = "gpu")]
            Executor::Gpu(device) => device.describe(),
        }
    }
}
