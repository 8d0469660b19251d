//! Profiles and tuned choices that are out of date, in the wrong place, or of no table: what is said, and that the
//! commands in it work.

use crate::support::Place;

/// A place with a table of two levels, and a profile of it beside its directory.
fn place() -> Place {
    let place = Place::new();
    for directory in ["tables", "profiles"] {
        std::fs::create_dir(place.path(directory)).unwrap();
    }
    place.file("tables/roof.ron", ROOF);
    place.file("rows.csv", "warm,x\nfalse,0.25\ntrue,0.5\ntrue,0.75\n");
    let said = place.run("profile --table tables/roof.ron --frames rows.csv -o profiles/roof.ron");
    assert_eq!(said.all(), "exit code: 0\n");
    place
}

const ROOF: &str = r#"Table(
    language: 1, name: "roof", title: "Snow on a roof", hit_policy: First,
    inputs: {"warm": Bool(default: false), "x": Range(from: 0, to: 1)},
    output: Number(),
    cases: [
        Case(id: 1, when: "warm", value: "0.5 * x"),
        Case(id: 2, when: "x < 0.5", value: 0.5),
    ],
    default: 1,
)
"#;

const BUILD: &str = "build tables --target wgsl --plan ordered,auto";

/// The choice of a plan, as `tune` writes it; `was` is a fingerprint.
fn tuned(place: &Place, was: &str) {
    let _ = std::fs::create_dir(place.path("tuned"));
    place.file(
        "tuned/toy.ron",
        format!(
            "Tuned(version: 1, device: \"Toy (of wood)\", tables: [Choice(table: \"roof\", fingerprint: \"{was}\", \
             plan: \"tree\", assume: false, profile: \"\", umbrage: \"0\", method: \"\", evidence: [])])"
        ),
    );
}

/// The fingerprint of the table, as generated files have it.
fn fingerprint(place: &Place) -> String {
    let text = place.read("generated/roof/ordered.wgsl");
    text.split("// Table:  ").nth(1).unwrap().split(',').next().unwrap().to_owned()
}

#[test]
fn what_changes_no_result_changes_nothing_else() {
    let place = place();
    let said = place.run(BUILD);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.out);
    assert!(said.out.contains("; `auto`: nothing was tuned for it\n"), "{}", said.out);
    tuned(&place, &fingerprint(&place));
    for text in [
        ROOF.to_owned(),
        ROOF.replace('\n', "\r\n"),
        format!("// A roof.\n{ROOF}"),
        ROOF.replace("Snow on a roof", "A roof in winter").replace("warm", "warm  "),
    ] {
        place.file("tables/roof.ron", text.replace("\"warm  \": Bool", "\"warm\": Bool"));
        let said = place.run(BUILD);
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{text}: {}", said.out);
        assert!(
            said.out.contains("tree           proved") && said.out.contains("; chosen on Toy (of wood)\n"),
            "{text}: {}",
            said.out
        );
    }
}

#[test]
fn line_ends_make_no_other_code() {
    let place = place();
    place.run(BUILD);
    let before = place.read("generated/roof/ordered.wgsl");
    place.file("tables/roof.ron", ROOF.replace('\n', "\r\n"));
    assert!(place.run(BUILD).out.contains(", 0 written, "));
    assert_eq!(place.read("generated/roof/ordered.wgsl"), before);
}

#[test]
fn a_choice_that_is_not_used_is_said_once() {
    let place = place();
    place.run(BUILD);
    let meant = fingerprint(&place);
    tuned(&place, &meant);
    place.file("tables/roof.ron", ROOF.replace("0.5 * x", "0.25 * x"));
    let said = place.run(BUILD);
    assert_eq!(said.code, Some(1), "{}", said.err);
    let expected = "warning[U0617]: what was tuned for `roof` is not used: it has changed since it was tuned on Toy (of wood); \
                    `auto` is `switch` there\n = to tune it: `umbrage tune tables/roof.ron --profile profiles/roof.ron \
                    --adapter Toy --output tuned`\n\n";
    assert_eq!(said.err, expected, "the profile is as good as it was");
    assert!(said.out.contains("; `auto`: it has changed since it was tuned on Toy (of wood)\n"), "{}", said.out);

    // A fingerprint of before, and a plan of another version.
    place.file("tables/roof.ron", ROOF);
    tuned(&place, "fnv1a 0123456789abcdef");
    let said = place.run(BUILD);
    assert!(
        said.err.contains("not used: it was tuned on Toy (of wood) by another version of umbrage; "),
        "{}",
        said.err
    );
    tuned(&place, &meant);
    let odd = place.read("tuned/toy.ron").replace("\"tree\"", "\"spiral\"");
    place.file("tuned/toy.ron", odd);
    let said = place.run(BUILD);
    assert!(
        said.err.contains("not used: `spiral`, chosen on Toy (of wood), is no plan of this umbrage; "),
        "{}",
        said.err
    );

    // A device on which nothing was tuned.
    tuned(&place, &meant);
    let said = place.run(&format!("{BUILD} --device abacus"));
    assert_eq!(said.code, Some(1));
    for part in [
        "warning[U0617]: nothing was tuned for `roof` on `abacus`; `auto` is `switch`\n",
        " = it was tuned on: toy\n",
        "--adapter abacus ",
    ] {
        assert!(said.err.contains(part), "{part}: {}", said.err);
    }
    assert_eq!(place.run(&format!("{BUILD} --device toy")).err, "");
    assert_eq!(
        place.run("build tables --target wgsl --plan ordered --device abacus").err,
        "",
        "nobody asked for `auto`"
    );
}

