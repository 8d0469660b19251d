//! `umbrage stabilise`: a table whose formulas divide by zero, in a form that does not.

use std::fmt::Write as _;
use std::io::{self, Write};
use std::path::PathBuf;

use super::output::Sink;
use super::report::Report;
use super::{Outcome, Result};
use crate::stabilise::{self, Certificate, Measured, Stabilised};
use crate::table::Table;

/// Arguments of `umbrage stabilise`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Table of functions
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    /// Where the new table goes; `-` is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Do not measure what was reached; measuring takes some seconds
    #[arg(long)]
    no_certificate: bool,
}

/// Writes the new table, its certificate in front.
pub(super) fn run(arguments: &Arguments, _report: &Report) -> Result<Outcome> {
    let table = Table::read(&arguments.table)?;
    let mut sink = Sink::create(&arguments.output)?;
    let stabilised = stabilise::stabilise(&table)?;
    let certificates = match arguments.no_certificate {
        true => Vec::new(),
        false => stabilised.certify(&table)?,
    };
    let name = arguments.table.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let summary = summary(&name, &stabilised, &certificates);
    for line in summary.lines() {
        writeln!(sink, "{}", format!("// {line}").trim_end())?;
    }
    write!(sink, "{}", stabilised.text)?;
    let to_file = arguments.output.as_os_str() != "-";
    sink.finish()?;
    if to_file {
        let mut out = io::stdout().lock();
        write!(out, "{summary}")?;
        out.flush()?;
    }
    let left = stabilised.functions.iter().any(|(_, outcome)| matches!(outcome, stabilise::Outcome::Left(_)));
    Ok(if left { Outcome::Findings } else { Outcome::Clean })
}

/// What was done and what was reached.
fn summary(name: &str, stabilised: &Stabilised, certificates: &[Certificate]) -> String {
    let mut text = format!("Rewritten from {name} by `umbrage stabilise`.\n\n");
    let _ = writeln!(text, "Formulas:");
    for (function, outcome) in &stabilised.functions {
        let what = match outcome {
            stabilise::Outcome::Rewritten => "rewritten".to_owned(),
            stabilise::Outcome::AsWritten => "as written; it gains from what it calls".to_owned(),
            stabilise::Outcome::Left(reason) => format!("left alone: {reason}"),
        };
        let _ = writeln!(text, "  {function:<10} {what}");
    }
    if !stabilised.kernels.is_empty() {
        let _ = writeln!(text, "Functions of one variable that were added: {}", stabilised.kernels.join(", "));
    }
    if !certificates.is_empty() {
        text.push_str(
            "\nCertificate: f32 against the original in 384 bits, singular points by their limits. `units` is the\n\
             largest error divided by what half a unit in the last place of each input can change, plus half a\n\
             unit in the last place of the declared scale or else of the value.\n\n",
        );
        let _ = writeln!(
            text,
            "  {:<10} {:>6}  {:>10} {:>9} {:>9}   {:>10} {:>9} {:>9}",
            "function", "points", "not finite", "error", "units", "not finite", "error", "units"
        );
        for certificate in certificates {
            let of = |m: &Measured| format!("{:>10} {:>9.1e} {:>9.1e}", m.not_finite, m.error, m.units);
            let _ = writeln!(
                text,
                "  {:<10} {:>6}  {}   {}",
                certificate.name,
                certificate.points,
                of(&certificate.before),
                of(&certificate.after)
            );
        }
        text.push_str("  The first three columns are the original's, the others those of this table.\n");
    }
    text
}
