//! `umbrage diff`: every plan on a GPU against the interpreter.

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;

use super::messages::{Format, Report};
use super::plan::{self, PlanArgument};
use super::{Outcome, Result, input};
use crate::build;
use crate::cli::output::stdout;
use crate::diag::{Diagnostic, Failure, codes};
use crate::diff::{self, Options};
use crate::gpu::{AdapterChoice, Gpu, Language};
use crate::plan::Weights;
use crate::profile;
use crate::program::Program;
use crate::text::file::shown;
use crate::tuned::{Auto, Fallback, Tuned};

/// Arguments of `umbrage diff`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Tables, or directories that contain tables (files named *.ron, at any depth)
    #[arg(value_name = "PATH", default_value = "tables")]
    paths: Vec<PathBuf>,
    /// The adapter: any, software, hardware, or a part of its name
    #[arg(long, value_name = "WHICH", default_value = "any")]
    adapter: AdapterChoice,
    /// Code shapes: ladder, ordered, nested, gathered, tree, switch, switch_buffer, coefficients, orbit; and auto, what
    /// `umbrage tune` chose on this device, or else switch, or ladder where the key is too large [default: all shapes]
    #[arg(long, value_name = "PLAN", value_delimiter = ',', value_parser = plan::parse_plan)]
    plan: Vec<PlanArgument>,
    /// Directory of what `umbrage tune` chose, for auto [default: tuned beside the directory of the tables]
    #[arg(long, value_name = "DIR")]
    tuned: Option<PathBuf>,
    /// Profiles to plan for, each for the table that it counts [default: profiles/TABLE.ron beside the directory of
    /// the tables, if there is one]
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    profile: Vec<PathBuf>,
    /// Let plans do anything where the table's assumptions do not hold, and compare where they do
    #[arg(long)]
    assume: bool,
    /// Most points of the grid on the continuous inputs, per discrete state
    #[arg(long, value_name = "COUNT", default_value_t = diff::Effort::default().grid)]
    grid: usize,
    /// Random points per discrete state
    #[arg(long, value_name = "COUNT", default_value_t = diff::Effort::default().random)]
    random: usize,
    /// Compare at these inputs of one table instead: *.bin, a capture, or CSV or *.json as `eval` reads it
    #[arg(long, value_name = "FILE", value_delimiter = ',', conflicts_with_all = ["grid", "random"])]
    frames: Vec<PathBuf>,
}

/// Compares every table.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let mut options = Options { assume: arguments.assume, ..Options::default() };
    options.effort.grid = arguments.grid;
    options.effort.random = arguments.random;
    let (named, auto) = plan::split(&arguments.plan);
    if !arguments.plan.is_empty() {
        options.shapes = named;
    }
    let mut given = Vec::new();
    for path in &arguments.profile {
        given.push((path.clone(), profile::read(path)?));
    }
    let mut programs: Vec<Program> = Vec::new();
    let mut tuned = Vec::new();
    let mut profiles: Vec<Option<PathBuf>> = Vec::new();
    for path in &arguments.paths {
        for file in build::find_tables(path)? {
            let found = Program::read_all(&file)?;
            // An exhibit is compared only if it was named.
            programs.extend(found.into_iter().filter(|program| !path.is_dir() || program.exhibit.is_none()));
        }
        tuned.resize(programs.len(), arguments.tuned.clone().or_else(|| build::beside(path, "tuned")));
        profiles.resize(programs.len(), build::beside(path, "profiles"));
    }
    if let Some((path, unused)) = given.iter().find(|(_, one)| programs.iter().all(|program| program.name != one.table))
    {
        let message = format!("is a profile of the table `{}`, which is not among those compared", unused.table);
        let error = Diagnostic::error(codes::OTHER_PROFILE, message).help("give profiles of these tables");
        return Err(Failure::bare(shown(path), error).into());
    }
    let frames = match (arguments.frames.as_slice(), programs.as_slice()) {
        ([], _) => None,
        (files, [program]) => {
            let read = files.iter().map(|file| input::read_all(program, file));
            Some(read.collect::<std::result::Result<Vec<_>, Failure>>()?)
        }
        (_, several) => {
            let message = format!("`--frames` belongs to one table, and {} are given", several.len());
            let error = Diagnostic::error(codes::NOT_APPLICABLE, message).help("name the file of the table");
            return Err(Failure::bare("", error).into());
        }
    };
    let gpu = Gpu::open(&arguments.adapter)?;
    let mut out = stdout();
    if report.format == Format::Human {
        writeln!(out, "adapter: {}", gpu.describe())?;
    }
    let mut outcome = Outcome::Clean;
    for ((program, tuned), profiles) in programs.iter().zip(&tuned).zip(&profiles) {
        let mut options = options.clone();
        let chosen = if auto { Some(with_auto(program, &gpu, tuned.as_deref(), &mut options)?) } else { None };
        let unused = chosen.iter().filter_map(|auto| {
            let directory = tuned.as_deref().unwrap_or(Path::new("tuned"));
            auto.fallback.as_ref()?.diagnostic(program, auto.shape, directory)
        });
        for warning in unused {
            report.failure(&Failure::bare("", warning));
            outcome = Outcome::Findings;
        }
        let found = match profiles {
            Some(directory) if given.is_empty() => build::profile_of(&program.name, directory)?,
            _ => None,
        };
        if let Some(warning) = found.as_ref().and_then(|found| build::misplaced(&program.name, found)) {
            report.failure(&Failure::bare("", warning));
            outcome = Outcome::Findings;
        }
        let mut planned = build::Options { assume: options.assume, ..build::Options::default() };
        for warning in build::weigh(program, if given.is_empty() { found.as_slice() } else { &given }, &mut planned)? {
            report.failure(&Failure::bare("", warning));
            outcome = Outcome::Findings;
        }
        options.weights = planned.weights.remove(&program.name);
        let bar = progress(program);
        let result = match &frames {
            None => diff::table(program, &gpu, &options, |state| bar.set_position(state as u64)),
            Some(frames) => diff::frames(program, &gpu, &options, frames),
        };
        bar.finish_and_clear();
        let result = result?;
        for failure in &result.refused {
            report.failure(failure);
        }
        if result.offending() > 0 || !result.refused.is_empty() {
            outcome = Outcome::Findings;
        }
        match report.format {
            Format::Human => human(&mut out, program, &options, chosen.as_ref(), &result)?,
            Format::Json => writeln!(out, "{}", json(&gpu, &options, chosen.as_ref(), &result))?,
        }
    }
    out.flush()?;
    Ok(outcome)
}

