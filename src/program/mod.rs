//! The typed program that a table means. This is the one definition of
//! correctness: interpreters, plans and emitters are all judged against it.
//!
//! A [`Program`] is total and pure. Its meaning, in full:
//!
//! 1. Rows are tried in order. The first whose guard holds is *taken*.
//! 2. Of its lines the first whose condition holds gives the result; if none
//!    does, or if no row is taken, the default gives it.
//! 3. Conditions are tested left to right and only as far as needed; of a
//!    selection only the chosen side is evaluated. A fetched input is produced
//!    by the host the first time it is needed, and never again.
//! 4. Each operation means what WGSL's means. Where WGSL leaves a choice the
//!    `f32` result is the exact one rounded to nearest.
//!
//! Assumptions and symmetries are carried along but never change the meaning.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

mod bits;
mod claimed;
pub(crate) mod claims;
mod classes;
pub(crate) mod comparisons;
pub mod data_type;
mod domain;
pub mod draw;
#[cfg(test)]
mod enumerated;
mod fix;
mod lower;
mod meaning;
pub(crate) mod normal;
pub mod operators;
mod ops;
mod outcomes;
mod output;
mod pool;
pub mod print;
pub(crate) mod rational;
mod reachable;
pub(crate) mod region;
mod settle;
mod spans;
mod substitute;
pub(crate) mod symbolic;
pub(crate) mod turn;
mod visit;

use std::sync::Arc;

use crate::diag::{Failure, Source, Span, Spanned};
use crate::table::{Allow, Erratum, HitPolicy, Table};

pub use bits::{InputSet, LevelSet};
pub use claimed::{Claim, ClaimedPair, Claims};
pub use classes::{Classes, Piece};
pub use data_type::{Component, DataType, Scalar};
pub use domain::{Domain, FetchCall, Input, LevelKind, Levels, MAX_LEVELS, StateSpace, Value};
pub use lower::{LevelTerm, Signature, signatures};
pub use meaning::Kinship;
pub use operators::{BinaryOp, Comparison, TernaryOp, UnaryOp};
pub use ops::Real;
pub use outcomes::Outcome;
pub use output::{Output, Reading};
pub use pool::{Cond, CondId, ExprId, Facts, Node, Number, Pool};
pub(crate) use reachable::can_occur;
pub use reachable::reachable;
#[cfg(test)]
pub(crate) use reachable::with_too_many_paths;

/// Number of an input, in the order declared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InputId(u8);

impl InputId {
    /// The input with this place in the declarations.
    pub fn new(index: usize) -> Self {
        debug_assert!(index < InputSet::CAPACITY);
        Self(index as u8)
    }

