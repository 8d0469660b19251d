//! The search on a GPU: surfaces and a hierarchy of triangles go there, light and counts come back.
//!
//! Pixels of one colour of a checkerboard are searched first, then the others, which learn from these. The shader has
//! bounded memory; the host searches the pixels that need more, each for itself.

use std::time::Duration;

use encase::ShaderType;
use glam::{DVec3, UVec2, Vec3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;

use super::super::gpu::world::{CornerRow, halves};
use super::super::received::Received;
use super::picture::{Picture, Pixels};
use super::{Options, Rule};
use crate::diag::Failure;
use crate::emit::{self, wgsl_text};
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::scene::light::Polygon;
use crate::scene::rays::{Rays, SurfacePoint};
use crate::scene::round::Round;
use crate::skeleton;
use crate::technique::tables::{
    CLIP_STEP, CLOSEST_POINT_SETUP, CLOSEST_POINT_START, CLOSEST_POINT_STEP, EDGE_INTEGRAL, PCG, QUAD_DIAGONAL,
    SEARCH_PLAN, TRIANGLE_CONFIGURATION, TRIANGLE_RAYS, TRIANGLE_REGION,
};

/// Bytes of a `Found` of the skeleton.
const FOUND: u64 = 48;
/// Bytes of an `Edge` of the skeleton.
const EDGE: u64 = 16;

/// The shader on a device.
#[derive(Debug)]
pub(super) struct Searching<'g> {
    gpu: &'g Gpu,
    module: Module,
    compute: Compute,
}

/// A frame on the device, and the place of what is found.
#[derive(Debug)]
pub(super) struct Placed {
    /// The resources of each run, in order.
    runs: Vec<Bound>,
    work: Work<'static>,
    found: Buffer,
}

/// The text of the shader: the modules of the tables, and the skeleton around them.
fn text() -> Result<String, Failure> {
    let tables = [
        &SEARCH_PLAN,
        &QUAD_DIAGONAL,
        &TRIANGLE_CONFIGURATION,
        &CLOSEST_POINT_SETUP,
        &CLOSEST_POINT_START,
        &CLOSEST_POINT_STEP,
        &TRIANGLE_REGION,
        &TRIANGLE_RAYS,
        &CLIP_STEP,
    ];
    let functions =
        [(&EDGE_INTEGRAL, "term"), (&EDGE_INTEGRAL, "small"), (&PCG, "hash"), (&PCG, "unit"), (&PCG, "jitter")];
    let module = |program: &'static Program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    let tables = tables.into_iter().map(|table| module(table.program()?));
    let functions = functions.into_iter().map(|(table, name)| module(table.function(name)?));
    Ok(tables.chain(functions).collect::<Result<String, Failure>>()? + skeleton::SEARCH)
}

impl<'g> Searching<'g> {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(super) fn new(gpu: &'g Gpu) -> Result<Self, Failure> {
        let module = Module::new(gpu, "area_search", wgsl_text("area_search", &text()?)?)?;
        // Eight threads side by side, each on its own way, share the rounds that Mesa's rasteriser grants.
        let rounds = if gpu.is_software() { 8_000.0 } else { f64::from(1 << 20) };
        let compute = module.compute(gpu, module.only_compute()?, &[("MOST_ROUNDS", rounds)])?;
        Ok(Self { gpu, module, compute })
    }

