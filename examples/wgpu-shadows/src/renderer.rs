//! The passes: shadow map once, then for each frame what the camera sees, and
//! its light by the chosen technique.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use umbrage::picture::sheet;
use umbrage::scene::Scene;
use umbrage::scene::light::Punctual;
use umbrage::technique::revectorise::{Settings, Variant};
use wgpu::util::DeviceExt;

use crate::feedback::{CASES, Collector};
use crate::geometry::{ATTRIBUTES, Stage, Vertex, vertices};
use crate::gpu::Gpu;
use crate::resources::{cleared, cleared_depth, group, layout, sampler, storage, texture, texture_view, uniform};
use crate::shaders::{PLANS, Tables};
use crate::view::View;

const GEOMETRY: &str = include_str!("wgsl/geometry.wgsl");

/// The map's depths, in a texture that can be gathered from. Its border is infinitely far away.
const MAP: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// What the camera's pass writes: places in the map, slopes, colours.
const SEEN: [wgpu::TextureFormat; 3] =
    [wgpu::TextureFormat::Rgba32Float, wgpu::TextureFormat::Rg32Float, wgpu::TextureFormat::Rgba16Float];

/// A last pass is made for each of these.
type Key = (Variant, usize, Counted);

/// What the last pass counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Counted {
    Nothing,
    /// Pixels by case, which it shows.
    Cases,
    /// Results by line of the table.
    Hits,
}

impl Counted {
    fn of(view: &View) -> Self {
        match (view.hits, view.cases) {
            (true, _) => Counted::Hits,
            (false, true) => Counted::Cases,
            (false, false) => Counted::Nothing,
        }
    }
}

/// A scene on a device.
pub(crate) struct Renderer {
    pub(crate) gpu: Gpu,
    scene: Scene,
    light: Punctual,
    texels: u32,
    corners: wgpu::Buffer,
    corner_count: u32,
    /// The uniforms of geometry.wgsl and of the search.
    stage: wgpu::Buffer,
    frame: wgpu::Buffer,
    stage_group: wgpu::BindGroup,
    camera_pass: wgpu::RenderPipeline,
    map: wgpu::TextureView,
    nearest: wgpu::Sampler,
    /// Colours of cases, and how many pixels took each.
    palette: wgpu::Buffer,
    counts: wgpu::Buffer,
    groups: [wgpu::BindGroupLayout; 2],
    target: wgpu::TextureFormat,
    light_passes: HashMap<Key, wgpu::RenderPipeline>,
    pub(crate) tables: Tables,
    picture: Picture,
    pub(crate) collector: Collector,
}

/// What depends on the size of the picture.
struct Picture {
    size: [u32; 2],
    seen: [wgpu::TextureView; 3],
    depth: wgpu::TextureView,
    groups: [wgpu::BindGroup; 2],
}

