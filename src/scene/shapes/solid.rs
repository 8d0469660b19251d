//! Surfaces under construction: triangles, and the exact forms that they stand for.

use std::ops::Range;

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

/// The exact form of a part of a surface.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A ball.
    Ball {
        /// Its centre.
        centre: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A solid cone with a circular base.
    Cone {
        /// Its apex.
        apex: DVec3,
        /// The middle of its base.
        base: DVec3,
        /// The radius of its base.
        radius: f64,
    },
    /// A flat convex polygon.
    Polygon {
        /// Its corners, one after the other around it.
        corners: Vec<DVec3>,
    },
    /// A box, at any angle.
    Box {
        /// Its centre.
        centre: DVec3,
        /// From the centre to the middles of three faces that meet in a corner; at right angles to each other.
        halves: [DVec3; 3],
    },
}

/// A part of a surface that has an exact form.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its form.
    pub form: Form,
    /// The triangles that stand for it, as indices into those of the object.
    pub triangles: Range<usize>,
}

/// Triangles, and the exact forms of those that have one.
#[derive(Debug, Clone, Default, PartialEq)]
pub(in crate::scene) struct Solid {
    pub(in crate::scene) triangles: Vec<Triangle>,
    pub(in crate::scene) parts: Vec<Part>,
}

impl Form {
    /// The form somewhere else, where all lengths have grown by a factor.
    fn moved(&self, by: &DAffine3, factor: f64) -> Self {
        match self {
            Form::Ball { centre, radius } => {
                Form::Ball { centre: by.transform_point3(*centre), radius: radius * factor }
            }
            Form::Cone { apex, base, radius } => {
                let [apex, base] = [*apex, *base].map(|place| by.transform_point3(place));
                Form::Cone { apex, base, radius: radius * factor }
            }
            Form::Polygon { corners } => {
                Form::Polygon { corners: corners.iter().map(|corner| by.transform_point3(*corner)).collect() }
            }
            Form::Box { centre, halves } => Form::Box {
                centre: by.transform_point3(*centre),
                halves: halves.map(|half| by.transform_vector3(half)),
            },
        }
    }
}

impl Solid {
    /// Adds a solid, moved by a map that makes all lengths grow by a factor.
    pub(in crate::scene) fn add(&mut self, solid: &Solid, by: &DAffine3, factor: f64) {
        let first = self.triangles.len();
        self.triangles.extend(solid.triangles.iter().map(|triangle| triangle.moved(by)));
        self.parts.extend(solid.parts.iter().map(|part| Part {
            form: part.form.moved(by, factor),
            triangles: first + part.triangles.start..first + part.triangles.end,
        }));
    }

    /// Says which form the triangles from `first` on stand for.
    pub(in crate::scene) fn stand_for(&mut self, first: usize, form: Form) {
        self.parts.push(Part { form, triangles: first..self.triangles.len() });
    }
}

/// A flat convex polygon, its corners anticlockwise as seen from outside.
pub(in crate::scene) fn polygon(out: &mut Solid, corners: &[DVec3]) {
    let first = out.triangles.len();
    if let Some((corner, rest)) = corners.split_first() {
        out.triangles.extend(rest.windows(2).map(|pair| Triangle::flat([*corner, pair[0], pair[1]])));
    }
    out.stand_for(first, Form::Polygon { corners: corners.to_vec() });
}

/// A face of a block: four corners, anticlockwise as seen from outside.
fn face(out: &mut Vec<Triangle>, [a, b, c, d]: [DVec3; 4]) {
    out.push(Triangle::flat([a, b, c]));
    out.push(Triangle::flat([a, c, d]));
}

/// A block between two corners.
pub(in crate::scene) fn block(out: &mut Solid, lo: DVec3, hi: DVec3) {
    let first = out.triangles.len();
    let at = |x: bool, y: bool, z: bool| {
        DVec3::new(if x { hi.x } else { lo.x }, if y { hi.y } else { lo.y }, if z { hi.z } else { lo.z })
    };
    let (o, x) = (false, true);
    face(&mut out.triangles, [at(o, o, o), at(o, o, x), at(o, x, x), at(o, x, o)]);
    face(&mut out.triangles, [at(x, o, o), at(x, x, o), at(x, x, x), at(x, o, x)]);
    face(&mut out.triangles, [at(o, o, o), at(x, o, o), at(x, o, x), at(o, o, x)]);
    face(&mut out.triangles, [at(o, x, o), at(o, x, x), at(x, x, x), at(x, x, o)]);
    face(&mut out.triangles, [at(o, o, o), at(o, x, o), at(x, x, o), at(x, o, o)]);
    face(&mut out.triangles, [at(o, o, x), at(x, o, x), at(x, x, x), at(o, x, x)]);
    let half = 0.5 * (hi - lo);
    let halves = [DVec3::X * half.x, DVec3::Y * half.y, DVec3::Z * half.z];
    out.stand_for(first, Form::Box { centre: 0.5 * (lo + hi), halves });
}

/// A bar of a width between two places of the xy plane, as deep as `depth`, with the ends a little beyond them.
pub(in crate::scene) fn bar(out: &mut Solid, from: [f64; 2], to: [f64; 2], width: f64, depth: f64) {
    let (from, to) = (DVec3::new(from[0], from[1], 0.0), DVec3::new(to[0], to[1], 0.0));
    let along = (to - from).normalize_or(DVec3::X);
    let half = width / 2.0;
    let across = DVec3::new(-along.y, along.x, 0.0);
    let mut start = Solid::default();
    block(
        &mut start,
        DVec3::new(-half, -half, -depth / 2.0),
        DVec3::new((to - from).length() + half, half, depth / 2.0),
    );
    let place = DAffine3::from_cols(along, across, DVec3::Z, from);
    out.add(&start, &place, 1.0);
}

/// A curved surface: places and normals on a grid of (columns + 1) × (rows + 1) parameters from 0 to 1.
pub(in crate::scene) fn surface(out: &mut Solid, columns: u32, rows: u32, point: impl Fn(f64, f64) -> (DVec3, DVec3)) {
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
                    out.triangles.push(triangle);
                }
            }
            (left, left_below) = (right, right_below);
        }
    }
}
