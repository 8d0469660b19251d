//! Lights: where light comes from, how much of it, and which technique takes which kind.

use std::fmt;

use glam::{DVec2, DVec3};

use super::view::View;
use super::{Scene, flat};
use crate::diag::{Diagnostic, Failure, codes};

/// A light of a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Light {
    /// From so far away that all rays are parallel.
    Directional(Directional),
    /// From a point, within a cone.
    Spot(Spot),
    /// From a flat convex polygon.
    Polygon(Polygon),
    /// From far away, with a Gaussian distribution of directions.
    Gaussian(Gaussian),
}

/// Parallel rays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directional {
    /// The direction in which the light travels; of any length but zero.
    pub direction: DVec3,
    /// Colour and intensity, linear.
    pub colour: [f64; 3],
}

/// A cone of rays from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Its place.
    pub position: DVec3,
    /// A place on its axis.
    pub target: DVec3,
    /// Angle of the whole cone, in degrees.
    pub angle: f64,
    /// Colour and intensity, linear.
    pub colour: [f64; 3],
}

/// A flat convex polygon of constant radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    /// Three to eight, counter-clockwise as seen from the side that emits.
    pub corners: Vec<DVec3>,
    /// True if both sides emit.
    pub two_sided: bool,
    /// Radiance, linear.
    pub colour: [f64; 3],
}

/// A distant light whose directions are distributed like a Gaussian.
///
/// The *slope* of a direction is the tangent of its angle to the vertical, along x
/// and along z: a direction with slopes (s, t) points towards (s, 1, t). Slopes are
/// normally distributed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gaussian {
    /// Angles of the mean direction to the vertical, along x and along z, in degrees; within 80.
    pub tilts: [f64; 2],
    /// Standard deviations of the slope along the two axes of the distribution; not negative.
    pub deviations: [f64; 2],
    /// Angle from the x axis to the first axis of the distribution, towards the z axis, in degrees.
    pub rotation: f64,
    /// Colour and intensity, linear.
    pub colour: [f64; 3],
}

/// A light without extent, whose shadows are hard: what a shadow map can show.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Punctual {
    /// From so far away that all rays are parallel.
    Directional(Directional),
    /// From a point, within a cone.
    Spot(Spot),
}

/// The kind of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightKind {
    /// [`Light::Directional`]
    Directional,
    /// [`Light::Spot`]
    Spot,
    /// [`Light::Polygon`]
    Polygon,
    /// [`Light::Gaussian`]
    Gaussian,
}

/// A set of kinds of lights.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lights(&'static [LightKind]);

impl fmt::Display for LightKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            LightKind::Directional => "directional",
            LightKind::Spot => "spot",
            LightKind::Polygon => "polygon",
            LightKind::Gaussian => "Gaussian",
        })
    }
}

impl fmt::Display for Lights {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, kind) in self.0.iter().enumerate() {
            let before = match index {
                0 => "",
                _ if index + 1 == self.0.len() => " and ",
                _ => ", ",
            };
            write!(f, "{before}{kind}")?;
        }
        f.write_str(" lights")
    }
}

impl Lights {
    /// Lights without extent.
    pub const PUNCTUAL: Self = Self(&[LightKind::Directional, LightKind::Spot]);
    /// Polygons.
    pub const POLYGON: Self = Self(&[LightKind::Polygon]);
    /// Distant Gaussians.
    pub const GAUSSIAN: Self = Self(&[LightKind::Gaussian]);
    /// All kinds.
    pub const ANY: Self = Self(&[LightKind::Directional, LightKind::Spot, LightKind::Polygon, LightKind::Gaussian]);

    /// The set of these kinds.
    pub const fn of(kinds: &'static [LightKind]) -> Self {
        Self(kinds)
    }

    /// Returns whether a kind belongs to the set.
    pub fn contains(self, kind: LightKind) -> bool {
        self.0.contains(&kind)
    }

    /// The lights of a scene that belong to the set, for a technique that takes no others: at least one.
    ///
    /// # Errors
    /// When there is none. The message names the technique and the lights that it does not take.
    pub fn of_scene<'s>(self, scene: &'s Scene, technique: &str) -> Result<Vec<&'s Light>, Failure> {
        let taken: Vec<&Light> = scene.lights.iter().filter(|light| self.contains(light.kind())).collect();
        if !taken.is_empty() {
            return Ok(taken);
        }
        let message = format!("`{technique}` takes {self}, and the scene `{}` has none", scene.name);
        let others = scene
            .lights
            .iter()
            .enumerate()
            .map(|(index, light)| format!("light {} is {}", index + 1, light.kind().with_article()));
        let others: Vec<String> = others.collect();
        let error = Diagnostic::error(codes::SCENE, message).help(others.join(", "));
        Err(Failure::bare("", error.help("add such a light, or choose a technique that takes these")))
    }
}

impl LightKind {
    fn with_article(self) -> String {
        match self {
            LightKind::Directional | LightKind::Spot => format!("a {self} light"),
            LightKind::Polygon => "a polygon".to_owned(),
            LightKind::Gaussian => "a Gaussian".to_owned(),
        }
    }
}

impl Light {
    /// Its kind.
    pub fn kind(&self) -> LightKind {
        match self {
            Light::Directional(_) => LightKind::Directional,
            Light::Spot(_) => LightKind::Spot,
            Light::Polygon(_) => LightKind::Polygon,
            Light::Gaussian(_) => LightKind::Gaussian,
        }
    }

