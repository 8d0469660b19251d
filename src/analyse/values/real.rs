//! Intervals of real numbers, and what they say of an expression over a box.
//!
//! Unlike the intervals of [`crate::eval`], which contain what a shader may
//! make of an operation, these contain its exact results only, so that a square
//! root at 0 is 0. Where an operation has no result, or one that no `f32` can
//! hold, that is [`Trouble`].

use std::collections::{BinaryHeap, HashMap};

use crate::analyse::sets::budget::Budget;
use crate::program::operators::{ANY, Bounds};
use crate::program::{BinaryOp, Domain, ExprId, InputSet, Node, Pool, Program, TernaryOp};

/// An interval for every input; of discrete ones it means nothing.
#[derive(Debug, Clone)]
pub(in crate::analyse) struct Boxed {
    lo: Vec<f64>,
    hi: Vec<f64>,
}

impl Boxed {
    /// Everything that the inputs can be.
    pub(in crate::analyse) fn domain(program: &Program) -> Self {
        let bounds = |domain: &Domain| match domain {
            Domain::Continuous { .. } | Domain::Word => domain.range().unwrap_or_default(),
            Domain::Discrete(_) => (0.0, 0.0),
        };
        let (lo, hi) = program.inputs.iter().map(|input| bounds(&input.domain)).unzip();
        Self { lo, hi }
    }

    /// A single point.
    pub(in crate::analyse) fn at(point: &[f64]) -> Self {
        Self { lo: point.to_vec(), hi: point.to_vec() }
    }

    /// The interval of an input.
    pub(in crate::analyse) fn of(&self, input: crate::program::InputId) -> (f64, f64) {
        (self.lo[input.index()], self.hi[input.index()])
    }

    /// Takes a smaller interval for an input.
    pub(in crate::analyse) fn cut(&mut self, input: crate::program::InputId, (lo, hi): Bounds) {
        (self.lo[input.index()], self.hi[input.index()]) = (lo, hi);
    }

    /// The point in the middle.
    pub(in crate::analyse) fn middle(&self) -> Vec<f64> {
        self.lo.iter().zip(&self.hi).map(|(lo, hi)| (lo + hi) / 2.0).collect()
    }

    /// The middle and the corners in the directions of some inputs, of which only the first few count.
    pub(in crate::analyse) fn corners(&self, inputs: InputSet) -> Vec<Vec<f64>> {
        let mut points = vec![self.middle()];
        let directions: Vec<_> =
            inputs.iter().filter(|input| self.lo[input.index()] < self.hi[input.index()]).collect();
        let directions = &directions[..directions.len().min(5)];
        for bits in 0..1_usize << directions.len() {
            let mut point = self.middle();
            for (place, input) in directions.iter().enumerate() {
                let end = if bits >> place & 1 == 0 { &self.lo } else { &self.hi };
                point[input.index()] = end[input.index()];
            }
            points.push(point);
        }
        points
    }

    /// The largest extent in the directions of some inputs.
    pub(in crate::analyse) fn width(&self, inputs: InputSet) -> f64 {
        inputs.iter().map(|input| self.hi[input.index()] - self.lo[input.index()]).fold(0.0, f64::max)
    }

    /// The two halves, cut across the longest direction of some inputs.
    pub(in crate::analyse) fn halves(self, inputs: InputSet) -> [Self; 2] {
        let extent = |index: usize| self.hi[index] - self.lo[index];
        let widest = inputs.iter().map(|input| input.index()).max_by(|a, b| extent(*a).total_cmp(&extent(*b)));
        let (mut low, mut high) = (self.clone(), self);
        if let Some(index) = widest {
            let middle = (low.lo[index] + low.hi[index]) / 2.0;
            low.hi[index] = middle;
            high.lo[index] = middle;
        }
        [low, high]
    }
}

/// Why an operation has no finite result.
#[derive(Debug, Clone, Copy)]
pub(in crate::analyse) struct Trouble {
    /// The operation.
    pub(in crate::analyse) expr: ExprId,
    /// Its possible trouble, as the end of a sentence.
    pub(in crate::analyse) what: &'static str,
}

