//! Expressions and conditions as terms over real numbers.

use std::collections::HashMap;

use super::script::{Script, real};
use crate::program::{
    BinaryOp, Comparison, Cond, CondId, ExprId, InputId, LevelSet, LevelTerm, Node, Pool, TernaryOp, UnaryOp,
};

/// Most constants that a factor or divisor may be one of for the product to be written out.
const MAX_CHOICES: usize = 64;

/// Writes terms of a pool, in an environment in which inputs stand for terms.
pub(super) struct Terms<'a> {
    pool: &'a Pool,
    /// The term that each input stands for.
    pub(super) inputs: Vec<String>,
    /// The terms that the components of the result stand for, in the result map of a symmetry.
    result: Vec<String>,
    exprs: HashMap<ExprId, String>,
    conds: HashMap<CondId, String>,
    /// By condition and input, the condition under which testing it fetches the input.
    asks: HashMap<(CondId, InputId), String>,
    /// The same of expressions.
    reads: HashMap<(ExprId, InputId), String>,
}

impl<'a> Terms<'a> {
    pub(super) fn new(pool: &'a Pool, inputs: Vec<String>) -> Self {
        Self {
            pool,
            inputs,
            result: Vec::new(),
            exprs: HashMap::new(),
            conds: HashMap::new(),
            asks: HashMap::new(),
            reads: HashMap::new(),
        }
    }

    /// Terms of a result map at a result.
    pub(super) fn of_result(pool: &'a Pool, inputs: Vec<String>, result: &[String]) -> Self {
        Self { result: result.to_vec(), ..Self::new(pool, inputs) }
    }

    /// The term of an expression.
    pub(super) fn expr(&mut self, script: &mut Script, expr: ExprId) -> String {
        if let Some(known) = self.exprs.get(&expr) {
            return known.clone();
        }
        let term = match self.pool.node(expr) {
            Node::Const(number) => return real(number.get()),
            Node::Word(word) => return real(f64::from(word)),
            Node::Input(input) => return self.inputs[input.index()].clone(),
            Node::Index(input) => format!("(to_real {})", self.inputs[input.index()]),
            // It occurs nowhere else.
            Node::Result(component) => {
                return self.result.get(usize::from(component)).cloned().unwrap_or_else(|| real(0.0));
            }
            Node::Unary(op, a) => self.unary(script, op, a),
            Node::Binary(op, a, b) => self.binary(script, op, a, b),
            Node::Ternary(op, a, b, c) => self.ternary(script, op, [a, b, c]),
            Node::Select(condition, a, b) => {
                let (condition, a, b) = (self.cond(script, condition), self.expr(script, a), self.expr(script, b));
                format!("(ite {condition} {a} {b})")
            }
        };
        let name = script.define("Real", &term);
        self.exprs.insert(expr, name.clone());
        name
    }

    fn unary(&mut self, script: &mut Script, op: UnaryOp, a: ExprId) -> String {
        let a = self.expr(script, a);
        match op {
            UnaryOp::Negate => format!("(- {a})"),
            UnaryOp::Abs => format!("(ite (< {a} 0.0) (- {a}) {a})"),
            UnaryOp::Saturate => clamp(&a, "0.0", "1.0"),
            UnaryOp::Sign => format!("(ite (< 0.0 {a}) 1.0 (ite (< {a} 0.0) (- 1.0) 0.0))"),
            UnaryOp::Floor => floor(&a),
            UnaryOp::Ceil => format!("(- {})", floor(&format!("(- {a})"))),
            UnaryOp::Trunc => {
                format!("(ite (< {a} 0.0) (- {}) {})", floor(&format!("(- {a})")), floor(&a))
            }
            UnaryOp::Fract => format!("(- {a} {})", floor(&a)),
            // A word is the number that it is.
            UnaryOp::NumberOfWord => a,
            UnaryOp::WordNot | UnaryOp::WordOfNumber | UnaryOp::WordOfWhole => {
                format!("({} {a})", script.function(&format!("{op:?}"), 1))
            }
            UnaryOp::Acos
            | UnaryOp::Acosh
            | UnaryOp::Asin
            | UnaryOp::Asinh
            | UnaryOp::Atan
            | UnaryOp::Atanh
            | UnaryOp::Cos
            | UnaryOp::Cosh
            | UnaryOp::Degrees
            | UnaryOp::Exp
            | UnaryOp::Exp2
            | UnaryOp::InverseSqrt
            | UnaryOp::Log
            | UnaryOp::Log2
            | UnaryOp::PortableCos
            | UnaryOp::PortableSin
            | UnaryOp::Radians
            | UnaryOp::Round
            | UnaryOp::Sin
            | UnaryOp::Sinh
            | UnaryOp::Sqrt
            | UnaryOp::Tan
            | UnaryOp::Tanh => format!("({} {a})", script.function(op.row().notation.name(), 1)),
        }
    }

