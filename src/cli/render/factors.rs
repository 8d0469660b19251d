//! `umbrage quality` of techniques for lights with an extent: errors in the form factor, and the time for them.
//!
//! A technique that casts rays is measured with several numbers of them, so that times can be compared at which
//! techniques are equally good. All of it is one run on one machine.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use comfy_table::{CellAlignment, Table, presets};
use serde_json::{Value as Json, json};

use super::plots;
use crate::cli::args::{Backend, Machine, SettingArguments, TechniqueArgument};
use crate::cli::messages::{Format, Report};
use crate::cli::output::{Sink, finish_all, stdout};
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::plot;
use crate::scene::Scene;
use crate::technique::area::{FACTOR, SAMPLES};
use crate::technique::difference::{Absolute, of_numbers};
use crate::technique::setting::Value;
use crate::technique::{self, Executor, Frame, Rendered, Technique};

/// The errors in the form factor that times are given for.
const LEVELS: [f64; 3] = [0.02, 0.01, 0.005];

/// The order for a comparison.
pub(super) struct Order<'a> {
    /// Names of scenes, or scene files; none for all that have a light for all techniques.
    pub(super) scenes: &'a [String],
    /// The techniques; the others are compared with the first.
    pub(super) techniques: &'a [TechniqueArgument],
    /// Size of the pictures.
    pub(super) size: (u32, u32),
    /// Numbers of rays of a pixel to each light.
    pub(super) rays: &'a [u32],
    /// Pictures of each technique and number of rays, whose median time counts.
    pub(super) rounds: usize,
    /// The file for the numbers.
    pub(super) json: Option<&'a Path>,
    /// The file for the plot.
    pub(super) plot: Option<&'a Path>,
    /// The machine.
    pub(super) machine: &'a Machine,
    /// The settings of the techniques.
    pub(super) settings: &'a SettingArguments,
}

/// A technique in a scene.
struct Row {
    scene: usize,
    technique: TechniqueArgument,
    /// The rays of a pixel to each light, where it casts some.
    rays: Option<u32>,
    error: Absolute,
    /// Median time of a picture, in seconds.
    time: f64,
}

/// Measures, then shows.
pub(super) fn run(order: &Order<'_>, report: &Report) -> Result<Outcome> {
    let techniques = order.techniques;
    let has_light = |scene: &Scene| techniques.iter().all(|one| one.lights().of_scene(scene, one.name()).is_ok());
    let scenes: Vec<Scene> = match order.scenes.is_empty() {
        true => {
            let all = Scene::names().map(Scene::open).collect::<std::result::Result<Vec<_>, _>>()?;
            all.into_iter().filter(has_light).collect()
        }
        false => order.scenes.iter().map(|name| Scene::open(name)).collect::<std::result::Result<_, _>>()?,
    };
    let [json_sink, plot_sink] = Sink::several([order.json, order.plot])?;
    let executor = order.machine.executor(Backend::Auto, report)?;
    let rows = measure(order, &scenes, &executor)?;
    let object = || json(order, &executor, &scenes, &rows);
    let mut sinks = Vec::new();
    if let Some(mut sink) = json_sink {
        writeln!(sink, "{:#}", object())?;
        sinks.push(sink);
    }
    if let (Some(mut sink), Some(path)) = (plot_sink, order.plot) {
        sink.write_all(&plots::file(path, draw(techniques, &scenes, &rows))?)?;
        sinks.push(sink);
    }
    finish_all(sinks)?;
    let mut out = stdout();
    match report.format {
        Format::Json => writeln!(out, "{}", object())?,
        Format::Human => {
            writeln!(out, "{}; errors are those of the sum of the form factors of the lights\n", executor.describe())?;
            for (index, scene) in scenes.iter().enumerate() {
                table(&mut out, scene, techniques, &rows.iter().filter(|row| row.scene == index).collect::<Vec<_>>())?;
            }
        }
    }
    Ok(Outcome::Clean)
}

fn measure(order: &Order<'_>, scenes: &[Scene], executor: &Executor) -> std::result::Result<Vec<Row>, Failure> {
    let techniques = order.techniques;
    let rounds = order.rounds;
    let pictures = |technique: &TechniqueArgument| rounds * rays(order, *technique).len();
    let pictures = 2 + techniques.iter().map(pictures).sum::<usize>();
    let height = u64::from(order.size.1);
    let progress = Progress::new(height * (pictures * scenes.len()) as u64);
    let advance = |rows| progress.advance(rows);
    let mut rows = Vec::new();
    for (scene, opened) in scenes.iter().enumerate() {
        progress.begin(&opened.name);
        let frame = Frame::new(opened, order.size, executor);
        progress.advance(height);
        let mut truths: Vec<(&str, Rendered)> = Vec::new();
        for technique in techniques {
            let Some(name) = technique.truth() else { continue };
            if truths.iter().all(|(known, _)| *known != name) {
                truths.push((name, frame.prepare(technique::from_name(name)?)?.render(&advance)?));
            }
            let truth = truths.iter().find(|(known, _)| *known == name);
            let truth = truth.map_or(Ok(&[][..]), |(_, rendered)| factors(technique::from_name(name)?, rendered))?;
            for rays in rays(order, *technique) {
                let mut settings = order.settings.read(techniques, None)?;
                if let Some(rays) = rays {
                    settings.set(&SAMPLES, Value::Whole(rays));
                }
                let mut prepared = frame.with(settings).prepare(*technique)?;
                let mut times = Vec::new();
                let mut error = Absolute::default();
                for _ in 0..rounds {
                    let start = Instant::now();
                    let rendered = prepared.render(&advance)?;
                    times.push(start.elapsed().as_secs_f64());
                    error = of_numbers(&frame.surfaces, factors(*technique, &rendered)?, truth);
                }
                times.sort_by(f64::total_cmp);
                rows.push(Row { scene, technique: *technique, rays, error, time: times[times.len() / 2] });
            }
        }
    }
    Ok(rows)
}

