//! The work that an analysis may do.
//!
//! Work is counted, not timed, so that an analysis stops at the same place on every machine and in every
//! run. What was found by then is worth nothing and is not reported; that it stopped is.

use std::cell::Cell;

/// Most steps of one analysis: a step of an operation on sets, or what takes as long. A table of some
/// thirty cases takes a hundredth of it.
pub(in crate::analyse) const STEPS: u64 = 40_000_000;

/// Operations on numbers that take as long as a step.
const OPERATIONS: u64 = 8;

/// The steps that an analysis has left.
#[derive(Debug)]
pub(in crate::analyse) struct Budget {
    steps: u64,
    left: Cell<u64>,
}

impl Budget {
    pub(in crate::analyse) fn new(steps: u64) -> Self {
        Self { steps, left: Cell::new(steps) }
    }

    /// Starts anew, for another analysis.
    pub(super) fn refill(&self) {
        self.left.set(self.steps);
    }

    /// Takes some steps; false if there are none left.
    pub(in crate::analyse) fn spend(&self, steps: u64) -> bool {
        self.left.set(self.left.get().saturating_sub(steps));
        !self.is_spent()
    }

    /// Takes the steps that some operations on numbers are worth; false if there are none left.
    pub(in crate::analyse) fn compute(&self, operations: usize) -> bool {
        self.spend(1 + operations as u64 / OPERATIONS)
    }

    /// The steps that are left.
    pub(in crate::analyse) fn left(&self) -> u64 {
        self.left.get()
    }

    /// Returns whether nothing is left. Then no answer is worth anything, and none may be kept.
    pub(in crate::analyse) fn is_spent(&self) -> bool {
        self.left.get() == 0
    }
}
