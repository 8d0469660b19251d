//! Findings: what is questionable about a program that has a meaning.
//!
//! A table that is malformed never gets here; [`Program::check`] refuses it.
//! What is found here is about intent: an example that the table contradicts,
//! a declaration that nothing uses. Each analysis is a file of its own and a
//! line of [`ANALYSES`].

mod examples;
mod unused;

use crate::diag::Diagnostic;
use crate::program::Program;

pub use examples::agrees;

/// Every analysis, in the order in which findings are shown.
const ANALYSES: &[fn(&Program) -> Vec<Diagnostic>] = &[examples::findings, unused::findings];

/// Everything that is questionable about a program; empty for a clean one.
///
/// An error contradicts the table's own declarations, a warning does not.
pub fn findings(program: &Program) -> Vec<Diagnostic> {
    ANALYSES.iter().flat_map(|analysis| analysis(program)).collect()
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
