//! `umbrage fmt`: tables in the layout of this project.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::messages::{Format, Report};
use super::output::{Sink, finish_all, stdout};
use super::{Outcome, Result};
use crate::build;
use crate::diag::{Failure, Source};
use crate::format;
use crate::text::file::{STDIN, read_stdin, read_text, settle, shown, utf8};

/// Largest accepted table, in bytes.
const MAX_BYTES: u64 = 16 << 20;

/// Arguments of `umbrage fmt`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Tables, or directories that contain tables (files named *.ron, at any depth); `-` is standard input, whose
    /// table goes to standard output
    #[arg(value_name = "PATH", default_value = "tables")]
    paths: Vec<PathBuf>,
    /// Change nothing; name the tables that would change, and end with exit code 1 if there are any
    #[arg(long)]
    check: bool,
}

/// A table before and after.
struct Formatted {
    path: PathBuf,
    before: Arc<Source>,
    after: String,
}

/// Formats every table. Nothing is written unless all of them could be read.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let mut done = Vec::new();
    let mut outcome = Outcome::Clean;
    for path in &arguments.paths {
        let files = if path.as_os_str() == "-" { vec![path.clone()] } else { build::find_tables(path)? };
        // A run that was interrupted may have left a table that is formatted but not in its place.
        let directories: BTreeSet<&Path> = files.iter().filter_map(|file| file.parent()).collect();
        for directory in directories.into_iter().filter(|_| !arguments.check && path.as_os_str() != "-") {
            settle(if directory.as_os_str().is_empty() { Path::new(".") } else { directory })?;
        }
        for file in files {
            let formatted = read(&file).and_then(|before| {
                let after = format::format(&before)?;
                Ok(Formatted { path: file, before, after })
            });
            match formatted {
                Ok(formatted) => done.push(formatted),
                Err(failure) => {
                    report.failure(&failure);
                    outcome = Outcome::Failed;
                }
            }
        }
    }
    if outcome == Outcome::Failed {
        return Ok(outcome);
    }
    if arguments.check { show(&done, report) } else { write(&done, report) }
}

/// Says which tables would change, and where they first would.
fn show(done: &[Formatted], report: &Report) -> Result<Outcome> {
    let mut out = stdout();
    let changed = done.iter().filter(|table| table.before.text != table.after);
    let mut outcome = Outcome::Clean;
    for table in changed {
        outcome = Outcome::Findings;
        let (old, new): (Vec<&str>, Vec<&str>) = (table.before.text.lines().collect(), table.after.lines().collect());
        let first = old.iter().zip(&new).take_while(|(old, new)| old == new).count();
        let (name, line) = (&table.before.name, first + 1);
        match report.format {
            Format::Json => writeln!(out, "{}", serde_json::json!({"file": name, "line": line}))?,
            Format::Human => {
                writeln!(out, "{name}:{line}: is laid out otherwise")?;
                for (sign, lines) in [('-', &old), ('+', &new)] {
                    if let Some(text) = lines.get(first) {
                        writeln!(out, "  {sign} {text}")?;
                    }
                }
            }
        }
    }
    out.flush()?;
    Ok(outcome)
}

/// Replaces the tables that change.
fn write(done: &[Formatted], report: &Report) -> Result<Outcome> {
    let (mut changed, mut sinks) = (Vec::new(), Vec::new());
    for table in done.iter().filter(|table| table.path.as_os_str() == "-" || table.before.text != table.after) {
        let mut sink = Sink::replace(&table.path)?;
        sink.write_all(table.after.as_bytes())?;
        changed.push(table);
        sinks.push(sink);
    }
    finish_all(sinks)?;
    for table in changed {
        if report.format == Format::Human && table.path.as_os_str() != "-" {
            writeln!(stdout(), "formatted {}", table.before.name)?;
        }
    }
    Ok(Outcome::Clean)
}

fn read(path: &Path) -> std::result::Result<Arc<Source>, Failure> {
    if path.as_os_str() != "-" {
        let name = shown(path);
        return Ok(Source::new(name, read_text(path, MAX_BYTES)?));
    }
    Ok(Source::new(STDIN, utf8(Path::new(STDIN), read_stdin(MAX_BYTES)?)?))
}
