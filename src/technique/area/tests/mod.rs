//! The method against closed forms, against an exact program, and against itself.

#[cfg(feature = "gpu")]
mod device;
mod exact;
mod pictures;
mod scenes;
mod sweep;

use std::f64::consts::PI;

use glam::DVec3;

use super::mesh::Mesh;
use super::{Answer, Occluder, Peeler, Question, Scalar, Shape};
use crate::eval::Interpreter;
use crate::points::random::Random;
use crate::program::Value;
use crate::technique::tables::CLOSED_FORMS;
use scenes::Scene;

fn peeler<T: Scalar>() -> Peeler<T> {
    Peeler::new().unwrap_or_else(|e| panic!("{e}"))
}

fn answer<T: Scalar>(query: &Question) -> Answer {
    peeler::<T>().answers([query.query()]).unwrap_or_else(|e| panic!("{e}"))[0]
}

/// A rectangle parallel to the ground, counter-clockwise as seen from above.
fn flat([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64) -> Vec<DVec3> {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| DVec3::new(x, y, z)).to_vec()
}

/// The same, seen from below.
fn ceiling(x: [f64; 2], y: [f64; 2], z: f64) -> Vec<DVec3> {
    let mut corners = flat(x, y, z);
    corners.reverse();
    corners
}

fn plate(x: [f64; 2], y: [f64; 2], z: f64) -> Occluder {
    Occluder::polygon(flat(x, y, z))
}

fn block(centre: [f64; 3], half: [f64; 3]) -> Occluder {
    let halves = [DVec3::X * half[0], DVec3::Y * half[1], DVec3::Z * half[2]];
    Occluder::block(DVec3::from_array(centre), halves)
}

/// A cube as a mesh, its faces looking outwards.
fn cube(centre: DVec3, half: f64) -> Mesh {
    let corners = (0..8).map(|index| {
        let sign = |axis: usize| if index >> axis & 1 == 1 { half } else { -half };
        centre + DVec3::new(sign(0), sign(1), sign(2))
    });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::new(corners.collect(), &faces.map(|face| face.to_vec()))
}

/// The origin below a light, with the normal upwards.
fn below(light: Vec<DVec3>, occluders: Vec<Occluder>) -> Question {
    Question { light, two_sided: false, point: DVec3::ZERO, normal: DVec3::Z, occluders, shape: None }
}

/// The origin below the square of side 2 at height 2.
fn below_square(occluders: Vec<Occluder>) -> Question {
    below(ceiling([-1.0, 1.0], [-1.0, 1.0], 2.0), occluders)
}

/// A form factor that has a closed form.
fn closed(function: &str, parameters: &[f64]) -> f64 {
    let program = CLOSED_FORMS.function(function).unwrap_or_else(|e| panic!("{e}"));
    let point: Vec<Option<Value>> = parameters.iter().map(|number| Some(Value::Number(*number))).collect();
    Interpreter::<f64>::new(program).evaluate(&point).expect("nothing is fetched").values[0]
}

/// Compares a form factor, and a share of the area, in both precisions.
#[track_caller]
fn assert_is(query: &Question, fraction: f64, form_factor: f64) {
    let (wide, narrow) = (answer::<f64>(query), answer::<f32>(query));
    let [wide_share, narrow_share] = [wide, narrow].map(|answer| answer.fraction.expect("not in the plane"));
    assert!((wide_share - fraction).abs() < 1e-12, "{wide:?}");
    assert!((narrow_share - fraction).abs() < 2e-6, "{narrow:?}");
    assert!((wide.form_factor - form_factor).abs() < 1e-12, "{wide:?}");
    assert!((narrow.form_factor - form_factor).abs() < 1e-6, "{narrow:?}");
}

