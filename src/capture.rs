//! Captures: the inputs at which a renderer evaluated a table, in a file.
//!
//! A capture is what lets real inputs be replayed: it is evaluated, compared
//! and timed like any other columns. The binary form is made for speed and
//! says what it holds:
//!
//! ```text
//! 8 bytes   0x89 "umbrage"
//! u32       version, 1                         (all numbers little-endian)
//! u32       length of the header
//! header    RON: table, fingerprint, rows, and the columns in their order
//! columns   one after the other, without gaps: an index of a level as one byte
//!           (255: absent), a number as an f32; after the numbers of a column
//!           that has gaps one byte per row, 1 where it is present
//! ```
//!
//! The other form is CSV as `umbrage eval` reads it. Reading checks everything,
//! levels by name, so that a capture of a table that has changed since is either
//! still right or refused.

use std::io::{self, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::{ABSENT, Column, Columns};
use crate::program::{Domain, Input, Kinship, Program};
use crate::text::file::{read_bytes, shown};

/// The first bytes of every capture.
pub const MAGIC: [u8; 8] = *b"\x89umbrage";

const VERSION: u32 = 1;
/// Longest accepted header. One of the largest table is a hundred times smaller.
const MAX_HEADER: usize = 1 << 20;
/// Largest accepted capture.
const MAX_BYTES: u64 = 4 << 30;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    table: String,
    fingerprint: String,
    rows: u64,
    columns: Vec<HeaderColumn>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct HeaderColumn {
    name: String,
    kind: Kind,
}

#[derive(Serialize, Deserialize, PartialEq)]
enum Kind {
    Levels(Vec<String>),
    Numbers,
    NumbersWithGaps,
    Words,
    WordsWithGaps,
}

impl Kind {
    /// Bytes of a row.
    fn width(&self) -> u64 {
        match self {
            Kind::Levels(_) => 1,
            Kind::Numbers | Kind::Words => 4,
            Kind::NumbersWithGaps | Kind::WordsWithGaps => 5,
        }
    }
}

/// The inputs read from a capture.
#[derive(Debug, Clone)]
pub struct Capture {
    /// The points.
    pub columns: Columns<f32>,
    /// True if the table meant something else when the capture was made, or that is not known. Its inputs are the same.
    pub table_changed: bool,
}

/// Writes the binary form.
///
/// # Errors
/// When `out` cannot be written.
///
/// ```
/// use umbrage::capture;
/// use umbrage::eval::Columns;
/// use umbrage::program::Program;
///
/// let program = Program::read("tables/smsr.ron")?;
/// let points = program.examples.iter().map(|example| &example.inputs);
/// let columns = Columns::from_rows(&program, points).unwrap();
/// let mut bytes = Vec::new();
/// capture::write(&program, &columns, &mut bytes).unwrap();
/// assert_eq!(capture::parse(&program, &bytes).unwrap().columns.len(), columns.len());
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn write(program: &Program, columns: &Columns<f32>, out: &mut impl Write) -> io::Result<()> {
    let kind = |input: &Input, column: &Column<f32>| match (&input.domain, column) {
        (Domain::Discrete(levels), _) => Kind::Levels(levels.names.clone()),
        (Domain::Word, Column::Numbers { present: Some(_), .. }) => Kind::WordsWithGaps,
        (Domain::Word, _) => Kind::Words,
        (_, Column::Numbers { present: Some(_), .. }) => Kind::NumbersWithGaps,
        _ => Kind::Numbers,
    };
    let named = program.input_ids().map(|(id, input)| {
        let kind = kind(input, columns.column(id));
        HeaderColumn { name: input.name.clone(), kind }
    });
    let header = Header {
        table: program.name.clone(),
        fingerprint: program.fingerprint(),
        rows: columns.len() as u64,
        columns: named.collect(),
    };
    let header = ron::to_string(&header).map_err(io::Error::other)?;
    out.write_all(&MAGIC)?;
    out.write_all(&VERSION.to_le_bytes())?;
    out.write_all(&(header.len() as u32).to_le_bytes())?;
    out.write_all(header.as_bytes())?;
    for (id, _) in program.input_ids() {
        match columns.column(id) {
            Column::Levels(levels) => out.write_all(levels)?,
            Column::Numbers { values, present } => {
                let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
                out.write_all(&bytes)?;
                if let Some(present) = present {
                    let bytes: Vec<u8> = present.iter().map(|there| u8::from(*there)).collect();
                    out.write_all(&bytes)?;
                }
            }
        }
    }
    Ok(())
}

/// Writes the CSV form: a header with the names of the inputs, then one line per point.
///
/// # Errors
/// When `out` cannot be written.
pub fn write_csv(program: &Program, columns: &Columns<f32>, out: &mut impl Write) -> io::Result<()> {
    // A call of a fetch has commas in its name.
    let names = program.inputs.iter().map(|input| match input.name.contains(',') {
        true => format!("\"{}\"", input.name),
        false => input.name.clone(),
    });
    writeln!(out, "{}", names.collect::<Vec<_>>().join(","))?;
    let mut line = String::new();
    for row in 0..columns.len() {
        line.clear();
        for (id, input) in program.input_ids() {
            if id.index() > 0 {
                line.push(',');
            }
            match (columns.is_present(row, id), columns.column(id)) {
                (false, _) => {}
                // Names of levels and numbers need no quotes. As an f32 a number is short and reads back exactly.
                (true, Column::Numbers { values, .. }) => line.push_str(&values[row].to_string()),
                (true, Column::Levels(_)) => line.extend(columns.value(row, id).map(|value| input.show(value))),
            }
        }
        line.push('\n');
        out.write_all(line.as_bytes())?;
    }
    Ok(())
}

/// Returns whether bytes are the beginning of a capture.
pub fn is_capture(bytes: &[u8]) -> bool {
    bytes.starts_with(&MAGIC)
}

/// Reads a capture of a table.
///
/// # Errors
/// When the file cannot be read, is damaged, or holds other inputs than the table's.
pub fn read(program: &Program, path: &Path) -> Result<Capture, Failure> {
    let bytes = read_bytes(path, MAX_BYTES)?;
    parse(program, &bytes).map_err(|error| Failure::bare(shown(path), error))
}

/// Reads a capture of a table from memory.
///
/// # Errors
/// When it is damaged, or holds other inputs than the table's.
pub fn parse(program: &Program, bytes: &[u8]) -> Result<Capture, Diagnostic> {
    let (header, data) = split(bytes)?;
    if header.table != program.name {
        let message = format!("is a capture of the table `{}`, not of `{}`", shorten(&header.table), program.name);
        return Err(Diagnostic::error(codes::BAD_CAPTURE, message).help("give the table that it was made with"));
    }
    let expected = header.columns.iter().try_fold(0_u64, |sum, column| {
        header.rows.checked_mul(column.kind.width()).and_then(|bytes| sum.checked_add(bytes))
    });
    if expected != Some(data.len() as u64) {
        let expected = expected.map_or("impossibly many".to_owned(), |bytes| bytes.to_string());
        let message = format!(
            "is cut off or damaged: {} rows of {} columns need {expected} bytes, and {} follow the header",
            header.rows,
            header.columns.len(),
            data.len()
        );
        return Err(Diagnostic::error(codes::BAD_CAPTURE, message).help("make it again"));
    }
    // It was compared with what is in memory, so it is small enough.
    let rows = if header.columns.is_empty() { 0 } else { header.rows as usize };
    let mut named: Vec<(&HeaderColumn, &[u8])> = Vec::with_capacity(header.columns.len());
    let mut rest = data;
    for column in &header.columns {
        let (bytes, after) = rest.split_at(rows * column.kind.width() as usize);
        named.push((column, bytes));
        rest = after;
    }
    let mut columns = Vec::with_capacity(program.inputs.len());
    for input in &program.inputs {
        let mut found = named.iter().filter(|(column, _)| column.name == input.name);
        let (Some((column, bytes)), None) = (found.next(), found.next()) else {
            return Err(changed(program, &format!("it has not exactly one column `{}`", input.name)));
        };
        columns.push(read_column(program, input, &column.kind, bytes, rows)?);
    }
    if let Some((extra, _)) = named.iter().find(|(column, _)| program.input(&column.name).is_none()) {
        return Err(changed(program, &format!("it has a column `{}`, which is no input", shorten(&extra.name))));
    }
    let columns = Columns::from_columns(program, columns)
        .map_err(|error| Diagnostic::error(codes::BAD_CAPTURE, format!("is damaged: {error}")).help("make it again"))?;
    Ok(Capture { columns, table_changed: program.kinship(&header.fingerprint) != Kinship::Same })
}

/// The header, and what follows it.
fn split(bytes: &[u8]) -> Result<(Header, &[u8]), Diagnostic> {
    let damaged = |what: &str| Diagnostic::error(codes::BAD_CAPTURE, what.to_owned());
    let Some(rest) = bytes.strip_prefix(&MAGIC) else {
        return Err(damaged("is not a capture").help("captures are written by `umbrage render --capture`"));
    };
    let number = |bytes: &[u8]| bytes.first_chunk().map(|bytes| u32::from_le_bytes(*bytes));
    let (Some(version), Some(length)) = (number(rest), rest.get(4..).and_then(number)) else {
        return Err(damaged("is cut off in its first line").help("make it again"));
    };
    if version != VERSION {
        return Err(damaged(&format!("is a capture of version {version}, and this is umbrage for version {VERSION}"))
            .help("make it again with this umbrage"));
    }
    let length = length as usize;
    let Some(header) = rest.get(8..).filter(|_| length <= MAX_HEADER).and_then(|rest| rest.get(..length)) else {
        return Err(damaged("is cut off or damaged in its header").help("make it again"));
    };
    let header = ron::de::from_bytes(header)
        .map_err(|error| damaged(&format!("has a header that is damaged: {}", error.code)).help("make it again"))?;
    Ok((header, &rest[8 + length..]))
}

fn read_column(
    program: &Program,
    input: &Input,
    kind: &Kind,
    bytes: &[u8],
    rows: usize,
) -> Result<Column<f32>, Diagnostic> {
    match (&input.domain, kind) {
        (Domain::Discrete(levels), Kind::Levels(names)) if *names == levels.names => {
            let wrong = |level: &u8| usize::from(*level) >= levels.count() && *level != ABSENT;
            match bytes.iter().position(wrong) {
                Some(row) => Err(bad_value(row, input, &format!("has no level {}", bytes[row]))),
                None => Ok(Column::Levels(bytes.to_vec())),
            }
        }
        (Domain::Discrete(_), Kind::Levels(_)) => {
            Err(changed(program, &format!("the levels of `{}` are others now", input.name)))
        }
        (Domain::Continuous { lo, hi, .. }, Kind::Numbers | Kind::NumbersWithGaps) => {
            let (numbers, presence) = bytes.split_at(4 * rows);
            let words = numbers.chunks_exact(4);
            let values: Vec<f32> = words.map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
            let present = (*kind == Kind::NumbersWithGaps).then(|| presence.iter().map(|byte| *byte != 0).collect());
            let there = |row: usize| present.as_ref().is_none_or(|present: &Vec<bool>| present[row]);
            // Rounding is monotonous, so no f32 of the domain is left out.
            let range = (*lo as f32)..=(*hi as f32);
            match values.iter().enumerate().find(|(row, value)| !range.contains(value) && there(*row)) {
                Some((row, value)) => Err(bad_value(row, input, &format!("is {value}, beyond {lo} to {hi}"))),
                None => Ok(Column::Numbers { values, present }),
            }
        }
        (Domain::Word, Kind::Words | Kind::WordsWithGaps) => {
            let (words, presence) = bytes.split_at(4 * rows);
            let words = words.chunks_exact(4);
            let values = words.map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
            let present = (*kind == Kind::WordsWithGaps).then(|| presence.iter().map(|byte| *byte != 0).collect());
            Ok(Column::Numbers { values, present })
        }
        _ => Err(changed(program, &format!("`{}` is of another kind now", input.name))),
    }
}

fn bad_value(row: usize, input: &Input, what: &str) -> Diagnostic {
    Diagnostic::error(codes::BAD_CAPTURE, format!("row {}: `{}` {what}", row + 1, input.name))
        .help("the file is damaged, or what captured it is wrong; make it again")
}

fn changed(program: &Program, what: &str) -> Diagnostic {
    let message = format!("does not suit the table `{}` as it is now: {what}", program.name);
    Diagnostic::error(codes::BAD_CAPTURE, message).help("make it again with this table")
}

/// The beginning of a name that may be long or strange.
fn shorten(name: &str) -> String {
    name.chars().take(40).flat_map(char::escape_debug).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::program::Value;
    use crate::table::Table;

    fn program(name: &str, levels: &str) -> Program {
        let text = format!(
            r#"Table(language: 1, name: "{name}", hit_policy: First,
                inputs: {{
                    "s": Levels(values: {levels}),
                    "x": Range(from: 0, to: 0.1),
                    "f": Bool(fetched: (cost: 1)),
                    "g": Range(from: -1, to: 1, fetched: (cost: 1)),
                }},
                output: Number(), cases: [Case(id: 1, when: "f && g > 0", value: "x")], default: 0)"#
        );
        let table = Table::parse(Source::new("t.ron", text));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
    }

    fn some(program: &Program) -> Columns<f32> {
        let level = |level| Some(Value::Level(level));
        let rows = [
            [level(1), Some(Value::Number(f64::from(0.1_f32))), level(1), Some(Value::Number(0.5))],
            [level(0), Some(Value::Number(0.0)), None, None],
        ];
        Columns::from_rows(program, rows).expect("they fit")
    }

    fn binary(program: &Program) -> Vec<u8> {
        let mut bytes = Vec::new();
        write(program, &some(program), &mut bytes).expect("memory can be written");
        bytes
    }

    #[test]
    fn what_is_written_is_read_back() {
        let program = program("t", r#"{"a": 0, "b": 1}"#);
        let capture = parse(&program, &binary(&program)).expect("right");
        assert!(!capture.table_changed);
        assert_eq!(capture.columns.len(), 2);
        for row in 0..2 {
            assert_eq!(capture.columns.point(row), some(&program).point(row));
        }
        let mut text = Vec::new();
        write_csv(&program, &capture.columns, &mut text).expect("memory can be written");
        assert_eq!(String::from_utf8_lossy(&text), "s,x,f,g\nb,0.1,true,0.5\na,0,,\n");
    }

    #[test]
    fn every_cut_and_every_flipped_bit_is_an_error_or_harmless() {
        let program = program("t", r#"{"a": 0, "b": 1}"#);
        let bytes = binary(&program);
        for length in 0..bytes.len() {
            assert!(parse(&program, &bytes[..length]).is_err(), "cut to {length} bytes");
        }
        for at in 0..bytes.len() * 8 {
            let mut hostile = bytes.clone();
            hostile[at / 8] ^= 1 << (at % 8);
            if let Ok(capture) = parse(&program, &hostile) {
                assert_eq!(capture.columns.len(), 2);
            }
        }
    }

    #[test]
    fn errors_say_what_is_wrong() {
        let old = program("t", r#"{"a": 0, "b": 1}"#);
        let message = |program: &Program, bytes: &[u8]| parse(program, bytes).expect_err("wrong").message;
        assert_eq!(
            message(&program("u", r#"{"a": 0, "b": 1}"#), &binary(&old)),
            "is a capture of the table `t`, not of `u`"
        );
        assert_eq!(
            message(&program("t", r#"{"b": 0, "a": 1}"#), &binary(&old)),
            "does not suit the table `t` as it is now: the levels of `s` are others now"
        );
        let mut bytes = binary(&old);
        let end = bytes.len();
        bytes.truncate(end - 1);
        assert_eq!(
            message(&old, &bytes),
            "is cut off or damaged: 2 rows of 4 columns need 22 bytes, and 21 follow the header"
        );
        bytes[8] = 2;
        assert_eq!(message(&old, &bytes), "is a capture of version 2, and this is umbrage for version 1");
        let mut huge = binary(&old);
        let at = huge.windows(6).position(|w| w == b"rows:2").expect("in the header");
        huge.splice(at..at + 6, b"rows:9000000000000000000".iter().copied());
        huge[12] += 18;
        assert_eq!(
            message(&old, &huge),
            "is cut off or damaged: 9000000000000000000 rows of 4 columns need impossibly many bytes, and 22 follow \
             the header"
        );
        assert_eq!(message(&old, b"s,x,f,g\n"), "is not a capture");
    }

    #[test]
    fn a_table_that_changed_elsewhere_still_takes_its_captures() {
        let old = program("t", r#"{"a": 0, "b": 1}"#);
        let mut new = program("t", r#"{"a": 0, "b": 1}"#);
        new.source = Source::new("t.ron", "another text");
        assert!(!parse(&new, &binary(&old)).expect("fits").table_changed, "the same meaning");
        new.rows.clear();
        assert!(parse(&new, &binary(&old)).expect("fits").table_changed);
    }
}
