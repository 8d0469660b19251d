//! Plans of a table as passes that can be timed.

use std::time::Duration;

use super::Gpu;
use super::kernel::Names;
use super::pass::{Compute, Module};
use super::timing::Stopwatch;
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::kernel::columns::{Entry, Layout, WORKGROUP};
use crate::emit::kernel::timed::{wgsl_floor, wgsl_timed};
use crate::emit::{lookup_words, wgsl_module};
use crate::eval::Columns;
use crate::jury::words::{fetched_words, plain_words};
use crate::plan::KeyLayout;
use crate::program::Program;
use crate::prove::Proved;

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
        let all = 0..columns.len();
        let workload = Self {
            rows: columns.len() as u32,
            plain: gpu.storage("plain", &plain_words(program, &key, Entry::Key, columns, all.clone())),
            fetched: (layout.fetched > 0).then(|| gpu.storage("fetched", &fetched_words(program, columns, all))),
            out: gpu.results("out", (4 * columns.len().max(1) * layout.values) as u64),
        };
        gpu.check()?;
        Ok(workload)
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.rows as usize
    }
}

/// A pass over a [`Workload`].
#[derive(Debug)]
pub struct Timed {
    module: Module,
    compute: Compute,
    names: Names,
    lookup: Option<wgpu::Buffer>,
    rows_of_thread: u32,
}

impl Timed {
    /// Evaluates a plan at every row; a thread does so many of them.
    ///
    /// # Errors
    /// When the source is refused; that would be a bug of the emitter or the driver.
    pub fn plan(gpu: &Gpu, proved: &Proved<'_>, rows_of_thread: u32) -> Result<Self, Failure> {
        let lookup = lookup_words(proved.plan());
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
        let module = Module::new(gpu, &program.name, wgsl_module(program, source)?)?;
        let compute = module.compute(gpu, module.only_compute()?, &[])?;
        let lookup = lookup.map(|words| gpu.storage("lookup", &words));
        gpu.check()?;
        Ok(Self { module, compute, names: Names::new(program), lookup, rows_of_thread })
    }

    /// Goes over a workload `repeats` times in one pass and returns the time of one of them.
    ///
    /// # Errors
    /// When the device fails.
    pub fn time(&self, gpu: &Gpu, watch: &Stopwatch<'_>, load: &Workload, repeats: u32) -> Result<Duration, Failure> {
        let (fetched, lookup) = (load.fetched.as_ref(), self.lookup.as_ref());
        let bound = self.names.bind(gpu, &self.module, &load.plain, fetched, &load.out, lookup)?;
        let work = self.compute.covering([load.rows / self.rows_of_thread, 1, 1]);
        let time = watch.time(|encoder, marks| self.compute.encode(encoder, &bound, work, repeats, marks.compute()))?;
        gpu.check()?;
        Ok(time / repeats.max(1))
    }
}
