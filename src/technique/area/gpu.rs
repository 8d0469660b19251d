//! Peeling on a GPU: surfaces, bodies and lists of candidates go there, light comes back.
//!
//! The shader has bounded memory. Pixels that need more are computed by the host, exactly.

use std::time::Duration;

use encase::ShaderType;
use glam::{DVec3, UVec2, Vec3};

use super::lit::Lit;
use super::occluder::{Form, Occluder};
use super::peel::Work;
use super::picture::{Pixels, peeled_at};
use super::tiles::{SIDE, candidates, pixels};
use crate::diag::Failure;
use crate::emit::{self, wgsl_text};
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work as Groups};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::scene::light::Polygon;
use crate::skeleton;
use crate::technique::tables::{BOX_SILHOUETTE, CLIP_STEP, EDGE_INTEGRAL, EDGE_SILHOUETTE};

/// Bytes of a `Lit` of the skeleton.
const LIT: u64 = 32;

/// The shader on a device.
#[derive(Debug)]
pub(super) struct Peeling<'g> {
    gpu: &'g Gpu,
    module: Module,
    compute: Compute,
}

/// A frame on the device, and the place of its light.
#[derive(Debug)]
pub(super) struct Placed {
    bound: Bound,
    work: Groups<'static>,
    lit: Buffer,
}

/// The text of the shader: the modules of the tables, and the skeleton around them.
fn text() -> Result<String, Failure> {
    let tables = [CLIP_STEP.program()?, BOX_SILHOUETTE.program()?, EDGE_SILHOUETTE.program()?];
    let functions = [EDGE_INTEGRAL.function("term")?, EDGE_INTEGRAL.function("small")?];
    let module = |program: &&'static Program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    let modules = tables.iter().chain(&functions).map(module).collect::<Result<String, Failure>>()?;
    Ok(modules + skeleton::AREA)
}

impl<'g> Peeling<'g> {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(super) fn new(gpu: &'g Gpu) -> Result<Self, Failure> {
        let module = Module::new(gpu, "area_light", wgsl_text("area_light", &text()?)?)?;
        // Eight threads side by side, each on its own way, share the rounds that Mesa's rasteriser grants.
        let rounds = if gpu.is_software() { 8_000.0 } else { f64::from(1 << 20) };
        let compute = module.compute(gpu, module.only_compute()?, &[("MOST_ROUNDS", rounds)])?;
        Ok(Self { gpu, module, compute })
    }

    /// Puts a frame onto the device.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub(super) fn place(&self, lit: &Lit) -> Result<Placed, Failure> {
        let gpu = self.gpu;
        let [width, height] = [lit.surfaces.width, lit.surfaces.height];
        let mut world = World::new(lit);
        let head = FrameRow { size: UVec2::new(width, height), lights: lit.lights.len() as u32, blur: lit.blur as f32 };
        // An array must have an element.
        world.bodies.push(BodyRow::default());
        world.faces.push(FaceRow::default());
        let surfaces: Vec<SurfaceRow> =
            lit.surfaces.points.iter().map(|point| SurfaceRow::of(point.as_ref())).collect();
        let frame = gpu.uniform("frame", &head)?;
        let lights = gpu.storage("lights", &laid_out("lights", &world.lights)?);
        let corners = gpu.storage("corners", &laid_out("corners", &world.corners)?);
        let bodies = gpu.storage("bodies", &laid_out("bodies", &world.bodies)?);
        let faces = gpu.storage("faces", &laid_out("faces", &world.faces)?);
        let words = gpu.storage("words", &world.words);
        let surfaces = gpu.storage("surfaces", &laid_out("surfaces", &surfaces)?);
        let results = gpu.results("lit", LIT * u64::from(width) * u64::from(height));
        let resources = Resources::new()
            .buffer("frame", &frame)
            .buffer("lights", &lights)
            .buffer("corners", &corners)
            .buffer("bodies", &bodies)
            .buffer("faces", &faces)
            .buffer("words", &words)
            .buffer("surfaces", &surfaces)
            .buffer("lit", &results);
        let bound = self.module.bind(gpu, &resources)?;
        Ok(Placed { bound, work: self.compute.covering([width, height, 1]), lit: results })
    }

    /// The light at every pixel of a frame.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn light(&self, lit: &Lit, placed: &Placed) -> Result<Pixels, Failure> {
        self.gpu.submit(|encoder| self.compute.encode(encoder, &placed.bound, placed.work, 1, None));
        let count = lit.surfaces.points.len();
        let rows = bytemuck::pod_collect_to_vec::<u8, [u32; 8]>;
        let rows: Vec<[u32; 8]> = self.gpu.read_buffer(&placed.lit, LIT * count as u64, rows)?;
        let mut all = Pixels::new(count);
        let mut beyond = Vec::new();
        for (pixel, [x, y, z, pieces, clips, overflow, ..]) in rows.into_iter().enumerate() {
            all.received[pixel] = Vec3::from_array([x, y, z].map(f32::from_bits)).as_dvec3();
            all.work[pixel] = Work { pieces: pieces.into(), clips: clips.into(), overflow: overflow != 0 };
            if overflow != 0 {
                beyond.push(pixel);
            }
        }
        peeled_at::<f32>(lit, &beyond, &mut all)?;
        Ok(all)
    }

    /// Runs a frame and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time(&self, placed: &Placed, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        stopwatch.time(|encoder, marks| {
            self.compute.encode(encoder, &placed.bound, placed.work, 1, marks.compute());
        })
    }
}

