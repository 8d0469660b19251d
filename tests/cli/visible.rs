//! No text of a table acts on a terminal, a picture or a page.

use crate::support::{Place, said_in, umbrage};

/// An escape, a character of the second set, a zero, marks of direction, a separator of lines.
const ACTING: [char; 8] = ['\u{1b}', '\u{9b}', '\0', '\u{7f}', '\u{202e}', '\u{2066}', '\u{2028}', '\u{b}'];

/// The same, as a text in a table has them: written out, and as they are where RON admits it.
const TEXT: &str = "a\\u{1b}]0;b\\u{9b}\\u{0}\\u{7f}\\u{202e}\\u{2066}\\u{2028}\\u{b}\u{1b}\u{9b}\u{202e}c";

fn table(value: &str) -> String {
    format!(
        "// \u{1b}[31m \u{9b} \u{202e} in a comment\n\
         Table(language: 1, name: \"texts\", title: \"{TEXT}\", hit_policy: First,
            inputs: {{\"x\": Range(from: 0, to: 1, doc: \"{TEXT}\"), \"l\": Levels(values: {{\"one\": 0, \"two\": 1}}, doc: \"{TEXT}\")}},
            output: Number(),
            cases: [Case(id: 1, doc: \"{TEXT}\", section: \"{TEXT}\", when: \"x < 0.5\", value: {value} /* \u{1b} \u{202e} */),
                Case(id: 2, doc: \"{TEXT}\", when: \"x < 0.25\", value: \"x\")],
            default: 0)\n"
    )
}

fn assert_still(what: &str, text: &str) {
    for c in ACTING {
        assert!(!text.contains(c), "{what} has {c:?}: {}", text.escape_debug());
    }
}

#[test]
fn texts_of_tables_do_not_act() {
    let place = Place::new();
    place.file("t.ron", table("\"x\"")).file("wrong.ron", table("\"y\"")).file("broken.ron", table("("));
    place.file("rows.csv", "x,l\n\u{1b}[31m\u{202e},one\n");
    for command in [
        "check t.ron",
        "check t.ron --message-format json",
        "check wrong.ron",
        "check wrong.ron --color always --message-format json",
        "check broken.ron",
        "explain t.ron --at x=0.1,l=one",
        "explain t.ron --at x=0.1,l=one --message-format json",
        "why t.ron --case 1",
        "why t.ron --case 2",
        "eval t.ron --input rows.csv",
        "build t.ron -o out",
        "fmt --check t.ron",
        "atlas t.ron -o atlas.svg",
        "atlas t.ron -o atlas.html",
        "atlas t.ron -o atlas.png",
        "report t.ron -o report.html",
    ] {
        let said = place.run(command);
        assert!(said.code.is_some_and(|code| code <= 2), "{command}: {}", said.all());
        assert_still(command, &said.all());
    }
    for file in ["atlas.svg", "atlas.html", "report.html"] {
        assert_still(file, &place.read(file));
        assert!(place.read(file).contains("\\u001b"), "{file} says what was there");
    }
    assert!(std::fs::read(place.path("atlas.png")).unwrap().starts_with(b"\x89PNG"), "the drawing is XML");
}

/// The name of a file is a text, too.
#[cfg(unix)]
#[test]
fn names_of_files_do_not_act() {
    let place = Place::new();
    place.file("\u{1b}[31m\u{202e}.ron", table("\"y\""));
    for arguments in [["check", "."], ["build", "."], ["fmt", "."]] {
        let said = said_in(&place.path(""), umbrage().args(arguments), "");
        assert_still(arguments[0], &said.all());
    }
}
