//! The files that a file may name.
//!
//! A table imports tables, a scene names meshes, a mesh names buffers. Such a file
//! may have come from anybody, so that what it names lies in its own directory or
//! below, links followed; anything else is refused, unless this process was told
//! that its files are trusted. That is a property of the process, as its umask is:
//! said once, before anything is read, and not by each of the many ways to read.

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Set when files may name any other.
static OUTSIDE: AtomicBool = AtomicBool::new(false);

/// From now on, files that this process reads may name files outside of their own directories.
pub fn allow_outside() {
    OUTSIDE.store(true, Ordering::Relaxed);
}

/// A path out of reach, in words that follow a name, and what helps.
#[derive(Debug)]
pub(crate) struct OutOfReach;

impl OutOfReach {
    pub(crate) const WHAT: &str = "lies outside of the directory of the file that names it";
    pub(crate) const HELP: &str = "move it there, or say `--allow-outside` if you trust the file that names it";
}

/// The path of a file that another one names, which lies in a directory.
pub(crate) fn beside(directory: &Path, name: &str) -> Result<PathBuf, OutOfReach> {
    let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
    let path = plain(&directory.join(name));
    if OUTSIDE.load(Ordering::Relaxed) {
        return Ok(path);
    }
    // Of a file that is not there, the name alone decides.
    let inside = match (fs::canonicalize(&path), fs::canonicalize(directory)) {
        (Ok(path), Ok(directory)) => path.starts_with(directory),
        _ => path.starts_with(plain(directory)) && !path.starts_with(".."),
    };
    if inside { Ok(path) } else { Err(OutOfReach) }
}

/// A path without `.` and, as far as that is possible, without `..`.
pub(crate) fn plain(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            part => out.push(part),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_below_is_in_reach() {
        let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
        let inner = place.path().join("inner");
        let write = |path: PathBuf| fs::write(path, "").unwrap_or_else(|error| panic!("{error}"));
        fs::create_dir_all(inner.join("deep")).unwrap_or_else(|error| panic!("{error}"));
        write(place.path().join("other"));
        write(inner.join("deep/mine"));
        #[cfg(unix)]
        std::os::unix::fs::symlink("../other", inner.join("link")).unwrap_or_else(|error| panic!("{error}"));
        let other = place.path().join("other").to_string_lossy().into_owned();
        for (name, expected) in [
            ("deep/mine", true),
            ("deep/../deep/mine", true),
            ("../inner/deep/mine", true),
            ("missing", true),
            ("../other", false),
            ("../missing", false),
            ("deep/../../missing", false),
            (&*other, false),
            ("/dev/zero", false),
            ("link", cfg!(not(unix))),
        ] {
            assert_eq!(beside(&inner, name).is_ok(), expected, "{name}");
        }
        assert!(beside(Path::new(""), "../missing").is_err() && beside(Path::new(""), "missing").is_ok());
    }
}
