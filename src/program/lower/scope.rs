//! The meaning of names at some point: locals, inputs (perhaps replaced), named
//! values, and what to say of a name that means nothing.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::Domain;
use crate::program::bits::LevelSet;
use crate::program::{InputId, LevelTerm};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{self, Output, names};
use crate::text::closest::nearest;

/// The meaning of names at some point.
#[derive(Clone, Default)]
pub(super) struct Env {
    /// Inputs that mean something else here.
    pub(super) overrides: Rc<HashMap<InputId, Term>>,
    /// The terms of named values under these overrides.
    pub(super) names: Rc<RefCell<HashMap<usize, Term>>>,
    /// Names bound by `let`, innermost last.
    pub(super) locals: Vec<(Spanned<String>, Term)>,
    /// The cases that are being lowered, outermost first.
    pub(super) cases: Vec<u32>,
    /// True if this is the value of a referenced case, where no further reference is allowed.
    pub(super) referenced: bool,
    /// In a function that is called: its parameters, which take the place of the inputs.
    pub(super) parameters: Option<Rc<Vec<(String, Term)>>>,
    /// The table that names are of: this one, or one that it imports.
    pub(super) scope: usize,
    /// In constant data: how many constants can be used, those declared before.
    pub(super) constants: Option<usize>,
}

impl Env {
    /// The environment of a row of its own.
    pub(super) fn of_case(id: u32) -> Self {
        Self { cases: vec![id], ..Self::default() }
    }

    /// The same environment with one more name.
    pub(super) fn with_local(&self, name: &Spanned<String>, term: Term) -> Self {
        let mut env = self.clone();
        env.locals.push((name.clone(), term));
        env
    }
}

