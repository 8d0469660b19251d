//! Layers on a device: the passes of `convolve_layers.wgsl` and their buffers.

use std::time::Duration;

use encase::ShaderType;
use glam::{IVec2, UVec2, Vec3};

use super::room;
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::{self, wgsl_text};
use crate::gpu::pass::{Bound, Compute, Module, Resources};
use crate::gpu::timing::Stopwatch;
use crate::gpu::{Buffer, CommandEncoder, Gpu, laid_out};
use crate::plan::{Plan, Shape};
use crate::skeleton;
use crate::technique::Frame;
use crate::technique::convolve::flat::{Flat, Flats};
use crate::technique::convolve::inside::refuse_odd;
use crate::technique::convolve::layers::{Crossing, sort, too_many};
use crate::technique::convolve::matter::occupied;
use crate::technique::convolve::settings::Chosen;
use crate::technique::convolve::stack::Stack;
use crate::technique::convolve::view::SlabView;
use crate::technique::tables::POLICIES;

/// Bytes of an `Entry` of the skeleton.
const ENTRY: u64 = 16;
/// Words of the skeleton's `marks` before those of slabs.
const FIRST_MARK: usize = 5;
/// Pixels of a block of the scan.
const BLOCK: usize = 256;
/// Longer lists are sorted by the host.
const LONGEST_SORTED: u32 = 512;
/// Mesa's rasteriser leaves loops early once a thread has gone through some 65,000 rounds in all.
const LONGEST_IN_SOFTWARE: u32 = 1 << 14;

/// The passes on a device.
#[derive(Debug)]
pub(super) struct LayerPasses {
    module: Module,
    count: Compute,
    scan_blocks: Compute,
    scan_sums: Compute,
    add_sums: Compute,
    scatter: Compute,
    arrange: Compute,
    mark: Compute,
}

/// The lists of a frame on a device.
#[derive(Debug)]
pub(super) struct Lists {
    /// The view that they are of.
    pub(super) view: SlabView,
    /// The depth that depths are relative to.
    pub(super) base: f64,
    /// The nearest and the farthest surface; `None` where nothing is seen.
    pub(super) depths: Option<(f32, f32)>,
    /// Surfaces at each pixel.
    pub(super) crossings: Vec<u32>,
    /// Of each pixel 1 if its list ended inside of matter.
    pub(super) odd: Vec<u32>,
    /// `lists` and `entries` of the skeletons.
    pub(super) lists: Buffer,
    pub(super) entries: Buffer,
    triangles: Buffer,
    counts: Buffer,
    frame: FrameRow,
    bound: Option<Bound>,
}

/// The words of `marks` that say what was counted.
struct Counted {
    total: u32,
    longest: u32,
    depths: (f32, f32),
    odd: u32,
}

/// The text of the shader: the module of the table's function, and the skeleton around it.
fn text() -> Result<String, Failure> {
    Ok(emit::wgsl(&Plan::proved(POLICIES.function("crossed")?, Shape::Ladder)?) + "\n" + skeleton::CONVOLVE_LAYERS)
}

