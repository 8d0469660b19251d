//! `umbrage area`: points, lights and occluders in, the light at each point out.

mod method;
mod occluders;
mod read;
mod values;

use std::io::Write;
use std::path::PathBuf;

use super::messages::Report;
use super::output::Sink;
use super::{Outcome, PrecisionArgument, Result};
use crate::diag::Failure;
use crate::show::Precision;
use method::{Answered, Choice, Machine};
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
    /// Floating-point type
    #[arg(long, value_enum, default_value = "f64", value_name = "TYPE")]
    precision: PrecisionArgument,
    #[command(flatten)]
    choice: Choice,
}

/// Points whose edges are evaluated together.
const PORTION: usize = 1024;

/// Reads all points, then computes and writes.
pub(super) fn run(arguments: &Arguments, _: &Report) -> Result<Outcome> {
    let mut wide = arguments.choice.machine::<f64>()?;
    let mut narrow = match arguments.precision.into() {
        Precision::F32 => Some(arguments.choice.machine::<f32>()?),
        Precision::F64 => None,
    };
    let source = super::input::text(&arguments.input)?;
    let rows = read::rows(&source).map_err(|diagnostics| Failure { source: source.clone(), diagnostics })?;
    let rows: Vec<(u32, &Row)> = rows.iter().enumerate().map(|(number, row)| (number as u32, row)).collect();
    let mut sink = Sink::create(&arguments.output)?;
    for portion in rows.chunks(PORTION) {
        let answers = match &mut narrow {
            Some(narrow) => in_range(narrow, &mut wide, portion)?,
            None => wide.answers(portion)?,
        };
        for ((_, row), answer) in portion.iter().zip(&answers) {
            writeln!(sink, "{}", answer.object(row))?;
        }
    }
    sink.finish()?;
    Ok(Outcome::Clean)
}

/// The answers in single precision; in double where one is beyond its range.
fn in_range(
    narrow: &mut Machine<f32>,
    wide: &mut Machine<f64>,
    rows: &[(u32, &Row)],
) -> std::result::Result<Vec<Answered>, Failure> {
    let mut all = narrow.answers(rows)?;
    let beyond: Vec<usize> = (0..all.len()).filter(|index| !all[*index].is_finite()).collect();
    let again: Vec<(u32, &Row)> = beyond.iter().map(|index| rows[*index]).collect();
    for (index, answer) in beyond.into_iter().zip(wide.answers(&again)?) {
        all[index] = answer;
    }
    Ok(all)
}
