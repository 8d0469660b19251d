//! Files: reading them within bounds, and writing them all or nothing.
//!
//! A file appears, or is replaced, only once everything that belongs into it
//! was computed and written. Until then it is a temporary file beside it, which
//! vanishes if something goes wrong. A file that existed keeps its permissions;
//! a new one gets those that the user's umask gives to new files.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::diag::{Diagnostic, Failure, Source, codes};

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
    let mut file = PendingFile::create(path)?;
    file.write_all(bytes).map_err(|error| unwritable(path, &error))?;
    file.commit()
}

/// A path as messages show it: the same on every platform.
pub fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// A file that is being written, and is not visible yet.
pub(crate) struct PendingFile {
    /// The path as the caller named it.
    path: PathBuf,
    place: Place,
}

enum Place {
    /// A temporary file, and the file that it becomes.
    File(BufWriter<NamedTempFile>, PathBuf),
    /// A device or pipe, which cannot be replaced; written at the end.
    Special(Vec<u8>),
}

impl PendingFile {
    /// Prepares to write to a path.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        if path.is_dir() {
            let error = Diagnostic::error(codes::UNWRITABLE, "is a directory, a file was expected");
            return Err(Failure::bare(shown(path), error.help("name a file in it")));
        }
        // The file that a link leads to is replaced, not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let path = path.to_owned();
        if fs::metadata(&target).is_ok_and(|m| !m.is_file()) {
            return Ok(Self { path, place: Place::Special(Vec::new()) });
        }
        let directory = target.parent().filter(|d| !d.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".umbrage-");
        // A temporary file is private by default; this one is to become an ordinary file.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        match builder.tempfile_in(directory) {
            Ok(file) => Ok(Self { path, place: Place::File(BufWriter::new(file), target) }),
            Err(error) => Err(unwritable(&path, &error)),
        }
    }

    /// The path as the caller named it.
    #[cfg(feature = "cli")]
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Makes what was written visible.
    pub(crate) fn commit(self) -> Result<(), Failure> {
        let Self { path, place } = self;
        let written = match place {
            Place::Special(bytes) => {
                let written = File::options().write(true).open(&path).and_then(|mut file| file.write_all(&bytes));
                match written {
                    // The reader of a pipe may have seen enough.
                    Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
                    written => written,
                }
            }
            Place::File(writer, target) => replace(writer, &target),
        };
        written.map_err(|error| unwritable(&path, &error))
    }
}

fn replace(writer: BufWriter<NamedTempFile>, target: &Path) -> io::Result<()> {
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Ok(old) = fs::metadata(target) {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.persist(target).map_err(|error| error.error)?;
    Ok(())
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.place {
            Place::File(file, _) => file.write(bytes),
            Place::Special(buffer) => buffer.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.place {
            Place::File(file, _) => file.flush(),
            Place::Special(_) => Ok(()),
        }
    }
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
    Ok(bytes)
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
