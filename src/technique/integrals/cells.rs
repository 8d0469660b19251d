//! The sphere of directions at a shading point, divided into cells with a
//! straight border of visibility.
//!
//! A cell is split while a lobe is not nearly linear in it, or while the signed
//! distance to the border of visibility is not nearly bilinear. Of a cell that
//! is kept the visible part is a polygon in azimuth φ and polar angle θ, and its
//! integral is a sum over the polygon's edges, each of which stands for the
//! area between itself and the cell's upper side `θ0`.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::{Lobe, Occluders, Settings};

/// Cells of the base grid, in azimuth and polar angle.
const BASE: (u32, u32) = (8, 4);

/// The area between an edge and the cell's side `theta`, to be added or subtracted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Ends, with ascending azimuth: (φ, θ).
    pub ends: [DVec2; 2],
    /// The constant side.
    pub theta: f64,
    /// 1 or -1.
    pub sign: f64,
    /// The cell it belongs to, as an index into [`Division::cells`].
    pub cell: usize,
}

/// A cell that is kept: the range of direction times axis, for each lobe.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Smallest and largest cosine to the axis.
    pub ranges: Vec<(f64, f64)>,
}

/// The visible directions at a point, in pieces.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Division {
    /// The cells with a visible part.
    pub cells: Vec<Cell>,
    /// Edges of the visible parts.
    pub edges: Vec<Edge>,
}

/// A rectangle in azimuth and polar angle.
#[derive(Debug, Clone, Copy)]
struct Patch {
    lo: DVec2,
    hi: DVec2,
    depth: u32,
}

/// The view from a point.
#[derive(Debug)]
struct View<'a> {
    normal: DVec3,
    occluders: &'a Occluders,
}

/// The direction with an azimuth and a polar angle.
pub fn direction(at: DVec2) -> DVec3 {
    let (sin, cos) = libm::sincos(at.y);
    DVec3::new(libm::cos(at.x) * sin, libm::sin(at.x) * sin, cos)
}

impl View<'_> {
    /// Angle to the nearest change of visibility: positive where visible.
    fn distance(&self, at: DVec2) -> f64 {
        self.occluders.distance(self.normal, direction(at))
    }
}

/// Divides the directions that are visible at a place with this normal, between these occluders.
pub fn divide(normal: DVec3, occluders: &Occluders, lobes: &[Lobe], settings: &Settings) -> Division {
    let view = View { normal, occluders };
    let step = DVec2::new(TAU / f64::from(BASE.0), PI / f64::from(BASE.1));
    let mut stack: Vec<Patch> = (0..BASE.0 * BASE.1)
        .map(|i| {
            let lo = DVec2::new(f64::from(i % BASE.0), f64::from(i / BASE.0)) * step;
            Patch { lo, hi: lo + step, depth: 0 }
        })
        .collect();
    let mut division = Division::default();
    while let Some(patch) = stack.pop() {
        let centre = 0.5 * (patch.lo + patch.hi);
        let half = 0.5 * (patch.hi - patch.lo);
        let at_centre = view.distance(centre);
        // No direction of the patch is farther from its centre.
        let reach = libm::hypot(half.x * widest(patch), half.y);
        if at_centre < -reach {
            continue;
        }
        let border = at_centre.abs() <= reach;
        let corners = corners(patch).map(|at| (at, view.distance(at)));
        let ranges: Vec<(f64, f64)> = lobes.iter().map(|lobe| range(patch, lobe.axis)).collect();
        let bent = border && bent(&view, patch, &corners, settings.border);
        let curved = lobes.iter().zip(&ranges).any(|(lobe, range)| curvature(lobe, *range) > settings.lobe);
        if (bent || curved) && patch.depth < settings.depth {
            stack.extend(quarters(patch));
            continue;
        }
        let before = division.edges.len();
        let cell = division.cells.len();
        for polygon in polygons(&view, &corners, at_centre) {
            edges(&view, patch, &polygon, cell, &mut division.edges);
        }
        if division.edges.len() > before {
            division.cells.push(Cell { ranges });
        }
    }
    division
}

/// Largest sine of the polar angle in a patch.
fn widest(patch: Patch) -> f64 {
    if patch.lo.y <= 0.5 * PI && patch.hi.y >= 0.5 * PI {
        1.0
    } else {
        libm::sin(patch.lo.y).max(libm::sin(patch.hi.y))
    }
}

/// The corners, counter-clockwise.
fn corners(patch: Patch) -> [DVec2; 4] {
    let Patch { lo, hi, .. } = patch;
    [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)]
}

fn quarters(patch: Patch) -> [Patch; 4] {
    let centre = 0.5 * (patch.lo + patch.hi);
    corners(patch).map(|corner| Patch { lo: corner.min(centre), hi: corner.max(centre), depth: patch.depth + 1 })
}

