//! Every finding of `umbrage check`, with its full message, and what the
//! findings say of the published tables.

use std::collections::BTreeSet;

use crate::support::Place;
use umbrage::analyse::{self, LintLevels};
use umbrage::diag::Source;
use umbrage::program::Program;
use umbrage::table::Table;

/// What `check` says of a table with these parts.
fn said(inputs: &str, rest: &str) -> String {
    let text = format!(
        "Table(language: 1, name: \"demo\", hit_policy: First,\n    inputs: {{{inputs}}},\n    output: Number(),\n{rest})\n"
    );
    let place = Place::new();
    place.file("demo.ron", text);
    place.run("check demo.ron").all()
}

const INPUTS: &str = "\"s\": Levels(values: {\"off\": 0, \"low\": 1, \"high\": 2}, default: off), \"f\": Bool(fetched: (cost: 1)), \"g\": Bool(fetched: (cost: 1)), \"x\": Range(from: 0, to: 1, default: 0.5), \"y\": Range(from: -1, to: 1, default: 0)";

fn cases(cases: &str) -> String {
    said(INPUTS, &format!("    cases: [\n{cases}\n    ],\n    default: \"if f && g {{ x + y }} else {{ 0 }}\",\n"))
}

/// Names the snapshot after its first argument.
macro_rules! says {
    ($name:literal, $said:expr) => {
        insta::assert_snapshot!($name, $said)
    };
}

#[test]
fn coverage() {
    says!(
        "uncovered",
        cases(
            "        Case(id: 1, when: \"s == off && x < 0.5\", value: 1),\n        Case(id: 2, when: \"s == low\", value: 2),"
        )
    );
    says!(
        "dead_guard",
        cases(
            "        Case(id: 1, when: \"s == low && s == high\", value: 1),\n        Case(id: 2, when: true, value: 2),"
        )
    );
    says!(
        "dead_case",
        cases(
            "        Case(id: 1, when: \"s == low\", value: 1),\n        Case(id: 2, when: \"s != low\", value: 2),\n        Case(id: 3, when: \"f\", value: 3),"
        )
    );
    says!(
        "not_reached",
        said(
            INPUTS,
            "    assume: {\"A\": (\"s != high || x == 0\", \"high is never reached\"), \"B\": \"f || !g\"},\n    cases: [\n        Case(id: 1, when: \"s == high && x > 0.5\", value: 1),\n        Case(id: 2, when: true, value: \"x + y\"),\n    ],\n    default: 0,\n"
        )
    );
}

#[test]
fn overlaps() {
    says!(
        "order_matters",
        cases(
            "        Case(id: 1, when: \"s == low\", value: 1),\n        Case(id: 2, when: \"s != off\", value: 2),\n        Case(id: 3, when: true, value: 3),"
        )
    );
    let text = "Table(language: 1, name: \"demo\", hit_policy: Unique,\n    inputs: {\"x\": Range(from: 0, to: 1), \"s\": Bool()},\n    output: Number(),\n    cases: [\n        Case(id: 1, when: \"s && x < 0.75\", value: \"x\"),\n        Case(id: 2, when: \"x > 0.5\", value: 1),\n    ],\n    default: 0)\n";
    let place = Place::new();
    place.file("demo.ron", text);
    says!("not_unique", place.run("check demo.ron").all());
}

#[test]
fn lines() {
    says!(
        "no_line",
        cases(
            "        Case(id: 1, when: \"s == low\", lines: [(1, \"f\"), (\"x\", \"g\")]),\n        Case(id: 2, when: \"s != low\", value: 0),"
        )
    );
    says!("lines_cross", cases("        Case(id: 1, when: true, lines: [(1, \"f\"), (\"x\", \"g\"), 0]),"));
    says!(
        "dead_line",
        cases(
            "        Case(id: 1, when: \"s == low\", lines: [(1, \"f\"), (2, \"!f\"), (\"x\", \"g\"), 0]),\n        Case(id: 2, when: \"s != low\", lines: [(1, \"s == low\"), 0]),"
        )
    );
    says!(
        "dead_choice",
        cases(
            "        Case(id: 1, when: \"s == low\", value: \"if s == high { x } else { y }\"),\n        Case(id: 2, when: \"s != low\", value: 0),"
        )
    );
}

