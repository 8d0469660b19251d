//! The start and the end of every variant on both executors: the light's depths and the receivers of a frame,
//! the inputs that the search finds in them, and visibility as layers.

use std::sync::Arc;

use super::settings::{SHADOW_MAP, bias};
use super::stage::{Bias, Stage};
use super::{Receivers, Settings, ShadowMap, Variant, Visibility, cpu};
use crate::diag::Failure;
use crate::program::Program;
use crate::technique::rendered::{CASE, STATE, VALUE};
use crate::technique::{Executor, Frame, Inputs, Rendered, Samples};

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

    /// The shadow map and the receivers of a frame, made once for all variants, by the one that asks first.
    pub(super) fn of(frame: &Frame<'_>, variant: Variant) -> Result<Arc<Self>, Failure> {
        frame.shared(Self::key(frame), || {
            let stage = Stage::with_rays(frame.scene, Arc::clone(&frame.rays), variant.name())?;
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
