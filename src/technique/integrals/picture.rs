//! Pictures of a scene: by the tables, and by brute force.

use std::f64::consts::{PI, TAU};
use std::iter::repeat_n;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;

use super::cells::{Division, Edge, divide};
use super::tables::Interpreters;
use super::{Lobe, Settings, Surface, Surroundings, Tables};
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::Inputs;

/// Points whose edges are evaluated together.
const PORTION: usize = 2048;

/// The results for surfaces, one after the other.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Shaded {
    /// Light that is sent to the camera; `None` where nothing is hit.
    pub light: Vec<Option<DVec3>>,
    /// Cells with a visible part.
    pub cells: Vec<u32>,
    /// Edges that were integrated.
    pub edges: Vec<u32>,
}

impl Shaded {
    /// Adds what was computed for the next surface.
    pub(super) fn push(&mut self, light: Option<DVec3>, cells: u32, edges: u32) {
        self.light.push(light);
        self.cells.push(cells);
        self.edges.push(edges);
    }
}

impl Surface {
    /// The share that it sends on of the light that falls on it.
    pub(super) fn sent(&self, light: DVec3) -> DVec3 {
        light * self.albedo / PI
    }
}

/// Light at surfaces by the tables and their batch interpreter.
///
/// # Errors
/// If a table does not have the functions that it should.
pub fn shade(
    scene: &Surroundings,
    tables: &Tables,
    settings: &Settings,
    surfaces: &[Option<Surface>],
) -> Result<Shaded, Failure> {
    // A part for each thread, as every interpreter has to specialise the tables for itself.
    let part = surfaces.len().div_ceil(rayon::current_num_threads()).max(1);
    let shade_part = |surfaces: &[Option<Surface>]| -> Result<Shaded, Failure> {
        let mut interpreters = tables.interpreters();
        let mut shaded = Shaded::default();
        for portion in surfaces.chunks(PORTION) {
            shade_some(scene, tables, &mut interpreters, settings, portion, &mut shaded)?;
        }
        Ok(shaded)
    };
    let parts: Vec<Shaded> = surfaces.par_chunks(part).map(shade_part).collect::<Result<_, Failure>>()?;
    let mut all = Shaded::default();
    for part in parts {
        all.light.extend(part.light);
        all.cells.extend(part.cells);
        all.edges.extend(part.edges);
    }
    Ok(all)
}

/// Light, cells and edges of some surfaces.
fn shade_some(
    scene: &Surroundings,
    tables: &Tables,
    interpreters: &mut Interpreters<'_>,
    settings: &Settings,
    surfaces: &[Option<Surface>],
    shaded: &mut Shaded,
) -> Result<(), Failure> {
    let Divided { all, parts } = divided(scene, settings, surfaces);
    let lines = tables.lines(interpreters, &tables.line_inputs(&all.cells, &scene.lobes)?)?;
    let moments = tables.moments(interpreters, &tables.moment_inputs(&all.edges)?)?;
    for (surface, (cells, edges)) in surfaces.iter().zip(parts) {
        let light = surface.as_ref().map(|surface| {
            let mut sum = DVec3::ZERO;
            for (edge, moments) in all.edges[edges.clone()].iter().zip(&moments[edges.clone()]) {
                let (along, tensor) = (moments.first.dot(surface.normal), moments.times(surface.normal));
                for (index, lobe) in scene.lobes.iter().enumerate() {
                    let (alpha, beta) = lines[edge.cell * scene.lobes.len() + index];
                    sum += lobe.amplitude * (edge.sign * (alpha * along + beta * lobe.axis.dot(tensor)));
                }
            }
            surface.sent(sum)
        });
        shaded.push(light, cells.len() as u32, edges.len() as u32);
    }
    Ok(())
}

/// The divisions at some surfaces, in one list, so that each table is evaluated once.
struct Divided {
    all: Division,
    /// The cells and the edges of each surface.
    parts: Vec<(Range<usize>, Range<usize>)>,
}

fn divided(scene: &Surroundings, settings: &Settings, surfaces: &[Option<Surface>]) -> Divided {
    let division = |surface: &Option<Surface>| match surface {
        Some(surface) => divide(surface.normal, &scene.occluders(surface), &scene.lobes, settings),
        None => Division::default(),
    };
    let divisions: Vec<Division> = surfaces.par_iter().map(division).collect();
    let mut all = Division::default();
    let mut parts = Vec::with_capacity(surfaces.len());
    for division in divisions {
        let (first, first_edge) = (all.cells.len(), all.edges.len());
        all.edges.extend(division.edges.into_iter().map(|edge| Edge { cell: edge.cell + first, ..edge }));
        all.cells.extend(division.cells);
        parts.push((first..all.cells.len(), first_edge..all.edges.len()));
    }
    Divided { all, parts }
}

