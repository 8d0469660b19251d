//! The states in which a table does not have a symmetry, one by one, along
//! every path of each. The findings say the same of sets of states at once.

use std::ops::ControlFlow;

use crate::program::symbolic::{Machine, View};
use crate::program::{Assumption, Program, Symmetry, turn};

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

/// The states in which the result is not what the symmetry says, the mapped result at the image,
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
    let mut found = None;
    machine.any_path(state, |machine| {
        if !assumed.iter().all(|assumption| machine.holds(assumption.condition, View::PLAIN)) {
            return ControlFlow::Continue(());
        }
        let (row, values) = machine.run(View::PLAIN);
        let (image_row, said) = turn::said(machine, symmetry);
        if machine.equal(&values, &said) {
            return ControlFlow::Continue(());
        }
        found = Some(Violation { state, row, image_row, path: machine.describe() });
        ControlFlow::Break(())
    });
    found
}
