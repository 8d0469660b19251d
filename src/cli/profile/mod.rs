//! `umbrage profile`: counts how often each state of a table occurs.

mod compare;
mod counted;
mod scenes;
mod show;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::args::{Machine, SettingArguments, TechniqueArgument, parse_map, parse_size, technique_parser};
use super::messages::Report;
use super::output::{Sink, finish_all};
use super::{Outcome, Result, input};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Missing;
use crate::profile::{self, Fitted, Hits, Profile, Scene};
use crate::program::Program;
use crate::text::file::shown;

/// Arguments of `umbrage profile`.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    count: Count,
}

#[derive(clap::Subcommand)]
enum Command {
    /// Put profiles of one table together
    Merge(Merge),
    /// Show how frequent each case is, and how much that varies between scenes
    Show(show::Arguments),
    /// Compare two profiles of one table
    Diff(compare::Arguments),
}

#[derive(clap::Args)]
struct Count {
    /// Scenes to render and count: names of built-in ones, or files
    #[arg(long, value_name = "SCENE", value_delimiter = ',', conflicts_with = "frames")]
    scene: Vec<String>,
    /// The technique to render with, one with a table of cases
    #[arg(long, value_name = "TECHNIQUE", default_value = "rsmss", value_parser = technique_parser())]
    technique: TechniqueArgument,
    /// Size of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "960x540", value_parser = parse_size)]
    size: (u32, u32),
    /// Texels per side of the shadow map
    #[arg(long, value_name = "TEXELS", default_value = "1024", value_parser = parse_map)]
    shadow_map: u32,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    settings: SettingArguments,
    /// The table [default for scenes: that of the technique]
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Captured inputs to count: *.bin, or CSV or *.json as `eval` reads it; each is a scene of its own
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    frames: Vec<PathBuf>,
    /// Counts that a shader of your own has made with the target `wgsl_counting`: *.bin, 32 bits each, or a text of
    /// numbers; each file is a scene of its own. They make no profile, for they know no states; they go with --lcov
    #[arg(long, value_name = "FILE", value_delimiter = ',', conflicts_with_all = ["scene", "frames"], requires = "lcov")]
    hits: Vec<PathBuf>,
    /// Also write how often each row and line of the table gave the result, as LCOV, which `genhtml` reads
    #[arg(long, value_name = "FILE")]
    lcov: Option<PathBuf>,
    /// The file for the profile; `-` is standard output [default: standard output, or none with --lcov]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(clap::Args)]
struct Merge {
    /// The profiles
    #[arg(required = true, value_name = "PROFILE")]
    profiles: Vec<PathBuf>,
    /// The weight of each profile's counts, one number per profile
    #[arg(long, value_name = "NUMBER", value_delimiter = ',')]
    weight: Vec<f64>,
    /// The file for the profile; `-` is standard output
    #[arg(long, short, default_value = "-", value_name = "FILE")]
    output: PathBuf,
}

/// Counts, or does something with profiles that were counted.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    match &arguments.command {
        None => count(&arguments.count, report),
        Some(Command::Merge(arguments)) => merge(arguments),
        Some(Command::Show(arguments)) => show::run(arguments, report),
        Some(Command::Diff(arguments)) => compare::run(arguments, report),
    }
}

fn count(arguments: &Count, report: &Report) -> Result<Outcome> {
    if !arguments.scene.is_empty() {
        let (program, profile, hits) = scenes::run(arguments, report)?;
        return finish(&program, profile, &hits, arguments, report);
    }
    if let (Some(table), Some(lcov), false) = (&arguments.table, &arguments.lcov, arguments.hits.is_empty()) {
        return counted::run(table, &arguments.hits, lcov);
    }
    let (Some(table), false) = (&arguments.table, arguments.frames.is_empty()) else {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, "there is nothing to count")
            .help("name scenes: --scene fence,lattice --technique rsmss")
            .help("or a table and captured inputs: --table tables/rsmss.ron --frames frame.bin")
            .help("or a table and what a shader counted: --table tables/rsmss.ron --hits frame.txt --lcov out.info")
            .help("or say what to do with profiles that exist: merge, show, diff");
        return Err(Failure::bare("", error).into());
    };
    let program = Program::read(table)?;
    let mut profile = Profile::new(&program);
    let mut hits = Vec::new();
    for file in &arguments.frames {
        let columns = input::read_all(&program, file)?;
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let missing = |missing: Missing| {
            let input = &program.inputs[missing.input.index()].name;
            let message = format!("row {} needs `{input}`, which is absent", missing.row + 1);
            let error = Diagnostic::error(codes::NEEDS_FETCH, message).help("capture the frame again");
            Failure::bare(shown(file), error)
        };
        profile.scenes.push(Scene::of_columns(&program, &name, &columns).map_err(missing)?);
        if arguments.lcov.is_some() {
            hits.push(Hits::of_columns(&program, &name, &columns).map_err(missing)?);
        }
    }
    finish(&program, profile, &hits, arguments, report)
}

