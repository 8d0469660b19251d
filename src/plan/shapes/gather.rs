//! Every fetch at one place, in front of all tests.
//!
//! In a chain a fetch stands wherever some case asks for it. Threads that run in
//! step pay for each of these places, and a device that runs both sides of
//! every branch pays for all of them always. Here each input has one place, and
//! the condition under which the table needs it: the states in which it does,
//! as few boxes of levels, and what other fetched inputs and comparisons have
//! to say. What follows may look at an input that was not fetched, and finds its
//! first level or least number; the proof checks that nothing depends on it there.

use std::collections::HashMap;

use super::{Definition, chain};
use crate::plan::arms::Arms;
use crate::plan::builder::{Builder, Result};
use crate::plan::key::KeyLayout;
use crate::plan::knowledge::Knowledge;
use crate::plan::order::Certificate;
use crate::plan::setting::Setting;
use crate::plan::{Plan, Step, StepId};
use crate::program::claims::decide;
use crate::program::{Cond, CondId, InputId, InputSet, LevelSet, Pool, Program};

/// Most states of a table, and most steps of all its cases, for this plan.
const MAX_STATES: usize = 1 << 14;
const MAX_STEPS: usize = 2000;
/// Most parts of the condition of one fetch.
const MAX_PARTS: usize = 64;

pub(super) static SHAPE: Definition = Definition {
    name: "gathered",
    summary: "every fetch at one place, then a few tests and chains as in `nested`",
    reads_buffer: false,
    needs_key: false,
    holds_data: false,
    plan: gathered,
};

/// The first tests and chains of `nested`, behind all fetches.
fn gathered<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    if program.fetched.is_empty() {
        return Err("it fetches nothing; use `nested`".to_owned());
    }
    let mut builder = Builder::new(program);
    let needs = needs(&mut builder, setting)?;
    let everywhere: Vec<usize> = (0..setting.states.len()).collect();
    let known = Knowledge::none(program).with_fetched(program.fetched);
    let mut certificate = Certificate { written: chain::written(setting)?, planned: 0.0, bound: 0.0 };
    let root = chain::nest(&mut builder, setting, &everywhere, &known, chain::FIRST_TESTS, &mut certificate)?;
    let root = in_front(&mut builder, &needs, root)?;
    let mut plan = builder.finish(setting, KeyLayout::new(program)?, Vec::new(), root);
    plan.certificate = Some(certificate);
    let fetched = needs.iter().filter(|(_, condition)| plan.pool.truth(*condition) != Some(false)).count();
    plan.notes.push(format!("{fetched} inputs are fetched, each at one place"));
    Ok(plan)
}

/// A condition under which an input is needed, and the states for which it is this one.
type Part = (CondId, Vec<usize>);

/// The fetched inputs and when they are needed, each after those that its condition mentions.
pub(super) fn needs(builder: &mut Builder<'_>, setting: &Setting<'_, '_>) -> Result<Vec<(InputId, CondId)>> {
    let program = setting.program;
    if setting.states.len() > MAX_STATES {
        return Err(format!(
            "it looks for the fetches of every state, and {} states are more than {MAX_STATES}; use `ladder`",
            setting.states.len()
        ));
    }
    // Steps with fetches where the table has them; only their conditions are kept.
    let mut lazy = Builder::new(program);
    let arms = Arms::new(&mut lazy, setting)?;
    let steps = arms.steps(&mut lazy)?;
    if lazy.len() > MAX_STEPS {
        return Err(format!("its cases have {} steps, more than {MAX_STEPS}; use `ladder`", lazy.len()));
    }
    builder.pool = lazy.pool.clone();
    let mut found: Vec<(InputId, Vec<Part>)> = program.fetched.iter().map(|input| (input, Vec::new())).collect();
    let mut levels = vec![0; program.inputs.len()];
    for (state, arm) in setting.states.iter().zip(&arms.of) {
        let step = steps[usize::from(*arm)];
        if matches!(lazy.step(step), Step::Leaf(_)) {
            continue;
        }
        program.states.write(*state, &mut levels);
        let mut known = Knowledge::none(program);
        for (input, _) in program.states.digits() {
            known.restrict(*input, LevelSet::one(levels[input.index()]));
        }
        for (input, parts) in &mut found {
            let mut search =
                Search { lazy: &lazy, pool: &mut builder.pool, input: *input, known: &known, levels: &levels };
            let condition = search.need(step, &mut HashMap::new());
            if builder.pool.truth(condition) == Some(false) {
                continue;
            }
            match parts.iter_mut().find(|(known, _)| *known == condition) {
                Some((_, states)) => states.push(*state),
                None => parts.push((condition, vec![*state])),
            }
        }
    }
    let mut needs = Vec::new();
    let mut covering = Covering::new(setting);
    for (input, parts) in found {
        let mut terms = Vec::new();
        for (condition, states) in parts {
            let boxes = covering.boxes(&states);
            if terms.len() + boxes.len() > MAX_PARTS {
                let name = &program.inputs[input.index()].name;
                return Err(format!("when it needs `{name}` takes more than {MAX_PARTS} conditions; use `ladder`"));
            }
            let boxes: Vec<CondId> = boxes.iter().map(|levels| product(program, &mut builder.pool, levels)).collect();
            let inside = builder.pool.or(boxes);
            terms.push(builder.pool.and([inside, condition]));
        }
        needs.push((input, builder.pool.or(terms)));
    }
    sorted(program, &builder.pool, needs)
}

