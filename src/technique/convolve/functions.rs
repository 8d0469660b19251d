//! Functions of the built-in tables, called with names of parameters and asked for names of results.
//!
//! They are what a frame or a slab needs once, so one point at a time in double precision does.

use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Interpreter;
use crate::program::{Domain, Program, Reading, Value};
use crate::technique::tables::BuiltIn;

/// A function of a table, or a table of cases.
#[derive(Debug, Clone, Copy)]
pub(super) struct Function {
    program: &'static Program,
}

/// A value for an input.
#[derive(Debug, Clone, Copy)]
pub(super) enum Given<'a> {
    /// A number.
    Number(f64),
    /// A level or an integer, as it is written.
    Word(&'a str),
}

impl From<f64> for Given<'_> {
    fn from(number: f64) -> Self {
        Given::Number(number)
    }
}

impl<'a> From<&'a str> for Given<'a> {
    fn from(word: &'a str) -> Self {
        Given::Word(word)
    }
}

/// The results at a point, by name; the only result of a function that returns no record is called `value`.
#[derive(Debug, Clone)]
pub(super) struct Answer {
    function: &'static str,
    results: Vec<(&'static str, Reading<'static>)>,
}

impl Function {
    /// A function of a table.
    pub(super) fn of(table: &'static BuiltIn, name: &str) -> Result<Self, Failure> {
        Ok(Self { program: table.function(name)? })
    }

    /// A table of cases.
    pub(super) fn cases(table: &'static BuiltIn) -> Result<Self, Failure> {
        Ok(Self { program: table.program()? })
    }

    /// The results with these inputs; those that are not given have their defaults.
    pub(super) fn call(self, given: &[(&str, Given<'_>)]) -> Result<Answer, Failure> {
        let program = self.program;
        let mut point: Vec<Option<Value>> = program.inputs.iter().map(|input| input.default).collect();
        for (name, value) in given {
            let found = program.inputs.iter().position(|input| input.name == *name);
            let index = found.ok_or_else(|| self.wrong(format!("has no input `{name}`")))?;
            let value = match (value, &program.inputs[index].domain) {
                // Numbers that a scene makes are cut to what the table is for; what it refuses was refused before.
                (Given::Number(number), Domain::Continuous { lo, hi, .. }) if !number.is_nan() => {
                    Value::Number(number.clamp(*lo, *hi))
                }
                (Given::Number(number), _) => self.read(index, &number.to_string())?,
                (Given::Word(word), _) => self.read(index, word)?,
            };
            point[index] = Some(value);
        }
        let missing = |_| self.wrong("needs an input that was not given".to_owned());
        let outcome = Interpreter::<f64>::new(program).evaluate(&point).map_err(missing)?;
        let results = match program.output.read(&outcome.values) {
            Reading::Record(fields) => fields,
            one => vec![("value", one)],
        };
        Ok(Answer { function: &program.name, results })
    }

    fn read(self, index: usize, word: &str) -> Result<Value, Failure> {
        self.program.inputs[index].parse(word).map_err(|message| self.wrong(message))
    }

    fn wrong(self, message: String) -> Failure {
        wrong(&self.program.name, &message)
    }
}

fn wrong(function: &str, message: &str) -> Failure {
    Failure::bare(function, Diagnostic::error(codes::NOT_APPLICABLE, format!("`{function}` {message}")))
}

impl Answer {
    fn result(&self, name: &str) -> Result<&Reading<'static>, Failure> {
        let found = self.results.iter().find(|(known, _)| *known == name).map(|(_, reading)| reading);
        found.ok_or_else(|| wrong(self.function, &format!("returns no `{name}`")))
    }

    /// A result that is a number.
    pub(super) fn number(&self, name: &str) -> Result<f64, Failure> {
        match self.result(name)? {
            Reading::Number(number) => Ok(*number),
            _ => Err(wrong(self.function, &format!("returns no number `{name}`"))),
        }
    }

    /// Several results that are numbers.
    pub(super) fn numbers<const N: usize>(&self, names: [&str; N]) -> Result<[f64; N], Failure> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = self.number(name)?;
        }
        Ok(numbers)
    }

    /// A result that is a condition.
    pub(super) fn holds(&self, name: &str) -> Result<bool, Failure> {
        match self.result(name)? {
            Reading::Bool(holds) => Ok(*holds),
            _ => Err(wrong(self.function, &format!("returns no condition `{name}`"))),
        }
    }

    /// The name of a result that is a level.
    pub(super) fn level(&self, name: &str) -> Result<&'static str, Failure> {
        match self.result(name)? {
            Reading::Level(_, level) => Ok(level),
            _ => Err(wrong(self.function, &format!("returns no level `{name}`"))),
        }
    }
}
