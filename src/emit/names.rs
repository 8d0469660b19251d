//! Names of generated things: constants of levels, temporaries, fetched inputs.

use std::collections::BTreeSet;

use super::dialect::{Prefix, Type};
use crate::program::{Domain, InputId, LevelKind, Levels, Program};

/// Names of generated things that depend on the whole table.
pub(super) struct Names {
    /// File name of the table, for comments.
    pub(super) file: String,
    /// What names of temporaries start with; no input or named value starts so.
    pub(super) temporary: String,
    /// Every set of named or integer levels, with the name of the first input that has it.
    pub(super) sets: Vec<(String, Levels)>,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        let mut sets: Vec<(String, Levels)> = Vec::new();
        let mut taken = BTreeSet::new();
        for input in &program.inputs {
            if let Domain::Discrete(levels) = &input.domain
                && levels.kind != LevelKind::Bool
                && !sets.iter().any(|(_, known)| known == levels)
            {
                // Constants are upper case, and inputs may differ in case only.
                let mut name = input.ident.clone();
                while !taken.insert(name.to_ascii_uppercase()) {
                    name.push_str("_other");
                }
                sets.push((name, levels.clone()));
            }
        }
        let mut temporary = "t".to_owned();
        let names = || program.inputs.iter().map(|i| i.ident.as_str());
        while names().any(|name| name.starts_with(&temporary) && name.ends_with('t')) {
            temporary.push('t');
        }
        let file = program.source.name.rsplit('/').next().unwrap_or_default().to_owned();
        Self { file, temporary, sets }
    }

    pub(super) fn set(&self, levels: &Levels) -> Option<&str> {
        self.sets.iter().find(|(_, known)| known == levels).map(|(name, _)| name.as_str())
    }

    /// The constant of a level.
    pub(super) fn level(&self, program: &Program, input: InputId, level: u8) -> String {
        let prefix = Prefix::new(&program.name);
        match program.levels(input) {
            Some(levels) => {
                level_constant(&prefix, self.set(levels).unwrap_or_default(), &levels.names[usize::from(level)])
            }
            None => String::new(),
        }
    }

    /// Name and type of a fetched input.
    pub(super) fn fetched(&self, program: &Program, input: InputId) -> (String, Type) {
        let input = &program.inputs[input.index()];
        (input.ident.clone(), input_type(&input.domain, Type::Uint))
    }
}

pub(super) fn level_constant(prefix: &Prefix, set: &str, level: &str) -> String {
    let level = level.replace('-', "minus_");
    format!("{}_{}_{}", prefix.upper, set.to_ascii_uppercase(), level.to_ascii_uppercase())
}

/// The type of an input; `levels` is that of named and integer levels.
pub(super) fn input_type(domain: &Domain, levels: Type) -> Type {
    match domain {
        Domain::Discrete(l) if l.kind == LevelKind::Bool => Type::Bool,
        Domain::Discrete(_) => levels,
        Domain::Continuous { .. } => Type::Float,
    }
}
