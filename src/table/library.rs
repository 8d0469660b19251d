//! Texts that tables find beside them: files, or what a program brought along instead.
//!
//! Tables that are part of a program import each other as those in a directory do. They are
//! looked up by path among the texts of the program, and then nothing is read from a disk.

use std::path::Path;

use super::MAX_BYTES;
use crate::diag::{Diagnostic, Failure, codes};
use crate::text::file::{read_text, shown};

/// The place where what a table names is looked for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Library {
    /// Among files.
    Disk,
    /// Among these texts, each with its path.
    Texts(&'static [(&'static str, &'static str)]),
}

impl Library {
    /// The text at a path.
    pub(super) fn read(self, path: &Path) -> Result<String, Failure> {
        match self {
            Library::Disk => read_text(path, MAX_BYTES),
            Library::Texts(texts) => {
                let found = texts.iter().find(|(known, _)| Path::new(known) == path);
                let missing =
                    || Failure::bare(shown(path), Diagnostic::error(codes::UNREADABLE, "is not part of this program"));
                found.map(|(_, text)| (*text).to_owned()).ok_or_else(missing)
            }
        }
    }
}
