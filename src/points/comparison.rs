//! The points at which executors are compared.
//!
//! Every discrete state, with every answer of the fetches it leads to, times
//! points of the continuous inputs: a grid with both ends of every range,
//! random points, and for every comparison in the table points exactly on the
//! line where it switches, with their neighbours in `f32`.

use std::collections::BTreeSet;

use super::random::Random;
use super::{Point, Samples};
use crate::eval::{Interpreter, NeedsFetch};
use crate::program::{BinaryOp, Cond, CondId, Domain, ExprId, InputId, Node, Program, Value};

/// The number of points per state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effort {
    /// Most points of the grid.
    pub grid: usize,
    /// Random points.
    pub random: usize,
    /// Points from which switching lines are looked for.
    pub lines: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { grid: 625, random: 32, lines: 4 }
    }
}

/// Makes points.
pub struct Points<'p> {
    program: &'p Program,
    effort: Effort,
    interpreter: Interpreter<'p, f32>,
    continuous: Vec<(InputId, f64, f64)>,
    /// Two expressions that are compared somewhere.
    comparisons: Vec<(ExprId, ExprId)>,
    /// True if only points count at which the assumptions hold.
    assumed: bool,
    random: Random,
}

/// Most changes that are made to a point so that the assumptions hold.
const MAX_CHANGES: usize = 16;
/// Most values of fetched inputs that are tried for the same reason.
const MAX_FILLINGS: usize = 16;

impl<'p> Points<'p> {
    /// Points at which the assumptions of a program hold.
    pub fn assuming(program: &'p Program, effort: Effort) -> Self {
        Self { assumed: true, ..Self::new(program, effort) }
    }

    /// Points for a program; the same ones every time.
    pub fn new(program: &'p Program, effort: Effort) -> Self {
        let continuous = program.input_ids().filter(|(_, input)| input.fetched.is_none());
        let continuous = continuous.filter_map(|(id, input)| match input.domain {
            Domain::Continuous { .. } | Domain::Word => input.domain.range().map(|(lo, hi)| (id, lo, hi)),
            Domain::Discrete(_) => None,
        });
        let mut comparisons = Comparisons::default();
        for row in &program.rows {
            comparisons.in_cond(program, row.guard);
            for line in &row.lines {
                comparisons.in_cond(program, line.condition);
                line.values.iter().for_each(|value| comparisons.in_expr(program, *value));
            }
        }
        program.default.iter().for_each(|value| comparisons.in_expr(program, *value));
        Self {
            program,
            effort,
            interpreter: Interpreter::new(program),
            continuous: continuous.collect(),
            comparisons: comparisons.found,
            assumed: false,
            random: Random::new(0x9e37_79b9_7f4a_7c15),
        }
    }

    /// The points of one state.
    pub fn of_state(&mut self, state: usize) -> Vec<Point> {
        let mut levels = vec![0; self.program.inputs.len()];
        self.program.states.write(state, &mut levels);
        let mut base: Point = vec![None; self.program.inputs.len()];
        for (input, _) in self.program.states.digits() {
            base[input.index()] = Some(Value::Level(levels[input.index()]));
        }
        let mut bases = self.grid(&base);
        for _ in 0..self.effort.random {
            let point = self.random_point(&base);
            bases.push(point);
        }
        for _ in 0..self.effort.lines {
            let from = self.random_point(&base);
            self.lines(&from, &mut bases);
        }
        if self.program.function.is_some() && state == 0 {
            // Most of the box may be outside of the conditions that the function states.
            bases.extend(Samples::new(self.program).take(self.effort.grid.max(16) / 2));
        }
        let mut points = Vec::with_capacity(bases.len());
        for base in bases {
            if !self.assumed {
                self.fetch_paths(base, &mut points);
            } else if let Some(base) = self.mended(base) {
                self.fetch_paths(base, &mut points);
            }
        }
        points
    }

    fn grid(&mut self, base: &Point) -> Vec<Point> {
        let count = self.continuous.len();
        // Powers of two as steps keep the grid exact, and exactly on many lines.
        let fits = |steps: &usize| (*steps + 1).checked_pow(count as u32).is_some_and(|n| n <= self.effort.grid);
        let Some(steps) = [8, 4, 2, 1].into_iter().find(fits) else { return self.corners(base) };
        let mut points = vec![base.clone()];
        for (input, lo, hi) in &self.continuous {
            let mut next = Vec::with_capacity(points.len() * (steps + 1));
            for point in points {
                for step in 0..=steps {
                    let value = lo + (hi - lo) * step as f64 / steps as f64;
                    let mut point = point.clone();
                    point[input.index()] = Some(self.given(*input, value));
                    next.push(point);
                }
            }
            points = next;
        }
        points
    }