/// The fetches, then `next`.
pub(super) fn in_front(builder: &mut Builder<'_>, needs: &[(InputId, CondId)], mut next: StepId) -> Result<StepId> {
    for (input, condition) in needs.iter().rev() {
        // What is never needed has to be there only if it is mentioned.
        if builder.pool.truth(*condition) == Some(false) && !builder.mentions(*input) {
            continue;
        }
        next = builder.push(Step::Gather { input: *input, condition: *condition, next })?;
    }
    Ok(next)
}

/// Each after those that its condition mentions.
fn sorted(program: &Program, pool: &Pool, mut needs: Vec<(InputId, CondId)>) -> Result<Vec<(InputId, CondId)>> {
    let mut done = InputSet::default();
    let mut order = Vec::with_capacity(needs.len());
    while !needs.is_empty() {
        let ready = |(_, condition): &(InputId, CondId)| {
            pool.cond_facts(*condition).inputs.and(program.fetched).minus(done).is_empty()
        };
        let place = needs
            .iter()
            .position(ready)
            .ok_or_else(|| "which of two inputs it fetches first differs from case to case; use `ladder`".to_owned())?;
        let need = needs.remove(place);
        done = done.or(InputSet::one(need.0));
        order.push(need);
    }
    Ok(order)
}

/// When an input is needed in one state, as a condition on all that the state does not decide.
struct Search<'a, 'p> {
    lazy: &'a Builder<'p>,
    pool: &'a mut Pool,
    input: InputId,
    known: &'a Knowledge,
    levels: &'a [u8],
}

impl Search<'_, '_> {
    fn need(&mut self, at: StepId, memo: &mut HashMap<StepId, CondId>) -> CondId {
        if let Some(known) = memo.get(&at) {
            return *known;
        }
        let need = match self.lazy.step(at) {
            Step::Fetch { input, .. } if *input == self.input => self.pool.always(true),
            Step::Fetch { next, .. } => self.need(*next, memo),
            Step::Test { condition, then, other } => {
                match decide(self.lazy.program, self.pool, *condition, self.levels) {
                    Some(true) => self.need(*then, memo),
                    Some(false) => self.need(*other, memo),
                    None => {
                        let (then, other) = (self.need(*then, memo), self.need(*other, memo));
                        let condition = self.known.cond(self.pool, *condition);
                        self.choice(condition, then, other)
                    }
                }
            }
            // A way has none of the others inside.
            Step::Leaf(_)
            | Step::Gather { .. }
            | Step::Switch { .. }
            | Step::Coefficients { .. }
            | Step::Orbit { .. } => self.pool.always(false),
        };
        memo.insert(at, need);
        need
    }

    /// `then` where a condition holds, else `other`. What both say of one input becomes one question.
    fn choice(&mut self, condition: CondId, then: CondId, other: CondId) -> CondId {
        if then == other {
            return then;
        }
        let about = [condition, then, other].iter().find_map(|part| self.level(*part).map(|(input, _)| input));
        if let Some(input) = about {
            let count = self.lazy.program.levels(input).map_or(0, |levels| levels.count());
            let sets = [condition, then, other].map(|part| self.levels_in(part, input, count));
            if let [Some(condition), Some(then), Some(other)] = sets {
                let levels = LevelSet(condition.0 & then.0 | !condition.0 & other.0);
                return self.pool.level(input, levels, count);
            }
        }
        match (self.pool.truth(then), self.pool.truth(other)) {
            (Some(false), _) => {
                let not = self.pool.not(condition);
                self.pool.and([not, other])
            }
            (_, Some(true)) => {
                let not = self.pool.not(condition);
                self.pool.or([not, then])
            }
            _ => self.pool.cond_if(condition, then, other),
        }
    }

