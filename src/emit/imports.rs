//! What stands before WGSL that is a module: its name, and what it imports.
//!
//! What the host supplies cannot be seen by a module unless it is imported, so
//! it is expected in a module of the host with a fixed name.

use super::Target;
use super::language::Prefix;
use super::names::fetches;
use crate::prove::Proved;

/// The first lines of a module; empty for WGSL that is none.
pub(super) fn head(plans: &[Proved<'_>], target: Target) -> String {
    let Some(first) = plans.first() else { return String::new() };
    let table = first.plan().program.table();
    let items: Vec<String> = plans.iter().flat_map(supplied).collect();
    let import = |keyword: &str, path: String, end: &str| match items.is_empty() {
        true => String::new(),
        false => format!("{keyword} {path}_host::{{{}}}{end}\n", items.join(", ")),
    };
    match target {
        Target::Wesl => import("import", format!("package::{table}"), ";"),
        Target::NagaOil => {
            format!("#define_import_path umbrage::{table}\n") + &import("#import", format!("umbrage::{table}"), "")
        }
        _ => String::new(),
    }
}

/// The names that the host supplies.
fn supplied(proved: &Proved<'_>) -> Vec<String> {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let fetches = fetches(program);
    let mut names = Vec::new();
    if !fetches.is_empty() {
        names.push(prefix.site());
    }
    names.extend(fetches.iter().map(|(ident, _)| format!("{}_fetch_{ident}", prefix.lower)));
    if proved.plan().reads_lookup() {
        names.push(format!("{}_lookup", prefix.lower));
    }
    names
}
