//! Linearly transformed cosines for GGX: the fit that `tables/ltc_ggx_*.csv` come from.
//!
//! A cosine lobe, transformed by a matrix, stands for the light that a rough surface reflects
//! (Heitz, Dupuy, Hill and Neubelt, Real-Time Polygonal-Light Shading with Linearly Transformed
//! Cosines, SIGGRAPH 2016). For every roughness and direction of view the matrix is found that
//! comes closest to the GGX distribution with the height-correlated masking of Smith: the simplex
//! method of Nelder and Mead minimises the cube of the difference, over directions that are drawn
//! from both.
//!
//! Everything is computed in `f64` and rounded to seven digits, so that the files are the same wherever
//! the standard library computes sines alike.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Columns and rows of the files: roughness from 0 to 1, and the root of one minus the cosine of view.
const SIZE: usize = 64;
/// Directions drawn along each of two dimensions.
const SAMPLES: usize = 32;
/// Smallest width of the distribution.
const SHARPEST: f64 = 1e-5;
/// The most grazing view.
const GRAZING: f64 = 1.57;
/// Smallest scale of a lobe.
const THINNEST: f64 = 1e-7;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A rough surface seen from a direction.
#[derive(Clone, Copy)]
struct Surface {
    /// Width of the distribution of normals: the square of what is called roughness.
    alpha: f64,
    view: Vector,
}

impl Surface {
    fn new(column: usize, row: usize) -> Self {
        let share = |index: usize| index as f64 / (SIZE - 1) as f64;
        let alpha = share(column).powi(2).max(SHARPEST);
        let theta = (1.0 - share(row).powi(2)).acos().min(GRAZING);
        Self { alpha, view: [theta.sin(), 0.0, theta.cos()] }
    }

    /// Smith's function of a direction with this cosine.
    fn masking(&self, cosine: f64) -> f64 {
        let tangent = (1.0 / (cosine * cosine) - 1.0).max(0.0).sqrt();
        let slope = self.alpha * tangent;
        0.5 * ((1.0 + slope * slope).sqrt() - 1.0)
    }

    /// The light that goes from a direction to the viewer, its cosine included, and the density with which
    /// [`draw`](Self::draw) draws the direction.
    fn reflected(&self, light: Vector) -> (f64, f64) {
        let half = unit([self.view[0] + light[0], self.view[1] + light[1], self.view[2] + light[2]]);
        let slopes = (half[0] * half[0] + half[1] * half[1]) / (half[2] * half[2]);
        let width = self.alpha * self.alpha;
        let spread = 1.0 + slopes / width;
        let facets = 1.0 / (PI * width * half[2].powi(4) * spread * spread);
        let density = (facets * half[2] / (4.0 * dot(self.view, half))).abs();
        if light[2] <= 0.0 {
            return (0.0, density);
        }
        let shadowing = 1.0 / (1.0 + self.masking(self.view[2]) + self.masking(light[2]));
        (facets * shadowing / (4.0 * self.view[2]), density)
    }

    /// The direction in which a facet of the distribution reflects the view.
    fn draw(&self, [a, b]: [f64; 2]) -> Vector {
        let around = 2.0 * PI * a;
        let slope = self.alpha * (b / (1.0 - b)).sqrt();
        let facet = unit([slope * around.cos(), slope * around.sin(), 1.0]);
        let along = 2.0 * dot(facet, self.view);
        std::array::from_fn(|axis| along * facet[axis] - self.view[axis])
    }

    /// The share of light that it reflects in all directions, the part of that for Fresnel's term, and the mean
    /// direction, in the plane of view.
    fn means(&self) -> (f64, f64, Vector) {
        let (mut albedo, mut fresnel, mut mean) = (0.0, 0.0, [0.0; 3]);
        for place in places() {
            let light = self.draw(place);
            let (value, density) = self.reflected(light);
            if density > 0.0 {
                let weight = value / density / (SAMPLES * SAMPLES) as f64;
                let half = unit([self.view[0] + light[0], self.view[1] + light[1], self.view[2] + light[2]]);
                albedo += weight;
                fresnel += weight * (1.0 - dot(self.view, half).max(0.0)).powi(5);
                mean = std::array::from_fn(|axis| mean[axis] + weight * light[axis]);
            }
        }
        (albedo, fresnel, unit([mean[0], 0.0, mean[2]]))
    }
}

