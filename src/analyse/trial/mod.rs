//! Trials of the analyses: what they find of the misprints of published tables, and of seeded mistakes.
//!
//! A research instrument (feature `trial`): it measures the checker and is no part of it.

mod errata;
mod mutate;
mod violations;

pub use errata::{errata, seeded};
pub use mutate::{Mistake, Tally, survey};
pub use violations::{Violation, violations, violations_under};
