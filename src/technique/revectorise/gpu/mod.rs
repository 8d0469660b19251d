//! The techniques on a GPU.
//!
//! ```text
//! ShadowMap, Receivers ──▶ Frame on the device ──Shader──▶ Visibility
//! ```
//!
//! A [`Shader`] is a technique with a proved plan of its table, compiled for one
//! kind of output. It takes the same [`ShadowMap`] and
//! [`Receivers`] as the CPU, whoever made them, and decides
//! every pixel alike: depth tests and steps of walks are exact in `f32`, so that
//! the case is the same and only divisions may round otherwise.

pub mod bench;
mod frame;
mod raster;
mod shader;
mod source;

pub use frame::GpuFrame;
pub use raster::{GpuPicture, Raster};
pub use shader::{Bound, Costs, Shader};
pub use source::{Output, Passes, Reads, Skeleton, source};

use super::{Receivers, Settings, ShadowMap, Technique, Visibility};
use crate::diag::Failure;
use crate::gpu::Gpu;
use crate::prove::Proved;

/// The visibility of every pixel by a technique. `proved` is the plan of its table, if it has one.
///
/// # Errors
/// When the frame is beyond the device's limits, or the device fails.
pub fn visibility(
    gpu: &Gpu,
    technique: Technique,
    proved: Option<&Proved<'_>>,
    map: &ShadowMap,
    receivers: &Receivers,
    settings: &Settings,
) -> Result<Visibility, Failure> {
    let shader = Shader::new(gpu, technique, proved, Skeleton::EXACT, Output::Record)?;
    shader.record(&GpuFrame::new(gpu, map, receivers)?, settings).map(|(visibility, _)| visibility)
}
