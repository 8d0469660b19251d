//! Waits until files change: what `umbrage build --watch` does between two runs.
//!
//! The files are looked at several times a second. A run names a dozen of them,
//! so this costs nothing, and unlike notifications of the operating system it
//! works alike on every platform and on network and container file systems.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Time between two looks.
const PAUSE: Duration = Duration::from_millis(100);

/// Deepest directory that is looked into.
const MAX_DEPTH: usize = 32;

/// Each file with what tells that it changed; files that do not exist have nothing.
type Files = BTreeMap<PathBuf, Option<(SystemTime, u64)>>;

/// Files and directories, as they were when last looked at.
pub(super) struct Watched {
    /// The files that are always looked at.
    always: BTreeSet<PathBuf>,
    /// Each of them, and each that the last run read, with the files in it.
    seen: BTreeMap<PathBuf, Files>,
}

impl Watched {
    /// Remembers how files are before anything reads them.
    pub(super) fn new(paths: impl IntoIterator<Item = PathBuf>) -> Self {
        let always: BTreeSet<PathBuf> = paths.into_iter().collect();
        Self { seen: look(&always), always }
    }

    /// After a run that has read these files, too: waits until one of them is not as it was before the run, and then
    /// until all of them rest.
    pub(super) fn wait(&mut self, read: &BTreeSet<PathBuf>) {
        let all: BTreeSet<PathBuf> = self.always.union(read).cloned().collect();
        let mut now = look(&all);
        // What changed while it was read is new; what was read for the first time is not.
        let before = now.iter().map(|(path, files)| (path.clone(), self.seen.get(path).unwrap_or(files).clone()));
        let before: BTreeMap<PathBuf, Files> = before.collect();
        while now == before {
            std::thread::sleep(PAUSE);
            now = look(&all);
        }
        // Programs that write several files, or one file in parts, get to finish.
        loop {
            std::thread::sleep(PAUSE);
            let next = look(&all);
            if next == now {
                break;
            }
            now = next;
        }
        self.seen = now;
    }
}

fn look(paths: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Files> {
    let files = |path: &PathBuf| {
        let mut files = Files::new();
        look_at(path, 0, &mut files);
        (path.clone(), files)
    };
    paths.iter().map(files).collect()
}

fn look_at(path: &Path, depth: usize, files: &mut Files) {
    let Ok(metadata) = path.metadata() else {
        files.insert(path.to_owned(), None);
        return;
    };
    if !metadata.is_dir() {
        files.insert(path.to_owned(), Some((metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH), metadata.len())));
        return;
    }
    for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
        let inner = entry.path();
        // Links to directories are not followed: they may form a circle.
        let directory = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if directory && depth < MAX_DEPTH || !directory && inner.extension().is_some_and(|e| e == "ron") {
            look_at(&inner, depth + 1, files);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_new_files_and_removals_are_seen() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let file = place.path().join("a.ron");
        let write = |text: &str| std::fs::write(&file, text).unwrap_or_else(|e| panic!("{e}"));
        write("1");
        let mut watched = Watched::new([place.path().to_owned()]);
        // Changed since it was looked at: no waiting.
        write("12");
        watched.wait(&BTreeSet::new());
        std::fs::write(place.path().join("b.ron"), "1").unwrap_or_else(|e| panic!("{e}"));
        watched.wait(&BTreeSet::new());
        std::fs::remove_file(&file).unwrap_or_else(|e| panic!("{e}"));
        watched.wait(&BTreeSet::from([file.clone()]));
        let all = look(&BTreeSet::from([place.path().to_owned(), file.clone()]));
        assert_eq!(all[place.path()].len(), 1);
        assert_eq!(all[&file][&file], None);
        let other = place.path().join("b.txt");
        std::fs::write(&other, "").unwrap_or_else(|e| panic!("{e}"));
        assert!(!look(&BTreeSet::from([place.path().to_owned()]))[place.path()].contains_key(&other), "only tables");
    }
}
