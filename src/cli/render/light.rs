//! `umbrage light`: a picture lit by integral expansions, beside brute force.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::DVec3;
use image::{ImageFormat, RgbImage};
use rayon::prelude::*;

use crate::cli::args::{Backend, Machine};
use crate::cli::messages::Report;
use crate::cli::output::{Sink, finish_all, stdout};
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::plot;
use crate::scene::Scene;
use crate::scene::rays::Rays;
use crate::scene::surfaces::Surfaces;
use crate::technique;
#[cfg(feature = "gpu")]
use crate::technique::integrals::gpu::LightPipeline;
use crate::technique::integrals::picture;
use crate::technique::integrals::{Settings, Shaded, Surface, Surroundings, Tables};

/// Largest width and height of a picture.
const MAX_SIDE: u32 = 4096;

/// Directions from pole to pole of a brute-force sum.
const FINENESS: u32 = 128;

/// The same for the plot, whose errors are smaller.
const PLOTTED_FINENESS: u32 = 512;

/// What is said of pictures by the interpreter.
const INTERPRETER: &str = "tables by the interpreter";

/// Thresholds of the plot.
const THRESHOLDS: [f64; 6] = [0.3, 0.1, 0.05, 0.03, 0.02, 0.01];

/// Width and height of the picture that the plot measures.
const PLOTTED: (u32, u32) = (32, 18);

/// Arguments of `umbrage light`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The picture, a PNG file
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// A scene that comes with Umbrage, or the file of one: balls and flat polygons under Gaussian lights
    #[arg(long, value_name = "NAME|FILE", default_value = "studio")]
    scene: String,
    /// Width and height of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "160x90", value_parser = size)]
    size: (u32, u32),
    /// Largest error of the border of visibility and of the lobes in a cell: e_r
    #[arg(long, value_name = "RADIANS", default_value = "0.1", value_parser = threshold, allow_negative_numbers = true)]
    threshold: f64,
    #[command(flatten)]
    machine: Machine,
    /// The same picture by brute force, a PNG file; prints how far they are apart
    #[arg(long, value_name = "FILE")]
    reference: Option<PathBuf>,
    /// The number of cells of each pixel as colours, a PNG file
    #[arg(long, value_name = "FILE")]
    cells: Option<PathBuf>,
    /// Cells per pixel and error against the threshold, an SVG file
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

fn size(text: &str) -> std::result::Result<(u32, u32), String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    sides.ok_or_else(|| format!("expected two numbers from 1 to {MAX_SIDE}, as in 320x180"))
}

fn threshold(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| (0.001..=10.0).contains(number));
    number.ok_or_else(|| "expected a number from 0.001 to 10".to_owned())
}

/// What makes the light at surfaces.
enum Executor<'t> {
    Interpreter(&'t Tables),
    #[cfg(feature = "gpu")]
    Gpu(LightPipeline<'t>),
}

impl Executor<'_> {
    fn shade(&self, scene: &Surroundings, settings: &Settings, surfaces: &[Option<Surface>]) -> Result<Shaded> {
        match self {
            Executor::Interpreter(tables) => Ok(picture::shade(scene, tables, settings, surfaces)?),
            #[cfg(feature = "gpu")]
            Executor::Gpu(pipeline) => Ok(pipeline.shade(scene, settings, surfaces)?),
        }
    }
}

