//! Shaders around a library: over columns of inputs, by compute shaders and by fragments, and lean ones to time.

pub mod columns;
pub mod fragments;
pub mod timed;
