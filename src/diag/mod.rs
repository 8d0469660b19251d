//! Diagnostics: what is wrong, where, and how to mend it.
//!
//! Everything that can fail on user input fails with a [`Failure`]: a list of
//! [`Diagnostic`]s over one [`Source`]. Diagnostics carry byte spans and are
//! rendered only at the very end, so that a command line, a build script and a
//! test can each show them their own way.

use std::fmt;
use std::sync::Arc;

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::files::{self, Files};
use codespan_reporting::term;

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
    /// Where it stands.
    pub span: Span,
    /// What stands there.
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
    /// Where each line begins; generated code names many lines.
    lines: Vec<usize>,
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
        Arc::new(Self { name: name.into(), text, lines })
    }

    /// Line and column of a byte offset, both counted from 1, columns in characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let mut offset = offset.min(self.text.len());
        while !self.text.is_char_boundary(offset) {
            offset -= 1;
        }
        let line = self.lines.partition_point(|start| *start <= offset);
        let start = self.lines[line - 1];
        (line, self.text[start..offset].chars().count() + 1)
    }

    /// The line a byte offset is on, counted from 1.
    pub fn line(&self, offset: usize) -> usize {
        self.line_column(offset).0
    }

    /// FNV-1a, 64 bits, of the text: tells whether something was made from this very text.
    pub fn fingerprint(&self) -> u64 {
        fnv1a(self.text.bytes())
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

/// How bad a diagnostic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// A fact worth knowing; does not change the exit code.
    Note,
    /// A finding: the table means something, but perhaps not what was wanted.
    Warning,
    /// The table has no meaning, or one that contradicts its own declarations.
    Error,
}

/// A stable name for a kind of diagnostic, such as `U0203`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub &'static str);

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

/// The codes, grouped by the stage that raises them.
#[allow(missing_docs)]
pub mod codes {
    use super::Code;

    // Reading files.
    pub const UNREADABLE: Code = Code("U0001");
    pub const UNWRITABLE: Code = Code("U0002");

    // Reading RON.
    pub const RON: Code = Code("U0101");
    pub const LANGUAGE_VERSION: Code = Code("U0102");
    pub const STRUCTURE: Code = Code("U0103");

    // Expressions.
    pub const EXPRESSION: Code = Code("U0201");
    pub const TOO_DEEP: Code = Code("U0202");
    pub const UNKNOWN_NAME: Code = Code("U0203");
    pub const UNKNOWN_LEVEL: Code = Code("U0204");
    pub const TYPE: Code = Code("U0205");
    pub const CALL: Code = Code("U0206");
    pub const DIVISION_BY_ZERO: Code = Code("U0207");
    pub const NOT_FINITE: Code = Code("U0208");
    pub const CIRCULAR_NAME: Code = Code("U0209");

    // Functions of a table.
    pub const RECURSION: Code = Code("U0210");
    pub const TOO_MANY_TERMS: Code = Code("U0211");
    pub const NOT_CONSTANT: Code = Code("U0212");
    pub const IMPORT: Code = Code("U0213");
    pub const FUNCTION_SHAPE: Code = Code("U0214");
    pub const PARAMETER: Code = Code("U0215");
    pub const NO_FUNCTION: Code = Code("U0216");
    pub const OUTPUTS: Code = Code("U0217");
    pub const OUTSIDE_DOMAIN: Code = Code("U0218");
    pub const LIMIT_BROKEN: Code = Code("U0219");
    pub const BUDGET_EXCEEDED: Code = Code("U0220");

    // Names and declarations.
    pub const BAD_NAME: Code = Code("U0301");
    pub const RESERVED_NAME: Code = Code("U0302");
    pub const DUPLICATE: Code = Code("U0303");
    pub const DOMAIN: Code = Code("U0304");
    pub const TOO_MANY_STATES: Code = Code("U0305");
    pub const SYMMETRY: Code = Code("U0306");

    // Cases.
    pub const EMPTY: Code = Code("U0401");
    pub const DUPLICATE_CASE: Code = Code("U0402");
    pub const MISSING_CASE: Code = Code("U0403");
    pub const CIRCULAR_CASE: Code = Code("U0404");
    pub const REFERENCE_DEPTH: Code = Code("U0405");
    pub const CASE_SHAPE: Code = Code("U0406");
    pub const BAD_EXAMPLE: Code = Code("U0407");

