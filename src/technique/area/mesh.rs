//! Meshes as occluders: faces, the edges between them, and what is known of the whole.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::scalar::{Scalar, Vector, cross, dot, length};

/// A surface made of flat convex faces.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    corners: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
    normals: Vec<DVec3>,
    edges: Vec<Edge>,
    form: Form,
    radius: f64,
}

/// An edge between two faces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Edge {
    /// Its start, in the order of its own face.
    pub from: usize,
    /// Its end.
    pub to: usize,
    /// The face on its left, as seen from outside.
    pub own: usize,
    /// The face on its right.
    pub other: usize,
}

/// The form of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    /// With a border, or with edges that more than two faces share, or that both run along in the same direction.
    Open,
    Closed,
    /// Closed, and on the inner side of the plane of every face.
    Convex,
}

impl Mesh {
    /// A mesh with these corners, and faces as indices of corners, all counter-clockwise or all clockwise as seen from outside. Corners in
    /// the same place, but for rounding, are one. Faces that are not flat and convex are cut into triangles.
    pub fn new(corners: Vec<DVec3>, faces: &[Vec<usize>]) -> Self {
        let (lo, hi) = corners
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), corner| (lo.min(*corner), hi.max(*corner)));
        let radius = if corners.is_empty() { 0.0 } else { 0.5 * (hi - lo).length() };
        // Cells so small that different corners are never in one, and so large that rounding hardly leaves one.
        let cell = (1e-9 * radius).max(f64::MIN_POSITIVE);
        let mut places: HashMap<[u64; 3], usize> = HashMap::new();
        let place = |corner: &DVec3| ((*corner - lo) / cell).round().to_array().map(f64::to_bits);
        let first: Vec<usize> =
            corners.iter().enumerate().map(|(index, corner)| *places.entry(place(corner)).or_insert(index)).collect();
        let mut flat = Vec::with_capacity(faces.len());
        for face in faces {
            let mut face: Vec<usize> = face.iter().map(|corner| first[*corner]).collect();
            face.dedup();
            while face.len() > 1 && face.first() == face.last() {
                face.pop();
            }
            let outline: Vec<DVec3> = face.iter().map(|corner| corners[*corner]).collect();
            match cut(&outline) {
                Some(parts) => flat.extend(parts.into_iter().map(|part| part.iter().map(|at| face[*at]).collect())),
                None if face.len() >= 3 => flat.push(face),
                None => {}
            }
        }
        let (mut edges, is_closed) = edges(&flat);
        if is_closed && volume(&corners, &flat) < 0.0 {
            flat.iter_mut().for_each(|face| face.reverse());
            // In the order of its own face, an edge now has the other one on its left.
            edges.iter_mut().for_each(|edge| std::mem::swap(&mut edge.own, &mut edge.other));
        }
        let outline = |face: &Vec<usize>| face.iter().map(|corner| corners[*corner]).collect::<Vec<DVec3>>();
        let normals = flat.iter().map(|face| normal(&outline(face))).collect();
        let mut mesh = Self { corners, faces: flat, normals, edges, form: Form::Open, radius };
        if is_closed {
            mesh.form = if mesh.bulges() { Form::Convex } else { Form::Closed };
        }
        mesh
    }

    /// The places of its corners.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Its faces, as indices of corners.
    pub fn faces(&self) -> &[Vec<usize>] {
        &self.faces
    }

    /// The unit normals of its faces.
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// The edges between two faces.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Returns whether it has an inside.
    pub fn is_closed(&self) -> bool {
        self.form != Form::Open
    }

    /// Returns whether it is closed and convex.
    pub fn is_convex(&self) -> bool {
        self.form == Form::Convex
    }

    /// Half the diagonal of its bounding box.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Returns whether a closed mesh is convex: whether it is one surface without holes that is folded outwards nowhere
    /// (Tietze's theorem), so that no face has to be compared with all the others.
    fn bulges(&self) -> bool {
        let is_folded_in = |edge: &Edge| {
            let (normal, from) = (self.normals[edge.own], self.corners[edge.from]);
            self.faces[edge.other].iter().all(|at| normal.dot(self.corners[*at] - from) <= 1e-9 * self.radius)
        };
        let mut used: Vec<usize> = self.faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let is_sphere = used.len() + self.faces.len() == self.edges.len() + 2;
        is_sphere && self.is_connected() && self.edges.iter().all(is_folded_in)
    }

    /// Returns whether every face can be reached from the first one over edges.
    fn is_connected(&self) -> bool {
        let mut beside = vec![Vec::new(); self.faces.len()];
        for edge in &self.edges {
            beside[edge.own].push(edge.other);
            beside[edge.other].push(edge.own);
        }
        let (mut reached, mut open, mut count) = (vec![false; self.faces.len()], vec![0], 0);
        while let Some(face) = open.pop() {
            if !std::mem::replace(&mut reached[face], true) {
                count += 1;
                open.extend(&beside[face]);
            }
        }
        count == self.faces.len()
    }

    /// Returns whether a closed mesh, by its corners as seen from a point, holds that point: whether its faces go round
    /// it, by the sum of their solid angles.
    pub fn holds<T: Scalar>(&self, corners: &[Vector<T>]) -> bool {
        let wide: Vec<Vector<f64>> = corners.iter().map(|corner| corner.map(T::to_f64)).collect();
        let fan = |face: &Vec<usize>| -> f64 {
            face[1..].windows(2).map(|pair| solid_angle([wide[face[0]], wide[pair[0]], wide[pair[1]]])).sum()
        };
        self.faces.iter().map(fan).sum::<f64>().abs() > std::f64::consts::TAU
    }
}

