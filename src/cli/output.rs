//! Writing results: all or nothing.
//!
//! A file appears, or is replaced, only once everything that belongs into it
//! has been computed and written. Until then it is a temporary file beside it,
//! which vanishes if something goes wrong.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::Result;
use crate::diag::{Diagnostic, Failure, codes};
use crate::table::io_reason;

/// Where results go.
pub(super) enum Sink {
    /// Standard output, written at the end.
    Stdout(Vec<u8>),
    /// A device or pipe, which cannot be replaced; written at the end.
    Special(Vec<u8>, PathBuf),
    /// A file, replaced at the end.
    File(BufWriter<NamedTempFile>, PathBuf),
}

impl Sink {
    /// Prepares to write to `path`, `-` being standard output. Nothing is visible yet.
    pub(super) fn create(path: &Path) -> std::result::Result<Self, Failure> {
        if path.as_os_str() == "-" {
            return Ok(Sink::Stdout(Vec::new()));
        }
        if path.is_dir() {
            let error = Diagnostic::error(codes::UNWRITABLE, "is a directory, a file was expected");
            return Err(Failure::bare(shown(path), error.help("name a file in it")));
        }
        // The file that a link leads to is replaced, not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&target).is_ok_and(|m| !m.is_file()) {
            return Ok(Sink::Special(Vec::new(), target));
        }
        let directory = target.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".umbrage-");
        // A temporary file is private by default; this one is to become an ordinary file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        match builder.tempfile_in(directory) {
            Ok(file) => Ok(Sink::File(BufWriter::new(file), target)),
            Err(error) => Err(unwritable(path, &error)),
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
            Sink::Special(bytes, path) => {
                let written = File::options().write(true).open(&path).and_then(|mut file| file.write_all(&bytes));
                match written {
                    Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                        return Err(unwritable(&path, &error).into());
                    }
                    _ => {}
                }
            }
            Sink::File(writer, path) => {
                let file = writer.into_inner().map_err(|e| unwritable(&path, e.error()))?;
                if let Ok(old) = fs::metadata(&path) {
                    file.as_file().set_permissions(old.permissions()).map_err(|e| unwritable(&path, &e))?;
                }
                file.persist(&path).map_err(|e| unwritable(&path, &e.error))?;
            }
        }
        Ok(())
    }

    /// A failure to write to this place.
    pub(super) fn failure(&self, error: &io::Error) -> Failure {
        match self {
            Sink::Stdout(_) => unwritable(Path::new("standard output"), error),
            Sink::Special(_, path) | Sink::File(_, path) => unwritable(path, error),
        }
    }
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stdout(buffer) | Sink::Special(buffer, _) => buffer.write(bytes),
            Sink::File(file, _) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stdout(_) | Sink::Special(..) => Ok(()),
            Sink::File(file, _) => file.flush(),
        }
    }
}

fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let message = format!("cannot be written: {}", io_reason(error));
    let help = match error.kind() {
        io::ErrorKind::NotFound => "create the directory first, or choose another one",
        io::ErrorKind::StorageFull => "make room, or choose another place",
        _ => "check the path and the permissions of its directory",
    };
    Failure::bare(shown(path), Diagnostic::error(codes::UNWRITABLE, message).help(help))
}
