//! One evaluation, with every intermediate value kept.

use crate::diag::Span;
use crate::program::{Cond, CondId, Domain, ExprId, InputId, Node, Program, Real, Value};

/// The terms that an evaluation came across, with their values.
#[derive(Debug)]
pub(super) struct Trace<'p, T> {
    program: &'p Program,
    point: &'p [Value],
    /// Every expression that was evaluated, operands before what they are operands of.
    pub(super) order: Vec<ExprId>,
    /// By expression of the pool.
    values: Vec<Option<T>>,
    /// The result.
    pub(super) result: Vec<T>,
}

impl<'p, T: Real> Trace<'p, T> {
    /// Nothing evaluated yet.
    fn at(program: &'p Program, point: &'p [Value]) -> Self {
        Self { program, point, order: Vec::new(), values: vec![None; program.pool.len()], result: Vec::new() }
    }

    /// Evaluates a program at a point that has a value for every input.
    pub(super) fn run(program: &'p Program, point: &'p [Value]) -> Self {
        let mut trace = Self::at(program, point);
        let row = program.rows.iter().find(|row| trace.holds(row.guard));
        let line = row.and_then(|row| row.lines.iter().find(|line| trace.holds(line.condition)));
        let values = line.map_or(&program.default, |line| &line.values);
        trace.result = values.iter().map(|value| trace.number(*value)).collect();
        trace
    }

    /// The part of the table that comes to an expression first: a guard, the condition of a line, or a line.
    pub(super) fn place(program: &'p Program, point: &'p [Value], expr: ExprId) -> Option<Span> {
        let mut trace = Self::at(program, point);
        for row in &program.rows {
            let taken = trace.holds(row.guard);
            if trace.value(expr).is_some() {
                return Some(row.guard_span);
            }
            if !taken {
                continue;
            }
            for line in &row.lines {
                let applies = trace.holds(line.condition);
                if trace.value(expr).is_some() {
                    return line.condition_span.or(Some(line.span));
                }
                if applies {
                    return Some(line.span);
                }
            }
            return Some(row.span);
        }
        None
    }

    /// The value of one expression at a point, whether or not the program evaluates it there.
    pub(super) fn of(program: &'p Program, point: &'p [Value], expr: ExprId) -> T {
        let mut trace = Self::at(program, point);
        trace.number(expr)
    }

    /// Returns whether a condition holds at a point.
    pub(super) fn condition(program: &'p Program, point: &'p [Value], condition: CondId) -> bool {
        let mut trace = Self::at(program, point);
        trace.holds(condition)
    }

    /// The value of an expression, if it was evaluated.
    pub(super) fn value(&self, expr: ExprId) -> Option<T> {
        self.values[expr.index()]
    }

    fn holds(&mut self, condition: CondId) -> bool {
        let program = self.program;
        match program.pool.cond(condition) {
            Cond::Const(value) => *value,
            Cond::Level(input, levels) => match self.point[input.index()] {
                Value::Level(level) => levels.contains(level),
                Value::Number(_) => false,
            },
            Cond::Compare(op, a, b) => {
                let words = program.pool.is_word(*a);
                let (a, b) = (self.number(*a), self.number(*b));
                op.holds_of(words, a, b)
            }
            Cond::Not(a) => !self.holds(*a),
            Cond::And(parts) => parts.iter().all(|part| self.holds(*part)),
            Cond::Or(parts) => parts.iter().any(|part| self.holds(*part)),
            Cond::If(condition, then, other) => {
                if self.holds(*condition) {
                    self.holds(*then)
                } else {
                    self.holds(*other)
                }
            }
        }
    }

    fn input(&self, input: InputId) -> T {
        match self.point[input.index()] {
            Value::Number(word) if self.program.inputs[input.index()].domain == Domain::Word => {
                T::from_word(word as u32)
            }
            Value::Number(number) => T::from_f64(number),
            Value::Level(level) => T::from_f64(f64::from(level)),
        }
    }

    fn number(&mut self, expr: ExprId) -> T {
        if let Some(known) = self.value(expr) {
            return known;
        }
        let value = match self.program.pool.node(expr) {
            Node::Const(number) => T::from_f64(number.get()),
            Node::Word(word) => T::from_word(word),
            Node::Input(input) | Node::Index(input) => self.input(input),
            // Occurs in the result map of a symmetry only.
            Node::Result(_) => T::from_f64(f64::NAN),
            Node::Unary(op, a) => T::unary(op, self.number(a)),
            Node::Binary(op, a, b) => {
                let (a, b) = (self.number(a), self.number(b));
                T::binary(op, a, b)
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.number(a), self.number(b), self.number(c));
                T::ternary(op, a, b, c)
            }
            Node::Select(condition, then, other) => {
                if self.holds(condition) {
                    self.number(then)
                } else {
                    self.number(other)
                }
            }
        };
        self.values[expr.index()] = Some(value);
        self.order.push(expr);
        value
    }
}
