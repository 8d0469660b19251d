//! glTF 2.0 and GLB → triangles.
//!
//! The nodes of one scene are walked, the default one or the first. What shapes a
//! surface is read; what it looks like is passed over; what would move it after
//! reading (skins, morphs) or hides it in an extension is refused by name.

mod accessor;
mod buffers;
mod document;

use std::path::Path;

use glam::{DMat4, DQuat, DVec3};

use self::accessor::{Accessors, Kind};
use self::document::{Document, Node, Primitive};
use super::{Assembly, Broken, Result, Triangle, no_faces};

/// The help against most mistakes.
const EXPORT: &str = "it was read as glTF; export the mesh again";

/// Extensions that say nothing about the shape of a surface, by how they begin.
const LOOKS: [&str; 8] = [
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_",
];

/// The extension by which coordinates are small integers.
const QUANTISED: &str = "KHR_mesh_quantization";

fn broken(what: impl Into<String>) -> Broken {
    Broken::new(what, EXPORT)
}

/// Looks an index up that stands in the file.
fn get<'d, T>(list: &'d [T], index: usize, what: &str) -> Result<&'d T> {
    list.get(index).ok_or_else(|| broken(format!("names {what} {index} of {}", list.len())))
}

/// Reads the triangles of a file that lies in a directory.
pub(super) fn read(bytes: &[u8], directory: &Path) -> Result<Vec<Triangle>> {
    let (json, blob) = buffers::split(bytes)?;
    let document: Document = serde_json::from_slice(json).map_err(|error| broken(format!("is broken: {error}")))?;
    check(&document)?;
    let buffers = buffers::read(&document, blob, directory)?;
    let mut accessors = Accessors::new(&document, &buffers);
    let mut triangles = Vec::new();
    for (node, place) in nodes(&document)? {
        let Some(mesh) = node.mesh else { continue };
        let mesh = get(&document.meshes, mesh, "mesh")?;
        if node.skin.is_some() {
            let what = "has a skin, whose joints move it";
            return Err(Broken::new(what, "apply the pose before you export it"));
        }
        if node.weights.as_ref().or(mesh.weights.as_ref()).is_some_and(|weights| weights.iter().any(|w| *w != 0.0)) {
            let what = "has a morph target that is not at rest";
            return Err(Broken::new(what, "apply the shape before you export it"));
        }
        for primitive in &mesh.primitives {
            triangles = self::primitive(primitive, place, &mut accessors, triangles)?;
        }
    }
    Ok(triangles)
}

/// Refuses what is of another version or needs an extension that is not read.
fn check(document: &Document) -> Result<()> {
    let asset = &document.asset;
    // What is written for a later 2.x can be read as 2.0, unless it says otherwise.
    let readable = asset.min_version.as_ref().map_or(asset.version.starts_with("2."), |needed| needed == "2.0");
    if !readable {
        let what = format!("is glTF {}", asset.version.escape_default());
        return Err(Broken::new(what, "export it as glTF 2.0"));
    }
    let known = |name: &str| name == QUANTISED || LOOKS.iter().any(|looks| name.starts_with(looks));
    if let Some(name) = document.extensions_required.iter().find(|name| !known(name)) {
        let what = format!("needs the extension `{}`, which is not read", name.escape_default());
        return Err(Broken::new(what, "export it without that extension"));
    }
    Ok(())
}

/// The nodes of the scene that is shown, with their places.
fn nodes(document: &Document) -> Result<Vec<(&Node, DMat4)>> {
    let Some(scene) = document.scene.or((!document.scenes.is_empty()).then_some(0)) else {
        return Err(Broken::new("has no scene, so that nothing of it is shown", EXPORT));
    };
    let roots = &get(&document.scenes, scene, "scene")?.nodes;
    let mut pending: Vec<(usize, DMat4)> = roots.iter().rev().map(|node| (*node, DMat4::IDENTITY)).collect();
    let mut seen = vec![false; document.nodes.len()];
    let mut found = Vec::new();
    while let Some((index, parent)) = pending.pop() {
        let node = get(&document.nodes, index, "node")?;
        if std::mem::replace(&mut seen[index], true) {
            return Err(broken(format!("shows node {index} in two places, where nodes have to form trees")));
        }
        let place = parent * transform(node);
        pending.extend(node.children.iter().rev().map(|child| (*child, place)));
        found.push((node, place));
    }
    Ok(found)
}

fn transform(node: &Node) -> DMat4 {
    match node.matrix {
        Some(matrix) => DMat4::from_cols_array(&matrix),
        None => DMat4::from_scale_rotation_translation(
            node.scale.map_or(DVec3::ONE, DVec3::from_array),
            node.rotation.map_or(DQuat::IDENTITY, DQuat::from_array),
            node.translation.map_or(DVec3::ZERO, DVec3::from_array),
        ),
    }
}

/// Adds the triangles of one part of a mesh.
fn primitive(
    primitive: &Primitive,
    place: DMat4,
    accessors: &mut Accessors<'_>,
    triangles: Vec<Triangle>,
) -> Result<Vec<Triangle>> {
    match primitive.mode {
        0 => return Err(no_faces("points")),
        1..=3 => return Err(no_faces("lines")),
        _ => {}
    }
    // Without places there is nothing to show, says the standard.
    let Some(positions) = primitive.attributes.get("POSITION") else { return Ok(triangles) };
    let positions = accessors.vectors(*positions, Kind::Position)?;
    let normals = match primitive.attributes.get("NORMAL") {
        Some(normals) => accessors.vectors(*normals, Kind::Normal)?,
        None => Vec::new(),
    };
    let indices = match primitive.indices {
        Some(indices) => accessors.indices(indices)?,
        None => (0..positions.len()).collect(),
    };
    let turn = place.inverse().transpose();
    let mut assembly = Assembly {
        positions: positions.into_iter().map(|at| place.transform_point3(at)).collect(),
        normals: normals.into_iter().map(|normal| turn.transform_vector3(normal)).collect(),
        triangles,
    };
    let mirrored = place.determinant() < 0.0;
    let mut add = |[a, b, c]: [usize; 3]| {
        let corners = if mirrored { [a, c, b] } else { [a, b, c] };
        assembly.triangle(corners.map(|index| (index, Some(index))))
    };
    match primitive.mode {
        4 if indices.len().is_multiple_of(3) => {
            indices.chunks_exact(3).try_for_each(|face| add([face[0], face[1], face[2]]))?;
        }
        4 => return Err(broken(format!("has triangles of {} corners in all", indices.len()))),
        // A strip turns around with each triangle.
        5 => indices.windows(3).enumerate().try_for_each(|(at, face)| match at % 2 {
            0 => add([face[0], face[1], face[2]]),
            _ => add([face[0], face[2], face[1]]),
        })?,
        6 => indices.windows(2).skip(1).try_for_each(|pair| add([pair[0], pair[1], indices[0]]))?,
        mode => return Err(broken(format!("has a part of mode {mode}, which does not exist"))),
    }
    Ok(assembly.triangles)
}
