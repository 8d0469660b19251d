//! Render passes: triangles that cover a picture, or those of a scene.

use super::Gpu;
use super::pass::{Bound, Module};
use crate::diag::Failure;
use crate::emit::reflect::{Attribute, AttributeKind, Stage};

/// The parts of a render pipeline.
#[derive(Debug)]
pub(crate) struct Drawing<'d> {
    /// The vertex shader.
    pub(crate) vertex: &'d str,
    /// The fragment shader.
    pub(crate) fragment: &'d str,
    /// The formats of the targets, by location.
    pub(crate) targets: &'d [wgpu::TextureFormat],
    /// The depth test, if there is one.
    pub(crate) depth: Option<DepthTest>,
    /// Values for constants that can be overridden.
    pub(crate) constants: &'d [(&'d str, f64)],
}

/// A test against a depth buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DepthTest {
    /// The format of the buffer.
    pub(crate) format: wgpu::TextureFormat,
    /// When a pixel passes.
    pub(crate) passes: wgpu::CompareFunction,
    /// True if pixels that pass are written to the buffer.
    pub(crate) write: bool,
}

/// A render pipeline. Both sides of a face are drawn.
#[derive(Debug)]
pub(crate) struct Draw(wgpu::RenderPipeline);

/// The triangles that are drawn.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Triangles<'t> {
    /// One, whose corners the vertex shader makes of their numbers.
    Cover,
    /// Those of a buffer, with its number of corners.
    Corners(&'t wgpu::Buffer, u32),
}

/// The textures that a pass draws to. They are cleared first.
#[derive(Debug)]
pub(crate) struct Canvas<'c> {
    /// By location; cleared to zeros.
    pub(crate) targets: &'c [wgpu::TextureView],
    /// The depth buffer, if there is one.
    pub(crate) depth: Option<DepthBuffer<'c>>,
}

/// A depth buffer in use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthBuffer<'c> {
    /// The texture.
    pub(crate) view: &'c wgpu::TextureView,
    /// Its value before the first draw.
    pub(crate) clear: f32,
    /// True if it is needed after the pass.
    pub(crate) keep: bool,
}

impl Module {
    /// A render pipeline of two of its entry points. The layout of the corners follows from the vertex shader: its
    /// attributes lie one after the other, in the order of its text.
    ///
    /// # Errors
    /// When there are no such entry points, or the device refuses them.
    pub(crate) fn draw(&self, gpu: &Gpu, drawing: &Drawing<'_>) -> Result<Draw, Failure> {
        self.entry(drawing.fragment, Stage::Fragment)?;
        let (attributes, stride) = corners(&self.entry(drawing.vertex, Stage::Vertex)?.attributes);
        let corners = wgpu::VertexBufferLayout {
            array_stride: stride,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let buffers = [Some(corners)];
        let targets: Vec<_> = drawing.targets.iter().map(|format| Some((*format).into())).collect();
        let options = wgpu::PipelineCompilationOptions { constants: drawing.constants, ..Default::default() };
        let pipeline = gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.shader,
                entry_point: Some(drawing.vertex),
                compilation_options: options.clone(),
                buffers: if attributes.is_empty() { &[] } else { &buffers },
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: drawing.depth.map(|test| wgpu::DepthStencilState {
                format: test.format,
                depth_write_enabled: Some(test.write),
                depth_compare: Some(test.passes),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.shader,
                entry_point: Some(drawing.fragment),
                compilation_options: options,
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        gpu.check()?;
        Ok(Draw(pipeline))
    }
}

/// Encodes a render pass of some draws, one after the other.
pub(crate) fn encode(
    encoder: &mut wgpu::CommandEncoder,
    canvas: &Canvas<'_>,
    bound: &Bound,
    draws: &[(&Draw, Triangles<'_>)],
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) {
    let attachments: Vec<_> = canvas
        .targets
        .iter()
        .map(|view| {
            let load = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
            let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
            Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
        })
        .collect();
    let depth_stencil_attachment = canvas.depth.map(|DepthBuffer { view, clear, keep }| {
        let store = if keep { wgpu::StoreOp::Store } else { wgpu::StoreOp::Discard };
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store };
        wgpu::RenderPassDepthStencilAttachment { view, depth_ops: Some(ops), stencil_ops: None }
    });
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &attachments,
        depth_stencil_attachment,
        timestamp_writes,
        ..Default::default()
    });
    for (number, group) in (0..).zip(&bound.groups) {
        pass.set_bind_group(number, group, &[]);
    }
    for (draw, triangles) in draws {
        pass.set_pipeline(&draw.0);
        match *triangles {
            Triangles::Cover => pass.draw(0..3, 0..1),
            Triangles::Corners(buffer, count) => {
                pass.set_vertex_buffer(0, buffer.slice(..));
                pass.draw(0..count, 0..1);
            }
        }
    }
}

impl Gpu {
    /// The corners of triangles, in the layout of a vertex shader's attributes.
    pub(crate) fn corners(&self, label: &str, numbers: &[f32]) -> wgpu::Buffer {
        self.filled(label, bytemuck::cast_slice(numbers), wgpu::BufferUsages::VERTEX)
    }
}

/// The layout of corners whose attributes lie one after the other, and the bytes of a corner.
fn corners(attributes: &[Attribute]) -> (Vec<wgpu::VertexAttribute>, u64) {
    let mut offset = 0;
    let layout = attributes.iter().map(|attribute| {
        let format = match (attribute.kind, attribute.components) {
            (AttributeKind::Float, 2) => wgpu::VertexFormat::Float32x2,
            (AttributeKind::Float, 3) => wgpu::VertexFormat::Float32x3,
            (AttributeKind::Float, 4) => wgpu::VertexFormat::Float32x4,
            (AttributeKind::Float, _) => wgpu::VertexFormat::Float32,
            (AttributeKind::Sint, 2) => wgpu::VertexFormat::Sint32x2,
            (AttributeKind::Sint, 3) => wgpu::VertexFormat::Sint32x3,
            (AttributeKind::Sint, 4) => wgpu::VertexFormat::Sint32x4,
            (AttributeKind::Sint, _) => wgpu::VertexFormat::Sint32,
            (AttributeKind::Uint, 2) => wgpu::VertexFormat::Uint32x2,
            (AttributeKind::Uint, 3) => wgpu::VertexFormat::Uint32x3,
            (AttributeKind::Uint, 4) => wgpu::VertexFormat::Uint32x4,
            (AttributeKind::Uint, _) => wgpu::VertexFormat::Uint32,
        };
        let entry = wgpu::VertexAttribute { format, offset, shader_location: attribute.location };
        offset += format.size();
        entry
    });
    (layout.collect(), offset)
}
