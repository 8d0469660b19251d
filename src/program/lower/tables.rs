//! Tables of cases as values of other tables: `t3(configuration = c, lit = b0)`.
//!
//! The called table is checked by itself, and has a program of its own. What it is called with takes
//! the place of its inputs, and its result is a value like any other: whatever the table is written
//! with, references, images, tables that it calls in turn, there is no second rule for it here.

use std::collections::HashMap;
use std::sync::Arc;

use super::calls::check_given;
use super::memo::CallKey;
use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::bits::LevelSet;
use crate::program::domain::{Domain, Input, LevelKind};
use crate::program::pool::{CondId, ExprId, Node, Pool};
use crate::program::substitute::{Meanings, Substitution};
use crate::program::{InputId, LevelTerm, Program};
use crate::table::Table;
use crate::table::expr::Expr;

/// The programs of the tables of cases that are imported, each known by the place of its table.
pub(super) type Programs = HashMap<*const Table, Arc<Program>>;

/// A table of cases that can be called.
#[derive(Clone, Copy)]
pub(super) struct Called<'t> {
    table: &'t Table,
    /// The name that it is called by.
    alias: &'t str,
    /// The scope of its names.
    scope: usize,
}

/// The meaning of an input of a called table.
enum Meaning {
    Number(ExprId),
    Level(SetId, Arc<LevelTerm>),
}

struct Given<'l, 't> {
    lowering: &'l mut Lowering<'t>,
    meanings: Vec<Meaning>,
}

impl Meanings for Given<'_, '_> {
    fn pool(&mut self) -> &mut Pool {
        &mut self.lowering.pool
    }

    fn number(&mut self, input: InputId) -> ExprId {
        match &self.meanings[input.index()] {
            Meaning::Number(number) => *number,
            Meaning::Level(..) => unreachable!("a continuous input has no levels"),
        }
    }

    fn index(&mut self, input: InputId) -> ExprId {
        match &self.meanings[input.index()] {
            Meaning::Level(set, term) => self.lowering.level_number(*set, term, |_, level| f64::from(level)),
            Meaning::Number(_) => unreachable!("a discrete input is no number"),
        }
    }

    fn level(&mut self, input: InputId, levels: LevelSet) -> CondId {
        match &self.meanings[input.index()] {
            Meaning::Level(set, term) => self.lowering.level_in(*set, term, levels),
            Meaning::Number(_) => unreachable!("a discrete input is no number"),
        }
    }
}

