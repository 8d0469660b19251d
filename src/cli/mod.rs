//! The command line: arguments, exit codes, and how things are said.
//!
//! Each subcommand is a file with its arguments and a `run` that returns an
//! `Outcome`; what it computes lives in the library. Results go to standard
//! output, messages to standard error.

mod answers;
mod area;
mod args;
mod atlas;
mod build;
mod check;
mod completions;
#[cfg(feature = "gpu")]
mod diff;
#[cfg(feature = "trial")]
mod errata;
mod eval;
mod expand;
mod explain;
mod fix;
mod fmt;
mod input;
mod levels;
mod lsp;
mod messages;
mod new;
mod output;
mod plan;
mod profile;
mod profiled;
mod progress;
mod render;
mod report;
mod scenes;
mod stabilise;
mod techniques;
#[cfg(test)]
mod tests;
#[cfg(feature = "gpu")]
mod tune;
mod watch;
mod why;

use std::io;
#[cfg(feature = "trial")]
use std::path::Path;
use std::process::ExitCode;

use clap::{Parser, Subcommand, ValueEnum};

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::Target;
#[cfg(feature = "trial")]
use crate::eval::Columns;
use crate::plan::Shape;
#[cfg(feature = "trial")]
use crate::program::Program;
use crate::show::Precision;
use crate::text::file::{STDOUT, io_reason};
use crate::text::reach;
use messages::{Color, Format, Report};

#[derive(Parser)]
#[command(name = "umbrage", version, about = "Compiles case tables into shaders that are proved equal to the table")]
#[command(
    after_help = "Exit codes: 0 clean, 1 findings, 2 failure.\nWhat a message means at length: umbrage explain CODE"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Colours in messages
    #[arg(long, global = true, value_enum, default_value = "auto", value_name = "WHEN")]
    color: Color,
    /// Form of messages: text for people, or one JSON object per line
    #[arg(long, global = true, value_enum, default_value = "human", value_name = "FORM")]
    message_format: Format,
    /// Let tables, scenes and meshes name files outside of their own directories
    #[arg(long, global = true)]
    allow_outside: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Compute the light of polygons at points, behind polygons, boxes and meshes, exactly
    Area(area::Arguments),
    /// Draw every case of a table
    Atlas(atlas::Arguments),
    /// Measure what each technique costs on this device
    #[cfg(feature = "gpu")]
    Bench(render::bench::Arguments),
    /// Check tables and run their examples
    Check(check::Arguments),
    /// Check, prove, emit and validate tables
    Build(build::Arguments),
    /// Compare every plan on a GPU with the interpreter
    #[cfg(feature = "gpu")]
    Diff(diff::Arguments),
    /// Report which misprints of a table the analyses find, and how well they find mistakes in general
    #[cfg(feature = "trial")]
    Errata(errata::ErrataArguments),
    /// Evaluate a table over rows of inputs
    Eval(eval::Arguments),
    /// Say which case is taken at one point, why, and how its value comes about; or what a code means
    Explain(explain::Arguments),
    /// List the images that the cases of a table stand for
    Expand(expand::Arguments),
    /// Say which inputs reach a case, and what lies around them
    Why(why::Arguments),
    /// Count how often each state of a table occurs; merge, show and compare such counts
    Profile(profile::Arguments),
    /// Put everything about a table on one page
    Report(report::Arguments),
    /// Measure how far each technique is from the true shadow
    Quality(render::quality::Arguments),
    /// Render a scene with its shadows
    Render(render::Arguments),
    /// List the scenes that come with Umbrage
    Scenes,
    /// List the techniques, with their tables, lights and settings
    Techniques,
    /// Light a picture by integral expansions: short for `render --technique integrals`, beside brute force
    Light(render::light::Arguments),
    /// Measure what the vertices of lights and occluders cost under area lights
    #[cfg(feature = "gpu")]
    Vertices(render::vertices::Arguments),
    /// Rewrite formulas that divide by zero or lose their digits
    Stabilise(stabilise::Arguments),
    /// Measure every plan of a table on this device, and keep the best
    #[cfg(feature = "gpu")]
    Tune(tune::Arguments),
    /// Lay out tables: columns aligned, expressions spaced
    Fmt(fmt::Arguments),
    /// Talk to an editor over the Language Server Protocol, on standard input and output
    Lsp(lsp::Arguments),
    /// Write a table to start from, and the build script that compiles it
    New(new::Arguments),
    /// Print a script that lets a shell complete command lines
    Completions(completions::CompletionArguments),
    /// Print the manual as man pages
    Man(completions::ManArguments),
}

/// The end of a command that was able to do its work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Outcome {
    /// Nothing to complain about.
    Clean,
    /// Warnings.
    Findings,
    /// Errors, which have been shown already.
    Failed,
}

