//! A technique as a pipeline.

use std::borrow::Cow;
use std::collections::HashMap;
use std::time::Duration;

use wgpu::util::DeviceExt;

use super::frame::GpuFrame;
use super::source::{Output, Passes, Skeleton, passes, source};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::{lookup_words, wgsl_module};
use crate::gpu::Gpu;
use crate::gpu::timing::{Marks, Stopwatch};
use crate::plan::{Plan, Proved};
use crate::technique::revectorise::{Settings, Technique, Visibility};

/// Threads of a workgroup along each side.
const TILE: u32 = 8;
/// What the work of a second dispatch starts from: no workgroups along x, one along y and z, no pixels.
const WORK: [u8; 16] = [0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];
/// Where a glance marks pixels.
const MARKS: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;

/// A technique on a device, for one kind of output.
#[derive(Debug)]
pub struct Shader<'g> {
    gpu: &'g Gpu,
    output: Output,
    pipeline: Pipeline,
    frame_layout: wgpu::BindGroupLayout,
    output_layout: wgpu::BindGroupLayout,
    lookup: wgpu::Buffer,
    keys: Keys,
}

#[derive(Debug)]
enum Pipeline {
    Compute(wgpu::ComputePipeline),
    /// The glance, and the pixels that it queued.
    Queue(wgpu::ComputePipeline, wgpu::ComputePipeline),
    Render(wgpu::RenderPipeline),
    /// The glance, and the pixels that it marked.
    Marked(wgpu::RenderPipeline, wgpu::RenderPipeline),
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

/// What each pixel cost.
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
    frame: wgpu::BindGroup,
    output: wgpu::BindGroup,
    pixels: [u32; 2],
    /// One for each binding of the output, with its size in bytes, and the size of a second dispatch.
    buffers: Vec<(wgpu::Buffer, u64)>,
    target: Option<wgpu::Texture>,
    /// Where a glance marks pixels.
    marks: Option<wgpu::TextureView>,
}

