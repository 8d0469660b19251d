//! GPU and CPU decide every pixel alike: the same case in the same state, and the same value but for rounding.

use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use umbrage::scene::Scene;
use umbrage::technique::revectorise::gpu::{GpuFrame, Output, Raster, Shader, Skeleton};
use umbrage::technique::revectorise::stage::{Bias, Stage};
use umbrage::technique::revectorise::{
    DEPTH_UNIT, Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Variant, Visibility, cpu, max_slope,
};

/// How far values may differ. Inputs of a table are sums of two exact numbers and a quotient below 1.5,
/// which WGSL lets be 2.5 ulp off; each input enters a value once, and the value is a sum of three terms below 2.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// A frame whose map is noise: every constellation of texels occurs.
fn noise(size: u32, pixels: u32, density: u32) -> (ShadowMap, Receivers) {
    let mut seed = 0x2545_f491_u32;
    let mut random = move |below: u32| {
        seed ^= seed << 13;
        seed ^= seed >> 17;
        seed ^= seed << 5;
        seed % below
    };
    let depth = (0..size * size)
        .map(|_| if random(100) < density { 0.25 + random(8) as f32 / 64.0 } else { 0.75 + random(8) as f32 / 64.0 })
        .collect();
    let slope = (max_slope(size) / DEPTH_UNIT) as u32;
    let points = (0..pixels * pixels)
        .map(|pixel| Receiver {
            // A little beyond the map on each side.
            u: (pixel % pixels) as f32 / pixels as f32 * 1.1 - 0.05,
            v: (pixel / pixels) as f32 / pixels as f32 * 1.1 - 0.05,
            z: 0.5 + random(1 << 16) as f32 * DEPTH_UNIT,
            kind: match random(50) {
                0 => ReceiverKind::Background,
                1 => ReceiverKind::Away,
                _ => ReceiverKind::Facing,
            },
            dz_dx: (random(slope) as f32 - slope as f32 / 2.0).floor() * DEPTH_UNIT / 16.0_f32.min(size as f32),
            dz_dy: 0.0,
        })
        .collect();
    (ShadowMap { size, depth }, Receivers { width: pixels, height: pixels, points })
}

