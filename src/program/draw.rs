//! Hints for pictures of inputs, names resolved. No meaning.

use super::{InputId, LevelSet};
use crate::table::draw::Side;

/// The drawing of one input.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Draw {
    /// A position in the cell, from its left to its right border.
    Across,
    /// A position in the cell, from its top to its bottom border.
    Down,
    /// Marked sides of the cell or of one of its neighbours.
    Sides {
        /// The neighbour, if it is not the cell itself.
        of: Option<Side>,
        /// The sides, by the index of the level.
        levels: Vec<Vec<Side>>,
    },
    /// The levels at which the cell is dark.
    Dark(LevelSet),
    /// A run of cells along marked sides.
    Run {
        /// The input that marks the sides.
        along: InputId,
        /// The number of closed ends, by the index of the level; `None` draws no run.
        ends: Vec<Option<u8>>,
    },
    /// A position in the run that another input is drawn as.
    Position(InputId),
    /// A condition under which the marks of another input are drawn strongly.
    Strong(InputId),
}
