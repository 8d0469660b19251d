//! `umbrage tune`: measures every plan of a table here, and keeps the best.

mod compile;
mod whole;

use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::json;

use super::args::{parse_map, parse_size};
use super::messages::{Format, Report};
use super::output::{Sink, finish_in, stdout};
use super::{Outcome, Result, input, parse_shape, profile};
use crate::diag::Failure;
use crate::gpu::timing::{Clock, Protocol};
use crate::gpu::{AdapterChoice, Gpu};
use crate::plan::Shape;
use crate::profile::fit;
use crate::program::Program;
use crate::technique::Executor;
use crate::text::file::{Home, shown};
use crate::tune::{self, Candidate, Kind, Options, Tuning};
use crate::tuned::{Choice, Tuned};

/// The longest time without a word.
const SILENCE: Duration = Duration::from_secs(10);

/// Reads a number of seconds.
fn parse_seconds(text: &str) -> std::result::Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.01..=1e6).contains(&seconds) { Ok(seconds) } else { Err("not between 0.01 and 1000000 seconds".to_owned()) }
}

/// Arguments of `umbrage tune`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// Profiles of the table: what plans are made for
    #[arg(long, required = true, value_name = "FILE", value_delimiter = ',')]
    profile: Vec<PathBuf>,
    /// Captured inputs to measure with: *.bin, or CSV or *.json as `eval` reads it [default: states drawn as the
    /// profile says]
    #[arg(long, value_name = "FILE", value_delimiter = ',')]
    frames: Vec<PathBuf>,
    /// The adapter: any, software, hardware, or a part of its name
    #[arg(long, value_name = "WHICH", default_value = "any")]
    adapter: AdapterChoice,
    /// Code shapes to try [default: all]
    #[arg(long, value_name = "PLAN", value_delimiter = ',', value_parser = parse_shape)]
    plan: Vec<Shape>,
    /// Try plans, too, that rely on the table's assumptions
    #[arg(long)]
    assume: bool,
    /// Rows of inputs of each kind
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().rows,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1 << 22))]
    rows: usize,
    /// Measurements of each plan with each kind of inputs
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().protocol.rounds,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=10_000))]
    rounds: usize,
    /// Rows that a thread evaluates: 1 is a pass over memory, more show what plans cost where inputs are at hand
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().rows_of_thread,
          value_parser = clap::value_parser!(u32).range(1..=1024))]
    rows_of_thread: u32,
    /// Evaluations of all rows in one measurement; more for fast devices
    #[arg(long, value_name = "COUNT", default_value_t = Options::default().repeats,
          value_parser = clap::value_parser!(u32).range(1..=10_000))]
    repeats: u32,
    /// Longest time that the device may take to compile a plan, in seconds; plans that take longer are left out
    #[arg(long, value_name = "SECONDS", default_value_t = 20.0, value_parser = parse_seconds)]
    compile_limit: f64,
    /// Longest time for all measurements, in seconds; there are fewer rounds if they would take longer
    #[arg(long, value_name = "SECONDS", default_value_t = Options::default().time.as_secs_f64(), value_parser = parse_seconds)]
    time_limit: f64,
    /// Compiles one plan and runs it once: what runs in a process of its own, which can be ended
    #[arg(long, hide = true)]
    only_compile: bool,
    /// Measure with the wall clock even if the device has timestamps
    #[arg(long)]
    wall_clock: bool,
    /// Measure the plans, too, in the whole shadow pass that the table is for, on frames of scenes
    #[arg(long)]
    whole: bool,
    /// Scenes for --whole: names of built-in ones, or files
    #[arg(
        long,
        value_name = "SCENE",
        value_delimiter = ',',
        default_value = "fence,foliage,outdoor",
        requires = "whole"
    )]
    scene: Vec<String>,
    /// Size of the picture for --whole [default: 1920x1080; on a software adapter 480x270]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = parse_size, requires = "whole")]
    size: Option<(u32, u32)>,
    /// Texels per side of the shadow map for --whole
    #[arg(long, value_name = "TEXELS", default_value = "1024", value_parser = parse_map, requires = "whole")]
    shadow_map: u32,
    /// Directory of the choices, one file per device
    #[arg(long, short, value_name = "DIR", default_value = "tuned")]
    output: PathBuf,
    /// The file for the report, an HTML page [default: none]
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

