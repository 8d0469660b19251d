//! What a frame contributes to a profile: how often each state of the table occurs in it.

use super::cpu::{self, Frame};
use super::{Settings, Technique};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
use crate::profile;
use crate::program::Program;

/// Counts the evaluations of a technique's table in a frame, by state and by case.
///
/// # Errors
/// When the table asks for inputs that a shadow map does not have.
pub fn count(
    program: &Program,
    scene: &str,
    technique: Technique,
    frame: Frame<'_>,
) -> Result<profile::Scene, Failure> {
    let found = cpu::evaluations(program, frame)?;
    let results = Batch::<f32>::new(program).evaluate(&found.columns).map_err(|missing| {
        let input = &program.inputs[missing.input.index()].name;
        let message = format!("`{input}` is needed, but was not found by the search");
        let error = Diagnostic::error(codes::NEEDS_FETCH, message);
        Failure::new(program.source.clone(), error.help("please report this: what is needed is searched for"))
    })?;
    let (width, height) = (frame.receivers.width as usize, frame.receivers.height as usize);
    let mut states = vec![None; width * height];
    let mut cases = vec![None; width * height];
    for (row, pixel) in found.pixels.iter().enumerate() {
        let pixel = *pixel as usize;
        states[pixel] = Some(program.states.index(|input| found.columns.levels(input)[row]));
        cases[pixel] = results.row(row).map(|row| program.rows[row].id);
    }
    let Settings { search_limit, .. } = frame.settings;
    let setting = format!("{width}x{height}, map {}, search limit {search_limit}", frame.map.size);
    let pixels = profile::Frame { width, states: &states, cases: &cases };
    Ok(profile::Scene::of_frame(scene, technique.name(), &setting, pixels))
}
