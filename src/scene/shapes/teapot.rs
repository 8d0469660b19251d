//! The Utah teapot from its Bézier patches (M. Newell, 1975), with y up.
//!
//! Body, lid and bottom are turned: a profile gives the radius and the height of
//! the control points, and four patches go around. Handle and spout have one
//! patch per half and piece.

use glam::DVec3;

use super::solid::{Solid, surface};

/// Radius and height of the control points: rim, body above, body below, bottom, knob, lid.
const PROFILES: [[[f64; 2]; 4]; 6] = [
    [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]],
    [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]],
    [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]],
    [[1.5, 0.15], [1.5, 0.075], [1.425, 0.0], [0.0, 0.0]],
    [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]],
    [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]],
];

/// Control points of handle and spout: four curves around one half of the tube, each point with distance
/// along the axis, half width, height.
const TUBES: [[[[f64; 3]; 4]; 4]; 4] = [
    // Handle above.
    [
        [[-1.6, 0.0, 2.025], [-1.6, 0.3, 2.025], [-1.5, 0.3, 2.25], [-1.5, 0.0, 2.25]],
        [[-2.3, 0.0, 2.025], [-2.3, 0.3, 2.025], [-2.5, 0.3, 2.25], [-2.5, 0.0, 2.25]],
        [[-2.7, 0.0, 2.025], [-2.7, 0.3, 2.025], [-3.0, 0.3, 2.25], [-3.0, 0.0, 2.25]],
        [[-2.7, 0.0, 1.8], [-2.7, 0.3, 1.8], [-3.0, 0.3, 1.8], [-3.0, 0.0, 1.8]],
    ],
    // Handle below.
    [
        [[-2.7, 0.0, 1.8], [-2.7, 0.3, 1.8], [-3.0, 0.3, 1.8], [-3.0, 0.0, 1.8]],
        [[-2.7, 0.0, 1.575], [-2.7, 0.3, 1.575], [-3.0, 0.3, 1.35], [-3.0, 0.0, 1.35]],
        [[-2.5, 0.0, 1.125], [-2.5, 0.3, 1.125], [-2.65, 0.3, 0.9375], [-2.65, 0.0, 0.9375]],
        [[-2.0, 0.0, 0.9], [-2.0, 0.3, 0.9], [-1.9, 0.3, 0.6], [-1.9, 0.0, 0.6]],
    ],
    // Spout below.
    [
        [[1.7, 0.0, 1.425], [1.7, 0.66, 1.425], [1.7, 0.66, 0.6], [1.7, 0.0, 0.6]],
        [[2.6, 0.0, 1.425], [2.6, 0.66, 1.425], [3.1, 0.66, 0.825], [3.1, 0.0, 0.825]],
        [[2.3, 0.0, 2.1], [2.3, 0.25, 2.1], [2.4, 0.25, 2.025], [2.4, 0.0, 2.025]],
        [[2.7, 0.0, 2.4], [2.7, 0.25, 2.4], [3.3, 0.25, 2.4], [3.3, 0.0, 2.4]],
    ],
    // Spout above.
    [
        [[2.7, 0.0, 2.4], [2.7, 0.25, 2.4], [3.3, 0.25, 2.4], [3.3, 0.0, 2.4]],
        [[2.8, 0.0, 2.475], [2.8, 0.25, 2.475], [3.525, 0.25, 2.49375], [3.525, 0.0, 2.49375]],
        [[2.9, 0.0, 2.475], [2.9, 0.15, 2.475], [3.45, 0.15, 2.5125], [3.45, 0.0, 2.5125]],
        [[2.8, 0.0, 2.4], [2.8, 0.15, 2.4], [3.2, 0.15, 2.4], [3.2, 0.0, 2.4]],
    ],
];

/// A quarter of a circle as the teapot has it: a little wider than the exact 0.5523.
const ROUND: f64 = 0.56;

type Patch = [[DVec3; 4]; 4];

/// Builds the teapot with `divisions` × `divisions` quads per patch.
pub(in crate::scene) fn build(out: &mut Solid, divisions: u32) {
    for profile in PROFILES {
        for quarter in 0..4 {
            let turn = |x: f64, z: f64| match quarter {
                0 => (x, z),
                1 => (-z, x),
                2 => (-x, -z),
                _ => (z, -x),
            };
            let patch = profile.map(|[radius, height]| {
                [(1.0, 0.0), (1.0, ROUND), (ROUND, 1.0), (0.0, 1.0)].map(|(x, z)| {
                    let (x, z) = turn(x * radius, z * radius);
                    DVec3::new(x, height, z)
                })
            });
            tessellate(out, &patch, divisions);
        }
    }
    for tube in TUBES {
        for side in [1.0, -1.0] {
            tessellate(out, &tube.map(|curve| curve.map(|[x, z, y]| DVec3::new(x, y, z * side))), divisions);
        }
    }
}

fn tessellate(out: &mut Solid, patch: &Patch, divisions: u32) {
    surface(out, divisions, divisions, |u, v| {
        let (along_u, along_v) = tangents(patch, u, v);
        let mut across = along_u.cross(along_v);
        if across.length() < 1e-9 {
            // A pole, where one tangent vanishes: the normal is the one close by.
            let (along_u, along_v) = tangents(patch, u.clamp(0.01, 0.99), v.clamp(0.01, 0.99));
            across = along_u.cross(along_v);
        }
        let normal = across.normalize_or_zero();
        (combine(patch, bernstein(u), bernstein(v)), normal)
    });
}

fn tangents(patch: &Patch, u: f64, v: f64) -> (DVec3, DVec3) {
    (combine(patch, slopes(u), bernstein(v)), combine(patch, bernstein(u), slopes(v)))
}

/// The sum of the control points with weights: `u` within the curves, `v` from curve to curve.
fn combine(patch: &Patch, u: [f64; 4], v: [f64; 4]) -> DVec3 {
    let curve = |points: &[DVec3; 4]| points.iter().zip(u).map(|(point, weight)| *point * weight).sum::<DVec3>();
    patch.iter().zip(v).map(|(points, weight)| curve(points) * weight).sum()
}

/// The cubic Bernstein polynomials.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Their derivatives.
fn slopes(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t]
}
