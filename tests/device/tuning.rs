//! Captures, profiles and the tuner, as a user meets them.

use crate::synthetic;

use std::path::Path;
use std::process::{Command, Stdio};

use crate::support::Place;
use serde_json::Value as Json;
use umbrage::capture;
use umbrage::eval::Columns;
use umbrage::program::{InputId, Program};

const HEADER: &str = "H,V,tH,tV,dH,dV,px,py,domH,domV";

/// A place with the table `smsr`, rows of it, and a profile of them.
fn place() -> Place {
    let place = Place::new();
    place.table("smsr.ron");
    let rows = "none,bottom,0,0,0.75,0,0.5,0.75,false,false\nleft,none,0,0,0,0.5,0.25,0.5,false,false\n";
    place.file("fence.csv", format!("{HEADER}\n{rows}{rows}left,top,0,0,0.5,0.5,0.25,0.5,true,true\n"));
    let said = place.run("profile --table smsr.ron --frames fence.csv -o fence.ron");
    assert_eq!((said.code, said.all().as_str()), (Some(0), "exit code: 0\n"));
    place
}

fn smsr() -> Program {
    Program::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("tables/smsr.ron")).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_capture_is_evaluated_and_compared_like_csv() {
    let place = place();
    let program = smsr();
    let words = std::fs::read_to_string(place.path("fence.csv")).unwrap();
    let mut columns = Columns::<f32>::new(&program);
    for line in words.lines().skip(1) {
        let cells = line.split(',').enumerate();
        let point: Vec<_> = cells.map(|(i, word)| program.inputs[InputId::new(i).index()].parse(word).ok()).collect();
        columns.push(&point).unwrap();
    }
    let mut bytes = Vec::new();
    capture::write(&program, &columns, &mut bytes).unwrap();
    place.file("fence.bin", &bytes);
    let (csv, bin) = (place.run("eval smsr.ron --input fence.csv"), place.run("eval smsr.ron --input fence.bin"));
    assert_eq!((bin.code, bin.out, bin.err.as_str()), (Some(0), csv.out, ""));
    let said = place.run("diff smsr.ron --frames fence.bin --plan ladder --message-format json");
    let report: Json = serde_json::from_str(&said.out).unwrap();
    assert_eq!((&report["points"], &report["states"]), (&Json::from(5), &Json::Null));
    assert_eq!(report["runs"][0]["offending"], 0);

    place.file("fence.bin", &bytes[..bytes.len() - 3]);
    let said = place.run("eval smsr.ron --input fence.bin --output out.csv");
    assert_eq!(said.code, Some(2));
    assert_eq!(
        said.err,
        "error[U0704]: fence.bin: is cut off or damaged: 5 rows of 10 columns need 110 bytes, and 107 follow the \
         header\n = make it again\n\n"
    );
    assert!(!place.path("out.csv").exists());
}

#[test]
fn profiles_are_merged_shown_and_compared() {
    let place = place();
    let said = place.run("profile merge fence.ron fence.ron --weight 1,3 -o both.ron");
    assert_eq!(said.all(), "exit code: 0\n");
    let shown: Json = serde_json::from_str(&place.run("profile show both.ron --message-format json").out).unwrap();
    assert_eq!((&shown["evaluations"], &shown["scenes"][1]["weight"]), (&Json::from(10), &Json::from(3.0)));
    assert_eq!((&shown["cases"][0]["case"], &shown["cases"][0]["share"]), (&Json::from(8), &Json::from(0.2)));
    let text = place.run("profile show fence.ron --table smsr.ron");
    assert!(text.out.contains("        9   40.00%   40.00%  0.00  ####"), "{}", text.out);
    let said = place.run("profile diff fence.ron both.ron");
    assert!(said.out.ends_with("0.00 % of the evaluations would have to be in other states to make them equal\n"));
    assert_eq!(place.run("profile show fence.ron -o fence.svg").code, Some(0));
    let picture = place.read("fence.svg");
    let bars = ["9", "8"].map(|case| picture.contains(&format!("\n{case}\n")));
    assert_eq!(bars, [true; 2], "{picture}");
}

