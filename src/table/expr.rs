//! The expression part of the language, as written: a syntax tree in which
//! every node knows its place. Types and meaning come later, in `program`.

use crate::diag::{Span, Spanned};

/// An expression with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Expr {
    /// Its place in the table's source.
    pub span: Span,
    /// Its kind.
    pub kind: ExprKind,
}

/// The forms of an expression.
#[derive(Debug, Clone, PartialEq)]
pub enum ExprKind {
    /// A decimal number.
    Number(f64),
    /// A name, possibly dotted: an input, a named value, a local, a level, or a swizzle of one.
    Name(String),
    /// `set::level`: a level that says its set.
    Level(Spanned<String>, Spanned<String>),
    /// `-a`, `!a`, `~a`.
    Unary(UnaryOp, Box<Expr>),
    /// `a + b`, `a && b`, `a < b`, …
    Binary(BinaryOp, Box<Expr>, Box<Expr>),
    /// `a in {x, y}`.
    In(Box<Expr>, Vec<Spanned<String>>),
    /// `f(a, b)`.
    Call(Spanned<String>, Vec<Expr>),
    /// `(expression).xy`.
    Swizzle(Box<Expr>, Spanned<String>),
    /// `case(11, V = none)`: the value of another case, with inputs replaced.
    Case(Spanned<u32>, Vec<(Spanned<String>, Expr)>),
    /// `if c { a } else { b }`.
    If(Box<Expr>, Box<Expr>, Box<Expr>),
    /// `let n = a; b`.
    Let(Spanned<String>, Box<Expr>, Box<Expr>),
    /// `[a, b if c]`: a list of results, or the coefficients of a polynomial.
    List(Vec<Expr>),
    /// `b if c`: an item that is in its list only if a condition holds.
    Optional(Box<Expr>, Box<Expr>),
    /// `f(p = a, q = b)`: a function of the table; parameters that are not given
    /// mean what they mean here.
    With(Spanned<String>, Vec<(Spanned<String>, Expr)>),
    /// `F | phi = lo .. hi`: F at `hi` less F at `lo`.
    Between(Box<Expr>, Spanned<String>, Box<Expr>, Box<Expr>),
    /// `sum(n in nodes, term)`.
    Sum(Spanned<String>, SumOver, Box<Expr>),
    /// `iterate(n, x = start, step)`: the step n times, each time of what the one before gave.
    Iterate(Box<Expr>, Spanned<String>, Box<Expr>, Box<Expr>),
    /// `curve[i]`, `m[i, j]`: an item of constant data.
    Index(Box<Expr>, Vec<Expr>),
    /// `{x: a, y: b}`: several named numbers.
    Record(Vec<(Spanned<String>, Expr)>),
}

impl Expr {
    /// The number, if this is one, with or without a sign.
    pub fn literal(&self) -> Option<f64> {
        if let ExprKind::Unary(UnaryOp::Negate, inner) = &self.kind {
            return if let ExprKind::Number(number) = inner.kind { Some(-number) } else { None };
        }
        if let ExprKind::Number(number) = self.kind { Some(number) } else { None }
    }

    /// The name, if this is nothing but one.
    pub fn name(&self) -> Option<&str> {
        if let ExprKind::Name(name) = &self.kind { Some(name) } else { None }
    }

    /// The expressions that this one is made of, in the order written.
    pub fn parts(&self) -> Vec<&Expr> {
        match &self.kind {
            ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Level(..) => Vec::new(),
            ExprKind::Unary(_, a) | ExprKind::In(a, _) | ExprKind::Swizzle(a, _) => vec![&**a],
            ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) | ExprKind::Optional(a, b) => vec![&**a, &**b],
            ExprKind::If(a, b, c) | ExprKind::Between(a, _, b, c) => vec![&**a, &**b, &**c],
            ExprKind::Call(_, items) | ExprKind::List(items) => items.iter().collect(),
            ExprKind::Case(_, set) | ExprKind::With(_, set) | ExprKind::Record(set) => {
                set.iter().map(|(_, value)| value).collect()
            }
            ExprKind::Sum(_, SumOver::Items(_), term) => vec![&**term],
            ExprKind::Sum(_, SumOver::Range(lo, hi), term) => vec![&**lo, &**hi, &**term],
            ExprKind::Iterate(count, _, start, step) => vec![&**count, &**start, &**step],
            ExprKind::Index(list, indices) => std::iter::once(&**list).chain(indices).collect(),
        }
    }

    /// The same, to be changed.
    pub fn parts_mut(&mut self) -> Vec<&mut Expr> {
        match &mut self.kind {
            ExprKind::Number(_) | ExprKind::Name(_) | ExprKind::Level(..) => Vec::new(),
            ExprKind::Unary(_, a) | ExprKind::In(a, _) | ExprKind::Swizzle(a, _) => vec![&mut **a],
            ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) | ExprKind::Optional(a, b) => vec![&mut **a, &mut **b],
            ExprKind::If(a, b, c) | ExprKind::Between(a, _, b, c) => vec![&mut **a, &mut **b, &mut **c],
            ExprKind::Call(_, items) | ExprKind::List(items) => items.iter_mut().collect(),
            ExprKind::Case(_, set) | ExprKind::With(_, set) | ExprKind::Record(set) => {
                set.iter_mut().map(|(_, value)| value).collect()
            }
            ExprKind::Sum(_, SumOver::Items(_), term) => vec![&mut **term],
            ExprKind::Sum(_, SumOver::Range(lo, hi), term) => vec![&mut **lo, &mut **hi, &mut **term],
            ExprKind::Iterate(count, _, start, step) => vec![&mut **count, &mut **start, &mut **step],
            ExprKind::Index(list, indices) => std::iter::once(&mut **list).chain(indices).collect(),
        }
    }
}

