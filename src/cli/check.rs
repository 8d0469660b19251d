//! `umbrage check`: tables, their findings and their examples.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::fix::FixArguments;
use super::messages;
use super::messages::{Format, Report, plural};
use super::{Outcome, Result, levels};
use crate::analyse::{self, LintLevels, Verdict};
use crate::build;
use crate::cli::output::stdout;
use crate::diag::{Failure, Severity};
use crate::program::Program;
use crate::table::Table;

/// Arguments of `umbrage check`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Tables, or directories that contain tables (files named *.ron, at any depth)
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    levels: levels::LevelArguments,
    #[command(flatten)]
    fix: FixArguments,
}

/// Checks every table; a bad one does not keep the others from being checked.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let mut out = stdout();
    let mut outcome = Outcome::Clean;
    let levels = arguments.levels.levels();
    for path in &arguments.paths {
        let files = match build::find_tables(path) {
            Ok(files) => files,
            Err(failure) => {
                outcome = outcome.max(show(&mut out, report, &failure)?);
                continue;
            }
        };
        for file in files {
            outcome = outcome.max(table(&mut out, report, &file, (&levels, &arguments.fix), path.is_dir())?);
        }
    }
    out.flush()?;
    Ok(outcome)
}

/// Checks one table and says how that went. What is found in an exhibit is shown only if it was named.
fn table(
    out: &mut impl Write,
    report: &Report,
    file: &Path,
    (levels, fix): (&LintLevels, &FixArguments),
    walked: bool,
) -> Result<Outcome> {
    let checked = Table::read(file).and_then(|table| {
        let programs = Program::check_all(&table)?.into_iter().map(|program| fix.apply(program));
        Ok((programs.collect::<std::result::Result<Vec<_>, Failure>>()?, table))
    });
    let (programs, declared) = match checked {
        Ok(checked) => checked,
        Err(failure) => {
            let outcome = show(out, report, &failure)?;
            if report.format == Format::Human {
                let count = failure.diagnostics.len();
                writeln!(out, "FAIL  {}: {}", failure.source.name, plural(count, "error"))?;
            }
            return Ok(outcome);
        }
    };
    let Some(program) = programs.first() else {
        if report.format == Format::Human {
            let sets = plural(declared.levels.len(), "level set");
            let constants = plural(declared.constants.len(), "constant");
            writeln!(out, "ok    {}: {sets}, {constants}", declared.source.name)?;
        }
        return Ok(Outcome::Clean);
    };
    let found = analyse::report_all(&programs, levels);
    if walked && program.exhibit.is_some() {
        if report.format == Format::Human {
            let count = plural(found.open.len(), "finding");
            writeln!(out, "exhibit {}: {count}, shown by `umbrage check {0}`", program.source.name)?;
        }
        return Ok(Outcome::Clean);
    }
    let failure = Failure { source: program.source.clone(), diagnostics: found.open };
    let outcome = show(out, report, &failure)?;
    if report.format == Format::Json {
        out.write_all(messages::acknowledged_lines(&failure.source, &found.acknowledged).as_bytes())?;
    }
    if report.format == Format::Human {
        let verdict = match outcome {
            Outcome::Clean => "ok   ",
            Outcome::Findings => "warn ",
            Outcome::Failed => "FAIL ",
        };
        let examples = plural(programs.iter().map(|program| program.examples.len()).sum(), "example");
        if program.function.is_some() {
            let functions = plural(programs.len(), "function");
            writeln!(out, "{verdict} {}: {functions}, {examples} run{}", program.source.name, claims(program))?;
            return Ok(outcome);
        }
        let fetched = program.fetched.iter().count();
        let inputs = plural(program.inputs.len(), "input");
        writeln!(
            out,
            "{verdict} {}: {}, {inputs}{}, {}, {examples} run{}{}",
            program.source.name,
            plural(program.case_count(), "case"),
            if fetched > 0 { format!(" ({fetched} fetched)") } else { String::new() },
            plural(program.states.count(), "state"),
            claims(program),
            match found.acknowledged.len() {
                0 => String::new(),
                count => format!(", {} acknowledged", plural(count, "finding")),
            },
        )?;
    }
    Ok(outcome)
}

/// The claims of a table in words: how many there are, and how many were tried out only.
fn claims(program: &Program) -> String {
    let verdicts = analyse::claims(program);
    if verdicts.is_empty() {
        return String::new();
    }
    let tried: Vec<&str> = (verdicts.iter())
        .filter(|(_, verdict)| matches!(verdict, Verdict::Tried(_)))
        .map(|(claim, _)| claim.name.as_str())
        .collect();
    let all = plural(verdicts.len(), "claim");
    if tried.is_empty() { format!(", {all}") } else { format!(", {all} (tried, not proved: {})", tried.join(", ")) }
}

/// Shows diagnostics. As JSON they are what the command is asked for, so they go to standard output.
fn show(out: &mut impl Write, report: &Report, failure: &Failure) -> Result<Outcome> {
    match report.format {
        Format::Json => out.write_all(messages::lines(&failure.source, &failure.diagnostics).as_bytes())?,
        Format::Human => report.failure(failure),
    }
    Ok(match failure.diagnostics.iter().map(|d| d.severity).max() {
        Some(Severity::Error) => Outcome::Failed,
        Some(Severity::Warning) => Outcome::Findings,
        Some(Severity::Note) | None => Outcome::Clean,
    })
}
