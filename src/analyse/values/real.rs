//! Intervals of real numbers, and what they say of an expression over a box.
//!
//! Unlike the intervals of [`crate::eval`], which contain what a shader may
//! make of an operation, these contain its exact results only, so that a square
//! root at 0 is 0. Where an operation has no result, or one that no `f32` can
//! hold, that is [`Trouble`].

use std::collections::BinaryHeap;
use std::f64::consts::PI;

use crate::program::operators::Image;
use crate::program::{BinaryOp, Domain, ExprId, InputSet, Node, Pool, Program, TernaryOp, UnaryOp};

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
            Domain::Continuous { lo, hi, .. } => (*lo, *hi),
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

type Interval = (f64, f64);

/// Everything: what is left once an operation failed.
const ANY: Interval = (f64::NEG_INFINITY, f64::INFINITY);

/// Returns whether a value has operations that not all numbers can undergo.
pub(in crate::analyse) fn is_partial(pool: &Pool, expr: ExprId) -> bool {
    let any = |parts: &[ExprId]| parts.iter().any(|part| is_partial(pool, *part));
    match pool.node(expr) {
        Node::Const(_) | Node::Input(_) | Node::Result => false,
        Node::Unary(op, a) => !op.row().is_plain || any(&[a]),
        Node::Binary(BinaryOp::Divide, a, b) if pool.constant(b).is_some() => any(&[a, b]),
        Node::Binary(BinaryOp::Multiply, a, b) if pool.constant(a).is_none() && pool.constant(b).is_none() => true,
        Node::Binary(op, a, b) => !op.row().is_plain || any(&[a, b]),
        Node::Ternary(op, a, b, c) => op == TernaryOp::Smoothstep && pool.constant(a).is_none() || any(&[a, b, c]),
        Node::Select(_, a, b) => any(&[a, b]),
    }
}

/// An operation of a value without selections that may fail in a box.
pub(in crate::analyse) fn trouble(pool: &Pool, expr: ExprId, part: &Boxed) -> Option<Trouble> {
    let mut trouble = None;
    evaluate(pool, expr, part, &mut trouble);
    trouble
}

