//! Variants that count: every result tells the host by which line of the table it came about.
//!
//! The host supplies `NAME_hit(number)`, which adds one to a counter of its own; numbers are those of
//! [`Program::outcomes`](crate::program::Program::outcomes). `umbrage profile --hits` reads what was counted.

use super::{Constant, Definition, joined};
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::language::glsl::Glsl;
use crate::emit::language::wgsl::Wgsl;
use crate::emit::{GlslVersion, glsl_module, kernel, module, wgsl_module};
use crate::plan::Step;
use crate::prove::Proved;

pub(super) static WGSL: Definition = Definition {
    name: "wgsl_counting",
    extension: "counting.wgsl",
    default: false,
    constant: Constant::text("The WGSL that counts.", "WGSL_COUNTING"),
    write: |plans, _| wgsl(plans).map(String::into_bytes),
};

pub(super) static GLSL: Definition = Definition {
    name: "glsl450_counting",
    extension: "counting.450.glsl",
    default: false,
    constant: Constant::text("The library for GLSL 450 that counts.", "GLSL_450_COUNTING"),
    write: |plans, _| glsl(plans).map(String::into_bytes),
};

fn wgsl(plans: &[Proved<'_>]) -> Result<String, Failure> {
    plans.iter().try_for_each(tells_lines)?;
    let source = joined(plans, |plan| module::write_counting(plan, &Wgsl::Plain));
    if let Some(first) = plans.first() {
        let whole = plans.iter().fold(source.clone(), |text, plan| {
            let stub = format!("fn {}(number: u32) {{}}\n", module::hit(plan));
            kernel::columns::wgsl_library(plan, &(text + &stub))
        });
        wgsl_module(first.plan().program, &whole)?;
    }
    Ok(source)
}

fn glsl(plans: &[Proved<'_>]) -> Result<String, Failure> {
    plans.iter().try_for_each(tells_lines)?;
    let version = GlslVersion::V450;
    let source = joined(plans, |plan| module::write_counting(plan, &Glsl { version }));
    let readable = !plans.iter().any(|plan| plan.plan().program.output.data_type().has_array());
    if let Some(first) = plans.first().filter(|_| readable) {
        let stubs: String =
            plans.iter().map(|plan| format!("void {}(uint number) {{}}\n", module::hit(plan))).collect();
        glsl_module(first.plan().program, &kernel::columns::glsl_library(first, &(stubs + &source), version))?;
    }
    Ok(source)
}

/// Refuses plans whose results come from no line of the table.
fn tells_lines(proved: &Proved<'_>) -> Result<(), Failure> {
    let plan = proved.plan();
    let reason = match plan.step(plan.behind_fetches()) {
        Step::Coefficients { .. } => "computes results from coefficients",
        Step::Orbit { .. } => "turns its inputs by symmetries",
        Step::Test { .. } | Step::Fetch { .. } | Step::Gather { .. } | Step::Switch { .. } | Step::Leaf(_) => {
            return Ok(());
        }
    };
    let message = format!("the plan `{}` {reason}, so it cannot count lines of the table", plan.shape);
    let error = Diagnostic::error(codes::NOT_APPLICABLE, message).help("count with another plan: --plan switch");
    Err(Failure::new(plan.program.source.clone(), error))
}
