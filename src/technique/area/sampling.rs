//! The estimators that peeling is compared with: rays towards stratified places on each light.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::gloss::Sheen;
use super::lit::Lit;
use super::received::Received;
use crate::scene::light::Polygon;
use crate::scene::rays::{Rays, SurfacePoint, Tests};
use crate::technique::Progress;

/// A stream of random numbers for a pixel and a light, the same on every machine.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stream(u32);

/// The generator PCG RXS-M-XS with 32 bits (O'Neill 2014).
fn pcg(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

impl Stream {
    /// The stream of a pixel and a light in a frame.
    pub(super) fn new([x, y]: [u32; 2], light: u32, frame: u32) -> Self {
        Self(pcg(x.wrapping_add(pcg(y.wrapping_add(pcg(light.wrapping_add(pcg(frame))))))))
    }

    /// The next number of [0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = pcg(self.0);
        f64::from(self.0 >> 8) / f64::from(1 << 24)
    }

    /// The next whole number below a count.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.uniform() * count as f64) as usize
    }
}

/// Sums over the samples of a pixel: with and without occluders.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Estimate {
    pub(super) shadowed: Received,
    pub(super) unshadowed: Received,
}

/// The transform of directions that a glossy surface has.
#[derive(Debug, Clone, Copy)]
struct Lobe {
    inverse: DMat3,
    determinant: f64,
}

impl Lobe {
    fn new(sheen: &Sheen, normal: DVec3) -> Self {
        let inverse = DMat3::from_cols_array_2d(&sheen.shape.rows(normal)).transpose();
        Self { inverse, determinant: inverse.determinant() }
    }

    /// The density of the lobe in a direction, which takes the place of the cosine over pi.
    fn density(&self, direction: DVec3) -> f64 {
        let turned = self.inverse * direction;
        let length = turned.length();
        (turned.z / length).max(0.0) / std::f64::consts::PI * self.determinant / length.powi(3)
    }
}

/// Estimates the light at every pixel from some rays to each light.
pub(super) fn estimates(lit: &Lit, rays: &Rays, samples: u32, frame: u32, progress: &Progress<'_>) -> Vec<Estimate> {
    let width = lit.surfaces.width as usize;
    let row = |(y, row): (usize, &[Option<SurfacePoint>])| {
        let tests = rays.tests(None);
        let pixel = |(x, point): (usize, &Option<SurfacePoint>)| {
            let Some(point) = point else { return Estimate::default() };
            let lobe = lit.sheen(y * width + x).map(|sheen| Lobe::new(&sheen, point.smooth_normal));
            let mut sum = Estimate::default();
            for (index, light) in lit.lights.iter().enumerate() {
                let mut stream = Stream::new([x as u32, y as u32], index as u32, frame);
                let [with, without] = at_point(&tests, point, lobe.as_ref(), light, samples, &mut stream);
                sum.shadowed += Received::of(light.colour, with);
                sum.unshadowed += Received::of(light.colour, without);
            }
            sum
        };
        let row: Vec<Estimate> = row.iter().enumerate().map(pixel).collect();
        progress(1);
        row
    };
    lit.surfaces.points.par_chunks(width.max(1)).enumerate().flat_map_iter(row).collect()
}

/// The mean of the lights' visible fractions at every pixel, by 400 rays to each light; 1 without a surface.
pub(super) fn fractions(lit: &Lit, rays: &Rays) -> Vec<f64> {
    const SIDE: u32 = 20;
    let one = |point: &Option<SurfacePoint>| {
        let Some(point) = point else { return 1.0 };
        let tests = rays.tests(None);
        let mut open = 0_u32;
        for light in &lit.lights {
            let share = |index: u32| (f64::from(index) + 0.5) / f64::from(SIDE);
            let places = (0..SIDE * SIDE).map(|index| DVec2::new(share(index % SIDE), share(index / SIDE)));
            open += places.filter(|at| tests.is_open(point.place, light.place(*at))).count() as u32;
        }
        f64::from(open) / (f64::from(SIDE * SIDE) * lit.lights.len() as f64)
    };
    lit.surfaces.points.par_iter().map(one).collect()
}

