//! Counting: how often each state of the table occurs in a frame, as a profile stores it.

use super::rendered::{CASE, DEFAULT, NONE, STATE};
use super::{Frame, Prepared, Technique};
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile;

/// Counts the evaluations of a technique's table in a frame, by state and by case.
///
/// Counters of the machine, if it has any, have to agree with the states of the pixels.
///
/// # Errors
/// When the technique evaluates no table of cases, the machine fails, or its counters disagree.
pub fn count<'s>(
    technique: &dyn Technique,
    frame: &Frame<'s>,
    prepared: &mut (dyn Prepared<'s> + 's),
    scene: &str,
) -> Result<profile::Scene, Failure> {
    let rendered = prepared.render(&|_| {})?;
    let (Some(states), Some(cases)) = (rendered.counts(STATE), rendered.counts(CASE)) else {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{technique}` evaluates no table of cases"));
        return Err(Failure::bare("", error));
    };
    let states: Vec<_> = states.iter().map(|state| (*state != NONE).then_some(*state as usize)).collect();
    let cases: Vec<_> = cases.iter().map(|case| (*case < DEFAULT).then_some(*case)).collect();
    let width = frame.surfaces.width as usize;
    let pixels = profile::Frame { width, states: &states, cases: &cases };
    let counted = profile::Scene::of_frame(scene, technique.name(), &frame.describe(&[technique]), pixels);
    if let Some(counts) = prepared.counts()? {
        let occurring = counts.iter().copied().enumerate().filter(|(_, count)| *count > 0);
        if !occurring.eq(counted.states.iter().map(|(state, count)| (*state, *count))) {
            let table = prepared.table().map_or("", |program| program.name.as_str());
            let message = format!("counts other states of `{table}` than it takes");
            let error =
                Diagnostic::error(codes::DEVICE, message).help("count with `--backend cpu`, or update the driver");
            return Err(Failure::bare(frame.on.describe(), error));
        }
    }
    Ok(counted)
}
