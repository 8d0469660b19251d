//! The atlas of a table: one panel per case, as a page of a paper shows them.
//!
//! A panel shows a point that leads to the case (its first example, or the
//! smallest input found), drawn as the table's hints say, the value around that
//! point as a picture, and the case in words. Nothing here decides anything:
//! points come from [`explain::reach`](crate::explain::reach), values from the
//! interpreter, text from the table.

mod cell;
mod panel;
mod sheet;
mod text;
mod values;

use crate::diag::Failure;
use crate::explain::reach;
use crate::plan::Weights;
use crate::program::{InputSet, Program};

pub use sheet::{html, page, svg};

/// The panels of a table, drawn.
#[derive(Debug, Clone)]
pub struct Atlas {
    /// In the order of the rows.
    pub panels: Vec<Panel>,
}

/// The panel of one case.
#[derive(Debug, Clone)]
pub struct Panel {
    /// The case.
    pub id: u32,
    /// Its drawing: an SVG fragment, [`PANEL_WIDTH`] wide.
    body: String,
    /// Its height.
    height: i32,
}

/// Width of a panel, in units of the drawing.
pub const PANEL_WIDTH: i32 = 320;

impl Atlas {
    /// Draws every case; with weights of the states, also how often each occurs.
    ///
    /// # Errors
    /// When a picture cannot be encoded.
    pub fn new(program: &Program, weights: Option<&Weights>) -> Result<Self, Failure> {
        let shares = weights.and_then(|weights| shares(program, weights));
        let scale = values::Scale::of(program);
        let panels = program.rows.iter().enumerate().map(|(index, row)| {
            let share = shares.as_ref().map(|shares| shares[index]);
            let (body, height) = panel::draw(program, index, share, &scale)?;
            Ok(Panel { id: row.id, body, height })
        });
        Ok(Atlas { panels: panels.collect::<Result<_, Failure>>()? })
    }
}

impl Panel {
    /// The panel as an SVG document of its own.
    pub fn svg(&self) -> String {
        sheet::document(PANEL_WIDTH, self.height, &self.body)
    }
}

/// How often each row is taken, as a share of all; `None` where the state alone does not tell.
pub fn shares(program: &Program, weights: &Weights) -> Option<Vec<f64>> {
    let digits = program.states.digits().iter().fold(InputSet::default(), |set, (id, _)| set.or(InputSet::one(*id)));
    let mut guards = program.rows.iter().map(|row| program.pool.cond_facts(row.guard).inputs);
    if !guards.all(|inputs| inputs.minus(digits).is_empty()) {
        return None;
    }
    let mut shares = vec![0.0; program.rows.len()];
    for (state, row) in reach::rows_by_state(program).into_iter().enumerate() {
        if let Some(row) = row {
            shares[row] += weights.of(state);
        }
    }
    let total: f64 = (0..program.states.count()).map(|state| weights.of(state)).sum();
    Some(shares.into_iter().map(|share| share / total).collect())
}
