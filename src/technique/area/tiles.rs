//! Tiles of a picture, and the occluders that can matter to all of a tile's pixels.

use glam::DVec3;

use super::lit::Lit;
use crate::scene::light::Polygon;
use crate::scene::rays::SurfacePoint;

/// Pixels along a side of a tile.
pub(super) const SIDE: usize = 8;

/// A ball: its centre and its radius.
type Ball = (DVec3, f64);

/// The pixels of a tile of which something is seen.
pub(super) fn pixels(lit: &Lit, column: usize, row: usize) -> impl Iterator<Item = (usize, &SurfacePoint)> {
    let (width, height) = (lit.surfaces.width as usize, lit.surfaces.height as usize);
    let rows = row * SIDE..height.min((row + 1) * SIDE);
    let columns = column * SIDE..width.min((column + 1) * SIDE);
    let all = rows.flat_map(move |y| columns.clone().map(move |x| y * width + x));
    all.filter_map(|pixel| Some((pixel, lit.surfaces.points[pixel].as_ref()?)))
}

/// The indices of the occluders that can lie between some points and a light.
pub(super) fn candidates(lit: &Lit, light: &Polygon, points: impl Iterator<Item = DVec3> + Clone) -> Vec<usize> {
    let (from, to) = (ball(points), ball(light.corners.iter().copied()));
    let meets = |index: &usize| between(from, to, lit.occluders[*index].sphere());
    (0..lit.occluders.len()).filter(meets).collect()
}

/// A ball around places.
fn ball(places: impl Iterator<Item = DVec3> + Clone) -> Ball {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = places.clone().fold(start, |(lo, hi), at| (lo.min(at), hi.max(at)));
    let centre = 0.5 * (lo + hi);
    (centre, places.map(|at| at.distance(centre)).fold(0.0, f64::max))
}

/// Returns whether a ball meets the convex hull of two others, which is made of all balls between them.
fn between((a, first): Ball, (b, last): Ball, (centre, radius): Ball) -> bool {
    let (along, offset) = (b - a, centre - a);
    let length = along.length();
    // The distance from the axis, less the radius there, is least where it falls as fast as the radius grows.
    let slope = if length > 0.0 { (last - first) / length } else { 0.0 };
    let near = if length > 0.0 { offset.dot(along) / length } else { 0.0 };
    let aside = (offset.length_squared() - near * near).max(0.0).sqrt();
    let shift =
        if slope.abs() < 1.0 { slope * aside / (1.0 - slope * slope).sqrt() } else { slope.signum() * f64::MAX };
    let at = |t: f64| (offset - along * t).length() - (first + (last - first) * t);
    let t = if length > 0.0 { ((near + shift) / length).clamp(0.0, 1.0) } else { 0.0 };
    at(t).min(at(0.0)).min(at(1.0)) <= radius * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::random::Random;

    #[test]
    fn a_ball_is_between_others_where_a_ball_between_them_meets_it() {
        let mut random = Random::new(5);
        let mut counts = [0; 2];
        for _ in 0..5000 {
            let mut ball = |reach: f64| {
                let mut unit = || 2.0 * random.unit() - 1.0;
                (DVec3::new(unit(), unit(), unit()) * 3.0, unit().abs() * reach)
            };
            let (a, b, other) = (ball(2.0), ball(2.0), ball(0.5));
            let meets = |t: f64| a.0.lerp(b.0, t).distance(other.0) <= a.1 + (b.1 - a.1) * t + other.1;
            let expected = (0..=2000).any(|step| meets(f64::from(step) / 2000.0));
            let found = between(a, b, other);
            // Steps may miss what just touches, and nothing may be missed.
            assert!(found || !expected, "{a:?} {b:?} {other:?}");
            let larger = (other.0, other.1 + 0.01);
            let nearly = (0..=2000).any(|step| {
                let t = f64::from(step) / 2000.0;
                a.0.lerp(b.0, t).distance(larger.0) <= a.1 + (b.1 - a.1) * t + larger.1
            });
            assert!(nearly || !found, "{a:?} {b:?} {other:?}");
            counts[usize::from(found)] += 1;
        }
        assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
    }
}
