//! Area lights by search beside plain sampling: tests of visibility and errors of the visible fraction in the penumbra,
//! and the time of a picture beside that of the exact method.
//!
//! `cargo bench --bench search -- --plot docs/images/search.svg`. The truth about a pixel is 1,600 rays to each light.
//! An error has three measures: its root mean square in one frame, its mean (bias), and the root mean square of its
//! mean over frames with other seeds, which is what remains to be seen as bands.

use std::time::Instant;

use glam::DVec2;
use umbrage::diag::Failure;
use umbrage::picture::plot::{self, Axis, Scale, Series};
use umbrage::points::random::Random;
use umbrage::scene::Scene;
use umbrage::scene::light::{Light, Polygon};
use umbrage::scene::rays::{Rays, SurfacePoint};
use umbrage::scene::surfaces::Surfaces;
use umbrage::technique::area::search::{BOUNDARY_RAYS, FRACTION, TESTS};
use umbrage::technique::setting::{SEED, Value};
use umbrage::technique::{Executor, Frame, Settings, from_name};

const SCENES: [&str; 4] = ["trio", "hexagon", "opening", "skittles"];
const SIZE: (u32, u32) = (160, 90);
/// Frames with other seeds.
const FRAMES: u32 = 24;
/// Rays of a pixel for sampling.
const RAYS: u32 = 28;
/// Frames of which the shortest time counts.
const TIMED: u32 = 5;

/// Numbers of a method in a scene.
struct Row {
    name: String,
    tests: f64,
    rms: f64,
    bias: f64,
    structured: f64,
}

/// A pixel in the penumbra, and the truth about it.
struct Pixel {
    index: usize,
    truth: f64,
}

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().collect();
    // `cargo test` runs benchmarks too, only to see whether they run.
    if !arguments.iter().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let file = arguments.iter().position(|argument| argument == "--plot").and_then(|at| arguments.get(at + 1));
    let mut shown = Vec::new();
    for name in SCENES {
        let scene = Scene::open(name)?;
        let rows = measured(&scene)?;
        println!("\n| {name} | tests | rms | bias | structured |\n|---|---|---|---|---|");
        for Row { name, tests, rms, bias, structured } in &rows {
            println!("| {name} | {tests:.1} | {rms:.4} | {bias:+.4} | {structured:.4} |");
        }
        times(&scene)?;
        if name == SCENES[0] {
            shown = rows;
        }
    }
    if let Some(file) = file {
        std::fs::write(file, picture(&shown)).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
    Ok(())
}

fn lights(scene: &Scene) -> Vec<Polygon> {
    let polygon = |light: &Light| match light {
        Light::Polygon(polygon) => Some(polygon.clone()),
        Light::Directional(_) | Light::Spot(_) | Light::Gaussian(_) => None,
    };
    scene.lights.iter().filter_map(polygon).collect()
}

/// The share of open rays to some places of each light.
fn sampled(rays: &Rays, lights: &[Polygon], point: &SurfacePoint, places: &[DVec2]) -> f64 {
    let tests = rays.tests(None);
    let open = lights.iter().flat_map(|light| places.iter().map(|at| light.place(*at)));
    let open = open.filter(|place| tests.is_open(point.place, *place)).count();
    open as f64 / (places.len() * lights.len()) as f64
}

/// The middles of a grid of strata.
fn grid(columns: u32, rows: u32) -> Vec<DVec2> {
    let middle = |index: u32, count: u32| (f64::from(index) + 0.5) / f64::from(count);
    (0..columns * rows)
        .map(|index| DVec2::new(middle(index % columns, columns), middle(index / columns, rows)))
        .collect()
}

