//! Triangles under construction.

use glam::{DAffine3, DVec3};

/// A triangle with a normal at each corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// The corners.
    pub corners: [DVec3; 3],
    /// The normal of the surface that the triangle stands for, of length 1, at each corner.
    pub normals: [DVec3; 3],
}

impl Triangle {
    /// A flat triangle; its normal looks to where the corners go anticlockwise.
    pub fn flat(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize_or_zero();
        Self { corners, normals: [normal; 3] }
    }

    /// The triangle somewhere else.
    pub(crate) fn moved(&self, by: &DAffine3) -> Self {
        // Normals are mapped by the transposed inverse; for turns and a uniform scale that is the map itself.
        Self {
            corners: self.corners.map(|corner| by.transform_point3(corner)),
            normals: self.normals.map(|normal| by.transform_vector3(normal).normalize_or_zero()),
        }
    }
}

/// A flat piece with four corners, anticlockwise as seen from outside.
pub(in crate::scene) fn quad(out: &mut Vec<Triangle>, [a, b, c, d]: [DVec3; 4]) {
    out.push(Triangle::flat([a, b, c]));
    out.push(Triangle::flat([a, c, d]));
}

/// A block between two corners.
pub(in crate::scene) fn block(out: &mut Vec<Triangle>, lo: DVec3, hi: DVec3) {
    let at = |x: bool, y: bool, z: bool| {
        DVec3::new(if x { hi.x } else { lo.x }, if y { hi.y } else { lo.y }, if z { hi.z } else { lo.z })
    };
    let (o, x) = (false, true);
    quad(out, [at(o, o, o), at(o, o, x), at(o, x, x), at(o, x, o)]);
    quad(out, [at(x, o, o), at(x, x, o), at(x, x, x), at(x, o, x)]);
    quad(out, [at(o, o, o), at(x, o, o), at(x, o, x), at(o, o, x)]);
    quad(out, [at(o, x, o), at(o, x, x), at(x, x, x), at(x, x, o)]);
    quad(out, [at(o, o, o), at(o, x, o), at(x, x, o), at(x, o, o)]);
    quad(out, [at(o, o, x), at(x, o, x), at(x, x, x), at(o, x, x)]);
}

/// A bar of a width between two places of the xy plane, as deep as `depth`, with the ends a little beyond them.
pub(in crate::scene) fn bar(out: &mut Vec<Triangle>, from: [f64; 2], to: [f64; 2], width: f64, depth: f64) {
    let (from, to) = (DVec3::new(from[0], from[1], 0.0), DVec3::new(to[0], to[1], 0.0));
    let along = (to - from).normalize_or(DVec3::X);
    let half = width / 2.0;
    let across = DVec3::new(-along.y, along.x, 0.0);
    let mut start = Vec::new();
    block(
        &mut start,
        DVec3::new(-half, -half, -depth / 2.0),
        DVec3::new((to - from).length() + half, half, depth / 2.0),
    );
    let place = DAffine3::from_cols(along, across, DVec3::Z, from);
    out.extend(start.iter().map(|triangle| triangle.moved(&place)));
}

/// A curved surface: places and normals on a grid of (columns + 1) × (rows + 1) parameters from 0 to 1.
pub(in crate::scene) fn surface(
    out: &mut Vec<Triangle>,
    columns: u32,
    rows: u32,
    point: impl Fn(f64, f64) -> (DVec3, DVec3),
) {
    let at = |i: u32, j: u32| point(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows));
    for j in 0..rows {
        let (mut left, mut left_below) = (at(0, j), at(0, j + 1));
        for i in 1..=columns {
            let (right, right_below) = (at(i, j), at(i, j + 1));
            for corners in [[left, right, right_below], [left, right_below, left_below]] {
                let triangle = Triangle { corners: corners.map(|c| c.0), normals: corners.map(|c| c.1) };
                let [a, b, c] = triangle.corners;
                // At a pole two corners are the same place.
                if (b - a).cross(c - a).length() > 1e-14 {
                    out.push(triangle);
                }
            }
            (left, left_below) = (right, right_below);
        }
    }
}
