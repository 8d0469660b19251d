//! Places in texts as the page counts them: in halves of UTF-16, from 0.

use serde_json::{Value as Json, json};
use umbrage::diag::{Diagnostic, Label, Repair, Severity, Source, Span};

/// Turns bytes of a text into places of the page.
pub(crate) struct Places<'s> {
    text: &'s str,
    /// Set where each character is one byte, so that nothing has to be counted.
    plain: bool,
}

impl<'s> Places<'s> {
    pub(crate) fn new(source: &'s Source) -> Self {
        Self { text: &source.text, plain: source.text.is_ascii() }
    }

    /// The place of a byte.
    pub(crate) fn of(&self, byte: usize) -> usize {
        let byte = byte.min(self.text.len());
        if self.plain {
            return byte;
        }
        let whole = (0..=byte).rev().find(|at| self.text.is_char_boundary(*at)).unwrap_or(0);
        self.text[..whole].encode_utf16().count()
    }

    /// A span as `[from, to]`.
    pub(crate) fn span(&self, span: Span) -> Json {
        json!([self.of(span.start), self.of(span.end)])
    }

    /// A diagnostic: its words, and where they belong.
    pub(crate) fn diagnostic(&self, diagnostic: &Diagnostic) -> Json {
        let label = |label: &Label| json!({ "at": self.span(label.span), "message": label.message });
        let repair = |repair: &Repair| json!({ "title": repair.title, "at": self.span(repair.span), "replacement": repair.replacement });
        json!({
            "code": diagnostic.code.0,
            "severity": match diagnostic.severity {
                Severity::Note => "note",
                Severity::Warning => "warning",
                Severity::Error => "error",
            },
            "message": diagnostic.message,
            "labels": diagnostic.labels.iter().map(label).collect::<Vec<_>>(),
            "notes": diagnostic.notes,
            "repairs": diagnostic.repairs().iter().map(repair).collect::<Vec<_>>(),
        })
    }
}
