//! Certificates: the meaning of a table and of a plan as SMT-LIB 2, for a solver to compare.
//!
//! Each file says that table and plan differ somewhere; a solver that answers `unsat` has found that they
//! agree in every state and for all numbers. This is a second opinion on the proof: it is written from
//! [`Program`](crate::program::Program) and [`Plan`] alone, by code that shares nothing with
//! [`prove`](crate::prove), neither its rules nor what those use. Of `f32` it knows nothing: numbers are
//! real ones. What is not linear is left to the solver or is an unknown function of its operands, and the
//! file says so.

mod plan;
mod program;
mod script;
mod terms;

use crate::plan::Plan;

/// The meaning of a table and of one of its plans, and the claim that they differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Certificate {
    /// SMT-LIB 2, which ends in `(check-sat)`; `unsat` is right.
    pub text: String,
    /// The operations that linear arithmetic does not reach, in words, sorted; none for most tables.
    pub beyond: Vec<String>,
}

impl Certificate {
    /// Writes down what a plan and its table mean. The plan need not be proved.
    ///
    /// ```
    /// use umbrage::certificate::Certificate;
    /// use umbrage::plan::{Plan, Shape};
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let certificate = Certificate::new(&Plan::new(&program, Shape::Switch)?);
    /// assert!(certificate.text.ends_with("(check-sat)\n"));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn new(plan: &Plan<'_>) -> Self {
        let program = plan.program;
        let mut script = script::Script::new(program);
        let table = program::meaning(program, &mut script);
        let code = plan::meaning(plan, &mut script);
        if plan.assumed {
            program::assume(program, &mut script);
        }
        let mut differences = Vec::new();
        if plan.reports_case() {
            differences.push(format!("(distinct {} {})", table.way, code.way));
        }
        differences.extend(table.values.iter().zip(&code.values).map(|(a, b)| format!("(distinct {a} {b})")));
        let fetches = table.fetches.iter().zip(&code.fetches);
        differences.extend(fetches.map(|((_, needs), (_, makes))| format!("(and {makes} (not {needs}))")));
        script.finish(plan, &differences)
    }
}

/// The names of the terms that a table, or a plan, comes down to.
#[derive(Clone)]
struct Meaning {
    /// The case and the line, by their number; see [`program::way`].
    way: String,
    /// The components of the result.
    values: Vec<String>,
    /// By fetched input, the condition under which it is fetched.
    fetches: Vec<(crate::program::InputId, String)>,
}
