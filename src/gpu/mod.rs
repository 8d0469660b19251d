//! Running emitted source over columns of inputs on a wgpu adapter.
//!
//! This is the only module that names wgpu. Errors say what to do: which
//! driver to install when there is no adapter, what was lost when a device is.

pub mod bench;
mod device;
mod kernel;
pub(crate) mod pass;
pub mod timing;

pub use device::{AdapterChoice, Gpu};
pub use kernel::{Kernel, Language, Outputs};
