//! Random tables, and files made wrong, by the thousand: what must hold of them, does it?
//!
//! `cargo xtask fuzz --minutes 10` runs this. Cases are made of bytes ([`choices`]), tables
//! of choices ([`tables`]), wrong files of right ones ([`mutate`], [`corpus`]); [`targets`] lists
//! what is tried, [`judge`] says what must hold, [`run`] runs it in processes of its own, so that
//! what ends a process, or does not end, is a fault like others, and makes reproducers small.

mod choices;
mod command;
mod corpus;
mod judge;
mod mutate;
mod run;
mod tables;
mod targets;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Tries random tables and files made wrong.
#[derive(Parser)]
#[command(name = "cargo xtask fuzz", args_conflicts_with_subcommands = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    options: Options,
}

/// The extent of a run.
#[derive(clap::Args, Clone)]
struct Options {
    /// Minutes that it takes, making reproducers small aside
    #[arg(long, default_value_t = 10.0, value_name = "MINUTES", conflicts_with = "cases")]
    minutes: f64,
    /// Instead of minutes, a number of cases: as many of each target as its share of the time says
    #[arg(long, value_name = "COUNT")]
    cases: Option<u64>,
    /// The seed that all cases follow from [default: another one every time]
    #[arg(long, value_name = "NUMBER")]
    seed: Option<u64>,
    /// Processes at once [default: one per core]
    #[arg(long, value_name = "COUNT")]
    jobs: Option<usize>,
    /// The directory for reproducers
    #[arg(long, value_name = "DIR")]
    faults: Option<PathBuf>,
    /// Keep reproducers as they were found
    #[arg(long)]
    no_shrink: bool,
    /// What to try [default: everything]: the names are those of `list`
    #[arg(value_name = "TARGET")]
    targets: Vec<String>,
}

#[derive(Subcommand)]
enum Command {
    /// Name the targets
    List,
    /// Print a case as it was made
    Show {
        /// The target
        target: String,
        /// The seed
        #[arg(long)]
        seed: u64,
        /// The number of the case
        #[arg(long)]
        number: u64,
    },
    /// Judge reproducers again: directories in `faults/`
    Replay {
        /// The directories
        #[arg(required = true)]
        directories: Vec<PathBuf>,
    },
    /// Judge every file of the corpus as it is
    Corpus,
    /// What runs in a process of its own
    #[command(hide = true)]
    Worker(run::worker::Arguments),
    /// The same for one case
    #[command(hide = true)]
    Attempt {
        /// The directory of the case
        directory: PathBuf,
    },
}

fn main() -> ExitCode {
    if command::called() == "umbrage" {
        return umbrage::cli::main();
    }
    let arguments = Arguments::parse();
    let result = match arguments.command {
        None => run::run(&arguments.options),
        Some(Command::List) => {
            for target in targets::ALL {
                println!("{:<12} {}", target.name, target.about);
            }
            Ok(true)
        }
        Some(Command::Show { target, seed, number }) => run::show(&target, seed, number),
        Some(Command::Replay { directories }) => run::replay(&directories),
        Some(Command::Corpus) => run::corpus(),
        Some(Command::Worker(arguments)) => run::worker::run(&arguments),
        Some(Command::Attempt { directory }) => run::worker::attempt(&directory),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::from(2)
        }
    }
}
