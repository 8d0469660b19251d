//! Readings of every mesh in `tests/meshes`.
//!
//! `NAME.txt` beside a mesh is what becomes of it: its triangles, with their area and extent, or the refusal. A new mesh
//! needs no Rust: put it there, run this test with `INSTA_UPDATE=always`, and read what was written.

use std::path::{Path, PathBuf};

use super::*;

fn meshes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/meshes");
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{error}"));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension != "txt" && extension != "bin"));
    paths.sort();
    paths
}

/// The reading of a mesh, in words.
fn described(path: &Path) -> String {
    let triangles = match triangles(path) {
        Ok(triangles) => triangles,
        Err(broken) => return format!("refused: {}\n  help: {}\n", broken.what, broken.help),
    };
    let area = |t: &Triangle| (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]).length() / 2.0;
    let corners = || triangles.iter().flat_map(|triangle| triangle.corners);
    let (lo, hi) = (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max));
    let facing: DVec3 = triangles.iter().map(|t| t.normals[0] * area(t)).sum();
    format!(
        "triangles: {}\narea: {:.4}\nfrom {lo:.3} to {hi:.3}\nfacing: {facing:.3}\n",
        triangles.len(),
        triangles.iter().map(area).sum::<f64>()
    )
}

#[test]
fn meshes_are_read_whole_or_refused_by_name() {
    let update = std::env::var_os("INSTA_UPDATE").is_some_and(|update| update == "always");
    let mut wrong = String::new();
    for path in meshes() {
        let now = described(&path);
        let beside = PathBuf::from(format!("{}.txt", path.display()));
        if update {
            std::fs::write(&beside, now).unwrap_or_else(|error| panic!("{error}"));
        } else if std::fs::read_to_string(&beside).ok().as_ref() != Some(&now) {
            wrong += &format!("{}: now\n{now}", shown(&path));
        }
    }
    assert!(wrong.is_empty(), "{wrong}\nINSTA_UPDATE=always accepts that");
}

/// Every byte of every mesh changed, and every mesh cut off at every place: a mesh or a refusal, no panic.
#[test]
fn damaged_meshes_do_no_harm() {
    for path in meshes() {
        let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |bytes: &[u8]| match path.extension().is_some_and(|extension| extension == "obj") {
            true => obj::read(bytes).is_ok(),
            false => gltf::read(bytes, folder).is_ok(),
        };
        for at in 0..bytes.len() {
            read(&bytes[..at]);
            for new in [b'9', b'-', b'\n'] {
                let mut changed = bytes.clone();
                changed[at] = new;
                read(&changed);
            }
        }
    }
}
