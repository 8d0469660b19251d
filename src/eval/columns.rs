//! Inputs and results as columns: one vector per input, one per component.
//!
//! Whatever evaluates many points at once (the batch interpreter, a GPU)
//! takes [`Columns`] and nothing else, so that all of them see the same points
//! in the same precision. Discrete inputs are carried as the index of their
//! level; that a fetched input is absent is kept beside its numbers, never
//! inside as a NaN.

use std::fmt;

use super::Outcome;
use crate::program::{Domain, InputId, InputSet, Program, Real, Value};

/// Stands for an absent fetched input in a column of levels.
pub const ABSENT: u8 = u8::MAX;

/// The values of one input, row by row.
#[derive(Debug, Clone, PartialEq)]
pub enum Column<T> {
    /// Indices of levels; [`ABSENT`] where a fetched input is absent.
    Levels(Vec<u8>),
    /// Numbers, or words as they are carried ([`Real::from_word`]).
    Numbers {
        /// The number of each row; anything where it is absent.
        values: Vec<T>,
        /// The rows in which it is there; `None` if it is in every row.
        present: Option<Vec<bool>>,
    },
}

impl<T> Column<T> {
    fn len(&self) -> usize {
        match self {
            Column::Levels(levels) => levels.len(),
            Column::Numbers { values, .. } => values.len(),
        }
    }
}

/// Points of a program, as columns.
#[derive(Debug, Clone)]
pub struct Columns<T> {
    len: usize,
    columns: Vec<Column<T>>,
    /// Number of levels per input; 0 for continuous ones.
    counts: Vec<usize>,
    fetched: InputSet,
    /// The inputs that are words.
    words: InputSet,
    /// The inputs that are absent somewhere.
    gaps: InputSet,
}

/// A mistake in values given as columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnError {
    /// There are more or fewer columns, or values in a row, than inputs.
    Count {
        /// The number given.
        found: usize,
        /// The number of inputs.
        expected: usize,
    },
    /// Levels for a continuous input or numbers for a discrete one.
    Kind(InputId),
    /// The column of an input has another length than the first one.
    Length(InputId),
    /// An input that is not fetched has no value.
    Absent {
        /// The row without it.
        row: usize,
        /// The input.
        input: InputId,
    },
    /// No level of the input has this index.
    Level {
        /// The row it stands in.
        row: usize,
        /// The input.
        input: InputId,
    },
}

impl fmt::Display for ColumnError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count { found, expected } => write!(f, "{found} values for {expected} inputs"),
            Self::Kind(input) => write!(f, "input {} is given values of another kind", input.index()),
            Self::Length(input) => write!(f, "the column of input {} has another length", input.index()),
            Self::Absent { row, input } => write!(f, "row {row} has no value for input {}", input.index()),
            Self::Level { row, input } => write!(f, "row {row} has no such level of input {}", input.index()),
        }
    }
}

impl std::error::Error for ColumnError {}

impl<T: Real> Columns<T> {
    /// No points yet.
    pub fn new(program: &Program) -> Self {
        let empty = |domain: &Domain| match domain {
            Domain::Discrete(_) => Column::Levels(Vec::new()),
            Domain::Continuous { .. } | Domain::Word => Column::Numbers { values: Vec::new(), present: None },
        };
        let count = |domain: &Domain| match domain {
            Domain::Discrete(levels) => levels.count(),
            Domain::Continuous { .. } | Domain::Word => 0,
        };
        let words = program.input_ids().filter(|(_, input)| input.domain == Domain::Word);
        Self {
            len: 0,
            columns: program.inputs.iter().map(|input| empty(&input.domain)).collect(),
            counts: program.inputs.iter().map(|input| count(&input.domain)).collect(),
            fetched: program.fetched,
            words: words.fold(InputSet::default(), |all, (id, _)| all.or(InputSet::one(id))),
            gaps: InputSet::default(),
        }
    }

    /// The points given row by row, each with one value per input.
    ///
    /// # Errors
    /// With the first value that does not fit its input.
    pub fn from_rows<R: AsRef<[Option<Value>]>>(
        program: &Program,
        rows: impl IntoIterator<Item = R>,
    ) -> Result<Self, ColumnError> {
        let mut all = Self::new(program);
        for row in rows {
            all.push(row.as_ref())?;
        }
        Ok(all)
    }

