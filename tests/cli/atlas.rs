//! What `umbrage atlas` draws, and that the checked-in drawings are what it draws now.

use std::path::Path;

use crate::support::{Place, published};
use umbrage::atlas::{self, Atlas};

#[test]
fn checked_in_drawings_are_current() {
    for name in ["rsmss", "smsr"] {
        let program = published(name);
        let drawn = atlas::svg(&program, &Atlas::new(&program, None).unwrap());
        let path = Path::new("docs/images").join(name).with_extension("svg");
        let kept = std::fs::read_to_string(&path).unwrap();
        assert!(kept == drawn, "{} is out of date: run `cargo xtask bless`", path.display());
    }
}

/// Every case has a panel with its number, its words and its section; with shares, also how often it is taken.
#[test]
fn panels_say_what_the_table_says() {
    let program = published("smsr");
    let shares: Vec<f64> = (0..12).map(|case| f64::from(case) / 66.0).collect();
    let atlas = Atlas::new(&program, Some(&shares)).unwrap();
    assert_eq!(atlas.panels.len(), program.rows.len());
    for (panel, row) in atlas.panels.iter().zip(&program.rows) {
        let svg = panel.svg();
        assert!(svg.contains(&format!(">{}</text>", row.id)) && svg.contains("data:image/png"), "case {}", row.id);
        assert!(svg.contains(&format!(">section {}</text>", row.section)), "case {}", row.id);
        assert!(svg.contains(" %</text>"), "case {}", row.id);
    }
    assert!(atlas.panels[11].svg().contains(">16.67 %</text>"));
}

#[test]
fn forms() {
    let place = Place::new();
    place.table("smsr.ron");
    for name in ["a.svg", "a.html", "a.png"] {
        let said = place.run(&format!("atlas smsr.ron -o {name} --scale 0.25"));
        assert_eq!(said.all(), "exit code: 0\n");
    }
    let svg = place.read("a.svg");
    place.run("atlas smsr.ron -o b.svg");
    assert_eq!(svg, place.read("b.svg"), "the same bytes each time");
    // The raster is the drawing at a quarter of its size: light paper with something on all parts of it.
    let side = |name: &str| {
        svg.split_once(&format!("{name}=\"")).unwrap().1.split('"').next().unwrap().parse::<f64>().unwrap()
    };
    let picture = image::open(place.path("a.png")).unwrap().into_rgb8();
    let (width, height) = picture.dimensions();
    assert_eq!((width, height), ((side("width") / 4.0).ceil() as u32, (side("height") / 4.0).ceil() as u32));
    let paper = *picture.get_pixel(0, 0);
    for part in 0..12 {
        let (left, top) = (part % 4 * width / 4, part / 4 * height / 3);
        let drawn = (left..left + width / 4).flat_map(|x| (top..top + height / 3).map(move |y| (x, y)));
        assert!(drawn.filter(|(x, y)| *picture.get_pixel(*x, *y) != paper).count() > 100, "part {part}");
    }
    let page = place.read("a.html");
    for case in 1..=12 {
        assert_eq!(page.matches(&format!("id=\"case-{case}\"")).count(), 1, "case {case}");
    }
    assert!(!page.contains("<script"));
}

/// A table without hints, with conditions, data, vectors and levels, still has panels.
#[test]
fn tables_without_hints() {
    let place = Place::new();
    place.file("first.ron", std::fs::read("docs/examples/first.ron").unwrap());
    place.file(
        "vector.ron",
        r#"Table(language: 1, name: "v", hit_policy: First, inputs: {"s": Bool(), "x": Range(from: -1, to: 3)},
            output: Vector(size: 3), cases: [Case(id: 7, when: {"s": true}, value: "vec3(x, 1 - x, 0.5)")], default: "vec3(0)")"#,
    );
    place.file(
        "levels.ron",
        r#"Table(language: 1, name: "l", hit_policy: First, inputs: {"s": Levels(values: {"a": 0, "b": 1})},
            output: Enumeration(of: "s"), cases: [Case(id: 1, when: "s == a", value: "b")], default: "s")"#,
    );
    for name in ["first", "vector", "levels"] {
        let said = place.run(&format!("atlas {name}.ron -o {name}.svg"));
        assert_eq!(said.all(), "exit code: 0\n");
    }
    for (name, panel) in [("first", ">5</text>"), ("vector", ">7</text>"), ("levels", ">1</text>")] {
        assert_eq!(place.read(&format!("{name}.svg")).matches(panel).count(), 1, "{name}");
    }
    assert!(place.read("vector.svg").contains(">s</text>"), "the guard as an expression");
}

#[test]
fn bad_input() {
    let place = Place::new();
    place.table("smsr.ron");
    let mut all = String::new();
    for arguments in [
        "smsr.ron -o atlas.pdf",
        "smsr.ron -o atlas",
        "none.ron -o a.svg",
        "smsr.ron -o no/a.svg",
        "smsr.ron -o a.png --scale 1000",
    ] {
        all.push_str(&format!("$ umbrage atlas {arguments}\n{}\n", place.run(&format!("atlas {arguments}")).all()));
    }
    insta::assert_snapshot!(all);
    assert_eq!(place.files(), ["smsr.ron"], "nothing is left behind");
}

/// Hints that do not suit the table are refused where they stand.
#[test]
fn bad_hints() {
    let place = Place::new();
    let mut all = String::new();
    for hint in [
        r#""none": Across"#,
        r#""s": Down"#,
        r#""x": Sides(levels: {})"#,
        r#""s": Sides(levels: {"c": [left]})"#,
        r#""s": Sides(levels: {"a": [above]})"#,
        r#""s": Run(along: "s", ends: {"a": 1})"#,
        r#""s": Sides(levels: {}), "t": Run(along: "s", ends: {"false": 3})"#,
        r#""x": Position("s")"#,
        r#""s": Strong("s")"#,
        r#""x": Across, "x": Down"#,
    ] {
        let table = format!(
            "Table(language: 1, name: \"hints\", hit_policy: First, output: Number(), default: 0,\n\
             inputs: {{\"s\": Levels(values: {{\"a\": 0, \"b\": 1}}), \"t\": Bool(), \"x\": Range(from: 0, to: 1)}},\n\
             draw: {{{hint}}},\ncases: [Case(id: 1, when: \"s == a && t\", value: \"x\")])"
        );
        place.file("t.ron", table);
        let said = place.run("check t.ron");
        assert_eq!(said.code, Some(2), "{hint}");
        all.push_str(&said.err);
    }
    insta::assert_snapshot!(all);
}
