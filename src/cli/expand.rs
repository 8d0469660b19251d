//! `umbrage expand`: the images that cases stand for.

use std::io::Write;
use std::path::PathBuf;

use serde_json::json;

use super::messages::{Format, Report};
use super::{Outcome, Result};
use crate::cli::output::stdout;
use crate::program::print::Printer;
use crate::program::{ExprId, Program, Row};
use crate::show::{self, Precision};

/// Arguments of `umbrage expand`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// Number of a case, if only its images are asked for
    #[arg(long, value_name = "NUMBER")]
    case: Option<u32>,
}

/// Expressions larger than this are not written out.
const LEGIBLE: u32 = 400;

/// Lists every case with its images, in the order in which they are tried.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let program = Program::read(&arguments.table)?;
    let mut out = stdout();
    if let Some(case) = arguments.case.filter(|case| program.rows.iter().all(|row| row.id != *case)) {
        return Err(super::why::missing(&program, case).into());
    }
    for row in program.rows.iter().filter(|row| arguments.case.is_none_or(|case| row.id == case)) {
        match report.format {
            Format::Human => human(&mut out, &program, row)?,
            Format::Json => writeln!(out, "{}", object(&program, row))?,
        }
    }
    out.flush()?;
    Ok(Outcome::Clean)
}

fn human(out: &mut impl Write, program: &Program, row: &Row) -> Result<()> {
    let printer = Printer { pool: &program.pool, inputs: &program.inputs };
    let under = if row.under.is_empty() { String::new() } else { format!(" under {}", row.under.join(", ")) };
    writeln!(out, "case {}{under}: {}", row.id, printer.cond(row.guard))?;
    for line in &row.lines {
        let value = value(program, &line.values);
        match line.condition_span {
            Some(_) => writeln!(out, "  {value}, if {}", printer.cond(line.condition))?,
            None => writeln!(out, "  {value}")?,
        }
    }
    Ok(())
}

fn object(program: &Program, row: &Row) -> serde_json::Value {
    let printer = Printer { pool: &program.pool, inputs: &program.inputs };
    let lines = row.lines.iter().map(|line| {
        let condition = line.condition_span.map(|_| printer.cond(line.condition));
        json!({ "value": value(program, &line.values), "condition": condition })
    });
    json!({
        "case": row.id, "under": row.under, "guard": printer.cond(row.guard), "lines": lines.collect::<Vec<_>>(),
    })
}

/// A value as an expression; component by component where it depends on inputs.
fn value(program: &Program, values: &[ExprId]) -> String {
    let constants: Option<Vec<f64>> = values.iter().map(|value| program.pool.constant(*value)).collect();
    match constants {
        Some(constants) => show::expression(&program.output, &constants, Precision::F64),
        None => {
            let printer = Printer { pool: &program.pool, inputs: &program.inputs };
            let named = |expr: &ExprId| match program.pool.expr_facts(*expr).size {
                0..=LEGIBLE => printer.expr(*expr),
                size => format!("an expression of {size} parts"),
            };
            match values {
                [one] => named(one),
                several => {
                    let parts = program.output.components().into_iter().zip(several);
                    parts.map(|(of, part)| format!("{} = {}", of.name, named(part))).collect::<Vec<_>>().join(", ")
                }
            }
        }
    }
}