/// Why a command could not do its work.
enum Error {
    /// A mistake in what the user gave.
    Failure(Failure),
    /// Standard output could not be written.
    Stdout(io::Error),
}

impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        Error::Failure(failure)
    }
}

impl From<io::Error> for Error {
    fn from(error: io::Error) -> Self {
        error.downcast().map_or_else(Error::Stdout, Error::Failure)
    }
}

type Result<T> = std::result::Result<T, Error>;

/// The floating-point type to evaluate in, as an argument.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum PrecisionArgument {
    /// Single, as on the GPU
    F32,
    /// Double
    F64,
}

impl From<PrecisionArgument> for Precision {
    fn from(argument: PrecisionArgument) -> Self {
        match argument {
            PrecisionArgument::F32 => Precision::F32,
            PrecisionArgument::F64 => Precision::F64,
        }
    }
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are on standard output and not a failure; a pipe that is closed early is fine.
            let _ = error.print();
            return if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS };
        }
    };
    let report = Report::new(arguments.color, arguments.message_format);
    if arguments.allow_outside {
        reach::allow_outside();
    }
    let result = match arguments.command {
        Command::Area(arguments) => area::run(&arguments, &report),
        Command::Atlas(arguments) => atlas::run(&arguments, &report),
        #[cfg(feature = "gpu")]
        Command::Bench(arguments) => render::bench::run(&arguments, &report),
        #[cfg(feature = "gpu")]
        Command::Vertices(arguments) => render::vertices::run(&arguments, &report),
        Command::Check(arguments) => check::run(&arguments, &report),
        Command::Build(arguments) => build::run(&arguments, &report),
        #[cfg(feature = "gpu")]
        Command::Diff(arguments) => diff::run(&arguments, &report),
        Command::Eval(arguments) => eval::run(&arguments, &report),
        #[cfg(feature = "trial")]
        Command::Errata(arguments) => errata::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments, &report),
        Command::Expand(arguments) => expand::run(&arguments, &report),
        Command::Why(arguments) => why::run(&arguments, &report),
        Command::Profile(arguments) => profile::run(&arguments, &report),
        Command::Report(arguments) => report::run(&arguments, &report),
        Command::Quality(arguments) => render::quality::run(&arguments, &report),
        Command::Render(arguments) => render::run(&arguments, &report),
        Command::Scenes => scenes::run(&report),
        Command::Techniques => techniques::run(&report),
        Command::Light(arguments) => render::light::run(&arguments, &report),
        Command::Stabilise(arguments) => stabilise::run(&arguments, &report),
        #[cfg(feature = "gpu")]
        Command::Tune(arguments) => tune::run(&arguments, &report),
        Command::Fmt(arguments) => fmt::run(&arguments, &report),
        Command::Lsp(arguments) => lsp::run(&arguments),
        Command::New(arguments) => new::run(&arguments, &report),
        Command::Completions(arguments) => completions::completions(&arguments),
        Command::Man(arguments) => completions::man(&arguments, &report),
    };
    match result {
        Ok(Outcome::Clean) => ExitCode::SUCCESS,
        Ok(Outcome::Findings) => ExitCode::from(1),
        Ok(Outcome::Failed) => ExitCode::from(2),
        Err(Error::Failure(failure)) => {
            report.failure(&failure);
            ExitCode::from(2)
        }
        // The reader of the output has seen enough.
        Err(Error::Stdout(error)) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
        Err(Error::Stdout(error)) => {
            let message = format!("cannot be written: {}", io_reason(&error));
            report.failure(&Failure::bare(STDOUT, Diagnostic::error(codes::UNWRITABLE, message)));
            ExitCode::from(2)
        }
    }
}

/// Reads rows of inputs from a file as commands do: CSV, JSON or a capture.
///
/// # Errors
/// With every mistake in them, each at its place.
#[cfg(feature = "trial")]
pub fn read_rows(program: &Program, path: &Path) -> std::result::Result<Columns<f32>, Failure> {
    input::read_all(program, path)
}

/// Reads the name of a plan.
fn parse_shape(name: &str) -> std::result::Result<Shape, String> {
    Shape::from_name(name).ok_or_else(|| {
        let known: Vec<&str> = Shape::ALL.iter().map(|shape| shape.name()).collect();
        format!("there is no such plan; the plans are: {}", known.join(", "))
    })
}

/// Reads the name of a target.
fn parse_target(name: &str) -> std::result::Result<Target, String> {
    Target::from_name(name).ok_or_else(|| {
        let known: Vec<&str> = Target::ALL.iter().map(|target| target.name()).collect();
        format!("there is no such target; the targets are: {}", known.join(", "))
    })
}
