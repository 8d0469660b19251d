//! Text in panels: what a case says, and lines that fit.

use crate::diag::Span;
use crate::program::print::Printer;
use crate::program::{Program, Row};

/// A line of a case in words.
pub(crate) struct LineText {
    /// The value.
    pub(crate) value: String,
    /// When it applies; empty for always.
    pub(crate) condition: String,
}

/// The guard of a row, as written if it is written.
pub(crate) fn guard(program: &Program, row: &Row) -> String {
    let written = written_out(row).then(|| slice(program, row.guard_span)).flatten();
    written.unwrap_or_else(|| printer(program).cond(row.guard))
}

/// The lines of a row, as written if they are written.
pub(crate) fn lines(program: &Program, row: &Row) -> Vec<LineText> {
    let texts = row.lines.iter().map(|line| {
        let written = |span: Option<Span>| if written_out(row) { slice(program, span?) } else { None };
        let value = written(Some(line.span)).unwrap_or_else(|| {
            let values: Vec<String> = line.values.iter().map(|value| printer(program).expr(*value)).collect();
            values.join(", ")
        });
        let condition = match program.pool.truth(line.condition) {
            Some(true) => String::new(),
            _ => written(line.condition_span).unwrap_or_else(|| printer(program).cond(line.condition)),
        };
        LineText { value, condition }
    });
    texts.collect()
}

/// Returns whether a row has its own text; the image of another case has not.
fn written_out(row: &Row) -> bool {
    row.lines.iter().all(|line| line.span.start >= row.span.start && line.span.end <= row.span.end)
}

fn printer(program: &Program) -> Printer<'_> {
    Printer { pool: &program.pool, inputs: &program.inputs }
}

/// A piece of the source on one line, if it is an expression and not data.
fn slice(program: &Program, span: Span) -> Option<String> {
    let text = program.source.text.get(span.start..span.end)?;
    let text = text.trim_matches('"');
    (!text.contains('"')).then(|| text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// Breaks a text into lines of at most `width` characters where there are blanks.
pub(crate) fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The same, of at most `most` lines; what is left out is said.
pub(crate) fn wrap_at_most(text: &str, width: usize, most: usize) -> Vec<String> {
    let mut lines = wrap(text, width);
    if lines.len() > most {
        lines.truncate(most);
        if let Some(last) = lines.last_mut() {
            last.push_str(" ...");
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_broken_at_blanks() {
        assert_eq!(wrap("a bc def g", 4), ["a bc", "def", "g"]);
        assert_eq!(wrap("longer than it", 4), ["longer", "than", "it"]);
        assert_eq!(wrap("", 4), [""; 0]);
        assert_eq!(wrap_at_most("a b c d", 1, 2), ["a", "b ..."]);
    }
}