#[test]
fn lights_that_nothing_hides_have_their_closed_forms() {
    for [a, b] in [[1.0, 1.0], [0.5, 2.0], [8.0, 8.0]] {
        assert_is(&below(ceiling([0.0, a], [0.0, b], 1.0), vec![]), 1.0, closed("rectangle_above", &[a, b]));
    }
    for [a, b, c] in [[1.0, 1.0, 1.0], [2.0, 3.0, 0.5]] {
        let light = [[0.0, 0.0], [a, 0.0], [a, b], [0.0, b]].map(|[y, z]| DVec3::new(c, y, z));
        let light: Vec<DVec3> = light.into_iter().rev().collect();
        assert_is(&below(light, vec![]), 1.0, closed("rectangle_standing", &[a, b, c]));
    }
    assert_is(&below(vec![DVec3::Z, DVec3::Y, DVec3::X], vec![]), 1.0, 0.25);
    // Polygons of more and more corners come close to a disk.
    let regular = |corners: usize, apothem: f64, aside: f64| {
        let angle = |index: usize| 2.0 * PI * index as f64 / corners as f64;
        let radius = apothem / libm::cos(PI / corners as f64);
        let corner =
            |index: usize| DVec3::new(aside + radius * libm::cos(angle(index)), radius * libm::sin(angle(index)), 2.0);
        below((0..corners).rev().map(corner).collect(), vec![])
    };
    for (corners, form_factor) in [(3, 0.2814556943036), (4, 0.239456470460774), (6, 0.215818009285473)] {
        assert_is(&regular(corners, 1.0, 0.0), 1.0, form_factor);
    }
    let round = answer::<f64>(&regular(4000, 1.0, 0.0)).form_factor;
    assert!((round - closed("disk", &[1.0, 2.0, 0.0])).abs() < 1e-6, "{round}");
    let aside = answer::<f64>(&regular(4000, 1.0, 3.0)).form_factor;
    assert!((aside - closed("disk_aside", &[1.0, 2.0, 3.0])).abs() < 1e-6, "{aside}");
    // A strip that is long enough.
    let strip = answer::<f64>(&below(ceiling([1.0, 3.0], [-1e5, 1e5], 2.0), vec![])).form_factor;
    assert!((strip - closed("strip", &[libm::atan(0.5), libm::atan(1.5)])).abs() < 1e-9, "{strip}");
    assert!((strip - 0.192418349418943).abs() < 1e-9);
}

#[test]
fn shadows_have_the_published_numbers() {
    let quarter = 0.165978835648252;
    let rows: [(Vec<Occluder>, f64, f64); 8] = [
        (vec![], 1.0, 0.239456470460774),
        (vec![plate([-0.25, 0.25], [-0.25, 0.25], 1.0)], 0.75, quarter),
        (vec![plate([-1.0, 0.0], [-1.0, 1.0], 1.0)], 0.5, 0.119728235230387),
        (vec![plate([0.0, 1.0], [0.0, 1.0], 1.0)], 0.75, 0.17959235284558),
        (
            vec![plate([-0.25, 0.125], [-0.25, 0.25], 1.0), plate([-0.125, 0.25], [-0.125, 0.125], 1.0)],
            25.0 / 32.0,
            0.174628204946223,
        ),
        (vec![plate([-0.25, 0.25], [-0.25, 0.25], 1.0), plate([-0.125, 0.125], [-0.125, 0.125], 0.5)], 0.75, quarter),
        (vec![block([0.5, 0.0, 0.75], [0.25, 0.25, 0.75])], 7.0 / 9.0, 0.188119051570508),
        // Across the light.
        (vec![block([0.5, 0.0, 2.0], [0.25, 0.25, 0.5])], 505.0 / 576.0, 0.207812806696237),
    ];
    for (occluders, fraction, form_factor) in rows {
        assert_is(&below_square(occluders), fraction, form_factor);
    }
    let upright = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[y, z]| DVec3::new(2.0, y, z));
    let query = Question { two_sided: true, ..below(upright.to_vec(), vec![]) };
    assert_is(&query, 1.0, 0.0278553824200465);
    let share = answer::<f64>(&query).fraction_above_horizon.expect("not in the plane");
    assert!((share - 0.5).abs() < 1e-12, "{share}");
}

