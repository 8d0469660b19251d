//! Searches for the interval that a number lies in.
//!
//! Where guards and lines compare one number with many constants, a chain asks for one interval after the
//! other. Here the constant in the middle is asked for first, and each side goes on with what can still be
//! taken there, so that a thousand intervals cost ten tests. Numbers that may not be numbers are left to
//! the chain: which side they are on is not for the order of constants to say.

use std::collections::{BTreeMap, HashSet};

use super::StepId;
use super::builder::{Builder, Guarded, Result};
use super::knowledge::Knowledge;
use crate::program::comparisons::{Relation, Subject, question};
use crate::program::print::Printer;
use crate::program::{Comparison, Cond, CondId, ExprId};

/// Fewest tests of one number that are worth a search.
const WORTH: usize = 4;
/// Most rows and lines that all searches of a plan go through, over all of their tests; what is left
/// then becomes chains.
const MAX_CARRIED: usize = 1 << 22;

/// A place at which a number is divided: at a constant, which belongs to the lower part or to the upper one.
#[derive(Clone, Copy)]
struct Cut {
    at: f32,
    lower: bool,
    /// The constant as it is written.
    written: ExprId,
}

/// Makes steps for rows.
pub(super) struct Search {
    /// The rows and lines that may still be gone through.
    left: usize,
    /// The numbers that were searched for, each with the most cuts and the most tests that took.
    searched: BTreeMap<ExprId, (usize, u32)>,
}

impl Search {
    pub(super) fn new() -> Self {
        Self { left: MAX_CARRIED, searched: BTreeMap::new() }
    }

    /// Facts that are worth knowing, for headers and summaries.
    pub(super) fn notes(&self, builder: &Builder<'_>) -> Vec<String> {
        let printer = Printer { pool: &builder.pool, inputs: &builder.program.inputs };
        let note = |(number, (cuts, tests)): (&ExprId, &(usize, u32))| {
            let number = printer.expr(*number);
            format!("at most {tests} tests find where `{number}` lies among {cuts} comparisons with constants")
        };
        self.searched.iter().map(note).collect()
    }

    /// The steps of some rows, then the default.
    pub(super) fn rows(&mut self, builder: &mut Builder<'_>, rows: &Guarded, known: &Knowledge) -> Result<StepId> {
        let Some((number, cuts)) = self.most_compared(builder, rows, known) else {
            return builder.rows(rows, known);
        };
        let most = self.searched.entry(number).or_default();
        *most = (*most).max((cuts.len(), usize::BITS - cuts.len().leading_zeros()));
        self.part(builder, number, &cuts, rows, known)
    }

    /// The same, where a number still lies on either side of some cuts.
    fn part(
        &mut self,
        builder: &mut Builder<'_>,
        number: ExprId,
        cuts: &[Cut],
        rows: &Guarded,
        known: &Knowledge,
    ) -> Result<StepId> {
        if cuts.is_empty() {
            return self.rows(builder, rows, known);
        }
        let middle = cuts.len() / 2;
        let Cut { lower, written, .. } = cuts[middle];
        let op = if lower { Comparison::LessEqual } else { Comparison::Less };
        let condition = builder.pool.compare(op, number, written);
        let mut side = |me: &mut Self, cuts: &[Cut], outcome: bool| {
            let known = known.with(&builder.pool, condition, outcome);
            let rows = me.narrowed(builder, rows, &known);
            me.part(builder, number, cuts, &rows, &known)
        };
        let then = side(self, &cuts[..middle], true)?;
        let other = side(self, &cuts[middle + 1..], false)?;
        builder.test(condition, then, other)
    }

    /// The rows that can be taken where more is known.
    fn narrowed(&mut self, builder: &mut Builder<'_>, rows: &Guarded, known: &Knowledge) -> Guarded {
        self.left = self.left.saturating_sub(rows.len());
        let mut narrowed = Guarded::new();
        for (row, guard) in rows {
            let guard = known.cond(&mut builder.pool, *guard);
            let truth = builder.pool.truth(guard);
            if truth != Some(false) {
                narrowed.push((*row, guard));
            }
            if truth == Some(true) {
                break;
            }
        }
        narrowed
    }

    /// The number that is compared with most constants, and where these divide it, ascending; `None` if
    /// that is not worth a search.
    fn most_compared(
        &mut self,
        builder: &Builder<'_>,
        rows: &Guarded,
        known: &Knowledge,
    ) -> Option<(ExprId, Vec<Cut>)> {
        let mut found = Found { builder, known, seen: HashSet::new(), cuts: BTreeMap::new() };
        for (row, guard) in rows {
            found.look(*guard);
            let lines = &builder.program.rows[*row].lines;
            lines.iter().for_each(|line| found.look(line.condition));
            self.left = self.left.saturating_sub(1 + lines.len());
        }
        if self.left == 0 {
            return None;
        }
        let cuts = found.cuts.into_iter().map(|(number, mut cuts)| {
            cuts.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.lower.cmp(&b.lower)));
            cuts.dedup_by_key(|cut| (cut.at, cut.lower));
            (number, cuts)
        });
        // Of equally many the number that was made first.
        cuts.rev().max_by_key(|(_, cuts)| cuts.len()).filter(|(_, cuts)| cuts.len() >= WORTH)
    }
}

/// The cuts that some conditions ask for.
struct Found<'a, 'p> {
    builder: &'a Builder<'p>,
    known: &'a Knowledge,
    seen: HashSet<CondId>,
    cuts: BTreeMap<ExprId, Vec<Cut>>,
}

impl Found<'_, '_> {
    fn look(&mut self, condition: CondId) {
        if !self.seen.insert(condition) {
            return;
        }
        let builder = self.builder;
        let cond = builder.pool.cond(condition);
        if let Cond::Compare(op, a, b) = cond
            && let Some((subject, relation, at)) = question(&builder.pool, *op, *a, *b)
            && let Some(number) = self.searchable(subject)
            && self.known.compared(&builder.pool, *op, *a, *b).is_none()
        {
            let places: &[bool] = match relation {
                Relation::Below | Relation::AtLeast => &[false],
                Relation::AtMost | Relation::Above => &[true],
                Relation::Equal => &[false, true],
            };
            let written = if *a == number { *b } else { *a };
            let cuts = places.iter().map(|lower| Cut { at, lower: *lower, written });
            self.cuts.entry(number).or_default().extend(cuts);
        }
        cond.children().for_each(|part| self.look(part));
    }

    /// The number that a comparison with a constant is about, if it is there without a fetch.
    fn searchable(&self, subject: Subject) -> Option<ExprId> {
        let pool = &self.builder.pool;
        let number = subject.number().filter(|_| subject.is_ordered(pool))?;
        self.builder.missing(pool.expr_facts(number).inputs, self.known).is_empty().then_some(number)
    }
}
