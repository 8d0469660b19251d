//! Pictures by peeling on a GPU: a thread for each pixel, whose tile has its lists of candidates.

use std::sync::OnceLock;
use std::time::Duration;

use encase::ShaderType;
use glam::{DVec3, UVec2, Vec3};

use super::world::{Places, World, halves};
use crate::diag::Failure;
use crate::emit;
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work as Groups};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::scene::light::Polygon;
use crate::scene::rays::SurfacePoint;
use crate::skeleton;
use crate::technique::area::lit::Lit;
use crate::technique::area::peel::Work;
use crate::technique::area::picture::{Pixels, peeled_at};
use crate::technique::area::received::Received;
use crate::technique::area::tiles::{SIDE, candidates, pixels};
use crate::technique::tables::{LTC, LTC_MATRIX};

/// Bytes of a `Lit` of the skeleton.
const LIT: u64 = 48;

/// The shader on a device.
#[derive(Debug)]
pub(in crate::technique::area) struct Peeling<'g> {
    gpu: &'g Gpu,
    module: Module,
    compute: Compute,
    texels: Buffer,
}

/// The module of the table `ltc_matrix`, whose data lie in a buffer, and the words of that: proved once in a process.
fn matrices() -> Result<&'static (String, Vec<u32>), Failure> {
    static MADE: OnceLock<Result<(String, Vec<u32>), Failure>> = OnceLock::new();
    let make = || {
        let proved = Plan::proved(LTC_MATRIX.program()?, Shape::Coefficients)?;
        let words = emit::lookup_words(proved.plan()).unwrap_or_default();
        Ok((emit::wgsl(&proved), words))
    };
    MADE.get_or_init(make).as_ref().map_err(Clone::clone)
}

/// A frame on the device, and the place of its light.
#[derive(Debug)]
pub(in crate::technique::area) struct Placed {
    bound: Bound,
    work: Groups<'static>,
    lit: Buffer,
}

impl<'g> Peeling<'g> {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(in crate::technique::area) fn new(gpu: &'g Gpu) -> Result<Self, Failure> {
        let (table, words) = matrices()?;
        let functions = [LTC.function("column")?, LTC.function("row")?, LTC.function("blend")?];
        let mut modules = table.clone();
        for function in functions {
            modules += &emit::wgsl(&Plan::proved(function, Shape::Ladder)?);
        }
        let (module, compute) = super::shader(gpu, "area_light", &(modules + skeleton::AREA))?;
        Ok(Self { gpu, module, compute, texels: gpu.storage("texels", words) })
    }