    fn binary(&mut self, script: &mut Script, op: BinaryOp, a: ExprId, b: ExprId) -> String {
        match op {
            BinaryOp::Multiply => return self.product(script, a, b),
            BinaryOp::Divide => return self.quotient(script, a, b),
            BinaryOp::WholeQuotient => return self.whole_quotient(script, a, b),
            BinaryOp::WholeRemainder => {
                let quotient = self.whole_quotient(script, a, b);
                let quotient = script.define("Real", &quotient);
                let a = self.expr(script, a);
                // Of one divisor: what is not constant was left to the solver by the quotient.
                let product = self.chosen_or(script, b, &|_, b| format!("(* {} {quotient})", real(b)), &|b| {
                    format!("(* {b} {quotient})")
                });
                return format!("(- {a} {product})");
            }
            BinaryOp::Add
            | BinaryOp::Subtract
            | BinaryOp::Remainder
            | BinaryOp::Atan2
            | BinaryOp::Max
            | BinaryOp::Min
            | BinaryOp::Pow
            | BinaryOp::Step
            | BinaryOp::WordAdd
            | BinaryOp::WordSubtract
            | BinaryOp::WordMultiply
            | BinaryOp::WordQuotient
            | BinaryOp::WordRemainder
            | BinaryOp::WordAnd
            | BinaryOp::WordOr
            | BinaryOp::WordXor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::WordMax
            | BinaryOp::WordMin => {}
        }
        let (a, b) = (self.expr(script, a), self.expr(script, b));
        match op {
            BinaryOp::Add => format!("(+ {a} {b})"),
            BinaryOp::Subtract => format!("(- {a} {b})"),
            BinaryOp::Max | BinaryOp::WordMax => larger(&a, &b),
            BinaryOp::Min | BinaryOp::WordMin => smaller(&a, &b),
            // They wrap, and bits are no part of the logic.
            BinaryOp::WordAdd
            | BinaryOp::WordSubtract
            | BinaryOp::WordMultiply
            | BinaryOp::WordQuotient
            | BinaryOp::WordRemainder
            | BinaryOp::WordAnd
            | BinaryOp::WordOr
            | BinaryOp::WordXor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight => format!("({} {a} {b})", script.function(&format!("{op:?}"), 2)),
            BinaryOp::Step => format!("(ite (<= {a} {b}) 1.0 0.0)"),
            BinaryOp::Remainder => format!("({} {a} {b})", script.function("remainder", 2)),
            BinaryOp::Atan2
            | BinaryOp::Pow
            | BinaryOp::Multiply
            | BinaryOp::Divide
            | BinaryOp::WholeQuotient
            | BinaryOp::WholeRemainder => {
                format!("({} {a} {b})", script.function(op.row().notation.name(), 2))
            }
        }
    }

    fn ternary(&mut self, script: &mut Script, op: TernaryOp, [a, b, c]: [ExprId; 3]) -> String {
        match op {
            TernaryOp::Clamp => {
                let [a, b, c] = [a, b, c].map(|part| self.expr(script, part));
                clamp(&a, &b, &c)
            }
            TernaryOp::Fma => {
                let (product, c) = (self.product(script, a, b), self.expr(script, c));
                format!("(+ {product} {c})")
            }
            TernaryOp::Mix => {
                // a + (b - a) t, which is a (1 - t) + b t.
                let (first, by_a, by_b) =
                    (self.expr(script, a), self.product(script, a, c), self.product(script, b, c));
                format!("(+ {first} (- {by_b} {by_a}))")
            }
            TernaryOp::Smoothstep => {
                let [a, b, c] = [a, b, c].map(|part| self.expr(script, part));
                format!("({} {a} {b} {c})", script.function("smoothstep", 3))
            }
        }
    }

    /// A product; of a choice of constants, a choice of multiples.
    fn product(&mut self, script: &mut Script, a: ExprId, b: ExprId) -> String {
        let (left, right) = (self.choices(a), self.choices(b));
        match (left, right) {
            (Some(_), _) => {
                let b = self.expr(script, b);
                self.chosen(script, a, &|_, factor| format!("(* {} {b})", real(factor)))
            }
            (None, Some(_)) => {
                let a = self.expr(script, a);
                self.chosen(script, b, &|_, factor| format!("(* {} {a})", real(factor)))
            }
            (None, None) => {
                script.beyond("products of which no factor is a constant");
                let (a, b) = (self.expr(script, a), self.expr(script, b));
                format!("(* {a} {b})")
            }
        }
    }

