//! The places of the domain where an expression can be zero.
//!
//! A product is zero where a factor is. An affine form is solved for one of its
//! inputs. Anything else is searched: along every input for a change of sign,
//! which is then halved. The search can miss a zero, so what comes out is a
//! list of candidates and no proof that there are no others.

use super::TRACED;
use super::trace::Trace;
use crate::analyse::sets::budget::Budget;
use crate::analyse::values::real::Laid;
use crate::program::normal::{Normaliser, Term};
use crate::program::{BinaryOp, Domain, ExprId, InputId, Node, Program, UnaryOp, Value};

/// Positions along one input at which the sign is looked at.
const POSITIONS: usize = 48;

/// A set of points at which an expression is zero.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Zero {
    /// Every point.
    Everywhere,
    /// One input has this value.
    Fixed(InputId, f64),
    /// The sum of multiples of inputs and a constant is zero.
    Plane { factor: ExprId, terms: Vec<(InputId, f64)>, constant: f64 },
    /// Some points, to be searched for.
    Somewhere(ExprId),
}

/// The zeros of an expression, each set once.
pub(super) fn zeros(program: &Program, normaliser: &mut Normaliser, expr: ExprId) -> Vec<Zero> {
    let mut all = Vec::new();
    collect(program, normaliser, expr, &mut all);
    all
}

fn collect(program: &Program, normaliser: &mut Normaliser, expr: ExprId, all: &mut Vec<Zero>) {
    let mut add = |zero: Zero| {
        if !all.contains(&zero) {
            all.push(zero);
        }
    };
    match program.pool.node(expr) {
        Node::Const(number) => {
            if number.get() == 0.0 {
                add(Zero::Everywhere);
            }
        }
        Node::Unary(UnaryOp::Negate | UnaryOp::Abs | UnaryOp::Sqrt, a) | Node::Binary(BinaryOp::Divide, a, _) => {
            collect(program, normaliser, a, all);
        }
        Node::Binary(BinaryOp::Multiply, a, b) => {
            collect(program, normaliser, a, all);
            collect(program, normaliser, b, all);
        }
        Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Select(..) => match affine(program, normaliser, expr) {
            Some((terms, constant)) => match terms.as_slice() {
                [] if constant == 0.0 => add(Zero::Everywhere),
                [] => {}
                [(input, factor)] => add(Zero::Fixed(*input, 0.0 - constant / factor)),
                _ => add(Zero::Plane { factor: expr, terms, constant }),
            },
            None => add(Zero::Somewhere(expr)),
        },
    }
}

/// The expression as a sum of multiples of inputs and a constant, if it is one.
fn affine(program: &Program, normaliser: &mut Normaliser, expr: ExprId) -> Option<(Vec<(InputId, f64)>, f64)> {
    let affine = normaliser.affine(&program.pool, expr)?;
    let terms = affine.terms.iter().map(|(term, factor)| match term {
        Term::Input(input) => Some((*input, factor.to_f64())),
        Term::Constant(_) | Term::Unary(..) | Term::Binary(..) | Term::Ternary(..) => None,
    });
    Some((terms.collect::<Option<_>>()?, affine.constant.to_f64()))
}

impl Zero {
    /// Points of the set close to `base`, in the domain: those whose rounding to `f32` may still be zeros.
    pub(super) fn near(&self, program: &Program, base: &[Value], budget: &Budget) -> Vec<Vec<Value>> {
        let with = |input: InputId, value: f64| {
            let mut point = base.to_vec();
            point[input.index()] = Value::Number(value);
            point
        };
        let inside = |input: InputId, value: f64| matches!(program.inputs[input.index()].domain, Domain::Continuous { lo, hi, .. } if (lo..=hi).contains(&value));
        // The nearest `f32` first, then its neighbours: in `f32` the zero may be at any of them.
        let neighbours = |input: InputId, value: f64| {
            let near = value as f32;
            let all = [near, near.next_up(), near.next_down()].map(f64::from);
            all.into_iter().filter(move |v| inside(input, *v)).map(move |v| with(input, v))
        };
        match self {
            Zero::Everywhere => vec![base.to_vec()],
            Zero::Fixed(input, value) => neighbours(*input, *value).collect(),
            Zero::Plane { terms, constant, .. } => {
                let number = |input: InputId| match base[input.index()] {
                    Value::Number(number) => number,
                    Value::Level(_) => 0.0,
                };
                let sum: f64 = constant + terms.iter().map(|(input, factor)| factor * number(*input)).sum::<f64>();
                let solve = |(input, factor): &(InputId, f64)| neighbours(*input, number(*input) - sum / factor);
                terms.iter().rev().flat_map(solve).collect()
            }
            Zero::Somewhere(expr) => {
                let inputs = program.pool.expr_facts(*expr).inputs;
                let size = Laid::new(&program.pool, *expr).work();
                // Along each input as many as there are positions, and as many again for a change of sign.
                if !budget.compute(2 * POSITIONS * TRACED * inputs.iter().count() * size) {
                    return Vec::new();
                }
                let roots = inputs.iter().flat_map(|input| {
                    let at = |value: f64| Trace::<f64>::of(program, &with(input, value), *expr);
                    let Domain::Continuous { lo, hi, .. } = program.inputs[input.index()].domain else {
                        return Vec::new();
                    };
                    crossings(lo, hi, at).into_iter().flat_map(|root| neighbours(input, root)).collect()
                });
                roots.collect()
            }
        }
    }
}

/// Places where a function is zero or changes its sign without a jump.
fn crossings(lo: f64, hi: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    // The last position is the end itself, whatever its sum is rounded to.
    let place = |i: usize| if i == POSITIONS { hi } else { lo + (hi - lo) * i as f64 / POSITIONS as f64 };
    let values: Vec<f64> = (0..=POSITIONS).map(|i| f(place(i))).collect();
    let mut found: Vec<f64> = (0..=POSITIONS).filter(|i| values[*i] == 0.0).map(place).collect();
    for i in 0..POSITIONS {
        if values[i] * values[i + 1] < 0.0 {
            let (mut left, mut right) = (place(i), place(i + 1));
            for _ in 0..64 {
                let middle = 0.5 * (left + right);
                if f(middle) * values[i] > 0.0 { left = middle } else { right = middle }
            }
            // At a pole the sign changes as well, but not towards zero.
            if f(left).abs() < values[i].abs() {
                found.push(left);
            }
        }
    }
    found
}
