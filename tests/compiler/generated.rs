//! `generated/` is exactly what `umbrage build` makes of `tables/`, with the
//! profiles and the tuned choices beside them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The files below a directory.
fn files(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut pending = vec![directory.to_owned()];
    while let Some(next) = pending.pop() {
        for entry in std::fs::read_dir(&next).unwrap_or_else(|e| panic!("{}: {e}", next.display())) {
            let path = entry.expect("readable").path();
            if path.is_dir() {
                pending.push(path);
            } else {
                let relative = path.strip_prefix(directory).expect("below").to_owned();
                found.insert(relative, std::fs::read(&path).expect("readable"));
            }
        }
    }
    found
}

#[test]
fn generated_files_are_up_to_date() {
    let output = tempfile::tempdir().expect("a directory");
    let mut build = Command::new(env!("CARGO_BIN_EXE_umbrage"));
    build.current_dir(env!("CARGO_MANIFEST_DIR")).arg("build").arg("--output").arg(output.path());
    let run = build.output().expect("runs");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let (expected, found) = (files(output.path()), files(Path::new("generated")));
    assert_eq!(
        found.keys().collect::<Vec<_>>(),
        expected.keys().collect::<Vec<_>>(),
        "files come and go with `cargo run --release -- build`"
    );
    for (path, contents) in &expected {
        assert!(found[path] == *contents, "{} is out of date: run `cargo run --release -- build`", path.display());
    }
    for table in ["smsr", "rsmss"] {
        let ordered = String::from_utf8_lossy(&expected[&Path::new(table).join("ordered.wgsl")]).into_owned();
        for line in ["// Plan:   ordered", &format!("// Weight: profile {table}.ron, "), "// Cost:   ", "// Proof:  "] {
            assert!(ordered.contains(line), "{table}: {line}");
        }
    }
}
