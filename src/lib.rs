//! Umbrage compiles case tables into shaders that are proved equal to the table.

pub mod diag;
pub mod eval;
pub mod plan;
pub mod program;
pub mod table;