/// The middles of a grid of cells.
fn places() -> impl Iterator<Item = [f64; 2]> {
    let middle = |index: usize| (index as f64 + 0.5) / SAMPLES as f64;
    (0..SAMPLES * SAMPLES).map(move |index| [middle(index % SAMPLES), middle(index / SAMPLES)])
}

/// A transformed cosine. Its matrix is `frame * [[a, 0, c], [0, b, 0], [0, 0, 1]]`, with the frame of its axis, which
/// lies in the plane of x and z.
#[derive(Clone, Copy)]
struct Lobe {
    /// a, b, c
    shape: [f64; 3],
    axis: Vector,
    albedo: f64,
}

impl Lobe {
    /// The two rows of the matrix in the plane of x and z.
    fn matrix(&self) -> [[f64; 2]; 2] {
        let ([a, _, c], [x, _, z]) = (self.shape, self.axis);
        // The first axis of the frame is (z, 0, -x).
        [[z * a, z * c + x], [-x * a, -x * c + z]]
    }

    /// The same of the inverse matrix.
    fn inverse(&self) -> [[f64; 2]; 2] {
        let [[a, b], [c, d]] = self.matrix();
        let determinant = a * d - b * c;
        [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]
    }

    /// The direction that the lobe has for a place of the unit square.
    fn draw(&self, [a, b]: [f64; 2]) -> Vector {
        let (height, around) = (a.sqrt(), 2.0 * PI * b);
        let across = (1.0 - a).sqrt();
        let [x, y, z] = [across * around.cos(), across * around.sin(), height];
        let [[p, q], [r, s]] = self.matrix();
        unit([p * x + q * z, self.shape[1] * y, r * x + s * z])
    }

    /// Its value in a direction.
    fn value(&self, inverse: [[f64; 2]; 2], direction: Vector) -> f64 {
        let [[p, q], [r, s]] = inverse;
        let [x, y, z] = direction;
        let before = [p * x + q * z, y / self.shape[1], r * x + s * z];
        let length = dot(before, before).sqrt();
        let determinant = (p * s - q * r) / self.shape[1];
        let cosine = (before[2] / length).max(0.0);
        self.albedo * cosine / PI * determinant.abs() / length.powi(3)
    }

    /// The cube of the difference from the light that a surface reflects.
    fn error(&self, surface: &Surface) -> f64 {
        let inverse = self.inverse();
        let at = |light: Vector| {
            let ((exact, density), value) = (surface.reflected(light), self.value(inverse, light));
            (exact - value).abs().powi(3) / (density + value / self.albedo)
        };
        places().map(|place| at(self.draw(place)) + at(surface.draw(place))).sum::<f64>() / (SAMPLES * SAMPLES) as f64
    }

    /// The same lobe in the shape that it can have: with its axis upright it is round.
    fn shaped(self, [a, b, c]: [f64; 3], is_round: bool) -> Self {
        let a = a.max(THINNEST);
        let shape = if is_round { [a, a, 0.0] } else { [a, b.max(THINNEST), c] };
        Self { shape, ..self }
    }
}

/// The place where a function is least, by the method of Nelder and Mead, near a start.
fn least(start: [f64; 3], of: impl Fn([f64; 3]) -> f64) -> [f64; 3] {
    const FIRST_STEP: f64 = 0.05;
    const TOLERANCE: f64 = 1e-5;
    const MOST_STEPS: usize = 100;
    let mut corners = vec![(of(start), start)];
    for axis in 0..3 {
        let mut corner = start;
        corner[axis] += FIRST_STEP;
        corners.push((of(corner), corner));
    }
    for _ in 0..MOST_STEPS {
        corners.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (best, next, (worst, at)) = (corners[0].0, corners[2].0, corners[3]);
        if 2.0 * (worst - best).abs() < (worst.abs() + best.abs()) * TOLERANCE {
            break;
        }
        let middle: [f64; 3] =
            std::array::from_fn(|axis| corners[..3].iter().map(|(_, at)| at[axis]).sum::<f64>() / 3.0);
        let along = |t: f64| {
            let place = std::array::from_fn(|axis| middle[axis] + t * (middle[axis] - at[axis]));
            (of(place), place)
        };
        let reflected = along(1.0);
        if reflected.0 < next {
            let expanded = if reflected.0 < best { Some(along(2.0)) } else { None };
            corners[3] = expanded.filter(|expanded| expanded.0 < reflected.0).unwrap_or(reflected);
            continue;
        }
        let contracted = along(-0.5);
        if contracted.0 < worst {
            corners[3] = contracted;
            continue;
        }
        let centre = corners[0].1;
        for corner in &mut corners[1..] {
            let place = std::array::from_fn(|axis| centre[axis] + 0.5 * (corner.1[axis] - centre[axis]));
            *corner = (of(place), place);
        }
    }
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners[0].1
}

