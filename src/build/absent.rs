//! Directories that are not there, as Cargo can watch them.
//!
//! Cargo takes a path that does not exist for one that has changed, and then runs the build
//! script, and compiles the crate, every time. But it follows links, and passes over those
//! that lead nowhere. So a directory in `OUT_DIR` holds a link to each place that is empty;
//! once something is made there, it is younger than the last run. The links themselves have
//! to be older than that run, and are given an old time.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// Links to places where nothing is, from a directory, which is the one to watch; none, if there is no such place.
///
/// # Errors
/// When the system has no such links, or refuses them.
pub(super) fn links(directory: &Path, absent: &BTreeSet<PathBuf>) -> io::Result<Option<PathBuf>> {
    let wanted = absent.iter().map(std::path::absolute).collect::<io::Result<BTreeSet<PathBuf>>>()?;
    let found = std::fs::read_dir(directory).into_iter().flatten().flatten();
    let found: BTreeSet<PathBuf> = found.filter_map(|entry| std::fs::read_link(entry.path()).ok()).collect();
    if wanted != found {
        match std::fs::remove_dir_all(directory) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        if !wanted.is_empty() {
            std::fs::create_dir_all(directory)?;
            make(directory, &wanted)?;
        }
    }
    Ok((!wanted.is_empty()).then(|| directory.to_owned()))
}

#[cfg(unix)]
fn make(directory: &Path, places: &BTreeSet<PathBuf>) -> io::Result<()> {
    use rustix::fs::{AtFlags, CWD, Timespec, Timestamps, utimensat};
    let old = Timespec { tv_sec: 1, tv_nsec: 0 };
    let old = Timestamps { last_access: old, last_modification: old };
    for (number, place) in places.iter().enumerate() {
        let link = directory.join(number.to_string());
        std::os::unix::fs::symlink(place, &link)?;
        utimensat(CWD, &link, &old, AtFlags::SYMLINK_NOFOLLOW)?;
    }
    Ok(utimensat(CWD, directory, &old, AtFlags::empty())?)
}

#[cfg(not(unix))]
fn make(_: &Path, _: &BTreeSet<PathBuf>) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, unix))]
mod tests {
    use std::time::{Duration, UNIX_EPOCH};

    use super::*;

    #[test]
    fn links_are_old_and_lead_to_what_is_made() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let at = |name: &str| place.path().join(name);
        let of = |names: &[&str]| links(&at("watched"), &names.iter().map(|name| at(name)).collect()).expect("made");
        assert_eq!(of(&[]), None);
        for _ in 0..2 {
            assert_eq!(of(&["profiles", "tuned"]), Some(at("watched")));
            for path in [at("watched"), at("watched/0"), at("watched/1")] {
                let time = path.symlink_metadata().and_then(|about| about.modified()).expect("there");
                assert_eq!(time, UNIX_EPOCH + Duration::from_secs(1), "{path:?}");
            }
        }
        std::fs::create_dir(at("tuned")).expect("made");
        assert!(at("watched/1").is_dir() && !at("watched/0").exists());
        assert_eq!(of(&["profiles"]), Some(at("watched")));
        assert!(at("watched/0").symlink_metadata().is_ok() && at("watched/1").symlink_metadata().is_err());
        assert_eq!(of(&[]), None);
        assert!(!at("watched").exists());
    }
}
