//! A module of naga_oil: validated WGSL behind its name and an import of what the host supplies.

use super::{Constant, Definition, wgsl};
use crate::emit::imports;
use crate::emit::language::wgsl::Wgsl;

pub(super) static TARGET: Definition = Definition {
    name: "naga_oil",
    extension: "naga_oil.wgsl",
    default: false,
    constant: Constant::text("The module for naga_oil.", "NAGA_OIL"),
    write: |plans, _| {
        let table = plans.first().map_or("", |first| first.plan().program.table());
        let name = format!("#define_import_path umbrage::{table}\n");
        let import = imports::import(plans, |table, items| format!("#import umbrage::{table}_host::{{{items}}}\n"));
        Ok((name + &import + &wgsl::validated(plans, Wgsl::Module)?).into_bytes())
    },
};
