//! The states that occur, as far as a table's assumptions say.

use std::ops::ControlFlow;

use super::Program;
use super::claims::decide;
use super::symbolic::{Machine, View};

/// The states in which all assumptions can hold, for some fetched and continuous inputs.
pub fn reachable(program: &Program) -> Vec<usize> {
    let mut levels = vec![0; program.inputs.len()];
    let mut machine = Machine::new(program);
    let mut can_hold = |state: &usize| {
        program.states.write(*state, &mut levels);
        let excluded = |condition| decide(program, &program.pool, condition, &levels) == Some(false);
        if program.assumptions.iter().any(|assumption| excluded(assumption.condition)) {
            return false;
        }
        let found = machine.any_path(*state, |machine| {
            match program.assumptions.iter().all(|assumption| machine.holds(assumption.condition, View::PLAIN)) {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        // What was not followed may hold.
        found || machine.gave_up()
    };
    (0..program.states.count()).filter(|state| can_hold(state)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_states_of_the_published_tables_occur() {
        for (table, count) in [("tables/smsr.ron", 148), ("tables/rsmss.ron", 296)] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(reachable(&program).len(), count, "{table}");
        }
    }
}
