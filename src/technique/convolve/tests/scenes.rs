//! Whole scenes: matter by the length of the way, lights that add up, and what is refused.

use std::path::Path;

use super::super::settings as set;
use super::super::{CONVOLVE, OPACITY, REFERENCE};
use crate::diag::{Failure, Source};
use crate::scene::Scene;
use crate::technique::rendered::LIGHT;
use crate::technique::setting::Value;
use crate::technique::{Executor, Frame, Rendered, Settings, Technique};

pub(super) const LAMP: &str = "Gaussian(tilts: (0, 0), deviations: (0.3, 0.3))";

pub(super) fn scene(lights: &str, objects: &str) -> Scene {
    scene_from("(0, 9, 0)", lights, objects)
}

fn scene_from(eye: &str, lights: &str, objects: &str) -> Scene {
    let text = format!(
        "Scene(camera: (eye: {eye}, target: (0, 0, 0), angle: 30), lights: [{lights}], ambient: 0, \
         background: (0, 0, 0), objects: [{objects}])"
    );
    Scene::parse("scene", &Source::new("scene.ron", text), Path::new("")).unwrap_or_else(|failure| panic!("{failure}"))
}

pub(super) fn tried(scene: &Scene, technique: &dyn Technique, settings: Settings) -> Result<Rendered, Failure> {
    let frame = Frame::new(scene, (48, 40), &Executor::Cpu).with(settings);
    frame.prepare(technique)?.render(&|_| {})
}

pub(super) fn rendered(scene: &Scene, settings: Settings) -> Rendered {
    tried(scene, &CONVOLVE, settings).unwrap_or_else(|failure| panic!("{failure}"))
}

pub(super) fn slabs(count: u32) -> Settings {
    Settings::default().with(&set::SLABS, Value::Whole(count))
}

const CLOUD: &str = "(shape: Ball(radius: 1), matter: (opacity: 0.4, length: 0.5))";

/// Opacity follows the length of the way through the tessellated ball, whatever the number of slabs.
#[test]
fn exact_coverage_does_not_depend_on_the_slabs() {
    let scene = scene(LAMP, CLOUD);
    let exact = |count| slabs(count).with(&set::COVERAGE, Value::Word("exact"));
    let pictures =
        [1, 7, 40, 333].map(|count| rendered(&scene, exact(count)).numbers(OPACITY).expect("a layer").to_vec());
    for picture in &pictures[1..] {
        for (a, b) in picture.iter().zip(&pictures[0]) {
            assert!((a - b).abs() < 2e-6, "{a} {b}");
        }
    }
    let scale = 20.0 / (15.0_f64.to_radians().tan() * 9.0);
    for (index, got) in pictures[2].iter().enumerate() {
        let (x, y) = ((index % 48) as f64 + 0.5 - 24.0, (index / 48) as f64 + 0.5 - 20.0);
        let chord = 2.0 * (1.0 - (x * x + y * y) / (scale * scale)).max(0.0).sqrt();
        let expected = 1.0 - 0.6_f64.powf(chord / 0.5);
        // The ball has 96 sides around and 48 from pole to pole, so its radius is that much smaller in places.
        let shorter = 2.0 * (2.0 - 2.0 * (std::f64::consts::PI / 96.0).cos()) / (0.5 * chord);
        let allowed = 1e-5 + (1.0 - expected) * -2.0 * 0.6_f64.ln() * shorter;
        if chord > 0.5 || chord == 0.0 && (x * x + y * y) > 1.01 * scale * scale {
            assert!((f64::from(*got) - expected).abs() < allowed, "{x} {y}: {got} {expected}");
        }
    }
    let full = |count| rendered(&scene, slabs(count)).numbers(OPACITY).expect("a layer").iter().sum::<f32>();
    assert!(
        (full(7) / full(333) - 1.0).abs() > 0.01,
        "a whole slab at every surface is more the thicker the slabs are"
    );
}

