//! The technique on a GPU: a shader divides the directions at a surface, evaluates
//! the tables and adds up, so that nothing but surfaces goes there and nothing
//! but light comes back.

use std::fmt::Write;
use std::iter::once;
use std::time::Duration;

use encase::ShaderType;
use glam::{UVec4, Vec3};

use super::tables::Tables;
use super::{Body, Settings, Shaded, Surface, Surroundings};
use crate::diag::Failure;
use crate::emit::{self, wgsl_module};
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::skeleton;

/// Surfaces of one run: many, but little work compared to what a driver takes for a hang.
const PORTION: usize = 1 << 16;

/// Bytes of the light at a surface: three channels, and two counts in one word.
const LIT: u64 = 16;

/// The shader of scenes of one shape.
#[derive(Debug)]
pub(super) struct LightPipeline<'g> {
    gpu: &'g Gpu,
    module: Module,
    compute: Compute,
    counts: [usize; 4],
}

/// The constants of the skeleton that say what a scene is made of.
const COUNTED: [&str; 4] = ["BALLS", "PLATES", "CORNERS", "LOBES"];

/// The numbers of each of [`COUNTED`] in a scene.
fn counts(scene: &Surroundings) -> [usize; 4] {
    let corners = scene.plates.iter().map(|plate| plate.corners.len()).sum();
    [scene.balls.len(), scene.plates.len(), corners, scene.lobes.len()]
}

/// Some surfaces on the device, and the place of their light.
#[derive(Debug)]
pub(super) struct Portion {
    bound: Bound,
    work: Work<'static>,
    lit: Buffer,
    surfaces: usize,
}

impl<'g> LightPipeline<'g> {
    /// Compiles the shader for scenes of this shape.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(super) fn new(gpu: &'g Gpu, tables: &Tables, scene: &Surroundings) -> Result<Self, Failure> {
        let mut source = String::new();
        for function in tables.for_shaders() {
            source += &emit::wgsl(&Plan::proved(function, Shape::Ladder)?);
            source.push('\n');
        }
        let counts = counts(scene);
        for (name, count) in COUNTED.iter().zip(counts) {
            let _ = writeln!(source, "const {name}: u32 = {count}u;");
        }
        source += skeleton::INTEGRALS;
        let module = wgsl_module(tables.moments_of_pieces(), &source)?;
        let module = Module::new(gpu, "light", module)?;
        let compute = module.compute(gpu, module.only_compute()?, &[])?;
        Ok(Self { gpu, module, compute, counts })
    }

    /// Returns whether the shader was made for scenes of the shape of this one.
    pub(super) fn fits(&self, scene: &Surroundings) -> bool {
        self.counts == counts(scene)
    }

    /// Light, cells and edges at surfaces of a scene of the shape that the shader was made for.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn shade(
        &self,
        scene: &Surroundings,
        settings: &Settings,
        surfaces: &[Option<Surface>],
    ) -> Result<Shaded, Failure> {
        let mut shaded = Shaded::default();
        let mut left = surfaces.iter();
        for portion in self.bind(scene, settings, surfaces)? {
            self.gpu.submit(|encoder| self.compute.encode(encoder, &portion.bound, portion.work, 1, None));
            let size = LIT * portion.surfaces as u64;
            let rows = self.gpu.read_buffer(&portion.lit, size, bytemuck::pod_collect_to_vec::<u8, [u32; 4]>)?;
            for ([x, y, z, counts], surface) in rows.into_iter().zip(left.by_ref()) {
                let light = Vec3::from_array([x, y, z].map(f32::from_bits)).as_dvec3();
                shaded.push(surface.as_ref().map(|surface| surface.sent(light)), counts & 0xffff, counts >> 16);
            }
        }
        Ok(shaded)
    }

    /// Puts surfaces onto the device, in portions of one run each.
    ///
    /// # Errors
    /// When the device is out of memory or lost.
    pub(super) fn bind(
        &self,
        scene: &Surroundings,
        settings: &Settings,
        surfaces: &[Option<Surface>],
    ) -> Result<Vec<Portion>, Failure> {
        let gpu = self.gpu;
        let scene_buffer = gpu.storage("scene", &scene_bytes(scene, settings)?);
        let portion = |portion: &[Option<Surface>]| {
            let rows: Vec<SurfaceRow> = portion.iter().map(|surface| self.row(surface.as_ref())).collect();
            let surface_buffer = gpu.storage("surfaces", &laid_out("surfaces", &rows)?);
            let lit = gpu.results("lit", LIT * portion.len() as u64);
            let resources =
                Resources::new().buffer("surfaces", &surface_buffer).buffer("scene", &scene_buffer).buffer("lit", &lit);
            let bound = self.module.bind(gpu, &resources)?;
            let work = self.compute.covering([portion.len() as u32, 1, 1]);
            Ok(Portion { bound, work, lit, surfaces: portion.len() })
        };
        surfaces.chunks(PORTION).map(portion).collect()
    }

    /// Runs a portion and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time(&self, portion: &Portion, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        stopwatch.time(|encoder, marks| {
            self.compute.encode(encoder, &portion.bound, portion.work, 1, marks.compute());
        })
    }

    fn row(&self, surface: Option<&Surface>) -> SurfaceRow {
        let Some(surface) = surface else { return SurfaceRow::default() };
        let body = match surface.body {
            Body::Ground => u32::MAX,
            Body::Ball(index) => index as u32,
            Body::Plate(index) => (self.counts[0] + index) as u32,
        };
        SurfaceRow { place: surface.place.as_vec3(), body, normal: surface.normal.as_vec3(), seen: 1 }
    }
}

