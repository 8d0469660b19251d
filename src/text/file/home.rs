//! Files that appear together.
//!
//! A file system replaces one file at once, not several. So the set is written down
//! first, in a journal: its files are made under other names beside their places, the
//! journal is renamed, which is the moment that decides, and the files are renamed.
//! Whoever comes next to the same directory finds what a process left that was killed:
//! a journal that was begun, whose files it removes, or a complete one, whose files it
//! renames, except over a file that somebody has changed since. Only one process at a time does any of this: it holds a lock on the
//! directory, which ends with the process.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::UNIX_EPOCH;

use super::pending::{PendingFile, directory};
use super::{read_bytes, unwritable};
use crate::diag::Failure;

/// A journal of files that are being made.
const BEGUN: &str = ".umbrage-begun";

/// A journal of files that are complete.
const COMPLETE: &str = ".umbrage-complete";

/// Largest journal, in bytes.
const MAX_BYTES: u64 = 16 << 20;

/// A directory in which this process alone makes files appear.
pub(crate) struct Home {
    directory: PathBuf,
    /// Without one where the system has no locks for directories; files then are still complete, each by itself.
    _lock: Option<File>,
}

impl Home {
    /// Makes the directory if there is none, waits for it, and brings to its end what a process began there that
    /// was interrupted.
    pub(crate) fn lock(directory: &Path) -> Result<Self, Failure> {
        fs::create_dir_all(directory).map_err(|error| unwritable(directory, &error))?;
        let lock = File::open(directory).and_then(|file| file.lock().map(|()| file)).ok();
        let home = Self { directory: directory.to_owned(), _lock: lock };
        if let Some(set) = Set::read(&home.begun())? {
            set.remove();
            home.forget(&home.begun())?;
        }
        if let Some(set) = Set::read(&home.complete())? {
            set.resume()?;
            home.forget(&home.complete())?;
        }
        Ok(home)
    }

    /// Makes files visible, all or none. Devices and pipes are written before, because that may fail.
    pub(crate) fn commit(&self, files: Vec<PendingFile>) -> Result<(), Failure> {
        let (files, special): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| file.target().is_some());
        let targets: Vec<PathBuf> = files.iter().filter_map(|file| file.target().map(Path::to_owned)).collect();
        if targets.is_empty() {
            return special.into_iter().try_for_each(PendingFile::deliver);
        }
        let set = Set::new(targets);
        if let Err(failure) = self.stage(&set, files, special) {
            set.remove();
            // The failure says more than that of tidying up.
            let _ = self.forget(&self.begun());
            return Err(failure);
        }
        set.publish()?;
        self.forget(&self.complete())
    }

    fn stage(&self, set: &Set, files: Vec<PendingFile>, special: Vec<PendingFile>) -> Result<(), Failure> {
        let first = files.first().map(|file| file.path().to_owned()).unwrap_or_default();
        fs::write(self.begun(), set.journal()).map_err(|error| unwritable(&first, &error))?;
        for (file, staged) in files.into_iter().zip(set.staged()) {
            let path = file.path().to_owned();
            file.stage(&staged).map_err(|error| unwritable(&path, &error))?;
        }
        special.into_iter().try_for_each(PendingFile::deliver)?;
        fs::rename(self.begun(), self.complete()).map_err(|error| unwritable(&self.directory, &error))
    }

    fn begun(&self) -> PathBuf {
        self.directory.join(BEGUN)
    }

    fn complete(&self) -> PathBuf {
        self.directory.join(COMPLETE)
    }

    fn forget(&self, journal: &Path) -> Result<(), Failure> {
        fs::remove_file(journal).map_err(|error| unwritable(&self.directory, &error))
    }
}

/// Brings to its end what was interrupted in a directory whose files are about to be read and replaced.
#[cfg(feature = "cli")]
pub(crate) fn settle(directory: &Path) -> Result<(), Failure> {
    Home::lock(directory).map(drop)
}

