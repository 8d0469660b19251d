//! The value of a function as a sum of products: names, calls and bindings
//! replaced by what they stand for.
//!
//! `F | x = lo .. hi` is where rewriting happens; see [`super::between`].

use std::collections::BTreeMap;

use super::between::between;
use super::names::Taken;
use super::poly::{Atom, Mono, Poly};
use crate::program::rational::Rational;
use crate::table::expr::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::table::{ConstantValue, Function, FunctionBody, Table};

/// Deepest nesting of calls that are written out.
const MAX_DEPTH: usize = 64;

/// The meaning of names.
pub(super) type Env = BTreeMap<String, Poly>;

/// A pair of bounds: `mid` and `half` are names of the mean and of half the difference.
#[derive(Debug, Clone)]
pub(super) struct Bounds {
    pub(super) lo: Poly,
    pub(super) hi: Poly,
    pub(super) mid: String,
    pub(super) half: String,
}

/// Reads values of one table; errors say what cannot be rewritten.
pub(super) struct Reader<'t> {
    pub(super) table: &'t Table,
    /// The bounds met so far.
    pub(super) bounds: Vec<Bounds>,
    depth: usize,
    /// The names that are in use, those of bounds included.
    pub(super) taken: Taken,
    /// True if differences between bounds are read as integrals; see [`super::integrand`].
    pub(super) integrands: bool,
}

pub(super) type Result<T> = std::result::Result<T, String>;

/// The sum became too large, or is divided by zero at every point.
fn too_large() -> String {
    "it becomes too large, or divides by zero at every point".to_owned()
}

impl<'t> Reader<'t> {
    pub(super) fn new(table: &'t Table, taken: &Taken) -> Self {
        Self { table, bounds: Vec::new(), depth: 0, taken: taken.clone(), integrands: false }
    }

    /// The value of a function in terms of its parameters.
    pub(super) fn function(&mut self, function: &Function) -> Result<Poly> {
        let env = function.parameters.iter().map(|p| (p.value.clone(), Poly::var(&p.value))).collect();
        self.body(function, env)
    }

    pub(super) fn body(&mut self, function: &Function, mut env: Env) -> Result<Poly> {
        let FunctionBody::Value(value) = &function.body else {
            return Err(format!("`{}` has cases", function.name.value));
        };
        for binding in &function.bindings {
            let value = self.expr(&binding.value, &env)?;
            env.insert(binding.name.value.clone(), value);
        }
        self.expr(value, &env)
    }

    pub(super) fn expr(&mut self, expr: &Expr, env: &Env) -> Result<Poly> {
        if self.depth == MAX_DEPTH {
            return Err("calls are nested too deep".to_owned());
        }
        self.depth += 1;
        let result = self.node(expr, env);
        self.depth -= 1;
        result
    }

    fn node(&mut self, expr: &Expr, env: &Env) -> Result<Poly> {
        match &expr.kind {
            ExprKind::Number(value) => {
                let exact =
                    Rational::exact(*value).ok_or_else(|| format!("{value} is no fraction of moderate size"))?;
                // The decimal as written, where the double is only the nearest to it.
                Ok(Poly::number(Rational::decimal(*value).unwrap_or(exact)))
            }
            ExprKind::Name(name) => self.name(name, env),
            ExprKind::Unary(UnaryOp::Negate, a) => {
                self.expr(a, env)?.times_number(Rational::whole(-1)).ok_or_else(too_large)
            }
            ExprKind::Binary(BinaryOp::Divide, a, b) => {
                let a = self.expr(a, env)?;
                self.quotient(a, b, env)
            }
            ExprKind::Binary(op, a, b) => {
                let (a, b) = (self.expr(a, env)?, self.expr(b, env)?);
                let result = match op {
                    BinaryOp::Add => a.plus(&b),
                    BinaryOp::Subtract => a.minus(&b),
                    BinaryOp::Multiply => a.times(&b),
                    _ => return Err(format!("`{}` is not arithmetic", op.symbol())),
                };
                result.ok_or_else(too_large)
            }
            ExprKind::Let(name, value, rest) => {
                let value = self.expr(value, env)?;
                let mut inner = env.clone();
                inner.insert(name.value.clone(), value);
                self.expr(rest, &inner)
            }
            ExprKind::Call(name, arguments) => self.call(&name.value, arguments, env),
            ExprKind::With(name, set) => {
                let set = set.iter().map(|(parameter, value)| Ok((parameter.value.clone(), self.expr(value, env)?)));
                let set: Env = set.collect::<Result<_>>()?;
                self.function_call(&name.value, env, &set)
            }
            ExprKind::Between(body, variable, lo, hi) => {
                let (lo, hi) = (self.expr(lo, env)?, self.expr(hi, env)?);
                if self.integrands {
                    return self.integral(body, &variable.value, lo, hi, env);
                }
                let mut inner = env.clone();
                // A name that no table can use, so that it stays apart from what the bounds mention.
                let free = format!("{}'{}", variable.value, self.depth);
                inner.insert(variable.value.clone(), Poly::var(&free));
                let body = self.expr(body, &inner)?;
                let (mid, half) = self.bounds(lo, hi);
                between(&body, &free, &mid, &half)
            }
            ExprKind::Unary(UnaryOp::BitNot, _) => Err("`~` is not arithmetic".to_owned()),
            ExprKind::If(..) | ExprKind::In(..) | ExprKind::Unary(UnaryOp::Not, _) => {
                Err("it is a choice, and rules know formulas only".to_owned())
            }
            ExprKind::Sum(..)
            | ExprKind::Iterate(..)
            | ExprKind::Index(..)
            | ExprKind::List(_)
            | ExprKind::Optional(..)
            | ExprKind::Level(..)
            | ExprKind::Record(_)
            | ExprKind::Swizzle(..)
            | ExprKind::Case(..) => Err("it contains a sum, a list, or several numbers at once".to_owned()),
        }
    }

