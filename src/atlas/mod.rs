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
pub(crate) mod text;
mod values;

use crate::diag::Failure;
use crate::program::{InputId, Program, Value};

pub use sheet::{html, page, svg};
pub use values::{Scale, colour, spread};

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
    /// The picture in it; absent where no input was found that leads to the case.
    pub shown: Option<Shown>,
}

/// The large picture of a panel: the value around a point.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The point, one value per input; fetched inputs may be absent.
    pub point: Vec<Option<Value>>,
    /// The input that grows from left to right over its domain.
    pub across: Option<InputId>,
    /// The input that grows from top to bottom.
    pub down: Option<InputId>,
    /// Left, top, width and height of the picture, in units of the drawing.
    pub place: [i32; 4],
}

/// Width of a panel, in units of the drawing.
pub const PANEL_WIDTH: i32 = 320;

impl Atlas {
    /// Draws every case; with shares, one per row, also how often each is taken.
    ///
    /// # Errors
    /// When a picture cannot be encoded.
    ///
    /// ```
    /// use umbrage::atlas::Atlas;
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let atlas = Atlas::new(&program, None)?;
    /// assert_eq!(atlas.panels.len(), 12);
    /// assert!(atlas.panels[0].svg().starts_with("<svg"));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn new(program: &Program, shares: Option<&[f64]>) -> Result<Self, Failure> {
        let scale = values::Scale::of(program);
        let panels = (0..program.rows.len()).map(|index| Panel::of(program, index, shares, &scale));
        Ok(Atlas { panels: panels.collect::<Result<_, Failure>>()? })
    }

    /// Draws one case, given as an index into [`Program::rows`], as it is drawn among all.
    ///
    /// # Errors
    /// When its picture cannot be encoded.
    pub fn panel(program: &Program, index: usize, shares: Option<&[f64]>) -> Result<Panel, Failure> {
        Panel::of(program, index, shares, &values::Scale::of(program))
    }
}

impl Panel {
    fn of(program: &Program, index: usize, shares: Option<&[f64]>, scale: &values::Scale) -> Result<Self, Failure> {
        let share = shares.and_then(|shares| shares.get(index).copied());
        let (body, height, shown) = panel::draw(program, index, share, scale)?;
        Ok(Panel { id: program.rows[index].id, body, height, shown })
    }

    /// The panel as an SVG document of its own.
    pub fn svg(&self) -> String {
        sheet::document(PANEL_WIDTH, self.height, &self.body)
    }
}
