//! The inputs to measure with: captured ones, random ones, coherent ones.
//!
//! The cost of a plan depends on the work of neighbouring threads. So each
//! plan meets three kinds of columns: what frames really contain, the worst a
//! group of threads can meet, and the best.

use std::fmt;

use crate::eval::Columns;
use crate::points::random::Random;
use crate::profile::Profile;
use crate::program::{Domain, Program, Value, reachable};

/// Threads of a coherent run: as many as run in step on most devices.
const RUN: usize = 32;

/// A kind of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// From frames, in the order of their pixels; or, without frames, states drawn as the profile says.
    Captured,
    /// Every thread a state of its own, drawn from the reachable ones.
    Random,
    /// Runs of threads in one state.
    Coherent,
}

impl Kind {
    /// All of them, in the order of reports.
    pub const ALL: [Kind; 3] = [Kind::Captured, Kind::Random, Kind::Coherent];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Captured => "captured",
            Kind::Random => "random",
            Kind::Coherent => "coherent",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Makes inputs; the same ones every time.
pub(super) struct Source<'p> {
    program: &'p Program,
    reachable: Vec<usize>,
    random: Random,
}

impl<'p> Source<'p> {
    pub(super) fn new(program: &'p Program) -> Self {
        let mut reachable = reachable(program);
        if reachable.is_empty() {
            reachable = (0..program.states.count()).collect();
        }
        Self { program, reachable, random: Random::new(0x2545_f491_4f6c_dd1d) }
    }

    /// As many rows of a kind.
    pub(super) fn rows(
        &mut self,
        kind: Kind,
        count: usize,
        frames: Option<&Columns<f32>>,
        profile: &Profile,
    ) -> Columns<f32> {
        let states: Vec<usize> = match (kind, frames) {
            (Kind::Captured, Some(frames)) => {
                let cycle: Vec<usize> = (0..frames.len()).cycle().take(count).collect();
                return frames.select(&cycle);
            }
            (Kind::Captured, None) => self.by_weight(&profile.state_weights(), count),
            (Kind::Random, _) => (0..count).map(|_| self.any_reachable()).collect(),
            (Kind::Coherent, _) => {
                let runs: Vec<usize> = (0..count.div_ceil(RUN)).map(|_| self.any_reachable()).collect();
                (0..count).map(|row| runs[row / RUN]).collect()
            }
        };
        let mut columns = Columns::new(self.program);
        for state in states {
            let point = self.point(state);
            // Made from the program's own inputs, so it fits.
            let _ = columns.push(&point);
        }
        columns
    }

    /// Some of the rows, drawn anew at each call.
    pub(super) fn subset(&mut self, columns: &Columns<f32>, count: usize) -> Columns<f32> {
        let rows: Vec<usize> = (0..count).map(|_| self.random.below(columns.len())).collect();
        columns.select(&rows)
    }

    fn by_weight(&mut self, weights: &[f64], count: usize) -> Vec<usize> {
        let mut sums = Vec::with_capacity(weights.len());
        let mut sum = 0.0;
        for weight in weights {
            sum += weight;
            sums.push(sum);
        }
        let mut draw = || {
            let at = self.random.unit() * sum;
            sums.partition_point(|reached| *reached <= at).min(weights.len().saturating_sub(1))
        };
        (0..count).map(|_| draw()).collect()
    }

    fn any_reachable(&mut self) -> usize {
        let place = self.random.below(self.reachable.len());
        self.reachable[place]
    }

    fn point(&mut self, state: usize) -> Vec<Option<Value>> {
        let program = self.program;
        let mut levels = vec![0; program.inputs.len()];
        program.states.write(state, &mut levels);
        let value = |(id, input): (crate::program::InputId, &crate::program::Input)| {
            Some(match &input.domain {
                Domain::Discrete(_) if input.fetched.is_none() => Value::Level(levels[id.index()]),
                Domain::Discrete(all) => Value::Level(self.random.below(all.count()) as u8),
                domain @ (Domain::Continuous { .. } | Domain::Word) => {
                    let (lo, hi) = domain.span();
                    Value::Number(domain.given(lo + (hi - lo) * self.random.unit()))
                }
            })
        };
        program.input_ids().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_of_their_kind() {
        let program = Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"));
        let mut profile = Profile::new(&program);
        profile.scenes.push(crate::profile::Scene {
            name: "one state".to_owned(),
            technique: "smsr".to_owned(),
            setting: String::new(),
            weight: 1.0,
            states: [(77, 3)].into(),
            cases: [(Some(1), 3)].into(),
            tiles: None,
        });
        let mut source = Source::new(&program);
        let state = |columns: &Columns<f32>, row: usize| program.states.index(|input| columns.levels(input)[row]);
        let drawn = source.rows(Kind::Captured, 50, None, &profile);
        assert!((0..50).all(|row| state(&drawn, row) == 77));
        let again = source.rows(Kind::Captured, 120, Some(&drawn), &profile);
        assert_eq!((again.len(), again.point(3)), (120, again.point(103)));
        let coherent = source.rows(Kind::Coherent, 100, None, &profile);
        assert_eq!(coherent.len(), 100);
        assert!((0..100).all(|row| state(&coherent, row) == state(&coherent, row / 32 * 32)));
        let random = source.rows(Kind::Random, 100, None, &profile);
        let different = (1..100).filter(|row| state(&random, *row) != state(&random, row - 1)).count();
        assert!(different > 80, "{different}");
    }

    /// A state that has too many paths may occur, so plans are measured in it.
    #[test]
    fn states_with_too_many_paths_are_drawn() {
        let program = crate::program::with_too_many_paths();
        assert_eq!(Source::new(&program).reachable, [0, 1]);
    }
}
