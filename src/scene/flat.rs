//! Flat convex polygons: their plane, and the tests that a list of corners is one.

use glam::DVec3;

/// A reason why corners are no flat convex polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Fault {
    /// The corner with this index repeats an earlier one.
    Repeated(usize),
    /// All corners lie on a line.
    Area,
    /// The corner with this index lies off the plane of the others, by this distance.
    Plane(usize, f64),
    /// The side that begins at the first of these corners has the second one on its outer side.
    Convex(usize, usize),
}

/// The sum of the cross products of the sides as seen from the first corner: normal to the plane, towards the side
/// from which the corners go counter-clockwise, and twice as long as the area is large.
pub(super) fn cross(corners: &[DVec3]) -> DVec3 {
    let Some((first, rest)) = corners.split_first() else { return DVec3::ZERO };
    rest.windows(2).map(|pair| (pair[0] - *first).cross(pair[1] - *first)).sum()
}

/// Checks that corners, at least three, are a flat convex polygon with an area.
pub(crate) fn check(corners: &[DVec3]) -> Result<(), Fault> {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = corners.iter().fold(start, |(lo, hi), at| (lo.min(*at), hi.max(*at)));
    let extent = (hi - lo).max_element();
    // Coordinates are written in decimal: a corner that is computed by hand is off its plane by a last digit.
    let slack = 1e-6 * extent;
    let repeats = |index: &usize| corners[..*index].iter().any(|other| (*other - corners[*index]).length() <= slack);
    if let Some(index) = (1..corners.len()).find(repeats) {
        return Err(Fault::Repeated(index));
    }
    let cross = cross(corners);
    if cross.length() <= slack * extent {
        return Err(Fault::Area);
    }
    let normal = cross.normalize();
    let height = |corner: &DVec3| (*corner - corners[0]).dot(normal);
    let (highest, off) =
        corners.iter().map(height).enumerate().fold((0, 0.0_f64), |most, (index, height)| {
            if height.abs() > most.1.abs() { (index, height) } else { most }
        });
    if off.abs() > slack {
        return Err(Fault::Plane(highest, off.abs()));
    }
    // Every corner on the inner side of every edge: this also refuses outlines that go round more than once.
    for (index, from) in corners.iter().enumerate() {
        let side = (corners[(index + 1) % corners.len()] - *from).normalize();
        let inwards = normal.cross(side);
        if let Some(outside) = corners.iter().position(|corner| (*corner - *from).dot(inwards) < -slack) {
            return Err(Fault::Convex(index, outside));
        }
    }
    Ok(())
}
