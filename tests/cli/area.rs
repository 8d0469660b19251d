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
