//! Profiles: how often each discrete state of a table occurs, in which scene.
//!
//! A [`Profile`] is what planner and tuner know about the world. It counts
//! states and not only cases, because a plan decides on states: two cases can
//! be exchanged, or a test be made first, only if it is known what the inputs
//! were. Counts are kept per scene, so that deviations between scenes can be
//! shown and scenes weighted.
//!
//! Nothing here knows how a scene is rendered or a device is driven; who does
//! hands over columns of inputs, or the state and case of every pixel.

#[cfg(feature = "report")]
mod chart;
mod count;
mod file;
mod fit;
mod hits;
mod summary;

use std::collections::BTreeMap;

use crate::program::{Program, StateSpace};

#[cfg(feature = "report")]
pub use chart::chart;
pub use count::{Frame, TILE};
pub use file::{read, to_ron};
pub use fit::{Excluded, Fitted, fit};
pub use hits::{Hits, lcov};
pub use summary::{Change, Frequency, changes, frequencies, shares, total_variation};

/// The frequencies of a table's states.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Name of the table.
    pub table: String,
    /// Fingerprint of the table's meaning when it was counted.
    pub fingerprint: String,
    /// The inputs that make up a state, in order, the last one varying fastest.
    pub inputs: Vec<StateInput>,
    /// The scenes.
    pub scenes: Vec<Scene>,
}

/// An input that is part of a state.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StateInput {
    /// Its name.
    pub name: String,
    /// The names of its levels.
    pub levels: Vec<String>,
}

/// The counts of one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// The technique it was rendered with.
    pub technique: String,
    /// Sizes and whatever else one would need to count again; for people.
    pub setting: String,
    /// The weight of a count of this scene.
    pub weight: f64,
    /// Evaluations by state. States that do not occur are left out.
    pub states: BTreeMap<usize, u64>,
    /// Evaluations by case; `None` is the default.
    pub cases: BTreeMap<Option<u32>, u64>,
    /// The states that threads in step meet together.
    pub tiles: Option<Tiles>,
}

/// The states that occur together in a tile of pixels, as large as the group of
/// threads that runs in step. The group pays for every path that one of its
/// threads takes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tiles {
    /// Pixels per row of a tile.
    pub width: u32,
    /// Rows of a tile.
    pub height: u32,
    /// The number of tiles with each set of states. The states of a set ascend.
    pub sets: BTreeMap<Vec<usize>, u64>,
    /// Tiles whose sets are too rare to be listed.
    pub others: u64,
}

impl Profile {
    /// A profile without scenes.
    pub fn new(program: &Program) -> Self {
        Self {
            table: program.name.clone(),
            fingerprint: program.fingerprint(),
            inputs: state_inputs(program),
            scenes: Vec::new(),
        }
    }

    /// Evaluations, over all scenes.
    pub fn total(&self) -> u64 {
        self.scenes.iter().map(Scene::total).fold(0, u64::saturating_add)
    }

    /// A state in words, one level per input.
    pub fn words(&self, state: usize) -> String {
        let mut rest = state;
        let mut words: Vec<&str> = Vec::with_capacity(self.inputs.len());
        for input in self.inputs.iter().rev() {
            words.push(&input.levels[rest % input.levels.len()]);
            rest /= input.levels.len();
        }
        words.reverse();
        words.join(" ")
    }

    /// The state that words stand for.
    fn state(&self, words: &str) -> Result<usize, String> {
        let mut state = 0;
        let mut given = words.split_whitespace();
        for input in &self.inputs {
            let Some(word) = given.next() else { return Err(format!("no level of `{}`", input.name)) };
            let Some(level) = input.levels.iter().position(|level| level == word) else {
                return Err(format!("not a level of `{}`: {}", input.name, input.levels.join(", ")));
            };
            state = state * input.levels.len() + level;
        }
        match given.next() {
            None => Ok(state),
            Some(_) => Err(format!("more levels than the {} inputs", self.inputs.len())),
        }
    }

    /// The number of states, if they are not too many.
    fn state_count(&self) -> Option<usize> {
        let product = self.inputs.iter().try_fold(1_u64, |all, input| all.checked_mul(input.levels.len() as u64));
        product.filter(|count| (1..=StateSpace::MAX).contains(count)).map(|count| count as usize)
    }

    /// The weight of each state: counts times the weights of their scenes.
    pub fn state_weights(&self) -> Vec<f64> {
        let mut weights = vec![0.0; self.state_count().unwrap_or(0)];
        for scene in &self.scenes {
            for (state, count) in &scene.states {
                weights[*state] += scene.weight * *count as f64;
            }
        }
        weights
    }

    /// The scenes in words, for headers and reports.
    pub fn describe(&self) -> String {
        let name = |scene: &Scene| match scene.weight == 1.0 {
            true => scene.name.clone(),
            false => format!("{} ({}x)", scene.name, scene.weight),
        };
        let names: Vec<String> = self.scenes.iter().map(name).collect();
        format!("{} evaluations of {}", self.total(), names.join(", "))
    }

