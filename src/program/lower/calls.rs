//! Calls: to whom a name belongs, and what of a term is asked for beside that.

use super::built_in::{self, check_arity};
use super::scope::Env;
use super::terms::{Call, Expected, Term, type_error};
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::operators::Operator;
use crate::program::pool::ExprId;
use crate::table::expr::Expr;
use crate::text::closest::nearest;

impl Lowering<'_> {
    /// A call of a function: of the language, of the table or of one that it imports, or of an operator.
    pub(super) fn call(&mut self, function: &Spanned<String>, call: Call<'_>) -> Result<Term> {
        let name = function.value.as_str();
        let language = self.scopes[call.env.scope].language.value;
        if let Some(built_in) = built_in::named(name).filter(|function| function.since <= language) {
            return self.built_in(built_in, call);
        }
        if let Some(callee) = self.callee(name, call.env.scope) {
            return self.call_in_order(callee, call.arguments, call.span, call.env);
        }
        if let Some(table) = self.called_table(name, call.env.scope) {
            return self.table_in_order(table, call.arguments, call.span, call.env);
        }
        if let Some(fetch) = self.fetch_named(name, call.env) {
            return self.fetch(fetch, call.arguments, call.span, call.env);
        }
        let Some(op) = Operator::named(name) else { return Err(self.unknown_function(function, call.env)) };
        let operand = |me: &mut Self, index: usize| me.term(&call.arguments[index], call.env, Expected::Anything);
        match op {
            Operator::Unary(op) => {
                check_arity(name, 1, call)?;
                let a = operand(self, 0)?;
                // What claims an accuracy cannot rely on a sine that may be off by 2^-11.
                let portable = op.row().portable.filter(|_| self.portable);
                self.map1(portable.unwrap_or(op), a, call.span)
            }
            Operator::Binary(op) => {
                check_arity(name, 2, call)?;
                let (a, b) = (operand(self, 0)?, operand(self, 1)?);
                self.map2(op, a, b, call.span)
            }
            Operator::Ternary(op) => {
                check_arity(name, 3, call)?;
                let (a, b, c) = (operand(self, 0)?, operand(self, 1)?, operand(self, 2)?);
                self.map3(op, a, b, c, call.span)
            }
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
            Term::Number(number) | Term::Whole(number) => Ok(Term::Number(number)),
            Term::Word(word) => Ok(Term::Number(self.number_of_word(word))),
            Term::Level(set, _) if self.is_wide(set) => Err(self.too_wide(set, argument.span)),
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

    /// `index(level)`, `index(condition)`.
    pub(super) fn index_of(&mut self, argument: &Expr, env: &Env) -> Result<Term> {
        match self.term(argument, env, Expected::Anything)? {
            Term::Level(set, _) if self.is_wide(set) => Err(self.too_wide(set, argument.span)),
            Term::Level(set, term) => Ok(Term::Whole(self.level_number(set, &term, |_, level| f64::from(level)))),
            Term::Bool(condition) => self.count(&[condition], argument.span),
            other @ (Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::List(_)
            | Term::Record(_)) => {
                Err(type_error(argument.span, &self.describe(&other), "expected a level or a condition"))
            }
        }
    }

    pub(super) fn unknown_function(&self, function: &Spanned<String>, env: &Env) -> Diagnostic {
        if let Some(built_in) = built_in::named(&function.value)
            && let Err(error) = self.table.since(built_in.since, function.span, &format!("`{}`", built_in.name))
        {
            return error;
        }
        let mut own = self.callable(env.scope);
        own.extend(self.fetches_in_sight(env).map(str::to_owned));
        let known = || own.iter().map(String::as_str).chain(built_in::signatures().map(|function| function.name));
        let error = Diagnostic::error(codes::CALL, format!("there is no function `{}`", function.value))
            .at(function.span, "unknown function");
        match nearest(&function.value, known()) {
            Some(close) => error.did_you_mean(&function.value, close),
            None => error.help(format!("the functions are: {}", known().collect::<Vec<_>>().join(", "))),
        }
    }
}

/// Refuses names that a call gives to nothing, or gives twice; `kind` is what those of the callee are.
pub(super) fn check_given(callee: &str, kind: &str, known: &[&str], given: &[(Spanned<String>, Expr)]) -> Result<()> {
    for (index, (name, _)) in given.iter().enumerate() {
        if !known.contains(&name.value.as_str()) {
            let error = Diagnostic::error(codes::PARAMETER, format!("`{callee}` has no {kind} `{}`", name.value))
                .at(name.span, format!("unknown {kind}"));
            return Err(match nearest(&name.value, known.iter().copied()) {
                Some(close) => error.did_you_mean(&name.value, close),
                None => error.help(format!("the {kind}s are: {}", known.join(", "))),
            });
        }
        if let Some((first, _)) = given[..index].iter().find(|(other, _)| other.value == name.value) {
            return Err(Diagnostic::error(codes::DUPLICATE, format!("`{}` is given twice", name.value))
                .at(name.span, "again")
                .at(first.span, "first here"));
        }
    }
    Ok(())
}
