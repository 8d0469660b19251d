//! Running emitted source over columns of inputs, and passes of techniques, on a
//! wgpu adapter.
//!
//! Only this folder names wgpu; techniques name the types below. Errors say what
//! to do: which driver to install when there is no adapter, what was lost when a
//! device is.

pub mod bench;
mod data;
mod device;
#[cfg(any(feature = "render", test))]
pub(crate) mod draw;
mod kernel;
pub(crate) mod pass;
#[cfg(test)]
mod tests;
pub mod timing;

pub use crate::jury::{Language, Outputs};
pub use device::{AdapterChoice, Gpu};
pub use kernel::Kernel;

#[cfg(feature = "render")]
pub(crate) use data::{laid_out, view};
#[cfg(feature = "render")]
pub(crate) use wgpu::ComputePassTimestampWrites as TimestampWrites;
#[cfg(feature = "render")]
pub(crate) use wgpu::{Buffer, CommandEncoder, CompareFunction, Texture, TextureFormat, TextureView};
