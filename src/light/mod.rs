//! Lighting by integral expansions: a demonstration of the double product tables.
//!
//! The light around a shading point is a few spherical Gaussians, the occluders
//! are balls, and the surface is diffuse. For each point the sphere of directions
//! is divided into cells ([`cells`]) in which every Gaussian is nearly linear in
//! the direction and the border of the visible part nearly straight; what each
//! cell sends is then a closed form, and that is a *table*: this module divides
//! and adds up ([`picture`]), the coefficients of the Gaussians and the moments
//! of the pieces come from `tables/spherical_gaussian.ron` and
//! `tables/double_product.ron` by the batch interpreter or by
//! shaders made from them.
//!
//! The subdivision is a reconstruction: the publication's algorithm was not
//! available. What is known and what is not says `docs/integrals.md`.

pub mod cells;
pub mod picture;
mod tables;

use glam::DVec3;

pub use tables::{Executor, Moments, Tables};

/// A spherical Gaussian: `amplitude * exp(sharpness * (axis . direction - 1))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Unit vector of the largest value.
    pub axis: DVec3,
    /// How narrow it is.
    pub sharpness: f64,
    /// The largest value, per colour channel.
    pub amplitude: DVec3,
}

impl Lobe {
    /// Its value in a direction.
    pub fn value(&self, direction: DVec3) -> DVec3 {
        self.amplitude * (self.sharpness * (self.axis.dot(direction) - 1.0)).exp()
    }
}

/// A ball, which shades and is shaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre; z is up.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
    /// The share of light that its surface sends on.
    pub albedo: DVec3,
}

/// Balls on the ground z = 0 under lobes of light.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The balls.
    pub balls: Vec<Ball>,
    /// The share of light that the ground sends on.
    pub ground: DVec3,
    /// The light.
    pub lobes: Vec<Lobe>,
    /// Where the camera stands.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
}

/// How finely the sphere of directions is divided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest error of the border's distance in a cell, in radians: the e_r of the publication.
    pub border: f64,
    /// Largest error of a lobe's linear approximation, relative to its largest value.
    pub lobe: f64,
    /// Most divisions of a cell of the base grid.
    pub depth: u32,
}

impl Settings {
    /// Both thresholds the same.
    pub fn with_threshold(threshold: f64) -> Self {
        Self { border: threshold, lobe: threshold, depth: 6 }
    }
}

impl Scene {
    /// Three balls, a broad sky, and two narrower lights.
    pub fn example() -> Self {
        let ball = |x: f64, y: f64, radius: f64, albedo: [f64; 3]| Ball {
            centre: DVec3::new(x, y, radius),
            radius,
            albedo: DVec3::from_array(albedo),
        };
        let lobe = |axis: [f64; 3], sharpness: f64, amplitude: [f64; 3]| Lobe {
            axis: DVec3::from_array(axis).normalize(),
            sharpness,
            amplitude: DVec3::from_array(amplitude),
        };
        Self {
            balls: vec![
                ball(0.0, 0.0, 1.0, [0.8, 0.75, 0.7]),
                ball(1.6, -0.9, 0.5, [0.75, 0.45, 0.35]),
                ball(-1.3, -1.2, 0.4, [0.4, 0.55, 0.75]),
            ],
            ground: DVec3::splat(0.7),
            lobes: vec![
                lobe([0.2, 0.1, 1.0], 1.5, [0.55, 0.65, 0.8]),
                lobe([0.8, -0.5, 0.6], 40.0, [6.0, 5.2, 4.0]),
                lobe([-0.7, -0.6, 0.35], 12.0, [0.9, 0.8, 1.3]),
            ],
            eye: DVec3::new(0.6, -6.0, 2.6),
            target: DVec3::new(0.1, 0.0, 0.6),
        }
    }

    /// The nearest surface along a ray: place, normal and albedo.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<Surface> {
        let mut nearest: Option<(f64, Surface)> = None;
        let mut offer = |distance: f64, normal: &dyn Fn(DVec3) -> DVec3, albedo: DVec3, ball: Option<usize>| {
            if distance > 1e-9 && nearest.as_ref().is_none_or(|(known, _)| distance < *known) {
                let place = origin + direction * distance;
                nearest = Some((distance, Surface { place, normal: normal(place), albedo, ball }));
            }
        };
        if direction.z < 0.0 {
            offer(-origin.z / direction.z, &|_| DVec3::Z, self.ground, None);
        }
        for (index, ball) in self.balls.iter().enumerate() {
            let offset = origin - ball.centre;
            let along = offset.dot(direction);
            let square = along * along - offset.length_squared() + ball.radius * ball.radius;
            if square > 0.0 {
                offer(-along - square.sqrt(), &|place| (place - ball.centre) / ball.radius, ball.albedo, Some(index));
            }
        }
        nearest.map(|(_, surface)| surface)
    }

    /// The caps of directions that balls hide at a surface: axis and angle.
    pub fn caps(&self, surface: &Surface) -> Vec<Cap> {
        let others = self.balls.iter().enumerate().filter(|(index, _)| surface.ball != Some(*index));
        others
            .map(|(_, ball)| {
                let offset = ball.centre - surface.place;
                let distance = offset.length();
                Cap { axis: offset / distance, angle: (ball.radius / distance).min(1.0).asin() }
            })
            .collect()
    }
}

/// A place on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Where it is.
    pub place: DVec3,
    /// Its unit normal.
    pub normal: DVec3,
    /// The share of light that it sends on.
    pub albedo: DVec3,
    /// The ball it belongs to; `None` for the ground.
    pub ball: Option<usize>,
}

/// The directions that a ball hides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    /// Unit vector to its middle.
    pub axis: DVec3,
    /// From there to its edge, in radians.
    pub angle: f64,
}
