//! Fetches with arguments: one declaration, and an input for each tuple of arguments that occurs.
//!
//! Arguments are constants, so `light(0, 1)` is an input like any other by the time that anything
//! but its name is asked for. Calls with equal arguments are one input, and one fetch.

use std::collections::HashMap;

use super::scope::Env;
use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::bits::InputSet;
use crate::program::domain::{FetchCall, Input};
use crate::program::pool::{ExprId, Node};
use crate::program::{InputId, Real};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{self, names, parse};

/// Most arguments of a fetch.
const MAX_ARGUMENTS: usize = 8;

/// Most operations that are carried out to know an argument.
const MAX_OPERATIONS: u32 = 10_000;

/// A fetch with arguments.
pub(super) struct Fetch<'t> {
    declared: &'t table::Input,
    /// The input that each call is, but for the call.
    common: Input,
    set: Option<SetId>,
    /// The inputs so far, by the bits of their arguments.
    calls: HashMap<Vec<u32>, InputId>,
}

impl Fetch<'_> {
    /// Returns whether this is its name.
    pub(super) fn is_called(&self, name: &str) -> bool {
        self.declared.name.value == name
    }

    /// The set of its levels; none of a range.
    pub(super) fn set(&self) -> Option<SetId> {
        self.set
    }

    /// Says of a name that stands alone how it is called.
    pub(super) fn needs_arguments(&self, error: Diagnostic) -> Diagnostic {
        let zeros = vec!["0"; self.declared.parameters.len()].join(", ");
        let name = &self.declared.name;
        error
            .at(name.span, "is fetched with arguments")
            .help(format!("each call is an input of its own, `{}({zeros})` for instance", name.value))
    }
}

impl<'t> Lowering<'t> {
    /// Declares a fetch with arguments.
    pub(super) fn declare_fetch(&mut self, input: &'t table::Input) -> Result<()> {
        let name = &input.name;
        if input.fetched.is_none() {
            return Err(Diagnostic::error(
                codes::DOMAIN,
                format!("`{}` has arguments, but is not fetched", name.value),
            )
            .at(name.span, "only a fetch takes arguments")
            .help("add `fetched: (cost: 1)`, or leave the parentheses out"));
        }
        if let Some(beyond) = input.parameters.get(MAX_ARGUMENTS) {
            let message = format!("a fetch takes at most {MAX_ARGUMENTS} arguments");
            return Err(Diagnostic::error(codes::DOMAIN, message).at(beyond.span, "one too many"));
        }
        for (index, parameter) in input.parameters.iter().enumerate() {
            names::check(&parameter.value, "an argument", parameter.span)?;
            if parameter.value.contains('.') {
                return Err(Diagnostic::error(codes::BAD_NAME, "the name of an argument contains no dot")
                    .at(parameter.span, "dots group inputs"));
            }
            if let Some(first) = input.parameters[..index].iter().find(|other| other.value == parameter.value) {
                return Err(Diagnostic::error(
                    codes::DUPLICATE,
                    format!("two arguments are called `{}`", parameter.value),
                )
                .at(parameter.span, "again")
                .at(first.span, "first here"));
            }
        }
        let helper = self.table.helpers.iter().find(|helper| helper.name.value == name.value);
        if let Some(helper) = helper {
            return Err(Diagnostic::error(codes::DUPLICATE, format!("two things are called as `{}(...)`", name.value))
                .at(helper.name.span, "a helper")
                .at(name.span, "a fetch"));
        }
        if super::signatures().any(|function| function.name == name.value) {
            let message = format!("`{}` is a function of the language", name.value);
            return Err(Diagnostic::error(codes::RESERVED_NAME, message).at(name.span, "choose another name"));
        }
        let (common, set) = self.checked_input(input)?;
        self.fetches.push(Fetch { declared: input, common, set, calls: HashMap::new() });
        Ok(())
    }

    /// The fetch that a name calls, where inputs are in sight.
    pub(super) fn fetch_named(&self, name: &str, env: &Env) -> Option<usize> {
        let in_sight = env.scope == 0 && env.parameters.is_none() && env.constants.is_none();
        self.fetches.iter().position(|fetch| fetch.is_called(name)).filter(|_| in_sight)
    }

