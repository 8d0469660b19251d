//! Messages about wrong scenes, in full, and what right ones mean.

use std::path::Path;

use glam::DVec3;

use crate::diag::Source;
use crate::scene::Scene;
use crate::scene::light::{Light, LightKind, Lights};

fn parse(lights: &str, shape: &str) -> Result<Scene, String> {
    let text = format!(
        "Scene(\n    camera: (eye: (0, 3, 6), target: (0, 0.5, 0)),\n    {lights}\n    objects: [(shape: {shape})],\n)\n"
    );
    let source = Source::new("scene.ron", text);
    Scene::parse("test", &source, Path::new("")).map_err(|failure| failure.to_string())
}

fn lights(lights: &str) -> Result<Vec<Light>, String> {
    parse(lights, "Ground(size: (4, 4))").map(|scene| scene.lights)
}

const SQUARE: &str = "(0, 2, 0), (1, 2, 0), (1, 2, 1), (0, 2, 1)";

#[test]
fn wrong_lights_are_refused_at_their_places() {
    let polygon = |corners: &str| format!("light: Polygon(corners: [{corners}]),");
    let gaussian = |fields: &str| format!("light: Gaussian({fields}),");
    let nine: Vec<String> = (0..9).map(|i| format!("({i}, 2, {})", i * i)).collect();
    let cases = [
        ("two corners", polygon("(0, 2, 0), (1, 2, 0)")),
        ("nine corners", polygon(&nine.join(", "))),
        ("repeated corner", polygon(&format!("{SQUARE}, (0, 2, 0)"))),
        ("on a line", polygon("(0, 2, 0), (1, 2, 0), (3, 2, 0)")),
        ("not planar", polygon("(0, 2, 0), (1, 2, 0), (1, 2.5, 1), (0, 2, 1)")),
        ("a dent", polygon("(0, 2, 0), (2, 2, 0), (0.5, 2, 0.5), (0, 2, 2)")),
        ("a star", polygon("(0, 2, -1), (0.6, 2, 0.8), (-1, 2, -0.3), (1, 2, -0.3), (-0.6, 2, 0.8)")),
        ("a bow", polygon("(0, 2, 0), (1, 2, 1), (1, 2, 0), (0, 2, 1)")),
        ("no number", polygon("(0, 2, 0), (1, NaN, 0), (1, 2, 1)")),
        ("far away", polygon("(0, 2, 0), (1, inf, 0), (1, 2, 1)")),
        ("negative deviation", gaussian("deviations: (0.1, -0.2)")),
        ("no deviation", gaussian("deviations: (0.1, inf)")),
        ("NaN deviation", gaussian("deviations: (NaN, 0.1)")),
        ("tilted beyond the horizon", gaussian("tilts: (10, 80.5), deviations: (0.1, 0.1)")),
        ("NaN tilt", gaussian("tilts: (NaN, 0), deviations: (0.1, 0.1)")),
        ("infinite turn", gaussian("rotation: -inf, deviations: (0.1, 0.1)")),
        ("negative colour", gaussian("colour: (1, -1, 1), deviations: (0.1, 0.1)")),
        ("without deviations", gaussian("tilts: (0, 0)")),
        ("another kind", "light: Point(position: (0, 1, 0)),".to_owned()),
        ("an empty list", "lights: [],".to_owned()),
        ("none", String::new()),
        (
            "both",
            "light: Directional(direction: (0, -1, 0)),\n    lights: [Directional(direction: (0, -1, 0))],".to_owned(),
        ),
        ("two mistakes", "lights: [Directional(direction: (0, 0, 0)), Gaussian(deviations: (-1, 0))],".to_owned()),
    ];
    let said: String =
        cases.iter().map(|(what, text)| format!("== {what}\n{}\n", lights(text).expect_err(what))).collect();
    insta::assert_snapshot!(said);
}

