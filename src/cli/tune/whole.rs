//! `umbrage tune --whole`: the plans in the shadow pass that the table is for.

use std::io::Write;

use serde_json::json;

use super::Arguments;
use crate::cli::Result;
use crate::diag::Failure;
use crate::gpu::Gpu;
use crate::gpu::timing::Stopwatch;
use crate::program::Program;
use crate::scene::Scene;
use crate::technique::revectorise::gpu::{GpuFrame, Raster};
use crate::technique::revectorise::stage::{Bias, Stage};
use crate::tune::Tuning;
use crate::tune::whole::{Frame, Whole, technique, whole};

/// Says what cannot be measured.
pub(super) fn check(arguments: &Arguments, program: &Program) -> std::result::Result<(), Failure> {
    technique(program)?;
    arguments.scene.iter().try_for_each(|scene| Scene::open(scene).map(drop))
}

/// Measures the pass on every scene.
pub(super) fn measure(
    arguments: &Arguments,
    program: &Program,
    gpu: &Gpu,
    tuning: &Tuning<'_>,
) -> std::result::Result<Vec<Whole>, Failure> {
    let (width, height) = arguments.size.unwrap_or(if gpu.is_software() { (480, 270) } else { (1920, 1080) });
    let size = arguments.shadow_map;
    let mut frames = Vec::new();
    for name in &arguments.scene {
        let scene = Scene::open(name)?;
        let stage = Stage::new(&scene)?;
        let raster = Raster::new(gpu, &stage)?;
        let map = raster.shadow_map(size, Bias::default())?;
        let frame = GpuFrame::new(gpu, &map, &raster.picture(width, height, size)?.receivers)?;
        frames.push(Frame { name: format!("{}, {width}x{height}, map {size}", scene.name), frame });
    }
    let watch = if arguments.wall_clock { Stopwatch::wall(gpu) } else { Stopwatch::new(gpu) };
    whole(gpu, program, &tuning.plans, &frames, &watch, tuning.options.protocol)
}

pub(super) fn human(out: &mut impl Write, tuning: &Tuning<'_>) -> Result<()> {
    let name = |plan: usize| tuning.plans[plan].candidate.name();
    for whole in &tuning.whole {
        writeln!(out, "\nthe whole pass on {}, {} shader", whole.frame, whole.pass.name())?;
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
        match faster.is_empty() {
            true => {
                writeln!(out, "  no plan is faster than the chosen one, {}, by more than noise", name(tuning.chosen))?
            }
            false => writeln!(out, "  faster than the chosen {}: {}", name(tuning.chosen), faster.join(", "))?,
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
                "pass": whole.pass.name(),
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
