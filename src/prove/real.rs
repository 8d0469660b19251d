//! The gate for plans that turn their inputs: equality over the reals, wherever the assumptions hold if
//! the plan makes use of them.
//!
//! Where inputs stay as they are and no other case stands in, [`exact`](super::exact) may prove a state
//! operation by operation; that is tried first. Elsewhere program and plan run on the same [`Machine`],
//! which knows the signs of differences and what can hold together, so that `min(u, 1 + w - d)` is seen to
//! be `u` where an assumption says so. It takes comparisons for those of real numbers. A bound on `f32` is
//! therefore stated only if all that were made compare numbers that `f32` has exactly. Cases need not agree;
//! of fetches, the plan may make none that the program does not, and none twice.

use std::collections::HashMap;
use std::ops::ControlFlow;

use super::exact;
use super::report::{Counterexample, Proof, Refusal};
use super::rounding;
use crate::plan::{Plan, Step, StepId};
use crate::program::claims::Candidates;
use crate::program::print::Printer;
use crate::program::symbolic::{Machine, View};
use crate::program::turn::Turn;
use crate::program::{ExprId, InputSet};

/// Proves a plan in some states.
pub(super) fn prove(plan: &Plan<'_>, states: &[usize]) -> Result<Proof, Refusal> {
    let program = plan.program;
    let mut machine = Machine::over(program, &plan.pool);
    let word = |state: usize| {
        let entry = usize::from(plan.lookup.get(state).copied().unwrap_or_default());
        entry & ((1 << plan.symmetries.len()) - 1)
    };
    let plain: Vec<usize> = states.iter().copied().filter(|state| word(*state) == 0).collect();
    let mut branching = exact::Prover::new(plan, &plain);
    let mut prover =
        Prover { plan, proof: Proof::none(plan.assumed), errors: HashMap::new(), candidates: Candidates::new(program) };
    for state in states {
        let word = word(*state);
        if word == 0 && branching.state(*state).is_ok() {
            continue;
        }
        let turn = Turn::new(program, machine.pool(), &plan.symmetries, word, *state);
        let mut different = None;
        machine.any_path(*state, |machine| match prover.path(machine, *state, turn.as_ref()) {
            Ok(()) => ControlFlow::Continue(()),
            Err(found) => {
                different = Some(found);
                ControlFlow::Break(())
            }
        });
        let described = |machine: &Machine<'_>| machine.describe().split(", ").map(str::to_owned).collect();
        if let Some(Difference { row, reason, certain }) = different {
            let (shape, state) = (plan.shape.name(), described(&machine));
            let found = Box::new(Counterexample { shape, state, reason, row });
            return Err(if certain { Refusal::Different(found) } else { Refusal::Undecided(found) });
        }
        if machine.gave_up() {
            return Err(Refusal::TooLong { shape: plan.shape.name(), state: described(&machine) });
        }
        prover.proof.states += 1;
    }
    Ok(branching.proof().and(prover.proof))
}

struct Prover<'a, 'p> {
    plan: &'a Plan<'p>,
    proof: Proof,
    /// Bounds of the rounding of expressions.
    errors: HashMap<ExprId, Option<f64>>,
    candidates: Candidates,
}

struct Run {
    values: Vec<ExprId>,
    fetched: InputSet,
}

/// A path on which the plan is not equal to the program.
struct Difference {
    /// The row that the program takes.
    row: Option<usize>,
    reason: String,
    /// False if they may be equal all the same.
    certain: bool,
}

impl Prover<'_, '_> {
    fn path(&mut self, machine: &mut Machine<'_>, state: usize, turn: Option<&Turn>) -> Result<(), Difference> {
        let program = self.plan.program;
        if self.plan.assumed {
            let conditions = program.assumptions.iter().map(|assumption| assumption.condition);
            if !conditions.into_iter().all(|condition| machine.holds(condition, View::PLAIN)) {
                return Ok(());
            }
            // An assumption is about the numbers that come in, not about what code makes of them.
            machine.take_compared();
        }
        machine.take_fetched();
        let (row, _, want) = machine.run_to_line(self.candidates.of(state));
        let wrong = |reason: String| Difference { row, reason, certain: true };
        let needed = machine.take_fetched();
        let got = self.run(machine, state, turn);
        machine.set_absent(InputSet::default());
        let got = got.map_err(wrong)?;
        self.proof.paths += 1;
        if let Some(input) = got.fetched.minus(needed).iter().next() {
            let input = &program.inputs[input.index()].name;
            return Err(wrong(format!("the plan fetches `{input}`, which the table does not need here")));
        }
        // What compares rounded numbers may come out otherwise than it does here.
        let compared = machine.take_compared();
        let as_taken = compared.iter().all(|(a, b)| self.is_exact(machine, *a) && self.is_exact(machine, *b));
        if !as_taken {
            self.proof.rounding = None;
        }
        if want == got.values {
            let turned = turn.is_some_and(|turn| !turn.is_identity());
            self.proof.identical += usize::from(as_taken && !turned);
            return Ok(());
        }
        if !machine.equal(&want, &got.values) {
            let certain = machine.has_forms(&want) && machine.has_forms(&got.values);
            let printer = Printer { pool: machine.pool(), inputs: &program.inputs };
            let list = |values: &[ExprId]| values.iter().map(|v| printer.expr(*v)).collect::<Vec<_>>().join(", ");
            let reason = format!("the table gives {}, the plan {}", list(&want), list(&got.values));
            return Err(Difference { row, reason, certain });
        }
        for (a, b) in want.iter().zip(&got.values).filter(|(a, b)| a != b) {
            let (a, b) = (self.error(machine, *a), self.error(machine, *b));
            self.proof.apart(a, b);
        }
        Ok(())
    }