/// Checks what was counted against the table's assumptions, and writes it.
fn finish(program: &Program, profile: Profile, hits: &[Hits], arguments: &Count, report: &Report) -> Result<Outcome> {
    let lcov = arguments.lcov.as_deref();
    // Who asks for hits alone gets nothing else.
    let output = arguments.output.as_deref().or_else(|| lcov.is_none().then_some(Path::new("-")));
    let fitted = profile::fit(program, profile, &output.map(shown).unwrap_or_default())?;
    if excluded(program, &fitted, report) {
        return Ok(Outcome::Failed);
    }
    let [mut profile_sink, mut lcov_sink] = Sink::several([output, lcov])?;
    if let Some(sink) = &mut profile_sink {
        let text = profile::to_ron(&fitted.profile);
        sink.write_all(text.as_bytes()).map_err(|error| sink.failure(&error))?;
    }
    if let Some(sink) = &mut lcov_sink {
        let text = profile::lcov(program, hits);
        sink.write_all(text.as_bytes()).map_err(|error| sink.failure(&error))?;
    }
    finish_all(profile_sink.into_iter().chain(lcov_sink))?;
    Ok(Outcome::Clean)
}

/// Reports the states that occur although assumptions exclude them, and says whether there are any.
pub(super) fn excluded(program: &Program, fitted: &Fitted, report: &Report) -> bool {
    let found = fitted.excluded(program);
    // One message per assumption and scene; the most frequent state stands for the others.
    let mut worst: BTreeMap<(&str, Option<&str>), &profile::Excluded> = BTreeMap::new();
    for excluded in &found {
        let kept = worst.entry((&excluded.scene, excluded.assumption.as_deref())).or_insert(excluded);
        if excluded.count > kept.count {
            *kept = excluded;
        }
    }
    let diagnostics: Vec<Diagnostic> = worst.values().map(|excluded| excluded.diagnostic(program)).collect();
    report.show(&program.source, &diagnostics);
    !found.is_empty()
}

fn merge(arguments: &Merge) -> Result<Outcome> {
    let refuse = |message: String, help: &str| {
        Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message).help(help)).into())
    };
    let (profiles, weights) = (&arguments.profiles, &arguments.weight);
    if !weights.is_empty() && weights.len() != profiles.len() {
        let message = format!("{} weights for {} profiles", weights.len(), profiles.len());
        return refuse(message, "give one weight per profile, in the same order: --weight 1,0.5");
    }
    if let Some(weight) = weights.iter().find(|weight| !(weight.is_finite() && **weight >= 0.0)) {
        return refuse(format!("the weight {weight} is not a number from 0 on"), "leave profiles out to ignore them");
    }
    write(&read_all(profiles, weights)?, &arguments.output)?;
    Ok(Outcome::Clean)
}

fn write(profile: &Profile, output: &Path) -> Result<()> {
    let mut sink = Sink::create(output)?;
    sink.write_all(profile::to_ron(profile).as_bytes()).map_err(|error| sink.failure(&error))?;
    sink.finish()
}

/// Reads several profiles as one. Those without a weight weigh 1.
pub(super) fn read_all(files: &[PathBuf], weights: &[f64]) -> std::result::Result<Profile, Failure> {
    let mut all: Option<Profile> = None;
    for (index, file) in files.iter().enumerate() {
        let profile = profile::read(file)?;
        let merged = all.get_or_insert_with(|| Profile { scenes: Vec::new(), ..profile.clone() });
        merged.merge(&profile, weights.get(index).copied().unwrap_or(1.0)).map_err(|reason| {
            let error = Diagnostic::error(codes::OTHER_PROFILE, format!("does not go with the others: {reason}"));
            Failure::bare(shown(file), error.help("take profiles of one table, counted while it meant the same"))
        })?;
    }
    all.ok_or_else(|| {
        let error = Diagnostic::error(codes::EMPTY_PROFILE, "there is no profile");
        Failure::bare("", error.help("name a file"))
    })
}