#[test]
fn triangular_lights_have_the_published_numbers() {
    let light = vec![DVec3::new(0.0, 0.0, 2.0), DVec3::new(0.0, 4.0, 2.0), DVec3::new(4.0, 0.0, 2.0)];
    let rows: [(&[[f64; 2]], f64, f64); 5] = [
        (&[[-1.0, -1.0], [0.5, -1.0], [0.5, 0.5], [-1.0, 0.5]], 7.0 / 8.0, 0.118093673159524),
        (&[[0.5, -1.0], [1.0, -1.0], [1.0, 0.5], [0.5, 0.5]], 7.0 / 8.0, 0.147637537828371),
        (&[[-0.5, 1.0], [1.0, -0.5], [1.5, -0.5], [-0.5, 1.5]], 13.0 / 16.0, 0.115871540026302),
        (&[[-0.5, -0.5], [1.5, -0.5], [1.5, 1.5], [-0.5, 1.5]], 1.0 / 8.0, 0.0055667652439639),
        (&[[1.5, -1.0], [1.5, 1.5], [-1.0, 1.5]], 3.0 / 16.0, 0.0397055593604861),
    ];
    for (corners, fraction, form_factor) in rows {
        let corners = corners.iter().map(|[x, y]| DVec3::new(*x, *y, 1.0)).collect();
        assert_is(&below(light.clone(), vec![Occluder::polygon(corners)]), fraction, form_factor);
    }
}

#[test]
fn random_scenes_are_as_exact_geometry_has_them() {
    let scenes: Vec<Scene> = (0..2000).map(Scene::new).collect();
    let questions: Vec<Question> = scenes.iter().map(Scene::question).collect();
    let wide = peeler::<f64>().answers(questions.iter().map(Question::query)).unwrap_or_else(|e| panic!("{e}"));
    let narrow = peeler::<f32>().answers(questions.iter().map(Question::query)).unwrap_or_else(|e| panic!("{e}"));
    let mut partly = 0;
    for (seed, scene) in scenes.iter().enumerate() {
        let polygons: Vec<Vec<exact::Whole>> = scene.occluders.iter().flatten().cloned().collect();
        let expected = exact::visible(&scene.light, scene.normal, &polygons);
        let of = |answer: &Answer| Some([answer.form_factor, answer.fraction?, answer.fraction_above_horizon?]);
        let (wide, narrow) = (of(&wide[seed]), of(&narrow[seed]));
        assert_eq!((expected.is_some(), expected.is_some()), (wide.is_some(), narrow.is_some()), "{seed}");
        let (Some(expected), Some(wide), Some(narrow)) = (expected, wide, narrow) else { continue };
        partly += usize::from(expected[1] > 0.01 && expected[1] < 0.99);
        for (index, limit) in [1e-6, 2e-6, 2e-6].into_iter().enumerate() {
            assert!((wide[index] - expected[index]).abs() < 1e-9, "{seed}: {wide:?} {expected:?}");
            assert!((narrow[index] - expected[index]).abs() < limit, "{seed}: {narrow:?} {expected:?}");
        }
    }
    assert!(partly > 800, "{partly}");
}

