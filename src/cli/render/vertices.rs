//! `umbrage vertices`: the cost of peeling against the vertices of lights and occluders.

use std::io::{Cursor, Write};
use std::path::PathBuf;

use comfy_table::{CellAlignment, Table, presets};
use image::ImageFormat;
use serde_json::{Value as Json, json};

use super::plots;
use crate::cli::args::{Backend, Machine, parse_size};
use crate::cli::messages::{Format, Report};
use crate::cli::output::{Sink, finish_all, stdout};
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result};
use crate::diag::Failure;
use crate::gpu::timing::{Protocol, Times, interleaved};
use crate::picture::sheet::{self, Entry};
use crate::picture::{plot, srgb};
use crate::technique::area::grid::{self, Sized};
use crate::technique::area::{OCCLUDERS, PEEL, SILHOUETTES, TRIANGLES};
use crate::technique::prepared::{Detail, Watch};
use crate::technique::setting::Value;
use crate::technique::{Executor, Frame, Settings, shade};

/// Arguments of `umbrage vertices`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// Size of the pictures
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "240x160", value_parser = parse_size)]
    size: (u32, u32),
    /// Measurements of each scene, of which the fastest counts: other work on the machine only adds to it
    #[arg(long, value_name = "COUNT", default_value_t = 9,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=10_000))]
    rounds: usize,
    /// Measurements before those that count
    #[arg(long, value_name = "COUNT", default_value_t = 1,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(0..=10_000))]
    warm_up: usize,
    /// The file for a sheet of the grid of lights and occluders: *.png
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the numbers as JSON as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Plot the times: *.svg or *.png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    machine: Machine,
}

/// A scene as it is measured.
struct Subject {
    series: Series,
    sized: Sized,
    /// The way in which occluders are taken: a word of [`OCCLUDERS`].
    taken: &'static str,
}

/// The purpose that a scene is measured for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Series {
    Grid,
    Lights,
    Occluders,
}

impl Series {
    fn vertices(self, sized: &Sized) -> usize {
        match self {
            Series::Lights => sized.of_lights,
            Series::Grid | Series::Occluders => sized.of_occluders,
        }
    }
}

/// A straight line through the times of a series.
struct Fit {
    name: String,
    points: Vec<(f64, f64)>,
    /// Milliseconds a vertex, milliseconds without vertices, R².
    line: [f64; 3],
}

/// Most vertices of a ball whose silhouette a shader finds itself.
const MOST_IN_SHADER: usize = 40;

fn subjects(executor: &Executor) -> Vec<Subject> {
    let mut all = Vec::new();
    for (lights, occluders) in (1..=3).flat_map(|lights| (0..=3).map(move |occluders| (lights, occluders))) {
        all.push(Subject { series: Series::Grid, sized: grid::image(lights, occluders), taken: SILHOUETTES });
    }
    all.extend([3, 6, 9, 12, 15].map(|sides| Subject {
        series: Series::Lights,
        sized: grid::lamp(sides),
        taken: SILHOUETTES,
    }));
    for taken in [SILHOUETTES, TRIANGLES] {
        let ball = |(rings, around)| Subject { series: Series::Occluders, sized: grid::ball(rings, around), taken };
        all.extend([(2, 3), (2, 6), (3, 7), (4, 9), (6, 12), (8, 19)].map(ball));
    }
    // The host would compute the others, unmeasured.
    let fits = |subject: &Subject| match executor {
        Executor::Cpu => true,
        Executor::Gpu(_) => subject.series != Series::Occluders || subject.sized.of_occluders <= MOST_IN_SHADER,
    };
    all.retain(fits);
    all
}

/// Measures, then shows.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    plots::is_plot(arguments.plot.as_deref())?;
    let paths = [arguments.output.as_deref(), arguments.json.as_deref(), arguments.plot.as_deref()];
    let [sheet_sink, json_sink, plot_sink] = Sink::several(paths)?;
    let executor = arguments.machine.executor(Backend::Auto, report)?;
    let subjects = subjects(&executor);
    let frames: Vec<Frame<'_>> = subjects.iter().map(|subject| frame(arguments, subject, &executor)).collect();
    let times = measure(arguments, &frames, &executor)?;
    let fits = fits(&subjects, &times);
    let object = || json(arguments, &executor, &subjects, &times, &fits);
    let mut sinks = Vec::new();
    if let Some(mut sink) = sheet_sink {
        sink.write_all(&sheet_of(&subjects, &frames, &times)?)?;
        sinks.push(sink);
    }
    if let Some(mut sink) = json_sink {
        writeln!(sink, "{:#}", object())?;
        sinks.push(sink);
    }
    if let (Some(mut sink), Some(path)) = (plot_sink, &arguments.plot) {
        sink.write_all(&plots::file(path, draw(&fits))?)?;
        sinks.push(sink);
    }
    finish_all(sinks)?;
    let mut out = stdout();
    match report.format {
        Format::Json => writeln!(out, "{}", object())?,
        Format::Human => human(&mut out, &executor, &subjects, &times, &fits)?,
    }
    Ok(Outcome::Clean)
}

fn frame<'s>(arguments: &Arguments, subject: &'s Subject, executor: &'s Executor) -> Frame<'s> {
    let mut settings = Settings::default();
    settings.set(&OCCLUDERS, Value::Word(subject.taken));
    Frame::new(&subject.sized.scene, arguments.size, executor).with(settings)
}