/// The solid angle of a triangle as seen from the origin, its sign by the way its corners go round (van Oosterom and
/// Strackee, IEEE Transactions on Biomedical Engineering 30(2), 1983).
fn solid_angle([a, b, c]: [Vector<f64>; 3]) -> f64 {
    let (la, lb, lc) = (length(a), length(b), length(c));
    let volume = dot(a, cross(b, c));
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * libm::atan2(volume, below)
}

/// The volume that closed faces go round; negative if they look inwards.
fn volume(corners: &[DVec3], faces: &[Vec<usize>]) -> f64 {
    let first = corners[faces[0][0]];
    let part = |face: &Vec<usize>| -> f64 {
        let at = |index: usize| corners[face[index]] - first;
        (2..face.len()).map(|index| at(0).dot(at(index - 1).cross(at(index)))).sum()
    };
    faces.iter().map(part).sum::<f64>() / 6.0
}

/// The unit normal of an outline; zero if it has no area.
fn normal(outline: &[DVec3]) -> DVec3 {
    let Some((first, rest)) = outline.split_first() else { return DVec3::ZERO };
    rest.windows(2).map(|pair| (pair[0] - *first).cross(pair[1] - *first)).sum::<DVec3>().normalize_or_zero()
}

/// The convex parts of an outline, as indices of its corners; `None` if it is flat and convex as it is, or nothing.
fn cut(outline: &[DVec3]) -> Option<Vec<Vec<usize>>> {
    if outline.len() < 4 {
        return None;
    }
    let normal = normal(outline);
    let extent = outline.iter().map(|corner| corner.distance(outline[0])).fold(0.0, f64::max);
    let off = |corner: &DVec3| normal.dot(*corner - outline[0]).abs() > 1e-9 * extent;
    let outside = |(index, from): (usize, &DVec3)| {
        let inwards = normal.cross((outline[(index + 1) % outline.len()] - *from).normalize_or_zero());
        outline.iter().any(|corner| (*corner - *from).dot(inwards) < -1e-9 * extent)
    };
    if !outline.iter().any(off) && !outline.iter().enumerate().any(outside) {
        return None;
    }
    // Ears are cut off in the plane that the outline is closest to.
    let across = normal.any_orthogonal_vector();
    let along = normal.cross(across);
    let flat: Vec<[f64; 2]> = outline.iter().map(|corner| [corner.dot(across), corner.dot(along)]).collect();
    let mut triangles: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(flat.iter().copied(), &[], &mut triangles);
    let turned = |[a, b, c]: &[usize; 3]| {
        let [u, v] = [*b, *c].map(|corner| DVec2::from(flat[corner]) - DVec2::from(flat[*a]));
        if u.perp_dot(v) < 0.0 { vec![*a, *c, *b] } else { vec![*a, *b, *c] }
    };
    Some(triangles.as_chunks().0.iter().map(turned).collect())
}

/// The edges between two faces each, and whether there are no others.
fn edges(faces: &[Vec<usize>]) -> (Vec<Edge>, bool) {
    let mut owners: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
    let sides = |face: &[usize]| -> Vec<(usize, usize)> {
        face.iter().copied().zip(face.iter().copied().cycle().skip(1)).collect()
    };
    for (index, face) in faces.iter().enumerate() {
        for side in sides(face) {
            owners.entry(side).or_default().push(index);
        }
    }
    let (mut edges, mut is_closed) = (Vec::new(), !faces.is_empty());
    for (own, face) in faces.iter().enumerate() {
        for (from, to) in sides(face) {
            match (owners[&(from, to)].len(), owners.get(&(to, from)).map(Vec::as_slice)) {
                (1, Some([other])) if from < to => edges.push(Edge { from, to, own, other: *other }),
                (1, Some([_])) => {}
                _ => is_closed = false,
            }
        }
    }
    (edges, is_closed)
}
