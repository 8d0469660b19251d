//! Plans carried out, one step after the other, in `f32`: what a proof says of a plan, tried at points.
//!
//! Of a plan this knows its steps and what they mean, nothing of how they were chosen or proved.

use std::collections::BTreeMap;

use super::{Plan, Step};
use crate::eval::{Interpreter, NeedsFetch};
use crate::program::{Domain, ExprId, InputId, InputSet, LevelTerm, Program, Value};

/// The end of a way through a plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Walked {
    /// The row that the plan reports, as an index into the program's rows; `None` for the default.
    pub row: Option<usize>,
    /// The line of that row; `None` where the default gave the value.
    pub line: Option<usize>,
    /// The components of the result.
    pub values: Vec<f32>,
    /// The inputs that were fetched.
    pub fetched: InputSet,
    /// An input that was fetched more than once.
    pub repeated: Option<InputId>,
}

/// Carries out a plan at single points.
#[derive(Debug)]
pub struct Walker<'a, 'p> {
    plan: &'a Plan<'p>,
    /// The program with the terms of the plan, and those that its coefficients stand for.
    program: Program,
    /// The components that each set of coefficients gives.
    sums: Vec<Vec<ExprId>>,
}

impl<'a, 'p> Walker<'a, 'p> {
    /// A walker of a plan.
    pub fn new(plan: &'a Plan<'p>) -> Self {
        let mut program = plan.program.clone();
        program.pool = plan.pool.clone();
        let pool = &mut program.pool;
        let values = |fit: &super::Fit| fit.pieces.iter().map(|piece| plan.coefficients.value(pool, piece)).collect();
        let sums = plan.coefficients.fits.iter().map(values).collect();
        Self { plan, program, sums }
    }

    /// The result at a point that gives every input.
    ///
    /// # Errors
    /// With an input that the point does not give.
    pub fn run(&self, point: &[Option<Value>]) -> Result<Walked, NeedsFetch> {
        let plan = self.plan;
        let level = |input: InputId| match point[input.index()] {
            Some(Value::Level(level)) => level,
            Some(Value::Number(_)) | None => 0,
        };
        let entry = plan.lookup.get(plan.program.states.index(level)).map_or(0, |entry| usize::from(*entry));
        let mut point = point.to_vec();
        let mut interpreter = Interpreter::<f32>::new(&self.program);
        interpreter.place(&point)?;
        let mut results = Vec::new();
        let mut walked =
            Walked { row: None, line: None, values: Vec::new(), fetched: InputSet::default(), repeated: None };
        let mut at = plan.root();
        loop {
            match plan.step(at) {
                Step::Switch { arms } => at = arms[entry],
                Step::Coefficients { rest } => match plan.coefficients.fits.get(entry) {
                    Some(fit) => {
                        (walked.row, walked.line) = (fit.row, fit.line);
                        let values = self.sums[entry].iter().map(|value| interpreter.number(*value));
                        walked.values = values.collect::<Result<_, _>>()?;
                        return Ok(walked);
                    }
                    None => at = rest[entry - plan.coefficients.fits.len()],
                },
                Step::Orbit { arms } => {
                    for (_, index) in plan.symmetries.iter().enumerate().filter(|(bit, _)| entry >> bit & 1 == 1) {
                        point = self.turned(*index, &point, &mut interpreter)?;
                        interpreter.place(&point)?;
                        results.splice(0..0, self.program.symmetries[*index].result.as_deref());
                    }
                    at = arms[entry >> plan.symmetries.len()];
                }
                Step::Test { condition, then, other } => {
                    at = if interpreter.holds(*condition)? { *then } else { *other };
                }
                Step::Fetch { input, next } => {
                    walked.fetch(*input);
                    at = *next;
                }
                Step::Gather { input, condition, next } => {
                    if interpreter.holds(*condition)? {
                        walked.fetch(*input);
                    } else {
                        point[input.index()] = Some(match plan.program.inputs[input.index()].domain {
                            Domain::Discrete(_) => Value::Level(0),
                            Domain::Continuous { lo, .. } => Value::Number(lo),
                            Domain::Word => Value::Number(0.0),
                        });
                        interpreter.place(&point)?;
                    }
                    at = *next;
                }
                Step::Leaf(leaf) => {
                    (walked.row, walked.line) = (leaf.row, leaf.line);
                    let values = leaf.values.iter().map(|value| interpreter.number(*value));
                    let values = values.collect::<Result<Vec<_>, _>>()?;
                    walked.values = results.iter().fold(values, |values, map| interpreter.mapped(map, &values));
                    return Ok(walked);
                }
            }
        }
    }

    /// A point, turned by a symmetry of the program.
    fn turned(
        &self,
        symmetry: usize,
        point: &[Option<Value>],
        interpreter: &mut Interpreter<'_, f32>,
    ) -> Result<Vec<Option<Value>>, NeedsFetch> {
        let symmetry = &self.program.symmetries[symmetry];
        let mut changes = BTreeMap::new();
        for (input, image) in &symmetry.levels {
            changes.insert(*input, Value::Level(level(image, point, interpreter)?));
        }
        for (input, image) in &symmetry.numbers {
            changes.insert(*input, Value::Number(f64::from(interpreter.number(*image)?)));
        }
        let mut turned = point.to_vec();
        for (input, value) in changes {
            turned[input.index()] = Some(value);
        }
        Ok(turned)
    }
}

impl Walked {
    fn fetch(&mut self, input: InputId) {
        if self.fetched.contains(input) {
            self.repeated = Some(input);
        }
        self.fetched = self.fetched.or(InputSet::one(input));
    }
}

/// The level that a term stands for at a point.
fn level(term: &LevelTerm, point: &[Option<Value>], interpreter: &mut Interpreter<'_, f32>) -> Result<u8, NeedsFetch> {
    match term {
        LevelTerm::Const(level) => Ok(*level),
        LevelTerm::Input(input) => match point[input.index()] {
            Some(Value::Level(level)) => Ok(level),
            Some(Value::Number(_)) | None => Err(NeedsFetch(*input)),
        },
        LevelTerm::If(condition, then, other) => {
            let chosen = if interpreter.holds(*condition)? { then } else { other };
            level(chosen, point, interpreter)
        }
        LevelTerm::Map(inner, renaming) => Ok(renaming[usize::from(level(inner, point, interpreter)?)]),
    }
}
