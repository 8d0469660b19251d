//! Results of commands: to a file, all or nothing, or to standard output.

use std::io::{self, Write};
use std::path::Path;

use super::Result;
use crate::diag::Failure;
use crate::text::file::{PendingFile, unwritable};

/// The place of a result.
pub(super) enum Sink {
    /// Standard output, written at the end.
    Stdout(Vec<u8>),
    /// A file, replaced at the end.
    File(PendingFile),
}

impl Sink {
    /// Prepares to write to `path`, `-` being standard output. Nothing is visible yet.
    pub(super) fn create(path: &Path) -> std::result::Result<Self, Failure> {
        match path.to_str() {
            Some("-") => Ok(Sink::Stdout(Vec::new())),
            _ => PendingFile::create(path).map(Sink::File),
        }
    }

    /// Makes what was written visible.
    pub(super) fn finish(self) -> Result<()> {
        match self {
            Sink::Stdout(bytes) => {
                let mut out = io::stdout().lock();
                out.write_all(&bytes)?;
                out.flush()?;
            }
            Sink::File(file) => file.commit()?,
        }
        Ok(())
    }

    /// A failure to write to this place.
    pub(super) fn failure(&self, error: &io::Error) -> Failure {
        match self {
            Sink::Stdout(_) => unwritable(Path::new("standard output"), error),
            Sink::File(file) => unwritable(file.path(), error),
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stdout(buffer) => buffer.write(bytes),
            Sink::File(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stdout(_) => Ok(()),
            Sink::File(file) => file.flush(),
        }
    }
}