    /// Colour and intensity, linear; of a polygon its radiance.
    pub fn colour(&self) -> [f64; 3] {
        match self {
            Light::Directional(light) => light.colour,
            Light::Spot(light) => light.colour,
            Light::Polygon(light) => light.colour,
            Light::Gaussian(light) => light.colour,
        }
    }

    /// The light, if it has no extent.
    pub fn punctual(&self) -> Option<Punctual> {
        match self {
            Light::Directional(light) => Some(Punctual::Directional(*light)),
            Light::Spot(light) => Some(Punctual::Spot(*light)),
            Light::Polygon(_) | Light::Gaussian(_) => None,
        }
    }
}

impl Polygon {
    /// Normal to its plane, towards the side that emits, and twice as long as the area is large.
    pub fn cross(&self) -> DVec3 {
        flat::cross(&self.corners)
    }

    /// Unit normal towards the side that emits.
    pub fn normal(&self) -> DVec3 {
        self.cross().normalize_or_zero()
    }

    /// Its area.
    pub fn area(&self) -> f64 {
        0.5 * self.cross().length()
    }

    /// A place on it, evenly distributed for numbers from 0 to 1 that are.
    pub fn place(&self, DVec2 { x, y }: DVec2) -> DVec3 {
        let area = self.area();
        // A fan of triangles, chosen by their areas along x, which is then as evenly distributed within the one chosen.
        let first = self.corners[0];
        let mut rest = x * area;
        let last = self.corners.len() - 2;
        for (index, pair) in self.corners[1..].windows(2).enumerate() {
            let (u, v) = (pair[0] - first, pair[1] - first);
            let own = 0.5 * u.cross(v).length();
            if rest <= own || index + 1 == last {
                let (s, t) = ((rest / own).clamp(0.0, 1.0).sqrt(), y);
                return first + s * ((1.0 - t) * u + t * v);
            }
            rest -= own;
        }
        first
    }

    /// The distance of a place from its plane: positive before the side that emits.
    pub fn distance(&self, place: DVec3) -> f64 {
        self.corners.first().map_or(0.0, |first| self.normal().dot(place - *first))
    }

    /// The mean of its corners.
    pub fn middle(&self) -> DVec3 {
        self.corners.iter().sum::<DVec3>() / self.corners.len().max(1) as f64
    }
}

impl Gaussian {
    /// The mean of the slope along x and z.
    pub fn mean(&self) -> DVec2 {
        let [x, z] = self.tilts.map(|tilt| libm::tan(tilt.to_radians()));
        DVec2::new(x, z)
    }

    /// Unit vector towards the mean of the light.
    pub fn axis(&self) -> DVec3 {
        let mean = self.mean();
        DVec3::new(mean.x, 1.0, mean.y).normalize()
    }
}

impl Punctual {
    /// The direction in which the light travels at a place.
    pub fn direction(&self, place: DVec3) -> DVec3 {
        match self {
            Punctual::Directional(light) => light.direction.normalize(),
            Punctual::Spot(light) => (place - light.position).normalize_or_zero(),
        }
    }

    /// Colour and intensity, linear.
    pub fn colour(&self) -> [f64; 3] {
        match self {
            Punctual::Directional(light) => light.colour,
            Punctual::Spot(light) => light.colour,
        }
    }

    /// The share of its light that is sent towards a place, shadows apart: 1, and less towards the border of a cone.
    pub fn brightness(&self, place: DVec3) -> f64 {
        match self {
            Punctual::Directional(_) => 1.0,
            Punctual::Spot(Spot { position, target, angle, .. }) => {
                let axis = (*target - *position).normalize_or_zero();
                let off_axis = (place - *position).angle_between(axis).to_degrees() / (angle / 2.0);
                // The last tenth of the cone fades.
                ((1.0 - off_axis) / 0.1).clamp(0.0, 1.0)
            }
        }
    }

    /// Distance from a place to the light.
    pub fn distance(&self, place: DVec3) -> f64 {
        match self {
            Punctual::Directional(_) => f64::INFINITY,
            Punctual::Spot(light) => (light.position - place).length(),
        }
    }

    /// The square of a scene that its shadow map shows.
    pub fn view(&self, scene: &Scene) -> View {
        let corners = |casters_only: bool| -> Vec<DVec3> {
            let objects = scene.objects.iter().filter(|object| object.casts || !casters_only);
            objects.flat_map(|object| object.triangles.iter().flat_map(|triangle| triangle.corners)).collect()
        };
        let (casts, all) = (corners(true), corners(false));
        let casts = if casts.is_empty() { &all } else { &casts };
        match self {
            Punctual::Directional(light) => View::along(light.direction, casts, &all),
            Punctual::Spot(light) => View::cone(light.position, light.target, light.angle, &all),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_on_a_polygon_are_evenly_distributed() {
        let corners = vec![DVec3::ZERO, DVec3::X * 2.0, DVec3::new(2.0, 1.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
        let light = Polygon { corners, two_sided: false, colour: [1.0; 3] };
        let count = 200;
        let share = |index: u32| (f64::from(index) + 0.5) / f64::from(count);
        let at = |index: u32| light.place(DVec2::new(share(index / count), share(index % count)));
        let mean = (0..count * count).map(at).sum::<DVec3>() / f64::from(count * count);
        // The centroid of the trapezium.
        assert!((mean - DVec3::new(5.0 / 6.0, 13.0 / 12.0, 0.0)).length() < 1e-3, "{mean}");
    }
}
