//! What becomes of a finding: the level it has by itself, the one that the
//! user gives to its code, and rows that acknowledge it.

use crate::diag::{Code, Diagnostic, Severity, codes};
use crate::program::Program;
use crate::table::Allow;

/// Every code of a finding, and what it is about.
pub const FINDINGS: &[(Code, &str)] = &[
    (codes::EXAMPLE_FAILS, "an example leads to another case or value"),
    (codes::NOT_UNIQUE, "`Unique`, but two cases match and differ"),
    (codes::UNCOVERED, "states that no case claims"),
    (codes::DEAD_CASE, "a case that is never taken"),
    (codes::UNUSED_INPUT, "an input or name that nothing uses"),
    (codes::SYMMETRY_BROKEN, "cases that contradict their images under a declared symmetry"),
    (codes::NO_LINE, "a case that can match without a line that applies"),
    (codes::LINES_CROSS, "lines of one case that hold together with different values"),
    (codes::ORDER_MATTERS, "cases that hold together with different values"),
    (codes::NOT_REACHED, "a case that is never taken where the assumptions hold"),
    (codes::DEAD_LINE, "a line, or a part of its value, that never counts"),
    (codes::SYMMETRY_ASSUMED, "cases that are images of each other only because an assumption holds"),
    (codes::OUT_OF_RANGE, "a value that is beyond the clamp wherever it counts"),
    (codes::NOT_A_NUMBER, "an operation that can leave the numbers"),
    (codes::FLOAT_EQUALITY, "numbers that are compared for equality"),
    (codes::JUMP, "the value jumps where it is declared not to"),
    (codes::INEXACT, "a constant that no f32 equals"),
    (codes::MERGEABLE, "cases that could be one"),
    (codes::RENAMED, "a name that a target has to change"),
    (codes::NOT_ANALYSED, "an analysis that could not be done"),
    (codes::REMOVABLE, "a division by zero where the value has a limit"),
    (codes::POLE, "a division by zero where it has none"),
    (codes::CANCELS, "terms that cancel on paper only"),
    (codes::OVERFLOW, "an overflow on the way to a finite value"),
    (codes::LIMIT_BROKEN, "a function that is not what a limit claims"),
    (codes::BUDGET_EXCEEDED, "a function that is less accurate than it claims"),
    (codes::UNUSED_ALLOW, "an `allow` that acknowledges nothing"),
];

/// What to do with findings of a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Leave them out.
    Allow,
    /// Warn.
    Warn,
    /// Treat them as errors.
    Deny,
}

/// The levels that the user gave to codes.
#[derive(Debug, Clone, Default)]
pub struct Levels(Vec<(Code, Level)>);

impl Levels {
    /// Gives a level to a code. The last one counts.
    ///
    /// # Errors
    /// In words, if there is no such finding or if its level is not to be chosen.
    pub fn set(&mut self, code: &str, level: Level) -> Result<(), String> {
        let Some((code, _)) = FINDINGS.iter().find(|(known, _)| known.0.eq_ignore_ascii_case(code)) else {
            let known: Vec<&str> = FINDINGS.iter().map(|(code, _)| code.0).collect();
            return Err(format!("there is no finding `{code}`; the findings are: {}", known.join(", ")));
        };
        if *code == codes::EXAMPLE_FAILS && level != Level::Deny {
            return Err(format!("{code} stays an error: an example that fails contradicts the table"));
        }
        self.0.push((*code, level));
        Ok(())
    }

    /// The level of a code, if the user gave one.
    fn of(&self, code: Code) -> Option<Level> {
        self.0.iter().rev().find(|(known, _)| *known == code).map(|(_, level)| *level)
    }

    /// What the user makes of findings.
    fn apply(&self, findings: &mut Vec<Diagnostic>) {
        findings.retain_mut(|finding| {
            match self.of(finding.code) {
                Some(Level::Allow) => return false,
                Some(Level::Warn) => finding.severity = Severity::Warning,
                Some(Level::Deny) => finding.severity = Severity::Error,
                None => {}
            }
            true
        });
    }
}

/// The findings about a program.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// What is to be shown.
    pub open: Vec<Diagnostic>,
    /// What the table itself acknowledges, with the reason it gives.
    pub acknowledged: Vec<(Diagnostic, String)>,
}

/// Sets aside what the table acknowledges, then applies the levels of the user.
///
/// An `allow` of a row acknowledges the findings whose first place is in that
/// row, one of the table those whose first place is in none.
pub(super) fn sort(program: &Program, found: Vec<Diagnostic>, levels: &Levels) -> Findings {
    let mut findings = Findings::default();
    let mut used: Vec<bool> = Vec::new();
    let allows: Vec<(Option<usize>, &Allow)> = program
        .rows
        .iter()
        .enumerate()
        .flat_map(|(row, case)| case.allow.iter().map(move |allow| (Some(row), allow)))
        .chain(program.allow.iter().map(|allow| (None, allow)))
        .collect();
    used.resize(allows.len(), false);
    for finding in found {
        let place = finding.labels.first().map(|label| label.span);
        let row = place.and_then(|place| {
            program.rows.iter().position(|row| row.span.start <= place.start && place.end <= row.span.end)
        });
        let fits = |(of, allow): &(Option<usize>, &Allow)| *of == row && allow.code.value == finding.code.0;
        match allows.iter().position(fits) {
            // What contradicts the table's own declarations cannot be talked away.
            Some(number) if finding.severity != Severity::Error => {
                used[number] = true;
                findings.acknowledged.push((finding, allows[number].1.reason.clone()));
            }
            _ => findings.open.push(finding),
        }
    }
    for ((row, allow), used) in allows.iter().zip(used) {
        if !used {
            findings.open.push(unused(program, *row, allow));
        }
    }
    levels.apply(&mut findings.open);
    findings
}

fn unused(program: &Program, row: Option<usize>, allow: &Allow) -> Diagnostic {
    let code = &allow.code.value;
    let known = FINDINGS.iter().any(|(known, _)| known.0 == code);
    let warning = Diagnostic::warning(codes::UNUSED_ALLOW, format!("nothing to acknowledge for `{code}`"));
    match (known, row) {
        (false, _) => warning.at(allow.code.span, "there is no finding with this code").help("check the code"),
        (true, Some(row)) => warning
            .at(allow.span, format!("no such finding has its first place in case {}", program.rows[row].id))
            .help("remove it, or move it to the case that the finding points at first"),
        (true, None) => warning
            .at(allow.span, "no such finding is about the table as a whole")
            .help("remove it, or move it to the case that the finding points at first"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_for_findings() {
        let mut levels = Levels::default();
        assert_eq!(levels.set("u0505", Level::Allow), Ok(()));
        assert_eq!(levels.set("U0505", Level::Deny), Ok(()));
        assert_eq!(levels.of(codes::UNUSED_INPUT), Some(Level::Deny));
        assert!(levels.set("U0203", Level::Warn).is_err_and(|e| e.starts_with("there is no finding `U0203`")));
        assert!(levels.set("U0501", Level::Allow).is_err());
    }
}
