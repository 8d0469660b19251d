//! A technique as a pipeline.

use std::collections::HashMap;
use std::time::Duration;

use encase::ShaderType;
use glam::UVec2;

use super::frame::GpuFrame;
use super::source::{Output, Passes, Skeleton, passes, source};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::{lookup_words, wgsl_module, wgsl_text};
use crate::gpu::draw::{self, Canvas, DepthBuffer, DepthTest, Draw, Drawing, Triangles};
use crate::gpu::pass::{self, Compute, Module, Resources, Work};
use crate::gpu::timing::{Marks, Stopwatch};
use crate::gpu::{Buffer, CommandEncoder, CompareFunction, Gpu, Texture, TextureFormat, TextureView, view};
use crate::plan::Plan;
use crate::prove::Proved;
use crate::technique::revectorise::{Settings, Variant, Visibility};

/// The start of `work` in compute_two.wgsl: no workgroups along x, one along y and z, no pixels.
const WORK: [u32; 4] = [0, 1, 1, 0];
/// The buffer in which a glance marks pixels.
const MARKS: TextureFormat = TextureFormat::Depth16Unorm;
/// Longest run that walks look for: keeps all that is computed from it within an `i32`.
const MAX_LIMIT: u32 = 1 << 16;

/// The uniform `frame` of frame.wgsl.
#[derive(ShaderType)]
struct Frame {
    pixels: UVec2,
    size: i32,
    limit: i32,
    walk_bias: f32,
    reach: i32,
}

/// A technique on a device, for one kind of output.
#[derive(Debug)]
pub struct Shader<'g> {
    gpu: &'g Gpu,
    output: Output,
    module: Module,
    pipeline: Pipeline,
    lookup: Option<Buffer>,
    keys: Keys,
}

#[derive(Debug)]
enum Pipeline {
    /// All pixels at once.
    Compute(Compute),
    /// The glance, and the pixels that it queued.
    Queue(Compute, Compute),
    /// Draws that cover the picture: one, or the glance and the pixels that it marked.
    Draws(Vec<Draw>),
}

/// The keys of a plan, and the numbers of their states.
#[derive(Debug, Default)]
struct Keys {
    states: HashMap<u32, u32>,
    bits: u32,
}

impl Keys {
    fn new(plan: &Plan<'_>) -> Self {
        let space = &plan.program.states;
        let mut levels = vec![0; plan.program.inputs.len()];
        let states = (0..space.count()).map(|state| {
            space.write(state, &mut levels);
            (plan.key.pack(|input| levels[input.index()]), state as u32)
        });
        Self { states: states.collect(), bits: plan.key.bits() }
    }
}

/// The cost of each pixel.
#[derive(Debug, Clone, Default)]
pub struct Costs {
    /// Reads of the shadow map; a gather counts as one.
    pub reads: Vec<u32>,
    /// Steps of loops.
    pub steps: Vec<u32>,
}

