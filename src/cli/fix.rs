//! `--fix`: inputs of a table that are decided.

use crate::diag::Failure;
use crate::program::Program;

/// Arguments of commands that decide inputs.
#[derive(clap::Args)]
pub(super) struct FixArguments {
    /// Decide inputs, as in b=entering,x=0.5: the table without them, called NAME_b_entering_x_0p5
    #[arg(long, value_name = "INPUT=LEVEL", value_delimiter = ',')]
    fix: Vec<String>,
}

impl FixArguments {
    /// The decisions, as they were written.
    pub(super) fn words(&self) -> &[String] {
        &self.fix
    }

    /// A program with the inputs decided.
    pub(super) fn apply(&self, program: Program) -> Result<Program, Failure> {
        if self.fix.is_empty() { Ok(program) } else { program.fix(&self.fix) }
    }
}
