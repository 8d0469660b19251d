//! `umbrage quality`: how far each technique is from the true shadow; of lights with an extent see `factors.rs`.

use std::io::Write;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::{factors, plots};
use crate::cli::args::{
    Backend, Machine, SettingArguments, TechniqueArgument, parse_map, parse_size, technique_parser,
};
use crate::cli::messages::{Format, Report};
use crate::cli::output::{Sink, finish_all, stdout};
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::plot;
use crate::scene::Scene;
use crate::technique::difference::{Difference, NEAR, Region, difference};
use crate::technique::rendered::VALUE;
use crate::technique::{self, Ability, Executor, Frame, Prepared, Rendered, Technique, shade};

/// Arguments of `umbrage quality`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The scenes, names or scene files [default: all that come with Umbrage]
    #[arg(long, value_name = "SCENES", value_delimiter = ',')]
    scenes: Vec<String>,
    /// The techniques [default: all whose true visibility is known]
    #[arg(long, value_name = "TECHNIQUES", value_delimiter = ',', value_parser = technique_parser(),
          hide_possible_values = true)]
    techniques: Vec<TechniqueArgument>,
    /// Sizes of the shadow map
    #[arg(long, value_name = "TEXELS", value_delimiter = ',', default_value = "256,512,1024,2048,4096", value_parser = parse_map)]
    shadow_maps: Vec<u32>,
    /// Size of the pictures
    #[arg(long, default_value = "640x360", value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: (u32, u32),
    /// Rays of a pixel to each light, of techniques for lights with an extent
    #[arg(long, value_name = "RAYS", value_delimiter = ',', default_value = "1,4,16,64,256",
          value_parser = clap::value_parser!(u32).range(1..=65536))]
    rays: Vec<u32>,
    /// Pictures of each of these techniques, whose median time counts
    #[arg(long, value_name = "COUNT", default_value_t = 3,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1000))]
    rounds: usize,
    /// Write the numbers as JSON as well
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Plot the errors: *.svg or *.png
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    settings: SettingArguments,
}

/// The errors of one technique.
struct Row {
    scene: String,
    map: u32,
    technique: TechniqueArgument,
    all: Difference,
    near: Difference,
}

/// Measures, then shows.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    plots::is_plot(arguments.plot.as_deref())?;
    let has_factors = |one: &&TechniqueArgument| one.abilities().contains(&Ability::FormFactors);
    if let Some(one) = arguments.techniques.iter().find(has_factors) {
        for other in &arguments.techniques {
            technique::require(*other, Ability::FormFactors, &format!("quality beside {one}"))?;
        }
        return factors::run(
            &factors::Order {
                scenes: &arguments.scenes,
                techniques: &with_truth(&arguments.techniques, Ability::FormFactors)?,
                size: arguments.size,
                rays: &arguments.rays,
                rounds: arguments.rounds,
                json: arguments.json.as_deref(),
                plot: arguments.plot.as_deref(),
                machine: &arguments.machine,
                settings: &arguments.settings,
            },
            report,
        );
    }
    let techniques = techniques(arguments)?;
    let open = |name: &str| Scene::open(name);
    let scenes: std::result::Result<Vec<Scene>, Failure> = if arguments.scenes.is_empty() {
        // Of the scenes that come with Umbrage, those with a light that has a shadow map.
        Scene::names().map(open).filter(|scene| scene.as_ref().map_or(true, Scene::has_punctual)).collect()
    } else {
        arguments.scenes.iter().map(|name| open(name)).collect()
    };
    let scenes = scenes?;
    let [json_sink, plot_sink] = Sink::several([arguments.json.as_deref(), arguments.plot.as_deref()])?;
    let executor = arguments.machine.executor(Backend::Auto, report)?;
    let rows = measure(arguments, &techniques, &scenes, &executor)?;

    let object = || json(arguments, &executor, &rows);
    let mut sinks = Vec::new();
    if let Some(mut sink) = json_sink {
        writeln!(sink, "{:#}", object())?;
        sinks.push(sink);
    }
    if let (Some(mut sink), Some(path)) = (plot_sink, &arguments.plot) {
        sink.write_all(&plots::file(path, draw(arguments, &techniques, &scenes, &rows))?)?;
        sinks.push(sink);
    }
    finish_all(sinks)?;
    let mut out = stdout();
    match report.format {
        Format::Json => writeln!(out, "{}", object())?,
        Format::Human => {
            for scene in &scenes {
                table(&mut out, arguments, &techniques, scene, &rows)?;
            }
            verdicts(&mut out, arguments, &techniques, &scenes, &rows)?;
        }
    }
    Ok(Outcome::Clean)
}