    // Findings about a program that has a meaning.
    pub const EXAMPLE_FAILS: Code = Code("U0501");
    pub const NOT_UNIQUE: Code = Code("U0502");
    pub const UNCOVERED: Code = Code("U0503");
    pub const DEAD_CASE: Code = Code("U0504");
    pub const UNUSED_INPUT: Code = Code("U0505");
    pub const SYMMETRY_BROKEN: Code = Code("U0506");
    pub const NO_LINE: Code = Code("U0507");
    pub const LINES_CROSS: Code = Code("U0508");
    pub const ORDER_MATTERS: Code = Code("U0509");
    pub const NOT_REACHED: Code = Code("U0510");
    pub const DEAD_LINE: Code = Code("U0511");
    pub const SYMMETRY_ASSUMED: Code = Code("U0512");
    pub const OUT_OF_RANGE: Code = Code("U0513");
    pub const NOT_A_NUMBER: Code = Code("U0514");
    pub const FLOAT_EQUALITY: Code = Code("U0515");
    pub const JUMP: Code = Code("U0516");
    pub const INEXACT: Code = Code("U0520");
    pub const MERGEABLE: Code = Code("U0521");
    pub const RENAMED: Code = Code("U0522");
    pub const NOT_ANALYSED: Code = Code("U0530");
    pub const UNUSED_ALLOW: Code = Code("U0531");
    pub const REMOVABLE: Code = Code("U0551");
    pub const POLE: Code = Code("U0552");
    pub const CANCELS: Code = Code("U0553");
    pub const OVERFLOW: Code = Code("U0554");
    pub const NO_FUNCTIONS: Code = Code("U0555");

    // Plans and output.
    pub const NOT_PROVED: Code = Code("U0601");
    pub const NOT_APPLICABLE: Code = Code("U0602");
    pub const PROOF_TOO_LONG: Code = Code("U0604");
    pub const INVALID_OUTPUT: Code = Code("U0603");

    // Profiles and tuning.
    pub const BAD_PROFILE: Code = Code("U0611");
    pub const OTHER_PROFILE: Code = Code("U0612");
    pub const EMPTY_PROFILE: Code = Code("U0613");
    pub const OLD_PROFILE: Code = Code("U0614");
    pub const EXCLUDED_STATE: Code = Code("U0615");
    pub const BAD_TUNED: Code = Code("U0616");

    // Values given to a table.
    pub const BAD_COLUMN: Code = Code("U0701");
    pub const BAD_VALUE: Code = Code("U0702");
    pub const NEEDS_FETCH: Code = Code("U0703");
    pub const BAD_CAPTURE: Code = Code("U0704");
    pub const FORMAT: Code = Code("U0721");
    pub const EXISTS: Code = Code("U0722");

    // Devices.
    pub const NO_ADAPTER: Code = Code("U0801");
    pub const DEVICE: Code = Code("U0802");

    // Scenes and renderers.
    pub const SCENE: Code = Code("U0901");
    pub const MESH: Code = Code("U0902");
    pub const RENDER: Code = Code("U0903");
    pub const FOREIGN_INPUT: Code = Code("U0904");
}

/// A source as what excerpts are taken from: its lines are known already.
struct Excerpts<'s>(&'s Source);

impl<'s> Files<'s> for Excerpts<'s> {
    type FileId = ();
    type Name = &'s str;
    type Source = &'s str;

    fn name(&'s self, (): ()) -> Result<&'s str, files::Error> {
        Ok(&self.0.name)
    }

    fn source(&'s self, (): ()) -> Result<&'s str, files::Error> {
        Ok(&self.0.text)
    }

    fn line_index(&'s self, (): (), offset: usize) -> Result<usize, files::Error> {
        Ok(self.0.lines.partition_point(|start| *start <= offset) - 1)
    }

    fn line_range(&'s self, (): (), line: usize) -> Result<std::ops::Range<usize>, files::Error> {
        let lines = &self.0.lines;
        let start = lines.get(line).ok_or(files::Error::LineTooLarge { given: line, max: lines.len() - 1 })?;
        Ok(*start..lines.get(line + 1).copied().unwrap_or(self.0.text.len()))
    }
}

/// A place that a diagnostic speaks about.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Where.
    pub span: Span,
    /// What is to be said of it; may be empty.
    pub message: String,
}

/// One thing to tell the user.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// Which kind of thing.
    pub code: Code,
    /// How bad it is.
    pub severity: Severity,
    /// The headline, without a full stop.
    pub message: String,
    /// The places, the one to mend first.
    pub labels: Vec<Label>,
    /// Further lines: what was expected, and how to mend it.
    pub notes: Vec<String>,
}

