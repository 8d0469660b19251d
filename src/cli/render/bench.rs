//! `umbrage bench`: the cost of each technique's passes on this device, or of its stages on the CPU.

use std::io::Write;

use comfy_table::{CellAlignment, Table, presets};
use serde_json::json;

use crate::cli::args::{Backend, Machine, Set, TechniqueArgument, parse_map, parse_size, technique_parser};
use crate::cli::messages::{Format, Report};
use crate::cli::output::stdout;
use crate::cli::progress::Progress;
use crate::cli::{Outcome, Result, parse_shape};
use crate::gpu::timing::{Clock, Protocol, Times, interleaved};
use crate::plan::Shape;
use crate::scene::Scene;
use crate::technique::prepared::{Detail, Pass, Watch};
use crate::technique::setting::Value;
use crate::technique::{self, Ability, Executor, Frame, Prepared, Settings};

/// Arguments of `umbrage bench`.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {
    /// The scene: a name as `umbrage scenes` lists it, or a file
    #[arg(long, value_name = "SCENE", default_value = "foliage")]
    scene: String,
    /// The techniques [default: all with passes that can be measured]; times are relative to the first
    #[arg(long, value_name = "TECHNIQUES", value_delimiter = ',', value_parser = technique_parser(),
          hide_possible_values = true)]
    techniques: Vec<TechniqueArgument>,
    /// Sizes of the picture [default: 1920x1080,3840x2160; on a software adapter 960x540, on the CPU 480x270]
    #[arg(long, value_name = "WxH", value_delimiter = ',', value_parser = parse_size)]
    size: Vec<(u32, u32)>,
    /// Texels per side of the shadow map, of techniques that have one [default: 1024,4096; on the CPU 1024]
    #[arg(long, value_name = "TEXELS", value_delimiter = ',', value_parser = parse_map)]
    shadow_map: Vec<u32>,
    #[command(flatten)]
    machine: Machine,
    /// The code shape of the tables [default: ladder]
    #[arg(long, value_name = "PLAN", value_parser = parse_shape)]
    plan: Option<Shape>,
    /// Longest run that is revectorised, in texels [default: 128]
    #[arg(long, value_name = "TEXELS", value_parser = clap::value_parser!(u32).range(1..=4096))]
    search_limit: Option<u32>,
    #[command(flatten)]
    set: Set,
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
    let techniques = techniques(arguments, &scene)?;
    let settings = settings(arguments, &techniques)?;
    let executor = arguments.machine.executor(Backend::Gpu, report)?;
    let (usual_sizes, usual_maps) = usual(&executor);
    let sizes = if arguments.size.is_empty() { usual_sizes } else { &arguments.size };
    let maps = if arguments.shadow_map.is_empty() { usual_maps } else { &arguments.shadow_map };
    let sized =
        techniques.iter().flat_map(|technique| technique.settings()).find(|setting| setting.name == "shadow_map");
    let maps: Vec<(Option<u32>, Settings)> = match sized {
        Some(setting) => maps.iter().map(|size| (Some(*size), settings.with(setting, Value::Whole(*size)))).collect(),
        None => vec![(None, settings)],
    };
    let protocol = Protocol { warm_up: arguments.warm_up, rounds: arguments.rounds };
    let watch = Watch::new(&executor);
    let frames: Vec<Frame<'_>> = sizes.iter().map(|size| Frame::new(&scene, *size, &executor)).collect();
    let mut prepared: Vec<Box<dyn Prepared<'_> + '_>> = Vec::new();
    let mut out = stdout();
    for (map, settings) in &maps {
        for frame in &frames {
            let frame = frame.with(settings.clone());
            for (index, technique) in techniques.iter().enumerate() {
                match prepared.get_mut(index) {
                    Some(prepared) => prepared.set_frame(&frame)?,
                    None => prepared.push(frame.prepare(*technique)?),
                }
            }
            let mut passes = Vec::new();
            for prepared in &mut prepared {
                passes.extend(prepared.passes(Detail::Variants)?);
            }
            let (width, height) = frame.size();
            let progress = Progress::new(((protocol.warm_up + protocol.rounds) * passes.len()) as u64);
            progress.begin(&format!("{width}x{height}{}", words(*map)));
            let times = interleaved(protocol, passes.len(), |index| {
                progress.advance(1);
                passes[index].time(&watch)
            })?;
            drop(progress);
            let measured: Vec<(Pass<'_>, Times)> = passes.into_iter().zip(times).collect();
            let (on, clock, scene) = (executor.describe(), watch.clock(), &scene.name);
            let subject = Subject { on, clock, scene, width, height, map: *map };
            match report.format {
                Format::Human => human(&mut out, &subject, &measured)?,
                Format::Json => writeln!(out, "{}", json(&subject, &measured))?,
            }
            out.flush()?;
        }
    }
    Ok(Outcome::Clean)
}