/// Most rows of a capture: about a hundred thousand pixels have as many edges.
const MAX_ROWS: usize = 1 << 24;

/// The inputs of each function at surfaces, one after the other.
///
/// # Errors
/// When there are too many for a capture.
pub(super) fn inputs<'p>(
    scene: &Surroundings,
    tables: &Tables,
    settings: &Settings,
    surfaces: &[Option<Surface>],
) -> Result<Vec<Inputs<'p>>, Failure> {
    let mut all = tables.nothing();
    let mut pixel = 0..;
    for portion in surfaces.chunks(PORTION) {
        let Divided { all: division, parts } = divided(scene, settings, portion);
        let lines = tables.line_inputs(&division.cells, &scene.lobes)?;
        let moments = tables.moment_inputs(&division.edges)?;
        let mut pixels = [Vec::new(), Vec::new()];
        for ((cells, edges), pixel) in parts.into_iter().zip(pixel.by_ref()) {
            pixels[0].extend(repeat_n(pixel, edges.len()));
            pixels[1].extend(repeat_n(pixel, cells.len() * scene.lobes.len()));
        }
        for (inputs, (columns, pixels)) in
            all.iter_mut().zip([(&moments, &pixels[0]), (&lines, &pixels[1]), (&lines, &pixels[1])])
        {
            inputs.columns.append(columns);
            inputs.pixels.extend(pixels);
            if inputs.pixels.len() > MAX_ROWS {
                let message = format!("`{}` is evaluated more than {MAX_ROWS} times", inputs.program.name);
                let error = Diagnostic::error(codes::RENDER, message);
                return Err(Failure::bare("", error.help("capture a smaller picture")));
            }
        }
    }
    Ok(all)
}

/// The light at a surface by a sum over these directions.
pub fn brute_force(scene: &Surroundings, surface: &Surface, directions: &[(DVec3, DVec3)]) -> DVec3 {
    let occluders = scene.occluders(surface);
    let hidden = occluders.hide();
    let sum: DVec3 = directions
        .iter()
        .map(|(direction, light)| {
            let cosine = surface.normal.dot(*direction);
            if cosine > 0.0 && !hidden(*direction) { *light * cosine } else { DVec3::ZERO }
        })
        .sum();
    surface.sent(sum)
}

/// Directions of equal solid angle with the light from each, times that solid angle.
pub fn directions(lobes: &[Lobe], fineness: u32) -> Vec<(DVec3, DVec3)> {
    let around = 2 * fineness;
    let solid = 4.0 * PI / f64::from(fineness * around);
    let direction = |i: u32| {
        let z = 1.0 - 2.0 * (f64::from(i / around) + 0.5) / f64::from(fineness);
        let phi = TAU * (f64::from(i % around) + 0.5) / f64::from(around);
        let flat = (1.0 - z * z).sqrt();
        let direction = DVec3::new(flat * libm::cos(phi), flat * libm::sin(phi), z);
        (direction, lobes.iter().map(|lobe| lobe.value(direction)).sum::<DVec3>() * solid)
    };
    (0..fineness * around).map(direction).collect()
}

#[cfg(test)]
mod tests {
    use super::super::surroundings::tests::studio;
    use super::*;
    use crate::scene::light::Gaussian;

    #[test]
    fn a_lobe_sends_as_much_light_as_its_light() {
        let light = Gaussian { tilts: [20.0, -30.0], deviations: [0.3, 0.3], rotation: 0.0, colour: [2.0, 1.0, 0.5] };
        let lobe = Lobe::of(&light).expect("equal deviations");
        let all: DVec3 = directions(&[lobe], 200).iter().map(|(_, light)| *light).sum();
        let expected = PI * DVec3::from_array(light.colour);
        assert!((all - expected).length() < 1e-3 * expected.length(), "{all} {expected}");
    }

    #[test]
    fn tables_and_brute_force_agree() {
        let (scene, surfaces) = studio(16, 9);
        let tables = Tables::new().unwrap_or_else(|e| panic!("{e}"));
        let settings = Settings::with_threshold(0.03);
        let shaded = shade(&scene, &tables, &settings, &surfaces).unwrap_or_else(|e| panic!("{e}"));
        let directions = directions(&scene.lobes, 160);
        let (mut error, mut whole) = (0.0, 0.0);
        for (surface, light) in surfaces.iter().zip(&shaded.light) {
            let (Some(surface), Some(light)) = (surface, light) else { continue };
            let exact = brute_force(&scene, surface, &directions);
            error += (*light - exact).length_squared();
            whole += exact.length_squared();
        }
        let relative = f64::sqrt(error / whole);
        assert!(relative < 0.02, "{relative}");
    }
}
