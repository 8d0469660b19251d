//! Convolution shadows on an adapter and on the CPU: the same surfaces at every pixel, and the same light. Where matter
//! fills whole slabs that is so to the last bit.

use std::path::Path;
use std::sync::Arc;

use umbrage::diag::Source;
use umbrage::scene::Scene;
use umbrage::technique::convolve::{CONVOLVE, CROSSINGS, ODD_LISTS, OPACITY};
use umbrage::technique::rendered::LIGHT;
use umbrage::technique::{self, Executor, Frame, Rendered};

const SIZE: (u32, u32) = (72, 56);
const SCENES: [&str; 4] = ["disk", "poles", "tilt", "boxes"];

/// Pictures with several settings each, made by one technique that goes on from frame to frame.
fn pictures(scene: &Scene, on: &Executor, size: (u32, u32), settings: &[&str]) -> Vec<Rendered> {
    let frame = Frame::new(scene, size, on);
    let mut prepared = None;
    let picture = |settings: &&str| {
        let settings = technique::read_settings(&[&CONVOLVE], settings.split_whitespace()).unwrap();
        let frame = frame.with(settings);
        let ready = match &mut prepared {
            None => prepared.insert(frame.prepare(&CONVOLVE).unwrap_or_else(|error| panic!("{error}"))),
            Some(ready) => {
                ready.set_frame(&frame).unwrap_or_else(|error| panic!("{error}"));
                ready
            }
        };
        ready.render(&|_| {}).unwrap_or_else(|error| panic!("{error}"))
    };
    settings.iter().map(picture).collect()
}

fn rendered(scene: &Scene, on: &Executor, size: (u32, u32), settings: &str) -> Rendered {
    pictures(scene, on, size, &[settings]).remove(0)
}

/// The differences between the CPU and an adapter with each of some settings.
fn differences(scene: &Scene, on_adapter: &Executor, settings: &[&str]) -> Vec<f32> {
    let [expected, found] = [&Executor::Cpu, on_adapter].map(|on| pictures(scene, on, SIZE, settings));
    let named = settings.iter().map(|settings| format!("{} {settings}", scene.name));
    expected.iter().zip(&found).zip(named).map(|((expected, found), what)| apart(expected, found, &what)).collect()
}

fn adapter() -> Option<Executor> {
    crate::support::adapter().map(|gpu| Executor::Gpu(Arc::new(gpu)))
}

/// The largest difference of light or opacity; surfaces have to be the same.
fn apart(expected: &Rendered, found: &Rendered, what: &str) -> f32 {
    for layer in [CROSSINGS, ODD_LISTS] {
        assert_eq!(expected.counts(layer).unwrap(), found.counts(layer).unwrap(), "{what}: {layer}");
    }
    let opacities = expected.numbers(OPACITY).unwrap().iter().zip(found.numbers(OPACITY).unwrap());
    let opacity = opacities.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    let colours = expected.colours(LIGHT).unwrap().iter().zip(found.colours(LIGHT).unwrap());
    let apart = |a: &[f32; 3], b: &[f32; 3]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    colours.map(|(a, b)| apart(a, b)).fold(opacity, f32::max)
}

#[test]
fn adapters_sweep_as_the_cpu_does() {
    let Some(on_adapter) = adapter() else { return };
    // Every kernel, phase, policy, projection and way to split, each in some scene; the scenes themselves first.
    let settings = [
        "slabs=48",
        "slabs=48 kernel=ring_arc samples=2 smear=none phase=random seed=3 rule=winding",
        "slabs=32 kernel=poisson8 border=clamp phase=steady",
        "slabs=32 kernel=poisson16 smear=subtract hit=last skip=0",
        "slabs=24 kernel=gauss19x19",
        "slabs=40 kernel=frac_box rule=winding",
        "slabs=40 kernel=binomial3 border=clamp",
        "slabs=40 smear=stride split=5 rho=0.2",
        "slabs=40 smear=snap odd=close_at_end",
        "slabs=24 phase=pixel",
        "slabs=32 split=3 frames=4",
    ];
    for name in SCENES {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
        for (settings, apart) in settings.iter().zip(differences(&scene, &on_adapter, &settings)) {
            assert_eq!(apart, 0.0, "{name} {settings}");
        }
    }
}

