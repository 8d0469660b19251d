//! The scene as its slabs see it: x to the right and y down in pixels, z away from the viewer in units of the scene.

use glam::{DVec2, DVec3};

use crate::scene::Scene;

/// The way in which slabs are seen, as in the level set `projection` of `tables/policies.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Projection {
    /// All pixels look the same way.
    Orthographic,
    /// All pixels look from one place; directions of light are the same everywhere in the world.
    PerspectiveWorld,
    /// All pixels look from one place, and light follows them: its directions are the same in every pixel.
    PerspectiveFollow,
}

/// The way in which places of the world become pixels and depths.
#[derive(Debug, Clone)]
pub struct SlabView {
    /// Pixels per row, and rows.
    pub size: (u32, u32),
    /// The projection.
    pub projection: Projection,
    eye: DVec3,
    right: DVec3,
    down: DVec3,
    forward: DVec3,
    /// Pixels per unit at distance 1 from the eye, and at the distance of the target.
    focal: f64,
    scale: f64,
}

/// The nearest that perspective sees, as a share of the distance to the target.
const NEAR: f64 = 1e-3;

impl SlabView {
    /// The view of a scene's camera. An orthographic one is as wide as the picture is at the camera's target.
    pub fn new(scene: &Scene, size: (u32, u32), projection: Projection) -> Self {
        let camera = &scene.camera;
        let forward = (camera.target - camera.eye).normalize();
        let up = if forward.cross(DVec3::Y).length() > 1e-3 { DVec3::Y } else { DVec3::Z };
        let right = forward.cross(up).normalize();
        let focal = 0.5 * f64::from(size.1) / libm::tan(0.5 * camera.angle.to_radians());
        let scale = focal / (camera.target - camera.eye).length();
        Self { size, projection, eye: camera.eye, right, down: forward.cross(right), forward, focal, scale }
    }

    /// A direction to the right, down and away.
    pub fn turned(&self, direction: DVec3) -> DVec3 {
        DVec3::new(direction.dot(self.right), direction.dot(self.down), direction.dot(self.forward))
    }

    /// The eye, and the directions to the right, down and away.
    pub fn frame(&self) -> [DVec3; 4] {
        [self.eye, self.right, self.down, self.forward]
    }

    /// A place to the right, below and away from the eye.
    pub fn seen(&self, place: DVec3) -> DVec3 {
        self.turned(place - self.eye)
    }

    /// The middle of the picture, in pixels.
    pub fn middle(&self) -> DVec2 {
        0.5 * DVec2::new(f64::from(self.size.0), f64::from(self.size.1))
    }

    /// Pixels per unit at a depth.
    pub fn scale_at(&self, depth: f64) -> f64 {
        match self.projection {
            Projection::Orthographic => self.scale,
            Projection::PerspectiveWorld | Projection::PerspectiveFollow => self.focal / depth,
        }
    }

    /// The least depth that is seen.
    pub fn near(&self) -> f64 {
        match self.projection {
            Projection::Orthographic => f64::NEG_INFINITY,
            Projection::PerspectiveWorld | Projection::PerspectiveFollow => NEAR * self.focal / self.scale,
        }
    }

    /// The pixel of what [`SlabView::seen`] gave.
    pub fn pixel(&self, seen: DVec3) -> DVec2 {
        self.middle() + seen.truncate() * self.scale_at(seen.z)
    }

    /// Returns whether depths are linear in pixels; otherwise their inverses are.
    pub fn is_parallel(&self) -> bool {
        self.projection == Projection::Orthographic
    }
}
