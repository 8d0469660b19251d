//! The places where `f32` rounds, and points at which it decides what real numbers do not.
//!
//! Analyses speak of real numbers. Codes, truth values, and sums and products of them are
//! the same in `f32`, and so is an input that is compared with a number; what a finding says
//! of other comparisons has to be tried out before it is said of `f32`.

use std::collections::{HashMap, HashSet};

use crate::eval::{Interpreter, Outcome};
use crate::points::random::Random;
use crate::program::operators::{BinaryAlgebra, Image, TernaryAlgebra, UnaryAlgebra};
use crate::program::{
    BinaryOp, Cond, CondId, Domain, ExprId, Input, InputId, InputSet, Node, Number, Pool, Program, UnaryOp, Value,
};

/// Most combinations of levels that are tried for a point.
const MAX_COMBINATIONS: usize = 4096;

/// Constants of a program that are tried as inputs.
const MAX_CONSTANTS: usize = 16;

/// Random numbers that are tried with each combination of levels.
const DRAWS: usize = 5;

/// The advice where something is said of the reals that `f32` may come to all the same.
pub(in crate::analyse) const MAY_HOLD: &str =
    "this is so over the real numbers; where f32 rounds, it may hold: compare with a distance";

/// Multiples of a power of two up to a size: if they are few enough, `f32` has all of them.
#[derive(Debug, Clone, Copy)]
struct Grid {
    unit: f64,
    most: f64,
}

impl Grid {
    /// Whole numbers up to one.
    const TRUTH: Self = Self { unit: 1.0, most: 1.0 };

    fn of(value: f64) -> Option<Self> {
        if f64::from(value as f32) != value || !value.is_finite() {
            return None;
        }
        let mut unit = 1.0;
        while value != 0.0 && (value / unit).fract() != 0.0 {
            unit /= 2.0;
        }
        while value != 0.0 && (value / (2.0 * unit)).fract() == 0.0 {
            unit *= 2.0;
        }
        Self { unit, most: value.abs() }.checked()
    }

    fn checked(self) -> Option<Self> {
        let few = self.most / self.unit <= f64::from(1_u32 << 24);
        (few && self.unit >= f64::from(f32::MIN_POSITIVE) && self.most <= f64::from(f32::MAX)).then_some(self)
    }

    fn join(self, other: Self) -> Self {
        Self { unit: self.unit.min(other.unit), most: self.most.max(other.most) }
    }

    fn plus(self, other: Self) -> Option<Self> {
        Self { unit: self.unit.min(other.unit), most: self.most + other.most }.checked()
    }

    fn times(self, other: Self) -> Option<Self> {
        Self { unit: self.unit * other.unit, most: self.most * other.most }.checked()
    }

    /// Whole numbers that lie beside these.
    fn whole(self) -> Option<Self> {
        Self { unit: self.unit.max(1.0), most: self.most.ceil().max(1.0) }.checked()
    }
}

/// The expressions of a pool, and where `f32` rounds them.
pub(in crate::analyse) struct Rounding<'p> {
    pool: &'p Pool,
    grids: HashMap<ExprId, Option<Grid>>,
    faithful: HashMap<ExprId, bool>,
    conditions: HashMap<CondId, bool>,
}

impl<'p> Rounding<'p> {
    pub(in crate::analyse) fn new(pool: &'p Pool) -> Self {
        Self { pool, grids: HashMap::new(), faithful: HashMap::new(), conditions: HashMap::new() }
    }

    /// Returns whether an expression has few values, all of which `f32` computes exactly.
    pub(in crate::analyse) fn is_exact(&mut self, expr: ExprId) -> bool {
        self.is_exact_word(expr) || self.grid(expr).is_some()
    }

    /// Returns whether an expression is a word that depends on no rounded number.
    fn is_exact_word(&mut self, expr: ExprId) -> bool {
        self.pool.is_word(expr) && self.is_faithful(expr)
    }

    /// Returns whether a condition compares numbers that `f32` may have rounded.
    pub(in crate::analyse) fn decides(&mut self, condition: CondId) -> bool {
        if let Some(known) = self.conditions.get(&condition) {
            return *known;
        }
        let cond = self.pool.cond(condition);
        let rounded = match cond {
            Cond::Compare(_, a, b) => !(self.is_faithful(*a) && self.is_faithful(*b)),
            Cond::Const(_) | Cond::Level(..) | Cond::Not(_) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {
                cond.children().any(|part| self.decides(part))
            }
        };
        self.conditions.insert(condition, rounded);
        rounded
    }

