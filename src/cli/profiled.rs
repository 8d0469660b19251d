//! Profiles given to commands that only look at frequencies.

use std::path::Path;

use super::messages::Report;
use crate::diag::Failure;
use crate::diag::{Diagnostic, codes};
use crate::profile::{self, Fitted};
use crate::program::Program;
use crate::text::file::shown;
use crate::tuned::{Choice, Tuned};

/// Reads the profile of a table; says what of it was lost, if the table has changed.
pub(super) fn read(program: &Program, path: Option<&Path>, report: &Report) -> Result<Option<Fitted>, Failure> {
    let Some(path) = path else { return Ok(None) };
    let fitted = profile::fit(program, profile::read(path)?, &shown(path))?;
    if let Some(warning) = &fitted.warning {
        report.failure(&Failure::bare(shown(path), warning.clone()));
    }
    Ok(Some(fitted))
}

/// Reads what was tuned on a device.
pub(super) fn tuned(path: &Path) -> Result<Tuned, Failure> {
    Tuned::read(path)?.ok_or_else(|| {
        let error = Diagnostic::error(codes::UNREADABLE, "cannot be read: no such file or directory");
        Failure::bare(shown(path), error.help("`umbrage tune` writes such files"))
    })
}

/// The device, and what was chosen on it for this very text of a table.
pub(super) fn choice<'t>(program: &Program, tuned: &'t Tuned) -> Result<(&'t str, &'t Choice), Failure> {
    let found = tuned.choice(program).map(|choice| (tuned.device.as_str(), choice));
    found.ok_or_else(|| {
        let message = format!("nothing was tuned for this text of `{}` on {}", program.name, tuned.device);
        let error = Diagnostic::error(codes::BAD_TUNED, message);
        Failure::bare(program.source.name.clone(), error.help("run `umbrage tune` again, or leave out --tuned"))
    })
}
