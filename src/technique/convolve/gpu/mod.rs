//! Convolution shadows on a GPU: triangles and samples of kernels go there, light comes back.
//!
//! The same as on the CPU, in the same order: layers by counting, scanning and scattering, then a pass for each slab that
//! is visited. Lights, kernels and steps are made by the host, as on the CPU. Where matter fills whole slabs its opacity
//! comes from the host, too, and light is the same to the last bit; the opacity of a part of a slab is a power, which
//! every device takes in its own way.

mod layers;
mod rows;
mod sweep;

use std::time::Duration;

use super::picture::{Picture, Portions, d1_for, materials};
use super::settings::Chosen;
use super::stack::Stack;
use super::steps::Spread;
use crate::diag::{Diagnostic, Failure, codes};
use crate::gpu::Gpu;
use crate::gpu::timing::Stopwatch;
use crate::scene::Scene;
use crate::technique::Frame;
use layers::{LayerPasses, Lists};
use sweep::{Chunk, SweepPasses, Swept};

/// The shaders on a device.
#[derive(Debug)]
pub(super) struct Device<'g> {
    gpu: &'g Gpu,
    layers: LayerPasses,
    sweep: SweepPasses,
    /// Set if its shaders know patterns.
    detailed: bool,
}

/// A frame that is ready to be swept again and again.
#[derive(Debug)]
pub(super) struct Ready {
    lists: Lists,
    sweeps: Vec<(Swept, Vec<Chunk>)>,
}

impl<'g> Device<'g> {
    /// Compiles the shaders that a scene needs.
    ///
    /// # Errors
    /// When the device refuses one.
    pub(super) fn new(gpu: &'g Gpu, scene: &Scene) -> Result<Self, Failure> {
        let detailed = has_detail(scene);
        Ok(Self { gpu, layers: LayerPasses::new(gpu)?, sweep: SweepPasses::new(gpu, detailed)?, detailed })
    }

    /// Returns whether the shaders are those that a scene needs.
    pub(super) fn fits(&self, scene: &Scene) -> bool {
        self.detailed == has_detail(scene)
    }

    /// Renders a frame.
    ///
    /// # Errors
    /// When a light or a kernel cannot be used, when there are more surfaces than the device has room for, or it fails.
    pub(super) fn picture(&self, frame: &Frame<'_>, chosen: &Chosen) -> Result<Picture, Failure> {
        let lists = self.layers.lists(self.gpu, frame, chosen)?;
        let pixels = lists.crossings.len();
        let mut picture = Picture {
            light: vec![[0.0; 3]; pixels],
            opacity: vec![0.0; pixels],
            crossings: lists.crossings.clone(),
            odd: lists.odd.clone(),
        };
        let mut swept = None;
        self.each_chunk(frame, chosen, &lists, |of, chunk| {
            self.sweep.submit(self.gpu, of, &chunk);
            swept = Some(of.clone());
            Ok(())
        })?;
        if let Some(swept) = swept {
            for (pixel, [r, g, b, opacity]) in self.sweep.seen(self.gpu, &swept)?.into_iter().enumerate() {
                picture.light[pixel] = [r, g, b];
                picture.opacity[pixel] = opacity;
            }
        }
        Ok(picture)
    }

    /// Puts a frame onto the device to be measured.
    ///
    /// # Errors
    /// As [`Self::picture`].
    pub(super) fn ready(&self, frame: &Frame<'_>, chosen: &Chosen) -> Result<Ready, Failure> {
        let lists = self.layers.lists(self.gpu, frame, chosen)?;
        let mut sweeps: Vec<(Swept, Vec<Chunk>)> = Vec::new();
        self.each_chunk(frame, chosen, &lists, |of, chunk| {
            match sweeps.last_mut() {
                Some((swept, chunks)) if !chunk.is_first => {
                    debug_assert_eq!(swept.lights, of.lights);
                    chunks.push(chunk);
                }
                _ => sweeps.push((of.clone(), vec![chunk])),
            }
            Ok(())
        })?;
        Ok(Ready { lists, sweeps })
    }

    /// Makes the layers of a frame again and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time_layers(&self, ready: &Ready, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        self.layers.time(&ready.lists, stopwatch)
    }

    /// Sweeps a frame again and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time_sweep(&self, ready: &Ready, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        ready.sweeps.iter().map(|(swept, chunks)| self.sweep.time(swept, chunks, stopwatch)).sum()
    }

    /// Calls for every chunk of steps of every portion of lights, in order.
    fn each_chunk(
        &self,
        frame: &Frame<'_>,
        chosen: &Chosen,
        lists: &Lists,
        mut each: impl FnMut(&Swept, Chunk) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let Some(depths) = lists.depths else { return Ok(()) };
        let stack = Stack::holding(lists.base, depths, chosen.slabs);
        let spread = Spread { d1: d1_for(chosen, &stack), ..chosen.spread };
        let occupied = self.layers.occupied(self.gpu, lists, &stack)?;
        let materials = materials(frame.scene);
        let most = self.sweep.most_lights(self.gpu, lists)?;
        let mut swept: Option<Swept> = None;
        for lights in &Portions::new(frame.scene, &lists.view, chosen)?.of_at_most(most) {
            let next = self.sweep.swept(self.gpu, lists, &materials, &stack, lights.len(), chosen, swept.as_ref())?;
            self.sweep.chunks(self.gpu, lists, lights, &stack, &occupied, &spread, &next, &mut each)?;
            swept = Some(next);
        }
        Ok(())
    }
}

/// Returns whether an object of a scene has a pattern.
fn has_detail(scene: &Scene) -> bool {
    scene.objects.iter().any(|object| object.detail.is_some())
}

/// Refuses what is more than a buffer of the device holds.
fn room(gpu: &Gpu, what: &str, bytes: u64) -> Result<(), Failure> {
    let most = gpu.largest_storage();
    if bytes <= most {
        return Ok(());
    }
    let mib = |bytes: u64| bytes.div_ceil(1 << 20);
    let message =
        format!("{what} take {} MiB, and `{}` gives at most {} MiB at once", mib(bytes), gpu.name(), mib(most));
    let error = Diagnostic::error(codes::RENDER, message);
    Err(Failure::bare("", error.help("make the picture smaller, or render with `--backend cpu`")))
}