fn measure(
    arguments: &Arguments,
    frames: &[Frame<'_>],
    executor: &Executor,
) -> std::result::Result<Vec<Times>, Failure> {
    let mut prepared = frames.iter().map(|frame| frame.prepare(&PEEL)).collect::<std::result::Result<Vec<_>, _>>()?;
    let mut passes = Vec::new();
    for prepared in &mut prepared {
        passes.extend(prepared.passes(Detail::Plain)?);
    }
    let watch = Watch::new(executor);
    let protocol = Protocol { warm_up: arguments.warm_up, rounds: arguments.rounds };
    let progress = Progress::new(((protocol.warm_up + protocol.rounds) * passes.len()) as u64);
    interleaved(protocol, passes.len(), |index| {
        progress.advance(1);
        passes[index].time(&watch)
    })
}

fn fits(subjects: &[Subject], times: &[Times]) -> Vec<Fit> {
    let fit = |name: &str, series: Series, taken: &str| {
        let own = subjects.iter().zip(times).filter(|(subject, _)| subject.series == series && subject.taken == taken);
        let point =
            |(subject, times): (&Subject, &Times)| (series.vertices(&subject.sized) as f64, times.quantile(0.0) * 1e3);
        let points: Vec<(f64, f64)> = own.map(point).collect();
        Fit { name: name.to_owned(), line: grid::line(&points), points }
    };
    vec![
        fit("light", Series::Lights, SILHOUETTES),
        fit("occluder, by silhouette", Series::Occluders, SILHOUETTES),
        fit("occluder, by triangles", Series::Occluders, TRIANGLES),
    ]
}

fn sheet_of(subjects: &[Subject], frames: &[Frame<'_>], times: &[Times]) -> std::result::Result<Vec<u8>, Failure> {
    let mut entries = Vec::new();
    for ((subject, frame), times) in subjects.iter().zip(frames).zip(times) {
        if subject.series == Series::Grid {
            let rendered = frame.prepare(&PEEL)?.render(&|_| {})?;
            let label = format!("{}: {:.1} ms", subject.sized.scene.name, times.quantile(0.0) * 1e3);
            entries.push(Entry { label, picture: srgb::encode(&shade::picture(frame, &rendered)?) });
        }
    }
    let sheet = sheet::grid(&entries, 4)?;
    let mut bytes = Cursor::new(Vec::new());
    sheet.write_to(&mut bytes, ImageFormat::Png).map_err(|error| {
        let error =
            crate::diag::Diagnostic::error(crate::diag::codes::RENDER, format!("the sheet cannot be encoded: {error}"));
        Failure::bare("", error.help("choose smaller pictures"))
    })?;
    Ok(bytes.into_inner())
}

fn human(out: &mut impl Write, executor: &Executor, subjects: &[Subject], times: &[Times], fits: &[Fit]) -> Result<()> {
    writeln!(out, "{}", executor.describe())?;
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    table.set_header(["scene", "vertices of lights", "of occluders", "taken by", "ms", "median ms"]);
    for (subject, times) in subjects.iter().zip(times) {
        table.add_row([
            subject.sized.scene.name.clone(),
            subject.sized.of_lights.to_string(),
            subject.sized.of_occluders.to_string(),
            subject.taken.to_owned(),
            format!("{:.3}", times.quantile(0.0) * 1e3),
            format!("{:.3}", times.median() * 1e3),
        ]);
    }
    for column in [1, 2, 4, 5] {
        if let Some(column) = table.column_mut(column) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    writeln!(out, "{}\n", table.trim_fmt())?;
    for Fit { name, line: [slope, start, r], .. } in fits {
        writeln!(out, "per vertex of a {name}: {slope:.4} ms, from {start:.3} ms on; R² {r:.3}")?;
    }
    if let [_, silhouettes, triangles] = fits {
        let ratios: Vec<String> = (silhouettes.points.iter().zip(&triangles.points))
            .map(|(a, b)| format!("{:.2} at {}", b.1 / a.1, a.0))
            .collect();
        writeln!(out, "triangles take as many times the time of the silhouette: {}", ratios.join(", "))?;
    }
    Ok(())
}

fn json(arguments: &Arguments, executor: &Executor, subjects: &[Subject], times: &[Times], fits: &[Fit]) -> Json {
    let scenes = subjects.iter().zip(times).map(|(subject, times)| {
        json!({
            "scene": subject.sized.scene.name, "light_vertices": subject.sized.of_lights,
            "occluder_vertices": subject.sized.of_occluders, "occluders": subject.taken,
            "ms": times.quantile(0.0) * 1e3, "median_ms": times.median() * 1e3,
        })
    });
    let fits = fits.iter().map(|Fit { name, line: [slope, start, r], .. }| {
        json!({ "vertices_of": name, "ms_per_vertex": slope, "ms_without": start, "r_squared": r })
    });
    let (width, height) = arguments.size;
    json!({
        "width": width, "height": height, "executor": executor.describe(),
        "scenes": scenes.collect::<Vec<_>>(), "fits": fits.collect::<Vec<_>>(),
    })
}

/// Times over vertices: of lights, and of occluders in both ways.
fn draw(fits: &[Fit]) -> Vec<String> {
    let plot = |label: &str, some: &[Fit]| {
        let axis = |label: &str| plot::Axis { label: label.to_owned(), scale: plot::Scale::Linear };
        let frame = plot::Frame { title: String::new(), x: axis(label), y: axis("ms"), size: plots::PLOT };
        let series = some.iter().map(|fit| plot::Series { name: fit.name.clone(), points: fit.points.clone() });
        plot::lines(&frame, &series.collect::<Vec<_>>())
    };
    vec![plot("vertices of the light", &fits[..1]), plot("vertices of the occluder", &fits[1..])]
}
