//! Points on an adapter: the published numbers, random scenes, shapes of light, and what the shader has no room for.

use glam::DVec3;

use super::scenes::Scene;
use super::{below_square, block, ceiling, cube, exact, plate};
use crate::diag::Failure;
use crate::gpu::{AdapterChoice, Gpu};
use crate::points::random::Random;
use crate::technique::area::mesh::Mesh;
use crate::technique::area::{Answer, Occluder, Peeler, PointPeeler, Query, Question, Shape, SinglePeeler};

/// Any adapter, or nothing where tests do without.
fn gpu() -> Option<Gpu> {
    if std::env::var_os("UMBRAGE_NO_ADAPTER").is_some() {
        return None;
    }
    let gpu = Gpu::open(&AdapterChoice::Any).ok();
    assert!(gpu.is_some() || std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_none(), "no adapter");
    gpu
}

fn good<T>(found: Result<T, Failure>) -> T {
    found.unwrap_or_else(|error| panic!("{error}"))
}

/// The answers of an adapter, and how many of them the host had to give.
fn on_device(gpu: &Gpu, questions: &[Question]) -> (Vec<Answer>, usize) {
    let mut peeler = good(PointPeeler::new(gpu));
    let queries: Vec<Query<'_>> = questions.iter().map(Question::query).collect();
    (good(peeler.answers(&queries)), peeler.by_host())
}

/// The numbers of an answer, each with the tolerance of single precision.
fn numbers(answer: &Answer) -> Option<[(f64, f64); 4]> {
    let [factor, share] = [1e-6, 2e-6];
    Some([
        (answer.form_factor, factor),
        (answer.form_factor_unshadowed, factor),
        (answer.fraction?, share),
        (answer.fraction_above_horizon?, share),
    ])
}

#[track_caller]
fn assert_close(found: &Answer, expected: &Answer, what: &dyn std::fmt::Debug) {
    match (numbers(found), numbers(expected)) {
        (Some(found), Some(expected)) => {
            for ((a, limit), (b, _)) in found.into_iter().zip(expected) {
                assert!((a - b).abs() < limit, "{what:?}: {found:?} {expected:?}");
            }
        }
        (found, expected) => assert_eq!(found, expected, "{what:?}"),
    }
    match (found.shaped, expected.shaped) {
        (Some((a, b)), Some((c, d))) => {
            assert!((a - c).abs() < 1e-6 && (b - d).abs() < 1e-6, "{what:?}: {found:?} {expected:?}")
        }
        (found, expected) => assert_eq!(found, expected, "{what:?}"),
    }
}

#[test]
fn an_adapter_has_the_published_numbers() {
    let Some(gpu) = gpu() else { return };
    let light = vec![DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 4.0, 2.0), DVec3::new(4.0, 0.0, 2.0)];
    let flat = |corners: &[[f64; 2]]| Occluder::polygon(corners.iter().map(|[x, y]| DVec3::new(*x, *y, 1.0)).collect());
    let triangle = |corners: &[[f64; 2]]| Question { light: light.clone(), ..below_square(vec![flat(corners)]) };
    let quarter = 0.165978835648252;
    let upright = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(2.0, y, z));
    let rows = [
        (below_square(vec![]), 1.0, 0.239456470460774),
        (below_square(vec![plate([-0.25, 0.25], [-0.25, 0.25], 1.0)]), 0.75, quarter),
        (below_square(vec![plate([-1.0, 0.0], [-1.0, 1.0], 1.0)]), 0.5, 0.119728235230387),
        (below_square(vec![plate([0.0, 1.0], [0.0, 1.0], 1.0)]), 0.75, 0.17959235284558),
        (
            below_square(vec![plate([-0.25, 0.125], [-0.25, 0.25], 1.0), plate([-0.125, 0.25], [-0.125, 0.125], 1.0)]),
            25.0 / 32.0,
            0.174628204946223,
        ),
        (
            below_square(vec![plate([-0.25, 0.25], [-0.25, 0.25], 1.0), plate([-0.125, 0.125], [-0.125, 0.125], 0.5)]),
            0.75,
            quarter,
        ),
        (below_square(vec![block([0.5, 0.0, 0.75], [0.25, 0.25, 0.75])]), 7.0 / 9.0, 0.188119051570508),
        (below_square(vec![block([0.5, 0.0, 2.0], [0.25, 0.25, 0.5])]), 505.0 / 576.0, 0.207812806696237),
        (Question { light: upright.to_vec(), two_sided: true, ..below_square(vec![]) }, 1.0, 0.0278553824200465),
        (triangle(&[[-1.0, -1.0], [0.5, -1.0], [0.5, 0.5], [-1.0, 0.5]]), 7.0 / 8.0, 0.118093673159524),
        (triangle(&[[0.5, -1.0], [1.0, -1.0], [1.0, 0.5], [0.5, 0.5]]), 7.0 / 8.0, 0.147637537828371),
        (triangle(&[[-0.5, 1.0], [1.0, -0.5], [1.5, -0.5], [-0.5, 1.5]]), 13.0 / 16.0, 0.115871540026302),
        (triangle(&[[-0.5, -0.5], [1.5, -0.5], [1.5, 1.5], [-0.5, 1.5]]), 1.0 / 8.0, 0.0055667652439639),
        (triangle(&[[1.5, -1.0], [1.5, 1.5], [-1.0, 1.5]]), 3.0 / 16.0, 0.0397055593604861),
    ];
    let questions: Vec<Question> = rows.iter().map(|(question, ..)| question.clone()).collect();
    let (answers, by_host) = on_device(&gpu, &questions);
    // A software adapter grants fewer rounds of loops.
    assert!(by_host == 0 || gpu.is_software() && by_host < 2, "{by_host}");
    for ((question, fraction, form_factor), answer) in rows.iter().zip(answers) {
        let found = answer.fraction.expect("not in the plane");
        assert!(
            (found - fraction).abs() < 2e-6 && (answer.form_factor - form_factor).abs() < 1e-6,
            "{question:?}: {answer:?}"
        );
    }
}

