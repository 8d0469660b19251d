//! Balls and cones as rays meet them exactly, without the triangles that stand for them.

use glam::DVec3;

use super::Form;

/// A solid with a curved surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Round {
    Ball { centre: DVec3, radius: f64 },
    Cone { apex: DVec3, base: DVec3, radius: f64 },
}

/// An end of a segment that lies on a surface is on either side of it by rounding: what is this much smaller counts.
const WITHIN: f64 = 1.0 - 1e-9;

impl Round {
    /// The solid of a form; `None` if its surface is flat.
    pub(super) fn of(form: &Form) -> Option<Self> {
        match form {
            Form::Ball { centre, radius } => Some(Round::Ball { centre: *centre, radius: *radius }),
            Form::Cone { apex, base, radius } => Some(Round::Cone { apex: *apex, base: *base, radius: *radius }),
            Form::Polygon { .. } | Form::Box { .. } => None,
        }
    }

    /// Distance along a ray, whose direction has length 1, to where it enters the solid, and the normal there.
    pub(super) fn entry(&self, (start, direction): (DVec3, DVec3)) -> Option<(f64, DVec3)> {
        match *self {
            Round::Ball { centre, radius } => {
                let offset = start - centre;
                let along = offset.dot(direction);
                let square = along * along - offset.length_squared() + radius * radius;
                let distance = -along - square.max(0.0).sqrt();
                let normal = || (start + direction * distance - centre) / radius;
                (square > 0.0 && distance > 0.0).then(|| (distance, normal()))
            }
            Round::Cone { apex, base, radius } => cone(Cone::new(apex, base, radius), start, direction),
        }
    }

