//! Profiles given to commands that only look at frequencies.

use std::path::Path;

use super::report::Report;
use crate::diag::Failure;
use crate::profile::{self, Fitted, Profile};
use crate::program::Program;

/// Reads the profile of a table; says what of it was lost, if the table has changed.
pub(super) fn read(program: &Program, path: Option<&Path>, report: &Report) -> Result<Option<Fitted>, Failure> {
    let Some(path) = path else { return Ok(None) };
    let fitted = profile::fit(program, profile::read(path)?, &path.to_string_lossy().replace('\\', "/"))?;
    if let Some(warning) = &fitted.warning {
        report.failure(&Failure::bare(path.to_string_lossy().replace('\\', "/"), warning.clone()));
    }
    Ok(Some(fitted))
}

/// How often each row is taken, as a share of all evaluations.
pub(super) fn shares(program: &Program, profile: &Profile) -> Vec<f64> {
    let found = profile::frequencies(profile);
    let of = |id: u32| found.iter().find(|frequency| frequency.case == Some(id)).map_or(0.0, |f| f.share);
    program.rows.iter().map(|row| of(row.id)).collect()
}
