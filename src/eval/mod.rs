//! Interpreters: the meaning of a [`Program`](crate::program::Program), executed.
//!
//! [`Interpreter`] is the reference. It walks the program exactly as the
//! program's documentation reads, one input at a time, in `f32` or `f64`, and
//! counts what it fetches. [`Batch`] gives the same results, bit for bit, for
//! columns of inputs at once. Nothing here knows plans or shading languages.

mod batch;
mod code;
mod columns;
mod residual;
mod scalar;

pub use batch::{Batch, Missing};
pub use columns::{ABSENT, Column, ColumnError, Columns, Path, Results};
pub use scalar::{Interpreter, NeedsFetch, Outcome};
