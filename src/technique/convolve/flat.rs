//! Triangles on the picture, in fixed point: a pixel's centre is inside of a triangle or not by whole numbers, which do
//! not round, so the CPU and every adapter decide alike. Depths are in single precision, relative to the nearest corner,
//! and computed in one order of operations everywhere.

use glam::{DVec2, DVec3};

use super::octahedron::{direction, packed};
use super::view::SlabView;
use crate::scene::{Scene, Triangle};

/// Units of a pixel.
pub const UNITS: i32 = 1 << 12;
/// The centre of a pixel, in units.
const CENTRE: i64 = (UNITS / 2) as i64;
/// Triangles are cut so many pixels away from the picture's first corner.
const FAR: f64 = 65536.0;
/// Bits of the numbers whose quotients are shares of a triangle: single precision holds them exactly.
const SHARE_BITS: u32 = 24;

/// A triangle on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flat {
    /// Its corners in units, in the order in which areas are positive.
    pub corners: [[i32; 2]; 3],
    /// Depths less that of the nearest corner of all; in perspective, over the depths.
    pub depths: [f32; 3],
    /// In perspective the inverses of the depths.
    pub inverses: [f32; 3],
    /// The directions of the surface's normals at the corners, as words.
    pub normals: [u32; 3],
    /// Set if it faces the viewer.
    pub front: bool,
    /// Number of the triangle in the scene.
    pub triangle: u32,
    /// Number of its object.
    pub object: u32,
    /// The first column and row of pixels that it can cover.
    pub first: [u32; 2],
    /// The number of columns and rows.
    pub extent: [u32; 2],
    /// Bits by which doubled areas are shifted to have `SHARE_BITS`.
    pub shift: u32,
    /// Its own doubled area, shifted.
    pub area: f32,
    /// Of each edge, opposite of the corner with that number: set if a centre on it is inside.
    pub ties: [bool; 3],
}

/// The triangles of a scene.
#[derive(Debug, Clone, Default)]
pub struct Flats {
    /// The triangles before the viewer that can cover a pixel.
    pub all: Vec<Flat>,
    /// The depth that theirs are relative to.
    pub base: f64,
    /// Set if depths are linear on the picture; otherwise they are quotients.
    pub parallel: bool,
}

/// A surface at a pixel of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fragment {
    /// The column and row of the pixel.
    pub pixel: [u32; 2],
    /// The depth there, relative to the base.
    pub depth: f32,
    /// The direction of the surface's normal there, as a word.
    pub normal: u32,
}

/// The triangle that a polygon is a part of.
#[derive(Debug, Clone, Copy)]
struct Of {
    triangle: u32,
    object: u32,
    /// Set if its corners go anticlockwise seen from where its normals look.
    outward: bool,
}

/// A corner of a polygon before the viewer.
#[derive(Debug, Clone, Copy)]
struct Seen {
    place: DVec3,
    normal: DVec3,
}

/// A corner of a polygon on the picture.
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: DVec2,
    depth: f64,
    inverse: f64,
    normal: DVec3,
}

impl Flats {
    /// The triangles of a scene as a view has them.
    pub fn new(scene: &Scene, view: &SlabView) -> Self {
        let seen = |(index, (object, triangle)): (usize, (usize, &Triangle))| {
            let corner =
                |i: usize| Seen { place: view.seen(triangle.corners[i]), normal: view.turned(triangle.normals[i]) };
            let polygon = cut_at(&[0, 1, 2].map(corner), view.near());
            // A triangle faces where its normals look, whatever the order of its corners.
            let [a, b, c] = triangle.corners;
            let outward = (b - a).cross(c - a).dot(triangle.normals.iter().sum()) >= 0.0;
            (!polygon.is_empty()).then_some((Of { triangle: index as u32, object: object as u32, outward }, polygon))
        };
        let polygons: Vec<(Of, Vec<Seen>)> = scene.triangles().enumerate().filter_map(seen).collect();
        let depths = polygons.iter().flat_map(|(_, polygon)| polygon).map(|corner| corner.place.z);
        let base = depths.fold(f64::INFINITY, f64::min);
        let mut all = Vec::new();
        for (of, polygon) in polygons {
            let corner = |Seen { place, normal }: Seen| {
                let inverse = if view.is_parallel() { 1.0 } else { 1.0 / place.z };
                Corner { at: view.pixel(place), depth: (place.z - base) * inverse, inverse, normal }
            };
            let polygon = within(polygon.into_iter().map(corner).collect());
            let Some((head, rest)) = polygon.split_first() else { continue };
            let pairs = rest.windows(2);
            all.extend(pairs.filter_map(|pair| Flat::new([*head, pair[0], pair[1]], of, view.size)));
        }
        Self { all, base: if base.is_finite() { base } else { 0.0 }, parallel: view.is_parallel() }
    }
}