/// The entries of the files at a place: a, b, c, d of the inverse matrix `[[a, 0, b], [0, 1, 0], [c, 0, d]]`, albedo and
/// Fresnel's part.
type Texel = [f64; 6];

/// Fits the lobe of a place, beginning with a shape.
fn fit(column: usize, row: usize, start: [f64; 3]) -> ([f64; 3], Texel) {
    let surface = Surface::new(column, row);
    let (albedo, fresnel, mean) = surface.means();
    let axis = if row == 0 { [0.0, 0.0, 1.0] } else { mean };
    let lobe = Lobe { shape: start, axis, albedo };
    let found = least(start, |shape| lobe.shaped(shape, row == 0).error(&surface));
    let lobe = lobe.shaped(found, row == 0);
    let [[a, b], [c, d]] = lobe.inverse().map(|line| line.map(|number| number * lobe.shape[1]));
    (lobe.shape, [a, b, c, d, albedo, fresnel])
}

/// All places, row by row.
fn table() -> Vec<Texel> {
    // Seen from above each column begins where the next rougher one ended, ...
    let mut starts = vec![[1.0, 1.0, 0.0]; SIZE];
    let mut texels = vec![Texel::default(); SIZE * SIZE];
    for column in (0..SIZE).rev() {
        let start = starts[(column + 1).min(SIZE - 1)];
        (starts[column], texels[column]) = fit(column, 0, start);
    }
    // ... and from there each place with the one before it.
    let (next, all) = (AtomicUsize::new(0), Mutex::new(texels));
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let column = next.fetch_add(1, Ordering::Relaxed);
                    let Some(start) = starts.get(column) else { break };
                    let mut shape = *start;
                    for row in 1..SIZE {
                        let (found, texel) = fit(column, row, shape);
                        shape = found;
                        if let Ok(mut all) = all.lock() {
                            all[row * SIZE + column] = texel;
                        }
                    }
                }
            });
        }
    });
    all.into_inner().unwrap_or_default()
}

/// Seven digits of a number, and of one that hardly differs from 0 nothing.
fn shown(number: f64) -> String {
    let rounded: f64 = format!("{number:.6e}").parse().unwrap_or(number);
    match rounded.abs() {
        size if size < 1e-12 => "0".to_owned(),
        size if size < 1e-3 => format!("{rounded:e}"),
        _ => rounded.to_string(),
    }
}

/// Fits all places and writes a file for each entry into a directory.
pub(crate) fn run(directory: &Path) -> std::io::Result<()> {
    let texels = table();
    let entries = [
        ("a", "entry (1,1) of the inverse matrix, whose entry (2,2) is 1"),
        ("b", "entry (1,3) of the inverse matrix"),
        ("c", "entry (3,1) of the inverse matrix"),
        ("d", "entry (3,3) of the inverse matrix"),
        ("albedo", "share of light that is reflected in all directions, were Fresnel's term 1"),
        ("fresnel", "the same times (1 - cosine to the half vector)^5"),
    ];
    for (place, (name, doc)) in entries.into_iter().enumerate() {
        let mut text = format!(
            "# Linearly transformed cosines for GGX: {doc}.\n\
             # A line for each x = sqrt(1 - cosine of view) = 0, 1/63, ... 1, a number in it for each roughness = sqrt(alpha)\n\
             # = 0, 1/63, ... 1. Fitted by `cargo xtask ltc`, see xtask/src/ltc.rs.\n"
        );
        for row in texels.chunks(SIZE) {
            let numbers: Vec<String> = row.iter().map(|texel| shown(texel[place])).collect();
            let _ = writeln!(text, "{}", numbers.join(","));
        }
        fs::write(directory.join(format!("ltc_ggx_{name}.csv")), text)?;
    }
    Ok(())
}
