//! Revectorized shadows in a window, or in a file.
//!
//! ```text
//! cargo run --release -p wgpu-shadows
//! cargo run --release -p wgpu-shadows -- --headless out.png --technique rsmss --cases
//! ```
//!
//! What a shadow's edge means is said by two tables, which the build script has
//! compiled into WGSL. Everything else is an ordinary deferred renderer:
//!
//! ```text
//! geometry ──light──▶ shadow map ─┐
//!          ──camera─▶ receivers ──┴─▶ light.wgsl with the technique and its table ──▶ picture
//! ```
//!
//! When the file of a table changes, it is checked, proved and compiled again
//! while the program runs; if it is wrong, the window says why and goes on with
//! what was right.

mod feedback;
mod geometry;
mod gpu;
mod headless;
mod panel;
mod renderer;
mod resources;
mod shaders;
mod view;
mod window;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use umbrage::scene::Scene;
use umbrage::technique::revectorise::Variant;

use shaders::PLANS;
use view::{TECHNIQUES, View};

/// Shadows of a scene, by techniques and plans to switch between
///
/// The variable WGPU_ADAPTER_NAME chooses among several adapters, by a part of the name.
#[derive(Parser)]
#[command(version, after_help = panel::KEYS)]
struct Arguments {
    /// Write one picture to this file (PNG) instead of opening a window
    #[arg(long, value_name = "FILE")]
    headless: Option<PathBuf>,
    /// With --headless, also write how often each line of the table gave a result, for `umbrage profile --hits`
    #[arg(long, value_name = "FILE", requires = "headless")]
    hits: Option<PathBuf>,
    /// The scene: one that comes with Umbrage, or a file
    #[arg(long, value_name = "SCENE", default_value = "fence")]
    scene: String,
    /// The technique to begin with: hard, pcf, smsr, rsmss, rpcf
    #[arg(long, value_name = "NAME", default_value = "rsmss", value_parser = technique)]
    technique: Variant,
    /// The plan of the table to begin with: ladder, ordered, gathered, switch, tree
    #[arg(long, value_name = "NAME", default_value = "ladder", value_parser = plan)]
    plan: usize,
    /// Begin with the cases in colours
    #[arg(long)]
    cases: bool,
    /// A table of rsmss or smsr that takes the place of the one compiled in, and is watched [default: the
    /// files that were compiled in are watched]
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Width and height of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x720", value_parser = size)]
    size: [u32; 2],
    /// Texels per side of the shadow map
    #[arg(long, value_name = "TEXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(16..=8190))]
    shadow_map: u32,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let scene = Scene::open(&arguments.scene).map_err(|failure| failure.to_string())?;
    let mut view = View::of(&scene.camera);
    (view.technique, view.plan, view.cases) = (arguments.technique, arguments.plan, arguments.cases);
    let table = arguments.table.as_deref();
    match &arguments.headless {
        Some(path) => {
            let hits = arguments.hits.as_deref();
            headless::write(path, &scene, arguments.shadow_map, table, &view, arguments.size, hits)
        }
        None => window::show(&scene, arguments.shadow_map, table, view, arguments.size),
    }
}

fn technique(name: &str) -> Result<Variant, String> {
    let found = Variant::from_name(name).filter(|technique| TECHNIQUES.contains(technique));
    let known = || TECHNIQUES.map(Variant::name).join(", ");
    found.ok_or_else(|| format!("there is no such technique; the techniques are: {}", known()))
}

fn plan(name: &str) -> Result<usize, String> {
    let known = || PLANS.map(|plan| plan.name()).join(", ");
    let found = PLANS.iter().position(|plan| plan.name() == name);
    found.ok_or_else(|| format!("there is no such plan; the plans are: {}", known()))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (16..=8192).contains(side));
    let size = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    size.ok_or_else(|| "expected WIDTHxHEIGHT, for instance 1280x720; a side has 16 to 8192 pixels".to_owned())
}
