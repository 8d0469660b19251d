//! `umbrage area`: points, lights and occluders in, the light at each point out.

mod occluders;
mod read;
mod values;

use std::io::Write;
use std::path::PathBuf;

use serde_json::{Value, json};

use super::messages::Report;
use super::output::Sink;
use super::{Outcome, PrecisionArgument, Result};
use crate::diag::Failure;
use crate::show::Precision;
use crate::technique::area::{Answer, Peeler, Query, Scalar};
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
}

/// Points whose edges are evaluated together.
const PORTION: usize = 1024;

/// Reads all points, then computes and writes.
pub(super) fn run(arguments: &Arguments, _: &Report) -> Result<Outcome> {
    let source = super::input::text(&arguments.input)?;
    let rows = read::rows(&source).map_err(|diagnostics| Failure { source: source.clone(), diagnostics })?;
    let mut sink = Sink::create(&arguments.output)?;
    let mut wide = Peeler::<f64>::new()?;
    let mut narrow = match arguments.precision.into() {
        Precision::F32 => Some(Peeler::<f32>::new()?),
        Precision::F64 => None,
    };
    for portion in rows.chunks(PORTION) {
        let answers = match &mut narrow {
            Some(narrow) => in_range(narrow, &mut wide, portion)?,
            None => answers(&mut wide, portion)?,
        };
        for (row, answer) in portion.iter().zip(&answers) {
            writeln!(sink, "{}", object(row, answer))?;
        }
    }
    sink.finish()?;
    Ok(Outcome::Clean)
}

fn answers<T: Scalar>(peeler: &mut Peeler<T>, rows: &[Row]) -> std::result::Result<Vec<Answer>, Failure> {
    peeler.answers(rows.iter().map(|row| row.question.query()))
}

/// The answers in single precision; in double where one is beyond its range.
fn in_range(
    narrow: &mut Peeler<f32>,
    wide: &mut Peeler<f64>,
    rows: &[Row],
) -> std::result::Result<Vec<Answer>, Failure> {
    let mut all = answers(narrow, rows)?;
    let beyond: Vec<usize> = (0..all.len()).filter(|index| !all[*index].is_finite()).collect();
    let queries: Vec<Query<'_>> = beyond.iter().map(|index| rows[*index].question.query()).collect();
    for (index, answer) in beyond.into_iter().zip(wide.answers(queries)?) {
        all[index] = answer;
    }
    Ok(all)
}

fn object(row: &Row, answer: &Answer) -> Value {
    let mut object = json!({
        "id": row.id,
        "fraction": answer.fraction,
        "fraction_above_horizon": answer.fraction_above_horizon,
        "form_factor": answer.form_factor,
        "form_factor_unshadowed": answer.form_factor_unshadowed,
    });
    if let Some((with, without)) = answer.shaped {
        object["ltc"] = with.into();
        object["ltc_unshadowed"] = without.into();
    }
    object["pieces"] = answer.work.pieces.into();
    object["clips"] = answer.work.clips.into();
    object["overflow"] = answer.work.overflow.into();
    object
}
