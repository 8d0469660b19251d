//! `umbrage completions` and `umbrage man`, made from the definitions of the arguments.

use std::io::{self, Write};
use std::path::PathBuf;

use clap::CommandFactory;
use clap_complete::Shell;
use clap_mangen::Man;

use super::messages::{Format, Report};
use super::{Arguments, Outcome, Result};
use crate::build::{self, Artifact};

/// Arguments of `umbrage completions`.
#[derive(clap::Args)]
pub(super) struct CompletionArguments {
    /// The shell that is to complete command lines
    #[arg(value_enum, value_name = "SHELL")]
    shell: Shell,
}

/// Arguments of `umbrage man`.
#[derive(clap::Args)]
pub(super) struct ManArguments {
    /// Directory for the pages of all subcommands, umbrage.1, umbrage-build.1, ... [default: the main page, on standard
    /// output]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Writes a script for a shell to standard output.
pub(super) fn completions(arguments: &CompletionArguments) -> Result<Outcome> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Arguments::command(), "umbrage", &mut script);
    let mut out = io::stdout().lock();
    out.write_all(&script)?;
    out.flush()?;
    Ok(Outcome::Clean)
}

/// Writes the manual.
pub(super) fn man(arguments: &ManArguments, report: &Report) -> Result<Outcome> {
    let mut out = io::stdout().lock();
    let Some(directory) = &arguments.output else {
        Man::new(Arguments::command()).render(&mut out)?;
        out.flush()?;
        return Ok(Outcome::Clean);
    };
    let mut pages = Vec::new();
    let mut command = Arguments::command();
    command.build();
    page(command, &mut pages)?;
    build::write(directory, &pages)?;
    if report.format == Format::Human {
        writeln!(out, "{}: {} pages", directory.display(), pages.len())?;
    }
    Ok(Outcome::Clean)
}

/// The page of a command, and those of its subcommands.
fn page(command: clap::Command, pages: &mut Vec<Artifact>) -> Result<()> {
    for inner in command.get_subcommands().filter(|inner| inner.get_name() != "help") {
        page(inner.clone(), pages)?;
    }
    let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
    let mut contents = Vec::new();
    Man::new(command).render(&mut contents)?;
    pages.push(Artifact { path: format!("{name}.1").into(), contents });
    Ok(())
}
