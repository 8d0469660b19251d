//! Profiles given to commands that only look at frequencies.

use std::path::Path;

use super::messages::Report;
use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::profile::{self, Fitted};
use crate::program::Program;
use crate::text::file::shown;
use crate::tuned::{Choice, Tuned, tune};

/// Says what is not as it was when a profile was counted. Returns whether there is anything.
pub(super) fn say(fitted: &Fitted, report: &Report) -> bool {
    let said: Vec<_> = fitted.lost.iter().chain(&fitted.aged).cloned().collect();
    report.show(&Source::new("", ""), &said);
    !said.is_empty()
}

/// Reads the profile of a table; says what of it was lost, if the table has changed.
pub(super) fn read(program: &Program, path: Option<&Path>, report: &Report) -> Result<Option<Fitted>, Failure> {
    let Some(path) = path else { return Ok(None) };
    let fitted = profile::fit(program, profile::read(path)?, &shown(path))?;
    say(&fitted, report);
    Ok(Some(fitted))
}

/// Reads what was tuned on a device.
pub(super) fn tuned(path: &Path) -> Result<Tuned, Failure> {
    Tuned::read(path)?.ok_or_else(|| {
        let error = Diagnostic::error(codes::UNREADABLE, "cannot be read: no such file or directory");
        Failure::bare(shown(path), error.help("`umbrage tune` writes such files"))
    })
}

/// The device, and what was chosen on it for what a table means.
pub(super) fn choice<'t>(program: &Program, tuned: &'t Tuned, path: &Path) -> Result<(&'t str, &'t Choice), Failure> {
    tuned.choice(program).map(|(choice, _)| (tuned.device.as_str(), choice)).map_err(|reason| {
        let message = format!("has no choice for `{}` that can be used: {reason}", program.name);
        let directory = path.parent().unwrap_or(path);
        let error = Diagnostic::error(codes::BAD_TUNED, message).help(tune(program, &tuned.device, directory));
        Failure::bare(shown(path), error.help("or leave out --tuned"))
    })
}