/// The numbers of rays that a technique is measured with.
fn rays(order: &Order<'_>, technique: &dyn Technique) -> Vec<Option<u32>> {
    match technique.settings().iter().any(|setting| setting.name == SAMPLES.name) {
        true => order.rays.iter().map(|rays| Some(*rays)).collect(),
        false => vec![None],
    }
}

fn factors<'r>(technique: &dyn Technique, rendered: &'r Rendered) -> std::result::Result<&'r [f32], Failure> {
    rendered.numbers(FACTOR).ok_or_else(|| {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{technique}` renders no form factors"));
        Failure::bare("", error)
    })
}

/// The time at which a technique has a root mean square error of so much: between two numbers of rays, by powers.
/// `None` where it never has.
fn time_for(rows: &[&Row], technique: &dyn Technique, level: f64) -> Option<f64> {
    let own: Vec<&&Row> = rows.iter().filter(|row| row.technique == technique).collect();
    let place = own.iter().position(|row| row.error.rmse <= level)?;
    let good = own[place];
    let Some(bad) = place.checked_sub(1).map(|before| own[before]) else { return Some(good.time) };
    let share = (bad.error.rmse / level).ln() / (bad.error.rmse / good.error.rmse.max(1e-12)).ln();
    Some(bad.time * (good.time / bad.time).powf(share))
}

/// The root mean square error that a technique has after a time: between two numbers of rays by powers, and that of the
/// most rays where there is more time than these take. `None` where its fewest rays take longer.
fn error_in(rows: &[&Row], technique: &dyn Technique, time: f64) -> Option<f64> {
    let own: Vec<&&Row> = rows.iter().filter(|row| row.technique == technique).collect();
    let place = own.iter().rposition(|row| row.time <= time)?;
    let quick = own[place];
    let Some(slow) = own.get(place + 1) else { return Some(quick.error.rmse) };
    let share = (time / quick.time).ln() / (slow.time / quick.time).ln();
    Some(quick.error.rmse * (slow.error.rmse / quick.error.rmse.max(1e-12)).powf(share))
}

fn table(out: &mut impl Write, scene: &Scene, techniques: &[TechniqueArgument], rows: &[&Row]) -> Result<()> {
    writeln!(out, "{}: {}", scene.name, scene.title)?;
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_header(["technique", "rays", "ms", "MAE", "RMSE", "most"]);
    for row in rows {
        table.add_row([
            row.technique.name().to_owned(),
            row.rays.map_or(String::new(), |rays| rays.to_string()),
            format!("{:.1}", row.time * 1e3),
            format!("{:.2e}", row.error.mean),
            format!("{:.2e}", row.error.rmse),
            format!("{:.2e}", row.error.most),
        ]);
    }
    table.column_iter_mut().skip(1).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "{}", table.trim_fmt())?;
    let Some((first, others)) = techniques.split_first() else { return Ok(()) };
    if let Some(time) = rows.iter().find(|row| row.technique == *first).map(|row| row.time) {
        let others = others.iter().map(|other| match error_in(rows, *other, time) {
            Some(error) => format!("{other} has RMSE {error:.1e}"),
            None => format!("{other} does not finish"),
        });
        writeln!(out, "In the time of {first}: {}", others.collect::<Vec<_>>().join("; "))?;
    }
    for level in LEVELS {
        let Some(time) = time_for(rows, *first, level) else {
            writeln!(out, "RMSE {level}: {first} does not reach it")?;
            continue;
        };
        let others = others.iter().map(|other| match time_for(rows, *other, level) {
            Some(theirs) => format!("{other} {:.1} ms ({first} takes {:.2} of that)", theirs * 1e3, time / theirs),
            None => format!("{other} does not reach it"),
        });
        let others: Vec<String> = others.collect();
        writeln!(out, "RMSE {level}: {first} {:.1} ms; {}", time * 1e3, others.join("; "))?;
    }
    writeln!(out)?;
    Ok(())
}

fn json(order: &Order<'_>, executor: &Executor, scenes: &[Scene], rows: &[Row]) -> Json {
    let row = |row: &Row| {
        json!({
            "scene": scenes[row.scene].name, "technique": row.technique.name(), "rays": row.rays,
            "ms": row.time * 1e3, "mae": row.error.mean, "rmse": row.error.rmse, "most": row.error.most,
        })
    };
    let (width, height) = order.size;
    json!({
        "width": width, "height": height, "executor": executor.describe(),
        "rows": rows.iter().map(row).collect::<Vec<_>>(),
    })
}

/// A plot per scene: error over time.
fn draw(techniques: &[TechniqueArgument], scenes: &[Scene], rows: &[Row]) -> Vec<String> {
    let one = |(index, scene): (usize, &Scene)| {
        let frame = plot::Frame {
            title: scene.title.clone(),
            x: plot::Axis { label: "ms for a picture".to_owned(), scale: plot::Scale::Log10 },
            y: plot::Axis { label: "RMSE of the form factor".to_owned(), scale: plot::Scale::Log10 },
            size: plots::PLOT,
        };
        let series = |technique: &TechniqueArgument| {
            let own = rows.iter().filter(|row| row.scene == index && row.technique == *technique);
            let mut points: Vec<(f64, f64)> = own.map(|row| (row.time * 1e3, row.error.rmse)).collect();
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            plot::Series { name: technique.name().to_owned(), points }
        };
        plot::lines(&frame, &techniques.iter().map(series).collect::<Vec<_>>())
    };
    scenes.iter().enumerate().map(one).collect()
}
