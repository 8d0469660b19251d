//! The states in which a table does not have a symmetry, one by one, along
//! every path of each. The findings say the same of sets of states at once.

use std::ops::ControlFlow;

use crate::program::symbolic::{Machine, View};
use crate::program::{Assumption, Program, Symmetry};

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