    /// If a grid would be too large, some corners of the ranges: the lowest, the highest, and random ones.
    fn corners(&mut self, base: &Point) -> Vec<Point> {
        let mut points = vec![base.clone(); self.effort.grid.max(2)];
        for (number, point) in points.iter_mut().enumerate() {
            for (input, lo, hi) in self.continuous.clone() {
                let high = if number < 2 { number == 1 } else { self.random.below(2) == 1 };
                point[input.index()] = Some(self.given(input, if high { hi } else { lo }));
            }
        }
        points
    }

    fn random_point(&mut self, base: &Point) -> Point {
        let mut point = base.clone();
        for (input, lo, hi) in self.continuous.clone() {
            let value = lo + (hi - lo) * self.random.unit();
            point[input.index()] = Some(self.given(input, value));
        }
        point
    }

    /// A value of an input as every executor is given it.
    fn given(&self, input: InputId, value: f64) -> Value {
        given(&self.program.inputs[input.index()].domain, value)
    }

    /// A value of an input, and its neighbours.
    fn beside(&self, input: InputId, value: f64) -> [f64; 3] {
        match self.program.inputs[input.index()].domain {
            Domain::Word => [value.floor(), value.floor() + 1.0, value.floor() - 1.0],
            Domain::Continuous { .. } | Domain::Discrete(_) => {
                let value = value as f32;
                [value, value.next_up(), value.next_down()].map(f64::from)
            }
        }
    }

    /// Points on the lines where comparisons switch, found along each axis from a point.
    fn lines(&mut self, from: &Point, found: &mut Vec<Point>) {
        for (a, b) in self.comparisons.clone() {
            let inputs = self.program.pool.expr_facts(a).inputs.or(self.program.pool.expr_facts(b).inputs);
            for (input, lo, hi) in self.continuous.clone() {
                if !inputs.contains(input) {
                    continue;
                }
                let mut point = from.clone();
                let mut difference = |me: &mut Self, value: f64| {
                    point[input.index()] = Some(me.given(input, value));
                    me.difference(&point, a, b)
                };
                let (at_lo, at_hi) = (difference(self, lo), difference(self, hi));
                let root = lo + (hi - lo) * at_lo / (at_lo - at_hi);
                // Comparisons of affine expressions are hit exactly, others nearly.
                if !root.is_finite() || !(lo..=hi).contains(&root) {
                    continue;
                }
                for value in self.beside(input, root) {
                    if (lo..=hi).contains(&value) {
                        let mut point = from.clone();
                        point[input.index()] = Some(Value::Number(value));
                        found.push(point);
                    }
                }
            }
        }
    }

    fn difference(&mut self, point: &Point, a: ExprId, b: ExprId) -> f64 {
        let point = self.filled(point);
        let mut wide = Interpreter::<f64>::new(self.program);
        match (wide.place(&point), wide.number(a), wide.number(b)) {
            (Ok(()), Ok(a), Ok(b)) => a - b,
            _ => f64::NAN,
        }
    }

    /// Every sequence of levels that fetches can return on the way from a point.
    fn fetch_paths(&mut self, point: Point, points: &mut Vec<Point>) {
        let mut open = vec![point];
        while let Some(point) = open.pop() {
            match self.interpreter.evaluate(&point) {
                Ok(_) => {
                    // What is not needed is there all the same: whoever looks at it is found out.
                    points.extend(self.completed(&point));
                }
                Err(NeedsFetch(input)) => {
                    let values: Vec<Value> = match &self.program.inputs[input.index()].domain {
                        Domain::Discrete(levels) => (0..levels.count() as u8).map(Value::Level).collect(),
                        domain @ (Domain::Continuous { .. } | Domain::Word) => {
                            let (lo, hi) = domain.span();
                            let between = lo + (hi - lo) * self.random.unit();
                            [lo, hi, between].map(|value| given(domain, value)).to_vec()
                        }
                    };
                    for value in values.into_iter().rev() {
                        let mut next = point.clone();
                        next[input.index()] = Some(value);
                        open.push(next);
                    }
                }
            }
        }
    }

    /// The point, with values for the fetched inputs that it leaves open; `None` if no assumption allows any.
    fn completed(&mut self, point: &Point) -> Option<Point> {
        if !self.assumed {
            return Some(self.filled(point));
        }
        for _ in 0..MAX_FILLINGS {
            let filled = self.filled(point);
            if self.broken(&filled).is_none() {
                return Some(filled);
            }
        }
        None
    }

