//! The findings of a proof, and of one that fails.

use std::fmt;

use crate::diag::{Diagnostic, Failure, codes};
use crate::program::Program;

/// Most paths of one state that are gone through, and of all states together beyond the first of each.
pub(super) const MAX_PATHS_OF_STATE: usize = 1 << 16;
pub(super) const MAX_PATHS: usize = 1 << 18;

/// The findings of a proof.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// Discrete states gone through.
    pub states: usize,
    /// True if these are only the states in which the assumptions can hold.
    pub assumed: bool,
    /// Paths gone through: states, times the answers of fetches and comparisons.
    pub paths: usize,
    /// Paths on which the result is the same expression.
    pub identical: usize,
    /// Largest difference in `f32` on the other paths, where the assumptions that the plan makes use of hold as
    /// statements on real numbers; `None` if no bound is known.
    pub rounding: Option<f64>,
}

impl Proof {
    /// The findings before the first state.
    pub(super) fn none(assumed: bool) -> Self {
        Self { states: 0, assumed, paths: 0, identical: 0, rounding: Some(0.0) }
    }

    /// Notes values that are equal over the reals, with the bounds of their errors in `f32`.
    pub(super) fn apart(&mut self, a: Option<f64>, b: Option<f64>) {
        self.rounding = match (self.rounding, a, b) {
            (Some(worst), Some(a), Some(b)) => Some(worst.max(a + b)),
            _ => None,
        };
    }

    /// The findings of the proofs of two programs together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self {
            states: self.states + other.states,
            assumed: self.assumed || other.assumed,
            paths: self.paths + other.paths,
            identical: self.identical + other.identical,
            rounding: self.rounding.zip(other.rounding).map(|(a, b)| a.max(b)),
        }
    }
}

impl fmt::Display for Proof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = if self.assumed { "states in which the assumptions can hold" } else { "states" };
        write!(f, "equal to the table on {} {kind}, {} paths; ", self.states, self.paths)?;
        if self.identical == self.paths {
            return write!(f, "the same operations on each");
        }
        write!(f, "the same operations on {}, on the others equal over the reals", self.identical)?;
        match self.rounding {
            Some(bound) => write!(f, " and at most {} apart in f32", above(bound)),
            None => write!(f, " with no bound on the f32 difference"),
        }
    }
}

/// A number that is not below another, with two digits.
fn above(bound: f64) -> String {
    let shown = format!("{bound:.1e}");
    match shown.parse::<f64>() {
        Ok(value) if value < bound => {
            // Half a unit of the second digit and a little more is enough for the next number.
            let unit = 10_f64.powi(bound.abs().log10().floor() as i32 - 1);
            format!("{:.1e}", value + unit)
        }
        _ => shown,
    }
}

/// A reason why a plan is not proved.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// It is not equal to its program.
    Different(Box<Counterexample>),
    /// Table and plan may be equal, but that cannot be computed.
    Undecided(Box<Counterexample>),
    /// There are too many paths to go through.
    TooLong {
        /// The shape of the plan.
        shape: &'static str,
        /// A state with many paths, in table notation.
        state: Vec<String>,
    },
}

impl Refusal {
    /// The refusal as a diagnostic.
    pub fn into_failure(self, program: &Program) -> Failure {
        match self {
            Refusal::Different(counterexample) => counterexample.into_failure(program),
            Refusal::Undecided(open) => {
                let span = open.row.map_or(program.hit_policy_span, |row| program.rows[row].span);
                let message = format!("the plan `{}` cannot be compared with the table `{}`", open.shape, program.name);
                let diagnostic = Diagnostic::error(codes::NOT_APPLICABLE, message)
                    .at(span, open.reason)
                    .help("its numbers, or the sums that minima and maxima make, are too large to be compared exactly; use `switch` or `ladder`")
                    .help(format!("in the state {}", open.state.join(", ")));
                Failure::new(program.source.clone(), diagnostic)
            }
            Refusal::TooLong { shape, state } => {
                let message = format!("the plan `{shape}` of `{}` has too many paths to be proved", program.name);
                let diagnostic = Diagnostic::error(codes::PROOF_TOO_LONG, message)
                    .help(format!(
                        "a state may have {MAX_PATHS_OF_STATE} paths, and all states {MAX_PATHS} more than one each, fewer where they are long; each comparison of other numbers and each fetch multiplies them"
                    ))
                    .help(format!("the limit was met in the state {}", state.join(", ")))
                    .help("split cases with many comparisons or choices, or make a comparison an input of the table");
                Failure::new(program.source.clone(), diagnostic)
            }
        }
    }
}

/// A state and a path on which a plan and its program differ.
#[derive(Debug, Clone, PartialEq)]
pub struct Counterexample {
    /// The shape of the plan.
    pub shape: &'static str,
    /// The state, the levels of fetched inputs, and the outcome of comparisons, in table notation.
    pub state: Vec<String>,
    /// The difference.
    pub reason: String,
    /// The row that the program takes, if any.
    pub row: Option<usize>,
}

impl Counterexample {
    /// The counterexample as a diagnostic at the row concerned.
    pub fn into_failure(self, program: &Program) -> Failure {
        let span = self.row.map_or(program.hit_policy_span, |row| program.rows[row].span);
        let diagnostic =
            Diagnostic::error(codes::NOT_PROVED, format!("the plan `{}` is not equal to the table", self.shape))
                .at(span, self.reason)
                .help(format!("in the state {}", self.state.join(", ")))
                .help("the plan is left out; please report this: a plan must never differ");
        Failure::new(program.source.clone(), diagnostic)
    }
}

/// Returns whether a plan was not made, or not proved, because it does not suit its
/// table: another one may.
pub fn is_unsuitable(failure: &Failure) -> bool {
    let code = failure.diagnostics.first().map(|diagnostic| diagnostic.code);
    code == Some(codes::NOT_APPLICABLE) || code == Some(codes::PROOF_TOO_LONG)
}

/// Returns whether a failure is about one plan, so that others of the same table may be had: the plan is
/// unsuitable, or, which would be a bug of the planner, not equal to the table.
pub fn is_of_one_plan(failure: &Failure) -> bool {
    let refused = failure.diagnostics.first().is_some_and(|diagnostic| diagnostic.code == codes::NOT_PROVED);
    refused || is_unsuitable(failure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_is_never_shown_smaller() {
        for (bound, shown) in
            [(1.84e-7, "1.9e-7"), (1.8e-7, "1.8e-7"), (9.99e-8, "1.0e-7"), (1.0, "1.0e0"), (0.0, "0.0e0")]
        {
            assert_eq!(above(bound), shown);
        }
        let mut bound = 1e-38;
        while bound < 1e30 {
            let shown: f64 = above(bound).parse().expect("a number");
            assert!(shown >= bound && shown <= bound * 1.11, "{bound:e}: {shown:e}");
            bound *= 1.037;
        }
    }
}
