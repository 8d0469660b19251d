//! The same on a device: a shader divides the directions at a surface, evaluates
//! the tables and adds up, so that nothing but surfaces goes there and nothing
//! but light comes back.

use std::fmt::Write;
use std::iter::once;

use glam::DVec3;

use super::tables::Tables;
use super::{Body, Scene, Settings, Shaded, Surface};
use crate::diag::Failure;
use crate::emit::{self, wgsl_module};
use crate::gpu::Gpu;
use crate::gpu::pass::Compute;
use crate::plan::{Plan, Shape};

const SKELETON: &str = include_str!("wgsl/light.wgsl");

/// Surfaces of a workgroup, as the skeleton says.
const ROW: u32 = 8;

/// Surfaces of one run: many, but little work compared to what a driver takes for a hang.
const PORTION: usize = 1 << 16;

/// A scene on a device.
#[derive(Debug)]
pub struct Lamp<'g> {
    gpu: &'g Gpu,
    compute: Compute,
    balls: usize,
}

impl<'g> Lamp<'g> {
    /// Compiles the shader for scenes of this shape.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub fn new(gpu: &'g Gpu, tables: &Tables, scene: &Scene) -> Result<Self, Failure> {
        let mut source = String::new();
        for function in tables.for_shaders() {
            source += &emit::wgsl(&Plan::proved(function, Shape::Ladder)?);
            source.push('\n');
        }
        let corners: usize = scene.plates.iter().map(|plate| plate.corners.len()).sum();
        let counts = [
            ("BALLS", scene.balls.len()),
            ("PLATES", scene.plates.len()),
            ("CORNERS", corners),
            ("LOBES", scene.lobes.len()),
        ];
        for (name, count) in counts {
            let _ = writeln!(source, "const {name}: u32 = {count}u;");
        }
        source += SKELETON;
        let module = wgsl_module(tables.moments_of_pieces(), &source)?;
        let compute = Compute::new(gpu, "light", module, [(0, true), (1, true), (2, false)])?;
        Ok(Self { gpu, compute, balls: scene.balls.len() })
    }

    /// Light, cells and edges at surfaces of a scene of the shape that the shader was made for.
    ///
    /// # Errors
    /// When the device fails.
    pub fn shade(&self, scene: &Scene, settings: &Settings, surfaces: &[Option<Surface>]) -> Result<Shaded, Failure> {
        let gpu = self.gpu;
        let scene_words: Vec<u32> = scene_rows(scene, settings).into_iter().flatten().collect();
        let scene_buffer = gpu.storage("scene", &scene_words);
        let mut shaded = Shaded::default();
        for portion in surfaces.chunks(PORTION) {
            let words: Vec<u32> = portion.iter().flat_map(|surface| self.surface_words(surface.as_ref())).collect();
            let surface_buffer = gpu.storage("surfaces", &words);
            let size = 16 * portion.len() as u64;
            let lit = gpu.results("lit", size);
            let group = self.compute.bind(gpu, [(0, &surface_buffer), (1, &scene_buffer), (2, &lit)]);
            let groups = (portion.len() as u32).div_ceil(ROW);
            self.compute.run(gpu, &group, groups, (&lit, size), |bytes| {
                let rows: &[[u32; 4]] = bytemuck::cast_slice(bytes);
                for (surface, [x, y, z, counts]) in portion.iter().zip(rows) {
                    let light = DVec3::from_array([x, y, z].map(|word| f64::from(f32::from_bits(*word))));
                    shaded.push(surface.as_ref().map(|surface| surface.sent(light)), counts & 0xffff, counts >> 16);
                }
            })?;
        }
        Ok(shaded)
    }

    fn surface_words(&self, surface: Option<&Surface>) -> [u32; 8] {
        let Some(surface) = surface else { return [0; 8] };
        let body = match surface.body {
            Body::Ground => u32::MAX,
            Body::Ball(index) => index as u32,
            Body::Plate(index) => (self.balls + index) as u32,
        };
        let [[px, py, pz, body], [nx, ny, nz, seen]] = [row(surface.place, body), row(surface.normal, 1)];
        [px, py, pz, body, nx, ny, nz, seen]
    }
}

/// Three numbers and a word.
fn row(vector: DVec3, last: u32) -> [u32; 4] {
    let [x, y, z] = vector.as_vec3().to_array().map(f32::to_bits);
    [x, y, z, last]
}

/// The structure `Scene` of the skeleton.
fn scene_rows(scene: &Scene, settings: &Settings) -> Vec<[u32; 4]> {
    let number = |number: f64| (number as f32).to_bits();
    let mut ends = 0;
    let plates = scene.plates.iter().map(|plate| {
        let first = ends;
        ends += plate.corners.len() as u32;
        [first, ends, 0, 0]
    });
    let lobes = scene.lobes.iter().flat_map(|lobe| [row(lobe.axis, number(lobe.sharpness)), row(lobe.amplitude, 0)]);
    // An array has one element more than there are things, as it must have one.
    once([number(settings.border), number(settings.lobe), settings.depth, 0])
        .chain(scene.balls.iter().map(|ball| row(ball.centre, number(ball.radius))))
        .chain(once([0; 4]))
        .chain(plates)
        .chain(once([0; 4]))
        .chain(lobes)
        .chain([[0; 4]; 2])
        .chain(scene.plates.iter().flat_map(|plate| plate.corners.iter().map(|corner| row(*corner, 0))))
        .chain(once([0; 4]))
        .collect()
}
