//! Interpreters: the meaning of a [`Program`](crate::program::Program), executed.
//!
//! [`Interpreter`] is the reference. It walks the program exactly as the
//! program's documentation reads, one input at a time, in `f32` or `f64`, and
//! counts what it fetches. Nothing here knows plans or shading languages.

mod scalar;

pub use scalar::{Interpreter, NeedsFetch, Outcome};
