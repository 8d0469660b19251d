//! The tree of tests on inputs that leads to the leaf soonest.
//!
//! A node is the list of states that can still be; a test parts it by some
//! levels of one input. The least expected number of tests is found by
//! dynamic programming over such lists where they are few enough. Otherwise
//! each node takes the test that tells most, and what any tree must cost (each
//! test tells one bit at most) bounds what that may have missed. Equal parts of
//! the tree become one.
//!
//! Where a number is compared with many constants, what the state leaves is found by a search among them.
//!
//! Fetches need no place in what is minimised. The state decides which inputs are
//! fetched or which tests of fetched inputs follow, and in which order is part of
//! the meaning: no tree over the state can save one, so their cost is the same in
//! all. It is said beside the number of tests.

use std::cell::RefCell;
use std::collections::HashMap;

use super::Definition;
use crate::plan::arms::Arms;
use crate::plan::builder::{Builder, Result};
use crate::plan::key::KeyLayout;
use crate::plan::order::Certificate;
use crate::plan::search::Search;
use crate::plan::setting::Setting;
use crate::plan::{Plan, Step, StepId};
use crate::program::claims::decide;
use crate::program::{InputId, LevelSet};

/// Most states that are looked at, over all nodes, in the search for the best tree.
const MAX_LOOKS: usize = 4_000_000;
/// Most states of a table for a tree at all.
const MAX_STATES: usize = 1 << 14;

pub(super) static SHAPE: Definition = Definition {
    name: "tree",
    summary: "a graph of tests on inputs with the least expected number of them, numbers searched for among constants",
    reads_buffer: false,
    needs_key: false,
    holds_data: false,
    plan: tree,
};

/// A graph of tests that ends where the arm is clear.
fn tree<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    if setting.states.len() > MAX_STATES {
        return Err(format!(
            "it goes through every state many times, and {} are more than {MAX_STATES}; use `ladder` or `switch_buffer`",
            setting.states.len()
        ));
    }
    let key = KeyLayout::new(program)?;
    let mut builder = Builder::new(program);
    let arms = Arms::new(&mut builder, setting)?;
    let mut search = Search::new();
    let steps = arms.steps_by(&mut builder, |builder, rows, known| search.rows(builder, rows, known))?;
    let searched = search.notes(&builder);
    let ways: Vec<StepId> = arms.of.iter().map(|arm| steps[usize::from(*arm)]).collect();
    let fetches = fetch_cost(&builder, setting, &ways);
    let mut planner = Planner {
        levels: levels(setting),
        ways,
        shares: &setting.shares,
        sums: RefCell::new(vec![0.0; builder.len()]),
        digits: program.states.digits(),
        known: HashMap::new(),
        looks: 0,
    };
    let all: Vec<u32> = (0..setting.states.len() as u32).collect();
    let planned = planner.best(&all);
    let exact = planned.is_some();
    let mut made = Made { builder: &mut builder, cost: 0.0 };
    let root = planner.build(&all, exact, &mut made)?;
    let cost = made.cost;
    let bound = if exact { cost } else { planner.entropy(&all) };
    let mut plan = builder.finish(setting, key, Vec::new(), root);
    plan.certificate = Some(Certificate { written: super::chain::written(setting)?, planned: cost, bound });
    plan.notes.extend(searched);
    plan.notes.extend(fetches.map(|cost| format!("expected cost of fetches {cost:.3}, the same in every tree")));
    Ok(plan)
}