/// The sizes of pictures and of shadow maps where none are named.
fn usual(executor: &Executor) -> (&'static [(u32, u32)], &'static [u32]) {
    match executor {
        Executor::Cpu => (&[(480, 270)], &[1024]),
        Executor::Gpu(gpu) if gpu.is_software() => (&[(960, 540)], &[1024, 4096]),
        Executor::Gpu(_) => (&[(1920, 1080), (3840, 2160)], &[1024, 4096]),
    }
}

/// The techniques that are measured: those that were named, or all that can be measured in the scene.
fn techniques(arguments: &Arguments, scene: &Scene) -> Result<Vec<TechniqueArgument>> {
    for technique in &arguments.techniques {
        technique::require(*technique, Ability::Passes, "bench")?;
    }
    if !arguments.techniques.is_empty() {
        return Ok(arguments.techniques.clone());
    }
    let fits = |technique: &TechniqueArgument| {
        technique.abilities().contains(&Ability::Passes) && technique.lights().of_scene(scene, technique.name()).is_ok()
    };
    Ok(technique::ALL.iter().copied().filter(fits).collect())
}

/// The settings for these techniques; an option is left out where none of them has such a setting.
fn settings(arguments: &Arguments, techniques: &[TechniqueArgument]) -> Result<Settings> {
    let mut settings = arguments.set.read(techniques)?;
    let declared = || techniques.iter().flat_map(|technique| technique.settings());
    let limit = arguments.search_limit.map(Value::Whole);
    for (name, value) in [("plan", arguments.plan.map(Value::Plan)), ("search_limit", limit)] {
        if let (Some(setting), Some(value)) = (declared().find(|setting| setting.name == name), value) {
            settings.set(setting, value);
        }
    }
    Ok(settings)
}

/// The frame and the device of a measurement.
struct Subject<'a> {
    on: String,
    clock: Clock,
    scene: &'a str,
    width: u32,
    height: u32,
    map: Option<u32>,
}

/// The size of a shadow map in words, where there is one.
fn words(map: Option<u32>) -> String {
    map.map_or(String::new(), |size| format!(", shadow map {size}"))
}

/// The first subject: the others are compared with it.
fn first(measured: &[(Pass<'_>, Times)]) -> &'static str {
    measured.first().map_or("first", |(pass, _)| pass.variant)
}

/// The time relative to the first subject in the same kind of pass.
fn vs_first(measured: &[(Pass<'_>, Times)], pass: &Pass<'_>, times: &Times) -> f64 {
    let first = measured.iter().find(|(other, _)| other.name == pass.name);
    times.median() / first.map_or(f64::NAN, |(_, first)| first.median())
}

fn human(out: &mut impl Write, subject: &Subject<'_>, measured: &[(Pass<'_>, Times)]) -> Result<()> {
    let Subject { on, clock, scene, width, height, map } = subject;
    writeln!(out, "{scene}, {width}x{height}{}; {on}; {clock}", words(*map))?;
    let mut table = Table::new();
    table.load_preset(presets::NOTHING);
    let vs = format!("vs {}", first(measured));
    let columns = ["technique", "pass", "ms", "± ms", &vs, "reads", "most", "steps", "group steps", "walking"];
    table.set_header(columns);
    for (pass, times) in measured {
        let time = [
            pass.variant.to_owned(),
            pass.name.to_owned(),
            format!("{:.3}", times.median() * 1e3),
            format!("{:.3}", times.uncertainty() * 1e3),
            format!("{:.2}", vs_first(measured, pass, times)),
        ];
        let costs = pass.costs.map_or_else(Default::default, |costs| {
            [
                format!("{:.2}", costs.reads),
                costs.most_reads.to_string(),
                format!("{:.3}", costs.steps),
                format!("{:.2}", costs.group_steps),
                format!("{:.1} %", 100.0 * costs.walking),
            ]
        });
        table.add_row(time.into_iter().chain(costs));
    }
    table.column_iter_mut().skip(2).for_each(|column| column.set_cell_alignment(CellAlignment::Right));
    writeln!(out, "{}", table.trim_fmt())?;
    Ok(())
}

fn json(subject: &Subject<'_>, measured: &[(Pass<'_>, Times)]) -> serde_json::Value {
    let vs = format!("vs_{}", first(measured));
    let passes = measured.iter().map(|(pass, times)| {
        let mut object = json!({
            "technique": pass.variant,
            "pass": pass.name,
            "ms": times.median() * 1e3,
            "uncertainty_ms": times.uncertainty() * 1e3,
            &vs: vs_first(measured, pass, times),
        });
        if let Some(costs) = pass.costs {
            object["reads_per_pixel"] = json!(costs.reads);
            object["most_reads"] = json!(costs.most_reads);
            object["steps_per_pixel"] = json!(costs.steps);
            object["steps_per_group"] = json!(costs.group_steps);
            object["walking"] = json!(costs.walking);
        }
        object
    });
    json!({
        "device": subject.on,
        "clock": subject.clock.to_string(),
        "scene": subject.scene,
        "width": subject.width,
        "height": subject.height,
        "shadow_map": subject.map,
        "passes": passes.collect::<Vec<_>>(),
    })
}
