//! Counting what scenes need: they are rendered, and every evaluation of the table is counted.

use super::Count;
use crate::cli::messages::Report;
use crate::cli::render::frame;
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::Profile;
use crate::program::Program;
use crate::scene::Scene;
use crate::technique::count::count;
#[cfg(feature = "gpu")]
use crate::technique::count::count_on;
use crate::technique::executor::Executor;
use crate::technique::revectorise::cpu;
use crate::technique::revectorise::cpu::Frame;
use crate::technique::revectorise::stage::{Bias, Stage};
use crate::technique::revectorise::{Settings, Technique};

/// Renders scenes and counts.
pub(super) fn run(arguments: &Count, report: &Report) -> Result<(Program, Profile), Failure> {
    let technique = arguments.technique;
    let Some(own) = cpu::table(technique)? else {
        let with: Vec<&str> = Technique::ALL.into_iter().filter(|t| t.table().is_some()).map(Technique::name).collect();
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{technique}` evaluates no table"));
        return Err(Failure::bare("", error.help(format!("techniques with a table are: {}", with.join(", ")))));
    };
    let program = match &arguments.table {
        None => own,
        Some(path) => Program::read(path)?,
    };
    let mut scenes = Vec::new();
    for name in &arguments.scene {
        scenes.push((name, Scene::open(name)?));
    }
    let executor = executor(arguments, report)?;
    let mut profile = Profile::new(&program);
    let (width, height) = arguments.size;
    for (name, scene) in &scenes {
        let stage = Stage::new(scene)?;
        let map = stage.shadow_map(arguments.shadow_map, Bias::default());
        let receivers = stage.receivers(&stage.surfaces(width, height), arguments.shadow_map);
        let settings = Settings { search_limit: arguments.search_limit, ..Settings::default() };
        let frame = Frame { map: &map, receivers: &receivers, settings: &settings };
        let name = std::path::Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        profile.scenes.push(match &executor {
            Executor::Cpu => count(&program, &name, technique, frame)?,
            #[cfg(feature = "gpu")]
            Executor::Gpu(gpu) => count_on(gpu, &program, &name, technique, frame)?,
        });
    }
    Ok((program, profile))
}

/// The machine that was asked for.
fn executor(arguments: &Count, report: &Report) -> Result<Executor, Failure> {
    #[cfg(feature = "gpu")]
    return frame::executor(arguments.backend, &arguments.adapter, report);
    #[cfg(not(feature = "gpu"))]
    frame::executor(arguments.backend, report)
}
