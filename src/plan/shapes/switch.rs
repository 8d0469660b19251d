//! The packed key selects the case, or the few that conditions on continuous
//! and fetched inputs still have to decide between, through a lookup.

use super::Definition;
use crate::plan::arms::Arms;
use crate::plan::builder::{Builder, Result};
use crate::plan::key::{KeyLayout, MAX_BUFFER_BITS};
use crate::plan::setting::Setting;
use crate::plan::{Plan, Step};

/// Most bits of a key whose lookup lies in the code.
const MAX_CONSTANT_BITS: u32 = 12;

pub(super) static CONSTANTS: Definition = Definition {
    name: "switch",
    summary: "the packed key selects the case through a lookup in constants, then a `switch`",
    reads_buffer: false,
    needs_key: true,
    holds_data: false,
    plan: |setting| plan(setting, MAX_CONSTANT_BITS, "use `switch_buffer` or `ladder`"),
};

pub(super) static BUFFER: Definition = Definition {
    name: "switch_buffer",
    summary: "the same with the lookup in a buffer of the host, which supplies a function that reads a word of it",
    reads_buffer: true,
    needs_key: true,
    holds_data: false,
    plan: |setting| plan(setting, MAX_BUFFER_BITS, "use `ladder`"),
};

fn plan<'p>(setting: &Setting<'p, '_>, limit: u32, advice: &str) -> Result<Plan<'p>> {
    let program = setting.program;
    let key = KeyLayout::new(program)?;
    key.fits(limit, advice)?;
    let mut builder = Builder::new(program);
    let arms = Arms::new(&mut builder, setting)?;
    let steps = arms.steps(&mut builder)?;
    // States that do not occur go where most go.
    let lookup = arms.of_state(setting).into_iter().map(|arm| arm.unwrap_or_default()).collect();
    let root = builder.push(Step::Switch { arms: steps })?;
    Ok(builder.finish(setting, key, lookup, root))
}
