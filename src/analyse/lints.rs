//! Levels of findings: the one that a finding has by itself, the one that the
//! user gives to its code, and cases that acknowledge it.

use super::acknowledge::Text;
use super::words;
use crate::diag::codes::Kind;
use crate::diag::{Code, Diagnostic, Severity, Spanned, codes};
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
        let needed = match code {
            codes::EXAMPLE_FAILS => Some("an example that fails contradicts the table"),
            codes::OVERLONG => Some("generated code has no place for more items"),
            _ => None,
        };
        if let Some(reason) = needed.filter(|_| level != LintLevel::Deny) {
            return Err(format!("{code} stays an error: {reason}"));
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
/// case, one of the table those whose first place is in none, if it names all that
/// they are about, or nothing at all. Of codes that were not looked for, nothing is
/// said to acknowledge nothing.
pub(super) fn sort(program: &Program, found: Vec<Diagnostic>, left_out: &[Code], levels: &LintLevels) -> Findings {
    let mut findings = Findings::default();
    let text = Text::new(program);
    let allows: Vec<(Option<usize>, &Allow)> = program
        .rows
        .iter()
        .enumerate()
        // Images of a case are rows of their own, which repeat what it allows.
        .filter(|(row, case)| row.checked_sub(1).is_none_or(|before| program.rows[before].span != case.span))
        .flat_map(|(row, case)| case.allow.iter().map(move |allow| (Some(row), allow)))
        .chain(program.allow.iter().map(|allow| (None, allow)))
        .collect();
    // For each of them, what the findings of its code and place are about, if there are any.
    let mut about: Vec<Option<Vec<String>>> = vec![None; allows.len()];
    for finding in found {
        let place = finding.labels.first().map(|label| label.span);
        let row = place.and_then(|place| {
            program.rows.iter().position(|row| row.span.start <= place.start && place.end <= row.span.end)
        });
        let of_code = |(of, allow): &&(Option<usize>, &Allow)| *of == row && allow.code.value == finding.code.0;
        let covers = |(_, allow): &(Option<usize>, &Allow)| unnamed(allow, &finding).is_empty();
        for (number, _) in allows.iter().enumerate().filter(|(_, entry)| of_code(entry)) {
            about[number].get_or_insert_default().extend(finding.subject().iter().cloned());
        }
        let fits = allows.iter().position(|entry| of_code(&entry) && covers(entry));
        match fits {
            // What contradicts the table's own declarations cannot be talked away.
            Some(number) if finding.severity != Severity::Error => {
                findings.acknowledged.push((finding, allows[number].1.reason.clone()));
            }
            _ => {
                let others: Vec<&Allow> = allows.iter().filter(of_code).map(|(_, allow)| *allow).collect();
                // Nobody mends an exhibit, or acknowledges what is wrong with it.
                findings.open.push(match program.exhibit {
                    None => with_advice(finding, &others, row, &text),
                    Some(_) => finding,
                });
            }
        }
    }
    for ((row, allow), about) in allows.iter().zip(about) {
        if !left_out.iter().any(|code| code.0 == allow.code.value) {
            findings.open.extend(questionable(&text, program, *row, allow, about.as_deref()));
        }
    }
    levels.apply(&mut findings.open);
    findings
}

/// The things that a finding is about and an `allow` does not name.
fn unnamed<'f>(allow: &Allow, finding: &'f Diagnostic) -> Vec<&'f str> {
    let Some(with) = &allow.with else { return Vec::new() };
    let about = finding.subject().iter().map(String::as_str);
    about.filter(|thing| !with.iter().any(|named| named.value == *thing)).collect()
}

/// A finding with the `allow` that would acknowledge it; `others` are those of its place and code that do not.
fn with_advice(finding: Diagnostic, others: &[&Allow], row: Option<usize>, text: &Text<'_>) -> Diagnostic {
    if finding.severity == Severity::Error || finding.subject().is_empty() {
        return finding;
    }
    let owned = |things: Vec<&str>| things.into_iter().map(str::to_owned).collect::<Vec<_>>();
    let new = others.iter().map(|allow| (*allow, owned(unnamed(allow, &finding))));
    match new.min_by_key(|(_, new)| new.len()) {
        Some((allow, new)) => {
            let new: Vec<&str> = new.iter().map(String::as_str).collect();
            let help = format!("new is {}; if that stays as well, add it to `with`: {}", quoted(&new), listed(&new));
            text.offer_more(finding.help(help), allow, &new)
        }
        None => {
            let about: Vec<&str> = finding.subject().iter().map(String::as_str).collect();
            let allow = format!("(code: \"{}\", with: {}, reason: \"...\")", finding.code, listed(&about));
            text.offer(finding.help(format!("if it is understood and stays: allow: [{allow}]")), row, &allow)
        }
    }
}

