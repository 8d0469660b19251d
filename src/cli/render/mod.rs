//! `umbrage render`: a scene and a technique in, a picture out.

#[cfg(feature = "gpu")]
pub(crate) mod bench;
mod factors;
pub(crate) mod light;
mod plots;
pub(crate) mod quality;
#[cfg(feature = "gpu")]
pub(crate) mod vertices;

use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};

use image::{ImageFormat, Rgb32FImage, RgbImage};
use serde_json::json;

use super::args::{Backend, Machine, SettingArguments, TechniqueArgument, parse_map, parse_size, technique_parser};
use super::input::has_extension;
use super::messages::{Format, Report};
use super::output::{Sink, finish_all, stdout};
use super::progress::Progress;
use super::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::sheet::{self, Entry};
use crate::picture::{heat, srgb};
use crate::program::Program;
use crate::scene::Scene;
use crate::technique::difference::{Region, difference, of_light};
use crate::technique::rendered::{CASE, DEFAULT, LIGHT, NONE, VALUE};
use crate::technique::{self, Ability, Executor, Frame, Inputs, Rendered, Samples, capture, cases, shade};
use crate::text::file::shown;

/// Arguments of `umbrage render`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene: a name (see `umbrage scenes`) or a scene file
    #[arg(long, value_name = "SCENE")]
    scene: String,
    /// The technique
    #[arg(long, default_value = "rsmss", value_name = "TECHNIQUE", value_parser = technique_parser())]
    technique: TechniqueArgument,
    /// Size of the picture, of each picture with --compare
    #[arg(long, default_value = "960x540", value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: (u32, u32),
    /// Texels per side of the shadow map
    #[arg(long, default_value = "1024", value_name = "TEXELS", value_parser = parse_map)]
    shadow_map: u32,
    /// The file for the picture: *.png, or *.exr with linear values
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Colour each pixel by the case that was taken, and add a legend
    #[arg(long, conflicts_with = "compare")]
    cases: bool,
    /// Instead of the light, a layer of counts as a heat map, white where there are most
    #[arg(long, value_name = "LAYER", conflicts_with_all = ["compare", "cases"])]
    layer: Option<String>,
    /// Instead of one picture a contact sheet of several techniques, with enlarged parts
    #[arg(long, value_name = "TECHNIQUES", value_delimiter = ',', value_parser = technique_parser(), conflicts_with = "technique",
          hide_possible_values = true)]
    compare: Vec<TechniqueArgument>,
    /// Say how many pixels took each case
    #[arg(long)]
    stats: bool,
    /// Write the table's inputs in every pixel that asks it: binary, or *.csv; where several tables are asked, one file
    /// for each, with its name before the extension
    #[arg(long, value_name = "FILE", conflicts_with = "compare")]
    capture: Option<PathBuf>,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    settings: SettingArguments,
}

/// A technique's answer for a frame.
struct Answer<'s> {
    technique: TechniqueArgument,
    /// The table that its cases are of.
    table: Option<&'s Program>,
    rendered: Rendered,
}

/// Renders, then writes what was asked for.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let techniques = if arguments.compare.is_empty() { vec![arguments.technique] } else { arguments.compare.clone() };
    check(arguments)?;
    let settings = arguments.settings.read(&techniques, Some(arguments.shadow_map))?;
    let scene = Scene::open(&arguments.scene)?;
    // Places that cannot be written are found before the work is done.
    let [picture_sink, capture_sink] = Sink::several([arguments.output.as_deref(), arguments.capture.as_deref()])?;
    let needs_device = techniques.iter().any(|technique| technique.needs_device());
    let executor = if needs_device { arguments.machine.executor(Backend::Auto, report)? } else { Executor::Cpu };

    let height = u64::from(arguments.size.1);
    let progress = Progress::new(height * (techniques.len() as u64 + 1));
    progress.begin("camera");
    let frame = Frame::new(&scene, arguments.size, &executor).with(settings);
    progress.advance(height);
    let mut answers = Vec::new();
    let mut captured = Vec::new();
    for technique in techniques {
        progress.begin(technique.name());
        let mut prepared = frame.prepare(technique)?;
        let rendered = prepared.render(&|rows| progress.advance(rows))?;
        if arguments.capture.is_some() {
            captured = prepared.inputs()?;
        }
        answers.push(Answer { technique, table: prepared.table(), rendered });
    }
    drop(progress);

    let mut sinks = Vec::new();
    if let Some(mut sink) = picture_sink {
        sink.write_all(&draw(arguments, &frame, &answers)?)?;
        sinks.push(sink);
    }
    if let (Some(sink), Some(path)) = (capture_sink, &arguments.capture) {
        for (inputs, mut sink) in captured.iter().zip(places(&captured, path, sink)?) {
            capture::write(inputs, has_extension(path, "csv"), &mut sink)?;
            sinks.push(sink);
        }
    }
    finish_all(sinks)?;
    if arguments.stats {
        for answer in &answers {
            stats(report, &frame, answer)?;
        }
    }
    Ok(Outcome::Clean)
}

