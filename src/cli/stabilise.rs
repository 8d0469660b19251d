//! `umbrage stabilise`: a table whose formulas divide by zero, in a form that does not.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

use serde_json::json;

use super::messages::{Format, Report};
use super::output::{Sink, stdout};
use super::{Outcome, Result};
use crate::stabilise::{self, Certificate, Measured, Stabilised};
use crate::table::Table;

/// Arguments of `umbrage stabilise`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Table of functions
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    /// The file for the new table; `-` is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Do not measure what was reached; measuring takes some seconds
    #[arg(long)]
    no_certificate: bool,
}

/// Writes the new table, its certificate in front.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let table = Table::read(&arguments.table)?;
    let mut sink = Sink::create(&arguments.output)?;
    let stabilised = stabilise::stabilise(&table)?;
    let certificates = match arguments.no_certificate {
        true => Vec::new(),
        false => stabilised.certify(&table)?,
    };
    let name = arguments.table.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let summary = summary(&name, &stabilised, &certificates);
    let head: String = summary.lines().map(|line| format!("{}\n", format!("// {line}").trim_end())).collect();
    // Remarks of the table's author stand apart.
    let gap = if stabilised.text.starts_with('/') { "\n" } else { "" };
    let text = format!("{head}{gap}{}", stabilised.text);
    let to_file = arguments.output.as_os_str() != "-";
    let said = match report.format {
        Format::Json => {
            let mut object = json(&name, &stabilised, &certificates);
            if !to_file {
                object["text"] = text.as_str().into();
            }
            format!("{object}\n")
        }
        Format::Human => summary,
    };
    if to_file || report.format == Format::Human {
        write!(sink, "{text}")?;
    }
    sink.finish()?;
    if to_file || report.format == Format::Json {
        let mut out = stdout();
        write!(out, "{said}")?;
        out.flush()?;
    }
    let left = stabilised.functions.iter().any(|(_, outcome)| matches!(outcome, stabilise::Outcome::Left(_)));
    Ok(if left { Outcome::Findings } else { Outcome::Clean })
}

/// The fate of a function, in words.
fn outcome(outcome: &stabilise::Outcome) -> String {
    match outcome {
        stabilise::Outcome::Rewritten => "rewritten".to_owned(),
        stabilise::Outcome::Integrated => "rewritten: the difference of two sides, integrated as a product".to_owned(),
        stabilise::Outcome::AsWritten => "as written; it gains from what it calls".to_owned(),
        stabilise::Outcome::Left(reason) => format!("left alone: {reason}"),
    }
}

/// The same for programs.
fn json(name: &str, stabilised: &Stabilised, certificates: &[Certificate]) -> serde_json::Value {
    let measured = |m: &Measured| json!({"not_finite": m.not_finite, "error": m.error, "units": m.units});
    let functions = stabilised.functions.iter().map(|(function, what)| {
        let certificate = certificates.iter().find(|certificate| certificate.name == *function);
        let certificate = certificate.map(|c| {
            json!({
                "points": c.points,
                "left_out": c.left_out,
                "before": measured(&c.before),
                "after": measured(&c.after),
                "admitted": c.admitted.as_ref().ok(),
                "no_bound": c.admitted.as_ref().err(),
                "claimed": c.claimed,
                "met": c.is_met(),
            })
        });
        let kind = match what {
            stabilise::Outcome::Rewritten => "rewritten",
            stabilise::Outcome::Integrated => "integrated",
            stabilise::Outcome::AsWritten => "as_written",
            stabilise::Outcome::Left(_) => "left",
        };
        json!({"function": function, "outcome": kind, "what": outcome(what), "certificate": certificate})
    });
    json!({
        "table": name,
        "functions": functions.collect::<Vec<_>>(),
        "kernels": stabilised.kernels,
    })
}

/// The changes, and the accuracy that they reach.
fn summary(name: &str, stabilised: &Stabilised, certificates: &[Certificate]) -> String {
    let mut text = format!("Rewritten from {name} by `umbrage stabilise`.\n\nFormulas:\n");
    for (function, what) in &stabilised.functions {
        let _ = writeln!(text, "  {function:<10} {}", outcome(what));
    }
    if !stabilised.kernels.is_empty() {
        let _ = writeln!(text, "Functions of one variable that were added: {}", stabilised.kernels.join(", "));
    }
    if certificates.is_empty() {
        return text;
    }
    text.push_str(
        "\nCertificate: f32 against the original in 384 bits, singular points by their limits. `units` is the\n\
         largest error divided by what half a unit in the last place of each input can change, plus half a\n\
         unit in the last place of the declared scale or else of the value. `admitted` bounds the units of every\n\
         executor that keeps WGSL's accuracy rules, at the same points, by intervals.\n\n",
    );
    let _ = writeln!(
        text,
        "  {:<8} {:>6}  {:>10} {:>8} {:>8}   {:>10} {:>8} {:>8}  {:>7} {:>9}",
        "function", "points", "not finite", "error", "units", "not finite", "error", "units", "claimed", "admitted"
    );
    for certificate in certificates {
        let of = |m: &Measured| format!("{:>10} {:>8.1e} {:>8.1e}", m.not_finite, m.error, m.units);
        let claimed = certificate.claimed.map_or_else(|| "-".to_owned(), |times| times.to_string());
        let admitted = certificate.admitted.as_ref().map_or_else(|_| "no bound".to_owned(), |b| format!("{b:.1e}"));
        let _ = writeln!(
            text,
            "  {:<8} {:>6}  {}   {}  {claimed:>7} {admitted:>9}",
            certificate.name,
            certificate.points,
            of(&certificate.before),
            of(&certificate.after)
        );
    }
    text.push_str("  The first three columns are the original's, the others those of this table.\n");
    for certificate in certificates {
        if let Err(reason) = &certificate.admitted {
            let _ = writeln!(text, "  No bound of {}: {reason}.", certificate.name);
        }
    }
    text
}
