//! The sweep on a device: steps as records and rows of samples, chunk by chunk, and the passes of `convolve.wgsl`.

use std::time::Duration;

use encase::ShaderType;
use glam::{UVec2, Vec3};

use super::layers::Lists;
use super::room;
use crate::diag::Failure;
use crate::emit::{self, wgsl_text};
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::skeleton;
use crate::technique::convolve::light::SlopeLight;
use crate::technique::convolve::matter::{Material, Through, ways};
use crate::technique::convolve::picture::d1_for;
use crate::technique::convolve::settings::Chosen;
use crate::technique::convolve::stack::Stack;
use crate::technique::convolve::stencil::{Border, Gather, Stencil};
use crate::technique::convolve::steps::{Spread, Steps};
use crate::technique::convolve::surface::{DRIFTS, Facets, Lamp, Slope};
use crate::technique::convolve::sweep::Step;
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

/// What all chunks of a sweep share.
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
fn text() -> Result<String, Failure> {
    let programs = [
        SLAB.program()?,
        SHADE.function("opacity")?,
        SHADE.function("transmittance")?,
        SHADE.function("specular")?,
        NOISE.function("hash")?,
    ];
    let module = |program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    Ok(programs.into_iter().map(module).collect::<Result<String, Failure>>()? + skeleton::CONVOLVE)
}

impl SweepPasses {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses it.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let varying = ("record", RecordRow::min_size().get());
        let module = Module::varying(gpu, "convolve", wgsl_text("convolve", &text()?)?, varying)?;
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
        };
        let mut lookups = vec![1.0; DRIFTS];
        if chosen.compensates {
            lookups = Slope::new(stack.thickness, d1_for(chosen, stack))?.inverses;
        }
        let ways = ways()?;
        let mut rows = Vec::new();
        for material in materials {
            let facets = material.facets()?;
            rows.push(MaterialRow::new(material, ways.of(material, stack.thickness), facets.as_ref(), lookups.len()));
            lookups.extend(facets.map_or_else(Vec::new, |facets| facets.shown));
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

/// The kinds of gathers of the skeleton.
const SAME: u32 = 0;
const DITHERED: u32 = 1;
const MAGNIFIED: u32 = 2;

/// The `rows` of the skeleton: colours of lights, gathers, samples.
struct Rows {
    words: Vec<[u32; 4]>,
    /// The gather of each light before, which the next one often is again, with its row.
    known: Vec<Option<(Gather<f32>, [u32; 4])>>,
}

impl Rows {
    fn new(lights: &[SlopeLight]) -> Self {
        let of_light = |light: &SlopeLight| {
            let [r, g, b] = light.colour.map(|channel| channel as f32);
            let Lamp { mean: [x, y], covariance: [xx, xy, yy] } = Lamp::new(light);
            [[r, g, b, 1.0], [x, y, xx, xy], [yy, 0.0, 0.0, 0.0]].map(|row| row.map(f32::to_bits))
        };
        let mut words: Vec<[u32; 4]> = lights.iter().flat_map(of_light).collect();
        if words.is_empty() {
            // An array must have an element.
            words.push([0; 4]);
        }
        Self { words, known: lights.iter().map(|_| None).collect() }
    }

    /// A step, after rows for its gathers.
    fn record(&mut self, step: &Step<f32>, stack: &Stack) -> RecordRow {
        let gathers: Vec<[u32; 4]> =
            step.gathers.iter().enumerate().map(|(light, gather)| self.gather(light, gather)).collect();
        let first = self.words.len() as u32;
        self.words.extend(gathers);
        let (front, back) = stack.slab(step.slab);
        RecordRow {
            front: front as f32,
            back: back as f32,
            thickness: stack.thickness as f32,
            slab: step.slab as u32,
            gathers: first,
        }
    }

    fn gather(&mut self, light: usize, gather: &Gather<f32>) -> [u32; 4] {
        if let Some((known, row)) = &self.known[light]
            && known == gather
        {
            return *row;
        }
        let row = match gather {
            Gather::Same(stencil) => self.stencil(stencil),
            Gather::Dithered(stencils) => {
                let all: Vec<[u32; 4]> = stencils.iter().map(|stencil| self.stencil(stencil)).collect();
                let first = self.words.len() as u32;
                let count = all.len() as u32;
                self.words.extend(all);
                [first, count, DITHERED, 0]
            }
            Gather::Magnified { samples, beyond } => {
                let first = self.words.len() as u32;
                let bits = |number: f64| (number as f32).to_bits();
                self.words.extend(
                    samples.iter().map(|sample| [bits(sample.at[0]), bits(sample.at[1]), bits(sample.weight), 0]),
                );
                [first, samples.len() as u32, MAGNIFIED, bits(*beyond)]
            }
        };
        self.known[light] = Some((gather.clone(), row));
        row
    }

    fn stencil(&mut self, stencil: &Stencil<f32>) -> [u32; 4] {
        let first = self.words.len() as u32;
        let word = |offset: i64| offset as i32 as u32;
        self.words.extend(stencil.taps().iter().map(|(dy, dx, weight)| [word(*dx), word(*dy), weight.to_bits(), 0]));
        [first, stencil.len() as u32, SAME, 0]
    }
}

/// A `Frame` of the skeleton.
#[derive(ShaderType)]
struct FrameRow {
    size: UVec2,
    lights: u32,
    clamps: u32,
    coverage: f32,
    last: u32,
    fresh: u32,
    seed: u32,
    compensates: u32,
    drift: f32,
}

/// A `Record` of the skeleton.
#[derive(ShaderType)]
struct RecordRow {
    front: f32,
    back: f32,
    thickness: f32,
    slab: u32,
    gathers: u32,
}

/// A `Material` of the skeleton.
#[derive(ShaderType)]
struct MaterialRow {
    colour: Vec3,
    alpha: f32,
    through: Vec3,
    opacity: f32,
    transport: Vec3,
    length: f32,
    exponent: f32,
    reflectance: f32,
    shown: u32,
}

impl MaterialRow {
    fn new(material: &Material, (alpha, through): Through, facets: Option<&Facets>, shown: usize) -> Self {
        let narrow = |numbers: [f64; 3]| Vec3::from_array(numbers.map(|number| number as f32));
        Self {
            colour: narrow(material.colour),
            alpha: alpha as f32,
            through: narrow(through),
            opacity: material.matter.opacity as f32,
            transport: narrow(material.matter.transport),
            length: material.matter.length as f32,
            exponent: facets.map_or(0.0, |facets| facets.exponent) as f32,
            reflectance: facets.map_or(0.0, |facets| facets.reflectance) as f32,
            shown: if facets.is_some() { shown as u32 } else { 0 },
        }
    }
}
