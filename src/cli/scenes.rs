//! `umbrage scenes`: the scenes that come with Umbrage.

use std::io::Write;

use serde_json::json;

use super::messages::{Format, Report};
use super::{Outcome, Result};
use crate::cli::output::stdout;
use crate::scene::Scene;

/// Lists the names, one a line; as JSON with what each scene shows.
pub(super) fn run(report: &Report) -> Result<Outcome> {
    let mut out = stdout();
    for name in Scene::names() {
        match report.format {
            Format::Human => writeln!(out, "{name}")?,
            Format::Json => writeln!(out, "{}", json!({ "name": name, "title": Scene::open(name)?.title }))?,
        }
    }
    Ok(Outcome::Clean)
}
