//! The record of what a build script made last time, so that it need not make it again.
//!
//! Cargo runs a build script again for many reasons, most of which have nothing
//! to do with tables. A stamp, kept in `OUT_DIR` beside the generated files,
//! names everything that they were made from, what they were, and what would have
//! been read if it had been there. If all of it still is as it was, there is nothing
//! to do. If not, the stamp also tells what is not made any more.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::UNIX_EPOCH;

use super::{Artifact, Request, find_tables};
use crate::diag::fnv1a;
use crate::text::file;

/// Largest file that is looked at. What is larger counts as changed.
const MAX_BYTES: u64 = 256 << 20;

/// A stamp in `OUT_DIR`.
///
/// A build script may compile tables several times. Each time has a stamp of its own, so that one does not take away
/// what another one has made.
pub(super) struct Stamp {
    place: PathBuf,
    name: String,
}

/// The files of last time, which are as they would be made now.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Fresh {
    /// The warnings of that time.
    pub(super) warnings: Vec<String>,
    /// The files that it was made from.
    pub(super) inputs: Vec<PathBuf>,
    /// The directories that would have been read if they had been there.
    pub(super) absent: BTreeSet<PathBuf>,
}

/// The files of a run, and everything they depend on.
pub(super) struct Made<'a> {
    pub(super) request: &'a Request,
    pub(super) output: &'a Path,
    pub(super) warnings: &'a [String],
    pub(super) inputs: &'a BTreeSet<PathBuf>,
    pub(super) absent: &'a BTreeSet<PathBuf>,
    pub(super) files: &'a [Artifact],
}

/// The places of the stamps of this process, and the files that it has made or found to be right.
static PLACES: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
static MADE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

impl Stamp {
    /// The stamp of the next compilation in an `OUT_DIR`.
    pub(super) fn next(place: &Path) -> Self {
        let before = PLACES.lock().map_or(0, |mut places| {
            places.push(place.to_owned());
            places.iter().filter(|other| *other == place).count() - 1
        });
        let name = if before == 0 { "umbrage".to_owned() } else { format!("umbrage-{}", before + 1) };
        Self { place: place.to_owned(), name }
    }

    fn path(&self) -> PathBuf {
        self.place.join(&self.name).with_extension("stamp")
    }

    /// The directory in which Cargo is shown what is not there.
    pub(super) fn absent(&self) -> PathBuf {
        self.place.join(&self.name).with_extension("absent")
    }

    /// Finds the files that a request asks for, if they are there already.
    pub(super) fn fresh(&self, request: &Request, output: &Path) -> Option<Fresh> {
        let text = file::read_text(&self.path(), MAX_BYTES).ok()?;
        let mut lines = text.lines();
        if lines.next()? != head(request, output) {
            return None;
        }
        let mut fresh = Fresh { warnings: Vec::new(), inputs: Vec::new(), absent: BTreeSet::new() };
        let mut made = Vec::new();
        for line in lines {
            let (kind, rest) = line.split_once(' ')?;
            let hashed = || rest.split_once(' ').map(|(hash, path)| (hash, PathBuf::from(path)));
            match kind {
                "warning" => fresh.warnings.push(rest.to_owned()),
                "absent" if Path::new(rest).exists() => return None,
                "absent" => drop(fresh.absent.insert(PathBuf::from(rest))),
                "input" => {
                    let (hash, path) = hashed()?;
                    (hash_of(&path)? == hash).then_some(())?;
                    fresh.inputs.push(path);
                }
                "output" => {
                    let (hash, path) = hashed()?;
                    let path = output.join(path);
                    (hash_of(&path)? == hash).then_some(())?;
                    made.push(path);
                }
                // The place of the outputs is a part of the first line.
                _ => {}
            }
        }
        keep(made);
        Some(fresh)
    }

    /// Removes what was made last time and is not made any more, from where it was made and from among copies. What
    /// somebody has changed since stays. That this fails leaves a file that nobody asks for, and nothing else.
    pub(super) fn sweep(&self, made: &Made<'_>, copies: Option<&Path>) {
        keep(made.files.iter().map(|file| made.output.join(&file.path)));
        let Ok(text) = file::read_text(&self.path(), MAX_BYTES) else { return };
        let kept = MADE.lock().map_or(BTreeSet::new(), |made| made.clone());
        let Some(output) = text.lines().find_map(|line| line.strip_prefix("at ")).map(Path::new) else { return };
        let outputs = text.lines().filter_map(|line| line.strip_prefix("output ")?.split_once(' '));
        for (hash, name) in outputs.filter(|(_, name)| !kept.contains(&output.join(name))) {
            for path in [Some(output), copies].into_iter().flatten().map(|directory| directory.join(name)) {
                if hash_of(&path).as_deref() == Some(hash) && std::fs::remove_file(&path).is_ok() {
                    // A directory that is not empty stays.
                    drop(path.parent().map(std::fs::remove_dir));
                }
            }
        }
    }

    /// Leaves a stamp for the next time. That this fails costs time then, and nothing else.
    pub(super) fn leave(&self, made: &Made<'_>) {
        match made.text() {
            Some(text) => drop(file::write(&self.path(), text.as_bytes())),
            None => drop(std::fs::remove_file(self.path())),
        }
    }
}

/// Notes files that this process has made.
fn keep(files: impl IntoIterator<Item = PathBuf>) {
    if let Ok(mut made) = MADE.lock() {
        made.extend(files);
    }
}

