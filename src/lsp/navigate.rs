//! From a word to its declaration, and to everywhere else that it stands.

use lsp_types::{DocumentHighlight, DocumentHighlightKind, Location, Range};

use super::document::{Document, Known};
use super::place;
use super::settings::Settings;
use crate::diag::Span;
use crate::uses::{Occurrence, Symbol, SymbolId};

/// The declarations that the word at a place of the text as it is now may stand for, with its place.
pub(super) fn symbols(document: &Document, offset: usize) -> Option<(&Known, Span, Vec<SymbolId>)> {
    let known = document.known()?;
    let found: Vec<&Occurrence> = known.uses.at(document.back(offset)?).collect();
    // Where two words touch, the one that begins here.
    let first = found.iter().max_by_key(|occurrence| occurrence.span.start)?.span;
    let symbols = found.iter().filter(|occurrence| occurrence.span == first).map(|occurrence| occurrence.symbol);
    Some((known, first, symbols.collect()))
}

/// The declarations of a word; an imported table is the file itself.
pub(super) fn definitions(document: &Document, offset: usize, settings: &Settings) -> Vec<Location> {
    let Some((known, _, symbols)) = symbols(document, offset) else { return Vec::new() };
    let place = |symbol: SymbolId| {
        let Symbol { kind, name, source, place, .. } = &known.uses[symbol];
        if *kind == crate::uses::Kind::Import {
            let import = known.table.imports.iter().find(|import| import.alias.value == *name);
            let imported = import.and_then(|import| import.table.as_ref())?;
            return Some(Location::new(place::uri(&imported.source.name)?, Range::default()));
        }
        if source.name != document.source.name {
            return Some(Location::new(place::uri(&source.name)?, place::range(source, *place, settings.encoding)));
        }
        Some(Location::new(document.uri.clone(), document.range(document.forth(*place)?)))
    };
    symbols.into_iter().filter_map(place).collect()
}

/// Everywhere in the text that a word's declaration is named; on request the declaration, too.
pub(super) fn references(document: &Document, offset: usize, declarations: bool) -> Vec<Location> {
    let at = |occurrence: &Occurrence| {
        Some(Location::new(document.uri.clone(), document.range(document.forth(occurrence.span)?)))
    };
    let kept = |occurrence: &&Occurrence| declarations || !occurrence.declares;
    occurrences(document, offset).iter().filter(kept).filter_map(at).collect()
}

/// The same, as an editor marks them while the cursor stands there.
pub(super) fn highlights(document: &Document, offset: usize) -> Vec<DocumentHighlight> {
    let at = |occurrence: &Occurrence| {
        let kind = if occurrence.declares { DocumentHighlightKind::WRITE } else { DocumentHighlightKind::READ };
        Some(DocumentHighlight { range: document.range(document.forth(occurrence.span)?), kind: Some(kind) })
    };
    occurrences(document, offset).iter().filter_map(at).collect()
}

fn occurrences(document: &Document, offset: usize) -> Vec<Occurrence> {
    let Some((known, _, symbols)) = symbols(document, offset) else { return Vec::new() };
    let mut all: Vec<Occurrence> = symbols.iter().flat_map(|symbol| known.uses.occurrences(*symbol)).copied().collect();
    all.sort_by_key(|occurrence| occurrence.span.start);
    all.dedup_by_key(|occurrence| occurrence.span);
    all
}
