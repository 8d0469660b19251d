//! Tables of cases over a few states: evaluated once in each of them, by the interpreter, and then looked up.

use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Interpreter;
use crate::program::{Domain, Program, Value};
use crate::technique::tables::BuiltIn;

/// The results of a table in all of its states.
#[derive(Debug, Clone)]
pub(super) struct Tabulated {
    results: Vec<Vec<u8>>,
    counts: Vec<usize>,
}

impl Tabulated {
    /// Evaluates a table of discrete inputs whose results are levels, conditions or small whole numbers, or lists of
    /// such.
    ///
    /// # Errors
    /// When the table has other inputs than these, in this order.
    pub(super) fn new(table: &'static BuiltIn, inputs: &[&str]) -> Result<Self, Failure> {
        let program = table.program()?;
        let wrong = || {
            let message = format!("`{}` has other inputs than the levels {}", table.name, inputs.join(", "));
            Failure::bare(table.name, Diagnostic::error(codes::NOT_APPLICABLE, message))
        };
        let counts = program.inputs.iter().zip(inputs).map(|(input, name)| match &input.domain {
            Domain::Discrete(levels) if input.name == *name && input.fetched.is_none() => Ok(levels.count()),
            Domain::Discrete(_) | Domain::Continuous { .. } | Domain::Word => Err(wrong()),
        });
        let counts = counts.collect::<Result<Vec<usize>, Failure>>()?;
        if counts.len() != program.inputs.len() || counts.len() != inputs.len() {
            return Err(wrong());
        }
        let results = (0..program.states.count()).map(|state| result(program, state).ok_or_else(wrong));
        Ok(Self { results: results.collect::<Result<_, Failure>>()?, counts })
    }

    /// The result at some levels, by their places, in the order of the inputs: of a list its length, then its items.
    pub(super) fn at(&self, levels: &[usize]) -> &[u8] {
        let state = levels.iter().zip(&self.counts).fold(0, |state, (level, count)| state * count + level);
        &self.results[state]
    }

    /// The items of a result that is a list.
    pub(super) fn list(&self, levels: &[usize]) -> &[u8] {
        match self.at(levels) {
            [count, items @ ..] => &items[..usize::from(*count)],
            [] => &[],
        }
    }
}

/// The lists of a result that is at most `most` of them: their number, then each with its length, filled up to the same
/// number of items.
pub(super) fn lists(result: &[u8], most: usize) -> Vec<Vec<usize>> {
    let Some((count, rest)) = result.split_first() else { return Vec::new() };
    let items = |list: &[u8]| list[1..=usize::from(list[0])].iter().map(|item| usize::from(*item)).collect();
    rest.chunks((rest.len() / most).max(1)).take(usize::from(*count)).map(items).collect()
}

/// The numbers that a table of discrete inputs has in each of its states, in the order of the states.
///
/// # Errors
/// When it needs more than that.
pub(super) fn numbers(table: &'static BuiltIn) -> Result<Vec<Vec<f64>>, Failure> {
    let program = table.program()?;
    let wrong = || {
        let message = format!("`{}` has other inputs than levels", table.name);
        Failure::bare(table.name, Diagnostic::error(codes::NOT_APPLICABLE, message))
    };
    let mut interpreter = Interpreter::<f64>::new(program);
    (0..program.states.count()).map(|state| values(&mut interpreter, program, state).ok_or_else(wrong)).collect()
}

fn result(program: &Program, state: usize) -> Option<Vec<u8>> {
    let values = values(&mut Interpreter::new(program), program, state)?;
    Some(values.into_iter().map(|value| value as u8).collect())
}

fn values(interpreter: &mut Interpreter<'_, f64>, program: &Program, state: usize) -> Option<Vec<f64>> {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let point: Vec<Option<Value>> = levels.iter().map(|level| Some(Value::Level(*level))).collect();
    Some(interpreter.evaluate(&point).ok()?.values)
}