/// Perspective reads between pixels of another size, in the same operations on both.
#[test]
fn perspective_is_the_same() {
    let Some(on_adapter) = adapter() else { return };
    for name in SCENES {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
        let settings = ["world", "follow"].map(|light| format!("slabs=32 projection=perspective_{light}"));
        let settings = settings.each_ref().map(String::as_str);
        assert_eq!(differences(&scene, &on_adapter, &settings), [0.0; 2], "{name}");
    }
}

/// The opacity of a part of a slab is a power: every adapter has its own exponential, and lengths of parts are differences
/// of depths in single precision there. So here opacities are a few roundings apart, and so is light; and where slopes
/// and facets are taken into account, by roots and powers.
#[test]
fn parts_of_slabs_are_nearly_the_same() {
    let Some(on_adapter) = adapter() else { return };
    let cloud = "(shape: Ball(radius: 1), matter: (opacity: 0.6, length: 0.5, transport: (0.5, 0.2, 0)), colour: (1, 0.9, 0.8), shine: (exponent: 20, reflectance: 0.3))";
    let clouds = scene(&format!("{cloud}, (shape: Block(size: (9, 0.2, 9)), at: (0, -2, 0))"), 9.0, 30.0, (0.3, 0.3));
    let scenes = SCENES.iter().map(|name| Scene::open(name).unwrap_or_else(|error| panic!("{error}")));
    let bricks = Scene::open("clouds").unwrap_or_else(|error| panic!("{error}"));
    for scene in scenes.chain([clouds, bricks]) {
        let settings = [
            "slabs=48 coverage=exact",
            "slabs=9 coverage=exact rule=winding",
            "slabs=48 slopes=compensate",
            "slabs=24 rule=winding detail=integrated",
        ];
        for (settings, apart) in settings.iter().zip(differences(&scene, &on_adapter, &settings)) {
            assert!(apart < 4e-6, "{} {settings}: {apart}", scene.name);
        }
    }
}