    /// The input that a condition asks for levels of.
    fn level(&self, condition: CondId) -> Option<(InputId, LevelSet)> {
        match self.pool.cond(condition) {
            Cond::Level(input, levels) => Some((*input, *levels)),
            Cond::Not(inner) => self.level(*inner).map(|(input, levels)| (input, LevelSet(!levels.0))),
            Cond::Const(_) | Cond::Compare(..) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => None,
        }
    }

    /// The levels of an input with which a condition holds, if it asks for nothing else.
    fn levels_in(&self, condition: CondId, input: InputId, count: usize) -> Option<LevelSet> {
        match self.pool.truth(condition) {
            Some(true) => Some(LevelSet::all(count)),
            Some(false) => Some(LevelSet(0)),
            None => self.level(condition).filter(|(known, _)| *known == input).map(|(_, levels)| levels),
        }
    }
}

/// The condition that each input has one of some levels.
fn product(program: &Program, pool: &mut Pool, levels: &[LevelSet]) -> CondId {
    let parts: Vec<CondId> = program
        .states
        .digits()
        .iter()
        .zip(levels)
        .map(|((input, count), levels)| pool.level(*input, *levels, *count))
        .collect();
    pool.and(parts)
}

/// Finds boxes of states.
struct Covering<'p> {
    program: &'p Program,
    /// The states that count; the others may be in any box.
    counts: Vec<bool>,
}

impl<'p> Covering<'p> {
    fn new(setting: &Setting<'p, '_>) -> Self {
        let mut counts = vec![false; setting.program.states.count()];
        setting.states.iter().for_each(|state| counts[*state] = true);
        Self { program: setting.program, counts }
    }

    /// Few boxes that together hold these states and no other one that counts.
    fn boxes(&mut self, states: &[usize]) -> Vec<Vec<LevelSet>> {
        let mut may: Vec<bool> = self.counts.iter().map(|counts| !counts).collect();
        states.iter().for_each(|state| may[*state] = true);
        let mut open = vec![false; may.len()];
        states.iter().for_each(|state| open[*state] = true);
        let mut found = Vec::new();
        let digits = self.program.states.digits().len();
        for state in states {
            if !open[*state] {
                continue;
            }
            // What is asked of few inputs comes first, then what holds many of the states.
            let grown = (0..digits.max(1)).map(|first| self.grown(*state, first, &may));
            let score = |levels: &[LevelSet]| {
                let asked = levels.iter().zip(self.program.states.digits());
                let asked = asked.filter(|(levels, (_, count))| levels.0 != LevelSet::all(*count).0).count();
                (std::cmp::Reverse(asked), self.members(levels).filter(|state| open[*state]).count())
            };
            let Some(best) = grown.max_by_key(|levels| score(levels)) else { continue };
            let members: Vec<usize> = self.members(&best).collect();
            members.into_iter().for_each(|state| open[state] = false);
            found.push(best);
        }
        found
    }

    /// The box around a state that no further level of any input fits into, tried from one input on.
    fn grown(&self, state: usize, first: usize, may: &[bool]) -> Vec<LevelSet> {
        let digits = self.program.states.digits();
        let mut levels = vec![0; self.program.inputs.len()];
        self.program.states.write(state, &mut levels);
        let mut grown: Vec<LevelSet> = digits.iter().map(|(input, _)| LevelSet::one(levels[input.index()])).collect();
        for step in 0..digits.len() {
            let place = (first + step) % digits.len();
            let had = grown[place];
            let mut gets = had;
            for level in LevelSet::all(digits[place].1).iter().filter(|level| !had.contains(*level)) {
                grown[place] = LevelSet::one(level);
                if self.members(&grown).all(|state| may[state]) {
                    gets.0 |= LevelSet::one(level).0;
                }
            }
            grown[place] = gets;
        }
        grown
    }

    /// The states in a box.
    fn members<'a>(&'a self, levels: &'a [LevelSet]) -> impl Iterator<Item = usize> + 'a {
        let mut states = vec![0];
        for ((_, count), levels) in self.program.states.digits().iter().zip(levels) {
            states = states
                .into_iter()
                .flat_map(|state| levels.iter().map(move |level| state * count + usize::from(level)))
                .collect();
        }
        states.into_iter()
    }
}
