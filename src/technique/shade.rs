//! Visibility → picture: diffuse surfaces under the scene's light.

use glam::DVec3;
use image::{Rgb, Rgb32FImage};

use super::revectorise::stage::Stage;
use crate::scene::surfaces::Surfaces;

/// The picture in linear light: for each pixel colour × (s + (1 - s) × visibility × what the light's direction
/// leaves), s being the ambient share.
pub fn shade(stage: &Stage<'_>, surfaces: &Surfaces, visibility: &[f32]) -> Rgb32FImage {
    let scene = stage.scene;
    let ambient = scene.ambient;
    let mut image = Rgb32FImage::new(surfaces.width, surfaces.height);
    for ((pixel, point), visible) in image.pixels_mut().zip(&surfaces.points).zip(visibility) {
        let colour = match point {
            None => DVec3::from_array(scene.background),
            Some(point) => {
                let towards = -stage.light.direction(point.place);
                let facing = point.smooth_normal.dot(towards).max(0.0) * stage.light.brightness(point.place);
                // The sky above is brighter than the ground below.
                let sky = 0.75 + 0.25 * point.smooth_normal.y;
                let light = DVec3::splat(ambient * sky)
                    + (1.0 - ambient) * f64::from(*visible) * facing * DVec3::from_array(stage.light.colour());
                DVec3::from_array(scene.objects[point.object as usize].colour) * light
            }
        };
        *pixel = Rgb(colour.as_vec3().to_array());
    }
    image
}
