//! Occluders as JSON → those of the technique.

use glam::DVec3;
use serde_json::value::RawValue;

use super::values::{Mistake, Read, entries, faulty, items, polygon, vector};
use crate::scene::flat::Fault;
use crate::technique::area::Occluder;
use crate::technique::area::mesh::Mesh;

const KINDS: &str = "occluders are {\"type\": \"polygon\", \"v\": [...]}, {\"type\": \"box\", \"center\": [x,y,z], \
                     \"axes\": [three half axes]} and {\"type\": \"mesh\", \"v\": [...], \"f\": [[i,j,k], ...]}";

/// Largest cosine between two half axes of a box that counts as a right angle.
const SKEW: f64 = 1e-6;

/// Reads an occluder.
pub(super) fn occluder<'s>(raw: &'s RawValue) -> Read<'s, Occluder> {
    let [kind, corners, faces, centre, axes] =
        entries(raw, "an occluder", ["type", "v", "f", "center", "axes"]).map_err(|mistake| mistake.help(KINDS))?;
    let kind = kind.ok_or_else(|| Mistake::new(raw, "the occluder has no `type`").help(KINDS))?;
    let name: String = serde_json::from_str(kind.get()).unwrap_or_default();
    let given = |value: Option<&'s RawValue>, field: &str| {
        value.ok_or_else(|| Mistake::new(raw, format!("the {name} has no `{field}`")).help(KINDS))
    };
    let none = |values: [(Option<&'s RawValue>, &str); 2]| match values.into_iter().find_map(|(v, n)| Some((v?, n))) {
        Some((value, field)) => Err(Mistake::new(value, format!("a {name} has no `{field}`")).help(KINDS)),
        None => Ok(()),
    };
    match name.as_str() {
        "polygon" => {
            none([(centre, "center"), (axes, "axes")])?;
            none([(faces, "f"), (None, "")])?;
            flat(given(corners, "v")?)
        }
        "box" => {
            none([(corners, "v"), (faces, "f")])?;
            block(given(centre, "center")?, given(axes, "axes")?)
        }
        "mesh" => {
            none([(centre, "center"), (axes, "axes")])?;
            mesh(given(corners, "v")?, given(faces, "f")?)
        }
        _ => Err(Mistake::new(kind, "there is no such occluder").help(KINDS)),
    }
}

fn flat<'s>(raw: &'s RawValue) -> Read<'s, Occluder> {
    match polygon(raw, "the polygon")? {
        Ok(corners) => Ok(Occluder::polygon(corners)),
        // Cut into triangles.
        Err(Fault::Convex(..)) => {
            let corners: Vec<DVec3> =
                items(raw, "the polygon")?.iter().map(|at| vector(at, "a corner")).collect::<Read<'s, _>>()?;
            let face = (0..corners.len()).collect();
            Ok(Occluder::mesh(Mesh::new(corners, &[face])))
        }
        Err(fault) => Err(faulty(raw, "the polygon", fault)),
    }
}

fn block<'s>(centre: &'s RawValue, axes: &'s RawValue) -> Read<'s, Occluder> {
    let centre = vector(centre, "`center`")?;
    let halves = items(axes, "`axes`")?.iter().map(|axis| vector(axis, "a half axis")).collect::<Read<'s, Vec<_>>>()?;
    let halves: [DVec3; 3] = halves.try_into().map_err(|_| Mistake::new(axes, "a box has three half axes"))?;
    let skewed = |a: DVec3, b: DVec3| a.dot(b).abs() > SKEW * a.length() * b.length();
    if skewed(halves[0], halves[1]) || skewed(halves[1], halves[2]) || skewed(halves[2], halves[0]) {
        let mistake = Mistake::new(axes, "the half axes of the box are not at right angles");
        return Err(mistake.help("give a skewed box as a mesh"));
    }
    Ok(Occluder::block(centre, halves))
}

fn mesh<'s>(corners: &'s RawValue, faces: &'s RawValue) -> Read<'s, Occluder> {
    let corners: Vec<DVec3> =
        items(corners, "`v`")?.iter().map(|at| vector(at, "a corner")).collect::<Read<'s, _>>()?;
    let face = |raw: &&'s RawValue| -> Read<'s, Vec<usize>> {
        let expected = || Mistake::new(raw, "a face is an array of three or more numbers of corners, counted from 0");
        let face: Vec<usize> = serde_json::from_str(raw.get()).map_err(|_| expected())?;
        if face.len() < 3 {
            return Err(expected());
        }
        match face.iter().find(|corner| **corner >= corners.len()) {
            Some(corner) => {
                let message = format!("there is no corner {corner}: the mesh has {}", corners.len());
                Err(Mistake::new(raw, message).help("corners are counted from 0"))
            }
            None => Ok(face),
        }
    };
    let faces: Vec<Vec<usize>> = items(faces, "`f`")?.iter().map(face).collect::<Read<'s, _>>()?;
    Ok(Occluder::mesh(Mesh::new(corners, &faces)))
}
