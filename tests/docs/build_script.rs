//! Tables in a build script, as a user has them: the example of `docs/build.md`
//! in a crate of its own, compiled without optimisation and without a network.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::SystemTime;

use umbrage::profile::{self, Profile, Scene};
use umbrage::program::Program;

/// The crate, in a place that stays, so that only the first run builds Umbrage for it.
struct Roof(PathBuf);

impl Roof {
    fn new() -> Self {
        let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("build_script");
        let roof = Self(place.join("roof"));
        for old in [roof.0.clone(), place.join("copies")].iter().chain(&Self::made()) {
            let _ = std::fs::remove_dir_all(old);
        }
        let document = std::fs::read_to_string(root().join("docs/build.md")).unwrap();
        let blocks = |language: &str| -> Vec<String> {
            let open = format!("```{language}\n");
            document.split(&open).skip(1).map(|part| part.split("```").next().unwrap().to_owned()).collect()
        };
        let manifest = blocks("toml").remove(0);
        let published = "umbrage = { version = \"0.1\"";
        assert!(manifest.contains(published), "{manifest}");
        let path = format!("umbrage = {{ path = {:?}", root());
        // A workspace of its own: it lies inside of this one's target directory.
        roof.file("Cargo.toml", &(manifest.replace(published, &path) + "\n[workspace]\n"));
        let [script, main] = <[String; 2]>::try_from(blocks("rust")).unwrap();
        roof.file("build.rs", &script);
        roof.file("src/main.rs", &main);
        roof.file("tables/snow.ron", &std::fs::read_to_string(root().join("docs/examples/first.ron")).unwrap());
        // The versions that this repository is built with are those at hand.
        roof.file("Cargo.lock", &std::fs::read_to_string(root().join("Cargo.lock")).unwrap());
        roof
    }