impl Diagnostic {
    /// An error with a headline.
    pub fn error(code: Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Error, code, message)
    }

    /// A warning with a headline.
    pub fn warning(code: Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, code, message)
    }

    /// A note with a headline.
    pub fn note(code: Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, message)
    }

    fn new(severity: Severity, code: Code, message: impl Into<String>) -> Self {
        Self { code, severity, message: message.into(), labels: Vec::new(), notes: Vec::new() }
    }

    /// Points at a place.
    pub fn at(mut self, span: Span, message: impl Into<String>) -> Self {
        self.labels.push(Label { span, message: message.into() });
        self
    }

    /// Adds a line of help.
    pub fn help(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    fn render(&self, source: &Source, writer: &mut Writer<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Note => codespan::Severity::Note,
            Severity::Warning => codespan::Severity::Warning,
            Severity::Error => codespan::Severity::Error,
        };
        let labels = self.labels.iter().enumerate().map(|(i, label)| {
            let style = if i == 0 { codespan::LabelStyle::Primary } else { codespan::LabelStyle::Secondary };
            codespan::Label::new(style, (), label.span.start..label.span.end).with_message(&label.message)
        });
        // A message without a place still names its file.
        let message = match self.labels.is_empty() && !source.name.is_empty() {
            true => format!("{}: {}", source.name, self.message),
            false => self.message.clone(),
        };
        let shown = codespan::Diagnostic::new(severity)
            .with_code(self.code.0)
            .with_message(message)
            .with_labels_iter(labels)
            .with_notes(self.notes.clone());
        let file = Excerpts(source);
        // A note is nothing to mend: its place is named, but no excerpt of the source shown.
        let display_style = match self.severity {
            Severity::Note => term::DisplayStyle::Medium,
            Severity::Warning | Severity::Error => term::DisplayStyle::Rich,
        };
        let config = term::Config { chars: term::Chars::ascii(), display_style, ..term::Config::default() };
        match writer {
            Writer::Plain(out) => {
                let text = term::emit_into_string(&config, &file, &shown).map_err(|_| fmt::Error)?;
                out.write_str(&text)
            }
            Writer::Styled(out) => term::emit_to_write_style(*out, &config, &file, &shown).map_err(|_| fmt::Error),
        }
    }
}

enum Writer<'a> {
    Plain(&'a mut dyn fmt::Write),
    Styled(&'a mut dyn term::WriteStyle),
}

/// Why something could not be done: one or more diagnostics about one source.
#[derive(Debug, Clone)]
pub struct Failure {
    /// The text that the diagnostics point into.
    pub source: Arc<Source>,
    /// At least one diagnostic.
    pub diagnostics: Vec<Diagnostic>,
}

impl Failure {
    /// A failure with a single diagnostic.
    pub fn new(source: Arc<Source>, diagnostic: Diagnostic) -> Self {
        Self { source, diagnostics: vec![diagnostic] }
    }

    /// A failure that is not about any text: a file that cannot be opened, a missing device.
    pub fn bare(name: impl Into<String>, diagnostic: Diagnostic) -> Self {
        Self::new(Source::new(name, ""), diagnostic)
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(render(&self.source, &self.diagnostics).trim_end())
    }
}

impl std::error::Error for Failure {}

/// Most diagnostics that people are shown at once.
const SHOWN: usize = 50;

/// The diagnostics that are shown, and a line about the others.
fn shown(diagnostics: &[Diagnostic]) -> (&[Diagnostic], Option<String>) {
    match diagnostics.split_at_checked(SHOWN) {
        Some((first, rest)) if !rest.is_empty() => (first, Some(format!("and {} more\n", rest.len()))),
        _ => (diagnostics, None),
    }
}

/// Renders diagnostics as plain text, each followed by an empty line. Of very many
/// only the first ones are shown.
pub fn render(source: &Source, diagnostics: &[Diagnostic]) -> String {
    let mut text = String::new();
    let (first, more) = shown(diagnostics);
    for diagnostic in first {
        // Writing to a string cannot fail, and every span was made from this source.
        let _ = diagnostic.render(source, &mut Writer::Plain(&mut text));
    }
    text.extend(more);
    text
}

/// Renders diagnostics with colours to a terminal, as many as [`render`] does.
pub fn render_styled(source: &Source, diagnostics: &[Diagnostic], out: &mut dyn term::WriteStyle) {
    let (first, more) = shown(diagnostics);
    for diagnostic in first {
        // A terminal that went away is not an error of the table.
        let _ = diagnostic.render(source, &mut Writer::Styled(out));
    }
    if let Some(more) = more {
        let _ = out.write_all(more.as_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_first_of_very_many_are_rendered() {
        let many = |count: usize| {
            let one = Diagnostic::error(codes::TYPE, "wrong").at(Span::new(0, 1), "here");
            Failure { source: Source::new("t", "x"), diagnostics: vec![one; count] }.to_string()
        };
        assert_eq!(many(50).matches("wrong").count(), 50);
        assert!(!many(50).contains(" more"));
        assert_eq!(many(75).matches("wrong").count(), 50);
        assert!(many(75).ends_with("\nand 25 more"), "{}", many(75));
    }

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
    }
}
