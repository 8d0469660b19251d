//! A module of WESL: validated WGSL behind an import of what the host supplies.

use super::{Constant, Definition, wgsl};
use crate::emit::imports;
use crate::emit::language::wgsl::Wgsl;

pub(super) static TARGET: Definition = Definition {
    name: "wesl",
    extension: "wesl",
    default: false,
    constant: Constant::text("The WESL module.", "WESL"),
    write: |plans, _| {
        let import = imports::import(plans, |table, items| format!("import package::{table}_host::{{{items}}};\n"));
        Ok((import + &wgsl::validated(plans, Wgsl::Module)?).into_bytes())
    },
};
