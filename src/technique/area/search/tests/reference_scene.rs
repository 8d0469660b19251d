//! The scene that the numbers of the specification were measured in: a box, a ball and a cone under a triangular light,
//! with tests of visibility in closed form.

use glam::DVec3;

use super::super::super::sampling::Stream;
use super::super::{Edge, Options, Rule, Searcher};
use super::share;

const LIGHT: [DVec3; 3] = [DVec3::new(-1.5, 1.0, 5.0), DVec3::new(1.5, 1.0, 5.0), DVec3::new(0.0, 3.5, 5.0)];
const COLUMNS: u32 = 96;
const ROWS: u32 = 40;

fn receiver(column: u32, row: u32) -> DVec3 {
    let x = -4.0 + 8.0 * (f64::from(column) + 0.5) / f64::from(COLUMNS);
    DVec3::new(x, -3.2 + 3.6 * (f64::from(row) + 0.5) / f64::from(ROWS), 1e-4)
}

/// Returns whether a segment meets a box with sides along the axes.
fn meets_box(from: DVec3, to: DVec3, lo: DVec3, hi: DVec3) -> bool {
    let along = to - from;
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for axis in 0..3 {
        let (a, b) = ((lo[axis] - from[axis]) / along[axis], (hi[axis] - from[axis]) / along[axis]);
        (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
    }
    first < last
}

fn meets_ball(from: DVec3, to: DVec3, centre: DVec3, radius: f64) -> bool {
    let along = to - from;
    let nearest = ((centre - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (from + along * nearest).distance(centre) < radius
}

/// Returns whether a segment meets a solid cone that stands upright.
fn meets_cone(from: DVec3, to: DVec3, apex: DVec3, height: f64, radius: f64) -> bool {
    let along = to - from;
    // The heights between which the segment is beside the cone.
    let at = |z: f64| (z - from.z) / along.z;
    let (a, b) = (at(apex.z - height), at(apex.z));
    let (first, last) = (a.min(b).max(0.0), a.max(b).min(1.0));
    if first >= last {
        return false;
    }
    // Inside where x^2 + y^2 < (slope * depth)^2, with the depth below the apex.
    let slope = radius / height;
    let (p, d) = (from - apex, along);
    let square = |u: DVec3, v: DVec3| u.x * v.x + u.y * v.y - slope * slope * u.z * v.z;
    let value = |t: f64| square(p + d * t, p + d * t);
    let (quadratic, linear) = (square(d, d), square(p, d));
    let lowest = if quadratic > 0.0 { (-linear / quadratic).clamp(first, last) } else { first };
    value(lowest) < 0.0 || value(first) < 0.0 || value(last) < 0.0
}

fn is_open(from: DVec3, to: DVec3) -> bool {
    !meets_box(from, to, DVec3::new(-2.6, -0.4, 0.0), DVec3::new(-1.8, 0.4, 1.2))
        && !meets_ball(from, to, DVec3::new(0.0, 0.0, 0.6), 0.6)
        && !meets_cone(from, to, DVec3::new(2.2, 0.0, 1.5), 1.5, 0.6)
}

/// The visible share of the light, from the middles of as many triangles as `sides` squared.
fn sampled(from: DVec3, sides: u32) -> f64 {
    let [a, b, c] = LIGHT;
    let mut open = 0;
    for i in 0..sides {
        for j in 0..sides - i {
            let middle = |third: f64| {
                let (u, v) = ((f64::from(i) + third) / f64::from(sides), (f64::from(j) + third) / f64::from(sides));
                a + (b - a) * u + (c - a) * v
            };
            open += u32::from(is_open(from, middle(1.0 / 3.0)));
            if j + 1 < sides - i {
                open += u32::from(is_open(from, middle(2.0 / 3.0)));
            }
        }
    }
    f64::from(open) / f64::from(sides * sides)
}

/// Costs and errors of a run over the picture.
#[derive(Debug, Default)]
struct Summary {
    tests: f64,
    most_tests: u64,
    penumbra: u32,
    tests_in_penumbra: f64,
    /// Root mean square and mean of errors in the penumbra.
    rms: f64,
    bias: f64,
}

/// Runs over the picture in lines of alternating direction, each pixel with its predecessor's edges.
fn run(options: Options, frame: u32, truth: &[f64]) -> Summary {
    let mut searcher = Searcher::new(options).unwrap_or_else(|e| panic!("{e}"));
    let mut summary = Summary::default();
    let mut neighbour: Option<Vec<Edge>> = None;
    for row in 0..ROWS {
        for step in 0..COLUMNS {
            let column = if row % 2 == 0 { step } else { COLUMNS - 1 - step };
            let from = receiver(column, row);
            let mut stream = Stream::new([column, row], 0, frame);
            let seen = searcher.search(&LIGHT, neighbour.as_deref(), &mut stream, &mut |to| is_open(from, to));
            let (truth, found) = (truth[(row * COLUMNS + column) as usize], share(&seen, &LIGHT));
            summary.tests += seen.tests as f64 / f64::from(COLUMNS * ROWS);
            summary.most_tests = summary.most_tests.max(seen.tests);
            if truth > 0.0 && truth < 1.0 {
                summary.penumbra += 1;
                summary.tests_in_penumbra += seen.tests as f64;
                summary.rms += (found - truth).powi(2);
                summary.bias += found - truth;
            }
            neighbour = Some(seen.edges);
        }
    }
    let count = f64::from(summary.penumbra);
    summary.tests_in_penumbra /= count;
    summary.rms = (summary.rms / count).sqrt();
    summary.bias /= count;
    summary
}

#[test]
fn cost_and_error_in_the_reference_scene_are_those_of_the_specification() {
    let pixels = (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| receiver(column, row)));
    let truth: Vec<f64> = pixels.map(|from| sampled(from, 40)).collect();
    let paper = Options { rays: 0, tolerance: 0.05, gap: 0.25, spacing: 0.333, rule: Rule::Line };
    let found = run(paper, 0, &truth);
    assert!((700..800).contains(&found.penumbra), "{found:?}");
    assert!((24.0..30.0).contains(&found.tests_in_penumbra) && found.most_tests <= 129, "{found:?}");
    assert!((found.rms / 0.048 - 1.0).abs() < 0.15 && (found.bias - 0.02).abs() < 0.005, "{found:?}");
    // Points of curves in place of closest points: a third of the error at the same cost.
    let found = run(Options { rays: 3, ..paper }, 0, &truth);
    assert!(found.tests_in_penumbra < 31.0 && found.rms < 0.017, "{found:?}");
}