impl<'t> Lowering<'t> {
    /// The table of cases that a name stands for in a scope.
    pub(super) fn called_table(&self, name: &str, scope: usize) -> Option<Called<'t>> {
        let inner = *self.import_index.get(&(scope, name))?;
        let import = self.scopes[scope].imports.iter().find(|import| import.alias.value == name)?;
        let table = self.scopes[inner];
        (!table.cases.is_empty()).then_some(Called { table, alias: &import.alias.value, scope: inner })
    }

    /// `t(a, b)`: every input in order, or none, and then each means what it means here.
    pub(super) fn table_in_order(
        &mut self,
        called: Called<'t>,
        arguments: &[Expr],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let inputs = &called.table.inputs;
        if !arguments.is_empty() && arguments.len() != inputs.len() {
            let name = &called.table.name.value;
            let message = format!("`{name}` takes {} inputs, not {}", inputs.len(), arguments.len());
            let listed = inputs.iter().map(|input| input.name.value.as_str()).collect::<Vec<_>>().join(", ");
            return Err(Diagnostic::error(codes::CALL, message)
                .at(span, "wrong number of inputs")
                .help(format!("all of {listed}, or some by name")));
        }
        let given = inputs.iter().map(|input| &input.name.value).zip(arguments).collect();
        self.table_value(called, given, span, env)
    }

    /// `t(p = a)`: what is not given means what it means here.
    pub(super) fn table_with(
        &mut self,
        called: Called<'t>,
        given: &[(Spanned<String>, Expr)],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let known: Vec<&str> = called.table.inputs.iter().map(|input| input.name.value.as_str()).collect();
        check_given(&called.table.name.value, "input", &known, given)?;
        self.table_value(called, given.iter().map(|(name, value)| (&name.value, value)).collect(), span, env)
    }

    fn table_value(
        &mut self,
        called: Called<'t>,
        given: HashMap<&String, &Expr>,
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        self.scopes[env.scope].since(2, span, "a table of cases as a value")?;
        let Some(program) = self.programs.get(&std::ptr::from_ref(called.table)).cloned() else {
            return Err(Diagnostic::error(codes::IMPORT, "this table cannot be called").at(span, "called here"));
        };
        let (mut meanings, mut key) = (Vec::new(), Vec::new());
        for input in &program.inputs {
            let (term, at) = match given.get(&input.name) {
                Some(value) => (self.argument(called, input, value, env)?, value.span),
                None => match self.resolve(&input.name, env)? {
                    Some(term) => (term, span),
                    None => return Err(not_given(called.table, input, span)),
                },
            };
            let (meaning, term) = self.meaning(called, input, term, at)?;
            meanings.push(meaning);
            key.push(term);
        }
        let key = CallKey::new(called.scope, &called.table.name.value, &key);
        if let Some(term) = self.memo.call(&key) {
            return Ok(term);
        }
        self.follow(program.pool.len() + program.pool.conditions(), span)?;
        let components = Substitution::new(&program, Given { lowering: self, meanings }).result();
        let output = called.table.output.value.try_map(&mut |set| self.set_in(called.scope, &set.value, span))?;
        let term = self.term_of(&output, &components);
        self.memo.remember(key, &term);
        Ok(term)
    }

    /// The argument for an input, as it is written.
    fn argument(&mut self, called: Called<'t>, input: &Input, value: &Expr, env: &Env) -> Result<Term> {
        let named = matches!(&input.domain, Domain::Discrete(levels) if levels.kind != LevelKind::Bool);
        // Of integers of any range no level is known by the number.
        if !named || matches!(&input.domain, Domain::Discrete(levels) if levels.is_wide()) {
            return self.term(value, env, Expected::Anything);
        }
        let set = self.set_in(called.scope, &input.name, value.span)?;
        // A whole number is a level by itself; other levels are told by name here, so that a code means nothing else.
        match self.literal_level(set, value, env)? {
            Some(level) => Ok(self.level_of(set, LevelTerm::Const(level))),
            None => self.term(value, env, Expected::Level(set)),
        }
    }

    /// The meaning of an input: the level or number that takes its place.
    fn meaning(&mut self, called: Called<'t>, input: &Input, term: Term, at: Span) -> Result<(Meaning, Term)> {
        let (table, name) = (&called.table.name.value, &input.name);
        match (&input.domain, &term) {
            (Domain::Continuous { lo, hi, .. }, Term::Number(number)) => match self.pool.constant(*number) {
                Some(value) if !(*lo..=*hi).contains(&value) => {
                    let message = format!("{value} is not in the range {lo} to {hi} of `{name}`");
                    Err(Diagnostic::error(codes::DOMAIN, message).at(at, format!("is given as `{name}` of `{table}`")))
                }
                _ => Ok((Meaning::Number(*number), term)),
            },
            (Domain::Continuous { .. }, other) => Err(self.no_number(other, at)),
            (Domain::Word, term) => {
                let word = self.word_of(term, at)?;
                Ok((Meaning::Number(word), Term::Word(word)))
            }
            (Domain::Discrete(levels), Term::Bool(condition)) if levels.kind == LevelKind::Bool => {
                let level = self.truth_as_level(*condition);
                let level = self.memo.level(level);
                Ok((Meaning::Level(SetId::BOOL, level), term))
            }
            (Domain::Discrete(levels), _) if levels.kind == LevelKind::Bool => {
                Err(type_error(at, &self.describe(&term), &format!("`{name}` of `{table}` is a condition")))
            }
            (Domain::Discrete(levels), _) if levels.is_wide() => {
                let (set, level) = self.class_in(levels, &term, at)?;
                Ok((Meaning::Level(set, level.clone()), Term::Level(set, level)))
            }
            (Domain::Discrete(levels), _) => {
                let set = self.set_in(called.scope, name, at)?;
                let level = match &term {
                    Term::Level(own, level) if *own == set => level.clone(),
                    // Whole numbers are the same wherever they are declared.
                    Term::Level(own, level)
                        if levels.kind == LevelKind::Int && self.sets[own.0].kind == LevelKind::Int =>
                    {
                        let map = self.sets[own.0].names.iter().map(|number| levels.find(number));
                        let Some(map) = map.collect::<Option<Vec<u8>>>() else {
                            return Err(self.unknown_to(called, input, *own, set, at));
                        };
                        self.memo.level(LevelTerm::Map(level.clone(), map.into()))
                    }
                    Term::Level(own, _) => return Err(self.unknown_to(called, input, *own, set, at)),
                    Term::Whole(number) if levels.kind == LevelKind::Int => self.level_of_whole(set, *number, at)?,
                    Term::Number(number) if levels.kind == LevelKind::Int => {
                        self.whole_as_level(set, *number, at, &mut HashMap::new())?
                    }
                    Term::Number(_)
                    | Term::Whole(_)
                    | Term::Word(_)
                    | Term::Vector(_)
                    | Term::Bool(_)
                    | Term::List(_)
                    | Term::Record(_) => {
                        let expected = format!("`{name}` of `{table}` is {}", self.all_levels(set));
                        return Err(type_error(at, &self.describe(&term), &expected));
                    }
                };
                Ok((Meaning::Level(set, level.clone()), Term::Level(set, level)))
            }
        }
    }

    fn all_levels(&self, set: SetId) -> String {
        format!("one of the levels {}", self.sets[set.0].names.join(", "))
    }

    /// The level that a choice between whole numbers is.
    fn whole_as_level(
        &mut self,
        set: SetId,
        number: ExprId,
        at: Span,
        known: &mut HashMap<ExprId, Arc<LevelTerm>>,
    ) -> Result<Arc<LevelTerm>> {
        if let Some(done) = known.get(&number) {
            return Ok(done.clone());
        }
        let level = match self.pool.node(number) {
            Node::Const(value) => match self.sets[set.0].find(&value.get().to_string()) {
                Some(level) => LevelTerm::Const(level),
                None => return Err(self.unknown_level(set, &value.get().to_string(), at)),
            },
            Node::Select(condition, then, other) => {
                let then = self.whole_as_level(set, then, at, known)?;
                let other = self.whole_as_level(set, other, at, known)?;
                LevelTerm::If(condition, then, other)
            }
            Node::Word(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Result(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..) => {
                return Err(type_error(at, "a real number", &format!("expected {}", self.all_levels(set)))
                    .help("whole numbers, `Int` inputs and choices between them are levels of an `Int`"));
            }
        };
        let level = self.memo.level(level);
        known.insert(number, level.clone());
        Ok(level)
    }

    /// The refusal of a level of another set than that of the input.
    fn unknown_to(&self, called: Called<'t>, input: &Input, own: SetId, set: SetId, at: Span) -> Diagnostic {
        let (table, name) = (&called.table.name.value, &input.name);
        let [own_levels, levels] = [own, set].map(|set| &self.sets[set.0]);
        let unknown: Vec<&str> =
            own_levels.names.iter().filter(|level| levels.find(level).is_none()).map(String::as_str).collect();
        let error = match unknown.as_slice() {
            [] => Diagnostic::error(codes::TYPE, format!("`{name}` of `{table}` has the levels of another set")),
            _ => {
                let message = format!("`{name}` of `{table}` knows no {}", unknown.join(", "));
                Diagnostic::error(codes::UNKNOWN_LEVEL, message)
            }
        };
        let error = error.at(at, "a level of another set");
        let error = error.help(format!("the levels are: {}", levels.describe()));
        match levels.kind {
            LevelKind::Int => error,
            LevelKind::Named | LevelKind::Bool => {
                let alias = called.alias;
                error.help(format!(
                    "take them from there: `Levels(of: \"{alias}::{name}\")`, `Enumeration(of: \"{alias}::{name}\")`"
                ))
            }
        }
    }

    /// A number that is a constant of an imported table, `kernels.sigma`.
    pub(super) fn imported_constant(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        let Some((scope, name)) = self.in_import(name, env.scope) else { return Ok(None) };
        let inner = Env { scope, constants: None, ..Env::default() };
        self.named_constant(name, &inner)
    }

    /// The scope of an imported table, and the name there, that a name with a dot stands for.
    pub(super) fn in_import<'n>(&self, name: &'n str, scope: usize) -> Option<(usize, &'n str)> {
        let (alias, rest) = name.split_once('.')?;
        let inner = *self.import_index.get(&(scope, alias))?;
        (self.scopes[scope].language.value >= 2).then_some((inner, rest))
    }
}

fn not_given(table: &Table, input: &Input, span: Span) -> Diagnostic {
    let (table, name) = (&table.name.value, &input.name);
    let message = format!("`{table}` needs `{name}`, which is not given");
    let error = Diagnostic::error(codes::PARAMETER, message)
        .at(span, format!("and nothing is called `{name}` here"))
        .help(format!("give it a value: `{table}({name} = ...)`"));
    match input.fetched {
        Some(_) => error.help("it is fetched there: declare an input with this name, fetched or not"),
        None => error,
    }
}
