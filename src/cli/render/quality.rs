//! `umbrage quality`: how far each technique is from the true shadow.

use std::io::{self, Write};
use std::path::PathBuf;

use serde_json::{Value, json};

use super::frame::{FrameArguments, parse_map, parse_size, parse_technique};
use crate::cli::input::has_extension;
use crate::cli::messages::{Format, Report};
use crate::cli::output::Sink;
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::compare;
use crate::picture::compare::{Difference, NEAR, Region};
use crate::picture::{self, plot};
use crate::scene::Scene;
use crate::technique::executor::Executor;
use crate::technique::revectorise::Technique;
use crate::technique::revectorise::reference;
use crate::technique::revectorise::reference::Samples;
use crate::technique::revectorise::stage::Stage;
use crate::text::file::shown;

/// Arguments of `umbrage quality`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The scenes, names or scene files [default: all that come with Umbrage]
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    scenes: Vec<String>,
    /// The techniques [default: all]
    #[arg(long, value_name = "TECHNIQUES", value_delimiter = ',', value_parser = parse_technique)]
    techniques: Vec<Technique>,
    /// Sizes of the shadow map
    #[arg(long, value_name = "TEXELS", value_delimiter = ',', default_value = "256,512,1024,2048,4096", value_parser = parse_map)]
    shadow_maps: Vec<u32>,
    /// Size of the pictures
    #[arg(long, default_value = "640x360", value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: (u32, u32),
    /// Write the numbers as JSON as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Plot the errors: *.svg or *.png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    frame: FrameArguments,
}

/// The errors of one technique.
struct Row {
    scene: String,
    map: u32,
    technique: Technique,
    all: Difference,
    near: Difference,
}

/// Measures, then shows.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    if let Some(path) = &arguments.plot
        && !has_extension(path, "svg")
        && !has_extension(path, "png")
    {
        let message = format!("`{}` is no kind of plot that can be written", shown(path));
        let error = Diagnostic::error(codes::RENDER, message).help("name it *.svg or *.png");
        return Err(Failure::bare("", error).into());
    }
    let open = |name: &str| Scene::open(name);
    let scenes: std::result::Result<Vec<Scene>, Failure> = if arguments.scenes.is_empty() {
        // Of the scenes that come with Umbrage, those with a light that has a shadow map.
        Scene::names().map(open).filter(|scene| scene.as_ref().map_or(true, Scene::has_punctual)).collect()
    } else {
        arguments.scenes.iter().map(|name| open(name)).collect()
    };
    let scenes = scenes?;
    let json_sink = arguments.json.as_deref().map(Sink::create).transpose()?;
    let plot_sink = arguments.plot.as_deref().map(Sink::create).transpose()?;
    let executor = arguments.frame.executor(report)?;
    let rows = measure(arguments, &scenes, &executor)?;

    let object = || json(arguments, &executor, &rows);
    if let Some(mut sink) = json_sink {
        writeln!(sink, "{:#}", object()).map_err(|error| sink.failure(&error))?;
        sink.finish()?;
    }
    if let Some(mut sink) = plot_sink {
        let svg = draw(arguments, &scenes, &rows);
        let as_png = arguments.plot.as_deref().is_some_and(|path| has_extension(path, "png"));
        let bytes = if as_png { picture::png(&picture::raster(&svg, 1.0)?)? } else { svg.into_bytes() };
        sink.write_all(&bytes).map_err(|error| sink.failure(&error))?;
        sink.finish()?;
    }
    let mut out = io::stdout().lock();
    match report.format {
        Format::Json => writeln!(out, "{}", object())?,
        Format::Human => {
            for scene in &scenes {
                table(&mut out, arguments, scene, &rows)?;
            }
            verdicts(&mut out, arguments, &scenes, &rows)?;
        }
    }
    Ok(Outcome::Clean)
}

/// The techniques that are measured, the reference never being one.
fn techniques(arguments: &Arguments) -> Vec<Technique> {
    let asked = match arguments.techniques.is_empty() {
        true => Technique::ALL.to_vec(),
        false => arguments.techniques.clone(),
    };
    asked.into_iter().filter(|technique| *technique != Technique::Reference).collect()
}

fn measure(arguments: &Arguments, scenes: &[Scene], executor: &Executor) -> std::result::Result<Vec<Row>, Failure> {
    let (width, height) = arguments.size;
    let techniques = techniques(arguments);
    // The truth takes as long as many techniques.
    let per_scene = 2 + arguments.shadow_maps.len() * (techniques.len() + 1);
    let progress = Progress::new(u64::from(height) * (per_scene * scenes.len()) as u64);
    let settings = arguments.frame.settings();
    let mut rows = Vec::new();
    for scene in scenes {
        progress.begin(&format!("{}, reference", scene.name));
        let stage = Stage::new(scene)?;
        let picture = stage.surfaces(width, height);
        let advance = |steps| progress.advance(steps);
        let truth = reference::visibility(&stage, &picture, Samples::default(), &advance);
        let (all, near) = (Region::surfaces(&picture), Region::silhouettes(&picture, &truth));
        for map_size in &arguments.shadow_maps {
            progress.begin(&format!("{}, {map_size}", scene.name));
            let map = stage.shadow_map(*map_size, arguments.frame.bias());
            let receivers = stage.receivers(&picture, *map_size);
            progress.advance(u64::from(height));
            for technique in &techniques {
                let seen = executor.visibility(*technique, &map, &receivers, &settings, &advance)?;
                let difference = |region| compare::difference(&picture, &seen.value, &truth, region);
                rows.push(Row {
                    scene: scene.name.clone(),
                    map: *map_size,
                    technique: *technique,
                    all: difference(&all),
                    near: difference(&near),
                });
            }
        }
    }
    Ok(rows)
}

