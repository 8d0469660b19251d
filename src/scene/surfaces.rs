//! The first surfaces of a picture: for each pixel, the point that the camera sees.

use rayon::prelude::*;

use super::Scene;
use super::rays::{Rays, SurfacePoint};

/// The surfaces that a camera sees, at the centres of a picture's pixels.
#[derive(Debug, Clone)]
pub struct Surfaces {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top; `None` where the background is seen.
    pub points: Vec<Option<SurfacePoint>>,
}

impl Surfaces {
    /// Casts a ray through the centre of every pixel.
    pub fn new(scene: &Scene, rays: &Rays, width: u32, height: u32) -> Self {
        let view = scene.camera.view(width, height);
        let across = f64::from(width);
        let down = f64::from(height);
        let row = |y: u32| (0..width).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5));
        let points = (0..height)
            .into_par_iter()
            .flat_map_iter(row)
            .map(|(x, y)| rays.see(view.ray(x / across, y / down)))
            .collect();
        Self { width, height, points }
    }
}
