//! The language as data: a table exactly as it is written, every node with
//! its place in the source.
//!
//! Reading happens in two steps. `read` turns RON into [`Table`] (structure,
//! no meaning), with expressions already parsed by `parse` into [`expr::Expr`].
//! Names are resolved, types checked and references followed by
//! [`crate::program`]; nothing past that point looks at RON again.

mod claims;
mod data;
pub mod draw;
pub mod expr;
pub mod fields;
mod functions;
mod imports;
pub(crate) mod lex;
mod library;
pub(crate) mod names;
mod output;
pub(crate) mod parse;
mod piece;
mod read;

use std::path::Path;
use std::sync::Arc;

use crate::diag::{Diagnostic, Failure, Source, Span, Spanned};
use crate::text::file::{read_text, shown};
use expr::Expr;
use library::Library;

pub use claims::Claim;
pub use data::DataFile;
pub use functions::{Accuracy, Constant, ConstantValue, Function, FunctionBody, Helper, Import, Limit};
pub use imports::seen_from;
pub(crate) use output::MAX_FIELDS;
pub use output::{Output, Same};
pub use parse::MAX_DEPTH;

/// Largest accepted table file, in bytes.
const MAX_BYTES: u64 = 16 << 20;

/// The newest version of the table language that this compiler reads. It reads all before, too.
pub const LANGUAGE: u32 = 2;

/// A table as written.
#[derive(Debug, Clone)]
pub struct Table {
    /// The file it was read from.
    pub source: Arc<Source>,
    /// The version of the language that it is written in.
    pub language: Spanned<u32>,
    /// Name of the table and prefix of everything generated from it.
    pub name: Spanned<String>,
    /// The title of the table.
    pub title: String,
    /// The publication of the technique.
    pub origin: String,
    /// The meaning of several cases that match.
    pub hit_policy: Spanned<HitPolicy>,
    /// Level sets that several inputs share.
    pub levels: Vec<(Spanned<String>, Vec<Level>)>,
    /// The inputs, in the order of the generated parameters.
    pub inputs: Vec<Input>,
    /// Inputs that conditions ask together, by patterns of bits.
    pub groups: Vec<Group>,
    /// Conditions and values that have a name of their own.
    pub names: Vec<Named>,
    /// Maps of the inputs under which the table is meant to be equivariant.
    pub symmetries: Vec<Symmetry>,
    /// Conditions that hold on every state that occurs.
    pub assumptions: Vec<Assumption>,
    /// The drawing hints of inputs.
    pub draw: Vec<(Spanned<String>, draw::Draw)>,
    /// The kind of its result.
    pub output: Spanned<Output<Spanned<String>>>,
    /// The rows, in the order written; none in a table of functions.
    pub cases: Vec<Case>,
    /// The result where no case matches.
    pub default: Expr,
    /// Other tables whose functions are called here.
    pub imports: Vec<Import>,
    /// Constant data.
    pub constants: Vec<Constant>,
    /// Functions for use inside the table.
    pub helpers: Vec<Helper>,
    /// Functions that generated code offers; a table has cases or these.
    pub functions: Vec<Function>,
    /// The places where the value is meant to have no jumps.
    pub continuity: Vec<Continuity>,
    /// Claims about constants, helpers and functions.
    pub claims: Vec<Claim>,
    /// Findings about the table as a whole that are known and stay.
    pub allow: Vec<Allow>,
    /// Set for a table that is kept to be looked at, mistakes included, with the reason.
    pub exhibit: Option<String>,
    /// True if it has neither cases nor functions: it declares level sets and constants for others.
    pub declares_only: bool,
}

/// The meaning of several cases that match the same input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HitPolicy {
    /// The first one written decides.
    First,
    /// It does not happen, or they agree: the checker proves it.
    Unique,
    /// All of them count: the result is the list of what they give, in order.
    Collect,
}

/// A named level of a discrete input.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Its name.
    pub name: Spanned<String>,
    /// The number that stands for it where levels are carried as `f32`.
    pub code: Spanned<f64>,
}

/// An input of the table.
#[derive(Debug, Clone)]
pub struct Input {
    /// Its name, possibly grouped by a dot.
    pub name: Spanned<String>,
    /// The values it can take.
    pub domain: Spanned<Domain>,
    /// Its description.
    pub doc: String,
    /// Set for inputs that the host produces on demand, with their cost in texture reads.
    pub fetched: Option<Spanned<f64>>,
    /// The arguments that a fetch of it takes; mostly none.
    pub parameters: Vec<Spanned<String>>,
    /// The value that examples and `explain` assume when they leave the input out.
    pub default: Option<Expr>,
}