/// The average cost of fetches, the same in every tree: the state alone decides the arm. Where
/// an arm tests what the state leaves open, both sides are thought to be as likely.
fn fetch_cost(builder: &Builder<'_>, setting: &Setting<'_, '_>, starts: &[StepId]) -> Option<f64> {
    let program = setting.program;
    if program.fetched.is_empty() || setting.states.len() * builder.len() > MAX_LOOKS {
        return None;
    }
    let mut levels = vec![0; program.inputs.len()];
    let mut costs = vec![0.0; builder.len()];
    let mut sum = 0.0;
    for ((state, share), start) in setting.states.iter().zip(&setting.shares).zip(starts) {
        if *share == 0.0 {
            continue;
        }
        program.states.write(*state, &mut levels);
        // What follows a step was made before it.
        for place in 0..=start.0 as usize {
            costs[place] = match builder.step(StepId(place as u32)) {
                Step::Fetch { input, next } => {
                    program.inputs[input.index()].fetched.unwrap_or_default() + costs[next.0 as usize]
                }
                Step::Test { condition, then, other } => {
                    let (then, other) = (costs[then.0 as usize], costs[other.0 as usize]);
                    match decide(program, &builder.pool, *condition, &levels) {
                        Some(holds) => {
                            if holds {
                                then
                            } else {
                                other
                            }
                        }
                        None => (then + other) / 2.0,
                    }
                }
                Step::Gather { .. }
                | Step::Switch { .. }
                | Step::Coefficients { .. }
                | Step::Orbit { .. }
                | Step::Leaf(_) => 0.0,
            };
        }
        sum += share * costs[start.0 as usize];
    }
    Some(sum)
}

/// The levels of each state, input by input.
fn levels(setting: &Setting<'_, '_>) -> Vec<Vec<u8>> {
    let program = setting.program;
    let mut of_state = vec![0; program.inputs.len()];
    let mut levels = vec![Vec::with_capacity(setting.states.len()); program.states.digits().len()];
    for state in &setting.states {
        program.states.write(*state, &mut of_state);
        for (list, (input, _)) in levels.iter_mut().zip(program.states.digits()) {
            list.push(of_state[input.index()]);
        }
    }
    levels
}

/// A test: of an input, by its place among those of a state, for some levels.
type Question = (usize, LevelSet);

struct Planner<'a> {
    levels: Vec<Vec<u8>>,
    /// The step that each state must come to.
    ways: Vec<StepId>,
    shares: &'a [f64],
    /// By step, the share of the states that go there, while it is added up; otherwise zero.
    sums: RefCell<Vec<f64>>,
    digits: &'a [(InputId, usize)],
    /// The best test of each list of states, and the expected number of tests from there on.
    known: HashMap<Vec<u32>, (Option<Question>, f64)>,
    looks: usize,
}

struct Made<'b, 'p> {
    builder: &'b mut Builder<'p>,
    cost: f64,
}

