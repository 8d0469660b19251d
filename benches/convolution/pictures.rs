//! Pictures against the same slabs under many sharp lights.

use std::time::Instant;

use umbrage::diag::Failure;
use umbrage::picture::plot::Scale;
use umbrage::scene::Scene;
use umbrage::technique::convolve::{CONVOLVE, REFERENCE};
use umbrage::technique::difference::{Region, difference, of_light};
use umbrage::technique::rendered::LIGHT;
use umbrage::technique::{self, Executor, Frame, Technique};

use crate::{Plots, series};

const SIZE: (u32, u32) = (96, 96);
/// Sharp lights that stand for each light: behind an edge they are at most 0.0076 wrong.
const SHARP: &str = "sharp_lights=1024";

/// A scene with its true light.
struct Subject {
    scene: Scene,
    truth: Vec<[f32; 3]>,
    slabs: String,
}

/// Distances from the truth: root mean square relative to all light, largest of a channel, structural dissimilarity.
struct Errors {
    rms: f64,
    most: f64,
    dissimilarity: f64,
    seconds: f64,
}

impl Subject {
    fn new(name: &str, slabs: u32, more: &str) -> Result<Self, Failure> {
        let scene = Scene::open(name)?;
        let slabs = format!("slabs={slabs} {more}");
        let truth = light(&scene, &REFERENCE, &format!("{slabs} {SHARP}"))?.0;
        Ok(Self { scene, truth, slabs })
    }

    fn errors(&self, settings: &str) -> Result<Errors, Failure> {
        let (found, seconds) = light(&self.scene, &CONVOLVE, &format!("{} {settings}", self.slabs))?;
        let frame = Frame::new(&self.scene, SIZE, &Executor::Cpu);
        let pairs = found.iter().flatten().zip(self.truth.iter().flatten());
        let most = pairs.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        let grey = |light: &[[f32; 3]]| -> Vec<f32> {
            light.iter().map(|[r, g, b]| (0.2126 * r + 0.7152 * g + 0.0722 * b).min(1.0)).collect()
        };
        let region = Region::surfaces(&frame.surfaces, &vec![1.0; found.len()]);
        Ok(Errors {
            rms: of_light(&frame.surfaces, &found, &self.truth),
            most,
            dissimilarity: difference(&frame.surfaces, &grey(&found), &grey(&self.truth), &region).dissimilarity,
            seconds,
        })
    }
}

/// The light of a picture, and the seconds that it took on the CPU.
fn light(scene: &Scene, technique: &dyn Technique, settings: &str) -> Result<(Vec<[f32; 3]>, f64), Failure> {
    let settings = technique::read_settings(&[technique], settings.split_whitespace())?;
    let frame = Frame::new(scene, SIZE, &Executor::Cpu).with(settings);
    let mut prepared = frame.prepare(technique)?;
    let start = Instant::now();
    let rendered = prepared.render(&|_| {})?;
    let seconds = start.elapsed().as_secs_f64();
    Ok((rendered.colours(LIGHT).unwrap_or_default().to_vec(), seconds))
}

fn head(first: &str) {
    println!("{}x{}, single precision, {SHARP}; times on the CPU, relative to the first row.\n", SIZE.0, SIZE.1);
    println!("| scene | {first} | RMS | largest | structural dissimilarity | time |\n|---|---|---|---|---|---|");
}

fn row(scene: &str, name: &str, errors: &Errors, unit: f64) {
    let Errors { rms, most, dissimilarity, seconds } = errors;
    println!("| {scene} | {name} | {rms:.4} | {most:.3} | {dissimilarity:.4} | {:.2} |", seconds / unit);
}

