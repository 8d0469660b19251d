//! The search on a GPU: surfaces and a hierarchy of triangles go there, light and counts come back.
//!
//! Pixels of one colour of a checkerboard are searched first, then the others, which learn from these. The shader has
//! bounded memory; the host searches the pixels that need more, each for itself.

use std::time::Duration;

use glam::{DVec3, UVec2, Vec3};

use super::super::gpu::compiled;
use super::super::received::Received;
use super::TABLES;
use super::picture::{Picture, Pixels};
use super::rows::{Casters, FrameRow, SurfaceRow, light_rows};
use super::{Options, Rule};
use crate::diag::Failure;
use crate::emit;
use crate::gpu::pass::{Bound, Compute, Module, Resources, Work};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::skeleton;
use crate::technique::tables::{CLIP_STEP, EDGE_INTEGRAL, PCG};

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
    let tables = TABLES.into_iter().filter(|table| table.name != EDGE_INTEGRAL.name).chain([&CLIP_STEP]);
    let functions =
        [(&EDGE_INTEGRAL, "term"), (&EDGE_INTEGRAL, "small"), (&PCG, "hash"), (&PCG, "unit"), (&PCG, "jitter")];
    let module = |program: &'static Program| Ok(emit::wgsl(&Plan::proved(program, Shape::Ladder)?) + "\n");
    let tables = tables.map(|table| module(table.program()?));
    let functions = functions.into_iter().map(|(table, name)| module(table.function(name)?));
    Ok(tables.chain(functions).collect::<Result<String, Failure>>()? + skeleton::SEARCH)
}

impl<'g> Searching<'g> {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub(super) fn new(gpu: &'g Gpu) -> Result<Self, Failure> {
        let (module, compute) = compiled(gpu, "area_search", &text()?)?;
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

    /// The findings at every pixel of a picture.
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
