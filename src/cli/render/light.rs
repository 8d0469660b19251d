//! `umbrage light`: short for `umbrage render --technique integrals`, beside its truth.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use image::ImageFormat;

use super::Canvas;
use crate::cli::args::{Backend, Machine, parse_size};
use crate::cli::messages::Report;
use crate::cli::output::{Sink, finish_all, stdout};
use crate::cli::{Outcome, Result};
use crate::diag::Failure;
use crate::picture::{heat, plot};
use crate::scene::Scene;
use crate::technique::difference::of_light;
use crate::technique::integrals::{BORDER, BRUTE_FORCE, CELLS, DIRECTIONS, EDGES, INTEGRALS, LOBE};
use crate::technique::rendered::LIGHT;
use crate::technique::setting::Value;
use crate::technique::{Executor, Frame, Rendered, Settings, shade};

/// Directions from pole to pole of the sums for the plot, whose errors are small.
const PLOTTED_DIRECTIONS: u32 = 512;

/// Thresholds of the plot.
const THRESHOLDS: [f64; 6] = [0.01, 0.02, 0.03, 0.05, 0.1, 0.3];

/// Width and height of the picture that the plot measures.
const PLOTTED: (u32, u32) = (32, 18);

/// Arguments of `umbrage light`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The picture, a PNG file
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// A scene that comes with Umbrage, or the file of one: balls and flat polygons under Gaussian lights
    #[arg(long, value_name = "SCENE", default_value = "studio")]
    scene: String,
    /// Width and height of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "160x90", value_parser = parse_size)]
    size: (u32, u32),
    /// Largest error of the border of visibility and of the lobes in a cell: e_r
    #[arg(long, value_name = "RADIANS", default_value = "0.1", value_parser = threshold, allow_negative_numbers = true)]
    threshold: Value,
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

fn threshold(text: &str) -> std::result::Result<Value, String> {
    BORDER.parse(text)
}

/// Both thresholds the same.
fn with_threshold(value: Value) -> Settings {
    Settings::default().with(&BORDER, value).with(&LOBE, value)
}

/// Makes everything that was asked for, then writes it.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let [picture_sink, reference_sink, cells_sink, plot_sink] = Sink::several([
        Some(&*arguments.output),
        arguments.reference.as_deref(),
        arguments.cells.as_deref(),
        arguments.plot.as_deref(),
    ])?;
    let scene = Scene::open(&arguments.scene)?;
    let executor = arguments.machine.executor(Backend::Cpu, report)?;
    let mut say = String::new();
    let mut sinks = Vec::new();
    let mut put = |sink: Option<Sink>, bytes: &[u8]| -> Result<()> {
        let Some(mut sink) = sink else { return Ok(()) };
        sink.write_all(bytes)?;
        sinks.push(sink);
        Ok(())
    };

    let frame = Frame::new(&scene, arguments.size, &executor).with(with_threshold(arguments.threshold));
    let start = Instant::now();
    let mut integrals = frame.prepare(&INTEGRALS)?;
    say += &format!("prepared in {:.2} s\n", start.elapsed().as_secs_f64());
    let start = Instant::now();
    let rendered = integrals.render(&|_| {})?;
    let (seconds, (width, height)) = (start.elapsed().as_secs_f64(), arguments.size);
    let (place, threshold) = (executor.describe(), arguments.threshold);
    say += &format!("{width} x {height} pixels in {seconds:.2} s, {place}, threshold {threshold}\n");
    let [cells, edges] = [CELLS, EDGES].map(|layer| mean(&frame, &rendered, layer));
    say += &format!("per pixel that shows a surface: {cells:.1} cells, {edges:.1} edges\n");
    put(picture_sink, &png(&frame, &rendered)?)?;

    if reference_sink.is_some() {
        let start = Instant::now();
        let truth = frame.prepare(&BRUTE_FORCE)?.render(&|_| {})?;
        let fineness = frame.settings.whole(&DIRECTIONS);
        say += &format!(
            "brute force with {} directions: {:.2} s; root mean square difference {:.2} %\n",
            2 * fineness * fineness,
            start.elapsed().as_secs_f64(),
            100.0 * error(&frame, &rendered, &truth)
        );
        put(reference_sink, &png(&frame, &truth)?)?;
    }
    if cells_sink.is_some() {
        let counts = rendered.counts(CELLS).unwrap_or_default();
        let most = counts.iter().copied().max().unwrap_or(0);
        say += &format!("cells: white is {most}\n");
        let picture = heat::counts(width, height, counts, most);
        put(cells_sink, &Canvas::Encoded(picture).bytes(ImageFormat::Png)?)?;
    }
    if plot_sink.is_some() {
        put(plot_sink, trade_off(&scene, &executor)?.as_bytes())?;
    }
    finish_all(sinks)?;
    let mut out = stdout();
    out.write_all(say.as_bytes())?;
    out.flush()?;
    Ok(Outcome::Clean)
}

/// The picture as `umbrage render` writes it.
fn png(frame: &Frame<'_>, rendered: &Rendered) -> std::result::Result<Vec<u8>, Failure> {
    Canvas::Linear(shade::picture(frame, rendered)?).bytes(ImageFormat::Png)
}

/// The mean of a layer of counts over the pixels that show a surface.
fn mean(frame: &Frame<'_>, rendered: &Rendered, layer: &str) -> f64 {
    let surfaces = frame.surfaces.points.iter().flatten().count().max(1);
    let counts = rendered.counts(layer).unwrap_or_default();
    counts.iter().map(|count| f64::from(*count)).sum::<f64>() / surfaces as f64
}

/// The error of light against the true one, relative to it.
fn error(frame: &Frame<'_>, rendered: &Rendered, truth: &Rendered) -> f64 {
    let [light, truth] = [rendered, truth].map(|rendered| rendered.colours(LIGHT).unwrap_or_default());
    of_light(&frame.surfaces, light, truth)
}

/// Cells per pixel and the error of the picture, against the threshold.
fn trade_off(scene: &Scene, executor: &Executor) -> Result<String> {
    let frame = Frame::new(scene, PLOTTED, executor);
    let fine = Settings::default().with(&DIRECTIONS, Value::Whole(PLOTTED_DIRECTIONS));
    let truth = frame.with(fine).prepare(&BRUTE_FORCE)?.render(&|_| {})?;
    let mut integrals = frame.prepare(&INTEGRALS)?;
    let (mut cells, mut errors) = (Vec::new(), Vec::new());
    for threshold in THRESHOLDS {
        integrals.set_frame(&frame.with(with_threshold(Value::Number(threshold))))?;
        let rendered = integrals.render(&|_| {})?;
        cells.push((threshold, mean(&frame, &rendered, CELLS)));
        errors.push((threshold, 100.0 * error(&frame, &rendered, &truth)));
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
