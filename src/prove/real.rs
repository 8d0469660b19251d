//! The gate for plans that compute otherwise than the table: equality over the
//! reals, wherever the assumptions hold if the plan makes use of them.
//!
//! [`prove`](super::exact) compares operations and takes comparisons that look
//! different for independent. Here program and plan run on the same
//! [`Machine`], which knows the signs of differences and what can hold together,
//! so that `min(u, 1 + w - d)` is seen to be `u` where an assumption says so.
//! Cases must agree where the plan reports them; of fetches, the plan may make
//! none that the program does not, and none twice.

use std::collections::HashMap;
use std::ops::ControlFlow;

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
    let mut prover = Prover {
        plan,
        proof: Proof { states: states.len(), assumed: plan.assumed, paths: 0, identical: 0, rounding: Some(0.0) },
        errors: HashMap::new(),
        compares: compares(plan),
        candidates: Candidates::new(program),
    };
    for state in states {
        let turn = match plan.step(plan.behind_fetches()) {
            Step::Orbit { .. } => {
                let entry = usize::from(plan.lookup.get(*state).copied().unwrap_or_default());
                let word = entry & ((1 << plan.symmetries.len()) - 1);
                Turn::new(program, machine.pool(), &plan.symmetries, word, *state)
            }
            Step::Test { .. }
            | Step::Fetch { .. }
            | Step::Gather { .. }
            | Step::Switch { .. }
            | Step::Coefficients { .. }
            | Step::Leaf(_) => None,
        };
        let mut different = None;
        machine.any_path(*state, |machine| match prover.path(machine, *state, turn.as_ref()) {
            Ok(()) => ControlFlow::Continue(()),
            Err((row, reason)) => {
                different = Some((row, reason));
                ControlFlow::Break(())
            }
        });
        let described = |machine: &Machine<'_>| machine.describe().split(", ").map(str::to_owned).collect();
        if let Some((row, reason)) = different {
            let (shape, state) = (plan.shape.name(), described(&machine));
            return Err(Refusal::Different(Box::new(Counterexample { shape, state, reason, row })));
        }
        if machine.gave_up() {
            return Err(Refusal::TooLong { shape: plan.shape.name(), state: described(&machine) });
        }
    }
    Ok(prover.proof)
}

struct Prover<'a, 'p> {
    plan: &'a Plan<'p>,
    proof: Proof,
    /// Bounds of the rounding of expressions.
    errors: HashMap<ExprId, Option<f64>>,
    /// True if the plan compares numbers.
    compares: bool,
    candidates: Candidates,
}

/// Returns whether a plan compares numbers, or chooses between values, behind its lookup.
fn compares(plan: &Plan<'_>) -> bool {
    plan.reachable().into_iter().any(|step| match plan.step(step) {
        Step::Test { condition, .. } => plan.pool.compares(*condition),
        Step::Leaf(leaf) => leaf.values.iter().any(|value| plan.pool.expr_facts(*value).selects),
        Step::Gather { condition, .. } => plan.pool.compares(*condition),
        Step::Fetch { .. } | Step::Switch { .. } | Step::Coefficients { .. } | Step::Orbit { .. } => false,
    })
}

struct Run {
    row: Option<usize>,
    line: Option<usize>,
    values: Vec<ExprId>,
    fetched: InputSet,
}

/// The row that the program takes, and what is wrong.
type Difference = (Option<usize>, String);

impl Prover<'_, '_> {
    fn path(&mut self, machine: &mut Machine<'_>, state: usize, turn: Option<&Turn>) -> Result<(), Difference> {
        let program = self.plan.program;
        if self.plan.assumed {
            let conditions = program.assumptions.iter().map(|assumption| assumption.condition);
            if !conditions.into_iter().all(|condition| machine.holds(condition, View::PLAIN)) {
                return Ok(());
            }
        }
        machine.take_fetched();
        let (row, line, want) = machine.run_to_line(self.candidates.of(state));
        let needed = machine.take_fetched();
        let got = self.run(machine, state, turn);
        machine.set_absent(InputSet::default());
        let got = got.map_err(|reason| (row, reason))?;
        self.proof.paths += 1;
        if self.plan.reports_case() && (row, line) != (got.row, got.line) {
            let name =
                |row: Option<usize>| row.map_or("the default".to_owned(), |r| format!("case {}", program.rows[r].id));
            let reason = match row == got.row {
                true => format!("the plan takes another line of {}", name(row)),
                false => format!("the table takes {}, the plan {}", name(row), name(got.row)),
            };
            return Err((row, reason));
        }
        if let Some(input) = got.fetched.minus(needed).iter().next() {
            let input = &program.inputs[input.index()].name;
            return Err((row, format!("the plan fetches `{input}`, which the table does not need here")));
        }
        // The same values, but comparisons of turned inputs may go the other way.
        let turned = turn.is_some_and(|turn| !turn.is_identity());
        if turned && self.compares {
            self.proof.rounding = None;
        }
        if want == got.values {
            self.proof.identical += usize::from(!turned);
            return Ok(());
        }
        if !machine.equal(&want, &got.values) {
            let printer = Printer { pool: machine.pool(), inputs: &program.inputs };
            let list = |values: &[ExprId]| values.iter().map(|v| printer.expr(*v)).collect::<Vec<_>>().join(", ");
            return Err((row, format!("the table gives {}, the plan {}", list(&want), list(&got.values))));
        }
        for (a, b) in want.iter().zip(&got.values).filter(|(a, b)| a != b) {
            let mut bound = |expr: ExprId| {
                *self.errors.entry(expr).or_insert_with(|| rounding::error(program, machine.pool(), expr))
            };
            self.proof.rounding = match (self.proof.rounding, bound(*a), bound(*b)) {
                (Some(worst), Some(a), Some(b)) => Some(worst.max(a + b)),
                _ => None,
            };
        }
        Ok(())
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
                Step::Switch { arms } => at = *entry.and_then(|arm| arms.get(arm)).ok_or(no_way)?,
                Step::Orbit { arms } => {
                    view = turn.ok_or("a symmetry does not apply in this state")?.view();
                    let arm = entry.map(|entry| entry >> plan.symmetries.len());
                    at = *arm.and_then(|arm| arms.get(arm)).ok_or(no_way)?;
                }
                Step::Coefficients { rest } => {
                    let entry = entry.ok_or(no_way)?;
                    if let Some(fit) = plan.coefficients.fits.get(entry) {
                        let pieces = fit.pieces.iter();
                        let values = pieces.map(|piece| plan.coefficients.value(machine.pool(), piece)).collect();
                        return Ok(Run { row: fit.row, line: fit.line, values, fetched });
                    }
                    at = *rest.get(entry - plan.coefficients.fits.len()).ok_or(no_way)?;
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
                    return Ok(Run { row: leaf.row, line: leaf.line, values, fetched });
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