/// Makes everything that was asked for, then writes it.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let [picture_sink, reference_sink, cells_sink, plot_sink] = Sink::several([
        Some(&*arguments.output),
        arguments.reference.as_deref(),
        arguments.cells.as_deref(),
        arguments.plot.as_deref(),
    ])?;

    let world = Scene::open(&arguments.scene)?;
    let scene = Surroundings::new(&world)?;
    let rays = Rays::exact(&world);
    let tables = Tables::new()?;
    let mut say = String::new();
    let machine = arguments.machine.executor(Backend::Cpu, report)?;
    let (executor, place) = match &machine {
        #[cfg(feature = "gpu")]
        technique::Executor::Gpu(gpu) => {
            let start = Instant::now();
            let pipeline = LightPipeline::new(gpu, &tables, &scene)?;
            say += &format!("shader compiled in {:.2} s\n", start.elapsed().as_secs_f64());
            (Executor::Gpu(pipeline), gpu.describe())
        }
        technique::Executor::Cpu => (Executor::Interpreter(&tables), INTERPRETER.to_owned()),
    };

    let (width, height) = arguments.size;
    let settings = Settings::with_threshold(arguments.threshold);
    let mut sinks = Vec::new();
    let mut put = |sink: Option<Sink>, bytes: &[u8]| -> Result<()> {
        let Some(mut sink) = sink else { return Ok(()) };
        sink.write_all(bytes)?;
        sinks.push(sink);
        Ok(())
    };
    let start = Instant::now();
    let surfaces = scene.surfaces(&rays, &Surfaces::new(&world, &rays, width, height));
    let shaded = executor.shade(&scene, &settings, &surfaces)?;
    let seconds = start.elapsed().as_secs_f64();
    let (cells, edges) = means(&shaded);
    say += &format!("{width} x {height} pixels in {seconds:.2} s, {place}, threshold {}\n", arguments.threshold);
    say += &format!("per pixel that shows a surface: {cells:.1} cells, {edges:.1} edges\n");
    let developed = picture::developed(width, height, &shaded.light, world.background);
    put(picture_sink, &png(&arguments.output, &developed)?)?;

    if let Some(path) = &arguments.reference {
        let start = Instant::now();
        let exact = reference(&scene, &surfaces, FINENESS);
        say += &format!(
            "brute force with {} directions: {:.2} s; root mean square difference {:.2} %\n",
            2 * FINENESS * FINENESS,
            start.elapsed().as_secs_f64(),
            100.0 * difference(&shaded.light, &exact)
        );
        put(reference_sink, &png(path, &picture::developed(width, height, &exact, world.background))?)?;
    }
    if let Some(path) = &arguments.cells {
        let most = shaded.cells.iter().copied().max().unwrap_or(0);
        say += &format!("cells: white is {most}\n");
        put(cells_sink, &png(path, &picture::counted(width, height, &shaded.cells, most))?)?;
    }
    if plot_sink.is_some() {
        let (width, height) = PLOTTED;
        let surfaces = scene.surfaces(&rays, &Surfaces::new(&world, &rays, width, height));
        put(plot_sink, trade_off(&scene, &surfaces, &executor)?.as_bytes())?;
    }
    finish_all(sinks)?;
    let mut out = stdout();
    out.write_all(say.as_bytes())?;
    out.flush()?;
    Ok(Outcome::Clean)
}

fn png(path: &Path, picture: &RgbImage) -> Result<Vec<u8>> {
    let mut bytes = io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| {
        Failure::bare(path.display().to_string(), Diagnostic::error(codes::UNWRITABLE, error.to_string()))
    })?;
    Ok(bytes.into_inner())
}

/// Cells and edges per pixel that shows a surface.
fn means(shaded: &Shaded) -> (f64, f64) {
    let hit = shaded.light.iter().filter(|light| light.is_some()).count().max(1) as f64;
    let sum = |counts: &[u32]| counts.iter().map(|count| f64::from(*count)).sum::<f64>() / hit;
    (sum(&shaded.cells), sum(&shaded.edges))
}

fn reference(scene: &Surroundings, surfaces: &[Option<Surface>], fineness: u32) -> Vec<Option<DVec3>> {
    let directions = picture::directions(&scene.lobes, fineness);
    let light =
        |surface: &Option<Surface>| surface.as_ref().map(|surface| picture::brute_force(scene, surface, &directions));
    surfaces.par_iter().map(light).collect()
}

/// Root mean square of the difference, relative to that of the second.
fn difference(got: &[Option<DVec3>], exact: &[Option<DVec3>]) -> f64 {
    let pairs = || got.iter().flatten().zip(exact.iter().flatten());
    let error: f64 = pairs().map(|(got, exact)| (*got - *exact).length_squared()).sum();
    let whole: f64 = pairs().map(|(_, exact)| exact.length_squared()).sum();
    (error / whole.max(f64::MIN_POSITIVE)).sqrt()
}

/// Cells per pixel and the error of the picture, against the threshold.
fn trade_off(scene: &Surroundings, surfaces: &[Option<Surface>], executor: &Executor<'_>) -> Result<String> {
    let exact = reference(scene, surfaces, PLOTTED_FINENESS);
    let (mut cells, mut errors) = (Vec::new(), Vec::new());
    for threshold in THRESHOLDS.into_iter().rev() {
        let shaded = executor.shade(scene, &Settings::with_threshold(threshold), surfaces)?;
        cells.push((threshold, means(&shaded).0));
        errors.push((threshold, 100.0 * difference(&shaded.light, &exact)));
    }
    let axis = |label: &str| plot::Axis { label: label.to_owned(), scale: plot::Scale::Log10 };
    let frame = plot::Frame {
        title: "Cells per pixel and error of the picture".to_owned(),
        x: axis("threshold e_r, radians"),
        y: axis("cells per pixel; error in percent"),
        size: (640, 420),
    };
    let series = |name: &str, points: Vec<(f64, f64)>| plot::Series { name: name.to_owned(), points };
    Ok(plot::lines(&frame, &[series("cells per pixel", cells), series("error against brute force, %", errors)]))
}
