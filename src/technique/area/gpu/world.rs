//! The things that hide light, as the skeleton has it: bodies, their corners, edges and faces.

use encase::ShaderType;
use glam::{DVec3, Vec3};

use crate::diag::Failure;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::scene::light::Polygon;
use crate::technique::area::occluder::{Form, Occluder};
use crate::technique::area::viewpoint::Viewpoint;

/// A `Corner` of the skeleton.
#[derive(ShaderType)]
pub(in crate::technique::area) struct CornerRow {
    pub(in crate::technique::area) high: Vec3,
    pub(in crate::technique::area) low: Vec3,
}

/// A `Body` of the skeleton.
#[derive(ShaderType, Default, Clone)]
struct BodyRow {
    high: Vec3,
    radius: f32,
    low: Vec3,
    kind: u32,
    first: u32,
    count: u32,
    edges: u32,
    edge_count: u32,
    faces: u32,
    face_count: u32,
}

/// A `Face` of the skeleton.
#[derive(ShaderType, Default)]
struct FaceRow {
    normal: Vec3,
    corner: u32,
}

/// The kinds of bodies of the skeleton.
const POLYGON: u32 = 0;
const CROSSING: u32 = 1;
const BOX: u32 = 2;
const MESH: u32 = 3;
const HOST: u32 = 4;

/// Most edges of a mesh in the shader, which goes through all of them for every plane: Mesa's rasteriser leaves loops
/// early once a thread has gone through some 65,000 rounds in all.
const MOST_EDGES: usize = 128;

/// A place as the nearest numbers, and what rounding to them lost.
pub(in crate::technique::area) fn halves(at: DVec3) -> (Vec3, Vec3) {
    let high = at.as_vec3();
    (high, (at - high.as_dvec3()).as_vec3())
}

/// The places that are given to the device.
#[derive(Debug, Clone, Copy, Default)]
pub(super) enum Places {
    /// In the axes of the scene, each as two numbers.
    #[default]
    AsTheyAre,
    /// Relative to a point, in its unit, before they are rounded to one.
    SeenFrom(Viewpoint),
}

impl Places {
    fn place(self, at: DVec3) -> CornerRow {
        let (high, low) = match self {
            Self::AsTheyAre => halves(at),
            Self::SeenFrom(point) => (Vec3::from_array(point.see(at)), Vec3::ZERO),
        };
        CornerRow { high, low }
    }

    fn along(self, vector: DVec3) -> CornerRow {
        match self {
            Self::AsTheyAre => self.place(vector),
            Self::SeenFrom(point) => CornerRow { high: Vec3::from_array(point.along(vector)), low: Vec3::ZERO },
        }
    }

    fn length(self, length: f64) -> f32 {
        match self {
            Self::AsTheyAre => length as f32,
            Self::SeenFrom(point) => point.length(length) as f32,
        }
    }
}

/// Bodies before lights, and lists of them.
#[derive(Default)]
pub(super) struct World {
    places: Places,
    corners: Vec<CornerRow>,
    bodies: Vec<BodyRow>,
    faces: Vec<FaceRow>,
    /// Lists of bodies, which the owner writes, and edges of meshes.
    pub(super) words: Vec<u32>,
}

impl World {
    /// An empty one.
    pub(super) fn new(places: Places) -> Self {
        Self { places, ..Self::default() }
    }

    /// From now on other places are given.
    pub(super) fn see(&mut self, places: Places) {
        self.places = places;
    }

    /// Its size so far, in corners; a body is as large as two.
    pub(super) fn size(&self) -> usize {
        self.corners.len() + 2 * self.bodies.len()
    }

