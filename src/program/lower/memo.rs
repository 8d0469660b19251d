//! The memory of lowering: nothing is written out twice, and the work that it may do has an end.
//!
//! A function is written out where it is called. The same function called with the same
//! arguments gives the same term, which is remembered: functions that call each other
//! twice would otherwise take twice as long with each of them. What is not the same has a
//! limit, so that lowering ends whatever a table asks for.

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;
use std::sync::Arc;

use super::lists::{List, Part};
use super::terms::Term;
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::pool::{CondId, ExprId};
use crate::program::{Choice, InputId, LevelTerm};

/// Most expressions that are followed beyond those that are written.
const MAX_FOLLOWED: usize = 1_000_000;

/// Numbers of a list of constants.
pub(super) type Items = Rc<Vec<Vec<f64>>>;

/// The memory of lowering one table.
#[derive(Default)]
pub(super) struct Memo<'t> {
    levels: HashMap<LevelKey, Arc<LevelTerm>>,
    calls: HashMap<CallKey<'t>, Term>,
    /// The constants that are numbers, and those that are lists, by scope and place.
    pub(super) constants: HashMap<(usize, usize), Result<f64>>,
    pub(super) lists: HashMap<(usize, usize), Items>,
    /// The choices of the table, by their places, and those of levels that are not numbers yet.
    choices: BTreeMap<(usize, usize), Choice>,
    of_levels: HashMap<usize, Vec<Span>>,
    /// The number of expressions followed so far.
    followed: usize,
    /// The refusal of any more, which is one mistake wherever it is met again.
    refusal: Option<Diagnostic>,
}

/// A level term; its parts are known by their place, as equal ones share it.
#[derive(PartialEq, Eq, Hash)]
enum LevelKey {
    Const(u8),
    Input(InputId),
    If(CondId, usize, usize),
    Map(usize, Arc<[u8]>),
}

/// A function of a scope with its arguments.
#[derive(PartialEq, Eq, Hash)]
pub(super) struct CallKey<'t> {
    scope: usize,
    name: &'t str,
    arguments: Vec<TermKey>,
}

/// A term as an argument.
#[derive(PartialEq, Eq, Hash)]
enum TermKey {
    Number(ExprId),
    Whole(ExprId),
    Word(ExprId),
    Vector(Vec<ExprId>),
    Bool(CondId),
    Level(SetId, usize),
    List(Vec<PartKey>),
    Record(Vec<(String, TermKey)>),
}

/// A part of a list as an argument.
#[derive(PartialEq, Eq, Hash)]
enum PartKey {
    Item(TermKey),
    If(CondId, Vec<PartKey>, Vec<PartKey>),
    Result(Vec<ExprId>),
}

impl PartKey {
    fn all(list: &List) -> Vec<Self> {
        let key = |part: &Part| match part {
            Part::Item(term, _) => PartKey::Item(TermKey::of(term)),
            Part::If(condition, then, other) => PartKey::If(*condition, Self::all(then), Self::all(other)),
            Part::Result(_, components) => PartKey::Result(components.clone()),
        };
        list.parts().iter().map(key).collect()
    }
}

impl TermKey {
    fn of(term: &Term) -> Self {
        match term {
            Term::Number(number) => TermKey::Number(*number),
            Term::Whole(number) => TermKey::Whole(*number),
            Term::Word(word) => TermKey::Word(*word),
            Term::Vector(parts) => TermKey::Vector(parts.clone()),
            Term::Bool(condition) => TermKey::Bool(*condition),
            Term::Level(set, term) => TermKey::Level(*set, place(term)),
            Term::List(items) => TermKey::List(PartKey::all(items)),
            Term::Record(parts) => {
                TermKey::Record(parts.iter().map(|(name, part)| (name.clone(), TermKey::of(part))).collect())
            }
        }
    }
}

/// The place of a level term, which is its own as long as the memo has it.
fn place(term: &Arc<LevelTerm>) -> usize {
    Arc::as_ptr(term) as usize
}

impl<'t> CallKey<'t> {
    pub(super) fn new(scope: usize, name: &'t str, arguments: &[Term]) -> Self {
        Self { scope, name, arguments: arguments.iter().map(TermKey::of).collect() }
    }
}

impl<'t> Memo<'t> {
    /// A level term; equal ones are the same.
    pub(super) fn level(&mut self, term: LevelTerm) -> Arc<LevelTerm> {
        let key = match &term {
            LevelTerm::Const(level) => LevelKey::Const(*level),
            LevelTerm::Input(input) => LevelKey::Input(*input),
            LevelTerm::If(condition, then, other) => LevelKey::If(*condition, place(then), place(other)),
            LevelTerm::Map(inner, map) => LevelKey::Map(place(inner), map.clone()),
        };
        self.levels.entry(key).or_insert_with(|| Arc::new(term)).clone()
    }

    /// The term that a call was written out to before.
    pub(super) fn call(&self, key: &CallKey<'t>) -> Option<Term> {
        self.calls.get(key).cloned()
    }

    /// Remembers what a call was written out to.
    pub(super) fn remember(&mut self, key: CallKey<'t>, term: &Term) {
        self.calls.insert(key, term.clone());
    }
}

impl Lowering<'_> {
    /// Notes what a choice that is written in this table became.
    pub(super) fn note_choice(&mut self, span: Span, condition: CondId, term: &Term) {
        if let Term::Level(_, level) = term {
            self.memo.of_levels.entry(place(level)).or_default().push(span);
        }
        let truth = self.pool.truth(condition);
        let parts = term.numbers();
        let is_selection = |part: &ExprId| self.pool.node(*part).condition() == Some(condition);
        let selections: Vec<ExprId> = parts.iter().copied().filter(is_selection).collect();
        // Where both sides are the same, neither is idle.
        let is_decided = truth == Some(true) || (truth.is_none() && selections.len() < parts.len());
        let choice =
            self.memo.choices.entry((span.start, span.end)).or_insert_with(|| Choice { span, ..Choice::default() });
        choice.is_decided |= is_decided;
        choice.selections.extend(selections);
    }

    /// Notes that a choice between levels became a selection between their numbers.
    pub(super) fn note_level_choice(&mut self, term: &LevelTerm, condition: CondId, selection: ExprId) {
        let LevelTerm::If(asked, ..) = term else { return };
        if *asked != condition || self.pool.node(selection).condition() != Some(condition) {
            return;
        }
        for span in self.memo.of_levels.get(&(std::ptr::from_ref(term) as usize)).cloned().unwrap_or_default() {
            let choice = self.memo.choices.entry((span.start, span.end)).or_default();
            choice.selections.push(selection);
        }
    }

    /// The choices of the table, in the order written.
    pub(super) fn choices(&mut self) -> Vec<Choice> {
        std::mem::take(&mut self.memo.choices).into_values().collect()
    }

    /// Counts expressions that are followed, and refuses more than a table may ask for.
    pub(super) fn follow(&mut self, expressions: usize, span: Span) -> Result<()> {
        self.memo.followed += expressions;
        // No expression is written in less than a byte, and each is lowered where it is written.
        if self.memo.followed <= MAX_FOLLOWED + self.table.source.text.len() {
            return Ok(());
        }
        let refusal = self.memo.refusal.get_or_insert_with(|| {
            let message = "with names, references, calls and sums written out, the table is too large";
            Diagnostic::error(codes::TOO_DEEP, message)
                .at(span, "not followed any further")
                .help(format!("at most {MAX_FOLLOWED} expressions beyond those that are written"))
        });
        Err(refusal.clone())
    }
}
