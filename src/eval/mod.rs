//! Interpreters: the meaning of a [`Program`](crate::program::Program), executed.
//!
//! [`Interpreter`] is the reference. It walks the program exactly as the
//! program's documentation reads, one input at a time, in `f32` or `f64`, and
//! counts what it fetches. [`Batch`] gives the same results, bit for bit, for
//! columns of inputs at once. [`IntervalInterpreter`] gives all results that WGSL's
//! accuracy rules admit, to judge implementations by, and `Precise` (feature `precise`)
//! those in hundreds of bits, to judge `f32` by. Nothing here knows plans or shading languages.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

mod admissible;
mod batch;
mod code;
mod columns;
mod freely;
mod interval;
#[cfg(feature = "precise")]
mod precise;
mod residual;
mod scalar;
mod walk;

pub use admissible::{Admissible, IntervalInterpreter, Possible};
pub use batch::{Batch, Missing};
pub use columns::{ABSENT, Column, ColumnError, Columns, Path, Results};
pub use interval::Interval;
#[cfg(feature = "precise")]
pub(crate) use precise::NOTHING;
#[cfg(feature = "precise")]
pub use precise::{Precise, Unknown};
pub use scalar::{Interpreter, NeedsFetch, Outcome};
