//! Everything that can be wrong with rows, points, files and arguments, and with tables that are no text or too deep
//! to be written down. Other tables that are refused stand in `tests/tables/refused`.
//!
//! Each message is a snapshot. Besides, every failure exits with 2 and leaves
//! files as they were.

use crate::support::Place;

const TABLE: &str = r#"Table(
    language: 1,
    name: "demo",
    hit_policy: First,
    inputs: {
        "side": Levels(values: {"none": 0, "left": 0.25, "right": 0.5}),
        "far":  Bool(),
        "x":    Range(from: 0, to: 1),
        "seen": Bool(fetched: (cost: 1), doc: "whether it is seen"),
    },
    names: {
        "near": "x < 0.5",
    },
    symmetries: {
        "turn": Symmetry(map: {"side": {"left": "right", "right": "left"}}),
    },
    output: Number(),
    cases: [
        Case(id: 1, when: "side == left && near", value: "x * 2"),
        Case(id: 3, is: Image(case: 1, under: "turn")),
        Case(id: 2, when: "far && seen", value: "1 - x"),
    ],
    default: 0,
)
"#;

/// The facts worth knowing about it.
const NOTES: &str = "\
demo.ron:19:28: note[U0509]: case 1 must come before case 2: they hold together and differ
 = cases 1 and 2 hold at side=left,far=true,x=0.4052734375,seen=true
 = if it is understood and stays: allow: [(code: \"U0509\", with: [\"case 2\"], reason: \"...\")]
demo.ron:20:47: note[U0509]: case 3 must come before case 2: they hold together and differ
 = cases 3 and 2 hold at side=right,far=true,x=0.4052734375,seen=true
 = if it is understood and stays: allow: [(code: \"U0509\", with: [\"case 2\"], reason: \"...\")]
demo.ron:4:17: note[U0503]: no case claims 1 of the 6 states; they get the default
 = these are the states with side == none && !far
 = to claim them: Case(id: 4, when: \"side == none && !far\", value: ...)
 = if it is understood and stays: allow: [(code: \"U0503\", with: [\"1 state\"], reason: \"...\")]
demo.ron:4:17: note[U0503]: no case claims `side != none && !far && x >= 0.5`, or `side != none && !seen && x >= 0.5`; the default decides there
 = for instance side=left,far=false,x=0.71484375,seen=false
 = to claim them: Case(id: 4, when: Any([\"side != none && !far && x >= 0.5\", \"side != none && !seen && x >= 0.5\"]), value: ...)
 = if it is understood and stays: allow: [(code: \"U0503\", with: [\"side != none && !far && x >= 0.5\", \"side != none && !seen && x >= 0.5\"], reason: \"...\")]
demo.ron:20:47: note[U0521]: cases 1 and 3 could be one
 = they give the same, and together their guards say `side != none && x < 0.5`
";

const ROWS: &str = "side,far,x,seen\nleft,false,0.25,\n";

/// What `check` says of the table after replacing a part of it. `eval` refuses
/// it as well, and touches nothing.
fn refused(old: &str, new: &str) -> String {
    assert!(TABLE.contains(old), "{old} is not in the table");
    refused_text(TABLE.replacen(old, new, 1))
}

fn refused_text(text: impl AsRef<[u8]>) -> String {
    let place = Place::new();
    place.file("demo.ron", text).file("rows.csv", ROWS).file("out.csv", "as before");
    let checked = place.run("check demo.ron");
    assert_eq!(checked.code, Some(2), "{}", checked.all());
    for command in [
        "eval demo.ron --input rows.csv --output out.csv",
        "eval demo.ron --input rows.csv --output new.csv",
        "explain demo.ron --at side=left,far=false,x=0.25",
    ] {
        let said = place.run(command);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{}", said.all());
        assert_eq!(said.err, checked.err);
    }
    assert_eq!(place.read("out.csv"), "as before");
    assert_eq!(place.files(), ["demo.ron", "out.csv", "rows.csv"]);
    checked.all()
}

/// What `eval` says of rows. No file is made or changed.
fn rejected(name: &str, rows: impl AsRef<[u8]>) -> String {
    let place = Place::new();
    place.file("demo.ron", TABLE).file(name, rows).file("out.csv", "as before");
    let said = place.run(&format!("eval demo.ron --input {name} --output out.csv"));
    assert_eq!(said.code, Some(2), "{}", said.all());
    assert_eq!(place.read("out.csv"), "as before");
    let piped = place.run(&format!("eval demo.ron --input {name} --output -"));
    assert_eq!((piped.code, piped.out.as_str()), (Some(2), ""));
    assert_eq!(place.files().len(), 3, "{:?}", place.files());
    said.all()
}

/// Names the snapshot after its first argument.
macro_rules! says {
    ($name:literal, $said:expr) => {
        insta::assert_snapshot!($name, $said)
    };
}

#[test]
fn the_table_itself_is_fine() {
    let place = Place::new();
    place.file("demo.ron", TABLE).file("rows.csv", ROWS);
    let said = place.run("check demo.ron");
    assert_eq!(
        said.all(),
        format!(
            "exit code: 0\nstdout:\nok    demo.ron: 3 cases, 4 inputs (1 fetched), 6 states, 0 examples run\nstderr:\n{NOTES}"
        )
    );
    let said = place.run("eval demo.ron --input rows.csv");
    assert_eq!(said.all(), "exit code: 0\nstdout:\ncase,value\n1,0.5\n");
}

#[test]
fn deep_nesting() {
    let deep = 10_000;
    let wrap = |open: &str, close: &str| format!("{}x{}", open.repeat(deep), close.repeat(deep));
    let cut = |said: String| {
        // The offending line is 10,000 characters long and more.
        said.lines()
            .map(|l| if l.chars().count() > 120 { "  | (a long line)" } else { l })
            .collect::<Vec<_>>()
            .join("\n")
    };
    says!("deep_parentheses", cut(refused("1 - x", &wrap("(", ")"))));
    says!("deep_minus", cut(refused("1 - x", &wrap("-", ""))));
    says!("deep_not", cut(refused("far && seen", &format!("{}far", "!".repeat(deep)))));
    says!("deep_sum", cut(refused("1 - x", &format!("{}1", "1+".repeat(deep)))));
    says!("deep_if", cut(refused("1 - x", &wrap("if far { ", " } else { 0 }"))));
    says!("deep_calls", cut(refused("1 - x", &wrap("abs(", ")"))));
    says!("deep_lists", cut(refused("1 - x", &wrap("[", "]"))));
    says!("deep_let", cut(refused("1 - x", &format!("{}x", "let q = x; ".repeat(deep)))));
    says!("deep_ron", cut(refused("\"1 - x\"", &wrap("[", "]"))));
    says!("deep_ron_unclosed", cut(refused("\"1 - x\"", &"(".repeat(deep))));
    let guard = |open: &str, close: &str| {
        cut(refused("\"far && seen\"", &format!("{}\"far\"{}", open.repeat(deep), close.repeat(deep))))
    };
    says!("deep_all", guard("All([", "])"));
    says!("deep_any", guard("Any([", "])"));
    says!("deep_ron_not", guard("Not(", ")"));
    // Each name uses the next one, so the first to be looked at needs all of them.
    let chain: String = (0..deep).map(|i| format!("\"n{i}\": \"n{} + x\",\n", i + 1)).collect();
    let said = refused("\"near\":", &format!("{chain}\"n{deep}\": \"x\",\n\"near\":"));
    says!("deep_names", said);
}

#[test]
fn files() {
    says!("not_utf8", refused_text(b"Table(\n    name: \"\xff\xfe\",\n)"));
    let place = Place::new();
    std::fs::create_dir(place.path("empty")).unwrap();
    place.file("demo.ron", TABLE).file("rows.csv", ROWS);
    let said = |command: &str| {
        let said = place.run(command);
        assert_eq!(said.code, Some(2), "{}", said.all());
        assert_eq!(place.files(), ["demo.ron", "empty", "rows.csv"]);
        said.all()
    };
    says!("missing_table", said("check other.ron"));
    says!("missing_table_eval", said("eval other.ron --input rows.csv --output out.csv"));
    says!("directory_without_tables", said("check empty"));
    says!("directory_as_table", said("eval empty --input rows.csv --output out.csv"));
    says!("directory_as_input", said("eval demo.ron --input empty --output out.csv"));
    says!("missing_input", said("eval demo.ron --input none.csv --output out.csv"));
    says!("output_in_missing_directory", said("eval demo.ron --input rows.csv --output nowhere/out.csv"));
    says!("output_is_directory", said("eval demo.ron --input rows.csv --output empty"));
    says!("output_below_file", said("eval demo.ron --input rows.csv --output demo.ron/out.csv"));
    says!("usage_no_command", said("frobnicate"));
    says!("usage_bad_option", said("eval demo.ron --precision f16"));
}

#[test]
fn csv() {
    says!("csv_missing_columns", rejected("rows.csv", "side,seen\nleft,\n"));
    says!("csv_extra_column", rejected("rows.csv", "side,far,x,color\nleft,false,0.25,red\n"));
    says!("csv_misspelt_column", rejected("rows.csv", "sid,far,x\nleft,false,0.25\n"));
    says!("csv_column_twice", rejected("rows.csv", "side,far,x,side\nleft,false,0.25,left\n"));
    says!("csv_ragged_short", rejected("rows.csv", "side,far,x\nleft,false,0.25\nleft,false\n"));
    says!("csv_ragged_long", rejected("rows.csv", "side,far,x\nleft,false,0.25,1\n\nleft,false,0.25\n"));
    says!("csv_empty", rejected("rows.csv", ""));
    says!("csv_nan", rejected("rows.csv", "side,far,x\nleft,false,0.25\nleft,false,NaN\n"));
    says!("csv_infinite", rejected("rows.csv", "side,far,x\nleft,false,inf\nleft,false,-inf\nleft,false,1e999\n"));
    says!("csv_out_of_range", rejected("rows.csv", "side,far,x\nleft,false,1.5\n"));
    says!("csv_unknown_level", rejected("rows.csv", "x,side,far\n0.5,\"lft\",false\n0.5,0.3,yes\n"));
    says!("csv_no_number", rejected("rows.csv", "side,far,x\nleft,false,half\n"));
    says!("csv_empty_cell", rejected("rows.csv", "side,far,x\nleft,,0.25\n"));
    says!("csv_needs_fetched", rejected("rows.csv", "side,far,x,seen\nnone,true,0.25,true\nnone,true,0.25,\n"));
    says!("csv_not_utf8", rejected("rows.csv", b"side,far,x\nl\xffft,false,0.25\n"));
    says!("csv_unclosed_quote", rejected("rows.csv", "side,far,x\n\"left,false,0.25\nleft,false,0.25\n"));
    let many = format!("side,far,x\n{}", "left,false,2\n".repeat(50));
    let said = rejected("rows.csv", many);
    assert_eq!(said.matches("is not in the range").count(), 20);
    assert!(said.contains("and 30 more like these"), "{said}");
}

#[test]
fn json() {
    says!("json_malformed", rejected("rows.json", "[{\"side\": \"left\", \"far\": false, \"x\": 0.25}\n {}]"));
    says!("json_no_array", rejected("rows.json", "{\"side\": \"left\", \"far\": false, \"x\": 0.25}"));
    says!("json_no_object", rejected("rows.json", "[[\"left\", false, 0.25]]"));
    says!("json_missing", rejected("rows.json", "[\n  {\n    \"side\": \"left\",\n    \"far\": false\n  }\n]"));
    says!("json_unknown", rejected("rows.json", "[{\"side\": \"left\", \"far\": false, \"x\": 0.25, \"y\": 1}]"));
    says!("json_twice", rejected("rows.json", "[{\"side\": \"left\", \"far\": false, \"x\": 0.25, \"x\": 1}]"));
    says!("json_nan", rejected("rows.json", "[{\"side\": \"left\", \"far\": false, \"x\": NaN}]"));
    says!("json_range", rejected("rows.json", "[\n{\"side\": \"left\", \"far\": false, \"x\": 1e400}]"));
    says!("json_null", rejected("rows.json", "[{\"side\": \"left\", \"far\": null, \"x\": 0}]"));
    says!("json_nested", rejected("rows.json", "[{\"side\": [\"left\"], \"far\": true, \"x\": 0}]"));
    says!("json_needs_fetched", rejected("rows.json", "[{\"side\": \"none\", \"far\": true, \"x\": 0}]"));
    says!("json_deep", rejected("rows.json", "[".repeat(10_000)).lines().take(3).collect::<Vec<_>>().join("\n"));
}

#[test]
fn points() {
    let place = Place::new();
    place.file("demo.ron", TABLE);
    let said = |at: &str| {
        let said = place.run(&format!("explain demo.ron --at {at}"));
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
        said.all()
    };
    says!("point_incomplete", said("side=left"));
    says!("point_unknown", said("side=left,fr=true,x=0"));
    says!("point_no_value", said("side=left,far,x=0"));
    says!("point_level", said("side=up,far=true,x=0"));
    says!("point_twice", said("side=left,far=true,x=0,far=false"));
    says!("point_needs_fetched", said("side=none,far=true,x=0"));
}

#[cfg(not(feature = "gpu"))]
#[test]
fn no_gpu() {
    let place = Place::new();
    place.file("demo.ron", TABLE).file("rows.csv", ROWS);
    let said = place.run("eval demo.ron --input rows.csv --output out.csv --executor gpu");
    says!("no_gpu", said.all());
    assert_eq!(place.files(), ["demo.ron", "rows.csv"]);
}

#[test]
fn a_refused_table_is_refused_by_every_command() {
    refused("1 - x", "mx(x, 1)");
}

#[test]
fn findings_as_json() {
    let place = Place::new();
    place.file("demo.ron", TABLE.replace("\"near\":", "\"lost\": \"x * 2\",\n        \"near\":"));
    says!("finding_unused_json", place.run("check demo.ron --message-format json").all());
}
