//! Peeling on an adapter and on the CPU: the same light at every pixel, also where the shader's memory does not do.

use std::sync::Arc;

use umbrage::scene::Scene;
use umbrage::scene::light::{Light, LightKind};
use umbrage::technique::area::{OVERFLOW, PEEL};
use umbrage::technique::rendered::LIGHT;
use umbrage::technique::{Executor, Frame, Rendered};

const SIZE: (u32, u32) = (64, 40);

fn rendered(scene: &Scene, on: &Executor) -> Rendered {
    let frame = Frame::new(scene, SIZE, on);
    let mut prepared = frame.prepare(&PEEL).unwrap_or_else(|error| panic!("{error}"));
    prepared.render(&|_| {}).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn adapters_peel_as_the_cpu_does() {
    let Some(gpu) = crate::support::adapter() else { return };
    let on_adapter = Executor::Gpu(Arc::new(gpu));
    let open = |name| Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
    let is_polygon = |light: &Light| light.kind() == LightKind::Polygon;
    let scenes = Scene::names().map(open).filter(|scene: &Scene| scene.lights.iter().any(is_polygon));
    let (mut beyond, mut count) = (0, 0);
    for scene in scenes {
        let (expected, found) = (rendered(&scene, &Executor::Cpu), rendered(&scene, &on_adapter));
        let brightest = scene.lights.iter().flat_map(Light::colour).fold(0.0, f64::max);
        // A millionth of the form factor of each light.
        let limit = (1e-6 * brightest * scene.lights.len() as f64) as f32;
        let light = |rendered: &Rendered| rendered.colours(LIGHT).unwrap().to_vec();
        for (pixel, (a, b)) in light(&expected).into_iter().zip(light(&found)).enumerate() {
            let apart = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(apart <= limit, "{} {pixel}: {a:?} {b:?}", scene.name);
        }
        beyond += found.counts(OVERFLOW).unwrap().iter().sum::<u32>();
        count += 1;
    }
    assert!(count >= 6, "{count}");
    // Leaves and balls are more than the shader has room for.
    assert!(beyond > 100, "{beyond}");
}
