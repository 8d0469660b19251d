//! The frequencies of the discrete states, for which a plan is the best one.

use crate::program::Program;

/// A weight for every state, by [`StateSpace`](crate::program::StateSpace)
/// number. Only ratios matter. Where they come from is not known here.
#[derive(Debug, Clone, PartialEq)]
pub struct Weights {
    of_state: Vec<f64>,
    origin: String,
}

impl Weights {
    /// Weights of the states of `program`, and where they come from, for the
    /// headers of generated files.
    ///
    /// # Errors
    /// With the reason, when they do not fit the program or say nothing.
    pub fn new(program: &Program, of_state: Vec<f64>, origin: impl Into<String>) -> Result<Self, String> {
        let states = program.states.count();
        if of_state.len() != states {
            return Err(format!("there are {} weights, but `{}` has {states} states", of_state.len(), program.name));
        }
        if let Some(state) = of_state.iter().position(|weight| !weight.is_finite() || *weight < 0.0) {
            return Err(format!("the weight of state {state} is {}, not a number from 0 on", of_state[state]));
        }
        if of_state.iter().sum::<f64>() <= 0.0 {
            return Err("all weights are zero".to_owned());
        }
        Ok(Self { of_state, origin: origin.into() })
    }

    /// The same weight for every state.
    pub fn uniform(program: &Program) -> Self {
        Self { of_state: vec![1.0; program.states.count()], origin: "every state alike".to_owned() }
    }

    /// The weight of a state.
    pub fn of(&self, state: usize) -> f64 {
        self.of_state[state]
    }

    /// The number of states.
    pub fn count(&self) -> usize {
        self.of_state.len()
    }

    /// Their origin.
    pub fn origin(&self) -> &str {
        &self.origin
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_must_fit_and_say_something() {
        let program = Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"));
        let states = program.states.count();
        let new = |weights: Vec<f64>| Weights::new(&program, weights, "a test");
        assert_eq!(new(vec![1.0]), Err("there are 1 weights, but `smsr` has 576 states".to_owned()));
        assert_eq!(new(vec![0.0; states]), Err("all weights are zero".to_owned()));
        let mut odd = vec![1.0; states];
        odd[3] = -1.0;
        assert_eq!(new(odd), Err("the weight of state 3 is -1, not a number from 0 on".to_owned()));
        assert_eq!(new(vec![2.0; states]).map(|weights| weights.of(5)), Ok(2.0));
    }
}
