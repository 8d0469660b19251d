//! Findings: what is questionable about a program that has a meaning.
//!
//! A table that is malformed never gets here; [`Program::check`] refuses it.
//! What is found here is about intent: an example that the table contradicts,
//! a declaration that nothing uses, cases that contradict each other. Each analysis is a file of its own and a
//! line of [`ANALYSES`].

mod claims;
mod coverage;
mod examples;
mod levels;
mod overlap;
#[cfg(feature = "precise")]
mod singular;
mod symmetry;
mod unused;

use crate::diag::{Diagnostic, Severity};
use crate::program::{Program, symbolic};

pub use claims::allowance;
pub use coverage::{Coverage, Dead, coverage};
pub use examples::agrees;
pub use levels::{FINDINGS, Findings, Level, Levels};
pub use overlap::{Overlap, overlaps};
#[cfg(feature = "precise")]
pub use singular::{Singularity, domain_points, singularities};
pub use symmetry::{Violation, admissible, violations, violations_under};

/// Every analysis that can find something wrong, in the order in which findings are shown.
const ANALYSES: &[fn(&Program) -> Vec<Diagnostic>] = &[
    examples::findings,
    claims::findings,
    overlap::findings,
    coverage::findings,
    unused::findings,
    #[cfg(feature = "precise")]
    singular::findings,
];

/// Analyses that only ever note facts.
const REMARKS: &[fn(&Program) -> Vec<Diagnostic>] = &[symmetry::findings];

/// Everything that is questionable or worth knowing about a program, without
/// what the table itself acknowledges.
///
/// An error contradicts the table's own declarations, a warning does not. A note
/// is a fact worth knowing, and leaves the table clean.
pub fn findings(program: &Program) -> Vec<Diagnostic> {
    report(program, &Levels::default()).open
}

/// Every finding: those to be shown, at the levels asked for, and those that the table acknowledges.
pub fn report(program: &Program, levels: &Levels) -> Findings {
    let found = ANALYSES.iter().chain(REMARKS).flat_map(|analysis| analysis(program)).collect();
    levels::sort(program, found, levels)
}

/// The findings without notes; empty for a clean program.
pub fn problems(program: &Program, levels: &Levels) -> Vec<Diagnostic> {
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
