//! `umbrage profile --lcov`: which rows and lines of a table ran.

use std::collections::BTreeMap;
use std::process::Command;

use super::support::Place;

/// Hits by line of the text, and by case.
fn read(text: &str) -> (BTreeMap<usize, u64>, BTreeMap<String, u64>) {
    let pairs = |key: &str| {
        let lines = text.lines().filter_map(|line| line.strip_prefix(key)?.split_once(','));
        lines.map(|(a, b)| (a.to_owned(), b.to_owned())).collect::<Vec<_>>()
    };
    let lines = pairs("DA:").into_iter().map(|(line, count)| (line.parse().unwrap(), count.parse().unwrap()));
    let cases = pairs("FNDA:").into_iter().map(|(count, case)| (case, count.parse().unwrap()));
    (lines.collect(), cases.collect())
}

#[test]
fn captures_are_counted_by_line() {
    let place = Place::new();
    place.table("smsr.ron");
    place.file(
        "frame.csv",
        "H,V,tH,tV,dH,dV,px,py,domH,domV\n\
         none,bottom,positive_negative,positive_negative,0.75,0,0.5,0.5,false,false\n\
         none,bottom,positive_negative,positive_negative,0.25,0,0.5,0.5,false,false\n\
         none,bottom,positive_negative,positive_negative,0.25,0,0.5,0.5,false,false\n\
         both,none,positive_negative,positive_negative,0,0,0.5,0.5,false,false\n",
    );
    let said = place.run("profile --table smsr.ron --frames frame.csv --lcov out.info");
    assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (Some(0), "", ""));
    let text = place.read("out.info");
    assert!(text.starts_with("TN:frame\nSF:smsr.ron\n") && text.ends_with("\nend_of_record\n"), "{text}");
    let (lines, cases) = read(&text);
    assert_eq!((cases["case 9"], cases["case 3"], cases["case 1"], cases["default"]), (3, 1, 0, 0));
    // The lines of case 9 stand on one line of the text: the one that was hit more often counts there, and both below.
    let table = place.read("smsr.ron");
    let line_of = |what: &str| table.lines().position(|line| line.contains(what)).unwrap() + 1;
    assert_eq!(lines[&line_of("Case(id: 9,")], 3);
    assert_eq!(lines[&line_of("lines: [(0, \"1 - py < dH\"), 1]")], 2);
    assert_eq!(lines[&line_of("Case(id: 1,")], 0);
    let branches: Vec<&str> = text.lines().filter(|line| line.starts_with("BRDA:") && line.contains(",8,")).collect();
    let at = line_of("lines: [(0, \"1 - py < dH\"), 1]");
    assert_eq!(branches, [format!("BRDA:{at},8,0,1"), format!("BRDA:{at},8,1,2")]);
    // A profile is written as well where a place for it is named.
    let both = place.run("profile --table smsr.ron --frames frame.csv --lcov out.info -o profile.ron");
    assert_eq!(both.code, Some(0), "{}", both.err);
    assert!(place.read("profile.ron").contains("table: \"smsr\""));
    // What LCOV's own tools make of it, where they are installed.
    let pages = Command::new("genhtml")
        .args(["out.info", "--branch-coverage", "--output-directory", "coverage"])
        .current_dir(place.path(""))
        .output();
    match pages {
        Ok(pages) => {
            let said = String::from_utf8_lossy(&pages.stdout).into_owned() + &String::from_utf8_lossy(&pages.stderr);
            assert!(pages.status.success(), "{said}");
            let page = std::fs::read_to_string(place.path("coverage/index.html")).unwrap();
            assert!(page.contains("LCOV"), "{page}");
            assert!(said.contains("functions"), "{said}");
        }
        Err(_) => eprintln!("skipped: genhtml is not installed (on Debian the package lcov)"),
    }
}

#[test]
fn scenes_are_counted_as_their_profile_counts() {
    let place = Place::new();
    let said = place.run("profile --scene fence,lattice --size 160x90 --shadow-map 128 --lcov out.info -o profile.ron");
    assert_eq!(said.code, Some(0), "{}", said.err);
    let text = place.read("out.info");
    let records: Vec<&str> = text.split_inclusive("end_of_record\n").collect();
    assert_eq!(records.len(), 2);
    let profile = umbrage::profile::read(&place.path("profile.ron")).unwrap();
    for (record, scene) in records.iter().zip(&profile.scenes) {
        assert!(record.starts_with(&format!("TN:{}\n", scene.name)), "{record}");
        let (_, cases) = read(record);
        let counted = cases.into_iter().filter(|(_, count)| *count > 0);
        let expected = scene
            .cases
            .iter()
            .map(|(case, count)| (case.map_or("default".to_owned(), |case| format!("case {case}")), *count));
        assert_eq!(counted.collect::<BTreeMap<_, _>>(), expected.collect(), "{}", scene.name);
    }
}

#[test]
fn counts_of_a_shader_are_read() {
    let place = Place::new();
    place.table("smsr.ron");
    let outcomes = umbrage::program::Program::read(place.path("smsr.ron")).unwrap().outcomes().len();
    let counts: Vec<u32> = (0..outcomes as u32).collect();
    let text: String = counts.iter().map(|count| format!("{count},\n")).collect();
    place.file("a.txt", &text);
    place.file("b.bin", counts.iter().flat_map(|count| count.to_le_bytes()).collect::<Vec<u8>>());
    let said = place.run("profile --table smsr.ron --hits a.txt,b.bin --lcov out.info");
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    let all = place.read("out.info");
    let (a, b) = all.split_once("end_of_record\n").unwrap();
    assert_eq!(a.strip_prefix("TN:a\n"), b.strip_suffix("end_of_record\n").and_then(|b| b.strip_prefix("TN:b\n")));
    assert_eq!(read(a).1["default"], outcomes as u64 - 1);
    for (name, contents, expected) in [
        ("few.txt", "1 2 3", "has 3 counts, and `smsr` has"),
        ("words.txt", "1 two", "`two` is no count"),
        ("odd.bin", "abc", "3 bytes, which are no words of 32 bits"),
    ] {
        place.file(name, contents);
        let said = place.run(&format!("profile --table smsr.ron --hits {name} --lcov {name}.info"));
        assert_eq!(said.code, Some(2));
        assert!(said.err.contains(expected) && said.err.contains(name), "{}", said.err);
        assert!(!place.path(&format!("{name}.info")).exists());
    }
    // Counts make no profile.
    assert_eq!(place.run("profile --table smsr.ron --hits a.txt").code, Some(2));
}
