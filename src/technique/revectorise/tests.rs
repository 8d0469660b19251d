//! Every variant on every scene: what it may change, and how far it is from the true shadow.

use super::{SHADOW_MAP, Variant};
use crate::scene::Scene;
use crate::technique::difference::{Region, difference};
use crate::technique::reference::{FIRST_SAMPLES, MOST_SAMPLES, REFERENCE};
use crate::technique::rendered::{CASE, NONE, STATE, VALUE};
use crate::technique::setting::Value;
use crate::technique::{self, Executor, Frame, Rendered, Settings, Technique, shade};

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

fn rendered(frame: &Frame<'_>, technique: &dyn Technique) -> Rendered {
    let rendered = frame.prepare(technique).and_then(|mut prepared| prepared.render(&|_| ()));
    rendered.unwrap_or_else(|e| panic!("{technique}: {e}"))
}

/// The true visibility with so many samples.
fn truth(frame: &Frame<'_>, first: u32, most: u32) -> Vec<f32> {
    let samples = Settings::default().with(&FIRST_SAMPLES, Value::Whole(first)).with(&MOST_SAMPLES, Value::Whole(most));
    rendered(&frame.with(samples), &REFERENCE).numbers(VALUE).expect("visibility").to_vec()
}

#[test]
fn every_variant_on_every_scene() {
    let mut ratios = Variant::ALL.map(|_| Vec::new());
    for name in Scene::names() {
        let scene = Scene::open(name).unwrap_or_else(|e| panic!("{e}"));
        let Ok(light) = scene.punctual("every variant") else { continue };
        let frame = Frame::new(&scene, SIZE, &Executor::Cpu);
        let truth = truth(&frame, 16, 64);
        let region = Region::silhouettes(&frame.surfaces, &shade::contribution(&light, &frame.surfaces), &truth);
        let frame = frame.with(Settings::default().with(&SHADOW_MAP, Value::Whole(256)));
        let seen = Variant::ALL.map(|variant| {
            let technique = technique::from_name(variant.name()).unwrap_or_else(|e| panic!("{e}"));
            rendered(&frame, technique)
        });
        let value = |variant: Variant| seen[variant as usize].numbers(VALUE).expect("visibility");
        let error = |variant| difference(&frame.surfaces, value(variant), &truth, &region).rmse;
        for (index, variant) in Variant::ALL.into_iter().enumerate() {
            let values = value(variant);
            assert!(values.iter().all(|value| (0.0..=1.0).contains(value)), "{name} {variant}");
            let [cases, states] = [CASE, STATE].map(|layer| seen[index].counts(layer).unwrap_or_default());
            assert_eq!([cases.len(), states.len()], [if variant.table().is_some() { values.len() } else { 0 }; 2]);
            let evaluations = cases.iter().filter(|case| **case != NONE).count();
            assert_eq!(evaluations > 50, variant.table().is_some(), "{name} {variant}: {evaluations} evaluations");
            // Where a table is asked, there is a state; where it is not asked, the plain test decides.
            for (pixel, (case, state)) in cases.iter().zip(states).enumerate() {
                assert_eq!(*case != NONE, *state != NONE, "{name} {variant} {pixel}");
                if *case == NONE && matches!(variant, Variant::Smsr | Variant::Rsmss) {
                    assert_eq!(values[pixel], value(Variant::Hard)[pixel], "{name} {variant} {pixel}");
                }
            }
            ratios[index].push((error(variant) / error(Variant::Hard), name));
        }
        // SMSR adds shadow and takes none away.
        let pairs = value(Variant::Smsr).iter().zip(value(Variant::Hard));
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
        let frame = Frame::new(&scene, (96, 54), &Executor::Cpu);
        let [first, most] = [&FIRST_SAMPLES, &MOST_SAMPLES].map(|setting| Settings::default().whole(setting));
        let [once, twice] = [1, 2].map(|times| truth(&frame, times * first, times * most));
        let differences: Vec<f32> = once.iter().zip(&twice).map(|(a, b)| (a - b).abs()).collect();
        let largest = differences.iter().copied().fold(0.0, f32::max);
        let seen = differences.iter().filter(|difference| **difference > 1.0 / 255.0).count();
        println!("{name}: at most {largest}; {seen} of {} pixels by more than 1/255", differences.len());
        // In so small a picture many pixels show several bars of a fence.
        assert!(largest < 2.0 / 255.0, "{name}: {largest}");
        assert!(seen * 500 < differences.len(), "{name}: {seen} pixels");
    }
}