const SIDES: &str = "\"h\": Levels(values: {\"none\": 0, \"left\": 1, \"right\": 2}, default: none), \"v\": Levels(values: {\"none\": 0, \"top\": 1, \"bottom\": 2}, default: none), \"b\": Bool(default: false), \"d\": Range(from: 0, to: 1, default: 0), \"x\": Range(from: 0, to: 1, default: 0.5), \"y\": Range(from: 0, to: 1, default: 0.5)";

const MIRRORS: &str = r#"    symmetries: {
        "mirror": Symmetry(map: {"h": {"left": "right", "right": "left"}, "x": "1 - x"}),
        "transpose": Symmetry(map: {"h": From("v", {"top": "left", "bottom": "right"}), "v": From("h", {"left": "top", "right": "bottom"}), "x": "y", "y": "x"}),
        "complement": Symmetry(map: {"b": "!b"}, result: "1 - value"),
    },
"#;

#[test]
fn symmetries() {
    let table = |fourth: &str, rest: &str| {
        said(
            SIDES,
            &format!(
                "{MIRRORS}    cases: [\n        Case(id: 1, when: \"h == left && v == none\", value: \"if b {{ 1 - x }} else {{ x }}\"),\n        Case(id: 2, when: \"h == right && v == none\", value: \"if b {{ x }} else {{ 1 - x }}\"),\n        Case(id: 3, when: \"v == top && h == none\", value: \"if b {{ 1 - y }} else {{ y }}\"),\n        Case(id: 4, when: \"v == bottom && h == none\", value: \"{fourth}\"),\n{rest}    ],\n    default: \"if b {{ 0 }} else {{ 1 }}\",\n"
            ),
        )
    };
    says!("odd_one_out", table("if b { y } else { 1 - x }", ""));
    says!(
        "undecided",
        said(
            SIDES,
            "    symmetries: {\"mirror\": Symmetry(map: {\"h\": {\"left\": \"right\", \"right\": \"left\"}, \"x\": \"1 - x\"})},\n    cases: [\n        Case(id: 1, when: \"h == left && !b\", value: \"x + d\"),\n        Case(id: 2, when: \"h == right && !b\", value: \"x - d\"),\n        Case(id: 3, when: \"v == top && b\", value: \"y\"),\n    ],\n    default: 0,\n"
        )
    );
    says!(
        "own_image",
        table(
            "if b { y } else { 1 - y }",
            "        Case(id: 5, when: \"h != none && v != none\", value: \"if b { 1 - d } else { x * d }\"),\n"
        )
    );
    says!(
        "symmetry_assumed",
        said(
            SIDES,
            &format!(
                "{MIRRORS}    assume: {{\"A\": \"h == none || v == none || x == y\"}},\n    cases: [\n        Case(id: 1, when: \"!b && h == left && v == top\", value: \"x\"),\n        Case(id: 2, when: \"!b && h == right && v == top\", value: \"1 - x\"),\n        Case(id: 3, when: \"!b && h == left && v == bottom\", value: \"x\"),\n        Case(id: 4, when: \"!b && h == right && v == bottom\", value: \"1 - x\"),\n    ],\n    default: \"if b {{ 0 }} else {{ 1 }}\",\n"
            )
        )
    );
}

#[test]
fn numbers() {
    says!(
        "not_a_number",
        cases(
            "        Case(id: 1, when: \"s == low\", value: \"1 / y\"),\n        Case(id: 2, when: \"s == off\", value: \"sqrt(y) + 1\"),\n        Case(id: 3, when: \"s == high && y > 0.25\", value: \"log(y)\"),\n        Case(id: 4, when: \"s == high\", value: 0),"
        )
    );
    says!(
        "float_equality",
        cases(
            "        Case(id: 1, when: \"x == 0.25\", value: 1),\n        Case(id: 2, when: \"x != 0.25\", value: \"if y == 0 { 2 } else { 3 }\"),"
        )
    );
    let place = Place::new();
    place.file("demo.ron", format!("Table(language: 1, name: \"demo\", hit_policy: First,\n    inputs: {{{INPUTS}}},\n    output: Number(clamp: (0, 1)),\n    cases: [\n        Case(id: 1, when: \"s == low\", value: \"1.5 + 0.25 * y\"),\n        Case(id: 2, when: \"f && g\", value: \"x\"),\n    ],\n    default: 0)\n"));
    says!("out_of_range", place.run("check demo.ron").all());
}

