//! Arguments that all commands share which render: how large, with what, on which machine.

use clap::ValueEnum;

use crate::cli::messages::Report;
use crate::diag::{Diagnostic, Failure, codes};
#[cfg(feature = "gpu")]
use crate::gpu::AdapterChoice;
#[cfg(feature = "gpu")]
use crate::gpu::Gpu;
use crate::technique::executor::Executor;
use crate::technique::revectorise::stage::Bias;
use crate::technique::revectorise::{Settings, Technique};

/// Largest side of a shadow map and of a picture.
pub(in crate::cli) const MAX_SIDE: u32 = 16384;

/// How techniques search, and on which machine.
#[derive(clap::Args)]
pub(in crate::cli) struct FrameArguments {
    /// What evaluates the techniques: auto is a GPU, or the CPU where there is only a software adapter
    #[arg(long, value_enum, default_value = "auto", value_name = "WHAT")]
    pub(in crate::cli) backend: Backend,
    /// The adapter: any, software, hardware, or a part of its name
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "WHICH", default_value = "any")]
    pub(in crate::cli) adapter: AdapterChoice,
    /// Longest run that is revectorised, in texels
    #[arg(long, value_name = "TEXELS", default_value_t = Settings::default().search_limit,
          value_parser = clap::value_parser!(u32).range(1..=4096))]
    pub(in crate::cli) search_limit: u32,
    /// Side of the kernel of pcf and rpcf, in texels; odd
    #[arg(long, value_name = "TEXELS", default_value_t = Settings::default().pcf, value_parser = parse_kernel)]
    pub(in crate::cli) pcf: u32,
    /// Depth bias, in units of 2^-22 of the light's range
    #[arg(long, value_name = "UNITS", default_value_t = Bias::default().constant, value_parser = parse_bias)]
    pub(in crate::cli) bias: f32,
    /// Depth bias, times the slope of the surface
    #[arg(long, value_name = "FACTOR", default_value_t = Bias::default().slope, value_parser = parse_bias)]
    pub(in crate::cli) slope_bias: f32,
    /// Depth bias along walks, as a share of the light's range
    #[arg(long, value_name = "DEPTH", default_value_t = Settings::default().walk_bias, value_parser = parse_bias)]
    pub(in crate::cli) walk_bias: f32,
}

/// What evaluates the techniques, as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Backend {
    /// A GPU if there is one, else the CPU
    Auto,
    /// A GPU, or a software adapter
    Gpu,
    /// The CPU
    Cpu,
}

impl FrameArguments {
    pub(in crate::cli) fn settings(&self) -> Settings {
        Settings { search_limit: self.search_limit, walk_bias: self.walk_bias, pcf: self.pcf }
    }

    pub(in crate::cli) fn bias(&self) -> Bias {
        Bias { constant: self.bias, slope: self.slope_bias }
    }

    /// The machine that was asked for.
    pub(in crate::cli) fn executor(&self, report: &Report) -> Result<Executor, Failure> {
        #[cfg(feature = "gpu")]
        return executor(self.backend, &self.adapter, report);
        #[cfg(not(feature = "gpu"))]
        executor(self.backend, report)
    }
}

/// The machine that was asked for. Where `auto` finds no GPU, a note says so.
pub(in crate::cli) fn executor(
    backend: Backend,
    #[cfg(feature = "gpu")] adapter: &AdapterChoice,
    report: &Report,
) -> Result<Executor, Failure> {
    #[cfg(feature = "gpu")]
    let gpu = |hardware_only| {
        let choice = match adapter {
            AdapterChoice::Any if hardware_only => &AdapterChoice::Hardware,
            choice => choice,
        };
        Ok::<_, Failure>(Executor::Gpu(Box::new(Gpu::open(choice)?)))
    };
    #[cfg(not(feature = "gpu"))]
    let gpu = |_| {
        let error = Diagnostic::error(codes::NO_ADAPTER, "this build has no GPU support");
        Err(Failure::bare("", error.help("use `--backend cpu`, or build umbrage with the feature `gpu`")))
    };
    match backend {
        Backend::Cpu => Ok(Executor::Cpu),
        Backend::Gpu => gpu(false),
        Backend::Auto => Ok(gpu(true).unwrap_or_else(|failure| {
            let reason = failure.diagnostics.first().map_or(String::new(), |d| format!(": {}", d.message));
            let note = Diagnostic::note(codes::NO_ADAPTER, format!("rendering on the CPU{reason}"));
            report.failure(&Failure::bare("", note.help("say `--backend cpu` or `--backend gpu` to choose")));
            Executor::Cpu
        })),
    }
}

/// Reads a size such as 1920x1080.
pub(in crate::cli) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let size = text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    size.ok_or_else(|| format!("expected WIDTHxHEIGHT, for instance 960x540; a side has 1 to {MAX_SIDE} pixels"))
}

/// Reads the size of a shadow map.
pub(in crate::cli) fn parse_map(text: &str) -> Result<u32, String> {
    let size = text.parse::<u32>().ok().filter(|size| (1..=MAX_SIDE).contains(size));
    size.ok_or_else(|| format!("expected the texels per side of the shadow map, 1 to {MAX_SIDE}"))
}

fn parse_kernel(text: &str) -> Result<u32, String> {
    let side = text.parse::<u32>().ok().filter(|side| (1..=31).contains(side) && side % 2 == 1);
    side.ok_or_else(|| "expected an odd number from 1 to 31".to_owned())
}

fn parse_bias(text: &str) -> Result<f32, String> {
    let bias = text.parse::<f32>().ok().filter(|bias| (0.0..=1e6).contains(bias));
    bias.ok_or_else(|| "expected a number, zero or more".to_owned())
}

/// Reads the name of a technique.
pub(in crate::cli) fn parse_technique(name: &str) -> Result<Technique, String> {
    Technique::from_name(name).ok_or_else(|| {
        let known: Vec<&str> = Technique::ALL.iter().map(|technique| technique.name()).collect();
        format!("there is no such technique; the techniques are: {}", known.join(", "))
    })
}