    /// Returns whether a value is computed without rounding.
    fn is_faithful(&mut self, expr: ExprId) -> bool {
        if let Some(known) = self.faithful.get(&expr) {
            return *known;
        }
        let node = self.pool.node(expr);
        let passes = match node {
            Node::Const(number) => f64::from(number.get() as f32) == number.get(),
            Node::Word(_) | Node::Input(_) | Node::Index(_) => true,
            Node::Result(_) => false,
            Node::Unary(op, _) if op.row().gives_word => true,
            Node::Unary(op, _) => op.is_exact(),
            Node::Binary(op, ..) if op.row().is_on_words => true,
            Node::Binary(op, ..) => op.is_exact(),
            Node::Ternary(op, ..) => op.is_exact(),
            Node::Select(condition, ..) => !self.decides(condition),
        };
        let faithful = (passes && node.children().all(|part| self.is_faithful(part))) || self.grid(expr).is_some();
        self.faithful.insert(expr, faithful);
        faithful
    }

    fn grid(&mut self, expr: ExprId) -> Option<Grid> {
        if let Some(known) = self.grids.get(&expr) {
            return *known;
        }
        let grid = self.grid_anew(expr);
        self.grids.insert(expr, grid);
        grid
    }

    fn grid_anew(&mut self, expr: ExprId) -> Option<Grid> {
        match self.pool.node(expr) {
            Node::Const(number) => Grid::of(number.get()),
            Node::Index(_) => Some(Grid { unit: 1.0, most: crate::program::MAX_LEVELS as f64 }),
            Node::Word(_) | Node::Input(_) | Node::Result(_) => None,
            // Of a word that is small, the number.
            Node::Unary(UnaryOp::NumberOfWord, a) if self.is_exact_word(a) => {
                Grid { unit: 1.0, most: self.pool.expr_facts(a).range.1 }.checked()
            }
            Node::Unary(op, a) => {
                let a = self.grid(a)?;
                match op.row().algebra {
                    UnaryAlgebra::Negate | UnaryAlgebra::Absolute => Some(a),
                    UnaryAlgebra::Saturate => Some(a.join(Grid::TRUTH)),
                    UnaryAlgebra::Opaque if op.row().image == Image::Steps => a.whole(),
                    UnaryAlgebra::Opaque => None,
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.grid(a)?, self.grid(b)?);
                match op.row().algebra {
                    BinaryAlgebra::Sum | BinaryAlgebra::Difference => a.plus(b),
                    BinaryAlgebra::Product => a.times(b),
                    BinaryAlgebra::Minimum | BinaryAlgebra::Maximum => Some(a.join(b)),
                    BinaryAlgebra::Opaque if op == BinaryOp::Step => Some(Grid::TRUTH),
                    // Whole, and no larger than what is divided.
                    BinaryAlgebra::Opaque if matches!(op, BinaryOp::WholeQuotient | BinaryOp::WholeRemainder) => {
                        Grid { unit: 1.0, most: a.most }.checked()
                    }
                    BinaryAlgebra::Quotient | BinaryAlgebra::Opaque => None,
                }
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.grid(a)?, self.grid(b)?, self.grid(c)?);
                match op.row().algebra {
                    TernaryAlgebra::Clamp => Some(a.join(b).join(c)),
                    TernaryAlgebra::ProductAndSum => a.times(b)?.plus(c),
                    TernaryAlgebra::Mix | TernaryAlgebra::Opaque => None,
                }
            }
            Node::Select(_, a, b) => Some(self.grid(a)?.join(self.grid(b)?)),
        }
    }
}

/// An input, in the form that `explain --at` takes, at which `f32` comes to something that is said not to happen over
/// the reals; nothing if none was found. Inputs that are not `relevant` keep their defaults.
pub(in crate::analyse) fn point_in_f32(
    program: &Program,
    relevant: InputSet,
    happens: impl Fn(&Outcome<f32>) -> bool,
) -> Option<String> {
    let discrete: Vec<(InputId, usize)> =
        relevant.iter().filter_map(|input| Some((input, program.levels(input)?.count()))).collect();
    let combinations = discrete.iter().try_fold(1_usize, |all, (_, count)| all.checked_mul(*count));
    let combinations = combinations.map_or(MAX_COMBINATIONS, |all| all.min(MAX_COMBINATIONS));
    let numbers = numbers(program, relevant);
    let mut interpreter = Interpreter::<f32>::new(program);
    for combination in 0..combinations {
        for numbers in &numbers {
            let mut point = numbers.clone();
            let mut rest = combination;
            for (input, count) in &discrete {
                point[input.index()] = Some(Value::Level((rest % count) as u8));
                rest /= count;
            }
            if interpreter.evaluate(&point).is_ok_and(|outcome| happens(&outcome)) {
                return Some(shown(program, relevant, &point));
            }
        }
    }
    None
}

