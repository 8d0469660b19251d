//! `umbrage errata`: misprints found in a table, and how well mistakes are found in general.

use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressDrawTarget};

use super::output::Sink;
use super::{Outcome, Result};
use crate::analyse::trial;
use crate::diag::{Diagnostic, Failure, codes};
use crate::program::Program;
use crate::table::Table;
use crate::text::file::shown;

/// Arguments of `umbrage errata`.
#[derive(clap::Args)]
pub(super) struct ErrataArguments {
    /// Pairs of tables: one as printed, then the same one mended, with its `errata`
    #[arg(required = true, num_args = 2.., value_name = "TABLE")]
    tables: Vec<PathBuf>,
    /// Mistakes to make in each mended table, to see how many are found; 0 for none
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    mistakes: usize,
    /// Start of the random numbers
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    seed: u64,
    /// The file for the report, in Markdown; `-` is standard output
    #[arg(long, short, value_name = "FILE", default_value = "-")]
    output: PathBuf,
}

/// Writes the report.
pub(super) fn run(arguments: &ErrataArguments) -> Result<Outcome> {
    let mut pairs = Vec::new();
    for pair in arguments.tables.chunks(2) {
        let [printed, mended] = pair else {
            let error = Diagnostic::error(codes::UNREADABLE, "has no partner");
            let help = "tables come in pairs: one as printed, then the same one mended";
            return Err(Failure::bare(shown(&pair[0]), error.help(help)).into());
        };
        pairs.push((Program::read(printed)?, Program::read(mended)?, Table::read(mended)?));
    }
    let mut sink = Sink::create(&arguments.output)?;
    let mut text = String::from(
        "# Errata\n\nWritten by `cargo xtask errata`; a test keeps it current.\n\
         What the analyses of `umbrage check` find in published tables by themselves, and what they leave.\n\n",
    );
    for (printed, mended, _) in &pairs {
        text.push_str(&trial::errata(printed, mended));
    }
    if arguments.mistakes > 0 {
        text.push_str(&format!(
            "## Seeded mistakes\n\n\
             One small mistake is made in a mended table, {} times each, of six kinds in turn (seed {}). A\n\
             mistake is *harmless* if the table gives the same wherever the assumptions hold, as far as sampled\n\
             points tell; *refused* if no meaningful table is left. The others are *caught* if `check` says\n\
             something that it does not say of the right table, with its examples taken away; that a name in an\n\
             `allow` is about nothing any more counts as well. The last column is the share of what is caught\n\
             among mistakes that are not harmless.\n\n",
            arguments.mistakes, arguments.seed
        ));
        for (_, mended, table) in &pairs {
            let bar = ProgressBar::new(arguments.mistakes as u64);
            if !io::stderr().is_terminal() {
                bar.set_draw_target(ProgressDrawTarget::hidden());
            }
            let tallies = trial::survey(table, arguments.mistakes, arguments.seed, |n| bar.set_position(n as u64))?;
            bar.finish_and_clear();
            text.push_str(&trial::seeded(&mended.name, &tallies));
        }
    }
    let written = sink.write_all(text.trim_end().as_bytes()).and_then(|()| sink.write_all(b"\n"));
    if let Err(error) = written {
        return Err(sink.failure(&error).into());
    }
    sink.finish()?;
    Ok(Outcome::Clean)
}
