//! The arms of a lookup: for each state the rows that may be taken there, alike ones together.

use std::collections::HashMap;

use super::StepId;
use super::builder::{Builder, Guarded, Result};
use super::knowledge::Knowledge;
use super::setting::Setting;
use crate::program::LevelSet;

/// The ways to go that the state decides.
pub(super) struct Arms {
    /// Each way, with the levels that occur on it.
    ways: Vec<(Guarded, Vec<LevelSet>)>,
    /// The way of each state of the setting.
    pub(super) of: Vec<u16>,
}

impl Arms {
    pub(super) fn new(builder: &mut Builder<'_>, setting: &Setting<'_, '_>) -> Result<Self> {
        let program = setting.program;
        let claims = setting.claims()?;
        let mut arms = Self { ways: Vec::new(), of: Vec::with_capacity(setting.states.len()) };
        let mut index: HashMap<Guarded, u16> = HashMap::new();
        let mut levels = vec![0; program.inputs.len()];
        for state in &setting.states {
            program.states.write(*state, &mut levels);
            let rows = builder.rows_of_state(claims, *state, &levels);
            let arm = match index.get(&rows) {
                Some(arm) => *arm,
                None => {
                    let count = arms.ways.len();
                    let arm = u16::try_from(count).map_err(|_| "it has more than 65535 ways to go".to_owned())?;
                    index.insert(rows.clone(), arm);
                    arms.ways.push((rows, vec![LevelSet(0); program.inputs.len()]));
                    arm
                }
            };
            for (input, _) in program.states.digits() {
                arms.ways[usize::from(arm)].1[input.index()].0 |= LevelSet::one(levels[input.index()]).0;
            }
            arms.of.push(arm);
        }
        Ok(arms)
    }

    /// The steps of each way: chains of its rows.
    pub(super) fn steps(&self, builder: &mut Builder<'_>) -> Result<Vec<StepId>> {
        self.steps_by(builder, |builder, rows, known| builder.rows(rows, known))
    }

    /// The steps of each way, made of its rows by `make`.
    pub(super) fn steps_by<'p>(
        &self,
        builder: &mut Builder<'p>,
        mut make: impl FnMut(&mut Builder<'p>, &Guarded, &Knowledge) -> Result<StepId>,
    ) -> Result<Vec<StepId>> {
        let program = builder.program;
        let mut steps = Vec::with_capacity(self.ways.len());
        for (rows, hull) in &self.ways {
            let mut known = Knowledge::none(program);
            for (input, _) in program.states.digits() {
                known.restrict(*input, hull[input.index()]);
            }
            steps.push(make(builder, rows, &known)?);
        }
        Ok(steps)
    }

    /// The way of every state of the program.
    pub(super) fn of_state(&self, setting: &Setting<'_, '_>) -> Vec<Option<u16>> {
        let mut of = vec![None; setting.program.states.count()];
        setting.states.iter().zip(&self.of).for_each(|(state, arm)| of[*state] = Some(*arm));
        of
    }
}
