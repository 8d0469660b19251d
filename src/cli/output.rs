//! Results of commands: to files, all or none, or to standard output.

use std::collections::BTreeSet;
use std::io::{self, IsTerminal, StdoutLock, Write};
use std::path::Path;

use super::Result;
use crate::diag::{Diagnostic, Failure, codes, visible};
#[cfg(feature = "gpu")]
use crate::text::file::Home;
use crate::text::file::{self, PendingFile, STDOUT, shown, unwritable};

/// The place of a result.
pub(super) enum Sink {
    /// Standard output, written at the end.
    Stdout(Vec<u8>),
    /// A file, replaced at the end, also if the command has read it.
    File(PendingFile, Replaces),
}

/// The files that a result may replace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Replaces {
    /// All but those that the command reads.
    Others,
    /// Those that the command reads, too, because it is there to change them.
    Inputs,
}

impl Sink {
    /// Prepares to write to `path`, `-` being standard output. Nothing is visible yet.
    pub(super) fn create(path: &Path) -> std::result::Result<Self, Failure> {
        let sink = Self::new(path, Replaces::Others)?;
        sink.refuse_input()?;
        Ok(sink)
    }

    /// Prepares to change a file that was read.
    pub(super) fn replace(path: &Path) -> std::result::Result<Self, Failure> {
        Self::new(path, Replaces::Inputs)
    }

    fn new(path: &Path, replaces: Replaces) -> std::result::Result<Self, Failure> {
        match path.to_str() {
            Some("-") => Ok(Sink::Stdout(Vec::new())),
            _ => PendingFile::create(path).map(|file| Sink::File(file, replaces)),
        }
    }

    /// Prepares to write several results of one command, those that were asked for.
    pub(super) fn several<const N: usize>(
        paths: [Option<&Path>; N],
    ) -> std::result::Result<[Option<Self>; N], Failure> {
        let mut sinks = [const { None }; N];
        for (sink, path) in sinks.iter_mut().zip(paths) {
            *sink = path.map(Self::create).transpose()?;
        }
        refuse_twice(sinks.iter().flatten())?;
        Ok(sinks)
    }

    fn target(&self) -> Option<&Path> {
        match self {
            Sink::Stdout(_) => None,
            Sink::File(file, _) => file.target(),
        }
    }

    /// Refuses to replace what the command reads.
    fn refuse_input(&self) -> std::result::Result<(), Failure> {
        match self {
            Sink::File(file, Replaces::Others) if file.target().is_some_and(file::was_read) => {
                let error = Diagnostic::error(codes::UNWRITABLE, "is read by this command, and would be replaced");
                Err(Failure::bare(shown(file.path()), error.help("write to another file")))
            }
            Sink::File(..) | Sink::Stdout(_) => Ok(()),
        }
    }

    /// Makes what was written visible.
    pub(super) fn finish(self) -> Result<()> {
        finish_all([self])
    }

    /// A failure to write to this place.
    pub(super) fn failure(&self, error: &io::Error) -> Failure {
        match error.get_ref().and_then(|error| error.downcast_ref::<Failure>()) {
            Some(failure) => failure.clone(),
            None => unwritable(self.path(), error),
        }
    }

    fn path(&self) -> &Path {
        match self {
            Sink::Stdout(_) => Path::new(STDOUT),
            Sink::File(file, _) => file.path(),
        }
    }

    /// An error that knows the file that it is about, so that nobody takes it for one of standard output.
    fn named(&self, error: io::Error) -> io::Error {
        io::Error::new(error.kind(), self.failure(&error))
    }
}

/// Refuses two results in one file.
fn refuse_twice<'s>(sinks: impl Iterator<Item = &'s Sink>) -> std::result::Result<(), Failure> {
    let mut targets = BTreeSet::new();
    for sink in sinks {
        if sink.target().is_some_and(|target| !targets.insert(target)) {
            let error = Diagnostic::error(codes::UNWRITABLE, "is the place of two results");
            return Err(Failure::bare(shown(sink.path()), error.help("name a file for each")));
        }
    }
    Ok(())
}

/// Makes what was written to several places visible, all of it or nothing.
pub(super) fn finish_all(sinks: impl IntoIterator<Item = Sink>) -> Result<()> {
    finish(sinks, file::commit)
}

/// The same, in a directory that this process has for itself.
#[cfg(feature = "gpu")]
pub(super) fn finish_in(home: &Home, sinks: impl IntoIterator<Item = Sink>) -> Result<()> {
    finish(sinks, |files| home.commit(files))
}

fn finish(
    sinks: impl IntoIterator<Item = Sink>,
    commit: impl FnOnce(Vec<PendingFile>) -> std::result::Result<(), Failure>,
) -> Result<()> {
    let sinks: Vec<Sink> = sinks.into_iter().collect();
    // Some was perhaps read after its place was prepared.
    sinks.iter().try_for_each(Sink::refuse_input)?;
    refuse_twice(sinks.iter())?;
    let (mut files, mut text) = (Vec::new(), Vec::new());
    for sink in sinks {
        match sink {
            Sink::Stdout(bytes) => text.extend(bytes),
            Sink::File(file, _) => files.push(file),
        }
    }
    commit(files)?;
    // What another program reads is as it is; a terminal is shown no characters that act on it.
    let mut out: Box<dyn Write> =
        if io::stdout().is_terminal() { Box::new(stdout()) } else { Box::new(io::stdout().lock()) };
    out.write_all(&text)?;
    out.flush()?;
    Ok(())
}

/// Standard output for people, where texts of tables are visible and do nothing.
pub(super) fn stdout() -> Visible<StdoutLock<'static>> {
    Visible(io::stdout().lock())
}

/// Writes text in which characters that act are written out.
pub(super) struct Visible<W>(W);

impl<W: Write> Write for Visible<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for chunk in bytes.utf8_chunks() {
            self.0.write_all(visible(chunk.valid()).as_bytes())?;
            if !chunk.invalid().is_empty() {
                self.0.write_all("\u{fffd}".as_bytes())?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = match self {
            Sink::Stdout(buffer) => buffer.write(bytes),
            Sink::File(file, _) => file.write(bytes),
        };
        written.map_err(|error| self.named(error))
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = match self {
            Sink::Stdout(_) => Ok(()),
            Sink::File(file, _) => file.flush(),
        };
        flushed.map_err(|error| self.named(error))
    }
}
