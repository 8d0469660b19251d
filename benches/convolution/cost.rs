//! Times of passes on the adapter, and memory.

use std::sync::Arc;

use umbrage::diag::Failure;
use umbrage::gpu::timing::{Protocol, interleaved};
use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::picture::plot::Scale;
use umbrage::scene::Scene;
use umbrage::technique::convolve::{CONVOLVE, CROSSINGS};
use umbrage::technique::prepared::{Detail, Watch};
use umbrage::technique::{self, Executor, Frame};

use crate::{Plots, series};

const PROTOCOL: Protocol = Protocol { warm_up: 1, rounds: 5 };

/// A picture whose passes are measured.
struct Subject<'n> {
    name: &'n str,
    size: (u32, u32),
    settings: String,
}

/// Medians in milliseconds: of making layers, and of the sweep.
fn times(scene: &Scene, on: &Executor, subjects: &[Subject<'_>]) -> Result<Vec<[f64; 2]>, Failure> {
    let mut prepared = Vec::new();
    for subject in subjects {
        let settings = technique::read_settings(&[&CONVOLVE], subject.settings.split_whitespace())?;
        prepared.push(Frame::new(scene, subject.size, on).with(settings).prepare(&CONVOLVE)?);
    }
    let mut passes = Vec::new();
    for prepared in &mut prepared {
        passes.extend(prepared.passes(Detail::Plain)?);
    }
    let watch = Watch::new(on);
    let times = interleaved(PROTOCOL, passes.len(), |index| passes[index].time(&watch))?;
    let medians: Vec<f64> = times.iter().map(|times| 1e3 * times.median()).collect();
    Ok(medians.chunks(2).map(|pair| [pair[0], pair[1]]).collect())
}

fn adapter() -> Result<Executor, Failure> {
    let gpu = Gpu::open(&AdapterChoice::Any)?;
    println!("{}; medians of {} rounds in milliseconds.\n", gpu.describe(), PROTOCOL.rounds);
    Ok(Executor::Gpu(Arc::new(gpu)))
}

/// Samples of a kernel, beside the paper's times.
pub(crate) fn samples(plots: &Plots) -> Result<(), Failure> {
    let on = adapter()?;
    let scene = Scene::open("poles")?;
    // At a pixel a step samples fall on pixels of their own; with a hundred slabs of the poles' depth this is so.
    let kernels = [
        ("2", "kernel=ring_arc samples=2", 44.3),
        ("3", "kernel=ring_arc samples=3", 49.2),
        ("8", "kernel=poisson8", 84.5),
        ("16", "kernel=poisson16", 149.0),
        ("361", "kernel=gauss19x19", 2083.0),
    ];
    let subject = |(name, settings, _): &(&'static str, &str, f64)| Subject {
        name,
        size: (128, 128),
        settings: format!("slabs=64 skip=0 distance=8 rule=winding {settings}"),
    };
    let subjects: Vec<Subject<'_>> = kernels.iter().map(subject).collect();
    let times = times(&scene, &on, &subjects)?;
    println!(
        "| samples | layers | sweep | relative | the paper's, 768x768, GTX 480 | relative |\n|---|---|---|---|---|---|"
    );
    let mut points = Vec::new();
    for ([layers, sweep], (name, _, paper)) in times.iter().zip(&kernels) {
        let [relative, of_paper] = [sweep / times[0][1], paper / kernels[0].2];
        println!("| {name} | {layers:.2} | {sweep:.1} | {relative:.2} | {paper} | {of_paper:.2} |");
        points.push((name.parse().unwrap_or(f64::NAN), relative));
    }
    let paper = kernels.iter().map(|(name, _, paper)| (name.parse().unwrap_or(f64::NAN), paper / kernels[0].2));
    let lines = [series("here", points), series("paper", paper.collect())];
    let axes = [("samples", Scale::Log2), ("time over that of 2", Scale::Log10)];
    plots.lines("convolution-samples", "Time and samples", axes, &lines);
    Ok(())
}

/// Slabs, lights and sizes.
pub(crate) fn cost(plots: &Plots) -> Result<(), Failure> {
    let on = adapter()?;
    let scene = Scene::open("poles")?;
    let subject = |name: &'static str, size: u32, slabs: u32, parts: u32| Subject {
        name,
        size: (size, size),
        settings: format!("slabs={slabs} skip=0 rule=winding split={parts} rho=0.3"),
    };
    let subjects = [
        subject("slabs", 96, 25, 1),
        subject("slabs", 96, 50, 1),
        subject("slabs", 96, 100, 1),
        subject("slabs", 96, 200, 1),
        subject("slabs", 96, 400, 1),
        subject("lights", 96, 50, 3),
        subject("lights", 96, 50, 6),
        subject("lights", 96, 50, 12),
        subject("size", 48, 50, 1),
        subject("size", 192, 50, 1),
        subject("size", 384, 50, 1),
    ];
    let times = times(&scene, &on, &subjects)?;
    println!(
        "| what grows | size | settings | layers | sweep | a pixel and slab, in nanoseconds |\n|---|---|---|---|---|---|"
    );
    let mut points = Vec::new();
    for (Subject { name, size, settings }, [layers, sweep]) in subjects.iter().zip(&times) {
        let slabs: f64 = settings.split(['=', ' ']).nth(1).and_then(|count| count.parse().ok()).unwrap_or(f64::NAN);
        let each = 1e6 * sweep / (slabs * f64::from(size.0) * f64::from(size.1));
        println!("| {name} | {}x{} | `{settings}` | {layers:.2} | {sweep:.2} | {each:.0} |", size.0, size.1);
        if *name == "slabs" {
            points.push((slabs, *sweep));
        }
    }
    let axes = [("slabs", Scale::Log2), ("milliseconds", Scale::Log10)];
    plots.lines("convolution-cost", "Time and slabs, 96x96", axes, &[series("one light, three samples", points)]);
    Ok(())
}

/// Memory on the device, by its parts.
pub(crate) fn memory(_: &Plots) -> Result<(), Failure> {
    println!("Bytes on a device: a pixel of layers 12, of the sweep 32 and 32 for each light, a surface 16.\n");
    println!("| scene | size | surfaces | a pixel | MiB, one light |\n|---|---|---|---|---|");
    for name in ["disk", "poles", "tilt", "boxes"] {
        let scene = Scene::open(name)?;
        let size = (256, 256);
        let settings = technique::read_settings(&[&CONVOLVE], ["slabs=1"])?;
        let rendered = Frame::new(&scene, size, &Executor::Cpu).with(settings).prepare(&CONVOLVE)?.render(&|_| {})?;
        let surfaces: u64 = rendered.counts(CROSSINGS).unwrap_or_default().iter().map(|count| u64::from(*count)).sum();
        let pixels = u64::from(size.0) * u64::from(size.1);
        let bytes = pixels * (12 + 32 + 32) + 16 * surfaces;
        let each = surfaces as f64 / pixels as f64;
        println!("| {name} | 256x256 | {surfaces} | {each:.2} | {:.1} |", bytes as f64 / f64::from(1 << 20));
    }
    Ok(())
}
