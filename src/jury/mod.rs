//! Whoever runs a table elsewhere: what is handed over, what comes back, and who judges it.
//!
//! An executor (a graphics adapter, a browser) gets columns of inputs as words and answers in words;
//! [`words`] writes and reads them. A result that equals the `f32` interpreter's in case and every bit is right.
//! One that does not may still be legal: WGSL fixes no rounding mode, so near
//! the line where a comparison switches, and in the last bits, more than one
//! answer is admissible. Then the interval interpreter judges, which knows
//! WGSL's accuracy rules: inside what it admits is legal, outside is a bug. What is
//! legal only since WGSL admits sums and products in another order is counted by itself.
//! Fetches have no such leeway: one that the interpreter did not make, or made
//! twice, is a bug, unless another case or line was legally taken.
//!
//! A plan that was proved equal over the reals, but computes otherwise, is
//! judged by its proof: a value that is no further off than the proof allows is
//! legal, and so is one that the table has at inputs that far off. One that
//! makes use of assumptions is compared where these hold. Nothing here runs anything.

mod judge;
pub mod words;

use crate::emit::kernel::columns::Entry;
use crate::eval::{Batch, Columns};
use crate::plan::Shape;
use crate::program::{InputSet, Program};
use crate::prove::Proved;

pub(crate) use judge::{Judge, Leeway};

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

/// One executor against the interpreter.
#[derive(Debug, Clone)]
pub struct Run {
    /// The plan.
    pub shape: Shape,
    /// The entry point.
    pub entry: Entry,
    /// The language.
    pub language: Language,
    /// Points with the same case and the same bits.
    pub bit_equal: usize,
    /// Points that differ, but as WGSL admits for the operations as they are written.
    pub admissible: usize,
    /// Points that differ as WGSL admits only if sums and products are computed in another order.
    pub reordered: usize,
    /// Points that differ otherwise.
    pub offending: usize,
    /// Points at which an assumption does not hold that the plan makes use of.
    pub excluded: usize,
    /// Largest difference of a value where the same case was taken.
    pub worst: f64,
    /// The first offenders.
    pub offenders: Vec<Offender>,
}

/// The verdict on the answer at one point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verdict {
    /// The same case and the same bits.
    Equal,
    /// It differs, but as WGSL admits for the operations as they are written.
    Admissible,
    /// It differs as WGSL admits only if sums and products are computed in another order.
    Reordered,
    /// It differs otherwise.
    Offending,
    /// An assumption does not hold that the plan makes use of.
    Excluded,
}

/// A point at which an executor is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offender {
    /// The inputs, as `umbrage explain --at` takes them.
    pub inputs: String,
    /// The result, and the one that was expected.
    pub reason: String,
}

impl Run {
    pub(crate) fn new(shape: Shape, entry: Entry, language: Language) -> Self {
        let (bit_equal, admissible, reordered, offending, excluded) = (0, 0, 0, 0, 0);
        let offenders = Vec::new();
        Self { shape, entry, language, bit_equal, admissible, reordered, offending, excluded, worst: 0.0, offenders }
    }
}

/// Judges the answers of one executor as they come.
pub struct Jury<'p> {
    interpreter: Batch<'p, f32>,
    judge: Judge<'p>,
    leeway: Leeway,
    /// The findings so far.
    pub run: Run,
}

impl<'p> Jury<'p> {
    /// A jury for the WGSL of a plan.
    pub fn new(proved: &Proved<'p>) -> Self {
        let program = proved.plan().program;
        Self {
            interpreter: Batch::new(program),
            judge: Judge::new(program),
            leeway: Leeway::of(proved),
            run: Run::new(proved.plan().shape, Entry::Key, Language::Wgsl),
        }
    }

    /// Judges the answers at some points, one verdict each. Where an input is missing that is needed at any of them,
    /// there is none.
    pub fn hear(&mut self, columns: &Columns<f32>, outputs: &Outputs) -> Vec<Verdict> {
        let Ok(expected) = self.interpreter.evaluate(columns) else { return Vec::new() };
        let judge = |point| self.judge.compare(columns, point, &expected, outputs, self.leeway, &mut self.run);
        (0..columns.len()).map(judge).collect()
    }
}
