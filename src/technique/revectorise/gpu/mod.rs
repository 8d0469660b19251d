//! The techniques on a GPU.
//!
//! ```text
//! ShadowMap, Receivers ──▶ Frame on the device ──Shader──▶ Visibility
//! ```
//!
//! A [`Shader`] is a technique with a proved plan of its table, compiled for one
//! kind of output. It takes the same [`ShadowMap`](super::ShadowMap) and
//! [`Receivers`](super::Receivers) as the CPU, whoever made them, and decides
//! every pixel alike: depth tests and steps of walks are exact in `f32`, so that
//! the case is the same and only divisions may round otherwise.

mod frame;
mod raster;
mod shader;
mod source;

pub use frame::GpuFrame;
pub use raster::{GpuPicture, Raster};
pub use shader::{Bound, Costs, Shader};
pub use source::{Output, Passes, Skeleton, source};
