//! Every variant on every scene: what it may change, and how far it is from the true shadow.

use super::stage::{Bias, Stage};
use super::{Settings, Variant, Visibility, cpu};
use crate::scene::Scene;
use crate::technique::difference::{Region, difference};
use crate::technique::reference::{self, Samples};
use crate::technique::shade;

const SIZE: (u32, u32) = (160, 90);

/// The largest error of a variant near silhouettes, as a share of that of the plain depth test: over all scenes, and
/// in the worst one. Measured, with some room.
fn bounds(variant: Variant) -> (f64, f64) {
    match variant {
        Variant::Hard => (1.0, 1.0),
        Variant::Pcf => (1.0, 1.3),
        // It adds shadow: lines where the staircase was, at its outer side.
        Variant::Smsr => (1.2, 1.6),
        Variant::Rsmss => (0.8, 1.0),
        Variant::Rpcf => (1.0, 1.3),
        Variant::CaseFree => (1.0, 1.3),
    }
}

#[test]
fn every_variant_on_every_scene() {
    let mut ratios = Variant::ALL.map(|_| Vec::new());
    for name in Scene::names() {
        let scene = Scene::open(name).unwrap_or_else(|e| panic!("{e}"));
        let Ok(stage) = Stage::new(&scene) else { continue };
        let surfaces = stage.surfaces(SIZE.0, SIZE.1);
        let map = stage.shadow_map(256, Bias::default());
        let receivers = stage.receivers(&surfaces, 256);
        let settings = Settings::default();
        let query = cpu::Query { map: &map, receivers: &receivers, settings: &settings };
        let samples = Samples { first: 16, most: 64 };
        let truth = reference::visibility(&scene, &stage.light, &stage.rays, &surfaces, samples, &|_| ());
        let weights = shade::contribution(&stage.light, &surfaces);
        let region = Region::silhouettes(&surfaces, &weights, &truth);
        let seen: Vec<Visibility> = Variant::ALL
            .iter()
            .map(|variant| {
                let program = variant.program().unwrap_or_else(|e| panic!("{e}"));
                cpu::visibility(*variant, program, query, &|_| ()).unwrap_or_else(|e| panic!("{e}"))
            })
            .collect();
        let of = |variant: Variant| &seen[variant as usize];
        let error = |variant| difference(&surfaces, &of(variant).value, &truth, &region).rmse;
        for (index, variant) in Variant::ALL.into_iter().enumerate() {
            let visibility = of(variant);
            assert!(visibility.value.iter().all(|value| (0.0..=1.0).contains(value)), "{name} {variant}");
            let cases = visibility.case.iter().filter(|case| **case != Visibility::NONE).count();
            assert_eq!(cases > 50, variant.table().is_some(), "{name} {variant}: {cases} evaluations");
            // Where a table is asked, there is a state; where it is not asked, the plain test decides.
            for pixel in 0..visibility.value.len() {
                let asked = visibility.case[pixel] != Visibility::NONE;
                assert_eq!(asked, visibility.state[pixel] != Visibility::NONE, "{name} {variant} {pixel}");
                if !asked && matches!(variant, Variant::Smsr | Variant::Rsmss) {
                    assert_eq!(visibility.value[pixel], of(Variant::Hard).value[pixel], "{name} {variant} {pixel}");
                }
            }
            ratios[index].push((error(variant) / error(Variant::Hard), name));
        }
        // SMSR adds shadow and takes none away.
        let pairs = of(Variant::Smsr).value.iter().zip(&of(Variant::Hard).value);
        assert!(pairs.clone().all(|(smsr, hard)| smsr <= hard), "{name}");
        assert!(pairs.clone().any(|(smsr, hard)| smsr < hard), "{name}");
    }
    for (variant, ratios) in Variant::ALL.into_iter().zip(ratios) {
        let mean = ratios.iter().map(|(ratio, _)| ratio).sum::<f64>() / ratios.len() as f64;
        let (worst, scene) = ratios.iter().fold((0.0, ""), |worst, one| if one.0 > worst.0 { *one } else { worst });
        println!("{variant}: {mean:.3} of the error of the plain test, {worst:.3} in {scene}");
        let (most, most_in_a_scene) = bounds(variant);
        assert!(mean <= most && worst <= most_in_a_scene, "{variant}: {mean}, {worst} in {scene}");
    }
}

#[test]
fn twice_the_samples_change_nothing_that_could_be_seen() {
    for name in ["fence", "teapot"] {
        let scene = Scene::open(name).unwrap_or_else(|e| panic!("{e}"));
        let stage = Stage::new(&scene).unwrap_or_else(|e| panic!("{e}"));
        let surfaces = stage.surfaces(96, 54);
        let samples = Samples::default();
        let twice = Samples { first: 2 * samples.first, most: 2 * samples.most };
        let [once, twice] = [samples, twice]
            .map(|samples| reference::visibility(&scene, &stage.light, &stage.rays, &surfaces, samples, &|_| ()));
        let differences: Vec<f32> = once.iter().zip(&twice).map(|(a, b)| (a - b).abs()).collect();
        let largest = differences.iter().copied().fold(0.0, f32::max);
        let seen = differences.iter().filter(|difference| **difference > 1.0 / 255.0).count();
        println!("{name}: at most {largest}; {seen} of {} pixels by more than 1/255", differences.len());
        // In so small a picture many pixels show several bars of a fence.
        assert!(largest < 2.0 / 255.0, "{name}: {largest}");
        assert!(seen * 500 < differences.len(), "{name}: {seen} pixels");
    }
}