impl Flat {
    fn new(corners: [Corner; 3], of: Of, size: (u32, u32)) -> Option<Self> {
        let fixed = |at: DVec2| (at * f64::from(UNITS)).round().to_array().map(|at| at as i32);
        let mut corners = corners.map(|corner| (fixed(corner.at), corner));
        let doubled = side(corners[0].0, corners[1].0, corners[2].0);
        // Outside is where corners go anticlockwise, and y points down.
        let front = (doubled < 0) == of.outward;
        if doubled < 0 {
            corners.swap(1, 2);
        }
        let at = corners.map(|(at, ..)| at);
        let doubled = doubled.abs();
        let span = |axis: usize, pixels: u32| {
            let along = at.map(|at| i64::from(at[axis]));
            let lo = along.into_iter().min().unwrap_or_default() - CENTRE;
            let hi = along.into_iter().max().unwrap_or_default() - CENTRE;
            let unit = i64::from(UNITS);
            let first = (-(-lo).div_euclid(unit)).clamp(0, i64::from(pixels));
            let end = (hi.div_euclid(unit) + 1).clamp(0, i64::from(pixels));
            (first as u32, (end - first).max(0) as u32)
        };
        let [(column, columns), (row, rows)] = [span(0, size.0), span(1, size.1)];
        if doubled == 0 || columns == 0 || rows == 0 {
            return None;
        }
        let shift = (64 - doubled.leading_zeros()).saturating_sub(SHARE_BITS);
        let tie = |i: usize| {
            let (from, to) = (at[(i + 1) % 3], at[(i + 2) % 3]);
            let edge = [to[0] - from[0], to[1] - from[1]];
            edge[1] < 0 || edge[1] == 0 && edge[0] > 0
        };
        Some(Self {
            corners: at,
            depths: corners.map(|(_, corner)| corner.depth as f32),
            inverses: corners.map(|(_, corner)| corner.inverse as f32),
            normals: corners.map(|(_, corner)| packed(corner.normal.as_vec3().to_array())),
            front,
            triangle: of.triangle,
            object: of.object,
            first: [column, row],
            extent: [columns, rows],
            shift,
            area: (doubled >> shift) as f32,
            ties: [0, 1, 2].map(tie),
        })
    }

    /// Calls for every pixel whose centre is inside.
    ///
    /// A centre on an edge counts as a little to the right of it, then below: so each belongs to exactly one of two
    /// triangles that share the edge.
    pub fn fragments(&self, parallel: bool, mut each: impl FnMut(Fragment)) {
        let centre = |pixel: u32| (i64::from(pixel) * i64::from(UNITS) + CENTRE) as i32;
        let ends = |i: usize| (self.corners[(i + 1) % 3], self.corners[(i + 2) % 3]);
        for y in self.first[1]..self.first[1] + self.extent[1] {
            let at = [centre(self.first[0]), centre(y)];
            let mut sides = [0, 1, 2].map(|i| side(ends(i).0, ends(i).1, at));
            let steps = [0, 1, 2].map(|i| i64::from(ends(i).0[1] - ends(i).1[1]) * i64::from(UNITS));
            for x in self.first[0]..self.first[0] + self.extent[0] {
                if (0..3).all(|i| sides[i] > 0 || sides[i] == 0 && self.ties[i]) {
                    let [b, c] = [sides[1], sides[2]].map(|area| (area >> self.shift) as f32 / self.area);
                    each(Fragment { pixel: [x, y], depth: self.depth(b, c, parallel), normal: self.normal(b, c) });
                }
                sides.iter_mut().zip(steps).for_each(|(side, step)| *side += step);
            }
        }
    }

    /// The depth at a place, from the shares of the second and third corner in it.
    fn depth(&self, b: f32, c: f32, parallel: bool) -> f32 {
        let mixed = |values: [f32; 3]| values[0] + b * (values[1] - values[0]) + c * (values[2] - values[0]);
        if parallel { mixed(self.depths) } else { mixed(self.depths) / mixed(self.inverses) }
    }

    /// The normal there.
    fn normal(&self, b: f32, c: f32) -> u32 {
        if self.normals[1..].iter().all(|normal| *normal == self.normals[0]) {
            return self.normals[0];
        }
        let corners = self.normals.map(direction);
        packed([0, 1, 2].map(|i| {
            let of = |corner: usize| corners[corner][i];
            of(0) + b * (of(1) - of(0)) + c * (of(2) - of(0))
        }))
    }
}

