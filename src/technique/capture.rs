//! Inputs of a frame as a capture.

use std::io::{self, Write};

use super::Inputs;
use crate::capture;

/// Writes the inputs of a table: in the binary form, or as CSV.
///
/// # Errors
/// When `out` cannot be written.
pub fn write(inputs: &Inputs<'_>, as_csv: bool, out: &mut impl Write) -> io::Result<()> {
    if as_csv {
        capture::write_csv(inputs.program, &inputs.columns, out)
    } else {
        capture::write(inputs.program, &inputs.columns, out)
    }
}
