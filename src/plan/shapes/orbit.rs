//! Few cases for many: symmetries turn a state into the representative of its
//! orbit, whose value is turned back.
//!
//! A symmetry is used in exactly those states in which the table has it, which
//! is proved state by state. Symmetries are applied one after the other, in the
//! order declared, each or not; for mirrors and a transposition these words are
//! the whole group. Representatives are then brought together further: if the
//! formula of one gives the value of another as well, one of them will do. That
//! is where assumptions tell most.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;

use super::{Definition, gather};
use crate::plan::builder::{Builder, Result};
use crate::plan::key::{KeyLayout, MAX_BUFFER_BITS};
use crate::plan::knowledge::Knowledge;
use crate::plan::setting::Setting;
use crate::plan::{Plan, Step, StepId};
use crate::program::symbolic::{Machine, View};
use crate::program::turn;
use crate::program::turn::Turn;
use crate::program::{ExprId, InputId, LevelSet, Symmetry};

/// Most symmetries whose words are gone through.
const MAX_SYMMETRIES: usize = 6;
/// Most states of a table for this plan.
const MAX_STATES: usize = 1 << 14;
/// Most representatives that are compared with each other.
const MAX_COMPARED: usize = 256;

/// A state turned into another one.
#[derive(Clone, Copy)]
struct Way {
    word: usize,
    target: usize,
}

pub(super) static SHAPE: Definition = Definition {
    name: "orbit",
    summary: "symmetries, from a buffer, turn the inputs into those of few cases, whose result is turned back",
    reads_buffer: true,
    needs_key: true,
    holds_data: false,
    plan,
};

/// Representatives of orbits.
fn plan<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    let symmetries: Vec<usize> =
        (0..program.symmetries.len()).filter(|index| turn::is_usable(program, &program.symmetries[*index])).collect();
    if symmetries.is_empty() {
        return Err(match program.symmetries.len() {
            0 => "it declares no symmetries".to_owned(),
            _ => "its symmetries map inputs in ways that this plan does not know".to_owned(),
        });
    }
    if symmetries.len() > MAX_SYMMETRIES {
        return Err(format!("it declares more than {MAX_SYMMETRIES} symmetries"));
    }
    if setting.states.len() > MAX_STATES {
        return Err(format!("it has {} states, this plan takes at most {MAX_STATES}", setting.states.len()));
    }
    let key = KeyLayout::new(program)?;
    key.fits(MAX_BUFFER_BITS, "use `ladder`")?;
    let images = images(setting, &symmetries);
    let mut machine = Machine::new(program);
    let way = |state: &usize| (*state, representative(&mut machine, setting, &symmetries, &images, *state));
    let ways: HashMap<usize, Way> = setting.states.iter().map(way).collect();
    if ways.values().all(|way| way.word == 0) {
        return Err("none of its symmetries turns a state into another one where the table has it".to_owned());
    }
    let mut builder = Builder::new(program);
    let needs = if program.fetched.is_empty() { Vec::new() } else { gather::needs(&mut builder, setting)? };
    let claims = setting.claims()?;
    let mut steps: HashMap<usize, StepId> = HashMap::new();
    let mut levels = vec![0; program.inputs.len()];
    let mut targets: Vec<usize> = ways.values().map(|way| way.target).collect();
    targets.sort_unstable();
    targets.dedup();
    for target in &targets {
        program.states.write(*target, &mut levels);
        let mut known = Knowledge::none(program).with_fetched(program.fetched);
        for (input, _) in program.states.digits() {
            known.restrict(*input, LevelSet::one(levels[input.index()]));
        }
        let rows = builder.rows_of_state(claims, *target, &levels);
        steps.insert(*target, builder.rows(&rows, &known)?);
    }
    let merged = merged(setting, &mut builder, &symmetries, &ways, &steps);
    let mut arms: Vec<StepId> = merged.values().copied().collect();
    arms.sort_unstable();
    arms.dedup();
    let mut lookup = vec![0_u16; program.states.count()];
    for (state, way) in &ways {
        let arm = arms.binary_search(&merged[&way.target]).unwrap_or_default();
        let entry = arm << symmetries.len() | way.word;
        lookup[*state] = u16::try_from(entry).map_err(|_| "it has too many ways to go".to_owned())?;
    }
    let unused = fill(setting, &mut lookup, &mut EntryCheck::new(setting, &builder, &symmetries, &arms));
    let count = arms.len();
    let root = builder.push(Step::Orbit { arms })?;
    let root = gather::in_front(&mut builder, &needs, root)?;
    let mut plan = builder.finish(setting, key, lookup, root);
    plan.symmetries = symmetries;
    let before: std::collections::BTreeSet<StepId> = steps.values().copied().collect();
    plan.notes.push(format!(
        "{} states, {} of them representatives with {} ways to go, brought down to {count}",
        setting.states.len(),
        targets.len(),
        before.len()
    ));
    if !unused.is_empty() {
        let names: Vec<&str> = unused.iter().map(|input| program.inputs[input.index()].name.as_str()).collect();
        plan.notes.push(format!("the value does not depend on {}: pass anything", names.join(", ")));
    }
    plan.notes
        .push("case_id is the case that was evaluated, which the value of the table's case follows from".to_owned());
    Ok(plan)
}

