//! The states that can occur, as far as a table's assumptions say.
//!
//! The one answer for everything that asks: plans that rely on the assumptions and their proofs,
//! the inputs that plans are measured with, and profiles. A state that has more paths than are
//! followed counts as one that can occur: to leave it out would leave it unproved.

use std::ops::ControlFlow;

use super::claims::decide;
use super::symbolic::{Machine, View};
use super::{Assumption, Program};

/// The states in which all assumptions can hold, for some fetched and continuous inputs.
pub fn reachable(program: &Program) -> Vec<usize> {
    let mut levels = vec![0; program.inputs.len()];
    let mut machine = Machine::new(program);
    let all: Vec<&Assumption> = program.assumptions.iter().collect();
    let mut is_reachable = |state: &usize| {
        program.states.write(*state, &mut levels);
        let excluded =
            |assumption: &&Assumption| decide(program, &program.pool, assumption.condition, &levels) == Some(false);
        !all.iter().any(excluded) && can_occur(&mut machine, *state, &all)
    };
    (0..program.states.count()).filter(|state| is_reachable(state)).collect()
}

/// Returns whether some assumptions can hold together in a state.
pub(crate) fn can_occur(machine: &mut Machine<'_>, state: usize, assumed: &[&Assumption]) -> bool {
    let found = machine.any_path(state, |machine| {
        if assumed.iter().all(|assumption| machine.holds(assumption.condition, View::PLAIN)) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    found || machine.gave_up()
}

/// A table in one state of which, without `b`, the assumption holds on the last of 32,768 paths only:
/// more than are followed.
#[cfg(test)]
pub(crate) fn with_too_many_paths() -> Program {
    let bits = 0..15;
    let inputs: String = bits.clone().map(|i| format!("\"f{i}\": Bool(fetched: (cost: 1)), ")).collect();
    let sum: Vec<String> = bits.map(|i| format!("(if f{i} {{ 1 }} else {{ 0 }})")).collect();
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"b": Bool(), {inputs}}},
            assume: {{"a": "b || {} > 14.5"}},
            output: Number(), cases: [Case(id: 1, when: "b", value: "1"), Case(id: 2, when: "!b", value: "2")], default: 0)"#,
        sum.join(" + ")
    );
    let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text));
    table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::Interpreter;
    use crate::program::{Domain, Value};

    #[test]
    fn few_states_of_the_published_tables_occur() {
        for (table, count) in [("tables/smsr.ron", 148), ("tables/rsmss.ron", 296)] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(reachable(&program).len(), count, "{table}");
        }
    }

    #[test]
    fn a_state_with_more_paths_than_are_followed_can_occur() {
        let program = with_too_many_paths();
        let mut machine = Machine::new(&program);
        let assumed: Vec<&Assumption> = program.assumptions.iter().collect();
        assert_eq!(reachable(&program), [0, 1]);
        assert!(can_occur(&mut machine, 0, &assumed) && machine.gave_up());
        assert!(can_occur(&mut machine, 1, &assumed) && !machine.gave_up());
    }

    /// Every combination of all levels, and numbers on a grid that meets every
    /// side of every comparison: where one of them satisfies the assumptions, the state can occur, and only there.
    #[test]
    fn the_states_are_those_that_enumeration_finds() {
        let text = r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {
                "a": Bool(), "side": Levels(values: {"left": 0, "right": 1, "both": 2}),
                "f": Bool(fetched: (cost: 1)), "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1),
            },
            assume: {"p1": "!a || f", "p2": "side != both || (!f && x < y)", "p3": "side != right || x + y >= 1.75 || a",
                "p4": "side != left || x > y || y > x", "p5": "!a || side != right || x > 1"},
            output: Number(), cases: [Case(id: 1, when: "a", value: "x")], default: 0)"#;
        let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text));
        let program = table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"));
        let mut points: Vec<Vec<Option<Value>>> = vec![Vec::new()];
        for input in &program.inputs {
            let values: Vec<Value> = match &input.domain {
                Domain::Discrete(levels) => (0..levels.count()).map(|level| Value::Level(level as u8)).collect(),
                Domain::Word => unreachable!("there is none"),
                Domain::Continuous { lo, hi, .. } => {
                    (0..=8).map(|i| Value::Number(lo + (hi - lo) * f64::from(i) / 8.0)).collect()
                }
            };
            let with = |point: &Vec<Option<Value>>, value| point.iter().copied().chain([Some(value)]).collect();
            points = points.iter().flat_map(|point| values.iter().map(move |value| with(point, *value))).collect();
        }
        let mut found = std::collections::BTreeSet::new();
        for point in &points {
            let mut interpreter = Interpreter::<f64>::new(&program);
            interpreter.place(point).expect("all inputs are given");
            if program.assumptions.iter().all(|a| interpreter.holds(a.condition).expect("given")) {
                found.insert(program.states.index(|input| match point[input.index()] {
                    Some(Value::Level(level)) => level,
                    _ => 0,
                }));
            }
        }
        assert_eq!(reachable(&program), found.into_iter().collect::<Vec<_>>());
    }
}
