//! The names in sight at a place of generated code.
//!
//! A name belongs to the block that it is declared in: it is in sight from there to the
//! end of the block, in the blocks inside as well, and no two names in sight are the same.
//! What a block has computed is therefore not computed again inside of it or after it, and
//! what is said of a condition inside a block is forgotten with the block.

use std::collections::{HashMap, HashSet, hash_map};

use crate::program::{CondId, ExprId};

/// The names in sight, and what is known about conditions.
#[derive(Default)]
pub(super) struct Scope {
    /// Expressions that have a name, or are a part of something that has.
    values: HashMap<ExprId, String>,
    /// Arguments whose sine and cosine have a name, as a pair.
    pairs: HashMap<ExprId, String>,
    /// Conditions whose outcome is known here.
    outcomes: HashMap<CondId, bool>,
    /// The names that the table chose, all of them different.
    taken: HashSet<String>,
    /// All of the above in the order of arrival, so that a block can take back what is its own.
    entries: Vec<Entry>,
}

enum Entry {
    Value(ExprId),
    Pair(ExprId),
    Outcome(CondId),
    Taken(String),
}

/// The beginning of a block.
#[derive(Clone, Copy)]
pub(super) struct Mark(usize);

impl Scope {
    /// Begins a block.
    pub(super) fn mark(&self) -> Mark {
        Mark(self.entries.len())
    }

    /// Ends the block that began there.
    pub(super) fn forget(&mut self, since: Mark) {
        for entry in self.entries.drain(since.0..) {
            match entry {
                Entry::Value(expr) => drop(self.values.remove(&expr)),
                Entry::Pair(expr) => drop(self.pairs.remove(&expr)),
                Entry::Outcome(condition) => drop(self.outcomes.remove(&condition)),
                Entry::Taken(name) => drop(self.taken.remove(&name)),
            }
        }
    }

    /// The name of an expression.
    pub(super) fn value(&self, expr: ExprId) -> Option<&str> {
        self.values.get(&expr).map(String::as_str)
    }

    /// Gives an expression a name; one that has a name keeps it.
    pub(super) fn name(&mut self, expr: ExprId, name: String) {
        if let hash_map::Entry::Vacant(place) = self.values.entry(expr) {
            place.insert(name);
            self.entries.push(Entry::Value(expr));
        }
    }

    /// The name of the sine and cosine of an argument.
    pub(super) fn pair(&self, argument: ExprId) -> Option<&str> {
        self.pairs.get(&argument).map(String::as_str)
    }

    /// Gives the sine and cosine of an argument a name.
    pub(super) fn name_pair(&mut self, argument: ExprId, name: String) {
        if self.pairs.insert(argument, name).is_none() {
            self.entries.push(Entry::Pair(argument));
        }
    }

    /// The outcome of a condition, where it is known.
    pub(super) fn outcome(&self, condition: CondId) -> Option<bool> {
        self.outcomes.get(&condition).copied()
    }

    /// Notes the outcome of a condition.
    pub(super) fn decide(&mut self, condition: CondId, outcome: bool) {
        if self.outcomes.insert(condition, outcome).is_none() {
            self.entries.push(Entry::Outcome(condition));
        }
    }

    /// Takes a name, if nothing in sight has it.
    pub(super) fn take(&mut self, name: &str) -> bool {
        let is_new = self.taken.insert(name.to_owned());
        if is_new {
            self.entries.push(Entry::Taken(name.to_owned()));
        }
        is_new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Pool;

    #[test]
    fn what_a_block_names_ends_with_it() {
        let mut pool = Pool::default();
        let (one, two) = (pool.number(1.0), pool.number(2.0));
        let condition = pool.always(true);
        let mut scope = Scope::default();
        assert!(scope.take("outer") && !scope.take("outer"));
        scope.name(one, "outer".to_owned());
        let block = scope.mark();
        assert!(!scope.take("outer") && scope.take("inner"));
        scope.name(one, "inner".to_owned());
        scope.name(two, "inner".to_owned());
        scope.name_pair(two, "pair".to_owned());
        scope.decide(condition, false);
        assert_eq!((scope.value(one), scope.value(two), scope.pair(two)), (Some("outer"), Some("inner"), Some("pair")));
        assert_eq!(scope.outcome(condition), Some(false));
        scope.forget(block);
        assert_eq!((scope.value(one), scope.value(two), scope.pair(two)), (Some("outer"), None, None));
        assert_eq!(scope.outcome(condition), None);
        assert!(scope.take("inner") && !scope.take("outer"));
    }
}
