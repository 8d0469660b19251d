//! U0506: declared symmetries that the table does not have everywhere.
//!
//! A note, not a warning: published techniques are known to break symmetries
//! that they nearly have, and a table that is true to its source must too.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use super::symbolic::{Machine, View};
use crate::diag::{Diagnostic, codes};
use crate::program::{Assumption, Program, Symmetry};

/// Most states that the findings go through; each costs many paths.
const MAX_STATES: usize = 1 << 16;

/// A state in which a table does not have a symmetry.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// The state.
    pub state: usize,
    /// The row taken there, as an index into [`Program::rows`].
    pub row: Option<usize>,
    /// The row taken in the image, for the same answers.
    pub image_row: Option<usize>,
    /// The path, in table notation.
    pub path: String,
}

/// The states in which the image of the result is not the result of the image,
/// for some fetched and continuous inputs, over the reals.
pub fn violations(program: &Program, symmetry: &Symmetry) -> Vec<Violation> {
    violations_under(program, symmetry, &[])
}

/// The same, where only inputs count for which these assumptions hold.
pub fn violations_under(program: &Program, symmetry: &Symmetry, assumed: &[&Assumption]) -> Vec<Violation> {
    let mut machine = Machine::new(program);
    (0..program.states.count()).filter_map(|state| violation(&mut machine, symmetry, assumed, state)).collect()
}

fn violation(
    machine: &mut Machine<'_>,
    symmetry: &Symmetry,
    assumed: &[&Assumption],
    state: usize,
) -> Option<Violation> {
    let image = View { symmetry: Some(symmetry), result: None };
    let mut found = None;
    machine.any_path(state, |machine| {
        if !assumed.iter().all(|assumption| machine.holds(assumption.condition, View::PLAIN)) {
            return ControlFlow::Continue(());
        }
        let (row, mut values) = machine.run(View::PLAIN);
        if let Some(map) = symmetry.result {
            for value in &mut values {
                *value = machine.resolve(map, View { symmetry: None, result: Some(*value) });
            }
        }
        let (image_row, image_values) = machine.run(image);
        if machine.equal(&values, &image_values) {
            return ControlFlow::Continue(());
        }
        found = Some(Violation { state, row, image_row, path: machine.describe() });
        ControlFlow::Break(())
    });
    found
}

/// The states in which assumptions can hold, for some fetched and continuous inputs.
pub fn admissible(program: &Program, assumed: &[&Assumption]) -> Vec<usize> {
    let mut machine = Machine::new(program);
    let mut can_hold = |state: &usize| {
        machine.any_path(*state, |machine| {
            match assumed.iter().all(|assumption| machine.holds(assumption.condition, View::PLAIN)) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        })
    };
    (0..program.states.count()).filter(|state| can_hold(state)).collect()
}

/// A note for each symmetry that is broken somewhere.
pub(super) fn findings(program: &Program) -> Vec<Diagnostic> {
    program.symmetries.iter().filter_map(|symmetry| finding(program, symmetry)).collect()
}

fn finding(program: &Program, symmetry: &Symmetry) -> Option<Diagnostic> {
    if program.states.count() > MAX_STATES {
        let message = format!("the symmetry `{}` was not looked at", symmetry.name);
        let reason =
            format!("the table has {} states, this analysis takes at most {MAX_STATES}", program.states.count());
        return Some(Diagnostic::note(codes::SYMMETRY_BROKEN, message).at(symmetry.span, "").help(reason));
    }
    let violations = violations(program, symmetry);
    let first = violations.first()?;
    let message = format!(
        "the table lacks the symmetry `{}` in {} of the {} states",
        symmetry.name,
        violations.len(),
        program.states.count()
    );
    // A pair of cases and its image are one pair.
    let mut pairs: BTreeMap<(Option<usize>, Option<usize>), usize> = BTreeMap::new();
    for violation in &violations {
        let (a, b) = (violation.row, violation.image_row);
        *pairs.entry((a.min(b), a.max(b))).or_default() += 1;
    }
    let mut pairs: Vec<_> = pairs.into_iter().collect();
    pairs.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let name = |row: Option<usize>| row.map_or("default".to_owned(), |row| program.rows[row].id.to_string());
    let mut shown: Vec<String> = pairs
        .iter()
        .take(8)
        .map(|((a, b), count)| match a == b {
            true => format!("{} ({count})", name(*a)),
            false => format!("{}/{} ({count})", name(*a), name(*b)),
        })
        .collect();
    if pairs.len() > shown.len() {
        shown.push(format!("and {} more pairs", pairs.len() - shown.len()));
    }
    Some(
        Diagnostic::note(codes::SYMMETRY_BROKEN, message)
            .at(symmetry.span, "")
            .help(format!("cases taken there and in the image: {}", shown.join(", ")))
            .help(format!("for instance {}", first.path)),
    )
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn mirrored(value: &str) -> Vec<String> {
        found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Levels(values: {{"left": 0, "right": 1}}), "x": Range(from: 0, to: 1)}},
                symmetries: {{
                    "mirror": Symmetry(map: {{"s": {{"left": "right", "right": "left"}}, "x": "1 - x"}}),
                    "swap": Symmetry(map: {{"x": "1 - x"}}, result: "1 - value"),
                }},
                output: Number(clamp: (0, 1)),
                cases: [Case(id: 1, when: "s == left || s == right", value: "{value}")],
                default: 0)"#
        ))
    }

    #[test]
    fn broken_symmetries_are_noted() {
        assert_eq!(
            mirrored("if s == left { 2 * x } else { 2 - 2 * x }"),
            ["U0506 the table lacks the symmetry `swap` in 2 of the 2 states"]
        );
        assert_eq!(
            mirrored("if s == left { x } else { x }"),
            ["U0506 the table lacks the symmetry `mirror` in 2 of the 2 states"]
        );
        // Equal only once clamped, and only because x ends at 1.
        assert_eq!(mirrored("if s == left { min(x, 1) } else { max(1 - x, 0) }"), [""; 0]);
        assert_eq!(mirrored("if x < 0.5 { 0.25 } else { if x == 0.5 { 0.5 } else { 0.75 } }").len(), 1);
    }
}
