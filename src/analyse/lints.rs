//! Levels of findings: the one that a finding has by itself, the one that the
//! user gives to its code, and cases that acknowledge it.

use crate::diag::codes::Kind;
use crate::diag::{Code, Diagnostic, Severity, codes};
use crate::program::Program;
use crate::table::Allow;

/// The treatment of the findings of a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LintLevel {
    /// Leave them out.
    Allow,
    /// Warn.
    Warn,
    /// Treat them as errors.
    Deny,
}

/// The levels that the user gave to codes.
#[derive(Debug, Clone, Default)]
pub struct LintLevels(Vec<(Code, LintLevel)>);

impl LintLevels {
    /// Gives a level to a code. The last one counts.
    ///
    /// # Errors
    /// In words, if there is no such finding or if its level is not to be chosen.
    pub fn set(&mut self, code: &str, level: LintLevel) -> Result<(), String> {
        let Some(finding) = codes::entry(code).filter(|entry| entry.kind == Kind::Finding) else {
            let known: Vec<&str> = codes::findings().map(|entry| entry.code.0).collect();
            return Err(format!("there is no finding `{code}`; the findings are: {}", known.join(", ")));
        };
        let code = finding.code;
        if code == codes::EXAMPLE_FAILS && level != LintLevel::Deny {
            return Err(format!("{code} stays an error: an example that fails contradicts the table"));
        }
        self.0.push((code, level));
        Ok(())
    }

    /// The level of a code, if the user gave one.
    fn of(&self, code: Code) -> Option<LintLevel> {
        self.0.iter().rev().find(|(known, _)| *known == code).map(|(_, level)| *level)
    }

    /// Applies the levels that the user gave.
    fn apply(&self, findings: &mut Vec<Diagnostic>) {
        findings.retain_mut(|finding| {
            match self.of(finding.code) {
                Some(LintLevel::Allow) => return false,
                Some(LintLevel::Warn) => finding.severity = Severity::Warning,
                Some(LintLevel::Deny) => finding.severity = Severity::Error,
                None => {}
            }
            true
        });
    }
}

/// The findings about a program.
#[derive(Debug, Clone, Default)]
pub struct Findings {
    /// Those to be shown.
    pub open: Vec<Diagnostic>,
    /// Those that the table itself acknowledges, with the reason it gives.
    pub acknowledged: Vec<(Diagnostic, String)>,
}

/// Sets aside what the table acknowledges, then applies the levels of the user.
///
/// An `allow` of a case acknowledges the findings whose first place is in that
/// case, one of the table those whose first place is in none. Of codes that were not
/// looked for, nothing is said to acknowledge nothing.
pub(super) fn sort(program: &Program, found: Vec<Diagnostic>, left_out: &[Code], levels: &LintLevels) -> Findings {
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
        if !used && !left_out.iter().any(|code| code.0 == allow.code.value) {
            findings.open.push(unused(program, *row, allow));
        }
    }
    levels.apply(&mut findings.open);
    findings
}

fn unused(program: &Program, row: Option<usize>, allow: &Allow) -> Diagnostic {
    let code = &allow.code.value;
    let known = codes::findings().any(|known| known.code.0 == code);
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
        let mut levels = LintLevels::default();
        assert_eq!(levels.set("u0505", LintLevel::Allow), Ok(()));
        assert_eq!(levels.set("U0505", LintLevel::Deny), Ok(()));
        assert_eq!(levels.of(codes::UNUSED_INPUT), Some(LintLevel::Deny));
        assert!(levels.set("U0203", LintLevel::Warn).is_err_and(|e| e.starts_with("there is no finding `U0203`")));
        assert!(levels.set("U0501", LintLevel::Allow).is_err());
    }
}