/// Makes files visible, all or none, each beside the others or elsewhere.
pub(crate) fn commit(files: Vec<PendingFile>) -> Result<(), Failure> {
    match files.iter().find_map(|file| file.target()).map(|target| directory(target).to_owned()) {
        Some(directory) => Home::lock(&directory)?.commit(files),
        None => files.into_iter().try_for_each(PendingFile::deliver),
    }
}

/// Files that appear together.
///
/// The names under which they are made follow from a number: whatever a journal says, nothing is removed or moved
/// that is not named like this.
struct Set {
    number: String,
    targets: Vec<PathBuf>,
    /// The state of each place before, as [`stamp`] tells it.
    replaced: Vec<Vec<u8>>,
}

/// Tells the states of a file apart, without reading it: its size and the time of its last change; nothing for none.
fn stamp(path: &Path) -> Vec<u8> {
    let Ok(metadata) = fs::metadata(path) else { return Vec::new() };
    let time = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok()).unwrap_or_default();
    format!("{} {}", metadata.len(), time.as_nanos()).into_bytes()
}

impl Set {
    fn new(targets: Vec<PathBuf>) -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let number = format!("{}-{}", std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let replaced = targets.iter().map(|target| stamp(target)).collect();
        Self { number, targets, replaced }
    }

    /// The set of a journal, if there is one.
    fn read(journal: &Path) -> Result<Option<Self>, Failure> {
        if fs::symlink_metadata(journal).is_err() {
            return Ok(None);
        }
        let bytes = read_bytes(journal, MAX_BYTES)?;
        let mut parts = bytes.split(|byte| *byte == 0);
        // What stands behind the last zero was not written to its end.
        parts.next_back();
        let number = parts.next().map_or(String::new(), |number| String::from_utf8_lossy(number).into_owned());
        let digits = number.bytes().all(|byte| byte.is_ascii_digit() || byte == b'-');
        let mut set = Self { number, targets: Vec::new(), replaced: Vec::new() };
        while let (true, Some(target), Some(replaced)) = (digits, parts.next(), parts.next()) {
            set.targets.push(to_path(target));
            set.replaced.push(replaced.to_vec());
        }
        Ok(Some(set))
    }

    fn journal(&self) -> Vec<u8> {
        let mut bytes = self.number.clone().into_bytes();
        for (target, replaced) in self.targets.iter().zip(&self.replaced) {
            for part in [&to_bytes(target), replaced] {
                bytes.push(0);
                bytes.extend(part);
            }
        }
        bytes.push(0);
        bytes
    }

    /// The names under which the files are made.
    fn staged(&self) -> impl Iterator<Item = PathBuf> {
        let name =
            |(index, target): (usize, &PathBuf)| directory(target).join(format!(".umbrage-{}-{index}", self.number));
        self.targets.iter().enumerate().map(name)
    }

    /// Removes what was made.
    fn remove(&self) {
        // Those that were not reached are not there.
        self.staged().for_each(|staged| drop(fs::remove_file(staged)));
    }

    /// Puts the files into their places that another process did not get to. What was written there in the
    /// meantime is newer, and stays.
    fn resume(&self) -> Result<(), Failure> {
        for ((staged, target), replaced) in self.staged().zip(&self.targets).zip(&self.replaced) {
            if stamp(target) != *replaced {
                drop(fs::remove_file(staged));
            }
        }
        self.publish()
    }

    /// Puts all files into their places; those that are there already are passed over.
    fn publish(&self) -> Result<(), Failure> {
        let mut failed = None;
        for (staged, target) in self.staged().zip(&self.targets) {
            match fs::rename(&staged, target) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    drop(fs::remove_file(staged));
                    failed.get_or_insert_with(|| unwritable(target, &error));
                }
                _ => {}
            }
        }
        failed.map_or(Ok(()), Err)
    }
}