/// A `Surface` of the skeleton.
#[derive(ShaderType, Default)]
struct SurfaceRow {
    place: Vec3,
    body: u32,
    normal: Vec3,
    seen: u32,
}

/// The start of a `Scene` of the skeleton.
#[derive(ShaderType)]
struct Limits {
    // What follows in the skeleton's structure is aligned so.
    #[shader(align(16))]
    border: f32,
    curvature: f32,
    depth: u32,
}

/// A `Lobe` of the skeleton.
#[derive(ShaderType, Default)]
struct LobeRow {
    axis: Vec3,
    sharpness: f32,
    amplitude: Vec3,
}

/// A `Scene` of the skeleton. The lengths of its arrays differ from scene to scene, so that they are laid out one by
/// one; each has one element more than there are things, as it must have one.
fn scene_bytes(scene: &Surroundings, settings: &Settings) -> Result<Vec<u8>, Failure> {
    let limits = Limits { border: settings.border as f32, curvature: settings.lobe as f32, depth: settings.depth };
    let balls = scene.balls.iter().map(|ball| ball.centre.as_vec3().extend(ball.radius as f32));
    let mut ends = 0;
    let plates = scene.plates.iter().map(|plate| {
        let first = ends;
        ends += plate.corners.len() as u32;
        UVec4::new(first, ends, 0, 0)
    });
    let lobes = scene.lobes.iter().map(|lobe| LobeRow {
        axis: lobe.axis.as_vec3(),
        sharpness: lobe.sharpness as f32,
        amplitude: lobe.amplitude.as_vec3(),
    });
    let corners = scene.plates.iter().flat_map(|plate| &plate.corners).map(|corner| corner.as_vec3().extend(0.0));
    let parts = [
        laid_out("limits", &limits)?,
        laid_out("balls", &and_one(balls))?,
        laid_out("plates", &and_one(plates))?,
        laid_out("lobes", &and_one(lobes))?,
        laid_out("corners", &and_one(corners))?,
    ];
    Ok(parts.concat())
}

fn and_one<T: Default>(things: impl Iterator<Item = T>) -> Vec<T> {
    things.chain(once(T::default())).collect()
}
