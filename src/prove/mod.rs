//! The gate: a plan is equal to its program, or is not emitted.
//!
//! Plans that only branch are compared operation by operation ([`exact`]), plans that compute over the
//! reals (`real`), with a bound on how far `f32` can be from that (`rounding`).

pub mod exact;
pub(crate) mod real;
pub(crate) mod rounding;
pub(crate) mod route;