    fn file(&self, name: &str, text: &str) {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    fn cargo(&self, arguments: &[&str]) -> Output {
        self.cargo_with_copies(arguments, "")
    }

    /// The same, with a directory for copies of generated files.
    fn cargo_with_copies(&self, arguments: &[&str], copies: &str) -> Output {
        let place = self.0.parent().unwrap();
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args(arguments).arg("--offline").current_dir(&self.0);
        cargo.env("CARGO_TARGET_DIR", place.join("target")).env("UMBRAGE_OUT_DIR", copies);
        cargo.env_remove("RUSTFLAGS").env("CARGO_TERM_COLOR", "never");
        cargo.output().unwrap()
    }

    fn succeeds(&self, arguments: &[&str]) -> (String, String) {
        let output = self.cargo(arguments);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert!(output.status.success(), "{arguments:?}: {err}");
        (out, err)
    }

    /// What Cargo keeps of the build script.
    fn made() -> Vec<PathBuf> {
        let build = Path::new(env!("CARGO_TARGET_TMPDIR")).join("build_script/target/debug/build");
        let Ok(entries) = std::fs::read_dir(build) else { return Vec::new() };
        let entries = entries.map(|entry| entry.unwrap());
        let own = entries.filter(|entry| entry.file_name().to_string_lossy().starts_with("roof-"));
        let paths = own.map(|entry| entry.path().join("out"));
        paths.filter(|path| path.join("umbrage.stamp").exists()).collect()
    }

    /// When a generated file was written.
    fn written(name: &str) -> SystemTime {
        Self::made()[0].join(name).metadata().unwrap().modified().unwrap()
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Many cases, and expressions that are long and deep.
fn large() -> String {
    let nested = |inner: &str| (0..10).fold(inner.to_owned(), |inner, _| format!("min(1, max({inner}, 0.5 * x))"));
    let long = vec!["x"; 60].join(" + ");
    let mut names = format!("\"deep0\": \"{}\",\n", nested("x"));
    for depth in 1..6 {
        let _ = writeln!(names, "\"deep{depth}\": \"{}\",", nested(&format!("deep{}", depth - 1)));
    }
    let mut cases = String::new();
    for id in 1..=150_u32 {
        let state = (0..4).map(|level| format!("i{level} == {}", (id >> (2 * level)) % 4)).collect::<Vec<_>>();
        let value = match id {
            1 => "deep5",
            2 => &long,
            _ => "x * 0.5",
        };
        let _ = writeln!(cases, "Case(id: {id}, doc: \"\", when: \"{}\", value: \"{value}\"),", state.join(" && "));
    }
    let inputs: String = (0..4).map(|level| format!("\"i{level}\": Int(from: 0, to: 3, default: 0),")).collect();
    format!(
        "Table(language: 1, name: \"large\", title: \"\", source: \"\", hit_policy: First,\n\
         inputs: {{{inputs} \"idle\": Bool(default: false), \"x\": Range(from: 0, to: 1, default: 0)}},\nnames: {{{names}}},\n\
         output: Number(),\ncases: [\n{cases}],\ndefault: 0)\n"
    )
}

#[test]
fn the_documented_example_works_and_notices_what_changes() {
    let roof = Roof::new();
    let (out, _) = roof.succeeds(&["run", "--quiet"]);
    let document = std::fs::read_to_string(root().join("docs/build.md")).unwrap();
    assert!(document.contains(&format!("```text\n{out}```")), "{out}");

    let (tree, _) = roof.succeeds(&["tree", "--edges", "normal,build", "--prefix", "none"]);
    for heavy in ["wgpu ", "clap ", "image "] {
        assert!(!tree.lines().any(|line| line.starts_with(heavy)), "{heavy}: {tree}");
    }

    // Touched, but the same: the script runs, and leaves everything alone.
    let before = Roof::written("snow/ordered.rs");
    let snow = std::fs::read_to_string(roof.0.join("tables/snow.ron")).unwrap();
    roof.file("tables/snow.ron", &snow);
    roof.succeeds(&["build"]);
    assert_eq!(Roof::written("snow/ordered.rs"), before);

    // Copies for people, the same to the byte; and nothing says where any of this lies.
    let copies = roof.0.parent().unwrap().join("copies");
    let output = roof.cargo_with_copies(&["build"], copies.to_str().unwrap());
    assert!(output.status.success(), "{}", text(&output.stderr));
    let mut names = Vec::new();
    for entry in std::fs::read_dir(copies.join("roof/snow")).unwrap() {
        let path = entry.unwrap().path();
        let (name, bytes) = (path.file_name().unwrap().to_owned(), std::fs::read(&path).unwrap());
        assert_eq!(std::fs::read(Roof::made()[0].join("snow").join(&name)).unwrap(), bytes);
        let own = root().to_str().unwrap();
        assert!(!String::from_utf8_lossy(&bytes).contains(own), "{name:?} holds the path {own}");
        names.push(name.into_string().unwrap());
    }
    names.sort();
    assert_eq!(names, ["ordered.330.glsl", "ordered.rs", "ordered.wgsl"]);
    assert_eq!(Roof::written("snow/ordered.rs"), before);

    // Another table; a large one, without optimisation, on the stack that a build script has.
    roof.file("tables/large.ron", &large());
    let (_, said) = roof.succeeds(&["build"]);
    assert!(said.contains("warning: roof@0.1.0: tables/large.ron:"), "findings are warnings: {said}");
    assert_eq!(Roof::written("snow/ordered.rs"), before);
    assert!(Roof::made()[0].join("large/ordered.330.glsl").exists());

    // A directory that was not there, watched without building again and again.
    let (_, said) = roof.succeeds(&["build"]);
    assert!(!said.contains("Compiling"), "{said}");
    let program = Program::read(roof.0.join("tables/snow.ron")).unwrap();
    let mut profile = Profile::new(&program);
    let states = BTreeMap::from([(0, 7)]);
    let (name, cases) = ("winter".to_owned(), BTreeMap::from([(None, 7)]));
    let (technique, setting) = ("snow".to_owned(), "captured".to_owned());
    profile.scenes.push(Scene { name, technique, setting, weight: 1.0, states, cases, tiles: None });
    roof.file("profiles/snow.ron", &profile::to_ron(&profile));
    roof.succeeds(&["build"]);
    let ordered = || std::fs::read_to_string(Roof::made()[0].join("snow/ordered.wgsl")).unwrap();
    assert!(ordered().contains("// Weight: profile snow.ron, 7 evaluations of winter"), "{}", ordered());
    let (_, said) = roof.succeeds(&["build"]);
    assert!(!said.contains("Compiling"), "{said}");

    // A broken profile: the command in the message finds the same.
    roof.file("profiles/snow.ron", "Profile(");
    let output = roof.cargo(&["build"]);
    let said = text(&output.stderr);
    assert!(!output.status.success() && said.contains("error[U0611]: "), "{said}");
    let hint = said.split('`').find(|part| part.starts_with("umbrage profile show ")).expect("a hint");
    let mut words = hint.split(' ').skip(1);
    let output = Command::new(env!("CARGO_BIN_EXE_umbrage")).args(&mut words).current_dir(&roof.0).output().unwrap();
    assert!(text(&output.stderr).contains("error[U0611]: "), "{}", text(&output.stderr));

    // What is not made any more is removed: of a table, and the plan for a profile.
    std::fs::remove_dir_all(roof.0.join("profiles")).unwrap();
    std::fs::rename(roof.0.join("tables/large.ron"), roof.0.join("tables/larger.txt")).unwrap();
    roof.succeeds(&["build"]);
    assert!(!ordered().contains("// Weight: ") && !Roof::made()[0].join("large").exists());
    let before = Roof::written("snow/ordered.rs");

    // Mistakes in two tables: both are told, and what was there stays.
    roof.file("tables/large.ron", "Table(");
    roof.file("tables/snow.ron", &snow.replace("\"0.5 + 0.5 * to_eaves\"", "\"0.5 + 0.5 * to_heaven\""));
    let output = roof.cargo(&["build"]);
    let said = text(&output.stderr);
    assert!(!output.status.success());
    for expected in ["tables/snow.ron:47:", "`to_heaven` is not defined", "tables/large.ron:1:", "umbrage explain U"] {
        assert!(said.contains(expected), "{expected}: {said}");
    }
    assert_eq!(Roof::written("snow/ordered.rs"), before);
}

/// The example is built by its own script, and does what its tests expect.
#[test]
fn the_terrain_is_built_by_its_own_script() {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("build_script");
    let terrain = Roof(place.join("terrain"));
    let example = root().join("examples/terrain");
    let read = |name: &str| std::fs::read_to_string(example.join(name)).unwrap();
    for name in ["build.rs", "src/main.rs", "src/map.txt", "tables/terrain.ron"] {
        terrain.file(name, &read(name));
    }
    let path = format!("path = {:?}", root());
    terrain.file("Cargo.toml", &(read("Cargo.toml").replace("path = \"../..\"", &path) + "\n[workspace]\n"));
    terrain.file("Cargo.lock", &std::fs::read_to_string(root().join("Cargo.lock")).unwrap());
    let (said, _) = terrain.succeeds(&["test"]);
    assert!(said.contains("test result: ok. "), "{said}");
}
