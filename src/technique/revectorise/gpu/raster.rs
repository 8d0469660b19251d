//! The passes before a technique, by rasterising: what the light sees, and where
//! what the camera sees lies in it.
//!
//! They make the same [`ShadowMap`] and [`Receivers`] as the rays of
//! [`passes`](crate::technique::revectorise::stage), but for pixels at the borders of faces.

use glam::DVec3;
use wgpu::util::DeviceExt;

use super::frame::{check_map, check_picture};
use crate::diag::{Diagnostic, Failure, codes};
use crate::gpu::Gpu;
use crate::scene::light::Punctual;
use crate::scene::view::View;
use crate::technique::revectorise::stage::{Bias, Stage};
use crate::technique::revectorise::{DEPTH_UNIT, Receiver, ReceiverKind, Receivers, ShadowMap, max_slope};

const SHADER: &str = include_str!("wgsl/raster.wgsl");

/// What a corner of a face consists of: clip coordinates of light and camera, anchor, slope.
const WORDS: usize = 14;

/// What a camera sees.
#[derive(Debug, Clone)]
pub struct GpuPicture {
    /// Where it lies in the shadow map.
    pub receivers: Receivers,
    /// For each pixel the number of the triangle that is seen, in the scene's order; `None` for the background.
    pub triangles: Vec<Option<u32>>,
}

/// A scene on a device.
#[derive(Debug)]
pub struct Raster<'g, 's> {
    gpu: &'g Gpu,
    stage: &'s Stage<'s>,
    module: wgpu::ShaderModule,
    group: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
}