impl Renderer {
    /// Prepares a scene for pictures in a format, and renders its shadow map: the light stands still.
    pub(crate) fn new(gpu: Gpu, scene: &Scene, texels: u32, target: wgpu::TextureFormat) -> Result<Self, String> {
        let device = &gpu.device;
        let most = device.limits().max_texture_dimension_2d;
        if texels + 2 > most {
            return Err(format!("error: a shadow map has at most {} texels per side on {}", most - 2, gpu.name()));
        }
        let light = scene.punctual("wgpu-shadows").map_err(|error| error.to_string())?;
        let vertices = vertices(scene, &light);
        let bytes: &[u8] = bytemuck::cast_slice(&vertices);
        if bytes.len() as u64 > device.limits().max_buffer_size {
            return Err(format!("error: the scene has too many triangles for {}", gpu.name()));
        }
        let corners = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("corners"),
            contents: bytes,
            usage: wgpu::BufferUsages::VERTEX,
        });
        let buffer = |label, size, usage| {
            let usage = usage | wgpu::BufferUsages::COPY_DST;
            device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let stage = buffer("stage", size_of::<Stage>() as u64, wgpu::BufferUsages::UNIFORM);
        let frame = buffer("frame", 32, wgpu::BufferUsages::UNIFORM);
        let palette = buffer("palette", 16 * CASES as u64, wgpu::BufferUsages::STORAGE);
        let counts = buffer("counts", 4 * CASES as u64, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        gpu.queue.write_buffer(&palette, 0, bytemuck::cast_slice(&colours()));

        let stage_layout = layout(device, "stage", &[uniform()], wgpu::ShaderStages::VERTEX_FRAGMENT);
        let groups = [
            layout(
                device,
                "search",
                &[uniform(), texture(), sampler(), texture(), texture()],
                wgpu::ShaderStages::FRAGMENT,
            ),
            layout(device, "light", &[texture(), storage(true), storage(false)], wgpu::ShaderStages::FRAGMENT),
        ];
        let stage_group = group(device, &stage_layout, [stage.as_entire_binding()]);
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("geometry"),
            source: wgpu::ShaderSource::Wgsl(GEOMETRY.into()),
        });
        let pass = |vertex, fragment, targets: &[wgpu::TextureFormat]| {
            geometry_pass(device, &stage_layout, &module, vertex, fragment, targets)
        };
        let light_pass = pass("from_light", "shadow_map", &[MAP]);
        let camera_pass = pass("from_camera", "receivers", &SEEN);
        let side = [texels + 2; 2];
        let map = texture_view(device, side, MAP);
        let nearest = device.create_sampler(&wgpu::SamplerDescriptor::default());
        let picture = Picture::new(device, [16, 16], &groups, [&frame, &palette, &counts], &map, &nearest);
        let collector = Collector::new(&gpu);
        let renderer = Self {
            corner_count: vertices.len() as u32,
            scene: scene.clone(),
            light,
            light_passes: HashMap::new(),
            tables: Tables::built(),
            gpu,
            texels,
            corners,
            stage,
            frame,
            stage_group,
            camera_pass,
            map,
            nearest,
            palette,
            counts,
            groups,
            target,
            picture,
            collector,
        };
        renderer.shadow_map(&light_pass, &texture_view(&renderer.gpu.device, side, DEPTH));
        Ok(renderer)
    }

    /// Renders what the light sees.
    fn shadow_map(&self, pipeline: &wgpu::RenderPipeline, depth: &wgpu::TextureView) {
        self.write_stage(&View::of(&self.scene.camera));
        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let far = wgpu::Color { r: f64::from(f32::MAX), g: 0.0, b: 0.0, a: 0.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            color_attachments: &[Some(cleared(&self.map, far))],
            depth_stencil_attachment: Some(cleared_depth(depth)),
            ..Default::default()
        });
        let side = self.texels as f32;
        pass.set_viewport(1.0, 1.0, side, side, 0.0, 1.0);
        pass.set_scissor_rect(1, 1, self.texels, self.texels);
        self.draw_faces(&mut pass, pipeline);
        drop(pass);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Makes room for pictures of a size.
    pub(crate) fn resize(&mut self, size: [u32; 2]) {
        if self.picture.size != size {
            let buffers = [&self.frame, &self.palette, &self.counts];
            self.picture = Picture::new(&self.gpu.device, size, &self.groups, buffers, &self.map, &self.nearest);
        }
    }

    /// Takes the table in a file. If that fails, everything stays as it is.
    pub(crate) fn take_table(&mut self, path: &Path, view: &View) -> Result<String, String> {
        let (tables, name) = self.tables.with(path)?;
        let key = (view.technique, tables.suitable(view.technique, view.plan), Counted::of(view));
        if view.technique.table().is_some_and(|table| table.name == name) {
            // Only now it is known whether it fits the search.
            let pipeline = self.light_pass(&tables, key)?;
            self.light_passes.retain(|(technique, ..), _| technique.table().is_none_or(|table| table.name != name));
            self.light_passes.insert(key, pipeline);
        }
        self.light_passes.retain(|other, _| *other == key || other.0.table().is_none_or(|table| table.name != name));
        self.tables = tables;
        Ok(name)
    }

    /// Renders a view into a target. Feedback about it arrives later, at [`Collector::take`].
    pub(crate) fn render(&mut self, view: &View, target: &wgpu::TextureView) -> Result<(), String> {
        let key = (view.technique, self.tables.suitable(view.technique, view.plan), Counted::of(view));
        if !self.light_passes.contains_key(&key) {
            let pipeline = self.light_pass(&self.tables, key)?;
            self.light_passes.insert(key, pipeline);
        }
        self.write_stage(view);
        let settings = Settings::default();
        let [width, height] = self.picture.size;
        // As `Frame` in frame.wgsl: size of picture and map, search limit, no bias along walks, reach of the kernel.
        let frame = [width, height, self.texels, settings.search_limit, 0, settings.pcf / 2, 0, 0];
        self.gpu.queue.write_buffer(&self.frame, 0, bytemuck::cast_slice(&frame));

        let mut encoder = self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.counts, 0, None);
        let [r, g, b] = self.scene.background;
        let background = wgpu::Color { r, g, b, a: 0.0 };
        let [points, slopes, colours] = &self.picture.seen;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("what the camera sees"),
            color_attachments: &[
                Some(cleared(points, wgpu::Color::TRANSPARENT)),
                Some(cleared(slopes, wgpu::Color::TRANSPARENT)),
                Some(cleared(colours, background)),
            ],
            depth_stencil_attachment: Some(cleared_depth(&self.picture.depth)),
            timestamp_writes: self.collector.marks(Some(0), 1),
            ..Default::default()
        });
        self.draw_faces(&mut pass, &self.camera_pass);
        drop(pass);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadows and light"),
            color_attachments: &[Some(cleared(target, wgpu::Color::BLACK))],
            timestamp_writes: self.collector.marks(None, 2),
            ..Default::default()
        });
        pass.set_pipeline(&self.light_passes[&key]);
        for (index, group) in self.picture.groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.draw(0..3, 0..1);
        drop(pass);
        let recorded = self.collector.record(&mut encoder, &self.counts);
        self.gpu.queue.submit([encoder.finish()]);
        if recorded {
            self.collector.submitted();
        }
        Ok(())
    }

    fn draw_faces(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.stage_group, &[]);
        pass.set_vertex_buffer(0, self.corners.slice(..));
        pass.draw(0..self.corner_count, 0..1);
    }

    fn write_stage(&self, view: &View) {
        let stage = Stage::new(&self.scene, &self.light, &view.camera(), self.picture.size, self.texels);
        self.gpu.queue.write_buffer(&self.stage, 0, bytemuck::bytes_of(&stage));
    }

    /// The last pass with a technique and a plan of its table.
    fn light_pass(&self, tables: &Tables, (technique, plan, counted): Key) -> Result<wgpu::RenderPipeline, String> {
        let text = tables.text(technique, plan, counted == Counted::Hits);
        let device = &self.gpu.device;
        let name = format!("{technique}, {}", PLANS[plan].name());
        let label = Some(name.as_str());
        self.gpu.guarded(|| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label,
                bind_group_layouts: &[Some(&self.groups[0]), Some(&self.groups[1])],
                immediate_size: 0,
            });
            let constants = [("CASES", f64::from(u8::from(counted == Counted::Cases)))];
            let options = wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label,
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("cover"),
                    compilation_options: options.clone(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState::default(),
                depth_stencil: None,
                multisample: wgpu::MultisampleState::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some("light"),
                    compilation_options: options,
                    targets: &[Some(self.target.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        })
    }
}

