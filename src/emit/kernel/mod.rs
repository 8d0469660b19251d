//! Compute shaders around a library: over columns of inputs, and lean ones to time.

pub mod columns;
pub mod timed;
