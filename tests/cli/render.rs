//! `umbrage scenes`, `render` and `quality`: what they write, and what they say about bad input.

use crate::support::Place;

/// A triangle over the ground, from a mesh.
const SCENE: &str = r#"Scene(
    title: "A triangle",
    camera: (eye: (0, 3, 6), target: (0, 0.5, 0)),
    light: Directional(direction: (0.3, -1, 0.2)),
    objects: [
        (shape: Ground(size: (10, 10))),
        (shape: Mesh(file: "mesh.obj"), at: (0, 1, 0)),
    ],
)
"#;

const MESH: &str = "v -1 0 0\nv 1 0 0\nv 0 0.5 1\nv 0 1 0\nf 1 2 3\nf 1 2 4\n";

const SMALL: &str = "--size 48x27 --shadow-map 64 --backend cpu";

#[test]
fn scenes_are_listed_one_a_line() {
    let said = Place::new().run("scenes");
    assert_eq!(said.all(), "exit code: 0\nstdout:\nfence\nfoliage\nlattice\noutdoor\nslope\nstudio\nteapot\ntext\n");
}

#[test]
fn pictures_of_all_kinds_are_written() {
    let place = Place::new();
    let png = b"\x89PNG";
    for arguments in [
        "--technique hard -o a.png",
        "--cases -o b.png",
        "--technique smsr --cases -o c.png",
        "--compare hard,rsmss,reference -o d.png",
    ] {
        let said = place.run(&format!("render --scene text {SMALL} {arguments}"));
        assert_eq!(said.all(), "exit code: 0\n", "{arguments}");
    }
    for name in ["a.png", "b.png", "c.png", "d.png"] {
        assert!(std::fs::read(place.path(name)).unwrap().starts_with(png), "{name}");
    }
    let said = place.run(&format!("render --scene text {SMALL} -o e.exr"));
    assert_eq!(said.code, Some(0));
    assert!(std::fs::read(place.path("e.exr")).unwrap().starts_with(&[0x76, 0x2f, 0x31, 0x01]));
}

/// A spot whose cone covers a small part of the ground, with a wall in it.
/// A block in the cone of a spot, which lights a small part of a ground of some size.
fn spot(ground: u32) -> String {
    format!(
        r#"Scene(
    title: "A spot",
    camera: (eye: (0, 6, 6), target: (0, 0, 0)),
    light: Spot(position: (1, 4, 0.5), target: (0, 0, 0), angle: 30),
    objects: [
        (shape: Ground(size: ({ground}, {ground}))),
        (shape: Block(size: (0.5, 0.5, 0.5)), turn: (0, 20, 0)),
    ],
)
"#
    )
}

