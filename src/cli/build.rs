//! `umbrage build`: tables to generated files.

use std::io::{self, Write};
use std::path::PathBuf;

use super::plan::{self, PlanArgument};
use super::report::{Format, Report};
use super::{Outcome, Result, levels, parse_target};
use crate::analyse::Levels;
use crate::build::{self, Built, NamedProfile, Options};
use crate::diag::{Diagnostic, Failure, Severity, codes};
use crate::emit::Target;
use crate::profile;
use crate::program::Program;
use crate::table::Table;
use crate::tuned::slug;

/// Arguments of `umbrage build`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Tables, or directories that contain tables (files named *.ron, at any depth)
    #[arg(value_name = "PATH", default_value = "tables")]
    paths: Vec<PathBuf>,
    /// Directory for the generated files, one folder per table
    #[arg(long, short, value_name = "DIR", default_value = "generated")]
    output: PathBuf,
    /// Code shapes: ladder, ordered, nested, gathered, tree, switch, switch_buffer, coefficients, orbit; and auto, what
    /// `umbrage tune` chose, or else switch, or ladder where the key is too large [default: ladder,ordered,switch,auto]
    #[arg(long, value_name = "PLAN", value_delimiter = ',', value_parser = plan::parse_plan)]
    plan: Vec<PlanArgument>,
    /// Profiles to plan for, each for the table that it counts [default: profiles/TABLE.ron beside the directory of
    /// the tables, if there is one]
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    profile: Vec<PathBuf>,
    /// Directory of what `umbrage tune` chose, for auto [default: tuned beside the directory of the tables]
    #[arg(long, value_name = "DIR")]
    tuned: Option<PathBuf>,
    /// For auto, only what was chosen on this device [default: on any]
    #[arg(long, value_name = "NAME")]
    device: Option<String>,
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
        (options.shapes, options.auto) = plan::split(&arguments.plan);
    }
    if !arguments.target.is_empty() {
        options.targets.clone_from(&arguments.target);
    }
    let given: Vec<NamedProfile> = arguments
        .profile
        .iter()
        .map(|path| Ok((path.clone(), profile::read(path)?)))
        .collect::<std::result::Result<_, Failure>>()?;
    let levels = arguments.levels.levels();
    let mut done: Vec<(Vec<Program>, Built)> = Vec::new();
    let mut outcome = Outcome::Clean;
    for path in &arguments.paths {
        let evidence = Evidence { given: &given, profiles: build::beside(path, "profiles") };
        if options.auto {
            let directory = arguments.tuned.clone().or_else(|| build::beside(path, "tuned"));
            options.tuned = directory.map_or(Ok(Vec::new()), |directory| build::tuned_in(&directory))?;
            let device = arguments.device.as_deref().map(slug);
            options.tuned.retain(|tuned| device.as_ref().is_none_or(|device| slug(&tuned.device) == *device));
        }
        for file in build::find_tables(path)? {
            // An exhibit is built only if it was named.
            let result = Table::read(&file).and_then(|table| match path.is_dir() && table.exhibit.is_some() {
                true => Ok(None),
                false => one(&table, &evidence, &mut options, &levels, report, &done).map(Some),
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
    for (path, profile) in &given {
        if !done.iter().any(|(_, built)| built.table == profile.table) {
            let message = format!("is a profile of the table `{}`, which is not among those built", profile.table);
            let error = Diagnostic::error(codes::OTHER_PROFILE, message).help("name its table, too, or leave it out");
            return Err(Failure::bare(path.to_string_lossy().replace('\\', "/"), error).into());
        }
    }
    let files: Vec<_> = done.iter().flat_map(|(_, built)| built.files.iter().cloned()).collect();
    let written = build::write(&arguments.output, &files)?;
    if report.format == Format::Human {
        summary(&done, &options, files.len(), written, arguments)?;
    }
    Ok(outcome)
}

/// Where the profiles of tables are.
struct Evidence<'a> {
    given: &'a [NamedProfile],
    profiles: Option<PathBuf>,
}

impl Evidence<'_> {
    /// The profiles of a table: those given, or else the one that lies beside it.
    fn of(&self, table: &str) -> std::result::Result<Vec<NamedProfile>, Failure> {
        let given: Vec<_> = self.given.iter().filter(|(_, profile)| profile.table == table).cloned().collect();
        match &self.profiles {
            Some(directory) if given.is_empty() => Ok(build::profile_of(table, directory)?.into_iter().collect()),
            _ => Ok(given),
        }
    }
}

fn one(
    table: &Table,
    evidence: &Evidence<'_>,
    options: &mut Options,
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
    let mut found = match findings.iter().any(|finding| finding.severity == Severity::Warning) {
        true => Outcome::Findings,
        false => Outcome::Clean,
    };
    report.show(&source, &findings);
    for program in programs.iter().filter(|program| program.function.is_none()) {
        for warning in build::weigh(program, &evidence.of(&program.name)?, options)? {
            report.failure(&Failure::bare("", warning));
            found = Outcome::Findings;
        }
    }
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
        for plan in &built.plans {
            let chosen = match plan.chosen_on.as_slice() {
                [] => String::new(),
                devices => format!("; chosen on {}", devices.join(", ")),
            };
            writeln!(out, "  {:<14} proved {}{chosen}", plan.name, plan.proof)?;
        }
        for (name, reason) in &built.skipped {
            let why = reason.diagnostics.iter().flat_map(|d| &d.notes).next().map_or("", String::as_str);
            writeln!(out, "  {:<14} left out: {why}", name)?;
        }
    }
    let targets: Vec<&str> = options.targets.iter().map(|target| target.name()).collect();
    writeln!(out, "targets: {}; validated by naga where it reads or writes the language", targets.join(", "))?;
    let place = arguments.output.display();
    writeln!(out, "{place}: {count} files, {written} written, {} unchanged", count - written)?;
    out.flush()?;
    Ok(())
}