impl<'g, 's> Raster<'g, 's> {
    /// Prepares a scene.
    ///
    /// # Errors
    /// When the device fails.
    pub fn new(gpu: &'g Gpu, stage: &'s Stage<'s>) -> Result<Self, Failure> {
        let label = Some("raster");
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(SHADER.into()),
        });
        let group = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&group)],
            immediate_size: 0,
        });
        gpu.check()?;
        Ok(Self { gpu, stage, module, group, layout })
    }

    /// What the light sees.
    ///
    /// # Errors
    /// When the size is beyond the device's limits, or the device fails.
    pub fn shadow_map(&self, size: u32, bias: Bias) -> Result<ShadowMap, Failure> {
        check_map(self.gpu, size)?;
        let depth = self.texture([size; 2], wgpu::TextureFormat::Depth32Float);
        self.draw("from_light", "shadow_map", [size, size], size, bias, &[], &depth)?;
        let depth = self.rows::<f32>(&depth)?;
        Ok(ShadowMap { size, depth })
    }

    /// What the camera sees, in a shadow map of a size.
    ///
    /// # Errors
    /// When the sizes are beyond the device's limits, or the device fails.
    pub fn picture(&self, width: u32, height: u32, size: u32) -> Result<GpuPicture, Failure> {
        check_map(self.gpu, size)?;
        check_picture(self.gpu, width, height)?;
        let pixels = [width, height];
        let depth = self.texture(pixels, wgpu::TextureFormat::Depth32Float);
        let targets = [
            self.texture(pixels, wgpu::TextureFormat::Rgba32Float),
            self.texture(pixels, wgpu::TextureFormat::Rg32Float),
            self.texture(pixels, wgpu::TextureFormat::R32Uint),
        ];
        self.draw("from_camera", "receivers", pixels, size, Bias::default(), &targets, &depth)?;
        let [points, slopes, faces] = targets;
        let points = self.rows::<[f32; 4]>(&points)?;
        let slopes = self.rows::<[f32; 2]>(&slopes)?;
        let faces = self.rows::<u32>(&faces)?;
        let receivers = points.into_iter().zip(slopes).zip(&faces).map(|(([u, v, z, kind], [dz_dx, dz_dy]), face)| {
            let kind = match (face, kind) {
                (0, _) => return Receiver::default(),
                (_, 1.0) => ReceiverKind::Facing,
                _ => ReceiverKind::Away,
            };
            Receiver { u, v, z, kind, dz_dx, dz_dy }
        });
        let receivers = Receivers { width, height, points: receivers.collect() };
        Ok(GpuPicture { receivers, triangles: faces.iter().map(|face| face.checked_sub(1)).collect() })
    }

    /// The corners of all faces, for a picture.
    fn vertices(&self, camera: &View) -> Vec<f32> {
        let triangles = self.stage.rays.triangles();
        let mut words = Vec::with_capacity(3 * WORDS * triangles.len());
        for triangle in triangles {
            let corners = triangle.corners;
            let (anchor, slope) = self.plane(corners);
            for corner in corners {
                let clips = [&self.stage.light_view, camera].map(|view| (view.matrix * corner.extend(1.0)).as_vec4());
                words.extend(clips.iter().flat_map(|clip| clip.to_array()));
                words.extend(anchor);
                words.extend(slope);
            }
        }
        words
    }

    /// The plane of a face over the light's square: a place with its depth and whether the side that
    /// the camera sees faces the light, and the slopes.
    fn plane(&self, corners: [DVec3; 3]) -> ([f32; 4], [f32; 2]) {
        let view = &self.stage.light_view;
        let Some(plane) = view.plane(corners) else { return ([0.0; 4], [0.0; 2]) };
        let places = corners.into_iter().filter_map(|corner| view.project(corner));
        let anchors = places.map(|(place, _)| {
            let place = place.clamp(glam::DVec2::ZERO, glam::DVec2::ONE);
            (place, plane.at(place.x, place.y))
        });
        // Single precision is finest where depths are small.
        let nearest = anchors.min_by(|a, b| (a.1 - 0.5).abs().total_cmp(&(b.1 - 0.5).abs()));
        let Some((place, depth)) = nearest else { return ([0.0; 4], [0.0; 2]) };
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let to_light = match self.stage.light {
            Punctual::Directional(light) => -light.direction,
            Punctual::Spot(light) => light.position - corners[0],
        };
        let to_eye = self.stage.scene.camera.eye - corners[0];
        let facing = normal.dot(to_light) * normal.dot(to_eye) > 0.0;
        let anchor = [place.x as f32, place.y as f32, depth as f32, f32::from(u8::from(facing))];
        (anchor, [plane.du as f32, plane.dv as f32])
    }

    fn texture(&self, [width, height]: [u32; 2], format: wgpu::TextureFormat) -> wgpu::Texture {
        self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("raster"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Draws all faces.
    #[allow(clippy::too_many_arguments)]
    fn draw(
        &self,
        vertex: &str,
        fragment: &str,
        pixels: [u32; 2],
        size: u32,
        bias: Bias,
        targets: &[wgpu::Texture],
        depth: &wgpu::Texture,
    ) -> Result<(), Failure> {
        let gpu = self.gpu;
        let camera = self.stage.scene.camera.view(pixels[0], pixels[1]);
        let vertices = self.vertices(&camera);
        let bytes: &[u8] = bytemuck::cast_slice(&vertices);
        let most = gpu.device.limits().max_buffer_size;
        if bytes.len() as u64 > most {
            let triangles = vertices.len() / (3 * WORDS);
            let error = Diagnostic::error(codes::DEVICE, format!("a scene of {triangles} triangles does not fit"))
                .help(format!("buffers on {} have at most {most} bytes; try `--backend cpu`", gpu.describe()));
            return Err(Failure::bare("", error));
        }
        let init = |label, contents, usage| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let vertices = init("corners", bytes, wgpu::BufferUsages::VERTEX);
        let parameters: [f32; 8] = [size as f32, max_slope(size), DEPTH_UNIT, bias.constant, bias.slope, 0.0, 0.0, 0.0];
        let uniform = init("goal", bytemuck::cast_slice(&parameters), wgpu::BufferUsages::UNIFORM);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.group,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let formats: Vec<_> = targets.iter().map(|target| Some(target.format().into())).collect();
        let pipeline = self.pipeline(vertex, fragment, &formats);
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let views: Vec<wgpu::TextureView> = targets.iter().map(view).collect();
        let attachments: Vec<_> = views
            .iter()
            .map(|view| {
                let ops = wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                };
                Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
            })
            .collect();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &attachments,
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &view(depth),
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            pass.set_vertex_buffer(0, vertices.slice(..));
            pass.draw(0..(bytes.len() / (4 * WORDS)) as u32, 0..1);
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.check()
    }

    fn pipeline(
        &self,
        vertex: &str,
        fragment: &str,
        formats: &[Option<wgpu::ColorTargetState>],
    ) -> wgpu::RenderPipeline {
        let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x2];
        let options = wgpu::PipelineCompilationOptions::default();
        self.gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(vertex),
                compilation_options: options.clone(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: 4 * WORDS as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &attributes,
                })],
            },
            // Both sides of a face are there.
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Less),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(fragment),
                compilation_options: options,
                targets: formats,
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    /// The texels of a texture, row by row.
    fn rows<T: bytemuck::Pod>(&self, texture: &wgpu::Texture) -> Result<Vec<T>, Failure> {
        let texel = size_of::<T>();
        let (bytes, pitch) = self.gpu.read_texture(texture, texel as u32)?;
        let width = texture.width() as usize * texel;
        Ok(bytes.chunks(pitch).flat_map(|row| bytemuck::pod_collect_to_vec::<u8, T>(&row[..width])).collect())
    }
}
