//! `umbrage profile diff`: what is more or less frequent in a second profile.

use std::io::Write;
use std::path::PathBuf;

use serde_json::json;

use crate::cli::messages::{Format, Report};
use crate::cli::output::stdout;
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::{self, changes, total_variation};
use crate::text::file::shown;

/// Arguments of `umbrage profile diff`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The profile to compare with
    before: PathBuf,
    /// The profile to compare
    after: PathBuf,
}

pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let (before, after) = (profile::read(&arguments.before)?, profile::read(&arguments.after)?);
    if before.table != after.table {
        let message = format!("is a profile of the table `{}`, not of `{}`", after.table, before.table);
        let error = Diagnostic::error(codes::OTHER_PROFILE, message).help("compare profiles of one table");
        return Err(Failure::bare(shown(&arguments.after), error).into());
    }
    let found = changes(&before, &after);
    let variation = total_variation(&before, &after);
    let mut out = stdout();
    if report.format == Format::Json {
        let cases = found.iter().map(|change| {
            let case = change.case.map_or(json!("default"), |case| json!(case));
            json!({"case": case, "before": change.before, "after": change.after})
        });
        let object = json!({
            "table": before.table,
            "same_table": before.fingerprint == after.fingerprint,
            "total_variation": variation,
            "cases": cases.collect::<Vec<_>>(),
        });
        writeln!(out, "{object}")?;
        out.flush()?;
        return Ok(Outcome::Clean);
    }
    if before.fingerprint != after.fingerprint {
        writeln!(out, "the table `{}` did not mean the same when the profiles were counted", before.table)?;
    }
    writeln!(out, "     case   before    after   change")?;
    for change in &found {
        let case = change.case.map_or("default".to_owned(), |case| case.to_string());
        let (before, after) = (100.0 * change.before, 100.0 * change.after);
        writeln!(out, "  {case:>7} {before:>7.2}% {after:>7.2}% {:>+7.2}", after - before)?;
    }
    match variation {
        Some(share) => {
            writeln!(
                out,
                "{:.2} % of the evaluations would have to be in other states to make them equal",
                100.0 * share
            )?;
        }
        None => writeln!(out, "their states are not comparable: the inputs of the table have changed")?,
    }
    out.flush()?;
    Ok(Outcome::Clean)
}
