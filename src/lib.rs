//! Umbrage compiles case tables into shaders that are proved equal to the table.

<<<<<<< HEAD
pub mod build;
=======
pub mod analyse;
#[cfg(feature = "cli")]
pub mod cli;
>>>>>>> helper-a
pub mod diag;
pub mod emit;
pub mod eval;
<<<<<<< HEAD
pub mod plan;
=======
pub mod explain;
>>>>>>> helper-a
pub mod program;
pub mod show;
pub mod table;