/// The values an input can take.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// Levels given in place.
    Levels(Vec<Level>),
    /// The levels of a shared set or of another input.
    LevelsOf(Spanned<String>),
    /// `false` or `true`.
    Bool,
    /// The integers of a closed interval; each is a level named by its decimal digits.
    Int(i64, i64),
    /// The real numbers of a closed interval, with their unit.
    Range(f64, f64, String),
    /// Words: unsigned integers of 32 bits.
    U32,
}

/// Inputs that are `false` or `true`, in the order of the letters of a pattern.
#[derive(Debug, Clone)]
pub struct Group {
    /// Its name.
    pub name: Spanned<String>,
    /// The inputs.
    pub members: Vec<Spanned<String>>,
}

/// A named condition or value.
#[derive(Debug, Clone)]
pub struct Named {
    /// Its name.
    pub name: Spanned<String>,
    /// The expression that it stands for.
    pub value: Expr,
}

/// A map of inputs, and optionally of the result.
#[derive(Debug, Clone)]
pub struct Symmetry {
    /// Its name.
    pub name: Spanned<String>,
    /// For each input that changes: what its new value is made of.
    pub map: Vec<(Spanned<String>, Image)>,
    /// The map of the result, if it changes.
    pub result: Option<ResultMap>,
    /// Its description.
    pub doc: String,
}

/// A map of a result.
#[derive(Debug, Clone)]
pub enum ResultMap {
    /// The result in terms of `value`, the result at the mapped inputs.
    Expr(Expr),
    /// Fields of a record with their maps, or levels with what becomes of them.
    Parts(Span, Vec<(Spanned<String>, ResultMap)>),
}

impl ResultMap {
    /// The place of the map.
    pub fn span(&self) -> Span {
        match self {
            ResultMap::Expr(expr) => expr.span,
            ResultMap::Parts(span, _) => *span,
        }
    }

    /// The expressions in it, names of levels among them.
    pub fn exprs(&self) -> Vec<&Expr> {
        match self {
            ResultMap::Expr(expr) => vec![expr],
            ResultMap::Parts(_, parts) => parts.iter().flat_map(|(_, part)| part.exprs()).collect(),
        }
    }
}

/// The image of one input under a symmetry.
#[derive(Debug, Clone)]
pub enum Image {
    /// An expression over the inputs.
    Expr(Expr),
    /// The levels of another input (or the same one), renamed. Levels that are
    /// not mentioned keep their name.
    Levels {
        /// The other input, if it is not the mapped one itself.
        from: Option<Spanned<String>>,
        /// Old name and new name.
        map: Vec<(Spanned<String>, Spanned<String>)>,
    },
}

/// The places where the value is meant to have no jumps.
#[derive(Debug, Clone)]
pub struct Continuity {
    /// Its name.
    pub name: Spanned<String>,
    /// The kind of the places.
    pub kind: ContinuityKind,
    /// Its description.
    pub doc: String,
}

/// Places at which the value is meant to have no jumps.
#[derive(Debug, Clone)]
pub enum ContinuityKind {
    /// Two points that touch: one for which the condition holds, and its image.
    Border {
        /// When a point has such a neighbour.
        when: Expr,
        /// For each input that is not the same on the other side: what it is there.
        map: Vec<(Spanned<String>, Image)>,
        /// Inputs that can be anything on the other side.
        free: Vec<Spanned<String>>,
    },
    /// Wherever a comparison of these inputs changes its outcome.
    Switch(Vec<Spanned<String>>),
}

/// A finding that is known and stays, with the reason.
#[derive(Debug, Clone)]
pub struct Allow {
    /// Its place.
    pub span: Span,
    /// The code of the finding.
    pub code: Spanned<String>,
    /// The things that the finding may be about; `None` for anything.
    pub with: Option<Vec<Spanned<String>>>,
    /// Why it stays.
    pub reason: String,
}

/// A condition that holds on every state that occurs.
#[derive(Debug, Clone)]
pub struct Assumption {
    /// Its name.
    pub name: Spanned<String>,
    /// The condition.
    pub condition: Expr,
    /// Why it holds.
    pub doc: String,
}

