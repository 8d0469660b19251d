//! `umbrage report`: everything about a table on one page.

use std::io::Write;
use std::path::PathBuf;

use super::messages::Report;
use super::output::Sink;
use super::{Outcome, Result, profiled};
use crate::program::Program;
use crate::report::{self, Known};

/// Arguments of `umbrage report`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// The function of a table of functions
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// The file for the page
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Profile: how often each case is taken
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
    /// The choice of `umbrage tune` on some device
    #[arg(long, value_name = "FILE")]
    tuned: Option<PathBuf>,
}

/// Writes the page.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let program = Program::read_function(&arguments.table, arguments.function.as_deref())?;
    let fitted = profiled::read(&program, arguments.profile.as_deref(), report)?;
    let tuned = arguments.tuned.as_deref().map(profiled::tuned).transpose()?;
    let choice = tuned.as_ref().zip(arguments.tuned.as_deref());
    let choice = choice.map(|(tuned, path)| profiled::choice(&program, tuned, path)).transpose()?;
    let known = Known { profile: fitted.as_ref().map(|fitted| &fitted.profile), tuned: choice };
    let mut sink = Sink::create(&arguments.output)?;
    let page = report::page(&program, known)?;
    sink.write_all(page.as_bytes()).map_err(|error| sink.failure(&error))?;
    sink.finish()?;
    Ok(Outcome::Clean)
}