#[test]
fn a_point_in_or_on_a_solid_sees_what_is_before_its_faces() {
    for solid in
        [block as fn([f64; 3], [f64; 3]) -> Occluder, |at, half| Occluder::mesh(cube(DVec3::from_array(at), half[0]))]
    {
        let alone = answer::<f64>(&below_square(vec![]));
        let of = |centre: [f64; 3]| answer::<f64>(&below_square(vec![solid(centre, [0.5; 3])]));
        let inside = of([0.1, 0.2, 0.1]);
        assert_eq!((inside.fraction, inside.form_factor), (Some(0.0), 0.0));
        // On its upper face, with the solid below: nothing of the light is hidden.
        assert_eq!(of([0.1, 0.2, -0.5]).form_factor, alone.form_factor);
        // On its lower face: everything; on a face at its side: half; on an edge and a corner a quarter is left of it.
        assert_eq!(of([0.1, 0.2, 0.5]).form_factor, 0.0);
        let half = of([0.5, 0.2, 0.1]);
        assert!((half.fraction.expect("in front") - 0.5).abs() < 1e-12, "{half:?}");
        let edge = of([0.5, 0.5, 0.1]);
        assert!((edge.fraction.expect("in front") - 0.75).abs() < 1e-12, "{edge:?}");
        let corner = of([0.5, 0.5, 0.5]);
        assert!((corner.fraction.expect("in front") - 0.75).abs() < 1e-12, "{corner:?}");
    }
}

#[test]
fn what_lies_behind_or_beyond_hides_nothing() {
    let alone = answer::<f64>(&below_square(vec![]));
    let square = [-0.5, 0.5];
    let idle = [
        plate(square, square, -1.0),
        plate(square, square, 3.0),
        plate(square, square, 2.0),
        plate(square, square, 0.0),
        block([0.0, 0.0, 4.0], [0.5; 3]),
        block([0.0, 0.0, -1.0], [0.5; 3]),
        // Edge-on, of no area, and with too few corners.
        Occluder::polygon(vec![DVec3::new(0.0, -1.0, 1.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, 0.0, 1.5)]),
        Occluder::polygon(vec![DVec3::new(0.1, 0.0, 1.0); 4]),
        Occluder::polygon(vec![DVec3::new(0.1, 0.0, 1.0), DVec3::new(0.2, 0.0, 1.0)]),
        Occluder::polygon(vec![]),
        block([0.2, 0.0, 1.0], [0.0, 0.3, 0.0]),
        Occluder::mesh(Mesh::new(vec![], &[])),
    ];
    for occluder in idle {
        let found = answer::<f64>(&below_square(vec![occluder.clone()]));
        assert_eq!((found.form_factor, found.fraction), (alone.form_factor, alone.fraction), "{occluder:?}");
    }
    let flat = answer::<f64>(&below_square(vec![block([0.0, 0.0, 1.0], [0.25, 0.25, 0.0])]));
    assert!((flat.fraction.expect("in front") - 0.75).abs() < 1e-12);
}

#[test]
fn lights_seen_from_behind_or_edge_on_send_nothing() {
    let behind = below(flat([-1.0, 1.0], [-1.0, 1.0], 2.0), vec![plate([-0.25, 0.25], [-0.25, 0.25], 1.0)]);
    let found = answer::<f64>(&behind);
    assert_eq!((found.form_factor, found.fraction), (0.0, Some(0.75)));
    let both = answer::<f64>(&Question { two_sided: true, ..behind });
    assert!((both.form_factor - 0.165978835648252).abs() < 1e-12);
    for light in [
        flat([1.0, 2.0], [1.0, 2.0], 0.0),
        vec![DVec3::Z; 4],
        vec![DVec3::Z, DVec3::X + DVec3::Z, DVec3::X * 2.0 + DVec3::Z],
    ] {
        let found = answer::<f64>(&Question { two_sided: true, ..below(light, vec![]) });
        assert_eq!((found.form_factor, found.fraction), (0.0, None));
    }
}