    fn error(&mut self, machine: &mut Machine<'_>, expr: ExprId) -> Option<f64> {
        let program = self.plan.program;
        *self.errors.entry(expr).or_insert_with(|| rounding::error(program, machine.pool(), expr))
    }

    fn is_exact(&mut self, machine: &mut Machine<'_>, expr: ExprId) -> bool {
        self.error(machine, expr) == Some(0.0)
    }

    /// The plan, step by step, with the discipline of fetching checked.
    fn run(&self, machine: &mut Machine<'_>, state: usize, turn: Option<&Turn>) -> Result<Run, String> {
        let plan = self.plan;
        // Inputs are turned by the step that says so, not before.
        let mut view = View::PLAIN;
        let entry = plan.lookup.get(state).map(|entry| usize::from(*entry));
        let no_way = "the plan's lookup has no way for this state";
        // What is fetched on this path, and what the code may mention: that, and what is gathered on others.
        let (mut fetched, mut declared) = (InputSet::default(), InputSet::default());
        let mut at: StepId = plan.root();
        loop {
            match plan.step(at) {
                // Another gate is for these.
                Step::Switch { .. } | Step::Coefficients { .. } => {
                    return Err("the plan looks up what it does not turn".to_owned());
                }
                Step::Orbit { arms } => {
                    view = turn.ok_or("a symmetry does not apply in this state")?.view();
                    let arm = entry.map(|entry| entry >> plan.symmetries.len());
                    at = *arm.and_then(|arm| arms.get(arm)).ok_or(no_way)?;
                }
                Step::Test { condition, then, other } => {
                    self.only_fetched(self.behind(turn, view, plan.pool.cond_facts(*condition).inputs), declared)?;
                    at = if machine.holds(*condition, view) { *then } else { *other };
                }
                Step::Fetch { input, next } => {
                    if declared.contains(*input) || view.symmetry.is_some() || !plan.program.fetched.contains(*input) {
                        return Err(format!("the plan fetches `{}` again", plan.program.inputs[input.index()].name));
                    }
                    fetched = fetched.or(InputSet::one(*input));
                    declared = declared.or(InputSet::one(*input));
                    at = *next;
                }
                Step::Gather { input, condition, next } => {
                    if declared.contains(*input) || view.symmetry.is_some() || !plan.program.fetched.contains(*input) {
                        return Err(format!("the plan fetches `{}` again", plan.program.inputs[input.index()].name));
                    }
                    self.only_fetched(plan.pool.cond_facts(*condition).inputs, declared)?;
                    if machine.holds(*condition, view) {
                        fetched = fetched.or(InputSet::one(*input));
                    }
                    declared = declared.or(InputSet::one(*input));
                    machine.set_absent(declared.minus(fetched));
                    at = *next;
                }
                Step::Leaf(leaf) => {
                    for value in &leaf.values {
                        let inputs = self.behind(turn, view, plan.pool.expr_facts(*value).inputs);
                        self.only_fetched(inputs, declared)?;
                    }
                    let values = match turn {
                        Some(turn) => turn.back(machine, &leaf.values),
                        None => leaf.values.iter().map(|value| machine.resolve(*value, view)).collect(),
                    };
                    return Ok(Run { values, fetched });
                }
            }
        }
    }

    /// The inputs that stand behind these.
    fn behind(&self, turn: Option<&Turn>, view: View<'_>, inputs: InputSet) -> InputSet {
        let Some(turn) = turn.filter(|_| view.symmetry.is_some()) else { return inputs };
        let fetched = inputs.and(self.plan.program.fetched);
        fetched.iter().fold(InputSet::default(), |all, input| all.or(turn.sources(&self.plan.pool, input)))
    }

    fn only_fetched(&self, inputs: InputSet, fetched: InputSet) -> Result<(), String> {
        let program = self.plan.program;
        match inputs.and(program.fetched).minus(fetched).iter().next() {
            None => Ok(()),
            Some(input) => Err(format!("the plan uses `{}` without fetching it", program.inputs[input.index()].name)),
        }
    }
}
