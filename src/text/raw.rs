//! RON with places.
//!
//! `ron` reports positions for syntax errors only, not for values. But a
//! borrowed [`RawValue`] is a slice of the source text, so its address minus
//! the address of the source is its position. A table is therefore read in
//! layers: serde sorts a struct's fields into [`Raw`] slices, and each slice is
//! read by itself, knowing where it stands.

use ron::Options;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

use super::closest::nearest;
use super::tokens;
use crate::diag::{Diagnostic, Source, Span, Spanned, codes};

/// A piece of RON, not yet interpreted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Raw<'a>(&'a str);

impl<'de: 'a, 'a> Deserialize<'de> for Raw<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw: &'a RawValue = Deserialize::deserialize(deserializer)?;
        Ok(Raw(trim(raw.get_ron())))
    }
}

/// A piece without the white space and comments around it.
/// (`RawValue::trim` does the same by parsing the piece once more.)
fn trim(text: &str) -> &str {
    let rest = tokens::skip_blank(text).trim_end();
    // Comments behind a value belong to its piece where no comma comes before them.
    if rest.contains("//") || rest.contains("/*") { &rest[..tokens::significant(rest)] } else { rest }
}

/// A map in the order written, duplicates included.
#[derive(Debug)]
pub(crate) struct RawMap<'a>(pub(crate) Vec<(Raw<'a>, Raw<'a>)>);

impl<'a> RawMap<'a> {
    pub(crate) fn empty() -> Self {
        RawMap(Vec::new())
    }
}

impl<'de: 'a, 'a> Deserialize<'de> for RawMap<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries;
        impl<'de> Visitor<'de> for Entries {
            type Value = RawMap<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a map such as `{\"name\": value}`")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(RawMap(entries))
            }
        }
        deserializer.deserialize_map(Entries)
    }
}

impl<'a> Raw<'a> {
    /// The piece as it is written.
    pub(crate) fn text(self) -> &'a str {
        self.0
    }
}

/// Reads pieces of one source.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a> {
    source: &'a Source,
}

impl<'a> Reader<'a> {
    pub(crate) fn new(source: &'a Source) -> Self {
        Self { source }
    }

    /// The whole source as one piece.
    pub(crate) fn whole(&self) -> Raw<'a> {
        Raw(&self.source.text)
    }

    /// The offset of the first thing that is neither blank nor a comment.
    pub(crate) fn first(&self) -> usize {
        self.source.text.len() - tokens::skip_blank(&self.source.text).len()
    }

    /// The place of a piece.
    pub(crate) fn span(&self, raw: Raw<'a>) -> Span {
        // A `Raw` is a slice of the source, so the difference of the addresses is its offset.
        let start = (raw.0.as_ptr() as usize).saturating_sub(self.source.text.as_ptr() as usize);
        Span::new(start, start + raw.0.len())
    }

    /// Reads a piece as `T`.
    pub(crate) fn get<T: Deserialize<'a>>(&self, raw: Raw<'a>) -> Result<T, Diagnostic> {
        let options = Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
        options.from_str(raw.0).map_err(|error| {
            let base = self.span(raw).start;
            let offset = |p: ron::error::Position| base + Source::offset(raw.0, p.line, p.col);
            let (start, end) = (offset(error.span.start), offset(error.span.end));
            let end = end.max(start).min(self.source.text.len());
            let start = start.min(end);
            // What is missing at the end of a line is shown there.
            let end = self.source.text[start..end].find('\n').map_or(end, |newline| start + newline);
            let diagnostic = describe(&error.code).at(Span::new(start, end), "here");
            match &error.code {
                ron::Error::NoSuchStructField { expected, found, .. } => {
                    let close = nearest(found, expected.iter().copied()).zip(self.field(raw, end, found));
                    match close {
                        Some((close, place)) => diagnostic.mend(format!("write `{close}`"), place, close),
                        None => diagnostic,
                    }
                }
                _ => diagnostic,
            }
        })
    }

    /// The last place at which a field of this name stands in a piece, up to a place in the source and the name there.
    fn field(&self, raw: Raw<'a>, up_to: usize, name: &str) -> Option<Span> {
        let base = self.span(raw).start;
        let mut most = (up_to + name.len()).min(base + raw.0.len());
        while !self.source.text.is_char_boundary(most) {
            most -= 1;
        }
        let start = base + self.source.text.get(base..most)?.rfind(name)?;
        let place = Span::new(start, start + name.len());
        tokens::skip_blank(&self.source.text[place.end..]).starts_with(':').then_some(place)
    }

    /// Reads a piece as `T` and keeps its place.
    pub(crate) fn spanned<T: Deserialize<'a>>(&self, raw: Raw<'a>) -> Result<Spanned<T>, Diagnostic> {
        Ok(Spanned::new(self.span(raw), self.get(raw)?))
    }

    /// A word in quotes or bare: `"left"`, `left`, `0.5`, `true`.
    pub(crate) fn word(&self, raw: Raw<'a>) -> Result<Spanned<String>, Diagnostic> {
        let quoted = raw.0.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        match quoted {
            // Most words; reading them as RON would only cost time.
            Some(word) if !word.contains(['\\', '"']) => Ok(Spanned::new(self.span(raw), word.to_owned())),
            _ if raw.0.starts_with(['"', 'r']) && raw.0.ends_with(['"', '#']) => self.spanned(raw),
            _ => Ok(Spanned::new(self.span(raw), raw.0.to_owned())),
        }
    }

    /// The shape of a piece, by its first character.
    pub(crate) fn shape(&self, raw: Raw<'a>) -> Shape<'a> {
        match raw.0.as_bytes().first() {
            Some(b'"') => Shape::Text,
            Some(b'r') if raw.0.starts_with("r\"") || raw.0.starts_with("r#") => Shape::Text,
            Some(b'{') => Shape::Map,
            Some(b'[') => Shape::List,
            Some(b'(') => Shape::Tuple,
            Some(b) if b.is_ascii_alphabetic() || *b == b'_' => {
                let end = raw.0.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(raw.0.len());
                if end == raw.0.len() { Shape::Word(raw.0) } else { Shape::Variant(&raw.0[..end]) }
            }
            _ => Shape::Other,
        }
    }
}

