//! Level sets by name: those of a table, those of its inputs, and those of the tables that it imports.
//!
//! A set is one and the same wherever it is named: by `edge` in its own table, by `shapes::edge` in
//! one that imports that as `shapes`. Two sets that look alike are two sets.

use super::fetches::Fetch;
use super::{Lowering, Result, SINCE, SetId, Term};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::LevelTerm;
use crate::program::classes::Classes;
use crate::program::domain::{LevelKind, Levels, MAX_LEVELS};
use crate::table;
use crate::text::closest::nearest;

impl<'t> Lowering<'t> {
    /// The level set that a name stands for in this table.
    pub(super) fn find_set(&mut self, name: &Spanned<String>) -> Result<SetId> {
        if let Some(set) = self.set_index.get(name.value.as_str()) {
            return Ok(*set);
        }
        if let Some((alias, rest)) = name.value.split_once("::") {
            return self.imported_set(0, alias, rest, name.span);
        }
        if let Some(input) = self.input_index.get(name.value.as_str())
            && let Some(set) = self.input_sets[input.index()]
        {
            return Ok(set);
        }
        if let Some(set) = self.fetches.iter().find(|fetch| fetch.is_called(&name.value)).and_then(Fetch::set) {
            return Ok(set);
        }
        // What the parameters of a function have the levels of need not be a parameter of it. All inputs of the
        // table were declared before, so none stands further down or leads back here.
        let table = self.table;
        let elsewhere = table.inputs.iter().find(|input| self.of_function && input.name.value == name.value);
        if let Some(set) = elsewhere.map_or(Ok(None), |input| self.set_of_input(input))? {
            return Ok(set);
        }
        if let Some(input) = self.input_index.get(name.value.as_str()) {
            return Err(Diagnostic::error(codes::DOMAIN, format!("`{}` has no levels", name.value))
                .at(name.span, "a range")
                .at(self.inputs[input.index()].span, "declared here"));
        }
        let known = self.set_index.keys().chain(self.input_index.keys()).copied();
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("there is no level set `{}`", name.value))
            .at(name.span, "neither under `levels` nor a discrete input declared above");
        Err(match nearest(&name.value, known) {
            Some(close) => error.did_you_mean(&name.value, close),
            None => error,
        })
    }

    /// The level set that a name stands for in a table, this one or an imported one; `at` is where it is asked for.
    pub(super) fn set_in(&mut self, scope: usize, name: &str, at: Span) -> Result<SetId> {
        if scope == 0 {
            return self.find_set(&Spanned::new(at, name.to_owned()));
        }
        if let Some((alias, rest)) = name.split_once("::") {
            return self.imported_set(scope, alias, rest, at);
        }
        let table = self.scopes[scope];
        if let Some(known) = self.foreign_sets.get(&(scope, name.to_owned())) {
            return Ok(*known);
        }
        let levels = table.levels.iter().find(|(set, _)| set.value == name);
        let input = table.inputs.iter().find(|input| input.name.value == name);
        let levels = match (levels, input.map(|input| &input.domain.value)) {
            (Some((set, levels)), _) => self.level_set(levels, set.span)?,
            (None, Some(table::Domain::Levels(levels))) => self.level_set(levels, at)?,
            (None, Some(table::Domain::LevelsOf(of))) => return self.set_in(scope, &of.value, at),
            (None, Some(table::Domain::Bool)) => return Ok(SetId::BOOL),
            (None, Some(table::Domain::Int(from, to))) if *to - *from >= MAX_LEVELS as i64 => {
                return Err(Diagnostic::error(codes::DOMAIN, format!("`{name}` has integers of any range, no levels"))
                    .at(at, "more than 64 integers")
                    .help("declare the input here, `Int(from: ..., to: ...)`: integers are the same in every table"));
            }
            (None, Some(table::Domain::Int(from, to))) => Levels {
                names: (*from..=*to).map(|i| i.to_string()).collect(),
                codes: (*from..=*to).map(|i| i as f64).collect(),
                kind: LevelKind::Int,
                classes: (table.language.value >= SINCE).then(|| Classes::each(*from, *to)),
            },
            (None, Some(table::Domain::Range(..) | table::Domain::U32) | None) => {
                let known = table.levels.iter().map(|(set, _)| &set.value);
                let known = known.chain(table.inputs.iter().map(|input| &input.name.value)).map(String::as_str);
                let message = format!("`{}` has no level set `{name}`", table.source.name);
                let error = Diagnostic::error(codes::UNKNOWN_NAME, message)
                    .at(at, "neither under its `levels` nor one of its discrete inputs");
                return Err(match nearest(name, known) {
                    Some(close) => error.did_you_mean(name, close),
                    None => error,
                });
            }
        };
        let set = SetId(self.sets.len());
        self.sets.push(levels);
        self.foreign_sets.insert((scope, name.to_owned()), set);
        Ok(set)
    }

    /// A set of an imported table.
    fn imported_set(&mut self, scope: usize, alias: &str, name: &str, at: Span) -> Result<SetId> {
        let table = self.scopes[scope];
        if scope == 0 {
            table.since(2, at, "a level set of another table")?;
        }
        match self.import_index.get(&(scope, alias)) {
            Some(inner) => self.set_in(*inner, name, at),
            None => {
                let known = table.imports.iter().map(|import| import.alias.value.as_str());
                let message = format!("nothing is imported as `{alias}`");
                let error = Diagnostic::error(codes::UNKNOWN_NAME, message).at(at, "not under `imports`");
                Err(match nearest(alias, known) {
                    Some(close) => error.did_you_mean(alias, close),
                    None => error.help(format!("import the table: imports: {{\"{alias}\": \"{alias}.ron\"}}")),
                })
            }
        }
    }

    /// `set::level`
    pub(super) fn typed_level(
        &mut self,
        set: &Spanned<String>,
        level: &Spanned<String>,
        span: Span,
        scope: usize,
    ) -> Result<Term> {
        self.scopes[scope].since(2, span, "a level that says its set")?;
        let id = self.set_in(scope, &set.value, set.span)?;
        if id == SetId::BOOL {
            return Err(Diagnostic::error(codes::TYPE, format!("`{}` is a condition, it has no levels", set.value))
                .at(span, "expected a set of named levels or integers")
                .help("write `true` or `false`"));
        }
        match self.sets[id.0].find(&level.value) {
            Some(index) => Ok(self.level_of(id, LevelTerm::Const(index))),
            None => Err(self.unknown_level(id, &level.value, level.span)),
        }
    }

    /// A level of a set in a list of levels, with or without its set.
    pub(super) fn listed_level(&mut self, set: SetId, word: &Spanned<String>, scope: usize) -> Result<u8> {
        let Some((named, level)) = word.value.rsplit_once("::") else {
            return self.sets[set.0].find(&word.value).ok_or_else(|| self.unknown_level(set, &word.value, word.span));
        };
        self.scopes[scope].since(2, word.span, "a level that says its set")?;
        let other = self.set_in(scope, named, word.span)?;
        if other != set {
            let message = format!("`{named}` is another set of levels");
            let error = Diagnostic::error(codes::TYPE, message).at(word.span, "not of what is asked");
            return Err(self
                .unlike(error, set, other)
                .help(format!("the levels are: {}", self.sets[set.0].describe())));
        }
        self.sets[set.0].find(level).ok_or_else(|| self.unknown_level(set, level, word.span))
    }

    /// The way to say the set of a level, for a level that stands alone; the first set that has it.
    pub(super) fn with_its_set(&self, level: &str) -> Option<String> {
        let table = self.table;
        let has = |set: &SetId| self.sets[set.0].names.iter().any(|name| name == level);
        let named = table.levels.iter().find(|(name, _)| self.set_index.get(name.value.as_str()).is_some_and(has));
        let input = || {
            let of = |input: &table::Input| self.own_sets.get(input.name.value.as_str()).is_some_and(has);
            table.inputs.iter().find(|input| of(input)).map(|input| &input.name)
        };
        let set = named.map(|(name, _)| name).or_else(input)?;
        Some(format!("{}::{level}", set.value))
    }
}
