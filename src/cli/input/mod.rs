//! Columns of inputs: CSV, JSON or a capture → points of a program.
//!
//! The whole text is kept, so that a bad value can be shown where it stands;
//! points are made from it in chunks, so that a million rows need little more
//! than their text.

pub(crate) mod csv;
pub(crate) mod json;
pub(super) mod raw;

use std::path::Path;

use crate::capture::{self, Capture};
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::eval;
use crate::program::{Domain, Input, InputId, Program, Value};
use crate::text::closest::nearest;
use crate::text::file::{STDIN, read_stdin, read_text, shown, utf8};

/// Rows that are read and evaluated together.
pub(super) const CHUNK: usize = 1 << 16;

/// Most problems that are shown.
const SHOWN: usize = 20;

/// Largest accepted input, in bytes.
const MAX_BYTES: u64 = 4 << 30;

/// Points of a program, one per row of the input.
pub(super) struct Points {
    /// A row in which nothing is given.
    empty: Vec<Option<Value>>,
    values: Vec<Option<Value>>,
    places: Vec<Span>,
}

impl Points {
    /// No points of a program.
    pub(super) fn new(program: &Program) -> Self {
        // What a function has no use for may be left out, and is then anything.
        let idle = |(id, input): (InputId, &Input)| match input.domain {
            Domain::Continuous { .. } | Domain::Word if optional(program, id) => Some(Value::Number(input.least())),
            Domain::Discrete(_) if optional(program, id) => Some(Value::Level(0)),
            _ => None,
        };
        Self { empty: program.input_ids().map(idle).collect(), values: Vec::new(), places: Vec::new() }
    }

    /// Forgets all points.
    pub(super) fn clear(&mut self) {
        self.values.clear();
        self.places.clear();
    }

    /// The number of points.
    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Adds a point with nothing given, from the row that stands at `place`.
    pub(super) fn push(&mut self, place: Span) -> &mut [Option<Value>] {
        self.places.push(place);
        let start = self.values.len();
        self.values.extend_from_slice(&self.empty);
        &mut self.values[start..]
    }

    /// Takes the last point back.
    pub(super) fn pop(&mut self) {
        self.places.pop();
        self.values.truncate(self.places.len() * self.empty.len());
    }

    /// One value per input, in the order of the program's inputs.
    pub(super) fn point(&self, index: usize) -> &[Option<Value>] {
        &self.values[index * self.empty.len()..][..self.empty.len()]
    }

    /// The place of a point's row.
    pub(super) fn place(&self, index: usize) -> Span {
        self.places[index]
    }
}

/// The mistakes in the rows: a bounded number of diagnostics and a count.
#[derive(Default)]
pub(super) struct Problems {
    shown: Vec<Diagnostic>,
    more: usize,
}

impl Problems {
    /// Notes one more; it is only described if it will be shown.
    pub(super) fn push(&mut self, describe: impl FnOnce() -> Diagnostic) {
        if self.shown.len() < SHOWN {
            self.shown.push(describe());
        } else {
            self.more += 1;
        }
    }

    /// Returns whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.shown.is_empty()
    }

    /// All of them as the reason of a failure.
    pub(super) fn into_failure(mut self, source: std::sync::Arc<Source>) -> Failure {
        if self.more > 0 {
            self.shown.push(Diagnostic::error(codes::BAD_VALUE, format!("and {} more like these", self.more)));
        }
        Failure { source, diagnostics: self.shown }
    }
}

/// Reads rows, a chunk at a time.
pub(super) enum Columns<'s> {
    Csv(csv::Reader<'s>),
    Json(json::Reader<'s>),
    /// With the number of rows that were given out.
    Capture(&'s eval::Columns<f32>, usize),
}

/// The file that rows are read from.
pub(super) struct Rows {
    /// The text, or, for a capture, only its name.
    pub(super) source: std::sync::Arc<Source>,
    capture: Option<Capture>,
}

impl<'s> Columns<'s> {
    /// Reads what comes before the first row.
    pub(super) fn open(program: &'s Program, rows: &'s Rows) -> Result<Self, Vec<Diagnostic>> {
        let source = &*rows.source;
        if let Some(capture) = &rows.capture {
            return Ok(Columns::Capture(&capture.columns, 0));
        }
        // A CSV header cannot begin with a bracket, as no input can.
        let is_json = has_extension(Path::new(&source.name), "json")
            || (source.name == STDIN && source.text.trim_start().starts_with('['));
        Ok(match is_json {
            true => Columns::Json(json::Reader::open(program, source)?),
            false => Columns::Csv(csv::Reader::open(program, source)?),
        })
    }

    /// Reads up to [`CHUNK`] further rows; returns whether there were any.
    pub(super) fn next(&mut self, points: &mut Points, problems: &mut Problems) -> bool {
        match self {
            Columns::Csv(reader) => reader.next(points, problems),
            Columns::Json(reader) => reader.next(points, problems),
            Columns::Capture(columns, done) => {
                points.clear();
                let end = columns.len().min(*done + CHUNK);
                for row in *done..end {
                    // A capture has no lines; the place of a row is its number.
                    points.push(Span::new(row, row)).copy_from_slice(&columns.point(row));
                }
                *done = end;
                points.len() > 0
            }
        }
    }

    /// The row at a place in words, and the place to point at if there is a text.
    pub(super) fn locate(&self, source: &Source, place: Span) -> (String, Option<Span>) {
        match self {
            Columns::Capture(..) => (format!("row {}", place.start + 1), None),
            _ => (format!("line {}", source.line(place.start)), Some(first_line(&source.text, place))),
        }
    }
}

/// Reads all rows at once.
pub(super) fn read_all(program: &Program, path: &Path) -> Result<eval::Columns<f32>, Failure> {
    let rows = read(program, path)?;
    if let Some(capture) = rows.capture {
        return Ok(capture.columns);
    }
    let fail = |diagnostics| Failure { source: rows.source.clone(), diagnostics };
    let mut columns = Columns::open(program, &rows).map_err(fail)?;
    let (mut points, mut problems) = (Points::new(program), Problems::default());
    let mut all = eval::Columns::new(program);
    while columns.next(&mut points, &mut problems) {
        for index in 0..points.len() {
            // Values were checked when they were read.
            let _ = all.push(points.point(index));
        }
    }
    match problems.is_empty() {
        true => Ok(all),
        false => Err(problems.into_failure(rows.source.clone())),
    }
}

/// Returns whether a file is named `….extension`.
pub(super) fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case(extension))
}

