//! The imports of WGSL that is a module.
//!
//! A module cannot see what the host supplies unless it imports it, so
//! it is expected in a module of the host with a fixed name.

use super::inputs::fetches;
use super::language::Prefix;
use crate::prove::Proved;

/// The line that imports what the host supplies, from the table's name and the items; empty if there is nothing.
pub(super) fn import(plans: &[Proved<'_>], line: impl Fn(&str, &str) -> String) -> String {
    let Some(first) = plans.first() else { return String::new() };
    let items: Vec<String> = plans.iter().flat_map(supplied).collect();
    if items.is_empty() { String::new() } else { line(first.plan().program.table(), &items.join(", ")) }
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
    names.extend(fetches.iter().map(|fetch| format!("{}_fetch_{}", prefix.lower, fetch.ident)));
    if proved.plan().reads_lookup() {
        names.push(format!("{}_lookup", prefix.lower));
    }
    names
}
