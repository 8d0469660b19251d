//! GLSL. The versions differ in their header only; naga reads the version 450, which is validated.

use super::{Constant, Definition, joined};
use crate::diag::Failure;
use crate::emit::{GlslVersion, glsl, glsl_module, kernel};
use crate::prove::Proved;

pub(super) static V450: Definition = Definition {
    name: "glsl450",
    extension: "450.glsl",
    default: true,
    constant: Constant::text("The library for GLSL 450.", "GLSL_450"),
    write: |plans, _| validated(plans).map(String::into_bytes),
};

pub(super) static V330: Definition = Definition {
    name: "glsl330",
    extension: "330.glsl",
    default: true,
    constant: Constant::text("The library for GLSL 330.", "GLSL_330"),
    write: |plans, _| Ok(joined(plans, |plan| glsl(plan, GlslVersion::V330)).into_bytes()),
};

pub(super) static ES300: Definition = Definition {
    name: "glsl_es300",
    extension: "es300.glsl",
    default: true,
    constant: Constant::text("The library for GLSL ES 300.", "GLSL_ES_300"),
    write: |plans, _| Ok(joined(plans, |plan| glsl(plan, GlslVersion::Es300)).into_bytes()),
};

fn validated(plans: &[Proved<'_>]) -> Result<String, Failure> {
    let version = GlslVersion::V450;
    let source = joined(plans, |plan| glsl(plan, version));
    // naga's GLSL front end gives an array another type inside of a structure than outside.
    let readable = !plans.iter().any(|plan| plan.plan().program.output.data_type().has_array());
    if let Some(first) = plans.first().filter(|_| readable) {
        glsl_module(first.plan().program, &kernel::columns::glsl_library(first, &source, version))?;
    }
    Ok(source)
}
