//! A compute shader and the storage buffers that it works on.

use std::borrow::Cow;

use wgpu::util::DeviceExt;

use super::Gpu;
use crate::diag::Failure;
use crate::emit::Validated;

/// The number of a binding, and whether the shader only reads it.
pub(crate) type Binding = (u32, bool);

/// A compute shader on a device.
#[derive(Debug)]
pub(crate) struct Compute {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
}

impl Compute {
    /// Compiles the only entry point of a module. The bindings are written down rather than derived from the
    /// shader, which may leave out what no case uses.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(crate) fn new(
        gpu: &Gpu,
        label: &str,
        module: Validated,
        bindings: impl IntoIterator<Item = Binding>,
    ) -> Result<Self, Failure> {
        let device = &gpu.device;
        let label = Some(label);
        let source = wgpu::ShaderSource::Naga(Cow::Owned(module.module));
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor { label, source });
        let entries: Vec<_> = bindings.into_iter().map(storage_binding).collect();
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries: &entries });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label,
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        gpu.check()?;
        Ok(Self { pipeline, layout })
    }

    /// Buffers for its bindings.
    pub(crate) fn bind<'b>(
        &self,
        gpu: &Gpu,
        buffers: impl IntoIterator<Item = (u32, &'b wgpu::Buffer)>,
    ) -> wgpu::BindGroup {
        let entry = |(binding, buffer): (u32, &'b wgpu::Buffer)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        };
        let entries: Vec<_> = buffers.into_iter().map(entry).collect();
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &self.layout, entries: &entries };
        gpu.device.create_bind_group(&descriptor)
    }

    /// Records runs of so many workgroups, one after the other.
    pub(crate) fn record(&self, pass: &mut wgpu::ComputePass<'_>, group: &wgpu::BindGroup, groups: u32, runs: u32) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        for _ in 0..runs {
            pass.dispatch_workgroups(groups, 1, 1);
        }
    }

    /// Runs so many workgroups, then shows the first bytes of one of the buffers.
    ///
    /// # Errors
    /// When the device fails.
    pub(crate) fn run<R>(
        &self,
        gpu: &Gpu,
        group: &wgpu::BindGroup,
        groups: u32,
        (out, size): (&wgpu::Buffer, u64),
        read: impl FnOnce(&[u8]) -> R,
    ) -> Result<R, Failure> {
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            self.record(&mut pass, group, groups, 1);
        }
        gpu.queue.submit([encoder.finish()]);
        gpu.read_buffer(out, size, read)
    }
}

impl Gpu {
    /// A storage buffer with these contents.
    pub(crate) fn storage(&self, label: &str, contents: &[u32]) -> wgpu::Buffer {
        self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some(label),
            contents: bytemuck::cast_slice(contents),
            usage: wgpu::BufferUsages::STORAGE,
        })
    }

    /// A storage buffer of zeros that shaders write and [`Compute::run`] reads back.
    pub(crate) fn results(&self, label: &str, size: u64) -> wgpu::Buffer {
        self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        })
    }
}

fn storage_binding((binding, read_only): Binding) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}