fn find<'r>(rows: &'r [Row], scene: &Scene, map: u32, technique: Technique) -> Option<&'r Row> {
    rows.iter().find(|row| row.scene == scene.name && row.map == map && row.technique == technique)
}

fn json(arguments: &Arguments, executor: &Executor, rows: &[Row]) -> Value {
    let row = |row: &Row| {
        json!({
            "scene": row.scene, "shadow_map": row.map, "technique": row.technique.name(),
            "rmse": row.all.rmse, "rmse_near": row.near.rmse,
            "dssim": row.all.dissimilarity, "dssim_near": row.near.dissimilarity,
        })
    };
    let (width, height) = arguments.size;
    json!({
        "width": width, "height": height, "near_pixels": NEAR, "executor": executor.describe(),
        "rows": rows.iter().map(row).collect::<Vec<_>>(),
    })
}

/// The errors in one scene: a line per map size, a column per technique.
fn table(out: &mut impl Write, arguments: &Arguments, scene: &Scene, rows: &[Row]) -> Result<()> {
    let techniques = techniques(arguments);
    writeln!(out, "{}: {}", scene.name, scene.title)?;
    type Measure = (&'static str, fn(&Row) -> (f64, f64));
    let measures: [Measure; 2] = [
        ("RMSE", |row| (row.all.rmse, row.near.rmse)),
        ("1 - SSIM", |row| (row.all.dissimilarity, row.near.dissimilarity)),
    ];
    for (name, measure) in measures {
        let mut table = comfy_table::Table::new();
        table.load_preset(comfy_table::presets::NOTHING);
        let head = [name.to_owned()].into_iter().chain(techniques.iter().map(|technique| technique.to_string()));
        table.set_header(head);
        for map in &arguments.shadow_maps {
            let cell = |technique: &Technique| {
                let found = find(rows, scene, *map, *technique).map(measure);
                found.map_or(String::new(), |(all, near)| format!("{all:.4} / {near:.4}"))
            };
            table.add_row([map.to_string()].into_iter().chain(techniques.iter().map(cell)));
        }
        writeln!(out, "{}\n", table.trim_fmt())?;
    }
    Ok(())
}

/// What the numbers mean, loss by loss. Errors are those near silhouettes.
fn verdicts(out: &mut impl Write, arguments: &Arguments, scenes: &[Scene], rows: &[Row]) -> Result<()> {
    writeln!(
        out,
        "Each cell: all surfaces / within {NEAR} pixels of a true silhouette. In what follows, RMSE near silhouettes."
    )?;
    let near = |scene, map, technique| find(rows, scene, map, technique).map(|row| row.near.rmse);
    let mut losses = Vec::new();
    let mut goal = Vec::new();
    for scene in scenes {
        for map in &arguments.shadow_maps {
            let Some(hard) = near(scene, *map, Technique::Hard) else { continue };
            let worse = techniques(arguments).into_iter().filter_map(|technique| {
                let error = near(scene, *map, technique)?;
                (error > hard).then(|| format!("{technique} {error:.4}"))
            });
            let worse: Vec<String> = worse.collect();
            if !worse.is_empty() {
                losses.push(format!("{}, {map}: worse than hard ({hard:.4}): {}", scene.name, worse.join(", ")));
            }
            if let (Some(rsmss), Some(case_free)) =
                (near(scene, *map, Technique::Rsmss), near(scene, *map, Technique::CaseFree))
                && rsmss > case_free
            {
                losses.push(format!("{}, {map}: rsmss {rsmss:.4} loses to casefree {case_free:.4}", scene.name));
            }
            if let (Some(rsmss), Some(fine)) =
                (near(scene, *map, Technique::Rsmss), map.checked_mul(4).and_then(|m| near(scene, m, Technique::Hard)))
            {
                let verdict = if rsmss <= fine { "reached" } else { "missed" };
                let fine_map = 4 * map;
                goal.push(format!(
                    "{}: rsmss at {map} {rsmss:.4}, hard at {fine_map} {fine:.4}: {verdict}",
                    scene.name
                ));
            }
        }
    }
    for (head, lines) in [("Losses", losses), ("rsmss at N against hard at 4N", goal)] {
        if !lines.is_empty() {
            writeln!(out, "\n{head}:")?;
            lines.iter().try_for_each(|line| writeln!(out, "  {line}"))?;
        }
    }
    Ok(())
}

/// A plot per scene, in rows of three: error near silhouettes over the size of the map.
fn draw(arguments: &Arguments, scenes: &[Scene], rows: &[Row]) -> String {
    let (width, height) = (420, 320);
    let plots: String = scenes
        .iter()
        .enumerate()
        .map(|(index, scene)| {
            let frame = plot::Frame {
                title: scene.title.clone(),
                x: plot::Axis { label: "texels per side of the shadow map".to_owned(), scale: plot::Scale::Log2 },
                y: plot::Axis { label: "RMSE near silhouettes".to_owned(), scale: plot::Scale::Linear },
                size: (width, height),
            };
            let series = |technique: Technique| {
                let at = |map: &u32| Some((f64::from(*map), find(rows, scene, *map, technique)?.near.rmse));
                let mut points: Vec<(f64, f64)> = arguments.shadow_maps.iter().filter_map(at).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                plot::Series { name: technique.name().to_owned(), points }
            };
            let all: Vec<plot::Series> = techniques(arguments).into_iter().map(series).collect();
            let (x, y) = (index as u32 % 3 * width, index as u32 / 3 * height);
            plot::lines(&frame, &all).replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1)
        })
        .collect();
    let count = scenes.len() as u32;
    let (width, height) = (count.min(3) * width, count.div_ceil(3) * height);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>{plots}</svg>\n"
    )
}
