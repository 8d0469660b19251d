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
    assert_eq!(
        said.all(),
        "exit code: 0\nstdout:\nabutting\nboxes\nclouds\ncoincident\ncolumns\ndining\ndisk\nfence\nfoliage\ngrazing\nhexagon\nlattice\nleaves\nopening\noutdoor\npoles\nskittles\nslope\nstudio\ntable\nteapot\ntext\ntilt\ntrio\n"
    );
}

/// A blue block over a grey ground, seen from above; light comes from the left, at 45 degrees.
const LID: &str = r#"Scene(
    title: "A lid",
    camera: (eye: (0, 8, 4), target: (0.8, 0, 0)),
    light: Directional(direction: (1, -1, 0)),
    ambient: 0.2,
    objects: [
        (shape: Ground(size: (40, 40)), colour: (0.5, 0.5, 0.5)),
        (shape: Block(size: (1, 0.2, 1)), at: (0, 2, 0), colour: (0, 0, 1)),
    ],
)
"#;

/// Renders [`LID`] with some arguments, and gives the picture.
fn lid(place: &Place, arguments: &str, file: &str) -> image::DynamicImage {
    place.file("lid.ron", LID);
    let said = place.run(&format!("render --scene lid.ron {SMALL} {arguments} -o {file}"));
    assert_eq!(said.all(), "exit code: 0\n", "{arguments}");
    image::open(place.path(file)).unwrap()
}

/// The ground has two brightnesses, which a pencil finds, too: half the colour, times the ambient share, times also
/// the cosine of 45 degrees where it is lit.
#[test]
fn plain_pictures_have_the_expected_light() {
    let place = Place::new();
    let light = lid(&place, "--technique hard", "hard.exr").into_rgb32f();
    assert_eq!(light.dimensions(), (48, 27));
    let near = |a: f32, b: f32| (a - b).abs() < 1e-6;
    let (mut lit, mut dark, mut blue) = (0, 0, 0);
    for (x, y, pixel) in light.enumerate_pixels() {
        match pixel.0 {
            [0.0, 0.0, _] => blue += 1,
            [r, g, b] if r == g && g == b && near(r, 0.5 * 0.2) => dark += 1,
            [r, g, b] if r == g && g == b && near(r, 0.5 * (0.2 + 0.8 * 0.5_f32.sqrt())) => lit += 1,
            other => panic!("{other:?} at {x}, {y}"),
        }
    }
    // The block is nearer to the eye than its shadow, and so a little larger.
    assert!(dark > 10 && dark < blue && blue < 2 * dark && lit > 10 * blue, "{lit} lit, {dark} dark, {blue} blue");

    // The same in the values of a picture: 0.1 is 89, and 0.382843 is 166.
    let encoded = lid(&place, "--technique hard", "hard.png").into_rgb8();
    for (pixel, light) in encoded.pixels().zip(light.pixels()).filter(|(_, light)| light.0[0] > 0.0) {
        assert_eq!(pixel.0, if near(light.0[0], 0.1) { [89; 3] } else { [166; 3] });
    }
}

/// A pixel in which a table was asked has the colour of its case, any other one is grey; the legend stands below.
#[test]
fn pictures_of_cases_colour_what_was_asked() {
    let place = Place::new();
    for technique in ["smsr", "rsmss"] {
        place.file("lid.ron", LID);
        let said = place.run(&format!(
            "render --scene lid.ron {SMALL} --technique {technique} --cases --stats --message-format json -o cases.png"
        ));
        let stats: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        let picture = image::open(place.path("cases.png")).unwrap().into_rgb8();
        assert!(picture.width() == 48 && picture.height() > 27, "{:?}", picture.dimensions());
        let mut found = std::collections::BTreeMap::new();
        for (.., pixel) in picture.enumerate_pixels().filter(|(_, y, _)| *y < 27) {
            if pixel.0 != [pixel.0[0]; 3] {
                *found.entry(pixel.0).or_insert(0) += 1;
            }
        }
        let case = |case: &serde_json::Value| {
            let id = case["case"].as_u64().unwrap() as u32;
            (umbrage::picture::sheet::case_colour(Some(id)).0, case["pixels"].as_u64().unwrap())
        };
        let expected: std::collections::BTreeMap<_, _> = stats["cases"].as_array().unwrap().iter().map(case).collect();
        assert_eq!(found, expected, "{technique}");
    }
}