#[test]
fn a_mesh_is_as_its_faces_whether_it_is_convex_or_not() {
    let mut random = Random::new(3);
    for _ in 0..300 {
        let mut unit = || 2.0 * random.unit() - 1.0;
        let centre = DVec3::new(1.5 * unit(), 1.5 * unit(), 1.2 + unit());
        let half = 0.1 + 0.3 * unit().abs();
        if centre.abs().max_element() <= half {
            continue;
        }
        let of = |occluders| answer::<f64>(&below_square(occluders)).form_factor;
        let convex = of(vec![Occluder::mesh(cube(centre, half))]);
        let exact = of(vec![block(centre.to_array(), [half; 3])]);
        // A cube with a dent that its own faces hide from everywhere is not convex.
        let mesh = cube(centre, half);
        assert!(mesh.is_convex());
        let (corners, faces) = (mesh.corners().to_vec(), mesh.faces().to_vec());
        let open = Mesh::new(
            corners.clone(),
            &faces[..5].iter().cloned().chain([faces[5].clone(), faces[0].clone()]).collect::<Vec<_>>(),
        );
        assert!(!open.is_closed());
        let triangles: Vec<Vec<usize>> =
            faces.iter().flat_map(|face| [vec![face[0], face[1], face[2]], vec![face[0], face[2], face[3]]]).collect();
        let cut = Mesh::new(corners, &triangles);
        assert!(cut.is_convex());
        for other in [convex, of(vec![Occluder::mesh(open)]), of(vec![Occluder::mesh(cut)])] {
            assert!((other - exact).abs() < 1e-12, "{centre} {half}: {other} {exact}");
        }
    }
}

#[test]
fn a_hollow_that_is_no_part_of_a_mesh_lets_light_through() {
    // An L of three cubes, as a prism: its outline is not convex.
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let corners: Vec<DVec3> =
        [0.9, 1.1].iter().flat_map(|z| outline.map(|[x, y]| DVec3::new(0.3 * x - 0.3, 0.3 * y - 0.3, *z))).collect();
    let mut faces: Vec<Vec<usize>> = vec![(0..6).rev().collect(), (6..12).collect()];
    faces.extend((0..6).map(|side| vec![side, (side + 1) % 6, 6 + (side + 1) % 6, 6 + side]));
    let mesh = Mesh::new(corners, &faces);
    assert!(mesh.is_closed() && !mesh.is_convex());
    let parts = |x: f64, y: f64| block([0.3 * x - 0.15, 0.3 * y - 0.15, 1.0], [0.15, 0.15, 0.1]);
    let cubes = vec![parts(0.0, 0.0), parts(1.0, 0.0), parts(0.0, 1.0)];
    let (whole, cut) =
        (answer::<f64>(&below_square(vec![Occluder::mesh(mesh.clone())])), answer::<f64>(&below_square(cubes)));
    assert!((whole.form_factor - cut.form_factor).abs() < 1e-12, "{whole:?} {cut:?}");
    let inside = Question { point: DVec3::new(-0.1, -0.1, 1.0), ..below_square(vec![Occluder::mesh(mesh.clone())]) };
    assert_eq!(answer::<f64>(&inside).fraction, Some(0.0));
    let outside = Question { point: DVec3::new(0.2, 0.2, 1.0), ..below_square(vec![Occluder::mesh(mesh)]) };
    assert!(answer::<f64>(&outside).fraction > Some(0.9));
}