/// Out of a spot's cone there is no light, so that nothing there is an error, however much of it a picture shows.
#[test]
fn errors_count_where_the_light_can_reach() {
    let place = Place::new();
    place.file("narrow.ron", spot(5)).file("wide.ron", spot(30));
    let said = place.run(
        "quality --scenes narrow.ron,wide.ron --shadow-maps 64,1024 --techniques hard,rsmss --size 320x180 \
         --backend cpu --message-format json",
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    let rmse = |scene: &str, map: u64, technique: &str| {
        let wanted = |row: &&serde_json::Value| {
            row["scene"] == scene && row["shadow_map"] == map && row["technique"] == technique
        };
        object["rows"].as_array().unwrap().iter().find(wanted).unwrap()["rmse"].as_f64().unwrap()
    };
    for scene in ["narrow", "wide"] {
        assert!(rmse(scene, 64, "rsmss") < 0.75 * rmse(scene, 64, "hard"), "{}", said.out);
        assert!(rmse(scene, 1024, "hard") < 0.9 * rmse(scene, 64, "hard"), "{}", said.out);
    }
    // The bias is a share of the range of depths, which the ground widens: nearly equal, not equal.
    let ratio = rmse("wide", 64, "rsmss") / rmse("narrow", 64, "rsmss");
    assert!((0.85..1.15).contains(&ratio), "{}", said.out);
}

#[test]
fn captured_inputs_can_be_evaluated() {
    let place = Place::new();
    place.table("rsmss.ron");
    let said = place.run(&format!("render --scene fence {SMALL} --capture frame.csv --stats"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    let rows = place.read("frame.csv").lines().count() - 1;
    assert!(said.out.contains(&format!("fence, rsmss: {rows} of 1296 pixels asked a table")), "{}", said.out);
    let answers = place.run("eval rsmss.ron --input frame.csv");
    assert_eq!((answers.code, answers.out.lines().count()), (Some(0), rows + 1), "{}", answers.err);
}

#[test]
fn meshes_are_placed_by_a_scene_file() {
    let place = Place::new();
    place.file("scene.ron", SCENE).file("mesh.obj", MESH);
    let said = place.run(&format!("render --scene scene.ron {SMALL} --stats"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.starts_with("scene, rsmss: "), "{}", said.out);
}

#[test]
fn quality_measures_and_judges() {
    let place = Place::new();
    let said = place.run(
        "quality --scenes text --shadow-maps 64,256 --techniques hard,rsmss --size 64x36 --backend cpu \
         --json q.json --plot q.svg",
    );
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("weighted by the light that would be there"), "{}", said.out);
    assert!(place.read("q.json").contains("\"rmse_near\""));
    assert!(place.read("q.svg").starts_with("<svg"));
}

/// Every technique in both kinds of passes, with what it is compared with.
#[test]
#[cfg(feature = "gpu")]
fn passes_are_measured() {
    let place = Place::new();
    let small = "bench --scene text --size 48x27 --shadow-map 64 --rounds 2 --warm-up 0";
    let said = place.run(&format!("{small} --message-format json"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!((&object["scene"], &object["width"], &object["shadow_map"]), (&"text".into(), &48.into(), &64.into()));
    let passes = object["passes"].as_array().unwrap();
    for technique in ["hard", "pcf", "smsr", "rsmss", "rsmss_one_pass", "casefree", "rsmss_2015"] {
        let mut of = passes.iter().filter(|pass| pass["technique"] == technique);
        assert!(of.all(|pass| pass["ms"].as_f64().unwrap() > 0.0 && pass["vs_hard"].as_f64().unwrap() > 0.0));
        assert_eq!(passes.iter().filter(|pass| pass["technique"] == technique).count(), 2, "{technique}");
    }
    for (bad, expected) in [
        ("--rounds 0", "invalid value '0' for '--rounds <COUNT>'"),
        ("--plan bush", "invalid value 'bush' for '--plan <PLAN>'"),
        ("--scene fense", "fense"),
        ("--adapter none-of-these", "error[U0801]: "),
    ] {
        let said = place.run(&format!("bench --size 48x27 --shadow-map 64 {bad}"));
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{bad}: {}", said.err);
        assert!(said.err.contains(expected), "{bad}: {}", said.err);
    }
}

/// Runs with a scene and a mesh of one's own and shows what was said.
fn fails(scene: &str, mesh: Option<&[u8]>, arguments: &str) -> String {
    let place = Place::new();
    place.file("scene.ron", scene);
    if let Some(mesh) = mesh {
        place.file("mesh.obj", mesh).file("mesh.glb", mesh).file("mesh.gltf", mesh);
    }
    let said = place.run(&format!("render --scene scene.ron {SMALL} -o out.png {arguments}"));
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{}", said.err);
    let mut left: Vec<_> = std::fs::read_dir(place.path("")).unwrap().map(|e| e.unwrap().file_name()).collect();
    left.retain(|name| !name.to_string_lossy().starts_with("mesh.") && name != "scene.ron");
    assert!(left.is_empty(), "half-written: {left:?}");
    said.err
}

#[test]
fn bad_scenes_are_refused_at_the_place_of_the_mistake() {
    let change = |from: &str, to: &str| {
        assert!(SCENE.contains(from));
        SCENE.replacen(from, to, 1)
    };
    let cases = [
        ("dark light", change("(0.3, -1, 0.2)", "(0, 0, 0)")),
        ("camera at its target", change("(0, 3, 6)", "(0, 0.5, 0)")),
        ("unknown field", change("eye:", "eyes:")),
        ("no size", change("(10, 10)", "(10, 0)")),
        ("not finite", change("at: (0, 1, 0)", "at: (0, inf, 0)")),
        ("unclosed", change("],\n)", "")),
        ("unknown shape", change("Ground(size", "Floor(size")),
        (
            "empty",
            change("(shape: Ground(size: (10, 10))),\n        (shape: Mesh(file: \"mesh.obj\"), at: (0, 1, 0)),", ""),
        ),
        ("letters", change("Mesh(file: \"mesh.obj\")", "Text(text: \"é\", height: 1, stroke: 0.1)")),
    ];
    let all: String =
        cases.iter().map(|(what, scene)| format!("== {what}\n{}", fails(scene, Some(MESH.as_bytes()), ""))).collect();
    insta::assert_snapshot!(all);
}

#[test]
fn bad_meshes_are_refused_where_they_are_named() {
    let gltf = SCENE.replace("mesh.obj", "mesh.gltf");
    let glb = SCENE.replace("mesh.obj", "mesh.glb");
    // A buffer of 12 bytes for three vertices of 12 bytes each.
    let short = r#"{"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 12}],
        "buffers": [{"byteLength": 12, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAA"}]}"#;
    let cases: [(&str, &str, Option<&[u8]>); 8] = [
        ("missing", SCENE, None),
        ("empty", SCENE, Some(b"")),
        ("not a number", SCENE, Some(b"v NaN 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")),
        ("no triangle with an area", SCENE, Some(b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")),
        ("broken", SCENE, Some(b"v 0 zero 0\n")),
        ("vertex out of range", SCENE, Some(b"v 0 0 0\nv 1 0 0\nf 1 2 7\n")),
        ("no glTF", &glb, Some(b"glTF....")),
        ("accessor beyond its buffer", &gltf, Some(short.as_bytes())),
    ];
    let all: String =
        cases.iter().map(|(what, scene, mesh)| format!("== {what}\n{}", fails(scene, *mesh, ""))).collect();
    insta::assert_snapshot!(all);
}

#[test]
fn bad_options_are_refused() {
    let place = Place::new();
    let commands = [
        "render --scene text --shadow-map 0 -o out.png",
        "render --scene text --shadow-map 99999 -o out.png",
        "render --scene text --size 0x10 -o out.png",
        "render --scene text --technique soft -o out.png",
        "render --scene fense -o out.png",
        "render --scene missing.ron -o out.png",
        "render --scene text",
        "render --scene text -o out.jpg",
        "render --scene text --technique hard --cases -o out.png",
        "render --scene text -o nowhere/out.png",
        "render --scene text --pcf 2 -o out.png",
        "quality --plot out.txt",
    ];
    let all: String = commands
        .iter()
        .map(|command| {
            let said = place.run(command);
            assert_eq!(said.code, Some(2), "{command}");
            format!("== {command}\n{}", said.err)
        })
        .collect();
    insta::assert_snapshot!(all);
}
