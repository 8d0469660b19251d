//! Arguments that commands share: where something runs, how large, and with which settings.

#[cfg(feature = "gpu")]
use std::sync::Arc;

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::messages::Report;
use crate::diag::{Diagnostic, Failure, codes};
#[cfg(feature = "gpu")]
use crate::gpu::{AdapterChoice, Gpu};
use crate::technique::revectorise::MAX_MAP;
use crate::technique::{self, Executor, Settings, Technique};

/// Largest side of a picture.
pub(super) const MAX_SIDE: u32 = 16384;

/// A technique, as an argument.
pub(super) type TechniqueArgument = &'static dyn Technique;

/// The arguments that choose a machine.
#[derive(clap::Args)]
pub(super) struct Machine {
    /// The machine: auto is a GPU, or the CPU where there is only a software adapter
    /// [default: auto to render and compare; gpu for bench; cpu to count, to evaluate, and for light]
    #[arg(long, alias = "executor", value_enum, value_name = "WHERE")]
    pub(super) backend: Option<Backend>,
    /// The adapter: any, software, hardware, or a part of its name
    #[cfg(feature = "gpu")]
    #[arg(long, value_name = "WHICH", default_value = "any")]
    pub(super) adapter: AdapterChoice,
}

/// A kind of machine, as an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Backend {
    /// A GPU if there is one, else the CPU
    Auto,
    /// A GPU, or a software adapter
    Gpu,
    /// The CPU
    #[value(alias = "interpreter")]
    Cpu,
}

impl Machine {
    /// The machine that was asked for, or the default one. Where `auto` finds no GPU, a note says so.
    pub(super) fn executor(&self, default: Backend, report: &Report) -> Result<Executor, Failure> {
        match self.backend.unwrap_or(default) {
            Backend::Cpu => Ok(Executor::Cpu),
            Backend::Gpu => self.gpu(false),
            Backend::Auto => Ok(self.gpu(true).unwrap_or_else(|failure| {
                let reason = failure.diagnostics.first().map_or(String::new(), |d| format!(": {}", d.message));
                let note = Diagnostic::note(codes::NO_ADAPTER, format!("runs on the CPU{reason}"));
                report.failure(&Failure::bare("", note.help("say `--backend cpu` or `--backend gpu` to choose")));
                Executor::Cpu
            })),
        }
    }

    #[cfg(feature = "gpu")]
    fn gpu(&self, hardware_only: bool) -> Result<Executor, Failure> {
        let choice = match &self.adapter {
            AdapterChoice::Any if hardware_only => &AdapterChoice::Hardware,
            choice => choice,
        };
        Ok(Executor::Gpu(Arc::new(Gpu::open(choice)?)))
    }

    #[cfg(not(feature = "gpu"))]
    fn gpu(&self, _: bool) -> Result<Executor, Failure> {
        Err(no_gpu())
    }
}

/// The failure of a build that cannot use GPUs.
#[cfg(not(feature = "gpu"))]
fn no_gpu() -> Failure {
    let error = Diagnostic::error(codes::NO_ADAPTER, "this build has no GPU support");
    Failure::bare("", error.help("use `--backend cpu`, or build umbrage with the feature `gpu`"))
}

/// Settings of techniques, any of them.
#[derive(clap::Args)]
pub(super) struct Set {
    /// A setting of a technique, as `umbrage techniques` lists them; may be given several times
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
}

impl Set {
    /// The settings for techniques that are used together.
    #[cfg(feature = "gpu")]
    pub(super) fn read(&self, techniques: &[TechniqueArgument]) -> Result<Settings, Failure> {
        technique::read_settings(techniques, self.set.iter().map(String::as_str))
    }
}

