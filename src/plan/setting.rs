//! What a plan is made for: the states that count, and how much each does.

use super::{PlanOptions, Weights};
use crate::program::Program;
use crate::program::claims::Claims;
use crate::program::reachable;
use crate::program::symbolic::{Machine, View};

/// The program, its states, and their weights.
pub(super) struct Setting<'p, 'w> {
    pub(super) program: &'p Program,
    pub(super) weights: Option<&'w Weights>,
    /// The states in which the plan must be right, ascending.
    pub(super) states: Vec<usize>,
    /// The share of each of them.
    pub(super) shares: Vec<f64>,
    claims: Option<Claims>,
    assume: bool,
}

impl<'p, 'w> Setting<'p, 'w> {
    /// # Errors
    /// With the reason, when the weights are of another program or all excluded.
    pub(super) fn new(program: &'p Program, options: &PlanOptions<'w>) -> Result<Self, String> {
        let states = match options.assume {
            true if program.assumptions.is_empty() => return Err("the table makes no assumptions".to_owned()),
            true => reachable(program),
            false => (0..program.states.count()).collect(),
        };
        let weight = |state: &usize| options.weights.map_or(1.0, |weights| weights.of(*state));
        if let Some(weights) = options.weights
            && weights.count() != program.states.count()
        {
            return Err(format!(
                "the weights are of {} states, the table has {}",
                weights.count(),
                program.states.count()
            ));
        }
        let sum: f64 = states.iter().map(weight).sum();
        if sum <= 0.0 {
            return Err("no state that the assumptions allow has a weight".to_owned());
        }
        let shares = states.iter().map(|state| weight(state) / sum).collect();
        Ok(Self {
            program,
            weights: options.weights,
            states,
            shares,
            claims: Claims::new(program),
            assume: options.assume,
        })
    }

    /// Whether the path of a machine is one that counts.
    pub(super) fn assumptions_hold(&self, machine: &mut Machine<'_>) -> bool {
        let mut assumptions = self.program.assumptions.iter();
        !self.assume || assumptions.all(|assumption| machine.holds(assumption.condition, View::PLAIN))
    }

    /// The claims on every state.
    ///
    /// # Errors
    /// With the reason, when there are too many.
    pub(super) fn claims(&self) -> Result<&Claims, String> {
        self.claims.as_ref().ok_or_else(|| {
            "too many cases ask for no level of an input, so that each may be taken in every state; use `ladder`"
                .to_owned()
        })
    }
}