    /// Puts a frame onto the device.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub(in crate::technique::area) fn place(&self, lit: &Lit) -> Result<Placed, Failure> {
        let gpu = self.gpu;
        let [width, height] = [lit.surfaces.width, lit.surfaces.height];
        let mut world = World::new(Places::AsTheyAre);
        let rows = lights(lit, &mut world);
        let (size, eye) = (UVec2::new(width, height), halves(lit.eye));
        let head = FrameRow { size, lights: rows.len() as u32, blur: lit.blur as f32, eye_high: eye.0, eye_low: eye.1 };
        let surfaces: Vec<SurfaceRow> =
            lit.surfaces.points.iter().map(|point| SurfaceRow::of(lit, point.as_ref())).collect();
        let frame = gpu.uniform("frame", &head)?;
        let lights = gpu.storage("lights", &laid_out("lights", &rows)?);
        let surfaces = gpu.storage("surfaces", &laid_out("surfaces", &surfaces)?);
        let results = gpu.results("lit", LIT * u64::from(width) * u64::from(height));
        let buffers = world.buffers(gpu)?;
        let resources = Resources::new()
            .buffer("frame", &frame)
            .buffer("lights", &lights)
            .buffer("surfaces", &surfaces)
            .buffer("texels", &self.texels)
            .buffer("lit", &results);
        let resources = buffers.iter().fold(resources, |all, (name, buffer)| all.buffer(name, buffer));
        let bound = self.module.bind(gpu, &resources)?;
        Ok(Placed { bound, work: self.compute.covering([width, height, 1]), lit: results })
    }

    /// The light at every pixel of a frame.
    ///
    /// # Errors
    /// When the device fails.
    pub(in crate::technique::area) fn light(&self, lit: &Lit, placed: &Placed) -> Result<Pixels, Failure> {
        self.gpu.submit(|encoder| self.compute.encode(encoder, &placed.bound, placed.work, 1, None));
        let count = lit.surfaces.points.len();
        let rows = bytemuck::pod_collect_to_vec::<u8, [u32; 12]>;
        let rows: Vec<[u32; 12]> = self.gpu.read_buffer(&placed.lit, LIT * count as u64, rows)?;
        let mut all = Pixels::new(count);
        let mut beyond = Vec::new();
        for (pixel, [x, y, z, factor, u, v, w, pieces, clips, overflow, ..]) in rows.into_iter().enumerate() {
            let colour = |words: [u32; 3]| Vec3::from_array(words.map(f32::from_bits)).as_dvec3();
            all.received[pixel] = Received {
                factor: f64::from(f32::from_bits(factor)),
                diffuse: colour([x, y, z]),
                glossy: colour([u, v, w]),
            };
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
    pub(in crate::technique::area) fn time(
        &self,
        placed: &Placed,
        stopwatch: &Stopwatch<'_>,
    ) -> Result<Duration, Failure> {
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
    eye_high: Vec3,
    eye_low: Vec3,
}

/// A `Light` of the skeleton.
#[derive(ShaderType)]
struct LightRow {
    colour: Vec3,
    first: u32,
    count: u32,
}

/// A `Surface` of the skeleton.
#[derive(ShaderType, Default)]
struct SurfaceRow {
    high: Vec3,
    kind: u32,
    low: Vec3,
    roughness: f32,
    normal: Vec3,
}

/// The kinds of surfaces that are seen at pixels.
const MATT: u32 = 1;
const GLOSSY: u32 = 2;

impl SurfaceRow {
    fn of(lit: &Lit, point: Option<&SurfacePoint>) -> Self {
        let Some(point) = point else { return Self::default() };
        let (high, low) = halves(point.place);
        let gloss = lit.glosses[point.object as usize];
        let kind = if gloss.is_some() { GLOSSY } else { MATT };
        let roughness = gloss.map_or(0.0, |gloss| gloss.roughness as f32);
        Self { high, kind, low, roughness, normal: point.smooth_normal.as_vec3() }
    }
}

/// Adds the lights of a frame to a world, their bodies, and for each light and each tile the list of those that can
/// matter. A light with two sides is two lights.
fn lights(lit: &Lit, world: &mut World) -> Vec<LightRow> {
    let other_side = |light: &Polygon| {
        let corners = light.corners.iter().rev().copied().collect();
        light.two_sided.then(|| Polygon { corners, ..light.clone() })
    };
    let sides: Vec<Polygon> =
        lit.lights.iter().flat_map(|light| [Some(light.clone()), other_side(light)]).flatten().collect();
    let tiles = [lit.surfaces.width, lit.surfaces.height].map(|pixels| (pixels as usize).div_ceil(SIDE));
    world.words.resize(2 * sides.len() * tiles[0] * tiles[1], 0);
    let mut rows = Vec::new();
    for (index, light) in sides.iter().enumerate() {
        let colour = Vec3::from_array(light.colour.map(|channel| channel as f32));
        rows.push(LightRow { colour, first: world.corners(&light.corners), count: light.corners.len() as u32 });
        // The bodies of an occluder depend on where the light's plane is.
        let bodies: Vec<_> = lit.occluders.iter().map(|occluder| world.add(occluder, light)).collect();
        for row in 0..tiles[1] {
            for column in 0..tiles[0] {
                let start = world.words.len() as u32;
                let places: Vec<DVec3> = pixels(lit, column, row).map(|(_, point)| point.place).collect();
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
    rows
}
