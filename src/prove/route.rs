//! The beginnings of the paths of each state: behind the tests that the state alone decides.
//!
//! All states go through the plan together. A test costs no more than the
//! states it takes away, so ten thousand tests over ten thousand states do not
//! cost 10^8 checks.

use std::collections::BTreeMap;

use crate::plan::{Plan, Step, StepId};
use crate::program::claims::{Boxes, decide};

/// For each of `states`, the first step that the state does not decide.
pub(super) fn starts(plan: &Plan<'_>, states: &[usize]) -> Vec<StepId> {
    let program = plan.program;
    let mut router = Router {
        plan,
        boxes: Boxes::new(program),
        owner: vec![0; program.states.count()],
        group: 0,
        starts: vec![plan.root(); program.states.count()],
        open: vec![(plan.root(), states.to_vec())],
    };
    while let Some((at, states)) = router.open.pop() {
        router.follow(at, states);
    }
    router.starts
}

struct Router<'a, 'p> {
    plan: &'a Plan<'p>,
    boxes: Boxes<'p>,
    /// The group that each state is in.
    owner: Vec<u32>,
    group: u32,
    starts: Vec<StepId>,
    /// Steps to which some states have come.
    open: Vec<(StepId, Vec<usize>)>,
}

impl Router<'_, '_> {
    /// Follows states down the plan while they stay together; those that turn off are followed later.
    fn follow(&mut self, mut at: StepId, mut states: Vec<usize>) {
        let plan = self.plan;
        self.group += 1;
        let group = self.group;
        states.iter().for_each(|state| self.owner[*state] = group);
        let mut left = states.len();
        while left > 0 {
            match plan.step(at) {
                Step::Test { condition, then, other }
                    if plan.pool.cond_facts(*condition).inputs.and(plan.program.fetched).is_empty() =>
                {
                    let mut taken = Vec::new();
                    let (owner, starts) = (&mut self.owner, &mut self.starts);
                    let mut visit = |state: usize, holds: Option<bool>| {
                        if owner[state] != group || holds == Some(false) {
                            return;
                        }
                        owner[state] = 0;
                        left -= 1;
                        match holds {
                            Some(_) => taken.push(state),
                            None => starts[state] = at,
                        }
                    };
                    if self.boxes.size(&plan.pool, *condition) < states.len() {
                        self.boxes.each(&plan.pool, *condition, &mut visit);
                    } else {
                        let mut levels = vec![0; plan.program.inputs.len()];
                        for state in &states {
                            plan.program.states.write(*state, &mut levels);
                            visit(*state, decide(plan.program, &plan.pool, *condition, &levels));
                        }
                        states.retain(|state| self.owner[*state] == group);
                    }
                    if !taken.is_empty() {
                        self.open.push((*then, taken));
                    }
                    at = *other;
                }
                Step::Switch { arms } => {
                    let mut ways: BTreeMap<StepId, Vec<usize>> = BTreeMap::new();
                    for state in states.into_iter().filter(|state| self.owner[*state] == group) {
                        match plan.lookup.get(state).and_then(|arm| arms.get(usize::from(*arm))) {
                            Some(arm) => ways.entry(*arm).or_default().push(state),
                            None => self.starts[state] = at,
                        }
                    }
                    self.open.extend(ways);
                    return;
                }
                Step::Coefficients { rest } => {
                    let mut ways: BTreeMap<StepId, Vec<usize>> = BTreeMap::new();
                    for state in states.into_iter().filter(|state| self.owner[*state] == group) {
                        let entry = plan.lookup.get(state).map(|entry| usize::from(*entry));
                        let behind = entry.and_then(|entry| entry.checked_sub(plan.coefficients.fits.len()));
                        match behind.and_then(|place| rest.get(place)) {
                            Some(arm) => ways.entry(*arm).or_default().push(state),
                            // It has coefficients, or no way at all.
                            None => self.starts[state] = at,
                        }
                    }
                    self.open.extend(ways);
                    return;
                }
                Step::Test { .. } | Step::Fetch { .. } | Step::Gather { .. } | Step::Orbit { .. } | Step::Leaf(_) => {
                    for state in states.into_iter().filter(|state| self.owner[*state] == group) {
                        self.starts[state] = at;
                    }
                    return;
                }
            }
        }
    }
}