/// A frame bound to a shader, ready to be run again and again.
#[derive(Debug)]
pub struct Bound<'s, 'g> {
    shader: &'s Shader<'g>,
    resources: pass::Bound,
    pixels: [u32; 2],
    /// The outputs, each with the name of its variable and its size in bytes.
    outputs: Vec<(&'static str, Buffer, u64)>,
    /// The size of the second dispatch of a queue, and what it is before the first.
    groups: Option<[Buffer; 2]>,
    target: Option<Texture>,
    /// The buffer in which a glance marks pixels.
    marks: Option<TextureView>,
}

impl<'g> Shader<'g> {
    /// Compiles a technique. `proved` is the plan of its table, if it has one.
    ///
    /// # Errors
    /// When the plan is not of the table that the technique needs, or the device refuses the shader.
    pub fn new(
        gpu: &'g Gpu,
        technique: Variant,
        proved: Option<&Proved<'_>>,
        skeleton: Skeleton,
        output: Output,
    ) -> Result<Self, Failure> {
        let text = source(technique, proved, skeleton, output)?;
        let proved = proved.filter(|_| technique.table().is_some());
        let module = match proved {
            Some(proved) => wgsl_module(proved.plan().program, &text)?,
            None => wgsl_text(technique.name(), &text)?,
        };
        let module = Module::new(gpu, technique.name(), module)?;
        let two = passes(technique, skeleton) == Passes::Two;
        let constants = [("COUNT", f64::from(u8::from(output == Output::Record)))];
        let compute = |entry| module.compute(gpu, entry, &constants);
        let cover = |fragment, depth| {
            let targets = &[TextureFormat::R32Float];
            module.draw(gpu, &Drawing { vertex: "cover", fragment, targets, depth, constants: &constants })
        };
        let marks = |passes, write| Some(DepthTest { format: MARKS, passes, write });
        let pipeline = match output {
            Output::Fragment if two => Pipeline::Draws(vec![
                cover("glance_pass", marks(CompareFunction::Always, true))?,
                // The mark is 1 and what covers lies at 0.5.
                cover("visibility_pass", marks(CompareFunction::Less, false))?,
            ]),
            Output::Fragment => Pipeline::Draws(vec![cover("visibility_pass", None)?]),
            Output::Compute if two => Pipeline::Queue(compute("glance_pass")?, compute("queue_pass")?),
            Output::Compute | Output::Record | Output::Count => Pipeline::Compute(compute("visibility_pass")?),
        };
        let lookup = proved.and_then(|proved| lookup_words(proved.plan()));
        let lookup = lookup.map(|words| gpu.storage("lookup", &words));
        gpu.check()?;
        let keys = proved.map_or_else(Keys::default, |proved| Keys::new(proved.plan()));
        Ok(Self { gpu, output, module, pipeline, lookup, keys })
    }

    /// Binds a frame.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub fn bind(&self, frame: &GpuFrame, settings: &Settings) -> Result<Bound<'_, 'g>, Failure> {
        let gpu = self.gpu;
        let uniform = Frame {
            pixels: UVec2::from(frame.pixels),
            size: frame.size as i32,
            limit: settings.search_limit.min(MAX_LIMIT) as i32,
            walk_bias: settings.walk_bias,
            reach: (settings.pcf / 2) as i32,
        };
        let uniform = gpu.uniform("frame", &uniform)?;
        let nearest = gpu.nearest();
        let queued = matches!(self.pipeline, Pipeline::Queue(..));
        let pixels = frame.pixel_count() as u64;
        let sizes = match self.output {
            Output::Fragment => vec![],
            Output::Compute if queued => vec![("values", 4 * pixels), ("work", 16), ("queue", 4 * pixels)],
            Output::Compute => vec![("values", 4 * pixels)],
            Output::Record => vec![("values", 4 * pixels), ("records", 16 * pixels)],
            Output::Count => vec![("counts", 4 << self.keys.bits)],
        };
        let outputs: Vec<_> = sizes.into_iter().map(|(name, size)| (name, gpu.results(name, size), size)).collect();
        let groups = queued.then(|| [gpu.indirect("groups", 16), gpu.words("no work", &WORK)]);
        let target =
            (self.output == Output::Fragment).then(|| gpu.target("visibility", frame.pixels, TextureFormat::R32Float));
        let marks = matches!(&self.pipeline, Pipeline::Draws(draws) if draws.len() > 1)
            .then(|| view(&gpu.target("marks", frame.pixels, MARKS)));
        let mut resources = Resources::new()
            .buffer("frame", &uniform)
            .texture("map", &frame.map)
            .sampler("nearest", &nearest)
            .texture("points", &frame.points)
            .texture("slopes", &frame.slopes)
            .optional_buffer("lookup_words", self.lookup.as_ref());
        for (name, buffer, _) in &outputs {
            resources = resources.buffer(name, buffer);
        }
        let resources = self.module.bind(gpu, &resources)?;
        Ok(Bound { shader: self, resources, pixels: frame.pixels, outputs, groups, target, marks })
    }

