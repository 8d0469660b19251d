//! Findings: what is questionable about a program that has a meaning.
//!
//! A table that is malformed never gets here; [`Program::check`] refuses it.
//! Findings are about intent: an example that the table contradicts,
//! a declaration that nothing uses, cases that contradict each other. Each
//! analysis is a file of its own.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

mod acknowledge;
pub(crate) mod findings;
mod lints;
mod sets;
#[cfg(feature = "trial")]
pub mod trial;
pub(crate) mod values;
mod words;

use crate::diag::{Code, Diagnostic, Severity, codes};
use crate::program::Program;
use findings::{Analysis, Run};
use sets::budget::{Budget, STEPS};
use sets::study::Study;

pub use findings::accuracy::allowance;
pub use findings::claims::{Counterexample, Verdict, verdicts as claims};
pub use findings::coverage::{Coverage, Dead, coverage};
pub use findings::examples::agrees;
pub use findings::numbers::{Range, ranges};
pub use findings::overlap::{Overlap, overlaps};
#[cfg(feature = "precise")]
pub use findings::singular::{Singularity, domain_points, singularities};
pub use lints::{Findings, LintLevel, LintLevels};

/// Everything that is questionable or worth knowing about a program, without
/// what the table itself acknowledges.
///
/// An error contradicts the table's own declarations, a warning does not. A note
/// is a fact worth knowing, and leaves the table clean.
pub fn findings(program: &Program) -> Vec<Diagnostic> {
    report(program, &LintLevels::default()).open
}

/// Every finding: those to be shown, at the levels asked for, and those that the table acknowledges.
///
/// ```
/// use umbrage::analyse::{LintLevels, report};
/// use umbrage::program::Program;
///
/// let program = Program::read("tables/published/rsmss_as_printed.ron")?;
/// let findings = report(&program, &LintLevels::default());
/// let breaks_symmetry = |finding: &umbrage::diag::Diagnostic| finding.code.0 == "U0506";
/// assert!(findings.open.iter().any(breaks_symmetry));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn report(program: &Program, levels: &LintLevels) -> Findings {
    report_within(program, levels, STEPS)
}

/// Every finding about the programs of one table. What its functions have in common is said once.
pub fn report_all(programs: &[Program], levels: &LintLevels) -> Findings {
    let mut all = Findings::default();
    for program in programs {
        let found = report(program, levels);
        for finding in found.open {
            if !all.open.contains(&finding) {
                all.open.push(finding);
            }
        }
        all.acknowledged.extend(found.acknowledged);
    }
    all
}

/// The same as [`report`], with so many steps for each analysis that may take long.
fn report_within(program: &Program, levels: &LintLevels, steps: u64) -> Findings {
    let (mut found, mut left_out) = (Vec::new(), Vec::new());
    // Codes of analyses that stopped somewhere, and said where.
    let mut in_part: Vec<Code> = Vec::new();
    let mut study = None;
    for Analysis { codes, run } in findings::ALL {
        let more = match run {
            Run::Program(run) => run(program),
            Run::Bounded(run) => {
                let budget = Budget::new(steps);
                let more = run(program, &budget);
                if budget.is_spent() {
                    left_out.extend(*codes);
                    continue;
                }
                more
            }
            // A function has no cases that could contradict each other, and `accuracy` and `singular` look at its numbers.
            Run::Sets(_) if program.function.is_some() => continue,
            Run::Sets(run) => {
                let study = study.get_or_insert_with(|| {
                    let study = Study::within(program, steps);
                    (!study.space.is_too_large()).then_some(study)
                });
                // Without its cases as sets, nothing else is worth anything either.
                let Some(study) = study.as_mut() else {
                    left_out.extend(*codes);
                    continue;
                };
                study.space.begin();
                let more = run(study);
                if study.space.is_too_large() {
                    left_out.extend(*codes);
                    continue;
                }
                more
            }
        };
        debug_assert!(
            more.iter().all(|finding| codes.contains(&finding.code)),
            "a code that the analysis does not name"
        );
        if more.iter().any(|finding| finding.code == codes::NOT_ANALYSED) {
            in_part.extend(*codes);
        }
        found.extend(more);
    }
    left_out.retain(|code| *code != codes::NOT_ANALYSED);
    if !left_out.is_empty() {
        found.push(not_analysed(program, &left_out));
    }
    drop_duplicates(&mut found);
    found.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    let unknown: Vec<Code> = left_out.into_iter().chain(in_part).collect();
    let mut findings = lints::sort(program, found, &unknown, levels);
    if !program.decided.is_empty() {
        findings.open.retain(|finding| !OF_WHOLE_TABLES.contains(&finding.code));
    }
    findings
}

/// Codes of what deciding inputs may leave without use, or makes alike: nobody wrote that. The whole table is
/// checked for it.
const OF_WHOLE_TABLES: &[Code] = &[
    codes::UNCOVERED,
    codes::DEAD_CASE,
    codes::UNUSED_INPUT,
    codes::NO_LINE,
    codes::LINES_CROSS,
    codes::ORDER_MATTERS,
    codes::NOT_REACHED,
    codes::DEAD_LINE,
    codes::SYMMETRY_ASSUMED,
    codes::OUT_OF_RANGE,
    codes::SETTLED,
    codes::MERGEABLE,
    codes::REPEATED,
    codes::UNUSED_ALLOW,
    codes::WIDE_ALLOW,
];

