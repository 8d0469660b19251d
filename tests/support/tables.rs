//! The tables that tests run over: the published ones and the synthetic ones.
#![allow(dead_code, clippy::unwrap_used, unreachable_pub)]

use std::path::{Path, PathBuf};

use umbrage::plan::{Plan, Proved, Shape};
use umbrage::program::Program;

fn ron_files(directory: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(directory)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    paths.sort();
    assert!(!paths.is_empty(), "{directory} has no tables");
    paths
}

fn read(paths: &[PathBuf]) -> Vec<Program> {
    paths.iter().map(|path| Program::read(path).unwrap_or_else(|e| panic!("{e}"))).collect()
}

/// SMSR and RSMSS.
pub fn published() -> Vec<Program> {
    read(&ron_files("tables"))
}

/// Small tables that together use every feature of the language.
pub fn synthetic() -> Vec<Program> {
    read(&ron_files("tests/tables"))
}

/// Both.
pub fn all() -> Vec<Program> {
    [published(), synthetic()].concat()
}

/// Every plan that suits a table. Only plans with a lookup may refuse a table, for the size of its key.
pub fn plans(program: &Program) -> Vec<Proved<'_>> {
    let mut plans = Vec::new();
    for shape in Shape::ALL {
        match Plan::new(program, shape) {
            Ok(plan) => plans.push(plan.prove().unwrap_or_else(|e| panic!("{e}"))),
            Err(failure) => {
                let text = failure.to_string();
                assert!(shape != Shape::Ladder && text.contains("its key has"), "{}: {text}", program.name);
            }
        }
    }
    plans
}
