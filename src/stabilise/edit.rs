//! The text of the new table: that of the old one, with values replaced and
//! helpers added. Everything else stays as it is written, comments included.

use super::{Added, gauss, print};
use crate::table::{Function, FunctionBody, Table};

/// Longest line that is written.
const WIDTH: usize = 110;

/// A place in the text and what to put there.
struct Edit {
    start: usize,
    end: usize,
    text: String,
}

/// Puts new values, kernels and densities into the text of a table.
pub(super) fn apply(table: &Table, values: &[(&Function, String)], added: &Added) -> String {
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
    // The new table is no exhibit, and remarks in front of the old one are about that.
    edits.extend(table.exhibit.as_ref().and_then(|_| line(source, "    exhibit:")).map(|(start, end)| Edit {
        start,
        end,
        text: String::new(),
    }));
    edits.extend(source.find("Table(").filter(|at| *at > 0).map(|end| Edit { start: 0, end, text: String::new() }));
    if let Some((_, end)) = line(source, "    title:").filter(|_| !table.title.is_empty()) {
        let quote = source[..end].rfind('"').unwrap_or(end);
        edits.push(Edit { start: quote, end: quote, text: ", stabilised".to_owned() });
    }
    let kernels = added.kernels.0.iter().map(|kernel| print::helper(kernel, "        "));
    let helpers: String = kernels.chain(added.densities.iter().cloned()).collect();
    let constants = if added.densities.is_empty() { String::new() } else { gauss::constants("        ") };
    let first_function = table.functions.first().map_or(0, |function| function.name.span.start);
    let before_functions =
        source[..first_function].rfind("functions").map_or(first_function, |at| line_start(source, at));
    let mut new_fields = String::new();
    for (field, entries, first) in [
        ("constants", constants, table.constants.first().map(|constant| constant.name.span.start)),
        ("helpers", helpers, table.helpers.first().map(|helper| helper.name.span.start)),
    ] {
        match first {
            _ if entries.is_empty() => {}
            Some(first) => {
                let at = line_start(source, first);
                edits.push(Edit { start: at, end: at, text: entries });
            }
            None => new_fields.push_str(&format!("    {field}: {{\n{entries}    }},\n")),
        }
    }
    edits.push(Edit { start: before_functions, end: before_functions, text: new_fields });
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

/// The line that begins with these words, line break included.
fn line(source: &str, words: &str) -> Option<(usize, usize)> {
    let start = source.find(&format!("\n{words}"))? + 1;
    Some((start, start + source[start..].find('\n')? + 1))
}

/// The field `let: { .. },` around its entries.
fn field(source: &str, first: usize, last: usize) -> Option<(usize, usize)> {
    let start = source[..first].rfind("let:")?;
    let end = last + source[last..].find('}')? + 1;
    let comma = usize::from(source[end..].starts_with(','));
    let rest = source[end + comma..].len() - source[end + comma..].trim_start().len();
    Some((start, end + comma + rest))
}

/// Breaks a value at its bindings and choices, and at signs where lines get too long.
fn wrapped(value: &str) -> String {
    let marked = value.replace("; ", ";\n").replace("} else ", "}\nelse ");
    let parts: Vec<&str> = marked.split('\n').collect();
    let indent = "\n            ";
    let mut text = String::new();
    for part in &parts {
        if parts.len() > 1 {
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
    }
    text
}
