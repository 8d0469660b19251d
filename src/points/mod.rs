//! Points of the input space, and the ways to choose them.

use crate::program::Value;

#[cfg(any(feature = "gpu", feature = "trial"))]
pub mod comparison;
pub mod random;
mod sample;

pub use sample::Samples;

/// A point: one value per input; fetched ones may be absent until they are asked for.
pub type Point = Vec<Option<Value>>;
