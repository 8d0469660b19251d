//! What is refused is refused with words: a place, what is wrong, and how to mend it.

use umbrage::diag::{Diagnostic, Failure, Severity, Source, codes, render};

use super::Court;

/// Looks at a refusal.
pub(crate) fn refusal(court: &mut Court<'_>, what: &str, failure: &Failure) {
    court.count("refused", 1);
    let code = failure.diagnostics.first().map_or("none", |diagnostic| diagnostic.code.0);
    court.expect(!failure.diagnostics.is_empty(), &format!("{what}: refused without a reason"), String::new);
    court.expect(
        failure.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error),
        &format!("{what}: refused without an error"),
        || failure.to_string(),
    );
    diagnostics(court, what, &failure.source, &failure.diagnostics);
    let placed = !failure.source.name.is_empty() || failure.diagnostics.iter().all(|one| !one.labels.is_empty());
    court.expect(placed, &format!("{what}: {code} names no place"), || failure.to_string());
    court.expect(code != codes::NOT_PROVED.0, &format!("{what}: a plan was not proved"), || failure.to_string());
    court.expect(code != codes::INVALID_OUTPUT.0, &format!("{what}: output is not valid"), || failure.to_string());
}

/// Looks at messages about a text: they can be shown, and stand where the text is.
pub(crate) fn diagnostics(court: &mut Court<'_>, what: &str, source: &Source, all: &[Diagnostic]) {
    for one in all {
        let code = one.code.0;
        court.expect(codes::entry(code).is_some(), &format!("{what}: {code} is no code"), || one.message.clone());
        court.expect(!one.message.is_empty(), &format!("{what}: {code} says nothing"), String::new);
        let inside = one.labels.iter().all(|label| {
            let (start, end) = (label.span.start, label.span.end);
            start <= end && source.text.get(start..end).is_some()
        });
        court.expect(inside, &format!("{what}: {code} is about a place outside of the text"), || format!("{one:?}"));
        if !inside {
            return;
        }
    }
    let shown = render(source, all);
    // Escapes and other characters that act must not reach a terminal.
    let acts = |c: char| {
        c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    court.expect(!shown.contains(acts), &format!("{what}: a message contains a character that acts"), || {
        format!("{shown:?}")
    });
    court.expect(!shown.contains("please report"), &format!("{what}: a message asks to be reported"), || shown.clone());
}
