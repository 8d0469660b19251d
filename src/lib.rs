//! Umbrage compiles case tables into shaders that are proved equal to the table.

pub mod build;
pub mod diag;
pub mod emit;
pub mod eval;
pub mod plan;
pub mod program;
pub mod table;
