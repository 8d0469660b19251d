//! Files: what may stand around a table, and with which permissions results are written.

use crate::support::Place;

const TABLE: &str = "Table(language: 1, name: \"halved\", hit_policy: First,
    inputs: {\"x\": Range(from: 0, to: 1)}, output: Number(),
    cases: [Case(id: 1, when: true, value: \"x / 2\")], default: 0)
";

/// Block comments nest, wherever they stand.
#[test]
fn comments_nest_before_and_behind_the_table() {
    let place = Place::new();
    for (before, behind) in
        [("/* a /* nested */ b */\n", ""), ("/* a */ // b\n/* /**/ */", " /* /* c */ */ // d"), ("", "/* /* e */ */")]
    {
        place.file("halved.ron", format!("{before}{TABLE}{behind}"));
        let said = place.run("check halved.ron");
        assert_eq!(said.code, Some(0), "{before}…{behind}: {}", said.all());
    }
}

/// Commands that write files, and what they write.
#[cfg(unix)]
const WRITING: [(&str, &str); 5] = [
    ("build halved.ron -o out", "out/halved/ladder.wgsl"),
    ("atlas halved.ron -o halved.svg", "halved.svg"),
    ("report halved.ron -o page.html", "page.html"),
    ("fmt halved.ron", "halved.ron"),
    ("new other --table-only", "tables/other.ron"),
];

/// Every command leaves files as the user's umask wants new ones, and an existing file as it was.
#[cfg(unix)]
#[test]
fn all_commands_write_with_the_same_permissions() {
    use std::os::unix::fs::PermissionsExt;
    for (umask, expected) in [("022", 0o644), ("077", 0o600), ("027", 0o640)] {
        for (command, file) in WRITING {
            let place = Place::new();
            place.file("halved.ron", TABLE);
            if file == "halved.ron" {
                let private = std::fs::Permissions::from_mode(expected);
                std::fs::set_permissions(place.path(file), private).unwrap();
            }
            let mode = |place: &Place| std::fs::metadata(place.path(file)).unwrap().permissions().mode() & 0o777;
            let said = place.run_under(umask, command);
            assert_eq!(said.code, Some(0), "{command}: {}", said.all());
            assert_eq!(mode(&place), expected, "{command} under {umask}: {:o}", mode(&place));
            if command.starts_with("new") {
                continue;
            }
            std::fs::set_permissions(place.path(file), std::fs::Permissions::from_mode(0o664)).unwrap();
            place.file(file, "other");
            place.file("halved.ron", TABLE);
            let said = place.run_under(umask, command);
            assert_eq!(said.code, Some(0), "{command}, again: {}", said.all());
            assert_eq!(mode(&place), 0o664, "{command}, again: {:o}", mode(&place));
        }
    }
}
