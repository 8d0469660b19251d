//! Rows of the buffers of the skeleton: lights, surfaces, and what rays are tested against.

use std::time::Duration;

use encase::ShaderType;
use glam::{UVec2, Vec3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;

use super::super::gpu::world::{CornerRow, halves};
use crate::scene::light::Polygon;
use crate::scene::rays::{Rays, SurfacePoint};
use crate::scene::round::Round;

/// A `Frame` of the skeleton.
#[derive(ShaderType)]
pub(super) struct FrameRow {
    pub(super) size: UVec2,
    pub(super) lights: u32,
    pub(super) corners: u32,
    pub(super) nodes: u32,
    pub(super) solids: u32,
    pub(super) seed: u32,
    pub(super) rays: u32,
    pub(super) rule: u32,
    pub(super) colour: u32,
    pub(super) learns: u32,
    pub(super) tolerance: f32,
    pub(super) gap: f32,
    pub(super) spacing: f32,
    pub(super) close: f32,
}

/// A `Light` of the skeleton.
#[derive(ShaderType)]
pub(super) struct LightRow {
    colour: Vec3,
    first: u32,
    count: u32,
    two_sided: u32,
}

/// A `Surface` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct SurfaceRow {
    high: Vec3,
    seen: u32,
    low: Vec3,
    normal: Vec3,
}

impl SurfaceRow {
    pub(super) fn of(point: Option<&SurfacePoint>) -> Self {
        let Some(point) = point else { return Self::default() };
        let (high, low) = halves(point.place);
        Self { high, seen: 1, low, normal: point.smooth_normal.as_vec3() }
    }
}

/// Lights, and the corners of all of them.
pub(super) fn light_rows(lights: &[Polygon]) -> (Vec<LightRow>, Vec<CornerRow>) {
    let (mut rows, mut corners) = (Vec::new(), Vec::new());
    for light in lights {
        rows.push(LightRow {
            colour: Vec3::from_array(light.colour.map(|channel| channel as f32)),
            first: corners.len() as u32,
            count: light.corners.len() as u32,
            two_sided: light.two_sided.into(),
        });
        corners.extend(light.corners.iter().copied().map(halves).map(|(high, low)| CornerRow { high, low }));
    }
    (rows, corners)
}

/// A `Node` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct NodeRow {
    low: Vec3,
    count: u32,
    high: Vec3,
    first: u32,
}

/// A `Face` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct FaceRow {
    a: Vec3,
    b: Vec3,
    c: Vec3,
}

/// A `Solid` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct SolidRow {
    place: Vec3,
    length: f32,
    axis: Vec3,
    square: f32,
}

/// The surfaces that rays are tested against.
pub(super) struct Casters {
    pub(super) nodes: Vec<NodeRow>,
    pub(super) faces: Vec<FaceRow>,
    pub(super) solids: Vec<SolidRow>,
    /// The numbers of nodes and of solids; their arrays have an element more, as none may be empty.
    pub(super) counts: [u32; 2],
    /// Surfaces nearer than this to the ends of a ray hide nothing.
    pub(super) close: f32,
}

/// Parts of the largest coordinate within which single precision knows a place on a surface.
const CLOSE: f64 = 2e-6;

impl Casters {
    pub(super) fn new(rays: &Rays) -> Self {
        let triangles = rays.faces();
        let bvh = build_bvh2_from_tris(triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        let corner = |place: glam::Vec3A| Vec3::from(place);
        let mut faces: Vec<FaceRow> = bvh
            .primitive_indices
            .iter()
            .map(|index| &triangles[*index as usize])
            .map(|face| FaceRow { a: corner(face.v0), b: corner(face.v1), c: corner(face.v2) })
            .collect();
        let node = |node: &obvhs::bvh2::node::Bvh2Node| NodeRow {
            low: corner(node.aabb().min),
            count: node.prim_count,
            high: corner(node.aabb().max),
            first: node.first_index,
        };
        let mut nodes: Vec<NodeRow> =
            if triangles.is_empty() { Vec::new() } else { bvh.nodes.iter().map(node).collect() };
        let mut solids: Vec<SolidRow> = rays.solids().map(SolidRow::of).collect();
        let counts = [nodes.len() as u32, solids.len() as u32];
        faces.push(FaceRow::default());
        nodes.push(NodeRow::default());
        solids.push(SolidRow::default());
        Self { nodes, faces, solids, counts, close: (CLOSE * rays.reach()) as f32 }
    }
}

impl SolidRow {
    fn of(solid: Round) -> Self {
        // Places on a surface are on either side of it by rounding.
        let within = (1.0 - 4.0 * CLOSE) as f32;
        match solid {
            Round::Ball { centre, radius } => {
                Self { place: centre.as_vec3(), square: within * (radius * radius) as f32, ..Self::default() }
            }
            Round::Cone { apex, base, radius } => {
                let length = apex.distance(base);
                Self {
                    place: apex.as_vec3(),
                    length: length as f32,
                    axis: ((base - apex) / length).as_vec3(),
                    square: within * (radius / length).powi(2) as f32,
                }
            }
        }
    }
}
