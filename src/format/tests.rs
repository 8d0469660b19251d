use std::path::{Path, PathBuf};

use super::*;
use crate::build::find_tables;
use crate::points::random::Random;

fn formatted(text: &str) -> String {
    format(&Source::new("t.ron", text)).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The tables of this project, with their text.
fn tables() -> Vec<(PathBuf, String)> {
    let mut all = find_tables("tables".as_ref()).unwrap_or_else(|e| panic!("{e}"));
    all.extend(find_tables("docs/examples".as_ref()).unwrap_or_else(|e| panic!("{e}")));
    read(all)
}

/// The same, and those of the tests that are well-formed.
fn all_tables() -> Vec<(PathBuf, String)> {
    let tests = find_tables("tests/tables".as_ref()).unwrap_or_else(|e| panic!("{e}"));
    let tests = read(tests).into_iter().filter(|(path, text)| {
        Table::parse(Source::new(path.to_string_lossy(), text.as_str())).is_ok() && text.len() < 40_000
    });
    tables().into_iter().chain(tests).collect()
}

fn read(all: Vec<PathBuf>) -> Vec<(PathBuf, String)> {
    let text = |path: &PathBuf| std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{e}"));
    all.into_iter().map(|path| (path.clone(), text(&path))).collect()
}

/// A table as read, without its places.
fn meaning(path: &Path, text: &str) -> String {
    let table = Table::parse(Source::new(path.to_string_lossy(), text)).unwrap_or_else(|e| panic!("{e}"));
    let table = Table { source: Source::new("", ""), imports: Vec::new(), ..table };
    let shown = format!("{table:?}");
    let mut parts = shown.split("Span { start: ");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| all + part.split_once('}').map_or("", |(_, rest)| rest))
}

/// Rows whose columns are a blank off. They stay until something else changes that table: profiles, tuned choices and
/// generated files know it by its text.
const A_BLANK_OFF: [&str; 2] = ["tables/rsmss.ron:257", "tables/rsmss.ron:286"];

#[test]
fn our_tables_are_formatted() {
    for (path, text) in tables() {
        let formatted = formatted(&text);
        assert_eq!(text.lines().count(), formatted.lines().count(), "{}", path.display());
        let lines = text.lines().zip(formatted.lines()).enumerate();
        for (index, (old, new)) in lines.filter(|(_, (old, new))| old != new) {
            let place = format!("{}:{}", path.display(), index + 1);
            assert!(A_BLANK_OFF.contains(&place.as_str()), "{place}\n{old}\n{new}");
        }
    }
}

#[test]
fn a_table_in_disorder_is_put_in_order() {
    let disorder = "// a comment\n\n\n(language:1,name:\"t\",hit_policy:First , // behind
inputs:{\"a\":Bool(),
 \"long\" : Range(from:0,to:1 , doc:\"a,b\"),\n\n\n\"x\":Range(from:0,to:1)},
names : {\"f\": \"if a{x}else{1-x}\",   // f\n\"second\":\"x*x\",   // second\n},
output:Number(),cases:[Case(id:1,when:\"a&&x<0.5\",value:\"f\"),Case(id:10,when:\"a\",value:1)
// odd
, Case(id:2,doc:\"long\",
  when:true,
  lines:[(\"x\",\"a\"),
     (\"1-x\",\"x<0.25\"),
    \"0\"
  ],
examples:[({\"x\":1},0),
({\"x\":0.5,},0)])] , default:0)";
    let expected = r#"// a comment

(
    language: 1,
    name: "t",
    hit_policy: First, // behind
    inputs: {
        "a":    Bool(),
        "long": Range(from: 0, to: 1, doc: "a,b"),

        "x": Range(from: 0, to: 1),
    },
    names: {
        "f":      "if a { x } else { 1 - x }",   // f
        "second": "x * x",   // second
    },
    output: Number(),
    cases: [
        Case(id: 1,  when: "a && x < 0.5", value: "f"),
        Case(id: 10, when: "a",            value: 1),
        // odd
        Case(id: 2, doc: "long",
             when: true,
             lines: [
                 ("x",     "a"),
                 ("1 - x", "x < 0.25"),
                 "0",
             ],
             examples: [({"x": 1}, 0),
                        ({"x": 0.5}, 0)]),
    ],
    default: 0,
)
"#;
    let found = formatted(disorder);
    assert_eq!(found, expected, "\n{found}");
    assert_eq!(formatted(&found), found);
}

/// Comments stand behind what has a column: keys, fields, cells of rows that are broken.
#[test]
fn comments_do_not_wander() {
    let wandering =
        "Table(  language: 1,\n name: \"t\", hit_policy: First, inputs:\n{\n \"d1q\":\nInt(from: 2,\nto: 4),
        \"g.x0q\": Range(from: -10,\n to: 10,),\n        \"d0q\": //\n Bool(),\n    },\n    output: Number(),
    cases: [ /* a\n b */\tCase(id: //\n 23, when:\n {\"d1q\": []},\nvalue: // é\n 0), ], default: 0)";
    let once = formatted(wandering);
    assert_eq!(formatted(&once), once);
    assert!(once.contains("\"d0q\": //\n"), "{once}");
}

#[test]
fn what_is_no_table_is_refused() {
    let failure = format(&Source::new("t.ron", "Table(language: 1")).expect_err("unfinished");
    assert_eq!(failure.diagnostics[0].code, codes::RON);
}

/// The number of times that each table is put in disorder.
const ROUNDS: usize = 3;

/// White space and comments are scattered over tables; formatted, they are what they were, and stay so.
#[test]
fn formatting_is_a_projection() {
    let mut random = Random::new(7);
    for (path, text) in all_tables() {
        if text.len() > 40_000 {
            continue;
        }
        let before = meaning(&path, &text);
        for _ in 0..ROUNDS {
            let scattered = scatter(&text, &mut random);
            let once = formatted(&scattered);
            let comments = |text: &str| {
                let tokens = tokens::tokens(text);
                tokens.iter().filter(|t| t.is_comment()).map(|t| t.text.to_owned()).collect::<Vec<_>>()
            };
            assert_eq!(comments(&once), comments(&scattered), "{}", path.display());
            assert_eq!(meaning(&path, &once), before, "{}", path.display());
            let twice = formatted(&once);
            let other = once.lines().zip(twice.lines()).enumerate().find(|(_, (old, new))| old != new);
            assert!(twice == once, "{} is not stable: {other:?}", path.display());
        }
    }
}

/// A text with blanks, line breaks and comments between some of its tokens, and without some that were there.
fn scatter(text: &str, random: &mut Random) -> String {
    let mut out = String::new();
    let mut after_line_comment = false;
    for token in tokens::tokens(text) {
        let was = if token.breaks > 0 { "\n".repeat(token.breaks) } else { " ".repeat(token.gap) };
        let space = match random.below(12) {
            0 => "\n  ".to_owned(),
            1 => "   ".to_owned(),
            2 => [" /* here */ ", "/**/", "\t/* on\n two lines */"][random.below(3)].to_owned(),
            3 => [" // there\n", " //\n", "//\n\t", "    // é ünï 𝕏\n"][random.below(4)].to_owned(),
            4 => "\n\n\n\n".to_owned(),
            5 | 6 => String::new(),
            _ => was,
        };
        if after_line_comment && !space.trim_start_matches([' ', '\t']).starts_with('\n') {
            out.push('\n');
        }
        out.push_str(&space);
        // An operator of an expression may lose its spaces.
        out.push_str(token.text);
        after_line_comment = token.kind == Kind::LineComment;
    }
    out
}