impl Lowering<'_> {
    pub(super) fn name(&mut self, name: &str, span: Span, env: &Env, expected: Expected) -> Result<Term> {
        match name {
            "true" => return Ok(Term::Bool(self.pool.always(true))),
            "false" => return Ok(Term::Bool(self.pool.always(false))),
            _ => {}
        }
        if let Some(term) = self.resolve(name, env)? {
            return Ok(term);
        }
        // `v.xy`, `r.at.x`: parts of something that has a name, the longest that means something.
        for (dot, _) in name.rmatch_indices('.') {
            if let Some(term) = self.resolve(&name[..dot], env)? {
                return name[dot + 1..].split('.').try_fold(term, |term, part| self.swizzle(term, part, span));
            }
        }
        // A level, where one is expected. Where all cases count, an item stands for the list of it alone.
        let item = if let Expected::Result(output) = &expected
            && let Output::List { of, .. } = &**output
            && let Output::Enumeration(set) = **of
            && self.collects()
        {
            Some(set)
        } else if let Expected::Level(set) = expected {
            Some(set)
        } else {
            None
        };
        if let Some(set) = item {
            return match self.sets[set.0].find(name) {
                Some(level) => Ok(self.level_of(set, LevelTerm::Const(level))),
                None => Err(self.unknown_level(set, name, span)),
            };
        }
        Err(self.unknown_name(name, span, env))
    }

    pub(super) fn resolve(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        if let Some((_, term)) = env.locals.iter().rev().find(|(local, _)| local.value == name) {
            return Ok(Some(term.clone()));
        }
        match &env.parameters {
            Some(parameters) => {
                if let Some((_, term)) = parameters.iter().find(|(parameter, _)| parameter == name) {
                    return Ok(Some(term.clone()));
                }
            }
            None => {
                if let Some(input) = self.input_named(name) {
                    return Ok(Some(self.input_term(input, env)));
                }
            }
        }
        if let Some(term) = self.named_constant(name, env)? {
            return Ok(Some(term));
        }
        match self.named(name, env)? {
            Some(term) => Ok(Some(term)),
            None => self.imported_constant(name, env),
        }
    }

    /// Refuses local names that are malformed or that would hide something.
    pub(super) fn check_local(&self, name: &Spanned<String>, env: &Env) -> Result<()> {
        names::check(&name.value, "a local value", name.span)?;
        if name.value.contains('.') {
            return Err(Diagnostic::error(codes::BAD_NAME, "the name of a local value contains no dot")
                .at(name.span, "dots group inputs"));
        }
        let table = self.scopes[env.scope];
        let locals = env.locals.iter().map(|(local, _)| (local, "a local value"));
        // In a function only its own parameters are in sight; a helper's are no inputs.
        let visible = |name: &str| env.parameters.as_ref().is_none_or(|all| all.iter().any(|(p, _)| p == name));
        let inputs = table.inputs.iter().map(|input| (&input.name, "an input")).filter(|(n, _)| visible(&n.value));
        let helpers =
            table.helpers.iter().filter(|helper| self.calling.last() == Some(&(env.scope, &helper.name.value)));
        let parameters = helpers.flat_map(|helper| &helper.parameters).map(|name| (name, "a parameter"));
        let constants = table.constants.iter().map(|constant| (&constant.name, "a constant"));
        let named = table.names.iter().map(|named| (&named.name, "a named value"));
        match locals
            .chain(parameters)
            .chain(inputs)
            .chain(constants)
            .chain(named)
            .find(|(other, _)| names::identifier(&other.value) == name.value)
        {
            None => Ok(()),
            Some((first, what)) => {
                Err(Diagnostic::error(codes::DUPLICATE, format!("the name `{}` is taken", name.value))
                    .at(name.span, "a local value would hide it")
                    .at(first.span, format!("first used for {what} here")))
            }
        }
    }

    /// Returns whether a name stands for something by itself, as levels do not.
    pub(super) fn is_defined(&self, name: &str, env: &Env) -> bool {
        let known = match &env.parameters {
            Some(parameters) => parameters.iter().any(|(parameter, _)| parameter == name),
            None => self.input_named(name).is_some(),
        };
        known
            || env.locals.iter().any(|(local, _)| local.value == name)
            || self.scopes[env.scope].names.iter().any(|named| named.name.value == name)
            || self.scopes[env.scope].constants.iter().any(|constant| constant.name.value == name)
    }

    /// Returns whether a name stands for something, or for a part of something.
    pub(super) fn has_meaning(&self, name: &str, env: &Env) -> bool {
        self.is_defined(name, env) || name.match_indices('.').any(|(dot, _)| self.is_defined(&name[..dot], env))
    }

    pub(super) fn input_named(&self, name: &str) -> Option<InputId> {
        self.input_index.get(name).copied()
    }

    /// The meaning of an input in an environment.
    pub(super) fn input_term(&mut self, input: InputId, env: &Env) -> Term {
        if let Some(term) = env.overrides.get(&input) {
            return term.clone();
        }
        match self.input_sets[input.index()] {
            None if self.inputs[input.index()].domain == Domain::Word => Term::Word(self.pool.input(input)),
            None => Term::Number(self.pool.input(input)),
            Some(SetId::BOOL) => Term::Bool(self.pool.level(input, LevelSet::one(1), 2)),
            Some(set) => self.level_of(set, LevelTerm::Input(input)),
        }
    }

    /// A condition or value with a name of its own.
    pub(super) fn named(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        let index = match env.scope {
            0 => self.named_index.get(name).copied(),
            scope => self.scopes[scope].names.iter().position(|named| named.name.value == name),
        };
        let Some(index) = index.filter(|_| env.constants.is_none()) else { return Ok(None) };
        // Without overrides a name means the same everywhere, so it is lowered once.
        // Case references inside it depend on where it is used: then it is lowered anew.
        let cacheable = env.overrides.is_empty() && !env.referenced && env.parameters.is_none();
        if cacheable && let Some(term) = &self.named_terms[index] {
            return Ok(Some(term.clone()));
        }
        if let Some(term) = env.names.borrow().get(&index) {
            return Ok(Some(term.clone()));
        }
        let entry = &self.scopes[env.scope].names[index];
        if self.resolving.contains(&(env.scope, index)) {
            let chain = self.resolving.iter().copied().chain([(env.scope, index)]);
            let chain = chain.map(|(scope, i)| self.scopes[scope].names[i].name.value.as_str());
            let chain = chain.collect::<Vec<_>>().join(" -> ");
            return Err(Diagnostic::error(codes::CIRCULAR_NAME, format!("`{name}` is defined by itself"))
                .at(entry.value.span, chain)
                .help("a name stands for something else: write out one of the definitions"));
        }
        self.resolving.push((env.scope, index));
        let inner = Env { locals: Vec::new(), ..env.clone() };
        let term = self.term(&entry.value, &inner, Expected::Anything);
        self.resolving.pop();
        let term = term?;
        self.label(&term, name);
        if cacheable {
            self.named_terms[index] = Some(term.clone());
        }
        env.names.borrow_mut().insert(index, term.clone());
        Ok(Some(term))
    }

    pub(super) fn term_of_name(&mut self, name: &str) -> Result<Term> {
        let expr = Expr { span: Span::default(), kind: ExprKind::Name(name.to_owned()) };
        self.term(&expr, &Env::default(), Expected::Anything)
    }

    /// Remembers a name for generated code.
    pub(super) fn label(&mut self, term: &Term, name: &str) {
        match term {
            Term::Number(expr) | Term::Whole(expr) | Term::Word(expr) => self.pool.set_label(*expr, name),
            Term::Record(parts) => {
                for (part, term) in parts {
                    self.label(term, &format!("{name}_{part}"));
                }
            }
            Term::Vector(_) | Term::Bool(_) | Term::Level(..) | Term::List(_) => {}
        }
    }

    pub(super) fn unknown_name(&self, name: &str, span: Span, env: &Env) -> Diagnostic {
        let inputs = || -> Vec<&str> {
            match &env.parameters {
                Some(parameters) => parameters.iter().map(|(name, _)| name.as_str()).collect(),
                None => self.inputs.iter().map(|i| i.name.as_str()).collect(),
            }
        };
        let scope = self.scopes[env.scope];
        let names = scope.names.iter().map(|n| n.name.value.as_str());
        let names = names.chain(scope.constants.iter().map(|c| c.name.value.as_str()));
        let locals = env.locals.iter().map(|(local, _)| local.value.as_str());
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{name}` is not defined")).at(span, "unknown name");
        if let Some((constant, _)) = scope
            .constants
            .iter()
            .map(|c| (c, &c.value))
            .find(|(c, value)| c.name.value == name && !matches!(value, table::ConstantValue::Number(_)))
        {
            return error
                .at(constant.name.span, "a list of constants")
                .help(format!("lists stand in sums and polynomials: `sum(n in {name}, ...)`, `poly(x, {name})`"))
                .help(format!(
                    "from version 2 on they are also indexed, `{name}[i]`, and interpolated, `lookup({name}, x)`"
                ));
        }
        if let Some(fetch) = self.fetches.iter().find(|fetch| fetch.is_called(name)) {
            return fetch.needs_arguments(error);
        }
        if let Some(group) = scope.groups.iter().find(|group| group.name.value == name) {
            let pattern = "01-1".chars().cycle().take(group.members.len()).collect::<String>();
            return error
                .at(group.name.span, "a group of inputs")
                .help(format!("groups stand in conditions that are written as data: {{\"{name}\": \"{pattern}\"}}"));
        }
        if let Some(input) = scope.inputs.iter().find(|input| input.name.value == name) {
            return error.at(input.name.span, "is an input of the table, but not a parameter here");
        }
        if self.sets.iter().any(|set| set.names.iter().any(|n| n == name)) {
            let error = error.help(format!("`{name}` is a level: compare an input with it, as in `input == {name}`"));
            return match self.with_its_set(name).filter(|_| self.table.language.value >= 2) {
                Some(typed) => error.help(format!("or say of which set it is, as in `{typed}`")).mend(
                    format!("write `{typed}`"),
                    span,
                    typed,
                ),
                None => error,
            };
        }
        match nearest(name, inputs().into_iter().chain(names).chain(locals)) {
            Some(close) => error.did_you_mean(name, close),
            None if env.parameters.is_some() => error.help(format!("the parameters are: {}", inputs().join(", "))),
            None => error.help(format!("the inputs are: {}", inputs().join(", "))),
        }
    }

    pub(super) fn unknown_input(&self, name: &Spanned<String>, label: &str) -> Diagnostic {
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{}` is not an input", name.value));
        if let Some(fetch) = self.fetches.iter().find(|fetch| fetch.is_called(&name.value)) {
            return fetch.needs_arguments(error.at(name.span, label));
        }
        let known = || self.inputs.iter().map(|i| i.name.as_str());
        let error = error.at(name.span, label);
        match nearest(&name.value, known()) {
            Some(close) => error.did_you_mean(&name.value, close),
            None => error.help(format!("the inputs are: {}", known().collect::<Vec<_>>().join(", "))),
        }
    }
}
