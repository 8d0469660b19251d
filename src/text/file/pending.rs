//! A file that is being written and is not visible yet.

use std::fs::{self, File};
use std::io::{self, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};

use super::{shown, unwritable};
use crate::diag::{Diagnostic, Failure, codes};

/// A file that is being written, and is not visible yet.
///
/// Until it is, it is a file without a name, of which nothing is left whatever ends this process.
pub(crate) struct PendingFile {
    /// The path as the caller named it.
    path: PathBuf,
    place: Place,
}

enum Place {
    /// A file without a name, and the file that its contents go to.
    File(BufWriter<File>, PathBuf),
    /// The contents, and the file that they go to.
    Whole(Vec<u8>, PathBuf),
    /// A device or pipe, which cannot be replaced; written at the end.
    Special(Vec<u8>),
}

impl PendingFile {
    /// Prepares to write to a path.
    #[cfg_attr(not(feature = "cli"), expect(dead_code, reason = "only commands write what comes bit by bit"))]
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let place = match target(path)? {
            None => Place::Special(Vec::new()),
            Some(target) => {
                let spool = tempfile::tempfile_in(directory(&target)).map_err(|error| unwritable(path, &error))?;
                Place::File(BufWriter::new(spool), target)
            }
        };
        Ok(Self { path: path.to_owned(), place })
    }

    /// Prepares a file of which all is known.
    pub(crate) fn whole(path: &Path, contents: Vec<u8>) -> Result<Self, Failure> {
        let place = match target(path)? {
            None => Place::Special(contents),
            Some(target) => Place::Whole(contents, target),
        };
        Ok(Self { path: path.to_owned(), place })
    }

    /// The path as the caller named it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file that will be replaced, links followed; `None` of a device or pipe.
    pub(crate) fn target(&self) -> Option<&Path> {
        match &self.place {
            Place::File(_, target) | Place::Whole(_, target) => Some(target),
            Place::Special(_) => None,
        }
    }

    /// Writes the contents to a new file with the permissions of the one that it will replace.
    pub(super) fn stage(self, staged: &Path) -> io::Result<()> {
        let mut options = File::options();
        options.write(true).create_new(true);
        let mut file = match options.open(staged) {
            // Left by a process that had the number of this one.
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                fs::remove_file(staged)?;
                options.open(staged)?
            }
            opened => opened?,
        };
        let target = match self.place {
            Place::File(spool, target) => {
                let mut spool = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
                spool.rewind()?;
                io::copy(&mut spool, &mut file)?;
                target
            }
            Place::Whole(contents, target) => {
                file.write_all(&contents)?;
                target
            }
            Place::Special(_) => return Ok(()),
        };
        match fs::metadata(target) {
            Ok(old) => file.set_permissions(old.permissions()),
            Err(_) => Ok(()),
        }
    }

    /// Writes to a device or pipe.
    pub(super) fn deliver(self) -> Result<(), Failure> {
        let Place::Special(bytes) = self.place else { return Ok(()) };
        let opened = File::options().write(true).open(&self.path);
        match opened.and_then(|mut file| file.write_all(&bytes)) {
            // The reader of a pipe may have seen enough.
            Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
            written => written.map_err(|error| unwritable(&self.path, &error)),
        }
    }
}

impl Write for PendingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.place {
            Place::File(spool, _) => spool.write(bytes),
            Place::Whole(contents, _) | Place::Special(contents) => contents.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.place {
            Place::File(spool, _) => spool.flush(),
            Place::Whole(..) | Place::Special(_) => Ok(()),
        }
    }
}

/// The directory of a file.
pub(super) fn directory(path: &Path) -> &Path {
    path.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The file that a path leads to, for it is replaced and not the link; `None` of a device or pipe.
fn target(path: &Path) -> Result<Option<PathBuf>, Failure> {
    if path.is_dir() {
        let error = Diagnostic::error(codes::UNWRITABLE, "is a directory, a file was expected");
        return Err(Failure::bare(shown(path), error.help("name a file in it")));
    }
    if let Ok(target) = fs::canonicalize(path) {
        return Ok(fs::metadata(&target).map_or(true, |m| m.is_file()).then_some(target));
    }
    let directory = fs::canonicalize(directory(path)).map_err(|error| unwritable(path, &error))?;
    Ok(Some(directory.join(path.file_name().unwrap_or_default())))
}