impl<'g> Shader<'g> {
    /// Compiles a technique. `proved` is the plan of its table, if it has one.
    ///
    /// # Errors
    /// When the plan is not of the table that the technique needs, or the device refuses the shader.
    pub fn new(
        gpu: &'g Gpu,
        technique: Technique,
        proved: Option<&Proved<'_>>,
        skeleton: Skeleton,
        output: Output,
    ) -> Result<Self, Failure> {
        let text = source(technique, proved, skeleton, output)?;
        let proved = proved.filter(|_| technique.table().is_some());
        let wgsl = match proved {
            // Reading it here shows a mistake with its place, and on a generous stack.
            Some(proved) => wgpu::ShaderSource::Naga(Cow::Owned(wgsl_module(proved.plan().program, &text)?.module)),
            None => wgpu::ShaderSource::Wgsl(text.into()),
        };
        let label = Some(technique.name());
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source: wgsl });
        let stage = match output {
            Output::Fragment => wgpu::ShaderStages::FRAGMENT,
            Output::Compute | Output::Record | Output::Count => wgpu::ShaderStages::COMPUTE,
        };
        let frame_layout = frame_layout(gpu, stage);
        let two = passes(technique, skeleton) != Passes::One;
        let outputs = match output {
            Output::Fragment => 0,
            Output::Compute if two => 3,
            Output::Compute | Output::Count => 1,
            Output::Record => 2,
        };
        let entries: Vec<_> = (0..outputs).map(|binding| storage(binding, stage, false)).collect();
        let output_layout =
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&frame_layout), Some(&output_layout)],
            immediate_size: 0,
        });
        let constants = [("COUNT", f64::from(u8::from(output == Output::Record)))];
        let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
        let compute = |entry| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label,
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: options.clone(),
                cache: None,
            })
        };
        let cover = |entry, compare| cover(gpu, &layout, &module, &options, entry, compare);
        let pipeline = match output {
            Output::Fragment if two => Pipeline::Marked(
                cover("glance_pass", Some(wgpu::CompareFunction::Always)),
                // The mark is 1 and what covers lies at 0.5.
                cover("visibility_pass", Some(wgpu::CompareFunction::Less)),
            ),
            Output::Fragment => Pipeline::Render(cover("visibility_pass", None)),
            Output::Compute if two => Pipeline::Queue(compute("glance_pass"), compute("queue_pass")),
            Output::Compute | Output::Record | Output::Count => Pipeline::Compute(compute("visibility_pass")),
        };
        let mut words = proved.map_or_else(Vec::new, |proved| lookup_words(proved.plan()));
        words.resize(words.len().max(1), 0);
        let lookup = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("lookup"),
            contents: bytemuck::cast_slice(&words),
            usage: wgpu::BufferUsages::STORAGE,
        });
        gpu.check()?;
        let keys = proved.map_or_else(Keys::default, |proved| Keys::new(proved.plan()));
        Ok(Self { gpu, output, pipeline, frame_layout, output_layout, lookup, keys })
    }

    /// Binds a frame.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub fn bind(&self, frame: &GpuFrame, settings: &Settings) -> Result<Bound<'_, 'g>, Failure> {
        let gpu = self.gpu;
        let [width, height] = frame.pixels;
        let parameters = [
            width,
            height,
            frame.size,
            settings.search_limit.min(MAX_LIMIT),
            settings.walk_bias.to_bits(),
            settings.pcf / 2,
            0,
            0,
        ];
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("frame"),
            contents: bytemuck::cast_slice(&parameters),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            address_mode_u: wgpu::AddressMode::ClampToEdge,
            address_mode_v: wgpu::AddressMode::ClampToEdge,
            ..Default::default()
        });
        let texture =
            |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        let frame_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &self.frame_layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
                texture(1, &frame.map),
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(&sampler) },
                texture(3, &frame.points),
                texture(4, &frame.slopes),
                wgpu::BindGroupEntry { binding: 5, resource: self.lookup.as_entire_binding() },
            ],
        });
        let pixels = frame.pixel_count() as u64;
        let sizes = match self.output {
            Output::Fragment => vec![],
            Output::Compute if matches!(self.pipeline, Pipeline::Queue(..)) => vec![4 * pixels, 16, 4 * pixels],
            Output::Compute => vec![4 * pixels],
            Output::Record => vec![4 * pixels, 16 * pixels],
            Output::Count => vec![4 << self.keys.bits],
        };
        let mut buffers: Vec<(wgpu::Buffer, u64)> = sizes
            .into_iter()
            .map(|size| {
                let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
                let descriptor =
                    wgpu::BufferDescriptor { label: Some("output"), size, usage, mapped_at_creation: false };
                (gpu.device.create_buffer(&descriptor), size)
            })
            .collect();
        let entries: Vec<_> = (0..)
            .zip(&buffers)
            .map(|(binding, (buffer, _))| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let output_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("output"),
            layout: &self.output_layout,
            entries: &entries,
        });
        if let Pipeline::Queue(..) = self.pipeline {
            let size = WORK.len() as u64;
            let usage = wgpu::BufferUsages::INDIRECT | wgpu::BufferUsages::COPY_DST;
            let descriptor = wgpu::BufferDescriptor { label: Some("groups"), size, usage, mapped_at_creation: false };
            buffers.push((gpu.device.create_buffer(&descriptor), size));
        }
        let texture = |format, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("visibility"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let target = (self.output == Output::Fragment)
            .then(|| texture(wgpu::TextureFormat::R32Float, wgpu::TextureUsages::COPY_SRC));
        let marks = matches!(self.pipeline, Pipeline::Marked(..))
            .then(|| texture(MARKS, wgpu::TextureUsages::empty()).create_view(&wgpu::TextureViewDescriptor::default()));
        gpu.check()?;
        Ok(Bound {
            shader: self,
            frame: frame_group,
            output: output_group,
            pixels: frame.pixels,
            buffers,
            target,
            marks,
        })
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
        visibility.value = bound.read(0, bytemuck::pod_collect_to_vec::<u8, f32>)?;
        let records = bound.read(1, bytemuck::pod_collect_to_vec::<u8, [u32; 4]>)?;
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

    /// Runs a shader made for [`Output::Count`]: how many pixels are in each state of the table,
    /// by its number.
    ///
    /// # Errors
    /// When the device fails.
    pub fn counts(&self, frame: &GpuFrame, settings: &Settings) -> Result<Vec<u64>, Failure> {
        let bound = self.bind(frame, settings)?;
        bound.submit();
        let by_key = bound.read(0, bytemuck::pod_collect_to_vec::<u8, u32>)?;
        let mut counts = vec![0; self.keys.states.len()];
        for (key, state) in &self.keys.states {
            counts[*state as usize] = u64::from(by_key[*key as usize]);
        }
        Ok(counts)
    }
}

/// Longest run that walks look for: keeps all that is computed from it within an `i32`.
const MAX_LIMIT: u32 = 1 << 16;

