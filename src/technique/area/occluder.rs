//! Occluders: flat polygons, boxes and meshes, and the cones of directions that they hide from a point.
//!
//! A point of a light is hidden if the open segment towards it meets the inside of an
//! occluder. So occluders end at the light's plane, what is seen edge-on hides nothing,
//! a point in a solid sees nothing, and one on a face of it nothing behind that face.

use glam::DVec3;

use super::cone::Cone;
use super::mesh::Mesh;
use super::panel::Panel;
use super::scalar::{Scalar, Vector, area, cross, dot, length, middle, minus, negated, plus, rounded, times};
use super::tabulated::Tabulated;
use super::viewpoint::Viewpoint;
use crate::diag::Failure;
use crate::technique::tables::{BOX_SILHOUETTE, EDGE_SILHOUETTE};

/// A thing that hides parts of a light.
#[derive(Debug, Clone, PartialEq)]
pub struct Occluder {
    form: Form,
    /// A sphere that holds all of it.
    centre: DVec3,
    radius: f64,
}

/// The form of an occluder.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Form {
    Polygon(Vec<DVec3>),
    Box { centre: DVec3, halves: [DVec3; 3] },
    Mesh(Mesh),
}

/// The part of all directions that an occluder hides.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Hidden<T> {
    /// All of them: the point is inside.
    All,
    /// Those in any of these cones.
    Cones(Vec<Cone<T>>),
}

/// A light as it is seen from a point that is known up to a distance.
#[derive(Debug, Clone, Copy)]
struct View<'p, T> {
    light: &'p Panel<T>,
    blur: f64,
}

/// The tables that silhouettes are taken from.
#[derive(Debug, Clone)]
pub(super) struct Silhouettes {
    boxes: Tabulated,
    edges: Tabulated,
}

impl Occluder {
    /// A flat convex polygon, hiding from both sides.
    pub fn polygon(corners: Vec<DVec3>) -> Self {
        let (centre, radius) = around(&corners);
        Self { form: Form::Polygon(corners), centre, radius }
    }

    /// A box by its centre and its half axes, from there to the middles of three faces that meet in a corner, at right
    /// angles to each other.
    pub fn block(centre: DVec3, halves: [DVec3; 3]) -> Self {
        let radius = halves.iter().map(|half| half.length_squared()).sum::<f64>().sqrt();
        Self { form: Form::Box { centre, halves }, centre, radius }
    }

    /// A surface made of faces; it has an inside if it is closed.
    pub fn mesh(mesh: Mesh) -> Self {
        let (centre, radius) = around(mesh.corners());
        Self { form: Form::Mesh(mesh), centre, radius }
    }

    /// Its form.
    #[cfg(feature = "gpu")]
    pub(super) fn form(&self) -> &Form {
        &self.form
    }

    /// The number of corners of all of its faces.
    #[cfg(feature = "gpu")]
    pub(super) fn corners(&self) -> usize {
        match &self.form {
            Form::Polygon(corners) => corners.len(),
            Form::Box { .. } => 24,
            Form::Mesh(mesh) => mesh.faces().iter().map(Vec::len).sum(),
        }
    }

    /// A sphere that holds all of it: its centre and its radius.
    pub fn sphere(&self) -> (DVec3, f64) {
        (self.centre, self.radius)
    }
}

fn around(corners: &[DVec3]) -> (DVec3, f64) {
    let centre = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
    (centre, corners.iter().map(|corner| corner.distance(centre)).fold(0.0, f64::max))
}

