//! A second reference that shares nothing with the sweep but lights and views: straight rays from what is seen towards
//! places of the lights, past the triangles of the scene.

use super::super::REFERENCE;
use super::super::layers::Layers;
use super::super::light::{SlopeLight, nodes};
use super::super::settings as set;
use super::super::view::{Projection, SlabView};
use super::scenes::{scene, slabs, tried};
use crate::scene::Scene;
use crate::scene::rays::Rays;
use crate::technique::rendered::LIGHT;
use crate::technique::setting::Value;

const SIZE: (u32, u32) = (48, 40);
const RAYS: u32 = 128;

/// Light at every pixel: each light as so many rays, of what is opaque.
fn by_rays(scene: &Scene) -> Vec<[f64; 3]> {
    let view = SlabView::new(scene, SIZE, Projection::Orthographic);
    let layers = Layers::new(scene, &view).expect("few");
    let rays = Rays::new(scene);
    let [eye, right, down, forward] = view.frame();
    let nodes = nodes(RAYS).expect("many");
    let lights: Vec<SlopeLight> =
        SlopeLight::of_scene(scene, &view).expect("above").iter().flat_map(|light| light.split(&nodes, 0.0)).collect();
    let pixel = |pixel: usize| {
        let Some(seen) = layers.of(pixel).first() else { return [0.0; 3] };
        let at = |along: usize, pixels: u32| (along as f64 + 0.5 - 0.5 * f64::from(pixels)) / view.scale_at(0.0);
        let (x, y) = (at(pixel % SIZE.0 as usize, SIZE.0), at(pixel / SIZE.0 as usize, SIZE.1));
        let place = eye + right * x + down * y + forward * (layers.base + f64::from(seen.depth) - 1e-4);
        let mut sum = [0.0; 3];
        for light in &lights {
            let towards = right * light.mean.x + down * light.mean.y - forward;
            if rays.is_open(place, place + towards * 20.0) {
                sum.iter_mut().zip(light.colour).for_each(|(sum, channel)| *sum += channel);
            }
        }
        let own = scene.objects[seen.object as usize].colour;
        [0, 1, 2].map(|channel| sum[channel] * own[channel])
    };
    (0..(SIZE.0 * SIZE.1) as usize).map(pixel).collect()
}

/// The reference is as near to rays as its slabs are thin and its moves whole.
#[test]
fn sharp_lights_in_slabs_are_straight_rays() {
    let lights = "Gaussian(tilts: (-20, 10), deviations: (0.4, 0.2), rotation: 30, colour: (1, 0.8, 0.5))";
    let scene = scene(
        lights,
        "(shape: Block(size: (9, 0.2, 9)), at: (0, -0.2, 0)), (shape: Block(size: (1, 0.1, 1)), at: (0, 1, 0)), \
         (shape: Block(size: (0.5, 0.6, 0.5)), at: (-1, 0, 0.7))",
    );
    let truth = by_rays(&scene);
    let apart = |count: u32| {
        let settings = slabs(count).with(&set::SHARP_LIGHTS, Value::Whole(RAYS));
        let picture = tried(&scene, &REFERENCE, settings).unwrap_or_else(|failure| panic!("{failure}"));
        let light = picture.colours(LIGHT).expect("a layer").to_vec();
        let pairs = light.iter().flatten().zip(truth.iter().flatten());
        let squares = pairs.map(|(a, b)| (f64::from(*a) - b).powi(2)).sum::<f64>();
        (squares / (3 * light.len()) as f64).sqrt()
    };
    let [few, many] = [12, 192].map(apart);
    assert!(many < 0.008 && few < 0.01 && many < few, "{few} {many}");
}
