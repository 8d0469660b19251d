//! `umbrage lsp`: tables in editors.

use std::io;

use super::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::lsp::{self, End};
use crate::text::file::STDIN;

/// Arguments of `umbrage lsp`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Ignored: standard input and output are all that there is. Some editors say so
    #[arg(long, hide = true)]
    stdio: bool,
}

/// Talks to an editor. As the protocol asks, one that goes away without a word leads to exit code 1.
pub(super) fn run(arguments: &Arguments) -> Result<Outcome> {
    let Arguments { stdio: _ } = arguments;
    match lsp::serve(io::stdin().lock(), io::stdout()) {
        End::Orderly => Ok(Outcome::Clean),
        End::Early => Ok(Outcome::Findings),
        End::Nonsense(reason) => {
            let message = format!("is not the Language Server Protocol: {reason}");
            let error = Diagnostic::error(codes::UNREADABLE, message)
                .help("this command is started by an editor; docs/editors.md says how");
            Err(Failure::bare(STDIN, error).into())
        }
    }
}