impl Bound<'_, '_> {
    /// Runs the pass and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub fn time(&self, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        stopwatch.time(|encoder, marks| self.encode(encoder, marks))
    }

    /// Reads the values of a shader made for [`Output::Compute`] or [`Output::Fragment`] after a run.
    ///
    /// # Errors
    /// When the device fails.
    pub fn values(&self) -> Result<Vec<f32>, Failure> {
        self.submit();
        match &self.target {
            None => self.read(0, bytemuck::pod_collect_to_vec::<u8, f32>),
            Some(target) => {
                let [width, height] = self.pixels.map(|side| side as usize);
                let (bytes, pitch) = self.shader.gpu.read_texture(target, 4)?;
                let rows = bytes.chunks(pitch).take(height);
                Ok(rows.flat_map(|row| bytemuck::pod_collect_to_vec::<u8, f32>(&row[..4 * width])).collect())
            }
        }
    }

    fn submit(&self) {
        let gpu = self.shader.gpu;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode(&mut encoder, &Marks::none());
        gpu.queue.submit([encoder.finish()]);
    }

    fn encode(&self, encoder: &mut wgpu::CommandEncoder, marks: &Marks<'_>) {
        let [x, y] = self.pixels.map(|side| side.div_ceil(TILE));
        match &self.shader.pipeline {
            Pipeline::Compute(pipeline) => {
                let mut pass = self.compute_pass(encoder, pipeline, marks.compute());
                pass.dispatch_workgroups(x, y, 1);
            }
            Pipeline::Queue(glance, queue) => {
                let [(_, _), (work, _), (_, _), (groups, _)] = self.buffers.as_slice() else { return };
                self.shader.gpu.queue.write_buffer(work, 0, &WORK);
                let [first, last] = marks.span();
                self.compute_pass(encoder, glance, first).dispatch_workgroups(x, y, 1);
                // What a shader can write cannot say how often it is run.
                encoder.copy_buffer_to_buffer(work, 0, groups, 0, WORK.len() as u64);
                self.compute_pass(encoder, queue, last).dispatch_workgroups_indirect(groups, 0);
            }
            Pipeline::Render(pipeline) => self.draw(encoder, marks, &[pipeline]),
            Pipeline::Marked(glance, marked) => self.draw(encoder, marks, &[glance, marked]),
        }
    }

    fn compute_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> wgpu::ComputePass<'e> {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(1, &self.output, &[]);
        pass.set_pipeline(pipeline);
        pass
    }

    /// Covers the picture with one pipeline after the other.
    fn draw(&self, encoder: &mut wgpu::CommandEncoder, marks: &Marks<'_>, pipelines: &[&wgpu::RenderPipeline]) {
        let view = self.target.as_ref().map(|target| target.create_view(&wgpu::TextureViewDescriptor::default()));
        let attachment = view.as_ref().map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
        });
        let depth_stencil = self.marks.as_ref().map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard }),
            stencil_ops: None,
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[attachment],
            depth_stencil_attachment: depth_stencil,
            timestamp_writes: marks.render(),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame, &[]);
        pass.set_bind_group(1, &self.output, &[]);
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, 0..1);
        }
    }

    fn read<R>(&self, buffer: usize, read: impl FnOnce(&[u8]) -> R) -> Result<R, Failure> {
        let gpu = self.shader.gpu;
        let Some((source, size)) = self.buffers.get(buffer) else {
            let message = format!("a pass for `{}` has no such output", self.shader.output.name());
            return Err(Failure::bare("", Diagnostic::error(codes::DEVICE, message)));
        };
        gpu.read_buffer(source, *size, read)
    }
}

fn frame_layout(gpu: &Gpu, stage: wgpu::ShaderStages) -> wgpu::BindGroupLayout {
    let texture = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: stage,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    };
    let entries = [
        wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: stage,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        },
        texture(1),
        wgpu::BindGroupLayoutEntry {
            binding: 2,
            visibility: stage,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
            count: None,
        },
        texture(3),
        texture(4),
        storage(5, stage, true),
    ];
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("frame"), entries: &entries })
}

fn storage(binding: u32, stage: wgpu::ShaderStages, read_only: bool) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: stage,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

/// A pipeline whose fragment shader covers the picture; `compare` if there are marks.
fn cover(
    gpu: &Gpu,
    layout: &wgpu::PipelineLayout,
    module: &wgpu::ShaderModule,
    options: &wgpu::PipelineCompilationOptions<'_>,
    entry: &str,
    compare: Option<wgpu::CompareFunction>,
) -> wgpu::RenderPipeline {
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("visibility"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("cover"),
            compilation_options: options.clone(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: compare.map(|compare| wgpu::DepthStencilState {
            format: MARKS,
            depth_write_enabled: Some(compare == wgpu::CompareFunction::Always),
            depth_compare: Some(compare),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: options.clone(),
            targets: &[Some(wgpu::TextureFormat::R32Float.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
