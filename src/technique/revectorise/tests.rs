//! Every variant on every scene: what it may change, and how far it is from the true shadow.

use super::{SHADOW_MAP, Variant};
use crate::scene::Scene;
use crate::technique::difference::{Region, difference};
use crate::technique::reference::{FIRST_SAMPLES, MOST_SAMPLES, REFERENCE};
use crate::technique::rendered::{CASE, NONE, STATE, VALUE};
use crate::technique::setting::Value;
use crate::technique::{self, Executor, Frame, Rendered, Settings, Technique, shade};

const SIZE: (u32, u32) = (160, 90);

/// The error of a variant near silhouettes as a share of that of the plain depth test: the mean over all scenes, and
/// the largest. Measured; pictures of the interpreter are the same everywhere, so a change of more than a hundredth
/// is a change of the technique.
fn measured(variant: Variant) -> (f64, f64) {
    match variant {
        Variant::Hard => (1.0, 1.0),
        Variant::Pcf => (0.583, 0.804),
        Variant::Smsr => (1.149, 1.479),
        Variant::Rsmss => (0.754, 0.954),
        Variant::Rpcf => (0.588, 1.055),
        Variant::CaseFree => (0.780, 1.042),
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
    let mean = |variant: Variant| {
        let ratios = &ratios[variant as usize];
        ratios.iter().map(|(ratio, _)| ratio).sum::<f64>() / ratios.len() as f64
    };
    for variant in Variant::ALL {
        let mean = mean(variant);
        let worst = ratios[variant as usize].iter().max_by(|a, b| a.0.total_cmp(&b.0)).expect("there are scenes");
        println!("{variant}: {mean:.3} of the error of the plain test, {:.3} in {}", worst.0, worst.1);
        let (expected, expected_worst) = measured(variant);
        assert!((mean - expected).abs() < 0.01, "{variant}: {mean}");
        assert!((worst.0 - expected_worst).abs() < 0.01, "{variant}: {worst:?}");
    }
    // SMSR draws its line through the outer corners of the staircase, half a texel from the true edge. So twice the
    // area of the staircase is wrong where edges are long and slanted, which is the root of two in the error.
    assert!(mean(Variant::Smsr) < 2_f64.sqrt());
    // RSMSS puts the same line where the edge is: better than both, in every scene.
    for ((rsmss, name), (smsr, _)) in ratios[Variant::Rsmss as usize].iter().zip(&ratios[Variant::Smsr as usize]) {
        assert!(*rsmss < smsr.min(1.0), "{name}: {rsmss}, {smsr}");
    }
    // Filters are better than no filter; that of the case-free formulation is the line of RSMSS, nearly.
    for variant in [Variant::Pcf, Variant::Rpcf, Variant::CaseFree] {
        assert!(mean(variant) < 0.8, "{variant}");
    }
    assert!((mean(Variant::CaseFree) / mean(Variant::Rsmss) - 1.0).abs() < 0.05);
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
