//! The short run that belongs to every test run: the first cases of targets.

use std::process::Command;

fn run(arguments: &str) {
    let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_umbrage-fuzz"));
    command.args(arguments.split(' ')).current_dir(place.path());
    let output = command.output().unwrap_or_else(|error| panic!("{error}"));
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
}

/// The seed is always the same, so that what fails here fails everywhere.
#[test]
fn a_few_files_of_each_format_are_without_faults() {
    run(
        "--cases 600 --seed 1 --no-shrink --faults faults csv json captures profiles tuned scenes obj gltf glb commands",
    );
}

/// Without a driver these say so, and count nothing.
#[test]
fn a_few_tables_do_on_a_device_what_they_do_here() {
    run("--cases 12 --seed 1 --no-shrink --faults faults devices");
}
