//! The plans in the pass that they are for: whole shaders, on frames of scenes.
//!
//! A table is a small part of a shader that also walks and reads. Whether the
//! plan that was chosen by itself is a good choice there is measured on the real
//! shadow pass, both as a compute and as a fragment pass.

use super::Measured;
use crate::diag::{Diagnostic, Failure, codes};
use crate::gpu::Gpu;
use crate::gpu::timing::{Protocol, Stopwatch, Times, interleaved};
use crate::program::Program;
use crate::technique::revectorise::gpu::{GpuFrame, Output, Shader, Skeleton};
use crate::technique::revectorise::{Settings, Technique};

/// The kinds of passes.
const PASSES: [Output; 2] = [Output::Compute, Output::Fragment];

/// A frame to measure on.
#[derive(Debug)]
pub struct Frame {
    /// The scene, and its sizes, in words.
    pub name: String,
    /// On the device.
    pub frame: GpuFrame,
}

/// What was measured of a frame, in one kind of pass.
#[derive(Debug, Clone)]
pub struct Whole {
    /// The scene, and its sizes, in words.
    pub frame: String,
    /// The kind of pass.
    pub pass: Output,
    /// Times of the whole pass, in the order of the plans.
    pub times: Vec<Times>,
}

impl Whole {
    /// The time with a plan relative to the ladder as written.
    pub fn vs_ladder(&self, plan: usize) -> f64 {
        self.times[plan].median() / self.times[0].median()
    }

    /// Whether the time with a plan differs from that with another by more than noise.
    pub fn differs(&self, plan: usize, other: usize) -> bool {
        self.times[plan].differs_from(&self.times[other])
    }

    /// The plans with which the pass is faster than with the chosen one by more than noise.
    pub fn faster_than(&self, chosen: usize) -> Vec<usize> {
        let better =
            |plan: &usize| self.times[*plan].median() < self.times[chosen].median() && self.differs(*plan, chosen);
        (0..self.times.len()).filter(better).collect()
    }
}

/// The technique whose pass a table is for.
///
/// # Errors
/// When no renderer evaluates the table.
pub fn technique(program: &Program) -> Result<Technique, Failure> {
    let found = [Technique::Smsr, Technique::Rsmss].into_iter().find(|one| one.table() == Some(program.name.as_str()));
    found.ok_or_else(|| {
        let message = format!("no shadow pass evaluates the table `{}`", program.name);
        let error = Diagnostic::error(codes::NOT_APPLICABLE, message);
        Failure::new(program.source.clone(), error.help("whole shaders are measured of the tables smsr and rsmss"))
    })
}

/// Measures the pass with every plan in turn, frame by frame.
///
/// # Errors
/// When the device refuses a shader, or fails.
pub fn whole(
    gpu: &Gpu,
    program: &Program,
    plans: &[Measured<'_>],
    frames: &[Frame],
    watch: &Stopwatch<'_>,
    protocol: Protocol,
) -> Result<Vec<Whole>, Failure> {
    let technique = technique(program)?;
    let settings = Settings::default();
    let mut shaders = Vec::new();
    for output in PASSES {
        for plan in plans {
            shaders.push(Shader::new(gpu, technique, Some(&plan.proved), Skeleton::FAST, output)?);
        }
    }
    let mut measured = Vec::new();
    for Frame { name, frame } in frames {
        let bound: Result<Vec<_>, Failure> = shaders.iter().map(|shader| shader.bind(frame, &settings)).collect();
        let bound = bound?;
        let mut times = interleaved(protocol, bound.len(), |index| bound[index].time(watch))?;
        let fragment = times.split_off(plans.len());
        for (output, times) in PASSES.into_iter().zip([times, fragment]) {
            measured.push(Whole { frame: name.clone(), pass: output, times });
        }
    }
    Ok(measured)
}
