//! WGSL, parsed and validated by naga.

use super::{Constant, Definition, joined};
use crate::diag::Failure;
use crate::emit::language::wgsl::Wgsl;
use crate::emit::{kernel, module, wgsl_module};
use crate::prove::Proved;

pub(super) static TARGET: Definition = Definition {
    name: "wgsl",
    extension: "wgsl",
    default: true,
    constant: Constant::text("The WGSL.", "WGSL"),
    write: |plans, _| Ok(validated(plans, Wgsl::Plain)?.into_bytes()),
};

/// The WGSL of plans, valid as part of a module that supplies what it needs.
pub(super) fn validated(plans: &[Proved<'_>], dialect: Wgsl) -> Result<String, Failure> {
    let source = joined(plans, |plan| module::write(plan, &dialect));
    if let Some(first) = plans.first() {
        let whole = plans.iter().fold(source.clone(), |text, plan| kernel::columns::wgsl_library(plan, &text));
        wgsl_module(first.plan().program, &whole)?;
    }
    Ok(source)
}