#[cfg(unix)]
fn to_bytes(path: &Path) -> Vec<u8> {
    std::os::unix::ffi::OsStrExt::as_bytes(path.as_os_str()).to_vec()
}

#[cfg(unix)]
fn to_path(bytes: &[u8]) -> PathBuf {
    PathBuf::from(<std::ffi::OsStr as std::os::unix::ffi::OsStrExt>::from_bytes(bytes))
}

#[cfg(not(unix))]
fn to_bytes(path: &Path) -> Vec<u8> {
    path.to_string_lossy().into_owned().into_bytes()
}

#[cfg(not(unix))]
fn to_path(bytes: &[u8]) -> PathBuf {
    PathBuf::from(String::from_utf8_lossy(bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(place: &Path) -> Vec<String> {
        let entries = fs::read_dir(place).unwrap_or_else(|error| panic!("{error}"));
        let mut names: Vec<_> = entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// A process that is killed anywhere between the first and the last step leaves nothing half done.
    #[test]
    fn whatever_was_begun_comes_to_its_end() {
        for (journal, made, expected) in [
            (BEGUN, 0, "old"),
            (BEGUN, 1, "old"),
            (BEGUN, 2, "old"),
            (COMPLETE, 2, "new"),
            (COMPLETE, 1, "new"),
            (COMPLETE, 0, "new"),
        ] {
            let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
            let write = |path: &Path, text: &str| fs::write(path, text).unwrap_or_else(|error| panic!("{error}"));
            let targets = [place.path().join("a"), place.path().join("b")];
            // A complete set whose first files are in their places already.
            let done = if journal == COMPLETE { 2 - made } else { 0 };
            targets.iter().for_each(|target| write(target, "old"));
            let set = Set::new(targets.to_vec());
            targets.iter().take(done).for_each(|target| write(target, "new"));
            write(&place.path().join(journal), &String::from_utf8_lossy(&set.journal()));
            set.staged().skip(done).take(made).for_each(|staged| write(&staged, "new"));
            Home::lock(place.path()).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(names(place.path()), ["a", "b"], "{journal}, {made} made");
            for target in &targets {
                assert_eq!(fs::read_to_string(target).unwrap_or_default(), expected, "{journal}, {made} made");
            }
        }
    }

    /// An interrupted set comes to its end without replacing files that were written in the meantime.
    #[test]
    fn newer_files_stay() {
        let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
        let write = |path: &Path, text: &str| fs::write(path, text).unwrap_or_else(|error| panic!("{error}"));
        let targets = ["absent", "edited", "left"].map(|name| place.path().join(name));
        targets[1..].iter().for_each(|target| write(target, "old"));
        let set = Set::new(targets.to_vec());
        write(&place.path().join(COMPLETE), &String::from_utf8_lossy(&set.journal()));
        set.staged().for_each(|staged| write(&staged, "new"));
        write(&targets[1], "by hand");
        Home::lock(place.path()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(names(place.path()), ["absent", "edited", "left"]);
        let texts = targets.map(|target| fs::read_to_string(target).unwrap_or_default());
        assert_eq!(texts, ["new", "by hand", "new"]);
    }

    /// A journal that is not ours moves and removes nothing.
    #[test]
    fn a_foreign_journal_does_no_harm() {
        let place = tempfile::tempdir().unwrap_or_else(|error| panic!("{error}"));
        let write = |name: &str, text: &str| {
            fs::write(place.path().join(name), text).unwrap_or_else(|error| panic!("{error}"));
        };
        write("mine", "kept");
        write(COMPLETE, &format!("../mine\0{}\0\0", place.path().join("mine").display()));
        write(BEGUN, "1-0\0cut off");
        Home::lock(place.path()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(names(place.path()), ["mine"]);
        assert_eq!(fs::read_to_string(place.path().join("mine")).unwrap_or_default(), "kept");
    }
}