#[test]
fn lights_are_read_as_written() {
    let text = format!(
        "lights: [
            Directional(direction: (0, -2, 0), colour: (3, 2, 1)),
            Spot(position: (0, 5, 0), target: (0, 0, 0), angle: 30),
            Polygon(corners: [{SQUARE}], two_sided: true),
            Gaussian(tilts: (45, 0), deviations: (0.1, 0.2), rotation: 30),
        ],"
    );
    let lights = lights(&text).expect("right");
    let kinds: Vec<LightKind> = lights.iter().map(Light::kind).collect();
    assert_eq!(kinds, [LightKind::Directional, LightKind::Spot, LightKind::Polygon, LightKind::Gaussian]);
    assert_eq!(lights[0].colour(), [3.0, 2.0, 1.0]);
    assert_eq!(lights[1].colour(), [1.0; 3]);
    let [_, _, Light::Polygon(polygon), Light::Gaussian(gaussian)] = lights.as_slice() else { panic!("{lights:?}") };
    assert!(polygon.two_sided);
    assert_eq!((polygon.area(), polygon.normal()), (1.0, DVec3::NEG_Y));
    assert_eq!(polygon.middle(), DVec3::new(0.5, 2.0, 0.5));
    assert_eq!(polygon.distance(DVec3::ZERO), 2.0);
    assert!((gaussian.axis() - DVec3::new(1.0, 1.0, 0.0).normalize()).length() < 1e-15);
}

#[test]
fn a_technique_takes_the_kinds_it_knows_and_names_the_others() {
    let gaussian = "Gaussian(deviations: (0.1, 0.1))";
    let sun = "Directional(direction: (0, -1, 0))";
    let scene = parse(&format!("lights: [{gaussian}, {sun}],"), "Ground(size: (4, 4))").expect("right");
    let taken = Lights::PUNCTUAL.of_scene(&scene, "rsmss").expect("the second");
    assert_eq!(taken, [&scene.lights[1]]);
    let error = Lights::POLYGON.of_scene(&scene, "area_samples").expect_err("none").to_string();
    insta::assert_snapshot!(error);
    assert_eq!(Lights::ANY.to_string(), "directional, spot, polygon and Gaussian lights");
}

#[test]
fn wrong_patterns_are_refused_at_their_places() {
    let light = "light: Directional(direction: (0, -1, 0)),";
    let said = |fields: &str| parse(light, &format!("Ball(radius: 1), {fields}")).expect_err(fields);
    let fbm = "detail: Fbm(size: 1)";
    for (fields, expected) in [
        ("detail: Fbm(size: 0)", "0 is out of range"),
        ("detail: Fbm(size: 1, octaves: 13)", "13 is out of range"),
        ("detail: Ridged(size: 1, lacunarity: 4.5)", "4.5 is out of range"),
        ("detail: Brick(size: (1, 1, NaN), mortar: 0.1)", "NaN is out of range"),
        ("transfer: [(value: 0, opacity: 0)]", "the object has no pattern whose values this could be for"),
        (&format!("{fbm}, transfer: [(value: 0, opacity: 0)]"), "1 knots are no transfer function"),
        (
            &format!("{fbm}, transfer: [(value: 1, opacity: 0), (value: 0, opacity: 1)]"),
            "a knot has a smaller value than the one before",
        ),
        (&format!("{fbm}, transfer: [(value: 1, opacity: 2), (value: 2, opacity: 1)]"), "2 is out of range"),
        ("shine: (exponent: 0)", "0 is out of range"),
    ] {
        let said = said(fields);
        assert!(said.contains(expected) && said.contains("scene.ron:"), "{fields}: {said}");
    }
    let scene = parse(light, "Ball(radius: 1), detail: Brick(size: (1, 2, 3), mortar: 0.1), shine: (exponent: 20)");
    let object = &scene.expect("right").objects[0];
    assert_eq!(object.detail.as_ref().map(|detail| detail.knots.len()), Some(2));
    assert_eq!(object.shine.map(|shine| shine.reflectance), Some(0.04));
}

#[test]
fn gloss_is_read_and_out_of_its_range_refused() {
    let with = |gloss: &str| {
        parse("light: Directional(direction: (0, -1, 0)),", &format!("Ground(size: (4, 4)), gloss: {gloss}"))
    };
    let glossy = with("(roughness: 0.25)").expect("is right").objects[0].gloss.expect("is said");
    assert_eq!((glossy.roughness, glossy.reflectance), (0.25, 0.04));
    for (gloss, said) in [
        ("(roughness: 1.5)", "1.5 is out of range"),
        ("(roughness: NaN)", "NaN is out of range"),
        ("(roughness: 0.5, reflectance: -1)", "-1 is out of range"),
        ("(reflectance: 0.5)", "roughness"),
        ("(roughness: 0.5, colour: 1)", "colour"),
    ] {
        let error = with(gloss).expect_err(gloss);
        assert!(error.contains(said), "{gloss}: {error}");
    }
    assert!(
        parse("light: Directional(direction: (0, -1, 0)),", "Ground(size: (4, 4))").expect("is right").objects[0]
            .gloss
            .is_none()
    );
}
