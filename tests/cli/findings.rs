//! Levels of findings, exhibits, and what the findings say of the published tables. The findings themselves, each with
//! its full message, stand in `tests/tables`.

use std::collections::BTreeSet;

use crate::support::{OrPanic as _, Place};
use umbrage::analyse::{self, LintLevels};
use umbrage::diag::Source;
use umbrage::program::Program;
use umbrage::table::Table;

/// Names the snapshot after its first argument.
macro_rules! says {
    ($name:literal, $said:expr) => {
        insta::assert_snapshot!($name, $said)
    };
}

#[test]
fn levels() {
    let place = Place::new();
    let table = |allow: &str| {
        format!(
            "Table(language: 1, name: \"demo\", hit_policy: First,\n    inputs: {{\"s\": Bool(), \"x\": Range(from: 0, to: 1)}},\n    output: Number(),\n    cases: [Case(id: 1, when: \"s\", value: 1{allow})],\n    default: 0)\n"
        )
    };
    place.file("demo.ron", table(""));
    assert_eq!(place.run("check demo.ron").code, Some(1));
    assert_eq!(place.run("check demo.ron -A U0505").code, Some(0));
    assert_eq!(place.run("check demo.ron --allow u0505 -W U0503").code, Some(1));
    let denied = place.run("check demo.ron -A U0505 -D U0503");
    assert_eq!(denied.code, Some(2));
    assert!(denied.err.contains("error[U0503]"), "{}", denied.all());
    let built = place.run("build demo.ron --target wgsl -D U0505 -o out");
    assert_eq!((built.code, place.files().len()), (Some(2), 1), "{}", built.all());
    says!("unknown_level", place.run("check demo.ron -W U0203").all());
    says!("level_of_examples", place.run("check demo.ron -A U0501").all());
}

/// An exhibit is counted in a directory, shown when named, and built only then.
#[test]
fn exhibits() {
    let place = Place::new();
    let text = "Table(language: 1, name: \"old\", hit_policy: First, exhibit: \"as printed\",\n    inputs: {\"s\": Bool(), \"x\": Range(from: 0, to: 1)},\n    output: Number(),\n    cases: [Case(id: 1, when: \"s\", value: 1)],\n    default: 0)\n";
    place.file("old.ron", text);
    says!("exhibit_walked", place.run("check .").all());
    assert_eq!(place.run("check old.ron").code, Some(1));
    let built = place.run("build . --target wgsl -o out");
    assert_eq!((built.code, place.files().len()), (Some(0), 1), "{}", built.all());
}

fn program(source: &str, text: String) -> Program {
    Table::parse(Source::new(source, text)).and_then(|t| Program::check(&t)).or_panic()
}

/// Findings of a table that another one does not have, by code, with the first case that each points at.
fn fresh(known: &Program, program: &Program) -> BTreeSet<(String, u32)> {
    let old: Vec<_> = analyse::report(known, &LintLevels::default()).open;
    let mut without = program.clone();
    without.examples.clear();
    let found = analyse::report(&without, &LintLevels::default()).open;
    let found = found.iter().filter(|f| !old.iter().any(|o| o.code == f.code && o.message == f.message));
    found
        .filter_map(|finding| {
            let place = finding.labels.first()?.span;
            let row = program.rows.iter().find(|r| r.span.start <= place.start && place.end <= r.span.end)?;
            Some((finding.code.to_string(), row.id))
        })
        .collect()
}