/// The image of each state under each symmetry, if the table has it there.
fn images(setting: &Setting<'_, '_>, symmetries: &[usize]) -> Vec<HashMap<usize, usize>> {
    let program = setting.program;
    let mut machine = Machine::new(program);
    let counts = |state: usize| setting.states.binary_search(&state).is_ok();
    let image_of = |machine: &mut Machine<'_>, symmetry, state| {
        let image = turn::image_of_state(program, symmetry, state)?;
        (image != state && counts(image) && has(machine, setting, symmetry, state)).then_some((state, image))
    };
    let all = symmetries.iter().map(|index| {
        let symmetry = &program.symmetries[*index];
        setting.states.iter().filter_map(|state| image_of(&mut machine, symmetry, *state)).collect()
    });
    all.collect()
}

/// Returns whether the table has a symmetry in a state: everywhere, or where the assumptions hold.
fn has(machine: &mut Machine<'_>, setting: &Setting<'_, '_>, symmetry: &Symmetry, state: usize) -> bool {
    is_said(machine, setting, state, |machine| turn::said(machine, symmetry).1)
}

/// Returns whether the result in a state is what `said` gives, wherever it counts, with no input fetched
/// for that beyond those that the table needs: others are of no use even if the value is right.
fn is_said(
    machine: &mut Machine<'_>,
    setting: &Setting<'_, '_>,
    state: usize,
    said: impl Fn(&mut Machine<'_>) -> Vec<ExprId>,
) -> bool {
    let broken = machine.any_path(state, |machine| {
        if !setting.assumptions_hold(machine) {
            return ControlFlow::Continue(());
        }
        machine.take_fetched();
        let (_, values) = machine.run(View::PLAIN);
        let needed = machine.take_fetched();
        let said = said(machine);
        let fetched = machine.take_fetched();
        match fetched.minus(needed).is_empty() && machine.equal(&values, &said) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }
    });
    !broken && !machine.gave_up()
}

/// The first state, in their order, that symmetries turn a state into.
fn representative(
    machine: &mut Machine<'_>,
    setting: &Setting<'_, '_>,
    symmetries: &[usize],
    images: &[HashMap<usize, usize>],
    state: usize,
) -> Way {
    let mut best = Way { word: 0, target: state };
    for word in 1_usize..1 << symmetries.len() {
        let mut at = Some(state);
        for (bit, image) in images.iter().enumerate() {
            if word >> bit & 1 == 1 {
                at = at.and_then(|state| image.get(&state).copied());
            }
        }
        let Some(target) = at.filter(|target| *target < best.target) else { continue };
        // An image of what the assumptions admit need not be admitted, so what holds of each symmetry
        // need not hold of one after the other.
        let holds = word.count_ones() == 1
            || !setting.options.assume
            || Turn::new(setting.program, machine.pool(), symmetries, word, state)
                .is_some_and(|turn| is_said(machine, setting, state, |machine| turn.said(machine)));
        if holds {
            best = Way { word, target };
        }
    }
    best
}

