//! JSON rows: an array of objects whose keys name the inputs.

use serde_json::value::RawValue;

use super::raw::{self, Object};
use super::{CHUNK, Points, Problems};
use crate::cli::input;
use crate::diag::{Diagnostic, Source, Span, codes};
use crate::program::{Program, Value};

const SHAPE: &str = "the rows are an array of objects, as in [{\"H\": \"left\", \"dV\": 0.5}, ...]";

/// Reads the rows of one text.
pub(in crate::cli) struct Reader<'s> {
    program: &'s Program,
    source: &'s Source,
    rows: std::vec::IntoIter<&'s RawValue>,
}

impl<'s> Reader<'s> {
    /// Checks that the text is JSON, and finds the rows.
    pub(in crate::cli) fn open(program: &'s Program, source: &'s Source) -> Result<Self, Vec<Diagnostic>> {
        match serde_json::from_str::<Vec<&'s RawValue>>(&source.text) {
            Ok(rows) => Ok(Self { program, source, rows: rows.into_iter() }),
            Err(error) => {
                let diagnostic = match error.classify() {
                    serde_json::error::Category::Data => {
                        let span = raw::place(&source.text, error.line(), error.column());
                        Diagnostic::error(codes::BAD_COLUMN, "expected an array of rows").at(span, "not an array")
                    }
                    _ => raw::malformed(codes::BAD_COLUMN, source, &error),
                };
                Err(vec![diagnostic.help(SHAPE)])
            }
        }
    }

    /// Reads a chunk of rows; returns whether there were any.
    pub(in crate::cli) fn next(&mut self, points: &mut Points, problems: &mut Problems) -> bool {
        points.clear();
        let mut any = false;
        while points.len() < CHUNK
            && let Some(row) = self.rows.next()
        {
            any = true;
            self.row(row, points, problems);
        }
        any
    }

    fn span(&self, raw: &RawValue) -> Span {
        raw::span(self.source, raw)
    }

    fn row(&self, row: &'s RawValue, points: &mut Points, problems: &mut Problems) {
        let place = self.span(row);
        let line = || self.source.line(place.start);
        let Ok(Object(entries)) = serde_json::from_str::<Object<'s>>(row.get()) else {
            problems.push(|| {
                Diagnostic::error(codes::BAD_COLUMN, format!("line {}: this row is not an object", line()))
                    .at(place, "expected {\"input\": value, ...}")
                    .help(SHAPE)
            });
            return;
        };
        let mut given = vec![false; self.program.inputs.len()];
        let mut bad = false;
        let point = points.push(place);
        for (name, raw) in &entries {
            let span = self.span(raw);
            let input = match input::column(self.program, name, span) {
                Ok(input) => input,
                Err(error) => {
                    bad = true;
                    problems.push(|| at_line(error, self.source.line(span.start)));
                    continue;
                }
            };
            if std::mem::replace(&mut given[input.index()], true) {
                bad = true;
                problems.push(|| {
                    let message = format!("line {}: `{name}` is given twice", self.source.line(span.start));
                    Diagnostic::error(codes::BAD_COLUMN, message).at(span, "again").help("remove one of the two")
                });
                continue;
            }
            match self.value(input.index(), raw) {
                Ok(value) => point[input.index()] = value,
                Err(message) => {
                    bad = true;
                    problems.push(|| {
                        let message = format!("line {}: {message}", self.source.line(span.start));
                        Diagnostic::error(codes::BAD_VALUE, message).at(span, format!("for `{name}`"))
                    });
                }
            }
        }
        if let Err(error) =
            input::complete(self.program, |id| given[id.index()], input::first_line(&self.source.text, place))
        {
            bad = true;
            problems.push(|| at_line(error, line()));
        }
        if bad {
            points.pop();
        }
    }

    fn value(&self, input: usize, raw: &RawValue) -> Result<Option<Value>, String> {
        let input = &self.program.inputs[input];
        match raw.get().as_bytes().first() {
            Some(b'"') => match serde_json::from_str::<String>(raw.get()) {
                Ok(word) => input::cell(input, word.trim()),
                Err(_) => Err(format!("this is no value of `{}`", input.name)),
            },
            Some(b'[' | b'{') => Err(format!("`{}` takes a level, a number or a boolean", input.name)),
            Some(b'n') => input::cell(input, ""),
            _ => input::cell(input, raw.get()),
        }
    }
}

fn at_line(mut error: Diagnostic, line: usize) -> Diagnostic {
    error.message = format!("line {line}: {}", error.message);
    error
}