/// Bounds of a value without selections over the whole domain, to a precision if that can be had.
pub(in crate::analyse) fn range(program: &Program, pool: &Pool, expr: ExprId, precision: f64) -> Interval {
    let upper = extreme(program, pool, expr, precision, 1.0);
    let lower = extreme(program, pool, expr, precision, -1.0);
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

/// The largest value times `sign`, by branch and bound.
fn extreme(program: &Program, pool: &Pool, expr: ExprId, precision: f64, sign: f64) -> f64 {
    let inputs = pool.expr_facts(expr).inputs;
    let bound = |part: &Boxed| {
        let (lo, hi) = evaluate(pool, expr, part, &mut None);
        if sign > 0.0 { hi } else { -lo }
    };
    let whole = Boxed::domain(program);
    let mut reached = f64::NEG_INFINITY;
    let mut queue = BinaryHeap::from([Promising { bound: bound(&whole), part: whole }]);
    for _ in 0..MAX_BOXES {
        let Some(best) = queue.pop() else { break };
        for point in best.part.corners(inputs) {
            reached = reached.max(bound(&Boxed::at(&point)));
        }
        if best.bound - reached <= precision || !best.bound.is_finite() {
            return if best.bound - reached <= 1e-9 { reached } else { best.bound };
        }
        for part in best.part.halves(inputs) {
            queue.push(Promising { bound: bound(&part), part });
        }
    }
    queue.pop().map_or(reached, |best| best.bound.max(reached))
}

fn evaluate(pool: &Pool, expr: ExprId, part: &Boxed, trouble: &mut Option<Trouble>) -> Interval {
    let mut at = |expr| evaluate(pool, expr, part, trouble);
    let (result, what) = match pool.node(expr) {
        Node::Const(number) => (point(number.get()), None),
        Node::Input(input) => (part.of(input), None),
        Node::Result | Node::Select(..) => (ANY, None),
        Node::Unary(op, a) => unary(op, at(a)),
        Node::Binary(op, a, b) => binary(op, at(a), at(b)),
        Node::Ternary(op, a, b, c) => ternary(op, at(a), at(b), at(c)),
    };
    if let Some(what) = what {
        trouble.get_or_insert(Trouble { expr, what });
        return ANY;
    }
    result
}

fn point(value: f64) -> Interval {
    (value, value)
}

/// An image, unless it is more than an `f32` can hold.
fn finite(lo: f64, hi: f64) -> (Interval, Option<&'static str>) {
    let largest = f64::from(f32::MAX);
    let what = (lo < -largest || hi > largest).then_some("can be larger than any f32");
    ((lo, hi), what)
}

fn unary(op: UnaryOp, (lo, hi): Interval) -> (Interval, Option<&'static str>) {
    // What failed inside has been reported already.
    if lo == f64::NEG_INFINITY || hi == f64::INFINITY {
        return (ANY, None);
    }
    let row = op.row();
    if let Some(operands) = row.operands.filter(|operands| !operands.contain(lo, hi)) {
        return (ANY, Some(operands.outside));
    }
    let of = row.wide;
    match row.image {
        Image::Increasing | Image::Steps => finite(of(lo), of(hi)),
        Image::Decreasing => finite(of(hi), of(lo)),
        Image::Valley => {
            let least = if lo <= 0.0 && hi >= 0.0 { 0.0 } else { lo.abs().min(hi.abs()) };
            finite(of(least), of(lo.abs().max(hi.abs())))
        }
        Image::Wave { peak } => (wave(lo, hi, of, peak), None),
        Image::Poles { pole, what } => {
            let turns = |x: f64| ((x - pole) / PI).floor();
            if turns(lo) == turns(hi) { finite(of(lo), of(hi)) } else { (ANY, Some(what)) }
        }
        Image::Sawtooth if lo.floor() == hi.floor() => ((of(lo), of(hi)), None),
        Image::Sawtooth => ((0.0, 1.0), None),
    }
}

fn wave(lo: f64, hi: f64, f: fn(f64) -> f64, peak: f64) -> Interval {
    let has = |place: f64| ((hi - place) / (2.0 * PI)).floor() >= ((lo - place) / (2.0 * PI)).ceil();
    let (a, b) = (f(lo), f(hi));
    (if has(peak + PI) { -1.0 } else { a.min(b) }, if has(peak) { 1.0 } else { a.max(b) })
}

fn hull(corners: [f64; 4]) -> (Interval, Option<&'static str>) {
    let lo = corners.into_iter().fold(f64::INFINITY, f64::min);
    finite(lo, corners.into_iter().fold(f64::NEG_INFINITY, f64::max))
}

fn binary(op: BinaryOp, a: Interval, b: Interval) -> (Interval, Option<&'static str>) {
    if a == ANY || b == ANY {
        return (ANY, None);
    }
    let has_zero = |(lo, hi): Interval| lo <= 0.0 && hi >= 0.0;
    match op {
        BinaryOp::Add => finite(a.0 + b.0, a.1 + b.1),
        BinaryOp::Subtract => finite(a.0 - b.1, a.1 - b.0),
        BinaryOp::Multiply => hull([a.0 * b.0, a.0 * b.1, a.1 * b.0, a.1 * b.1]),
        BinaryOp::Divide | BinaryOp::Remainder if has_zero(b) => (ANY, Some("can be a division by zero")),
        BinaryOp::Divide => hull([a.0 / b.0, a.0 / b.1, a.1 / b.0, a.1 / b.1]),
        BinaryOp::Remainder => {
            let most = a.0.abs().max(a.1.abs()).min(b.0.abs().max(b.1.abs()));
            ((if a.0 < 0.0 { -most } else { 0.0 }, if a.1 > 0.0 { most } else { 0.0 }), None)
        }
        BinaryOp::Min => ((a.0.min(b.0), a.1.min(b.1)), None),
        BinaryOp::Max => ((a.0.max(b.0), a.1.max(b.1)), None),
        BinaryOp::Step => match (a.1 <= b.0, a.0 > b.1) {
            (true, _) => (point(1.0), None),
            (_, true) => (point(0.0), None),
            _ => ((0.0, 1.0), None),
        },
        BinaryOp::Atan2 if has_zero(a) && has_zero(b) => (ANY, Some("can be the angle of the origin")),
        BinaryOp::Atan2 if b.0 <= 0.0 && has_zero(a) => ((-PI, PI), None),
        BinaryOp::Atan2 => {
            hull([libm::atan2(a.0, b.0), libm::atan2(a.0, b.1), libm::atan2(a.1, b.0), libm::atan2(a.1, b.1)])
        }
        BinaryOp::Pow if a.0 < 0.0 => (ANY, Some("can be a power of a negative number")),
        BinaryOp::Pow if a.0 == 0.0 && b.0 <= 0.0 => (ANY, Some("can be zero to a power that is not positive")),
        BinaryOp::Pow => hull([libm::pow(a.0, b.0), libm::pow(a.0, b.1), libm::pow(a.1, b.0), libm::pow(a.1, b.1)]),
    }
}

fn ternary(op: TernaryOp, a: Interval, b: Interval, c: Interval) -> (Interval, Option<&'static str>) {
    if a == ANY || b == ANY || c == ANY {
        return match op {
            TernaryOp::Clamp if b != ANY && c != ANY => ((b.0.min(c.0), c.1), None),
            TernaryOp::Clamp | TernaryOp::Fma | TernaryOp::Mix | TernaryOp::Smoothstep => (ANY, None),
        };
    }
    match op {
        TernaryOp::Clamp => ((a.0.max(b.0).min(c.0), a.1.max(b.1).min(c.1)), None),
        TernaryOp::Fma => {
            let (product, what) = binary(BinaryOp::Multiply, a, b);
            match what {
                Some(what) => (ANY, Some(what)),
                None => binary(BinaryOp::Add, product, c),
            }
        }
        // Between the two for shares from 0 to 1, and linear in each operand anyway.
        TernaryOp::Mix => {
            let mix = |a: f64, b: f64, c: f64| a * (1.0 - c) + b * c;
            let ends = [c.0, c.1];
            let low = ends.map(|c| mix(if c <= 1.0 { a.0 } else { a.1 }, if c >= 0.0 { b.0 } else { b.1 }, c));
            let high = ends.map(|c| mix(if c <= 1.0 { a.1 } else { a.0 }, if c >= 0.0 { b.1 } else { b.0 }, c));
            finite(low[0].min(low[1]), high[0].max(high[1]))
        }
        TernaryOp::Smoothstep if a.1 >= b.0 => (ANY, Some("can have a first bound that is not below the second")),
        TernaryOp::Smoothstep => ((0.0, 1.0), None),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
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
            range(&program, &program.pool, value, 1e-3)
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
            trouble(&program.pool, value, &Boxed::domain(&program)).map(|trouble| trouble.what)
        };
        assert_eq!(what("1 / (x + 1)"), None);
        assert_eq!(what("1 / y"), Some("can be a division by zero"));
        assert_eq!(what("sqrt(x)"), None);
        assert_eq!(what("sqrt(y) + 1"), Some("can be the root of a negative number"));
        assert_eq!(what("exp(100 * x)"), Some("can be larger than any f32"));
    }

    /// An operand: an interval, and points of it.
    fn operand() -> impl Strategy<Value = (Interval, Vec<f64>)> {
        let start =
            prop_oneof![6 => -4.0_f64..4.0, 2 => -100.0_f64..100.0, 1 => Just(0.0), 1 => Just(1.0), 1 => -1e6_f64..1e6];
        let width = prop_oneof![1 => Just(0.0), 3 => 0.0_f64..1.0, 3 => 0.0_f64..10.0, 1 => 0.0_f64..1000.0];
        (start, width, prop::collection::vec(0.0_f64..=1.0, 6)).prop_map(|(lo, width, shares)| {
            let hi = lo + width;
            let points = shares.into_iter().map(|share| (lo + share * width).clamp(lo, hi));
            ((lo, hi), points.chain([lo, hi]).collect())
        })
    }

    /// Fails if a value at a point is outside of an image that is said to be one.
    fn contains(image: (Interval, Option<&str>), value: f64, what: impl Fn() -> String) -> Result<(), TestCaseError> {
        let ((lo, hi), trouble) = image;
        // Of the portable library no function is known to be monotone to the last digit.
        let slack = 1e-12 * value.abs().max(1.0);
        let inside = lo - slack <= value && value <= hi + slack;
        prop_assert!(trouble.is_some() || inside, "{}: {value} is not in {lo} to {hi}", what());
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 1000, failure_persistence: None, ..ProptestConfig::default() })]

        /// The image of an interval contains the value at every point of it, for every operator, or trouble is reported.
        #[test]
        fn images_contain_the_values((x, xs) in operand(), (y, ys) in operand(), (z, zs) in operand()) {
            for op in UnaryOp::ALL.iter().copied() {
                let image = unary(op, x);
                for a in &xs {
                    contains(image, op.apply(*a), || format!("{op:?} of {a} in {x:?}"))?;
                }
            }
            for op in BinaryOp::ALL.iter().copied() {
                let image = binary(op, x, y);
                for (a, b) in xs.iter().flat_map(|a| ys.iter().map(move |b| (*a, *b))) {
                    contains(image, op.apply(a, b), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}"))?;
                }
            }
            for op in TernaryOp::ALL.iter().copied() {
                let image = ternary(op, x, y, z);
                for (a, (b, c)) in xs.iter().flat_map(|a| ys.iter().zip(&zs).map(move |rest| (*a, rest))) {
                    contains(image, op.apply(a, *b, *c), || format!("{op:?} of {a} in {x:?}, {b} in {y:?}, {c} in {z:?}"))?;
                }
            }
        }
    }
}
