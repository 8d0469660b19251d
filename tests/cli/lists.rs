//! Lists that are put together, cases that all count, and tables that use tables: what commands show of them.

use std::path::Path;

use crate::support::Place;

/// A copy of a table of `tests/tables/pass`.
fn copied(place: &Place, names: &[&str]) {
    std::fs::create_dir_all(place.path("imported")).unwrap();
    for name in names {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tables/pass").join(name);
        place.file(name, std::fs::read(from).unwrap());
    }
}

#[test]
fn all_cases_that_hold_are_shown() {
    let place = Place::new();
    copied(&place, &["collect.ron"]);
    place.file(
        "points.csv",
        "night,inside,fuel,seen,x\nfalse,true,oil,false,0\ntrue,false,wood,true,0.5\ntrue,true,none,true,0.5\n",
    );
    let mut said = String::new();
    for command in [
        "eval collect.ron --input points.csv",
        "explain collect.ron --at inside=true,fuel=oil,x=0",
        "explain collect.ron --at night=true,inside=true",
        "why collect.ron --case 4",
        "expand collect.ron",
    ] {
        said += &format!("$ umbrage {command}\n{}\n", place.run(command).all());
    }
    insta::assert_snapshot!(said);
}

/// Every plan of tables with such lists is proved, and the text of each is accepted.
#[test]
fn lists_are_built() {
    let place = Place::new();
    copied(&place, &["collect.ron", "lists.ron", "tables_that_use_tables.ron", "typed_levels.ron"]);
    copied(&place, &["imported/area.ron", "imported/t2.ron", "imported/t3.ron"]);
    for table in ["collect", "lists", "tables_that_use_tables", "typed_levels", "imported"] {
        let path = if table == "imported" { table.to_owned() } else { format!("{table}.ron") };
        let plans = "ladder,ordered,nested,gathered,tree,switch";
        let said = place.run(&format!("build {path} --plan {plans} --target wgsl,glsl450,rust -o out"));
        let left_out = said.out.replace("left out: it fetches nothing", "").contains("left out");
        assert!(said.code.is_some_and(|code| code < 2) && !left_out, "{}", said.all());
    }
    let text = place.read("out/regions/switch.wgsl");
    assert!(text.lines().count() < 3000, "{} lines", text.lines().count());
}

/// Fourteen conditions that do not exclude each other are fourteen items, not 2^14 lists.
#[test]
fn many_optional_items_are_moved_one_by_one() {
    let place = Place::new();
    let inputs: Vec<String> = (0..14).map(|i| format!("\"x{i}\": Range(from: 0, to: 1)")).collect();
    let cases: Vec<String> =
        (0..14).map(|i| format!("Case(id: {i}, when: \"x{i} < 0.5\", value: \"n::{}\")", i % 8)).collect();
    let table = format!(
        "Table(language: 2, name: \"many\", hit_policy: Collect, inputs: {{\"n\": Int(from: 0, to: 7), {}}},
        output: List(of: n, max: 14), cases: [{}], default: \"[]\")",
        inputs.join(", "),
        cases.join(",\n")
    );
    place.file("many.ron", table);
    let said = place.run("build many.ron --plan ladder --target wgsl,glsl450,rust -o out");
    assert!(said.code.is_some_and(|code| code < 2), "{}", said.all());
    let text = place.read("out/many/ladder.wgsl");
    assert!(text.len() < 200_000, "{} bytes", text.len());
    let row = (0..14).map(|i| if i % 3 == 0 { "0.25" } else { "0.75" }).collect::<Vec<_>>().join(",");
    let head: Vec<String> = (0..14).map(|i| format!("x{i}")).collect();
    place.file("row.csv", format!("n,{}\n0,{row}\n", head.join(",")));
    let said = place.run("eval many.ron --input row.csv");
    assert!(said.out.contains("0 3 6 1 4"), "{}", said.all());
}
