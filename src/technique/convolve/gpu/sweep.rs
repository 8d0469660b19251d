//! The sweep on a device: steps as records and rows of samples, chunk by chunk, and the passes of `convolve.wgsl`.

use std::time::Duration;

use encase::ShaderType;
use glam::UVec2;

use super::layers::Lists;
use super::room;
use super::rows::{FrameRow, MaterialRow, RecordRow, Rows};
use crate::diag::Failure;
use crate::emit::{self, wgsl_text};
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::skeleton;
use crate::technique::convolve::detail::PixelSize;
use crate::technique::convolve::fine::Placed;
use crate::technique::convolve::light::SlopeLight;
use crate::technique::convolve::material::{Material, ways};
use crate::technique::convolve::picture::d1_for;
use crate::technique::convolve::settings::Chosen;
use crate::technique::convolve::stack::Stack;
use crate::technique::convolve::stencil::Border;
use crate::technique::convolve::steps::{Spread, Steps};
use crate::technique::convolve::surface::{DRIFTS, Facets, Slope};
use crate::technique::tables::{NOISE, SHADE, SLAB};

/// Bytes of a pixel in the image of a light.
const PIXEL: u64 = 16;
/// The most memory for light images, in bytes: parts of split lights beyond it wait for the next sweep.
const MOST_LIGHT: u64 = 1 << 30;
/// Steps of a chunk, and rows at which it ends.
const MOST_STEPS: usize = 1024;
const MOST_ROWS: usize = 1 << 20;

/// The passes on a device.
#[derive(Debug)]
pub(super) struct SweepPasses {
    module: Module,
    begin: Compute,
    sweep: Compute,
}

/// The things that all chunks of a sweep share.
#[derive(Debug, Clone)]
pub(super) struct Swept {
    /// The number of lights.
    pub(super) lights: usize,
    size: [u32; 2],
    frame: Buffer,
    cursors: Buffer,
    images: [Buffer; 2],
    materials: Buffer,
    lookups: Buffer,
    seen: Buffer,
}

/// Some steps on the device.
#[derive(Debug)]
pub(super) struct Chunk {
    /// Set if a sweep begins with it.
    pub(super) is_first: bool,
    bound: [Bound; 2],
    steps: u32,
}

/// The text of the shader: the modules of the tables, and the skeleton around them.
fn text(detailed: bool) -> Result<String, Failure> {
    let mut programs = vec![
        SLAB.program()?,
        SHADE.function("opacity")?,
        SHADE.function("transmittance")?,
        SHADE.function("specular")?,
        NOISE.function("hash")?,
    ];
    if detailed {
        programs.extend([
            SHADE.function("piece_of_ramp")?,
            SHADE.function("preintegrated")?,
            NOISE.function("fbm_octave")?,
            NOISE.function("ridged_octave")?,
            NOISE.function("brick")?,
        ]);
    }
    let module = |program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    Ok(programs.into_iter().map(module).collect::<Result<String, Failure>>()? + &skeleton::convolve(detailed))
}

impl SweepPasses {
    /// Compiles the shader, for patterns inside of objects or without.
    ///
    /// # Errors
    /// When the device refuses it.
    pub(super) fn new(gpu: &Gpu, detailed: bool) -> Result<Self, Failure> {
        let varying = ("record", RecordRow::min_size().get());
        let module = Module::varying(gpu, "convolve", wgsl_text("convolve", &text(detailed)?)?, varying)?;
        let [begin, sweep] = ["begin", "sweep"].map(|entry| module.compute(gpu, entry, &[]));
        Ok(Self { begin: begin?, sweep: sweep?, module })
    }

    /// The most lights whose images there is room for.
    ///
    /// # Errors
    /// When there is none for one.
    pub(super) fn most_lights(&self, gpu: &Gpu, lists: &Lists) -> Result<usize, Failure> {
        let of_one = PIXEL * lists.crossings.len() as u64;
        room(gpu, "the images of one light", of_one)?;
        Ok((MOST_LIGHT.min(gpu.largest_storage()) / of_one).max(1) as usize)
    }