#[test]
fn lights_add_up() {
    let objects = "(shape: Block(size: (9, 0.2, 9))), (shape: Ball(radius: 0.5), at: (0, 0.7, 0))";
    let one = "Gaussian(tilts: (30, 0), deviations: (0.4, 0.2), rotation: 20, colour: (0.5, 0.25, 0))";
    let other = "Gaussian(tilts: (-10, 20), deviations: (0, 0), colour: (0.125, 0.25, 0.5))";
    let wide = slabs(40).with(&set::PRECISION, Value::Word("f64"));
    let light =
        |lights: &str| rendered(&scene(lights, objects), wide.clone()).colours(LIGHT).expect("a layer").to_vec();
    let (both, first, second, twice) =
        (light(&format!("{one}, {other}")), light(one), light(other), light(&format!("{one}, {one}")));
    for pixel in 0..both.len() {
        for channel in 0..3 {
            assert!((both[pixel][channel] - first[pixel][channel] - second[pixel][channel]).abs() < 1e-6);
            assert!((twice[pixel][channel] - 2.0 * first[pixel][channel]).abs() < 1e-6);
        }
    }
}

#[test]
fn one_slab_casts_no_shadow_and_an_empty_picture_is_background() {
    let objects = "(shape: Block(size: (9, 0.2, 9)), colour: (0.5, 0.25, 1)), (shape: Ball(radius: 0.5), at: (0, 0.7, 0), colour: (0.5, 0.25, 1))";
    let picture = rendered(&scene(LAMP, objects), slabs(1));
    assert!(picture.colours(LIGHT).expect("a layer").iter().all(|pixel| *pixel == [0.5, 0.25, 1.0]));
    let away = rendered(&scene(LAMP, "(shape: Ball(radius: 0.5), at: (90, 0, 0))"), slabs(40));
    assert!(away.colours(LIGHT).expect("a layer").iter().all(|pixel| *pixel == [0.0; 3]));
}

/// Sixteen steps through the empty slabs between two blocks are the same blur as one for each of 200.
#[test]
fn empty_slabs_are_skipped() {
    let scene = scene(LAMP, "(shape: Block(size: (9, 0.2, 9))), (shape: Block(size: (1, 0.1, 1)), at: (0, 1.5, 0))");
    let light = |skip| {
        let picture = rendered(&scene, slabs(200).with(&set::SKIP, Value::Whole(skip)));
        picture.colours(LIGHT).expect("a layer").to_vec()
    };
    let (every, fewer) = (light(0), light(16));
    let differences = every.iter().zip(&fewer).map(|(a, b)| f64::from((a[0] - b[0]).abs()));
    let worst = differences.fold(0.0, f64::max);
    assert!(worst > 0.0 && worst < 0.02, "{worst}");
}

/// A light that is a line blurs along it, and across it not at all.
#[test]
fn a_line_of_light_blurs_along_itself() {
    let line = "Gaussian(tilts: (0, 0), deviations: (0, 0.8), rotation: 70)";
    let scene = scene(
        line,
        "(shape: Block(size: (9, 0.2, 9))), (shape: Block(size: (0.6, 0.1, 0.6)), at: (0, 1.5, 0), turn: (0, -70, 0))",
    );
    let difference = |technique: &dyn Technique| {
        let picture = tried(&scene, technique, slabs(64)).unwrap_or_else(|failure| panic!("{failure}"));
        let light = picture.colours(LIGHT).expect("a layer").to_vec();
        // Shadow along the line, beside the block that hides its middle, and across the line.
        let (s, c) = 70.0_f64.to_radians().sin_cos();
        let at = |along: f64, across: f64| {
            let (x, y) = (24.0 + 9.0 * (-s * along + c * across), 20.0 - 9.0 * (-c * along - s * across));
            light[y as usize * 48 + x as usize][0]
        };
        [at(0.75, 0.0), at(-0.75, 0.0), at(0.0, 0.9), at(0.0, -0.9)]
    };
    let (iterated, truth) = (difference(&CONVOLVE), difference(&REFERENCE));
    for values in [iterated, truth] {
        let [a, b, c, d] = values;
        let (along, across) = (a.max(b), c.min(d));
        assert!(along < 0.7 && across > 0.72, "{iterated:?} {truth:?}");
    }
}

