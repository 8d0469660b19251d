//! Points at which a function is meant to be used: its examples, points around
//! them, and points of its domain at large.
//!
//! Ranges are generous, and most of a box may lie outside of the conditions
//! that a function states, so points are drawn until they hold.

use super::Point;
use super::random::Random;
use crate::eval::Interpreter;
use crate::program::{Domain, Input, Program, Value};

/// Most tries for one point.
const TRIES: usize = 50;

/// The part of an unbounded range that points are drawn from.
const USUAL: f64 = 4.0;

/// Draws points; the same ones every time.
pub struct Samples<'p> {
    program: &'p Program,
    interpreter: Interpreter<'p, f64>,
    random: Random,
}

impl<'p> Samples<'p> {
    /// Points of a program.
    pub fn new(program: &'p Program) -> Self {
        Self { program, interpreter: Interpreter::new(program), random: Random::new(0x9e37_79b9_7f4a_7c15) }
    }

    /// The examples and further points, up to `count` of these; fewer if the conditions are hard to meet.
    pub fn take(&mut self, count: usize) -> Vec<Point> {
        let examples: Vec<Point> = self.program.examples.iter().map(|example| self.given(&example.inputs)).collect();
        let mut points: Vec<Point> =
            examples.iter().filter(|point| self.satisfies_assumptions(point)).cloned().collect();
        for number in 0..count {
            for _ in 0..TRIES {
                let point = match examples.get(number / 2 % examples.len().max(1)) {
                    Some(example) if number % 2 == 0 => self.near(example),
                    _ => self.anywhere(),
                };
                let point = self.given(&point);
                if self.satisfies_assumptions(&point) {
                    points.push(point);
                    break;
                }
            }
        }
        points
    }

    /// Returns whether the conditions of the program hold at a point.
    pub fn satisfies_assumptions(&mut self, point: &Point) -> bool {
        let program = self.program;
        self.interpreter.place(point).is_ok()
            && program.assumptions.iter().all(|a| self.interpreter.holds(a.condition) == Ok(true))
    }

    fn near(&mut self, example: &Point) -> Point {
        let inputs = self.program.inputs.iter().zip(example);
        inputs
            .map(|(input, value)| match (&input.domain, value) {
                (Domain::Word, Some(Value::Number(number))) => {
                    // The word itself, one beside it, or one with some other bits.
                    let bit = f64::from(1_u32 << self.random.below(32));
                    Some(Value::Number(input.domain.point(match self.random.below(4) {
                        0 => *number,
                        1 => number + 1.0,
                        2 => number - 1.0,
                        _ => (number + bit) % 4_294_967_296.0,
                    })))
                }
                (Domain::Continuous { lo, hi, .. }, Some(Value::Number(number))) => {
                    // Now and then the very same number: what is special about an example stays so.
                    let step = if self.random.unit() < 0.25 { 0.0 } else { self.random.unit() - 0.5 };
                    Some(Value::Number((number + step * number.abs().max(0.1)).clamp(*lo, *hi)))
                }
                _ => *value,
            })
            .collect()
    }

    fn anywhere(&mut self) -> Point {
        let inputs = self.program.inputs.iter();
        inputs
            .map(|input| {
                Some(match &input.domain {
                    Domain::Discrete(levels) => Value::Level((self.random.unit() * levels.count() as f64) as u8),
                    // Of all sizes.
                    Domain::Word => {
                        let most = f64::from(u32::MAX >> self.random.below(32));
                        Value::Number(input.domain.point(self.random.unit() * (most + 1.0)))
                    }
                    Domain::Continuous { lo, hi, .. } => {
                        let (lo, hi) = (lo.max(-USUAL.max(-hi)), hi.min(USUAL.max(*lo)));
                        Value::Number(lo + (hi - lo) * self.random.unit())
                    }
                })
            })
            .collect()
    }

    /// A point as every executor is given it.
    fn given(&self, point: &[Option<Value>]) -> Point {
        let given = |(input, value): (&Input, &Option<Value>)| match value {
            Some(Value::Number(number)) => Some(Value::Number(input.domain.given(*number))),
            Some(Value::Level(_)) | None => *value,
        };
        self.program.inputs.iter().zip(point).map(given).collect()
    }
}