    /// A quotient. Of a divisor that is a product each factor is kept by itself, so that equal ones are seen.
    fn quotient(&mut self, over: Poly, under: &Expr, env: &Env) -> Result<Poly> {
        match &under.kind {
            ExprKind::Binary(BinaryOp::Multiply, a, b) => {
                let part = self.quotient(over, a, env)?;
                self.quotient(part, b, env)
            }
            ExprKind::Call(name, arguments) if name.value == "pow" && arguments.len() == 2 => {
                let exponent = self.expr(&arguments[1], env)?.constant().and_then(Rational::integer);
                match exponent {
                    Some(count @ 1..=8) => (0..count).try_fold(over, |part, _| self.quotient(part, &arguments[0], env)),
                    _ => Err("`pow` with an exponent that is no small number".to_owned()),
                }
            }
            _ => {
                let under = self.expr(under, env)?;
                over.over(&under).ok_or_else(too_large)
            }
        }
    }

    fn name(&mut self, name: &str, env: &Env) -> Result<Poly> {
        if let Some(value) = env.get(name) {
            return Ok(value.clone());
        }
        let table = self.table;
        if let Some(named) = table.names.iter().find(|named| named.name.value == name) {
            let value = self.expr(&named.value, env)?;
            let plain = |sum: &Poly| sum.0.keys().flat_map(Mono::keys).all(|atom| matches!(atom, Atom::Var(_)));
            return Ok(if self.integrands && !plain(&value) { Poly::var(name) } else { value });
        }
        match table.constants.iter().find(|constant| constant.name.value == name).map(|c| &c.value) {
            Some(ConstantValue::Number(value)) => self.expr(value, env),
            Some(ConstantValue::List(_) | ConstantValue::Levels { .. } | ConstantValue::File(..)) => {
                Err(format!("`{name}` is a list"))
            }
            None => Ok(Poly::var(name)),
        }
    }

    /// The names of mean and half difference of two bounds.
    fn bounds(&mut self, lo: Poly, hi: Poly) -> (String, String) {
        let number = self.bounds_number(lo, hi);
        let Bounds { mid, half, .. } = &self.bounds[number];
        (mid.clone(), half.clone())
    }

    /// The place of a pair of bounds among those met so far.
    pub(super) fn bounds_number(&mut self, lo: Poly, hi: Poly) -> usize {
        if let Some(known) = self.bounds.iter().position(|known| known.lo == lo && known.hi == hi) {
            return known;
        }
        let mid = self.taken.free(&["m", "mid", "mean", "centre"]);
        let half = self.taken.free(&["h", "halved", "reach"]);
        self.bounds.push(Bounds { lo, hi, mid, half });
        self.bounds.len() - 1
    }

