//! Worked values: for every one of the 43 cases, and every line of every
//! piecewise value, rows whose case and value were derived from the published
//! formulas, not from our tables. `tests/worked/*.csv` are the inputs,
//! `*.expected.csv` the answers; all numbers are exact in binary, so the
//! answers are compared exactly, in both precisions.

use std::collections::BTreeSet;
use std::path::Path;

use crate::support::Place;

fn worked(name: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/worked").join(name)).unwrap()
}

fn check(table: &str, cases: u32) {
    let place = Place::new();
    place.table(&format!("{table}.ron")).file("rows.csv", worked(&format!("{table}.csv")));
    let (inputs, expected) = (worked(&format!("{table}.csv")), worked(&format!("{table}.expected.csv")));
    for precision in ["f32", "f64"] {
        let said = place.run(&format!("eval {table}.ron --input rows.csv --precision {precision}"));
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.all());
        assert_eq!(said.out.lines().count(), inputs.lines().count());
        for ((got, want), row) in said.out.lines().zip(expected.lines()).zip(inputs.lines()) {
            assert_eq!(got, want, "{table} in {precision} at {row}");
        }
    }
    let covered: BTreeSet<u32> = expected.lines().filter_map(|line| line.split(',').next()?.parse().ok()).collect();
    assert_eq!(covered, (1..=cases).collect(), "every case is worked");
}

#[test]
fn smsr() {
    check("smsr", 12);
}

#[test]
fn rsmss() {
    check("rsmss", 31);
}
