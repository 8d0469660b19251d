//! Compute shaders over columns of inputs, written by naga from validated WGSL.

use super::{Constant, Definition, joined};
use crate::diag::Failure;
use crate::emit::{Translated, kernel, module, translate, wgsl_module};
use crate::prove::Proved;

pub(super) static SPIRV: Definition = Definition {
    name: "spirv",
    extension: "spv",
    default: true,
    constant: Some(Constant { doc: "The compute shader as SPIR-V.", name: "SPIRV", text: false }),
    write: |plans, _| translated(plans, Translated::SpirV),
};

pub(super) static HLSL: Definition = Definition {
    name: "hlsl",
    extension: "hlsl",
    default: true,
    constant: Constant::text("The compute shader as HLSL.", "HLSL"),
    write: |plans, _| with_header(plans, Translated::Hlsl),
};

pub(super) static MSL: Definition = Definition {
    name: "msl",
    extension: "metal",
    default: true,
    constant: Constant::text("The compute shader as MSL.", "MSL"),
    write: |plans, _| with_header(plans, Translated::Msl),
};

fn translated(plans: &[Proved<'_>], to: Translated) -> Result<Vec<u8>, Failure> {
    let Some(first) = plans.first() else { return Ok(Vec::new()) };
    let program = first.plan().program;
    let source = joined(plans, |plan| kernel::columns::wgsl_columns(plan, kernel::columns::Entry::Key));
    translate(program, &wgsl_module(program, &source)?, to)
}

/// Text with the comments that WGSL begins with, which naga drops.
fn with_header(plans: &[Proved<'_>], to: Translated) -> Result<Vec<u8>, Failure> {
    let mut out: Vec<u8> = plans.iter().map(module::header).collect::<String>().into_bytes();
    out.extend(translated(plans, to)?);
    Ok(out)
}