    /// Memory for a sweep of so many lights, which adds to the picture of the one before.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    #[expect(clippy::too_many_arguments, reason = "a sweep is where everything comes together")]
    pub(super) fn swept(
        &self,
        gpu: &Gpu,
        lists: &Lists,
        materials: &[Material],
        stack: &Stack,
        lights: usize,
        chosen: &Chosen,
        before: Option<&Swept>,
    ) -> Result<Swept, Failure> {
        let (width, height) = lists.view.size;
        let pixels = u64::from(width) * u64::from(height);
        let pixel = PixelSize::new(&lists.view, lists.base);
        let frame = FrameRow {
            size: UVec2::new(width, height),
            lights: lights as u32,
            clamps: u32::from(chosen.border == Border::Clamp),
            coverage: if chosen.policies.coverage == "exact" { 1.0 } else { 0.0 },
            last: u32::from(chosen.policies.hit == "last"),
            fresh: u32::from(before.is_none()),
            seed: chosen.spread.seed,
            compensates: chosen.compensates.into(),
            drift: (stack.thickness / d1_for(chosen, stack)).sqrt() as f32,
            pixel_at_base: pixel.at_base,
            pixel_growth: pixel.growth,
            integrates: chosen.integrates.into(),
        };
        let mut lookups = vec![1.0; DRIFTS];
        if chosen.compensates {
            lookups = Slope::new(stack.thickness, d1_for(chosen, stack))?.inverses;
        }
        let ways = ways()?;
        let mut rows = Vec::new();
        for material in materials {
            let facets = Facets::of(material)?;
            let mut row = MaterialRow::new(material, ways.of(&material.matter, stack.thickness));
            if let Some(facets) = facets {
                row.exponent = facets.exponent as f32;
                row.reflectance = facets.reflectance as f32;
                row.shown = lookups.len() as u32;
                lookups.extend(facets.shown);
            }
            if let Some(placed) = Placed::new(material, &lists.view, lists.base) {
                row.set_detail(&placed, lookups.len());
                lookups.extend(placed.knots.iter().flatten());
            }
            rows.push(row);
        }
        let image = || gpu.results("images", PIXEL * pixels * lights.max(1) as u64);
        Ok(Swept {
            lights,
            size: [width, height],
            frame: gpu.uniform("frame", &frame)?,
            cursors: gpu.results("cursors", 16 * pixels),
            images: [image(), image()],
            materials: gpu.storage("materials", &laid_out("materials", &rows)?),
            lookups: gpu.storage("lookups", &lookups),
            seen: before.map_or_else(|| gpu.results("seen", PIXEL * pixels), |before| before.seen.clone()),
        })
    }

    /// Puts the steps of some lights onto the device, chunk by chunk.
    ///
    /// # Errors
    /// When a kernel is asked for a blur that it is not made for, or the device fails.
    #[expect(clippy::too_many_arguments, reason = "steps are where everything comes together")]
    pub(super) fn chunks(
        &self,
        gpu: &Gpu,
        lists: &Lists,
        lights: &[SlopeLight],
        stack: &Stack,
        occupied: &[bool],
        spread: &Spread,
        swept: &Swept,
        each: &mut impl FnMut(&Swept, Chunk) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut steps = Steps::<f32>::new(lights, stack, occupied, spread, &lists.view)?;
        let mut done = 0;
        loop {
            let mut rows = Rows::new(lights);
            let mut records = Vec::new();
            while records.len() < MOST_STEPS && rows.words.len() < MOST_ROWS {
                let Some(step) = steps.next() else { break };
                records.push(rows.record(&step?, stack));
            }
            if records.is_empty() {
                return Ok(());
            }
            let turns = [done % 2, (done + 1) % 2];
            let bound = self.bind(gpu, lists, swept, &records, &rows, turns)?;
            let steps = records.len() as u32;
            each(swept, Chunk { is_first: done == 0, bound, steps })?;
            done += records.len();
        }
    }

    fn bind(
        &self,
        gpu: &Gpu,
        lists: &Lists,
        swept: &Swept,
        records: &[RecordRow],
        rows: &Rows,
        turns: [usize; 2],
    ) -> Result<[Bound; 2], Failure> {
        let records = gpu.records("record", records)?;
        let rows = gpu.storage("rows", &rows.words);
        let bound = |turn: usize| {
            let resources = Resources::new()
                .buffer("frame", &swept.frame)
                .buffer("record", &records)
                .buffer("lists", &lists.lists)
                .buffer("entries", &lists.entries)
                .buffer("cursors", &swept.cursors)
                .buffer("images", &swept.images[turn])
                .buffer("next_images", &swept.images[1 - turn])
                .buffer("rows", &rows)
                .buffer("materials", &swept.materials)
                .buffer("lookups", &swept.lookups)
                .buffer("seen", &swept.seen);
            self.module.bind(gpu, &resources)
        };
        Ok([bound(turns[0])?, bound(turns[1])?])
    }

    /// Runs a chunk.
    pub(super) fn submit(&self, gpu: &Gpu, swept: &Swept, chunk: &Chunk) {
        gpu.submit(|encoder| {
            if chunk.is_first {
                self.begin.encode(encoder, &chunk.bound[1], self.work(swept), 1, None);
            }
            let bound = [&chunk.bound[0], &chunk.bound[1]];
            self.sweep.encode_records(encoder, bound, self.work(swept), 0..chunk.steps, None);
        });
    }

    /// Runs all chunks of a sweep and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time(&self, swept: &Swept, chunks: &[Chunk], stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        stopwatch.time(|encoder, marks| {
            let [mut start, end] = marks.span();
            let mut end = end;
            for (index, chunk) in chunks.iter().enumerate() {
                if chunk.is_first {
                    self.begin.encode(encoder, &chunk.bound[1], self.work(swept), 1, start.take());
                }
                let last = if index + 1 == chunks.len() { end.take() } else { None };
                let bound = [&chunk.bound[0], &chunk.bound[1]];
                self.sweep.encode_records(encoder, bound, self.work(swept), 0..chunk.steps, last);
            }
        })
    }

    fn work(&self, swept: &Swept) -> Work<'static> {
        self.sweep.covering([swept.size[0], swept.size[1], 1])
    }

    /// The picture: colours times opacity, and opacities.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn seen(&self, gpu: &Gpu, swept: &Swept) -> Result<Vec<[f32; 4]>, Failure> {
        let pixels = u64::from(swept.size[0]) * u64::from(swept.size[1]);
        gpu.read_buffer(&swept.seen, PIXEL * pixels, bytemuck::pod_collect_to_vec::<u8, [f32; 4]>)
    }
}
