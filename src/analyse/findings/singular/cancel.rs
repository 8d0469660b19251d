//! U0553: equal terms that cancel on paper, after a division.
//!
//! In `(2 (k x + b) + sin(x)) / k - (2 (k y + b) + sin(y)) / k` the terms `2 b / k` are equal and
//! vanish. In floating point each is rounded first, and for small `k` their
//! roundings are larger than the result.

use super::trace::Trace;
use super::{Singularity, called, loss, quote};
use crate::analyse::sets::budget::Budget;
use crate::diag::{Diagnostic, codes};
use crate::program::{BinaryOp, ExprId, Node, Pool, Program, UnaryOp};
use crate::show::{Precision, sentence};

/// Most terms a sum is taken apart into.
const MAX_TERMS: usize = 64;

/// A factor, an expression, and what it is divided by.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Quotient {
    factor: f64,
    term: ExprId,
    divisor: Option<ExprId>,
}

/// One finding for each term that cancels behind a divisor that can be zero.
pub(super) fn findings(program: &Program, singularities: &[Singularity], budget: &Budget) -> Vec<Diagnostic> {
    let pool = &program.pool;
    let mut told: Vec<(ExprId, ExprId)> = Vec::new();
    let mut all = Vec::new();
    for expr in super::expressions(program) {
        let Node::Binary(BinaryOp::Subtract, left, right) = pool.node(expr) else { continue };
        let (mut over, mut under) = (Vec::new(), Vec::new());
        quotients(pool, left, 1.0, None, &mut over);
        quotients(pool, right, 1.0, None, &mut under);
        for quotient in over.iter().filter(|q| under.contains(q)) {
            let Some(divisor) = quotient.divisor else { continue };
            let Some(singularity) = singularities.iter().find(|s| s.divisor == divisor && s.limit.is_some()) else {
                continue;
            };
            if told.contains(&(quotient.term, divisor)) {
                continue;
            }
            let Some(loss) = loss(program, singularity, budget) else { continue };
            told.push((quotient.term, divisor));
            let term = match quotient.factor {
                1.0 => quote(program, quotient.term),
                factor => format!("{} * {}", Precision::F32.show(factor), quote(program, quotient.term)),
            };
            let divisor = quote(program, divisor);
            let message = format!("in `{}` the term `{term} / ({divisor})` cancels on paper only", called(program));
            let mut diagnostic = Diagnostic::warning(codes::CANCELS, message);
            if let Some(span) = Trace::<f32>::place(program, &singularity.point, singularity.divisor) {
                diagnostic = diagnostic.at(span, "both sides of a difference have this term");
            }
            let shown = |values: &[f64]| sentence(&program.output, values, Precision::F32);
            let effect = format!("at {} f32 gives {}, exact is {}", loss.place, shown(&loss.got), shown(&loss.exact));
            all.push(diagnostic.help(effect).help("leave the term out of both sides"));
        }
    }
    all
}

/// Takes a sum of quotients apart.
fn quotients(pool: &Pool, expr: ExprId, factor: f64, divisor: Option<ExprId>, out: &mut Vec<Quotient>) {
    if out.len() >= MAX_TERMS {
        return;
    }
    match pool.node(expr) {
        Node::Unary(UnaryOp::Negate, a) => quotients(pool, a, -factor, divisor, out),
        Node::Binary(BinaryOp::Add, a, b) => {
            quotients(pool, a, factor, divisor, out);
            quotients(pool, b, factor, divisor, out);
        }
        Node::Binary(BinaryOp::Subtract, a, b) => {
            quotients(pool, a, factor, divisor, out);
            quotients(pool, b, -factor, divisor, out);
        }
        Node::Binary(BinaryOp::Multiply, a, b) => match (pool.constant(a), pool.constant(b)) {
            (Some(a), _) => quotients(pool, b, factor * a, divisor, out),
            (_, Some(b)) => quotients(pool, a, factor * b, divisor, out),
            _ => out.push(Quotient { factor, term: expr, divisor }),
        },
        Node::Binary(BinaryOp::Divide, a, b) => match (pool.constant(b), divisor) {
            (Some(b), _) => quotients(pool, a, factor / b, divisor, out),
            (None, None) => quotients(pool, a, factor, Some(b), out),
            (None, Some(_)) => out.push(Quotient { factor, term: expr, divisor }),
        },
        Node::Const(_)
        | Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Select(..) => out.push(Quotient { factor, term: expr, divisor }),
    }
}
