//! `umbrage render`: a scene and a technique in, a picture out.

#[cfg(feature = "gpu")]
pub(crate) mod bench;
pub(crate) mod frame;
pub(crate) mod light;
pub(crate) mod quality;

use std::io::{self, Cursor, Write as _};
use std::path::{Path, PathBuf};

use image::{ImageFormat, Rgb32FImage, RgbImage};
use serde_json::json;

use super::input::has_extension;
use super::messages::{Format, Report};
use super::output::Sink;
use super::progress::Progress;
use super::{Outcome, Result};
use crate::capture;
use crate::cli::render::frame::{FrameArguments, parse_map, parse_size, parse_technique};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture::compare;
use crate::picture::compare::Region;
use crate::picture::sheet;
use crate::picture::sheet::{CaseCount, Entry};
use crate::picture::srgb;
use crate::program::Program;
use crate::scene::Scene;
use crate::scene::surfaces::Surfaces;
use crate::technique::executor::Executor;
use crate::technique::revectorise::reference;
use crate::technique::revectorise::reference::Samples;
use crate::technique::revectorise::stage::Stage;
use crate::technique::revectorise::{Receivers, ShadowMap, Technique, Visibility, cpu};
use crate::technique::shade;
use crate::text::file::shown;

/// Arguments of `umbrage render`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The scene: a name (see `umbrage scenes`) or a scene file
    #[arg(long, value_name = "SCENE")]
    scene: String,
    /// How shadows are made: hard, pcf, smsr, rsmss, rpcf, casefree, reference
    #[arg(long, default_value = "rsmss", value_name = "TECHNIQUE", value_parser = parse_technique)]
    technique: Technique,
    /// Size of the picture, of each picture with --compare
    #[arg(long, default_value = "960x540", value_name = "WIDTHxHEIGHT", value_parser = parse_size)]
    size: (u32, u32),
    /// Texels per side of the shadow map
    #[arg(long, default_value = "1024", value_name = "TEXELS", value_parser = parse_map)]
    shadow_map: u32,
    /// Where the picture goes: *.png, or *.exr with linear values
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Colour each pixel by the case that was taken, and add a legend
    #[arg(long, conflicts_with = "compare")]
    cases: bool,
    /// Instead of one picture a contact sheet of several techniques, with enlarged parts
    #[arg(long, value_name = "TECHNIQUES", value_delimiter = ',', value_parser = parse_technique, conflicts_with = "technique")]
    compare: Vec<Technique>,
    /// Say how many pixels took each case
    #[arg(long)]
    stats: bool,
    /// Write the table's inputs in every pixel that asks it: binary, or *.csv
    #[arg(long, value_name = "FILE", conflicts_with = "compare")]
    capture: Option<PathBuf>,
    #[command(flatten)]
    frame: FrameArguments,
}

/// A technique's answer for a frame.
struct Answer {
    technique: Technique,
    visibility: Visibility,
}

/// Renders, then writes whatever was asked for.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let techniques = match arguments.compare.is_empty() {
        true => vec![arguments.technique],
        false => arguments.compare.clone(),
    };
    check(arguments)?;
    let program = cpu::table(arguments.technique)?;
    let scene = Scene::open(&arguments.scene)?;
    // Places that cannot be written are found before the work is done.
    let picture_sink = arguments.output.as_deref().map(Sink::create).transpose()?;
    let capture_sink = arguments.capture.as_deref().map(Sink::create).transpose()?;
    let needs_device = techniques.iter().any(|technique| *technique != Technique::Reference);
    let executor = if needs_device { arguments.frame.executor(report)? } else { Executor::Cpu };

    let (width, height) = arguments.size;
    let progress = Progress::new(u64::from(height) * (techniques.len() as u64 + 4));
    progress.begin("camera");
    let stage = Stage::new(&scene)?;
    let picture = stage.surfaces(width, height);
    progress.advance(u64::from(height));
    progress.begin("shadow map");
    let map_size = if needs_device { arguments.shadow_map } else { 1 };
    let map = executor.shadow_map(&stage, map_size, arguments.frame.bias())?;
    let receivers = stage.receivers(&picture, map_size);
    progress.advance(u64::from(height));
    let mut answers = Vec::new();
    for technique in techniques {
        progress.begin(technique.name());
        let frame = Frame { stage: &stage, picture: &picture, map: &map, receivers: &receivers };
        let visibility = frame.visibility(&executor, technique, &arguments.frame, &|rows| progress.advance(rows))?;
        answers.push(Answer { technique, visibility });
    }
    drop(progress);

    if let Some(mut sink) = picture_sink {
        let bytes = draw(arguments, &stage, &picture, program.as_ref(), &answers)?;
        sink.write_all(&bytes).map_err(|error| sink.failure(&error))?;
        sink.finish()?;
    }
    if let (Some(mut sink), Some(program)) = (capture_sink, &program) {
        let settings = arguments.frame.settings();
        let frame = cpu::Frame { map: &map, receivers: &receivers, settings: &settings };
        let columns = cpu::evaluations(program, frame)?.columns;
        let written = match arguments.capture.as_deref().is_some_and(|path| has_extension(path, "csv")) {
            true => capture::write_csv(program, &columns, &mut sink),
            false => capture::write(program, &columns, &mut sink),
        };
        written.map_err(|error| sink.failure(&error))?;
        sink.finish()?;
    }
    if arguments.stats {
        for answer in &answers {
            stats(report, &scene, &executor, answer)?;
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
    let has_table = arguments.technique.table().is_some();
    for (asked, option) in [(arguments.cases, "--cases"), (arguments.capture.is_some(), "--capture")] {
        if asked && !has_table {
            let message = format!("`{option}` needs a technique with a table, and {} has none", arguments.technique);
            return error(message, "the techniques with a table are smsr, rsmss and rpcf");
        }
    }
    Ok(())
}

fn format_of(path: &Path) -> Option<ImageFormat> {
    match (has_extension(path, "png"), has_extension(path, "exr")) {
        (true, _) => Some(ImageFormat::Png),
        (_, true) => Some(ImageFormat::OpenExr),
        _ => None,
    }
}

/// A frame that techniques answer.
struct Frame<'a> {
    stage: &'a Stage<'a>,
    picture: &'a Surfaces,
    map: &'a ShadowMap,
    receivers: &'a Receivers,
}

