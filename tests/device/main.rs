//! What runs on an adapter: shaders against the interpreter, techniques against each other, the tuner.
#![allow(clippy::unwrap_used)]

mod adapter;
mod area_agreement;
mod convolution_agreement;
mod diff;
mod reordering;
mod search_agreement;
mod shadow_agreement;
#[path = "../support/mod.rs"]
mod support;
#[path = "../../benches/synthetic.rs"]
mod synthetic;
mod tuning;
