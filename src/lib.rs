//! Umbrage compiles case tables into shaders that are proved equal to the table.

pub mod analyse;
#[cfg(feature = "cli")]
pub mod cli;
pub mod diag;
pub mod eval;
pub mod explain;
pub mod program;
pub mod show;
pub mod table;
