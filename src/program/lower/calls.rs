//! Functions, and operations component by component. Vectors end here: they
//! are expanded by WGSL's definitions of the functions.

use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::operators::{BinaryOp, Operator, TernaryOp, UnaryOp};
use crate::program::pool::{ExprId, Node};
use crate::table::expr::Expr;
use crate::text::closest::nearest;

/// Functions that are not operations on numbers.
pub(super) const BUILT_IN: [&str; 12] =
    ["f32", "select", "vec2", "vec3", "vec4", "dot", "length", "distance", "normalize", "cross", "poly", "sum"];

impl Lowering<'_> {
    pub(super) fn call(
        &mut self,
        function: &Spanned<String>,
        arguments: &[Expr],
        span: Span,
        env: &Env,
        expected: Expected,
    ) -> Result<Term> {
        let name = function.value.as_str();
        let arity = |expected: usize| -> Result<()> {
            if arguments.len() == expected {
                return Ok(());
            }
            let plural = if expected == 1 { "" } else { "s" };
            Err(Diagnostic::error(
                codes::CALL,
                format!("`{name}` takes {expected} argument{plural}, not {}", arguments.len()),
            )
            .at(span, "wrong number of arguments"))
        };
        match name {
            "f32" => {
                arity(1)?;
                return self.number_of(&arguments[0], env);
            }
            "select" => {
                arity(3)?;
                let condition = self.condition(&arguments[2], env)?;
                let (other, then) = self.alternatives(&arguments[0], &arguments[1], env, expected)?;
                return self.choose(condition, then, other, span);
            }
            _ => {}
        }
        if name == "poly" {
            return self.polynomial(arguments, span, env);
        }
        if let Some(callee) = self.callee(name, env.scope) {
            return self.call_in_order(callee, arguments, span, env);
        }
        match Operator::named(name) {
            Some(Operator::Unary(op)) => {
                arity(1)?;
                let a = self.term(&arguments[0], env, Expected::Anything)?;
                // What claims an accuracy cannot rely on a sine that may be off by 2^-11.
                let portable = op.row().portable.filter(|_| self.portable);
                self.map1(portable.unwrap_or(op), a, span)
            }
            Some(Operator::Binary(op)) => {
                arity(2)?;
                let a = self.term(&arguments[0], env, Expected::Anything)?;
                let b = self.term(&arguments[1], env, Expected::Anything)?;
                self.map2(op, a, b, span)
            }
            Some(Operator::Ternary(op)) => {
                arity(3)?;
                let terms = [0, 1, 2].map(|i| self.term(&arguments[i], env, Expected::Anything));
                let [a, b, c] = terms;
                self.map3(op, a?, b?, c?, span)
            }
            None => self.vector_call(function, arguments, span, env, arity),
        }
    }

    pub(super) fn map1(&mut self, op: UnaryOp, a: Term, span: Span) -> Result<Term> {
        match a {
            Term::Number(a) => Ok(Term::Number(self.unary(op, a, span)?)),
            Term::Vector(parts) => {
                Ok(Term::Vector(parts.into_iter().map(|a| self.unary(op, a, span)).collect::<Result<_>>()?))
            }
            Term::Record(parts) => {
                let parts = parts.into_iter().map(|(name, a)| Ok((name, self.map1(op, a, span)?)));
                Ok(Term::Record(parts.collect::<Result<_>>()?))
            }
            other @ (Term::Bool(_) | Term::Level(..) | Term::List(_)) => Err(self.no_number(&other, span)),
        }
    }

    /// An operation on one number. In a function that is called with constants,
    /// what they make constant is computed when the shader runs, unless the result is bit-identical.
    fn unary(&mut self, op: UnaryOp, a: ExprId, span: Span) -> Result<ExprId> {
        let result = match self.calling.is_empty() {
            true => self.pool.unary(op, a),
            false => self.pool.rebuild(Node::Unary(op, a)),
        };
        self.finite(result, span)
    }

    fn binary_operation(&mut self, op: BinaryOp, a: ExprId, b: ExprId, span: Span) -> Result<ExprId> {
        let result = match self.calling.is_empty() {
            true => self.pool.binary(op, a, b),
            false => self.pool.rebuild(Node::Binary(op, a, b)),
        };
        self.finite(result, span)
    }

    pub(super) fn map2(&mut self, op: BinaryOp, a: Term, b: Term, span: Span) -> Result<Term> {
        // Records go with records of the same names, and with numbers.
        match (&a, &b) {
            (Term::Record(x), Term::Record(y)) if !x.iter().map(|p| &p.0).eq(y.iter().map(|p| &p.0)) => {
                let message = format!("{} and {} do not go together", self.describe(&a), self.describe(&b));
                return Err(Diagnostic::error(codes::TYPE, message).at(span, "in this operation"));
            }
            (Term::Record(x), Term::Record(y)) => {
                let pairs = x.iter().zip(y);
                let pairs =
                    pairs.map(|((name, a), (_, b))| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(pairs.collect::<Result<_>>()?));
            }
            (Term::Record(x), Term::Number(_)) => {
                let parts = x.iter().map(|(name, a)| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(parts.collect::<Result<_>>()?));
            }
            (Term::Number(_), Term::Record(y)) => {
                let parts = y.iter().map(|(name, b)| Ok((name.clone(), self.map2(op, a.clone(), b.clone(), span)?)));
                return Ok(Term::Record(parts.collect::<Result<_>>()?));
            }
            _ => {}
        }
        let mut parts = Vec::new();
        let (a, b, scalar) = self.broadcast(a, b, span)?;
        for (a, b) in a.into_iter().zip(b) {
            parts.push(self.binary_operation(op, a, b, span)?);
        }
        Ok(if scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    pub(super) fn map3(&mut self, op: TernaryOp, a: Term, b: Term, c: Term, span: Span) -> Result<Term> {
        let (b, c, scalar) = self.broadcast(b, c, span)?;
        let wrap = |parts: Vec<ExprId>| if parts.len() == 1 { Term::Number(parts[0]) } else { Term::Vector(parts) };
        let (a, b, also_scalar) = self.broadcast(a, wrap(b), span)?;
        let n = a.len();
        let c = if c.len() == 1 { vec![c[0]; n] } else { c };
        if c.len() != n {
            return Err(type_error(span, "vectors of different sizes", "operands must have the same size"));
        }
        let mut parts = Vec::new();
        for ((a, b), c) in a.into_iter().zip(b).zip(c) {
            if let Some((lo, hi)) = op.misordered([a, b, c].map(|part| self.pool.constant(part))) {
                return Err(Diagnostic::error(
                    codes::DOMAIN,
                    format!("the lower bound {lo} is not below the upper bound {hi}"),
                )
                .at(span, "shading languages leave this undefined"));
            }
            let result = match self.calling.is_empty() {
                true => self.pool.ternary(op, a, b, c),
                false => self.pool.rebuild(Node::Ternary(op, a, b, c)),
            };
            parts.push(self.finite(result, span)?);
        }
        Ok(if scalar && also_scalar { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// Components of two operands; a number goes with a vector of any size.
    pub(super) fn broadcast(&self, a: Term, b: Term, span: Span) -> Result<(Vec<ExprId>, Vec<ExprId>, bool)> {
        match (a, b) {
            (Term::Number(a), Term::Number(b)) => Ok((vec![a], vec![b], true)),
            (Term::Vector(a), Term::Number(b)) => {
                let n = a.len();
                Ok((a, vec![b; n], false))
            }
            (Term::Number(a), Term::Vector(b)) => Ok((vec![a; b.len()], b, false)),
            (Term::Vector(a), Term::Vector(b)) if a.len() == b.len() => Ok((a, b, false)),
            (a @ (Term::Number(_) | Term::Vector(_)), b) | (b, a @ (Term::Number(_) | Term::Vector(_))) => {
                let message = format!("{} and {} do not go together", self.describe(&a), self.describe(&b));
                let error = Diagnostic::error(codes::TYPE, message).at(span, "in this operation");
                Err(match b {
                    Term::Level(..) | Term::Bool(_) => {
                        error.help("`f32(...)` gives the number of a level or condition")
                    }
                    Term::Number(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => error,
                })
            }
            (a, _) => Err(self.no_number(&a, span)),
        }
    }

    pub(super) fn swizzle(&mut self, value: Term, letters: &str, span: Span) -> Result<Term> {
        if let Term::Record(parts) = &value
            && let Some((_, part)) = parts.iter().find(|(name, _)| name == letters)
        {
            return Ok(part.clone());
        }
        if let Term::Record(parts) = &value {
            let known = parts.iter().map(|(name, _)| name.as_str());
            let error = Diagnostic::error(codes::TYPE, format!("the record has no `{letters}`"));
            return Err(error.at(span, "not in it").help(format!("it has {}", known.collect::<Vec<_>>().join(", "))));
        }
        let Term::Vector(parts) = &value else {
            return Err(type_error(span, &self.describe(&value), "only vectors have components"));
        };
        // All letters come from one of the two alphabets, as in every shading language.
        let picked = ["xyzw", "rgba"].into_iter().find_map(|alphabet| {
            let pick = |letter: char| alphabet.find(letter).and_then(|i| parts.get(i).copied());
            letters.chars().map(pick).collect::<Option<Vec<ExprId>>>()
        });
        match picked {
            Some(picked) if picked.len() == 1 => Ok(Term::Number(picked[0])),
            Some(picked) if (2..=4).contains(&picked.len()) => Ok(Term::Vector(picked)),
            _ => Err(Diagnostic::error(codes::TYPE, format!("`.{letters}` is not a component"))
                .at(span, format!("of {}", self.describe(&value)))
                .help("components are one to four of `xyzw`, or of `rgba`, as far as the vector has them")),
        }
    }

    /// `f32(level)`, `f32(condition)`, `f32(number)`.
    pub(super) fn number_of(&mut self, argument: &Expr, env: &Env) -> Result<Term> {
        match self.term(argument, env, Expected::Anything)? {
            Term::Number(number) => Ok(Term::Number(number)),
            Term::Level(set, term) => {
                Ok(Term::Number(self.level_number(set, &term, |me, level| me.sets[set.0].codes[usize::from(level)])))
            }
            Term::Bool(condition) => {
                let (one, zero) = (self.pool.number(1.0), self.pool.number(0.0));
                Ok(Term::Number(self.pool.select(condition, one, zero)))
            }
            other @ (Term::Vector(_) | Term::List(_) | Term::Record(_)) => {
                Err(type_error(argument.span, &self.describe(&other), "expected a level, a condition or a number"))
            }
        }
    }

    /// Vectors are expanded here, by WGSL's definitions of the functions.
    pub(super) fn vector_call(
        &mut self,
        function: &Spanned<String>,
        arguments: &[Expr],
        span: Span,
        env: &Env,
        arity: impl Fn(usize) -> Result<()>,
    ) -> Result<Term> {
        let name = function.value.as_str();
        let size = match name {
            "vec2" => Some(2),
            "vec3" => Some(3),
            "vec4" => Some(4),
            "dot" | "distance" | "cross" => {
                arity(2)?;
                None
            }
            "length" | "normalize" => {
                arity(1)?;
                None
            }
            _ => return Err(self.unknown_function(function, env)),
        };
        let mut terms = Vec::new();
        for argument in arguments {
            terms.push(match self.term(argument, env, Expected::Anything)? {
                Term::Number(number) => vec![number],
                Term::Vector(parts) => parts,
                other @ (Term::Bool(_) | Term::Level(..) | Term::List(_) | Term::Record(_)) => {
                    return Err(self.no_number(&other, argument.span));
                }
            });
        }
        if let Some(size) = size {
            let mut parts: Vec<ExprId> = terms.concat();
            if parts.len() == 1 {
                parts = vec![parts[0]; size];
            }
            if parts.len() != size {
                return Err(Diagnostic::error(
                    codes::CALL,
                    format!("`{name}` needs {size} components, not {}", parts.len()),
                )
                .at(span, "wrong number of components"));
            }
            return Ok(Term::Vector(parts));
        }
        if terms.len() == 2 && terms[0].len() != terms[1].len() {
            return Err(type_error(span, "vectors of different sizes", "operands must have the same size"));
        }
        match name {
            "dot" => Ok(Term::Number(self.dot(&terms[0], &terms[1]))),
            "length" => Ok(Term::Number(self.length(&terms[0]))),
            "distance" => {
                let pairs = terms[0].iter().zip(&terms[1]);
                let difference: Vec<_> = pairs.map(|(a, b)| self.pool.binary(BinaryOp::Subtract, *a, *b)).collect();
                Ok(Term::Number(self.length(&difference)))
            }
            "normalize" => {
                let length = self.length(&terms[0]);
                let parts = terms[0].iter().map(|a| self.pool.binary(BinaryOp::Divide, *a, length));
                Ok(Term::Vector(parts.collect()))
            }
            _ if terms[0].len() == 3 => {
                let (a, b) = (&terms[0], &terms[1]);
                let mut part = |i: usize, j: usize| {
                    let (x, y) = (
                        self.pool.binary(BinaryOp::Multiply, a[i], b[j]),
                        self.pool.binary(BinaryOp::Multiply, a[j], b[i]),
                    );
                    self.pool.binary(BinaryOp::Subtract, x, y)
                };
                Ok(Term::Vector(vec![part(1, 2), part(2, 0), part(0, 1)]))
            }
            _ => Err(type_error(span, "a vector of another size", "`cross` needs vectors of 3")),
        }
    }

    pub(super) fn dot(&mut self, a: &[ExprId], b: &[ExprId]) -> ExprId {
        let mut sum = self.pool.binary(BinaryOp::Multiply, a[0], b[0]);
        for (x, y) in a.iter().zip(b).skip(1) {
            let product = self.pool.binary(BinaryOp::Multiply, *x, *y);
            sum = self.pool.binary(BinaryOp::Add, sum, product);
        }
        sum
    }

    pub(super) fn length(&mut self, a: &[ExprId]) -> ExprId {
        if let [only] = a {
            return self.pool.unary(UnaryOp::Abs, *only);
        }
        let square = self.dot(a, a);
        self.pool.unary(UnaryOp::Sqrt, square)
    }

    pub(super) fn unknown_function(&self, function: &Spanned<String>, env: &Env) -> Diagnostic {
        let own = self.callable(env.scope);
        let known = || {
            let named = Operator::functions().map(|(name, _)| name).chain(BUILT_IN);
            own.iter().map(String::as_str).chain(named)
        };
        let error = Diagnostic::error(codes::CALL, format!("there is no function `{}`", function.value))
            .at(function.span, "unknown function");
        match nearest(&function.value, known()) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => error.help(format!("the functions are: {}", known().collect::<Vec<_>>().join(", "))),
        }
    }
}
