//! Texts that diagnostics point into: sources, spans of bytes, lines and columns.

use std::borrow::Cow;
use std::sync::Arc;

use codespan_reporting::files::{self, Files};

use super::visible::{in_place, is_inert, visible};

/// A range of bytes in a [`Source`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The bytes from `start` to `end`, exclusive.
    pub fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The smallest span that covers both.
    pub fn to(self, other: Span) -> Span {
        Span::new(self.start.min(other.start), self.end.max(other.end))
    }
}

/// A value together with the place it was read from.
#[derive(Debug, Clone, PartialEq)]
pub struct Spanned<T> {
    /// Its place.
    pub span: Span,
    /// The value.
    pub value: T,
}

impl<T> Spanned<T> {
    /// `value`, read at `span`.
    pub fn new(span: Span, value: T) -> Self {
        Self { span, value }
    }
}

/// A named text: the unit that spans point into.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name shown in messages, usually a path relative to where the user stands.
    pub name: String,
    /// The text.
    pub text: String,
    /// The start of each line; generated code names many lines.
    lines: Vec<usize>,
    /// Set when nothing in the text acts, so that each message can quote it as it is.
    is_inert: bool,
}

impl Source {
    /// Names a text. A byte order mark is dropped.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Arc<Self> {
        let text: String = text.into();
        let text = match text.strip_prefix('\u{feff}') {
            Some(rest) => rest.to_owned(),
            None => text,
        };
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let lines = [0].into_iter().chain(ends.map(|(end, _)| end + 1)).collect();
        let is_inert = is_inert(&text);
        Arc::new(Self { name: name.into(), text, lines, is_inert })
    }

    /// Line and column of a byte offset, both counted from 1, columns in characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let (line, before) = self.before(offset);
        (line + 1, before.chars().count() + 1)
    }

    /// The line of a byte offset, counted from 0, and what stands in it before that.
    pub(crate) fn before(&self, offset: usize) -> (usize, &str) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.lines.partition_point(|start| *start <= offset) - 1;
        (line, &self.text[self.lines[line]..offset])
    }

    /// The line a byte offset is on, counted from 1.
    pub fn line(&self, offset: usize) -> usize {
        self.line_column(offset).0
    }

    /// FNV-1a, 64 bits, of the text: tells whether something was made from this very text. Lines may end in either way.
    pub fn fingerprint(&self) -> u64 {
        let bytes = self.text.as_bytes();
        let ends = |at: usize| bytes[at] == b'\r' && bytes.get(at + 1) == Some(&b'\n');
        fnv1a((0..bytes.len()).filter(|at| !ends(*at)).map(|at| bytes[at]))
    }

    /// Byte offset of a line and column, both counted from 1, columns in characters.
    pub(crate) fn offset(text: &str, line: usize, column: usize) -> usize {
        let start = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum::<usize>();
        let rest = &text[start.min(text.len())..];
        start + rest.chars().take(column.saturating_sub(1)).map(char::len_utf8).sum::<usize>()
    }
}

/// FNV-1a, 64 bits.
pub(crate) fn fnv1a(bytes: impl IntoIterator<Item = u8>) -> u64 {
    let bytes = bytes.into_iter();
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// A source as what excerpts are taken from: its lines are known already, and nothing in them acts.
pub(super) struct Excerpts<'s> {
    name: Cow<'s, str>,
    text: Cow<'s, str>,
    lines: &'s [usize],
}

impl<'s> Excerpts<'s> {
    pub(super) fn new(source: &'s Source) -> Self {
        let text = if source.is_inert { Cow::Borrowed(&*source.text) } else { in_place(&source.text) };
        Self { name: visible(&source.name), text, lines: &source.lines }
    }
}

impl<'s> Files<'s> for Excerpts<'_> {
    type FileId = ();
    type Name = &'s str;
    type Source = &'s str;

    fn name(&'s self, (): ()) -> Result<&'s str, files::Error> {
        Ok(&self.name)
    }

    fn source(&'s self, (): ()) -> Result<&'s str, files::Error> {
        Ok(&self.text)
    }

    fn line_index(&'s self, (): (), offset: usize) -> Result<usize, files::Error> {
        Ok(self.lines.partition_point(|start| *start <= offset) - 1)
    }

    fn line_range(&'s self, (): (), line: usize) -> Result<std::ops::Range<usize>, files::Error> {
        let lines = self.lines;
        let start = lines.get(line).ok_or(files::Error::LineTooLarge { given: line, max: lines.len() - 1 })?;
        Ok(*start..lines.get(line + 1).copied().unwrap_or(self.text.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_characters_from_one() {
        let source = Source::new("t", "ab\nçd\n");
        assert_eq!(source.line_column(0), (1, 1));
        assert_eq!(source.line_column(3), (2, 1));
        assert_eq!(source.line_column(5), (2, 2));
        assert_eq!(Source::offset(&source.text, 2, 2), 5);
        assert_eq!(source.line_column(999), (3, 1));
    }

    #[test]
    fn fingerprint_is_fnv() {
        assert_eq!(Source::new("t", "").fingerprint(), 0xcbf2_9ce4_8422_2325);
        assert_eq!(Source::new("t", "a").fingerprint(), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(Source::new("t", "a\r\nb\r\n").fingerprint(), Source::new("t", "a\nb\n").fingerprint());
        assert_ne!(Source::new("t", "a\rb").fingerprint(), Source::new("t", "ab").fingerprint());
    }
}
