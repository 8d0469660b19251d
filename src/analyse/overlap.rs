//! U0502: cases of a table with hit policy `Unique` that contradict each other.
//!
//! Two guards may hold together as long as both cases give the same value. With
//! hit policy `First` overlaps are how a table is written, and no finding;
//! [`overlaps`] still tells which there are.

use std::ops::ControlFlow;

use super::coverage::{Claim, claim};
use super::symbolic::{Machine, View};
use crate::diag::{Diagnostic, codes};
use crate::program::Program;
use crate::table::HitPolicy;

/// Two cases whose guards can hold together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Overlap {
    /// The earlier case, as an index into [`Program::rows`].
    pub first: usize,
    /// The later case.
    pub second: usize,
    /// States in which both guards can hold, and the values are then equal.
    pub states_equal: usize,
    /// States in which both guards can hold with different values.
    pub states_different: usize,
    /// Of both, the states in which the earlier case is the first of all whose
    /// guard can hold: where it is order that decides between these two.
    pub states_first: (usize, usize),
    /// Whether some inputs are sure to give different values. Otherwise this
    /// depends on comparisons that are not linear, and is not decided here.
    pub certain: bool,
    /// One such state (one with different values if there is any), with what
    /// else leads there, in table notation.
    pub example_state: String,
}

/// Every pair of cases whose guards can hold together, in the order of rows.
///
/// Values are compared over the reals, for all fetched and continuous inputs.
pub fn overlaps(program: &Program) -> Vec<Overlap> {
    let rows = program.rows.len();
    let mut machine = Machine::new(program);
    let mut found: Vec<Option<Overlap>> = vec![None; rows * rows];
    for state in 0..program.states.count() {
        let claims: Vec<usize> =
            (0..rows).filter(|row| claim(&mut machine, state, program.rows[*row].guard) != Claim::Never).collect();
        for (place, first) in claims.iter().enumerate() {
            for second in &claims[place + 1..] {
                let entry = &mut found[first * rows + second];
                pair(&mut machine, state, (*first, *second), place == 0, entry);
            }
        }
    }
    found.into_iter().flatten().collect()
}

/// Adds what one state says of a pair of rows.
fn pair(
    machine: &mut Machine<'_>,
    state: usize,
    (first, second): (usize, usize),
    is_first: bool,
    found: &mut Option<Overlap>,
) {
    let mut example = None;
    let mut certain = false;
    let different = machine.any_path(state, |machine| {
        if !machine.both_hold(first, second) {
            return ControlFlow::Continue(());
        }
        let values = (machine.row_values(first, View::PLAIN), machine.row_values(second, View::PLAIN));
        if machine.equal(&values.0, &values.1) {
            example.get_or_insert_with(|| machine.describe());
            return ControlFlow::Continue(());
        }
        certain = machine.certain();
        example = Some(machine.describe());
        ControlFlow::Break(())
    });
    // What was not followed may differ: then nothing is certain, and `Unique` is not proved.
    let different = different || machine.gave_up();
    if machine.gave_up() {
        example.get_or_insert_with(|| machine.describe());
    }
    let Some(example) = example else { return };
    let found = found.get_or_insert_with(|| Overlap {
        first,
        second,
        states_equal: 0,
        states_different: 0,
        states_first: (0, 0),
        certain: false,
        example_state: example.clone(),
    });
    if !different {
        found.states_equal += 1;
        found.states_first.0 += usize::from(is_first);
        return;
    }
    if found.states_different == 0 || certain && !found.certain {
        found.example_state = example;
    }
    found.states_different += 1;
    found.states_first.1 += usize::from(is_first);
    found.certain |= certain;
}

/// For hit policy `Unique`, every pair with different values.
pub(super) fn findings(program: &Program) -> Vec<Diagnostic> {
    if program.hit_policy != HitPolicy::Unique {
        return Vec::new();
    }
    let overlaps = overlaps(program).into_iter().filter(|overlap| overlap.states_different > 0);
    overlaps.map(|overlap| finding(program, &overlap)).collect()
}

fn finding(program: &Program, overlap: &Overlap) -> Diagnostic {
    let (first, second) = (&program.rows[overlap.first], &program.rows[overlap.second]);
    let what = if overlap.certain { "both hold" } else { "may both hold" };
    let message = format!("cases {} and {} {what}, with different values", first.id, second.id);
    let diagnostic = match overlap.certain {
        true => Diagnostic::error(codes::NOT_UNIQUE, message),
        // What is not linear cannot be decided here, and no table is refused for that.
        false => Diagnostic::warning(codes::NOT_UNIQUE, message),
    };
    let states = match overlap.states_different {
        1 => "1 state".to_owned(),
        count => format!("{count} states"),
    };
    diagnostic
        .at(second.guard_span, format!("the guard of case {}", second.id))
        .at(first.guard_span, format!("the guard of case {}", first.id))
        .at(program.hit_policy_span, "but at most one case may decide")
        .help(format!("in {states}, such as {}", overlap.example_state))
        .help("make the guards exclude each other, or say `hit_policy: First`")
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn unique(first: &str, second: &str) -> Vec<String> {
        found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: Unique,
                inputs: {{"s": Bool(), "x": Range(from: 0, to: 1), "f": Bool(fetched: (cost: 1))}},
                output: Number(),
                cases: [Case(id: 1, when: {first}), Case(id: 2, when: {second})],
                default: "if s && f {{ x }} else {{ 0 }}")"#
        ))
    }

    #[test]
    fn contradictions_are_errors() {
        let different = ["U0502 cases 1 and 2 both hold, with different values"];
        assert_eq!(unique(r#""s", value: "x""#, r#""x > 0.5 && f", value: "2 * x""#), different);
        assert_eq!(unique(r#""x < 0.75", value: "x""#, r#""x > 0.5", value: 1"#), different);
    }

    #[test]
    fn guards_that_exclude_each_other_and_equal_values_are_not() {
        let uncovered = |found: Vec<String>| found.into_iter().filter(|f| !f.starts_with("U0503")).collect::<Vec<_>>();
        let fine = |first, second| assert_eq!(uncovered(unique(first, second)), [""; 0]);
        fine(r#""x < 0.5", value: 1"#, r#""x >= 0.5", value: 2"#);
        fine(r#""x < 0.5", value: 1"#, r#""2 * x - 1 > 0.25", value: 2"#);
        fine(r#""s", value: "2 * x - x""#, r#""s && f", value: "max(x, 0)""#);
        fine(r#""x <= 0.5 && f", value: "x""#, r#""x >= 0.5", value: "0.5""#);
    }

    #[test]
    fn what_is_not_linear_is_a_warning() {
        let maybe = unique(r#""x * x < 0.25", value: 1"#, r#""x > 0.75", value: 2"#);
        assert_eq!(maybe, ["U0502 cases 1 and 2 may both hold, with different values"]);
    }
}