impl Silhouettes {
    /// By the tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub(super) fn new() -> Result<Self, Failure> {
        let boxes = Tabulated::new(&BOX_SILHOUETTE, &["x", "y", "z"])?;
        Ok(Self { boxes, edges: Tabulated::new(&EDGE_SILHOUETTE, &["own", "other"])? })
    }

    /// The directions that an occluder hides from a point, of those towards a light.
    pub(super) fn hidden<T: Scalar>(&self, occluder: &Occluder, from: &Viewpoint, light: &Panel<T>) -> Hidden<T> {
        let seen = |at: &DVec3| from.see::<T>(*at);
        let view = View { light, blur: from.blur() };
        match &occluder.form {
            Form::Polygon(corners) => {
                let corners: Vec<Vector<T>> = corners.iter().map(seen).collect();
                Hidden::Cones(polygon(&corners, view).into_iter().collect())
            }
            Form::Box { centre, halves } => {
                let halves = halves.map(|half| from.along::<T>(half));
                self.block(seen(centre), halves, view)
            }
            Form::Mesh(mesh) => {
                let corners: Vec<Vector<T>> = mesh.corners().iter().map(seen).collect();
                self.mesh(mesh, (&corners, from.length(mesh.radius())), view)
            }
        }
    }

    fn block<T: Scalar>(&self, centre: Vector<T>, halves: [Vector<T>; 3], view: View<'_, T>) -> Hidden<T> {
        let View { light, blur } = view;
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let corner = |index: usize| {
            let half = |axis: usize| if index >> axis & 1 == 1 { halves[axis] } else { negated(halves[axis]) };
            plus(centre, plus(half(0), plus(half(1), half(2))))
        };
        let squares = halves.map(|half| dot(half, half));
        if squares.contains(&zero) {
            // As flat as a polygon, or flatter.
            let Some(flat) = squares.iter().position(|square| *square == zero) else {
                return Hidden::Cones(Vec::new());
            };
            let (a, b) = ((1 << ((flat + 1) % 3)), (1 << ((flat + 2) % 3)));
            return polygons(std::iter::once([0, a, a | b, b].map(corner).to_vec()), view);
        }
        // The place of the point along each axis: 1 on the face at its positive end.
        let places: [T; 3] = std::array::from_fn(|axis| -dot(centre, halves[axis]) / squares[axis]);
        let slack: [T; 3] = std::array::from_fn(|axis| {
            let half = squares[axis].to_f64().sqrt();
            T::from_f64(T::NOISE * (1.0 + length(centre) / half) + blur / half)
        });
        let beyond = |axis: usize| places[axis] > one + slack[axis] || places[axis] < -one - slack[axis];
        if !(0..3).any(beyond) {
            let touches = |axis: &usize| places[*axis] >= one - slack[*axis] || places[*axis] <= slack[*axis] - one;
            let behind = |axis: usize| if places[axis] > zero { negated(halves[axis]) } else { halves[axis] };
            let planes: Vec<Vector<T>> = (0..3).filter(touches).map(behind).collect();
            return Cone::of_planes(planes).map_or(Hidden::All, |cone| Hidden::Cones(vec![cone]));
        }
        let all: Vec<Vector<T>> = (0..8).map(corner).collect();
        let (heights, slack) = (light.heights(&all), light.slack(&all));
        if heights.iter().all(|height| *height <= slack) {
            return Hidden::Cones(Vec::new());
        }
        let level = |place: T| if place >= one { 2 } else { usize::from(place > -one) };
        let levels = places.map(level);
        if heights.iter().any(|height| *height < -slack) {
            // It ends at the light's plane: the faces that are seen, up to there.
            let front = (0..3).filter(|axis| levels[*axis] != 1).map(|axis| {
                let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                let face = if levels[axis] == 2 { 1 << axis } else { 0 };
                [face, face | a, face | a | b, face | b].map(|index| all[index]).to_vec()
            });
            return polygons(front, view);
        }
        let mut silhouette: Vec<Vector<T>> =
            self.boxes.list(&levels).iter().map(|item| all[usize::from(*item)]).collect();
        if dot(cross(halves[0], halves[1]), halves[2]) < zero {
            silhouette.reverse();
        }
        Hidden::Cones(Cone::of_loop(&silhouette).into_iter().collect())
    }

    fn mesh<T: Scalar>(&self, mesh: &Mesh, (corners, radius): (&[Vector<T>], f64), view: View<'_, T>) -> Hidden<T> {
        let View { light, blur } = view;
        let zero = T::from_f64(0.0);
        let face = |face: &[usize]| face.iter().map(|corner| corners[*corner]).collect::<Vec<Vector<T>>>();
        let all = || mesh.faces().iter().map(|corners| face(corners));
        if !mesh.is_closed() {
            return polygons(all(), view);
        }
        // The height of the point above each face.
        let height = |(face, normal): (&Vec<usize>, &DVec3)| {
            let corner = corners[face[0]];
            let slack = T::NOISE * length(corner).max(radius) + blur;
            (-dot(rounded(normal.to_array()), corner), T::from_f64(slack))
        };
        let heights: Vec<(T, T)> = mesh.faces().iter().zip(mesh.normals()).map(height).collect();
        let is_front = |face: usize| heights[face].0 > zero;
        if mesh.is_convex() {
            if heights.iter().all(|(height, slack)| *height <= *slack) {
                let touched = mesh.normals().iter().zip(&heights).filter(|(_, (height, slack))| *height >= -*slack);
                let planes = touched.map(|(normal, _)| rounded((-*normal).to_array())).collect();
                return Cone::of_planes(planes).map_or(Hidden::All, |cone| Hidden::Cones(vec![cone]));
            }
            let above = light.heights(corners);
            let slack = light.slack(corners);
            if above.iter().all(|height| *height >= -slack) {
                let edges = mesh.edges().iter().filter_map(|edge| {
                    let (from, to) = (corners[edge.from], corners[edge.to]);
                    match self.edges.at(&[usize::from(is_front(edge.own)), usize::from(is_front(edge.other))]) {
                        [1] => Some((from, to)),
                        [2] => Some((to, from)),
                        _ => None,
                    }
                });
                return Hidden::Cones(Cone::of_edges(edges).into_iter().collect());
            }
        } else if mesh.holds(corners) {
            return Hidden::All;
        }
        let touches = heights.iter().any(|(height, slack)| *height <= *slack && *height >= -*slack);
        let seen = all().enumerate().filter(|(face, _)| is_front(*face) || (touches && !mesh.is_convex()));
        polygons(seen.map(|(_, face)| face), view)
    }
}

