//! The search on an adapter and on the CPU: the same configurations, and values that differ by rounding.

use std::sync::Arc;

use umbrage::scene::Scene;
use umbrage::technique::area::search::{BOUNDARY_RAYS, COHERENCE, CONFIGURATION, DISCONTINUITY, FRACTION, TESTS};
use umbrage::technique::rendered::LIGHT;
use umbrage::technique::setting::{SEED, Value};
use umbrage::technique::{Executor, Frame, Rendered, Settings};

const SIZE: (u32, u32) = (96, 54);

fn rendered(scene: &Scene, on: &Executor, points: u32, coherence: &'static str) -> Rendered {
    let mut frame = Frame::new(scene, SIZE, on);
    frame.settings = Settings::default()
        .with(&BOUNDARY_RAYS, Value::Whole(points))
        .with(&COHERENCE, Value::Word(coherence))
        .with(&SEED, Value::Whole(3));
    let mut prepared = frame.prepare(&DISCONTINUITY).unwrap_or_else(|error| panic!("{error}"));
    prepared.render(&|_| {}).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn adapters_search_as_the_cpu_does() {
    let Some(gpu) = crate::support::adapter() else { return };
    let on_adapter = Executor::Gpu(Arc::new(gpu));
    // Past flat things hardly a test goes the other way. A ray that grazes a ball or a cone from a place on it meets it or
    // does not by the last bits of a number.
    for (name, points, coherence, share) in [
        ("trio", 0, "checkerboard", 0.01),
        ("trio", 3, "checkerboard", 0.01),
        ("hexagon", 3, "checkerboard", 0.015),
        ("opening", 0, "none", 0.001),
        ("opening", 5, "checkerboard", 0.001),
        ("skittles", 1, "checkerboard", 0.015),
        ("columns", 3, "none", 0.002),
    ] {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
        let expected = rendered(&scene, &Executor::Cpu, points, coherence);
        let found = rendered(&scene, &on_adapter, points, coherence);
        let counts = |rendered: &Rendered, layer| rendered.counts(layer).unwrap().to_vec();
        let (a, b) = (counts(&expected, CONFIGURATION), counts(&found, CONFIGURATION));
        let (tests_a, tests_b) = (counts(&expected, TESTS), counts(&found, TESTS));
        let fraction = |rendered: &Rendered| rendered.numbers(FRACTION).unwrap().to_vec();
        let (fraction_a, fraction_b) = (fraction(&expected), fraction(&found));
        let light = |rendered: &Rendered| rendered.colours(LIGHT).unwrap().to_vec();
        let (light_a, light_b) = (light(&expected), light(&found));
        let brightest = light_a.iter().flatten().copied().fold(0.0, f32::max);
        let mut other = 0;
        for pixel in 0..a.len() {
            // A test that falls within rounding of a border goes either way, and then so does what follows from it.
            if a[pixel] != b[pixel] || tests_a[pixel] != tests_b[pixel] {
                other += 1;
                continue;
            }
            let apart = (fraction_a[pixel] - fraction_b[pixel]).abs();
            let dimmer = light_a[pixel].iter().zip(&light_b[pixel]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            if apart > 2e-5 || dimmer > 2e-5 * brightest {
                other += 1;
            }
        }
        let found = other as f64 / a.len() as f64;
        assert!(found <= share, "{name} {points} {coherence}: {other} of {} pixels differ", a.len());
    }
}
