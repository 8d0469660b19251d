//! Umbrage compiles case tables into shaders that are proved equal to the table.
//!
//! ```text
//! RON text ──table──▶ Table ──program──▶ Program ──plan──▶ Plan ──prove──▶ Proved ──emit──▶ source
//!                                          │ eval                                     │ gpu
//!                                          ▼                                          ▼
//!                                        values ◀────────────── diff ──────────────▶ values
//! ```
//!
//! Data flows one way. Nothing past [`program`] looks at RON, nothing before
//! [`emit`] knows a shading language, and interpreters and emitters share
//! nothing but the [`program::Program`], so that no bug can hide in both.
//!
//! ```
//! use umbrage::eval::Interpreter;
//! use umbrage::plan::{Plan, Shape};
//! use umbrage::program::Program;
//!
//! let program = Program::read("tables/smsr.ron")?;
//! let proved = Plan::proved(&program, Shape::Ladder)?;
//! let wgsl = umbrage::emit::wgsl(&proved);
//! assert!(wgsl.contains("fn smsr_key("));
//! # Ok::<(), umbrage::diag::Failure>(())
//! ```

pub mod analyse;
#[cfg(feature = "report")]
pub mod atlas;
pub mod build;
pub mod capture;
pub mod certificate;
#[cfg(feature = "cli")]
pub mod cli;
pub mod diag;
#[cfg(feature = "gpu")]
pub mod diff;
pub mod emit;
pub mod eval;
pub mod explain;
pub mod format;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod jury;
#[cfg(feature = "cli")]
pub mod lsp;
#[cfg(feature = "report")]
pub mod picture;
pub mod plan;
pub mod points;
pub mod profile;
pub mod program;
pub mod prove;
#[cfg(feature = "report")]
pub mod report;
#[cfg(feature = "render")]
pub mod scene;
pub mod show;
pub mod skeleton;
#[cfg(feature = "precise")]
pub mod stabilise;
pub mod table;
#[cfg(feature = "render")]
pub mod technique;
pub mod text;
#[cfg(all(feature = "gpu", feature = "render"))]
pub mod tune;
pub mod tuned;
pub mod uses;

/// The Rust in documents, compiled like the examples of this crate. That of `docs/build.md` and `docs/tutorial.md`
/// needs what a build script makes, and is built and run by tests.
#[cfg(doctest)]
mod documents {
    #[doc = include_str!("../README.md")]
    mod readme {}
    #[doc = include_str!("../docs/tuning.md")]
    mod tuning {}
}
