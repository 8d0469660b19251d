//! Counting what scenes need: they are rendered, and every evaluation of the table is counted.

use super::Count;
use crate::cli::args::Backend;
use crate::cli::messages::Report;
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::{Hits, Profile};
use crate::program::Program;
use crate::scene::Scene;
use crate::technique::count::count;
use crate::technique::{self, Ability, Frame, Prepared};

/// Renders scenes and counts.
pub(super) fn run(arguments: &Count, report: &Report) -> Result<(Program, Profile, Vec<Hits>), Failure> {
    let technique = arguments.technique;
    technique::require(technique, Ability::Cases, "profile --scene")?;
    let given = arguments.table.as_deref().map(Program::read).transpose()?;
    let mut scenes = Vec::new();
    for name in &arguments.scene {
        scenes.push((name, Scene::open(name)?));
    }
    let executor = arguments.machine.executor(Backend::Cpu, report)?;
    let settings = arguments.settings.read(&[technique], Some(arguments.shadow_map))?;
    let (mut counted, mut hits) = (Vec::new(), Vec::new());
    let mut prepared: Option<Box<dyn Prepared<'_> + '_>> = None;
    for (name, scene) in &scenes {
        let mut frame = Frame::new(scene, arguments.size, &executor).with(settings.clone());
        frame.table = given.as_ref();
        // The same profile on every machine.
        frame.by_rays = true;
        let mut ready = match prepared.take() {
            None => frame.prepare(technique)?,
            Some(mut ready) => {
                ready.set_frame(&frame)?;
                ready
            }
        };
        let name = std::path::Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        counted.push(count(technique, &frame, &mut *ready, &name)?);
        if arguments.lcov.is_some() {
            hits.push(lines(&mut *ready, &name)?);
        }
        prepared = Some(ready);
    }
    let Some(program) = prepared.as_ref().and_then(|prepared| prepared.table()) else {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{technique}` evaluates no table of cases"));
        return Err(Failure::bare("", error));
    };
    let mut profile = Profile::new(program);
    profile.scenes = counted;
    Ok((program.clone(), profile, hits))
}

/// Counts the lines that give the results in a frame, wherever it was rendered: by the interpreter, at its inputs.
fn lines<'s>(ready: &mut (dyn Prepared<'s> + 's), scene: &str) -> Result<Hits, Failure> {
    let table = ready.table().map(|program| program.name.clone());
    let inputs = ready.inputs()?;
    let of_table = inputs.iter().find(|inputs| Some(&inputs.program.name) == table.as_ref());
    let nothing =
        || Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, "the technique evaluates no table of cases"));
    let inputs = of_table.ok_or_else(nothing)?;
    Hits::of_columns(inputs.program, scene, &inputs.columns).map_err(|missing| {
        let message = format!("row {} of the inputs needs what is absent", missing.row + 1);
        Failure::bare("", Diagnostic::error(codes::NEEDS_FETCH, message))
    })
}
