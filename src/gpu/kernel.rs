//! A table as a compute pipeline.

use std::ops::Range;

use super::Gpu;
use super::pass::{Bound, Compute, Module, Resources};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::kernel::columns::{COUNTS_PER_WORD, Entry, Layout, buffer_name, glsl_columns, wgsl_columns};
use crate::emit::{glsl_module, lookup_words, wgsl_module};
use crate::eval::{ABSENT, Columns};
use crate::plan::KeyLayout;
use crate::program::{Domain, InputId, InputSet, LevelKind, Levels, Program};
use crate::prove::Proved;

/// Most rows of one dispatch.
const MAX_ROWS: usize = 1 << 18;

/// The language in which a kernel is handed over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Language {
    /// The emitted WGSL.
    Wgsl,
    /// The emitted GLSL 450, read by naga.
    Glsl,
}

impl Language {
    /// Both.
    pub const ALL: [Language; 2] = [Language::Wgsl, Language::Glsl];

    /// Returns whether programs in it can be run: naga's reader of GLSL gives an array in a structure another stride than
    /// one by itself, so that it refuses every result that is a list.
    pub fn runs(self, program: &Program) -> bool {
        match self {
            Language::Wgsl => true,
            Language::Glsl => !program.output.data_type().has_array(),
        }
    }

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Language::Wgsl => "wgsl",
            Language::Glsl => "glsl",
        }
    }
}

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

/// The results of a kernel, row by row.
#[derive(Debug, Clone, Default)]
pub struct Outputs {
    /// The row of the program that was taken; `None` for the default.
    pub rows: Vec<Option<usize>>,
    /// For each component of the output, its values. Whole numbers are exact.
    pub values: Vec<Vec<f32>>,
    /// The inputs that were fetched.
    pub fetched: Vec<InputSet>,
    /// The inputs that were fetched more than once.
    pub repeated: Vec<InputSet>,
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
        gpu.read_buffer(&out, size, |bytes| self.read(bytemuck::cast_slice(bytes), outputs))
    }

    fn read(&self, words: &[u32], outputs: &mut Outputs) {
        let rows: std::collections::HashMap<u32, usize> =
            self.program.rows.iter().enumerate().map(|(index, row)| (row.id, index)).collect();
        let fetched: Vec<InputId> = self.program.fetched.iter().collect();
        let components = self.program.output.components();
        for result in words.chunks_exact(self.layout.out) {
            outputs.rows.push(rows.get(&result[0]).copied());
            for ((column, component), word) in outputs.values.iter_mut().zip(&components).zip(&result[1..]) {
                column.push(component.scalar.number(*word));
            }
            let (mut once, mut repeated) = (InputSet::default(), InputSet::default());
            for (index, input) in fetched.iter().enumerate() {
                let word = result[1 + self.layout.values + index / COUNTS_PER_WORD];
                match word >> (4 * (index % COUNTS_PER_WORD)) & 15 {
                    0 => {}
                    1 => once = once.or(InputSet::one(*input)),
                    _ => repeated = repeated.or(InputSet::one(*input)),
                }
            }
            outputs.fetched.push(once.or(repeated));
            outputs.repeated.push(repeated);
        }
    }
}

/// The number of rows, then the inputs that are not fetched, as [`Layout`] says.
pub(super) fn plain_words(
    program: &Program,
    key: &KeyLayout,
    entry: Entry,
    columns: &Columns<f32>,
    rows: Range<usize>,
) -> Vec<u32> {
    let plain = program.input_ids().filter(|(_, input)| input.fetched.is_none());
    let inputs: Vec<(InputId, &Domain)> = plain.map(|(id, input)| (id, &input.domain)).collect();
    let mut words = Vec::with_capacity(1 + rows.len() * (1 + inputs.len()));
    words.push(rows.len() as u32);
    for row in rows {
        if entry == Entry::Key {
            words.push(key.pack(|input| columns.levels(input)[row]));
        }
        for (input, domain) in &inputs {
            match domain {
                // A word by its bits, as a number.
                Domain::Continuous { .. } | Domain::Word => words.push(columns.numbers(*input)[row].to_bits()),
                Domain::Discrete(_) if entry == Entry::Key => {}
                Domain::Discrete(levels) => {
                    let level = columns.levels(*input)[row];
                    words.push(match levels.kind {
                        LevelKind::Bool => u32::from(level),
                        LevelKind::Int if levels.classes.is_some() => integer_word(levels, level),
                        _ => (levels.codes[usize::from(level)] as f32).to_bits(),
                    });
                }
            }
        }
    }
    words
}

/// An integer that a level stands for.
fn integer_word(levels: &Levels, level: u8) -> u32 {
    (levels.codes[usize::from(level)] as i32).cast_unsigned()
}

/// The fetched inputs, as [`Layout`] says.
pub(super) fn fetched_words(program: &Program, columns: &Columns<f32>, rows: Range<usize>) -> Vec<u32> {
    let inputs: Vec<(InputId, Option<&Levels>)> =
        program.fetched.iter().map(|input| (input, program.levels(input))).collect();
    let mut words = Vec::with_capacity(rows.len() * inputs.len());
    for row in rows {
        words.extend(inputs.iter().map(|(input, levels)| {
            if let Some(levels) = levels {
                let level = columns.levels(*input)[row];
                let is_integer = levels.classes.is_some() && level != ABSENT;
                if is_integer { integer_word(levels, level) } else { u32::from(level) }
            } else if columns.is_present(row, *input) {
                columns.numbers(*input)[row].to_bits()
            } else {
                f32::NAN.to_bits()
            }
        }));
    }
    words
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