/// At three times the distance at which penumbras are right, parts of a light are nearer to the truth than the whole.
#[test]
fn the_reference_is_what_splitting_leads_to() {
    let scene = scene(LAMP, "(shape: Block(size: (9, 0.2, 9))), (shape: Block(size: (1, 0.1, 1)), at: (0, 1.5, 0))");
    let truth = tried(&scene, &REFERENCE, slabs(64)).unwrap_or_else(|failure| panic!("{failure}"));
    let truth = truth.colours(LIGHT).expect("a layer");
    let error = |split: u32, rho: f64| {
        let settings = slabs(64).with(&set::SPLIT, Value::Whole(split)).with(&set::RHO, Value::Number(rho));
        let picture = rendered(&scene, settings.with(&set::DISTANCE, Value::Number(0.4)));
        let pixels = picture.colours(LIGHT).expect("a layer").iter().zip(truth);
        (pixels.map(|(a, b)| f64::from(a[0] - b[0]).powi(2)).sum::<f64>() / truth.len() as f64).sqrt()
    };
    let (one, many) = (error(1, 1.0), error(16, 0.15));
    assert!(many < 0.5 * one && one > 0.01, "{one} {many}");
}

#[test]
fn what_cannot_be_is_refused() {
    let ball = "(shape: Ball(radius: 0.5))";
    let said = |lights: &str, objects: &str, settings: Settings| {
        tried(&scene(lights, objects), &CONVOLVE, settings).expect_err("refused").to_string()
    };
    let beside = tried(&scene_from("(9, 0.5, 0)", LAMP, ball), &CONVOLVE, slabs(4)).expect_err("refused").to_string();
    assert!(beside.contains("light 1 is tilted more than 80 degrees from the view axis"), "{beside}");
    let open = said(LAMP, "(shape: Ground(size: (3, 3)))", slabs(4).with(&set::ODD, Value::Word("error")));
    assert!(open.contains("a surface is entered and never left"), "{open}");
    let two = said(LAMP, ball, slabs(4).with(&set::SPLIT, Value::Whole(2)));
    assert!(two.contains("cannot be split into two"), "{two}");
}

/// Matter in thin shells of noise: sampled and integrated it comes to the same with many slabs; with few, integrated matter
/// is nearer to that, as it does not miss shells between two places.
#[test]
fn details_are_sampled_or_integrated() {
    let ball = "(shape: Ball(radius: 1.2), matter: (opacity: 0.5, length: 0.002), detail: Fbm(size: 1, octaves: 1), \
                transfer: [(value: 0, opacity: 0), (value: 0.05, opacity: 0.02), (value: 0.1, opacity: 0)])";
    let scene = scene(LAMP, ball);
    let exact = |count| slabs(count).with(&set::COVERAGE, Value::Word("exact"));
    let opacity = |settings: Settings| rendered(&scene, settings).numbers(OPACITY).expect("a layer").to_vec();
    let integrated = |count| exact(count).with(&set::DETAIL, Value::Word("integrated"));
    let rms = |a: &[f32], b: &[f32]| {
        (a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
    };
    let fine = opacity(integrated(96));
    let alike = rms(&opacity(exact(96)), &fine);
    let [sampled, integrated] = [exact(12), integrated(12)].map(|settings| rms(&opacity(settings), &fine));
    assert!(alike < 0.01 && integrated < 0.9 * sampled && sampled > 0.05, "{alike} {integrated} {sampled}");
}

/// Facets reflect most where the normal is halfway between light and viewer, and nothing from behind.
#[test]
fn facets_shine() {
    let lamp = "Gaussian(tilts: (-40, 0), deviations: (0.01, 0.01), colour: (1, 1, 1))";
    let ball = |shine: &str| format!("(shape: Ball(radius: 1.2), colour: (0.1, 0.1, 0.1){shine})");
    let light = |shine: &str| rendered(&scene(lamp, &ball(shine)), slabs(40)).colours(LIGHT).expect("a layer").to_vec();
    let (plain, shiny) = (light(""), light(", shine: (exponent: 50, reflectance: 0.5)"));
    let brightest = (0..plain.len()).max_by(|a, b| shiny[*a][0].total_cmp(&shiny[*b][0])).expect("pixels");
    assert!(plain.iter().zip(&shiny).all(|(plain, shiny)| shiny[0] >= plain[0]));
    // The normal is tilted by 20 degrees there, and a unit is 8.3 pixels.
    let (x, y) = ((brightest % 48) as f64 + 0.5 - 24.0, (brightest / 48) as f64 + 0.5 - 20.0);
    let expected = 1.2 * 20.0_f64.to_radians().sin() * 20.0 / (15.0_f64.to_radians().tan() * 9.0);
    assert!((x.hypot(y) - expected).abs() < 1.5 && y.abs() < 1.5, "{x} {y} {expected}");
    assert!(shiny[brightest][0] > 1.0, "{}", shiny[brightest][0]);
}
