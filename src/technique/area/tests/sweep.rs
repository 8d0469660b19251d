//! Points that move across places at which edges coincide: nothing jumps there, and no precision strays from another.

use glam::DVec3;

use super::super::lit::Lit;
use super::{Question, peeler};
use crate::scene::Scene;
use crate::scene::light::Polygon;
use crate::technique::area::{Answer, Query};
use crate::technique::{Executor, Frame};

/// Steps on either side of a place.
const STEPS: i32 = 40;
/// Lengths of a step: from what shows in a picture to what single precision hardly tells apart.
const LENGTHS: [f64; 3] = [1.0 / 256.0, 1.0 / 65_536.0, 1.0 / 4_194_304.0];

/// The scene with its light and its occluders.
fn scene() -> (Polygon, Vec<super::Occluder>) {
    let scene = Scene::open("coincident").unwrap_or_else(|error| panic!("{error}"));
    let frame = Frame::new(&scene, (8, 8), &Executor::Cpu);
    let lit = Lit::of(&frame, "peel").unwrap_or_else(|error| panic!("{error}"));
    (lit.lights[0].clone(), lit.occluders.clone())
}

/// Places of the floor at which edges, corners or planes coincide as seen from there: of corners of occluders and
/// corners of the light, and below and beside the occluders.
fn places(light: &Polygon) -> Vec<DVec3> {
    let corners = [
        [-0.25, 1.5, -0.25],
        [0.25, 1.5, 0.25],
        [-1.25, 1.0, -1.0],
        [-0.75, 1.0, -0.5],
        [1.0, 1.0, -0.75],
        [1.4, 1.0, -0.75],
        [-0.5, 1.0, 0.5],
        [-1.5, 0.5, 0.5],
        [0.0, 0.5, 1.0],
        [0.75, 2.0, 0.75],
        [1.25, 2.0, 0.75],
        [1.25, 2.0, 1.25],
    ];
    // Before the middle of the light, and in the planes of the upright plates.
    let mut places = vec![DVec3::ZERO, DVec3::X * 0.5, DVec3::new(1.75, 0.0, 0.75), DVec3::new(1.25, 0.0, 1.75)];
    for corner in corners.map(DVec3::from_array) {
        for end in &light.corners {
            // From the light's corner through the occluder's to the floor.
            let place = *end + (corner - *end) * (end.y / (end.y - corner.y));
            places.push(DVec3::new(place.x, 0.0, place.z));
        }
    }
    places.retain(is_open);
    places
}

/// Returns whether a sweep across a place meets nothing that stands on the floor: light does jump there.
fn is_open(place: &DVec3) -> bool {
    let near = |[x0, x1]: [f64; 2], [z0, z1]: [f64; 2]| {
        (x0 - 0.2..=x1 + 0.2).contains(&place.x) && (z0 - 0.2..=z1 + 0.2).contains(&place.z)
    };
    !near([-1.5, 0.0], [0.5, 1.0]) && !near([0.75, 1.25], [0.75, 1.25])
}

/// The points of a sweep across a place in a direction.
fn sweep(place: DVec3, direction: DVec3, length: f64) -> Vec<DVec3> {
    (-STEPS..=STEPS).map(|step| place + direction * (f64::from(step) * length)).collect()
}

/// The questions of all sweeps, a sweep of each length across each place in three directions.
fn questions() -> Vec<(f64, Vec<Question>)> {
    let (light, occluders) = scene();
    let directions = [DVec3::X, DVec3::Z, DVec3::new(0.6, 0.0, 0.8)];
    let mut all = Vec::new();
    for place in places(&light) {
        for (direction, length) in directions.iter().flat_map(|direction| LENGTHS.map(|length| (*direction, length))) {
            let question = |point| Question {
                light: light.corners.clone(),
                two_sided: light.two_sided,
                point,
                normal: DVec3::Y,
                occluders: occluders.clone(),
                shape: None,
            };
            all.push((length, sweep(place, direction, length).into_iter().map(question).collect()));
        }
    }
    all
}

/// Asserts that form factors along a sweep have no spike: that none is off the mean of its neighbours by more than the
/// light can change, or than single precision rounds.
fn assert_smooth(answers: &[Answer], length: f64, noise: f64) {
    for three in answers.windows(3) {
        let [a, b, c] = [0, 1, 2].map(|index| three[index].form_factor);
        // An edge sweeps over the light, whose form factor is below 0.05, at a speed of a few lights a unit of length.
        let bound = 0.25 * length + noise;
        assert!((b - 0.5 * (a + c)).abs() < bound, "{length}: {a} {b} {c}");
    }
}

#[test]
fn nothing_jumps_where_edges_coincide() {
    let (mut wide, mut narrow) = (peeler::<f64>(), peeler::<f32>());
    let mut shadowed = 0;
    for (length, questions) in questions() {
        let queries: Vec<Query<'_>> = questions.iter().map(Question::query).collect();
        let wide = wide.answers(queries.iter().cloned()).unwrap_or_else(|e| panic!("{e}"));
        let narrow = narrow.answers(queries.iter().cloned()).unwrap_or_else(|e| panic!("{e}"));
        assert_smooth(&wide, length, 1e-12);
        assert_smooth(&narrow, length, 2e-6);
        for ((wide, narrow), question) in wide.iter().zip(&narrow).zip(&questions) {
            assert!((wide.form_factor - narrow.form_factor).abs() < 1e-6, "{}: {wide:?} {narrow:?}", question.point);
            let shares = (wide.fraction.expect("below"), narrow.fraction.expect("below"));
            assert!((shares.0 - shares.1).abs() < 2e-6, "{}: {wide:?} {narrow:?}", question.point);
            shadowed += usize::from(shares.0 < 0.99);
        }
    }
    assert!(shadowed > 5000, "{shadowed}");
}