/// Things as RON lists them.
fn listed(things: &[&str]) -> String {
    let things: Vec<String> = things.iter().map(|thing| format!("{thing:?}")).collect();
    format!("[{}]", things.join(", "))
}

fn quoted(things: &[&str]) -> String {
    words::list(&things.iter().map(|thing| format!("`{thing}`")).collect::<Vec<_>>())
}

/// The finding about an `allow`: that it acknowledges nothing, names what is not there, or does not say what it
/// acknowledges. `about` is what the findings of its code and place are about, if there are any.
fn questionable(
    text: &Text<'_>,
    program: &Program,
    row: Option<usize>,
    allow: &Allow,
    about: Option<&[String]>,
) -> Option<Diagnostic> {
    let code = &allow.code.value;
    let Some(about) = about else { return Some(text.offer_without(unused(program, row, allow), row, allow)) };
    let Some(with) = &allow.with else {
        let mut things: Vec<&str> = Vec::new();
        for thing in about {
            if !things.contains(&thing.as_str()) {
                things.push(thing);
            }
        }
        let message = format!("this `allow` acknowledges every finding of {code} here, also new ones");
        return (!things.is_empty()).then(|| {
            let note = Diagnostic::note(codes::WIDE_ALLOW, message)
                .at(allow.span, "")
                .help(format!("to acknowledge those that there are: with: {}", listed(&things)));
            text.offer_with(note, allow, &listed(&things))
        });
    };
    let gone = with.iter().filter(|thing| !about.contains(&thing.value));
    let gone: Vec<&Spanned<String>> = gone.collect();
    let first = gone.first()?;
    let things: Vec<&str> = gone.iter().map(|thing| thing.value.as_str()).collect();
    let message = format!("nothing to acknowledge for {} of `{code}`", quoted(&things));
    let warning = Diagnostic::warning(codes::UNUSED_ALLOW, message)
        .at(first.span, "no finding here is about this")
        .help("remove it, so that it hides nothing that is new");
    Some(text.offer_fewer(warning, allow, first.span))
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

    /// A table whose lines 1 and 2 cross, or 1 and 3 as well, with an `allow`.
    fn checked(third: &str, allow: &str) -> Vec<String> {
        crate::analyse::found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"a": Bool(), "b": Bool(), "c": Bool(), "x": Range(from: 0, to: 1)}},
                output: Number(),
                cases: [Case(id: 4, when: true, lines: [("x", "a"), ("1 - x", "b"), ("0.5", "{third}"), "0"],
                    allow: [{allow}])],
                default: "if c {{ 0 }} else {{ 1 }}")"#
        ))
    }

    #[test]
    fn an_allow_covers_what_it_names() {
        let crossing = "U0508 lines 1 and 2 of case 4 can apply together, with different values";
        let more = "U0508 lines 1 and 2 of case 4 can apply together, with different values; so can 2 more pairs";
        let narrow = r#"(code: "U0508", with: ["lines 1 and 2"], reason: "so it is printed")"#;
        assert_eq!(
            checked("!a && !b && c", r#"(code: "U0511", reason: "none")"#).first().map(String::as_str),
            Some(crossing)
        );
        assert_eq!(checked("!a && !b && c", narrow), [""; 0]);
        // Line 3 crosses as well: that is new, and all of it is shown, but the `allow` is not called needless.
        assert_eq!(checked("c", narrow), [more]);
        // Without names it covers everything, which is said.
        let wide = checked("c", r#"(code: "U0508", reason: "so it is printed")"#);
        assert_eq!(wide, ["U0532 this `allow` acknowledges every finding of U0508 here, also new ones"]);
        let stale = r#"(code: "U0508", with: ["lines 1 and 2", "lines 2 and 9"], reason: "so it is printed")"#;
        assert_eq!(checked("!a && !b && c", stale), ["U0531 nothing to acknowledge for `lines 2 and 9` of `U0508`"]);
    }

    #[test]
    fn advice_can_be_pasted() {
        let text = r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"a": Bool(), "b": Bool()}, output: Number(),
            cases: [Case(id: 4, when: true, lines: [("1", "a"), ("2", "b"), "0"])], default: 0)"#;
        let program = |text: &str| {
            let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text));
            table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
        };
        let found = crate::analyse::findings(&program(text));
        let advice = found[0].notes.iter().find_map(|note| note.strip_prefix("if it is understood and stays: "));
        let advice = advice.expect("a finding about lines has advice").replace("...", "a test");
        let mended = text.replace("\"0\"])", &format!("\"0\"], {advice})"));
        assert!(crate::analyse::findings(&program(&mended)).is_empty(), "{advice}");
    }

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