/// Measures, shows the ranking, and keeps the choice.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let program = Program::read(&arguments.table)?;
    let name: Vec<String> = arguments.profile.iter().map(|path| shown(path)).collect();
    let name = name.join(", ");
    let fitted = fit(&program, profile::read_all(&arguments.profile, &[])?, &name)?;
    let mut outcome = Outcome::Clean;
    if let Some(warning) = &fitted.lost {
        report.failure(&Failure::bare("", warning.clone()));
        outcome = Outcome::Findings;
    }
    if arguments.assume && profile::excluded(&program, &fitted, report) {
        return Ok(Outcome::Failed);
    }
    let weights = fitted.weights(&program, &name)?;
    if let (true, [shape]) = (arguments.only_compile, arguments.plan.as_slice()) {
        let (candidate, gpu) = (Candidate::of(*shape, arguments.assume), Gpu::open(&arguments.adapter)?);
        tune::compile(&program, &fitted, &weights, candidate, &gpu, arguments.rows_of_thread)?;
        return Ok(Outcome::Clean);
    }
    let mut frames = None;
    for file in &arguments.frames {
        let read = input::read_all(&program, file)?;
        match &mut frames {
            None => frames = Some(read),
            Some(all) => all.append(&read),
        }
    }
    let defaults = Options::default();
    let options = Options {
        shapes: if arguments.plan.is_empty() { defaults.shapes } else { arguments.plan.clone() },
        assume: arguments.assume,
        rows: arguments.rows.next_multiple_of(arguments.rows_of_thread as usize),
        rows_of_thread: arguments.rows_of_thread,
        repeats: arguments.repeats,
        protocol: Protocol { rounds: arguments.rounds, ..defaults.protocol },
        wall_clock: arguments.wall_clock,
        time: Duration::from_secs_f64(arguments.time_limit),
    };
    // What is wrong with them is said before anything takes time.
    let scenes = if arguments.whole { whole::scenes(arguments, &program)? } else { Vec::new() };
    let gpu = Arc::new(Gpu::open(&arguments.adapter)?);
    let executor = Executor::Gpu(Arc::clone(&gpu));
    let path = Tuned::path(&arguments.output, gpu.name());
    // A file that cannot be read or written is found before anything takes time.
    Tuned::read(&path)?;
    let page = arguments.report.as_deref().map(Sink::create).transpose()?;
    let bar = progress();
    let start = Instant::now();
    let mut compiles = |candidate, rows| compile::within_limit(arguments, candidate, rows);
    let result = tune::tune(&program, fitted, &weights, frames.as_ref(), &gpu, &options, &mut compiles, |doing| {
        bar.set_message(doing.to_owned());
        // Where nobody sees the bar, what takes long is still said.
        if bar.is_hidden() && start.elapsed() > SILENCE {
            eprintln!("{} s: {doing}", start.elapsed().as_secs());
        }
    });
    let result = result.and_then(|mut tuning| {
        if arguments.whole {
            bar.set_message("measuring whole shaders");
            tuning.whole = whole::measure(arguments, &program, &scenes, &executor, &tuning)?;
        }
        Ok(tuning)
    });
    bar.finish_and_clear();
    let tuning = result?;

    let mut sinks = Vec::new();
    if let Some(mut page) = page {
        page.write_all(tune::page(&program, &tuning, &weights).as_bytes())?;
        sinks.push(page);
    }
    keep(&arguments.output, &path, tuning.choice(&program, &weights), gpu.name(), sinks)?;

    match report.format {
        Format::Human => human(&tuning, &path)?,
        Format::Json => writeln!(stdout(), "{}", object(&tuning))?,
    }
    if !tuning.wrong.is_empty() {
        outcome = Outcome::Findings;
    }
    Ok(outcome)
}

fn progress() -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    if !io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} [{elapsed}]") {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(100));
    bar
}

/// Puts a choice into the file of a device, which appears together with other results.
///
/// The file is read again: another run may have put a choice into it since. Until it is written no other run does.
fn keep(directory: &Path, path: &Path, choice: Choice, device: &str, mut sinks: Vec<Sink>) -> Result<()> {
    let home = Home::lock(directory)?;
    let mut tuned = Tuned::read(path)?.unwrap_or_else(|| Tuned::new(device));
    tuned.set(choice);
    let mut sink = Sink::replace(path)?;
    sink.write_all(tuned.to_ron().as_bytes())?;
    sinks.push(sink);
    finish_in(&home, sinks)
}

