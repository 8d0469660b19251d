//! `umbrage area`: points in, light out.

use crate::support::*;
use serde_json::Value;

const LIGHT: &str = r#""light": [[-1,1,2],[1,1,2],[1,-1,2],[-1,-1,2]], "point": [0,0,0], "normal": [0,0,3]"#;

/// The answers to some points.
fn answers(place: &Place, input: &str, arguments: &str) -> Vec<Value> {
    place.file("points.json", input);
    let said = place.run(&format!("area --input points.json {arguments}"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    said.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(answer: &Value, name: &str) -> f64 {
    answer[name].as_f64().unwrap_or_else(|| panic!("{name} of {answer}"))
}

#[test]
fn points_have_the_published_numbers_in_both_precisions() {
    let place = Place::new();
    let input = format!(
        r#"[{{"id": "plate", {LIGHT}, "occluders": [{{"type": "polygon", "v": [[-0.25,-0.25,1],[0.25,-0.25,1],[0.25,0.25,1],[-0.25,0.25,1]]}}]}},
            {{"id": {{"row": 2}}, {LIGHT}, "occluders": [{{"type": "box", "center": [0.5,0,2], "axes": [[0.25,0,0],[0,0.25,0],[0,0,0.5]]}}]}},
            {{"id": 3, {LIGHT}, "ltc": {{"view": [0,0,1], "minv": [[1,0,0],[0,1,0],[0,0,1]]}}}},
            {{{LIGHT}, "occluders": [{{"type": "mesh", "v": [[-1,-1,1],[0,-1,1],[0,1,1],[-1,1,1]], "f": [[0,1,2,3]]}}]}},
            {{"id": 5, "light": [[1,0,0],[2,0,0],[2,1,0]], "point": [0,0,0], "normal": [0,0,1]}}]"#
    );
    for (precision, limit) in [("f64", 1e-12), ("f32", 1e-6)] {
        let found = answers(&place, &input, &format!("--precision {precision}"));
        let expected = [
            (Some(0.75), 0.165978835648252),
            (Some(505.0 / 576.0), 0.207812806696237),
            (Some(1.0), 0.239456470460774),
            (Some(0.5), 0.119728235230387),
            (None, 0.0),
        ];
        assert_eq!(found.len(), expected.len());
        for (answer, (fraction, factor)) in found.iter().zip(expected) {
            assert!((number(answer, "form_factor") - factor).abs() < limit, "{answer}");
            match fraction {
                Some(fraction) => assert!((number(answer, "fraction") - fraction).abs() < 2.0 * limit, "{answer}"),
                None => assert!(answer["fraction"].is_null() && answer["fraction_above_horizon"].is_null()),
            }
            assert!(!answer["overflow"].as_bool().unwrap());
        }
        assert_eq!(
            (&found[0]["id"], &found[1]["id"]["row"], &found[3]["id"]),
            (&"plate".into(), &2.into(), &Value::Null)
        );
        assert!((number(&found[2], "ltc") - number(&found[2], "form_factor")).abs() < limit);
        assert!(found[0].get("ltc").is_none());
        assert_eq!((number(&found[0], "pieces"), number(&found[0], "clips")), (4.0, 13.0));
    }
}

#[test]
fn lines_are_as_good_as_an_array_and_nothing_gives_nothing() {
    let place = Place::new();
    let line = format!("{{\"id\": 1, {LIGHT}}}\n");
    let lines = answers(&place, &line.repeat(3), "");
    let array = answers(&place, &format!("[{line},{line},{line}]"), "");
    assert_eq!((lines.len(), &lines), (3, &array));
    assert!(answers(&place, "", "").is_empty() && answers(&place, "[]", "").is_empty());
}

#[test]
fn malformed_points_are_refused_by_line_and_id_and_nothing_is_written() {
    let place = Place::new();
    let head = format!("{{\"id\": \"x\", {LIGHT}");
    let bad = [
        "[{\"id\": 1}]".to_owned(),
        "{\"id\": 1,".to_owned(),
        "{\"id\": 2, \"light\": [[0,0,1],[1,0,1]], \"point\": [0,0,0], \"normal\": [0,0,1]}".to_owned(),
        "{\"light\": [[0,0,1],[1,0,1],[1,1,1],[0,1,1.5]], \"point\": [0,0,0], \"normal\": [0,0,1]}".to_owned(),
        "{\"light\": [[0,0,1],[1,0,1],[0.1,0.1,1],[0,1,1]], \"point\": [0,0,0], \"normal\": [0,0,1]}".to_owned(),
        "{\"light\": [[0,0,1],[1,0,1e999],[0,1,1]], \"point\": [0,0,0], \"normal\": [0,0,1]}".to_owned(),
        "{\"light\": [[0,0,1],[1,0,1e16],[0,1,1]], \"point\": [0,0,0], \"normal\": [0,0,1]}".to_owned(),
        "{\"light\": [[0,0,1],[1,0,1],[0,1,1]], \"point\": [0,0,0], \"normal\": [0,0,0]}".to_owned(),
        format!("{head}, \"ocluders\": []}}"),
        format!("{head}, \"occluders\": [{{\"type\": \"ball\"}}]}}"),
        format!(
            "{head}, \"occluders\": [{{\"type\": \"box\", \"center\": [0,0,0], \"axes\": [[1,0,0],[1,1,0],[0,0,1]]}}]}}"
        ),
        format!("{head}, \"occluders\": [{{\"type\": \"box\", \"center\": [0,0,0], \"v\": []}}]}}"),
        format!(
            "{head}, \"occluders\": [{{\"type\": \"mesh\", \"v\": [[0,0,1],[1,0,1],[0,1,1]], \"f\": [[0,1,3]]}}]}}"
        ),
        format!("{head}, \"ltc\": {{\"view\": [0,0,1], \"minv\": [[1,0],[0,1]]}}}}"),
        format!("{head}, \"two_sided\": 1}}"),
        format!("{head}, \"id\": 4}}"),
    ];
    let mut all = String::new();
    for input in bad {
        place.file("points.json", format!("\n{input}"));
        let said = place.run("area --input points.json --output answers.json");
        assert_eq!(said.code, Some(2), "{input}");
        assert!(!place.path("answers.json").exists());
        all += &said.err;
    }
    insta::assert_snapshot!(all);
}

/// Of the specification, section 4: an occluder before a triangle of light, its configuration and discontinuities.
type Known = (&'static str, &'static str, [&'static [f64]; 3], f64);

const BEFORE_A_TRIANGLE: [Known; 3] = [
    ("[[-0.5,1,1],[1,-0.5,1],[1.5,-0.5,1],[-0.5,1.5,1]]", "C022", [&[0.25, 0.5], &[], &[0.5, 0.75]], 13.0 / 16.0),
    ("[[-0.5,-0.5,1],[1.5,-0.5,1],[1.5,1.5,1],[-0.5,1.5,1]]", "C112", [&[0.75], &[0.25, 0.75], &[0.25]], 1.0 / 8.0),
    ("[[1.5,-1,1],[1.5,1.5,1],[-1,1.5,1]]", "C222", [&[0.25, 0.75], &[0.25, 0.75], &[0.25, 0.75]], 3.0 / 16.0),
];

#[test]
fn a_search_finds_configurations_and_discontinuities_within_its_tolerance() {
    let place = Place::new();
    let row = |(index, (occluder, ..)): (usize, &Known)| {
        format!(
            r#"{{"id": {index}, "light": [[0,0,2],[4,0,2],[0,4,2]], "two_sided": true, "point": [0,0,0], "normal": [0,0,1],
                "occluders": [{{"type": "polygon", "v": {occluder}}}]}}"#
        )
    };
    let rows: Vec<String> = BEFORE_A_TRIANGLE.iter().enumerate().map(row).collect();
    let input = rows.join("\n");
    for arguments in ["", "--rays 0", "--rays 5 --seed 7", "--precision f32"] {
        let found = answers(&place, &input, &format!("--method search {arguments}"));
        assert_eq!(found, answers(&place, &input, &format!("--method search {arguments}")), "the same seed");
        for (answer, (_, configuration, discontinuities, fraction)) in found.iter().zip(BEFORE_A_TRIANGLE) {
            assert_eq!(answer["configuration"], configuration, "{answer}");
            for (edge, expected) in discontinuities.iter().enumerate() {
                let places: Vec<f64> = serde_json::from_value(answer["discontinuities"][edge].clone()).unwrap();
                assert_eq!(places.len(), expected.len(), "{answer}");
                assert!(
                    places.iter().zip(*expected).all(|(place, expected)| (place - expected).abs() <= 0.05),
                    "{answer}"
                );
            }
            assert!((number(answer, "fraction") - fraction).abs() < 0.15, "{answer}");
            assert!((6.0..=129.0).contains(&number(answer, "tests")), "{answer}");
        }
    }
    let other = answers(&place, &input, "--method search --seed 1");
    assert_ne!(other[0]["discontinuities"], answers(&place, &input, "--method search")[0]["discontinuities"]);
}

#[test]
fn a_search_of_lights_with_more_corners_says_what_it_found_of_each_triangle() {
    let place = Place::new();
    let input = format!(
        r#"[{{"id": "quad", {LIGHT}}},
            {{"id": "hidden", {LIGHT}, "occluders": [{{"type": "polygon", "v": [[-9,-9,1],[9,-9,1],[9,9,1],[-9,9,1]]}}]}},
            {{"id": "in its plane", "light": [[1,0,0],[2,0,0],[2,1,0]], "point": [0,0,0], "normal": [0,0,1]}},
            {{"id": "inside", {LIGHT}, "occluders": [{{"type": "box", "center": [0,0,0], "axes": [[1,0,0],[0,1,0],[0,0,1]]}}]}},
            {{"id": "several", {LIGHT}, "occluders": [{{"type": "polygon", "v": [[-0.4,-0.1,1],[-0.2,-0.1,1],[-0.2,0.1,1]]}},
                                                      {{"type": "polygon", "v": [[0.4,-0.1,1],[0.2,-0.1,1],[0.2,0.1,1]]}}]}}]"#
    );
    let found = answers(&place, &input, "--method search");
    let names = |index: usize| found[index]["configuration"].clone();
    assert_eq!(names(0), serde_json::json!(["C000", "C000"]));
    assert_eq!((number(&found[0], "fraction"), number(&found[1], "fraction")), (1.0, 0.0));
    assert!((number(&found[0], "form_factor") - 0.239456470460774).abs() < 1e-12);
    assert_eq!(
        (&found[2]["fraction"], &found[2]["configuration"], &found[2]["tests"]),
        (&Value::Null, &Value::Null, &0.into())
    );
    assert_eq!(found[2]["discontinuities"], serde_json::json!([[], [], []]));
    assert_eq!(number(&found[3], "form_factor"), 0.0);
    let beyond: Vec<bool> = found.iter().map(|answer| answer["overflow"].as_bool().unwrap()).collect();
    assert_eq!(beyond, [false, false, false, false, true], "several occluders are not what it is made for");
}

#[test]
fn options_of_the_search_are_for_the_search() {
    let place = Place::new();
    place.file("points.json", format!("{{{LIGHT}}}"));
    for option in ["--rays 3", "--seed 3"] {
        let said = place.run(&format!("area --input points.json {option}"));
        assert_eq!(said.code, Some(2));
        assert!(said.err.contains("is for `--method search`"), "{}", said.err);
    }
    for wrong in ["--rays 6", "--rays -1", "--seed x", "--seed 4294967296"] {
        let said = place.run(&format!("area --input points.json --method search {wrong}"));
        assert_eq!(said.code, Some(2), "{wrong}");
    }
    place.file("points.json", format!("{{{LIGHT}}}"));
    let said = place.run("area --input points.json --method search --backend gpu");
    assert!(said.code == Some(2) && said.err.contains("the search of points runs on the CPU"), "{}", said.err);
}

#[test]
fn a_gpu_gives_the_same_fields_in_single_precision_and_refuses_double() {
    let place = Place::new();
    let input = format!(
        r#"{{"id": "plate", {LIGHT}, "occluders": [{{"type": "polygon", "v": [[-0.25,-0.25,1],[0.25,-0.25,1],[0.25,0.25,1],[-0.25,0.25,1]]}}]}}
           {{"id": 3, {LIGHT}, "ltc": {{"view": [1,0,1], "minv": [[1,0,0.2],[0,1,0],[-0.1,0,0.7]]}}}}
           {{"id": 5, "light": [[1,0,0],[2,0,0],[2,1,0]], "point": [0,0,0], "normal": [0,0,1]}}"#
    );
    place.file("points.json", &input);
    for backend in ["gpu", "auto"] {
        let said = place.run(&format!("area --input points.json --backend {backend} --precision f64"));
        assert_eq!(said.code, Some(2));
        assert!(said.out.is_empty() && said.err.contains("the GPU computes in f32 only"), "{}", said.err);
    }
    let expected = answers(&place, &input, "--precision f32");
    // Without a GPU this is the CPU, in the same precision.
    assert_eq!(answers(&place, &input, "--backend auto").len(), 3);
    if crate::support::adapter().is_none() {
        return;
    }
    let found = answers(&place, &input, "--backend gpu");
    for (found, expected) in found.iter().zip(&expected) {
        let fields = |answer: &Value| answer.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!((fields(found), &found["id"]), (fields(expected), &expected["id"]));
        for (name, value) in expected.as_object().unwrap() {
            match value.as_f64() {
                Some(value) => assert!((number(found, name) - value).abs() < 1e-6, "{name}: {found} {expected}"),
                None => assert_eq!(&found[name], value),
            }
        }
    }
    place.file("points.json", "[{\"id\": 1}]");
    let said = place.run("area --input points.json --backend gpu");
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
    assert!(said.err.contains("id 1"), "{}", said.err);
}

#[test]
fn quality_of_area_lights_is_that_of_form_factors_beside_the_time() {
    let place = Place::new();
    let command = "quality --scenes table --size 32x18 --rounds 1 --backend cpu";
    let said = place.run(&format!(
        "{command} --techniques peel,area_samples,area_unshadowed --rays 1,64 --message-format json --plot times.svg"
    ));
    assert_eq!(said.code, Some(0), "{}", said.err);
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let rows = found["rows"].as_array().unwrap();
    let error = |technique: &str, rays: Option<u64>| {
        let row = rows.iter().find(|row| row["technique"] == technique && row["rays"].as_u64() == rays).unwrap();
        assert!(number(row, "ms") > 0.0 && number(row, "mae") <= number(row, "rmse"), "{row}");
        assert!(number(row, "rmse") <= number(row, "most"), "{row}");
        number(row, "rmse")
    };
    assert_eq!(rows.len(), 4);
    assert!(error("peel", None) < 1e-7);
    let [few, many, none] =
        [error("area_samples", Some(1)), error("area_samples", Some(64)), error("area_unshadowed", None)];
    assert!(many < few / 4.0 && many < none / 4.0, "{few} {many} {none}");
    assert!(std::fs::read_to_string(place.path("times.svg")).unwrap().contains("RMSE of the form factor"));
    let said = place.run(&format!("{command} --techniques peel,area_samples --rays 1,16"));
    assert!(
        said.out.contains("In the time of peel: area_samples ") && said.out.contains("RMSE 0.005: peel "),
        "{}",
        said.out
    );
    let bad = [
        ("--techniques peel,rsmss", "needs a technique with form factors of lights"),
        ("--techniques area_exact", "no true picture is known"),
        ("--techniques peel --plot times.txt", "no kind of plot"),
        ("--techniques area_samples --rays 0", "0 is not in 1..=65536"),
    ];
    for (arguments, expected) in bad {
        let said = place.run(&format!("{command} {arguments}"));
        assert!(said.code == Some(2) && said.out.is_empty() && said.err.contains(expected), "{}", said.err);
    }
}

#[test]
fn the_cost_of_vertices_is_measured_and_fitted() {
    let place = Place::new();
    let said = place
        .run("vertices --size 16x12 --rounds 1 --warm-up 0 --backend cpu --json cost.json --plot cost.svg -o grid.png");
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("per vertex of a light: ") && said.out.contains("R² "), "{}", said.out);
    let found: Value = serde_json::from_slice(&std::fs::read(place.path("cost.json")).unwrap()).unwrap();
    assert_eq!((found["scenes"].as_array().unwrap().len(), found["fits"].as_array().unwrap().len()), (12 + 5 + 12, 3));
    assert!(found["fits"].as_array().unwrap().iter().all(|fit| number(fit, "r_squared") <= 1.0 + 1e-9));
    assert!(std::fs::read_to_string(place.path("cost.svg")).unwrap().contains("vertices of the light"));
    assert!(image::open(place.path("grid.png")).unwrap().width() > 4 * 16);
    let said = place.run("vertices --plot cost.txt");
    assert!(said.code == Some(2) && said.err.contains("no kind of plot"), "{}", said.err);
}