#[test]
fn an_adapter_has_random_scenes_as_the_cpu_and_as_exact_geometry_have_them() {
    let Some(gpu) = gpu() else { return };
    let scenes: Vec<Scene> = (0..6000).map(Scene::new).collect();
    let mut random = Random::new(3);
    let mut unit = || 2.0 * random.unit() - 1.0;
    let mut question = |scene: &Scene| {
        // Something like the matrices of rough surfaces, for every other one.
        let view = DVec3::new(unit(), unit(), unit());
        let [a, b, c, d] = [0.8 + 0.3 * unit(), 0.4 * unit(), 0.3 * unit(), 0.7 + 0.4 * unit()];
        let shape = Shape { view, inverse: [[a, 0.0, b], [0.0, 1.0, 0.0], [c, 0.0, d]] };
        Question { shape: (b > 0.0).then_some(shape), two_sided: c > 0.0, ..scene.question() }
    };
    let questions: Vec<Question> = scenes.iter().map(&mut question).collect();
    let (found, by_host) = on_device(&gpu, &questions);
    // The host is for exceptions.
    assert!(by_host < questions.len() / if gpu.is_software() { 5 } else { 50 }, "{by_host}");
    let queries: Vec<Query<'_>> = questions.iter().map(Question::query).collect();
    let narrow = good(good(SinglePeeler::new()).answers(&queries));
    let wide = good(good(Peeler::<f64>::new()).answers(queries.iter().cloned()));
    for (seed, ((found, narrow), wide)) in found.iter().zip(&narrow).zip(&wide).enumerate() {
        assert_close(found, wide, &seed);
        assert_close(found, narrow, &seed);
    }
    for (seed, scene) in scenes.iter().enumerate().take(500) {
        let polygons: Vec<Vec<exact::Whole>> = scene.occluders.iter().flatten().cloned().collect();
        let Some([_, share, above]) = exact::visible(&scene.light, scene.normal, &polygons) else { continue };
        let numbers = (found[seed].fraction, found[seed].fraction_above_horizon);
        let apart = |found: Option<f64>, exact: f64| (found.expect("not in the plane") - exact).abs();
        assert!(apart(numbers.0, share) < 2e-6 && apart(numbers.1, above) < 2e-6, "{seed}: {numbers:?}");
    }
}