fn measured(scene: &Scene) -> Result<Vec<Row>, Failure> {
    let (rays, lights) = (Rays::exact(scene), lights(scene));
    let surfaces = Surfaces::new(scene, &rays, SIZE.0, SIZE.1);
    let fine = grid(40, 40);
    let truth = surfaces.points.iter().enumerate().filter_map(|(index, point)| {
        let truth = sampled(&rays, &lights, point.as_ref()?, &fine);
        (truth > 0.0 && truth < 1.0).then_some(Pixel { index, truth })
    });
    let penumbra: Vec<Pixel> = truth.collect();
    let at = |pixel: &Pixel| surfaces.points[pixel.index].as_ref().expect("a pixel in the penumbra has a surface");

    let mut rows = Vec::new();
    for (name, points) in [
        ("closest points, as published".to_owned(), 0),
        ("curves of 1 point".to_owned(), 1),
        ("curves of 2 points".to_owned(), 2),
        ("curves of 3 points".to_owned(), 3),
        ("curves of 5 points".to_owned(), 5),
    ] {
        let mut frames = Vec::new();
        let mut tests = 0.0;
        for seed in 0..FRAMES {
            let rendered = search(scene, points, seed)?;
            let (fraction, counts) = rendered;
            tests += penumbra.iter().map(|pixel| f64::from(counts[pixel.index])).sum::<f64>();
            frames.push(penumbra.iter().map(|pixel| f64::from(fraction[pixel.index])).collect());
        }
        rows.push(row(name, tests / (f64::from(FRAMES) * penumbra.len() as f64), &frames, &penumbra));
    }
    let regular = grid(7, 4);
    let frame: Vec<f64> = penumbra.iter().map(|pixel| sampled(&rays, &lights, at(pixel), &regular)).collect();
    let cost = f64::from(RAYS) * lights.len() as f64;
    rows.push(row(format!("{RAYS} rays in a grid"), cost, &[frame], &penumbra));
    let mut random = Random::new(1);
    let frames = (0..FRAMES).map(|_| {
        let mut one = |pixel: &Pixel| {
            let places: Vec<DVec2> = (0..RAYS).map(|_| DVec2::new(random.unit(), random.unit())).collect();
            sampled(&rays, &lights, at(pixel), &places)
        };
        penumbra.iter().map(&mut one).collect()
    });
    let frames: Vec<Vec<f64>> = frames.collect();
    rows.push(row(format!("{RAYS} rays at random"), cost, &frames, &penumbra));
    Ok(rows)
}

/// The visible fraction and the tests of every pixel.
fn search(scene: &Scene, points: u32, seed: u32) -> Result<(Vec<f32>, Vec<u32>), Failure> {
    let technique = from_name("discontinuity")?;
    let mut frame = Frame::new(scene, SIZE, &Executor::Cpu);
    frame.settings = Settings::default().with(&BOUNDARY_RAYS, Value::Whole(points)).with(&SEED, Value::Whole(seed));
    let rendered = frame.prepare(technique)?.render(&|_| {})?;
    let fraction = rendered.numbers(FRACTION).unwrap_or_default().to_vec();
    Ok((fraction, rendered.counts(TESTS).unwrap_or_default().to_vec()))
}

fn row(name: String, tests: f64, frames: &[Vec<f64>], penumbra: &[Pixel]) -> Row {
    let count = penumbra.len() as f64;
    let errors =
        || frames.iter().flat_map(|frame| frame.iter().zip(penumbra).map(|(found, pixel)| found - pixel.truth));
    let all = count * frames.len() as f64;
    let mean = |pixel: usize| frames.iter().map(|frame| frame[pixel]).sum::<f64>() / frames.len() as f64;
    let lasting = penumbra.iter().enumerate().map(|(index, pixel)| (mean(index) - pixel.truth).powi(2));
    Row {
        name,
        tests,
        rms: (errors().map(|error| error * error).sum::<f64>() / all).sqrt(),
        bias: errors().sum::<f64>() / all,
        structured: (lasting.sum::<f64>() / count).sqrt(),
    }
}

/// Prints the time of a picture by search, as a multiple of that of others.
fn times(scene: &Scene) -> Result<(), Failure> {
    let mut shortest = Vec::new();
    for name in ["discontinuity", "peel", "area_samples"] {
        let frame = Frame::new(scene, SIZE, &Executor::Cpu);
        let mut prepared = frame.prepare(from_name(name)?)?;
        let mut best = f64::INFINITY;
        for _ in 0..TIMED {
            let start = Instant::now();
            prepared.render(&|_| {})?;
            best = best.min(start.elapsed().as_secs_f64());
        }
        shortest.push(best);
    }
    let [search, peel, samples] = shortest[..] else { unreachable!("three techniques") };
    println!(
        "\ntime of a picture on the CPU: {:.2} times that of the exact method in `f32`, {:.2} times that of 16 rays",
        search / peel,
        search / samples
    );
    Ok(())
}

/// Error against cost.
fn picture(rows: &[Row]) -> String {
    let axis = |label: &str, scale: Scale| Axis { label: label.to_owned(), scale };
    let frame = plot::Frame {
        title: "Box, ball and cone under a triangle: error of the visible fraction".to_owned(),
        x: axis("tests of visibility per pixel of the penumbra", Scale::Linear),
        y: axis("root mean square", Scale::Log10),
        size: (760, 420),
    };
    let one = |row: &Row| Series { name: row.name.clone(), points: vec![(row.tests, row.rms)] };
    let (curves, others): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.name.starts_with("curves"));
    let curves = Series {
        name: "curves of 1, 2, 3, 5 points".to_owned(),
        points: curves.iter().map(|row| (row.tests, row.rms)).collect(),
    };
    let series: Vec<Series> = std::iter::once(curves).chain(others.into_iter().map(one)).collect();
    plot::lines(&frame, &series)
}
