//! A text that the editor has open, and what was last understood of it.

use std::cell::OnceCell;
use std::sync::Arc;

use lsp_types::{Position, Range, TextDocumentContentChangeEvent, Uri};

use super::place::{self, Encoding};
use crate::diag::{Source, Span};
use crate::program::Program;
use crate::table::Table;
use crate::uses::Uses;

/// An open text.
pub(super) struct Document {
    pub(super) uri: Uri,
    pub(super) version: i32,
    /// Its text as it is now.
    pub(super) source: Arc<Source>,
    encoding: Encoding,
    /// The table as it last was one.
    known: Option<Known>,
}

/// A table that was one, perhaps some keystrokes ago.
pub(super) struct Known {
    pub(super) table: Table,
    pub(super) uses: Uses,
    programs: OnceCell<Vec<Program>>,
}

impl Known {
    /// The programs of the table; none, if it means nothing.
    pub(super) fn programs(&self) -> &[Program] {
        self.programs.get_or_init(|| Program::check_all(&self.table).unwrap_or_default())
    }
}

impl Document {
    pub(super) fn new(uri: Uri, version: i32, text: String, encoding: Encoding) -> Self {
        let source = Source::new(place::name(&uri), text);
        let mut document = Self { uri, version, source, encoding, known: None };
        document.read();
        document
    }

    /// Changes the text: all of it, or the ranges that are named, one after the other.
    pub(super) fn change(&mut self, version: i32, changes: Vec<TextDocumentContentChangeEvent>) {
        let mut text = self.source.text.clone();
        for change in changes {
            match change.range {
                Some(range) => {
                    let span = place::span(&text, range, self.encoding);
                    text.replace_range(span.start..span.end, &change.text);
                }
                None => text = change.text,
            }
        }
        self.version = version;
        self.source = Source::new(self.source.name.as_str(), text);
        self.read();
    }

    /// Reads the text anew, and what it imports.
    pub(super) fn read(&mut self) {
        if let Ok(table) = Table::parse(self.source.clone()) {
            self.known = Some(Known { uses: Uses::of(&table), table, programs: OnceCell::new() });
        }
    }

    /// The table as it last was one.
    pub(super) fn known(&self) -> Option<&Known> {
        self.known.as_ref()
    }

    /// The table, if the text is one as it is now.
    pub(super) fn current(&self) -> Option<&Known> {
        self.known.as_ref().filter(|known| Arc::ptr_eq(&known.table.source, &self.source))
    }

    /// The byte at a position.
    pub(super) fn offset(&self, position: Position) -> usize {
        place::offset(&self.source.text, position, self.encoding)
    }

    /// The range of a span of the text as it is now.
    pub(super) fn range(&self, span: Span) -> Range {
        place::range(&self.source, span, self.encoding)
    }

    /// The place in the table as it last was one; nothing for a place within what has changed since.
    pub(super) fn back(&self, offset: usize) -> Option<usize> {
        let (before, now) = (&self.known.as_ref()?.table.source.text, &self.source.text);
        moved(now, before, offset)
    }

    /// The place that a span of the table as it last was one has now.
    pub(super) fn forth(&self, span: Span) -> Option<Span> {
        let (before, now) = (&self.known.as_ref()?.table.source.text, &self.source.text);
        Some(Span::new(moved(before, now, span.start)?, moved(before, now, span.end)?))
    }
}

/// The place in one text of what stands at a place in another one: before all that differs, behind it, or in a line
/// that both have once.
fn moved(from: &str, to: &str, offset: usize) -> Option<usize> {
    let (a, b) = (from.as_bytes(), to.as_bytes());
    let same = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    if offset <= same {
        return Some(offset);
    }
    let most = a.len().min(b.len()) - same;
    let behind = a.iter().rev().zip(b.iter().rev()).take(most).take_while(|(a, b)| a == b).count();
    if offset >= a.len() - behind {
        return Some(offset + b.len() - a.len());
    }
    let start = from.get(..offset)?.rfind('\n').map_or(0, |at| at + 1);
    let line = from[start..].split_inclusive('\n').next().unwrap_or_default();
    let once = |text: &str| {
        let mut places = text.match_indices(line).map(|(at, _)| at);
        let whole = |at: &usize| *at == 0 || text.as_bytes()[at - 1] == b'\n';
        places.next().filter(whole).filter(|_| places.next().is_none())
    };
    (!line.trim().is_empty() && once(from).is_some()).then(|| once(to)).flatten().map(|at| at + offset - start)
}

#[cfg(test)]
mod tests {
    use super::moved;

    #[test]
    fn places_are_followed_through_changes() {
        let (before, now) = ("a\nbb\nccc\nbb\nd", "x\nbb\nccc\nbb\ny");
        assert_eq!(moved(before, before, 4), Some(4));
        assert_eq!(moved("a\nb", "a\nxb", 3), Some(4));
        assert_eq!(moved("a\nb", "a\nxb", 1), Some(1));
        // Between two changes, by the line, if there is one such.
        assert_eq!(moved(before, now, 6), Some(6));
        assert_eq!(moved(before, &format!("\n\n{now}"), 7), Some(9));
        assert_eq!(moved(before, now, 3), None);
        assert_eq!(moved(before, "x\nccc\nccc\ny", 6), None);
    }
}