/// Finds combinations of options that make no sense.
fn check(arguments: &Arguments) -> std::result::Result<(), Failure> {
    let error = |message: String, help: &str| {
        Err(Failure::bare("", Diagnostic::error(codes::RENDER, message).help(help.to_owned())))
    };
    if arguments.output.is_none() && arguments.capture.is_none() && !arguments.stats {
        return error("nothing is asked for".to_owned(), "name a picture with `-o`, or say `--stats` or `--capture`");
    }
    if let Some(path) = &arguments.output
        && format_of(path).is_none()
    {
        let message = format!("`{}` is no kind of picture that can be written", shown(path));
        return error(message, "name it *.png or *.exr");
    }
    if arguments.cases {
        technique::require(arguments.technique, Ability::Cases, "--cases")?;
    }
    if arguments.capture.is_some() {
        technique::require(arguments.technique, Ability::Inputs, "--capture")?;
    }
    Ok(())
}

/// The places of captures: the one that was named, or one beside it for each of several tables.
fn places(captured: &[Inputs<'_>], path: &Path, named: Sink) -> std::result::Result<Vec<Sink>, Failure> {
    if captured.len() == 1 {
        return Ok(vec![named]);
    }
    let Some(stem) = path.file_stem().filter(|_| !matches!(named, Sink::Stdout(_))) else {
        let names: Vec<&str> = captured.iter().map(|inputs| inputs.program.name.as_str()).collect();
        let message = format!("the inputs of {} do not go to one place", technique::and(&names));
        return Err(Failure::bare("", Diagnostic::error(codes::RENDER, message).help("name a file")));
    };
    let place = |inputs: &Inputs<'_>| {
        let mut name = stem.to_owned();
        name.push(format!("-{}", inputs.program.name));
        if let Some(extension) = path.extension() {
            name.push(".");
            name.push(extension);
        }
        Sink::create(&path.with_file_name(name))
    };
    captured.iter().map(place).collect()
}

fn format_of(path: &Path) -> Option<ImageFormat> {
    match (has_extension(path, "png"), has_extension(path, "exr")) {
        (true, _) => Some(ImageFormat::Png),
        (_, true) => Some(ImageFormat::OpenExr),
        _ => None,
    }
}

/// The picture that was asked for, as the bytes of its file.
fn draw(arguments: &Arguments, frame: &Frame<'_>, answers: &[Answer<'_>]) -> std::result::Result<Vec<u8>, Failure> {
    let image = match answers {
        [Answer { table: Some(table), rendered, .. }] if arguments.cases => {
            let picture = srgb::encode(&shade::picture(frame, rendered)?);
            let taken = rendered.counts(CASE).unwrap_or_default();
            Canvas::Encoded(sheet::coloured(&picture, &cases::legend(table, taken))?)
        }
        [answer] if arguments.layer.is_some() => Canvas::Encoded(layer(arguments, frame, answer)?),
        [answer] if arguments.compare.is_empty() => Canvas::Linear(shade::picture(frame, &answer.rendered)?),
        _ => Canvas::Encoded(contact(frame, answers)?),
    };
    let format = arguments.output.as_deref().and_then(format_of).unwrap_or(ImageFormat::Png);
    image.bytes(format)
}

/// A layer of counts or numbers as a heat map.
fn layer(arguments: &Arguments, frame: &Frame<'_>, answer: &Answer<'_>) -> std::result::Result<RgbImage, Failure> {
    let name = arguments.layer.as_deref().unwrap_or_default();
    let (width, height) = frame.size();
    match answer.rendered.layer(name) {
        Some(Samples::Counts(counts)) => {
            // No surface is no count.
            let shown: Vec<u32> = counts.iter().map(|count| if *count >= DEFAULT { 0 } else { *count }).collect();
            Ok(heat::counts(width, height, &shown, shown.iter().copied().max().unwrap_or_default()))
        }
        Some(Samples::Numbers(numbers)) => Ok(heat::numbers(width, height, numbers)),
        Some(Samples::Colours(_)) | None => {
            let is_map = |samples: &Samples| matches!(samples, Samples::Counts(_) | Samples::Numbers(_));
            let with = answer.rendered.layers.iter().filter(|layer| is_map(&layer.samples));
            let with: Vec<&str> = with.map(|layer| layer.name).collect();
            let message = format!("{} has no layer of counts or numbers called `{name}`", answer.technique);
            let error = Diagnostic::error(codes::RENDER, message).help(format!("it has {}", technique::and(&with)));
            Err(Failure::bare("", error))
        }
    }
}