/// Drops findings of `numbers` about a division by zero that `singular` reports, too: of the same place,
/// it knows the limit as well. And those of formulas that are one number, where that is beyond the clamp.
fn drop_duplicates(found: &mut Vec<Diagnostic>) {
    let place = |finding: &Diagnostic| finding.labels.first().map(|label| label.span);
    let known = |found: &[Diagnostic], better: &[Code]| -> Vec<_> {
        found.iter().filter(|finding| better.contains(&finding.code)).filter_map(place).collect()
    };
    let limits = known(found, &[codes::REMOVABLE, codes::POLE]);
    let clamped = known(found, &[codes::OUT_OF_RANGE]);
    let divides = |finding: &Diagnostic| finding.labels.iter().any(|label| label.message.contains("division by zero"));
    found.retain(|finding| {
        let is_in = |places: &[_]| place(finding).is_some_and(|place| places.contains(&place));
        let limit = finding.code == codes::NOT_A_NUMBER && divides(finding) && is_in(&limits);
        let settled = finding.code == codes::SETTLED && is_in(&clamped);
        !limit && !settled
    });
    // What was not analysed is said once of a case, however many of its lines and components it is true of.
    let mut said = std::collections::HashSet::new();
    found.retain(|finding| finding.code != codes::NOT_ANALYSED || said.insert(finding.message.clone()));
}

/// The note that some analyses stopped, or could not begin.
fn not_analysed(program: &Program, left_out: &[Code]) -> Diagnostic {
    let codes: Vec<String> = left_out.iter().map(Code::to_string).collect();
    let message = format!("the table is too intricate to look for {}", words::list(&codes));
    Diagnostic::note(codes::NOT_ANALYSED, message)
        .at(program.hit_policy_span, "")
        .help("sets of its inputs, or the values of its lines, take more work than the limits allow")
        .help("split the table, or write conditions on fewer inputs")
}

/// The findings without notes; empty for a clean program.
pub fn problems(program: &Program, levels: &LintLevels) -> Vec<Diagnostic> {
    let mut found = report(program, levels).open;
    found.retain(|finding| finding.severity != Severity::Note);
    found
}

/// Checks the text of a table and returns the codes and messages of its findings.
#[cfg(test)]
fn found(text: &str) -> Vec<String> {
    use crate::diag::Source;
    use crate::table::Table;
    let program = Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table));
    let program = program.unwrap_or_else(|e| panic!("{e}"));
    findings(&program).iter().map(|d| format!("{} {}", d.code, d.message)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values in hundreds of bits take long, and are given up like sets.
    #[test]
    #[cfg(feature = "precise")]
    fn a_search_for_zeros_stops_and_says_so() {
        use crate::diag::Source;
        use crate::table::Table;
        let text = r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}, output: Number(),
            cases: [Case(id: 1, when: "x < 0.5", value: "1 / (x * y - 0.125)")], default: 0)"#;
        let program = Table::parse(Source::new("t.ron", text)).and_then(|table| Program::check(&table));
        let program = program.unwrap_or_else(|e| panic!("{e}"));
        let found = |steps: u64| {
            let found = report_within(&program, &LintLevels::default(), steps).open;
            found.iter().map(|finding| format!("{} {}", finding.code, finding.message)).collect::<Vec<_>>()
        };
        assert!(found(STEPS).iter().any(|message| message.contains("divides by zero")), "{:?}", found(STEPS));
        let some = found(1000);
        assert!(some.iter().any(|message| message.starts_with("U0530") && message.contains("U0552")), "{some:?}");
    }

    /// The published tables take a hundredth of what an analysis may do; with less than they take, what was
    /// not looked for is named, and nothing else is claimed of it.
    #[test]
    fn an_analysis_stops_and_says_for_what_it_was_looking() {
        for table in ["tables/rsmss.ron", "tables/published/rsmss_as_printed.ron"] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            let found = |steps: u64| {
                let found = report_within(&program, &LintLevels::default(), steps);
                let shown = |finding: &Diagnostic| format!("{} {}", finding.code, finding.message);
                found.open.iter().map(shown).collect::<Vec<_>>()
            };
            let all = found(STEPS);
            assert_eq!(found(STEPS / 10), all, "{table}");
            for steps in [1, 1000, 100_000] {
                let some = found(steps);
                let (notes, others): (Vec<_>, Vec<_>) = some.iter().partition(|message| message.starts_with("U0530"));
                // A border has its share of the work, and is named by itself.
                let known = |note: &&String| {
                    note.contains("too intricate to look for U0") || note.contains("was not looked at")
                };
                assert!(!notes.is_empty() && notes.iter().all(known), "{notes:?}");
                let mut others = others.into_iter();
                assert!(others.all(|message| all.contains(message)), "{table} {steps}: {some:?}");
            }
        }
    }
}
