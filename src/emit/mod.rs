//! Printers: proved plan → source text, and through naga to SPIR-V, HLSL and MSL.
//!
//! Only a [`Proved`] plan can be printed. One walk over the plan
//! (`module`) decides what is said; a `Dialect` per
//! language decides how. What comes out depends on the table and the options
//! alone, so it is the same bytes on every machine.

pub(crate) mod function;
mod host;
mod imports;
pub mod kernel;
mod language;
mod module;
mod names;
pub mod reflect;
mod text;
mod validate;

use host::Host;
use language::wgsl::Wgsl;

use crate::diag::Failure;
use crate::program::Output;
use crate::prove::Proved;

pub use host::Beside;
pub use language::glsl::GlslVersion;
pub use module::lookup_words;
pub use validate::{Translated, Validated, glsl_module, translate, wgsl_module, wgsl_text};

/// A language to emit, and in what form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Target {
    /// WGSL to be pasted or concatenated.
    Wgsl,
    /// A module of WESL.
    Wesl,
    /// A module of naga_oil.
    NagaOil,
    /// A GLSL library.
    Glsl(GlslVersion),
    /// A Rust module without dependencies.
    Rust,
    /// The same with inputs that `bytemuck` turns into bytes.
    RustBytemuck,
    /// The same with a pipeline for `wgpu`.
    RustWgpu,
    /// A SPIR-V compute shader over columns of inputs.
    SpirV,
    /// The same as HLSL.
    Hlsl,
    /// The same as MSL.
    Msl,
}

impl Target {
    /// Every target, in the order of reports.
    pub const ALL: [Target; 12] = [
        Target::Wgsl,
        Target::Wesl,
        Target::NagaOil,
        Target::Glsl(GlslVersion::V450),
        Target::Glsl(GlslVersion::V330),
        Target::Glsl(GlslVersion::Es300),
        Target::Rust,
        Target::RustBytemuck,
        Target::RustWgpu,
        Target::SpirV,
        Target::Hlsl,
        Target::Msl,
    ];

    /// One target per language.
    pub const DEFAULT: [Target; 8] = [
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
            Target::Wesl => "wesl",
            Target::NagaOil => "naga_oil",
            Target::Glsl(GlslVersion::V450) => "glsl450",
            Target::Glsl(GlslVersion::V330) => "glsl330",
            Target::Glsl(GlslVersion::Es300) => "glsl_es300",
            Target::Rust => "rust",
            Target::RustBytemuck => "rust_bytemuck",
            Target::RustWgpu => "rust_wgpu",
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
            Target::Wesl => "wesl",
            Target::NagaOil => "naga_oil.wgsl",
            Target::Glsl(GlslVersion::V450) => "450.glsl",
            Target::Glsl(GlslVersion::V330) => "330.glsl",
            Target::Glsl(GlslVersion::Es300) => "es300.glsl",
            Target::Rust => "rs",
            Target::RustBytemuck => "bytemuck.rs",
            Target::RustWgpu => "wgpu.rs",
            Target::SpirV => "spv",
            Target::Hlsl => "hlsl",
            Target::Msl => "metal",
        }
    }

    /// What a Rust module offers besides functions, if this is one.
    fn host(self) -> Option<Host> {
        match self {
            Target::Rust => Some(Host::Plain),
            Target::RustBytemuck => Some(Host::Bytemuck),
            Target::RustWgpu => Some(Host::Wgpu),
            _ => None,
        }
    }
}

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
/// functions of a table. A Rust module embeds the files that lie `beside` it.
///
/// # Errors
/// As [`emit`].
pub fn emit_all(plans: &[Proved<'_>], target: Target, beside: &[Beside]) -> Result<Vec<u8>, Failure> {
    let Some(first) = plans.first() else { return Ok(Vec::new()) };
    let program = first.plan().program;
    let join = |write: &dyn Fn(&Proved<'_>) -> String| plans.iter().map(write).collect::<Vec<_>>().join("\n");
    let text = match target {
        Target::Wgsl | Target::Wesl | Target::NagaOil => {
            let dialect = if target == Target::Wgsl { Wgsl::Plain } else { Wgsl::Module };
            let source = join(&|plan| module::write(plan, &dialect));
            wgsl_module(
                program,
                &plans.iter().fold(source.clone(), |text, plan| kernel::columns::wgsl_library(plan, &text)),
            )?;
            imports::head(plans, target) + &source
        }
        Target::Glsl(version) => {
            let source = join(&|plan| glsl(plan, version));
            // naga's GLSL front end gives an array another type inside of a structure than outside.
            let readable = !plans.iter().any(|plan| matches!(plan.plan().program.output, Output::List { .. }));
            if version == GlslVersion::V450 && readable {
                glsl_module(program, &kernel::columns::glsl_library(first, &source, version))?;
            }
            source
        }
        Target::Rust | Target::RustBytemuck | Target::RustWgpu => {
            let host = target.host().unwrap_or(Host::Plain);
            host::modules(plans, host, beside)
        }
        Target::SpirV | Target::Hlsl | Target::Msl => {
            let source = join(&|plan| kernel::columns::wgsl_columns(plan, kernel::columns::Entry::Key));
            let module = wgsl_module(program, &source)?;
            let translated = match target {
                Target::SpirV => Translated::SpirV,
                Target::Hlsl => Translated::Hlsl,
                _ => Translated::Msl,
            };
            let mut out = translate(program, &module, translated)?;
            if translated != Translated::SpirV {
                let headers: String = plans.iter().map(module::header).collect();
                out.splice(0..0, headers.into_bytes());
            }
            return Ok(out);
        }
    };
    Ok(text.into_bytes())
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