/// A contact sheet. Where the true picture is on it, the others have their error beside the name.
fn contact(frame: &Frame<'_>, answers: &[Answer<'_>]) -> std::result::Result<RgbImage, Failure> {
    let mut entries = Vec::new();
    for answer in answers {
        let mut label = answer.technique.name().to_owned();
        let truth = answers.iter().find(|other| Some(other.technique.name()) == answer.technique.truth());
        let error = truth.map(|truth| error(frame, answer, &truth.rendered)).transpose()?.flatten();
        if let Some(error) = error {
            label += &format!(", RMSE {error:.4}");
        }
        let picture = srgb::encode(&shade::picture(frame, &answer.rendered)?);
        entries.push(Entry { label, picture });
    }
    let techniques: Vec<TechniqueArgument> = answers.iter().map(|answer| answer.technique).collect();
    let title = format!("{}: {}", frame.scene.title, frame.describe(&techniques));
    sheet::contact(&title, &entries)
}

/// The error of an answer against the true one, by a layer that both have.
fn error(frame: &Frame<'_>, answer: &Answer<'_>, truth: &Rendered) -> std::result::Result<Option<f64>, Failure> {
    let (surfaces, rendered) = (&frame.surfaces, &answer.rendered);
    if let (Some(truth), Some(value)) = (truth.numbers(VALUE), rendered.numbers(VALUE)) {
        let weights = shade::contribution(&frame.scene.punctual(answer.technique.name())?, surfaces);
        return Ok(Some(difference(surfaces, value, truth, &Region::surfaces(surfaces, &weights)).rmse));
    }
    let light = rendered.colours(LIGHT).zip(truth.colours(LIGHT));
    Ok(light.map(|(light, truth)| of_light(surfaces, light, truth)))
}

/// A finished picture.
enum Canvas {
    Linear(Rgb32FImage),
    Encoded(RgbImage),
}

impl Canvas {
    fn bytes(self, format: ImageFormat) -> std::result::Result<Vec<u8>, Failure> {
        let mut bytes = Cursor::new(Vec::new());
        let written = match (format, self) {
            (ImageFormat::OpenExr, Canvas::Linear(image)) => image.write_to(&mut bytes, format),
            (ImageFormat::OpenExr, Canvas::Encoded(image)) => srgb::decode(&image).write_to(&mut bytes, format),
            (_, Canvas::Linear(image)) => srgb::encode(&image).write_to(&mut bytes, format),
            (_, Canvas::Encoded(image)) => image.write_to(&mut bytes, format),
        };
        written.map_err(|error| {
            let error = Diagnostic::error(codes::RENDER, format!("the picture cannot be encoded: {error}"));
            Failure::bare("", error.help("choose another kind of file, or a smaller picture"))
        })?;
        Ok(bytes.into_inner())
    }
}

/// Prints how often each case was taken.
fn stats(report: &Report, frame: &Frame<'_>, answer: &Answer<'_>) -> Result<()> {
    let (scene, technique) = (&frame.scene.name, answer.technique);
    let taken = answer.rendered.counts(CASE).unwrap_or_default();
    let counts = answer.table.map_or(Vec::new(), |table| cases::counts(table, taken));
    let pixels = frame.surfaces.points.len();
    let asked = taken.iter().filter(|case| **case != NONE).count();
    let mut out = stdout();
    if report.format == Format::Json {
        let cases: Vec<_> = counts
            .iter()
            .map(|count| {
                let case = count.id.map_or(json!("default"), |id| json!(id));
                json!({ "case": case, "pixels": count.pixels, "doc": count.doc })
            })
            .collect();
        let object = json!({
            "scene": scene, "technique": technique.name(), "executor": frame.on.describe(),
            "pixels": pixels, "evaluated": asked, "cases": cases,
        });
        writeln!(out, "{object}")?;
        return Ok(());
    }
    writeln!(out, "{scene}, {technique}: {asked} of {pixels} pixels asked a table")?;
    if !counts.is_empty() {
        let mut table = comfy_table::Table::new();
        table.load_preset(comfy_table::presets::NOTHING).set_header(["case", "pixels", "of those", "what it is"]);
        for count in &counts {
            let case = count.id.map_or("default".to_owned(), |id| id.to_string());
            let share = format!("{:.1} %", 100.0 * count.pixels as f64 / asked as f64);
            let doc = count.doc.unwrap_or_default().to_owned();
            table.add_row([case, count.pixels.to_string(), share, doc]);
        }
        for column in 0..3 {
            if let Some(column) = table.column_mut(column) {
                column.set_cell_alignment(comfy_table::CellAlignment::Right);
            }
        }
        writeln!(out, "{}", table.trim_fmt())?;
    }
    Ok(())
}