/// A scene from straight above under one white light.
fn scene(objects: &str, height: f64, angle: f64, deviations: (f64, f64)) -> Scene {
    let text = format!(
        "Scene(camera: (eye: (0, {height}, 0), target: (0, 0, 0), angle: {angle}), ambient: 0, background: (0, 0, 0), \
         lights: [Gaussian(tilts: (0, 0), deviations: {deviations:?}, colour: (1, 1, 1))], objects: [{objects}])"
    );
    Scene::parse("scene", &Source::new("scene.ron", text), Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

/// Pixels of a unit of length in the scenes below.
const PIXELS: f64 = 4.0;

/// Opaque blocks in slabs one unit thick: each left of a pixel from the middle, from a depth to another one; and a white
/// floor from the last slab's first quarter to its end.
fn blocks(blocks: &[(i32, f64, f64)], slabs: u32) -> Scene {
    // In the picture x goes the other way.
    let block = |(left_of, front, back): &(i32, f64, f64)| {
        let (edge, far) = (-f64::from(*left_of) / PIXELS, 40.0);
        format!(
            "(shape: Block(size: ({far}, {}, 80)), at: ({}, {}, 0), colour: (1, 1, 1)), ",
            back - front,
            edge + 0.5 * far,
            -back
        )
    };
    let objects: String = blocks.iter().map(block).collect();
    let floor = format!("(shape: Block(size: (80, 0.75, 80)), at: (0, -{slabs}, 0), colour: (1, 1, 1))");
    let angle = 2.0 * (0.5 * f64::from(SIZE.1) / (100.0 * PIXELS)).atan().to_degrees();
    scene(&(objects + &floor), 100.0, angle, (0.3, 0.3))
}

/// Light at pixels of the middle row, counted from the middle.
fn light(scene: &Scene, on: &Executor, slabs: u32, more: &str, pixels: &[i32]) -> Vec<f32> {
    let settings = format!("slabs={slabs} skip=0 kernel=binomial3 {more}");
    let rendered = rendered(scene, on, SIZE, &settings);
    let row = &rendered.colours(LIGHT).unwrap()[(SIZE.1 / 2 * SIZE.0) as usize..];
    pixels.iter().map(|pixel| row[(SIZE.0 as i32 / 2 + pixel) as usize][0]).collect()
}

/// Integer kernels with dyadic weights: no tolerance.
#[test]
fn binomials_are_exact() {
    let on: Vec<Executor> = std::iter::once(Executor::Cpu).chain(adapter()).collect();
    for on in &on {
        // A half plane in the first slab, which covers the pixels before 0.
        for (n, over, expected) in
            [(1, 4.0, [1.0, 0.0, 0.0]), (2, 16.0, [5.0, 1.0, 0.0]), (4, 256.0, [93.0, 37.0, 9.0])]
        {
            let found = light(&blocks(&[(0, 0.0, 0.5)], n + 1), on, n + 1, "", &[0, 1, 2]);
            assert_eq!(found, expected.map(|shadow| 1.0 - shadow / over), "slab {n}");
        }
        // A wall along the view.
        for (n, expected) in [(1, 3.0 / 4.0), (2, 5.0 / 8.0), (3, 35.0 / 64.0), (4, 63.0 / 128.0)] {
            let found = light(&blocks(&[(0, 0.0, f64::from(n) - 0.5)], n + 1), on, n + 1, "", &[0]);
            assert_eq!(found, [expected], "slab {n}");
        }
        // A slope, a pixel farther in every second slab: between them 1, 4, 6, 4, 1 over 16.
        let steps = [1.0, 15.0 / 16.0, 59.0 / 64.0, 1877.0 / 2048.0, 14981.0 / 16384.0];
        for (n, expected) in (0_u32..).zip(steps).skip(1) {
            let stairs: Vec<_> = (0..n).map(|i| (i as i32, f64::from(2 * i), f64::from(2 * i) + 0.5)).collect();
            let found = light(&blocks(&stairs, 2 * n + 1), on, 2 * n + 1, "", &[n as i32]);
            assert_eq!(found, [expected], "step {n}");
        }
    }
}

/// A light from the side moves an edge by whole pixels, as many in every slab.
#[test]
fn a_whole_tilt_moves_an_edge_exactly() {
    let on: Vec<Executor> = std::iter::once(Executor::Cpu).chain(adapter()).collect();
    let tilt = (3.0 / PIXELS).atan().to_degrees();
    for on in &on {
        for n in 1..6 {
            let scene = blocks(&[(0, 0.0, 0.5)], n + 1);
            // Light comes from the left of the picture: shadows move to the right.
            let mut tilted = scene.clone();
            let text = format!("Gaussian(tilts: ({tilt}, 0), deviations: (0, 0), colour: (1, 1, 1))");
            tilted.lights = lights(&text);
            let pixels: Vec<i32> = (0..24).collect();
            let found = light(&tilted, on, n + 1, "smear=snap", &pixels);
            let expected: Vec<f32> = pixels.iter().map(|x| if *x < 3 * n as i32 { 0.0 } else { 1.0 }).collect();
            assert_eq!(found, expected, "slab {n}");
        }
    }
}

/// The lights of a scene with such a light.
fn lights(light: &str) -> Vec<umbrage::scene::light::Light> {
    let text = format!(
        "Scene(camera: (eye: (0, 9, 0), target: (0, 0, 0)), lights: [{light}], objects: [(shape: Ball(radius: 1))])"
    );
    let scene = Scene::parse("light", &Source::new("light.ron", text), Path::new(""));
    scene.unwrap_or_else(|error| panic!("{error}")).lights
}
