//! A table as a compute pipeline.

use super::Gpu;
use super::pass::{Bound, Compute, Module, Resources};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::kernel::columns::{Entry, Layout, buffer_name, glsl_columns, wgsl_columns};
use crate::emit::{glsl_module, lookup_words, wgsl_module};
use crate::eval::Columns;
use crate::jury::words::{fetched_words, plain_words, read};
use crate::jury::{Language, Outputs};
use crate::plan::KeyLayout;
use crate::program::Program;
use crate::prove::Proved;

/// Most rows of one dispatch.
const MAX_ROWS: usize = 1 << 18;

/// A plan on a device.
#[derive(Debug)]
pub struct Kernel<'a, 'p> {
    gpu: &'a Gpu,
    program: &'p Program,
    key: KeyLayout,
    entry: Entry,
    layout: Layout,
    module: Module,
    compute: Compute,
    names: Names,
    lookup: Option<wgpu::Buffer>,
}

impl<'a, 'p> Kernel<'a, 'p> {
    /// Compiles a proved plan for a device.
    ///
    /// # Errors
    /// When the source is refused; that would be a bug of the emitter or the driver.
    ///
    /// ```no_run
    /// use umbrage::emit::kernel::columns::Entry;
    /// use umbrage::eval::Columns;
    /// use umbrage::gpu::{AdapterChoice, Gpu, Kernel, Language};
    /// use umbrage::plan::{Plan, Shape};
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let proved = Plan::proved(&program, Shape::Ladder)?;
    /// let gpu = Gpu::open(&AdapterChoice::Any)?;
    /// let points = program.examples.iter().map(|example| &example.inputs);
    /// let columns = Columns::from_rows(&program, points).unwrap();
    /// let outputs = Kernel::new(&gpu, &proved, Entry::Key, Language::Wgsl)?.run(&columns)?;
    /// assert_eq!(outputs.values.len(), columns.len());
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn new(gpu: &'a Gpu, proved: &Proved<'p>, entry: Entry, language: Language) -> Result<Self, Failure> {
        let program = proved.plan().program;
        let module = match language {
            Language::Wgsl => wgsl_module(program, &wgsl_columns(proved, entry))?,
            Language::Glsl => glsl_module(program, &glsl_columns(proved, entry))?,
        };
        let layout = Layout::new(program, entry);
        let module = Module::new(gpu, &program.name, module)?;
        let compute = module.compute(gpu, module.only_compute()?, &[])?;
        let lookup = lookup_words(proved.plan()).map(|words| gpu.storage("lookup", &words));
        gpu.check()?;
        let (key, names) = (proved.plan().key.clone(), Names::new(program));
        Ok(Self { gpu, program, key, entry, layout, module, compute, names, lookup })
    }

    /// Evaluates columns, in as many dispatches as the device's limits ask for.
    /// Fetched inputs that are absent read as level 255 or NaN.
    ///
    /// # Errors
    /// When the device is lost or out of memory.
    pub fn run(&self, columns: &Columns<f32>) -> Result<Outputs, Failure> {
        let limit = self.gpu.device.limits().max_storage_buffer_binding_size;
        let widest = self.layout.plain.max(self.layout.fetched).max(self.layout.out).max(1) as u64;
        let fitting = usize::try_from(limit / (4 * widest)).unwrap_or(MAX_ROWS).saturating_sub(1);
        let chunk = MAX_ROWS.min(fitting);
        if chunk == 0 {
            let message = "the device's buffers are too small for a single row";
            return Err(Failure::bare("", Diagnostic::error(codes::DEVICE, message).help("use another adapter")));
        }
        let mut outputs = Outputs { values: vec![Vec::new(); self.layout.values], ..Outputs::default() };
        let mut start = 0;
        while start < columns.len() {
            let end = columns.len().min(start + chunk);
            self.run_chunk(columns, start, end, &mut outputs)?;
            start = end;
        }
        Ok(outputs)
    }

    fn run_chunk(
        &self,
        columns: &Columns<f32>,
        start: usize,
        end: usize,
        outputs: &mut Outputs,
    ) -> Result<(), Failure> {
        let gpu = self.gpu;
        let count = end - start;
        let plain = gpu.storage("plain", &plain_words(self.program, &self.key, self.entry, columns, start..end));
        let fetched = (self.layout.fetched > 0)
            .then(|| gpu.storage("fetched", &fetched_words(self.program, columns, start..end)));
        let size = (4 * count * self.layout.out) as u64;
        // A new buffer is zeroed, so the counts of fetches start at zero.
        let out = gpu.results("out", size);
        gpu.check()?;
        let bound = self.names.bind(gpu, &self.module, &plain, fetched.as_ref(), &out, self.lookup.as_ref())?;
        let work = self.compute.covering([count as u32, 1, 1]);
        gpu.submit(|encoder| self.compute.encode(encoder, &bound, work, 1, None));
        gpu.read_buffer(&out, size, |bytes| {
            read(self.program, &self.layout, bytemuck::cast_slice(bytes), outputs);
        })
    }
}

/// The names of the buffers in a shader over columns.
#[derive(Debug)]
pub(super) struct Names {
    plain: String,
    fetched: String,
    out: String,
    lookup: String,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        let [plain, fetched, out, lookup] =
            ["plain", "fetched", "out", "lookup"].map(|buffer| buffer_name(program, buffer));
        Self { plain, fetched, out, lookup }
    }

    /// Binds plain inputs, fetched ones, results and lookup.
    pub(super) fn bind(
        &self,
        gpu: &Gpu,
        module: &Module,
        plain: &wgpu::Buffer,
        fetched: Option<&wgpu::Buffer>,
        out: &wgpu::Buffer,
        lookup: Option<&wgpu::Buffer>,
    ) -> Result<Bound, Failure> {
        let resources = Resources::new()
            .buffer(&self.plain, plain)
            .optional_buffer(&self.fetched, fetched)
            .buffer(&self.out, out)
            .optional_buffer(&self.lookup, lookup);
        module.bind(gpu, &resources)
    }
}
