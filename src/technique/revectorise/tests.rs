use super::reference::{self, Samples};
use super::stage::{Bias, Stage};
use super::{Receivers, Settings, ShadowMap, Technique, Visibility, cpu};
use crate::scene::Scene;
use crate::scene::surfaces::Surfaces;

fn built_in(name: &str) -> Scene {
    Scene::open(name).unwrap_or_else(|e| panic!("{e}"))
}

fn seen(technique: Technique, map: &ShadowMap, receivers: &Receivers) -> Visibility {
    let program = cpu::table(technique).expect("a table of this crate");
    let settings = Settings::default();
    let frame = cpu::Frame { map, receivers, settings: &settings };
    cpu::visibility(technique, program.as_ref(), frame, &|_| ()).expect("its inputs are known")
}

/// Root of the mean squared difference over the pixels that show a surface.
fn error(picture: &Surfaces, values: &[f32], truth: &[f32]) -> f32 {
    let shown = |pixel: &usize| picture.points[*pixel].is_some();
    let squares: Vec<f32> =
        (0..values.len()).filter(shown).map(|pixel| (values[pixel] - truth[pixel]).powi(2)).collect();
    (squares.iter().sum::<f32>() / squares.len() as f32).sqrt()
}

#[test]
fn every_technique_renders_every_scene() {
    for name in Scene::names().filter(|name| built_in(name).has_punctual()) {
        let scene = built_in(name);
        let stage = Stage::new(&scene).expect("a light");
        let picture = stage.surfaces(160, 90);
        let map = stage.shadow_map(256, Bias::default());
        let receivers = stage.receivers(&picture, 256);
        let truth = reference::visibility(&stage, &picture, Samples { first: 16, most: 64 }, &|_| ());
        let hard = error(&picture, &seen(Technique::Hard, &map, &receivers).value, &truth);
        for technique in Technique::ALL {
            let visibility = seen(technique, &map, &receivers);
            assert!(visibility.value.iter().all(|value| (0.0..=1.0).contains(value)), "{name} {technique}");
            let cases = visibility.case.iter().filter(|case| **case != Visibility::NONE).count();
            assert_eq!(cases > 50, technique.table().is_some(), "{name} {technique}: {cases} evaluations");
            let error = error(&picture, &visibility.value, &truth);
            // SMSR adds shadow.
            let bound = match technique {
                Technique::Smsr => 2.0,
                // A kernel blurs; without cases, gaps of one texel close.
                Technique::Pcf | Technique::Rpcf | Technique::CaseFree => 1.3,
                _ => 1.0,
            };
            assert!(error <= bound * hard, "{name} {technique}: {error} against {hard}");
        }
    }
}

#[test]
fn twice_the_samples_change_nothing_that_could_be_seen() {
    for name in ["fence", "teapot"] {
        let scene = built_in(name);
        let stage = Stage::new(&scene).expect("a light");
        let picture = stage.surfaces(96, 54);
        let samples = Samples::default();
        let twice = Samples { first: 2 * samples.first, most: 2 * samples.most };
        let [once, twice] = [samples, twice].map(|s| reference::visibility(&stage, &picture, s, &|_| ()));
        let differences: Vec<f32> = once.iter().zip(&twice).map(|(a, b)| (a - b).abs()).collect();
        let largest = differences.iter().copied().fold(0.0, f32::max);
        let seen = differences.iter().filter(|difference| **difference > 1.0 / 255.0).count();
        println!("{name}: at most {largest}; {seen} of {} pixels by more than 1/255", differences.len());
        // In so small a picture many pixels show several bars of a fence.
        assert!(largest < 2.0 / 255.0, "{name}: {largest}");
        assert!(seen * 500 < differences.len(), "{name}: {seen} pixels");
    }
}
