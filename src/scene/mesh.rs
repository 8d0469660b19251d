//! Meshes of the user's: Wavefront OBJ, glTF and GLB.
//!
//! Only triangles and normals are of interest here. What is read is checked:
//! a renderer in which a NaN or an empty mesh turns up has no good way to say so.

use std::path::Path;

use glam::{DMat4, DVec3};

use super::shapes::solid::Triangle;
use crate::diag::{Diagnostic, codes};
use crate::text::file::{io_reason, shown};

/// Most triangles of a mesh.
const MAX_TRIANGLES: usize = 20_000_000;

/// Reads a mesh. Its kind is told by the file's name.
pub(super) fn read(path: &Path) -> Result<Vec<Triangle>, Diagnostic> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    let triangles = match extension.as_deref() {
        Some("obj") => obj(path)?,
        Some("gltf" | "glb") => gltf(path)?,
        _ => {
            let error = broken(path, "is no mesh that can be read");
            return Err(error.help("meshes are files named *.obj, *.gltf or *.glb"));
        }
    };
    if triangles.is_empty() {
        return Err(
            broken(path, "contains no triangles").help("lines, points and triangles without area cast no shadow")
        );
    }
    if triangles.len() > MAX_TRIANGLES {
        return Err(broken(path, &format!("has more than {MAX_TRIANGLES} triangles")).help("simplify it"));
    }
    Ok(triangles)
}

fn broken(path: &Path, what: &str) -> Diagnostic {
    Diagnostic::error(codes::MESH, format!("the mesh `{}` {what}", shown(path)))
}

fn bytes(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    std::fs::read(path).map_err(|error| {
        broken(path, &format!("cannot be read: {}", io_reason(&error)))
            .help("paths in a scene are relative to the scene's file")
    })
}

/// Triangles from indexed corners. Those without area are left out.
fn assemble(
    path: &Path,
    positions: &[DVec3],
    normals: &[DVec3],
    corners: impl Iterator<Item = [(usize, Option<usize>); 3]>,
) -> Result<Vec<Triangle>, Diagnostic> {
    if let Some(index) = positions.iter().position(|position| !position.is_finite()) {
        let what = format!("has a vertex that is not finite: number {}", index + 1);
        return Err(broken(path, &what).help("export the mesh again; a coordinate is NaN or infinite"));
    }
    let mut triangles = Vec::new();
    for corner in corners {
        let mut places = [DVec3::ZERO; 3];
        for (place, (index, _)) in places.iter_mut().zip(corner) {
            *place = *positions
                .get(index)
                .ok_or_else(|| broken(path, &format!("uses vertex {} of {}", index + 1, positions.len())))?;
        }
        let mut triangle = Triangle::flat(places);
        if triangle.normals[0] == DVec3::ZERO {
            continue;
        }
        for (normal, (_, index)) in triangle.normals.iter_mut().zip(corner) {
            let given = index.and_then(|index| normals.get(index)).filter(|n| n.is_finite());
            *normal = given.map_or(*normal, |given| given.normalize_or(*normal));
        }
        triangles.push(triangle);
    }
    Ok(triangles)
}

fn obj(path: &Path) -> Result<Vec<Triangle>, Diagnostic> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_points: true, ignore_lines: true, ..Default::default() };
    let mut text = std::io::Cursor::new(bytes(path)?);
    // Materials are not used, and a missing one is no reason not to show a mesh.
    let (models, _) = tobj::load_obj_buf(&mut text, &options, |_| tobj::MTLLoadResult::Ok(Default::default()))
        .map_err(|error| {
            broken(path, &format!("is broken: {error}")).help("it was read as Wavefront OBJ; export the mesh again")
        })?;
    let mut triangles = Vec::new();
    for model in models {
        let mesh = model.mesh;
        let vector = |at: &[f32]| DVec3::new(f64::from(at[0]), f64::from(at[1]), f64::from(at[2]));
        let positions: Vec<DVec3> = mesh.positions.chunks_exact(3).map(vector).collect();
        let normals: Vec<DVec3> = mesh.normals.chunks_exact(3).map(vector).collect();
        let corner = |at: usize| (mesh.indices[at] as usize, mesh.normal_indices.get(at).map(|index| *index as usize));
        let corners = (0..mesh.indices.len() / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2].map(corner));
        triangles.extend(assemble(path, &positions, &normals, corners)?);
    }
    Ok(triangles)
}

