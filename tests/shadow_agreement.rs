//! GPU and CPU decide every pixel alike: the same case in the same state, and the same value but for rounding.
#![cfg(all(feature = "gpu", feature = "render"))]
#![allow(clippy::unwrap_used)]

use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::plan::{Plan, Shape};
use umbrage::shadow::gpu::{GpuFrame, Output, Shader, Skeleton};
use umbrage::shadow::{
    DEPTH_UNIT, Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Technique, Visibility, cpu, max_slope,
};

/// Techniques that are evaluated from a shadow map.
const TECHNIQUES: [Technique; 6] =
    [Technique::Hard, Technique::Pcf, Technique::Smsr, Technique::Rsmss, Technique::Rpcf, Technique::CaseFree];

/// How far values may differ. Inputs of a table are sums of two exact numbers and a quotient below 1.5,
/// which WGSL lets be 2.5 ulp off; each input enters a value once, and the value is a sum of three terms below 2.
const ROUNDING: f32 = 4.0 * f32::EPSILON;

/// A frame whose map is noise: every constellation of texels occurs.
fn noise(size: u32, pixels: u32, density: u32, settings: Settings) -> (ShadowMap, Receivers, Settings) {
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
    (ShadowMap { size, depth }, Receivers { width: pixels, height: pixels, points }, settings)
}

#[test]
fn noise_is_decided_alike() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    for (size, density) in [(32, 20), (48, 50)] {
        let (map, receivers, settings) =
            noise(size, 160, density, Settings { search_limit: 16, ..Settings::default() });
        compare(&gpu, &format!("noise {size} {density}"), &map, &receivers, &settings);
    }
}

fn compare(gpu: &Gpu, what: &str, map: &ShadowMap, receivers: &Receivers, settings: &Settings) {
    let frame = GpuFrame::new(gpu, map, receivers).unwrap_or_else(|error| panic!("{error}"));
    for technique in TECHNIQUES {
        let program = cpu::table(technique).unwrap();
        let expected =
            cpu::visibility(technique, program.as_ref(), cpu::Frame { map, receivers, settings }, &|_| {}).unwrap();
        let proved = program.as_ref().map(|program| Plan::proved(program, Shape::Ladder).unwrap());
        for skeleton in [Skeleton::EXACT, Skeleton::PUBLISHED] {
            let shader = Shader::new(gpu, technique, proved.as_ref(), skeleton, Output::Record);
            let shader = shader.unwrap_or_else(|error| panic!("{error}"));
            let (found, _) = shader.record(&frame, settings).unwrap_or_else(|error| panic!("{error}"));
            same(&format!("{what}, {technique}, {skeleton:?}"), &expected, &found);
        }
    }
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

/// A receiver that hugs the surface, so that walks lift it at nearly every step.
#[test]
fn a_walk_that_lifts_its_receiver_is_the_same() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let settings = Settings { search_limit: 7, walk_bias: 0.125, ..Settings::default() };
    let (mut map, receivers, settings) = noise(32, 128, 50, settings);
    map.depth.iter_mut().for_each(|depth| *depth = 0.5 + (*depth - 0.5) * 0.25);
    compare(&gpu, "lifted", &map, &receivers, &settings);
}
