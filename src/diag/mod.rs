//! Diagnostics: faults with their places, and how to mend them.
//!
//! Everything that can fail on user input fails with a [`Failure`]: a list of
//! [`Diagnostic`]s over one [`Source`]. Diagnostics carry byte spans and are
//! rendered only at the very end, so that a command line, a build script and a
//! test can each show them their own way.

pub mod codes;
mod source;
mod visible;

use std::fmt;
use std::sync::Arc;

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::term;

pub use codes::Code;
pub(crate) use source::fnv1a;
pub use source::{Source, Span, Spanned};
pub(crate) use visible::visible;

/// The severity of a diagnostic.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// A fact worth knowing; does not change the exit code.
    Note,
    /// A finding: the table means something, but perhaps not what was wanted.
    Warning,
    /// The table has no meaning, or one that contradicts its own declarations.
    Error,
}

/// A place that a diagnostic speaks about.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// Its place.
    pub span: Span,
    /// The remark on it; may be empty.
    pub message: String,
}

/// A change of the text that mends what a diagnostic is about.
///
/// It is offered, never made unasked: whoever makes it looks at the whole table again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Repair {
    /// The change in words, without a full stop.
    pub title: String,
    /// The bytes that are replaced; empty where something is put in.
    pub span: Span,
    /// The text that takes their place.
    pub replacement: String,
}

/// One thing to tell the user.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnostic {
    /// Its kind.
    pub code: Code,
    /// Its severity.
    pub severity: Severity,
    /// The headline, without a full stop.
    pub message: String,
    /// The places, the one to mend first.
    pub labels: Vec<Label>,
    /// Further lines: what was expected, and how to mend it.
    pub notes: Vec<String>,
    /// Boxed, as diagnostics are returned as errors everywhere, and most have none.
    pub(crate) details: Option<Box<Details>>,
}

/// The parts of a diagnostic that tools look at rather than people.
#[derive(Default, Debug, Clone, PartialEq)]
pub(crate) struct Details {
    about: Vec<String>,
    repairs: Vec<Repair>,
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

    /// The subject of a finding, apart from its code and its first place: lines, cases, symmetries,
    /// sizes. An `allow` of a table names the same; with anything else it is another finding.
    pub fn subject(&self) -> &[String] {
        self.details.as_ref().map_or(&[], |details| &details.about)
    }

    /// Changes that would mend it, the likeliest first; mostly none.
    pub fn repairs(&self) -> &[Repair] {
        self.details.as_ref().map_or(&[], |details| &details.repairs)
    }

    /// A note with a headline.
    pub fn note(code: Code, message: impl Into<String>) -> Self {
        Self::new(Severity::Note, code, message)
    }

    fn new(severity: Severity, code: Code, message: impl Into<String>) -> Self {
        Self { code, severity, message: message.into(), labels: Vec::new(), notes: Vec::new(), details: None }
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

    /// Asks whether a misspelt word was meant to be another one. Where the first label is the word itself, in quotes
    /// or without, that is a repair, too.
    pub fn did_you_mean(self, word: &str, close: &str) -> Self {
        let place = self.labels.first().map(|label| label.span);
        let diagnostic = self.help(format!("did you mean `{close}`?"));
        let span = match place {
            Some(place) if place.end - place.start == word.len() => place,
            Some(place) if place.end - place.start == word.len() + 2 => Span::new(place.start + 1, place.end - 1),
            _ => return diagnostic,
        };
        diagnostic.mend(format!("write `{close}`"), span, close)
    }

    /// Offers a change of the text that mends it.
    pub fn mend(mut self, title: impl Into<String>, span: Span, replacement: impl Into<String>) -> Self {
        self.details.get_or_insert_default().repairs.push(Repair {
            title: title.into(),
            span,
            replacement: replacement.into(),
        });
        self
    }

    /// Says what a finding is about; each thing once, in the order of the first mention.
    pub fn about<S: Into<String>>(mut self, things: impl IntoIterator<Item = S>) -> Self {
        for thing in things.into_iter().map(Into::into) {
            if !self.subject().contains(&thing) {
                self.details.get_or_insert_default().about.push(thing);
            }
        }
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
            codespan::Label::new(style, (), label.span.start..label.span.end).with_message(visible(&label.message))
        });
        // A message without a place still names its file.
        let message = if self.labels.is_empty() && !source.name.is_empty() {
            format!("{}: {}", source.name, self.message)
        } else {
            self.message.clone()
        };
        let shown = codespan::Diagnostic::new(severity)
            .with_code(self.code.0)
            .with_message(visible(&message))
            .with_labels_iter(labels)
            .with_notes(self.notes.iter().map(|note| visible(note).into_owned()).collect());
        let file = source::Excerpts::new(source);
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

/// The reason why something could not be done: one or more diagnostics about one source.
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
}
