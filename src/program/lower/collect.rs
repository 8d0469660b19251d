//! Hit policy `Collect`: the items of all cases whose guards hold, in the order of the cases.
//!
//! A program takes the first row whose guard holds. So the value of a row is that of its case and,
//! behind it, what the later cases have to say where their guards hold as well. What several rows
//! say so is one and the same term.

use super::lists::List;
use super::terms::Term;
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::Row;
use crate::table::{HitPolicy, Output};

impl Lowering<'_> {
    /// True if all cases that hold count.
    pub(super) fn collects(&self) -> bool {
        self.table.functions.is_empty() && self.table.hit_policy.value == HitPolicy::Collect
    }

    /// Refuses outputs that have no items.
    pub(super) fn check_collected(&self) -> Result<()> {
        if !self.collects() || matches!(*self.output, Output::List { .. }) {
            return Ok(());
        }
        let found = self.resolved(&self.output).describe();
        Err(Diagnostic::error(
            codes::DOMAIN,
            format!("`Collect` collects the items of a list, but the output is {found}"),
        )
        .at(self.table.hit_policy.span, "all cases that hold count")
        .at(self.table.output.span, "but this has no items")
        .help("write `output: List(of: ..., max: ...)`, or `hit_policy: First`"))
    }

    /// A value where all cases count: an item stands for the list of it alone.
    pub(super) fn as_items(&self, term: Term, span: Span) -> Term {
        match (&*self.output, &term) {
            (Output::List { .. }, Term::List(_)) => term,
            (Output::List { .. }, _) if self.collects() => Term::List(List::of(term, span)),
            _ => term,
        }
    }

    /// Adds to each row what later cases give where it is taken.
    pub(super) fn collect(&mut self, rows: &mut [Row]) -> Result<()> {
        let output = self.output.clone();
        let zero = self.pool.number(0.0);
        let mut rest = vec![zero; output.size()];
        for row in rows.iter_mut().rev() {
            if let Some(last) = row.lines.last().filter(|last| last.condition_span.is_some()) {
                let message = format!("case {} may come to no line", row.id);
                return Err(Diagnostic::error(codes::CASE_SHAPE, message)
                    .at(last.span, "the last line has a condition")
                    .help("where all cases count, a last line `\"[]\"` says that there is nothing to add"));
            }
            let mut value = rest.clone();
            for line in row.lines.iter_mut().rev() {
                self.check_room(line.span)?;
                line.values = self.behind(&output, &line.values, rest.clone())?;
                value = self.either(line.condition, &line.values, &value);
            }
            rest = self.either(row.guard, &value, &rest);
            // Where the row is taken, its guard need not be asked again.
            for line in &mut row.lines {
                line.values = self.where_it_holds(row.guard, &line.values);
            }
        }
        Ok(())
    }
}
