//! Plans of a table as passes that can be timed.

use std::borrow::Cow;
use std::time::Duration;

use wgpu::util::DeviceExt;

use super::Gpu;
use super::kernel::{fetched_words, plain_words, storage_binding};
use super::timing::Stopwatch;
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::harness::{Entry, Layout, WORKGROUP, reads_lookup};
use crate::emit::timed::{wgsl_floor, wgsl_timed};
use crate::emit::{lookup_words, wgsl_module};
use crate::eval::Columns;
use crate::plan::{KeyLayout, Proved};
use crate::program::Program;

/// Columns of inputs that stay on the device, with room for the results.
#[derive(Debug)]
pub struct Workload {
    rows: u32,
    plain: wgpu::Buffer,
    fetched: Option<wgpu::Buffer>,
    out: wgpu::Buffer,
}

impl Workload {
    /// Moves columns to a device.
    ///
    /// # Errors
    /// When the device has not room for them.
    pub fn new(gpu: &Gpu, program: &Program, columns: &Columns<f32>) -> Result<Self, Failure> {
        let layout = Layout::new(program, Entry::Key);
        let limits = gpu.device.limits();
        let widest = layout.plain.max(layout.fetched).max(layout.values) as u64;
        let needed = 4 * (1 + columns.len() as u64 * widest);
        let available = limits.max_storage_buffer_binding_size;
        let groups = columns.len().div_ceil(WORKGROUP as usize) as u64;
        if needed > available || groups > u64::from(limits.max_compute_workgroups_per_dimension) {
            let message = format!("{} rows are more than the device takes at once", columns.len());
            return Err(Failure::bare("", Diagnostic::error(codes::DEVICE, message).help("use fewer: `--rows`")));
        }
        let key = KeyLayout::new(program)
            .map_err(|reason| Failure::bare(&*program.source.name, Diagnostic::error(codes::NOT_APPLICABLE, reason)))?;
        let storage = |words: &[u32]| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("inputs"),
                contents: bytemuck::cast_slice(words),
                usage: wgpu::BufferUsages::STORAGE,
            })
        };
        let all = 0..columns.len();
        let workload = Self {
            rows: columns.len() as u32,
            plain: storage(&plain_words(program, &key, Entry::Key, columns, all.clone())),
            fetched: (layout.fetched > 0).then(|| storage(&fetched_words(program, columns, all))),
            out: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("results"),
                size: (4 * columns.len().max(1) * layout.values) as u64,
                usage: wgpu::BufferUsages::STORAGE,
                mapped_at_creation: false,
            }),
        };
        gpu.check()?;
        Ok(workload)
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.rows as usize
    }
}

/// A pass over a [`Workload`].
#[derive(Debug)]
pub struct Timed {
    pipeline: wgpu::ComputePipeline,
    group_layout: wgpu::BindGroupLayout,
    lookup: Option<wgpu::Buffer>,
    fetches: bool,
    rows_of_thread: u32,
}

impl Timed {
    /// Evaluates a plan at every row; a thread does so many of them.
    ///
    /// # Errors
    /// When the source is refused; that would be a bug of the emitter or the driver.
    pub fn plan(gpu: &Gpu, proved: &Proved<'_>, rows_of_thread: u32) -> Result<Self, Failure> {
        let lookup = reads_lookup(proved).then(|| lookup_words(proved.plan()));
        Self::new(gpu, proved.plan().program, &wgsl_timed(proved, rows_of_thread), lookup, rows_of_thread)
    }

    /// Reads and writes the same data as a plan of this program, and computes nothing.
    ///
    /// # Errors
    /// As [`Self::plan`].
    pub fn floor(gpu: &Gpu, program: &Program, rows_of_thread: u32) -> Result<Self, Failure> {
        Self::new(gpu, program, &wgsl_floor(program, rows_of_thread), None, rows_of_thread)
    }

    fn new(
        gpu: &Gpu,
        program: &Program,
        source: &str,
        lookup: Option<Vec<u32>>,
        rows_of_thread: u32,
    ) -> Result<Self, Failure> {
        let module = wgsl_module(program, source)?;
        let shader = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&program.name),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module.module)),
        });
        let fetches = !program.fetched.is_empty();
        let mut bindings = vec![storage_binding(0, true), storage_binding(2, false)];
        bindings.extend(fetches.then(|| storage_binding(1, true)));
        bindings.extend(lookup.as_ref().map(|_| storage_binding(3, true)));
        let group_layout =
            gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &bindings });
        let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&group_layout)],
            immediate_size: 0,
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(&program.name),
            layout: Some(&layout),
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let lookup = lookup.map(|words| {
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("lookup"),
                contents: bytemuck::cast_slice(&words),
                usage: wgpu::BufferUsages::STORAGE,
            })
        });
        gpu.check()?;
        Ok(Self { pipeline, group_layout, lookup, fetches, rows_of_thread })
    }

    /// Goes over a workload `repeats` times in one pass and returns the time of one of them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn time(&self, gpu: &Gpu, watch: &Stopwatch<'_>, load: &Workload, repeats: u32) -> Result<Duration, Failure> {
        let mut entries = vec![(0, &load.plain), (2, &load.out)];
        entries.extend(load.fetched.as_ref().filter(|_| self.fetches).map(|buffer| (1, buffer)));
        entries.extend(self.lookup.as_ref().map(|buffer| (3, buffer)));
        let entries: Vec<_> = entries
            .into_iter()
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &self.group_layout,
            entries: &entries,
        });
        let time = watch.time(|encoder, marks| {
            let mut pass = encoder
                .begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes: marks.compute() });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &group, &[]);
            for _ in 0..repeats {
                pass.dispatch_workgroups((load.rows / self.rows_of_thread).div_ceil(WORKGROUP), 1, 1);
            }
        })?;
        gpu.check()?;
        Ok(time / repeats.max(1))
    }
}
