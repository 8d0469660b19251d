//! The chain of guards, as written: what every other shape is measured against.

use super::Definition;
use crate::plan::Plan;
use crate::plan::builder::{Builder, Guarded, Result};
use crate::plan::key::KeyLayout;
use crate::plan::knowledge::Knowledge;
use crate::plan::setting::Setting;

pub(super) static SHAPE: Definition = Definition {
    name: "ladder",
    summary: "the chain of guards, as written",
    reads_buffer: false,
    needs_key: false,
    holds_data: false,
    plan,
};

fn plan<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    let mut builder = Builder::new(program);
    let rows: Guarded = program.rows.iter().enumerate().map(|(i, row)| (i, row.guard)).collect();
    let root = builder.rows(&rows, &Knowledge::none(program))?;
    Ok(builder.finish(setting, KeyLayout::new(program)?, Vec::new(), root))
}
