//! Places and files as the protocol names them.

use std::path::PathBuf;
use std::str::FromStr;

use lsp_types::{Position, Range, Uri};
use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};

use crate::diag::{Source, Span};
use crate::text::file::shown;

/// The unit in which a client counts columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// Bytes.
    Utf8,
    /// Halves of UTF-16, which every client knows.
    Utf16,
}

impl Encoding {
    fn width(self, c: char) -> usize {
        match self {
            Encoding::Utf8 => c.len_utf8(),
            Encoding::Utf16 => c.len_utf16(),
        }
    }
}

/// The position of a byte.
pub(super) fn position(source: &Source, offset: usize, encoding: Encoding) -> Position {
    let (line, before) = source.before(offset);
    let column: usize = before.chars().map(|c| encoding.width(c)).sum();
    // Texts have at most 128 MiB.
    Position::new(u32::try_from(line).unwrap_or(u32::MAX), u32::try_from(column).unwrap_or(u32::MAX))
}

/// The byte at a position; beyond the end of a line or text its end counts.
pub(super) fn offset(text: &str, position: Position, encoding: Encoding) -> usize {
    let mut lines = text.split_inclusive('\n');
    let start: usize = lines.by_ref().take(position.line as usize).map(str::len).sum();
    let line = lines.next().unwrap_or_default().trim_end_matches(['\n', '\r']);
    let (mut column, mut at) = (0, start);
    for c in line.chars() {
        if column + encoding.width(c) > position.character as usize {
            break;
        }
        column += encoding.width(c);
        at += c.len_utf8();
    }
    at
}

/// The range of a span.
pub(super) fn range(source: &Source, span: Span, encoding: Encoding) -> Range {
    Range::new(position(source, span.start, encoding), position(source, span.end, encoding))
}

/// The span of a range; a range that runs backwards is empty.
pub(super) fn span(text: &str, range: Range, encoding: Encoding) -> Span {
    let start = offset(text, range.start, encoding);
    Span::new(start, offset(text, range.end, encoding).max(start))
}

/// Characters of a path that stand for themselves.
const KEPT: &AsciiSet = &NON_ALPHANUMERIC.remove(b'/').remove(b'-').remove(b'_').remove(b'.').remove(b'~');

/// The path of a file; nothing for a text that is in no file.
pub(super) fn path(uri: &Uri) -> Option<PathBuf> {
    let rest = uri.as_str().strip_prefix("file://")?;
    let path = percent_decode_str(&rest[rest.find('/')?..]).decode_utf8().ok()?;
    // `file:///c:/tables` names a drive, not a directory `c:`.
    let drive = path.as_bytes().get(2) == Some(&b':') && path.as_bytes()[1].is_ascii_alphabetic();
    Some(PathBuf::from(if drive { &path[1..] } else { &path }))
}

/// The name of a text in messages, from which what it imports is found.
pub(super) fn name(uri: &Uri) -> String {
    path(uri).map_or_else(|| uri.as_str().to_owned(), |path| shown(&path))
}

/// The URI of a file with such a name.
pub(super) fn uri(name: &str) -> Option<Uri> {
    if !std::path::Path::new(name).is_absolute() {
        return Uri::from_str(name).ok();
    }
    let slash = if name.starts_with('/') { "" } else { "/" };
    Uri::from_str(&format!("file://{slash}{}", utf8_percent_encode(name, KEPT))).ok()
}