/// A `Frame` of the skeleton.
#[derive(ShaderType)]
struct FrameRow {
    size: UVec2,
    lights: u32,
    blur: f32,
}

/// A `Light` of the skeleton.
#[derive(ShaderType)]
pub(super) struct LightRow {
    colour: Vec3,
    first: u32,
    count: u32,
    two_sided: u32,
}

/// A `Corner` of the skeleton.
#[derive(ShaderType)]
pub(super) struct CornerRow {
    high: Vec3,
    low: Vec3,
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

/// A `Surface` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct SurfaceRow {
    high: Vec3,
    seen: u32,
    low: Vec3,
    normal: Vec3,
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
pub(super) fn halves(at: DVec3) -> CornerRow {
    let high = at.as_vec3();
    CornerRow { high, low: (at - high.as_dvec3()).as_vec3() }
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
        corners.extend(light.corners.iter().copied().map(halves));
    }
    (rows, corners)
}

impl SurfaceRow {
    pub(super) fn of(point: Option<&crate::scene::rays::SurfacePoint>) -> Self {
        let Some(point) = point else { return Self::default() };
        let CornerRow { high, low } = halves(point.place);
        Self { high, seen: 1, low, normal: point.smooth_normal.as_vec3() }
    }
}

/// Everything of a frame but its surfaces.
struct World {
    lights: Vec<LightRow>,
    corners: Vec<CornerRow>,
    bodies: Vec<BodyRow>,
    faces: Vec<FaceRow>,
    words: Vec<u32>,
}

impl World {
    fn new(lit: &Lit) -> Self {
        let (lights, corners) = light_rows(&lit.lights);
        let mut world = Self { lights, corners, bodies: vec![], faces: vec![], words: vec![] };
        let tiles = [lit.surfaces.width, lit.surfaces.height].map(|pixels| (pixels as usize).div_ceil(SIDE));
        world.words.resize(2 * lit.lights.len() * tiles[0] * tiles[1], 0);
        for (index, light) in lit.lights.iter().enumerate() {
            // The bodies of an occluder depend on where the light's plane is.
            let bodies: Vec<_> = lit.occluders.iter().map(|occluder| world.add(occluder, light)).collect();
            for row in 0..tiles[1] {
                for column in 0..tiles[0] {
                    let start = world.words.len() as u32;
                    let places = pixels(lit, column, row).map(|(_, point)| point.place);
                    let places: Vec<DVec3> = places.collect();
                    if !places.is_empty() {
                        let list = candidates(lit, light, places.iter().copied());
                        world.words.extend(list.into_iter().flat_map(|candidate| bodies[candidate].clone()));
                    }
                    let entry = 2 * ((index * tiles[1] + row) * tiles[0] + column);
                    world.words[entry] = start;
                    world.words[entry + 1] = world.words.len() as u32 - start;
                }
            }
        }
        world
    }

    /// Adds the bodies of an occluder before a light.
    fn add(&mut self, occluder: &Occluder, light: &Polygon) -> std::ops::Range<u32> {
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
                let flat = halves.contains(&DVec3::ZERO);
                if crosses(&all) == (true, true) || flat {
                    for axis in 0..3 {
                        let (a, b) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
                        for face in [0, 1 << axis] {
                            let corners = [face, face | a, face | a | b, face | b].map(corner);
                            self.polygon(&corners, crosses(&corners), occluder.sphere());
                        }
                    }
                } else {
                    let start = self.corners.len() as u32;
                    self.corners.push(self::halves(*centre));
                    let is_right_handed = halves[0].cross(halves[1]).dot(halves[2]) > 0.0;
                    let last = if is_right_handed { halves[2] } else { -halves[2] };
                    self.corners.extend([halves[0], halves[1], last].map(self::halves));
                    self.body(occluder.sphere(), BodyRow { kind: BOX, first: start, count: 4, ..BodyRow::default() });
                }
            }
            Form::Mesh(mesh) if mesh.is_convex() && mesh.edges().len() > MOST_EDGES => {
                self.body(occluder.sphere(), BodyRow { kind: HOST, ..BodyRow::default() });
            }
            Form::Mesh(mesh) if mesh.is_convex() && !crosses(mesh.corners()).1 => {
                let start = self.corners.len() as u32;
                self.corners.extend(mesh.corners().iter().copied().map(halves));
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
                for face in mesh.faces() {
                    let corners: Vec<DVec3> = face.iter().map(|corner| mesh.corners()[*corner]).collect();
                    self.polygon(&corners, crosses(&corners), occluder.sphere());
                }
            }
        }
        first..self.bodies.len() as u32
    }

    /// Adds a polygon, if any of it is before the light's plane.
    fn polygon(&mut self, corners: &[DVec3], (is_front, is_behind): (bool, bool), sphere: (DVec3, f64)) {
        if !is_front || corners.len() < 3 {
            return;
        }
        let first = self.corners.len() as u32;
        self.corners.extend(corners.iter().copied().map(halves));
        let kind = if is_behind { CROSSING } else { POLYGON };
        self.body(sphere, BodyRow { kind, first, count: corners.len() as u32, ..BodyRow::default() });
    }

    fn body(&mut self, (centre, radius): (DVec3, f64), row: BodyRow) {
        let CornerRow { high, low } = halves(centre);
        self.bodies.push(BodyRow { high, low, radius: radius as f32, ..row });
    }
}
