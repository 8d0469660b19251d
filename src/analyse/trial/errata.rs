//! A report on misprints: which of those that a mended table lists do the
//! analyses find in the table as printed, and what remains in the mended one.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::mutate::{Mistake, Tally};
use crate::analyse::lints::{Findings, LintLevels};
use crate::diag::{Diagnostic, Severity};
use crate::program::Program;

/// A misprint, and what the analyses find of it.
struct Misprint {
    cases: Vec<u32>,
    printed: String,
    meant: String,
}

/// A finding in the table as printed, with the cases that it points at.
struct Found {
    code: &'static str,
    severity: Severity,
    cases: Vec<u32>,
    message: String,
    details: Vec<String>,
}

/// The report on one table, in Markdown.
pub fn errata(printed: &Program, mended: &Program) -> String {
    let (before, after) = (
        crate::analyse::report(printed, &LintLevels::default()),
        crate::analyse::report(mended, &LintLevels::default()),
    );
    let found = fresh(printed, &before, &after);
    let mut text = format!("## {}\n\n", mended.title);
    let _ = writeln!(
        text,
        "As printed: `{}`. Mended: `{}`. Of {} findings in the printed table {} are not in the mended one.\n",
        printed.source.name,
        mended.source.name,
        before.open.len() + before.acknowledged.len(),
        found.len()
    );
    misprints(&mut text, mended, &found);
    if !found.is_empty() {
        text.push_str("### What is found in the table as printed\n\n");
        for (number, finding) in found.iter().enumerate() {
            let _ = writeln!(text, "{}. {} {}", number + 1, finding.code, finding.message);
            for detail in &finding.details {
                let _ = writeln!(text, "   * {}", detail.replace('\n', " "));
            }
        }
        text.push('\n');
    }
    known(&mut text, mended, &after);
    text
}

/// Findings in the printed table that the mended one does not have.
fn fresh(printed: &Program, before: &Findings, after: &Findings) -> Vec<Found> {
    let all = |findings: &Findings| -> Vec<Diagnostic> {
        let acknowledged = findings.acknowledged.iter().map(|(finding, _)| finding.clone());
        findings.open.iter().cloned().chain(acknowledged).collect()
    };
    let known = all(after);
    let mut found: Vec<Found> = all(before)
        .iter()
        .filter(|finding| !known.iter().any(|old| old.code == finding.code && old.message == finding.message))
        .map(|finding| Found {
            code: finding.code.0,
            severity: finding.severity,
            cases: cases(printed, finding),
            message: finding.message.clone(),
            details: finding.notes.clone(),
        })
        .collect();
    found.sort_by(|a, b| (a.code, &a.cases).cmp(&(b.code, &b.cases)));
    found
}

/// The cases that a finding points at.
fn cases(program: &Program, finding: &Diagnostic) -> Vec<u32> {
    let mut cases = Vec::new();
    for label in &finding.labels {
        let row = program.rows.iter().find(|r| r.span.start <= label.span.start && label.span.end <= r.span.end);
        cases.extend(row.map(|row| row.id).filter(|id| !cases.contains(id)));
    }
    cases
}

fn misprints(text: &mut String, mended: &Program, found: &[Found]) {
    let mut list: BTreeMap<u32, Misprint> = BTreeMap::new();
    for row in &mended.rows {
        for erratum in &row.errata {
            let entry = list.entry(erratum.number).or_insert_with(|| Misprint {
                cases: Vec::new(),
                printed: erratum.printed.clone(),
                meant: erratum.meant.clone(),
            });
            entry.cases.push(row.id);
        }
    }
    if list.is_empty() {
        text.push_str("No case is misprinted.\n\n");
        return;
    }
    text.push_str(
        "### Misprints\n\nBeside a misprint stand the warnings that point at one of its cases first. They tell that \
         something is\nwrong with the case, not what: a case with several misprints has the same warnings beside \
         each, and so\nhas one whose misprint is in the words around the formula, where no analysis looks. \
         `tests/cli/findings.rs`\nputs each misprint of a formula back alone and says what is found then.\n\n",
    );
    text.push_str("| no | cases | printed | meant | findings |\n|---|---|---|---|---|\n");
    for (number, misprint) in &list {
        let points = |finding: &&Found| {
            finding.severity != Severity::Note
                && finding.cases.first().is_some_and(|first| misprint.cases.contains(first))
        };
        let numbers: Vec<String> = found
            .iter()
            .enumerate()
            .filter(|(_, finding)| points(finding))
            .map(|(place, finding)| format!("{} ({})", place + 1, finding.code))
            .collect();
        let cases: Vec<String> = misprint.cases.iter().map(u32::to_string).collect();
        let _ = writeln!(
            text,
            "| {number} | {} | {} | {} | {} |",
            cases.join(", "),
            cell(&misprint.printed),
            cell(&misprint.meant),
            if numbers.is_empty() { "none".to_owned() } else { numbers.join(", ") }
        );
    }
    text.push('\n');
}

fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

fn known(text: &mut String, mended: &Program, after: &Findings) {
    text.push_str("### What remains in the mended table\n\n");
    if after.open.is_empty() && after.acknowledged.is_empty() {
        text.push_str("Nothing.\n\n");
        return;
    }
    text.push_str("| finding | acknowledged because |\n|---|---|\n");
    let mut rows: Vec<(&Diagnostic, &str)> =
        after.acknowledged.iter().map(|(f, reason)| (f, reason.as_str())).collect();
    rows.extend(after.open.iter().map(|finding| (finding, "not acknowledged")));
    rows.sort_by_key(|(finding, _)| (finding.code, cases(mended, finding)));
    for (finding, reason) in rows {
        let _ = writeln!(text, "| {} {} | {} |", finding.code, cell(&finding.message), cell(reason));
    }
    text.push('\n');
}

/// The outcome of seeded mistakes, in Markdown.
pub fn seeded(name: &str, tallies: &[(Mistake, Tally)]) -> String {
    let mut text = format!("### `{name}`\n\n");
    text.push_str(
        "| mistake | made | harmless | refused | warning | note only | examples only | unnoticed | caught |\n",
    );
    text.push_str("|---|---|---|---|---|---|---|---|---|\n");
    let mut all = Tally::default();
    let mut line = |name: &str, tally: &Tally| {
        let unnoticed = tally.harmful() - tally.caught() - tally.only_examples;
        let share = 100.0 * tally.caught() as f64 / tally.harmful().max(1) as f64;
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {unnoticed} | {share:.0} % |",
            tally.made, tally.harmless, tally.refused, tally.warned, tally.noted, tally.only_examples
        );
    };
    for (kind, tally) in tallies {
        line(kind.name(), tally);
        all.made += tally.made;
        all.harmless += tally.harmless;
        all.refused += tally.refused;
        all.warned += tally.warned;
        all.noted += tally.noted;
        all.only_examples += tally.only_examples;
    }
    line("all", &all);
    text.push('\n');
    text
}
