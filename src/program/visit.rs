//! The parts of expressions and conditions, for walks that only pass through them.
//!
//! Code that gives a term a meaning matches its variants; code that looks for something
//! inside of a term asks for its parts, and code that replaces something inside of it maps
//! them. Neither needs a change when a variant is added.

use super::{Cond, CondId, ExprId, Node};

impl Node {
    /// The numbers that an expression is made of, from left to right; of a selection, its two sides.
    pub fn children(self) -> impl Iterator<Item = ExprId> + Clone {
        let parts = match self {
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) => [None; 3],
            Node::Unary(_, a) => [Some(a), None, None],
            Node::Binary(_, a, b) | Node::Select(_, a, b) => [Some(a), Some(b), None],
            Node::Ternary(_, a, b, c) => [Some(a), Some(b), Some(c)],
        };
        parts.into_iter().flatten()
    }

    /// The same node with its numbers mapped, from left to right. The condition of a selection stays.
    #[must_use]
    pub fn map(self, mut part: impl FnMut(ExprId) -> ExprId) -> Self {
        match self {
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) => self,
            Node::Unary(op, a) => Node::Unary(op, part(a)),
            Node::Binary(op, a, b) => Node::Binary(op, part(a), part(b)),
            Node::Ternary(op, a, b, c) => Node::Ternary(op, part(a), part(b), part(c)),
            Node::Select(condition, a, b) => Node::Select(condition, part(a), part(b)),
        }
    }

    /// The condition of a selection.
    pub fn condition(self) -> Option<CondId> {
        if let Node::Select(condition, ..) = self { Some(condition) } else { None }
    }
}

impl Cond {
    /// The conditions that a condition is made of, from left to right.
    pub fn children(&self) -> impl Iterator<Item = CondId> + '_ {
        let (few, list): ([Option<CondId>; 3], &[CondId]) = match self {
            Cond::Const(_) | Cond::Level(..) | Cond::Compare(..) => ([None; 3], &[]),
            Cond::Not(a) => ([Some(*a), None, None], &[]),
            Cond::And(parts) | Cond::Or(parts) => ([None; 3], parts),
            Cond::If(c, a, b) => ([Some(*c), Some(*a), Some(*b)], &[]),
        };
        few.into_iter().flatten().chain(list.iter().copied())
    }

    /// The numbers that a comparison compares.
    pub fn compared(&self) -> impl Iterator<Item = ExprId> {
        let parts = if let Cond::Compare(_, a, b) = self { [Some(*a), Some(*b)] } else { [None; 2] };
        parts.into_iter().flatten()
    }
}