/// The text of a file, `-` being standard input.
pub(super) fn text(path: &Path) -> Result<std::sync::Arc<Source>, Failure> {
    if path.as_os_str() == "-" {
        return Ok(Source::new(STDIN, utf8(Path::new(STDIN), read_stdin(MAX_BYTES)?)?));
    }
    Ok(Source::new(shown(path), read_text(path, MAX_BYTES)?))
}

/// Reads what the rows are in, `-` being standard input.
pub(super) fn read(program: &Program, path: &Path) -> Result<Rows, Failure> {
    let text = |source| Ok(Rows { source, capture: None });
    if path.as_os_str() != "-" {
        let name = shown(path);
        if has_extension(path, "bin") {
            let capture = Some(capture::read(program, path)?);
            return Ok(Rows { source: Source::new(name, ""), capture });
        }
        return text(Source::new(name, read_text(path, MAX_BYTES)?));
    }
    let bytes = read_stdin(MAX_BYTES)?;
    if capture::is_capture(&bytes) {
        let capture = capture::parse(program, &bytes).map_err(|error| Failure::bare(STDIN, error))?;
        return Ok(Rows { source: Source::new(STDIN, ""), capture: Some(capture) });
    }
    text(Source::new(STDIN, utf8(Path::new(STDIN), bytes)?))
}

/// The input that a column is for.
pub(super) fn column(program: &Program, name: &str, span: Span) -> Result<InputId, Diagnostic> {
    if let Some(input) = program.input(name) {
        return Ok(input);
    }
    let message = format!("`{}` is not an input of `{}`", shorten(name), program.name);
    let error = Diagnostic::error(codes::BAD_COLUMN, message).at(span, "not an input");
    Err(match nearest(name, program.inputs.iter().map(|i| i.name.as_str())) {
        Some(close) => error.did_you_mean(name, close),
        None => error.help(describe_columns(program)),
    })
}

/// Returns whether an input may be left out though it is not fetched: the functions of
/// a table may share one list of parameters, of which this one uses only some.
fn optional(program: &Program, input: InputId) -> bool {
    program.function.is_some() && program.idle().contains(input)
}

/// Refuses rows that leave out an input which is not fetched.
pub(super) fn complete(program: &Program, given: impl Fn(InputId) -> bool, span: Span) -> Result<(), Diagnostic> {
    let missing: Vec<String> = program
        .input_ids()
        .filter(|(id, input)| input.fetched.is_none() && !given(*id) && !optional(program, *id))
        .map(|(_, input)| format!("`{}`", input.name))
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    let what = if missing.len() == 1 { "the input" } else { "the inputs" };
    let verb = if missing.len() == 1 { "is" } else { "are" };
    Err(Diagnostic::error(codes::BAD_COLUMN, format!("{what} {} {verb} missing", missing.join(", ")))
        .at(span, "not given here")
        .help(describe_columns(program)))
}

/// The columns that a table takes, in words.
pub(super) fn describe_columns(program: &Program) -> String {
    let list = |fetched: bool| {
        let names = program.inputs.iter().filter(|i| i.fetched.is_some() == fetched).map(|i| i.name.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    let needed = format!("`{}` needs the inputs {}", program.name, list(false));
    match program.fetched.is_empty() {
        true => needed,
        false => format!("{needed}; these are fetched and may be left out: {}", list(true)),
    }
}

/// The value in one cell; absent if empty, which only fetched inputs may be.
pub(super) fn cell(input: &Input, word: &str) -> Result<Option<Value>, String> {
    match word {
        "" if input.fetched.is_some() => Ok(None),
        "" => Err(format!("`{}` has no value; only fetched inputs can be left out", input.name)),
        _ if word.len() > 64 => Err(format!("`{}` is no value of `{}`", shorten(word), input.name)),
        _ => input.parse(word).map(Some),
    }
}

/// The beginning of a text that may be long or strange.
pub(super) fn shorten(text: &str) -> String {
    let mut shown: String = text.chars().take(40).flat_map(char::escape_debug).collect();
    if text.chars().count() > 40 {
        shown.push_str("...");
    }
    shown
}

/// The part of a place that is on its first line; the whole line, if the place is only a point.
pub(super) fn first_line(text: &str, place: Span) -> Span {
    let rest = &text[place.start..if place.end > place.start { place.end } else { text.len() }];
    let end = rest.find(['\n', '\r']).unwrap_or(rest.len());
    Span::new(place.start, place.start + end)
}
