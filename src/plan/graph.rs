//! The graph that a plan is: tests, fetches, lookups and leaves, and what they refer to.
//!
//! This is all that the prover and the printers know of planning.

use super::{Certificate, Coefficients, KeyLayout, Shape};
use crate::program::{CondId, ExprId, InputId, Pool, Program};

/// Number of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StepId(pub(super) u32);

/// A step of a decision.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Step {
    /// Takes one of two branches. The condition mentions no input that is not yet fetched.
    Test {
        /// The condition.
        condition: CondId,
        /// The next step if it holds.
        then: StepId,
        /// The next step if not.
        other: StepId,
    },
    /// Fetches an input.
    Fetch {
        /// The input.
        input: InputId,
        /// The next step.
        next: StepId,
    },
    /// Fetches an input if a condition holds, and goes on either way, with the first level or
    /// the least number in its place. Such steps come before all others.
    Gather {
        /// The input.
        input: InputId,
        /// When it is needed.
        condition: CondId,
        /// The next step.
        next: StepId,
    },
    /// Goes where the lookup says; only at the root or behind [`Step::Gather`].
    Switch {
        /// The arms.
        arms: Vec<StepId>,
    },
    /// The result that coefficients give, or one of the other arms, as the lookup
    /// says: the coefficients come first in its numbering; only at the root or behind [`Step::Gather`].
    Coefficients {
        /// The arms of states without coefficients.
        rest: Vec<StepId>,
    },
    /// Turns the inputs by symmetries, takes one of the arms, turns the result back.
    /// The lowest bits of the lookup say by which symmetries, the others which arm;
    /// only at the root or behind [`Step::Gather`].
    Orbit {
        /// The arms.
        arms: Vec<StepId>,
    },
    /// The result.
    Leaf(Leaf),
}

impl Step {
    /// The steps that may come next.
    pub fn next(&self) -> Vec<StepId> {
        match self {
            Step::Test { then, other, .. } => vec![*then, *other],
            Step::Fetch { next, .. } | Step::Gather { next, .. } => vec![*next],
            Step::Switch { arms } | Step::Coefficients { rest: arms } | Step::Orbit { arms } => arms.clone(),
            Step::Leaf(_) => Vec::new(),
        }
    }
}

/// A result.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Leaf {
    /// The row taken, as an index into [`Program::rows`]; `None` for the default.
    pub row: Option<usize>,
    /// The line of that row; `None` where the default gives the value.
    pub line: Option<usize>,
    /// One expression per component of the output.
    pub values: Vec<ExprId>,
}

/// A way to evaluate a program.
#[derive(Debug, Clone)]
pub struct Plan<'p> {
    /// The program that it evaluates.
    pub program: &'p Program,
    /// Its shape.
    pub shape: Shape,
    /// True if it may do anything where the assumptions do not hold.
    pub assumed: bool,
    /// The origin of the weights that it was made for.
    pub weights_origin: Option<String>,
    /// A hash of everything that it was made from: texts, weights and options.
    pub inputs: u64,
    /// Its cost and a bound on the best one of its kind, where that is known.
    pub certificate: Option<Certificate>,
    /// The program's terms and those that planning made of them.
    pub pool: Pool,
    /// The layout of the key that the discrete inputs are packed into.
    pub key: KeyLayout,
    /// The entry of the lookup for every state, by [`StateSpace`](crate::program::StateSpace) number; empty if there is none.
    pub lookup: Vec<u16>,
    /// For [`Step::Coefficients`].
    pub coefficients: Coefficients,
    /// For [`Step::Orbit`]: the symmetries that inputs are turned by, one after
    /// the other, as indices into [`Program::symmetries`].
    pub symmetries: Vec<usize>,
    /// Facts that are worth knowing, for headers and summaries.
    pub notes: Vec<String>,
    pub(super) steps: Vec<Step>,
    pub(super) root: StepId,
}

impl Plan<'_> {
    /// A step.
    pub fn step(&self, id: StepId) -> &Step {
        &self.steps[id.0 as usize]
    }

    /// The plan with another step in a place, right or wrong: for those who try what judges plans.
    #[cfg(any(test, feature = "trial"))]
    #[must_use]
    pub fn replaced(mut self, place: StepId, step: Step) -> Self {
        self.steps[place.0 as usize] = step;
        self
    }

    /// The step at which evaluation starts.
    pub fn root(&self) -> StepId {
        self.root
    }

    /// Returns whether its code reads a buffer of the host, which holds the lookup.
    pub fn reads_lookup(&self) -> bool {
        self.shape.reads_buffer()
    }

    /// Returns whether the case it reports is the one that the table takes. A plan
    /// that turns inputs reports the case that it evaluated.
    pub fn reports_case(&self) -> bool {
        !matches!(self.step(self.behind_fetches()), Step::Orbit { .. })
    }

    /// The first step behind those that gather.
    pub fn behind_fetches(&self) -> StepId {
        let mut at = self.root;
        while let Step::Gather { next, .. } = self.step(at) {
            at = *next;
        }
        at
    }

    /// The input that a step fetches.
    pub fn fetch_of(&self, step: StepId) -> Option<InputId> {
        match self.step(step) {
            Step::Fetch { input, .. } | Step::Gather { input, .. } => Some(*input),
            Step::Test { .. }
            | Step::Switch { .. }
            | Step::Coefficients { .. }
            | Step::Orbit { .. }
            | Step::Leaf(_) => None,
        }
    }

    /// The steps that evaluation can come to, each after all that follow it.
    pub fn reachable(&self) -> Vec<StepId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.steps.len()];
        // With each step, whether its successors were put on the stack already.
        let mut open = vec![(self.root, false)];
        while let Some((at, done)) = open.pop() {
            if done {
                order.push(at);
            } else if !std::mem::replace(&mut seen[at.0 as usize], true) {
                open.push((at, true));
                open.extend(self.step(at).next().into_iter().map(|next| (next, false)));
            }
        }
        order
    }
}
