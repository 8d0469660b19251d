//! Commands in the documentation are accepted as they stand.

use std::path::{Path, PathBuf};

use clap::{CommandFactory, Parser};

use super::Arguments;

/// The texts with command lines in them.
fn texts() -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
    let entries = std::fs::read_dir(root.join("docs")).unwrap_or_else(|e| panic!("{e}"));
    paths
        .extend(entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "md")));
    paths.sort();
    let text = |path: &PathBuf| std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{e}"));
    paths.into_iter().map(|path| (path.clone(), text(&path))).collect()
}

/// A command line of a text: without its prompt, its comment and what a shell makes of it. Where something stands
/// at a distance behind it that may be a description, once with and once without that.
fn readings(line: &str) -> Option<[Vec<String>; 2]> {
    let line = line.trim().trim_start_matches("$ ");
    // An example of the repository is another program.
    let line = match line.strip_prefix("cargo run ").filter(|rest| !rest.contains("-p ")) {
        Some(rest) => format!("umbrage {}", rest.split_once("-- ")?.1),
        None => line.to_owned(),
    };
    // A line of Cargo.toml is no command.
    line.strip_prefix("umbrage ").filter(|rest| !rest.starts_with('='))?;
    let command = line.split(" # ").next()?.split([';', '|', '>']).next()?;
    let described = command.trim_end().rfind("  ").map_or(command, |gap| &command[..gap]);
    Some([command, described].map(|text| {
        let words = text.split_whitespace().map(|word| word.trim_matches(['"', '\'']).to_owned());
        words.collect()
    }))
}

#[test]
fn command_lines_of_the_documentation_are_accepted() {
    let mut count = 0;
    for (path, text) in texts() {
        let mut inside = false;
        let mut continued = String::new();
        for line in text.lines() {
            if line.starts_with("```") {
                inside = !inside;
                continue;
            }
            let line = format!("{continued}{line}");
            continued.clear();
            if let Some(begun) = line.strip_suffix('\\') {
                continued = begun.to_owned();
                continue;
            }
            // Placeholders such as <command> and `...` are for people.
            let Some(readings) = readings(&line).filter(|_| inside && !line.contains('<') && !line.contains("..."))
            else {
                continue;
            };
            count += 1;
            let [error, other] =
                readings.map(|words| Arguments::try_parse_from(words).err().filter(clap::Error::use_stderr));
            if let (Some(error), Some(_)) = (error, other) {
                panic!("{}: {line}\n{error}", path.display());
            }
        }
    }
    assert!(count > 40, "{count} command lines were found");
}

#[test]
fn the_definitions_of_the_arguments_are_sound() {
    Arguments::command().debug_assert();
}
