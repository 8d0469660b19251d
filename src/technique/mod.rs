//! The techniques as renderers.

pub mod count;
pub mod executor;
pub mod integrals;
pub mod revectorise;
pub mod shade;
