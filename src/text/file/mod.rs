//! Files: reading them within bounds, and writing them all or nothing.
//!
//! A file appears, or is replaced, only once everything was computed and written that
//! belongs into it, or into a file that appears together with it. A file that existed
//! keeps its permissions; a new one gets those that the user's umask gives to new files.

mod home;
mod pending;

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use crate::diag::{Diagnostic, Failure, Source, codes};

#[cfg(feature = "cli")]
pub(crate) use home::settle;
pub(crate) use home::{Home, commit};
pub(crate) use pending::PendingFile;

/// The files that this process has read: what they say must not be replaced unasked.
static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Writes a file, all or nothing.
///
/// ```
/// # let folder = tempfile::tempdir()?;
/// let path = folder.path().join("table.txt");
/// umbrage::text::file::write(&path, b"complete")?;
/// assert_eq!(std::fs::read(&path)?, b"complete");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// When the file cannot be written, with the reason and what helps.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    commit(vec![PendingFile::whole(path, bytes.to_vec())?])
}

/// A path as messages show it: the same on every platform.
pub fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// The failure to write to a path.
pub(crate) fn unwritable(path: &Path, error: &io::Error) -> Failure {
    let message = format!("cannot be written: {}", io_reason(error));
    let help = match error.kind() {
        io::ErrorKind::NotFound => "create the directory first, or choose another one",
        io::ErrorKind::StorageFull => "make room, or choose another place",
        _ => "check the path and the permissions of its directory",
    };
    Failure::bare(shown(path), Diagnostic::error(codes::UNWRITABLE, message).help(help))
}

/// Reads a UTF-8 file of bounded size, with errors that say what to do.
pub(crate) fn read_text(path: &Path, max: u64) -> Result<String, Failure> {
    utf8(path, read_bytes(path, max)?)
}

/// The text that the bytes of a file are.
pub(crate) fn utf8(path: &Path, bytes: Vec<u8>) -> Result<String, Failure> {
    String::from_utf8(bytes).map_err(|e| unreadable(path, &not_utf8(&e), "save it as UTF-8"))
}

/// Reads a file of bounded size, with errors that say what to do.
pub(crate) fn read_bytes(path: &Path, max: u64) -> Result<Vec<u8>, Failure> {
    let io = |e: io::Error| {
        unreadable(path, &format!("cannot be read: {}", io_reason(&e)), "check the path and its permissions")
    };
    let metadata = match fs::metadata(path) {
        Err(error) if is_circular(path, &error) => {
            return Err(unreadable(path, "is a link that leads in a circle", "mend the link"));
        }
        metadata => metadata.map_err(io)?,
    };
    if metadata.is_dir() {
        return Err(unreadable(path, "is a directory, a file was expected", "name the file itself"));
    }
    // Reading a pipe may never begin, reading a device never end.
    if !metadata.is_file() {
        return Err(unreadable(
            path,
            "is a device or a pipe, a file was expected",
            "copy what it delivers into a file",
        ));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(io)?;
    // The size that a file system tells need not be true.
    file.take(max + 1).read_to_end(&mut bytes).map_err(io)?;
    if bytes.len() as u64 > max {
        return Err(unreadable(path, &format!("is larger than {} MiB", max >> 20), "split it"));
    }
    if let (Ok(mut read), Ok(path)) = (READ.lock(), fs::canonicalize(path)) {
        read.insert(path);
    }
    Ok(bytes)
}

/// Returns whether this process has read a file, given by its path without links.
#[cfg(feature = "cli")]
pub(crate) fn was_read(path: &Path) -> bool {
    READ.lock().is_ok_and(|read| read.contains(path))
}

/// Reads standard input to its end, which comes within a size.
#[cfg(feature = "cli")]
pub(crate) fn read_stdin(max: u64) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let fail = |message: &str, help: &str| unreadable(Path::new(STDIN), message, help);
    let read = io::stdin().lock().take(max + 1).read_to_end(&mut bytes);
    read.map_err(|e| fail(&format!("cannot be read: {}", io_reason(&e)), "pipe something into the command"))?;
    if bytes.len() as u64 > max {
        return Err(fail(&format!("is larger than {} MiB", max >> 20), "split it"));
    }
    Ok(bytes)
}

/// The name of standard output in messages.
#[cfg(feature = "cli")]
pub(crate) const STDOUT: &str = "standard output";

/// The name of standard input in messages.
#[cfg(feature = "cli")]
pub(crate) const STDIN: &str = "standard input";

/// Returns whether a path cannot be followed because its links have no end.
fn is_circular(path: &Path, error: &io::Error) -> bool {
    use io::ErrorKind;
    // There is no stable name for this kind of error.
    let named = [ErrorKind::NotFound, ErrorKind::PermissionDenied, ErrorKind::NotADirectory].contains(&error.kind());
    !named && fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink())
}

/// The failure to read a path, with what helps.
pub(crate) fn unreadable(path: &Path, message: &str, help: &str) -> Failure {
    Failure::bare(shown(path), Diagnostic::error(codes::UNREADABLE, message).help(help))
}

/// Says that bytes are not text, and where.
fn not_utf8(error: &std::string::FromUtf8Error) -> String {
    let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
    let (line, column) = Source::new("", String::from_utf8_lossy(good)).line_column(good.len());
    format!("is not UTF-8 text at line {line}, column {column}")
}

/// The reason of an I/O error in words that do not depend on the platform.
pub(crate) fn io_reason(error: &io::Error) -> String {
    use io::ErrorKind;
    match error.kind() {
        ErrorKind::NotFound => "no such file or directory".to_owned(),
        ErrorKind::PermissionDenied => "permission denied".to_owned(),
        ErrorKind::NotADirectory => "a part of the path is not a directory".to_owned(),
        ErrorKind::IsADirectory => "it is a directory".to_owned(),
        ErrorKind::StorageFull => "no space left".to_owned(),
        ErrorKind::ReadOnlyFilesystem => "the file system is read-only".to_owned(),
        _ => error.to_string(),
    }
}
