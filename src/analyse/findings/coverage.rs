//! U0503: states, and numbers in other states, that no case claims; U0504, U0510: cases that are never taken.
//!
//! A default is a legitimate part of a table, so unclaimed states are a note.
//! A case that can never be taken is a warning: somebody wrote it for a reason.

mod regions;

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::study::Study;
use crate::analyse::values::rounding::{self, Rounding};
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::{InputSet, Program};
use crate::table::HitPolicy;

/// The states of a table that its cases claim.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Coverage {
    /// All states of the discrete inputs that are not fetched.
    pub states: usize,
    /// States in which no guard can hold.
    pub unclaimed: Vec<usize>,
    /// States in which guards can hold, but none always does: it depends on
    /// fetched or continuous inputs whether one applies.
    pub open: Vec<usize>,
    /// Cases that are never taken.
    pub dead: Vec<Dead>,
}

/// A case that is never taken.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dead {
    /// The case, as an index into [`Program::rows`].
    pub row: usize,
    /// Earlier rows that claim the states in which its guard can hold, the one
    /// that claims most first; empty if its guard never holds.
    pub covered_by: Vec<usize>,
}

/// Finds the cases that claim each state.
pub fn coverage(program: &Program) -> Coverage {
    let mut study = Study::new(program);
    let (unclaimed, open) = gaps(&mut study);
    Coverage {
        states: program.states.count(),
        unclaimed: list(&study, unclaimed),
        open: list(&study, open),
        dead: dead(&mut study),
    }
}

/// The states that no case claims, and those that some case may claim.
fn gaps(study: &mut Study<'_>) -> (Set, Set) {
    let claimed = study.space.sets.not(study.rows.unclaimed);
    let (claimed, left) = (study.space.states(claimed), study.space.states(study.rows.unclaimed));
    (study.space.sets.not(claimed), study.space.sets.and(claimed, left))
}

/// The numbers of the states in a set.
fn list(study: &Study<'_>, set: Set) -> Vec<usize> {
    fn walk(study: &Study<'_>, set: Set, digit: usize, number: usize, found: &mut Vec<usize>) {
        if set.is_empty() {
            return;
        }
        let Some((_, count)) = study.program.states.digits().get(digit) else {
            found.push(number);
            return;
        };
        for level in 0..*count {
            let child = match study.space.sets.test(set) {
                Some((tested, children)) if tested == digit => children[level],
                _ => set,
            };
            walk(study, child, digit + 1, number * count + level, found);
        }
    }
    let mut found = Vec::new();
    walk(study, set, 0, 0, &mut found);
    found
}

/// The cases that are never taken.
fn dead(study: &mut Study<'_>) -> Vec<Dead> {
    let mut found = Vec::new();
    for row in 0..study.program.rows.len() {
        let taken = study.rows.taken[row];
        if study.space.is_void(taken) {
            found.push(Dead { row, covered_by: covering(study, row, Set::ALL) });
        }
    }
    found
}

/// The earlier rows that hold where a row does, within a set, the one that is taken most first.
fn covering(study: &mut Study<'_>, row: usize, within: Set) -> Vec<usize> {
    let guard = study.space.sets.and(study.rows.guards[row], within);
    let mut found = Vec::new();
    let earlier: Vec<usize> = study.rows.nearby.of(row).take_while(|other| *other < row).collect();
    for earlier in earlier {
        let taken = study.rows.taken[earlier];
        if study.space.sets.meets(guard, taken) {
            let both = study.space.sets.and(guard, taken);
            found.push((earlier, study.space.count(both)));
        }
    }
    found.retain(|(_, count)| *count > 0);
    found.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    found.into_iter().map(|(earlier, _)| earlier).collect()
}

pub(in crate::analyse) use regions::IN_FUNCTIONS;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::UNCOVERED, codes::DEAD_CASE, codes::NOT_REACHED], run: Run::Sets(findings) };

