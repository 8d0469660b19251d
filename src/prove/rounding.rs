//! A bound on the difference in `f32` between expressions that are equal over the reals.

use std::collections::HashMap;

use crate::program::operators::{BinaryAlgebra, TernaryAlgebra, UnaryAlgebra};
use crate::program::{Domain, ExprId, Node, Pool, Program};

/// Half a unit in the last place of 1: the relative error of one rounding.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// A range of exact values and a bound of the error after rounding.
#[derive(Debug, Clone, Copy)]
struct Bound {
    lo: f64,
    hi: f64,
    error: f64,
}

impl Bound {
    fn rounded(lo: f64, hi: f64, inherited: f64) -> Option<Self> {
        let magnitude = lo.abs().max(hi.abs()) + inherited;
        let error = inherited + UNIT * magnitude;
        (lo.is_finite() && hi.is_finite()).then_some(Self { lo, hi, error })
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
        Node::Const(number) => {
            let value = number.get();
            Some(Bound { lo: value, hi: value, error: (value - f64::from(value as f32)).abs() })
        }
        Node::Input(input) => match program.inputs[input.index()].domain {
            Domain::Continuous { lo, hi, .. } => Some(Bound { lo, hi, error: 0.0 }),
            Domain::Discrete(_) => None,
        },
        Node::Result | Node::Select(..) => None,
        Node::Unary(op, a) => {
            let a = of(a)?;
            match op.row().algebra {
                UnaryAlgebra::Negate => Some(Bound { lo: -a.hi, hi: -a.lo, error: a.error }),
                UnaryAlgebra::Saturate => {
                    Some(Bound { lo: a.lo.clamp(0.0, 1.0), hi: a.hi.clamp(0.0, 1.0), error: a.error })
                }
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
                BinaryAlgebra::Minimum => {
                    Some(Bound { lo: a.lo.min(b.lo), hi: a.hi.min(b.hi), error: a.error.max(b.error) })
                }
                BinaryAlgebra::Maximum => {
                    Some(Bound { lo: a.lo.max(b.lo), hi: a.hi.max(b.hi), error: a.error.max(b.error) })
                }
                BinaryAlgebra::Quotient | BinaryAlgebra::Opaque => None,
            }
        }
        Node::Ternary(op, x, lo, hi) if op.row().algebra == TernaryAlgebra::Clamp => {
            let (x, lo, hi) = (of(x)?, of(lo)?, of(hi)?);
            let error = x.error.max(lo.error).max(hi.error);
            Some(Bound { lo: x.lo.max(lo.lo).min(hi.lo), hi: x.hi.max(lo.hi).min(hi.hi), error })
        }
        Node::Ternary(..) => None,
    }
}
