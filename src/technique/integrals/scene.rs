//! Balls and flat plates on the ground under spherical Gaussians of light.

use glam::DVec3;

use super::visibility::{Cap, Facet, Occluders};

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

/// A flat convex polygon with two sides, which shades and is shaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// Its corners, one after the other around it.
    pub corners: Vec<DVec3>,
    /// The share of light that its surface sends on.
    pub albedo: DVec3,
}

/// Balls and plates on the ground z = 0 under lobes of light.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The balls.
    pub balls: Vec<Ball>,
    /// The plates.
    pub plates: Vec<Plate>,
    /// The share of light that the ground sends on.
    pub ground: DVec3,
    /// The light.
    pub lobes: Vec<Lobe>,
    /// Where the camera stands.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
}

/// What a surface is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {
    /// The ground.
    Ground,
    /// The ball with this index.
    Ball(usize),
    /// The plate with this index.
    Plate(usize),
}

/// A place on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Where it is.
    pub place: DVec3,
    /// Its unit normal, on the side that is seen.
    pub normal: DVec3,
    /// The share of light that it sends on.
    pub albedo: DVec3,
    /// What it is part of, and so what does not hide its sky.
    pub body: Body,
}

impl Plate {
    /// A normal of its plane.
    fn normal(&self) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|i| self.corners.get(i).copied().unwrap_or_default());
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// How far along a ray it is hit.
    fn hit(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let normal = self.normal();
        let first = *self.corners.first()?;
        let distance = (first - origin).dot(normal) / direction.dot(normal);
        let place = origin + direction * distance;
        let beside = |i: usize| {
            let (from, to) = (self.corners[i], self.corners[(i + 1) % self.corners.len()]);
            (to - from).cross(place - from).dot(normal) < 0.0
        };
        (distance.is_finite() && !(0..self.corners.len()).any(beside)).then_some(distance)
    }
}

impl Scene {
    /// Three balls before a folding screen, a tile that leans, a broad sky, and two narrower lights.
    pub fn example() -> Self {
        let colour = DVec3::from_array;
        let ball = |x: f64, y: f64, radius: f64, albedo: [f64; 3]| Ball {
            centre: DVec3::new(x, y, radius),
            radius,
            albedo: colour(albedo),
        };
        let panel = |from: [f64; 2], to: [f64; 2], height: f64| {
            let at = |[x, y]: [f64; 2], z: f64| DVec3::new(x, y, z);
            vec![at(from, 0.0), at(to, 0.0), at(to, height), at(from, height)]
        };
        let lobe = |axis: [f64; 3], sharpness: f64, amplitude: [f64; 3]| Lobe {
            axis: DVec3::from_array(axis).normalize(),
            sharpness,
            amplitude: colour(amplitude),
        };
        Self {
            balls: vec![
                ball(0.1, 0.0, 1.0, [0.8, 0.75, 0.7]),
                ball(1.5, -1.2, 0.5, [0.75, 0.4, 0.3]),
                ball(-1.3, -1.3, 0.4, [0.35, 0.5, 0.75]),
            ],
            plates: vec![
                Plate { corners: panel([-3.1, 0.9], [-1.2, 2.0], 2.1), albedo: colour([0.72, 0.7, 0.6]) },
                Plate { corners: panel([-1.2, 2.0], [1.0, 1.8], 2.1), albedo: colour([0.72, 0.7, 0.6]) },
                Plate {
                    corners: hexagon(DVec3::new(2.4, 0.3, 0.66), DVec3::new(-0.45, -0.8, 0.35), 0.7),
                    albedo: colour([0.45, 0.65, 0.4]),
                },
            ],
            ground: DVec3::splat(0.7),
            lobes: vec![
                lobe([0.2, 0.1, 1.0], 1.5, [0.2, 0.27, 0.38]),
                lobe([0.85, -0.15, 0.6], 150.0, [60.0, 50.0, 35.0]),
                lobe([-0.7, -0.6, 0.35], 12.0, [0.4, 0.4, 0.7]),
            ],
            eye: DVec3::new(0.6, -6.0, 2.6),
            target: DVec3::new(0.0, 0.0, 0.75),
        }
    }

