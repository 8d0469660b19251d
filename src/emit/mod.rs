//! Printers: proved plan → source text, and through naga to SPIR-V, HLSL and MSL.
//!
//! Only a [`Proved`] plan can be printed. One walk over the plan
//! (`module`) decides what is said; a `Dialect` per
//! language decides how. A file of `targets` is one form of that. What comes out depends on the table and the options
//! alone, so it is the same bytes on every machine.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

pub(crate) mod function;
mod host;
mod imports;
mod inputs;
pub mod kernel;
mod language;
mod module;
mod names;
pub mod reflect;
mod targets;
mod text;
mod validate;

use host::Host;
use language::wgsl::Wgsl;

use crate::diag::Failure;
use crate::prove::Proved;

pub use language::glsl::GlslVersion;
pub use module::lookup_words;
pub use targets::{SiblingFile, Target};
pub use validate::{Translated, Validated, glsl_module, translate, wgsl_module, wgsl_text};

/// Emits a proved plan and validates what was emitted.
///
/// WGSL and GLSL 450 are parsed and validated by naga; SPIR-V, HLSL and MSL
/// are written by naga from the validated WGSL. GLSL 330 and ES 300, which
/// naga does not read, differ from GLSL 450 in their header only, and so do
/// modules of WESL and naga_oil from plain WGSL. GLSL of a table whose output
/// is a list is not read by naga either.
///
/// ```
/// use umbrage::emit::{self, Target};
/// use umbrage::plan::{Plan, Shape};
/// use umbrage::program::Program;
///
/// let program = Program::read("tables/smsr.ron")?;
/// let proved = Plan::proved(&program, Shape::Ordered)?;
/// let module = String::from_utf8_lossy(&emit::emit(&proved, Target::NagaOil)?).into_owned();
/// assert!(module.starts_with("#define_import_path umbrage::smsr\n"));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
///
/// # Errors
/// When validation fails, which would be a bug of the printer.
pub fn emit(proved: &Proved<'_>, target: Target) -> Result<Vec<u8>, Failure> {
    emit_all(std::slice::from_ref(proved), target, &[])
}

/// Emits plans into one file: that of a table of cases, or those of the
/// functions of a table. A Rust module embeds its sibling files.
///
/// # Errors
/// As [`emit`].
pub fn emit_all(plans: &[Proved<'_>], target: Target, siblings: &[SiblingFile]) -> Result<Vec<u8>, Failure> {
    target.write(plans, siblings)
}

/// The WGSL module of a plan.
pub fn wgsl(proved: &Proved<'_>) -> String {
    module::write(proved, &Wgsl::Plain)
}

/// The GLSL library of a plan: no `#version` line and no `main`.
pub fn glsl(proved: &Proved<'_>, version: GlslVersion) -> String {
    module::write(proved, &language::glsl::Glsl { version })
}

/// The Rust module of a plan.
pub fn rust(proved: &Proved<'_>) -> String {
    host::modules(std::slice::from_ref(proved), Host::Plain, &[])
}
