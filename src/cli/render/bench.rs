//! `umbrage bench`: what each technique's visibility pass costs on this device.

use std::io::{self, Write};

use comfy_table::{CellAlignment, Table, presets};
use serde_json::json;

use super::frame::{parse_map, parse_size};
use crate::cli::messages::{Format, Report};
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result, parse_shape};
use crate::gpu::timing::{Clock, Protocol};
use crate::gpu::{AdapterChoice, Gpu};
use crate::plan::{Plan, Shape};
use crate::scene::Scene;
use crate::technique::revectorise::gpu::bench;
use crate::technique::revectorise::gpu::bench::Measured;
use crate::technique::revectorise::gpu::{GpuFrame, Raster};
use crate::technique::revectorise::stage::{Bias, Stage};
use crate::technique::revectorise::{Settings, Technique, cpu};

/// Arguments of `umbrage bench`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The scene: a name as `umbrage scenes` lists it, or a file
    #[arg(long, value_name = "SCENE", default_value = "foliage")]
    scene: String,
    /// Sizes of the picture [default: 1920x1080,3840x2160; on a software adapter 960x540]
    #[arg(long, value_name = "WxH", value_delimiter = ',', value_parser = parse_size)]
    size: Vec<(u32, u32)>,
    /// Texels per side of the shadow map
    #[arg(long, value_name = "TEXELS", value_delimiter = ',', value_parser = parse_map, default_value = "1024,4096")]
    shadow_map: Vec<u32>,
    /// The adapter: any, software, hardware, or a part of its name
    #[arg(long, value_name = "WHICH", default_value = "any")]
    adapter: AdapterChoice,
    /// The code shape of the tables
    #[arg(long, value_name = "PLAN", default_value = "ladder", value_parser = parse_shape)]
    plan: Shape,
    /// Longest run that is revectorised, in texels
    #[arg(long, value_name = "TEXELS", default_value_t = Settings::default().search_limit,
          value_parser = clap::value_parser!(u32).range(1..=4096))]
    search_limit: u32,
    /// Measurements of each pass
    #[arg(long, value_name = "COUNT", default_value_t = 15,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=10_000))]
    rounds: usize,
    /// Measurements before those that count
    #[arg(long, value_name = "COUNT", default_value_t = 3,
          value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(0..=10_000))]
    warm_up: usize,
}

/// Measures every size of picture with every size of map.
pub(in crate::cli) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let scene = Scene::open(&arguments.scene)?;
    let gpu = Gpu::open(&arguments.adapter)?;
    let sizes = match arguments.size.as_slice() {
        [] if gpu.is_software() => &[(960, 540)],
        [] => [(1920, 1080), (3840, 2160)].as_slice(),
        sizes => sizes,
    };
    let programs = [cpu::table(Technique::Smsr)?, cpu::table(Technique::Rsmss)?];
    let [Some(smsr), Some(rsmss)] = &programs else { return Ok(Outcome::Failed) };
    let proved = [Plan::proved(smsr, arguments.plan)?, Plan::proved(rsmss, arguments.plan)?];
    let subjects = bench::subjects(&proved[0], &proved[1]);
    let settings = Settings { search_limit: arguments.search_limit, ..Settings::default() };
    let protocol = Protocol { warm_up: arguments.warm_up, rounds: arguments.rounds };
    let stage = Stage::new(&scene)?;
    let raster = Raster::new(&gpu, &stage)?;
    let mut out = io::stdout().lock();
    for &size in &arguments.shadow_map {
        let map = raster.shadow_map(size, Bias::default())?;
        for &(width, height) in sizes {
            let frame = GpuFrame::new(&gpu, &map, &raster.picture(width, height, size)?.receivers)?;
            let progress = Progress::new(((protocol.warm_up + protocol.rounds) * 2 * subjects.len()) as u64);
            progress.begin(&format!("{width}x{height}, map {size}"));
            let (clock, measured) =
                bench::measure(&gpu, &subjects, &frame, &settings, protocol, || progress.advance(1))?;
            drop(progress);
            let frame = Frame { scene: &scene.name, width, height, size };
            match report.format {
                Format::Human => human(&mut out, &gpu, clock, &frame, &measured)?,
                Format::Json => writeln!(out, "{}", json(&gpu, clock, &frame, &measured))?,
            }
            out.flush()?;
        }
    }
    Ok(Outcome::Clean)
}

/// What was measured on.
struct Frame<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    size: u32,
}

/// The time of a subject relative to the plain depth test in the same kind of pass.
fn vs_hard(measured: &[Measured], one: &Measured) -> f64 {
    let hard = measured.iter().find(|other| other.name == "hard" && other.output == one.output);
    one.times.median() / hard.map_or(f64::NAN, |hard| hard.times.median())
}

fn human(out: &mut impl Write, gpu: &Gpu, clock: Clock, frame: &Frame<'_>, measured: &[Measured]) -> Result<()> {
    let Frame { scene, width, height, size } = frame;
    writeln!(out, "{scene}, {width}x{height}, shadow map {size}; {}; {clock}", gpu.describe())?;
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    let columns = ["technique", "pass", "ms", "± ms", "vs hard", "reads", "most", "steps", "group steps", "walking"];
    table.set_header(columns);
    for one in measured {
        let costs = &one.costs;
        table.add_row([
            one.name.to_owned(),
            one.output.name().to_owned(),
            format!("{:.3}", one.times.median() * 1e3),
            format!("{:.3}", one.times.uncertainty() * 1e3),
            format!("{:.2}", vs_hard(measured, one)),
            format!("{:.2}", costs.reads),
            costs.most_reads.to_string(),
            format!("{:.3}", costs.steps),
            format!("{:.2}", costs.group_steps),
            format!("{:.1} %", 100.0 * costs.walking),
        ]);
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "{}", table.trim_fmt())?;
    Ok(())
}

fn json(gpu: &Gpu, clock: Clock, frame: &Frame<'_>, measured: &[Measured]) -> serde_json::Value {
    let passes = measured.iter().map(|one| {
        json!({
            "technique": one.name,
            "pass": one.output.name(),
            "ms": one.times.median() * 1e3,
            "uncertainty_ms": one.times.uncertainty() * 1e3,
            "vs_hard": vs_hard(measured, one),
            "reads_per_pixel": one.costs.reads,
            "most_reads": one.costs.most_reads,
            "steps_per_pixel": one.costs.steps,
            "steps_per_group": one.costs.group_steps,
            "walking": one.costs.walking,
        })
    });
    json!({
        "device": gpu.describe(),
        "clock": clock.to_string(),
        "scene": frame.scene,
        "width": frame.width,
        "height": frame.height,
        "shadow_map": frame.size,
        "passes": passes.collect::<Vec<_>>(),
    })
}
