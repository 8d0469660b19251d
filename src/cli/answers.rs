//! Answers: the case taken and the value of every row → CSV or JSON.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::output::Sink;
use crate::diag::Failure;
use crate::program::{InputId, Program, Reading};
use crate::show::Precision;

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
            false => format!("case,{}\n", program.output.columns().join(",")),
        };
        out.write_all(head.as_bytes()).map_err(|e| out.failure(&e))?;
        Ok(Self { program, precision, json, started: false, out })
    }

    /// Writes some answers.
    pub(super) fn write(&mut self, answers: &Answers) -> Result<(), Failure> {
        let values = answers.values.chunks_exact(self.program.output.components().len());
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
        let reading = self.program.output.read(values);
        self.cells(&reading)?;
        self.out.write_all(b"\n")
    }

    /// The columns of a result. Numbers and names of levels need no quotes.
    fn cells(&mut self, reading: &Reading<'_>) -> io::Result<()> {
        match reading {
            Reading::Number(value) => match self.precision {
                Precision::F32 => write!(self.out, "{}", *value as f32),
                Precision::F64 => write!(self.out, "{value}"),
            },
            Reading::Bool(value) => write!(self.out, "{value}"),
            Reading::Int(value) => write!(self.out, "{value}"),
            Reading::Level(_, name) => self.out.write_all(name.as_bytes()),
            Reading::Vector(values) => self.separated(",", values, |me, value| me.cells(&Reading::Number(*value))),
            Reading::Record(fields) => self.separated(",", fields, |me, (_, field)| me.cells(field)),
            Reading::List(items) => self.separated(" ", items, |me, item| me.item(item)),
        }
    }

    /// An item of a list, which is one cell: numbers and items of an item are held together.
    fn item(&mut self, item: &Reading<'_>) -> io::Result<()> {
        match item {
            Reading::Number(_) | Reading::Bool(_) | Reading::Int(_) | Reading::Level(..) => self.cells(item),
            Reading::Vector(numbers) => {
                let numbers: Vec<Reading<'_>> = numbers.iter().map(|number| Reading::Number(*number)).collect();
                self.enclosed(&numbers)
            }
            Reading::List(items) => self.enclosed(items),
            Reading::Record(fields) => self.separated(" ", fields, |me, (_, field)| me.item(field)),
        }
    }

    fn enclosed(&mut self, items: &[Reading<'_>]) -> io::Result<()> {
        self.out.write_all(b"[")?;
        self.separated(" ", items, |me, item| me.item(item))?;
        self.out.write_all(b"]")
    }

    fn separated<T>(
        &mut self,
        separator: &str,
        parts: &[T],
        write: impl Fn(&mut Self, &T) -> io::Result<()>,
    ) -> io::Result<()> {
        for (index, part) in parts.iter().enumerate() {
            if index > 0 {
                self.out.write_all(separator.as_bytes())?;
            }
            write(self, part)?;
        }
        Ok(())
    }

    fn object(&mut self, row: Option<usize>, values: &[f64]) -> io::Result<()> {
        let value = match &self.program.output.read(values) {
            // A key for each field, as there are columns for each in CSV.
            Reading::Record(fields) => self.fields(fields),
            other @ (Reading::Number(_)
            | Reading::Bool(_)
            | Reading::Int(_)
            | Reading::Level(..)
            | Reading::Vector(_)
            | Reading::List(_)) => {
                format!("\"value\":{}", self.json(other))
            }
        };
        let case = row.map_or(json!("default"), |row| Value::from(self.program.rows[row].id));
        let separator = if std::mem::replace(&mut self.started, true) { "," } else { "" };
        write!(self.out, "{separator}\n{{\"case\":{case},{value}}}")
    }

    fn fields(&self, fields: &[(&str, Reading<'_>)]) -> String {
        let fields = fields.iter().map(|(name, field)| format!("{}:{}", json!(name), self.json(field)));
        fields.collect::<Vec<_>>().join(",")
    }

    fn json(&self, reading: &Reading<'_>) -> String {
        match reading {
            // A number goes out as it is shown, so that it reads back exactly. JSON has no
            // infinities and no NaN; those are strings.
            Reading::Number(value) if value.is_finite() => self.precision.show(*value),
            Reading::Number(value) => format!("\"{}\"", self.precision.show(*value)),
            Reading::Bool(value) => value.to_string(),
            Reading::Int(value) => value.to_string(),
            Reading::Level(_, name) => json!(name).to_string(),
            Reading::Vector(values) => {
                let numbers = values.iter().map(|value| self.json(&Reading::Number(*value)));
                format!("[{}]", numbers.collect::<Vec<_>>().join(","))
            }
            Reading::Record(fields) => format!("{{{}}}", self.fields(fields)),
            Reading::List(items) => {
                format!("[{}]", items.iter().map(|item| self.json(item)).collect::<Vec<_>>().join(","))
            }
        }
    }
}
