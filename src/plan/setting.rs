//! The setting of a plan: the states that count, and the share of each.

use super::{PlanOptions, Weights};
use crate::diag::fnv1a;
use crate::program::Program;
use crate::program::claims::Claims;
use crate::program::reachable;
use crate::program::symbolic::{Machine, View};

/// The program, the plan asked for, and the states with their weights.
pub(super) struct Setting<'p, 'w> {
    pub(super) program: &'p Program,
    pub(super) options: PlanOptions<'w>,
    /// The states in which the plan must be right, ascending.
    pub(super) states: Vec<usize>,
    /// The share of each of them.
    pub(super) shares: Vec<f64>,
    /// A hash of everything that the plan is made from.
    pub(super) inputs: u64,
    claims: Option<Claims>,
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
            options: *options,
            states,
            shares,
            inputs: inputs(program, options),
            claims: Claims::new(program),
        })
    }

    /// Returns whether the path of a machine is one that counts.
    pub(super) fn assumptions_hold(&self, machine: &mut Machine<'_>) -> bool {
        let mut assumptions = self.program.assumptions.iter();
        !self.options.assume || assumptions.all(|assumption| machine.holds(assumption.condition, View::PLAIN))
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

/// A hash of everything that a plan is made from.
fn inputs(program: &Program, options: &PlanOptions<'_>) -> u64 {
    let texts = [&program.source].into_iter().chain(&program.imported).map(|source| source.fingerprint());
    let weights = options.weights.into_iter().flat_map(|w| (0..w.count()).map(|state| w.of(state).to_bits()));
    let origin = options.weights.map_or("", Weights::origin);
    let options = format!("{} {} {} {origin}", env!("CARGO_PKG_VERSION"), options.shape, options.assume);
    fnv1a(texts.chain(weights).flat_map(u64::to_le_bytes).chain(options.into_bytes()))
}