    /// Its place in the declarations.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A checked table.
#[derive(Debug, Clone)]
pub struct Program {
    /// The file it came from.
    pub source: Arc<Source>,
    /// The texts of the tables that it imports, directly or not, and of the files of data that they name.
    pub imported: Vec<Arc<Source>>,
    /// Name, and prefix of everything generated.
    pub name: String,
    /// The title of the table.
    pub title: String,
    /// The publication of the technique.
    pub origin: String,
    /// The meaning of several rows that match.
    pub hit_policy: HitPolicy,
    /// The place of the hit policy.
    pub hit_policy_span: Span,
    /// The inputs.
    pub inputs: Vec<Input>,
    /// The inputs that are fetched.
    pub fetched: InputSet,
    /// The combinations of discrete inputs.
    pub states: StateSpace,
    /// Owns all expressions and conditions below.
    pub pool: Pool,
    /// The rows, in the order written.
    pub rows: Vec<Row>,
    /// The result where no row, or no line of the taken row, applies.
    pub default: Vec<ExprId>,
    /// The place of that.
    pub default_span: Span,
    /// The kind of its result.
    pub output: Output,
    /// Conditions that hold on every state that occurs.
    pub assumptions: Vec<Assumption>,
    /// The drawing hints of inputs.
    pub draw: Vec<(InputId, draw::Draw)>,
    /// Declared symmetries.
    pub symmetries: Vec<Symmetry>,
    /// Inputs with expected results.
    pub examples: Vec<Example>,
    /// Its declaration, if it is a function of a table.
    pub function: Option<Function>,
    /// The places where the value is meant to have no jumps.
    pub continuity: Vec<Continuity>,
    /// The claims of the table; of its functions the first one has them.
    pub claims: Option<Box<Claims>>,
    /// Findings about the table as a whole that are known and stay.
    pub allow: Vec<Allow>,
    /// Set for a table that is kept to be looked at, mistakes included, with the reason.
    pub exhibit: Option<String>,
    /// The parts of the table that this does not keep.
    pub written: Written,
    /// The inputs of the table that are decided here, in words; none in the program of the whole table.
    pub decided: Vec<String>,
}

/// Parts of a table that are in its text only.
#[derive(Debug, Clone, Default)]
pub struct Written {
    /// Names that nothing leads to.
    pub unused_names: Vec<Spanned<String>>,
    /// Helpers that nothing calls.
    pub unused_helpers: Vec<Spanned<String>>,
    /// Fetches with arguments that nothing calls.
    pub unused_fetches: Vec<Spanned<String>>,
    /// Numbers that no `f32` equals.
    pub inexact: Vec<(f64, Span)>,
    /// Operands of `&&` and `||` that stand there twice, with the first place.
    pub repeated: Vec<(Span, Span)>,
    /// The choices, an `if` or `select` each, in the order written.
    pub choices: Vec<Choice>,
}

/// A choice that is written in a table. What stands in a name, or in a function, is one
/// choice and may be many selections, one for each place that it is used at.
#[derive(Debug, Clone, Default)]
pub struct Choice {
    /// Its place.
    pub span: Span,
    /// The selections that it became.
    pub selections: Vec<ExprId>,
    /// True if somewhere it is known beforehand that the first of the two is chosen.
    pub is_decided: bool,
}

/// The declaration of a program that is a function of a table. The conditions of
/// its domain stand among [`Program::assumptions`].
#[derive(Debug, Clone)]
pub struct Function {
    /// Name of the table.
    pub table: String,
    /// Name of the function in the table.
    pub name: String,
    /// The place of its declaration.
    pub span: Span,
    /// The claims on its values at particular places.
    pub limits: Vec<Limit>,
    /// The claim on its accuracy.
    pub accuracy: Option<Accuracy>,
}

/// A claim on the value of a function at particular places.
#[derive(Debug, Clone)]
pub struct Limit {
    /// The claim.
    pub span: Span,
    /// The inputs that are fixed, and at what.
    pub at: Vec<(InputId, f64)>,
    /// The components there.
    pub values: Vec<ExprId>,
}

/// A claim on the accuracy of a function in `f32`: the error is at most
/// `times` the sum of what half a unit in the last place of each input can
/// change and of half a unit in the last place of 1 times `scale`.
#[derive(Debug, Clone)]
pub struct Accuracy {
    /// The factor.
    pub times: f64,
    /// The natural size of the result.
    pub scale: ExprId,
    /// The claim.
    pub span: Span,
}

/// A row: one case of the technique, or one of its images.
#[derive(Debug, Clone)]
pub struct Row {
    /// The number of the case.
    pub id: u32,
    /// The place of the row.
    pub span: Span,
    /// When it is taken.
    pub guard: CondId,
    /// The place of the guard.
    pub guard_span: Span,
    /// The symmetries, in order, under which this is the image of its case; none for the case itself.
    pub under: Vec<String>,
    /// Its value.
    pub lines: Vec<Line>,
    /// Section of the source that defines it.
    pub section: String,
    /// One line on what it is.
    pub doc: String,
    /// Misprints of the source that were mended here.
    pub errata: Vec<Erratum>,
    /// Findings about this row that are known and stay.
    pub allow: Vec<Allow>,
}

/// A line of a row's value.
#[derive(Debug, Clone)]
pub struct Line {
    /// When it applies.
    pub condition: CondId,
    /// The place of the condition; `None` if it has none.
    pub condition_span: Option<Span>,
    /// The result, one expression per component.
    pub values: Vec<ExprId>,
    /// The place of the value.
    pub span: Span,
}

/// A condition that holds on every state that occurs.
#[derive(Debug, Clone)]
pub struct Assumption {
    /// Its name.
    pub name: String,
    /// The condition.
    pub condition: CondId,
    /// Why it holds.
    pub doc: String,
    /// Its place.
    pub span: Span,
}

/// A map `m` of the inputs and a map `R` of the result. A program whose result at `x` is `V(x)` has the
/// symmetry at `x` if
///
/// ```text
/// V(x) = R(V(m(x)))
/// ```
///
/// that is, if the result there is the mapped result at the image. A derived case is made so; analyses,
/// plans and proofs ask for just this. `m` applied twice need not be the identity, and `R` need have no
/// inverse, so the equation has one direction.
#[derive(Debug, Clone)]
pub struct Symmetry {
    /// Its name.
    pub name: String,
    /// Its description.
    pub doc: String,
    /// Discrete inputs that change, with their levels in the image.
    pub levels: Vec<(InputId, LevelTerm)>,
    /// Continuous inputs that change, with their values in the image.
    pub numbers: Vec<(InputId, ExprId)>,
    /// The result in terms of that at the image, [`Node::Result`], if they differ.
    pub result: Option<Vec<ExprId>>,
    /// The place of its declaration.
    pub span: Span,
}

/// The places where the value is meant to have no jumps.
#[derive(Debug, Clone)]
pub struct Continuity {
    /// Its name, and the inputs on the other side; the result
    /// is the same there. Nothing is mapped for a switch.
    pub map: Symmetry,
    /// The kind of the places.
    pub kind: ContinuityKind,
}

/// Places at which the value is meant to have no jumps.
#[derive(Debug, Clone)]
pub enum ContinuityKind {
    /// The condition under which a point touches its image; these inputs can be anything there.
    Border(CondId, Vec<InputId>),
    /// Wherever a comparison that involves one of these inputs changes its outcome.
    Switch(Vec<InputId>),
}

/// Inputs with the expected result.
#[derive(Debug, Clone)]
pub struct Example {
    /// The row it belongs to, as an index into [`Program::rows`]; of a case with images the first of its rows.
    pub row: usize,
    /// Its place.
    pub span: Span,
    /// One value per input; `None` for fetched inputs that must not be needed.
    pub inputs: Vec<Option<Value>>,
    /// The expected components.
    pub expected: Vec<f64>,
}

/// Most constants that code writes out for the states of a table; a table with more is data, of which a shader reads
/// a few numbers.
pub const MAX_WRITTEN: usize = 4096;

impl Program {
    /// Reads and checks the file of a table of cases.
    ///
    /// # Errors
    /// When the file cannot be read or is not a meaningful table of cases.
    ///
    /// ```
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// assert_eq!((program.rows.len(), program.states.count()), (12, 576));
    ///
    /// let failure = Program::read("tables/snsr.ron").unwrap_err();
    /// assert!(failure.to_string().contains("error[U0001]"));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn read(path: impl AsRef<std::path::Path>) -> Result<Self, Failure> {
        Self::check(&Table::read(path)?)
    }

