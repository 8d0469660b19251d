//! Names of generated things: constants of levels, temporaries, fetched inputs.

use std::collections::BTreeSet;

use super::inputs::{fetch_ident, fetches, input_type};
use super::language::{Dialect, Prefix};
use crate::program::{Domain, InputId, LevelKind, Levels, Program, Scalar};

/// Names of generated things that depend on the whole table.
pub(super) struct Names {
    /// File name of the table, for comments.
    pub(super) file: String,
    /// The prefix of the names of temporaries; nothing that the table names looks like one.
    pub(super) temporary: String,
    /// Names that a local must not have: they mean something else where locals stand.
    hidden: BTreeSet<String>,
    /// The beginning of the names of the module, in lower case.
    module: String,
    /// The number that stands for no case.
    pub(super) default: u32,
    /// The number that stands for no result: some tests were gone through, others follow.
    miss: u32,
    /// Every set of named or integer levels.
    pub(super) sets: Vec<Set>,
}

/// A set of levels in generated code.
#[derive(Clone)]
pub(super) struct Set {
    /// The name of the first input that has it.
    pub(super) name: String,
    /// The constants of its levels; none of integers that are many, or numbers in the table.
    pub(super) constants: Vec<String>,
    /// The levels.
    pub(super) levels: Levels,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        let prefix = Prefix::new(&program.name);
        let mut sets: Vec<Set> = Vec::new();
        let mut taken = BTreeSet::from([format!("{}_DEFAULT", prefix.upper)]);
        let mut functions: BTreeSet<String> =
            fetches(program).into_iter().map(|fetch| format!("fetch_{}", fetch.ident)).collect();
        for input in &program.inputs {
            if let Domain::Discrete(levels) = &input.domain
                && levels.kind != LevelKind::Bool
                && !sets.iter().any(|known| known.levels == *levels)
            {
                // Constants are upper case, while inputs may differ in case only, and where
                // set and level meet in a constant is not to be seen: `a_b` and `c`, `a` and `b_c`.
                let mut name = fetch_ident(input).to_owned();
                loop {
                    let constants = match has_constants(levels) {
                        true => level_constants(&prefix, &name, levels),
                        false => Vec::new(),
                    };
                    if !constants.iter().any(|constant| taken.contains(constant))
                        && functions.insert(format!("{name}_level"))
                    {
                        taken.extend(constants.iter().cloned());
                        sets.push(Set { name, constants, levels: levels.clone() });
                        break;
                    }
                    name.push_str("_other");
                }
            }
        }
        let mut hidden: BTreeSet<String> = program.inputs.iter().map(|input| input.ident.clone()).collect();
        hidden.extend(program.inputs.iter().map(|input| fetch_ident(input).to_owned()));
        hidden.extend(["key".to_owned(), "site".to_owned(), prefix.result(), prefix.value(), prefix.site()]);
        hidden.extend(taken);
        let mut temporary = "t".to_owned();
        let looks_so = |name: &str, start: &str| {
            let number = name.strip_prefix(start).and_then(|rest| rest.strip_suffix('t'));
            number.is_some_and(|number| number.chars().all(|c| c.is_ascii_digit()))
        };
        let labels = || program.pool.labels().map(|label| label.replace('.', "_"));
        while hidden.iter().any(|name| looks_so(name, &temporary)) || labels().any(|name| looks_so(&name, &temporary)) {
            temporary.push('t');
        }
        let file = program.source.name.rsplit('/').next().unwrap_or_default().to_owned();
        let used: BTreeSet<u32> = program.rows.iter().map(|row| row.id).collect();
        let mut unused = (0..=u32::MAX).rev().filter(|id| !used.contains(id));
        let (default, miss) = (unused.next().unwrap_or(u32::MAX), unused.next().unwrap_or(0));
        let module = format!("{}_", prefix.lower.to_ascii_lowercase());
        Self { file, temporary, hidden, module, default, miss, sets }
    }

    /// Returns whether a local of this name would hide something.
    pub(super) fn hides(&self, name: &str) -> bool {
        self.hidden.contains(name) || name.to_ascii_lowercase().starts_with(&self.module)
    }

    /// The number of the case where a part of the tests found none.
    pub(super) fn miss(&self, dialect: &dyn Dialect) -> String {
        dialect.uint(self.miss)
    }

    pub(super) fn set(&self, levels: &Levels) -> Option<&Set> {
        self.sets.iter().find(|known| known.levels == *levels)
    }

    /// The constant of a level, if it has one.
    pub(super) fn level(&self, program: &Program, input: InputId, level: u8) -> Option<&str> {
        let set = program.levels(input).and_then(|levels| self.set(levels))?;
        set.constants.get(usize::from(level)).map(String::as_str)
    }

    /// Name and type of a fetched input.
    pub(super) fn fetched(&self, program: &Program, input: InputId) -> (String, Scalar) {
        let input = &program.inputs[input.index()];
        (input.ident.clone(), input_type(&input.domain, Scalar::Uint))
    }
}

/// Integers with a constant each, at most.
pub(super) const MAX_INTEGERS: usize = 16;

fn has_constants(levels: &Levels) -> bool {
    match (levels.kind, &levels.classes) {
        (LevelKind::Named | LevelKind::Bool, _) => true,
        (LevelKind::Int, None) => levels.count() <= MAX_INTEGERS,
        (LevelKind::Int, Some(_)) => levels.is_wide(),
    }
}

fn level_constant(prefix: &Prefix, set: &str, level: &str) -> String {
    let level = level.replace('-', "minus_");
    format!("{}_{}_{}", prefix.upper, set.to_ascii_uppercase(), level.to_ascii_uppercase())
}

/// The constants of a set's levels; levels may differ in case only.
fn level_constants(prefix: &Prefix, set: &str, levels: &Levels) -> Vec<String> {
    let mut constants: Vec<String> = Vec::new();
    for level in &levels.names {
        let mut name = level_constant(prefix, set, level);
        while constants.contains(&name) {
            name.push_str("_OTHER");
        }
        constants.push(name);
    }
    constants
}