impl Picture {
    fn new(
        device: &wgpu::Device,
        size: [u32; 2],
        layouts: &[wgpu::BindGroupLayout; 2],
        [frame, palette, counts]: [&wgpu::Buffer; 3],
        map: &wgpu::TextureView,
        nearest: &wgpu::Sampler,
    ) -> Self {
        let seen = SEEN.map(|format| texture_view(device, size, format));
        let view = wgpu::BindingResource::TextureView;
        let search = [
            frame.as_entire_binding(),
            view(map),
            wgpu::BindingResource::Sampler(nearest),
            view(&seen[0]),
            view(&seen[1]),
        ];
        let light = [view(&seen[2]), palette.as_entire_binding(), counts.as_entire_binding()];
        let groups = [group(device, &layouts[0], search), group(device, &layouts[1], light)];
        Self { size, depth: texture_view(device, size, DEPTH), seen, groups }
    }
}

/// The colour of each case, linear.
fn colours() -> Vec<[f32; 4]> {
    let linear = |channel: u8| {
        let value = f32::from(channel) / 255.0;
        if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    (0..CASES)
        .map(|entry| {
            let [r, g, b] = case_colour(entry).map(linear);
            [r, g, b, 1.0]
        })
        .collect()
}

/// The colour of an entry of the palette, as in a picture.
pub(crate) fn case_colour(entry: usize) -> [u8; 3] {
    sheet::case_colour((entry + 1 < CASES).then_some(entry as u32)).0
}

/// Files of tables that have changed, taken one after the other; returns what was wrong with them.
pub(crate) fn take_tables(renderer: &mut Renderer, paths: &[PathBuf], view: &View) -> Result<(), String> {
    let problems: Vec<String> = paths.iter().filter_map(|path| renderer.take_table(path, view).err()).collect();
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n")) }
}

fn geometry_pass(
    device: &wgpu::Device,
    stage: &wgpu::BindGroupLayout,
    module: &wgpu::ShaderModule,
    vertex: &str,
    fragment: &str,
    targets: &[wgpu::TextureFormat],
) -> wgpu::RenderPipeline {
    let label = Some(fragment);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(stage)],
        immediate_size: 0,
    });
    let targets: Vec<_> = targets.iter().map(|format| Some((*format).into())).collect();
    let compilation_options = wgpu::PipelineCompilationOptions::default();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: compilation_options.clone(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vertex>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &ATTRIBUTES,
            })],
        },
        // Both sides of a face are there.
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(fragment),
            compilation_options,
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
