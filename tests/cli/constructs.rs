//! Fetches with arguments, claims and indexed data: what the commands make of them.

use std::path::Path;

use crate::support::Place;

fn place(names: &[&str]) -> Place {
    let place = Place::new();
    for name in names {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tables/pass").join(name);
        place.file(name, std::fs::read(from).unwrap());
    }
    place
}

#[test]
fn calls_of_a_fetch_are_columns() {
    let place = place(&["fetches.ron"]);
    let csv = "wide,\"kind(0)\",\"kind( 1 )\",\"light(0,0)\",\"light(-1, 0)\",\"light(1.0,0)\"\n\
               true,air,1,0.25,1,1\n\
               false,rock,air,0.5,,\n";
    assert_eq!(place.run_with("eval fetches.ron", csv).out, "case,value\n1,0.75\n3,0.5\n");
    let json =
        r#"[{"wide": true, "kind(0)": "air", "kind(1)": 1, "light(0,0)": 0.25, "light(-1,0)": 1, "light(1,0)": 1}]"#;
    assert_eq!(place.run_with("eval fetches.ron", json).out, "case,value\n1,0.75\n");
    let said = place.run_with("eval fetches.ron", "wide,\"light(0,7)\"\ntrue,1\n");
    assert!(said.err.contains("`light(0,7)` is not an input of `fetches`"), "{}", said.all());
    let said = place
        .run("explain fetches.ron --at wide=true,kind(0)=air,kind(1)=air,light(-1,0)=1,light(0,0)=0,light(1,0)=0.5");
    assert!(said.out.contains("result:  0.5 (case 1, f32)"), "{}", said.all());
    assert!(
        said.out.contains("light(1,0), light(-1,0), light(0,0), kind(0), kind(1) (7 texture reads)"),
        "{}",
        said.all()
    );
    let said = place.run("explain fetches.ron --at wide=true,kind(0)=air,kind(1)=air");
    assert!(said.err.contains("case 1") && said.err.contains("needs `light(-1,0)` at this point"), "{}", said.all());
}

#[test]
fn calls_of_a_fetch_are_built() {
    let place = place(&["fetches.ron"]);
    let said = place.run("build fetches.ron --plan switch --target wgsl,glsl450,rust --output out");
    assert_eq!(said.code, Some(0), "{}", said.all());
}

#[test]
fn claims_are_explained() {
    let place = place(&["claims.ron"]);
    let said = place.run("explain claims.ron --at s=left,phase=0,x=0,y=0");
    let claims = said.out.split("\nclaims\n").nth(1).unwrap_or_default();
    assert_eq!(
        claims,
        "    weights: computed\n    mean   : computed; it does not shift\n    turned : proved for all values\n    \
         levels : computed for all 2 combinations of levels\n    fast   : tried at 515 points, not proved\n    \
         square : proved for all values\n"
    );
    let said = place.run("report claims.ron --output report.html");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert!(place.read("report.html").contains("tried at 515 points, not proved"));
}

/// What is built from data in a file is out of date when the file changes.
#[test]
fn data_files_belong_to_the_table() {
    let place = place(&["indexed.ron", "indexed.csv"]);
    let first = place.run("build indexed.ron --plan ladder --target wgsl --output out");
    assert_eq!(first.code, Some(0), "{}", first.all());
    let all = place.read("indexed.csv");
    place.file("indexed.csv", all.replace("8;16", "8;15"));
    let said = place.run("check indexed.ron");
    assert!(said.err.contains("the claim `all` does not hold"), "{}", said.all());
    place.file("indexed.csv", "1 2\n3\n");
    let said = place.run("check indexed.ron");
    assert!(said.err.contains("error[U0222]") && said.err.contains("indexed.csv:2:1"), "{}", said.all());
}