    /// The points given as one column per input.
    ///
    /// # Errors
    /// With the first column that does not fit its input.
    pub fn from_columns(program: &Program, columns: Vec<Column<T>>) -> Result<Self, ColumnError> {
        let mut all = Self::new(program);
        if columns.len() != all.columns.len() {
            return Err(ColumnError::Count { found: columns.len(), expected: all.columns.len() });
        }
        all.len = columns.first().map_or(0, Column::len);
        for (index, column) in columns.iter().enumerate() {
            let input = InputId::new(index);
            if column.len() != all.len {
                return Err(ColumnError::Length(input));
            }
            let absent = match column {
                Column::Levels(levels) => {
                    let count = all.counts[index];
                    if count == 0 {
                        return Err(ColumnError::Kind(input));
                    }
                    let wrong = |level: &u8| usize::from(*level) >= count && *level != ABSENT;
                    if let Some(row) = levels.iter().position(wrong) {
                        return Err(ColumnError::Level { row, input });
                    }
                    levels.iter().position(|level| *level == ABSENT)
                }
                Column::Numbers { present, .. } => {
                    if all.counts[index] != 0 {
                        return Err(ColumnError::Kind(input));
                    }
                    if present.as_ref().is_some_and(|present| present.len() != all.len) {
                        return Err(ColumnError::Length(input));
                    }
                    present.as_ref().and_then(|present| present.iter().position(|there| !there))
                }
            };
            if let Some(row) = absent {
                all.gap(row, input)?;
            }
        }
        all.columns = columns;
        Ok(all)
    }

    fn gap(&mut self, row: usize, input: InputId) -> Result<(), ColumnError> {
        if !self.fetched.contains(input) {
            return Err(ColumnError::Absent { row, input });
        }
        self.gaps = self.gaps.or(InputSet::one(input));
        Ok(())
    }

    /// Appends a point: one value per input, `None` for absent fetched inputs.
    ///
    /// # Errors
    /// With the first value that does not fit its input; the point is then not appended.
    pub fn push(&mut self, point: &[Option<Value>]) -> Result<(), ColumnError> {
        if point.len() != self.columns.len() {
            return Err(ColumnError::Count { found: point.len(), expected: self.columns.len() });
        }
        let row = self.len;
        for (index, value) in point.iter().enumerate() {
            let (input, count) = (InputId::new(index), self.counts[index]);
            match value {
                Some(Value::Level(level)) if count > usize::from(*level) => {}
                Some(Value::Level(_)) if count > 0 => return Err(ColumnError::Level { row, input }),
                Some(Value::Number(_)) if count == 0 => {}
                Some(_) => return Err(ColumnError::Kind(input)),
                None => self.gap(row, input)?,
            }
        }
        for (index, (column, value)) in self.columns.iter_mut().zip(point).enumerate() {
            match column {
                Column::Levels(levels) => levels.push(match value {
                    Some(Value::Level(level)) => *level,
                    _ => ABSENT,
                }),
                Column::Numbers { values, present } => {
                    let number = match value {
                        Some(Value::Number(number)) => Some(*number),
                        _ => None,
                    };
                    values.push(match self.words.contains(InputId::new(index)) {
                        true => T::from_word(number.unwrap_or(0.0) as u32),
                        false => T::from_f64(number.unwrap_or(0.0)),
                    });
                    match (present, number) {
                        (Some(present), number) => present.push(number.is_some()),
                        (None, Some(_)) => {}
                        (present @ None, None) => {
                            let mut all = vec![true; row];
                            all.push(false);
                            *present = Some(all);
                        }
                    }
                }
            }
        }
        self.len += 1;
        Ok(())
    }