/// One row of the table.
#[derive(Debug, Clone)]
pub struct Case {
    /// The number of the case; stable, used in every report and as the second result.
    pub id: Spanned<u32>,
    /// The whole row.
    pub span: Span,
    /// Section of the source that defines it.
    pub section: String,
    /// One line on what it is.
    pub doc: String,
    /// Its conditions and values.
    pub body: CaseBody,
    /// Misprints of the source that were mended here.
    pub errata: Vec<Erratum>,
    /// Inputs with the expected result; every executor runs them.
    pub examples: Vec<Example>,
    /// Findings about this row that are known and stay.
    pub allow: Vec<Allow>,
}

/// The conditions and values of a row.
#[derive(Debug, Clone)]
pub enum CaseBody {
    /// A guard and the lines of its value, of which the first that applies counts.
    Rows {
        /// The guard.
        when: Expr,
        /// The lines; at least one.
        lines: Vec<Line>,
        /// The symmetries under whose images the case stands as well.
        images: Vec<Spanned<String>>,
    },
    /// Another case under symmetries.
    Image {
        /// The other case.
        case: Spanned<u32>,
        /// The symmetries, one after the other; at least one.
        under: Vec<Spanned<String>>,
        /// The place of all of them.
        span: Span,
    },
}

/// One line of a piecewise value.
#[derive(Debug, Clone)]
pub struct Line {
    /// The value.
    pub value: Expr,
    /// When it applies; always, if absent.
    pub condition: Option<Expr>,
}

/// A misprint of the source.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Erratum {
    /// Its number in the list of errata.
    pub number: u32,
    /// The text as printed.
    pub printed: String,
    /// The text as meant.
    pub meant: String,
}

/// Inputs with the expected result.
#[derive(Debug, Clone)]
pub struct Example {
    /// Its place.
    pub span: Span,
    /// The inputs that differ from their defaults.
    pub inputs: Vec<(Spanned<String>, Expr)>,
    /// The expected result.
    pub value: Expr,
}

impl Table {
    /// Refuses what a later version of the language brings.
    pub(crate) fn since(&self, version: u32, span: Span, what: &str) -> Result<(), Diagnostic> {
        read::since(version, &self.language, span, what)
    }

    /// The files of constant data that it names, once they are read.
    pub(crate) fn data_files(&self) -> impl Iterator<Item = &DataFile> {
        self.constants.iter().filter_map(|constant| match &constant.value {
            ConstantValue::File(_, read) => read.as_deref(),
            ConstantValue::Number(_) | ConstantValue::List(_) | ConstantValue::Levels { .. } => None,
        })
    }

    /// Reads a table from a file.
    ///
    /// # Errors
    /// When the file cannot be read, is not UTF-8, or is not a well-formed table.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, Failure> {
        let path = path.as_ref();
        let name = shown(path);
        Self::parse(Source::new(&*name, read_text(path, MAX_BYTES)?))
    }

    /// Reads a table from a text.
    ///
    /// # Errors
    /// When the text is not a well-formed table.
    ///
    /// ```
    /// use umbrage::diag::Source;
    /// use umbrage::table::Table;
    ///
    /// let failure = Table::parse(Source::new("mine.ron", "Table(language: 1,")).unwrap_err();
    /// assert!(failure.to_string().contains("mine.ron:1:"));
    /// ```
    pub fn parse(source: Arc<Source>) -> Result<Self, Failure> {
        Self::found(source, Library::Disk)
    }

    /// Reads a table that is part of this program, as are the texts that it names: each with its path.
    ///
    /// # Errors
    /// When the text is not a well-formed table, or names something else.
    pub fn parse_among(source: Arc<Source>, texts: &'static [(&'static str, &'static str)]) -> Result<Self, Failure> {
        Self::found(source, Library::Texts(texts))
    }

    fn found(source: Arc<Source>, library: Library) -> Result<Self, Failure> {
        imports::resolve(read::table(&source).map_err(|diagnostics| Failure { source, diagnostics })?, library)
    }

    /// Checks that a text is a table, as far as that can be said without reading what it imports.
    pub(crate) fn well_formed(source: &Arc<Source>) -> Result<(), Failure> {
        read::table(source).map(drop).map_err(|diagnostics| Failure { source: source.clone(), diagnostics })
    }
}
