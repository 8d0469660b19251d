//! A face of any number of corners → triangles that cover it and nothing else.
//!
//! A convex face becomes a fan, another one is cut by `earcut`. A face that crosses itself
//! has no inside and is refused, as is one too large for work that grows with the square.

use earcut::Earcut;
use glam::{DVec2, DVec3};

use super::{Broken, Result};

/// Most corners of a face that is not convex.
const MAX_CORNERS: usize = 1000;
/// Most by which triangles may differ from the face in area, as a part of it.
const MAX_DEVIATION: f64 = 1e-6;

/// Triangles of a flat face, as indices of its corners.
pub(super) fn triangles(corners: &[DVec3]) -> Result<Vec<[usize; 3]>> {
    let crossing = || Broken::new("has a face that crosses itself", "export it in triangles");
    let origin = corners[0];
    let fan = corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin));
    // By Newell: twice the area, along the normal. Of a flat face it is that, of a bent one a mean.
    let normal: DVec3 = fan.clone().sum();
    let largest = fan.map(DVec3::length).fold(0.0, f64::max);
    if largest == 0.0 {
        return Ok(Vec::new());
    }
    let Some(normal) = normal.try_normalize().filter(|_| normal.length() > 1e-9 * largest) else {
        return Err(crossing());
    };
    let (x, y) = normal.any_orthonormal_pair();
    let flat: Vec<DVec2> = corners.iter().map(|c| DVec2::new((c - origin).dot(x), (c - origin).dot(y))).collect();
    if is_convex(&flat) {
        return Ok((1..corners.len() - 1).map(|index| [0, index, index + 1]).collect());
    }
    if corners.len() > MAX_CORNERS {
        let what = format!("has a face of more than {MAX_CORNERS} corners that is not convex");
        return Err(Broken::new(what, "export it in triangles"));
    }
    if crosses_itself(&flat) {
        return Err(crossing());
    }
    ears(&flat).ok_or_else(crossing)
}

/// Twice the area of a triangle, negative if its corners go clockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Returns whether a polygon turns left everywhere, and once around.
fn is_convex(flat: &[DVec2]) -> bool {
    let corner = |index: usize| flat[index % flat.len()];
    let turns_left = (0..flat.len()).all(|i| area(corner(i), corner(i + 1), corner(i + 2)) >= 0.0);
    // Around once, edges change from rightward to leftward once, and back once.
    let rightward: Vec<bool> =
        (0..flat.len()).map(|i| corner(i + 1).x - corner(i).x).filter(|x| *x != 0.0).map(|x| x > 0.0).collect();
    let changes = (0..rightward.len()).filter(|i| rightward[*i] != rightward[(i + 1) % rightward.len()]).count();
    turns_left && changes <= 2
}

/// Returns whether two sides cross. Sides may touch: a face with a hole is often written with a cut that leads to it.
fn crosses_itself(flat: &[DVec2]) -> bool {
    let side = |index: usize| (flat[index], flat[(index + 1) % flat.len()]);
    let apart = |a: f64, b: f64| (a > 0.0 && b < 0.0) || (a < 0.0 && b > 0.0);
    (0..flat.len()).any(|first| {
        let (a, b) = side(first);
        (first + 1..flat.len()).any(|second| {
            let (c, d) = side(second);
            apart(area(a, b, c), area(a, b, d)) && apart(area(c, d, a), area(c, d, b))
        })
    })
}

/// Cuts off ears until nothing is left; `None` if triangles do not cover the same area. Corners on a straight line
/// may be left out.
fn ears(flat: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let places = || flat.iter().map(DVec2::to_array);
    let mut cut: Vec<u32> = Vec::new();
    Earcut::new().earcut(places(), &[], &mut cut);
    (earcut::deviation(places(), &[], &cut) < MAX_DEVIATION)
        .then(|| cut.as_chunks().0.iter().map(|c| turned_left(flat, c)).collect())
}

/// The corners of a triangle in the order of the face that it is cut from.
fn turned_left(flat: &[DVec2], corners: &[u32; 3]) -> [usize; 3] {
    let [a, b, c] = corners.map(|corner| corner as usize);
    if area(flat[a], flat[b], flat[c]) < 0.0 { [a, c, b] } else { [a, b, c] }
}
