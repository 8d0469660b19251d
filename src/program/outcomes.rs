//! The ways in which a table comes to a result, numbered: what counts of lines are counted by.

use super::{Program, Row};
use crate::diag::Span;

/// A way to a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Outcome {
    /// The row taken, as an index into [`Program::rows`]; `None` for the default.
    pub row: Option<usize>,
    /// The line of that row that applied; `None` where the default gave the value.
    pub line: Option<usize>,
}

impl Program {
    /// All ways to a result: row by row its lines and, if none of them need apply, the default in their place; the
    /// default where no row is taken comes last.
    ///
    /// ```
    /// use umbrage::program::{Outcome, Program};
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let outcomes = program.outcomes();
    /// assert_eq!(outcomes[0], Outcome { row: Some(0), line: Some(0) });
    /// assert_eq!(outcomes.last(), Some(&Outcome { row: None, line: None }));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn outcomes(&self) -> Vec<Outcome> {
        let of_row = |(index, row): (usize, &Row)| {
            let lines = (0..row.lines.len()).map(Some);
            let open = row.lines.last().is_none_or(|line| line.condition_span.is_some());
            let all = lines.chain(open.then_some(None));
            all.map(|line| Outcome { row: Some(index), line }).collect::<Vec<_>>()
        };
        let rows = self.rows.iter().enumerate().flat_map(of_row);
        rows.chain([Outcome { row: None, line: None }]).collect()
    }

    /// The place of what gives the value in an outcome: of a line, of the case none of whose lines applies, of the
    /// default.
    pub fn place(&self, outcome: Outcome) -> Span {
        let row = outcome.row.map(|row| &self.rows[row]);
        match (row, row.and_then(|row| row.lines.get(outcome.line?))) {
            (Some(_), Some(line)) => line.span,
            (Some(row), None) => row.span,
            (None, _) => self.default_span,
        }
    }
}
