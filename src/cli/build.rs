//! `umbrage build`: tables to generated files.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::PathBuf;

use super::fix::FixArguments;
use super::messages::{Format, Report, plural};
use super::plan::{self, PlanArgument};
use super::watch::Watched;
use super::{Error, Outcome, Result, levels, parse_target};
use crate::build::{self, Built, Options, Request};
use crate::cli::output::stdout;
use crate::emit::Target;
use crate::program::Program;
use crate::prove::is_unsuitable;

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
    /// Languages: wgsl, glsl450, glsl330, glsl_es300, rust, spirv, hlsl, msl [default: these]; and wesl, naga_oil,
    /// rust_bytemuck, rust_wgpu; and, to count which lines of the table give the results, wgsl_counting, glsl450_counting
    #[arg(long, value_name = "TARGET", value_delimiter = ',', value_parser = parse_target)]
    target: Vec<Target>,
    /// Techniques whose WGSL around the table to write, too, to skeletons/NAME.wgsl: hard, pcf, smsr, rsmss, rpcf,
    /// casefree, integrals
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    skeleton: Vec<String>,
    /// Also write what each plan and its table mean as SMT-LIB 2, to TABLE/PLAN.smt2: a solver such as z3 or cvc5 that
    /// answers `unsat` has found them equal, by no rule of the proof's
    #[arg(long)]
    certificates: bool,
    /// Build again whenever a table, a profile or a tuned choice changes, until interrupted. While there are errors,
    /// what was generated before stays
    #[arg(long)]
    watch: bool,
    #[command(flatten)]
    levels: levels::LevelArguments,
    #[command(flatten)]
    fix: FixArguments,
}

/// Builds every table. Nothing is written unless all of them are right.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let request = arguments.request();
    if !arguments.watch {
        return once(arguments, &request, report).map(|(outcome, _)| outcome);
    }
    let mut watched = Watched::new(request.paths.iter().chain(&request.profiles).chain(&request.tuned).cloned());
    loop {
        let (outcome, inputs) = match once(arguments, &request, report) {
            Err(Error::Failure(failure)) => {
                report.failure(&failure);
                (Outcome::Failed, BTreeSet::new())
            }
            done => done?,
        };
        if report.format == Format::Human {
            let mut out = stdout();
            let kept = if outcome == Outcome::Failed { "what was generated before stays; " } else { "" };
            writeln!(out, "{kept}waiting for changes (Ctrl+C ends this)")?;
            out.flush()?;
        }
        watched.wait(&inputs);
    }
}

/// Builds every table. Says how that went, and on which files it depends, those included that are not there.
fn once(arguments: &Arguments, request: &Request, report: &Report) -> Result<(Outcome, BTreeSet<PathBuf>)> {
    let batch = build::run(request);
    for message in &batch.messages {
        report.failure(message);
    }
    if batch.failed() {
        return Ok((Outcome::Failed, &batch.inputs | &batch.absent));
    }
    let files = batch.files();
    let written = build::write(&arguments.output, &files)?;
    if report.format == Format::Human {
        summary(&batch.tables, &request.options, files.len(), written, arguments)?;
    }
    Ok((if batch.warned() { Outcome::Findings } else { Outcome::Clean }, &batch.inputs | &batch.absent))
}

impl Arguments {
    /// The order that the arguments amount to.
    fn request(&self) -> Request {
        let mut options = Options { assume: self.assume, certificates: self.certificates, ..Options::default() };
        if !self.plan.is_empty() {
            (options.shapes, options.auto) = plan::split(&self.plan);
        }
        if !self.target.is_empty() {
            options.targets.clone_from(&self.target);
        }
        Request {
            paths: self.paths.clone(),
            options,
            profiles: self.profile.clone(),
            tuned: self.tuned.clone(),
            device: self.device.clone(),
            levels: self.levels.levels(),
            skeletons: self.skeleton.clone(),
            fix: self.fix.words().to_vec(),
        }
    }
}

fn summary(
    done: &[(Vec<Program>, Built)],
    options: &Options,
    count: usize,
    written: usize,
    arguments: &Arguments,
) -> Result<()> {
    let mut out = stdout();
    for (programs, built) in done {
        let Some(program) = programs.first() else { continue };
        if program.function.is_some() {
            let examples = plural(programs.iter().map(|program| program.examples.len()).sum(), "example");
            let functions = plural(programs.len(), "function");
            writeln!(out, "{}: {functions}, {examples} run", program.source.name)?;
        } else {
            let (cases, states) = (plural(program.case_count(), "case"), plural(program.states.count(), "state"));
            let (inputs, examples) = (plural(program.inputs.len(), "input"), plural(program.examples.len(), "example"));
            writeln!(out, "{}: {cases}, {inputs}, {states}, {examples} run", program.source.name)?;
        }
        for plan in &built.plans {
            let chosen = match plan.chosen_on.as_slice() {
                [] => String::new(),
                devices => format!("; chosen on {}", devices.join(", ")),
            };
            let auto = plan.fallback.as_ref().map_or(String::new(), |reason| format!("; `auto`: {reason}"));
            writeln!(out, "  {:<14} proved {}{chosen}{auto}", plan.name, plan.proof)?;
            match plan.beyond.as_deref() {
                None => {}
                Some([]) => writeln!(out, "  {:<14} certificate: linear", "")?,
                Some(beyond) => {
                    writeln!(out, "  {:<14} certificate, beyond linear arithmetic: {}", "", beyond.join("; "))?
                }
            }
        }
        for (name, reason) in &built.skipped {
            let why = match is_unsuitable(reason) {
                true => reason.diagnostics.iter().flat_map(|d| &d.notes).next().map_or("", String::as_str),
                false => "it is not equal to the table, which is a bug of the planner",
            };
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
