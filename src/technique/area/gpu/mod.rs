//! Peeling on a GPU: lights, bodies and points go there, light comes back.
//!
//! The shader has bounded memory. What needs more is computed by the host, exactly.

mod pictures;
mod points;
pub(super) mod world;

pub(super) use pictures::Peeling;
pub use points::PointPeeler;

use crate::diag::Failure;
use crate::emit::{self, wgsl_text};
use crate::gpu::Gpu;
use crate::gpu::pass::{Compute, Module};
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::technique::tables::{BOX_SILHOUETTE, CLIP_STEP, EDGE_INTEGRAL, EDGE_SILHOUETTE};

/// The shader of an entry point: the modules of the tables, and a skeleton around them.
///
/// # Errors
/// When the device refuses it.
fn shader(gpu: &Gpu, label: &str, skeleton: &str) -> Result<(Module, Compute), Failure> {
    let tables = [CLIP_STEP.program()?, BOX_SILHOUETTE.program()?, EDGE_SILHOUETTE.program()?];
    let functions = [EDGE_INTEGRAL.function("term")?, EDGE_INTEGRAL.function("small")?];
    let emitted = |program: &&'static Program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    let modules = tables.iter().chain(&functions).map(emitted).collect::<Result<String, Failure>>()?;
    compiled(gpu, label, &(modules + skeleton))
}

/// A shader by its whole text, with one entry point and the rounds of loops that the device grants.
///
/// # Errors
/// When the device refuses it.
pub(super) fn compiled(gpu: &Gpu, label: &str, text: &str) -> Result<(Module, Compute), Failure> {
    let module = Module::new(gpu, label, wgsl_text(label, text)?)?;
    // Eight threads side by side, each on its own way, share the rounds that Mesa's rasteriser grants.
    let rounds = if gpu.is_software() { 8_000.0 } else { f64::from(1 << 20) };
    let compute = module.compute(gpu, module.only_compute()?, &[("MOST_ROUNDS", rounds)])?;
    Ok((module, compute))
}