impl LayerPasses {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses it.
    pub(super) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let module = Module::new(gpu, "convolve_layers", wgsl_text("convolve_layers", &text()?)?)?;
        let pass = |entry: &str| module.compute(gpu, entry, &[]);
        Ok(Self {
            count: pass("count")?,
            scan_blocks: pass("scan_blocks")?,
            scan_sums: pass("scan_sums")?,
            add_sums: pass("add_sums")?,
            scatter: pass("scatter")?,
            arrange: pass("arrange")?,
            mark: pass("mark")?,
            module,
        })
    }

    /// The lists of a frame.
    ///
    /// # Errors
    /// When there are more surfaces than the device has room for, some that are not allowed, or the device fails.
    pub(super) fn lists(&self, gpu: &Gpu, frame: &Frame<'_>, chosen: &Chosen) -> Result<Lists, Failure> {
        let view = SlabView::new(frame.scene, frame.size(), chosen.projection);
        let flats = Flats::new(frame.scene, &view);
        let (width, height) = view.size;
        let pixels = width as usize * height as usize;
        let rows: u64 = flats.all.iter().map(|flat| u64::from(flat.extent[1])).sum();
        let rows = u32::try_from(rows).map_err(|_| too_many("the", u64::from(u32::MAX)))?;
        let bytes = laid_out("triangles", &triangle_rows(&flats.all))?;
        room(gpu, "the triangles", bytes.len() as u64)?;
        room(gpu, "the lists of pixels", 8 * pixels as u64)?;
        let mut lists = Lists {
            base: flats.base,
            depths: None,
            crossings: vec![0; pixels],
            odd: vec![0; pixels],
            lists: gpu.results("lists", 8 * pixels as u64),
            entries: gpu.results("entries", ENTRY),
            triangles: gpu.storage("triangles", &bytes),
            counts: gpu.results("counts", 4 * pixels as u64),
            frame: FrameRow {
                size: UVec2::new(width, height),
                triangles: flats.all.len() as u32,
                rows,
                parallel: flats.parallel.into(),
                rule: if chosen.inside.rule == "winding" { 1.0 } else { 0.0 },
                drop_odd: u32::from(chosen.inside.odd_list == "drop_last"),
                sorted: 0,
                slabs: 0,
            },
            bound: None,
            view,
        };
        if flats.all.is_empty() {
            return Ok(lists);
        }
        let sums = gpu.results("words", 4 * pixels.div_ceil(BLOCK) as u64);
        let marks = gpu.results("marks", 4 * FIRST_MARK as u64);
        let bound = self.bind(gpu, &lists, &sums, &marks)?;
        gpu.submit(|encoder| self.encode_count(encoder, &bound, &lists, None));
        let Counted { total, longest, .. } = counted(gpu, &marks)?;
        if total == 0 {
            return Ok(lists);
        }
        if total == u32::MAX {
            return Err(too_many("2^32 or more", gpu.largest_storage() / ENTRY));
        }
        room(gpu, &format!("the {total} crossings of surfaces"), ENTRY * u64::from(total))?;
        if gpu.is_software() && longest > LONGEST_IN_SOFTWARE {
            let message = format!("a pixel has {longest} surfaces, and a software adapter takes {LONGEST_IN_SOFTWARE}");
            let error = Diagnostic::error(codes::RENDER, message);
            return Err(Failure::bare("", error.help("render with `--backend cpu`")));
        }
        lists.entries = gpu.results("entries", ENTRY * u64::from(total));
        let bound = self.bind(gpu, &lists, &sums, &marks)?;
        let in_rows = self.scatter.in_line(rows);
        gpu.submit(|encoder| self.scatter.encode(encoder, &bound, in_rows, 1, None));
        let bound = if longest > LONGEST_SORTED {
            lists.entries = gpu.storage("entries", &sorted(gpu, &lists, total)?);
            lists.frame.sorted = 1;
            self.bind(gpu, &lists, &sums, &marks)?
        } else {
            bound
        };
        let in_pixels = self.arrange.in_line(pixels as u32);
        gpu.submit(|encoder| self.arrange.encode(encoder, &bound, in_pixels, 1, None));
        let Counted { depths, odd, .. } = counted(gpu, &marks)?;
        refuse_odd(odd as usize, pixels, chosen.inside)?;
        lists.depths = Some(depths);
        lists.crossings = gpu.read_buffer(&lists.counts, 4 * pixels as u64, bytemuck::pod_collect_to_vec::<u8, u32>)?;
        let ends = gpu.read_buffer(&lists.lists, 8 * pixels as u64, bytemuck::pod_collect_to_vec::<u8, [u32; 2]>)?;
        lists.odd = ends.into_iter().map(|[_, end]| end >> 31).collect();
        lists.bound = Some(bound);
        Ok(lists)
    }

    /// Of each slab, whether it holds matter at any pixel.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn occupied(&self, gpu: &Gpu, lists: &Lists, stack: &Stack) -> Result<Vec<bool>, Failure> {
        let count = stack.count();
        let edges: Vec<u32> = stack.edges().iter().map(|edge| edge.to_bits()).collect();
        let words = gpu.storage("words", &edges);
        let marks = gpu.results("marks", 4 * (FIRST_MARK + count + 1) as u64);
        let frame = FrameRow { slabs: count as u32, ..lists.frame };
        let bound = self.bind_with(gpu, lists, &frame, &words, &marks)?;
        let work = self.mark.in_line(lists.crossings.len() as u32);
        gpu.submit(|encoder| self.mark.encode(encoder, &bound, work, 1, None));
        let bytes = 4 * (FIRST_MARK + count + 1) as u64;
        let starts = gpu.read_buffer(&marks, bytes, bytemuck::pod_collect_to_vec::<u8, i32>)?;
        let starts: Vec<i64> = starts[FIRST_MARK..].iter().map(|start| i64::from(*start)).collect();
        Ok(occupied(&starts))
    }

    /// Makes the lists again, of the same length, and measures it.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn time(&self, lists: &Lists, stopwatch: &Stopwatch<'_>) -> Result<Duration, Failure> {
        let Some(bound) = &lists.bound else { return Ok(Duration::ZERO) };
        stopwatch.time(|encoder, marks| {
            encoder.clear_buffer(&lists.counts, 0, None);
            let [start, end] = marks.span();
            self.encode_count(encoder, bound, lists, start);
            self.scatter.encode(encoder, bound, self.scatter.in_line(lists.frame.rows), 1, None);
            self.arrange.encode(encoder, bound, self.arrange.in_line(lists.crossings.len() as u32), 1, end);
        })
    }

    fn encode_count(
        &self,
        encoder: &mut CommandEncoder,
        bound: &Bound,
        lists: &Lists,
        start: Option<crate::gpu::TimestampWrites<'_>>,
    ) {
        let pixels = lists.crossings.len() as u32;
        self.count.encode(encoder, bound, self.count.in_line(lists.frame.rows), 1, start);
        self.scan_blocks.encode(encoder, bound, self.scan_blocks.in_line(pixels), 1, None);
        self.scan_sums.encode(encoder, bound, self.scan_sums.in_line(1), 1, None);
        self.add_sums.encode(encoder, bound, self.add_sums.in_line(pixels), 1, None);
    }

    fn bind(&self, gpu: &Gpu, lists: &Lists, words: &Buffer, marks: &Buffer) -> Result<Bound, Failure> {
        self.bind_with(gpu, lists, &lists.frame, words, marks)
    }

    fn bind_with(
        &self,
        gpu: &Gpu,
        lists: &Lists,
        frame: &FrameRow,
        words: &Buffer,
        marks: &Buffer,
    ) -> Result<Bound, Failure> {
        let frame = gpu.uniform("frame", frame)?;
        let resources = Resources::new()
            .buffer("frame", &frame)
            .buffer("triangles", &lists.triangles)
            .buffer("counts", &lists.counts)
            .buffer("lists", &lists.lists)
            .buffer("words", words)
            .buffer("entries", &lists.entries)
            .buffer("marks", marks);
        self.module.bind(gpu, &resources)
    }
}

