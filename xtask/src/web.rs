//! The playground: the compiler as WebAssembly and the page around it, and the browser that tries it.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Result, Steps, apt_install, cargo, runs};

/// The oldest Node.js that will do.
const NODE: u32 = 20;

/// Builds `web/dist/index.html`; with `--test`, also drives it in a browser without a window.
pub(crate) fn run(steps: &mut Steps, root: &Path, arguments: &[String]) -> Result {
    if let Some(other) = arguments.iter().find(|argument| *argument != "--test") {
        eprintln!("error: `{other}` is no argument of `web`; there is `--test`");
        return Err(2);
    }
    let web = root.join("web");
    target(steps)?;
    node()?;
    // A workspace of its own, with its own settings beside it.
    for (name, words) in [("formatting", &["fmt", "--check"][..]), ("compiler for the page", &["build", "--release"])] {
        let mut command = cargo(words);
        command.current_dir(web.join("wasm"));
        steps.run(name, command)?;
    }
    packages(steps, &web)?;
    let targets = env::var_os("CARGO_TARGET_DIR").map_or_else(|| web.join("wasm/target"), PathBuf::from);
    let wasm = targets.join("wasm32-unknown-unknown/release/umbrage_playground.wasm");
    steps.run("types of the page", npm(&web, &["run", "--silent", "check"]))?;
    let mut page = Command::new("node");
    page.current_dir(&web).arg("build.mjs").arg(wasm);
    steps.run("page", page)?;
    if !arguments.is_empty() {
        browser(steps)?;
        steps.run("page in a browser", npm(&web, &["run", "--silent", "test"]))?;
    }
    println!("\nOpen {} in a browser.", web.join("dist/index.html").display());
    Ok(())
}

fn npm(web: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(if cfg!(windows) { "npm.cmd" } else { "npm" });
    command.current_dir(web).args(arguments);
    command
}

/// Makes sure that Rust can compile for the browser.
fn target(steps: &mut Steps) -> Result {
    let name = "wasm32-unknown-unknown";
    let mut list = Command::new("rustup");
    let installed = list.args(["target", "list", "--installed"]).output();
    match installed {
        Ok(output) if String::from_utf8_lossy(&output.stdout).lines().any(|line| line == name) => Ok(()),
        Ok(_) => {
            let mut add = Command::new("rustup");
            add.args(["target", "add", name]);
            steps.run("target", add)
        }
        // Without rustup the target may have come with Rust; if not, the build says so.
        Err(_) => Ok(()),
    }
}

/// Makes sure that Node.js is there, and new enough.
fn node() -> Result {
    let output = Command::new("node").arg("--version").output();
    let version = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()).unwrap_or_default();
    let major = version.trim_start_matches('v').split('.').next().and_then(|major| major.parse::<u32>().ok());
    if major.is_some_and(|major| major >= NODE) && runs(npm(Path::new("."), &["--version"]).env("NO_COLOR", "1")) {
        return Ok(());
    }
    let found = if version.is_empty() { "it is not here".to_owned() } else { format!("here is {version}") };
    eprintln!(
        "error: the page is built with Node.js {NODE} or later and its npm; {found}\n\
         \x20 Debian, Ubuntu  apt-get install nodejs npm\n\
         \x20 elsewhere       https://nodejs.org"
    );
    Err(1)
}

/// Installs what the lock file names, unless that was done.
fn packages(steps: &mut Steps, web: &Path) -> Result {
    let time = |path: &str| web.join(path).metadata().and_then(|metadata| metadata.modified());
    let fresh = time("node_modules/.package-lock.json").ok().zip(time("package-lock.json").ok());
    if fresh.is_some_and(|(installed, locked)| installed >= locked) {
        return Ok(());
    }
    // None of the packages needs its scripts run.
    steps.run("packages of the page", npm(web, &["ci", "--ignore-scripts", "--no-audit", "--no-fund"]))
}

/// Makes sure that there is a browser to be driven.
fn browser(steps: &mut Steps) -> Result {
    let found = || {
        let places = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
        env::var_os("CHROMIUM").is_some() || places.iter().any(|place| Path::new(place).exists())
    };
    if found() || apt_install(steps, &["chromium"]) && found() {
        return Ok(());
    }
    eprintln!(
        "error: the page is tried in Chromium, which is not here\n\
         \x20 Debian          apt-get install chromium\n\
         \x20 elsewhere       install Chromium or Chrome, and name it: CHROMIUM=/path/to/it"
    );
    Err(1)
}