    /// The buffers of the skeleton that hold it, by name.
    ///
    /// # Errors
    /// When they cannot be laid out.
    pub(super) fn buffers(mut self, gpu: &Gpu) -> Result<[(&'static str, Buffer); 4], Failure> {
        // An array must have an element.
        self.bodies.push(BodyRow::default());
        self.faces.push(FaceRow::default());
        self.words.push(0);
        Ok([
            ("corners", gpu.storage("corners", &laid_out("corners", &self.corners)?)),
            ("bodies", gpu.storage("bodies", &laid_out("bodies", &self.bodies)?)),
            ("faces", gpu.storage("faces", &laid_out("faces", &self.faces)?)),
            ("words", gpu.storage("words", &self.words)),
        ])
    }

    /// Adds corners and returns the place of the first one.
    pub(super) fn corners(&mut self, corners: &[DVec3]) -> u32 {
        let (first, places) = (self.corners.len() as u32, self.places);
        self.corners.extend(corners.iter().map(|corner| places.place(*corner)));
        first
    }

    /// Adds the bodies of an occluder before a light, which is seen from the side that emits.
    pub(super) fn add(&mut self, occluder: &Occluder, light: &Polygon) -> std::ops::Range<u32> {
        let first = self.bodies.len() as u32;
        let reach = light.corners.iter().map(|corner| corner.distance(occluder.sphere().0)).fold(0.0, f64::max);
        // Relative to the light, single precision tells places apart by so much.
        let slack = 1e-6 * reach;
        let crosses = |corners: &[DVec3]| {
            let heights: Vec<f64> = corners.iter().map(|corner| light.distance(*corner)).collect();
            let is_front = heights.iter().any(|height| *height > slack);
            let is_behind = heights.iter().any(|height| *height < -slack);
            (is_front, is_behind)
        };
        match occluder.form() {
            Form::Polygon(corners) => self.polygon(corners, crosses(corners), occluder.sphere()),
            Form::Box { centre, halves } => {
                let corner = |index: usize| {
                    let half = |axis: usize| if index >> axis & 1 == 1 { halves[axis] } else { -halves[axis] };
                    *centre + half(0) + half(1) + half(2)
                };
                let all: Vec<DVec3> = (0..8).map(corner).collect();
                let (is_front, is_behind) = crosses(&all);
                if !is_front {
                    return first..first;
                }
                if is_behind || halves.contains(&DVec3::ZERO) {
                    let face = |index: usize| {
                        let (axis, is_far) = (index / 2, index % 2 == 1);
                        let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                        let face = if is_far { 1 << axis } else { 0 };
                        let outwards = if is_far { halves[axis] } else { -halves[axis] };
                        ([face, face | a, face | a | b, face | b].map(corner).to_vec(), outwards.normalize_or_zero())
                    };
                    for corners in self.seen(&(0..6).map(face).collect::<Vec<_>>(), occluder.sphere().1) {
                        self.polygon(corners, crosses(corners), occluder.sphere());
                    }
                } else {
                    let start = self.corners(&[*centre]);
                    let is_right_handed = halves[0].cross(halves[1]).dot(halves[2]) > 0.0;
                    let last = if is_right_handed { halves[2] } else { -halves[2] };
                    let places = self.places;
                    self.corners.extend([halves[0], halves[1], last].map(|half| places.along(half)));
                    self.body(occluder.sphere(), BodyRow { kind: BOX, first: start, count: 4, ..BodyRow::default() });
                }
            }
            Form::Mesh(mesh) if mesh.is_convex() && mesh.edges().len() > MOST_EDGES => {
                self.body(occluder.sphere(), BodyRow { kind: HOST, ..BodyRow::default() });
            }
            Form::Mesh(mesh) if mesh.is_convex() && crosses(mesh.corners()) == (true, false) => {
                let start = self.corners(mesh.corners());
                let faces = self.faces.len() as u32;
                let row = BodyRow {
                    kind: MESH,
                    first: start,
                    count: mesh.corners().len() as u32,
                    edges: self.words.len() as u32,
                    edge_count: mesh.edges().len() as u32,
                    faces,
                    face_count: mesh.faces().len() as u32,
                    ..BodyRow::default()
                };
                let at = |corner: usize| start + corner as u32;
                let edges = mesh.edges().iter();
                self.words.extend(
                    edges.flat_map(|edge| {
                        [at(edge.from), at(edge.to), faces + edge.own as u32, faces + edge.other as u32]
                    }),
                );
                self.faces.extend(
                    mesh.faces()
                        .iter()
                        .zip(mesh.normals())
                        .map(|(face, normal)| FaceRow { normal: normal.as_vec3(), corner: at(face[0]) }),
                );
                self.body(occluder.sphere(), row);
            }
            Form::Mesh(mesh) => {
                let outline = |face: &Vec<usize>| face.iter().map(|corner| mesh.corners()[*corner]).collect();
                let faces = mesh.faces().iter().zip(mesh.normals()).map(|(face, normal)| (outline(face), *normal));
                let faces: Vec<(Vec<DVec3>, DVec3)> = faces.collect();
                let seen = match mesh.is_convex() {
                    true => self.seen(&faces, mesh.radius()),
                    false => faces.iter().map(|(corners, _)| corners.as_slice()).collect(),
                };
                for corners in seen {
                    self.polygon(corners, crosses(corners), occluder.sphere());
                }
            }
        }
        first..self.bodies.len() as u32
    }

    /// The faces of a convex solid, by their corners and outward normals, that can hide something: where a point is known,
    /// and is outside of the solid, those that are turned to it.
    fn seen<'f>(&self, faces: &'f [(Vec<DVec3>, DVec3)], radius: f64) -> Vec<&'f [DVec3]> {
        let slack = 1e-6 * radius;
        let height = |(corners, normal): &(Vec<DVec3>, DVec3)| match self.places {
            Places::AsTheyAre => 0.0,
            Places::SeenFrom(point) => point.height(*normal, corners[0]),
        };
        let is_outside = faces.iter().any(|face| height(face) > slack);
        let kept = faces.iter().filter(|face| !is_outside || height(face) > -slack);
        kept.map(|(corners, _)| corners.as_slice()).collect()
    }

    /// Adds a polygon, if any of it is before the light's plane.
    fn polygon(&mut self, corners: &[DVec3], (is_front, is_behind): (bool, bool), sphere: (DVec3, f64)) {
        if !is_front || corners.len() < 3 {
            return;
        }
        let first = self.corners(corners);
        let kind = if is_behind { CROSSING } else { POLYGON };
        self.body(sphere, BodyRow { kind, first, count: corners.len() as u32, ..BodyRow::default() });
    }

    fn body(&mut self, (centre, radius): (DVec3, f64), row: BodyRow) {
        let CornerRow { high, low } = self.places.place(centre);
        self.bodies.push(BodyRow { high, low, radius: self.places.length(radius), ..row });
    }
}