    /// A quotient; nothing is known of one by zero, or by what is no constant.
    fn quotient(&mut self, script: &mut Script, a: ExprId, b: ExprId) -> String {
        let a = self.expr(script, a);
        let unknown = |script: &mut Script, a: &str, b: &str| format!("({} {a} {b})", script.function("quotient", 2));
        if self.choices(b).is_none() {
            let b = self.expr(script, b);
            return unknown(script, &a, &b);
        }
        self.chosen(script, b, &|script, divisor| match divisor == 0.0 {
            true => unknown(script, &a, &real(0.0)),
            false => format!("(/ {a} {})", real(divisor)),
        })
    }

    /// A quotient without its fraction.
    fn whole_quotient(&mut self, script: &mut Script, a: ExprId, b: ExprId) -> String {
        let quotient = self.quotient(script, a, b);
        let quotient = script.define("Real", &quotient);
        format!("(ite (< {quotient} 0.0) (- {}) {})", floor(&format!("(- {quotient})")), floor(&quotient))
    }

    /// A choice of constants with something made of each, or what is made of a term that is none.
    fn chosen_or(
        &mut self,
        script: &mut Script,
        expr: ExprId,
        make: &dyn Fn(&mut Script, f64) -> String,
        other: &dyn Fn(&str) -> String,
    ) -> String {
        match self.choices(expr) {
            Some(_) => self.chosen(script, expr, make),
            None => {
                script.beyond("products of which no factor is a constant");
                let term = self.expr(script, expr);
                other(&term)
            }
        }
    }

    /// The number of constants that an expression is a choice of, if it is one and they are few.
    fn choices(&self, expr: ExprId) -> Option<usize> {
        let count = match self.pool.node(expr) {
            Node::Const(_) | Node::Word(_) => 1,
            Node::Select(_, a, b) => self.choices(a)? + self.choices(b)?,
            Node::Index(_) => self.pool.expr_facts(expr).range.1 as usize + 1,
            Node::Input(_) | Node::Result(_) | Node::Unary(..) | Node::Binary(..) | Node::Ternary(..) => return None,
        };
        (count <= MAX_CHOICES).then_some(count)
    }