    /// Runs a shader made for [`Output::Record`].
    ///
    /// # Errors
    /// When the device fails.
    pub fn record(&self, frame: &GpuFrame, settings: &Settings) -> Result<(Visibility, Costs), Failure> {
        let bound = self.bind(frame, settings)?;
        bound.submit();
        let mut visibility = Visibility::new(frame.pixel_count());
        let mut costs = Costs::default();
        visibility.value = bound.read("values")?;
        let records = bound.read::<[u32; 4]>("records")?;
        for (pixel, [case, key, reads, steps]) in records.into_iter().enumerate() {
            costs.reads.push(reads);
            costs.steps.push(steps);
            if key != Visibility::NONE {
                visibility.case[pixel] = if case == u32::MAX { Visibility::DEFAULT } else { case };
                visibility.state[pixel] = self.keys.states.get(&key).copied().unwrap_or(Visibility::NONE);
            }
        }
        Ok((visibility, costs))
    }

    /// Runs a shader made for [`Output::Count`] and returns the number of pixels in each state of the table, by
    /// the state's number.
    ///
    /// # Errors
    /// When the device fails.
    pub fn counts(&self, frame: &GpuFrame, settings: &Settings) -> Result<Vec<u64>, Failure> {
        let bound = self.bind(frame, settings)?;
        bound.submit();
        let by_key = bound.read::<u32>("counts")?;
        let mut counts = vec![0; self.keys.states.len()];
        for (key, state) in &self.keys.states {
            counts[*state as usize] = u64::from(by_key[*key as usize]);
        }
        Ok(counts)
    }
}

impl Bound<'_, '_> {
    /// Runs the pass and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub fn time(&self, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        stopwatch.time(|encoder, marks| self.encode(encoder, marks))
    }

    /// Runs a shader made for [`Output::Compute`] or [`Output::Fragment`] and returns its values.
    ///
    /// # Errors
    /// When the device fails.
    pub fn values(&self) -> Result<Vec<f32>, Failure> {
        self.submit();
        match &self.target {
            None => self.read("values"),
            Some(target) => self.shader.gpu.read_texture(target),
        }
    }

    fn submit(&self) {
        self.shader.gpu.submit(|encoder| self.encode(encoder, &Marks::none()));
    }

    fn encode(&self, encoder: &mut CommandEncoder, marks: &Marks<'_>) {
        let [width, height] = self.pixels;
        let pixels = [width, height, 1];
        match &self.shader.pipeline {
            Pipeline::Compute(all) => all.encode(encoder, &self.resources, all.covering(pixels), 1, marks.compute()),
            Pipeline::Queue(glance, queue) => {
                let work = self.outputs.iter().find(|(name, ..)| *name == "work");
                let (Some((_, work, size)), Some([groups, start])) = (work, &self.groups) else { return };
                let [first, last] = marks.span();
                encoder.copy_buffer_to_buffer(start, 0, work, 0, *size);
                glance.encode(encoder, &self.resources, glance.covering(pixels), 1, first);
                // A buffer that a shader can write cannot size a dispatch of it.
                encoder.copy_buffer_to_buffer(work, 0, groups, 0, *size);
                queue.encode(encoder, &self.resources, Work::Indirect(groups), 1, last);
            }
            Pipeline::Draws(draws) => {
                let targets: Vec<_> = self.target.iter().map(view).collect();
                let depth = self.marks.as_ref().map(|view| DepthBuffer { view, clear: 0.0, keep: false });
                let draws: Vec<_> = draws.iter().map(|draw| (draw, Triangles::Cover)).collect();
                let canvas = Canvas { targets: &targets, depth };
                draw::encode(encoder, &canvas, &self.resources, &draws, marks.render());
            }
        }
    }

    fn read<T: bytemuck::Pod>(&self, output: &str) -> Result<Vec<T>, Failure> {
        let Some((_, buffer, size)) = self.outputs.iter().find(|(name, ..)| *name == output) else {
            let message = format!("a pass for `{}` has no output `{output}`", self.shader.output.name());
            return Err(Failure::bare("", Diagnostic::error(codes::DEVICE, message)));
        };
        self.shader.gpu.read_buffer(buffer, *size, bytemuck::pod_collect_to_vec::<u8, T>)
    }
}