/// Combinations of numbers to try: ends, middles, constants of the program, and some at random.
fn numbers(program: &Program, relevant: InputSet) -> Vec<Vec<Option<Value>>> {
    let usual = |(id, input): (InputId, &Input)| match input.domain {
        Domain::Discrete(_) => Some(input.default.unwrap_or(Value::Level(0))),
        Domain::Continuous { .. } | Domain::Word => {
            let (lo, hi) = input.domain.span();
            let middle = input.domain.given(lo + (hi - lo) / 2.0).clamp(lo, hi);
            Some(input.default.filter(|_| !relevant.contains(id)).unwrap_or(Value::Number(middle)))
        }
    };
    let usual: Vec<Option<Value>> = program.input_ids().map(usual).collect();
    let ranges: Vec<(InputId, f64, f64)> = program
        .input_ids()
        .filter_map(|(id, input)| match input.domain {
            Domain::Continuous { .. } | Domain::Word if relevant.contains(id) => {
                input.domain.range().map(|(lo, hi)| (id, lo, hi))
            }
            Domain::Continuous { .. } | Domain::Word | Domain::Discrete(_) => None,
        })
        .collect();
    let mut all = vec![usual.clone()];
    if ranges.is_empty() {
        return all;
    }
    let mut random = Random::new(0);
    let with = |number: &mut dyn FnMut(f64, f64) -> f64| {
        let mut point = usual.clone();
        for (id, lo, hi) in &ranges {
            let domain = &program.inputs[id.index()].domain;
            point[id.index()] = Some(Value::Number(domain.given(number(*lo, *hi)).clamp(*lo, *hi)));
        }
        point
    };
    all.push(with(&mut |lo, _| lo));
    all.push(with(&mut |_, hi| hi));
    let mut seen = HashSet::new();
    let constants = program.pool.nodes().filter_map(|node| match node {
        Node::Const(number) => Some(number),
        Node::Word(word) => Some(Number::new(f64::from(word))),
        Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Select(..) => None,
    });
    for number in constants.filter(|number| seen.insert(*number)).take(MAX_CONSTANTS) {
        all.push(with(&mut |_, _| number.get()));
    }
    for _ in 0..DRAWS {
        all.push(with(&mut |lo, hi| lo + random.unit() * (hi - lo)));
    }
    all
}

fn shown(program: &Program, relevant: InputSet, point: &[Option<Value>]) -> String {
    let value = |(id, input): (InputId, &Input)| {
        let value = point[id.index()]?;
        let needed = relevant.contains(id) || (input.default.is_none() && input.fetched.is_none());
        (needed && input.default != Some(value)).then(|| format!("{}={}", input.name, input.show(value)))
    };
    let parts: Vec<String> = program.input_ids().filter_map(value).collect();
    if parts.is_empty() { "the defaults of all inputs".to_owned() } else { parts.join(",") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    /// Returns whether `f32` may decide a guard otherwise than the reals.
    fn decides(guard: &str) -> bool {
        let table = format!(
            r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"n": Int(from: 0, to: 7), "a": Bool(), "b": Bool(),
                "e": Levels(values: {{"low": 0.25, "high": 0.75}}), "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}},
                output: Number(), cases: [Case(id: 1, when: "{guard}", value: 1)], default: 0)"#
        );
        let table = Table::parse(Source::new("t", table)).unwrap_or_else(|e| panic!("{e}"));
        let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
        Rounding::new(&program.pool).decides(program.rows[0].guard)
    }

    #[test]
    fn sums_of_codes_are_exact_and_tenths_are_not() {
        for guard in [
            "f32(a) + f32(b) + f32(n) == 2",
            "f32(e) * f32(e) + 1 < f32(n)",
            "x < 0.5",
            "min(x, 0.25) <= max(y, 1 - f32(e))",
            "floor(x) == f32(n)",
            "(if a { x } else { y }) > -0.5",
            "step(f32(n), 3) == 1",
        ] {
            assert!(!decides(guard), "{guard}");
        }
        for guard in [
            "f32(n) * 0.1 == 0.3",
            "x + y < 1",
            "x < 0.1",
            "x * x > 0.25",
            "f32(n) + 16777216 > 16777217",
            "sqrt(x) < y",
        ] {
            assert!(decides(guard), "{guard}");
        }
    }
}
