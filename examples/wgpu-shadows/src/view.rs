//! What is to be seen: a camera that goes around, and what is chosen.

use std::f64::consts::TAU;

use glam::DVec3;
use umbrage::scene::view::Camera;
use umbrage::technique::revectorise::Variant;

/// The techniques to choose from, the cheapest first.
pub(crate) const TECHNIQUES: [Variant; 5] = [Variant::Hard, Variant::Pcf, Variant::Smsr, Variant::Rsmss, Variant::Rpcf];

/// What is to be seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct View {
    /// What the camera looks at, and its angle of view from top to bottom in degrees.
    target: DVec3,
    angle: f64,
    /// Where it stands around that: an angle about the vertical, one above the ground, and the distance.
    around: f64,
    above: f64,
    distance: f64,
    pub(crate) technique: Variant,
    /// Index among the plans.
    pub(crate) plan: usize,
    /// Whether cases are shown in colours.
    pub(crate) cases: bool,
    /// Whether lines of the table are counted, by its first plan. Cases are not shown then.
    pub(crate) hits: bool,
}

impl View {
    /// What a camera sees, by RSMSS as written.
    pub(crate) fn of(camera: &Camera) -> Self {
        let away = camera.eye - camera.target;
        Self {
            target: camera.target,
            angle: camera.angle,
            around: away.x.atan2(away.z),
            above: away.y.atan2(away.x.hypot(away.z)),
            distance: away.length(),
            technique: Variant::Rsmss,
            plan: 0,
            cases: false,
            hits: false,
        }
    }

    /// The camera that sees it.
    pub(crate) fn camera(&self) -> Camera {
        let flat = self.distance * self.above.cos();
        let away = DVec3::new(flat * self.around.sin(), self.distance * self.above.sin(), flat * self.around.cos());
        Camera { eye: self.target + away, target: self.target, angle: self.angle }
    }

    /// Moves the camera around its target.
    pub(crate) fn turn(&mut self, around: f64, above: f64) {
        self.around = (self.around + around) % TAU;
        // Not below the ground, and not straight above, where there is no up.
        self.above = (self.above + above).clamp(0.02, 1.5);
    }

    /// Moves the camera closer, or away.
    pub(crate) fn zoom(&mut self, factor: f64) {
        self.distance = (self.distance * factor).clamp(0.2, 500.0);
    }

    /// Moves the camera to where another one stands.
    pub(crate) fn go_to(&mut self, other: &View) {
        (self.around, self.above, self.distance) = (other.around, other.above, other.distance);
    }
}
