//! Meshes of the user's: Wavefront OBJ, glTF and GLB.
//!
//! Only triangles and normals are of interest here. A file is read whole or refused
//! with the reason: half a mesh would look like a mesh. What is read is checked: a
//! renderer in which a NaN or an empty mesh turns up has no good way to say so.
//! Both readers are ours, because those that there are index what a file names
//! before they look whether it is there.

mod gltf;
mod obj;
mod polygon;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::shapes::solid::Triangle;
use crate::diag::{Diagnostic, codes};
use crate::text::file::{read_bytes, shown};
use crate::text::reach::{OutOfReach, beside};

/// Most triangles of a mesh.
const MAX_TRIANGLES: usize = 20_000_000;

/// Largest accepted file, with the buffers that it names, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Largest coordinate: areas of what lies further out are not finite.
const FAR: f64 = 1e38;

/// A mistake in a mesh, in words that follow the mesh's name, and how to mend it.
#[derive(Debug)]
struct Broken {
    what: String,
    help: String,
}

type Result<T> = std::result::Result<T, Broken>;

impl Broken {
    fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self { what: what.into(), help: help.into() }
    }
}

/// Reads a mesh that a scene in a directory names. Its kind is told by the file's name.
pub(super) fn read(directory: &Path, name: &str) -> std::result::Result<Vec<Triangle>, Diagnostic> {
    let path = named(directory, name);
    path.and_then(|path| triangles(&path)).map_err(|broken| {
        let shown = shown(&directory.join(name));
        Diagnostic::error(codes::MESH, format!("the mesh `{shown}` {}", broken.what)).help(broken.help)
    })
}

/// The path of a file that a scene or mesh in a directory names.
fn named(directory: &Path, name: &str) -> Result<PathBuf> {
    beside(directory, name).map_err(|OutOfReach| Broken::new(OutOfReach::WHAT, OutOfReach::HELP))
}

fn triangles(path: &Path) -> Result<Vec<Triangle>> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let read = match extension.as_deref() {
        Some("obj") => obj::read(&bytes(path, MAX_BYTES)?)?,
        Some("gltf" | "glb") => gltf::read(&bytes(path, MAX_BYTES)?, path.parent().unwrap_or(Path::new("")))?,
        _ => return Err(Broken::new("is no mesh that can be read", "meshes are files named *.obj, *.gltf or *.glb")),
    };
    if read.is_empty() {
        return Err(Broken::new("contains no triangles", "triangles without area cast no shadow"));
    }
    Ok(read)
}

fn bytes(path: &Path, most: u64) -> Result<Vec<u8>> {
    read_bytes(path, most).map_err(|failure| {
        let reason = failure.diagnostics.first().map_or(String::new(), |diagnostic| diagnostic.message.clone());
        Broken::new(reason, "paths in a scene or mesh are relative to the file that names them")
    })
}

/// The refusal of parts that are not made of faces.
fn no_faces(what: &str) -> Broken {
    Broken::new(format!("has {what}, which have no area"), format!("export its faces without the {what}"))
}

/// Corners with their normals, and the triangles made of them so far.
struct Assembly {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<Triangle>,
}

/// A corner of a face: the indices of its place and of its normal.
type Corner = (usize, Option<usize>);

impl Assembly {
    /// The place of a corner.
    fn place(&self, (index, _): Corner) -> Result<DVec3> {
        let count = self.positions.len();
        let missing = || Broken::new(format!("uses vertex {} of {count}", index + 1), "export the mesh again");
        let place = self.positions.get(index).copied().ok_or_else(missing)?;
        if !place.is_finite() {
            let what = format!("has a vertex that is not finite: number {}", index + 1);
            return Err(Broken::new(what, "export the mesh again; a coordinate is NaN or infinite"));
        }
        if place.abs().max_element() > FAR {
            let what = format!("has a vertex further out than {FAR:e}: number {}", index + 1);
            return Err(Broken::new(what, "scale the mesh down"));
        }
        Ok(place)
    }

    /// Adds a triangle, unless it has no area.
    fn triangle(&mut self, corners: [Corner; 3]) -> Result<()> {
        let [a, b, c] = corners;
        let mut triangle = Triangle::flat([self.place(a)?, self.place(b)?, self.place(c)?]);
        if triangle.normals[0] == DVec3::ZERO {
            return Ok(());
        }
        for (normal, (_, index)) in triangle.normals.iter_mut().zip(corners) {
            let given = index.and_then(|index| self.normals.get(index)).filter(|n| n.is_finite());
            *normal = given.map_or(*normal, |given| given.normalize_or(*normal));
        }
        if self.triangles.len() == MAX_TRIANGLES {
            return Err(Broken::new(format!("has more than {MAX_TRIANGLES} triangles"), "simplify it"));
        }
        self.triangles.push(triangle);
        Ok(())
    }
}