/// Returns whether the distance differs from the interpolation of its corner values.
fn bent(view: &View<'_>, patch: Patch, corners: &[(DVec2, f64); 4], threshold: f64) -> bool {
    let at = |x: f64, y: f64| {
        let place = patch.lo + DVec2::new(x, y) * (patch.hi - patch.lo);
        let [a, b, c, d] = corners.map(|(_, distance)| distance);
        let bilinear = (1.0 - y) * ((1.0 - x) * a + x * b) + y * ((1.0 - x) * d + x * c);
        (view.distance(place) - bilinear).abs()
    };
    [(0.5, 0.5), (0.5, 0.0), (1.0, 0.5), (0.5, 1.0), (0.0, 0.5)].into_iter().any(|(x, y)| at(x, y) > threshold)
}

/// The range of the cosine to an axis in a patch, exactly.
fn range(patch: Patch, axis: DVec3) -> (f64, f64) {
    let azimuth = if axis.x == 0.0 && axis.y == 0.0 { 0.0 } else { libm::atan2(axis.y, axis.x) };
    let polar = libm::acos(axis.z.clamp(-1.0, 1.0));
    let inside = |at: DVec2| {
        let turned = patch.lo.x + (at.x - patch.lo.x).rem_euclid(TAU);
        turned <= patch.hi.x && (patch.lo.y..=patch.hi.y).contains(&at.y)
    };
    let mut all: Vec<f64> = corners(patch).iter().map(|at| axis.dot(direction(*at))).collect();
    // Extremes inside of a side of constant polar angle, then of constant azimuth.
    for theta in [patch.lo.y, patch.hi.y] {
        for phi in [azimuth, azimuth + PI] {
            if inside(DVec2::new(phi, theta)) {
                all.push(axis.dot(direction(DVec2::new(phi, theta))));
            }
        }
    }
    for phi in [patch.lo.x, patch.hi.x] {
        let theta = libm::atan2(axis.x * libm::cos(phi) + axis.y * libm::sin(phi), axis.z);
        for theta in [theta, theta + PI, theta - PI] {
            if (patch.lo.y..=patch.hi.y).contains(&theta) {
                all.push(axis.dot(direction(DVec2::new(phi, theta))));
            }
        }
    }
    if inside(DVec2::new(azimuth, polar)) {
        all.push(1.0);
    }
    if inside(DVec2::new(azimuth + PI, PI - polar)) {
        all.push(-1.0);
    }
    let lo = all.iter().copied().fold(1.0, f64::min);
    (lo.max(-1.0), all.iter().copied().fold(-1.0, f64::max).min(1.0))
}

/// The error of the linear approximation of a lobe over a range, relative to its largest value.
fn curvature(lobe: &Lobe, (a, b): (f64, f64)) -> f64 {
    let y = 0.5 * lobe.sharpness * (b - a);
    let largest = libm::exp(lobe.sharpness * (b - 1.0));
    // The error at the ends of the range grows like y²/3, up to the value itself.
    largest * (libm::exp(-y) * y * y / 3.0).max(if y > 1.0 { 0.5 } else { 0.0 })
}

/// The visible parts of a patch: polygons in azimuth and polar angle, counter-clockwise.
fn polygons(view: &View<'_>, corners: &[(DVec2, f64); 4], at_centre: f64) -> Vec<Vec<DVec2>> {
    let mut outline: Vec<DVec2> = Vec::new();
    let mut crossings = Vec::new();
    for i in 0..4 {
        let ((from, d), (to, e)) = (corners[i], corners[(i + 1) % 4]);
        if d > 0.0 {
            outline.push(from);
        }
        if (d > 0.0) != (e > 0.0) {
            crossings.push(outline.len());
            outline.push(crossing(view, (from, d), (to, e)));
        }
    }
    if crossings.len() == 4 && at_centre <= 0.0 {
        // Two opposite corners are visible and the centre is not: a triangle at each.
        let first_visible = usize::from(corners[0].1 <= 0.0);
        let triangle = |corner: usize| {
            let own = outline.iter().position(|at| *at == corners[corner].0).unwrap_or(0);
            let count = outline.len();
            vec![outline[(own + count - 1) % count], outline[own], outline[(own + 1) % count]]
        };
        return vec![triangle(first_visible), triangle(first_visible + 2)];
    }
    if outline.len() < 3 { Vec::new() } else { vec![outline] }
}

/// The place where the distance is zero between two corners: linear, then one step of false position.
fn crossing(view: &View<'_>, (from, d): (DVec2, f64), (to, e): (DVec2, f64)) -> DVec2 {
    let part = d / (d - e);
    let f = view.distance(from.lerp(to, part));
    let refined = if (f > 0.0) == (d > 0.0) { part + (1.0 - part) * f / (f - e) } else { part * d / (d - f) };
    from.lerp(to, if refined.is_finite() { refined.clamp(0.0, 1.0) } else { part })
}

