//! The commands around tables: `fmt`, `new`, `build --watch`, `completions`, `man`.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::support::{OrPanic as _, Place};

const UNTIDY: &str = "Table(language:1, name:\"dim\", hit_policy:First, // a dim
inputs:{\"x\":Range(from:0,to:1)}, output:Number(), cases:[Case(id:1,when:true,value:\"x/2\")], default:0)";

const TIDY: &str = "Table(
    language: 1,
    name: \"dim\",
    hit_policy: First, // a dim
    inputs: {\"x\": Range(from: 0, to: 1)},
    output: Number(),
    cases: [
        Case(id: 1, when: true, value: \"x / 2\"),
    ],
    default: 0,
)
";

fn write(place: &Place, name: &str, text: &str) {
    let path = place.path(name);
    std::fs::create_dir_all(path.parent().unwrap_or(&path)).or_panic();
    place.file(name, text);
}

#[test]
fn fmt_formats_files_directories_and_standard_input() {
    let place = Place::new();
    write(&place, "tables/dim.ron", UNTIDY);
    let said = place.run("fmt --check");
    let first = "tables/dim.ron:1: is laid out otherwise
  - Table(language:1, name:\"dim\", hit_policy:First, // a dim
  + Table(
";
    assert_eq!((said.code, said.out.as_str(), said.err.as_str()), (Some(1), first, ""));
    assert_eq!(place.read("tables/dim.ron"), UNTIDY);
    let said = place.run("fmt");
    assert_eq!((said.code, said.out.as_str()), (Some(0), "formatted tables/dim.ron\n"));
    assert_eq!(place.read("tables/dim.ron"), TIDY);
    let said = place.run("fmt --check tables/dim.ron");
    assert_eq!((said.code, said.out.as_str()), (Some(0), ""));
    let said = place.run_with("fmt -", UNTIDY);
    assert_eq!((said.code, said.out.as_str()), (Some(0), TIDY));
}

#[test]
fn fmt_touches_nothing_if_one_table_is_none() {
    let place = Place::new();
    write(&place, "tables/a.ron", UNTIDY);
    write(&place, "tables/b.ron", "Table(language: 1, name: )");
    let said = place.run("fmt tables");
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("tables/b.ron:1:"), "{}", said.err);
    assert_eq!(place.read("tables/a.ron"), UNTIDY);
    assert_eq!(place.run("fmt missing.ron").code, Some(2));
}

#[test]
fn new_writes_what_can_be_checked_and_built_and_replaces_nothing() {
    let place = Place::new();
    let said = place.run("new paint");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert!(said.out.starts_with("wrote ./tables/paint.ron\nwrote ./build.rs\n"), "{}", said.out);
    assert_eq!(place.run("check tables/paint.ron").code, Some(0));
    assert_eq!(place.run("build").code, Some(0));
    assert!(place.read("generated/paint/ladder.wgsl").contains("fn paint("));
    assert!(place.read("build.rs").contains("\"/paint/ordered.wgsl\""));
    let said = place.run("new paint");
    assert_eq!(said.code, Some(2));
    assert!(
        said.err.starts_with("error[U0722]: ./tables/paint.ron: exists already; nothing was written"),
        "{}",
        said.err
    );
    // The build script alone stands in the way, too.
    let said = place.run("new other");
    assert_eq!(said.code, Some(2));
    assert!(!place.path("tables/other.ron").exists());
    assert_eq!(place.run("new other --table-only").code, Some(0));
    for bad in ["2nd", "a.b", "float"] {
        let said = place.run(&format!("new {bad} --table-only"));
        assert_eq!(said.code, Some(2), "{bad}: {}", said.all());
    }
}

/// A command that runs until it is dropped, with what it says, line by line.
struct Running {
    child: Child,
    lines: std::sync::mpsc::Receiver<String>,
}

impl Running {
    fn until(&self, what: &str) {
        let end = Instant::now() + Duration::from_secs(60);
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let line = self.lines.recv_timeout(left).unwrap_or_else(|_| panic!("never said: {what}"));
            if line.contains(what) {
                return;
            }
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn watch_builds_again_and_keeps_what_was_right() {
    let place = Place::new();
    write(&place, "tables/dim.ron", TIDY);
    let mut child = Command::new(env!("CARGO_BIN_EXE_umbrage"))
        .args(["build", "--watch", "--target", "wgsl", "--plan", "ladder"])
        .current_dir(place.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .or_panic();
    let (send, lines) = std::sync::mpsc::channel();
    let out: [Box<dyn std::io::Read + Send>; 2] = [
        Box::new(child.stdout.take().unwrap_or_else(|| panic!("a pipe"))),
        Box::new(child.stderr.take().unwrap_or_else(|| panic!("a pipe"))),
    ];
    for stream in out {
        let send = send.clone();
        std::thread::spawn(move || {
            BufReader::new(stream).lines().map_while(Result::ok).try_for_each(|line| send.send(line))
        });
    }
    let running = Running { child, lines };
    running.until("waiting for changes");
    assert!(
        place.read("generated/dim/ladder.wgsl").contains("0.5")
            || place.read("generated/dim/ladder.wgsl").contains("/ 2.0")
    );
    write(&place, "tables/dim.ron", &TIDY.replace("x / 2", "y / 2"));
    running.until("what was generated before stays; waiting for changes");
    let kept = place.read("generated/dim/ladder.wgsl");
    assert!(kept.contains("x"), "{kept}");
    write(&place, "tables/dim.ron", &TIDY.replace("x / 2", "x * 0.125"));
    running.until("waiting for changes");
    assert!(place.read("generated/dim/ladder.wgsl").contains("0.125"));
    write(&place, "tables/more.ron", &TIDY.replace("dim", "more"));
    running.until("waiting for changes");
    assert!(place.path("generated/more/ladder.wgsl").exists());
}

#[test]
fn completions_and_manual_come_from_the_arguments() {
    let place = Place::new();
    for (shell, what) in
        [("bash", "complete -F _umbrage"), ("zsh", "#compdef umbrage"), ("fish", "complete -c umbrage")]
    {
        let said = place.run(&format!("completions {shell}"));
        assert_eq!(said.code, Some(0));
        assert!(said.out.contains(what) && said.out.contains("stabilise"), "{shell}");
    }
    assert_eq!(place.run("completions csh").code, Some(2));
    assert!(place.run("man").out.contains(".TH umbrage 1"));
    let said = place.run("man -o man");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert!(place.read("man/umbrage-build.1").contains("\\-\\-watch"));
    assert!(place.path("man/umbrage-profile-merge.1").exists());
}

/// The fenced blocks of a text whose opening line says this.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = None;
    for line in text.lines() {
        match &mut open {
            None if line.starts_with("```") => open = Some((line[3..] == *language, String::new())),
            Some((wanted, block)) if line == "```" => {
                found.extend(wanted.then(|| std::mem::take(block)));
                open = None;
            }
            Some((_, block)) => {
                block.push_str(line);
                block.push('\n');
            }
            None => {}
        }
    }
    found
}

/// The tutorial, done as it says, but for `cargo`: what the build script would make is made by the command, and the
/// program is compiled by itself.
#[test]
fn the_tutorial_works() {
    let text = include_str!("../../docs/tutorial.md");
    let place = Place::new();
    let commands = blocks(text, "sh").concat();
    let umbrage: Vec<&str> = commands.lines().filter_map(|line| line.strip_prefix("umbrage ")).collect();
    let said: Vec<_> = umbrage.iter().map(|arguments| place.run(arguments)).collect();
    assert!(
        said.iter().all(|said| said.code == Some(0)),
        "{umbrage:?}: {:?}",
        said.iter().map(|s| s.all()).collect::<Vec<_>>()
    );
    let shown = blocks(text, "text");
    assert_eq!(said[1].out, shown[0]);
    // The script that is shown is the one that was written, without its comment.
    assert!(place.read("build.rs").ends_with(&blocks(text, "rust,build")[0]));
    // The program.
    let build = |plan: &str| place.run(&format!("build --target wgsl --plan {plan} --output out"));
    assert_eq!(build("ordered").code, Some(0));
    place.file("main.rs", &blocks(text, "rust,main")[0]);
    let compiled = Command::new("rustc")
        .args(["--edition", "2024", "main.rs"])
        .env("OUT_DIR", place.path("out"))
        .current_dir(place.path(""))
        .status()
        .or_panic();
    assert!(compiled.success());
    let ran = Command::new(place.path("main")).output().or_panic();
    assert!(String::from_utf8_lossy(&ran.stdout).contains("fn paint("));
    // The change, and the mistake.
    let change = blocks(text, "ron,change")[0].trim().to_owned();
    let table = place.read("tables/paint.ron");
    write(&place, "tables/paint.ron", &table.replacen("value: 0,", &change, 1));
    let checked = place.run("check tables/paint.ron");
    assert_eq!(checked.code, Some(0), "{}", checked.all());
    write(&place, "tables/paint.ron", &table.replacen("value: 0,", &change.replacen("pressure", "presure", 1), 1));
    let checked = place.run("check tables/paint.ron");
    assert_eq!(checked.code, Some(2));
    assert!(checked.err.starts_with(&shown[1]), "{}", checked.err);
    assert_eq!(build("ordered").code, Some(2));
}

/// The example, but for `cargo`: its tests pass with what the command makes of its table.
#[test]
fn the_terrain_is_the_expected_one() {
    let example = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/terrain");
    let place = Place::new();
    let read = |name: &str| std::fs::read_to_string(example.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    for name in ["tables/terrain.ron", "src/main.rs", "src/map.txt"] {
        write(&place, name, &read(name));
    }
    assert_eq!(place.run("fmt --check").code, Some(0));
    let built = place.run("build --target wgsl,rust --plan ordered --output out");
    assert_eq!(built.code, Some(0), "{}", built.all());
    let compiled = Command::new("rustc")
        .args(["--edition", "2024", "--test", "src/main.rs", "-o", "terrain"])
        .env("OUT_DIR", place.path("out"))
        .current_dir(place.path(""))
        .status()
        .or_panic();
    assert!(compiled.success());
    let tested = Command::new(place.path("terrain")).output().or_panic();
    assert!(tested.status.success(), "{}", String::from_utf8_lossy(&tested.stdout));
}