/// The note on unclaimed states, and a warning for each case that is never taken.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let dead = dead(study);
    // Without an order no case comes first, and one that says what another says may stand.
    let ordered = program.hit_policy == HitPolicy::First;
    // An image that another one makes superfluous was written by nobody.
    let is_dead = |row: usize| dead.binary_search_by_key(&row, |dead| dead.row).is_ok();
    let whole = |row: usize| {
        let case = &program.rows[row];
        let images = (0..program.rows.len()).filter(|other| program.rows[*other].id == case.id);
        case.under.is_empty() && images.into_iter().all(is_dead)
    };
    let warned = dead.iter().filter(|dead| whole(dead.row) && (ordered || dead.covered_by.is_empty()));
    let mut found: Vec<Diagnostic> = warned.map(|dead| never_taken(program, dead)).collect();
    for row in 0..program.rows.len() {
        let counts = study.counts(row);
        let reached = study.space.can_meet(counts, study.assumed);
        if !reached && !is_dead(row) && program.rows[row].under.is_empty() {
            found.push(not_reached(study, row));
        }
    }
    let (unclaimed, _) = gaps(study);
    if !unclaimed.is_empty() {
        found.push(uncovered(study, unclaimed));
    }
    found.extend(regions::finding(&mut study.space, study.rows.unclaimed, study.assumed));
    found
}

fn never_taken(program: &Program, dead: &Dead) -> Diagnostic {
    let case = &program.rows[dead.row];
    let guards = dead.covered_by.iter().chain([&dead.row]).map(|row| program.rows[*row].guard);
    let mut rounding = Rounding::new(&program.pool);
    if guards.clone().any(|guard| rounding.decides(guard)) {
        let inputs = guards.fold(InputSet::default(), |all, guard| all.or(program.pool.cond_facts(guard).inputs));
        return by_rounding(program, dead, inputs);
    }
    let warning = Diagnostic::warning(codes::DEAD_CASE, format!("case {} is never taken", case.id));
    if dead.covered_by.is_empty() {
        return warning
            .at(case.guard_span, "this does not hold in any state")
            .help("remove the case, or mend its guard");
    }
    let warning = warning.at(case.guard_span, "wherever this can hold, an earlier case is taken");
    let warning = dead.covered_by.iter().take(3).fold(warning, |warning, first| {
        let first = &program.rows[*first];
        warning.at(first.guard_span, format!("case {} comes first", first.id))
    });
    let all: Vec<Option<usize>> = dead.covered_by.iter().copied().map(Some).collect();
    let warning = match all.len() > 3 {
        true => warning.help(format!("{} cover it", words::cases(program, &all))),
        false => warning,
    };
    warning.help("move the case up, narrow the earlier guards, or remove it")
}

/// The warning about a case that is never taken over the real numbers, where `f32` rounds on the way to its guard.
fn by_rounding(program: &Program, dead: &Dead, inputs: InputSet) -> Diagnostic {
    let case = &program.rows[dead.row];
    let place = match dead.covered_by.is_empty() {
        true => "over the real numbers this holds nowhere",
        false => "over the real numbers an earlier case is taken wherever this holds",
    };
    let distance = "numbers that are equal on paper differ in f32: compare with a distance, as in `abs(a - b) < 0.001`";
    match rounding::point_in_f32(program, inputs, |outcome| outcome.row == Some(dead.row)) {
        Some(point) => {
            Diagnostic::warning(codes::DEAD_CASE, format!("case {} is taken only where f32 rounds", case.id))
                .at(case.guard_span, place)
                .help(format!("in f32 it is taken at {point}"))
                .help(distance)
        }
        None => Diagnostic::warning(codes::DEAD_CASE, format!("case {} is never taken but by rounding", case.id))
            .at(case.guard_span, place)
            .help(distance),
    }
}

fn not_reached(study: &mut Study<'_>, row: usize) -> Diagnostic {
    let program = study.program;
    let case = &program.rows[row];
    let message = format!("case {} is never taken where the assumptions hold", case.id);
    let warning = Diagnostic::warning(codes::NOT_REACHED, message);
    let guard = study.rows.guards[row];
    if study.space.can_meet(guard, study.assumed) {
        let first = covering(study, row, study.assumed);
        let warning = warning.at(case.guard_span, "wherever this can hold, an earlier case is taken");
        let warning = first.iter().take(3).fold(warning, |warning, first| {
            let first = &program.rows[*first];
            warning.at(first.guard_span, format!("case {} comes first", first.id))
        });
        return warning.help("move the case up, narrow the earlier guards, or remove it");
    }
    let blamed: Vec<String> = study.blame(guard).into_iter().map(|name| format!("`{name}`")).collect();
    let warning = warning.at(case.guard_span, format!("{} rules this out", words::list(&blamed)));
    let spans = program.assumptions.iter().filter(|a| blamed.contains(&format!("`{}`", a.name))).take(2);
    let warning = spans.fold(warning, |warning, a| warning.at(a.span, format!("`{}`: {}", a.name, a.doc)));
    warning.help(nearest(study, row)).help("widen the guard, mend the assumption, or remove the case")
}