/// The edges of a polygon. Those that run inside the patch are borders of visibility and get a third point.
fn edges(view: &View<'_>, patch: Patch, polygon: &[DVec2], cell: usize, out: &mut Vec<Edge>) {
    let on_side = |a: DVec2, b: DVec2| {
        (a.x == b.x && (a.x == patch.lo.x || a.x == patch.hi.x))
            || (a.y == b.y && (a.y == patch.lo.y || a.y == patch.hi.y))
    };
    for (i, from) in polygon.iter().enumerate() {
        let to = polygon[(i + 1) % polygon.len()];
        if on_side(*from, to) {
            edge(patch, *from, to, cell, out);
        } else {
            let middle = bulge(view, patch, *from, to);
            edge(patch, *from, middle, cell, out);
            edge(patch, middle, to, cell, out);
        }
    }
}

/// A point beside the middle of a chord, such that the polygon has the area below the parabola.
fn bulge(view: &View<'_>, patch: Patch, from: DVec2, to: DVec2) -> DVec2 {
    let middle = 0.5 * (from + to);
    let chord = to - from;
    let length = chord.length();
    if length == 0.0 {
        return middle;
    }
    let across = chord.perp() / length;
    let step = 0.01 * length;
    let here = view.distance(middle);
    let slope = (view.distance(middle + across * step) - here) / step;
    let sagitta = -here / slope;
    if !sagitta.is_finite() || sagitta.abs() > 0.3 * length {
        return middle;
    }
    (middle + across * (4.0 / 3.0 * sagitta)).clamp(patch.lo, patch.hi)
}

/// The area between an edge and the patch's upper side; nothing if the edge is vertical or on that side.
fn edge(patch: Patch, from: DVec2, to: DVec2, cell: usize, out: &mut Vec<Edge>) {
    if from.x == to.x || (from.y == patch.lo.y && to.y == patch.lo.y) {
        return;
    }
    // Along the outline, what lies above an edge that goes back counts, and above one that goes on is cut off.
    let (ends, sign) = if from.x > to.x { ([to, from], 1.0) } else { ([from, to], -1.0) };
    out.push(Edge { ends, theta: patch.lo.y, sign, cell });
}

#[cfg(test)]
mod tests {
    use super::super::{Cap, Facet};
    use super::*;

    /// The solid angle of a division: of each edge by a fine midpoint sum.
    fn solid_angle(division: &Division) -> f64 {
        let of = |edge: &Edge| {
            let [a, b] = edge.ends;
            let count = 64;
            let height = |i: u32| {
                let part = (f64::from(i) + 0.5) / f64::from(count);
                edge.theta.cos() - a.lerp(b, part).y.cos()
            };
            edge.sign * (b.x - a.x) * (0..count).map(height).sum::<f64>() / f64::from(count)
        };
        division.edges.iter().map(of).sum()
    }

    #[test]
    fn the_pieces_make_up_the_visible_solid_angle() {
        let settings = Settings { border: 0.01, lobe: 1.0, depth: 7 };
        let open = Occluders::default();
        let all = divide(DVec3::Z, &open, &[], &settings);
        assert!((solid_angle(&all) - TAU).abs() < 1e-3, "{}", solid_angle(&all));

        let tilted = DVec3::new(0.3, -0.4, 0.866).normalize();
        let half = solid_angle(&divide(tilted, &open, &[], &settings));
        assert!((half - TAU).abs() < 0.01, "{half}");

        let cap = Cap { axis: DVec3::new(0.5, 0.2, 0.8).normalize(), angle: 0.4 };
        let behind_cap = Occluders { caps: vec![cap], facets: Vec::new() };
        let rest = solid_angle(&divide(DVec3::Z, &behind_cap, &[], &settings));
        let expected = TAU - TAU * (1.0 - cap.angle.cos());
        assert!((rest - expected).abs() < 0.01, "{rest} {expected}");

        // An eighth of the sphere.
        let corners = [DVec3::X, DVec3::Y, DVec3::Z].map(|corner| 3.0 * corner);
        let behind_facet = Occluders { caps: Vec::new(), facets: vec![Facet::new(corners.into_iter())] };
        let rest = solid_angle(&divide(DVec3::Z, &behind_facet, &[], &settings));
        let expected = TAU - 0.5 * PI;
        assert!((rest - expected).abs() < 0.01, "{rest} {expected}");
    }

    #[test]
    fn ranges_contain_all_directions_of_a_patch() {
        let axis = DVec3::new(0.3, -0.5, 0.6).normalize();
        for i in 0..200 {
            let lo = DVec2::new(f64::from(i % 20) * 0.3, f64::from(i / 20) * 0.25);
            let patch = Patch { lo, hi: lo + DVec2::new(0.7, 0.5), depth: 0 };
            let (a, b) = range(patch, axis);
            for j in 0..=400 {
                let at = DVec2::new(f64::from(j % 20) / 20.0, f64::from(j / 20) / 20.0);
                let cosine = axis.dot(direction(patch.lo + at * (patch.hi - patch.lo)));
                assert!((a - 1e-12..=b + 1e-12).contains(&cosine), "{patch:?}: {cosine} not in {a} to {b}");
            }
        }
    }
}