/// Settings of techniques, the most common of them as options of their own.
#[derive(clap::Args)]
pub(super) struct SettingArguments {
    #[command(flatten)]
    set: Set,
    /// Longest run that is revectorised, in texels
    #[arg(long, value_name = "TEXELS", default_value_t = default("search_limit"), value_parser = Short("search_limit"))]
    search_limit: String,
    /// Side of the kernel of pcf and rpcf, in texels; odd
    #[arg(long, value_name = "TEXELS", default_value_t = default("pcf"), value_parser = Short("pcf"))]
    pcf: String,
    /// Depth bias, in units of 2^-22 of the light's range
    #[arg(long, value_name = "UNITS", default_value_t = default("bias"), value_parser = Short("bias"))]
    bias: String,
    /// Depth bias, times the slope of the surface
    #[arg(long, value_name = "FACTOR", default_value_t = default("slope_bias"), value_parser = Short("slope_bias"))]
    slope_bias: String,
    /// Depth bias along walks, as a share of the light's range
    #[arg(long, value_name = "DEPTH", default_value_t = default("walk_bias"), value_parser = Short("walk_bias"))]
    walk_bias: String,
}

impl SettingArguments {
    /// The settings for techniques that are used together. An option of its own is left out where none of the
    /// techniques has such a setting; `--set` wins.
    pub(super) fn read(&self, techniques: &[TechniqueArgument], shadow_map: Option<u32>) -> Result<Settings, Failure> {
        let shadow_map = shadow_map.map(|size| size.to_string());
        let short = [
            ("shadow_map", shadow_map.as_ref()),
            ("search_limit", Some(&self.search_limit)),
            ("pcf", Some(&self.pcf)),
            ("bias", Some(&self.bias)),
            ("slope_bias", Some(&self.slope_bias)),
            ("walk_bias", Some(&self.walk_bias)),
        ];
        let declares = |name: &str| {
            techniques.iter().flat_map(|technique| technique.settings()).any(|setting| setting.name == name)
        };
        let short = short.into_iter().filter(|(name, _)| declares(name));
        let mut pairs: Vec<String> = short.filter_map(|(name, value)| Some(format!("{name}={}", value?))).collect();
        pairs.extend(self.set.set.iter().cloned());
        technique::read_settings(techniques, pairs.iter().map(String::as_str))
    }
}

/// The default of a setting, as an option shows it.
fn default(name: &str) -> String {
    technique::setting(name).map_or(String::new(), |setting| setting.default.to_string())
}

/// Checks the value of an option that stands for the setting of this name.
#[derive(Clone)]
struct Short(&'static str);

impl TypedValueParser for Short {
    type Value = String;

    fn parse_ref(
        &self,
        command: &clap::Command,
        arg: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<String, clap::Error> {
        let name = self.0;
        let check = move |text: &str| match technique::setting(name) {
            Some(setting) => setting.parse(text).map(|_| text.to_owned()),
            None => Err("expected a setting".to_owned()),
        };
        check.parse_ref(command, arg, value)
    }
}

/// Reads the name of a technique; help lists all with their lines of documentation.
pub(super) fn technique_parser() -> impl TypedValueParser<Value = TechniqueArgument> {
    let values = technique::ALL.iter().map(|technique| PossibleValue::new(technique.name()).help(technique.doc()));
    PossibleValuesParser::new(values).try_map(|name| {
        technique::from_name(&name).map_err(|failure| failure.diagnostics.first().map_or(name, |d| d.message.clone()))
    })
}

/// Reads a size such as 1920x1080.
pub(super) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| text.parse::<u32>().ok().filter(|side| (1..=MAX_SIDE).contains(side));
    let size = text.split_once('x').and_then(|(width, height)| Some((side(width)?, side(height)?)));
    size.ok_or_else(|| format!("expected WIDTHxHEIGHT, for instance 960x540; a side has 1 to {MAX_SIDE} pixels"))
}

/// Reads the size of a shadow map.
pub(super) fn parse_map(text: &str) -> Result<u32, String> {
    let size = text.parse::<u32>().ok().filter(|size| (1..=MAX_MAP).contains(size));
    size.ok_or_else(|| format!("expected the texels per side of the shadow map, 1 to {MAX_MAP}"))
}
