//! The shadow of a disk after 64 steps against an exact Gaussian blur.

use glam::DVec2;
use umbrage::diag::Failure;
use umbrage::picture::plot::Scale;
use umbrage::scene::Scene;
use umbrage::technique::convolve::dither::Dither;
use umbrage::technique::convolve::kernel::Kernel;
use umbrage::technique::convolve::light::SlopeLight;
use umbrage::technique::convolve::stack::Stack;
use umbrage::technique::convolve::stencil::Border;
use umbrage::technique::convolve::steps::{Phase, Spread, Steps};
use umbrage::technique::convolve::sweep::{Matter, Slabs, Sweep};
use umbrage::technique::convolve::view::{Projection, SlabView};

use crate::{Plots, series};

/// Pixels per row, radius of the disk, steps.
const SIZE: usize = 256;
const RADIUS: f64 = 40.0;
const STEPS: usize = 64;

/// A disk in the first slab.
struct Disk;

fn is_inside(x: usize, y: usize) -> bool {
    let [x, y] = [x, y].map(|at| at as f64 + 0.5 - SIZE as f64 / 2.0);
    x * x + y * y < RADIUS * RADIUS
}

impl Slabs for Disk {
    type Row = ();

    fn row(&self, _: usize) {}

    fn matter(&self, slab: usize, y: usize, (): &mut (), out: &mut [Option<Matter>]) {
        for (x, out) in out.iter_mut().enumerate() {
            let opaque = Matter { alpha: 1.0, through: [0.0; 3], colour: [1.0; 3], surface: None };
            *out = (slab == 0 && is_inside(x, y)).then_some(opaque);
        }
    }
}

/// A kernel with its phases.
struct Way {
    name: &'static str,
    kernel: Kernel,
    phase: Phase,
}

const fn way(name: &'static str, family: &'static str, samples: u32, phase: Phase) -> Way {
    Way { name, kernel: Kernel { family, samples }, phase }
}

const WAYS: [Way; 14] = [
    way("ring_affine 2, steady", "ring_affine", 2, Phase::Steady),
    way("ring_affine 2, random", "ring_affine", 2, Phase::Random),
    way("ring_affine 2, golden", "ring_affine", 2, Phase::Golden),
    way("ring_affine 2, pixel", "ring_affine", 2, Phase::Pixel),
    way("ring_affine 3, random", "ring_affine", 3, Phase::Random),
    way("ring_affine 3, golden", "ring_affine", 3, Phase::Golden),
    way("ring_affine 3, pixel", "ring_affine", 3, Phase::Pixel),
    way("ring_affine 4, golden", "ring_affine", 4, Phase::Golden),
    way("ring_arc 2, golden", "ring_arc", 2, Phase::Golden),
    way("ring_arc 3, golden", "ring_arc", 3, Phase::Golden),
    way("poisson8, golden", "poisson8", 0, Phase::Golden),
    way("poisson16, golden", "poisson16", 0, Phase::Golden),
    way("gauss19x19", "gauss19x19", 0, Phase::Steady),
    way("frac_box", "frac_box", 0, Phase::Steady),
];

/// Those that are plotted: as many as there are colours.
const PLOTTED: [&str; 7] = [
    "ring_affine 2, random",
    "ring_affine 2, golden",
    "ring_affine 3, golden",
    "poisson8, golden",
    "poisson16, golden",
    "gauss19x19",
    "frac_box",
];

const DEVIATIONS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Prints and plots the largest errors.
pub(crate) fn blurs(plots: &Plots) -> Result<(), Failure> {
    println!("Largest error behind a disk of radius {RADIUS} after {STEPS} steps, {SIZE}x{SIZE}, double precision;");
    println!("without | with what interpolation adds taken off the kernel (`smear=none`, `smear=subtract`).\n");
    println!("| kernel, phase | 0.5 pixels a step | 1 | 2 | 4 |\n|---|---|---|---|---|");
    let exact: Vec<Vec<f64>> = DEVIATIONS.iter().map(|deviation| exact(*deviation)).collect();
    let mut lines = Vec::new();
    for way in &WAYS {
        let mut cells = Vec::new();
        let mut points = Vec::new();
        for (deviation, exact) in DEVIATIONS.iter().zip(&exact) {
            let [none, subtract] = ["none", "subtract"].map(|smear| error(way, *deviation, smear, exact));
            let (none, subtract) = (none?, subtract?);
            cells.push(format!("{none:.4} \\| {subtract:.4}"));
            points.push((*deviation, subtract));
        }
        println!("| {} | {} |", way.name, cells.join(" | "));
        if PLOTTED.contains(&way.name) {
            lines.push(series(way.name, points));
        }
    }
    let axes = [("deviation of a step, in pixels", Scale::Log2), ("largest error", Scale::Log10)];
    plots.lines("convolution-blurs", "64 steps against an exact blur", axes, &lines);
    Ok(())
}

fn error(way: &Way, deviation: f64, smear: &'static str, exact: &[f64]) -> Result<f64, Failure> {
    let scene = Scene::open("disk")?;
    let view = SlabView::new(&scene, (SIZE as u32, SIZE as u32), Projection::Orthographic);
    let unit = 1.0 / view.scale_at(0.0);
    let stack = Stack::new(0.0, 0.0, unit, STEPS + 1);
    // With slabs of a pixel, and penumbras right after one, the deviation of the slope is that of a step.
    let lights = [SlopeLight { mean: DVec2::ZERO, deviations: [deviation; 2], angle: 0.0, colour: [1.0; 3] }];
    let Way { kernel, phase, .. } = *way;
    let spread = Spread { kernel, phase, seed: 1, smear: Some(smear), d1: unit, skip: 0 };
    let mut dither = Dither::new((SIZE, SIZE))?;
    let mut sweep = Sweep::<_, f64>::new(&Disk, (SIZE, SIZE), vec![[1.0; 3]], Border::Unoccluded, None);
    for step in Steps::<f64>::new(&lights, &stack, &[true; STEPS + 1], &spread, &view)? {
        let step = step?;
        let phases = if step.is_dithered() { dither.phases(step.slab, spread.seed)? } else { Vec::new() };
        sweep.step(&step, &phases);
    }
    let light = (0..SIZE).flat_map(|y| sweep.light.row(y, 0, 0));
    Ok(light.zip(exact).map(|(light, shadow)| (1.0 - light - shadow).abs()).fold(0.0, f64::max))
}

/// The disk under a Gaussian of all steps together.
fn exact(deviation: f64) -> Vec<f64> {
    let variance = deviation * deviation * STEPS as f64;
    let reach = (6.0 * variance.sqrt()) as i64;
    let weights: Vec<f64> = (-reach..=reach).map(|i| (-0.5 * (i * i) as f64 / variance).exp()).collect();
    let sum: f64 = weights.iter().sum();
    let blurred = |image: &[f64], stride: usize| -> Vec<f64> {
        let value = |pixel: usize| {
            let along = pixel / stride % SIZE;
            let first = along as i64 - reach;
            let tap = |(weight, at): (&f64, i64)| {
                let inside = (0..SIZE as i64).contains(&at);
                if inside { weight * image[pixel - along * stride + at as usize * stride] } else { 0.0 }
            };
            weights.iter().zip(first..).map(tap).sum::<f64>() / sum
        };
        (0..SIZE * SIZE).map(value).collect()
    };
    let disk: Vec<f64> = (0..SIZE * SIZE).map(|at| f64::from(is_inside(at % SIZE, at / SIZE))).collect();
    blurred(&blurred(&disk, 1), SIZE)
}