/// Kernels on the published scenes, with a light that is narrow and one that is wide.
pub(crate) fn kernels(plots: &Plots) -> Result<(), Failure> {
    head("kernel");
    let mut lines = Vec::new();
    for scene in ["poles", "disk"] {
        let subject = Subject::new(scene, 64, "rule=winding")?;
        let mut unit = None;
        let mut points = Vec::new();
        for (samples, name, settings) in [
            (2.0, "ring_arc 2", "kernel=ring_arc samples=2"),
            (2.0, "ring_affine 2", "samples=2"),
            (3.0, "ring_arc 3", "kernel=ring_arc samples=3"),
            (3.0, "ring_affine 3", "samples=3"),
            (4.0, "ring_affine 4", "samples=4"),
            (8.0, "poisson8", "kernel=poisson8"),
            (16.0, "poisson16", "kernel=poisson16"),
            (361.0, "gauss19x19", "kernel=gauss19x19"),
        ] {
            let errors = subject.errors(settings)?;
            row(scene, name, &errors, *unit.get_or_insert(errors.seconds));
            points.push((samples, errors.rms));
        }
        lines.push(series(scene, points));
    }
    let axes = [("samples", Scale::Log2), ("RMS", Scale::Linear)];
    plots.lines("convolution-kernels", "Kernels against sharp lights", axes, &lines);
    Ok(())
}

/// The shares of covariance that parts keep, for the numbers of parts.
const SPLITS: [(u32, f64); 6] = [(1, 1.0), (4, 0.42), (7, 0.2), (16, 0.15), (32, 0.085), (64, 0.036)];

/// Lights in parts: error against cost.
pub(crate) fn split(plots: &Plots) -> Result<(), Failure> {
    head("parts, rho");
    let mut lines = Vec::new();
    for scene in ["poles", "disk", "tilt", "boxes"] {
        let subject = Subject::new(scene, 64, "rule=winding")?;
        let mut unit = None;
        let mut points = Vec::new();
        for (parts, rho) in SPLITS {
            let errors = subject.errors(&format!("split={parts} rho={rho}"))?;
            row(scene, &format!("{parts}, {rho}"), &errors, *unit.get_or_insert(errors.seconds));
            points.push((f64::from(parts), errors.rms));
        }
        lines.push(series(scene, points));
    }
    let axes = [("parts of each light", Scale::Log2), ("RMS", Scale::Linear)];
    plots.lines("convolution-split", "Lights in parts against sharp lights", axes, &lines);
    Ok(())
}

/// Light on slopes: as iterating leaves it, put right by the slope, in parts, and both.
pub(crate) fn slopes(_: &Plots) -> Result<(), Failure> {
    head("slopes");
    for scene in ["boxes", "tilt"] {
        let subject = Subject::new(scene, 64, "rule=winding")?;
        let mut unit = None;
        for (name, settings) in [
            ("iterated", ""),
            ("compensated", "slopes=compensate"),
            ("16 parts", "split=16 rho=0.15"),
            ("16 parts, compensated", "split=16 rho=0.15 slopes=compensate"),
        ] {
            let errors = subject.errors(settings)?;
            row(scene, name, &errors, *unit.get_or_insert(errors.seconds));
        }
    }
    Ok(())
}

/// Numbers of slabs with whole slabs of matter at surfaces, and with as much as there is.
pub(crate) fn slabs(plots: &Plots) -> Result<(), Failure> {
    head("slabs, coverage");
    let counts = [25, 50, 100, 200, 400];
    let mut lines = Vec::new();
    for scene in ["disk", "boxes"] {
        let mut unit = None;
        for coverage in ["full", "exact"] {
            let mut points = Vec::new();
            for count in counts {
                let subject = Subject::new(scene, count, &format!("rule=winding coverage={coverage}"))?;
                let errors = subject.errors("")?;
                row(scene, &format!("{count}, {coverage}"), &errors, *unit.get_or_insert(errors.seconds));
                points.push((f64::from(count), errors.rms));
            }
            lines.push(series(&format!("{scene}, {coverage}"), points));
        }
    }
    let axes = [("slabs", Scale::Log2), ("RMS", Scale::Linear)];
    plots.lines("convolution-slabs", "Slabs against sharp lights in the same slabs", axes, &lines);
    Ok(())
}