/// Every technique with its table, compiled in the ways that must not differ.
struct Executors<'g> {
    programs: Vec<Option<&'static Program>>,
    shaders: Vec<(usize, Skeleton, Shader<'g>)>,
    /// As fast as possible: values only.
    fast: Vec<(usize, Output, Shader<'g>)>,
}

impl<'g> Executors<'g> {
    fn new(gpu: &'g Gpu) -> Self {
        let programs: Vec<_> = Variant::ALL.iter().map(|variant| variant.program().unwrap()).collect();
        let mut shaders = Vec::new();
        let mut fast = Vec::new();
        for (index, program) in programs.iter().enumerate() {
            let proved = program.map(|program| Plan::proved(program, Shape::Ladder).unwrap());
            for skeleton in [Skeleton::EXACT, Skeleton::PUBLISHED] {
                let shader = Shader::new(gpu, Variant::ALL[index], proved.as_ref(), skeleton, Output::Record);
                shaders.push((index, skeleton, shader.unwrap_or_else(|error| panic!("{error}"))));
            }
            for output in [Output::Compute, Output::Fragment] {
                let shader = Shader::new(gpu, Variant::ALL[index], proved.as_ref(), Skeleton::FAST, output);
                fast.push((index, output, shader.unwrap_or_else(|error| panic!("{error}"))));
            }
        }
        Self { programs, shaders, fast }
    }

    /// Compares a frame, with every skeleton if it is to be thorough.
    fn compare(
        &self,
        gpu: &Gpu,
        what: &str,
        map: &ShadowMap,
        receivers: &Receivers,
        settings: &Settings,
        thorough: bool,
    ) {
        let frame = GpuFrame::new(gpu, map, receivers).unwrap_or_else(|error| panic!("{error}"));
        for (index, technique) in Variant::ALL.into_iter().enumerate() {
            let program = self.programs[index];
            let expected =
                cpu::visibility(technique, program, cpu::Query { map, receivers, settings }, &|_| {}).unwrap();
            for (_, skeleton, shader) in self.shaders.iter().filter(|(of, ..)| *of == index) {
                if thorough || *skeleton == Skeleton::EXACT {
                    let (found, _) = shader.record(&frame, settings).unwrap_or_else(|error| panic!("{error}"));
                    same(&format!("{what}, {technique}, {skeleton:?}"), &expected, &found);
                }
            }
            for (_, output, shader) in self.fast.iter().filter(|(of, ..)| *of == index) {
                let bound = shader.bind(&frame, settings).unwrap_or_else(|error| panic!("{error}"));
                let found = bound.values().unwrap_or_else(|error| panic!("{error}"));
                let what = format!("{what}, {technique}, fast {}", output.name());
                let found = Visibility { value: found, ..expected.clone() };
                same(&what, &expected, &found);
            }
        }
    }
}

fn gpu() -> Gpu {
    Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn noise_is_decided_alike() {
    let gpu = gpu();
    let executors = Executors::new(&gpu);
    // A map whose size is no power of two: places in a texel are rounded.
    for (size, density) in [(32, 20), (48, 50)] {
        let (map, receivers) = noise(size, 160, density);
        let settings = Settings { search_limit: 16, ..Settings::default() };
        executors.compare(&gpu, &format!("noise {size}"), &map, &receivers, &settings, true);
    }
    // A receiver that hugs the surface, so that walks lift it at nearly every step.
    let (mut map, receivers) = noise(32, 128, 50);
    map.depth.iter_mut().for_each(|depth| *depth = 0.5 + (*depth - 0.5) * 0.25);
    let settings = Settings { search_limit: 7, walk_bias: 0.125, ..Settings::default() };
    executors.compare(&gpu, "lifted", &map, &receivers, &settings, true);
}

/// No pixel of any scene is excluded.
#[test]
fn scenes_are_decided_alike() {
    let gpu = gpu();
    let executors = Executors::new(&gpu);
    let settings = Settings::default();
    for name in Scene::names() {
        let scene = Scene::open(name).unwrap_or_else(|error| panic!("{error}"));
        if !scene.has_punctual() {
            continue;
        }
        let stage = Stage::new(&scene, "every variant").unwrap_or_else(|error| panic!("{error}"));
        let by_rays = stage.shadow_map(256, Bias::default());
        let receivers = stage.receivers(&stage.surfaces(480, 270), 256);
        executors.compare(&gpu, name, &by_rays, &receivers, &settings, false);

        let raster = Raster::new(&gpu, &stage).unwrap_or_else(|error| panic!("{error}"));
        let rastered = raster.shadow_map(256, Bias::default()).unwrap_or_else(|error| panic!("{error}"));
        let picture = raster.picture(480, 270, 256).unwrap_or_else(|error| panic!("{error}"));
        executors.compare(&gpu, &format!("{name}, rastered"), &rastered, &picture.receivers, &settings, false);
        like(name, &by_rays, &rastered, &receivers, &picture.receivers);
    }
}

/// Rasterising and casting rays differ at the borders of faces only.
fn like(name: &str, by_rays: &ShadowMap, rastered: &ShadowMap, receivers: &Receivers, others: &Receivers) {
    let texels = by_rays.depth.iter().zip(&rastered.depth).filter(|(a, b)| (*a - *b).abs() > 4.0 * DEPTH_UNIT).count();
    let pixels = receivers.points.iter().zip(&others.points).filter(|(a, b)| {
        a.kind != b.kind
            || [a.u - b.u, a.v - b.v].into_iter().any(|off| off.abs() > 0.01 / 256.0)
            || (a.texel(256).0 == b.texel(256).0 && (a.z - b.z).abs() > 4.0 * DEPTH_UNIT)
    });
    let pixels = pixels.count();
    println!("{name}: {texels} texels and {pixels} pixels differ between rays and rasterising");
    assert!(texels * 20 < by_rays.depth.len(), "{texels} texels");
    assert!(pixels * 50 < receivers.points.len(), "{pixels} pixels");
}

fn same(what: &str, expected: &Visibility, found: &Visibility) {
    let differing: Vec<usize> = (0..expected.value.len())
        .filter(|&i| {
            expected.case[i] != found.case[i]
                || expected.state[i] != found.state[i]
                || (expected.value[i] - found.value[i]).abs() > ROUNDING
        })
        .collect();
    for &i in differing.iter().take(5) {
        println!(
            "{what}: pixel {i}: CPU case {} state {} value {}, GPU case {} state {} value {}",
            expected.case[i], expected.state[i], expected.value[i], found.case[i], found.state[i], found.value[i]
        );
    }
    let worst = (0..expected.value.len()).map(|i| (expected.value[i] - found.value[i]).abs()).fold(0.0, f32::max);
    println!("{what}: {} of {} differ, worst {worst:e}", differing.len(), expected.value.len());
    assert!(differing.is_empty(), "{what}");
}
