//! Occluders, which hide parts of the sky at a surface: caps and facets of the sphere of
//! directions, and the angle from a direction to the nearest of their borders.

use std::f64::consts::PI;

use glam::DVec3;

/// The directions that a ball hides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cap {
    /// Unit vector to its middle.
    pub axis: DVec3,
    /// From there to its edge, in radians.
    pub angle: f64,
}

/// The directions that a flat convex polygon hides: a convex polygon whose sides are arcs of great circles.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    arcs: Vec<Arc>,
    /// A cap that contains it.
    around: Cap,
}

/// A side of a [`Facet`].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Arc {
    from: DVec3,
    to: DVec3,
    /// Unit normal of its plane, towards the inside of the facet.
    normal: DVec3,
}

/// All that hides parts of the sky.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Occluders {
    /// Of balls.
    pub caps: Vec<Cap>,
    /// Of plates.
    pub facets: Vec<Facet>,
}

impl Cap {
    /// The directions hidden by a ball with its centre at an offset.
    pub fn of_ball(offset: DVec3, radius: f64) -> Self {
        let distance = offset.length();
        Self { axis: offset / distance, angle: libm::asin((radius / distance).min(1.0)) }
    }

    /// Angle to its edge: negative inside.
    fn distance(&self, direction: DVec3) -> f64 {
        angle(self.axis, direction) - self.angle
    }
}

impl Facet {
    /// The directions hidden by a flat convex polygon with its corners at these offsets.
    pub fn new(corners: impl Iterator<Item = DVec3>) -> Self {
        let corners: Vec<DVec3> = corners.collect();
        let corner = |i: usize| corners.get(i).copied().unwrap_or_default();
        // Which way round they follow. Asked of the plane, so that the sides agree if it is seen edge-on.
        let turn = corner(0).dot((corner(1) - corner(0)).cross(corner(2) - corner(0))).signum();
        let arc = |(i, from): (usize, &DVec3)| {
            let (from, to) = (from.normalize_or_zero(), corners[(i + 1) % corners.len()].normalize_or_zero());
            Arc { from, to, normal: turn * from.cross(to).normalize_or_zero() }
        };
        let arcs: Vec<Arc> = corners.iter().enumerate().map(arc).collect();
        let axis = arcs.iter().map(|arc| arc.from).sum::<DVec3>().normalize_or_zero();
        let least = arcs.iter().map(|arc| axis.dot(arc.from)).fold(1.0, f64::min);
        // Larger caps are not convex.
        let around = Cap { axis, angle: if least > 0.0 { libm::acos(least) } else { PI } };
        Self { arcs, around }
    }

    /// The sine of the angle to the nearest great circle of its sides: negative outside.
    fn depth(&self, direction: DVec3) -> f64 {
        self.arcs.iter().map(|arc| arc.normal.dot(direction)).fold(1.0, f64::min)
    }

    /// Angle to its nearest side: negative inside.
    fn distance(&self, direction: DVec3) -> f64 {
        let depth = self.depth(direction);
        if depth > 0.0 {
            return -libm::asin(depth);
        }
        self.arcs.iter().map(|arc| arc.distance(direction)).fold(PI, f64::min)
    }
}

impl Arc {
    fn distance(&self, direction: DVec3) -> f64 {
        // The nearest place of the great circle, if it is between the ends.
        let along = self.normal.cross(direction);
        if self.from.dot(along) * self.to.dot(along) < 0.0 && (self.from + self.to).dot(direction) > 0.0 {
            libm::asin(self.normal.dot(direction).abs().min(1.0))
        } else {
            angle(self.from, direction).min(angle(self.to, direction))
        }
    }
}

impl Occluders {
    /// Angle from a direction to the nearest change of visibility, for a surface with this normal: positive where
    /// the sky is visible. It changes by no more than the direction does.
    pub fn distance(&self, normal: DVec3, direction: DVec3) -> f64 {
        let horizon = libm::asin(normal.dot(direction).clamp(-1.0, 1.0));
        let nearest = self.caps.iter().map(|cap| cap.distance(direction)).fold(horizon, f64::min);
        let nearer = |nearest: f64, facet: &Facet| {
            if facet.around.distance(direction) < nearest { nearest.min(facet.distance(direction)) } else { nearest }
        };
        self.facets.iter().fold(nearest, nearer)
    }

    /// A test that hides nothing but what they hide, made once for many directions.
    pub fn hide(&self) -> impl Fn(DVec3) -> bool {
        let caps: Vec<(DVec3, f64)> = self.caps.iter().map(|cap| (cap.axis, libm::cos(cap.angle))).collect();
        move |direction| {
            caps.iter().any(|(axis, cosine)| axis.dot(direction) > *cosine)
                || self.facets.iter().any(|facet| facet.depth(direction) > 0.0)
        }
    }
}

/// The angle between two unit vectors.
fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::acos(a.dot(b).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::random::Random;

    fn some_direction(random: &mut Random) -> DVec3 {
        let mut part = || 2.0 * random.unit() - 1.0;
        DVec3::new(part(), part(), part()).normalize_or_zero()
    }

    #[test]
    fn a_facet_is_as_far_as_its_nearest_side_at_fine_steps() {
        let corners = [[1.0, 2.0, 0.1], [-1.0, 2.0, 0.1], [-1.0, 2.2, 2.0], [0.5, 2.2, 2.0]].map(DVec3::from_array);
        let facet = Facet::new(corners.into_iter());
        let sides: Vec<DVec3> = (0..4)
            .flat_map(|i| (0..2000).map(move |j| corners[i].lerp(corners[(i + 1) % 4], f64::from(j) / 2000.0)))
            .map(DVec3::normalize)
            .collect();
        let mut random = Random::new(3);
        for _ in 0..200 {
            let direction = some_direction(&mut random);
            let nearest = sides.iter().map(|side| angle(*side, direction)).fold(PI, f64::min);
            let got = facet.distance(direction);
            assert!((got.abs() - nearest).abs() < 2e-3, "{direction}: {got}, not {nearest}");
        }
        assert!(facet.distance(DVec3::new(0.0, 2.1, 1.0).normalize()) < -0.2);
        assert!(facet.distance(DVec3::new(0.0, -2.1, -1.0).normalize()) > 1.0);
    }

    #[test]
    fn the_distance_changes_no_faster_than_the_direction() {
        let facet = Facet::new([[1.0, 2.0, 0.1], [-1.0, 2.0, 0.3], [0.0, 2.0, 2.0]].map(DVec3::from_array).into_iter());
        let cap = Cap::of_ball(DVec3::new(-1.0, -1.0, 1.0), 0.7);
        let occluders = Occluders { caps: vec![cap], facets: vec![facet] };
        let mut random = Random::new(5);
        for _ in 0..500 {
            let (a, b) = (some_direction(&mut random), some_direction(&mut random));
            let difference = (occluders.distance(DVec3::Z, a) - occluders.distance(DVec3::Z, b)).abs();
            assert!(difference <= angle(a, b) + 1e-9, "{a} {b}: {difference}");
        }
    }
}