/// Twice the area that an edge spans with a place: positive to its left (y points down).
fn side(from: [i32; 2], to: [i32; 2], at: [i32; 2]) -> i64 {
    let between = |a: i32, b: i32| i64::from(b) - i64::from(a);
    between(from[0], to[0]) * between(from[1], at[1]) - between(from[1], to[1]) * between(from[0], at[0])
}

/// The part of a triangle that is no nearer than `near`.
fn cut_at(corners: &[Seen; 3], near: f64) -> Vec<Seen> {
    let mut out = Vec::with_capacity(4);
    for (i, from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % 3];
        let [before, after] = [from.place.z >= near, to.place.z >= near];
        if before {
            out.push(*from);
        }
        if before != after {
            // From the nearer end, so that both triangles at an edge get the same place.
            let (a, b) = if before { (to, *from) } else { (*from, to) };
            let share = (near - a.place.z) / (b.place.z - a.place.z);
            out.push(Seen { place: a.place.lerp(b.place, share), normal: a.normal.lerp(b.normal, share) });
        }
    }
    out
}

/// The part of a polygon that is no farther away than [`FAR`], in which fixed point has room.
fn within(mut polygon: Vec<Corner>) -> Vec<Corner> {
    for (axis, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let room = |corner: &Corner| FAR - sign * corner.at[axis];
        if polygon.iter().all(|corner| room(corner) >= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (i, from) in polygon.iter().enumerate() {
            let to = &polygon[(i + 1) % polygon.len()];
            if room(from) >= 0.0 {
                kept.push(*from);
            }
            if (room(from) >= 0.0) != (room(to) >= 0.0) {
                let (a, b) = if room(from) < room(to) { (from, to) } else { (to, from) };
                let share = room(a) / (room(a) - room(b));
                let mix = |a: f64, b: f64| a + share * (b - a);
                let (depth, inverse) = (mix(a.depth, b.depth), mix(a.inverse, b.inverse));
                let normal = a.normal.lerp(b.normal, share);
                kept.push(Corner { at: a.at.lerp(b.at, share), depth, inverse, normal });
            }
        }
        polygon = kept;
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    const OF: Of = Of { triangle: 0, object: 0, outward: true };

    fn corner(x: f64, y: f64, depth: f64) -> Corner {
        Corner { at: DVec2::new(x, y), depth, inverse: 1.0, normal: DVec3::Z }
    }

    /// Triangles around a place share their edges, with centres on edges and on corners: each centre belongs to one.
    #[test]
    fn a_centre_belongs_to_one_triangle() {
        let ring = [(0.0, 0.0), (4.5, 0.5), (8.0, 0.0), (8.0, 8.0), (2.5, 7.5), (0.0, 8.0)];
        let middle = corner(3.5, 3.5, 0.0);
        let mut counts = [0; 64];
        for (i, (x, y)) in ring.iter().enumerate() {
            let next = ring[(i + 1) % ring.len()];
            // Both orders of corners: one faces the viewer, one does not.
            for corners in [
                [middle, corner(*x, *y, 1.0), corner(next.0, next.1, 1.0)],
                [middle, corner(next.0, next.1, 1.0), corner(*x, *y, 1.0)],
            ] {
                let Some(flat) = Flat::new(corners, OF, (8, 8)) else { continue };
                flat.fragments(true, |Fragment { pixel: [x, y], .. }| {
                    counts[(y * 8 + x) as usize] += if flat.front { 1 } else { 100 }
                });
            }
        }
        assert!(counts.iter().all(|count| *count == 101 || *count == 0), "{counts:?}");
        assert!(counts.iter().filter(|count| **count == 101).count() > 54);
    }

    #[test]
    fn depths_are_linear_and_far_corners_are_cut() {
        let flat = Flat::new([corner(0.0, 0.0, 1.0), corner(64.0, 0.0, 3.0), corner(0.0, 64.0, 2.0)], OF, (8, 8));
        flat.expect("covers").fragments(true, |Fragment { pixel: [x, y], depth, .. }| {
            let expected = 1.0 + (x as f32 + 0.5) / 32.0 + (y as f32 + 0.5) / 64.0;
            assert!((depth - expected).abs() < 1e-6, "{depth} {expected}");
        });
        let cut = within(vec![corner(-1e9, 0.0, 0.0), corner(1e9, 4.0, 1.0), corner(1e9, 9.0, 1.0)]);
        assert!(cut.len() == 4 && cut.iter().all(|corner| corner.at.x.abs() <= FAR + 1.0), "{cut:?}");
    }
}
