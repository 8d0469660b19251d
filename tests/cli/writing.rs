//! Results appear together or not at all: with full disks, kills and other runs beside.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use crate::support::{Place, umbrage};

/// A table with a number in it that tells versions apart.
fn table(name: &str, number: u32) -> String {
    format!(
        "Table(language: 1, name: \"{name}\", hit_policy: First, inputs: {{\"x\": Range(from: 0, to: 1)}},
        output: Number(), cases: [Case(id: 1, when: \"x < 0.5\", value: \"x * {number}\")], default: 0)\n"
    )
}

/// What lies in a folder, by name.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let read = |entry: std::fs::DirEntry| {
        let bytes = std::fs::read(entry.path()).unwrap_or_default();
        (entry.file_name().to_string_lossy().into_owned(), bytes)
    };
    std::fs::read_dir(folder).map(|entries| entries.flatten().map(read).collect()).unwrap_or_default()
}

/// A place with two versions of a table, and what is made of each.
fn versions() -> (Place, [BTreeMap<String, Vec<u8>>; 2]) {
    let place = Place::new();
    place.file("other.ron", table("other", 1));
    let made = [2, 3].map(|number| {
        place.file(&format!("v{number}.ron"), table("versioned", number));
        let said = place.run(&format!("build v{number}.ron -o expected{number}"));
        assert_eq!(said.code, Some(0), "{}", said.all());
        contents(&place.path(&format!("expected{number}/versioned")))
    });
    assert!(made[0].len() == made[1].len() && made[0].len() > 8);
    (place, made)
}

/// Killed at many moments, most of them near the end, a build leaves one version whole once somebody comes by again.
#[test]
fn a_killed_build_leaves_one_version() {
    let (place, made) = versions();
    let start = |number: usize| {
        let file = format!("v{number}.ron");
        let mut command = umbrage();
        command.args(["build", &file, "-o", "out"]).current_dir(place.path("")).stdout(std::process::Stdio::null());
        command.spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(start(2).wait().unwrap().success());
    let whole = begun.elapsed();
    let mut seen = [0, 0];
    for round in 0..24 {
        let mut child = start(2 + round % 2);
        // From the whole time back to half of it.
        std::thread::sleep(whole.mul_f64(1.05 - 0.55 * round as f64 / 24.0));
        let _ = child.kill();
        child.wait().unwrap();
        let said = place.run("build other.ron -o out");
        assert_eq!(said.code, Some(0), "{}", said.all());
        let found = contents(&place.path("out/versioned"));
        let version = made.iter().position(|made| *made == found);
        seen[version.unwrap_or_else(|| panic!("round {round}: a mixture: {:?}", found.keys()))] += 1;
        let left: Vec<String> = contents(&place.path("out")).into_keys().collect();
        assert_eq!(left, ["other", "versioned"], "round {round}");
    }
    assert!(seen.iter().sum::<usize>() == 24, "{seen:?}");
}

/// Builds at the same time leave what one of them made.
#[test]
fn builds_at_once_leave_one_version() {
    let (place, made) = versions();
    for round in 0..8 {
        let start = |number: usize| {
            let mut command = umbrage();
            command.args(["build", &format!("v{}.ron", 2 + number % 2), "-o", "out"]);
            command.current_dir(place.path("")).stdout(std::process::Stdio::null()).spawn().unwrap()
        };
        let children: Vec<_> = (round..round + 4).map(start).collect();
        for mut child in children {
            assert!(child.wait().unwrap().success());
        }
        let found = contents(&place.path("out/versioned"));
        assert!(made.contains(&found), "round {round}: a mixture: {:?}", found.keys());
        assert_eq!(contents(&place.path("out")).into_keys().collect::<Vec<_>>(), ["versioned"], "round {round}");
    }
}

/// What a run that was interrupted left does not keep the next one from its work, whoever it belongs to.
#[test]
fn journals_of_others_do_no_harm() {
    let place = Place::new();
    place.file("t.ron", table("t", 1));
    std::fs::create_dir_all(place.path("out")).unwrap();
    place
        .file("kept", "kept")
        .file("out/.umbrage-begun", "7-0\0")
        .file("out/.umbrage-complete", "x/../../kept\0kept\0");
    assert_eq!(place.run("build t.ron -o out").code, Some(0));
    assert_eq!(place.read("kept"), "kept");
    assert_eq!(contents(&place.path("out")).into_keys().collect::<Vec<_>>(), ["t"]);
}

/// A command replaces nothing that it reads, and writes one result to one place; links are followed.
#[test]
fn inputs_are_not_replaced_and_places_are_not_shared() {
    let place = Place::new();
    place.file("t.ron", table("t", 1)).file("rows.csv", "x\n0.25\n").table("spherical_gaussian.ron");
    place.file(
        "f.ron",
        "Table(language: 1, name: \"f\", inputs: {\"x\": Range(from: 0, to: 1)},
        functions: {\"g\": Function(parameters: [\"x\"], value: \"x / 2\")})\n",
    );
    place.file(
        "i.ron",
        "Table(language: 1, name: \"i\", hit_policy: First, imports: {\"f\": \"f.ron\"},
        inputs: {\"x\": Range(from: 0, to: 1)}, output: Number(),
        cases: [Case(id: 1, when: true, value: \"f.g(x)\")], default: 0)\n",
    );
    let mut commands = vec![
        "eval t.ron --input rows.csv --output t.ron",
        "eval t.ron --input rows.csv --output rows.csv",
        "report t.ron -o t.ron",
        "report i.ron -o f.ron",
        "stabilise f.ron -o ./f.ron",
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("t.ron", place.path("link.svg")).unwrap();
        commands.push("atlas t.ron -o link.svg");
    }
    let small = "render --scene text --size 16x9 --shadow-map 16 --backend cpu";
    let shared = format!("{small} -o p.png --capture p.png");
    let quality = "quality --scenes text --shadow-maps 16 --size 16x9 --backend cpu --json q.svg --plot ./q.svg";
    commands.extend([&*shared, quality]);
    let before: Vec<_> = place.files();
    let texts = contents(&place.path(""));
    let mut all = String::new();
    for command in commands {
        let said = place.run(command);
        assert_eq!(said.code, Some(2), "{command}: {}", said.all());
        all += &format!("== {command}\n{}", said.all());
    }
    assert_eq!(place.files(), before);
    assert_eq!(contents(&place.path("")), texts);
    // What is there to change its input does so.
    assert_eq!(place.run("fmt t.ron").code, Some(0));
    insta::assert_snapshot!(all);
}

/// Where nothing fits, the message names the file, and the other results do not appear.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_named_and_leaves_nothing() {
    let place = Place::new();
    place.file("t.ron", table("t", 1)).file("rows.csv", "x\n0.25\n").table("spherical_gaussian.ron");
    let before = place.files();
    let small = "--scene text --size 16x9 --shadow-map 16 --backend cpu";
    let mut all = String::new();
    for command in [
        "stabilise spherical_gaussian.ron --no-certificate -o /dev/full",
        "eval t.ron --input rows.csv --output /dev/full",
        "report t.ron -o /dev/full",
        &format!("render {small} -o p.png --capture /dev/full"),
        "light --size 8x5 -o p.png --cells /dev/full",
    ] {
        let said = place.run(command);
        assert_eq!(said.code, Some(2), "{command}: {}", said.all());
        all += &format!("== {command}\n{}", said.all());
        assert_eq!(place.files(), before, "{command}");
    }
    insta::assert_snapshot!(all);
}
