//! Answers: the case taken and the value of every row → CSV or JSON.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::output::Sink;
use crate::diag::Failure;
use crate::program::{InputId, Output, Program};
use crate::show::{self, Precision};

/// The answers to some points, in their order.
#[derive(Default)]
pub(super) struct Answers {
    /// The row taken, as an index into the program's rows; `None` for the default.
    pub(super) rows: Vec<Option<usize>>,
    /// The components of every result, one after the other.
    pub(super) values: Vec<f64>,
    /// Points without an answer, because they need an input that is absent.
    pub(super) needed: Vec<(usize, InputId)>,
}

/// Writes answers in one of two forms.
pub(super) struct Writer<'p> {
    program: &'p Program,
    precision: Precision,
    json: bool,
    /// JSON only: whether something stands before the next object.
    started: bool,
    out: Sink,
}

impl<'p> Writer<'p> {
    /// Writes what comes before the first answer.
    pub(super) fn start(
        program: &'p Program,
        precision: Precision,
        json: bool,
        mut out: Sink,
    ) -> Result<Self, Failure> {
        let head = match json {
            true => "[".to_owned(),
            false => format!("case,{}\n", show::component_names(&program.output).join(",")),
        };
        out.write_all(head.as_bytes()).map_err(|e| out.failure(&e))?;
        Ok(Self { program, precision, json, started: false, out })
    }

    /// Writes some answers.
    pub(super) fn write(&mut self, answers: &Answers) -> Result<(), Failure> {
        let values = answers.values.chunks_exact(self.program.output.components());
        for (row, values) in answers.rows.iter().zip(values) {
            let written = match self.json {
                true => self.object(*row, values),
                false => self.line(*row, values),
            };
            written.map_err(|e| self.out.failure(&e))?;
        }
        Ok(())
    }

    /// Writes what comes after the last answer and gives the place back.
    pub(super) fn end(mut self) -> Result<Sink, Failure> {
        if self.json {
            let end: &[u8] = if self.started { b"\n]\n" } else { b"]\n" };
            self.out.write_all(end).map_err(|e| self.out.failure(&e))?;
        }
        Ok(self.out)
    }

    fn line(&mut self, row: Option<usize>, values: &[f64]) -> io::Result<()> {
        match row {
            Some(row) => write!(self.out, "{},", self.program.rows[row].id)?,
            None => self.out.write_all(b"default,")?,
        }
        // Numbers and names of levels need no quotes.
        match &self.program.output {
            Output::Number | Output::Vector(_) | Output::Record(_) => {
                for (i, value) in values.iter().enumerate() {
                    let comma = if i > 0 { "," } else { "" };
                    match self.precision {
                        Precision::F32 => write!(self.out, "{comma}{}", *value as f32)?,
                        Precision::F64 => write!(self.out, "{comma}{value}")?,
                    }
                }
            }
            output => self.out.write_all(show::words(output, values, self.precision).join(" ").as_bytes())?,
        }
        self.out.write_all(b"\n")
    }

    fn object(&mut self, row: Option<usize>, values: &[f64]) -> io::Result<()> {
        let words = show::words(&self.program.output, values, self.precision);
        // A number goes out as it is shown, so that it reads back exactly. JSON has no
        // infinities and no NaN; those are strings.
        let number = |(word, value): (&String, &f64)| match value.is_finite() {
            true => word.clone(),
            false => format!("\"{word}\""),
        };
        let value = match &self.program.output {
            Output::Record(names) => {
                // One key per number, as there is one column in CSV.
                let fields = names.iter().zip(words.iter().zip(values));
                let fields = fields.map(|(name, pair)| format!(",\"{name}\":{}", number(pair))).collect::<String>();
                let case = row.map_or(json!("default"), |row| Value::from(self.program.rows[row].id));
                let separator = if std::mem::replace(&mut self.started, true) { "," } else { "" };
                return write!(self.out, "{separator}\n{{\"case\":{case}{fields}}}");
            }
            Output::Number => words.iter().zip(values).map(number).collect(),
            Output::Vector(_) => {
                format!("[{}]", words.iter().zip(values).map(number).collect::<Vec<_>>().join(","))
            }
            Output::Enumeration(_) => words.iter().map(|w| json!(w).to_string()).collect(),
            Output::List { .. } => json!(words).to_string(),
        };
        let case = row.map_or(json!("default"), |row| Value::from(self.program.rows[row].id));
        let separator = if std::mem::replace(&mut self.started, true) { "," } else { "" };
        write!(self.out, "{separator}\n{{\"case\":{case},\"value\":{value}}}")
    }
}
