//! Convolution shadows: volumes lit by many small blurs.
//!
//! The scene is cut into slabs that face the viewer. Each light has an image, which is swept
//! through the slabs from front to back: at every slab it is blurred a little, shades the
//! matter of the slab, and loses what that absorbs. Many small blurs add up to a Gaussian, so
//! the light is a distant Gaussian behind the viewer.
//!
//! ```text
//! scene ──▶ layers ──▶ inside ──▶ matter ──┐
//!           all surfaces   in and out   slabs    sweep ──▶ picture
//! lights ──▶ light ──▶ kernel ──▶ steps ──┘
//!           slopes, split  samples   gathers
//! ```
//!
//! Kernels and their phases, the cases of a slab, policies and shading are tables: `kernels`,
//! `ellipse`, `light_kernel`, `slab`, `policies`, `shade`. This module asks them; what it knows
//! itself is how triangles become layers, and how images are gathered.

pub mod detail;
pub mod dither;
mod entry;
mod fine;
pub mod flat;
mod functions;
#[cfg(feature = "gpu")]
mod gpu;
pub mod inside;
pub mod kernel;
pub mod layers;
pub mod light;
pub mod material;
pub mod matter;
pub mod octahedron;
pub mod picture;
pub mod settings;
pub mod stack;
pub mod stencil;
pub mod steps;
pub mod surface;
pub mod sweep;
#[cfg(test)]
mod tests;
pub mod view;

pub use entry::{CONVOLVE, CROSSINGS, Entry, ODD_LISTS, OPACITY, REFERENCE};
