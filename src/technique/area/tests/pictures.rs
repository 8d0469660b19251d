//! Pictures of every scene with polygonal lights: single precision against double, and rays against both.

use super::super::lit::Lit;
use super::super::picture::{Pixels, peeled};
use super::super::received::Received;
use super::super::sampling::estimates;
use crate::scene::Scene;
use crate::scene::light::LightKind;
use crate::technique::{Executor, Frame};

const SIZE: (u32, u32) = (48, 32);

fn scenes() -> Vec<Scene> {
    let open = |name| Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
    let scenes = Scene::names().map(open);
    scenes.filter(|scene: &Scene| scene.lights.iter().any(|light| light.kind() == LightKind::Polygon)).collect()
}

fn lit(scene: &Scene) -> (Frame<'_>, std::sync::Arc<Lit>) {
    let frame = Frame::new(scene, SIZE, &Executor::Cpu);
    let lit = Lit::of(&frame, "peel").unwrap_or_else(|error| panic!("{error}"));
    (frame, lit)
}

/// The largest radiance of the lights of a scene, by which light is more than form factors.
fn brightest(lit: &Lit) -> f64 {
    lit.lights.iter().flat_map(|light| light.colour).fold(0.0, f64::max)
}

#[test]
fn single_precision_is_within_a_millionth_at_every_pixel() {
    let scenes = scenes();
    assert!(scenes.len() >= 6, "{}", scenes.len());
    for scene in &scenes {
        let (_, lit) = lit(scene);
        let of = |pixels: Result<Pixels, _>| pixels.unwrap_or_else(|error: crate::diag::Failure| panic!("{error}"));
        let (wide, narrow) = (of(peeled::<f64>(&lit, &|_| {})), of(peeled::<f32>(&lit, &|_| {})));
        let limit = 1e-6 * brightest(&lit) * lit.lights.len() as f64;
        let mut shadowed = 0;
        for (pixel, (wide_light, narrow_light)) in wide.received.iter().zip(&narrow.received).enumerate() {
            let whole = wide.unshadowed[pixel];
            let ways = [
                (wide_light.diffuse, narrow_light.diffuse, whole.diffuse),
                (wide_light.glossy, narrow_light.glossy, whole.glossy),
            ];
            for (wide, narrow, whole) in ways {
                assert!((wide - narrow).abs().max_element() < limit, "{} {pixel}: {wide} {narrow}", scene.name);
                assert!(wide.is_finite() && wide.min_element() >= 0.0, "{} {pixel}", scene.name);
                assert!(wide.cmple(whole + 1e-9).all(), "{} {pixel}: {wide} of {whole}", scene.name);
            }
            shadowed += usize::from((whole - *wide_light).diffuse.max_element() > 1e-3);
        }
        assert!(shadowed > 50, "{}: {shadowed}", scene.name);
    }
}

#[test]
fn many_rays_come_close_to_the_exact_light() {
    for (name, limit) in [("table", 0.01), ("abutting", 0.01), ("grazing", 0.1)] {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
        let (frame, lit) = lit(&scene);
        let exact = peeled::<f64>(&lit, &|_| {}).unwrap_or_else(|error| panic!("{error}"));
        let error = |samples: u32| {
            let rays = estimates(&lit, &frame.rays, samples, 7, &|_| {});
            let square = |light: Received| light.diffuse.length_squared() + light.glossy.length_squared();
            // Beside a light that stands on the floor a few rays bring almost all of it.
            let is_apart = |pixel: usize| lit.surfaces.points[pixel].is_none_or(|point| point.place.z > -1.0);
            let both = rays.iter().zip(&exact.received).enumerate().filter(|(pixel, _)| is_apart(*pixel));
            let squares = both.map(|(_, (ray, light))| square(ray.shadowed - *light));
            (squares.sum::<f64>() / rays.len() as f64).sqrt() / brightest(&lit)
        };
        let (few, many) = (error(16), error(1024));
        // Stratified samples of edges: the error falls faster than with the square root of their number.
        assert!(few < limit && many < few / 8.0, "{name}: {few} {many}");
    }
}
