//! The language server: tables in editors, over the Language Server Protocol.
//!
//! What is said of a table, `analyse` and `explain` know; where its names are declared and
//! used, `uses`; which fields there are, `table::fields`. Here all of it is put into the words
//! of the protocol: one file for each thing that an editor asks for. The client is trusted as
//! little as a table: whatever it sends leads to an answer or to an end, not to a panic.

mod complete;
mod diagnose;
mod document;
mod hover;
mod navigate;
mod outline;
mod place;
mod rename;
mod repair;
mod server;
mod settings;
mod transport;

use std::io::{BufRead, Write};

/// The end of a conversation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// The client has said goodbye.
    Orderly,
    /// The client went away without a word.
    Early,
    /// Something came that is not this protocol: the reason.
    Nonsense(String),
}

/// Talks to a client until either side ends.
pub fn serve(input: impl BufRead, output: impl Write + Send + 'static) -> End {
    server::Server::new(transport::Outlet::new(output)).run(input)
}
