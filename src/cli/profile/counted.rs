//! Counts that a shader of the user's own has made, as hits of the lines of a table.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::cli::input::has_extension;
use crate::cli::output::Sink;
use crate::cli::{Outcome, Result};
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::{self, Hits};
use crate::program::Program;
use crate::text::file::{read_bytes, shown, utf8};

/// Largest file of counts, in bytes.
const MAX_BYTES: u64 = 16 << 20;

/// Writes what was counted as LCOV.
pub(super) fn run(table: &Path, files: &[PathBuf], lcov: &Path) -> Result<Outcome> {
    let program = Program::read(table)?;
    let outcomes = program.outcomes().len();
    let mut hits = Vec::new();
    for file in files {
        let counts = counts(file)?;
        let scene = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let counted = Hits::of_counts(&program, &scene, &counts).ok_or_else(|| {
            let message = format!("has {} counts, and `{}` has {outcomes} lines to count", counts.len(), program.name);
            let error = Diagnostic::error(codes::OTHER_PROFILE, message)
                .help("count with a shader that was generated from this very table: --target wgsl_counting");
            Failure::bare(shown(file), error)
        })?;
        hits.push(counted);
    }
    let mut sink = Sink::create(lcov)?;
    sink.write_all(profile::lcov(&program, &hits).as_bytes()).map_err(|error| sink.failure(&error))?;
    sink.finish()?;
    Ok(Outcome::Clean)
}

/// The counts in a file: words of 32 bits, little-endian, or a text of numbers between blanks, commas and semicolons.
fn counts(file: &Path) -> std::result::Result<Vec<u64>, Failure> {
    let bytes = read_bytes(file, MAX_BYTES)?;
    let refuse = |message: String, help: &str| {
        Failure::bare(shown(file), Diagnostic::error(codes::BAD_PROFILE, message).help(help))
    };
    if has_extension(file, "bin") {
        let (words, []) = bytes.as_chunks::<4>() else {
            let message = format!("{} bytes, which are no words of 32 bits", bytes.len());
            return Err(refuse(message, "write the buffer of counts as it is"));
        };
        return Ok(words.iter().map(|word| u64::from(u32::from_le_bytes(*word))).collect());
    }
    let text = utf8(file, bytes)?;
    let words = text.split(|c: char| c.is_whitespace() || c == ',' || c == ';').filter(|word| !word.is_empty());
    let count = |word: &str| {
        word.parse::<u64>().map_err(|_| {
            let word: String = word.chars().take(24).flat_map(char::escape_debug).collect();
            refuse(format!("`{word}` is no count"), "expected whole numbers, separated by blanks or commas")
        })
    };
    words.map(count).collect()
}