/// Names the parts of a guard without which it would hold somewhere.
fn nearest(study: &mut Study<'_>, row: usize) -> String {
    let guard = study.rows.guards[row];
    let pattern = study.space.sets.patterns(guard, 1).into_iter().next().unwrap_or_default();
    let mut too_much = Vec::new();
    for place in 0..pattern.len() {
        let rest: Vec<_> = pattern.iter().copied().enumerate().filter(|(p, _)| *p != place).map(|(_, t)| t).collect();
        let wider = study.space.sets.pattern(&rest);
        if study.space.can_meet(wider, study.assumed) {
            too_much.push(format!("`{}`", words::condition(&mut study.space, &[pattern[place]])));
        }
    }
    match too_much.len() {
        0 => "no single condition of the guard is at fault".to_owned(),
        1 => format!("without {} the guard could hold", too_much[0]),
        _ => format!("without one of {} the guard could hold", words::list(&too_much)),
    }
}

fn uncovered(study: &mut Study<'_>, unclaimed: Set) -> Diagnostic {
    let program = study.program;
    let count = study.space.count(unclaimed);
    let claim = regions::claim(&mut study.space, unclaimed);
    let admitted = study.space.sets.and(unclaimed, study.assumed);
    let admitted = study.space.count(admitted);
    let all = program.states.count();
    let message = format!("no case claims {count} of the {all} states; they get the default");
    let note = Diagnostic::note(codes::UNCOVERED, message).at(program.hit_policy_span, "");
    let note = match &claim {
        _ if count == all => note.help("these are all states"),
        Some(claim) => note.help(format!("these are the states with {}", claim.join(", or "))),
        None => {
            let some = words::conditions(&mut study.space, unclaimed, regions::MOST);
            note.help(format!("these are the states with {}, and further ones", some.join(", or ")))
        }
    };
    let note = note.about([words::states(count)]);
    let note = match program.assumptions.is_empty() {
        true => note,
        false => note.help(format!("the assumptions admit {admitted} of them")).about([format!("{admitted} admitted")]),
    };
    note.help(regions::row(program, claim.as_deref()))
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn cases(cases: &str) -> Vec<String> {
        found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Int(from: 0, to: 2), "x": Range(from: 0, to: 1), "f": Bool(fetched: (cost: 1))}},
                output: Number(),
                cases: [{cases}],
                default: "if s == 1 && f {{ x }} else {{ 0 }}")"#
        ))
    }

    #[test]
    fn unclaimed_states_are_noted() {
        let found = cases(r#"Case(id: 1, when: "s == 1", value: 1), Case(id: 2, when: "s == 2", value: 2)"#);
        assert_eq!(found, ["U0503 no case claims 1 of the 3 states; they get the default"]);
        let found = cases(r#"Case(id: 1, when: "s == 1", value: 1), Case(id: 2, when: "s == 2 && x < 0.5", value: 2)"#);
        assert_eq!(
            found,
            [
                "U0503 no case claims 1 of the 3 states; they get the default",
                "U0503 no case claims `s == 2 && x >= 0.5`; the default decides there"
            ]
        );
    }

    #[test]
    fn dead_cases_are_found() {
        let found = cases(
            r#"Case(id: 1, when: "s == 1", value: 1), Case(id: 2, when: "s != 1", value: 2),
               Case(id: 3, when: "s != 0 && f", value: 3), Case(id: 4, when: "s == 0 && s == 1", value: 4),
               Case(id: 5, when: "s == 2 && x > 2", value: 5)"#,
        );
        let dead: Vec<&String> = found.iter().filter(|message| message.starts_with("U0504")).collect();
        let expected = ["U0504 case 3 is never taken", "U0504 case 4 is never taken", "U0504 case 5 is never taken"];
        assert_eq!(dead, expected.iter().collect::<Vec<_>>());
    }

    /// Guards that depend on more than the state may leave something to later cases.
    #[test]
    fn open_guards_kill_nothing() {
        let found = cases(
            r#"Case(id: 1, when: "x < 0.5", value: 1), Case(id: 2, when: "f", value: 2), Case(id: 3, when: "s == 0 || s != 0", value: 3)"#,
        );
        assert!(!found.iter().any(|message| message.starts_with("U0504")), "{found:?}");
    }
}
