//! The findings, one file a subject, and the registry of what finds them.
//!
//! A new finding is a file here and its line in [`ALL`]; its code is registered in `diag::codes`.

pub(crate) mod accuracy;
pub(crate) mod claims;
pub(crate) mod continuity;
pub(crate) mod coverage;
pub(crate) mod examples;
pub(crate) mod guards;
pub(crate) mod lengths;
pub(crate) mod lines;
pub(crate) mod numbers;
pub(crate) mod overlap;
pub(crate) mod settled;
#[cfg(feature = "precise")]
pub(crate) mod singular;
pub(crate) mod style;
pub(crate) mod symmetry;
pub(crate) mod unused;

use super::sets::budget::Budget;
use super::sets::study::Study;
use crate::diag::{Code, Diagnostic};
use crate::program::Program;

/// An analysis, with the codes of its findings.
pub(super) struct Analysis {
    /// The codes of its findings.
    pub(super) codes: &'static [Code],
    /// The analysis itself.
    pub(super) run: Run,
}

/// The view of a program that an analysis takes.
pub(super) enum Run {
    /// The program as it is written; functions are analysed, too.
    Program(fn(&Program) -> Vec<Diagnostic>),
    /// The same, if it may take long.
    #[cfg_attr(not(feature = "precise"), allow(dead_code))]
    Bounded(fn(&Program, &Budget) -> Vec<Diagnostic>),
    /// Sets of inputs, which the cases of a table divide.
    Sets(fn(&mut Study<'_>) -> Vec<Diagnostic>),
}

/// Every analysis, in the order in which their findings are shown.
pub(super) const ALL: &[Analysis] = &[
    examples::ANALYSIS,
    accuracy::ANALYSIS,
    lengths::ANALYSIS,
    claims::ANALYSIS,
    unused::ANALYSIS,
    #[cfg(feature = "precise")]
    singular::ANALYSIS,
    overlap::ANALYSIS,
    coverage::ANALYSIS,
    coverage::IN_FUNCTIONS,
    lines::ANALYSIS,
    settled::ANALYSIS,
    symmetry::ANALYSIS,
    continuity::ANALYSIS,
    numbers::ANALYSIS,
    guards::ANALYSIS,
    style::ANALYSIS,
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::codes;

    /// Codes that no analysis finds: `analyse` itself reports them.
    const OTHERS: [Code; 3] = [codes::NOT_ANALYSED, codes::UNUSED_ALLOW, codes::WIDE_ALLOW];

    #[test]
    #[cfg(feature = "precise")]
    fn every_registered_finding_is_found_by_an_analysis() {
        let found = |code: &Code| ALL.iter().any(|analysis| analysis.codes.contains(code));
        for entry in codes::findings() {
            assert!(found(&entry.code) || OTHERS.contains(&entry.code), "{} is found by nothing", entry.code);
        }
        let registered = |code: &Code| codes::findings().any(|entry| entry.code == *code);
        assert!(ALL.iter().flat_map(|analysis| analysis.codes).all(registered), "a code that is no finding");
    }
}
