//! Diagnostics for the user: excerpts in colour, or JSON by the line.

use std::io::{self, IsTerminal, Write};

use clap::ValueEnum;
use codespan_reporting::term::termcolor::{ColorChoice, StandardStream};
use codespan_reporting::term::{Styles, StylesWriter};
use serde_json::{Value, json};

use crate::diag::{self, Diagnostic, Failure, Severity, Source, visible};

/// When messages are coloured.
#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum Color {
    /// On a terminal, unless the environment says otherwise
    Auto,
    /// Always
    Always,
    /// Never
    Never,
}

/// The form of messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Text with excerpts of the source
    Human,
    /// One JSON object per line
    Json,
}

/// Shows diagnostics the way the user asked for.
pub(super) struct Report {
    color: Color,
    /// The form of messages.
    pub(super) format: Format,
}

impl Report {
    /// A report in a form.
    pub(super) fn new(color: Color, format: Format) -> Self {
        Self { color, format }
    }

    /// Shows why something failed, on standard error.
    pub(super) fn failure(&self, failure: &Failure) {
        self.show(&failure.source, &failure.diagnostics);
    }

    /// Shows diagnostics on standard error. That this fails is nothing one could tell anybody.
    pub(super) fn show(&self, source: &Source, diagnostics: &[Diagnostic]) {
        match self.format {
            Format::Json => {
                let _ = io::stderr().lock().write_all(lines(source, diagnostics).as_bytes());
            }
            Format::Human => {
                // Termcolor looks at TERM and NO_COLOR, but not whether anybody sees it.
                let choice = match self.color {
                    Color::Always => ColorChoice::Always,
                    Color::Auto if io::stderr().is_terminal() => ColorChoice::Auto,
                    Color::Auto | Color::Never => ColorChoice::Never,
                };
                let styles = Styles::default();
                let stream = StandardStream::stderr(choice);
                let mut stream = stream.lock();
                diag::render_styled(source, diagnostics, &mut StylesWriter::new(&mut stream, &styles));
            }
        }
    }
}

/// Diagnostics as JSON, one object per line.
pub(super) fn lines(source: &Source, diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|diagnostic| format!("{}\n", visible(&object(source, diagnostic).to_string()))).collect()
}

/// Findings that a table acknowledges, as JSON, each with the reason that it gives.
pub(super) fn acknowledged_lines(source: &Source, findings: &[(Diagnostic, String)]) -> String {
    let line = |(finding, reason): &(Diagnostic, String)| {
        let mut object = object(source, finding);
        object["acknowledged"] = json!(reason);
        format!("{object}\n")
    };
    findings.iter().map(line).collect()
}

fn object(source: &Source, diagnostic: &Diagnostic) -> Value {
    let place = |span: diag::Span| {
        let (line, column) = source.line_column(span.start);
        let (end_line, end_column) = source.line_column(span.end);
        json!({"line": line, "column": column, "end_line": end_line, "end_column": end_column})
    };
    let label = |label: &diag::Label| {
        let mut place = place(label.span);
        place["message"] = json!(label.message);
        place
    };
    let repair = |repair: &diag::Repair| {
        let mut place = place(repair.span);
        place["title"] = json!(repair.title);
        place["replacement"] = json!(repair.replacement);
        place
    };
    json!({
        "code": diagnostic.code.0,
        "severity": match diagnostic.severity {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Error => "error",
        },
        "message": diagnostic.message,
        "file": source.name,
        "labels": diagnostic.labels.iter().map(label).collect::<Vec<_>>(),
        "notes": diagnostic.notes,
        "about": diagnostic.subject(),
        "repairs": diagnostic.repairs().iter().map(repair).collect::<Vec<_>>(),
    })
}

/// A count with its noun.
pub(super) fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{Span, codes};

    /// `docs/messages.md` shows a message as it is.
    #[test]
    fn the_documented_message_is_one() {
        let documented = include_str!("../../docs/messages.md");
        let example = documented.split("```json").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or_default();
        let expected: Value = serde_json::from_str(example).unwrap_or_default();
        let source = Source::new("tables/snow.ron", "Table(\n  cases: [\n        value: y");
        let message = Diagnostic::error(codes::UNKNOWN_NAME, "`y` is not defined")
            .at(Span::new(33, 34), "unknown name")
            .did_you_mean("y", "x");
        assert_eq!(object(&source, &message), expected);
    }
}
