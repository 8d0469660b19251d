//! Hints for pictures of a table's inputs, as written.
//!
//! A picture shows one cell with its four neighbours. Hints say which input is
//! a position in the cell, which has to do with its sides, and so on. They have
//! no meaning beyond pictures.

use serde::Deserialize;

use crate::diag::{Diagnostic, Spanned, codes};
use crate::text::raw::{Raw, RawMap, Reader};

/// A side of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[allow(missing_docs)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    Left,
    Right,
    Top,
    Bottom,
}

/// The drawing of one input.
#[derive(Debug, Clone)]
pub enum Draw {
    /// The number is a position in the cell, from its left to its right border.
    Across,
    /// The number is a position in the cell, from its top to its bottom border.
    Down,
    /// Each level names the sides of the cell (or of one of its neighbours) that have a mark.
    Sides {
        /// The neighbour, if it is not the cell itself.
        of: Option<Side>,
        /// The sides by level; a level that is missing marks none.
        levels: Vec<(Spanned<String>, Vec<Side>)>,
    },
    /// The cell is dark at these levels, and light at the others.
    Dark(Vec<Spanned<String>>),
    /// A run of cells along marked sides, with so many closed ends at each level.
    Run {
        /// The input that marks the sides along which the run goes.
        along: Spanned<String>,
        /// The number of closed ends, 0 to 2, by level.
        ends: Vec<(Spanned<String>, u8)>,
    },
    /// The number is a position in the run that this input is drawn as.
    Position(Spanned<String>),
    /// The condition under which the marks of this input are drawn strongly.
    Strong(Spanned<String>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum DrawRon<'a> {
    Across,
    Down,
    Sides {
        #[serde(default)]
        of: Option<Side>,
        #[serde(borrow)]
        levels: RawMap<'a>,
    },
    Dark(Vec<Raw<'a>>),
    Run {
        along: Raw<'a>,
        ends: RawMap<'a>,
    },
    Position(Raw<'a>),
    Strong(Raw<'a>),
}

impl<'a> Reader<'a> {
    /// `"H": Sides(levels: {"left": [left], ...})`
    pub(super) fn draw(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<(Spanned<String>, Draw), Diagnostic> {
        let words = |list: Vec<Raw<'a>>| list.into_iter().map(|raw| self.word(raw)).collect::<Result<Vec<_>, _>>();
        let draw = match self.get::<DrawRon<'a>>(raw)? {
            DrawRon::Across => Draw::Across,
            DrawRon::Down => Draw::Down,
            DrawRon::Sides { of, levels } => {
                let sides = |(level, sides): (Raw<'a>, Raw<'a>)| Ok((self.word(level)?, self.get(sides)?));
                Draw::Sides { of, levels: levels.0.into_iter().map(sides).collect::<Result<_, Diagnostic>>()? }
            }
            DrawRon::Dark(levels) => Draw::Dark(words(levels)?),
            DrawRon::Run { along, ends } => {
                let end = |(level, raw): (Raw<'a>, Raw<'a>)| match self.get::<u8>(raw)? {
                    ends @ 0..=2 => Ok((self.word(level)?, ends)),
                    _ => Err(Diagnostic::error(codes::STRUCTURE, "a run has two ends")
                        .at(self.span(raw), "expected 0, 1 or 2, the number of closed ends")),
                };
                Draw::Run {
                    along: self.word(along)?,
                    ends: ends.0.into_iter().map(end).collect::<Result<_, Diagnostic>>()?,
                }
            }
            DrawRon::Position(run) => Draw::Position(self.word(run)?),
            DrawRon::Strong(of) => Draw::Strong(self.word(of)?),
        };
        Ok((self.word(name)?, draw))
    }
}