/// The techniques that are measured, true pictures left out.
fn techniques(arguments: &Arguments) -> std::result::Result<Vec<TechniqueArgument>, Failure> {
    for technique in &arguments.techniques {
        technique::require(*technique, Ability::Visibility, "quality")?;
    }
    with_truth(
        if arguments.techniques.is_empty() { technique::ALL } else { &arguments.techniques },
        Ability::Visibility,
    )
}

/// Those with an ability whose truth is another technique.
fn with_truth(asked: &[TechniqueArgument], ability: Ability) -> std::result::Result<Vec<TechniqueArgument>, Failure> {
    let has_truth = |technique: &dyn Technique| technique.truth().is_some() && technique.abilities().contains(&ability);
    let measured: Vec<TechniqueArgument> = asked.iter().copied().filter(|technique| has_truth(*technique)).collect();
    if measured.is_empty() {
        let message = "no true picture is known for the techniques that were named";
        let with = technique::names(has_truth);
        let error = Diagnostic::error(codes::NOT_APPLICABLE, message);
        return Err(Failure::bare("", error.help(format!("techniques with one are {}", technique::and(&with)))));
    }
    Ok(measured)
}

/// The true pictures of a scene, by the name of the technique that makes them.
type Truths = Vec<(&'static str, Vec<f32>)>;

fn measure(
    arguments: &Arguments,
    techniques: &[TechniqueArgument],
    scenes: &[Scene],
    executor: &Executor,
) -> std::result::Result<Vec<Row>, Failure> {
    let height = u64::from(arguments.size.1);
    let per_scene = 2 + arguments.shadow_maps.len() * techniques.len();
    let progress = Progress::new(height * (per_scene * scenes.len()) as u64);
    let advance = |rows| progress.advance(rows);
    let mut prepared: Vec<Option<Box<dyn Prepared<'_> + '_>>> = techniques.iter().map(|_| None).collect();
    let mut rows = Vec::new();
    for scene in scenes {
        let mut frame = Frame::new(scene, arguments.size, executor);
        // Maps are the same on every machine, and so are the errors.
        frame.by_rays = true;
        progress.advance(height);
        let mut truths = Truths::new();
        for name in techniques.iter().filter_map(|technique| technique.truth()) {
            if truths.iter().all(|(known, _)| *known != name) {
                progress.begin(&format!("{}, {name}", scene.name));
                let truth = technique::from_name(name)?;
                let rendered = frame.prepare(truth)?.render(&advance)?;
                truths.push((name, value(truth, &rendered)?.to_vec()));
            }
        }
        for map in &arguments.shadow_maps {
            progress.begin(&format!("{}, {map}", scene.name));
            let frame = frame.with(arguments.settings.read(techniques, Some(*map))?);
            for (technique, prepared) in techniques.iter().zip(&mut prepared) {
                let truth = truths.iter().find(|(name, _)| technique.truth() == Some(*name));
                let truth = truth.map_or(&[][..], |(_, truth)| truth);
                let ready = match prepared {
                    Some(ready) => {
                        ready.set_frame(&frame)?;
                        ready
                    }
                    None => prepared.insert(frame.prepare(*technique)?),
                };
                let rendered = ready.render(&advance)?;
                let value = value(*technique, &rendered)?;
                let weights = shade::contribution(&scene.punctual(technique.name())?, &frame.surfaces);
                let regions = [
                    Region::surfaces(&frame.surfaces, &weights),
                    Region::silhouettes(&frame.surfaces, &weights, truth),
                ];
                let [all, near] = regions.map(|region| difference(&frame.surfaces, value, truth, &region));
                rows.push(Row { scene: scene.name.clone(), map: *map, technique: *technique, all, near });
            }
        }
    }
    Ok(rows)
}

/// The visibility that a technique rendered.
fn value(technique: TechniqueArgument, rendered: &Rendered) -> std::result::Result<&[f32], Failure> {
    rendered.numbers(VALUE).ok_or_else(|| {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{technique}` renders no visibility"));
        Failure::bare("", error.help("errors are measured of the share of light that reaches each pixel"))
    })
}

fn find<'r>(rows: &'r [Row], scene: &Scene, map: u32, technique: TechniqueArgument) -> Option<&'r Row> {
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
fn table(
    out: &mut impl Write,
    arguments: &Arguments,
    techniques: &[TechniqueArgument],
    scene: &Scene,
    rows: &[Row],
) -> Result<()> {
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
            let cell = |technique: &TechniqueArgument| {
                let found = find(rows, scene, *map, *technique).map(measure);
                found.map_or(String::new(), |(all, near)| format!("{all:.4} / {near:.4}"))
            };
            table.add_row([map.to_string()].into_iter().chain(techniques.iter().map(cell)));
        }
        writeln!(out, "{}\n", table.trim_fmt())?;
    }
    Ok(())
}

/// The meaning of the numbers, loss by loss: where a technique is worse than the first, the cheapest one. Errors are
/// those near silhouettes.
fn verdicts(
    out: &mut impl Write,
    arguments: &Arguments,
    techniques: &[TechniqueArgument],
    scenes: &[Scene],
    rows: &[Row],
) -> Result<()> {
    writeln!(
        out,
        "Each cell: all surfaces / within {NEAR} pixels of a true silhouette, weighted by the light that would be \
         there.\nIn what follows, RMSE near silhouettes."
    )?;
    let Some((first, others)) = techniques.split_first() else { return Ok(()) };
    let near = |scene, map, technique| find(rows, scene, map, technique).map(|row| row.near.rmse);
    let mut losses = Vec::new();
    for scene in scenes {
        for map in &arguments.shadow_maps {
            let Some(least) = near(scene, *map, *first) else { continue };
            let worse = others.iter().filter_map(|technique| {
                let error = near(scene, *map, *technique)?;
                (error > least).then(|| format!("{technique} {error:.4}"))
            });
            let worse: Vec<String> = worse.collect();
            if !worse.is_empty() {
                losses.push(format!("{}, {map}: worse than {first} ({least:.4}): {}", scene.name, worse.join(", ")));
            }
        }
    }
    if !losses.is_empty() {
        writeln!(out, "\nLosses:")?;
        losses.iter().try_for_each(|line| writeln!(out, "  {line}"))?;
    }
    Ok(())
}

/// A plot per scene: error near silhouettes over the size of the map.
fn draw(arguments: &Arguments, techniques: &[TechniqueArgument], scenes: &[Scene], rows: &[Row]) -> Vec<String> {
    scenes
        .iter()
        .map(|scene| {
            let frame = plot::Frame {
                title: scene.title.clone(),
                x: plot::Axis { label: "texels per side of the shadow map".to_owned(), scale: plot::Scale::Log2 },
                y: plot::Axis { label: "RMSE near silhouettes".to_owned(), scale: plot::Scale::Linear },
                size: plots::PLOT,
            };
            let series = |technique: &TechniqueArgument| {
                let at = |map: &u32| Some((f64::from(*map), find(rows, scene, *map, *technique)?.near.rmse));
                let mut points: Vec<(f64, f64)> = arguments.shadow_maps.iter().filter_map(at).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                plot::Series { name: technique.name().to_owned(), points }
            };
            let all: Vec<plot::Series> = techniques.iter().map(series).collect();
            plot::lines(&frame, &all)
        })
        .collect()
}
