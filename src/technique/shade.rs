//! Layers → picture: diffuse surfaces under the scene's light.

use glam::DVec3;
use image::{Rgb, Rgb32FImage};

use super::rendered::{LIGHT, VALUE};
use super::{Frame, Rendered};
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::Scene;
use crate::scene::light::Punctual;
use crate::scene::rays::SurfacePoint;
use crate::scene::surfaces::Surfaces;

/// The picture of a frame in linear light: the layer of light itself, or surfaces shaded by the layer of visibility.
///
/// # Errors
/// When there is neither layer, or nothing that casts the light.
pub fn picture(frame: &Frame<'_>, rendered: &Rendered) -> Result<Rgb32FImage, Failure> {
    let surfaces = &frame.surfaces;
    if let Some(light) = rendered.colours(LIGHT) {
        let mut image = Rgb32FImage::new(surfaces.width, surfaces.height);
        for (pixel, light) in image.pixels_mut().zip(light) {
            *pixel = Rgb(*light);
        }
        return Ok(image);
    }
    let Some(value) = rendered.numbers(VALUE) else {
        let error = Diagnostic::error(codes::RENDER, "the technique has neither light nor visibility to show");
        return Err(Failure::bare("", error));
    };
    Ok(shade(frame.scene, &frame.scene.punctual("shading")?, surfaces, value))
}

/// The picture in linear light: for each pixel colour × (s + (1 - s) × visibility × what the light's direction
/// leaves), s being the ambient share.
pub fn shade(scene: &Scene, light: &Punctual, surfaces: &Surfaces, visibility: &[f32]) -> Rgb32FImage {
    let ambient = scene.ambient;
    let mut image = Rgb32FImage::new(surfaces.width, surfaces.height);
    for ((pixel, point), visible) in image.pixels_mut().zip(&surfaces.points).zip(visibility) {
        let colour = match point {
            None => DVec3::from_array(scene.background),
            Some(point) => {
                // The sky above is brighter than the ground below.
                let sky = 0.75 + 0.25 * point.smooth_normal.y;
                let light = DVec3::splat(ambient * sky)
                    + (1.0 - ambient)
                        * f64::from(*visible)
                        * arriving(light, point)
                        * DVec3::from_array(light.colour());
                DVec3::from_array(scene.objects[point.object as usize].colour) * light
            }
        };
        *pixel = Rgb(colour.as_vec3().to_array());
    }
    image
}

/// The share of its light that a light would leave at each pixel, were there no shadow: what an error of visibility
/// weighs there. Zero beyond its cone, on surfaces that face away from it, and on the background.
pub fn contribution(light: &Punctual, surfaces: &Surfaces) -> Vec<f32> {
    let at = |point: &Option<SurfacePoint>| match point {
        Some(point) if faces(light, point) => arriving(light, point) as f32,
        _ => 0.0,
    };
    surfaces.points.iter().map(at).collect()
}

/// Returns whether the side of a surface that is seen is the one that a light could reach.
pub(crate) fn faces(light: &Punctual, point: &SurfacePoint) -> bool {
    point.normal.dot(light.direction(point.place)) < 0.0
}

/// The share of its light that arrives at a point, shadows apart.
fn arriving(light: &Punctual, point: &SurfacePoint) -> f64 {
    point.smooth_normal.dot(-light.direction(point.place)).max(0.0) * light.brightness(point.place)
}