impl Planner<'_> {
    fn is_clear(&self, states: &[u32]) -> bool {
        states.iter().all(|state| self.ways[*state as usize] == self.ways[states[0] as usize])
    }

    fn share(&self, states: &[u32]) -> f64 {
        states.iter().map(|state| self.shares[*state as usize]).sum()
    }

    fn part(&self, states: &[u32], (place, levels): Question) -> (Vec<u32>, Vec<u32>) {
        states.iter().partition(|state| levels.contains(self.levels[place][**state as usize]))
    }

    /// The tests that part some states: by one level, by the levels up to one,
    /// and of few levels by any of them. Levels between which the states do not
    /// differ stay together.
    fn questions(&self, states: &[u32]) -> Vec<Question> {
        let mut questions = Vec::new();
        for (place, (_, count)) in self.digits.iter().enumerate() {
            let mut present = LevelSet(0);
            for state in states {
                present.0 |= LevelSet::one(self.levels[place][*state as usize]).0;
            }
            let present: Vec<u8> = present.iter().collect();
            let Some((last, others)) = present.split_last() else { continue };
            if others.is_empty() || !self.matters(states, place) {
                continue;
            }
            if *count <= 4 {
                // The last level is never asked for: the answer would be the opposite one.
                for chosen in 1..1_u64 << others.len() {
                    let levels = others.iter().zip(0..).filter(|(_, bit)| chosen >> bit & 1 == 1);
                    questions.push((place, LevelSet(levels.map(|(level, _)| 1 << level).sum())));
                }
                continue;
            }
            let mut below = LevelSet(0);
            for level in others {
                below.0 |= LevelSet::one(*level).0;
                questions.push((place, below));
                if below.0.count_ones() > 1 {
                    questions.push((place, LevelSet::one(*level)));
                }
            }
            if others.len() > 1 {
                questions.push((place, LevelSet::one(*last)));
            }
        }
        questions
    }

    /// Returns whether some states that differ in this input only go different ways.
    fn matters(&self, states: &[u32], place: usize) -> bool {
        let mut ways: HashMap<Vec<u8>, StepId> = HashMap::with_capacity(states.len());
        states.iter().any(|state| {
            let state = *state as usize;
            let others = self.levels.iter().enumerate().filter(|(digit, _)| *digit != place);
            let key: Vec<u8> = others.map(|(_, levels)| levels[state]).collect();
            *ways.entry(key).or_insert(self.ways[state]) != self.ways[state]
        })
    }

    /// The least expected number of tests, counted from some states on; `None` if that is too much work.
    fn best(&mut self, states: &[u32]) -> Option<f64> {
        if self.is_clear(states) {
            return Some(0.0);
        }
        if let Some((_, cost)) = self.known.get(states) {
            return Some(*cost);
        }
        let share = self.share(states);
        if share <= 0.0 {
            // Any tree will do.
            return Some(0.0);
        }
        self.looks += states.len() * self.digits.len();
        if self.looks > MAX_LOOKS {
            return None;
        }
        let mut best: (Option<Question>, f64) = (None, f64::INFINITY);
        let mut questions: Vec<(f64, Question)> =
            self.questions(states).into_iter().map(|question| (self.left(states, question), question)).collect();
        self.looks += states.len() * questions.len();
        // The most telling first: what follows is then soon seen to be no better.
        questions.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (left, question) in questions {
            if share + left >= best.1 {
                continue;
            }
            let (yes, no) = self.part(states, question);
            let cost = share + self.best(&yes)?;
            if cost >= best.1 {
                continue;
            }
            let cost = cost + self.best(&no)?;
            if cost < best.1 {
                best = (Some(question), cost);
            }
        }
        self.known.insert(states.to_vec(), best);
        Some(best.1)
    }

    /// The entropy that is left after a test, in bits.
    fn left(&self, states: &[u32], question: Question) -> f64 {
        let (yes, no) = self.part(states, question);
        self.entropy(&yes) + self.entropy(&no)
    }

    /// The entropy of where some states go, in bits times their share: the
    /// least that any tests need to find out.
    fn entropy(&self, states: &[u32]) -> f64 {
        let mut sums = self.sums.borrow_mut();
        let mut met = Vec::new();
        for state in states {
            let (way, share) = (self.ways[*state as usize].0 as usize, self.shares[*state as usize]);
            if sums[way] == 0.0 {
                met.push(way);
            }
            sums[way] += share;
        }
        let all = self.share(states);
        // In order: sums of floating-point numbers depend on it. A way that was met before it had a
        // share is met again, and then has none left.
        let shares = met.into_iter().map(|way| std::mem::take(&mut sums[way]));
        let mut shares: Vec<f64> = shares.filter(|share| *share > 0.0).collect();
        shares.sort_by(f64::total_cmp);
        shares.into_iter().map(|share| share * libm::log2(all / share)).sum()
    }

    /// The test that tells most.
    fn telling(&self, states: &[u32]) -> Option<Question> {
        let scored = self.questions(states).into_iter().map(|question| {
            let (yes, no) = self.part(states, question);
            // Where nothing occurs, what parts the ways most evenly.
            let even = yes.len().abs_diff(no.len());
            (self.entropy(&yes) + self.entropy(&no), even, question)
        });
        let best = scored.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        best.map(|(_, _, question)| question)
    }

    fn build(&self, states: &[u32], exact: bool, made: &mut Made<'_, '_>) -> Result<StepId> {
        if self.is_clear(states) {
            return Ok(self.ways[states[0] as usize]);
        }
        made.cost += self.share(states);
        let question = match self.known.get(states) {
            Some((question, _)) if exact => *question,
            _ => self.telling(states),
        };
        let question = question.ok_or_else(|| "two states with the same levels go different ways".to_owned())?;
        let (yes, no) = self.part(states, question);
        let (yes, no) = (self.build(&yes, exact, made)?, self.build(&no, exact, made)?);
        let (input, count) = self.digits[question.0];
        let condition = made.builder.pool.level(input, question.1, count);
        made.builder.test(condition, yes, no)
    }
}
