//! Points on a GPU: a thread for each, with a light and occluders of its own.

use encase::ShaderType;
use glam::{DVec3, Vec3};

use super::world::{Places, World};
use crate::diag::Failure;
use crate::gpu::pass::{Compute, Module, Resources};
use crate::gpu::{Gpu, laid_out};
use crate::scene::light::Polygon;
use crate::skeleton;
use crate::technique::area::panel::Panel;
use crate::technique::area::peel::Work;
use crate::technique::area::point::{Answer, Query, unit};
use crate::technique::area::single::{SinglePeeler, between, reaches_far};
use crate::technique::area::viewpoint::Viewpoint;

/// Bytes of an `Answer` of the skeleton.
const ANSWER: u64 = 36;
/// Points, and about as many corners of their bodies, that go to the device together.
const PORTION: (usize, usize) = (1 << 14, 1 << 20);
/// Most bodies of a point, and most corners, beyond which the host is as fast.
const MOST: (usize, usize) = (512, 4096);

/// The light of polygons at points, on a GPU in single precision. What its shader has no room for is computed by the
/// host, in the same precision.
#[derive(Debug)]
pub struct PointPeeler<'g> {
    gpu: &'g Gpu,
    module: Module,
    compute: Compute,
    host: SinglePeeler,
    by_host: usize,
}

/// A `Query` of the skeleton.
#[derive(ShaderType)]
struct QueryRow {
    normal: Vec3,
    first: u32,
    row_0: Vec3,
    count: u32,
    row_1: Vec3,
    list: u32,
    row_2: Vec3,
    list_count: u32,
    emits: u32,
    is_shaped: u32,
}

/// Points on their way to the device.
#[derive(Default)]
struct Portion {
    world: World,
    rows: Vec<QueryRow>,
    /// For each row the place of its query.
    places: Vec<usize>,
}

impl<'g> PointPeeler<'g> {
    /// Compiles the shader.
    ///
    /// # Errors
    /// When the device refuses the shader.
    pub fn new(gpu: &'g Gpu) -> Result<Self, Failure> {
        let (module, compute) = super::shader(gpu, "area_points", skeleton::AREA_POINTS)?;
        Ok(Self { gpu, module, compute, host: SinglePeeler::new()?, by_host: 0 })
    }

    /// The number of points so far that the shader had no room for.
    pub fn by_host(&self) -> usize {
        self.by_host
    }

    /// The light at some points.
    ///
    /// # Errors
    /// When the device fails.
    pub fn answers(&mut self, queries: &[Query<'_>]) -> Result<Vec<Answer>, Failure> {
        let none = |query: &Query<'_>| Answer { shaped: query.shape.map(|_| (0.0, 0.0)), ..Answer::default() };
        let mut answers: Vec<Answer> = queries.iter().map(none).collect();
        let (mut beyond, mut portion) = (Vec::new(), Portion::default());
        for (place, query) in queries.iter().enumerate() {
            if !portion.add(place, query) {
                beyond.push(place);
            }
            if portion.rows.len() >= PORTION.0 || portion.world.size() >= PORTION.1 {
                self.run(std::mem::take(&mut portion), queries, &mut answers, &mut beyond)?;
            }
        }
        self.run(portion, queries, &mut answers, &mut beyond)?;
        self.by_host += beyond.len();
        let rest: Vec<Query<'_>> = beyond.iter().map(|place| queries[*place].clone()).collect();
        for (place, answer) in beyond.into_iter().zip(self.host.answers(&rest)?) {
            answers[place] = answer;
        }
        Ok(answers)
    }

    /// Computes a portion; points without room are added to those beyond the device.
    fn run(
        &self,
        portion: Portion,
        queries: &[Query<'_>],
        answers: &mut [Answer],
        beyond: &mut Vec<usize>,
    ) -> Result<(), Failure> {
        let (gpu, count) = (self.gpu, portion.rows.len());
        if count == 0 {
            return Ok(());
        }
        let rows = gpu.storage("queries", &laid_out("queries", &portion.rows)?);
        let results = gpu.results("answers", ANSWER * count as u64);
        let buffers = portion.world.buffers(gpu)?;
        let resources = Resources::new().buffer("queries", &rows).buffer("answers", &results);
        let resources = buffers.iter().fold(resources, |all, (name, buffer)| all.buffer(name, buffer));
        let bound = self.module.bind(gpu, &resources)?;
        let work = self.compute.covering([count as u32, 1, 1]);
        gpu.submit(|encoder| self.compute.encode(encoder, &bound, work, 1, None));
        let words = bytemuck::pod_collect_to_vec::<u8, [u32; 9]>;
        let found: Vec<[u32; 9]> = gpu.read_buffer(&results, ANSWER * count as u64, words)?;
        for (place, [share, above, with, without, shaped, shaped_without, pieces, clips, overflow]) in
            portion.places.into_iter().zip(found)
        {
            let number = |word: u32| f64::from(f32::from_bits(word));
            let answer = Answer {
                fraction: queries[place].fraction.then_some(number(share)),
                fraction_above_horizon: Some(number(above)),
                form_factor: number(with),
                form_factor_unshadowed: number(without),
                shaped: queries[place].shape.map(|_| (number(shaped), number(shaped_without))),
                work: Work { pieces: pieces.into(), clips: clips.into(), overflow: false },
            };
            match overflow == 0 && answer.is_finite() {
                true => answers[place] = answer,
                false => beyond.push(place),
            }
        }
        Ok(())
    }
}

impl Portion {
    /// Takes a point, unless it is one without light; false if the device has no room for it.
    fn add(&mut self, place: usize, query: &Query<'_>) -> bool {
        let Some(from) = Viewpoint::new(query.point, query.light, query.blur) else { return true };
        let Some(panel) = Panel::<f64>::new(query.light, &from) else { return true };
        let between: Vec<_> = between(query, &from, &panel).collect();
        let corners: usize = between.iter().map(|occluder| occluder.corners()).sum();
        if between.len() > MOST.0 || corners > MOST.1 || between.iter().any(|occluder| reaches_far(occluder, &from)) {
            return false;
        }
        let mut corners = query.light.to_vec();
        if !panel.in_front {
            corners.reverse();
        }
        let light = Polygon { corners, two_sided: false, colour: [1.0; 3] };
        let normal = unit(query.normal);
        let rows = query.shape.map_or([[0.0; 3]; 3], |shape| shape.rows(normal));
        let [row_0, row_1, row_2] = rows.map(|row| DVec3::from_array(row).as_vec3());
        let world = &mut self.world;
        world.see(Places::SeenFrom(from));
        let first = world.corners(&light.corners);
        let bodies: Vec<u32> = between.into_iter().flat_map(|occluder| world.add(occluder, &light)).collect();
        let (list, list_count) = (world.words.len() as u32, bodies.len() as u32);
        world.words.extend(bodies);
        self.places.push(place);
        self.rows.push(QueryRow {
            normal: normal.as_vec3(),
            first,
            row_0,
            count: light.corners.len() as u32,
            row_1,
            list,
            row_2,
            list_count,
            emits: (query.two_sided || panel.in_front).into(),
            is_shaped: query.shape.is_some().into(),
        });
        true
    }
}
