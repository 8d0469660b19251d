//! A program at one point: what it gives there, and where a symmetry leads.
//!
//! Points of findings have short binary fractions, so that for tables that are
//! piecewise linear nothing is rounded here.

use crate::program::{
    Comparison, Cond, CondId, Domain, ExprId, Input, InputId, LevelTerm, Node, Pool, Program, Symmetry, Value,
};

/// Inputs that reach some set.
#[derive(Debug, Clone)]
pub(in crate::analyse) struct Witness {
    /// The levels that matter.
    pub(in crate::analyse) levels: Vec<Option<u8>>,
    /// A number for each continuous input.
    pub(in crate::analyse) numbers: Vec<Option<f64>>,
    /// True if these very inputs reach the set. Otherwise nothing is known of the numbers.
    pub(in crate::analyse) certain: bool,
}

/// A value for every input.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::analyse) struct Point {
    pub(in crate::analyse) levels: Vec<u8>,
    pub(in crate::analyse) numbers: Vec<f64>,
}

/// The result of a program at a point.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::analyse) struct Outcome {
    pub(in crate::analyse) row: Option<usize>,
    pub(in crate::analyse) line: Option<usize>,
    pub(in crate::analyse) values: Vec<f64>,
}

impl Point {
    /// The point of a witness; what does not matter has its default.
    pub(in crate::analyse) fn of(program: &Program, witness: &Witness) -> Self {
        let usual = |input: usize| match program.inputs[input].default {
            Some(Value::Level(level)) => level,
            _ => 0,
        };
        let levels = witness.levels.iter().enumerate().map(|(input, level)| level.unwrap_or_else(|| usual(input)));
        let least = |input: usize| match program.inputs[input].default {
            Some(Value::Number(number)) => number,
            _ => program.inputs[input].least(),
        };
        let numbers = witness.numbers.iter().enumerate().map(|(input, number)| number.unwrap_or_else(|| least(input)));
        Self { levels: levels.collect(), numbers: numbers.collect() }
    }

    /// Returns whether a condition holds here.
    pub(in crate::analyse) fn holds(&self, pool: &Pool, condition: CondId) -> bool {
        match pool.cond(condition) {
            Cond::Const(value) => *value,
            Cond::Level(input, levels) => levels.contains(self.levels[input.index()]),
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.number(pool, *a), self.number(pool, *b));
                match op {
                    Comparison::Less => a < b,
                    Comparison::LessEqual => a <= b,
                    Comparison::Equal => a == b,
                }
            }
            Cond::Not(a) => !self.holds(pool, *a),
            Cond::And(list) => list.iter().all(|part| self.holds(pool, *part)),
            Cond::Or(list) => list.iter().any(|part| self.holds(pool, *part)),
            Cond::If(c, a, b) => self.holds(pool, if self.holds(pool, *c) { *a } else { *b }),
        }
    }

    /// Returns whether the numbers are in their ranges, as those of an image need not be, and all assumptions hold.
    pub(in crate::analyse) fn is_admitted(&self, program: &Program) -> bool {
        let inside = |(input, number): (&Input, &f64)| match input.domain {
            Domain::Continuous { lo, hi, .. } => (lo..=hi).contains(number),
            Domain::Discrete(_) | Domain::Word => true,
        };
        program.inputs.iter().zip(&self.numbers).all(inside)
            && program.assumptions.iter().all(|assumption| self.holds(&program.pool, assumption.condition))
    }

    /// Returns whether another condition is asked on the way to the outcome of this one.
    pub(in crate::analyse) fn asks(&self, pool: &Pool, condition: CondId, other: CondId) -> bool {
        if condition == other {
            return true;
        }
        match pool.cond(condition) {
            Cond::Const(_) | Cond::Level(..) | Cond::Compare(..) => false,
            Cond::Not(a) => self.asks(pool, *a, other),
            Cond::And(list) | Cond::Or(list) => {
                let goes_on = matches!(pool.cond(condition), Cond::And(_));
                let asked = list.iter().position(|part| self.holds(pool, *part) != goes_on);
                let asked = asked.map_or(list.as_slice(), |last| &list[..=last]);
                asked.iter().any(|part| self.asks(pool, *part, other))
            }
            Cond::If(c, a, b) => {
                self.asks(pool, *c, other) || self.asks(pool, if self.holds(pool, *c) { *a } else { *b }, other)
            }
        }
    }

    /// The value of an expression here. The result of a table is not a number here.
    pub(in crate::analyse) fn number(&self, pool: &Pool, expr: ExprId) -> f64 {
        let at = |expr| self.number(pool, expr);
        match pool.node(expr) {
            Node::Const(number) => number.get(),
            Node::Word(word) => f64::from(word),
            Node::Input(input) => self.numbers[input.index()],
            Node::Index(input) => f64::from(self.levels[input.index()]),
            Node::Result(_) => f64::NAN,
            Node::Unary(op, a) => op.apply(at(a)),
            Node::Binary(op, a, b) => op.apply(at(a), at(b)),
            Node::Ternary(op, a, b, c) => op.apply(at(a), at(b), at(c)),
            Node::Select(condition, a, b) => at(if self.holds(pool, condition) { a } else { b }),
        }
    }

    fn level(&self, pool: &Pool, term: &LevelTerm) -> u8 {
        match term {
            LevelTerm::Const(level) => *level,
            LevelTerm::Input(input) => self.levels[input.index()],
            LevelTerm::If(c, a, b) => self.level(pool, if self.holds(pool, *c) { a } else { b }),
            LevelTerm::Map(inner, renaming) => renaming[usize::from(self.level(pool, inner))],
        }
    }

    /// The image under a symmetry.
    pub(in crate::analyse) fn image(&self, pool: &Pool, symmetry: &Symmetry) -> Self {
        let mut image = self.clone();
        for (input, term) in &symmetry.levels {
            image.levels[input.index()] = self.level(pool, term);
        }
        for (input, term) in &symmetry.numbers {
            image.numbers[input.index()] = self.number(pool, *term);
        }
        image
    }

    /// The result of the program here.
    pub(in crate::analyse) fn outcome(&self, program: &Program) -> Outcome {
        let pool = &program.pool;
        let row = program.rows.iter().position(|row| self.holds(pool, row.guard));
        let lines = row.map(|row| &program.rows[row].lines);
        let line = lines.and_then(|lines| lines.iter().position(|line| self.holds(pool, line.condition)));
        let values = lines.zip(line).map_or(&program.default, |(lines, line)| &lines[line].values);
        Outcome { row, line, values: values.iter().map(|value| self.number(pool, *value)).collect() }
    }

    /// The point as a witness that leaves nothing open but what `like` leaves open.
    pub(in crate::analyse) fn witness(&self, program: &Program, read: &[bool]) -> Witness {
        let level = |(input, level): (usize, &u8)| {
            let discrete = program.levels(InputId::new(input)).is_some();
            (discrete && read[input]).then_some(*level)
        };
        let number = |(input, number): (usize, &f64)| program.levels(InputId::new(input)).is_none().then_some(*number);
        Witness {
            levels: self.levels.iter().enumerate().map(level).collect(),
            numbers: self.numbers.iter().enumerate().map(number).collect(),
            certain: true,
        }
    }
}