/// Each misprint alone, put back into the mended table: the number in the list
/// of errata, the case, and what to replace by what is printed.
const MISPRINTS: &[(u32, u32, &str, &str)] = &[
    (
        1,
        4,
        "H == both && V == none && tV == dual_positive",
        "H == both && V == none && tH == dual_positive && tV == dual_positive",
    ),
    (
        1,
        6,
        "V == both && H == none && tH == dual_positive",
        "V == both && H == none && tH == dual_positive && tV == dual_positive",
    ),
    (
        1,
        8,
        "V_one_sided && tV == positive_negative",
        "V_one_sided && tH == positive_negative && tV == positive_negative",
    ),
    (
        1,
        10,
        "H_one_sided && tH == positive_negative",
        "H_one_sided && tH == positive_negative && tV == positive_negative",
    ),
    (
        3,
        4,
        "(\"px + py - 1\", \"n_bottom == left\"),\n                 (\"py - px\",     \"n_bottom == right\"),\n                 (\"px - py\",     \"n_top == left\"),\n                 (\"1 - px - py\", \"n_top == right\")",
        "(\"px + py - 1\", \"n_top == left\"),\n                 (\"py - px\",     \"n_top == right\"),\n                 (\"px - py\",     \"n_bottom == left\"),\n                 (\"1 - px - py\", \"n_bottom == right\")",
    ),
    (4, 7, "2 - py - dH), u)", "2 - py - dH), if H != right { 1 - py } else { px })"),
    (
        5,
        8,
        "(\"min(w, 2 - px - dV)\", \"d_cb_h == right\"),\n                 (\"min(w, 1 + px - dV)\", \"d_cb_h == left\")",
        "(\"min(w, 2 - py - dV)\", \"d_cb_h == right\"),\n                 (\"min(w, 1 + py - dV)\", \"d_cb_h == left\")",
    ),
    (6, 9, "d_cb_top == left || d_cb_bottom == left", "d_cb_top == none || d_cb_bottom == none"),
    (7, 12, "max(1 - w, 1 - px)", "max(1 - w, 1 - py)"),
    (8, 14, "max(1 - u, B_v)", "max(if H != right { 1 - py } else { py }, B_v)"),
    (
        9,
        28,
        "(\"py\", \"V == bottom\"), (\"1 - py\", \"V == top\")",
        "(\"py\", \"V == top\"), (\"1 - py\", \"V == bottom\")",
    ),
    (
        10,
        16,
        "\"if tV == dual_positive { case(21, V = none) }",
        "\"if tH == dual_positive { case(20, V = none) } else if tV == dual_positive { case(21, V = none) }",
    ),
];

/// The checker finds every misprint by itself, and points at the misprinted case.
#[test]
fn every_misprint_alone_is_found() {
    let text = std::fs::read_to_string("tables/rsmss.ron").unwrap();
    let mended = program("rsmss.ron", text.clone());
    // What is acknowledged must not hide anything here.
    let bare = |text: &str| {
        let mut table = Table::parse(Source::new("rsmss.ron", text)).or_panic();
        table.cases.iter_mut().for_each(|case| case.allow.clear());
        Program::check(&table).or_panic()
    };
    let before = bare(&text);
    assert_eq!(analyse::findings(&mended), [], "the mended table is clean");
    let mut summary = String::new();
    for (number, case, meant, printed) in MISPRINTS {
        assert!(text.contains(meant), "erratum {number}: `{meant}` is not in the table");
        let found = fresh(&before, &bare(&text.replacen(meant, printed, 1)));
        let there: Vec<&str> = found.iter().filter(|(_, at)| at == case).map(|(code, _)| code.as_str()).collect();
        let elsewhere = found.iter().filter(|(_, at)| at != case).map(|(code, at)| format!("{code} at {at}"));
        summary += &format!(
            "erratum {number}, case {case}: {}; elsewhere: {}\n",
            there.join(", "),
            elsewhere.collect::<Vec<_>>().join(", ")
        );
        assert!(!found.is_empty(), "erratum {number} in case {case} is not found");
    }
    says!("misprints_alone", summary);
}

/// The ranges before the clamp are those that the specification gives.
#[test]
fn ranges_of_rsmss() {
    let program = Program::read("tables/rsmss.ron").or_panic();
    let ranges = analyse::ranges(&program);
    let all = ranges.iter().fold((0.0_f64, 1.0_f64), |all, r| (all.0.min(r.before.0), all.1.max(r.before.1)));
    assert_eq!(all, (-1.0, 2.0));
    let inside = ranges.iter().filter(|r| r.before.0 >= 0.0 && r.before.1 <= 1.0);
    let inside: Vec<u32> = inside.filter_map(|r| r.row).map(|row| program.rows[row].id).collect();
    assert_eq!(inside, [1, 2, 3, 8, 10, 12, 14, 20, 21, 28, 29]);
    assert!(ranges.iter().all(|r| r.after.0 >= 0.0 && r.after.1 <= 1.0));
}
