//! Renaming: every place that names a declaration, and then the compiler's word that it is a table still.

use lsp_types::{Range, TextEdit, WorkspaceEdit};

use super::document::{Document, Known};
use super::navigate::symbols;
use super::repair::edits;
use crate::diag::Source;
use crate::program::Program;
use crate::table::Table;
use crate::uses::{Kind, SymbolId, Uses};

/// The place of the word that would be renamed, and the word; or why nothing would.
pub(super) fn prepare(document: &Document, offset: usize) -> Result<(Range, String), String> {
    let (_, symbol) = target(document, offset)?;
    let (known, place, _) = symbols(document, offset).ok_or_else(nothing)?;
    let place = document.forth(place).ok_or_else(nothing)?;
    Ok((document.range(place), known.uses[symbol].name.clone()))
}

/// The edits that give the declaration at a place another name; or why that cannot be.
pub(super) fn rename(document: &Document, offset: usize, name: &str) -> Result<WorkspaceEdit, String> {
    let (known, symbol) = target(document, offset)?;
    let places = known.uses.renamed(symbol);
    let mut text = document.source.text.clone();
    for place in places.iter().rev() {
        text.replace_range(place.start..place.end, name);
    }
    if Program::check_all(&known.table).is_err() {
        return Err("the table has mistakes; mend them first, so that the new name can be checked".to_owned());
    }
    // It is a table afterwards, too, and no name in it has come to stand for something else: given back, the old name
    // leads to the old text.
    let after = Table::parse(Source::new(document.source.name.as_str(), text)).and_then(|table| {
        Program::check_all(&table)?;
        Ok(table)
    });
    let after = after.map_err(|failure| {
        let first = failure.diagnostics.first();
        let reason = first.map_or("", |first| first.message.as_str());
        let place = first.and_then(|first| first.labels.first());
        let line = place.map_or(String::new(), |label| format!(" (line {})", failure.source.line(label.span.start)));
        format!("with `{name}` this would be no table: {reason}{line}")
    })?;
    if back(&after, places.first().map_or(0, |place| place.start), &known.uses[symbol].name) != document.source.text {
        return Err(format!("`{name}` stands for something else here"));
    }
    let edit = |place| TextEdit::new(document.range(place), name.to_owned());
    Ok(edits(&document.uri, places.into_iter().map(edit).collect()))
}

/// The text of a table in which the declaration at a place has another name.
fn back(table: &Table, offset: usize, name: &str) -> String {
    let uses = Uses::of(table);
    let symbol = uses.at(offset).max_by_key(|occurrence| occurrence.span.start).map(|occurrence| occurrence.symbol);
    let mut text = table.source.text.clone();
    for place in symbol.map(|symbol| uses.renamed(symbol)).unwrap_or_default().iter().rev() {
        text.replace_range(place.start..place.end, name);
    }
    text
}

/// The one declaration of this text at a place.
fn target(document: &Document, offset: usize) -> Result<(&Known, SymbolId), String> {
    let known = document.current().ok_or("the text is not a table as it is now; mend it first")?;
    let (_, _, found) = symbols(document, offset).ok_or_else(nothing)?;
    let [symbol] = found.as_slice() else {
        return Err("several sets have this level; say of which it is, as in `set::level`".to_owned());
    };
    let declared = &known.uses[*symbol];
    if declared.source.name != document.source.name {
        return Err(format!("`{}` is declared in {}; rename it there", declared.name, declared.source.name));
    }
    if declared.kind == Kind::Level && declared.name.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
        return Err("the levels of an integer are its numbers".to_owned());
    }
    Ok((known, *symbol))
}

fn nothing() -> String {
    "nothing that is declared in the table stands here".to_owned()
}
