//! What `umbrage check` says of every table in `tests/tables`, in full.
//!
//! `pass/NAME.ron` is fine (exit code 0), `finding/NAME.ron` has something that deserves a look (1), `refused/NAME.ron`
//! has no meaning (2). `NAME.txt` beside it is what the command prints. A new table needs no Rust: put it there, run
//! this test with `INSTA_UPDATE=always`, as for other snapshots, and read what was written.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::support::{said_in, umbrage};

/// Each folder with the exit code of its tables.
const FOLDERS: [(&str, i32); 3] = [("pass", 0), ("finding", 1), ("refused", 2)];

/// A table that is wrong with the test, and in which way.
type Wrong = Mutex<BTreeMap<String, String>>;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tables").join(name)
}

/// The names of the files in a folder that end like this, without the ending.
fn names(folder: &Path, extension: &str) -> Vec<String> {
    let paths = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = paths
        .filter(|path| path.extension().is_some_and(|e| e == extension))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

fn check(kind: &str, code: i32, name: &str, update: bool) -> Result<(), String> {
    let (folder, file) = (folder(kind), format!("{name}.ron"));
    let said = said_in(&folder, umbrage().args(["check", &file]), "");
    let now = said.all();
    if said.code != Some(code) {
        return Err(format!("tables of `{kind}` exit with {code}\n{now}"));
    }
    let beside = folder.join(format!("{name}.txt"));
    if update {
        return std::fs::write(&beside, now).map_err(|error| error.to_string());
    }
    let expected = std::fs::read_to_string(&beside).unwrap_or_default();
    if now == expected { Ok(()) } else { Err(format!("expected:\n{expected}\nnow:\n{now}")) }
}

#[test]
fn messages_stand_beside_their_tables() {
    let update = std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always");
    let all: Vec<(&str, i32, String)> = FOLDERS
        .iter()
        .flat_map(|(kind, code)| names(&folder(kind), "ron").into_iter().map(|name| (*kind, *code, name)))
        .collect();
    let (wrong, next): (Wrong, _) = (Mutex::default(), AtomicUsize::new(0));
    let work = || {
        while let Some((kind, code, name)) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(said) = check(kind, *code, name, update) {
                wrong.lock().unwrap().insert(format!("tests/tables/{kind}/{name}.ron"), said);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let wrong = wrong.into_inner().unwrap();
    let shown: Vec<String> = wrong.iter().map(|(file, said)| format!("==== {file}\n{said}")).collect();
    assert!(
        wrong.is_empty(),
        "{}\n{} of {} differ; INSTA_UPDATE=always accepts that",
        shown.join("\n"),
        wrong.len(),
        all.len()
    );
}

/// No message is left of a table that is gone.
#[test]
fn every_message_has_its_table() {
    for (kind, _) in FOLDERS {
        let folder = folder(kind);
        assert_eq!(names(&folder, "txt"), names(&folder, "ron"), "{kind}");
    }
}
