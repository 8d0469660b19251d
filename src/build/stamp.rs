//! The record of what a build script made last time, so that it need not make it again.
//!
//! Cargo runs a build script again for many reasons, most of which have nothing
//! to do with tables. A stamp, kept in `OUT_DIR` beside the generated files,
//! names everything that they were made from and what they were. If all of it
//! still is as it was, there is nothing to do.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use super::{Artifact, Request, find_tables};
use crate::diag::fnv1a;
use crate::text::file;

/// Name of the stamp in `OUT_DIR`.
const NAME: &str = "umbrage.stamp";

/// Largest file that is looked at. What is larger counts as changed.
const MAX_BYTES: u64 = 256 << 20;

/// The files of last time, which are as they would be made now.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Fresh {
    /// The warnings of that time.
    pub(super) warnings: Vec<String>,
    /// The files that it was made from.
    pub(super) inputs: Vec<PathBuf>,
}

/// Finds the files that a request asks for, if they are there already.
pub(super) fn fresh(place: &Path, request: &Request, output: &Path) -> Option<Fresh> {
    let text = file::read_text(&place.join(NAME), MAX_BYTES).ok()?;
    let mut lines = text.lines();
    if lines.next()? != head(request, output) {
        return None;
    }
    let mut fresh = Fresh { warnings: Vec::new(), inputs: Vec::new() };
    for line in lines {
        let (kind, rest) = line.split_once(' ')?;
        if kind == "warning" {
            fresh.warnings.push(rest.to_owned());
            continue;
        }
        let (hash, path) = rest.split_once(' ')?;
        let path = match kind {
            "input" => PathBuf::from(path),
            _ => output.join(path),
        };
        if hash_of(&path)? != hash {
            return None;
        }
        if kind == "input" {
            fresh.inputs.push(path);
        }
    }
    Some(fresh)
}

/// Leaves a stamp for the next time. That this fails costs time then, and nothing else.
pub(super) fn leave(
    place: &Path,
    request: &Request,
    output: &Path,
    warnings: &[String],
    inputs: &BTreeSet<PathBuf>,
    files: &[Artifact],
) {
    let path = place.join(NAME);
    match text(request, output, warnings, inputs, files) {
        Some(text) => drop(file::write(&path, text.as_bytes())),
        None => drop(std::fs::remove_file(path)),
    }
}

fn text(
    request: &Request,
    output: &Path,
    warnings: &[String],
    inputs: &BTreeSet<PathBuf>,
    files: &[Artifact],
) -> Option<String> {
    let mut text = head(request, output) + "\n";
    for warning in warnings {
        let _ = writeln!(text, "warning {warning}");
    }
    for input in inputs {
        let _ = writeln!(text, "input {} {}", hash_of(input)?, one_line(input)?);
    }
    for file in files {
        let _ = writeln!(text, "output {:016x} {}", fnv1a(file.contents.iter().copied()), one_line(&file.path)?);
    }
    Some(text)
}

fn one_line(path: &Path) -> Option<&str> {
    path.to_str().filter(|path| !path.contains('\n'))
}

/// Names the request, and the very program that carries it out: versions alone do not tell builds of it apart.
fn head(request: &Request, output: &Path) -> String {
    let program = std::env::current_exe().and_then(std::fs::metadata).map(|about| {
        let built = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        (about.len(), built)
    });
    let asked = format!("{request:?} {output:?} {:?}", program.ok());
    format!("umbrage {} {:016x}", env!("CARGO_PKG_VERSION"), fnv1a(asked.bytes()))
}

/// Of a file, what is in it; of a directory, the names of the tables in it.
fn hash_of(path: &Path) -> Option<String> {
    let hash = match path.is_dir() {
        true => {
            let names = find_tables(path).unwrap_or_default();
            fnv1a(names.iter().flat_map(|name| name.as_os_str().as_encoded_bytes().iter().copied().chain([0])))
        }
        false => fnv1a(file::read_bytes(path, MAX_BYTES).ok()?),
    };
    Some(format!("{hash:016x}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_changes_makes_a_stamp_stale() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let at = |name: &str| place.path().join(name);
        let write = |name: &str, text: &str| std::fs::write(at(name), text).unwrap_or_else(|e| panic!("{e}"));
        std::fs::create_dir(at("tables")).unwrap_or_else(|e| panic!("{e}"));
        write("tables/a.ron", "a");
        write("out.wgsl", "made");
        let request = Request { paths: vec![at("tables")], ..Request::default() };
        let inputs = BTreeSet::from([at("tables"), at("tables/a.ron")]);
        let files = [Artifact { path: "out.wgsl".into(), contents: b"made".to_vec() }];
        let warnings = ["beware".to_owned()];
        leave(place.path(), &request, place.path(), &warnings, &inputs, &files);
        let fresh = |request: &Request| fresh(place.path(), request, place.path());
        let expected = Fresh { warnings: warnings.to_vec(), inputs: inputs.into_iter().collect() };
        assert_eq!(fresh(&request), Some(expected));
        let other = Request { profiles: vec![at("p.ron")], ..request.clone() };
        assert_eq!(fresh(&other), None, "another request");
        for (name, changed, restored) in [("tables/a.ron", "b", "a"), ("out.wgsl", "edited", "made")] {
            write(name, changed);
            assert_eq!(fresh(&request), None, "{name}");
            write(name, restored);
            assert!(fresh(&request).is_some(), "{name}");
        }
        write("tables/b.ron", "");
        assert_eq!(fresh(&request), None, "another table");
    }
}
