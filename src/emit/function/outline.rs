//! The choice of the steps that become functions of their own.
//!
//! Code that several ways lead to is printed once, where it is large. And no
//! chain of tests gets long: drivers turn `if (a) { return x; } if (b) ...` into
//! conditionals inside of each other and inline every function, and Mesa's
//! software rasteriser silently ignores the eighty-first level of nesting and
//! all below it. A long chain is therefore cut into parts, each a function that
//! says whether it found a result.

use std::collections::HashMap;

use crate::plan::{Plan, Step, StepId};
use crate::program::InputSet;

/// Most conditionals inside of each other, chains counted as nested.
pub(in crate::emit) const MAX_LEVELS: usize = 48;
/// Parts of a chain that is cut, and tests of the smallest part.
pub(in crate::emit) const FAN_OUT: usize = 8;
/// Steps from which on code that is shared becomes a function.
const SHARED_SIZE: usize = 24;

/// Facts about each step and all that follows it.
pub(in crate::emit) struct Outline {
    about: HashMap<StepId, About>,
}

#[derive(Debug, Clone, Copy, Default)]
struct About {
    /// Inputs that must be there: all but those fetched on the way.
    needs: InputSet,
    /// True if anything is fetched.
    fetches: bool,
    /// Steps when printed as a tree; saturates.
    size: usize,
    /// The number of steps that lead here.
    ways: usize,
}

impl Outline {
    pub(in crate::emit) fn new(plan: &Plan<'_>) -> Self {
        let mut about: HashMap<StepId, About> = HashMap::new();
        // A step comes after all that follows it.
        for at in plan.reachable() {
            let step = plan.step(at);
            let next = step.next();
            let mut this = About { size: 1, ..About::default() };
            for id in &next {
                let after = about.entry(*id).or_default();
                after.ways += 1;
                this.needs = this.needs.or(after.needs);
                this.fetches |= after.fetches;
                this.size = this.size.saturating_add(after.size);
            }
            match step {
                Step::Test { condition, .. } => this.needs = this.needs.or(plan.pool.cond_facts(*condition).inputs),
                Step::Fetch { input, .. } => {
                    this.needs = this.needs.minus(InputSet::one(*input));
                    this.fetches = true;
                }
                Step::Gather { input, condition, .. } => {
                    let after = this.needs.minus(InputSet::one(*input));
                    this.needs = after.or(plan.pool.cond_facts(*condition).inputs);
                    this.fetches = true;
                }
                Step::Coefficients { .. } => {
                    let inputs = plan.coefficients.inputs.iter();
                    this.needs = inputs.fold(this.needs, |needs, input| needs.or(InputSet::one(*input)));
                }
                Step::Switch { .. } | Step::Orbit { .. } => {}
                Step::Leaf(leaf) => {
                    for value in &leaf.values {
                        this.needs = this.needs.or(plan.pool.expr_facts(*value).inputs);
                    }
                }
            }
            about.insert(at, this);
        }
        Self { about }
    }

    fn about(&self, step: StepId) -> About {
        self.about.get(&step).copied().unwrap_or_default()
    }

    /// The inputs that a step and what follows it take as given.
    pub(in crate::emit) fn needs(&self, step: StepId) -> InputSet {
        self.about(step).needs
    }

    /// Returns whether a step or one that follows it fetches.
    pub(in crate::emit) fn fetches(&self, step: StepId) -> bool {
        self.about(step).fetches
    }

    /// Returns whether a step is printed as a function.
    pub(in crate::emit) fn is_function(&self, step: StepId) -> bool {
        let about = self.about(step);
        about.ways > 1 && about.size >= SHARED_SIZE
    }
}
