//! The way through a program, once for all interpreters that follow it step by step.
//!
//! Rules 1 to 3 of a program's meaning say which conditions are tested, in which order and
//! how far. An interpreter adds what it takes a level and a comparison to be.

use crate::program::{Comparison, Cond, CondId, ExprId, InputId, LevelSet, Program};

/// An interpreter that tests conditions one by one.
pub(super) trait Walk<'p> {
    /// The reason why a walk cannot go on.
    type Stop;

    /// The program that is followed.
    fn program(&self) -> &'p Program;

    /// Returns whether a discrete input has one of some levels.
    fn has_level(&mut self, input: InputId, levels: LevelSet) -> Result<bool, Self::Stop>;

    /// Returns the outcome of a comparison, which stands in the program as `condition`.
    fn compare(&mut self, condition: CondId, op: Comparison, a: ExprId, b: ExprId) -> Result<bool, Self::Stop>;

    /// Returns whether a condition holds; tests its parts from left to right, and only as far as needed.
    fn decide(&mut self, condition: CondId) -> Result<bool, Self::Stop> {
        match self.program().pool.cond(condition) {
            Cond::Const(value) => Ok(*value),
            Cond::Level(input, levels) => self.has_level(*input, *levels),
            Cond::Compare(op, a, b) => self.compare(condition, *op, *a, *b),
            Cond::Not(a) => Ok(!self.decide(*a)?),
            Cond::And(parts) => {
                for part in parts {
                    if !self.decide(*part)? {
                        return Ok(false);
                    }
                }
                Ok(true)
            }
            Cond::Or(parts) => {
                for part in parts {
                    if self.decide(*part)? {
                        return Ok(true);
                    }
                }
                Ok(false)
            }
            Cond::If(condition, then, other) => match self.decide(*condition)? {
                true => self.decide(*then),
                false => self.decide(*other),
            },
        }
    }

    /// Finds the row that is taken and the line of it that applies.
    fn taken(&mut self) -> Result<Taken<'p>, Self::Stop> {
        let program = self.program();
        for (index, row) in program.rows.iter().enumerate() {
            if !self.decide(row.guard)? {
                continue;
            }
            for (number, line) in row.lines.iter().enumerate() {
                if self.decide(line.condition)? {
                    return Ok(Taken { row: Some(index), line: Some(number), values: &line.values });
                }
            }
            return Ok(Taken { row: Some(index), line: None, values: &program.default });
        }
        Ok(Taken { row: None, line: None, values: &program.default })
    }
}

/// The part of a program that gives the result.
pub(super) struct Taken<'p> {
    /// The row; `None` if none is taken.
    pub(super) row: Option<usize>,
    /// The line of the row; `None` if none applies.
    pub(super) line: Option<usize>,
    /// The components of the result.
    pub(super) values: &'p [ExprId],
}