/// The two form factors of a light, with and without occluders, by places in a grid of strata.
fn at_point(
    tests: &Tests<'_>,
    point: &SurfacePoint,
    lobe: Option<&Lobe>,
    light: &Polygon,
    samples: u32,
    stream: &mut Stream,
) -> [[f64; 2]; 2] {
    let area = light.area();
    let columns = f64::from(samples).sqrt().ceil() as u32;
    let (mut with, mut without) = ([0.0; 2], [0.0; 2]);
    for index in 0..samples {
        // Rows of strata; the last one has fewer and wider ones.
        let (row, rows) = (index / columns, samples.div_ceil(columns));
        let across = if row + 1 == rows { samples - row * columns } else { columns };
        let share = f64::from(index % columns) + stream.uniform();
        let at = DVec2::new(share / f64::from(across), (f64::from(row) + stream.uniform()) / f64::from(rows));
        // A row with fewer strata has less weight for each of its samples.
        let weight = 1.0 / (f64::from(across) * f64::from(rows));
        let place = light.place(at);
        let towards = place - point.place;
        let square = towards.length_squared();
        let cosine = point.smooth_normal.dot(towards);
        let emitted = -light.normal().dot(towards);
        let emitted = if light.two_sided { emitted.abs() } else { emitted };
        if cosine <= 0.0 || emitted <= 0.0 {
            continue;
        }
        let across = weight * area * emitted / (square * square.sqrt());
        let diffuse = across * cosine / (std::f64::consts::PI * square.sqrt());
        let glossy = lobe.map_or(0.0, |lobe| across * lobe.density(towards / square.sqrt()));
        let is_open = tests.is_open(point.place, place);
        for (index, part) in [diffuse, glossy].into_iter().enumerate() {
            without[index] += part;
            with[index] += if is_open { part } else { 0.0 };
        }
    }
    [with, without]
}

/// Sizes of the filter of the ratio estimator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Filter {
    /// Pixels to each side.
    pub(super) radius: u32,
}

/// A picture without noise: the true light without occluders times the filtered ratio of the two estimates.
///
/// Shadowed and unshadowed sums are filtered alike and then divided, over pixels whose surfaces are close and
/// look the same way (Heitz, Hill and McGuire, Combining Analytic Direct Illumination and Stochastic Shadows, I3D 2018).
pub(super) fn ratio(lit: &Lit, estimates: &[Estimate], unshadowed: &[Received], filter: Filter) -> Vec<Received> {
    let (width, height) = (lit.surfaces.width as i64, lit.surfaces.height as i64);
    let radius = i64::from(filter.radius);
    let deviation = (f64::from(filter.radius) / 2.0).max(1e-3);
    let points = &lit.surfaces.points;
    let filtered = |pixel: usize| {
        let Some(own) = &points[pixel] else { return Received::default() };
        let (x, y) = (pixel as i64 % width, pixel as i64 / width);
        let mut sum = Estimate::default();
        for v in (y - radius).max(0)..=(y + radius).min(height - 1) {
            for u in (x - radius).max(0)..=(x + radius).min(width - 1) {
                let index = (v * width + u) as usize;
                let Some(other) = &points[index] else { continue };
                let apart = ((u - x) * (u - x) + (v - y) * (v - y)) as f64 / (2.0 * deviation * deviation);
                let off =
                    own.normal.dot(other.place - own.place).abs() / (1e-2 * (1e-9 + own.place.distance(other.place)));
                let turned = own.smooth_normal.dot(other.smooth_normal).max(0.0).powi(32);
                let weight = libm::exp(-apart - off.min(50.0)) * turned;
                sum.shadowed += weight * estimates[index].shadowed;
                sum.unshadowed += weight * estimates[index].unshadowed;
            }
        }
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let shares =
            |part: DVec3, whole: DVec3| DVec3::from_array([0, 1, 2].map(|index| share(part[index], whole[index])));
        unshadowed[pixel].with(sum.shadowed.with(sum.unshadowed, shares), |light, share| light * share)
    };
    (0..points.len()).into_par_iter().map(filtered).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::Interpreter;
    use crate::program::Value;
    use crate::technique::tables::PCG;

    #[test]
    fn the_stream_is_the_published_one() {
        let values = [(0, 0x07bb_2fe2), (1, 0xa8be_ea3c), (2, 0x7a7e_cc88), (12345, 0xf45e_ad0e)];
        for (state, expected) in values {
            assert_eq!(pcg(state), expected);
        }
        // A ray is no place for an interpreter, so that the generator stands here again: as the table has it.
        let table = PCG.function("hash").unwrap_or_else(|e| panic!("{e}"));
        let mut interpreter = Interpreter::<f64>::new(table);
        let mut state = 1;
        for _ in 0..1000 {
            let found = interpreter.evaluate(&[Some(Value::Number(f64::from(state)))]).expect("nothing is fetched");
            state = pcg(state);
            assert_eq!(found.values, [f64::from(state)]);
        }
        let mut stream = Stream::new([3, 5], 1, 2);
        assert_eq!(stream.0, pcg(3 + pcg(5_u32.wrapping_add(pcg(1_u32.wrapping_add(pcg(2)))))));
        assert!((0..1000).all(|_| (0.0..1.0).contains(&stream.uniform())));
    }
}