    /// Some of the points, in the order of `rows`; a row may be named more than once.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Self {
        let pick = |column: &Column<T>| match column {
            Column::Levels(levels) => Column::Levels(rows.iter().map(|row| levels[*row]).collect()),
            Column::Numbers { values, present } => Column::Numbers {
                values: rows.iter().map(|row| values[*row]).collect(),
                present: present.as_ref().map(|present| rows.iter().map(|row| present[*row]).collect()),
            },
        };
        Self {
            len: rows.len(),
            columns: self.columns.iter().map(pick).collect(),
            counts: self.counts.clone(),
            fetched: self.fetched,
            words: self.words,
            gaps: self.gaps,
        }
    }

    /// Appends the points of other columns.
    ///
    /// # Panics
    /// If they were made for a program with other inputs.
    pub fn append(&mut self, other: &Self) {
        assert!(self.counts == other.counts, "columns of another program");
        for (mine, theirs) in self.columns.iter_mut().zip(&other.columns) {
            match (mine, theirs) {
                (Column::Levels(mine), Column::Levels(theirs)) => mine.extend_from_slice(theirs),
                (Column::Numbers { values, present }, Column::Numbers { values: more, present: their_presence }) => {
                    if present.is_some() || their_presence.is_some() {
                        let all = present.get_or_insert_with(|| vec![true; values.len()]);
                        match their_presence {
                            Some(presence) => all.extend_from_slice(presence),
                            None => all.resize(all.len() + more.len(), true),
                        }
                    }
                    values.extend_from_slice(more);
                }
                // Columns of one input are of one kind.
                _ => {}
            }
        }
        self.len += other.len;
        self.gaps = self.gaps.or(other.gaps);
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The column of an input.
    pub fn column(&self, input: InputId) -> &Column<T> {
        &self.columns[input.index()]
    }

    /// The levels of a discrete input; none for a continuous one.
    pub fn levels(&self, input: InputId) -> &[u8] {
        match self.column(input) {
            Column::Levels(levels) => levels,
            Column::Numbers { .. } => &[],
        }
    }

    /// The numbers of a continuous input; none for a discrete one.
    pub fn numbers(&self, input: InputId) -> &[T] {
        match self.column(input) {
            Column::Numbers { values, .. } => values,
            Column::Levels(_) => &[],
        }
    }

    /// The inputs that are absent in some row.
    pub fn gaps(&self) -> InputSet {
        self.gaps
    }

    /// Returns whether an input has a value in a row.
    pub fn is_present(&self, row: usize, input: InputId) -> bool {
        match self.column(input) {
            Column::Levels(levels) => levels[row] != ABSENT,
            Column::Numbers { present: Some(present), .. } => present[row],
            Column::Numbers { present: None, .. } => true,
        }
    }

    /// The value of an input in a row.
    pub fn value(&self, row: usize, input: InputId) -> Option<Value> {
        self.is_present(row, input).then(|| match self.column(input) {
            Column::Levels(levels) => Value::Level(levels[row]),
            Column::Numbers { values, .. } if self.words.contains(input) => {
                Value::Number(f64::from(values[row].to_word()))
            }
            Column::Numbers { values, .. } => Value::Number(values[row].to_f64()),
        })
    }

    /// A row as a point.
    pub fn point(&self, row: usize) -> Vec<Option<Value>> {
        (0..self.columns.len()).map(|index| self.value(row, InputId::new(index))).collect()
    }

    /// Returns whether these are points of `program`.
    pub fn fit(&self, program: &Program) -> bool {
        let empty = Self::new(program);
        self.counts == empty.counts && self.fetched == empty.fetched && self.words == empty.words
    }
}

/// The way to a result: its case, its line, and its fetches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Path {
    /// The row taken, as an index into [`Program::rows`]; `None` for the default.
    pub row: Option<usize>,
    /// The line of that row that applied; `None` where the default gave the value.
    pub line: Option<usize>,
    /// The inputs that were fetched.
    pub fetched: InputSet,
}

/// Results at many points, as columns.
///
/// There are few different paths through a program, so each row has the
/// number of its path instead of the path.
#[derive(Debug, Clone)]
pub struct Results<T> {
    pub(super) paths: Vec<Path>,
    pub(super) path: Vec<u32>,
    pub(super) values: Vec<Vec<T>>,
}

impl<T> Default for Results<T> {
    fn default() -> Self {
        Self { paths: Vec::new(), path: Vec::new(), values: Vec::new() }
    }
}

impl<T: Real> Results<T> {
    /// The number of results.
    pub fn len(&self) -> usize {
        self.path.len()
    }

    /// Returns whether there is none.
    pub fn is_empty(&self) -> bool {
        self.path.is_empty()
    }

    /// The way to the result at a point.
    pub fn path(&self, point: usize) -> Path {
        self.paths[self.path[point] as usize]
    }

    /// The row taken at a point, as an index into [`Program::rows`]; `None` for the default.
    pub fn row(&self, point: usize) -> Option<usize> {
        self.path(point).row
    }

    /// The inputs fetched at a point.
    pub fn fetched(&self, point: usize) -> InputSet {
        self.path(point).fetched
    }

    /// One component of the result at every point.
    pub fn values(&self, component: usize) -> &[T] {
        &self.values[component]
    }

    /// The number of components of a result.
    pub fn components(&self) -> usize {
        self.values.len()
    }

    /// The result at a point, as the scalar interpreter gives it.
    pub fn outcome(&self, point: usize) -> Outcome<T> {
        let Path { row, line, fetched } = self.path(point);
        Outcome { row, line, values: self.values.iter().map(|component| component[point]).collect(), fetched }
    }

    /// The number of points of each path that was taken.
    pub fn histogram(&self) -> Vec<(Path, usize)> {
        let mut counts = vec![0; self.paths.len()];
        for path in &self.path {
            counts[*path as usize] += 1;
        }
        self.paths.iter().copied().zip(counts).filter(|(_, count)| *count > 0).collect()
    }
}
