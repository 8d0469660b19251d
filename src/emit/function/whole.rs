//! Whole numbers as code computes them: results that are indices or integers, quotients and remainders.
//!
//! A program computes whole numbers so small that `f32` has all of them, so code may change
//! between both kinds wherever it likes. It stays with integers where the result is one, and
//! where a language promises too little for the quotient of real numbers.

use std::collections::HashSet;

use super::body::Body;
use super::values::MAX_PLAIN;
use crate::emit::language::bare;
use crate::program::{BinaryOp, ExprId, Node, Scalar, TernaryOp, UnaryOp};

impl Body<'_, '_> {
    /// A whole number of a kind: [`Scalar::Uint`], or [`Scalar::Int`].
    pub(super) fn whole(&self, expr: ExprId, scalar: Scalar) -> String {
        let integer = |part: ExprId| self.whole(part, Scalar::Int);
        if let Some(name) = self.scope.value(expr) {
            return self.dialect.converted(Scalar::Float, scalar, name);
        }
        let value = match self.plan.pool.node(expr) {
            Node::Const(number) if scalar == Scalar::Uint => return self.dialect.uint(number.get() as u32),
            Node::Const(number) => return self.dialect.int(number.get() as i32),
            Node::Index(input) => {
                let ident = &self.plan.program.inputs[input.index()].ident;
                return self.dialect.converted(Scalar::Uint, scalar, ident);
            }
            Node::Select(c, a, b) => {
                if let Some(outcome) = self.scope.outcome(c) {
                    return self.whole(if outcome { a } else { b }, scalar);
                }
                let (a, b) = (self.whole(a, scalar), self.whole(b, scalar));
                return self.dialect.select(bare(&self.condition(c)), bare(&a), bare(&b));
            }
            Node::Unary(UnaryOp::NumberOfWord, a) => {
                return self.dialect.converted(Scalar::Uint, scalar, &self.expr(a));
            }
            Node::Unary(UnaryOp::Negate, a) => format!("(-{})", integer(a)),
            Node::Unary(UnaryOp::Abs, a) => self.dialect.int_function("abs", &[&integer(a)]),
            Node::Binary(op, a, b) => {
                let operands = [integer(a), integer(b)];
                let symbol = match op {
                    BinaryOp::Add => "+",
                    BinaryOp::Subtract => "-",
                    BinaryOp::Multiply => "*",
                    BinaryOp::WholeQuotient => "/",
                    BinaryOp::WholeRemainder => "%",
                    BinaryOp::Min | BinaryOp::Max | BinaryOp::Divide | BinaryOp::Remainder => "",
                    BinaryOp::Atan2 | BinaryOp::Pow | BinaryOp::Step => "",
                    BinaryOp::WordAdd | BinaryOp::WordSubtract | BinaryOp::WordMultiply => "",
                    BinaryOp::WordQuotient | BinaryOp::WordRemainder | BinaryOp::WordMax | BinaryOp::WordMin => "",
                    BinaryOp::WordAnd | BinaryOp::WordOr | BinaryOp::WordXor => "",
                    BinaryOp::ShiftLeft | BinaryOp::ShiftRight => "",
                };
                let parts = operands.each_ref().map(String::as_str);
                match (symbol, op) {
                    ("", BinaryOp::Min) => self.dialect.int_function("min", &parts),
                    ("", BinaryOp::Max) => self.dialect.int_function("max", &parts),
                    ("", _) => return self.dialect.converted(Scalar::Float, scalar, &self.expr(expr)),
                    ("%", _) if self.plan.pool.expr_facts(a).range.0 < 0.0 => {
                        self.dialect.signed_remainder(self.prefix, parts)
                    }
                    _ => format!("({} {symbol} {})", parts[0], parts[1]),
                }
            }
            Node::Ternary(TernaryOp::Clamp, a, lo, hi) => {
                let raised = self.dialect.int_function("max", &[&integer(a), &integer(lo)]);
                self.dialect.int_function("min", &[&raised, &integer(hi)])
            }
            Node::Word(_) | Node::Input(_) | Node::Result(_) | Node::Unary(..) | Node::Ternary(..) => {
                return self.dialect.converted(Scalar::Float, scalar, &self.expr(expr));
            }
        };
        self.dialect.converted(Scalar::Int, scalar, &value)
    }

    /// Returns whether a whole number is large and is calculated, so that its parts get names.
    pub(super) fn is_calculated(&self, expr: ExprId) -> bool {
        let pool = &self.plan.pool;
        if pool.expr_facts(expr).size <= MAX_PLAIN {
            return false;
        }
        let (mut open, mut seen) = (vec![expr], HashSet::new());
        while let Some(part) = open.pop() {
            let node = pool.node(part);
            if matches!(node, Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) {
                return true;
            }
            open.extend(node.children().filter(|child| seen.insert(*child)));
        }
        // Nothing but choices: what several of them share gets a name as a choice.
        false
    }
}