/// The two sines are bounded alike, so the root of a negative number is found under either.
#[test]
fn a_root_of_any_sine_can_leave_the_numbers() {
    for function in ["sin", "cos", "portableSin", "portableCos"] {
        let found = said(
            "\"x\": Range(from: -3, to: 3, default: 0)",
            &format!(
                "    cases: [Case(id: 1, when: \"x <= 3\", value: \"sqrt({function}(x) + 0.5)\")],\n    default: 0,\n"
            ),
        );
        assert!(found.contains("warning[U0514]") && found.contains("the root of a negative number"), "{found}");
    }
}

#[test]
fn continuity() {
    says!(
        "jump",
        said(
            "\"x\": Range(from: 0, to: 1, default: 0.5), \"s\": Bool(default: false)",
            "    continuity: {\n        \"cut\": Switch(of: [\"x\"]),\n        \"wrap\": Border(when: \"x == 1\", map: {\"x\": \"0\"}, free: [\"s\"], doc: \"the next one\"),\n    },\n    cases: [\n        Case(id: 1, when: \"x < 0.5\", value: \"x\"),\n        Case(id: 2, when: \"x >= 0.5\", value: \"if s { 1.25 - x } else { 1 - x }\"),\n    ],\n    default: 0,\n"
        )
    );
}

#[test]
fn style() {
    says!(
        "inexact",
        cases("        Case(id: 1, when: true, lines: [(\"0.1 * x\", \"f\"), (\"y + 0.3\", \"g\"), 0.1]),")
    );
    says!(
        "mergeable",
        cases(
            "        Case(id: 1, when: \"s == low\", value: \"x\"),\n        Case(id: 2, when: \"s == off\", value: \"y\"),\n        Case(id: 3, when: \"s == high\", value: \"x\"),"
        )
    );
    says!(
        "renamed",
        said(
            "\"a\": Levels(values: {\"On\": 0, \"on\": 1}), \"B\": Bool(), \"b\": Bool()",
            "    cases: [\n        Case(id: 1, when: \"a == On && b && B\", value: 1),\n    ],\n    default: 0,\n"
        )
    );
}

#[test]
fn acknowledged_findings() {
    let lines = "        Case(id: 1, when: true, lines: [(1, \"f\"), (\"x\", \"g\"), 0],\n             allow: [(code: \"U0508\", reason: \"f comes first\")]),";
    says!("acknowledged", cases(lines));
    says!("unused_allow", cases(&lines.replace("U0508", "U0507")));
    says!("unknown_allow", cases(&lines.replace("U0508", "U9999")));
    says!("no_reason", cases(&lines.replace("f comes first", " ")));
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
    Table::parse(Source::new(source, text)).and_then(|t| Program::check(&t)).unwrap_or_else(|e| panic!("{e}"))
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
        let mut table = Table::parse(Source::new("rsmss.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        table.cases.iter_mut().for_each(|case| case.allow.clear());
        Program::check(&table).unwrap_or_else(|e| panic!("{e}"))
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
    let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
    let ranges = analyse::ranges(&program);
    let all = ranges.iter().fold((0.0_f64, 1.0_f64), |all, r| (all.0.min(r.before.0), all.1.max(r.before.1)));
    assert_eq!(all, (-1.0, 2.0));
    let inside = ranges.iter().filter(|r| r.before.0 >= 0.0 && r.before.1 <= 1.0);
    let inside: Vec<u32> = inside.filter_map(|r| r.row).map(|row| program.rows[row].id).collect();
    assert_eq!(inside, [1, 2, 3, 8, 10, 12, 14, 20, 21, 28, 29]);
    assert!(ranges.iter().all(|r| r.after.0 >= 0.0 && r.after.1 <= 1.0));
}
