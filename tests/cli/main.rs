//! The command: what it says, what it writes, and how it refuses.
#![allow(clippy::unwrap_used)]

mod area;
mod atlas;
mod bad_input;
mod certificates;
mod constructs;
mod coverage;
mod eval;
mod explain;
mod files;
mod findings;
mod fix;
mod functions;
mod integrals;
mod lists;
mod lsp;
mod render;
mod report;
mod stale;
#[path = "../support/mod.rs"]
mod support;
mod tables;
mod tools;
mod visible;
mod why;
mod worked_values;
mod writing;