/// Adds what `auto` stands for on this device to the plans that are named. If
/// it relies on assumptions, so do they: all are compared at the same points.
fn with_auto(
    program: &Program,
    gpu: &Gpu,
    tuned: Option<&Path>,
    options: &mut Options,
) -> std::result::Result<Auto, Failure> {
    let tuned = tuned.map_or(Ok(None), |directory| Tuned::read(&Tuned::path(directory, gpu.name())))?;
    let auto = Auto::of(program, tuned.as_ref());
    if !options.shapes.contains(&auto.shape) {
        options.shapes.push(auto.shape);
    }
    options.assume |= auto.assume;
    Ok(auto)
}

fn progress(program: &Program) -> ProgressBar {
    let bar = ProgressBar::new(program.states.count() as u64);
    if !io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) = ProgressStyle::with_template("{prefix:10} {wide_bar} {pos}/{len} states, {eta} left") {
        bar.set_style(style);
    }
    bar.set_prefix(program.name.clone());
    bar
}

fn human(
    out: &mut impl Write,
    program: &Program,
    options: &Options,
    auto: Option<&Auto>,
    report: &diff::Report,
) -> Result<()> {
    let function = program.function.as_ref().map_or(String::new(), |f| format!(", function {}", f.name));
    let states = report.states.map_or(String::new(), |states| format!("{states} states, "));
    let weights = options.weights.as_ref();
    let planned = weights.map_or(String::new(), |weights| format!("; planned for {}", weights.origin()));
    writeln!(out, "{}{function}: {states}{} points{planned}", program.source.name, report.points)?;
    if let Some(auto) = auto {
        let why = auto.fallback.as_ref().map_or("tuned on this device".to_owned(), Fallback::to_string);
        writeln!(out, "  `auto` is `{}`: {why}", auto.shape)?;
    }
    writeln!(
        out,
        "  plan           entry   source   bit-equal  admissible   reordered   offending   worst difference"
    )?;
    if !Language::Glsl.runs(program) {
        writeln!(out, "  GLSL is not run: naga refuses lists in the structure of a result")?;
    }
    for run in &report.runs {
        writeln!(
            out,
            "  {:<14} {:<7} {:<6} {:>11} {:>11} {:>11} {:>11}   {:e}",
            run.shape.name(),
            run.entry.name(),
            run.language.name(),
            run.bit_equal,
            run.admissible,
            run.reordered,
            run.offending,
            run.worst
        )?;
        for offender in &run.offenders {
            writeln!(out, "    {}", offender.reason)?;
            let function = program.function.as_ref().map_or(String::new(), |f| format!(" --function {}", f.name));
            writeln!(
                out,
                "    to see what should happen: umbrage explain {}{function} --at {}",
                program.source.name, offender.inputs
            )?;
        }
    }
    Ok(())
}

fn json(gpu: &Gpu, options: &Options, auto: Option<&Auto>, report: &diff::Report) -> serde_json::Value {
    let runs = report.runs.iter().map(|run| {
        json!({
            "plan": run.shape.name(),
            "entry": run.entry.name(),
            "language": run.language.name(),
            "bit_equal": run.bit_equal,
            "admissible": run.admissible,
            "reordered": run.reordered,
            "offending": run.offending,
            "excluded": run.excluded,
            "worst": run.worst,
            "offenders": run.offenders.iter().map(|o| json!({"inputs": o.inputs, "reason": o.reason})).collect::<Vec<_>>(),
        })
    });
    json!({
        "adapter": gpu.describe(),
        "table": report.table,
        "states": report.states,
        "points": report.points,
        "profile": options.weights.as_ref().map(Weights::origin),
        "auto": auto.map(|auto| json!({"plan": auto.shape.name(), "fallback": auto.fallback.as_ref().map(Fallback::to_string)})),
        "runs": runs.collect::<Vec<_>>(),
    })
}
