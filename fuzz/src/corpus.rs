//! Files to begin with: those of `corpus/`, and what the tests of the project read.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A kind of file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Family {
    Ron,
    Expression,
    Csv,
    Json,
    Capture,
    Profile,
    Tuned,
    Scene,
    Obj,
    Gltf,
    Glb,
}

impl Family {
    /// Every kind.
    pub(crate) const ALL: [Self; 11] = [
        Self::Ron,
        Self::Expression,
        Self::Csv,
        Self::Json,
        Self::Capture,
        Self::Profile,
        Self::Tuned,
        Self::Scene,
        Self::Obj,
        Self::Gltf,
        Self::Glb,
    ];

    /// Its directory in `corpus/`, and the end of its files' names.
    pub(crate) fn place(self) -> (&'static str, &'static str) {
        match self {
            Self::Ron => ("ron", "ron"),
            Self::Expression => ("expressions", "txt"),
            Self::Csv => ("csv", "csv"),
            Self::Json => ("json", "json"),
            Self::Capture => ("captures", "bin"),
            Self::Profile => ("profiles", "ron"),
            Self::Tuned => ("tuned", "ron"),
            Self::Scene => ("scenes", "ron"),
            Self::Obj => ("meshes", "obj"),
            Self::Gltf => ("meshes", "gltf"),
            Self::Glb => ("meshes", "glb"),
        }
    }

    /// Directories of the project with further ones.
    fn elsewhere(self) -> &'static [&'static str] {
        match self {
            Self::Ron => &["tables", "tests/tables/pass", "tests/tables/finding", "tests/tables/refused"],
            Self::Scene => &["scenes"],
            Self::Obj | Self::Gltf | Self::Glb => &["tests/meshes"],
            Self::Profile | Self::Tuned | Self::Expression | Self::Csv | Self::Json | Self::Capture => &[],
        }
    }
}

/// Largest file to begin with: what is made of larger ones is looked at too slowly.
const LARGEST: u64 = 40_000;

/// The directory of this package.
pub(crate) fn package() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The files of a kind, in the order of their names, those of `corpus/` first.
pub(crate) fn files(family: Family) -> &'static [Vec<u8>] {
    static ALL: OnceLock<BTreeMap<Family, Vec<Vec<u8>>>> = OnceLock::new();
    let all = ALL.get_or_init(|| Family::ALL.into_iter().map(|family| (family, read(family))).collect());
    all.get(&family).map_or(&[], Vec::as_slice)
}

/// The paths of the files of a kind.
pub(crate) fn paths(family: Family) -> Vec<PathBuf> {
    let (folder, ending) = family.place();
    let own = package().join("corpus").join(folder);
    let root = package().parent().unwrap_or(package());
    let mut all = Vec::new();
    for directory in std::iter::once(own).chain(family.elsewhere().iter().map(|place| root.join(place))) {
        let Ok(entries) = directory.read_dir() else { continue };
        let files = entries.flatten().map(|entry| entry.path());
        let mut files: Vec<PathBuf> = files.filter(|path| path.extension().is_some_and(|e| e == ending)).collect();
        files.sort();
        all.extend(files);
    }
    all
}

fn read(family: Family) -> Vec<Vec<u8>> {
    let small = |path: &PathBuf| path.metadata().is_ok_and(|data| data.len() <= LARGEST);
    paths(family).iter().filter(|path| small(path)).filter_map(|path| std::fs::read(path).ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_files_of_every_kind() {
        for family in Family::ALL {
            assert!(!files(family).is_empty(), "no file of {family:?} to begin with");
        }
    }
}