#[test]
fn shaped_light_is_the_integral_of_the_transformed_cosine() {
    let inverse = [[1.3, 0.0, 0.4], [0.0, 0.9, 0.0], [-0.35, 0.0, 0.8]];
    let shape = Shape { view: DVec3::new(0.6, 0.1, 0.5), inverse };
    let light = vec![
        DVec3::new(-0.5, 2.0, 0.3),
        DVec3::new(1.5, 2.0, 0.2),
        DVec3::new(1.2, 1.8, 1.6),
        DVec3::new(-0.6, 1.9, 1.4),
    ];
    let hides = plate([0.0, 0.6], [0.5, 1.2], 0.5);
    let query = Question { two_sided: true, shape: Some(shape), ..below(light, vec![hides]) };
    // Directions over the sphere, each with the density that the transform gives it.
    let first = DVec3::new(0.6, 0.1, 0.0).normalize();
    let frame = [first, DVec3::Z.cross(first), DVec3::Z];
    let matrix = glam::DMat3::from_cols_array_2d(&inverse).transpose();
    let inverse = matrix.determinant();
    let hidden = |w: DVec3| {
        let at = w * (0.5 / w.z);
        (0.0..=0.6).contains(&at.x) && (0.5..=1.2).contains(&at.y)
    };
    let mut corners = query.light.clone();
    if corners[0].dot((corners[1] - corners[0]).cross(corners[2] - corners[0])) > 0.0 {
        corners.reverse();
    }
    let (steps, mut sums) = (1500, [0.0; 2]);
    for i in 0..steps {
        for j in 0..2 * steps {
            let z = (f64::from(i) + 0.5) / f64::from(steps);
            let around = PI * (f64::from(j) + 0.5) / f64::from(steps);
            let across = (1.0 - z * z).sqrt();
            let w = DVec3::new(across * libm::cos(around), across * libm::sin(around), z);
            let next = |index: usize| corners[(index + 1) % corners.len()];
            if !(0..corners.len()).all(|index| next(index).cross(corners[index]).dot(w) >= 0.0) {
                continue;
            }
            let turned = matrix * DVec3::from_array(frame.map(|axis| axis.dot(w)));
            let length = turned.length();
            let density = (turned.z / length).max(0.0) / PI * inverse / (length * length * length);
            let part = density * PI / (f64::from(steps) * f64::from(steps));
            sums[1] += part;
            sums[0] += if hidden(w) { 0.0 } else { part };
        }
    }
    let Some((with, without)) = answer::<f64>(&query).shaped else { panic!("it was asked for") };
    assert!((with - sums[0]).abs() < 3e-4 && (without - sums[1]).abs() < 3e-4, "{with} {without} {sums:?}");
    assert!(with > 0.02 && without > with + 0.01, "{with} {without}");
    let straight = Shape { view: DVec3::Z, inverse: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] };
    let found = answer::<f64>(&Question { shape: Some(straight), ..query });
    let (with, without) = found.shaped.expect("it was asked for");
    assert!((with - found.form_factor).abs() < 1e-15 && (without - found.form_factor_unshadowed).abs() < 1e-15);
}

#[test]
fn thousands_of_occluders_at_one_point_are_counted_as_an_overflow_and_stay_exact() {
    // A grid of plates that abut, over the left half of the light; its lines are no binary fractions.
    let count = 100;
    let cell = |index: usize| -0.5 + 0.5 * index as f64 / count as f64;
    let row = |index: usize| -0.5 + index as f64 / count as f64;
    let plates = (0..count).flat_map(|x| (0..count).map(move |y| (x, y)));
    let plates: Vec<Occluder> = plates.map(|(x, y)| plate([cell(x), cell(x + 1)], [row(y), row(y + 1)], 1.0)).collect();
    let query = below_square(plates);
    let wide = answer::<f64>(&query);
    assert!((wide.fraction.expect("in front") - 0.5).abs() < 1e-12, "{wide:?}");
    assert!((wide.form_factor - 0.119728235230387).abs() < 1e-12, "{wide:?}");
    assert!(wide.work.overflow);
    // The rounding of each of twenty thousand pieces adds up.
    let narrow = answer::<f32>(&query);
    assert!((narrow.form_factor - 0.119728235230387).abs() < 1e-5, "{narrow:?}");
}

#[test]
fn small_and_distant_lights_keep_their_digits_in_f32() {
    for distance in [10.0, 1e2, 1e3, 1e4] {
        let query = below(ceiling([-1.0, 1.0], [-1.0, 1.0], distance), vec![]);
        let (wide, narrow) = (answer::<f64>(&query).form_factor, answer::<f32>(&query).form_factor);
        assert!((narrow / wide - 1.0).abs() < 1e-4, "{distance}: {narrow} {wide}");
    }
}
