//! The short run that belongs to every test run: the corpus as it is, and the first cases of every target.

use std::process::Command;

fn run(arguments: &str) {
    let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_umbrage-fuzz"));
    command.args(arguments.split(' ')).current_dir(place.path());
    let output = command.output().unwrap_or_else(|error| panic!("{error}"));
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

#[test]
fn the_corpus_is_without_faults() {
    run("corpus");
}

/// The seed is always the same, so that what fails here fails everywhere.
#[test]
fn a_few_cases_of_each_target_are_without_faults() {
    run("--cases 600 --seed 1 --no-shrink --faults faults");
}
