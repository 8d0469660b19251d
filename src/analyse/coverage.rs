//! U0503: states that no case claims; U0504: cases that are never taken.
//!
//! A default is a legitimate part of a table, so unclaimed states are a note.
//! A case that can never be taken is a warning: somebody wrote it for a reason.

use std::ops::ControlFlow;

use super::symbolic::{Machine, View};
use crate::diag::{Diagnostic, codes};
use crate::program::{CondId, InputId, Program, Value};
use crate::table::HitPolicy;

/// How far the cases of a table claim its states.
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

/// What a state says of a guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Claim {
    Never,
    /// It depends on inputs that are continuous or fetched.
    Sometimes,
    Always,
}

/// What a state says of the guard of a row.
pub(super) fn claim(machine: &mut Machine<'_>, state: usize, guard: CondId) -> Claim {
    let (mut yes, mut no) = (false, false);
    machine.any_path(state, |machine| {
        match machine.holds(guard, View::PLAIN) {
            true => yes = true,
            false => no = true,
        }
        if yes && no { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    match (yes, no) {
        // What was not followed may go the other way.
        _ if machine.gave_up() => Claim::Sometimes,
        (true, true) => Claim::Sometimes,
        (true, false) => Claim::Always,
        (false, _) => Claim::Never,
    }
}

/// Which states are claimed by which cases.
pub fn coverage(program: &Program) -> Coverage {
    let rows = program.rows.len();
    let mut machine = Machine::new(program);
    let mut alive = vec![false; rows];
    // For a case that is not alive: in how many states each earlier one is in its way.
    let mut in_the_way = vec![vec![0_usize; rows]; rows];
    let mut result =
        Coverage { states: program.states.count(), unclaimed: Vec::new(), open: Vec::new(), dead: Vec::new() };
    for state in 0..program.states.count() {
        let mut any = false;
        let mut first: Option<usize> = None;
        for (row, case) in program.rows.iter().enumerate() {
            // Whoever is known to be alive matters only as long as nothing claims the state.
            if first.is_some() && alive[row] {
                continue;
            }
            let claim = claim(&mut machine, state, case.guard);
            if claim == Claim::Never {
                continue;
            }
            any = true;
            match first {
                Some(first) => in_the_way[row][first] += 1,
                None => alive[row] = true,
            }
            if claim == Claim::Always {
                first = first.or(Some(row));
            }
        }
        match first {
            Some(_) => {}
            None if any => result.open.push(state),
            None => result.unclaimed.push(state),
        }
    }
    for row in (0..rows).filter(|row| !alive[*row]) {
        let mut covered_by: Vec<usize> = (0..row).filter(|first| in_the_way[row][*first] > 0).collect();
        covered_by.sort_by_key(|first| std::cmp::Reverse(in_the_way[row][*first]));
        result.dead.push(Dead { row, covered_by });
    }
    result
}

/// The note on unclaimed states, and a warning for each dead case.
pub(super) fn findings(program: &Program) -> Vec<Diagnostic> {
    let coverage = coverage(program);
    // Without an order no case comes first, and one that says what another says may stand.
    let ordered = program.hit_policy == HitPolicy::First;
    let dead = coverage.dead.iter().filter(|dead| ordered || dead.covered_by.is_empty());
    let mut found: Vec<Diagnostic> = dead.map(|dead| warning(program, dead)).collect();
    if !coverage.unclaimed.is_empty() {
        let (count, all) = (coverage.unclaimed.len(), coverage.states);
        let message = format!("no case claims {count} of the {all} states; they get the default");
        let note = Diagnostic::note(codes::UNCOVERED, message).at(program.hit_policy_span, "");
        found.push(note.help(common(program, &coverage.unclaimed)));
    }
    found
}

fn warning(program: &Program, dead: &Dead) -> Diagnostic {
    let case = &program.rows[dead.row];
    let warning = Diagnostic::warning(codes::DEAD_CASE, format!("case {} is never taken", case.id));
    if dead.covered_by.is_empty() {
        return warning
            .at(case.guard_span, "this does not hold in any state")
            .help("remove the case, or mend its guard");
    }
    let warning = warning.at(case.guard_span, "wherever this can hold, an earlier case is taken");
    let shown = dead.covered_by.iter().take(3).map(|first| &program.rows[*first]);
    shown
        .fold(warning, |warning, first| warning.at(first.guard_span, format!("case {} comes first", first.id)))
        .help("move the case up, narrow the earlier guards, or remove it")
}

/// What states have in common, in words.
pub(super) fn common(program: &Program, states: &[usize]) -> String {
    let mut levels = vec![0; program.inputs.len()];
    let mut seen = vec![0_u64; program.inputs.len()];
    for state in states {
        program.states.write(*state, &mut levels);
        for (input, _) in program.states.digits() {
            seen[input.index()] |= 1 << levels[input.index()];
        }
    }
    let mut parts = Vec::new();
    let mut product = 1;
    for (input, count) in program.states.digits() {
        let declared = &program.inputs[input.index()];
        let names: Vec<String> = (0..*count as u8)
            .filter(|level| seen[input.index()] >> level & 1 == 1)
            .map(|level| declared.show(Value::Level(level)))
            .collect();
        product *= names.len();
        match names.as_slice() {
            all if all.len() == *count => {}
            [one] => parts.push(format!("{} = {one}", declared.name)),
            some => parts.push(format!("{} in {{{}}}", declared.name, some.join(", "))),
        }
    }
    match (parts.is_empty(), product == states.len()) {
        (true, true) => "these are all states".to_owned(),
        (true, false) => format!("the first is {}", state_in_words(program, states[0])),
        (false, true) => format!("these are the states with {}", parts.join(", ")),
        (false, false) => {
            format!("all of them have {}; the first is {}", parts.join(", "), state_in_words(program, states[0]))
        }
    }
}

/// A state in table notation.
pub(super) fn state_in_words(program: &Program, state: usize) -> String {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let show = |(input, _): &(InputId, usize)| {
        let declared = &program.inputs[input.index()];
        format!("{} = {}", declared.name, declared.show(Value::Level(levels[input.index()])))
    };
    program.states.digits().iter().map(show).collect::<Vec<_>>().join(", ")
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
        let found = cases(r#"Case(id: 1, when: "s == 1", value: 1), Case(id: 2, when: "s == 2 && x < 0.5", value: 2)"#);
        assert_eq!(found, ["U0503 no case claims 1 of the 3 states; they get the default"]);
    }

    #[test]
    fn dead_cases_are_found() {
        let found = cases(
            r#"Case(id: 1, when: "s == 1", value: 1), Case(id: 2, when: "s != 1", value: 2),
               Case(id: 3, when: "s != 0 && f", value: 3), Case(id: 4, when: "s == 0 && s == 1", value: 4),
               Case(id: 5, when: "s == 2 && x > 2", value: 5)"#,
        );
        let dead = ["U0504 case 3 is never taken", "U0504 case 4 is never taken", "U0504 case 5 is never taken"];
        assert_eq!(found, dead);
    }

    /// Guards that depend on more than the state may leave something to later cases.
    #[test]
    fn open_guards_kill_nothing() {
        assert_eq!(
            cases(
                r#"Case(id: 1, when: "x < 0.5", value: 1), Case(id: 2, when: "f", value: 2), Case(id: 3, when: "s == 0 || s != 0", value: 3)"#
            ),
            [""; 0]
        );
    }
}