impl Frame<'_> {
    fn visibility(
        &self,
        executor: &Executor,
        technique: Technique,
        arguments: &FrameArguments,
        done: &(dyn Fn(u64) + Sync),
    ) -> std::result::Result<Visibility, Failure> {
        if technique != Technique::Reference {
            return executor.visibility(technique, self.map, self.receivers, &arguments.settings(), done);
        }
        let value = reference::visibility(self.stage, self.picture, Samples::default(), done);
        let nothing = Visibility::new(value.len());
        Ok(Visibility { value, ..nothing })
    }
}

/// The picture that was asked for, as the bytes of its file.
fn draw(
    arguments: &Arguments,
    stage: &Stage<'_>,
    picture: &Surfaces,
    program: Option<&Program>,
    answers: &[Answer],
) -> std::result::Result<Vec<u8>, Failure> {
    let shaded = |answer: &Answer| shade::shade(stage, picture, &answer.visibility.value);
    let image = match (answers, program) {
        ([answer], Some(program)) if arguments.cases => {
            Canvas::Encoded(sheet::cases(&srgb::encode(&shaded(answer)), program, &answer.visibility)?)
        }
        ([answer], _) if arguments.compare.is_empty() => Canvas::Linear(shaded(answer)),
        _ => {
            let truth = answers.iter().find(|answer| answer.technique == Technique::Reference);
            let region = Region::surfaces(picture);
            let entry = |answer: &Answer| {
                let value = &answer.visibility.value;
                let mut label = answer.technique.name().to_owned();
                if let Some(truth) = truth.filter(|truth| truth.technique != answer.technique) {
                    let found = compare::difference(picture, value, &truth.visibility.value, &region);
                    label += &format!(", RMSE {:.4}", found.rmse);
                }
                Entry { label, picture: srgb::encode(&shaded(answer)), value: value.clone() }
            };
            let entries: Vec<Entry> = answers.iter().map(entry).collect();
            let (width, height) = arguments.size;
            let title = format!("{}: {width} x {height}, shadow map {}", stage.scene.title, arguments.shadow_map);
            Canvas::Encoded(sheet::contact(&title, &entries)?)
        }
    };
    let format = arguments.output.as_deref().and_then(format_of).unwrap_or(ImageFormat::Png);
    image.bytes(format)
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
fn stats(report: &Report, scene: &Scene, executor: &Executor, answer: &Answer) -> Result<()> {
    let visibility = &answer.visibility;
    let program = cpu::table(answer.technique)?;
    let counts = program.as_ref().map_or(Vec::new(), |program| sheet::case_counts(program, visibility));
    let pixels = visibility.value.len();
    let asked: usize = counts.iter().map(|count| count.pixels).sum();
    let row = |count: &CaseCount| program.as_ref().and_then(|p| p.rows.iter().find(|row| Some(row.id) == count.id));
    let mut out = io::stdout().lock();
    if report.format == Format::Json {
        let cases: Vec<_> = counts
            .iter()
            .map(|count| {
                let case = count.id.map_or(json!("default"), |id| json!(id));
                json!({ "case": case, "pixels": count.pixels, "doc": row(count).map(|row| row.doc.as_str()) })
            })
            .collect();
        let object = json!({
            "scene": scene.name, "technique": answer.technique.name(), "executor": executor.describe(),
            "pixels": pixels, "evaluated": asked, "cases": cases,
        });
        writeln!(out, "{object}")?;
        return Ok(());
    }
    writeln!(out, "{}, {}: {asked} of {pixels} pixels asked a table", scene.name, answer.technique)?;
    if !counts.is_empty() {
        let mut table = comfy_table::Table::new();
        table.load_preset(comfy_table::presets::NOTHING).set_header(["case", "pixels", "of those", "what it is"]);
        for count in &counts {
            let case = count.id.map_or("default".to_owned(), |id| id.to_string());
            let share = format!("{:.1} %", 100.0 * count.pixels as f64 / asked as f64);
            let doc = row(count).map_or("", |row| row.doc.as_str());
            table.add_row([case, count.pixels.to_string(), share, doc.to_owned()]);
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