/// For each representative, the steps that it goes in the end: its own, or
/// those of another one that give its value as well.
fn merged(
    setting: &Setting<'_, '_>,
    builder: &mut Builder<'_>,
    symmetries: &[usize],
    ways: &HashMap<usize, Way>,
    steps: &HashMap<usize, StepId>,
) -> HashMap<usize, StepId> {
    let mut result = steps.clone();
    let mut leaves: Vec<StepId> =
        steps.values().copied().filter(|step| matches!(builder.step(*step), Step::Leaf(_))).collect();
    leaves.sort_unstable();
    leaves.dedup();
    if leaves.len() > MAX_COMPARED {
        return result;
    }
    // The states that go each way, with the symmetries that turn them.
    let mut users: HashMap<StepId, Vec<(usize, Turn)>> = HashMap::new();
    let mut states: Vec<(&usize, &Way)> = ways.iter().collect();
    states.sort_by_key(|(state, _)| **state);
    for (state, way) in states {
        let step = steps[&way.target];
        if let Some(turn) = Turn::new(setting.program, &mut builder.pool, symmetries, way.word, *state) {
            users.entry(step).or_default().push((*state, turn));
        }
    }
    let pool = builder.pool.clone();
    let mut machine = Machine::over(setting.program, &pool);
    // Whether the leaf `other` serves every state that goes to `step`.
    let mut serves = |step: StepId, other: StepId| {
        let Step::Leaf(leaf) = builder.step(other) else { return false };
        users.get(&step).is_some_and(|users| {
            users.iter().all(|(state, turn)| {
                let differs = machine.any_path(*state, |machine| {
                    if !setting.assumptions_hold(machine) {
                        return ControlFlow::Continue(());
                    }
                    let (_, want) = machine.run(View::PLAIN);
                    let got = turn.back(machine, &leaf.values);
                    if machine.equal(&want, &got) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
                });
                !differs && !machine.gave_up()
            })
        })
    };
    // Whoever serves most goes first, and takes all that it serves.
    let served: Vec<(StepId, Vec<StepId>)> = leaves
        .iter()
        .map(|leaf| (*leaf, leaves.iter().copied().filter(|step| step == leaf || serves(*step, *leaf)).collect()))
        .collect();
    let mut open: Vec<StepId> = leaves.clone();
    while !open.is_empty() {
        let count = |list: &[StepId]| list.iter().filter(|step| open.contains(step)).count();
        let best = served.iter().max_by_key(|(leaf, list)| (count(list), std::cmp::Reverse(*leaf)));
        let Some((leaf, list)) = best else { break };
        for step in list.iter().filter(|step| open.contains(step)) {
            result.values_mut().filter(|to| *to == step).for_each(|to| *to = *leaf);
        }
        let taken: Vec<StepId> = list.clone();
        open.retain(|step| !taken.contains(step));
    }
    result
}

/// Tells whether an entry of the lookup serves a state.
struct EntryCheck<'a, 's> {
    setting: &'a Setting<'s, 's>,
    builder: &'a Builder<'s>,
    symmetries: &'a [usize],
    arms: &'a [StepId],
    machine: Machine<'a>,
    known: HashMap<(usize, u16), bool>,
}

impl<'a, 's> EntryCheck<'a, 's> {
    fn new(
        setting: &'a Setting<'s, 's>,
        builder: &'a Builder<'s>,
        symmetries: &'a [usize],
        arms: &'a [StepId],
    ) -> Self {
        let machine = Machine::over(setting.program, &builder.pool);
        Self { setting, builder, symmetries, arms, machine, known: HashMap::new() }
    }