#[test]
fn what_is_wrong_with_a_profile_is_said() {
    let place = place();
    place.table("rsmss.ron");
    let refused = |place: &Place, arguments: &str, message: &str| {
        let said = place.run(arguments);
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{arguments}: {}", said.err);
        assert!(said.err.contains(message), "{arguments}: {}", said.err);
    };
    let other = "error[U0612]: fence.ron: is a profile of the table `smsr`, not of `rsmss`";
    refused(&place, "tune rsmss.ron --profile fence.ron", other);
    refused(&place, "profile show fence.ron --table rsmss.ron", other);
    refused(&place, "profile show missing.ron", "error[U0001]: missing.ron: cannot be read: no such file");
    refused(&place, "profile show smsr.ron", "error[U0611]: this is not a profile: ");
    refused(&place, "profile", "error[U0602]: there is nothing to count");
    refused(&place, "profile merge fence.ron --weight 1,2", "error[U0602]: 2 weights for 1 profiles");
    refused(&place, "profile show fence.ron -o fence.gif", "error[U0002]: fence.gif: is no kind of picture");

    let zero = place.read("fence.ron").replace("(8, 1), (9, 2), (11, 2)", "");
    place.file("zero.ron", zero.replace(", 2),", ", 0),").replace(", 1),", ", 0),"));
    refused(&place, "tune smsr.ron --profile zero.ron", "error[U0613]: zero.ron: counts nothing");
    refused(&place, "profile show zero.ron", "error[U0613]: zero.ron: counts nothing");

    let text = place.read("fence.ron");
    place.file("cut.ron", &text[..text.len() / 2]);
    refused(&place, "tune smsr.ron --profile cut.ron", "error[U0611]: this is not a profile: ");
    refused(&place, "diff smsr.ron --profile cut.ron", "error[U0611]: this is not a profile: ");
    place.file("huge.ron", text.replace(", 2),", ", 99999999999999999999999),"));
    refused(&place, "tune smsr.ron --profile huge.ron", "error[U0611]: ");
    place.file("wild.ron", text.replace("weight: 1", "weight: 1e400"));
    refused(&place, "profile merge wild.ron", "error[U0611]: ");
    let other = "error[U0612]: fence.ron: is a profile of the table `smsr`, which is not among those compared";
    refused(&place, "diff rsmss.ron --profile fence.ron", other);
    place.file("odd.csv", format!("{HEADER}\nnone,none,-1,0,0,0,0.5,0.5,false,false\n"));
    let excluded = "error[U0615]: the assumption `I1_h` excludes a state that occurs 1 times in the scene `odd`";
    refused(&place, "profile --table smsr.ron --frames odd.csv -o odd.ron", excluded);
    assert!(!place.path("odd.ron").exists());
    assert!(!place.path("tuned").exists());
}

/// A table that says something else since: the same inputs keep every count, others lose what is said.
#[test]
fn a_profile_of_a_changed_table_is_mapped_with_a_warning() {
    let place = place();
    let text = place.read("smsr.ron");
    place.file("smsr.ron", format!("{text}\n// changed\n"));
    let said = place.run("profile show fence.ron --table smsr.ron");
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "a comment means nothing");
    let changed = text.replace("\n    default: 1,", "\n    default: 0.5,");
    assert_ne!(changed, text);
    place.file("smsr.ron", changed);
    let said = place.run("profile show fence.ron --table smsr.ron");
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(said.err.contains("the counts of states stand, those of cases are of that time"), "{}", said.err);
    let text = text.replace("\"both\": 0.75}", "\"both\": 0.75, \"odd\": 1}").replace("id: 8,", "id: 108,");
    place.file("smsr.ron", text);
    let said = place.run("profile show fence.ron --table smsr.ron");
    assert_eq!(said.code, Some(1), "{}", said.err);
    assert!(said.err.contains("4 of 5 counts were mapped by the number of their case, 1 (20.0 %) were lost"));
}

