//! `generated/` is exactly what the compiler makes of `tables/`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use umbrage::build;
use umbrage::program::Program;

fn on_disk(directory: &Path, root: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
    for entry in std::fs::read_dir(directory).expect("`generated/` is there") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            on_disk(&path, root, found);
        } else if !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("functions.")) {
            let relative = path.strip_prefix(root).expect("below").to_owned();
            found.insert(relative, std::fs::read(&path).expect("readable"));
        }
    }
}

#[test]
fn generated_files_are_up_to_date() {
    let mut expected = BTreeMap::new();
    for path in build::find_tables(Path::new("tables")).unwrap_or_else(|e| panic!("{e}")) {
        let programs = Program::read_all(&path).unwrap_or_else(|e| panic!("{e}"));
        // What functions compile to is too large to be checked in.
        let [program] = programs.as_slice() else { continue };
        if program.exhibit.is_some() || program.function.is_some() {
            continue;
        }
        let built = build::table(program, &build::Options::default()).unwrap_or_else(|e| panic!("{e}"));
        expected.extend(built.files.into_iter().map(|file| (file.path, file.contents)));
    }
    let mut found = BTreeMap::new();
    on_disk(Path::new("generated"), Path::new("generated"), &mut found);
    assert_eq!(
        found.keys().collect::<Vec<_>>(),
        expected.keys().collect::<Vec<_>>(),
        "files come and go with `cargo run --release -- build`"
    );
    for (path, contents) in &expected {
        assert!(found[path] == *contents, "{} is out of date: run `cargo run --release -- build`", path.display());
    }
}
