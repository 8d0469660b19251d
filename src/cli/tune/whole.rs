//! `umbrage tune --whole`: the plans in the technique that the table is for.

use std::io::Write;

use serde_json::json;

use super::Arguments;
use crate::cli::Result;
use crate::diag::Failure;
use crate::gpu::timing::Stopwatch;
use crate::program::Program;
use crate::scene::Scene;
use crate::technique::prepared::Watch;
use crate::technique::{Executor, Frame, Settings, revectorise::SHADOW_MAP, setting::Value};
use crate::tune::Tuning;
use crate::tune::whole::{Whole, technique, whole};

/// The scenes that are measured.
///
/// # Errors
/// When a scene is wrong, or no technique evaluates the table.
pub(super) fn scenes(arguments: &Arguments, program: &Program) -> std::result::Result<Vec<Scene>, Failure> {
    let technique = technique(program)?;
    let open = |name: &String| {
        let scene = Scene::open(name)?;
        technique.lights().of_scene(&scene, technique.name())?;
        Ok(scene)
    };
    arguments.scene.iter().map(open).collect()
}

/// Measures the technique that the table is for, on every scene.
pub(super) fn measure(
    arguments: &Arguments,
    program: &Program,
    scenes: &[Scene],
    executor: &Executor,
    tuning: &Tuning<'_>,
) -> std::result::Result<Vec<Whole>, Failure> {
    let Executor::Gpu(gpu) = executor else { return Ok(Vec::new()) };
    let technique = technique(program)?;
    let size = arguments.size.unwrap_or(if gpu.is_software() { (480, 270) } else { (1920, 1080) });
    let settings = Settings::default().with(&SHADOW_MAP, Value::Whole(arguments.shadow_map));
    let watch = Watch::Device(if arguments.wall_clock { Stopwatch::wall(gpu) } else { Stopwatch::new(gpu) });
    let frame = |scene| {
        let frame = Frame::new(scene, size, executor).with(settings.clone());
        (format!("{}, {}", scene.name, frame.describe(&[technique])), frame)
    };
    let frames: Vec<_> = scenes.iter().map(frame).collect();
    whole(technique, &frames, &tuning.plans, &watch, tuning.options.protocol)
}

pub(super) fn human(out: &mut impl Write, tuning: &Tuning<'_>) -> Result<()> {
    let name = |plan: usize| tuning.plans[plan].candidate.name();
    for whole in &tuning.whole {
        writeln!(out, "\nthe whole pass on {}, {} shader", whole.frame, whole.pass)?;
        writeln!(out, "  plan                       ms      +-   to ladder")?;
        let mut order: Vec<usize> = (0..whole.times.len()).collect();
        order.sort_by(|a, b| whole.times[*a].median().total_cmp(&whole.times[*b].median()));
        for plan in order {
            let times = &whole.times[plan];
            let (ms, uncertainty) = (1e3 * times.median(), 1e3 * times.uncertainty());
            let noise = if plan != 0 && !whole.differs(plan, 0) { "   within noise of the ladder" } else { "" };
            writeln!(out, "  {:<20} {ms:>9.3} {uncertainty:>7.3} {:>11.3}{noise}", name(plan), whole.vs_ladder(plan))?;
        }
        let faster: Vec<String> = whole.faster_than(tuning.chosen).into_iter().map(name).collect();
        let chosen = name(tuning.chosen);
        if faster.is_empty() {
            writeln!(out, "  no plan is faster than the chosen one, {chosen}, by more than noise")?;
        } else {
            writeln!(out, "  faster than the chosen {chosen}: {}", faster.join(", "))?;
        }
    }
    Ok(())
}

pub(super) fn object(tuning: &Tuning<'_>) -> serde_json::Value {
    let lines = tuning.whole.iter().flat_map(|whole| {
        let faster = whole.faster_than(tuning.chosen);
        (0..whole.times.len()).map(move |plan| {
            json!({
                "frame": whole.frame,
                "pass": whole.pass,
                "name": tuning.plans[plan].candidate.name(),
                "ms": 1e3 * whole.times[plan].median(),
                "uncertainty_ms": 1e3 * whole.times[plan].uncertainty(),
                "vs_ladder": whole.vs_ladder(plan),
                "differs": whole.differs(plan, 0),
                "faster_than_chosen": faster.contains(&plan),
            })
        })
    });
    lines.collect()
}