    /// Only what needs no test and no fetch is looked at.
    fn serves(&mut self, state: usize, entry: u16) -> bool {
        if let Some(known) = self.known.get(&(state, entry)) {
            return *known;
        }
        let (word, arm) =
            (usize::from(entry) & ((1 << self.symmetries.len()) - 1), usize::from(entry) >> self.symmetries.len());
        let turn = Turn::new(self.setting.program, self.machine.pool(), self.symmetries, word, state);
        let serves = match (self.arms.get(arm).map(|step| self.builder.step(*step)), turn) {
            (Some(Step::Leaf(leaf)), Some(turn)) => {
                let setting = self.setting;
                let differs = self.machine.any_path(state, |machine| {
                    if !setting.assumptions_hold(machine) {
                        return ControlFlow::Continue(());
                    }
                    let (_, want) = machine.run(View::PLAIN);
                    let got = turn.back(machine, &leaf.values);
                    if machine.equal(&want, &got) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
                });
                !differs && !self.machine.gave_up()
            }
            _ => false,
        };
        self.known.insert((state, entry), serves);
        serves
    }
}

/// Lets the lookup say the same for all levels of an input wherever one entry
/// serves all states that count, and returns the inputs that are then not
/// looked at.
fn fill(setting: &Setting<'_, '_>, lookup: &mut [u16], check: &mut EntryCheck<'_, '_>) -> Vec<InputId> {
    let program = setting.program;
    let mut unused: Vec<InputId> = Vec::new();
    let mut levels = vec![0; program.inputs.len()];
    for (input, _) in program.states.digits() {
        // States that differ in this input and in those that are not looked at anyway.
        let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for state in &setting.states {
            program.states.write(*state, &mut levels);
            let ignored = |i: InputId| i == *input || unused.contains(&i);
            let key = program.states.index(|i| if ignored(i) { 0 } else { levels[i.index()] });
            groups.entry(key).or_default().push(*state);
        }
        let mut chosen: BTreeMap<usize, u16> = BTreeMap::new();
        for (key, group) in &groups {
            let mut entries: Vec<u16> = group.iter().map(|state| lookup[*state]).collect();
            entries.sort_unstable();
            entries.dedup();
            let serves_all = |entry: &u16| {
                let mut others = group.iter().filter(|state| lookup[**state] != *entry);
                others.all(|state| check.serves(*state, *entry))
            };
            let Some(entry) = entries.into_iter().find(serves_all) else { break };
            chosen.insert(*key, entry);
        }
        if chosen.len() < groups.len() {
            continue;
        }
        unused.push(*input);
        for (state, entry) in lookup.iter_mut().enumerate() {
            program.states.write(state, &mut levels);
            let key = program.states.index(|i| if unused.contains(&i) { 0 } else { levels[i.index()] });
            if let Some(chosen) = chosen.get(&key) {
                *entry = *chosen;
            }
        }
    }
    unused
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::PlanOptions;
    use crate::plan::Shape;
    use crate::program::Program;

    fn notes(table: &str, assume: bool) -> Vec<String> {
        let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
        let options = PlanOptions { shape: Shape::Orbit, weights: None, assume };
        let proved = Plan::proved(&program, options).unwrap_or_else(|e| panic!("{e}"));
        proved.plan().notes.clone()
    }

    #[test]
    fn assumptions_make_the_dominance_inputs_superfluous() {
        let notes = notes("tables/rsmss.ron", true);
        assert!(notes.iter().any(|note| note.contains("does not depend on domH, domV")), "{notes:#?}");
    }

    #[test]
    fn symmetries_alone_bring_cases_together() {
        let notes = notes("tables/smsr.ron", false);
        assert!(notes[0].contains("576 states"), "{notes:#?}");
    }
}