#[test]
fn an_adapter_has_solids_meshes_and_degenerate_things_as_the_cpu_has_them() {
    let Some(gpu) = gpu() else { return };
    let square = [-0.5, 0.5];
    let solid = |at: [f64; 3]| [block(at, [0.5; 3]), Occluder::mesh(cube(DVec3::from_array(at), 0.5))];
    let octahedron = || {
        let corners =
            [[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, -0.3, 0.0], [0.0, 0.0, 0.4], [0.0, 0.0, -0.4]];
        let corners = corners.map(|at| DVec3::from_array(at) + DVec3::new(0.1, 0.2, 1.0)).to_vec();
        let faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
        Occluder::mesh(Mesh::new(corners, &faces.map(|face| face.to_vec())))
    };
    let mut scenes: Vec<Vec<Occluder>> = vec![
        vec![plate(square, square, -1.0)],
        vec![plate(square, square, 3.0)],
        vec![plate(square, square, 2.0)],
        vec![plate(square, square, 0.0)],
        vec![block([0.0, 0.0, 4.0], [0.5; 3]), block([0.0, 0.0, -1.0], [0.5; 3])],
        vec![block([1.5, 0.0, 2.6], [0.5; 3])],
        vec![Occluder::polygon(vec![DVec3::new(0.1, 0.0, 1.0); 4])],
        vec![block([0.2, 0.0, 1.0], [0.0, 0.3, 0.0])],
        vec![block([0.0, 0.0, 1.0], [0.25, 0.25, 0.0])],
        vec![octahedron()],
        vec![octahedron(), block([0.4, -0.3, 0.8], [0.2, 0.3, 0.1]), plate(square, [0.1, 0.9], 1.5)],
        // Across the light's plane.
        vec![Occluder::mesh(cube(DVec3::new(0.3, 0.2, 2.0), 0.4))],
        vec![Occluder::polygon([[0.0, -0.5, 1.5], [0.5, 0.5, 2.5], [-0.5, 0.5, 2.5]].map(DVec3::from_array).to_vec())],
        // Far away, and large.
        vec![plate([-1e9, 0.0], [-1e9, 1e9], 1.0)],
        vec![],
    ];
    for at in [[0.1, 0.2, 0.1], [0.1, 0.2, -0.5], [0.1, 0.2, 0.5], [0.5, 0.2, 0.1], [0.5, 0.5, 0.1], [0.5, 0.5, 0.5]] {
        scenes.extend(solid(at).map(|solid| vec![solid]));
    }
    let lights = [
        ceiling([-1.0, 1.0], [-1.0, 1.0], 2.0),
        super::flat([-1.0, 1.0], [-1.0, 1.0], 2.0),
        // Edge-on, without area, half below the horizon, far away, and tiny.
        [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0]].map(DVec3::from_array).to_vec(),
        vec![DVec3::ONE; 3],
        [[2.0, -1.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0]].map(DVec3::from_array).to_vec(),
        ceiling([-1.0, 1.0], [-1.0, 1.0], 1e4),
        ceiling([-1e-12, 1e-12], [-1e-12, 1e-12], 2e-12),
    ];
    let mut questions = Vec::new();
    for occluders in &scenes {
        for light in &lights {
            for two_sided in [false, true] {
                questions.push(Question { light: light.clone(), two_sided, ..below_square(occluders.clone()) });
            }
        }
    }
    let (found, _) = on_device(&gpu, &questions);
    let queries: Vec<Query<'_>> = questions.iter().map(Question::query).collect();
    let wide = good(good(Peeler::<f64>::new()).answers(queries.iter().cloned()));
    for ((found, wide), question) in found.iter().zip(&wide).zip(&questions) {
        assert_close(found, wide, question);
    }
}

#[test]
fn what_the_shader_has_no_room_for_is_given_to_the_host() {
    let Some(gpu) = gpu() else { return };
    let count = 30;
    let cell = |index: usize| -0.5 + 0.5 * index as f64 / count as f64;
    let row = |index: usize| -0.5 + index as f64 / count as f64;
    let plates = (0..count).flat_map(|x| (0..count).map(move |y| (x, y)));
    let plates: Vec<Occluder> = plates.map(|(x, y)| plate([cell(x), cell(x + 1)], [row(y), row(y + 1)], 1.0)).collect();
    let some = |count: usize| below_square(plates[..count].to_vec());
    // More than the list of bodies holds, than a portion takes, and in the same run one that has room.
    let (found, by_host) = on_device(&gpu, &[some(100), some(900), some(1)]);
    assert_eq!(by_host, 2);
    assert!((found[1].fraction.expect("in front") - 0.5).abs() < 2e-6 && found[1].work.overflow, "{:?}", found[1]);
    assert!((found[1].form_factor - 0.119728235230387).abs() < 1e-5 && !found[2].work.overflow, "{:?}", found[1]);
}