    /// Puts a picture onto the device, whose pixels learn from their neighbours or do not.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub(super) fn place(&self, picture: &Picture<'_>, learns: bool) -> Result<Placed, Failure> {
        let (gpu, lit) = (self.gpu, picture.lit);
        let [width, height] = [lit.surfaces.width, lit.surfaces.height];
        let (lights, corners) = light_rows(&lit.lights);
        let Casters { nodes, faces, solids, counts, close } = Casters::new(picture.rays);
        let surfaces: Vec<SurfaceRow> =
            lit.surfaces.points.iter().map(|point| SurfaceRow::of(point.as_ref())).collect();
        let Options { rays, tolerance, gap, spacing, rule } = picture.options;
        let head = |colour: u32, learns: bool| FrameRow {
            size: UVec2::new(width, height),
            lights: lights.len() as u32,
            corners: corners.len() as u32,
            nodes: counts[0],
            solids: counts[1],
            seed: picture.seed,
            rays,
            rule: match rule {
                Rule::Line => 0,
                Rule::Chord => 1,
            },
            colour,
            learns: learns.into(),
            tolerance: tolerance as f32,
            gap: gap as f32,
            spacing: spacing as f32,
            close,
        };
        let heads = if learns { vec![head(0, false), head(1, true)] } else { vec![head(2, false)] };
        let pixels = u64::from(width) * u64::from(height);
        let edges = gpu.results("edges", EDGE * pixels * corners.len() as u64);
        let found = gpu.results("found", FOUND * pixels);
        let lights = gpu.storage("lights", &laid_out("lights", &lights)?);
        let corners = gpu.storage("corners", &laid_out("corners", &corners)?);
        let nodes = gpu.storage("nodes", &laid_out("nodes", &nodes)?);
        let faces = gpu.storage("faces", &laid_out("faces", &faces)?);
        let solids = gpu.storage("solids", &laid_out("solids", &solids)?);
        let surfaces = gpu.storage("surfaces", &laid_out("surfaces", &surfaces)?);
        let bind = |head: &FrameRow| {
            let frame = gpu.uniform("frame", head)?;
            let resources = Resources::new()
                .buffer("frame", &frame)
                .buffer("lights", &lights)
                .buffer("corners", &corners)
                .buffer("nodes", &nodes)
                .buffer("faces", &faces)
                .buffer("solids", &solids)
                .buffer("surfaces", &surfaces)
                .buffer("edges", &edges)
                .buffer("found", &found);
            self.module.bind(gpu, &resources)
        };
        let runs = heads.iter().map(bind).collect::<Result<Vec<Bound>, Failure>>()?;
        Ok(Placed { runs, work: self.compute.covering([width, height, 1]), found })
    }

    /// What is found at every pixel of a picture.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn pixels(&self, picture: &Picture<'_>, placed: &Placed) -> Result<Pixels, Failure> {
        for run in &placed.runs {
            self.gpu.submit(|encoder| self.compute.encode(encoder, run, placed.work, 1, None));
        }
        let count = picture.lit.surfaces.points.len();
        let rows = bytemuck::pod_collect_to_vec::<u8, [u32; 12]>;
        let rows: Vec<[u32; 12]> = self.gpu.read_buffer(&placed.found, FOUND * count as u64, rows)?;
        let mut all = Pixels::new(count);
        let mut beyond = Vec::new();
        for (pixel, [x, y, z, factor, fraction, lights, configuration, tests, overflow, ..]) in
            rows.into_iter().enumerate()
        {
            all.received[pixel] = Received {
                factor: f64::from(f32::from_bits(factor)),
                diffuse: Vec3::from_array([x, y, z].map(f32::from_bits)).as_dvec3(),
                glossy: DVec3::ZERO,
            };
            if lights > 0 {
                all.fraction[pixel] = f64::from(f32::from_bits(fraction)) / f64::from(lights);
            }
            all.configuration[pixel] = configuration.checked_sub(1);
            all.tests[pixel] = tests.into();
            if overflow != 0 {
                beyond.push(pixel);
            }
        }
        picture.search_again(&beyond, &mut all)?;
        Ok(all)
    }

    /// Runs a picture and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time(&self, placed: &Placed, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        let runs = placed.runs.iter().map(|run| {
            stopwatch.time(|encoder, marks| self.compute.encode(encoder, run, placed.work, 1, marks.compute()))
        });
        runs.sum()
    }
}

/// A `Frame` of the skeleton.
#[derive(ShaderType)]
struct FrameRow {
    size: UVec2,
    lights: u32,
    corners: u32,
    nodes: u32,
    solids: u32,
    seed: u32,
    rays: u32,
    rule: u32,
    colour: u32,
    learns: u32,
    tolerance: f32,
    gap: f32,
    spacing: f32,
    close: f32,
}

/// A `Light` of the skeleton.
#[derive(ShaderType)]
struct LightRow {
    colour: Vec3,
    first: u32,
    count: u32,
    two_sided: u32,
}

/// A `Surface` of the skeleton.
#[derive(ShaderType, Default)]
struct SurfaceRow {
    high: Vec3,
    seen: u32,
    low: Vec3,
    normal: Vec3,
}

impl SurfaceRow {
    fn of(point: Option<&SurfacePoint>) -> Self {
        let Some(point) = point else { return Self::default() };
        let (high, low) = halves(point.place);
        Self { high, seen: 1, low, normal: point.smooth_normal.as_vec3() }
    }
}

/// Lights, and the corners of all of them.
fn light_rows(lights: &[Polygon]) -> (Vec<LightRow>, Vec<CornerRow>) {
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
struct NodeRow {
    low: Vec3,
    count: u32,
    high: Vec3,
    first: u32,
}

/// A `Face` of the skeleton.
#[derive(ShaderType, Default)]
struct FaceRow {
    a: Vec3,
    b: Vec3,
    c: Vec3,
}

/// A `Solid` of the skeleton.
#[derive(ShaderType, Default)]
struct SolidRow {
    place: Vec3,
    length: f32,
    axis: Vec3,
    square: f32,
}

/// What rays are tested against.
struct Casters {
    nodes: Vec<NodeRow>,
    faces: Vec<FaceRow>,
    solids: Vec<SolidRow>,
    /// The numbers of nodes and of solids; their arrays have an element more, as none may be empty.
    counts: [u32; 2],
    /// Surfaces nearer than this to the ends of a ray hide nothing.
    close: f32,
}

/// Parts of the largest coordinate within which single precision knows a place on a surface.
const CLOSE: f64 = 2e-6;

impl Casters {
    fn new(rays: &Rays) -> Self {
        let single = |place: DVec3| glam::Vec3A::from(place.as_vec3());
        let triangles: Vec<obvhs::triangle::Triangle> = rays
            .traced()
            .map(|triangle| {
                let [v0, v1, v2] = triangle.corners.map(single);
                obvhs::triangle::Triangle { v0, v1, v2 }
            })
            .collect();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
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