/// A plan that does not suit the table is left out with the reason; asked for alone, by `diff`, it is refused.
#[test]
fn plans_that_do_not_suit_a_table_are_left_out() {
    let place = Place::new();
    let table = r#"Table(language: 1, name: "t", hit_policy: First,
        inputs: {"s": Bool(), "x": Range(from: 0, to: 1)}, output: Number(),
        cases: [Case(id: 1, when: "s", value: "x")], default: 0)"#;
    place.file("t.ron", table).file("t.csv", "s,x\ntrue,0.5\nfalse,0.25\n");
    assert_eq!(place.run("profile --table t.ron --frames t.csv -o p.ron").code, Some(0));
    let said = place.run("tune t.ron --profile p.ron --rows 256 --rounds 2 --plan orbit");
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("left out: orbit: it declares no symmetries"), "{}", said.out);
    assert!(said.out.contains("chosen: ladder"), "{}", said.out);
    let said = place.run("diff t.ron --plan orbit");
    assert_eq!((said.code, said.err.contains("error[U0602]: ")), (Some(2), true), "{}", said.err);
    // Nothing renders this table.
    let said = place.run("tune t.ron --profile p.ron --whole");
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
    assert!(said.err.contains("no technique has a pass that evaluates the table `t`"), "{}", said.err);
}

/// What is too large for a plan is said; the others are made.
#[test]
fn plans_that_a_table_is_too_large_for_are_named() {
    let place = Place::new();
    place.file("large.ron", synthetic::table(1400));
    // Some of its broad cases are never taken, which is a warning.
    let said = place.run("check large.ron");
    assert_eq!(said.code, Some(1), "{}", said.out);
    let said = place.run("build large.ron --plan ladder,switch,orbit,tree --target wgsl");
    assert_eq!(said.code, Some(1), "{}", said.err);
    let line = |name: &str| said.out.lines().find(|line| line.trim_start().starts_with(name)).unwrap_or_default();
    assert!(line("ladder").contains("proved equal to the table on 32768 states"), "{}", said.out);
    let reason = "left out: its key has 15 bits, and the lookup of this plan has room for 12; use `switch_buffer`";
    assert!(line("switch").contains(reason), "{}", said.out);
    assert!(line("tree").contains("32768 are more than 16384; use `ladder`"), "{}", said.out);
    assert!(line("orbit").contains("left out: it declares no symmetries"), "{}", said.out);
    assert!(place.path("generated/synthetic_1400/ladder.wgsl").exists());
    assert!(!place.path("generated/synthetic_1400/switch.wgsl").exists());
}

