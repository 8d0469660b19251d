//! What a frame contributes to a profile: how often each state of the table occurs in it.

#[cfg(feature = "gpu")]
use super::revectorise::Visibility;
use super::revectorise::cpu;
use super::revectorise::cpu::Frame;
#[cfg(feature = "gpu")]
use super::revectorise::gpu::{GpuFrame, Output, Shader, Skeleton};
use super::revectorise::{Settings, Technique};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
#[cfg(feature = "gpu")]
use crate::gpu::Gpu;
#[cfg(feature = "gpu")]
use crate::plan::{Plan, Shape};
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
    let pixels = frame.receivers.points.len();
    let (mut states, mut cases) = (vec![None; pixels], vec![None; pixels]);
    for (row, pixel) in found.pixels.iter().enumerate() {
        let pixel = *pixel as usize;
        states[pixel] = Some(program.states.index(|input| found.columns.levels(input)[row]));
        cases[pixel] = results.row(row).map(|row| program.rows[row].id);
    }
    Ok(contribution(scene, technique, frame, &states, &cases))
}

/// The same from the counters of a GPU. Cases and tiles come from the record that another
/// pass makes of each pixel; the two must agree on every state.
///
/// # Errors
/// When the program is not the table that the technique needs, or the device fails.
#[cfg(feature = "gpu")]
pub fn count_on(
    gpu: &Gpu,
    program: &Program,
    scene: &str,
    technique: Technique,
    frame: Frame<'_>,
) -> Result<profile::Scene, Failure> {
    // What rpcf filters is what rsmss gives, and a profile counts one evaluation per pixel.
    let evaluated = if technique == Technique::Rpcf { Technique::Rsmss } else { technique };
    let proved = Plan::proved(program, Shape::Ladder)?;
    let on_device = GpuFrame::new(gpu, frame.map, frame.receivers)?;
    let shader = |output| Shader::new(gpu, evaluated, Some(&proved), Skeleton::EXACT, output);
    let counts = shader(Output::Count)?.counts(&on_device, frame.settings)?;
    let (seen, _) = shader(Output::Record)?.record(&on_device, frame.settings)?;
    let states: Vec<_> =
        seen.state.iter().map(|state| (*state != Visibility::NONE).then_some(*state as usize)).collect();
    let cases: Vec<_> = seen.case.iter().map(|case| (*case < Visibility::DEFAULT).then_some(*case)).collect();
    let counted = contribution(scene, technique, frame, &states, &cases);
    let occurring = counts.iter().copied().enumerate().filter(|(_, count)| *count > 0);
    if !occurring.eq(counted.states.iter().map(|(state, count)| (*state, *count))) {
        let message = format!("counts other states of `{}` than it takes", program.name);
        let error = Diagnostic::error(codes::DEVICE, message).help("count with `--backend cpu`, or update the driver");
        return Err(Failure::bare(gpu.name(), error));
    }
    Ok(counted)
}

/// What a scene contributes, given the state and the case of every pixel.
fn contribution(
    scene: &str,
    technique: Technique,
    frame: Frame<'_>,
    states: &[Option<usize>],
    cases: &[Option<u32>],
) -> profile::Scene {
    let (width, height) = (frame.receivers.width as usize, frame.receivers.height);
    let Settings { search_limit, .. } = frame.settings;
    let setting = format!("{width}x{height}, map {}, search limit {search_limit}", frame.map.size);
    profile::Scene::of_frame(scene, technique.name(), &setting, profile::Frame { width, states, cases })
}
