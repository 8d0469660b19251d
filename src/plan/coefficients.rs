//! The sums that [`Step::Coefficients`](super::Step::Coefficients) computes, and what they mean.

use crate::program::{BinaryOp, ExprId, InputId, Node, Pool, TernaryOp};

/// The coefficients of a plan.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Coefficients {
    /// The inputs that are multiplied, in the order in which the products are added.
    pub inputs: Vec<InputId>,
    /// The number of sums that a value is the minimum of.
    pub width: usize,
    /// The bounds that every value is clamped to.
    pub clamp: Option<(f64, f64)>,
    /// The sets of coefficients.
    pub fits: Vec<Fit>,
}

/// A set of coefficients and the case that it is the value of.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The row, as an index into [`Program::rows`](crate::program::Program::rows); `None` for the default.
    pub row: Option<usize>,
    /// The line of that row; `None` where the default gives the value.
    pub line: Option<usize>,
    /// One for each component of the output.
    pub pieces: Vec<Piece>,
}

/// The coefficients of one component.
#[derive(Debug, Clone, PartialEq)]
pub struct Piece {
    /// 1, or -1 for the negative of the minimum, which is a maximum.
    pub sign: f64,
    /// The sums, [`Coefficients::width`] of them.
    pub forms: Vec<Form>,
}

/// A sum.
#[derive(Debug, Clone, PartialEq)]
pub struct Form {
    /// The first summand.
    pub constant: f64,
    /// The factor of each of [`Coefficients::inputs`].
    pub factors: Vec<f64>,
}

impl Coefficients {
    /// Returns the value of a piece, as the code computes it, in the same order.
    pub(crate) fn value(&self, pool: &mut Pool, piece: &Piece) -> ExprId {
        let mut least = None;
        for form in &piece.forms {
            let mut sum = pool.number(form.constant);
            for (input, factor) in self.inputs.iter().zip(&form.factors) {
                let (factor, input) = (pool.number(*factor), pool.input(*input));
                let product = pool.settle(Node::Binary(BinaryOp::Multiply, factor, input));
                sum = pool.settle(Node::Binary(BinaryOp::Add, sum, product));
            }
            least = Some(match least {
                None => sum,
                Some(least) => pool.settle(Node::Binary(BinaryOp::Min, least, sum)),
            });
        }
        let sign = pool.number(piece.sign);
        let least = least.unwrap_or(sign);
        let value = pool.settle(Node::Binary(BinaryOp::Multiply, sign, least));
        match self.clamp {
            None => value,
            Some((lo, hi)) => {
                let (lo, hi) = (pool.number(lo), pool.number(hi));
                pool.settle(Node::Ternary(TernaryOp::Clamp, value, lo, hi))
            }
        }
    }
}
