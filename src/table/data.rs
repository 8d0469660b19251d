//! Constant data in a file beside the table.
//!
//! A file is lines of numbers, separated by blanks, commas or semicolons; `#` begins a comment,
//! and lines without a number do not count. Each line is an item, and all have as many numbers.

use std::path::Path;
use std::sync::Arc;

use super::library::Library;
use crate::diag::{Diagnostic, Failure, Source, Span, Spanned, codes};
use crate::text::file::shown;
use crate::text::reach::{OutOfReach, beside};

/// Most numbers of a file.
pub(crate) const MAX_NUMBERS: usize = 1 << 16;

/// The contents of a file of constant data.
#[derive(Debug, Clone)]
pub struct DataFile {
    /// Its text.
    pub source: Arc<Source>,
    /// The numbers, line by line.
    pub rows: Vec<Vec<f64>>,
}

/// Reads the file that a table names at a place.
pub(super) fn file(table: &Arc<Source>, path: &Spanned<String>, library: Library) -> Result<DataFile, Failure> {
    let error = |message: String| Diagnostic::error(codes::DATA_FILE, message).at(path.span, "named here");
    let fail = |diagnostic| Failure::new(table.clone(), diagnostic);
    let folder = Path::new(&table.name).parent().unwrap_or(Path::new(""));
    let place = beside(folder, &path.value).map_err(|OutOfReach| {
        let message = format!("`{}` {}", path.value.escape_debug(), OutOfReach::WHAT);
        fail(error(message).help(OutOfReach::HELP))
    })?;
    let name = shown(&place);
    let text = library.read(&place).map_err(|failure| {
        let reason = failure.diagnostics.first().map_or(String::new(), |d| d.message.clone());
        fail(error(format!("the data in `{name}` {reason}")).help("paths are relative to the file that names them"))
    })?;
    let source = Source::new(&*name, text);
    let rows = numbers(&source.text).map_err(|diagnostic| Failure::new(source.clone(), diagnostic))?;
    Ok(DataFile { source, rows })
}

/// The numbers of a text, line by line.
fn numbers(text: &str) -> Result<Vec<Vec<f64>>, Diagnostic> {
    let error =
        |message: String, span: Span, label: &str| Err(Diagnostic::error(codes::DATA_FILE, message).at(span, label));
    let (mut rows, mut count, mut start): (Vec<Vec<f64>>, usize, usize) = (Vec::new(), 0, 0);
    for line in text.split_inclusive('\n') {
        let written = line.split('#').next().unwrap_or_default();
        let mut row = Vec::new();
        for word in written.split([',', ';', ' ', '\t', '\r', '\n']).filter(|word| !word.is_empty()) {
            // A word is a slice of the text, so the difference of the addresses is its offset.
            let at = (word.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
            let span = Span::new(at, at + word.len());
            match word.parse::<f64>() {
                Ok(number) if (number as f32).is_finite() => row.push(number),
                Ok(_) => return error(format!("`{word}` is not a finite f32 number"), span, "too large"),
                Err(_) => {
                    let shown: String = word.chars().take(24).flat_map(char::escape_debug).collect();
                    let message = format!("`{shown}` is not a number");
                    return error(message, span, "expected numbers, separated by blanks or commas");
                }
            }
        }
        count += row.len();
        let span = Span::new(start, start + written.trim_end().len());
        if count > MAX_NUMBERS {
            return error(format!("more than {MAX_NUMBERS} numbers"), span, "too many from here on");
        }
        if let Some(first) = rows.first()
            && !row.is_empty()
            && row.len() != first.len()
        {
            let message = format!("a line of {} numbers, where the first has {}", row.len(), first.len());
            return error(message, span, "this line");
        }
        if !row.is_empty() {
            rows.push(row);
        }
        start += line.len();
    }
    match rows.is_empty() {
        true => {
            error("the file has no numbers".to_owned(), Span::new(0, text.len().min(1)), "expected lines of numbers")
        }
        false => Ok(rows),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_numbers_are_read() {
        assert_eq!(numbers("# x, y\n1, 2\n\n 3;-4e0 # last\r\n"), Ok(vec![vec![1.0, 2.0], vec![3.0, -4.0]]));
        let said = |text: &str| numbers(text).map_err(|d| (d.message, d.labels[0].span)).expect_err("refused");
        assert_eq!(said("1 2\n3\n"), ("a line of 1 numbers, where the first has 2".to_owned(), Span::new(4, 5)));
        assert_eq!(said("1 x"), ("`x` is not a number".to_owned(), Span::new(2, 3)));
        assert_eq!(said("1e39").0, "`1e39` is not a finite f32 number");
        assert_eq!(said("# nothing").0, "the file has no numbers");
        assert!(said(&"1 ".repeat(MAX_NUMBERS + 1)).0.contains("more than"));
    }
}