/// The outward form of a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape<'a> {
    Text,
    Map,
    List,
    Tuple,
    /// A bare word and nothing else.
    Word(&'a str),
    /// A bare word that something follows.
    Variant(&'a str),
    Other,
}

/// A RON error in the words of the table language.
fn describe(error: &ron::Error) -> Diagnostic {
    use ron::Error as E;
    let quoted = |names: &[&str]| names.iter().map(|n| format!("`{n}`")).collect::<Vec<_>>().join(", ");
    let known = |names: &[&'static str]| format!("known here: {}", quoted(names));
    match error {
        E::NoSuchStructField { expected, found, .. } => {
            let error = Diagnostic::error(codes::STRUCTURE, format!("unknown field `{found}`"));
            match nearest(found, expected.iter().copied()) {
                Some(close) => error.help(format!("did you mean `{close}`?")),
                None => error,
            }
            .help(known(expected))
        }
        E::NoSuchEnumVariant { expected, found, .. } => {
            Diagnostic::error(codes::STRUCTURE, format!("unknown variant `{found}`")).help(known(expected))
        }
        E::MissingStructField { field, outer } => {
            let outer = outer.as_deref().map(|o| format!(" in `{o}`")).unwrap_or_default();
            Diagnostic::error(codes::STRUCTURE, format!("the field `{field}` is missing{outer}"))
        }
        E::DuplicateStructField { field, .. } => {
            Diagnostic::error(codes::STRUCTURE, format!("the field `{field}` is given twice"))
        }
        E::ExceededRecursionLimit => Diagnostic::error(codes::RON, "the file is nested too deeply")
            .help("tables need no more than about ten levels of brackets"),
        E::InvalidValueForType { expected, found } => {
            Diagnostic::error(codes::STRUCTURE, format!("expected {expected}, found {found}"))
        }
        E::ExpectedInteger => expected("a whole number"),
        E::ExpectedFloat => expected("a number"),
        E::ExpectedBoolean => expected("`true` or `false`"),
        E::ExpectedString => expected("a text in double quotes"),
        E::ExpectedArray => expected("a list, written [a, b]"),
        E::ExpectedMap => expected("a map, written {\"name\": value}"),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) => {
            expected("fields in parentheses, written (name: value)")
        }
        E::ExpectedComma => malformed("a comma is missing before this").help(UNCLOSED),
        E::ExpectedMapColon | E::ExpectedStructLikeEnd | E::ExpectedArrayEnd | E::ExpectedMapEnd => {
            malformed(&lower_first(&error.to_string())).help(UNCLOSED)
        }
        E::Eof => malformed("the file ends here, but a bracket is still open").help(UNCLOSED),
        E::ExpectedStringEnd => malformed("the text that begins here never ends").help("close it with a double quote"),
        E::TrailingCharacters => {
            malformed("the table ends before this").help("remove what follows, or a closing bracket too many before it")
        }
        other => malformed(&lower_first(&other.to_string())),
    }
}

const UNCLOSED: &str = "if it looks right here, look above for a bracket or a double quote that is not closed";

fn malformed(what: &str) -> Diagnostic {
    Diagnostic::error(codes::RON, format!("malformed RON: {what}"))
}

fn expected(what: &str) -> Diagnostic {
    Diagnostic::error(codes::STRUCTURE, format!("expected {what}"))
}

fn lower_first(text: &str) -> String {
    let mut chars = text.chars();
    match chars.next() {
        Some(first) => first.to_lowercase().chain(chars).collect(),
        None => String::new(),
    }
}