/// The range of a sum.
#[derive(Debug, Clone, PartialEq)]
pub enum SumOver {
    /// The items of a list of constants.
    Items(Spanned<String>),
    /// The whole numbers from one constant to another, both included.
    Range(Box<Expr>, Box<Expr>),
}

/// Operators with one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnaryOp {
    /// `-`
    Negate,
    /// `!`
    Not,
    /// `~`
    BitNot,
}

/// Operators with two operands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum BinaryOp {
    Or,
    And,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    Join,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
}

impl UnaryOp {
    /// The operator as written.
    pub fn symbol(self) -> &'static str {
        match self {
            UnaryOp::Negate => "-",
            UnaryOp::Not => "!",
            UnaryOp::BitNot => "~",
        }
    }
}

impl BinaryOp {
    /// All of them.
    pub const ALL: [Self; 19] = [
        Self::Or,
        Self::And,
        Self::Equal,
        Self::NotEqual,
        Self::Less,
        Self::LessEqual,
        Self::Greater,
        Self::GreaterEqual,
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
        Self::Remainder,
        Self::Join,
        Self::BitAnd,
        Self::BitOr,
        Self::BitXor,
        Self::ShiftLeft,
        Self::ShiftRight,
    ];

    /// Returns whether it is an operation on bits. Its operands are unary expressions, as in WGSL: beside other
    /// operators it stands in parentheses, so that nobody has to know which of them binds more strongly.
    pub fn is_on_bits(self) -> bool {
        matches!(self, Self::BitAnd | Self::BitOr | Self::BitXor | Self::ShiftLeft | Self::ShiftRight)
    }

    /// Its binding strength; the operands of a stronger one need no parentheses.
    pub fn strength(self) -> u8 {
        match self {
            BinaryOp::Or => 1,
            BinaryOp::And => 2,
            BinaryOp::Equal
            | BinaryOp::NotEqual
            | BinaryOp::Less
            | BinaryOp::LessEqual
            | BinaryOp::Greater
            | BinaryOp::GreaterEqual => 3,
            BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Join => 4,
            BinaryOp::Multiply | BinaryOp::Divide | BinaryOp::Remainder => 5,
            BinaryOp::BitAnd | BinaryOp::BitOr | BinaryOp::BitXor | BinaryOp::ShiftLeft | BinaryOp::ShiftRight => 6,
        }
    }

    /// The operator as written.
    pub fn symbol(self) -> &'static str {
        match self {
            BinaryOp::Or => "||",
            BinaryOp::And => "&&",
            BinaryOp::Equal => "==",
            BinaryOp::NotEqual => "!=",
            BinaryOp::Less => "<",
            BinaryOp::LessEqual => "<=",
            BinaryOp::Greater => ">",
            BinaryOp::GreaterEqual => ">=",
            BinaryOp::Add => "+",
            BinaryOp::Subtract => "-",
            BinaryOp::Multiply => "*",
            BinaryOp::Divide => "/",
            BinaryOp::Remainder => "%",
            BinaryOp::Join => "++",
            BinaryOp::BitAnd => "&",
            BinaryOp::BitOr => "|",
            BinaryOp::BitXor => "^",
            BinaryOp::ShiftLeft => "<<",
            BinaryOp::ShiftRight => ">>",
        }
    }
}
