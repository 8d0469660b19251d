//! The command itself: exit codes, messages, and files that are left behind.
//!
//! This executable is the command when it is called `umbrage`, so that what is tried is what
//! was built.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::choices::Choices;
use crate::corpus::Family;
use crate::judge::Court;
use crate::targets::{Case, of_file};

/// What a command reads, and what it is called with.
const COMMANDS: &[(Family, &str, &str)] = &[
    (Family::Ron, "t.ron", "check t.ron"),
    (Family::Ron, "t.ron", "build t.ron --output out"),
    (Family::Ron, "t.ron", "fmt --check t.ron"),
    (Family::Ron, "t.ron", "fmt t.ron"),
    (Family::Ron, "t.ron", "atlas t.ron --output a.svg"),
    (Family::Ron, "t.ron", "report t.ron --output r.html"),
    (Family::Ron, "t.ron", "check --message-format json t.ron"),
    (Family::Csv, "rows.csv", "eval yard.ron --input rows.csv"),
    (Family::Json, "rows.json", "eval yard.ron --input rows.json --output a.json"),
    (Family::Capture, "rows.bin", "eval yard.ron --input rows.bin"),
    (Family::Profile, "p.ron", "build yard.ron --profile p.ron --output out"),
    (Family::Profile, "p.ron", "profile show p.ron"),
    (Family::Scene, "s.ron", "profile --scene s.ron --size 24x14 --shadow-map 32 --output p.ron"),
];

/// A command, in a file beside what it reads.
pub(crate) fn make(choices: &mut Choices<'_>) -> Case {
    let (family, name, line) = *choices.pick(COMMANDS);
    let mut case = of_file(choices, family, name);
    case.files.insert(0, ("command".to_owned(), line.as_bytes().to_vec()));
    case.files.push(("yard.ron".to_owned(), include_str!("../corpus/ron/yard.ron").as_bytes().to_vec()));
    case
}

/// Runs it: it ends as commands end, and says why.
pub(crate) fn judge(court: &mut Court<'_>, case: &Case) {
    let line = String::from_utf8_lossy(&case.files[0].1).into_owned();
    court.part("command", |court| run(court, case, &line));
}

fn run(court: &mut Court<'_>, case: &Case, line: &str) {
    let Ok(mut command) = this_executable("umbrage") else {
        return court.fault("commands: this executable cannot be found", String::new());
    };
    command.args(line.split_whitespace()).current_dir(court.directory).env("NO_COLOR", "1");
    let output = match command.stdin(Stdio::null()).output() {
        Ok(output) => output,
        Err(error) => return court.fault("commands: cannot be started", error.to_string()),
    };
    // Messages for programs go to standard output.
    let said = [&output.stderr, &output.stdout].map(|text| String::from_utf8_lossy(text)).concat();
    let all = || format!("umbrage {line}\n{}\n{said}", output.status);
    let what = line.split(' ').next().unwrap_or("");
    match output.status.code() {
        Some(0) => court.count("commands clean", 1),
        // `fmt --check` says with 1 that something would change.
        Some(1) => court.count("commands with findings", 1),
        Some(2) => {
            court.count("commands refused", 1);
            court.expect(said.contains("error"), &format!("commands: `{what}` fails without a word"), all);
            let files: Vec<&str> = case.files[1..].iter().map(|(name, _)| name.as_str()).collect();
            // What a scene has none of is said of the scene, which is called like its file.
            let scene = |file: &str| file.strip_suffix(".ron").map(|name| format!("the scene `{name}`"));
            court.expect(
                files.iter().any(|file| said.contains(file) || scene(file).is_some_and(|scene| said.contains(&scene))),
                &format!("commands: `{what}` names no file"),
                all,
            );
        }
        _ => court.fault(format!("commands: `{what}` ends with {}", output.status), all()),
    }
    court.expect(!said.contains('\u{1b}'), &format!("commands: `{what}` writes an escape"), all);
    // What was not there before and is not what it was asked for.
    let left: Vec<PathBuf> =
        court.directory.read_dir().into_iter().flatten().flatten().map(|entry| entry.path()).collect();
    let litter =
        left.iter().find(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".tmp")));
    court.expect(litter.is_none(), &format!("commands: `{what}` leaves a file behind"), || format!("{litter:?}"));
    if output.status.code() == Some(2) {
        let made =
            left.iter().find(|path| ["a.svg", "r.html", "a.json", "out"].iter().any(|name| path.ends_with(name)));
        court.expect(made.is_none(), &format!("commands: `{what}` fails and writes something"), || {
            format!("{}\n{made:?}", all())
        });
    }
}

/// This executable under a name, which says what it is to be.
pub(crate) fn this_executable(name: &str) -> std::io::Result<Command> {
    let mut command = Command::new(std::env::current_exe()?);
    #[cfg(unix)]
    std::os::unix::process::CommandExt::arg0(&mut command, name);
    #[cfg(not(unix))]
    command.env("UMBRAGE_FUZZ_AS", name);
    Ok(command)
}

/// The name under which this process was called.
pub(crate) fn called() -> String {
    let name = std::env::args_os().next().unwrap_or_default();
    std::env::var("UMBRAGE_FUZZ_AS").unwrap_or_else(|_| name.to_string_lossy().into_owned())
}
