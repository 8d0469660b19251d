//! U0507, U0508, U0511: lines of a case: none applies, two do and differ, one never does.

mod choices;

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::View;
use crate::analyse::sets::study::{Piece, Study};
use crate::analyse::values::rounding::{self, Rounding};
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::NO_LINE, codes::LINES_CROSS, codes::DEAD_LINE], run: Run::Sets(findings) };

/// Looks at the lines of every case.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for row in 0..study.program.rows.len() {
        let taken = study.space.sets.and(study.counts(row), study.assumed);
        // A case that is never taken is a finding of its own.
        if study.space.is_void(taken) {
            continue;
        }
        found.extend(no_line(study, row, taken));
        found.extend(crossing(study, row, taken));
        found.extend(dead_lines(study, row, taken));
    }
    found.extend(choices::findings(study));
    found
}

/// Reports where the case is taken and none of its lines applies.
fn no_line(study: &mut Study<'_>, row: usize, taken: Set) -> Option<Diagnostic> {
    let default = study.rows.own[row].iter().filter(|piece| piece.line.is_none());
    let default: Vec<Set> = default.map(|piece| piece.set).collect();
    let mut without = Set::EMPTY;
    for set in default {
        without = study.space.sets.or(without, set);
    }
    let without = study.space.sets.and(without, taken);
    let witness = study.space.witness(without)?;
    let program = study.program;
    let case = &program.rows[row];
    let count = study.space.count(without);
    let relevant = words::mentioned(program, row);
    let message = format!("case {} can match without a line that applies: the default decides", case.id);
    let last = case.lines.last().map_or(case.span, |line| line.span);
    let pruned = study.space.prune(without);
    let shown = words::conditions(&mut study.space, pruned, 3);
    Some(
        Diagnostic::warning(codes::NO_LINE, message)
            .at(last, "after this line nothing is left")
            .at(case.guard_span, "but the guard holds")
            .help(match words::at(program, &witness, relevant) {
                Some(place) => format!("in {}, for instance at {place}", words::states(count)),
                None => format!("in {}", words::states(count)),
            })
            .help(format!("where {}", shown.join(", or ")))
            .about(shown.into_iter().chain([words::states(count)]))
            .help("add a line for this, or a last line without a condition"),
    )
}

/// Pairs of lines that apply together with different values, neither of them
/// the more special one: which counts is then an accident of their order.
fn crossing(study: &mut Study<'_>, row: usize, taken: Set) -> Option<Diagnostic> {
    let program = study.program;
    let case = &program.rows[row];
    let mut conditions: Vec<(usize, Set)> = Vec::new();
    for (number, line) in case.lines.iter().enumerate() {
        let condition = study.space.condition(line.condition, View::PLAIN);
        if condition != Set::ALL {
            conditions.push((number, study.space.sets.and(condition, taken)));
        }
    }
    let mut pairs: Vec<(usize, usize, Set)> = Vec::new();
    for (place, (first, here)) in conditions.iter().enumerate() {
        for (second, there) in &conditions[place + 1..] {
            let both = study.space.sets.and(*here, *there);
            let alone = [study.space.sets.minus(*here, *there), study.space.sets.minus(*there, *here)];
            if alone.iter().any(|set| study.space.is_void(*set)) || study.space.is_void(both) {
                continue;
            }
            let different = lines_differ(study, row, (*first, *second), both);
            if !study.space.is_void(different) {
                pairs.push((*first, *second, different));
            }
        }
    }
    let (first, second, different) = *pairs.first()?;
    let witness = study.space.witness(different)?;
    let relevant = words::mentioned(program, row);
    let message = match pairs.len() {
        1 => format!(
            "lines {} and {} of case {} can apply together, with different values",
            first + 1,
            second + 1,
            case.id
        ),
        count => {
            let (a, b) = (first + 1, second + 1);
            let more = if count == 2 { "one more pair".to_owned() } else { format!("{} more pairs", count - 1) };
            format!("lines {a} and {b} of case {} can apply together, with different values; so can {more}", case.id)
        }
    };
    let mut warning = Diagnostic::warning(codes::LINES_CROSS, message)
        .at(case.lines[second].span, "this one applies as well")
        .at(case.lines[first].span, "this one counts, because it is written first");
    if let Some(place) = words::at(program, &witness, relevant) {
        warning = warning.help(format!("for instance at {place}"));
    }
    if pairs.len() > 1 {
        let others: Vec<String> =
            pairs[1..].iter().map(|(first, second, _)| format!("{} with {}", first + 1, second + 1)).collect();
        warning = warning.help(format!("also lines {}", words::list(&others)));
    }
    let about = pairs.iter().map(|(first, second, _)| format!("lines {} and {}", first + 1, second + 1));
    Some(warning.about(about).help("make the conditions exclude each other, or acknowledge that the order decides"))
}

