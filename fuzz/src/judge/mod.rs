//! What must hold, whatever is read: the oracle.
//!
//! [`Court`] runs the parts of a judgement one after the other, each by itself: a panic, or a
//! run that takes too long, is a fault of that part and keeps no other from being looked at.

pub(crate) mod claims;
pub(crate) mod clock;
pub(crate) mod device;
pub(crate) mod failures;
pub(crate) mod plans;
pub(crate) mod points;
pub(crate) mod tables;

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Duration;

use clock::Clock;

/// Something that does not hold.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Fault {
    /// The fault without what differs from case to case: equal kinds are probably one fault.
    pub(crate) kind: String,
    /// What was expected, what came, and where.
    pub(crate) detail: String,
}

/// Counts of what was looked at.
pub(crate) type Tally = BTreeMap<String, u64>;

/// The longest that one part of a judgement may take, in time of the processor: a hundred times what is usual.
pub(crate) const LIMIT: Duration = Duration::from_secs(4);

/// A judgement under way.
pub(crate) struct Court<'d> {
    /// A directory for files that commands read by their names.
    pub(crate) directory: &'d Path,
    pub(crate) faults: Vec<Fault>,
    pub(crate) tally: Tally,
}

impl<'d> Court<'d> {
    /// Nothing looked at yet.
    pub(crate) fn new(directory: &'d Path) -> Self {
        Self { directory, faults: Vec::new(), tally: Tally::new() }
    }

    /// Counts something.
    pub(crate) fn count(&mut self, what: &str, more: usize) {
        if let Some(count) = self.tally.get_mut(what) {
            *count += more as u64;
        } else {
            self.tally.insert(what.to_owned(), more as u64);
        }
    }

    /// Notes a fault.
    pub(crate) fn fault(&mut self, kind: impl Into<String>, detail: impl Into<String>) {
        let fault = Fault { kind: kind.into(), detail: detail.into() };
        // One of a kind says enough about a case.
        if self.faults.iter().all(|known| known.kind != fault.kind) {
            self.faults.push(fault);
        }
    }

    /// Notes a fault unless something holds.
    pub(crate) fn expect(&mut self, holds: bool, kind: &str, detail: impl FnOnce() -> String) {
        if !holds {
            self.fault(kind, detail());
        }
    }

    /// Does a part of the work; nothing comes of it if it panics.
    pub(crate) fn part<T>(&mut self, name: &str, work: impl FnOnce(&mut Self) -> T) -> Option<T> {
        clock::enter(name);
        let clock = Clock::start();
        let done = catch_unwind(AssertUnwindSafe(|| work(self)));
        let spent = clock.spent(LIMIT);
        if spent > LIMIT {
            self.fault(
                format!("slow: {name}"),
                format!("took {:.1} s, and should take less than {:.0}", spent.as_secs_f64(), LIMIT.as_secs_f64()),
            );
        }
        match done {
            Ok(done) => Some(done),
            Err(_) => {
                let (place, message) = clock::last_panic();
                self.fault(format!("panic: {place}"), format!("in {name}: {message}"));
                None
            }
        }
    }
}