    fn call(&mut self, name: &str, arguments: &[Expr], env: &Env) -> Result<Poly> {
        let table = self.table;
        if let Some(helper) = table.helpers.iter().find(|helper| helper.name.value == name) {
            let [line] = helper.lines.as_slice() else { return Err(format!("`{name}` has several lines")) };
            let mut inner = Env::new();
            for (parameter, argument) in helper.parameters.iter().zip(arguments) {
                inner.insert(parameter.value.clone(), self.expr(argument, env)?);
            }
            return self.expr(&line.value, &inner);
        }
        if let Some(function) = table.functions.iter().find(|function| function.name.value == name) {
            let mut set = Env::new();
            for (parameter, argument) in function.parameters.iter().zip(arguments) {
                set.insert(parameter.value.clone(), self.expr(argument, env)?);
            }
            return self.function_call(name, env, &set);
        }
        let arguments = arguments.iter().map(|a| self.expr(a, env)).collect::<Result<Vec<_>>>()?;
        match (name, arguments.as_slice()) {
            ("pow", [base, exponent]) => {
                let whole = exponent.constant().and_then(Rational::integer).filter(|e| (0..=8).contains(e));
                let Some(count) = whole else {
                    return Err("`pow` with an exponent that is no small number".to_owned());
                };
                (0..count).try_fold(Poly::whole(1), |p, _| p.times(base)).ok_or_else(too_large)
            }
            _ => Ok(Poly::atom(Atom::Fun(name.to_owned(), arguments))),
        }
    }

    /// A function of the table; parameters that are not set mean what they mean here.
    fn function_call(&mut self, name: &str, env: &Env, set: &Env) -> Result<Poly> {
        let table = self.table;
        let Some(function) = table.functions.iter().find(|function| function.name.value == name) else {
            return Err(format!("`{name}` belongs to another table"));
        };
        let mut inner = Env::new();
        for parameter in &function.parameters {
            let parameter = &parameter.value;
            let value = match set.get(parameter).or_else(|| env.get(parameter)) {
                Some(value) => value.clone(),
                None => self.name(parameter, env)?,
            };
            inner.insert(parameter.clone(), value);
        }
        if self.integrands {
            return self.integral_of(function, inner);
        }
        self.body(function, inner)
    }
}

/// Returns whether a function itself, and not only what it calls, divides by more than a number or takes a
/// difference between bounds.
pub(super) fn is_singular(table: &Table, function: &Function) -> bool {
    let FunctionBody::Value(value) = &function.body else { return false };
    let mut own: Vec<&Expr> = function.bindings.iter().map(|binding| &binding.value).chain([value]).collect();
    let mut seen: Vec<&str> = Vec::new();
    while let Some(expr) = own.pop() {
        match &expr.kind {
            ExprKind::Between(..) => return true,
            ExprKind::Binary(BinaryOp::Divide, _, under) if !is_number(under) => return true,
            ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) | ExprKind::Optional(a, b) => own.extend([&**a, &**b]),
            ExprKind::Unary(_, a) | ExprKind::Swizzle(a, _) | ExprKind::Sum(_, _, a) | ExprKind::In(a, _) => {
                own.push(a)
            }
            ExprKind::If(a, b, c) | ExprKind::Iterate(a, _, b, c) => own.extend([&**a, &**b, &**c]),
            ExprKind::Index(_, indices) => own.extend(indices),
            ExprKind::List(items) => own.extend(items),
            ExprKind::With(_, set) | ExprKind::Record(set) | ExprKind::Case(_, set) => {
                own.extend(set.iter().map(|(_, value)| value));
            }
            // Helpers and names are as if written here; functions speak for themselves.
            ExprKind::Call(name, items) => {
                own.extend(items);
                if let Some(helper) = table.helpers.iter().find(|h| h.name.value == name.value)
                    && !seen.contains(&helper.name.value.as_str())
                {
                    seen.push(&helper.name.value);
                    own.extend(helper.lines.iter().map(|line| &line.value));
                }
            }
            ExprKind::Name(name) => {
                if let Some(named) = table.names.iter().find(|n| n.name.value == *name)
                    && !seen.contains(&named.name.value.as_str())
                {
                    seen.push(&named.name.value);
                    own.push(&named.value);
                }
            }
            ExprKind::Number(_) | ExprKind::Level(..) => {}
        }
    }
    false
}

/// Returns whether an expression is a number without any name in it.
fn is_number(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(_) => true,
        ExprKind::Unary(_, a) => is_number(a),
        ExprKind::Binary(_, a, b) => is_number(a) && is_number(b),
        _ => false,
    }
}