/// A contact sheet has the picture of each technique in a column of its own, but for the marks on it.
#[test]
fn contact_sheets_show_the_pictures_that_are_compared() {
    let place = Place::new();
    let techniques = ["hard", "rsmss", "reference"];
    let sheet = lid(&place, "--compare hard,rsmss,reference", "sheet.png").into_rgb8();
    for (column, technique) in (0..).zip(techniques) {
        let alone = lid(&place, &format!("--technique {technique}"), "alone.png").into_rgb8();
        let shown = |x: u32, y: u32| sheet.get_pixel(8 + column * (48 + 8) + x, 30 + 24 + y);
        let marks: Vec<_> = alone
            .enumerate_pixels()
            .filter(|(x, y, pixel)| shown(*x, *y) != *pixel)
            .map(|(x, y, _)| shown(x, y))
            .collect();
        let is_mark = |pixel: &&image::Rgb<u8>| matches!(pixel.0, [230, 40, 40] | [20, 110, 230]);
        // At most two squares of 27 pixels a side are marked.
        assert!(marks.len() <= 2 * 4 * 26 && marks.iter().all(is_mark), "{technique}: {marks:?}");
    }
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
    let object: serde_json::Value = serde_json::from_str(&place.read("q.json")).unwrap();
    let rows = object["rows"].as_array().unwrap();
    let of =
        |row: &serde_json::Value| (row["shadow_map"].as_u64().unwrap(), row["technique"].as_str().unwrap().to_owned());
    let names = [(64, "hard"), (64, "rsmss"), (256, "hard"), (256, "rsmss")].map(|(map, name)| (map, name.to_owned()));
    assert_eq!(rows.iter().map(of).collect::<Vec<_>>(), names);
    for measure in ["rmse", "rmse_near", "dssim", "dssim_near"] {
        let [hard, rsmss, fine_hard, fine_rsmss] = [0, 1, 2, 3].map(|row| rows[row][measure].as_f64().unwrap());
        // The line is better than the staircase, and small texels are better than large ones.
        assert!(0.0 < fine_rsmss && fine_rsmss < fine_hard.min(rsmss) && fine_hard.max(rsmss) < hard, "{measure}");
        assert!(hard < 0.2, "{measure}: {hard}");
    }
    for row in rows {
        // Pixels far from a silhouette have small errors, so that those near it have more than all together.
        assert!(row["rmse_near"].as_f64() > row["rmse"].as_f64(), "{row}");
        assert!(said.out.contains(&format!(
            "{:.4} / {:.4}",
            row["rmse"].as_f64().unwrap(),
            row["rmse_near"].as_f64().unwrap()
        )));
    }
    let plot = place.read("q.svg");
    assert_eq!(plot.matches("stroke-width=\"2\" points=").count(), 2, "a line for each technique");
    assert!(["Standing letters", "RMSE near silhouettes", "hard", "rsmss"].iter().all(|text| plot.contains(text)));
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
    let most_reads =
        |technique| passes.iter().find(|pass| pass["technique"] == technique).unwrap()["most_reads"].clone();
    assert_eq!((most_reads("hard"), most_reads("pcf")), (1.into(), 9.into()), "a texel; three by three");
    for technique in ["hard", "pcf", "smsr", "rsmss", "rsmss_one_pass", "casefree", "rsmss_2015"] {
        let of: Vec<_> = passes.iter().filter(|pass| pass["technique"] == technique).collect();
        let kinds: Vec<_> = of.iter().map(|pass| pass["pass"].as_str().unwrap()).collect();
        assert_eq!(kinds, ["compute", "fragment"], "{technique}");
        for pass in of {
            let hard = passes.iter().find(|hard| hard["technique"] == "hard" && hard["pass"] == pass["pass"]).unwrap();
            let ratio = pass["ms"].as_f64().unwrap() / hard["ms"].as_f64().unwrap();
            assert!((pass["vs_hard"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-9, "{pass} to {hard}");
            // What is read and walked is counted, and the same in both kinds of passes.
            let counts = ["reads_per_pixel", "most_reads", "steps_per_pixel", "steps_per_group", "walking"];
            let other = passes.iter().find(|other| other["technique"] == technique && other["pass"] != pass["pass"]);
            assert!(counts.iter().all(|count| other.unwrap()[count] == pass[count]), "{pass} and {other:?}");
        }
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
