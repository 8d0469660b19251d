//! CSV rows. The first record names the inputs, in any order.

use super::{CHUNK, Points, Problems};
use crate::cli::input;
use crate::diag::{Diagnostic, Source, Span, codes};
use crate::program::{InputId, Program};

/// Reads the rows of one text.
pub(in crate::cli) struct Reader<'s> {
    program: &'s Program,
    source: &'s Source,
    records: csv::Reader<&'s [u8]>,
    record: csv::StringRecord,
    columns: Vec<InputId>,
}

impl<'s> Reader<'s> {
    /// Reads the header.
    pub(in crate::cli) fn open(program: &'s Program, source: &'s Source) -> Result<Self, Vec<Diagnostic>> {
        let records = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(source.text.as_bytes());
        let mut reader = Self { program, source, records, record: csv::StringRecord::new(), columns: Vec::new() };
        let Some(start) = reader.advance() else {
            return Err(vec![
                Diagnostic::error(codes::BAD_COLUMN, "is empty, a header was expected")
                    .help("the first line names the inputs, separated by commas")
                    .help(input::describe_columns(program)),
            ]);
        };
        let spans = cells(&source.text, start);
        let mut errors = Vec::new();
        for (index, name) in reader.record.iter().enumerate() {
            let span = spans.get(index).copied().unwrap_or(Span::new(start, start));
            match input::column(program, name.trim(), span) {
                Err(error) => errors.push(error),
                Ok(input) => {
                    if let Some(first) = reader.columns.iter().position(|c| *c == input) {
                        errors.push(
                            Diagnostic::error(
                                codes::BAD_COLUMN,
                                format!("the column `{}` is given twice", name.trim()),
                            )
                            .at(span, "given again here")
                            .at(spans[first], "first given here")
                            .help("remove one of the two"),
                        );
                    }
                    reader.columns.push(input);
                }
            }
        }
        let given = |id| reader.columns.contains(&id);
        if errors.is_empty()
            && let Err(error) =
                input::complete(program, given, input::first_line(&source.text, Span::new(start, start)))
        {
            errors.push(error);
        }
        if errors.is_empty() { Ok(reader) } else { Err(errors) }
    }

    /// Reads the next record; returns where it starts.
    fn advance(&mut self) -> Option<usize> {
        let start = self.records.position().byte() as usize;
        // The text is valid UTF-8 and in memory, so reading it cannot fail.
        if !self.records.read_record(&mut self.record).unwrap_or(false) {
            return None;
        }
        // Empty lines before a record are skipped by the reader.
        let blank = self.source.text[start..].bytes().take_while(|b| matches!(b, b'\n' | b'\r')).count();
        Some(start + blank)
    }

    /// Reads a chunk of rows; returns whether there were any.
    pub(in crate::cli) fn next(&mut self, points: &mut Points, problems: &mut Problems) -> bool {
        points.clear();
        let mut any = false;
        while points.len() < CHUNK
            && let Some(start) = self.advance()
        {
            any = true;
            self.row(start, points, problems);
        }
        any
    }

    fn row(&self, start: usize, points: &mut Points, problems: &mut Problems) {
        let text = &self.source.text;
        if self.record.len() != self.columns.len() {
            problems.push(|| {
                let count = self.record.len();
                let cells = if count == 1 { "cell" } else { "cells" };
                let message = format!(
                    "line {}: {count} {cells}, but the header names {} columns",
                    self.source.line(start),
                    self.columns.len()
                );
                Diagnostic::error(codes::BAD_COLUMN, message)
                    .at(input::first_line(text, Span::new(start, start)), "this row")
                    .help("every row has one cell per column; the cell of an absent fetched input is empty")
            });
            return;
        }
        let point = points.push(Span::new(start, start));
        let mut bad = false;
        for (index, (input, word)) in self.columns.iter().zip(&self.record).enumerate() {
            match input::cell(&self.program.inputs[input.index()], word.trim()) {
                Ok(value) => point[input.index()] = value,
                Err(message) => {
                    bad = true;
                    problems.push(|| {
                        let span = cells(text, start).get(index).copied().unwrap_or_default();
                        let message = format!("line {}: {message}", self.source.line(span.start));
                        Diagnostic::error(codes::BAD_VALUE, message)
                            .at(span, format!("column `{}`", self.program.inputs[input.index()].name))
                    });
                }
            }
        }
        if bad {
            points.pop();
        }
    }
}

/// The places of the cells of the record that begins at `start`, without surrounding blanks.
fn cells(text: &str, start: usize) -> Vec<Span> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let (mut from, mut at, mut quoted) = (start, start, false);
    loop {
        let byte = bytes.get(at).copied();
        match byte {
            Some(b'"') => quoted = !quoted && at == from,
            Some(b',' | b'\n' | b'\r') if quoted => {}
            Some(b',' | b'\n' | b'\r') | None => {
                let cell = &text[from..at];
                let blank = cell.len() - cell.trim_start().len();
                found.push(Span::new(from + blank, (from + cell.trim_end().len()).max(from + blank)));
                from = at + 1;
                if byte != Some(b',') {
                    return found;
                }
            }
            Some(_) => {}
        }
        at += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_know_their_place() {
        let text = "x\na, b ,\"c,\n\"\"d\",\nnext";
        let shown: Vec<&str> = cells(text, 2).iter().map(|s| &text[s.start..s.end]).collect();
        assert_eq!(shown, ["a", "b", "\"c,\n\"\"d\"", ""]);
    }
}