    /// A choice of constants, with something made of each.
    fn chosen(&mut self, script: &mut Script, expr: ExprId, make: &dyn Fn(&mut Script, f64) -> String) -> String {
        match self.pool.node(expr) {
            Node::Select(condition, a, b) => {
                let condition = self.cond(script, condition);
                let (a, b) = (self.chosen(script, a, make), self.chosen(script, b, make));
                format!("(ite {condition} {a} {b})")
            }
            Node::Index(input) => {
                let last = self.pool.expr_facts(expr).range.1 as u32;
                let rest = make(script, f64::from(last));
                let input = self.inputs[input.index()].clone();
                (0..last).rev().fold(rest, |rest, level| {
                    let chosen = make(script, f64::from(level));
                    format!("(ite (= {input} {level}) {chosen} {rest})")
                })
            }
            Node::Const(_)
            | Node::Word(_)
            | Node::Input(_)
            | Node::Result(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => make(script, self.pool.known(expr).unwrap_or_default()),
        }
    }

    /// The term of a condition.
    pub(super) fn cond(&mut self, script: &mut Script, condition: CondId) -> String {
        if let Some(known) = self.conds.get(&condition) {
            return known.clone();
        }
        let pool = self.pool;
        let term = match pool.cond(condition) {
            Cond::Const(value) => return value.to_string(),
            Cond::Level(input, levels) => among(&self.inputs[input.index()], *levels),
            Cond::Compare(op, a, b) => {
                let symbol = match op {
                    Comparison::Less => "<",
                    Comparison::LessEqual => "<=",
                    Comparison::Equal => "=",
                };
                let (a, b) = (self.expr(script, *a), self.expr(script, *b));
                format!("({symbol} {a} {b})")
            }
            Cond::Not(a) => format!("(not {})", self.cond(script, *a)),
            Cond::And(parts) => format!("(and {})", self.all(script, parts)),
            Cond::Or(parts) => format!("(or {})", self.all(script, parts)),
            Cond::If(c, a, b) => {
                let [c, a, b] = [c, a, b].map(|part| self.cond(script, *part));
                format!("(ite {c} {a} {b})")
            }
        };
        let name = script.define("Bool", &term);
        self.conds.insert(condition, name.clone());
        name
    }

    fn all(&mut self, script: &mut Script, parts: &[CondId]) -> String {
        parts.iter().map(|part| self.cond(script, *part)).collect::<Vec<_>>().join(" ")
    }

    /// The level that an image stands for.
    pub(super) fn level(&mut self, script: &mut Script, term: &LevelTerm) -> String {
        match term {
            LevelTerm::Const(level) => level.to_string(),
            LevelTerm::Input(input) => self.inputs[input.index()].clone(),
            LevelTerm::If(condition, a, b) => {
                let (condition, a, b) = (self.cond(script, *condition), self.level(script, a), self.level(script, b));
                format!("(ite {condition} {a} {b})")
            }
            LevelTerm::Map(inner, renaming) => {
                let inner = self.level(script, inner);
                let inner = script.define("Int", &inner);
                let mut levels = renaming.iter().enumerate().rev();
                let last = levels.next().map_or_else(|| "0".to_owned(), |(_, level)| level.to_string());
                levels.fold(last, |rest, (level, image)| format!("(ite (= {inner} {level}) {image} {rest})"))
            }
        }
    }

    /// The condition under which testing a condition fetches an input: parts are tested from left to right,
    /// as far as needed.
    pub(super) fn asks(&mut self, script: &mut Script, condition: CondId, input: InputId) -> String {
        let pool = self.pool;
        if !pool.cond_facts(condition).inputs.contains(input) {
            return "false".to_owned();
        }
        if let Some(known) = self.asks.get(&(condition, input)) {
            return known.clone();
        }
        let term = match pool.cond(condition) {
            Cond::Const(_) => "false".to_owned(),
            Cond::Level(asked, _) => (*asked == input).to_string(),
            Cond::Compare(_, a, b) => {
                let (a, b) = (self.reads(script, *a, input), self.reads(script, *b, input));
                format!("(or {a} {b})")
            }
            Cond::Not(a) => self.asks(script, *a, input),
            Cond::And(parts) | Cond::Or(parts) => {
                let is_and = matches!(pool.cond(condition), Cond::And(_));
                let mut rest = "false".to_owned();
                for part in parts.iter().rev() {
                    let (asks, holds) = (self.asks(script, *part, input), self.cond(script, *part));
                    let goes_on = if is_and { holds } else { format!("(not {holds})") };
                    rest = format!("(or {asks} (and {goes_on} {rest}))");
                }
                rest
            }
            Cond::If(c, a, b) => {
                let asks = [c, a, b].map(|part| self.asks(script, *part, input));
                let c = self.cond(script, *c);
                format!("(or {} (ite {c} {} {}))", asks[0], asks[1], asks[2])
            }
        };
        let name = script.define("Bool", &term);
        self.asks.insert((condition, input), name.clone());
        name
    }

    /// The condition under which computing an expression fetches an input: of a selection only the chosen
    /// side is computed.
    pub(super) fn reads(&mut self, script: &mut Script, expr: ExprId, input: InputId) -> String {
        let pool = self.pool;
        if !pool.expr_facts(expr).inputs.contains(input) {
            return "false".to_owned();
        }
        if let Some(known) = self.reads.get(&(expr, input)) {
            return known.clone();
        }
        let term = match pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Result(_) => "false".to_owned(),
            Node::Input(read) | Node::Index(read) => (read == input).to_string(),
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let parts: Vec<String> = node.children().map(|part| self.reads(script, part, input)).collect();
                format!("(or false {})", parts.join(" "))
            }
            Node::Select(c, a, b) => {
                let (asks, holds) = (self.asks(script, c, input), self.cond(script, c));
                let (a, b) = (self.reads(script, a, input), self.reads(script, b, input));
                format!("(or {asks} (ite {holds} {a} {b}))")
            }
        };
        let name = script.define("Bool", &term);
        self.reads.insert((expr, input), name.clone());
        name
    }
}

fn floor(a: &str) -> String {
    format!("(to_real (to_int {a}))")
}

fn larger(a: &str, b: &str) -> String {
    format!("(ite (< {a} {b}) {b} {a})")
}

fn smaller(a: &str, b: &str) -> String {
    format!("(ite (< {b} {a}) {b} {a})")
}

fn clamp(a: &str, lo: &str, hi: &str) -> String {
    // The larger one of the first two is written twice, and none of them is long.
    smaller(&larger(a, lo), hi)
}

/// A level is one of some.
fn among(input: &str, levels: LevelSet) -> String {
    let each: Vec<String> = levels.iter().map(|level| format!("(= {input} {level})")).collect();
    format!("(or false {})", each.join(" "))
}
