//! The gate: a plan is equal to its program, or is not emitted.
//!
//! Plans are compared with the program operation by operation, or, where they compute otherwise, over the
//! reals, with a bound on how far `f32` can be from that (`rounding`). The first gate (`exact`) knows what is
//! written and normal forms of that; the other one (`real`) is for plans that turn their inputs, and knows
//! what symmetries do and what can hold together.
//!
//! Of the planner this knows the graph alone (`plan::graph`, with its key layout and coefficients):
//! whatever a shape does, it is judged by the steps that come out. What planner and prover both use is
//! `program::{claims, comparisons, reachable, symbolic, turn}`, each tested against plain enumeration, and
//! `program::settle`.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

mod exact;
mod oracle;
mod real;
mod report;
mod rounding;
mod route;

use crate::diag::Failure;
use crate::plan::{Plan, PlanOptions, Step};
use crate::program::{Program, reachable};

pub use report::{Counterexample, Proof, Refusal, is_of_one_plan, is_unsuitable};

/// A plan that was proved equal to its program. There is no other way to make one than the proof.
#[derive(Debug, Clone)]
pub struct Proved<'p> {
    plan: Plan<'p>,
    proof: Proof,
}

impl<'p> Proved<'p> {
    /// The plan.
    pub fn plan(&self) -> &Plan<'p> {
        &self.plan
    }

    /// The findings of the proof.
    pub fn proof(&self) -> &Proof {
        &self.proof
    }
}

/// Proves a plan.
///
/// # Errors
/// With the first difference found.
pub fn prove(plan: &Plan<'_>) -> Result<Proof, Refusal> {
    let program = plan.program;
    let states = if plan.assumed { reachable(program) } else { (0..program.states.count()).collect() };
    match plan.step(plan.behind_fetches()) {
        Step::Orbit { .. } => real::prove(plan, &states),
        Step::Test { .. }
        | Step::Fetch { .. }
        | Step::Gather { .. }
        | Step::Switch { .. }
        | Step::Coefficients { .. }
        | Step::Leaf(_) => exact::prove(plan, &states),
    }
}

impl<'p> Plan<'p> {
    /// Plans a program and proves the plan: the only way to something that can be emitted.
    ///
    /// # Errors
    /// When the shape does not suit the program, or, which would be a bug of
    /// the planner, when the plan is not equal to it.
    ///
    /// ```
    /// use umbrage::plan::{Plan, Shape};
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/rsmss.ron")?;
    /// let proved = Plan::proved(&program, Shape::Switch)?;
    /// assert_eq!((proved.proof().states, proved.proof().paths), (1152, 2856));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn proved<'w>(program: &'p Program, options: impl Into<PlanOptions<'w>>) -> Result<Proved<'p>, Failure> {
        Self::new(program, options)?.prove()
    }

    /// Proves the plan.
    ///
    /// # Errors
    /// With a counterexample if the plan is not equal to its program, and when
    /// it has too many paths.
    pub fn prove(self) -> Result<Proved<'p>, Failure> {
        match prove(&self) {
            Ok(proof) => Ok(Proved { plan: self, proof }),
            Err(refusal) => Err(refusal.into_failure(self.program)),
        }
    }
}
