//! The text of the new table: that of the old one, with values replaced and
//! helpers added. Everything else stays as it is written, comments included.
//!
//! Places are those of fields and entries, by tokens, never those of words: these may stand
//! in comments and texts. What is changed in one place is not changed in another, so edits
//! do not overlap.

use super::{Added, gauss, print};
use crate::diag::Span;
use crate::table::names::check;
use crate::table::{Function, FunctionBody, Table};
use crate::text::layout::{Item, Layout};
use crate::text::tokens::quoted;

/// Longest line that is written.
const WIDTH: usize = 110;

/// The indent of fields of a table, and of entries in them.
const FIELD: &str = "    ";
const ENTRY: &str = "        ";

/// A place in the text and what to put there.
struct Edit {
    start: usize,
    end: usize,
    text: String,
}

impl Edit {
    fn replace(place: Span, text: String) -> Self {
        Self { start: place.start, end: place.end, text }
    }

    fn insert(at: usize, text: String) -> Self {
        Self { start: at, end: at, text }
    }

    fn remove(start: usize, end: usize) -> Self {
        Self { start, end, text: String::new() }
    }
}

/// Puts new values, kernels and densities into the text of a table.
///
/// `None` if the text is not laid out as RON is, which cannot be of what was read as a table.
pub(super) fn apply(table: &Table, values: &[(&Function, String)], added: &Added) -> Option<String> {
    let source = &table.source.text;
    let layout = Layout::new(source);
    let fields = layout.outermost()?;
    let field = |name: &str| layout.field(&fields, name);
    let mut edits = Vec::new();

    let functions = field("functions")?;
    let entries = layout.bracket(functions.value)?;
    for (function, value) in values.iter().filter(|(function, _)| matches!(function.body, FunctionBody::Value(_))) {
        let parts = layout.bracket(entries.keyed(function.name.span)?.value)?;
        edits.push(Edit::replace(layout.field(&parts, "value")?.value, format!("\"{}\"", wrapped(value))));
        // What the value was made of is written out in the new one.
        edits.extend(layout.field(&parts, "let").map(|bindings| {
            let rest = &source[bindings.whole.end..];
            Edit::remove(bindings.whole.start, bindings.whole.end + rest.len() - rest.trim_start().len())
        }));
    }

    edits.push(Edit::replace(field("name")?.value, format!("\"{}\"", renamed(&table.name.value))));
    if let Some(title) = field("title").filter(|_| !table.title.is_empty()) {
        let (_, _, close) = quoted(&source[title.value.start..title.value.end]);
        edits.push(Edit::insert(title.value.end - close.len(), ", stabilised".to_owned()));
    }
    // The new table is no exhibit, and remarks in front of the old one are about that.
    if let Some(exhibit) = field("exhibit") {
        edits.push(line_of(source, exhibit));
        edits.push(Edit::remove(0, layout.start()));
    }

    let kernels = added.kernels.all.iter().map(|kernel| print::helper(kernel, &added.kernels.variable, ENTRY));
    let helpers: String = kernels.chain(added.densities.iter().cloned()).collect();
    let constants = if added.densities.is_empty() { String::new() } else { gauss::constants(&added.rules, ENTRY) };
    let mut new_fields = String::new();
    for (name, entries) in [("constants", constants), ("helpers", helpers)] {
        match field(name) {
            _ if entries.is_empty() => {}
            Some(known) => edits.push(in_front(source, layout.bracket(known.value)?.open, &entries)),
            None => new_fields.push_str(&format!("{FIELD}{name}: {{\n{entries}{FIELD}}},\n")),
        }
    }
    if !new_fields.is_empty() {
        let at = functions.whole.start;
        edits.push(match begins_line(source, at) {
            Some(start) => Edit::insert(start, new_fields),
            None => Edit::insert(at, format!("\n{new_fields}{FIELD}")),
        });
    }

    edits.sort_by_key(|edit| (edit.start, edit.end));
    let breaks = if source.contains("\r\n") { "\r\n" } else { "\n" };
    let mut text = String::with_capacity(source.len());
    let mut done = 0;
    for edit in edits {
        text.push_str(source.get(done..edit.start)?);
        text.push_str(&edit.text.replace('\n', breaks));
        done = edit.end;
    }
    text.push_str(&source[done..]);
    Some(text)
}

/// The name of the new table; the old one, if that is too long to be changed.
fn renamed(name: &str) -> String {
    let stable = format!("{}_stable", name.strip_suffix("_printed").unwrap_or(name));
    if check(&stable, "a table", Span::default()).is_ok() { stable } else { name.to_owned() }
}

/// The beginning of a line, if nothing but blanks stands between it and a place.
fn begins_line(source: &str, at: usize) -> Option<usize> {
    let start = source[..at].rfind('\n').map_or(0, |end| end + 1);
    source[start..at].trim().is_empty().then_some(start)
}

/// Removes an item, with its lines if nothing else stands there.
fn line_of(source: &str, item: &Item) -> Edit {
    let rest = &source[item.whole.end..];
    let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
    let end = item.whole.end + blank;
    match begins_line(source, item.whole.start) {
        Some(start) if source[end..].starts_with('\n') => Edit::remove(start, end + 1),
        _ => Edit::remove(item.whole.start, item.whole.end),
    }
}

/// Puts entries in front of those of a map, which opens before a place.
fn in_front(source: &str, open: usize, entries: &str) -> Edit {
    let rest = &source[open..];
    let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r']).len();
    match rest[blank..].starts_with('\n') {
        true => Edit::insert(open + blank + 1, entries.to_owned()),
        false => Edit::insert(open, format!("\n{entries}{ENTRY}")),
    }
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
