//! `umbrage profile show`: frequencies of the cases, as text, JSON or a picture.

use std::io::Write;
use std::path::PathBuf;

use serde_json::json;

use super::{excluded, read_all};
use crate::cli::input::has_extension;
use crate::cli::messages::{Format, Report};
use crate::cli::output::{Sink, stdout};
use crate::cli::{Outcome, Result, profiled};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture;
use crate::profile::{Frequency, Profile, chart, fit, frequencies};
use crate::program::Program;
use crate::text::file::shown;

/// Arguments of `umbrage profile show`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The profiles; several of one table are shown together
    #[arg(required = true, value_name = "PROFILE")]
    profiles: Vec<PathBuf>,
    /// The table, to name its cases and to check its assumptions
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// A picture instead of text: *.svg or *.png
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
}

/// Columns of the longest bar.
const BAR: f64 = 40.0;

pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let mut profile = read_all(&arguments.profiles, &[])?;
    let mut program = None;
    let mut outcome = Outcome::Clean;
    if let Some(table) = &arguments.table {
        let table = Program::read(table)?;
        let name = shown(&arguments.profiles[0]);
        let fitted = fit(&table, profile, &name)?;
        if profiled::say(&fitted, report) {
            outcome = Outcome::Findings;
        }
        if excluded(&table, &fitted, report) {
            return Ok(Outcome::Failed);
        }
        profile = fitted.profile;
        program = Some(table);
    }
    if profile.total() == 0 {
        let error = Diagnostic::error(codes::EMPTY_PROFILE, "counts nothing, so there are no frequencies");
        let name = shown(&arguments.profiles[0]);
        return Err(Failure::bare(name, error.help("count scenes in which the table is evaluated")).into());
    }
    match (&arguments.output, report.format) {
        (Some(path), _) => draw(&profile, path)?,
        (None, Format::Human) => text(&profile, program.as_ref())?,
        (None, Format::Json) => writeln!(stdout(), "{}", object(&profile))?,
    }
    Ok(outcome)
}

fn text(profile: &Profile, program: Option<&Program>) -> Result<()> {
    let found = frequencies(profile);
    let mut out = stdout();
    writeln!(out, "{}: {} evaluations", profile.table, profile.total())?;
    for scene in &profile.scenes {
        let weight = if scene.weight == 1.0 { String::new() } else { format!(", weight {}", scene.weight) };
        let (total, states) = (scene.total(), scene.states.len());
        let setting = if scene.setting.is_empty() { String::new() } else { format!(", {}", scene.setting) };
        let (name, technique) = (&scene.name, &scene.technique);
        let tiles = scene.tiles.as_ref().map_or(String::new(), |tiles| {
            format!(", {:.2} in a tile of {}x{} pixels", tiles.mean_states(), tiles.width, tiles.height)
        });
        writeln!(out, "  {name:<12} {technique}{setting}{weight}: {total} evaluations in {states} states{tiles}")?;
    }
    let largest = found.iter().map(|f| f.mean).fold(0.0, f64::max);
    writeln!(out, "\n     case    share     mean    +-")?;
    for frequency in &found {
        let case = frequency.case.map_or("default".to_owned(), |case| case.to_string());
        let Frequency { share, mean, deviation, .. } = frequency;
        let bar = "#".repeat((BAR * mean / largest).round() as usize);
        let row = program.and_then(|program| program.rows.iter().find(|row| Some(row.id) == frequency.case));
        let doc = row.map_or(String::new(), |row| format!("{} ", row.doc));
        let (share, mean, deviation) = (100.0 * share, 100.0 * mean, 100.0 * deviation);
        let line = format!("  {case:>7} {share:>7.2}% {mean:>7.2}% {deviation:>5.2}  {bar:<40}  {doc}");
        writeln!(out, "{}", line.trim_end())?;
    }
    writeln!(out, "share: of all evaluations, by weight; mean, +-: over scenes, with their standard deviation")?;
    out.flush()?;
    Ok(())
}

fn object(profile: &Profile) -> serde_json::Value {
    let cases = frequencies(profile).into_iter().map(|f| {
        let case = f.case.map_or(json!("default"), |case| json!(case));
        json!({"case": case, "share": f.share, "mean": f.mean, "deviation": f.deviation, "scenes": f.scenes})
    });
    let scenes = profile.scenes.iter().map(|scene| {
        json!({
            "name": scene.name,
            "technique": scene.technique,
            "setting": scene.setting,
            "weight": scene.weight,
            "evaluations": scene.total(),
            "states": scene.states.len(),
        })
    });
    json!({
        "table": profile.table,
        "fingerprint": profile.fingerprint,
        "evaluations": profile.total(),
        "scenes": scenes.collect::<Vec<_>>(),
        "cases": cases.collect::<Vec<_>>(),
    })
}

fn draw(profile: &Profile, path: &std::path::Path) -> Result<()> {
    let svg = chart(profile);
    let bytes = if has_extension(path, "svg") {
        svg.into_bytes()
    } else if has_extension(path, "png") {
        picture::png(&picture::raster(&svg, 2.0)?)?
    } else {
        let error = Diagnostic::error(codes::UNWRITABLE, "is no kind of picture that can be written");
        return Err(Failure::bare(shown(path), error.help("name a file *.svg or *.png")).into());
    };
    let mut sink = Sink::create(path)?;
    sink.write_all(&bytes).map_err(|error| sink.failure(&error))?;
    sink.finish()
}