    /// An assumption that does not hold at a point.
    fn broken(&mut self, point: &Point) -> Option<CondId> {
        let program = self.program;
        self.interpreter.place(point).ok()?;
        let mut holds = |condition| self.interpreter.holds(condition).unwrap_or(true);
        program.assumptions.iter().map(|assumption| assumption.condition).find(|condition| !holds(*condition))
    }

    /// A point near by at which the assumptions on continuous inputs hold, if one is found.
    fn mended(&mut self, mut point: Point) -> Option<Point> {
        for _ in 0..MAX_CHANGES {
            let filled = self.completed(&point).unwrap_or_else(|| self.filled(&point));
            let Some(condition) = self.broken(&filled) else { return Some(point) };
            let mut comparisons = Comparisons::default();
            comparisons.in_cond(self.program, condition);
            let mut better = None;
            for (a, b) in comparisons.found {
                let inputs = self.program.pool.expr_facts(a).inputs.or(self.program.pool.expr_facts(b).inputs);
                for (input, lo, hi) in self.continuous.clone() {
                    if better.is_some() || !inputs.contains(input) {
                        continue;
                    }
                    let mut tried = filled.clone();
                    let mut difference = |me: &mut Self, value: f64| {
                        tried[input.index()] = Some(me.given(input, value));
                        me.difference(&tried, a, b)
                    };
                    let (at_lo, at_hi) = (difference(self, lo), difference(self, hi));
                    let root = lo + (hi - lo) * at_lo / (at_lo - at_hi);
                    let between = [lo + (hi - lo) * self.random.unit(), lo + (hi - lo) * self.random.unit()];
                    for value in between.into_iter().chain([root, lo, hi]).filter(|v| (lo..=hi).contains(v)) {
                        let mut tried = filled.clone();
                        tried[input.index()] = Some(self.given(input, value));
                        if better.is_none() && self.holds(&tried, condition) {
                            better = Some((input, value));
                        }
                    }
                }
            }
            // None is better if the assumption is on fetched inputs, which are seen to later.
            let Some((input, value)) = better else { return Some(point) };
            point[input.index()] = Some(self.given(input, value));
        }
        None
    }

    fn holds(&mut self, point: &Point, condition: CondId) -> bool {
        self.interpreter.place(point).is_ok() && self.interpreter.holds(condition).unwrap_or(true)
    }

    /// The point, with random values for the fetched inputs that it leaves open.
    fn filled(&mut self, point: &Point) -> Point {
        let mut point = point.clone();
        for (id, input) in self.program.input_ids() {
            if point[id.index()].is_none() {
                point[id.index()] = Some(match &input.domain {
                    Domain::Discrete(levels) => Value::Level(self.random.below(levels.count()) as u8),
                    domain @ (Domain::Continuous { .. } | Domain::Word) => {
                        let (lo, hi) = domain.span();
                        given(domain, lo + (hi - lo) * self.random.unit())
                    }
                });
            }
        }
        point
    }
}

/// A number as every executor gets it.
fn given(domain: &Domain, value: f64) -> Value {
    Value::Number(domain.given(value))
}

/// Collects the comparisons of a program; `step(a, b)` is one, too.
#[derive(Default)]
struct Comparisons {
    found: Vec<(ExprId, ExprId)>,
    seen_exprs: BTreeSet<ExprId>,
    seen_conds: BTreeSet<CondId>,
}

impl Comparisons {
    fn in_cond(&mut self, program: &Program, cond: CondId) {
        if !self.seen_conds.insert(cond) {
            return;
        }
        let cond = program.pool.cond(cond);
        if let Cond::Compare(_, a, b) = cond {
            self.add(program, *a, *b);
        }
        cond.children().for_each(|part| self.in_cond(program, part));
    }

    fn in_expr(&mut self, program: &Program, expr: ExprId) {
        if !self.seen_exprs.insert(expr) {
            return;
        }
        let node = program.pool.node(expr);
        if let Node::Binary(BinaryOp::Step, a, b) = node {
            return self.add(program, a, b);
        }
        if let Some(condition) = node.condition() {
            self.in_cond(program, condition);
        }
        node.children().for_each(|part| self.in_expr(program, part));
    }

    fn add(&mut self, program: &Program, a: ExprId, b: ExprId) {
        self.found.push((a, b));
        [a, b].into_iter().for_each(|e| self.in_expr(program, e));
    }
}
