//! The example without a window, on whatever adapter there is.
#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

use image::RgbImage;
use umbrage::picture::srgb;
use umbrage::scene::Scene;
use umbrage::technique::revectorise::SHADOW_MAP;
use umbrage::technique::setting::Value;
use umbrage::technique::{self, Executor, Frame, Settings, shade};

const TABLE: &str = include_str!("../../../tables/rsmss.ron");

fn run(directory: &Path, arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_wgpu-shadows"))
        .args(arguments.split_whitespace())
        .current_dir(directory)
        .env("XDG_RUNTIME_DIR", directory)
        // Whoever runs the tests should not see windows.
        .env_remove("DISPLAY")
        .output()
        .unwrap()
}

/// A picture, and what was said about it; none where there is no adapter and none is required.
fn picture(directory: &Path, arguments: &str) -> Option<(RgbImage, String)> {
    let output = run(directory, &format!("--headless out.png --size 320x180 --shadow-map 128 {arguments}"));
    let problem = String::from_utf8_lossy(&output.stderr);
    if problem.contains("no graphics adapter") && std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_none() {
        eprintln!("skipped: no graphics adapter");
        return None;
    }
    assert!(output.status.success(), "{arguments}: {problem}");
    let said = String::from_utf8(output.stdout).unwrap();
    Some((image::open(directory.join("out.png")).unwrap().to_rgb8(), said))
}

/// In how many pixels two pictures differ by more than rounding.
fn differ(a: &RgbImage, b: &RgbImage) -> usize {
    assert_eq!(a.dimensions(), b.dimensions());
    let apart = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 3);
    a.pixels().zip(b.pixels()).filter(|(a, b)| apart(a.0, b.0)).count()
}

#[test]
fn techniques_plans_and_cases() {
    let place = tempfile::tempdir().unwrap();
    let Some((rsmss, said)) = picture(place.path(), "") else { return };
    assert!(said.starts_with("out.png: rsmss, plan ladder"), "{said}");
    for plan in ["ordered", "gathered", "switch", "tree"] {
        let (same, said) = picture(place.path(), &format!("--plan {plan}")).unwrap();
        assert!(said.starts_with(&format!("out.png: rsmss, plan {plan}")), "{said}");
        assert_eq!(differ(&rsmss, &same), 0, "{plan}");
    }
    let mut others = vec![("rsmss", rsmss.clone())];
    for technique in ["hard", "pcf", "smsr", "rpcf"] {
        let (picture, _) = picture(place.path(), &format!("--technique {technique}")).unwrap();
        for (other, seen) in &others {
            assert!(differ(seen, &picture) > 200, "{technique} looks like {other}");
        }
        others.push((technique, picture));
    }
    let (cases, said) = picture(place.path(), "--cases").unwrap();
    assert!(differ(&rsmss, &cases) > 10_000);
    // As many pixels in colours as the legend counts.
    let counted: usize =
        said.lines().skip(1).map(|line| line[8..].trim().split(' ').next().unwrap().parse::<usize>().unwrap()).sum();
    let coloured = cases.pixels().filter(|pixel| pixel.0.iter().any(|channel| *channel != pixel.0[0])).count();
    assert!(counted > 500 && counted == coloured, "{counted}, {coloured}: {said}");
}

/// What is seen here is what Umbrage's reference renders by rays, but for pixels at the borders of faces.
#[test]
fn pictures_are_those_of_the_reference() {
    let place = tempfile::tempdir().unwrap();
    for (scene, name) in [("fence", "rsmss"), ("teapot", "smsr"), ("lattice", "hard")] {
        let Some((seen, _)) = picture(place.path(), &format!("--scene {scene} --technique {name}")) else {
            return;
        };
        let scene = Scene::open(scene).unwrap();
        let frame = Frame::new(&scene, (320, 180), &Executor::Cpu);
        let frame = frame.with(Settings::default().with(&SHADOW_MAP, Value::Whole(128)));
        let technique = technique::from_name(name).unwrap();
        let rendered = frame.prepare(technique).and_then(|mut prepared| prepared.render(&|_| {}));
        let rendered = rendered.unwrap_or_else(|error| panic!("{error}"));
        let expected = srgb::encode(&shade::picture(&frame, &rendered).unwrap());
        let apart = differ(&seen, &expected);
        assert!(apart < 320 * 180 / 1000, "{}: {apart} pixels differ", scene.name);
    }
}