impl Made<'_> {
    fn text(&self) -> Option<String> {
        let mut text = format!("{}\nat {}\n", head(self.request, self.output), one_line(self.output)?);
        for warning in self.warnings {
            let _ = writeln!(text, "warning {warning}");
        }
        for input in self.inputs {
            let _ = writeln!(text, "input {} {}", hash_of(input)?, one_line(input)?);
        }
        for directory in self.absent {
            let _ = writeln!(text, "absent {}", one_line(directory)?);
        }
        for file in self.files {
            let _ = writeln!(text, "output {:016x} {}", fnv1a(file.contents.iter().copied()), one_line(&file.path)?);
        }
        Some(text)
    }
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

    fn or_panic<T>(result: std::io::Result<T>) -> T {
        result.unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn whatever_changes_makes_a_stamp_stale() {
        let place = or_panic(tempfile::tempdir());
        let at = |name: &str| place.path().join(name);
        let write = |name: &str, text: &str| or_panic(std::fs::write(at(name), text));
        or_panic(std::fs::create_dir(at("tables")));
        write("tables/a.ron", "a");
        write("out.wgsl", "made");
        let request = Request { paths: vec![at("tables")], ..Request::default() };
        let inputs = BTreeSet::from([at("tables"), at("tables/a.ron")]);
        let absent = BTreeSet::from([at("profiles")]);
        let files = [Artifact { path: "out.wgsl".into(), contents: b"made".to_vec() }];
        let warnings = ["beware".to_owned()];
        let stamp = Stamp::next(place.path());
        stamp.leave(&Made {
            request: &request,
            output: place.path(),
            warnings: &warnings,
            inputs: &inputs,
            absent: &absent,
            files: &files,
        });
        let fresh = |request: &Request| stamp.fresh(request, place.path());
        let expected = Fresh { warnings: warnings.to_vec(), inputs: inputs.into_iter().collect(), absent };
        assert_eq!(fresh(&request), Some(expected));
        let other = Request { profiles: vec![at("p.ron")], ..request.clone() };
        assert_eq!(fresh(&other), None, "another request");
        for (name, changed, restored) in [("tables/a.ron", "b", "a"), ("out.wgsl", "edited", "made")] {
            write(name, changed);
            assert_eq!(fresh(&request), None, "{name}");
            write(name, restored);
            assert!(fresh(&request).is_some(), "{name}");
        }
        or_panic(std::fs::create_dir(at("profiles")));
        assert_eq!(fresh(&request), None, "what was not there");
        or_panic(std::fs::remove_dir(at("profiles")));
        assert!(fresh(&request).is_some());
        write("tables/b.ron", "");
        assert_eq!(fresh(&request), None, "another table");
    }

    /// Files that are not made any more go; those of another compilation of the script, and those that somebody has changed, stay.
    #[test]
    fn what_is_not_made_any_more_is_removed() {
        let (place, copies) = (or_panic(tempfile::tempdir()), or_panic(tempfile::tempdir()));
        let request = Request::default();
        let run = |stamp: &Stamp, names: &[&str]| {
            let file = |name: &&str| Artifact { path: PathBuf::from(name), contents: name.as_bytes().to_vec() };
            let files: Vec<Artifact> = names.iter().map(file).collect();
            for (directory, file) in
                [&place, &copies].into_iter().flat_map(|place| files.iter().map(move |f| (place, f)))
            {
                let path = directory.path().join(&file.path);
                or_panic(std::fs::create_dir_all(path.parent().unwrap_or(&path)));
                or_panic(std::fs::write(path, &file.contents));
            }
            let none = BTreeSet::new();
            let (output, files) = (place.path(), &*files);
            let made = Made { request: &request, output, warnings: &[], inputs: &none, absent: &none, files };
            stamp.sweep(&made, Some(copies.path()));
            stamp.leave(&made);
        };
        let (first, second) = (Stamp::next(place.path()), Stamp::next(place.path()));
        run(&first, &["a/tree.wgsl", "a/switch.wgsl", "b/tree.wgsl", "c/tree.wgsl"]);
        run(&second, &["d/tree.wgsl"]);
        or_panic(std::fs::write(place.path().join("c/tree.wgsl"), "by hand"));
        run(&first, &["a/switch.wgsl"]);
        let there = |name: &str| [&place, &copies].map(|place| place.path().join(name).exists());
        assert_eq!(there("a/switch.wgsl"), [true, true]);
        assert_eq!([there("b"), there("c"), there("d")], [[true, true]; 3], "made by this very process");
        // In a process that comes later.
        if let Ok(mut made) = MADE.lock() {
            made.retain(|path| !path.starts_with(place.path()));
        }
        or_panic(std::fs::remove_file(first.path()));
        run(&first, &["a/tree.wgsl", "a/switch.wgsl", "b/tree.wgsl", "c/tree.wgsl"]);
        or_panic(std::fs::write(place.path().join("c/tree.wgsl"), "by hand"));
        if let Ok(mut made) = MADE.lock() {
            made.retain(|path| !path.starts_with(place.path()));
        }
        run(&second, &["d/tree.wgsl"]);
        run(&first, &["a/switch.wgsl"]);
        assert_eq!([there("a/switch.wgsl"), there("d/tree.wgsl")], [[true, true]; 2]);
        assert_eq!([there("a/tree.wgsl"), there("b")], [[false, false]; 2]);
        assert_eq!(there("c/tree.wgsl"), [true, false], "changed by hand");
    }
}