    /// Adds the scenes of another profile, whose counts weigh `weight` times as much.
    /// The same scene in the same setting is counted together if its weight is the same.
    ///
    /// # Errors
    /// With the reason, if it is the profile of something else.
    pub fn merge(&mut self, other: &Profile, weight: f64) -> Result<(), String> {
        if self.table != other.table {
            return Err(format!("one is a profile of the table `{}`, one of `{}`", self.table, other.table));
        }
        if self.fingerprint != other.fingerprint || self.inputs != other.inputs {
            return Err(format!("the table `{}` did not mean the same when they were counted", self.table));
        }
        for scene in &other.scenes {
            let scene = Scene { weight: scene.weight * weight, ..scene.clone() };
            match self.scenes.iter_mut().find(|mine| mine.is_same(&scene)) {
                Some(mine) => mine.add(&scene),
                None => self.scenes.push(scene),
            }
        }
        Ok(())
    }
}

impl Tiles {
    /// The mean number of different states in a tile: 1 where neighbours agree, more where they diverge.
    pub fn mean_states(&self) -> f64 {
        let tiles: f64 = self.sets.values().map(|count| *count as f64).sum();
        let states: f64 = self.sets.iter().map(|(set, count)| set.len() as f64 * *count as f64).sum();
        if tiles > 0.0 { states / tiles } else { 0.0 }
    }
}

impl Scene {
    /// Evaluations.
    pub fn total(&self) -> u64 {
        self.states.values().copied().fold(0, u64::saturating_add)
    }

    fn is_same(&self, other: &Scene) -> bool {
        let key = |scene: &Scene| (scene.name.clone(), scene.technique.clone(), scene.setting.clone());
        key(self) == key(other) && self.weight == other.weight
    }

    fn add(&mut self, other: &Scene) {
        let add = |count: &mut u64, more: u64| *count = count.saturating_add(more);
        other.states.iter().for_each(|(state, count)| add(self.states.entry(*state).or_default(), *count));
        other.cases.iter().for_each(|(case, count)| add(self.cases.entry(*case).or_default(), *count));
        self.tiles = match (self.tiles.take(), &other.tiles) {
            (Some(mut mine), Some(theirs)) if (mine.width, mine.height) == (theirs.width, theirs.height) => {
                theirs.sets.iter().for_each(|(set, count)| add(mine.sets.entry(set.clone()).or_default(), *count));
                add(&mut mine.others, theirs.others);
                Some(mine)
            }
            // Tiles of only a part of the counts would mislead.
            _ => None,
        };
    }
}

/// The inputs that make up the states of a program.
fn state_inputs(program: &Program) -> Vec<StateInput> {
    let digits = program.states.digits().iter();
    digits
        .map(|(input, _)| StateInput {
            name: program.inputs[input.index()].name.clone(),
            levels: program.levels(*input).map_or_else(Vec::new, |levels| levels.names.clone()),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) fn smsr() -> Program {
        Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"))
    }

    pub(super) fn scene(name: &str, states: &[(usize, u64)], cases: &[(Option<u32>, u64)]) -> Scene {
        Scene {
            name: name.to_owned(),
            technique: "smsr".to_owned(),
            setting: String::new(),
            weight: 1.0,
            states: states.iter().copied().collect(),
            cases: cases.iter().copied().collect(),
            tiles: None,
        }
    }

    #[test]
    fn states_read_back_from_their_words() {
        let program = smsr();
        let profile = Profile::new(&program);
        for state in 0..program.states.count() {
            assert_eq!(profile.state(&profile.words(state)), Ok(state));
        }
        assert_eq!(profile.words(0), "none none dual_negative dual_negative false false");
        assert_eq!(profile.state("none none"), Err("no level of `tH`".to_owned()));
        assert_eq!(profile.state("up"), Err("not a level of `H`: none, right, left, both".to_owned()));
    }

    #[test]
    fn merging_weighs_scenes_and_counts_equal_ones_together() {
        let program = smsr();
        let mut a = Profile::new(&program);
        a.scenes.push(scene("fence", &[(1, 10), (2, 30)], &[(Some(1), 40)]));
        let mut b = Profile::new(&program);
        b.scenes.push(scene("fence", &[(2, 5)], &[(Some(1), 5)]));
        b.scenes.push(scene("lattice", &[(2, 1)], &[(None, 1)]));

        let mut same = a.clone();
        assert_eq!(same.merge(&b, 1.0), Ok(()));
        assert_eq!(same.scenes.len(), 2);
        assert_eq!((same.state_weights()[1], same.state_weights()[2]), (10.0, 36.0));
        assert_eq!(same.scenes[0].cases[&Some(1)], 45);

        let mut weighted = a.clone();
        assert_eq!(weighted.merge(&b, 2.0), Ok(()));
        assert_eq!(weighted.scenes.len(), 3);
        assert_eq!((weighted.state_weights()[1], weighted.state_weights()[2]), (10.0, 42.0));

        b.table = "rsmss".to_owned();
        let refused = "one is a profile of the table `smsr`, one of `rsmss`";
        assert_eq!(a.merge(&b, 1.0), Err(refused.to_owned()));
    }
}
