//! Points of the input space, and how they are chosen.

#[cfg(feature = "gpu")]
pub(crate) mod comparison;
pub mod random;
pub(crate) mod sample;