/// The lines that were counted are those of the cases that were seen.
#[test]
fn lines_of_the_table_are_counted() {
    let place = tempfile::tempdir().unwrap();
    let Some((_, said)) = picture(place.path(), "--cases --hits hits.txt") else { return };
    let program = umbrage::program::Program::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tables/rsmss.ron"));
    let program = program.unwrap_or_else(|error| panic!("{error}"));
    let text = std::fs::read_to_string(place.path().join("hits.txt")).unwrap();
    let counts: Vec<u64> = text.lines().map(|line| line.parse().unwrap()).collect();
    let hits = umbrage::profile::Hits::of_counts(&program, "fence", &counts).unwrap();
    let mut all = 0;
    for line in said.lines().skip(1) {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (case, pixels) = match words.as_slice() {
            ["case", case, pixels, ..] => (Some(case.parse().unwrap()), pixels),
            ["default", pixels, ..] => (None, pixels),
            _ => panic!("{line}"),
        };
        let pixels: u64 = pixels.parse().unwrap();
        assert_eq!(hits.of_case(&program, case), pixels, "{line}");
        all += pixels;
    }
    assert!(all > 500, "{said}");
    let refused = run(place.path(), "--headless out.png --technique pcf --hits hits.txt");
    assert!(String::from_utf8_lossy(&refused.stderr).contains("pcf has no table"));
}

#[test]
fn a_table_that_was_edited() {
    let place = tempfile::tempdir().unwrap();
    let Some((rsmss, _)) = picture(place.path(), "") else { return };
    let edited = |name: &str, from: &str, to: &str| {
        assert!(TABLE.contains(from));
        std::fs::write(place.path().join(name), TABLE.replace(from, to)).unwrap();
    };
    edited("same.ron", "hit_policy: First", "hit_policy:   First");
    let (same, said) = picture(place.path(), "--table same.ron --plan gathered").unwrap();
    assert!(said.contains("plan gathered, table read again"), "{said}");
    assert_eq!(differ(&rsmss, &same), 0);
    edited("other.ron", "\"vertical edge\"", "\"edge that stands\"");
    let (_, said) = picture(place.path(), "--table other.ron --cases").unwrap();
    assert!(said.contains("edge that stands") && !said.contains("  vertical edge"), "{said}");
    edited("wrong.ron", "\"F22\",", "\"F99\",");
    let wrong = run(place.path(), "--headless wrong.png --table wrong.ron");
    let problem = String::from_utf8_lossy(&wrong.stderr);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(problem.contains("`F99` is not defined") && problem.contains("wrong.ron:"), "{problem}");
    assert!(!place.path().join("wrong.png").exists());
}

#[test]
fn what_cannot_be_done_is_said() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("stranger.ron"), TABLE.replace("name: \"rsmss\"", "name: \"stranger\"")).unwrap();
    for (arguments, expected) in [
        ("--plan nested", "the plans are: ladder, ordered, gathered, switch, tree"),
        ("--technique reference", "the techniques are: hard, pcf, smsr, rsmss, rpcf"),
        ("--size 5", "expected WIDTHxHEIGHT"),
        ("--shadow-map 9000", "9000 is not in 16..=8190"),
        ("--scene nowhere --headless a.png", "there is no scene `nowhere`"),
        ("--table stranger.ron --headless a.png", "is the table `stranger`; here are rsmss and smsr"),
        ("--headless nowhere/a.png", "nowhere/a.png: cannot be written"),
        // There is no display.
        ("", "write a picture: --headless out.png"),
    ] {
        let output = run(place.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        if said.contains("no graphics adapter") && std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_none() {
            continue;
        }
        assert_eq!(output.status.code(), Some(2), "{arguments}: {said}");
        assert!(said.contains(expected), "{arguments}: {said}");
    }
}