/// Returns whether a sphere, by its centre and radius, lies outside one of the planes of a light.
pub(super) fn is_outside<T: Scalar>(light: &Panel<T>, (centre, radius): (Vector<T>, f64)) -> bool {
    let beyond = |height: T, normal: Vector<T>| {
        let reach = radius * (1.0 + T::NOISE) + T::NOISE * length(centre);
        height < T::from_f64(0.0) && -height.to_f64() > reach * length(normal)
    };
    light.sides().any(|side| beyond(dot(side, centre), side)) || beyond(light.heights(&[centre])[0], light.normal)
}

/// The cone of a flat convex polygon, before the light's plane; `None` if it hides nothing.
///
/// Nothing is cut: an end at the light's plane is one more plane of the cone, so that no edge gets so short that
/// rounding would turn it.
fn polygon<T: Scalar>(corners: &[Vector<T>], View { light, blur }: View<'_, T>) -> Option<Cone<T>> {
    let zero = T::from_f64(0.0);
    let (mut heights, slack) = (light.heights(corners), light.slack(corners));
    // In the light's plane is beyond it.
    if heights.iter().all(|height| *height <= slack) {
        return None;
    }
    let mut corners = corners.to_vec();
    let (mut normal, mut height) = (area(&corners), dot(area(&corners), middle(&corners)));
    // Seen edge-on, or without area.
    if height.to_f64().abs() <= (T::NOISE * length(middle(&corners)) + blur) * length(normal) {
        return None;
    }
    if height > zero {
        corners.reverse();
        heights.reverse();
        (normal, height) = (negated(normal), -height);
    }
    // In front of the light's plane, or up to it.
    let is_whole = heights.iter().all(|height| *height >= -slack);
    let next = |index: usize| (index + 1) % corners.len();
    let counts = |index: &usize| is_whole || heights[*index] > zero || heights[next(*index)] > zero;
    let edges = (0..corners.len()).filter(counts).map(|index| (corners[index], corners[next(index)]));
    let mut cone = Cone::of_edges(edges)?;
    if !is_whole {
        // The plane through the point and the line in which the two planes meet.
        cone.planes.push(minus(times(normal, light.level()), times(light.normal, height)));
    }
    Some(cone)
}

fn polygons<T: Scalar>(faces: impl Iterator<Item = Vec<Vector<T>>>, view: View<'_, T>) -> Hidden<T> {
    Hidden::Cones(faces.filter_map(|face| polygon(&face, view)).collect())
}