fn human(tuning: &Tuning<'_>, path: &Path) -> Result<()> {
    let mut out = stdout();
    writeln!(out, "device: {}", tuning.device)?;
    writeln!(out, "measured with {}", tuning.method())?;
    if tuning.clock == Clock::Wall && !tuning.options.wall_clock {
        writeln!(out, "the device has no timestamp queries: times contain the way to the device and back")?;
    }
    for (place, kind) in Kind::ALL.into_iter().enumerate() {
        let floor = 1e6 * tuning.floor[place].median();
        writeln!(out, "\n{kind} inputs; reading and writing them alone takes {floor:.1} us")?;
        writeln!(out, "  plan                       us      +-   to ladder   to floor")?;
        for line in tuning.ranking(kind) {
            let name = tuning.plans[line.plan].candidate.name();
            let noise = if line.plan != 0 && !line.differs { "   within noise of the ladder" } else { "" };
            writeln!(
                out,
                "  {name:<20} {:>9.1} {:>7.1} {:>11.3} {:>10.2}{noise}",
                line.us, line.uncertainty, line.vs_ladder, line.vs_floor
            )?;
        }
    }
    writeln!(out)?;
    for plan in &tuning.plans {
        if let Some(certificate) = &plan.proved.plan().certificate {
            writeln!(out, "{}: {certificate}", plan.candidate.name())?;
        }
    }
    whole::human(&mut out, tuning)?;
    for shortened in &tuning.shortened {
        writeln!(out, "shortened: {shortened}")?;
    }
    for (candidate, reason) in &tuning.skipped {
        writeln!(out, "left out: {}: {reason}", candidate.name())?;
    }
    for (candidate, reason) in &tuning.wrong {
        writeln!(out, "wrong on this device, left out: {}: {reason}", candidate.name())?;
    }
    let chosen = &tuning.plans[tuning.chosen];
    let proof = chosen.proved.proof();
    writeln!(out, "\nchosen: {}, proved {proof}", chosen.candidate.name())?;
    if !tuning.is_clear() {
        writeln!(out, "it does not differ from the ladder as written by more than noise")?;
    }
    writeln!(out, "kept in {}", path.display())?;
    out.flush()?;
    Ok(())
}

fn object(tuning: &Tuning<'_>) -> serde_json::Value {
    let floor: serde_json::Map<String, serde_json::Value> = Kind::ALL
        .into_iter()
        .zip(&tuning.floor)
        .map(|(kind, times)| (kind.name().to_owned(), json!(1e6 * times.median())))
        .collect();
    let lines = Kind::ALL.into_iter().flat_map(|kind| tuning.ranking(kind));
    let plans = lines.map(|line| {
        json!({
            "name": tuning.plans[line.plan].candidate.name(),
            "input": line.input.name(),
            "us": line.us,
            "vs_ladder": line.vs_ladder,
            "vs_floor": line.vs_floor,
            "differs": line.differs,
            "uncertainty": line.uncertainty,
        })
    });
    let expected = tuning.plans.iter().filter_map(|plan| {
        let certificate = plan.proved.plan().certificate?;
        Some(json!({
            "name": plan.candidate.name(),
            "written": certificate.written,
            "planned": certificate.planned,
            "bound": certificate.bound,
            "optimal": certificate.is_optimal(),
        }))
    });
    let whole = whole::object(tuning);
    let left_out = |all: &[(tune::Candidate, String)]| {
        let one = |(candidate, reason): &(tune::Candidate, String)| json!({"name": candidate.name(), "reason": reason});
        all.iter().map(one).collect::<Vec<_>>()
    };
    json!({
        "device": tuning.device,
        "floor": floor,
        "plans": plans.collect::<Vec<_>>(),
        "clock": tuning.clock.to_string(),
        "chosen": tuning.plans[tuning.chosen].candidate.name(),
        "shortened": tuning.shortened,
        "skipped": left_out(&tuning.skipped),
        "wrong": left_out(&tuning.wrong),
        "expected_tests": expected.collect::<Vec<_>>(),
        "whole": whole,
    })
}