    /// Reads and checks a table file: one program, or one per function.
    ///
    /// # Errors
    /// When the file cannot be read or is not a meaningful table.
    pub fn read_all(path: impl AsRef<std::path::Path>) -> Result<Vec<Self>, Failure> {
        Self::check_all(&Table::read(path)?)
    }

    /// Reads and checks a table file, and picks the function with a name; a
    /// table of cases is picked by no name.
    ///
    /// # Errors
    /// As [`Self::read_all`], and when there is no such function.
    ///
    /// ```
    /// use umbrage::program::Program;
    ///
    /// let lobe = Program::read_function("tables/spherical_gaussian.ron", Some("r0"))?;
    /// assert!(lobe.input("lambda").is_some());
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn read_function(path: impl AsRef<std::path::Path>, name: Option<&str>) -> Result<Self, Failure> {
        let table = Table::read(path)?;
        let mut all = Self::check_all(&table)?;
        let of = |program: &Self| program.function.as_ref().map(|function| function.name.clone());
        match all.iter().position(|program| of(program).as_deref() == name) {
            Some(index) => Ok(all.swap_remove(index)),
            None => Err(lower::no_function(&table, name)),
        }
    }

    /// Checks names, types, domains and references of a table of cases.
    ///
    /// # Errors
    /// With every mistake found, each at its place.
    pub fn check(table: &Table) -> Result<Self, Failure> {
        match table.functions.is_empty() && !table.declares_only {
            true => lower::program(table),
            false => Err(lower::no_function(table, None)),
        }
    }

