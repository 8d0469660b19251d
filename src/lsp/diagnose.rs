//! Diagnostics of a text: found beside the conversation, the newest text first.
//!
//! Checking may take seconds while the editor asks something else every few milliseconds. So a
//! thread of its own checks; texts that were replaced while it was busy are never looked at.

use std::collections::BTreeMap;
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Arc, Mutex};

use lsp_types::notification::PublishDiagnostics;
use lsp_types::{
    DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Location, NumberOrString,
    PublishDiagnosticsParams, Uri,
};

use super::place;
use super::settings::Settings;
use super::transport::Outlet;
use crate::analyse;
use crate::diag::{Diagnostic, Severity, Source, Span, codes};
use crate::program::Program;
use crate::table::{Table, seen_from};
use crate::text::tokens;

/// Stack of the thread: as much as expressions of the deepest nesting need, several times over.
const STACK: usize = 32 << 20;

/// Codes of what has no effect, which editors show faded.
const UNNECESSARY: [crate::diag::Code; 5] =
    [codes::DEAD_CASE, codes::UNUSED_INPUT, codes::DEAD_LINE, codes::UNUSED_ALLOW, codes::REPEATED];

/// The last findings about each text, with the version of it that they are about.
pub(super) type Found = Arc<Mutex<BTreeMap<String, (i32, Vec<Diagnostic>)>>>;

/// A text to be checked, or one that is closed.
struct Job {
    uri: Uri,
    version: i32,
    source: Option<Arc<Source>>,
}

/// The thread that checks.
pub(super) struct Checker {
    jobs: Sender<Job>,
    pub(super) found: Found,
}

impl Checker {
    /// Starts it.
    pub(super) fn start(settings: Settings, outlet: Outlet) -> std::io::Result<Self> {
        let (jobs, pending) = mpsc::channel();
        let found = Found::default();
        let inner = found.clone();
        let thread = std::thread::Builder::new().name("check".to_owned()).stack_size(STACK);
        thread.spawn(move || work(&pending, &settings, &outlet, &inner))?;
        Ok(Self { jobs, found })
    }

    /// Lets it check a text.
    pub(super) fn check(&self, uri: &Uri, version: i32, source: &Arc<Source>) {
        let _ = self.jobs.send(Job { uri: uri.clone(), version, source: Some(source.clone()) });
    }

    /// Lets it forget a text.
    pub(super) fn close(&self, uri: &Uri) {
        let _ = self.jobs.send(Job { uri: uri.clone(), version: 0, source: None });
    }
}

fn work(pending: &Receiver<Job>, settings: &Settings, outlet: &Outlet, found: &Found) {
    // By text, the newest of it; and whose turn it is.
    let mut newest: BTreeMap<String, Job> = BTreeMap::new();
    loop {
        if newest.is_empty() {
            match pending.recv() {
                Ok(job) => drop(newest.insert(job.uri.as_str().to_owned(), job)),
                Err(mpsc::RecvError) => return,
            }
        }
        newest.extend(pending.try_iter().map(|job| (job.uri.as_str().to_owned(), job)));
        let Some((key, job)) = newest.pop_first() else { continue };
        let Some(source) = &job.source else {
            if let Ok(mut found) = found.lock() {
                found.remove(&key);
            }
            let nothing = PublishDiagnosticsParams::new(job.uri, Vec::new(), None);
            outlet.notify::<PublishDiagnostics>(&nothing);
            continue;
        };
        let diagnostics = diagnose(source, settings);
        let shown = diagnostics.iter().map(|diagnostic| shown(&job.uri, source, diagnostic, settings)).collect();
        if let Ok(mut found) = found.lock() {
            found.insert(key, (job.version, diagnostics));
        }
        outlet.notify::<PublishDiagnostics>(&PublishDiagnosticsParams::new(job.uri, shown, Some(job.version)));
    }
}

/// Everything that is to be said of a text.
pub(super) fn diagnose(source: &Arc<Source>, settings: &Settings) -> Vec<Diagnostic> {
    let checked = Table::parse(source.clone()).and_then(|table| Program::check_all(&table));
    match checked {
        Ok(programs) => analyse::report_all(&programs, &settings.levels).open,
        Err(failure) => seen_from(source, failure),
    }
}

/// A diagnostic as an editor shows it.
pub(super) fn shown(uri: &Uri, source: &Source, diagnostic: &Diagnostic, settings: &Settings) -> lsp_types::Diagnostic {
    let range = |span: Span| place::range(source, span, settings.encoding);
    let first = diagnostic.labels.first();
    // What has no place is about the table, which begins with its first word.
    let start = source.text.len() - tokens::skip_blank(&source.text).len();
    let place = first.map_or(Span::new(start, start), |label| label.span);
    let related = diagnostic.labels.iter().skip(1).map(|label| DiagnosticRelatedInformation {
        location: Location::new(uri.clone(), range(label.span)),
        message: if label.message.is_empty() { "see here".to_owned() } else { label.message.clone() },
    });
    let related: Vec<_> = related.collect();
    let mut message = diagnostic.message.clone();
    if let Some(label) = first.filter(|label| !label.message.is_empty()) {
        message.push_str(&format!(": {}", label.message));
    }
    for note in &diagnostic.notes {
        message.push_str(&format!("\n{note}"));
    }
    lsp_types::Diagnostic {
        range: range(place),
        severity: Some(match diagnostic.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
            Severity::Note => DiagnosticSeverity::INFORMATION,
        }),
        code: Some(NumberOrString::String(diagnostic.code.to_string())),
        code_description: None,
        source: Some("umbrage".to_owned()),
        message: crate::diag::visible(&message).into_owned(),
        related_information: (!related.is_empty()).then_some(related),
        tags: UNNECESSARY.contains(&diagnostic.code).then(|| vec![DiagnosticTag::UNNECESSARY]),
        data: None,
    }
}