/// Plans that need weights are compared with the profile beside the tables, or the one that is given.
#[test]
fn plans_are_compared_as_they_are_made_for_a_profile() {
    let place = place();
    let rows = "--frames fence.csv --plan ordered --message-format json";
    let origin = |said: &str| serde_json::from_str::<Json>(said).unwrap()["profile"].clone();
    let said = place.run(&format!("diff smsr.ron {rows}"));
    assert_eq!((said.code, origin(&said.out)), (Some(0), Json::Null), "{}", said.err);
    let said = place.run(&format!("diff smsr.ron --profile fence.ron {rows}"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(origin(&said.out), "profile fence.ron, 5 evaluations of fence");
    for directory in ["tables", "profiles"] {
        std::fs::create_dir(place.path(directory)).unwrap();
    }
    std::fs::copy(place.path("smsr.ron"), place.path("tables/smsr.ron")).unwrap();
    std::fs::copy(place.path("fence.ron"), place.path("profiles/smsr.ron")).unwrap();
    let said = place.run(&format!("diff tables/smsr.ron {rows}"));
    assert_eq!(origin(&said.out), "profile smsr.ron, 5 evaluations of fence", "{}", said.err);
}

/// What a GPU counts is what the CPU counts, in every state, case and tile.
#[test]
fn a_gpu_counts_what_the_cpu_counts() {
    let place = Place::new();
    for technique in ["smsr", "rsmss"] {
        let count = |backend: &str| {
            let file = format!("{technique}_{backend}.ron");
            let said = place.run(&format!(
                "profile --scene fence,text --technique {technique} --size 96x54 --shadow-map 128 --backend {backend} \
                 -o {file}"
            ));
            assert_eq!(said.all(), "exit code: 0\n");
            place.read(&file)
        };
        let cpu = count("cpu");
        assert_eq!(cpu.matches("tiles: Tiles(width: 8, height: 4").count(), 2, "one for each scene: {cpu}");
        assert_eq!(count("gpu"), cpu);
    }
}

const TUNE: &str = "tune smsr.ron --profile fence.ron --frames fence.csv --rows 1024 --rounds 3 --plan ladder,switch";

#[test]
fn tuning_ranks_plans_and_keeps_the_choice() {
    let place = place();
    let said = place.run(&format!("{TUNE} --report tuning.html --message-format json"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: Json = serde_json::from_str(&said.out).unwrap();
    for input in ["captured", "random", "coherent"] {
        let of_input: Vec<_> =
            object["plans"].as_array().unwrap().iter().filter(|plan| plan["input"] == input).collect();
        let us = |plan: &Json| plan["us"].as_f64().unwrap();
        let ladder = of_input.iter().find(|plan| plan["name"] == "ladder").unwrap();
        assert!(ladder["vs_ladder"] == 1.0 && ladder["differs"] == false, "{ladder}");
        assert!(of_input.is_sorted_by_key(|plan| us(plan)), "the fastest first");
        for plan in &of_input {
            let floor = object["floor"][input].as_f64().unwrap();
            for (field, of) in [("vs_ladder", us(ladder)), ("vs_floor", floor)] {
                assert!((plan[field].as_f64().unwrap() * of / us(plan) - 1.0).abs() < 1e-9, "{field} of {plan}");
            }
        }
        let mut names: Vec<_> = of_input.iter().map(|plan| plan["name"].as_str().unwrap()).collect();
        names.sort_unstable();
        assert_eq!(names, ["ladder", "switch"], "{input}");
    }
    assert_eq!(object["whole"], Json::from(Vec::<Json>::new()));
    let files: Vec<_> = std::fs::read_dir(place.path("tuned")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 1);
    let kept = std::fs::read_to_string(&files[0]).unwrap();
    let chosen = object["chosen"].as_str().unwrap();
    assert!(kept.contains(&format!("plan: \"{chosen}\"")) && kept.contains("table: \"smsr\""), "{kept}");
    // What is measured is on the page as it is in the object, and the choice is marked once for each kind of input.
    let page = place.read("tuning.html");
    assert!(page.contains("<title>Tuning of smsr</title>") && page.contains(object["device"].as_str().unwrap()));
    for plan in object["plans"].as_array().unwrap() {
        assert!(page.contains(&format!(">{:.1}</td>", plan["us"].as_f64().unwrap())), "{plan}");
    }
    assert_eq!(page.matches(&format!("<code>{chosen}</code> (chosen)")).count(), 3);

    let said = place.run(&format!("{TUNE} --wall-clock"));
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("measured with wall clock") && said.out.contains("chosen: "), "{}", said.out);

    // Damaged choices are not silently replaced.
    std::fs::write(&files[0], "Tuned(").unwrap();
    let said = place.run(TUNE);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("error[U0616]: this is no tuned choice"), "{}", said.err);
    assert_eq!(std::fs::read_to_string(&files[0]).unwrap(), "Tuned(");
}

/// What a device takes too long for is left out or done less often, and said; the command ends in any case.
#[test]
fn tuning_ends_in_time() {
    let place = place();
    let said = place.run(&format!("{TUNE} --compile-limit 0.01"));
    assert_eq!(said.code, Some(2), "{}", said.out);
    let expected = "the ladder itself cannot be measured: compiling takes longer than 0.01 s";
    assert!(said.err.contains(expected) && said.err.contains("--compile-limit"), "{}", said.err);
    assert!(!place.path("tuned").exists());
    let said = place.run("tune smsr.ron --profile fence.ron --rows 1024 --rounds 10000 --plan ladder --time-limit 0.2");
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("shortened: ") && said.out.contains(" rounds instead of 10000, "), "{}", said.out);
    let said = place.run("tune smsr.ron --profile fence.ron --time-limit 0");
    assert!(said.code == Some(2) && said.err.contains("not between 0.01 and 1000000 seconds"), "{}", said.err);
}

#[test]
fn plans_are_measured_in_whole_shaders() {
    let place = place();
    let said = place.run(&format!(
        "{TUNE} --whole --scene text,slope --size 64x36 --shadow-map 64 --report tuning.html --message-format json"
    ));
    assert_eq!(said.code, Some(0), "{}", said.err);
    let object: Json = serde_json::from_str(&said.out).unwrap();
    let whole = object["whole"].as_array().unwrap();
    let passes: Vec<_> =
        whole.iter().map(|line| (line["pass"].as_str().unwrap(), line["name"].as_str().unwrap())).collect();
    let expected = [("compute", "ladder"), ("compute", "switch"), ("fragment", "ladder"), ("fragment", "switch")];
    assert_eq!(passes, [expected, expected].concat());
    for (index, lines) in whole.chunks(2).enumerate() {
        for line in lines {
            let scene = ["text", "slope"][index / 2];
            assert_eq!(line["frame"], format!("{scene}, 64x36, map 64, search limit 128"));
            let ratio = line["ms"].as_f64().unwrap() / lines[0]["ms"].as_f64().unwrap();
            assert!((line["vs_ladder"].as_f64().unwrap() / ratio - 1.0).abs() < 1e-9, "{line}");
        }
    }
    // Said before anything is measured.
    let said = place.run(&format!("{TUNE} --whole --scene text,studio"));
    assert_eq!((said.code, said.out.as_str()), (Some(2), ""));
    assert!(said.err.contains("and the scene `studio` has none"), "{}", said.err);
    let page = place.read("tuning.html");
    for line in whole {
        assert!(page.contains(&format!(">{:.3}</td>", line["vs_ladder"].as_f64().unwrap())), "{line}");
    }
}

#[test]
fn an_interrupted_tuning_leaves_the_old_choice() {
    let place = place();
    assert_eq!(place.run(TUNE).code, Some(0));
    let file = std::fs::read_dir(place.path("tuned")).unwrap().next().unwrap().unwrap().path();
    let old = std::fs::read_to_string(&file).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_umbrage"))
        .args(TUNE.replace("--rounds 3", "--rounds 10000").split(' '))
        .current_dir(place.path("."))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(700));
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(std::fs::read_to_string(&file).unwrap(), old);
    assert_eq!(std::fs::read_dir(place.path("tuned")).unwrap().count(), 1);
}

#[test]
fn tunings_at_once_keep_all_choices() {
    let place = place();
    let quick = "--rows 256 --rounds 2 --plan ladder";
    let names = ["one", "two", "three", "four"];
    let children: Vec<_> = names
        .iter()
        .map(|name| {
            let renamed = place.read("smsr.ron").replace("name: \"smsr\"", &format!("name: \"{name}\""));
            place.file(&format!("{name}.ron"), renamed);
            let said = place.run(&format!("profile --table {name}.ron --frames fence.csv -o {name}.profile"));
            assert_eq!(said.code, Some(0), "{}", said.all());
            let tune = format!("tune {name}.ron --profile {name}.profile {quick}");
            let mut command = Command::new(env!("CARGO_BIN_EXE_umbrage"));
            command.args(tune.split(' ')).current_dir(place.path(".")).stdout(Stdio::null()).spawn().unwrap()
        })
        .collect();
    for mut child in children {
        assert!(child.wait().unwrap().success());
    }
    let files: Vec<_> = std::fs::read_dir(place.path("tuned")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    let kept = std::fs::read_to_string(&files[0]).unwrap();
    assert!(names.iter().all(|name| kept.contains(&format!("table: \"{name}\""))), "{kept}");
}