    /// Checks a table: one program, or one per function, in the order written; none if it only declares
    /// something for others.
    ///
    /// # Errors
    /// With every mistake found, each at its place.
    pub fn check_all(table: &Table) -> Result<Vec<Self>, Failure> {
        if table.declares_only {
            return lower::declarations(table).map(|()| Vec::new());
        }
        match table.functions.is_empty() {
            true => lower::program(table).map(|program| vec![program]),
            false => lower::functions(table),
        }
    }

    /// The name of the table: that of the program, or, for a function, the one before its own.
    pub fn table(&self) -> &str {
        self.function.as_ref().map_or(&self.name, |function| &function.table)
    }

    /// The number of cases, each counted once whatever images it has.
    pub fn case_count(&self) -> usize {
        self.rows.iter().filter(|row| row.under.is_empty()).count()
    }

    /// The input with a name.
    pub fn input(&self, name: &str) -> Option<InputId> {
        self.inputs.iter().position(|i| i.is_called(name)).map(InputId::new)
    }

    /// The inputs that no result depends on.
    pub fn idle(&self) -> InputSet {
        let conditions = self.rows.iter().flat_map(|r| r.lines.iter().map(|l| l.condition).chain([r.guard]));
        let values = self.rows.iter().flat_map(|r| r.lines.iter().flat_map(|l| &l.values)).chain(&self.default);
        let used = conditions.map(|c| self.pool.cond_facts(c).inputs);
        let used = used.chain(values.map(|e| self.pool.expr_facts(*e).inputs)).fold(InputSet::default(), InputSet::or);
        let all = self.input_ids().fold(InputSet::default(), |all, (id, _)| all.or(InputSet::one(id)));
        all.minus(used)
    }

    /// The inputs without levels: ranges of real numbers, and words.
    pub fn continuous(&self) -> InputSet {
        let continuous = self.input_ids().filter(|(id, _)| self.levels(*id).is_none());
        continuous.fold(InputSet::default(), |set, (id, _)| set.or(InputSet::one(id)))
    }

    /// The rows with the number of this one: itself, and the other images of its case. The default is alone.
    pub fn rows_like(&self, row: Option<usize>) -> impl Iterator<Item = Option<usize>> {
        let number = row.map(|row| self.rows[row].id);
        let same = self.rows.iter().enumerate().filter(move |(_, row)| number == Some(row.id));
        same.map(|(row, _)| Some(row)).chain(row.is_none().then_some(None))
    }

    /// All inputs with their ids.
    pub fn input_ids(&self) -> impl Iterator<Item = (InputId, &Input)> {
        self.inputs.iter().enumerate().map(|(i, input)| (InputId::new(i), input))
    }

    /// Returns whether its states choose between so many constants that no code should write them out: whether it is a
    /// number or a vector looked up.
    pub fn is_data(&self) -> bool {
        let constants = self.pool.nodes().filter(|node| matches!(node, Node::Const(_)));
        self.function.is_none() && self.output.is_real() && constants.count() > MAX_WRITTEN
    }

    /// The levels of a discrete input.
    pub fn levels(&self, input: InputId) -> Option<&Levels> {
        match &self.inputs[input.index()].domain {
            Domain::Discrete(levels) => Some(levels),
            Domain::Continuous { .. } | Domain::Word => None,
        }
    }

    /// The line of the source that a place is on, counted from 1.
    pub fn line(&self, span: Span) -> usize {
        self.source.line(span.start)
    }
}