    /// Returns whether an open segment meets its interior.
    pub(super) fn meets(&self, from: DVec3, to: DVec3) -> bool {
        let along = to - from;
        match *self {
            Round::Ball { centre, radius } => {
                let nearest = ((centre - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                (from + along * nearest - centre).length_squared() < WITHIN * radius * radius
            }
            Round::Cone { apex, base, radius } => {
                let cone = Cone::new(apex, base, WITHIN * radius);
                let Some((first, last)) = cone.beside(from, along, (0.0, 1.0)) else { return false };
                let [quadratic, linear, _] = cone.form(from, along);
                let lowest = if quadratic > 0.0 { (-linear / quadratic).clamp(first, last) } else { first };
                [first, lowest, last].into_iter().any(|at| cone.height(from + along * at) < 0.0)
            }
        }
    }
}

/// A cone by its apex and the direction to its base.
struct Cone {
    apex: DVec3,
    axis: DVec3,
    length: f64,
    /// Square of its radius over its depth below the apex.
    slope: f64,
}

impl Cone {
    fn new(apex: DVec3, base: DVec3, radius: f64) -> Self {
        let length = apex.distance(base);
        Self { apex, axis: (base - apex) / length, length, slope: (radius / length).powi(2) }
    }

    /// The scalar product that is negative of a vector from the apex with itself inside the double cone.
    fn product(&self, a: DVec3, b: DVec3) -> f64 {
        a.dot(b) - (1.0 + self.slope) * a.dot(self.axis) * b.dot(self.axis)
    }

    /// Negative inside the double cone.
    fn height(&self, place: DVec3) -> f64 {
        self.product(place - self.apex, place - self.apex)
    }

    /// The height along a line, as a t^2 + 2 b t + c.
    fn form(&self, start: DVec3, along: DVec3) -> [f64; 3] {
        let from = start - self.apex;
        [self.product(along, along), self.product(from, along), self.product(from, from)]
    }

    /// The part of a line between the planes of the apex and of the base.
    fn beside(&self, start: DVec3, along: DVec3, (first, last): (f64, f64)) -> Option<(f64, f64)> {
        let (depth, speed) = ((start - self.apex).dot(self.axis), along.dot(self.axis));
        if speed == 0.0 {
            return (depth > 0.0 && depth < self.length).then_some((first, last));
        }
        let (a, b) = (-depth / speed, (self.length - depth) / speed);
        let (first, last) = (first.max(a.min(b)), last.min(a.max(b)));
        (first < last).then_some((first, last))
    }
}

/// The distance at which a ray enters a cone, and the normal there.
fn cone(cone: Cone, start: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
    let (first, last) = cone.beside(start, direction, (0.0, f64::INFINITY))?;
    let at = |distance: f64| start + direction * distance;
    if cone.height(at(first)) < 0.0 {
        // Through the base; or from inside, where nothing is entered.
        return (first > 0.0).then_some((first, cone.axis));
    }
    let [a, b, c] = cone.form(start, direction);
    let root = (b * b - a * c).max(0.0).sqrt();
    // The stable form of both solutions; of a line along the surface there is one.
    let sum = -(b + root.copysign(b));
    let entered = [sum / a, c / sum].into_iter().filter(|distance| *distance > first && *distance < last);
    let distance = entered.min_by(f64::total_cmp).filter(|_| b * b - a * c > 0.0)?;
    let from = at(distance) - cone.apex;
    Some((distance, (from - (1.0 + cone.slope) * from.dot(cone.axis) * cone.axis).normalize_or_zero()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CONE: Round = Round::Cone { apex: DVec3::new(0.0, 2.0, 0.0), base: DVec3::ZERO, radius: 1.0 };

    fn inside(place: DVec3) -> bool {
        let radius = 1.0 - place.y / 2.0;
        place.y > 0.0 && place.y < 2.0 && place.x.hypot(place.z) < radius
    }

    #[test]
    fn rays_enter_cones_where_their_points_begin_to_lie_inside() {
        let place = |index: u32, radius: f64| {
            let [a, b] = [0.618, 0.7548].map(|step: f64| (f64::from(index) * step).fract());
            let (angle, up) = (a * std::f64::consts::TAU, 2.0 * b - 1.0);
            let out = (1.0 - up * up).sqrt();
            DVec3::new(out * angle.cos(), up, out * angle.sin()) * radius + DVec3::Y
        };
        let mut hits = 0;
        for index in 0..2000 {
            let (from, to) = (place(index, 4.0), place(7 * index + 3, 1.5));
            let direction = (to - from).normalize();
            let steps = 4000;
            let along = |step: u32| from + direction * (8.0 * f64::from(step) / f64::from(steps));
            let first = (0..steps).find(|step| inside(along(*step)));
            match (CONE.entry((from, direction)), first) {
                (Some((distance, normal)), Some(step)) => {
                    assert!((distance - 8.0 * f64::from(step) / f64::from(steps)).abs() < 0.01, "{index}");
                    let place = from + direction * distance;
                    assert!(!inside(place + normal * 1e-6) && normal.dot(direction) <= 1e-9, "{index}: {normal}");
                    assert!((normal.length() - 1.0).abs() < 1e-9);
                    hits += 1;
                }
                // Through less than a step of it.
                (Some((distance, _)), None) => assert!(!inside(from + direction * (distance + 0.01)), "{index}"),
                (None, first) => assert_eq!(first, None, "{index}"),
            }
            let end = from + direction * 8.0;
            assert!(CONE.meets(from, end) || first.is_none(), "{index}");
            assert_eq!(CONE.meets(from, end), CONE.meets(end, from), "{index}");
        }
        assert!(hits > 300, "{hits}");
    }

    #[test]
    fn a_segment_ends_where_it_ends() {
        let from = DVec3::new(-3.0, 0.5, 0.0);
        assert!(!CONE.meets(from, DVec3::new(-0.76, 0.5, 0.0)));
        assert!(CONE.meets(from, DVec3::new(-0.74, 0.5, 0.0)));
        assert!(CONE.meets(DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.6, 0.0)), "inside");
        // A place on its surface does not hide itself.
        let on = DVec3::new(0.5, 1.0, 0.0);
        assert!(!CONE.meets(on, on + DVec3::new(1.0, 0.5, 0.0)));
        assert!(!CONE.meets(DVec3::new(0.2, 0.0, 0.0), DVec3::new(0.2, -1.0, 0.0)));
    }
}
