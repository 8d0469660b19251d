//! `umbrage build`: tables to generated files.

use std::io::{self, Write};
use std::path::PathBuf;

use super::report::{Format, Report};
use super::{Outcome, Result, levels, parse_shape, parse_target};
use crate::analyse::Levels;
use crate::build::{self, Built, Options};
use crate::diag::{Diagnostic, Failure, Severity, codes};
use crate::emit::Target;
use crate::plan::Shape;
use crate::program::Program;
use crate::table::Table;

/// Arguments of `umbrage build`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Tables, or directories that contain tables (files named *.ron, at any depth)
    #[arg(value_name = "PATH", default_value = "tables")]
    paths: Vec<PathBuf>,
    /// Directory for the generated files, one folder per table
    #[arg(long, short, value_name = "DIR", default_value = "generated")]
    output: PathBuf,
    /// Code shapes: ladder, ordered, nested, tree, switch, switch_buffer, coefficients, orbit [default: ladder,switch]
    #[arg(long, value_name = "PLAN", value_delimiter = ',', value_parser = parse_shape)]
    plan: Vec<Shape>,
    /// Let plans do anything where the table's assumptions do not hold
    #[arg(long)]
    assume: bool,
    /// Languages: wgsl, glsl450, glsl330, glsl_es300, rust, spirv, hlsl, msl [default: all]
    #[arg(long, value_name = "TARGET", value_delimiter = ',', value_parser = parse_target)]
    target: Vec<Target>,
    #[command(flatten)]
    levels: levels::LevelArguments,
}

/// Builds every table. Nothing is written unless all of them are right.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let mut options = Options { assume: arguments.assume, ..Options::default() };
    if !arguments.plan.is_empty() {
        options.shapes.clone_from(&arguments.plan);
    }
    if !arguments.target.is_empty() {
        options.targets.clone_from(&arguments.target);
    }
    let levels = arguments.levels.levels();
    let mut done: Vec<(Vec<Program>, Built)> = Vec::new();
    let mut outcome = Outcome::Clean;
    for path in &arguments.paths {
        for file in build::find_tables(path)? {
            // An exhibit is built only if it was named.
            let result = Table::read(&file).and_then(|table| match path.is_dir() && table.exhibit.is_some() {
                true => Ok(None),
                false => one(&table, &options, &levels, report, &done).map(Some),
            });
            match result {
                Ok(None) => {}
                Ok(Some((built, found))) => {
                    outcome = outcome.max(found);
                    done.push(built);
                }
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
    let files: Vec<_> = done.iter().flat_map(|(_, built)| built.files.iter().cloned()).collect();
    let written = build::write(&arguments.output, &files)?;
    if report.format == Format::Human {
        summary(&done, &options, files.len(), written, arguments)?;
    }
    Ok(outcome)
}

fn one(
    table: &Table,
    options: &Options,
    levels: &Levels,
    report: &Report,
    done: &[(Vec<Program>, Built)],
) -> std::result::Result<((Vec<Program>, Built), Outcome), Failure> {
    let (name, source) = (table.name.value.clone(), table.source.clone());
    if let Some((other, _)) = done.iter().find(|(_, built)| built.table == name) {
        let other = other.first().map_or("", |program| program.source.name.as_str());
        let message = format!("`{other}` and this file both define the table `{name}`");
        let error =
            Diagnostic::error(codes::DUPLICATE, message).help("their output would go to the same folder; rename one");
        return Err(Failure::new(source, error));
    }
    let programs = Program::check_all(table)?;
    // Notes are for `check`: here they would hide what was built.
    let findings: Vec<Diagnostic> =
        programs.iter().flat_map(|program| crate::analyse::problems(program, levels)).collect();
    if findings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(Failure { source, diagnostics: findings });
    }
    let found = match findings.iter().any(|finding| finding.severity == Severity::Warning) {
        true => Outcome::Findings,
        false => Outcome::Clean,
    };
    report.show(&source, &findings);
    let built = build::programs(&programs, options)?;
    Ok(((programs, built), found))
}

fn summary(
    done: &[(Vec<Program>, Built)],
    options: &Options,
    count: usize,
    written: usize,
    arguments: &Arguments,
) -> Result<()> {
    let mut out = io::stdout().lock();
    for (programs, built) in done {
        let Some(program) = programs.first() else { continue };
        if program.function.is_some() {
            let examples: usize = programs.iter().map(|program| program.examples.len()).sum();
            writeln!(out, "{}: {} functions, {examples} examples hold", program.source.name, programs.len())?;
        } else {
            let (cases, states) = (program.rows.len(), program.states.count());
            writeln!(
                out,
                "{}: {cases} cases, {} inputs, {states} states, {} examples hold",
                program.source.name,
                program.inputs.len(),
                program.examples.len()
            )?;
        }
        for (shape, proof) in &built.plans {
            writeln!(out, "  {:<14} proved {proof}", shape.name())?;
        }
        for (shape, reason) in &built.skipped {
            let why = reason.diagnostics.iter().flat_map(|d| &d.notes).next().map_or("", String::as_str);
            writeln!(out, "  {:<14} left out: {why}", shape.name())?;
        }
    }
    let targets: Vec<&str> = options.targets.iter().map(|target| target.name()).collect();
    writeln!(out, "targets: {}; validated by naga where it reads or writes the language", targets.join(", "))?;
    let place = arguments.output.display();
    writeln!(out, "{place}: {count} files, {written} written, {} unchanged", count - written)?;
    out.flush()?;
    Ok(())
}