/// The part of a set in which the values of two lines differ.
fn lines_differ(study: &mut Study<'_>, row: usize, (first, second): (usize, usize), within: Set) -> Set {
    let lines = &study.program.rows[row].lines;
    let parts = [first, second].map(|line| study.space.products(&lines[line].values, View::PLAIN));
    let mut result = Set::EMPTY;
    for (here, a) in &parts[0] {
        for (there, b) in &parts[1] {
            let both = study.space.sets.and(*here, *there);
            let both = study.space.sets.and(both, within);
            if both.is_empty() {
                continue;
            }
            let different = study.space.different(a, b);
            let different = study.space.sets.and(both, different);
            result = study.space.sets.or(result, different);
        }
    }
    result
}

/// Lines that never count.
fn dead_lines(study: &mut Study<'_>, row: usize, taken: Set) -> Vec<Diagnostic> {
    let program = study.program;
    let case = &program.rows[row];
    let mut found = Vec::new();
    let mut rest = taken;
    for (number, line) in case.lines.iter().enumerate() {
        let condition = study.space.condition(line.condition, View::PLAIN);
        let counts = study.space.sets.and(rest, condition);
        if study.space.is_void(counts) {
            found.push(dead_line(study, row, number));
        }
        rest = study.space.sets.minus(rest, condition);
    }
    found
}

fn dead_line(study: &mut Study<'_>, row: usize, number: usize) -> Diagnostic {
    let program = study.program;
    let case = &program.rows[row];
    let line = &case.lines[number];
    let here = |piece: &&Piece| piece.line == Some(number);
    let anywhere: Vec<Set> = study.rows.own[row].iter().filter(here).map(|piece| piece.set).collect();
    let mut counts = Set::EMPTY;
    for set in anywhere {
        let set = study.space.sets.and(set, study.counts(row));
        counts = study.space.sets.or(counts, set);
    }
    let condition = study.space.condition(line.condition, View::PLAIN);
    let holds = study.space.sets.and(condition, study.counts(row));
    let holds = if study.space.is_void(holds) { holds } else { study.space.sets.and(holds, study.assumed) };
    let message = format!("line {} of case {} never counts", number + 1, case.id);
    let warning = Diagnostic::warning(codes::DEAD_LINE, message).about([format!("line {}", number + 1)]);
    if !study.space.is_void(counts) {
        let blamed = study.blame(counts);
        let quoted: Vec<String> = blamed.iter().map(|name| format!("`{name}`")).collect();
        return warning
            .at(line.span, format!("{} rules this out", words::list(&quoted)))
            .about(blamed)
            .help("mend its condition or the assumption, or remove the line");
    }
    if study.space.is_void(holds) {
        let warning =
            warning.at(line.span, "its condition never holds where the case is taken").at(case.guard_span, "the guard");
        let mut rounds = Rounding::new(&program.pool);
        return match rounds.decides(line.condition) || rounds.decides(case.guard) {
            true => warning.help(rounding::MAY_HOLD),
            false => warning.help("mend the condition, or remove the line"),
        };
    }
    let mut warning = warning.at(line.span, "wherever its condition holds, an earlier line counts");
    for earlier in case.lines[..number].iter() {
        let condition = study.space.condition(earlier.condition, View::PLAIN);
        if warning.labels.len() < 4 && study.space.can_meet(condition, holds) {
            warning = warning.at(earlier.span, "this one");
        }
    }
    warning.help("mend the conditions, move the line up, or remove it")
}