#[test]
fn a_profile_that_is_not_used_is_said_once() {
    let place = place();
    // Other guards and values: every state still means the same.
    place.file("tables/roof.ron", ROOF.replace("x < 0.5", "x < 0.25"));
    assert_eq!(place.run(BUILD).err, "");
    let said = place.run("profile show profiles/roof.ron --table tables/roof.ron");
    assert_eq!(said.code, Some(1));
    assert!(
        said.err.starts_with("warning[U0614]: profiles/roof.ron: was counted when the table meant something else\n = "),
        "{}",
        said.err
    );
    place.file("tables/roof.ron", ROOF);

    // Copied to the name of another table, which has none.
    place.file("tables/wall.ron", ROOF.replace("\"roof\"", "\"wall\""));
    place.file("profiles/wall.ron", place.read("profiles/roof.ron"));
    place.file("profiles/shed.ron", place.read("profiles/roof.ron"));
    let said = place.run(BUILD);
    assert_eq!(said.code, Some(1));
    let expected = "warning[U0614]: profiles/wall.ron: is a profile of the table `roof`, not of `wall`, and is not used\n = remove it, \
                    `rm profiles/wall.ron`: `roof` has profiles/roof.ron\n\nwarning[U0614]: profiles/shed.ron: there is no table `shed`; \
                    it is not used\n = name it like the table that it counts, or remove it: `rm profiles/shed.ron`\n\n";
    assert_eq!(said.err, expected);
    for name in ["wall", "shed"] {
        std::fs::remove_file(place.path(&format!("profiles/{name}.ron"))).unwrap();
    }
    assert_eq!(place.run(BUILD).err, "");
    // Renamed: the command puts it right.
    std::fs::rename(place.path("profiles/roof.ron"), place.path("profiles/wall.ron")).unwrap();
    let said = place.run(BUILD);
    assert!(said.err.contains(" = name it like its table: `mv profiles/wall.ron profiles/roof.ron`\n"), "{}", said.err);
    std::fs::rename(place.path("profiles/wall.ron"), place.path("profiles/roof.ron")).unwrap();
    assert_eq!(place.run(BUILD).err, "");
    // Of one table only its own profile is looked for.
    place.file("profiles/shed.ron", "");
    assert_eq!(place.run("build tables/roof.ron --target wgsl").err, "");
}

/// The command that counts again does, and what it writes is not stale.
#[test]
fn the_command_that_counts_again_works() {
    let place = Place::new();
    std::fs::create_dir(place.path("tables")).unwrap();
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tables/smsr.ron")).unwrap();
    place.file("tables/smsr.ron", &text);
    let count = "profile --scene fence --technique smsr --table tables/smsr.ron --size 32x18 --shadow-map 64 -o p.ron";
    assert_eq!(place.run(count).all(), "exit code: 0\n");
    place.file("tables/smsr.ron", text.replace("\"both\": 0.75}", "\"both\": 0.75, \"odd\": 1}"));
    let said = place.run("profile show p.ron --table tables/smsr.ron");
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(
        said.err.contains("was counted with other inputs of the table `smsr`, and is used in part\n"),
        "{}",
        said.err
    );
    assert!(said.err.contains(&format!(" = to count again: `umbrage {count}`\n")), "{}", said.err);
    place.file("tables/smsr.ron", text);
    assert_eq!(place.run(count).all(), "exit code: 0\n");
    assert_eq!(place.run("profile show p.ron --table tables/smsr.ron").err, "");
}

/// The profiles and choices that come with Umbrage are of what its tables mean.
///
/// If this fails although no table has changed its meaning, tables are lowered or hashed in another way: count up the
/// version of fingerprints in `src/program/meaning.rs`, and put the new ones into these files.
#[test]
fn what_comes_with_umbrage_is_not_stale() {
    let directory = tempfile::tempdir().unwrap();
    let mut build = crate::support::umbrage();
    build.current_dir(env!("CARGO_MANIFEST_DIR")).args(["build", "--target", "wgsl", "--output"]).arg(directory.path());
    let said = build.output().unwrap();
    assert_eq!((said.status.code(), String::from_utf8_lossy(&said.stderr).as_ref()), (Some(0), ""));
    for table in ["rsmss", "smsr"] {
        let text = std::fs::read_to_string(directory.path().join(table).join("ladder.wgsl")).unwrap();
        let fingerprint = text.split("// Table:  ").nth(1).unwrap().split(',').next().unwrap();
        for file in [format!("profiles/{table}.ron"), "tuned/llvmpipe.ron".to_owned()] {
            let text = std::fs::read_to_string(format!("{}/{file}", env!("CARGO_MANIFEST_DIR"))).unwrap();
            assert!(text.contains(&format!("fingerprint: \"{fingerprint}\"")), "{file}: {fingerprint}");
        }
    }
}
