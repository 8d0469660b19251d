//! `cargo xtask`: the chores of this repository. Standard library only, so
//! that it compiles in a second.

mod kill;
mod licences;
mod ltc;
mod web;

use std::env;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

const USAGE: &str = "\
Usage: cargo xtask <task> [arguments]

  test [--no-gpu-setup] [ARGS]   set up what the tests need, then run all of them;
                                 ARGS go to the main `cargo test`
  test --fast [ARGS]             what needs no adapter, no other tool and no other crate: for
                                 work, under two minutes from a warm build
  ci [ARGS]                      formatting, lints and documentation, then test
  features                       check that each feature compiles alone
  msrv                           check with the oldest Rust that is promised, if rustup has it
  licences                       check the licences of all packages against deny.toml
  package                        build what would be published, from what would be in it
  bless                          rewrite generated/ and the snapshots from what the code does now
  errata                         write docs/errata.md: what the analyses find in tables as printed
  ltc                            fit linearly transformed cosines for GGX: tables/ltc_ggx_*.csv; minutes,
                                 or with `cargo run --release --package xtask -- ltc` one
  kill [TIMES [SEED [PROGRAM]]]  kill build, fmt, render and tune at random moments, 500 each if nothing else
                                 is said, and look at what they leave; PROGRAM is a built `umbrage`
  fuzz [--minutes N] [--seed S] [TARGET...]
                                 try random tables and files made wrong, on all cores; `fuzz --help`
                                 says more
  web [--test]                   build the playground, web/dist/index.html; --test also tries it in Chromium
  bench [ARGS]                   run the benchmarks; ARGS go to `cargo bench`
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (task, rest) = match arguments.split_first() {
        Some((task, rest)) => (task.as_str(), rest),
        None => ("help", &[][..]),
    };
    let mut steps = Steps::default();
    let result = match task {
        "test" if rest.iter().any(|argument| argument == "--fast") => fast(&mut steps, rest),
        "test" => test(&mut steps, rest),
        "ci" => lint(&mut steps).and_then(|()| test(&mut steps, rest)),
        "features" => features(&mut steps),
        "msrv" => oldest_rust(&mut steps),
        "licences" => licences::check(include_str!("../../deny.toml")),
        "package" => package(&mut steps),
        "bless" => bless(&mut steps),
        "errata" => errata(&mut steps),
        "ltc" => cosines(),
        "kill" => kill(&mut steps, rest),
        "fuzz" => fuzz(&mut steps, rest),
        "web" => web::run(&mut steps, root(), rest),
        "bench" => bench(&mut steps, rest),
        "help" | "--help" | "-h" => {
            print!("{USAGE}");
            return ExitCode::SUCCESS;
        }
        unknown => {
            eprint!("error: there is no task `{unknown}`\n\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    steps.summary();
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(code) => ExitCode::from(code),
    }
}

/// The exit code of the step that failed.
type Result<T = ()> = std::result::Result<T, u8>;

// Tasks

/// Everything that has to hold, on this machine.
fn test(steps: &mut Steps, arguments: &[String]) -> Result {
    let set_up = !arguments.iter().any(|a| a == "--no-gpu-setup");
    let arguments: Vec<&String> = arguments.iter().filter(|a| *a != "--no-gpu-setup").collect();
    if set_up {
        vulkan_driver(steps)?;
    }
    let glslang = tool(steps, set_up, "glslangValidator", "glslang-tools", "generated GLSL and HLSL is");
    let spirv_val = tool(steps, set_up, "spirv-val", "spirv-tools", "generated SPIR-V is");
    let solvers = ["z3", "cvc5"].map(|solver| tool(steps, set_up, solver, solver, "certificates of plans are"));
    let tests = |arguments: &[&str]| {
        let mut command = cargo(arguments);
        command.env("UMBRAGE_REQUIRE_ADAPTER", "1");
        if glslang {
            command.env("UMBRAGE_REQUIRE_GLSLANG", "1");
        }
        if spirv_val {
            command.env("UMBRAGE_REQUIRE_SPIRV_VAL", "1");
        }
        if solvers == [true, true] {
            command.env("UMBRAGE_REQUIRE_SOLVERS", "1");
        }
        command
    };
    // First and alone, so that the line `adapter: ...` is seen and a missing
    // adapter is the first thing that fails. `--workspace` resolves features as
    // the main run does: wgpu is built once.
    steps.run(
        "adapter",
        tests(&[
            "test",
            "--workspace",
            "--features",
            "umbrage/trial",
            "--test",
            "device",
            "adapter::",
            "--",
            "--nocapture",
        ]),
    )?;
    let mut all = tests(&["test", "--workspace", "--features", "umbrage/trial"]);
    all.args(arguments);
    steps.run("tests", all)?;
    licences::check(include_str!("../../deny.toml"))?;
    features(steps)
}

/// What is worth its time after every change: the library, the compiler and the command, on the CPU.
fn fast(steps: &mut Steps, arguments: &[String]) -> Result {
    // One package with its default features, so that what the full run has built is used.
    let mut tests = cargo(&["test", "--features", "umbrage/trial", "--lib", "--test", "compiler", "--test", "cli"]);
    tests
        .env("UMBRAGE_NO_ADAPTER", "1")
        .env("UMBRAGE_NO_SOLVERS", "1")
        .args(arguments.iter().filter(|argument| *argument != "--fast"));
    steps.run("fast tests", tests)
}

/// The compiler alone, and each feature alone. Only checked, not built: no second wgpu, no second set of tests.
fn features(steps: &mut Steps) -> Result {
    for feature in ["", "precise", "report", "render", "gpu", "cli", "trial"] {
        let set = ["clippy", "--package", "umbrage", "--no-default-features", "--features", feature];
        let mut check = cargo(&set);
        // What only another feature uses is a warning, and a mistake in a condition.
        check.args(["--", "-D", "warnings"]);
        let name = if feature.is_empty() { "no feature".to_owned() } else { format!("feature {feature}") };
        steps.run(&name, check)?;
    }
    Ok(())
}

/// The library, alone and with its default features, by the oldest toolchain that `Cargo.toml` promises. In a target
/// directory of its own, so that nothing else has to be built again.
fn oldest_rust(steps: &mut Steps) -> Result {
    let manifest = include_str!("../../Cargo.toml");
    let promised = manifest.split_once("rust-version = \"").and_then(|(_, rest)| rest.split_once('"'));
    let Some((version, _)) = promised else {
        eprintln!("error: Cargo.toml does not say `rust-version`");
        return Err(1);
    };
    for features in [&["--no-default-features"][..], &[]] {
        let mut check = Command::new("rustup");
        check.args(["run", version, "cargo", "check", "--locked", "--package", "umbrage"]).args(features);
        check.args(["--target-dir", "target/msrv"]);
        // `cargo xtask` runs under a toolchain, and would hand it on.
        check.env_remove("RUSTUP_TOOLCHAIN").env_remove("CARGO").env_remove("RUSTC");
        steps.run(&format!("Rust {version} {}", features.concat()), check)?;
    }
    Ok(())
}

/// What would be published, unpacked and built as Cargo does it before publishing.
fn package(steps: &mut Steps) -> Result {
    steps.run("package", cargo(&["package", "--package", "umbrage", "--allow-dirty", "--no-default-features"]))
}

/// Formatting, lints and documentation.
fn lint(steps: &mut Steps) -> Result {
    steps.run("formatting", cargo(&["fmt", "--all", "--check"]))?;
    steps.run("lints", cargo(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"]))?;
    let mut doc = cargo(&["doc", "--workspace", "--no-deps"]);
    doc.env("RUSTDOCFLAGS", "-D warnings");
    steps.run("documentation", doc)
}

/// Takes what the code does now as what it should do. Look at the difference before committing it.
fn bless(steps: &mut Steps) -> Result {
    steps.run("generated", cargo(&["run", "--release", "--", "build"]))?;
    for (table, plan) in [("smsr", "switch"), ("rsmss", "switch_buffer")] {
        let from = format!("tables/{table}.ron");
        let build = ["run", "--release", "--", "build", &from, "--plan", plan, "--target", "rust_wgpu"];
        let mut build = cargo(&build);
        build.args(["--output", "consumers/tests/generated"]);
        steps.run("generated for wgpu", build)?;
    }
    for table in ["rsmss", "smsr"] {
        let (from, to) = (format!("tables/{table}.ron"), format!("docs/images/{table}.svg"));
        steps.run("atlas", cargo(&["run", "--release", "--", "atlas", &from, "--output", &to]))?;
    }
    let mut snapshots = cargo(&["test", "--workspace", "--features", "umbrage/trial"]);
    snapshots.env("INSTA_UPDATE", "always");
    steps.run("snapshots", snapshots)
}

/// What the analyses find in tables as they were printed, and how many seeded mistakes.
fn errata(steps: &mut Steps) -> Result {
    let mut command = cargo(&["run", "--release", "--features", "trial", "--", "errata"]);
    for name in ["rsmss", "smsr"] {
        command.args([format!("tables/published/{name}_as_printed.ron"), format!("tables/{name}.ron")]);
    }
    command.args(["--mistakes", "1002", "--output", "docs/errata.md"]);
    steps.run("errata", command)
}

/// The data of the tables `ltc_matrix` and `ltc_albedo`.
fn cosines() -> Result {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    ltc::run(&root.join("tables")).map_err(|error| {
        eprintln!("error: the files cannot be written: {error}");
        1
    })
}

/// What commands leave that are killed.
fn kill(steps: &mut Steps, arguments: &[String]) -> Result {
    let number = |index: usize, usual: u64| match arguments.get(index).map(|word| word.parse()) {
        None => Ok(usual),
        Some(Ok(number)) => Ok(number),
        Some(Err(_)) => {
            eprintln!("error: `{}` is not a whole number\n\n{USAGE}", arguments[index]);
            Err(2)
        }
    };
    let (times, seed) = (number(0, 500)?, number(1, 1)?);
    let root = root();
    let program = match arguments.get(2) {
        Some(program) => PathBuf::from(program),
        None => {
            steps.run("program", cargo(&["build", "--release"]))?;
            let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
            target.join("release/umbrage")
        }
    };
    kill::run(root, &program, times as usize, seed)
}

/// Random tables and files made wrong. What overflows, or was thought impossible, ends a process there.
fn fuzz(steps: &mut Steps, arguments: &[String]) -> Result {
    let mut command = cargo(&["run", "--quiet", "--profile", "fuzz", "--package", "umbrage-fuzz", "--"]);
    if let Ok(directory) = env::current_dir() {
        // Paths among the arguments are those of whoever gave them.
        command.current_dir(directory);
    }
    command.args(arguments);
    steps.run("fuzz", command)
}

/// The benchmarks: all of them optimised, and compilation also as a build script gets it, without optimisation.
/// None needs wgpu, so none builds it.
fn bench(steps: &mut Steps, arguments: &[String]) -> Result {
    let mut optimised = cargo(&["bench", "--package", "umbrage", "--no-default-features"]);
    optimised.args(arguments);
    steps.run("benchmarks", optimised)?;
    let profile = ["bench", "--package", "umbrage", "--no-default-features", "--profile", "unoptimised"];
    let mut unoptimised = cargo(&profile);
    unoptimised.args(["--bench", "compile"]).args(arguments);
    steps.run("benchmarks without optimisation", unoptimised)
}

// What the tests need from the system

/// Makes sure that some Vulkan driver is installed; a software one will do.
fn vulkan_driver(steps: &mut Steps) -> Result {
    if !cfg!(target_os = "linux") {
        // Metal and Direct3D 12 come with the system.
        return Ok(());
    }
    if has_vulkan_driver() {
        return Ok(());
    }
    println!("No Vulkan driver found: installing Mesa's software driver.");
    if apt_install(steps, &["mesa-vulkan-drivers", "libvulkan1"]) && has_vulkan_driver() {
        return Ok(());
    }
    eprintln!(
        "error: the tests run shaders, and there is no Vulkan driver on this machine\n\
         \x20 Debian, Ubuntu  apt-get install mesa-vulkan-drivers libvulkan1\n\
         \x20 Fedora          dnf install mesa-vulkan-drivers vulkan-loader\n\
         \x20 Arch            pacman -S vulkan-swrast vulkan-icd-loader\n\
         \x20 elsewhere       any Vulkan driver and loader; Mesa's `lavapipe` needs no GPU\n\
         A driver in an unusual place is named by VK_DRIVER_FILES. With --no-gpu-setup nothing is\n\
         looked for or installed."
    );
    Err(1)
}

fn has_vulkan_driver() -> bool {
    let named = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"];
    let directories = ["/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
    named.iter().any(|name| env::var_os(name).is_some_and(|value| !value.is_empty()))
        || directories.iter().any(|directory| has_file_with_extension(directory, "json"))
}

fn has_file_with_extension(directory: &str, extension: &str) -> bool {
    let Ok(entries) = Path::new(directory).read_dir() else { return false };
    entries.flatten().any(|entry| entry.path().extension() == Some(OsStr::new(extension)))
}

/// Makes sure that a validator is there, if that is possible. The tests can do without.
fn tool(steps: &mut Steps, set_up: bool, name: &str, package: &str, judged: &str) -> bool {
    let found = || runs(Command::new(name).arg("--version"));
    if found() {
        return true;
    }
    if set_up {
        println!("{name} not found: installing it.");
        if apt_install(steps, &[package]) && found() {
            return true;
        }
    }
    let line = "*".repeat(78);
    eprintln!(
        "{line}\n\
         warning: {name} is missing, so {judged} NOT checked by it.\n\
         The tests that would do so are skipped. It is in Debian's package `{package}`.\n\
         {line}"
    );
    steps.note(format!("{name} is missing: {judged} not checked by it"));
    false
}

/// Installs Debian packages, if this is such a system and the rights are there.
fn apt_install(steps: &mut Steps, packages: &[&str]) -> bool {
    if !runs(Command::new("apt-get").arg("--version")) {
        return false;
    }
    let Some(prefix) = root_prefix() else {
        eprintln!("Neither root nor `sudo` without a password: nothing can be installed.");
        return false;
    };
    let apt = |arguments: &[&str]| {
        let mut words = prefix.iter().copied().chain(["apt-get"]).chain(arguments.iter().copied());
        let mut command = Command::new(words.next().unwrap_or("apt-get"));
        command.args(words);
        command
    };
    let mut install = vec!["install", "-y", "--no-install-recommends"];
    install.extend(packages);
    // An index that is partly out of date may still do, so only the installation decides.
    let _ = steps.run("apt-get update", apt(&["update"]));
    steps.run(&format!("apt-get install {}", packages.join(" ")), apt(&install)).is_ok()
}

/// What to write before a command that needs root; `None` if it cannot be had.
/// The variable goes through `env`, because `sudo` drops the environment.
fn root_prefix() -> Option<&'static [&'static str]> {
    let id = Command::new("id").arg("-u").output().ok()?;
    if id.stdout.trim_ascii() == b"0" {
        return Some(&["env", "DEBIAN_FRONTEND=noninteractive"]);
    }
    runs(Command::new("sudo").args(["-n", "true"])).then_some(&["sudo", "-n", "env", "DEBIAN_FRONTEND=noninteractive"])
}

/// Whether a command can be started and succeeds; its output is dropped.
fn runs(command: &mut Command) -> bool {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    quiet.status().is_ok_and(|status| status.success())
}

// Steps

/// What was run, and how it went.
#[derive(Default)]
struct Steps {
    done: Vec<(String, Duration, bool)>,
    notes: Vec<String>,
}

impl Steps {
    /// Runs a command, its output passed through.
    fn run(&mut self, name: &str, mut command: Command) -> Result {
        println!("\n==> {name}: {}", shown(&command));
        let start = Instant::now();
        let result = match command.stdin(Stdio::null()).status() {
            Ok(status) if status.success() => Ok(()),
            // A process that was killed by a signal has no code.
            Ok(status) => Err(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)),
            Err(error) => {
                eprintln!("error: cannot be started: {error}");
                Err(1)
            }
        };
        self.done.push((name.to_owned(), start.elapsed(), result.is_ok()));
        result
    }

    fn note(&mut self, note: String) {
        self.notes.push(note);
    }

    fn summary(&self) {
        if self.done.is_empty() {
            return;
        }
        println!("\nSummary");
        for (name, time, ok) in &self.done {
            println!("  {:<6} {:>7.1} s  {name}", if *ok { "ok" } else { "FAILED" }, time.as_secs_f64());
        }
        for note in &self.notes {
            println!("  note: {note}");
        }
    }
}

/// The directory of the repository.
fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."))
}

/// The `cargo` that runs this, so that toolchain overrides stay in force.
fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments);
    command.current_dir(root());
    command
}

fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or_default();
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