/// Returns whether a value has operations that not all numbers can undergo.
pub(in crate::analyse) fn is_partial(pool: &Pool, expr: ExprId) -> bool {
    let any = |parts: &[ExprId]| parts.iter().any(|part| is_partial(pool, *part));
    match pool.node(expr) {
        Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) => false,
        Node::Unary(op, a) => !op.row().is_plain || any(&[a]),
        Node::Binary(BinaryOp::Divide, a, b) if pool.constant(b).is_some() => any(&[a, b]),
        Node::Binary(BinaryOp::Multiply, a, b) if pool.constant(a).is_none() && pool.constant(b).is_none() => true,
        Node::Binary(op, a, b) => !op.row().is_plain || any(&[a, b]),
        Node::Ternary(op, a, b, c) => op == TernaryOp::Smoothstep && pool.constant(a).is_none() || any(&[a, b, c]),
        Node::Select(_, a, b) => any(&[a, b]),
    }
}

/// A value without selections, laid out to be computed over many boxes: operands first, and what occurs in
/// several places once.
#[derive(Debug, Clone)]
pub(in crate::analyse) struct Laid {
    steps: Vec<Step>,
    inputs: InputSet,
}

/// A step of it, whose operands are earlier steps.
#[derive(Debug, Clone, Copy)]
struct Step {
    expr: ExprId,
    node: Node,
    operands: [usize; 3],
}

impl Laid {
    pub(in crate::analyse) fn new(pool: &Pool, expr: ExprId) -> Self {
        let mut laid = Self { steps: Vec::new(), inputs: pool.expr_facts(expr).inputs };
        laid.lay(pool, expr, &mut HashMap::new());
        laid
    }

    fn lay(&mut self, pool: &Pool, expr: ExprId, places: &mut HashMap<ExprId, usize>) -> usize {
        if let Some(place) = places.get(&expr) {
            return *place;
        }
        let node = pool.node(expr);
        let mut operands = [0; 3];
        // Of a selection nothing is known, whatever its sides are.
        if !matches!(node, Node::Select(..)) {
            for (operand, part) in operands.iter_mut().zip(node.children()) {
                *operand = self.lay(pool, part, places);
            }
        }
        self.steps.push(Step { expr, node, operands });
        places.insert(expr, self.steps.len() - 1);
        self.steps.len() - 1
    }

    /// The operations that it takes to compute it once.
    pub(in crate::analyse) fn work(&self) -> usize {
        self.steps.len()
    }

    /// Bounds over a box, everything where an operation may fail; and the first operation that may.
    pub(in crate::analyse) fn over(&self, part: &Boxed) -> (Bounds, Option<Trouble>) {
        let mut trouble = None;
        let mut values: Vec<Bounds> = Vec::with_capacity(self.steps.len());
        for Step { expr, node, operands } in &self.steps {
            let [a, b, c] = operands.map(|place| values.get(place).copied().unwrap_or(ANY));
            let (bounds, what) = match node {
                Node::Const(number) => ((number.get(), number.get()), None),
                Node::Word(word) => ((f64::from(*word), f64::from(*word)), None),
                Node::Input(input) => (part.of(*input), None),
                Node::Index(_) | Node::Result(_) | Node::Select(..) => (ANY, None),
                Node::Unary(op, _) => op.image(a),
                Node::Binary(op, ..) => op.image(a, b),
                Node::Ternary(op, ..) => op.image(a, b, c),
            };
            if let Some(what) = what {
                trouble.get_or_insert(Trouble { expr: *expr, what });
            }
            values.push(if what.is_some() { ANY } else { bounds });
        }
        (values.last().copied().unwrap_or(ANY), trouble)
    }
}

impl Laid {
    /// Returns whether an operation fails at a point: for the very numbers that it is given there. Bounds over a
    /// point are wider than it where an operation is none of those that are exact.
    pub(in crate::analyse) fn fails_at(&self, point: &[f64]) -> bool {
        let mut values: Vec<f64> = Vec::with_capacity(self.steps.len());
        self.steps.iter().any(|Step { node, operands, .. }| {
            let [a, b, c] = operands.map(|place| values.get(place).copied().unwrap_or(f64::NAN));
            let (value, (_, fails)) = match node {
                Node::Const(number) => (number.get(), (ANY, None)),
                Node::Word(word) => (f64::from(*word), (ANY, None)),
                Node::Input(input) => (point[input.index()], (ANY, None)),
                Node::Index(_) | Node::Result(_) | Node::Select(..) => (f64::NAN, (ANY, None)),
                Node::Unary(op, _) => (op.apply(a), op.image((a, a))),
                Node::Binary(op, ..) => (op.apply(a, b), op.image((a, a), (b, b))),
                Node::Ternary(op, ..) => (op.apply(a, b, c), op.image((a, a), (b, b), (c, c))),
            };
            values.push(value);
            fails.is_some()
        })
    }
}

