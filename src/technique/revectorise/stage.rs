//! The passes before a technique, by ray casting: what the camera sees, what the
//! light sees, and where the one lies in the other.

use std::sync::Arc;

use glam::DVec2;
use rayon::prelude::*;

use super::{DEPTH_UNIT, Receiver, ReceiverKind, Receivers, ShadowMap, fixed_depth, max_slope};
use crate::diag::Failure;
use crate::scene::Scene;
use crate::scene::light::Punctual;
use crate::scene::rays::{Rays, SurfacePoint};
use crate::scene::surfaces::Surfaces;
use crate::scene::view::{Plane, View};
use crate::technique::shade::faces;

/// The amount added to the depths of a shadow map, so that a surface does not shadow itself.
///
/// Receivers are continued as planes, which meet the map's own plane exactly; the
/// bias has to cover rounding and curvature only, and can be small.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bias {
    /// A constant, in units of [`DEPTH_UNIT`].
    pub constant: f32,
    /// Times the change of depth from a texel to the next.
    pub slope: f32,
}

impl Bias {
    /// Covers rounding and gentle curvature.
    pub const DEFAULT: Bias = Bias { constant: 4.0, slope: 0.25 };
}

impl Default for Bias {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A scene with everything that its passes share.
#[derive(Debug)]
pub struct Stage<'s> {
    /// The scene.
    pub scene: &'s Scene,
    /// The triangles that rays are sent through.
    pub rays: Arc<Rays>,
    /// The light that has a shadow map.
    pub light: Punctual,
    /// The view of the light.
    pub light_view: View,
    /// The plane of each triangle over the light's square; `None` if it is seen edge-on.
    planes: Vec<Option<Plane>>,
}

impl<'s> Stage<'s> {
    /// Prepares a scene and the first of its lights that a shadow map can show, for a technique of this name.
    ///
    /// # Errors
    /// When there is no such light: the message says that the technique takes none.
    pub fn new(scene: &'s Scene, technique: &str) -> Result<Self, Failure> {
        Self::with_rays(scene, Arc::new(Rays::new(scene)), technique)
    }

    /// The same with rays that were made before.
    ///
    /// # Errors
    /// As [`Stage::new`].
    pub fn with_rays(scene: &'s Scene, rays: Arc<Rays>, technique: &str) -> Result<Self, Failure> {
        let light = scene.punctual(technique)?;
        let light_view = light.view(scene);
        let planes = rays.triangles().iter().map(|triangle| light_view.plane(triangle.corners)).collect();
        Ok(Self { scene, rays, light, light_view, planes })
    }

    /// The surfaces that the camera sees.
    pub fn surfaces(&self, width: u32, height: u32) -> Surfaces {
        Surfaces::new(self.scene, &self.rays, width, height)
    }

    /// The depths that the light sees, one per texel, at the texel's centre.
    pub fn shadow_map(&self, size: u32, bias: Bias) -> ShadowMap {
        let texel = 1.0 / f64::from(size);
        let depth = |index: u64| {
            let x = ((index % u64::from(size)) as f64 + 0.5) * texel;
            let y = ((index / u64::from(size)) as f64 + 0.5) * texel;
            let Some(number) = self.rays.first(self.light_view.ray(x, y)) else { return 1.0 };
            // Edge-on triangles are met by rounding only.
            let Some(plane) = self.planes[number as usize] else { return 1.0 };
            let slope = (plane.du.abs().max(plane.dv.abs()) * texel) as f32;
            let added = bias.constant * DEPTH_UNIT + bias.slope * slope.min(max_slope(size));
            (fixed_depth(plane.at(x, y) as f32, 1.0) + added).clamp(0.0, 1.0)
        };
        ShadowMap { size, depth: (0..u64::from(size) * u64::from(size)).into_par_iter().map(depth).collect() }
    }

    /// The places of points of surfaces in a shadow map of a size.
    pub fn receivers(&self, surfaces: &Surfaces, size: u32) -> Receivers {
        let receiver = |point: &Option<SurfacePoint>| match point {
            Some(point) => self.receiver(point, size),
            None => Receiver::default(),
        };
        let points = surfaces.points.par_iter().map(receiver).collect();
        Receivers { width: surfaces.width, height: surfaces.height, points }
    }

    fn receiver(&self, point: &SurfacePoint, size: u32) -> Receiver {
        let away = Receiver { kind: ReceiverKind::Away, ..Receiver::default() };
        if !faces(&self.light, point) {
            return away;
        }
        let Some((place, depth)) = self.light_view.project(point.place) else { return away };
        let Some(plane) = self.planes[point.triangle as usize] else { return away };
        let (limit, texel) = (max_slope(size), 1.0 / f64::from(size));
        let (u, v) = (place.x as f32, place.y as f32);
        // The centre of the texel that the rounded place is in.
        let centre = DVec2::new(f64::from((u * size as f32).floor()), f64::from((v * size as f32).floor()));
        let centre = (centre + 0.5) * texel;
        let [dz_dx, dz_dy] = [plane.du, plane.dv].map(|slope| fixed_depth((slope * texel) as f32, limit));
        // Where the plane is too steep to be followed to the centre, it is followed as far as it goes.
        let is_steep = [plane.du, plane.dv].iter().any(|slope| (slope * texel).abs() > f64::from(limit));
        let z = if is_steep {
            let off = (centre - place) * f64::from(size);
            depth + f64::from(dz_dx) * off.x + f64::from(dz_dy) * off.y
        } else {
            plane.at(centre.x, centre.y)
        };
        Receiver { u, v, z: fixed_depth(z.clamp(0.0, 1.0) as f32, 1.0), kind: ReceiverKind::Facing, dz_dx, dz_dy }
    }
}
