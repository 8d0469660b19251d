//! A bound on the difference in `f32` between expressions that are equal over the reals.
//!
//! The bound holds of every executor that rounds sums and products to the nearest `f32`, also if it
//! takes numbers that are no normal `f32` for zero. What may leave the range of `f32` has no bound.

use std::collections::HashMap;

use crate::program::operators::{BinaryAlgebra, TernaryAlgebra, UnaryAlgebra};
use crate::program::{Domain, ExprId, Node, Pool, Program};

/// Half a unit in the last place of 1: the relative error of one rounding.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// The smallest normal number; what is smaller may become zero.
const SMALLEST: f64 = f32::MIN_POSITIVE as f64;

/// A factor for what bounds lose as they are computed.
const SLACK: f64 = 1.0 + 1e-12;

/// A range of exact values and a bound of the error after rounding.
#[derive(Debug, Clone, Copy)]
struct Bound {
    lo: f64,
    hi: f64,
    error: f64,
}

impl Bound {
    /// The result of an operation that rounds, of operands with an error.
    fn rounded(lo: f64, hi: f64, inherited: f64) -> Option<Self> {
        let magnitude = lo.abs().max(hi.abs()) + inherited;
        // Of an exact zero nothing is lost.
        let lost = if magnitude == 0.0 { 0.0 } else { UNIT * magnitude + SMALLEST };
        Self { lo, hi, error: (inherited + lost) * SLACK }.within_range()
    }

    /// Itself, if every value of it is an `f32`, errors included.
    fn within_range(self) -> Option<Self> {
        let magnitude = self.lo.abs().max(self.hi.abs()) + self.error;
        (magnitude < f64::from(f32::MAX)).then_some(self)
    }

    /// The smaller of two; one that is smaller everywhere, rounded or not, hides the error of the other.
    fn smaller(self, other: Self) -> Self {
        if self.hi + self.error <= other.lo - other.error {
            return self;
        }
        if other.hi + other.error <= self.lo - self.error {
            return other;
        }
        Self { lo: self.lo.min(other.lo), hi: self.hi.min(other.hi), error: self.error.max(other.error) }
    }

    fn negated(self) -> Self {
        Self { lo: -self.hi, hi: -self.lo, ..self }
    }

    fn larger(self, other: Self) -> Self {
        self.negated().smaller(other.negated()).negated()
    }

    /// A constant as an `f32`.
    fn constant(value: f64) -> Option<Self> {
        let lost = (value - f64::from(value as f32)).abs();
        let vanishes = value != 0.0 && value.abs() < SMALLEST;
        Self { lo: value, hi: value, error: if vanishes { value.abs() } else { lost } }.within_range()
    }
}

/// A bound of the difference between an expression's `f32` result and its exact
/// value on the whole domain; `None` where this simple analysis knows none.
/// The expression contains no selections.
pub(super) fn error(program: &Program, pool: &Pool, expr: ExprId) -> Option<f64> {
    bound(program, pool, expr, &mut HashMap::new()).map(|bound| bound.error)
}

/// The same with the range; what is shared is looked at once.
fn bound(program: &Program, pool: &Pool, expr: ExprId, known: &mut HashMap<ExprId, Option<Bound>>) -> Option<Bound> {
    if let Some(known) = known.get(&expr) {
        return *known;
    }
    let found = operation(program, pool, expr, known);
    known.insert(expr, found);
    found
}

fn operation(
    program: &Program,
    pool: &Pool,
    expr: ExprId,
    known: &mut HashMap<ExprId, Option<Bound>>,
) -> Option<Bound> {
    let mut of = |expr| bound(program, pool, expr, known);
    match pool.node(expr) {
        Node::Const(number) => Bound::constant(number.get()),
        Node::Input(input) => match program.inputs[input.index()].domain {
            // The ends themselves are rounded before they come in.
            Domain::Continuous { lo, hi, .. } => {
                Bound { lo: lo.min((lo as f32).into()), hi: hi.max((hi as f32).into()), error: 0.0 }.within_range()
            }
            Domain::Discrete(_) | Domain::Word => None,
        },
        // Words are exact, but no numbers.
        Node::Word(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => None,
        Node::Unary(op, a) => {
            let a = of(a)?;
            match op.row().algebra {
                UnaryAlgebra::Negate => Some(a.negated()),
                UnaryAlgebra::Saturate => Some(a.larger(Bound::constant(0.0)?).smaller(Bound::constant(1.0)?)),
                UnaryAlgebra::Absolute | UnaryAlgebra::Opaque => None,
            }
        }
        Node::Binary(op, a, b) => {
            let (a, b) = (of(a)?, of(b)?);
            let error = a.error + b.error;
            match op.row().algebra {
                BinaryAlgebra::Sum => Bound::rounded(a.lo + b.lo, a.hi + b.hi, error),
                BinaryAlgebra::Difference => Bound::rounded(a.lo - b.hi, a.hi - b.lo, error),
                BinaryAlgebra::Product => {
                    let ends = [a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi];
                    let (lo, hi) = ends.iter().fold((f64::MAX, f64::MIN), |(l, h), e| (l.min(*e), h.max(*e)));
                    let size = |x: Bound| x.lo.abs().max(x.hi.abs());
                    Bound::rounded(lo, hi, size(a) * b.error + size(b) * a.error + a.error * b.error)
                }
                BinaryAlgebra::Minimum => Some(a.smaller(b)),
                BinaryAlgebra::Maximum => Some(a.larger(b)),
                BinaryAlgebra::Quotient | BinaryAlgebra::Opaque => None,
            }
        }
        Node::Ternary(op, x, lo, hi) if op.row().algebra == TernaryAlgebra::Clamp => {
            Some(of(x)?.larger(of(lo)?).smaller(of(hi)?))
        }
        Node::Ternary(..) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    /// The bound of a value of inputs in 0 to 1.
    fn error_of(value: &str) -> Option<f64> {
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}},
                output: Number(), cases: [Case(id: 1, when: true, value: "{value}")], default: 0)"#
        );
        let program = Table::parse(Source::new("t.ron", text)).and_then(|table| Program::check(&table));
        let program = program.unwrap_or_else(|e| panic!("{e}"));
        error(&program, &program.pool, program.rows[0].lines[0].values[0])
    }

    #[test]
    fn what_is_exact_has_no_error() {
        for exact in ["x", "-x", "min(x, 0.5)", "clamp(y, 0.25, max(x, 0.5))", "-2.5", "16777216"] {
            assert_eq!(error_of(exact), Some(0.0), "{exact}");
        }
    }

    #[test]
    fn constants_and_sums_have_one() {
        let constant = error_of("0.1").expect("bounded");
        assert!((constant - 1.490_116_1e-9).abs() < 1e-15, "{constant:e}");
        assert_eq!(error_of("16777217"), Some(1.0));
        let sum = error_of("x + y").expect("bounded");
        assert!(sum > 2.0 * UNIT && sum < 2.01 * UNIT, "{sum:e}");
        // Limits that are never met have no part in it.
        assert_eq!(error_of("clamp(x + y, -1e30, 1e30)"), Some(sum));
        assert_eq!(error_of("clamp(x + y, 0.3, 1e30)"), error_of("max(x + y, 0.3)"));
        // A product of small numbers may vanish.
        assert!(error_of("1e-30 * x * 1e-10").expect("bounded") >= 1e-40);
    }

    #[test]
    fn what_may_leave_the_range_has_no_bound() {
        for without in ["1e30 * x * 1e30", "3e38 * x + 3e38 * y", "1 / x", "sqrt(x)"] {
            assert_eq!(error_of(without), None, "{without}");
        }
    }
}
