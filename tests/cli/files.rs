//! Files: what may stand around a table, and with which permissions results are written.

use crate::support::Place;

const TABLE: &str = "Table(language: 1, name: \"halved\", hit_policy: First,
    inputs: {\"x\": Range(from: 0, to: 1)}, output: Number(),
    cases: [Case(id: 1, when: true, value: \"x / 2\")], default: 0)
";

/// Block comments nest, wherever they stand.
#[test]
fn comments_nest_before_and_behind_the_table() {
    let place = Place::new();
    for (before, behind) in
        [("/* a /* nested */ b */\n", ""), ("/* a */ // b\n/* /**/ */", " /* /* c */ */ // d"), ("", "/* /* e */ */")]
    {
        place.file("halved.ron", format!("{before}{TABLE}{behind}"));
        let said = place.run("check halved.ron");
        assert_eq!(said.code, Some(0), "{before}…{behind}: {}", said.all());
    }
}

/// Commands that write files, and what they write.
#[cfg(unix)]
const WRITING: [(&str, &str); 5] = [
    ("build halved.ron -o out", "out/halved/ladder.wgsl"),
    ("atlas halved.ron -o halved.svg", "halved.svg"),
    ("report halved.ron -o page.html", "page.html"),
    ("fmt halved.ron", "halved.ron"),
    ("new other --table-only", "tables/other.ron"),
];

/// Every command leaves files as the user's umask wants new ones, and an existing file as it was.
#[cfg(unix)]
#[test]
fn all_commands_write_with_the_same_permissions() {
    use std::os::unix::fs::PermissionsExt;
    for (umask, expected) in [("022", 0o644), ("077", 0o600), ("027", 0o640)] {
        for (command, file) in WRITING {
            let place = Place::new();
            place.file("halved.ron", TABLE);
            if file == "halved.ron" {
                let private = std::fs::Permissions::from_mode(expected);
                std::fs::set_permissions(place.path(file), private).unwrap();
            }
            let mode = |place: &Place| std::fs::metadata(place.path(file)).unwrap().permissions().mode() & 0o777;
            let said = place.run_under(umask, command);
            assert_eq!(said.code, Some(0), "{command}: {}", said.all());
            assert_eq!(mode(&place), expected, "{command} under {umask}: {:o}", mode(&place));
            if command.starts_with("new") {
                continue;
            }
            std::fs::set_permissions(place.path(file), std::fs::Permissions::from_mode(0o664)).unwrap();
            place.file(file, "other");
            place.file("halved.ron", TABLE);
            let said = place.run_under(umask, command);
            assert_eq!(said.code, Some(0), "{command}, again: {}", said.all());
            assert_eq!(mode(&place), 0o664, "{command}, again: {:o}", mode(&place));
        }
    }
}

const IMPORTING: &str = "Table(language: 1, name: \"importing\", hit_policy: First, imports: {\"m\": \"FILE\"},
    inputs: {\"x\": Range(from: 0, to: 1)}, output: Number(),
    cases: [Case(id: 1, when: true, value: \"m.f(x)\")], default: 0)
";

const IMPORTED: &str = "Table(language: 1, name: \"imported\", inputs: {\"x\": Range(from: 0, to: 1)},
    functions: {\"f\": Function(parameters: [\"x\"], value: \"x / 2\")})
";

const NAMING: &str = "Scene(
    camera: (eye: (0, 3, 6), target: (0, 0.5, 0)), light: Directional(direction: (0.3, -1, 0.2)),
    objects: [(shape: Ground(size: (10, 10))), (shape: Mesh(file: \"FILE\"))],
)
";

/// Files name files in their own directories, unless that is allowed.
#[test]
fn files_out_of_reach_are_not_read() {
    let place = Place::new();
    std::fs::create_dir_all(place.path("own/deep")).unwrap();
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    place.file("imported.ron", IMPORTED).file("own/deep/imported.ron", IMPORTED);
    place.file("mesh.obj", triangle).file("own/deep/mesh.obj", triangle);
    let gltf = |uri: &str| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
            "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}}],
            "bufferViews": [{{"buffer": 0, "byteLength": 36}}], "buffers": [{{"byteLength": 36, "uri": "{uri}"}}]}}"#
        )
    };
    place.file("triangle.bin", [0, 0, 0, 1, 0, 0, 0, 1, 0].map(|n| (n as f32).to_le_bytes()).concat());
    place.file("own/outside.gltf", gltf("%2e%2e/triangle.bin"));
    place.file("own/device.gltf", gltf("/dev/zero"));
    #[cfg(unix)]
    for (target, link) in [("../imported.ron", "own/link.ron"), ("../mesh.obj", "own/link.obj")] {
        std::os::unix::fs::symlink(target, place.path(link)).unwrap();
    }
    let render = "render --size 8x6 --shadow-map 8 --backend cpu --stats --scene own/naming.ron";
    let mut all = String::new();
    for (file, is_outside) in [
        ("deep/imported.ron", false),
        ("../imported.ron", true),
        ("../missing.ron", true),
        #[cfg(unix)]
        ("link.ron", true),
        ("deep/mesh.obj", false),
        ("../mesh.obj", true),
        #[cfg(unix)]
        ("link.obj", true),
        ("outside.gltf", true),
        ("device.gltf", true),
    ] {
        let (name, text, command) = match file.ends_with(".ron") {
            true => ("own/importing.ron", IMPORTING, "check own/importing.ron"),
            false => ("own/naming.ron", NAMING, render),
        };
        place.file(name, text.replace("FILE", file));
        let said = place.run(command);
        assert_eq!(said.code, Some(if is_outside { 2 } else { 0 }), "{file}: {}", said.all());
        assert_eq!(said.err.contains("--allow-outside"), is_outside, "{file}: {}", said.all());
        all += &said.err;
        let allowed = place.run(&format!("{command} --allow-outside"));
        let is_there = !file.contains("missing") && !file.contains("device");
        assert_eq!(allowed.code, Some(if is_there { 0 } else { 2 }), "{file}: {}", allowed.all());
        if !is_there {
            all += &allowed.err;
        }
    }
    insta::assert_snapshot!(all);
}

/// What may never begin or never end is not read, whatever it is given as.
#[cfg(unix)]
#[test]
fn devices_pipes_and_circles_are_not_read() {
    let place = Place::new();
    place.file("halved.ron", TABLE);
    std::fs::create_dir_all(place.path("tables")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(place.path("tables/pipe.ron")).status().unwrap().success());
    for (target, link) in [("/dev/zero", "zero.ron"), ("circle.ron", "circle.ron"), ("nowhere.ron", "broken.ron")] {
        std::os::unix::fs::symlink(target, place.path(link)).unwrap();
    }
    let mut all = String::new();
    for command in [
        "check tables",
        "fmt tables",
        "check zero.ron",
        "check circle.ron",
        "check broken.ron",
        "eval halved.ron --input zero.ron",
        "eval halved.ron --input /dev/zero",
        "build halved.ron --profile tables/pipe.ron",
        "render --stats --scene zero.ron",
    ] {
        let said = place.run(command);
        all += &format!("== {command}\n{}", said.all());
    }
    insta::assert_snapshot!(all);
}
