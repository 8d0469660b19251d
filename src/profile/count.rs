//! Counting: evaluations of a table → what a scene contributes to a profile.

use std::collections::BTreeMap;

use super::{Scene, Tiles};
use crate::eval::{Batch, Columns, Missing};
use crate::program::Program;

/// Pixels per row and rows of a tile: 32 threads that are neighbours.
pub const TILE: (u32, u32) = (8, 4);

/// Most sets of states that are listed; those of common scenes are some hundred.
const MAX_SETS: usize = 4096;

/// The evaluations at the pixels of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// Pixels per row.
    pub width: usize,
    /// The state of each pixel, row by row; `None` where the table was not evaluated.
    pub states: &'a [Option<usize>],
    /// The case taken, by its id; `None` for the default. Not looked at where there is no state.
    pub cases: &'a [Option<u32>],
}

impl Scene {
    /// Counts points in no particular arrangement.
    ///
    /// # Errors
    /// With the first point that needs an absent input.
    pub fn of_columns(program: &Program, name: &str, columns: &Columns<f32>) -> Result<Self, Missing> {
        let results = Batch::<f32>::new(program).evaluate(columns)?;
        let mut scene = Self::new(name, &program.name, "captured");
        for row in 0..columns.len() {
            let state = program.states.index(|input| columns.levels(input)[row]);
            *scene.states.entry(state).or_default() += 1;
        }
        for (path, count) in results.histogram() {
            *scene.cases.entry(path.row.map(|row| program.rows[row].id)).or_default() += count as u64;
        }
        Ok(scene)
    }

    /// Counts the pixels of a picture, and its tiles.
    pub fn of_frame(name: &str, technique: &str, setting: &str, frame: Frame<'_>) -> Self {
        let mut scene = Self::new(name, technique, setting);
        for (state, case) in frame.states.iter().zip(frame.cases) {
            if let Some(state) = state {
                *scene.states.entry(*state).or_default() += 1;
                *scene.cases.entry(*case).or_default() += 1;
            }
        }
        scene.tiles = Some(tiles(frame));
        scene
    }

    fn new(name: &str, technique: &str, setting: &str) -> Self {
        Self {
            name: name.to_owned(),
            technique: technique.to_owned(),
            setting: setting.to_owned(),
            weight: 1.0,
            states: BTreeMap::new(),
            cases: BTreeMap::new(),
            tiles: None,
        }
    }
}

fn tiles(frame: Frame<'_>) -> Tiles {
    let (width, height) = (TILE.0 as usize, TILE.1 as usize);
    let columns = frame.width.div_ceil(width).max(1);
    let mut of_tile: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (pixel, state) in frame.states.iter().enumerate() {
        if let Some(state) = state {
            let (x, y) = (pixel % frame.width, pixel / frame.width);
            of_tile.entry(y / height * columns + x / width).or_default().push(*state);
        }
    }
    let mut sets: BTreeMap<Vec<usize>, u64> = BTreeMap::new();
    for mut set in of_tile.into_values() {
        set.sort_unstable();
        set.dedup();
        *sets.entry(set).or_default() += 1;
    }
    let mut ranked: Vec<(Vec<usize>, u64)> = sets.into_iter().collect();
    // The sort is stable, so among equally frequent ones the first in order are kept.
    ranked.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    let others = ranked.iter().skip(MAX_SETS).map(|(_, count)| count).sum();
    ranked.truncate(MAX_SETS);
    Tiles { width: TILE.0, height: TILE.1, sets: ranked.into_iter().collect(), others }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_collect_the_states_of_neighbours() {
        // Two tiles in a row; the second one is cut off by the border.
        let mut states = vec![None; 10 * 4];
        states[0] = Some(7);
        states[13] = Some(3);
        states[31] = Some(7);
        states[9] = Some(3);
        let cases = vec![Some(1); states.len()];
        let scene = Scene::of_frame("s", "t", "", Frame { width: 10, states: &states, cases: &cases });
        assert_eq!(scene.states, [(3, 2), (7, 2)].into());
        assert_eq!(scene.cases, [(Some(1), 4)].into());
        let tiles = scene.tiles.expect("a frame has tiles");
        assert_eq!(tiles.sets, [(vec![3], 1), (vec![3, 7], 1)].into());
        assert_eq!((tiles.others, tiles.mean_states()), (0, 1.5));
    }
}