fn gltf(path: &Path) -> Result<Vec<Triangle>, Diagnostic> {
    let broken_gltf = |what: &str| broken(path, what).help("it was read as glTF; export the mesh again");
    let gltf = gltf::Gltf::from_slice(&bytes(path)?).map_err(|error| broken_gltf(&format!("is broken: {error}")))?;
    for buffer in gltf.document.buffers() {
        if let gltf::buffer::Source::Uri(uri) = buffer.source()
            && uri.contains('%')
            && !uri.starts_with("data:")
        {
            // The reader cannot cope with every such name.
            return Err(broken_gltf(&format!("names a buffer `{uri}` with a percent sign")));
        }
    }
    let buffers = gltf::import_buffers(&gltf.document, path.parent(), gltf.blob)
        .map_err(|error| broken_gltf(&format!("lacks a buffer: {error}")))?;
    let scene = gltf.document.default_scene().or_else(|| gltf.document.scenes().next());
    let mut pending: Vec<(gltf::Node<'_>, DMat4, u32)> = Vec::new();
    pending.extend(scene.iter().flat_map(|scene| scene.nodes()).map(|node| (node, DMat4::IDENTITY, 0)));
    let mut triangles = Vec::new();
    while let Some((node, parent, depth)) = pending.pop() {
        if depth > 256 {
            return Err(broken_gltf("nests its nodes too deeply, or in a circle"));
        }
        let local = glam::Mat4::from_cols_array_2d(&node.transform().matrix()).as_dmat4();
        let place = parent * local;
        pending.extend(node.children().map(|child| (child, place, depth + 1)));
        for primitive in node.mesh().iter().flat_map(|mesh| mesh.primitives()) {
            if primitive.mode() != gltf::mesh::Mode::Triangles {
                continue;
            }
            let used = [
                primitive.get(&gltf::Semantic::Positions),
                primitive.get(&gltf::Semantic::Normals),
                primitive.indices(),
            ];
            if let Some(accessor) = used.into_iter().flatten().find(|accessor| !is_inside(accessor, &buffers)) {
                return Err(broken_gltf(&format!("has data outside its buffers (accessor {})", accessor.index())));
            }
            let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| data.0.as_slice()));
            let vector = |at: [f32; 3]| glam::Vec3::from_array(at).as_dvec3();
            let Some(read) = reader.read_positions() else { continue };
            let positions: Vec<DVec3> = read.map(|at| place.project_point3(vector(at))).collect();
            let turn = place.inverse().transpose();
            let normals: Vec<DVec3> = reader
                .read_normals()
                .map(|normals| normals.map(|n| turn.transform_vector3(vector(n))).collect())
                .unwrap_or_default();
            let indices: Vec<usize> = match reader.read_indices() {
                Some(indices) => indices.into_u32().map(|index| index as usize).collect(),
                None => (0..positions.len()).collect(),
            };
            let corners = indices.chunks_exact(3).map(|face| [face[0], face[1], face[2]].map(|i| (i, Some(i))));
            triangles.extend(assemble(path, &positions, &normals, corners)?);
            if triangles.len() > MAX_TRIANGLES {
                return Ok(triangles);
            }
        }
    }
    Ok(triangles)
}

/// Returns whether an accessor's data are there. The reader trusts the file in this.
fn is_inside(accessor: &gltf::Accessor<'_>, buffers: &[gltf::buffer::Data]) -> bool {
    let Some(view) = accessor.view() else { return false };
    let Some(buffer) = buffers.get(view.buffer().index()) else { return false };
    let end_of_view = view.offset().checked_add(view.length());
    let stride = view.stride().unwrap_or(accessor.size());
    let last = accessor.count().checked_sub(1).and_then(|last| last.checked_mul(stride));
    let end = last.and_then(|last| last.checked_add(accessor.offset())).and_then(|at| at.checked_add(accessor.size()));
    accessor.sparse().is_none()
        && stride >= accessor.size()
        && end.is_some_and(|end| end <= view.length())
        && end_of_view.is_some_and(|end| end <= buffer.0.len())
}
