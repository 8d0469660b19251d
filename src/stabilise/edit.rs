//! The text of the new table: that of the old one, with values replaced and
//! helpers added. Everything else stays as it is written, comments included.

use super::kernel::Kernels;
use super::print;
use crate::table::{Function, FunctionBody, Table};

/// Longest line that is written.
const WIDTH: usize = 110;

/// A place in the text and what to put there.
struct Edit {
    start: usize,
    end: usize,
    text: String,
}

/// Puts new values and kernels into the text of a table.
pub(super) fn apply(table: &Table, values: &[(&Function, String)], kernels: &Kernels) -> String {
    let source = &table.source.text;
    let mut edits = Vec::new();
    for (function, value) in values {
        if let FunctionBody::Value(old) = &function.body {
            edits.push(Edit { start: old.span.start, end: old.span.end, text: wrapped(value) });
        }
        // What the value was made of is written out in the new one.
        if let (Some(first), Some(last)) = (function.bindings.first(), function.bindings.last())
            && let Some((start, end)) = field(source, first.name.span.start, last.value.span.end)
        {
            edits.push(Edit { start, end, text: String::new() });
        }
    }
    let name = &table.name;
    let stem = name.value.strip_suffix("_printed").unwrap_or(&name.value);
    edits.push(Edit {
        start: name.span.start,
        end: name.span.end,
        text: renamed(source, name.span, &format!("{stem}_stable")),
    });
    if !kernels.0.is_empty() {
        let helpers: String = kernels.0.iter().map(|kernel| print::helper(kernel, "        ")).collect();
        edits.push(match table.helpers.first() {
            Some(first) => {
                let at = line_start(source, first.name.span.start);
                Edit { start: at, end: at, text: helpers }
            }
            None => {
                let first = table.functions.first().map_or(0, |function| function.name.span.start);
                let at = source[..first].rfind("functions").map_or(first, |at| line_start(source, at));
                Edit { start: at, end: at, text: format!("    helpers: {{\n{helpers}    }},\n") }
            }
        });
    }
    edits.sort_by_key(|edit| edit.start);
    let mut text = String::with_capacity(source.len());
    let mut done = 0;
    for edit in edits {
        if edit.start < done {
            continue;
        }
        text.push_str(&source[done..edit.start]);
        text.push_str(&edit.text);
        done = edit.end;
    }
    text.push_str(&source[done..]);
    text
}

/// A name as it stands in the source: with quotes if the place includes them.
fn renamed(source: &str, span: crate::diag::Span, name: &str) -> String {
    if source[span.start..span.end].starts_with('"') { format!("\"{name}\"") } else { name.to_owned() }
}

fn line_start(source: &str, at: usize) -> usize {
    source[..at].rfind('\n').map_or(0, |end| end + 1)
}

/// The field `let: { .. },` around its entries.
fn field(source: &str, first: usize, last: usize) -> Option<(usize, usize)> {
    let start = source[..first].rfind("let:")?;
    let end = last + source[last..].find('}')? + 1;
    let comma = usize::from(source[end..].starts_with(','));
    let rest = source[end + comma..].len() - source[end + comma..].trim_start().len();
    Some((start, end + comma + rest))
}

/// Breaks a value at its bindings, and at signs where lines get too long.
fn wrapped(value: &str) -> String {
    let parts: Vec<String> = value.split("; ").map(str::to_owned).collect();
    let last = parts.len() - 1;
    let indent = "\n            ";
    let mut text = String::new();
    for (i, part) in parts.iter().enumerate() {
        if last > 0 {
            text.push_str(indent);
        }
        let mut width = 0;
        for word in part.split_inclusive(' ') {
            let breaks = matches!(word.trim(), "+" | "-" | "*" | "/");
            if breaks && width > WIDTH {
                text.truncate(text.trim_end().len());
                text.push_str(indent);
                text.push_str("    ");
                width = 0;
            }
            text.push_str(word);
            width += word.len();
        }
        if i < last {
            text.push(';');
        }
    }
    text
}