/// Bounds of a value without selections over the whole domain, to a precision if that can be had.
pub(in crate::analyse) fn range(
    program: &Program,
    pool: &Pool,
    expr: ExprId,
    precision: f64,
    budget: &Budget,
) -> Bounds {
    let laid = Laid::new(pool, expr);
    let upper = extreme(program, &laid, precision, 1.0, budget);
    let lower = extreme(program, &laid, precision, -1.0, budget);
    (-lower, upper)
}

/// A box in a queue, the most promising first.
struct Promising {
    bound: f64,
    part: Boxed,
}

impl PartialEq for Promising {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Promising {}

impl PartialOrd for Promising {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Promising {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound.total_cmp(&other.bound)
    }
}

/// Most boxes that are looked at for one bound.
const MAX_BOXES: usize = 4000;

/// The largest value times `sign`, by branch and bound; too large rather than too small where the work is too much.
fn extreme(program: &Program, laid: &Laid, precision: f64, sign: f64, budget: &Budget) -> f64 {
    let bound = |part: &Boxed| {
        budget.compute(laid.work());
        let ((lo, hi), _) = laid.over(part);
        if sign > 0.0 { hi } else { -lo }
    };
    let whole = Boxed::domain(program);
    let mut reached = f64::NEG_INFINITY;
    let mut queue = BinaryHeap::from([Promising { bound: bound(&whole), part: whole }]);
    for _ in 0..MAX_BOXES {
        if budget.is_spent() {
            break;
        }
        let Some(best) = queue.pop() else { break };
        for point in best.part.corners(laid.inputs) {
            reached = reached.max(bound(&Boxed::at(&point)));
        }
        if best.bound - reached <= precision || !best.bound.is_finite() {
            return if best.bound - reached <= 1e-9 { reached } else { best.bound };
        }
        for part in best.part.halves(laid.inputs) {
            queue.push(Promising { bound: bound(&part), part });
        }
    }
    queue.pop().map_or(reached, |best| best.bound.max(reached))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analyse::sets::budget::STEPS;
    use crate::diag::Source;
    use crate::table::Table;

    fn value(text: &str) -> (Program, ExprId) {
        let table = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: -1, to: 1)}},
                output: Number(), cases: [Case(id: 1, when: "x > 0", value: "{text}")], default: 0)"#
        );
        let table = Table::parse(Source::new("t", table)).unwrap_or_else(|e| panic!("{e}"));
        let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
        let value = program.rows[0].lines[0].values[0];
        (program, value)
    }

    #[test]
    fn ranges_are_tight() {
        let of = |text: &str| {
            let (program, value) = value(text);
            range(&program, &program.pool, value, 1e-3, &Budget::new(STEPS))
        };
        assert_eq!(of("1 + x - y"), (0.0, 3.0));
        assert_eq!(of("min(x, 1 - x)"), (0.0, 0.5));
        assert_eq!(of("sqrt(x) * y"), (-1.0, 1.0));
        let (lo, hi) = of("x * (1 - x)");
        assert!(lo == 0.0 && (0.25..0.2511).contains(&hi), "{hi}");
    }

    #[test]
    fn trouble_is_seen() {
        let what = |text: &str| {
            let (program, value) = value(text);
            let (_, trouble) = Laid::new(&program.pool, value).over(&Boxed::domain(&program));
            trouble.map(|trouble| trouble.what)
        };
        assert_eq!(what("1 / (x + 1)"), None);
        assert_eq!(what("1 / y"), Some("can be a division by zero"));
        assert_eq!(what("sqrt(x)"), None);
        assert_eq!(what("sqrt(y) + 1"), Some("can be the root of a negative number"));
        assert_eq!(what("exp(100 * x)"), Some("can be larger than any f32"));
    }
}
