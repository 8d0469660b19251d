//! `umbrage area`: points, lights and occluders in, the light at each point out.

mod method;
mod occluders;
mod read;
mod values;

use std::io::Write;
use std::path::PathBuf;

use super::args::{Backend, Machine};
use super::messages::Report;
use super::output::Sink;
use super::{Outcome, PrecisionArgument, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::show::Precision;
use method::{Choice, Method};
use read::Row;

/// Arguments of `umbrage area`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Points: a JSON array of objects, or one object a line; `-` is standard input
    #[arg(long, default_value = "-", value_name = "FILE")]
    input: PathBuf,
    /// The file for the answers, one JSON object a line, in the order of the points; `-` is standard output
    #[arg(long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Floating-point type; a GPU computes in f32 [default: f64 on the CPU, f32 with another --backend]
    #[arg(long, value_enum, value_name = "TYPE")]
    precision: Option<PrecisionArgument>,
    #[command(flatten)]
    choice: Choice,
    #[command(flatten)]
    machine: Machine,
}

/// Points that are computed together.
const PORTION: usize = 1 << 14;

/// Reads all points, then computes and writes.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let (precision, search) = (precision(arguments)?, arguments.choice.search()?);
    if search.is_some() && arguments.machine.backend == Some(Backend::Gpu) {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, "the search of points runs on the CPU");
        return Err(Failure::bare("", error.help("leave out `--backend gpu`, or `--method search`")).into());
    }
    let source = super::input::text(&arguments.input)?;
    let rows = read::rows(&source).map_err(|diagnostics| Failure { source: source.clone(), diagnostics })?;
    let executor = arguments.machine.executor(Backend::Cpu, report)?;
    let mut sink = Sink::create(&arguments.output)?;
    let mut method = Method::new(precision, &executor, search)?;
    let rows: Vec<(u32, &Row)> = rows.iter().enumerate().map(|(number, row)| (number as u32, row)).collect();
    for portion in rows.chunks(PORTION) {
        for ((_, row), answer) in portion.iter().zip(&method.answers(portion)?) {
            writeln!(sink, "{}", answer.object(row))?;
        }
    }
    sink.finish()?;
    Ok(Outcome::Clean)
}

/// The precision that was asked for: double unless a GPU may compute, which has none.
fn precision(arguments: &Arguments) -> std::result::Result<Precision, Failure> {
    let may_be_gpu = arguments.machine.backend.is_some_and(|backend| backend != Backend::Cpu);
    match arguments.precision.map(Precision::from) {
        Some(Precision::F64) if may_be_gpu => {
            let error = Diagnostic::error(codes::NOT_APPLICABLE, "the GPU computes in f32 only");
            Err(Failure::bare("", error.help("leave out `--precision f64`, or use `--backend cpu`")))
        }
        Some(precision) => Ok(precision),
        None if may_be_gpu => Ok(Precision::F32),
        None => Ok(Precision::F64),
    }
}
