//! `umbrage techniques`: the techniques, with what they need and take.

use std::io::Write;

use serde_json::json;

use super::messages::{Format, Report};
use super::{Outcome, Result};
use crate::cli::output::stdout;
use crate::technique::{self, Technique};

/// Lists every technique with its tables, lights and settings.
pub(super) fn run(report: &Report) -> Result<Outcome> {
    let mut out = stdout();
    for technique in technique::ALL {
        match report.format {
            Format::Human => human(&mut out, *technique)?,
            Format::Json => writeln!(out, "{}", object(*technique))?,
        }
    }
    Ok(Outcome::Clean)
}

fn human(out: &mut impl Write, technique: &dyn Technique) -> Result<()> {
    writeln!(out, "{technique}: {}", technique.doc())?;
    let tables: Vec<&str> = technique.tables().iter().map(|table| table.name).collect();
    let tables = if tables.is_empty() { String::new() } else { format!("; tables: {}", tables.join(", ")) };
    writeln!(out, "  takes {}{tables}", technique.lights())?;
    for setting in technique.settings() {
        let (name, default) = (setting.name, setting.default);
        writeln!(out, "  {name:<14} {}; {} [default: {default}]", setting.doc, setting.range)?;
    }
    Ok(())
}

fn object(technique: &dyn Technique) -> serde_json::Value {
    let setting = |setting: &technique::Setting| {
        json!({
            "name": setting.name, "doc": setting.doc,
            "default": setting.default.to_string(), "range": setting.range.to_string(),
        })
    };
    json!({
        "name": technique.name(), "doc": technique.doc(),
        "tables": technique.tables().iter().map(|table| table.name).collect::<Vec<_>>(),
        "lights": technique.lights().to_string(),
        "settings": technique.settings().iter().map(setting).collect::<Vec<_>>(),
    })
}