/// The lists, sorted by the host.
fn sorted(gpu: &Gpu, lists: &Lists, total: u32) -> Result<Vec<[u32; 4]>, Failure> {
    let bytes = ENTRY * u64::from(total);
    let rows = gpu.read_buffer(&lists.entries, bytes, bytemuck::pod_collect_to_vec::<u8, [u32; 4]>)?;
    let pixels = lists.crossings.len() as u64;
    let ends = gpu.read_buffer(&lists.lists, 8 * pixels, bytemuck::pod_collect_to_vec::<u8, [u32; 2]>)?;
    let crossing = |[depth, surface, object, normal]: &[u32; 4]| Crossing {
        depth: f32::from_bits(*depth),
        front: surface >> 31 == 0,
        triangle: surface & 0x7fff_ffff,
        object: *object,
        normal: *normal,
    };
    let mut all: Vec<Crossing> = rows.iter().map(crossing).collect();
    for [first, length] in ends {
        sort(&mut all[first as usize..(first + length) as usize]);
    }
    let row = |at: Crossing| [at.depth.to_bits(), at.triangle | u32::from(!at.front) << 31, at.object, at.normal];
    Ok(all.into_iter().map(row).collect())
}

fn counted(gpu: &Gpu, marks: &Buffer) -> Result<Counted, Failure> {
    let words = gpu.read_buffer(marks, 4 * FIRST_MARK as u64, bytemuck::pod_collect_to_vec::<u8, u32>)?;
    let depth = |word: u32| f32::from_bits(if word >> 31 == 0 { !word } else { word & 0x7fff_ffff });
    Ok(Counted { total: words[0], longest: words[1], depths: (depth(!words[2]), depth(words[3])), odd: words[4] })
}

/// A `Frame` of the skeleton.
#[derive(Debug, ShaderType, Clone, Copy)]
struct FrameRow {
    size: UVec2,
    triangles: u32,
    rows: u32,
    parallel: u32,
    rule: f32,
    drop_odd: u32,
    sorted: u32,
    slabs: u32,
}

/// A `Triangle` of the skeleton.
#[derive(ShaderType, Default)]
struct TriangleRow {
    a: IVec2,
    b: IVec2,
    c: IVec2,
    first: UVec2,
    columns: u32,
    before: u32,
    depths: Vec3,
    area: f32,
    inverses: Vec3,
    shift: u32,
    flags: u32,
    triangle: u32,
    object: u32,
    normal_a: u32,
    normal_b: u32,
    normal_c: u32,
}

/// The triangles as the skeleton has them; an array must have an element.
fn triangle_rows(flats: &[Flat]) -> Vec<TriangleRow> {
    let mut before = 0;
    let row = |flat: &Flat| {
        let [a, b, c] = flat.corners.map(IVec2::from_array);
        let [normal_a, normal_b, normal_c] = flat.normals;
        let ties = flat.ties.iter().enumerate().fold(0, |flags, (i, tie)| flags | u32::from(*tie) << i);
        let row = TriangleRow {
            a,
            b,
            c,
            first: UVec2::from_array(flat.first),
            columns: flat.extent[0],
            before,
            depths: Vec3::from_array(flat.depths),
            area: flat.area,
            inverses: Vec3::from_array(flat.inverses),
            shift: flat.shift,
            flags: ties | u32::from(!flat.front) << 31,
            triangle: flat.triangle,
            object: flat.object,
            normal_a,
            normal_b,
            normal_c,
        };
        before += flat.extent[1];
        row
    };
    let mut rows: Vec<TriangleRow> = flats.iter().map(row).collect();
    if rows.is_empty() {
        rows.push(TriangleRow::default());
    }
    rows
}