    /// The nearest surface along a ray.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<Surface> {
        let mut nearest: Option<(f64, Body)> = None;
        let mut offer = |distance: f64, body: Body| {
            if distance > 1e-9 && nearest.is_none_or(|(known, _)| distance < known) {
                nearest = Some((distance, body));
            }
        };
        if direction.z < 0.0 {
            offer(-origin.z / direction.z, Body::Ground);
        }
        for (index, ball) in self.balls.iter().enumerate() {
            let offset = origin - ball.centre;
            let along = offset.dot(direction);
            let square = along * along - offset.length_squared() + ball.radius * ball.radius;
            if square > 0.0 {
                offer(-along - square.sqrt(), Body::Ball(index));
            }
        }
        for (index, plate) in self.plates.iter().enumerate() {
            if let Some(distance) = plate.hit(origin, direction) {
                offer(distance, Body::Plate(index));
            }
        }
        let (distance, body) = nearest?;
        let place = origin + direction * distance;
        let (normal, albedo) = match body {
            Body::Ground => (DVec3::Z, self.ground),
            Body::Ball(index) => {
                let ball = &self.balls[index];
                ((place - ball.centre) / ball.radius, ball.albedo)
            }
            Body::Plate(index) => {
                let plate = &self.plates[index];
                let normal = plate.normal();
                (if normal.dot(direction) < 0.0 { normal } else { -normal }, plate.albedo)
            }
        };
        Some(Surface { place, normal, albedo, body })
    }

    /// What hides parts of the sky at a surface, as directions.
    pub fn occluders(&self, surface: &Surface) -> Occluders {
        let balls = self.balls.iter().enumerate().filter(|(index, _)| surface.body != Body::Ball(*index));
        let plates = self.plates.iter().enumerate().filter(|(index, _)| surface.body != Body::Plate(*index));
        Occluders {
            caps: balls.map(|(_, ball)| Cap::of_ball(ball.centre - surface.place, ball.radius)).collect(),
            facets: plates
                .map(|(_, plate)| Facet::new(plate.corners.iter().map(|corner| *corner - surface.place)))
                .collect(),
        }
    }
}

/// A regular hexagon around a centre, with one corner at the lowest place.
fn hexagon(centre: DVec3, normal: DVec3, radius: f64) -> Vec<DVec3> {
    let normal = normal.normalize();
    let across = normal.cross(DVec3::Z).normalize();
    let up = across.cross(normal);
    let corner = |i: u32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_3).sin_cos();
        centre + radius * (across * sin - up * cos)
    };
    (0..6).map(corner).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::random::Random;

    #[test]
    fn what_hides_the_sky_is_what_rays_hit() {
        let scene = Scene::example();
        let mut random = Random::new(11);
        let mut hidden = 0;
        for _ in 0..20_000 {
            let mut part = || 2.0 * random.unit() - 1.0;
            let towards = DVec3::new(part(), part(), -1.0);
            let Some(surface) = scene.hit(scene.eye, towards.normalize()) else { continue };
            let direction = DVec3::new(part(), part(), part()).normalize();
            if surface.normal.dot(direction) > 0.0 {
                let hit = scene.hit(surface.place, direction);
                let above = hit.filter(|hit| hit.body != Body::Ground && hit.body != surface.body);
                // Only a ground that is nearer than what stands on it could lie between, and it never is.
                let hides = scene.occluders(&surface).hide()(direction);
                assert_eq!(hides, above.is_some(), "{surface:?} {direction}");
                hidden += usize::from(hides);
            }
        }
        assert!(hidden > 50, "{hidden}");
    }
}
