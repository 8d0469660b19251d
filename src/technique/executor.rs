//! The machine that evaluates techniques: the CPU, or a GPU.

#[cfg(feature = "gpu")]
use std::sync::Arc;

#[cfg(feature = "gpu")]
use crate::gpu::Gpu;

/// The machine that evaluates techniques.
#[derive(Debug)]
pub enum Executor {
    /// In plain Rust, tables by the interpreter.
    Cpu,
    /// As shaders, with the tables compiled.
    #[cfg(feature = "gpu")]
    Gpu(Arc<Gpu>),
}

impl Executor {
    /// Its name, in words.
    pub fn describe(&self) -> String {
        match self {
            Executor::Cpu => "CPU".to_owned(),
            #[cfg(feature = "gpu")]
            Executor::Gpu(device) => device.describe(),
        }
    }
}
