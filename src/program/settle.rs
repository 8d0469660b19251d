//! Terms whose operands became known in a state: folded if nobody can tell, left as they are if not.
//!
//! Plans, proofs and symbolic runs put in what a state decides. What then has constants for operands is
//! replaced by its result only if that is the exact one, and the one that the operation gives in `f32`,
//! bit for bit. So a term means the same over the reals before and after, and every executor that adds
//! and multiplies as it must gets the same bits; a proof may speak of either, and its words hold of both.
//! A shader's square root or sine may be off in the last place: such operations are left to it.

use super::operators::BinaryAlgebra;
use super::{BinaryOp, ExprId, Node, Pool, Real, TernaryOp, UnaryOp};

/// Products below this may have lost digits, so that their error cannot be computed.
const SMALLEST: f64 = 1e-250;

impl Pool {
    /// A node made of what is in the pool, a selection made if it is decided, an operation carried out if
    /// that leaves no trace: neither over the reals nor in the bits of an `f32`.
    pub(crate) fn settle(&mut self, node: Node) -> ExprId {
        if let Node::Select(condition, then, other) = node {
            return self.select(condition, then, other);
        }
        if self.gives_word(node) {
            return self.rebuild(node);
        }
        match self.settled(node) {
            Some(value) => self.number(value),
            None => self.intern(node),
        }
    }

    /// The constant that a node is, over the reals and in `f32`.
    fn settled(&self, node: Node) -> Option<f64> {
        let (wide, narrow) = match node {
            Node::Unary(UnaryOp::NumberOfWord, a) => {
                let a = self.word(a)?;
                (f64::from(a), a as f32)
            }
            Node::Unary(op, a) => {
                let a = self.constant(a)?;
                (exact_unary(op, a)?, f32::unary(op, a as f32))
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.constant(a)?, self.constant(b)?);
                (exact_binary(op, a, b)?, f32::binary(op, a as f32, b as f32))
            }
            Node::Ternary(op, a, b, c) => {
                let operands = [a, b, c].map(|part| self.constant(part));
                if op.misordered(operands).is_some() {
                    return None;
                }
                let (a, b, c) = (operands[0]?, operands[1]?, operands[2]?);
                (exact_ternary(op, a, b, c)?, f32::ternary(op, a as f32, b as f32, c as f32))
            }
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => {
                return None;
            }
        };
        // A constant has no sign of zero.
        let told = wide.is_finite() && narrow.is_finite() && (wide as f32).to_bits() == narrow.to_bits();
        (told && wide.to_bits() != (-0.0_f64).to_bits()).then_some(wide)
    }
}

/// The result of an operation on one number, if it is exact.
fn exact_unary(op: UnaryOp, a: f64) -> Option<f64> {
    op.is_exact().then(|| op.apply(a))
}

/// The result of an operation on two numbers, if it is exact.
fn exact_binary(op: BinaryOp, a: f64, b: f64) -> Option<f64> {
    let value = op.apply(a, b);
    let exact = match op.row().algebra {
        BinaryAlgebra::Sum => is_sum(a, b, value),
        BinaryAlgebra::Difference => is_sum(a, -b, value),
        BinaryAlgebra::Product => is_product(a, b, value),
        BinaryAlgebra::Quotient => b != 0.0 && is_product(value, b, a),
        BinaryAlgebra::Minimum | BinaryAlgebra::Maximum | BinaryAlgebra::Opaque => op.is_exact(),
    };
    exact.then_some(value)
}

/// The result of an operation on three numbers, if it is exact. A product with a sum may be rounded
/// once or twice, and how numbers are mixed is left to a shader, too.
fn exact_ternary(op: TernaryOp, a: f64, b: f64, c: f64) -> Option<f64> {
    op.is_exact().then(|| op.apply(a, b, c))
}

/// Returns whether a rounded sum is the sum: what was lost of either operand is nothing.
fn is_sum(a: f64, b: f64, sum: f64) -> bool {
    let of_b = sum - a;
    let of_a = sum - of_b;
    sum.is_finite() && a - of_a == 0.0 && b - of_b == 0.0
}

/// Returns whether a rounded product is the product.
fn is_product(a: f64, b: f64, product: f64) -> bool {
    let nothing = (a == 0.0 || b == 0.0) && product == 0.0;
    nothing || (product.abs() > SMALLEST && product.is_finite() && a.mul_add(b, -product) == 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::InputId;

    fn binary(op: BinaryOp, a: f64, b: f64) -> Option<f64> {
        let mut pool = Pool::default();
        let (a, b) = (pool.number(a), pool.number(b));
        let settled = pool.settle(Node::Binary(op, a, b));
        pool.constant(settled)
    }

    #[test]
    fn what_is_exact_is_carried_out() {
        assert_eq!(binary(BinaryOp::Add, 0.25, 3.0), Some(3.25));
        assert_eq!(binary(BinaryOp::Divide, 3.0, 4.0), Some(0.75));
        assert_eq!(binary(BinaryOp::Multiply, 0.0, 6.0), Some(0.0));
        assert_eq!(binary(BinaryOp::Max, -1.5, 1e30), Some(1e30));
        assert_eq!(binary(BinaryOp::Step, 0.5, 0.25), Some(0.0));
        // More than an f32 holds, but rounded to the same one.
        assert_eq!(binary(BinaryOp::Add, 16_777_216.0, 1.0), Some(16_777_217.0));
    }

    #[test]
    fn what_leaves_a_trace_is_left() {
        // Not in f32: the first operand is 16777216 there.
        assert_eq!(binary(BinaryOp::Subtract, 16_777_217.0, 16_777_216.0), None);
        // Not over the reals.
        assert_eq!(binary(BinaryOp::Multiply, 0.1, 3.0), None);
        assert_eq!(binary(BinaryOp::Divide, 1.0, 3.0), None);
        assert_eq!(binary(BinaryOp::Add, 1e16, 1.0), None);
        assert_eq!(binary(BinaryOp::Multiply, 1e-200, 1e-200), None);
        // A zero with a sign, an infinity, no number.
        assert_eq!(binary(BinaryOp::Multiply, 0.0, -6.0), None);
        assert_eq!(binary(BinaryOp::Divide, 1.0, 0.0), None);
        assert_eq!(binary(BinaryOp::Multiply, 1e30, 1e30), None);
        // A shader may compute it otherwise.
        let mut pool = Pool::default();
        let four = pool.number(4.0);
        let root = pool.settle(Node::Unary(UnaryOp::Sqrt, four));
        assert_eq!(pool.constant(root), None);
        let x = pool.input(InputId::new(0));
        let sum = pool.settle(Node::Binary(BinaryOp::Add, four, x));
        assert_eq!(pool.node(sum), Node::Binary(BinaryOp::Add, four, x));
    }
}