    /// The names of the fetches with arguments that can be called.
    pub(super) fn fetches_in_sight(&self, env: &Env) -> impl Iterator<Item = &'t str> {
        let known = self.fetches.iter().map(|fetch| fetch.declared.name.value.as_str());
        known.filter(|name| self.fetch_named(name, env).is_some()).collect::<Vec<_>>().into_iter()
    }

    /// `light(0, 1)`
    pub(super) fn fetch(&mut self, fetch: usize, arguments: &[Expr], span: Span, env: &Env) -> Result<Term> {
        let mut known = Vec::new();
        for argument in arguments {
            let parts = match self.term(argument, env, Expected::Anything)? {
                Term::Number(number) | Term::Whole(number) => vec![number],
                Term::Vector(parts) => parts,
                other @ (Term::Word(_) | Term::Bool(_) | Term::Level(..) | Term::List(_) | Term::Record(_)) => {
                    return Err(self.no_number(&other, argument.span));
                }
            };
            for part in parts {
                known.push(self.known_argument(part, fetch, argument.span)?);
            }
        }
        let input = self.call_of(fetch, known, span)?;
        Ok(self.input_term(input, env))
    }

    /// `light(dx = 0, dy = 1)`
    pub(super) fn fetch_with(
        &mut self,
        fetch: usize,
        given: &[(Spanned<String>, Expr)],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let declared = self.fetches[fetch].declared;
        let name = &declared.name.value;
        if let Some((unknown, _)) = given.iter().find(|(n, _)| !declared.parameters.iter().any(|p| p.value == n.value))
        {
            let known: Vec<&str> = declared.parameters.iter().map(|p| p.value.as_str()).collect();
            let message = format!("`{name}` has no argument `{}`", unknown.value);
            return Err(Diagnostic::error(codes::PARAMETER, message)
                .at(unknown.span, "unknown argument")
                .help(format!("the arguments are: {}", known.join(", "))));
        }
        let mut ordered = Vec::new();
        for parameter in &declared.parameters {
            let mut found = given.iter().filter(|(n, _)| n.value == parameter.value);
            match (found.next(), found.next()) {
                (Some((_, value)), None) => ordered.push(value.clone()),
                (Some((first, _)), Some((again, _))) => {
                    let message = format!("`{}` is given twice", parameter.value);
                    let error = Diagnostic::error(codes::DUPLICATE, message);
                    return Err(error.at(again.span, "again").at(first.span, "first here"));
                }
                (None, _) => {
                    let message = format!("`{name}` needs `{}`, which is not given", parameter.value);
                    return Err(Diagnostic::error(codes::PARAMETER, message).at(span, "in this call"));
                }
            }
        }
        self.fetch(fetch, &ordered, span, env)
    }

    /// The value of an argument.
    fn known_argument(&self, part: ExprId, fetch: usize, span: Span) -> Result<f32> {
        let facts = self.pool.expr_facts(part);
        let known = match facts.inputs.is_empty() && facts.size <= MAX_OPERATIONS {
            true => self.closed(part).filter(|value| value.is_finite()),
            false => None,
        };
        known.map(|value| value + 0.0).ok_or_else(|| {
            let name = &self.fetches[fetch].declared.name.value;
            let label = if facts.inputs == InputSet::default() { "not a finite constant" } else { "depends on inputs" };
            Diagnostic::error(codes::NOT_CONSTANT, format!("an argument of `{name}` is not constant"))
                .at(span, label)
                .help("each call is an input of its own, so its arguments are constants, counting variables of sums, or items of lists")
        })
    }

    /// The value, in `f32`, of an expression without inputs that was left as it is.
    fn closed(&self, expr: ExprId) -> Option<f32> {
        Some(match self.pool.node(expr) {
            Node::Const(number) => number.get() as f32,
            Node::Word(word) => f32::from_word(word),
            Node::Unary(op, a) => f32::unary(op, self.closed(a)?),
            Node::Binary(op, a, b) => f32::binary(op, self.closed(a)?, self.closed(b)?),
            Node::Ternary(op, a, b, c) => f32::ternary(op, self.closed(a)?, self.closed(b)?, self.closed(c)?),
            Node::Input(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => return None,
        })
    }

    /// The input that a call is.
    fn call_of(&mut self, fetch: usize, arguments: Vec<f32>, span: Span) -> Result<InputId> {
        let Fetch { declared, common, set, calls } = &self.fetches[fetch];
        if arguments.len() != declared.parameters.len() {
            let parameters: Vec<&str> = declared.parameters.iter().map(|p| p.value.as_str()).collect();
            let plural = if parameters.len() == 1 { "" } else { "s" };
            let (name, count) = (&declared.name.value, parameters.len());
            let message = format!("`{name}` takes {count} argument{plural}, not {}", arguments.len());
            return Err(Diagnostic::error(codes::CALL, message).at(span, "wrong number of arguments").help(format!(
                "it is called as `{name}({})`; a vector counts as its components",
                parameters.join(", ")
            )));
        }
        let key: Vec<u32> = arguments.iter().map(|argument| argument.to_bits()).collect();
        if let Some(known) = calls.get(&key) {
            return Ok(*known);
        }
        if self.inputs.len() == InputSet::CAPACITY {
            let message = format!("more than {} inputs, each call of a fetch counted as one", InputSet::CAPACITY);
            return Err(Diagnostic::error(codes::DOMAIN, message)
                .at(span, "one too many")
                .at(declared.name.span, format!("called with {} different arguments so far", calls.len())));
        }
        let call = FetchCall {
            function: declared.name.value.clone(),
            ident: common.ident.clone(),
            parameters: declared.parameters.iter().map(|p| p.value.clone()).collect(),
            arguments,
        };
        let ident = self.call_ident(&call, calls.len());
        let input = Input { name: call.name(), ident, call: Some(call), ..common.clone() };
        let (set, id) = (*set, InputId::new(self.inputs.len()));
        if set.is_none() {
            input.domain.declare(id, &mut self.pool);
        }
        self.input_sets.push(set);
        self.inputs.push(input);
        self.fetches[fetch].calls.insert(key, id);
        Ok(id)
    }

    /// The name in generated code of what a call fetches: `light_at_0_m1` is that of `light(0, -1)`.
    fn call_ident(&self, call: &FetchCall, number: usize) -> String {
        let part = |argument: &f32| argument.to_string().replace('-', "m").replace('.', "p");
        let parts: Vec<String> = call.arguments.iter().map(part).collect();
        let mut ident = format!("{}_at_{}", call.ident, parts.join("_"));
        if ident.len() > names::MAX_LENGTH {
            ident = format!("{}_number_{number}", call.ident);
        }
        let declared = || self.table.inputs.iter().map(|input| names::identifier(&input.name.value));
        while declared().any(|other| other == ident) || self.inputs.iter().any(|other| other.ident == ident) {
            ident += "_other";
        }
        ident
    }

    /// The input that a text in a declaration means: its name, or a call of a fetch.
    pub(super) fn input_written(&mut self, name: &Spanned<String>) -> Result<Option<InputId>> {
        let Some((word, _)) = name.value.split_once('(') else { return Ok(self.input_named(&name.value)) };
        let Some(fetch) = self.fetch_named(word.trim_end(), &Env::default()) else { return Ok(None) };
        // Its text stands in quotes.
        let call = parse::expression(&name.value, name.span.start + 1)?;
        let ExprKind::Call(_, arguments) = &call.kind else { return Ok(None) };
        let known = arguments.iter().map(|argument| {
            let number = self.numeric(argument, &Env::default())?;
            self.known_argument(number, fetch, argument.span)
        });
        let known = known.collect::<Result<Vec<_>>>()?;
        self.call_of(fetch, known, call.span).map(Some)
    }

    /// The input with a name, calls among them that were met before.
    pub(super) fn input_or_call(&self, name: &str) -> Option<InputId> {
        let called = || self.inputs.iter().position(|input| input.is_called(name)).map(InputId::new);
        self.input_named(name).or_else(called)
    }

    /// The fetches with arguments that nothing calls.
    pub(super) fn unused_fetches(&self) -> Vec<Spanned<String>> {
        let unused = self.fetches.iter().filter(|fetch| fetch.calls.is_empty());
        unused.map(|fetch| fetch.declared.name.clone()).collect()
    }
}
