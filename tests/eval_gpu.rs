//! `umbrage eval --executor gpu`: the same answers, and the same refusals.
#![cfg(all(feature = "cli", feature = "gpu"))]
#![allow(clippy::unwrap_used)]

mod support;

use std::path::Path;

use support::{Place, Said};

fn place(table: &str) -> Place {
    let place = Place::new();
    let rows = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/worked/{table}.csv"));
    place.table(&format!("{table}.ron")).file("rows.csv", std::fs::read(rows).unwrap());
    place
}

fn clean(said: Said) -> String {
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.all());
    said.out
}

#[test]
fn the_worked_rows_come_out_the_same() {
    for table in ["smsr", "rsmss"] {
        let place = place(table);
        let expected = clean(place.run(&format!("eval {table}.ron --input rows.csv")));
        for plan in ["", " --plan ladder", " --plan switch", " --plan switch_buffer"] {
            let got = clean(place.run(&format!("eval {table}.ron --input rows.csv --executor gpu{plan}")));
            assert_eq!(got, expected, "{table}{plan}");
        }
    }
}

#[test]
fn a_needed_fetched_input_that_is_absent_is_named() {
    let place = place("rsmss");
    place.file(
        "few.csv",
        "H,V,b,tH,tV,dH,dV,px,py,domH,domV,n_top\n\
         none,top,0,0,0,0.5,0,0.5,0.5,0,0,\n\
         both,top,0,1,1,0,0.75,0.5,0.5,0,0,none\n",
    );
    let interpreter = place.run("eval rsmss.ron --input few.csv");
    let gpu = place.run("eval rsmss.ron --input few.csv --executor gpu --output out.csv");
    assert_eq!((gpu.code, &gpu.err), (Some(2), &interpreter.err), "the same message as the interpreter's");
    assert!(gpu.err.contains("line 3: case 5 needs `n_bottom`"), "{}", gpu.all());
    assert!(!place.files().contains(&"out.csv".to_owned()), "nothing is written on failure");
}

#[test]
fn double_precision_is_refused() {
    let said = place("smsr").run("eval smsr.ron --input rows.csv --executor gpu --precision f64");
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{}", said.all());
    assert!(said.err.contains("the GPU computes in f32 only"), "{}", said.all());
}

#[test]
fn an_adapter_that_is_not_there_is_named() {
    let said = place("smsr").run("eval smsr.ron --input rows.csv --executor gpu --adapter no-such-card");
    assert_eq!(said.code, Some(2), "{}", said.all());
    assert!(said.err.contains("no adapter suits `no-such-card`") && said.err.contains("there are:"), "{}", said.all());
}
