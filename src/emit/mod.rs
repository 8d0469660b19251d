//! Printers: proved plan → source text, and through naga to SPIR-V, HLSL and MSL.
//!
//! Only a [`Proved`] plan can be printed. One walk over the plan
//! ([`module`]) decides what is said; a [`Dialect`](dialect::Dialect) per
//! language decides how. What comes out depends on the table and the options
//! alone, so it is the same bytes on every machine.

mod body;
mod dialect;
mod glsl;
pub mod harness;
mod lookup;
mod module;
mod names;
mod outline;
mod rust;
mod special;
mod terms;
mod text;
pub mod timed;
mod validate;
mod values;
mod wgsl;

use crate::diag::Failure;
use crate::plan::Proved;
use crate::program::Output;

pub use glsl::GlslVersion;
pub use module::lookup_words;
pub use validate::{Translated, Validated, glsl_module, translate, wgsl_module};

/// A language to emit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Target {
    /// A WGSL module.
    Wgsl,
    /// A GLSL library.
    Glsl(GlslVersion),
    /// A Rust module without dependencies.
    Rust,
    /// A SPIR-V compute shader over columns of inputs.
    SpirV,
    /// The same as HLSL.
    Hlsl,
    /// The same as MSL.
    Msl,
}

impl Target {
    /// Every target, in the order of reports.
    pub const ALL: [Target; 8] = [
        Target::Wgsl,
        Target::Glsl(GlslVersion::V450),
        Target::Glsl(GlslVersion::V330),
        Target::Glsl(GlslVersion::Es300),
        Target::Rust,
        Target::SpirV,
        Target::Hlsl,
        Target::Msl,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Target::Wgsl => "wgsl",
            Target::Glsl(GlslVersion::V450) => "glsl450",
            Target::Glsl(GlslVersion::V330) => "glsl330",
            Target::Glsl(GlslVersion::Es300) => "glsl_es300",
            Target::Rust => "rust",
            Target::SpirV => "spirv",
            Target::Hlsl => "hlsl",
            Target::Msl => "msl",
        }
    }

    /// The target with a name; `glsl` is the version 450.
    pub fn from_name(name: &str) -> Option<Self> {
        let name = if name == "glsl" { "glsl450" } else { name };
        Self::ALL.into_iter().find(|target| target.name() == name)
    }

    /// What the file name ends in, without the leading dot.
    pub fn extension(self) -> &'static str {
        match self {
            Target::Wgsl => "wgsl",
            Target::Glsl(GlslVersion::V450) => "450.glsl",
            Target::Glsl(GlslVersion::V330) => "330.glsl",
            Target::Glsl(GlslVersion::Es300) => "es300.glsl",
            Target::Rust => "rs",
            Target::SpirV => "spv",
            Target::Hlsl => "hlsl",
            Target::Msl => "metal",
        }
    }
}

/// Emits the plans of the functions of a table into one file, and validates it.
///
/// # Errors
/// As [`emit`].
pub fn emit_all(functions: &[Proved<'_>], target: Target) -> Result<Vec<u8>, Failure> {
    let Some(first) = functions.first() else { return Ok(Vec::new()) };
    let program = first.plan().program;
    let join = |texts: Vec<String>| texts.join("\n");
    match target {
        Target::Wgsl => {
            let source = join(functions.iter().map(wgsl).collect());
            wgsl_module(program, &source)?;
            Ok(source.into_bytes())
        }
        Target::Glsl(version) => {
            let source = join(functions.iter().map(|function| glsl(function, version)).collect());
            if version == GlslVersion::V450 {
                glsl_module(program, &harness::glsl_library(first, &source, version))?;
            }
            Ok(source.into_bytes())
        }
        Target::Rust => Ok(join(functions.iter().map(rust).collect()).into_bytes()),
        Target::SpirV | Target::Hlsl | Target::Msl => {
            let source = join(functions.iter().map(|f| harness::wgsl_columns(f, harness::Entry::Key)).collect());
            let module = wgsl_module(program, &source)?;
            let translated = match target {
                Target::SpirV => Translated::SpirV,
                Target::Hlsl => Translated::Hlsl,
                _ => Translated::Msl,
            };
            translate(program, &module, translated)
        }
    }
}

/// Emits a proved plan and validates what was emitted.
///
/// WGSL and GLSL 450 are parsed and validated by naga; SPIR-V, HLSL and MSL
/// are written by naga from the validated WGSL. GLSL 330 and ES 300, which
/// naga does not read, differ from GLSL 450 in their header only. GLSL of a
/// table whose output is a list is not read by naga either.
///
/// # Errors
/// When validation fails, which would be a bug of the printer.
pub fn emit(proved: &Proved<'_>, target: Target) -> Result<Vec<u8>, Failure> {
    match target {
        Target::Wgsl => {
            let source = wgsl(proved);
            wgsl_module(proved.plan().program, &harness::wgsl_library(proved, &source))?;
            Ok(source.into_bytes())
        }
        Target::Glsl(version) => {
            let source = glsl(proved, version);
            // naga's GLSL front end gives an array another type inside of a structure than outside.
            let readable = !matches!(proved.plan().program.output, Output::List { .. });
            if version == GlslVersion::V450 && readable {
                glsl_module(proved.plan().program, &harness::glsl_library(proved, &source, version))?;
            }
            Ok(source.into_bytes())
        }
        Target::Rust => Ok(rust(proved).into_bytes()),
        Target::SpirV | Target::Hlsl | Target::Msl => {
            let source = harness::wgsl_columns(proved, harness::Entry::Key);
            let module = wgsl_module(proved.plan().program, &source)?;
            let translated = match target {
                Target::SpirV => Translated::SpirV,
                Target::Hlsl => Translated::Hlsl,
                _ => Translated::Msl,
            };
            translate(proved.plan().program, &module, translated)
        }
    }
}

/// The WGSL module of a plan.
pub fn wgsl(proved: &Proved<'_>) -> String {
    module::write(proved, &wgsl::Wgsl)
}

/// The GLSL library of a plan: no `#version` line and no `main`.
pub fn glsl(proved: &Proved<'_>, version: GlslVersion) -> String {
    module::write(proved, &glsl::Glsl { version })
}

/// The Rust module of a plan.
pub fn rust(proved: &Proved<'_>) -> String {
    module::write(proved, &rust::Rust)
}
