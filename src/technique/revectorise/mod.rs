//! The techniques as renderers: from a scene to a picture, with every case visible.
//!
//! ```text
//! scene ──▶ light, camera, triangles ──▶ ShadowMap, Receivers ──▶ Visibility ──▶ picture
//! ```
//!
//! The technique lies between the shadow map and the visibility. Its
//! skeleton (which texels are read, how far a walk goes) is written by hand,
//! once here in plain Rust and once in WGSL; what the inputs so found *mean* is
//! said by the tables alone, which the interpreter or the compiler evaluates.
//!
//! Both executors take the same [`ShadowMap`] and [`Receivers`], so that their
//! cases can be compared pixel by pixel.

mod case_free;
pub mod cpu;
#[cfg(feature = "gpu")]
mod device;
mod entry;
mod frame;
#[cfg(feature = "gpu")]
pub mod gpu;
mod inputs;
mod probe;
mod settings;
mod shadow;
pub mod stage;
mod variant;

pub use entry::{CASE_FREE, Entry, HARD, PCF, RPCF, RSMSS, SMSR};
pub use frame::{
    DEPTH_UNIT, Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Visibility, fixed_depth, max_slope,
};
pub use inputs::Vocabulary;
pub use settings::{BIAS, MAX_MAP, PCF_KERNEL, PLAN, SEARCH_LIMIT, SHADOW_MAP, SLOPE_BIAS, WALK_BIAS};
pub use variant::Variant;

#[cfg(test)]
mod tests;
