//! JSON that keeps its places: raw values, and where in the text they stand.

use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;

use crate::diag::{Code, Diagnostic, Source, Span};

/// The place of a value that was read from a text.
pub(in crate::cli) fn span(source: &Source, raw: &RawValue) -> Span {
    // A raw value is a slice of the source, so the difference of the addresses is its offset.
    let start = (raw.get().as_ptr() as usize).saturating_sub(source.text.as_ptr() as usize);
    Span::new(start, start + raw.get().len())
}

/// The refusal of a text that is no JSON.
pub(in crate::cli) fn malformed(code: Code, source: &Source, error: &serde_json::Error) -> Diagnostic {
    let text = error.to_string();
    let reason = text.split(" at line ").next().unwrap_or(&text);
    let place = place(&source.text, error.line(), error.column());
    Diagnostic::error(code, format!("malformed JSON: {reason}")).at(place, "here")
}

/// A position of serde_json, whose columns count bytes.
pub(in crate::cli) fn place(text: &str, line: usize, column: usize) -> Span {
    let mut start = (Source::offset(text, line, 1) + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let end = start + text[start..].chars().next().map_or(0, char::len_utf8);
    Span::new(start, end)
}

/// An object in the order written, repeated keys included.
pub(in crate::cli) struct Object<'s>(pub(in crate::cli) Vec<(String, &'s RawValue)>);

impl<'de: 's, 's> Deserialize<'de> for Object<'s> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = Object<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Object(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}
