//! Code shapes: the same leaves, reached in different ways, each proved equal
//! to the program before anything is emitted.
//!
//! A [`Plan`] is a directed acyclic graph of [`Step`]s. Fetches are steps of
//! their own, so that "at most once, and only where needed" can be read off
//! the graph and is part of what [`prove`](crate::prove) proves.

// A new operation, step or target must be thought of wherever one is told from another.
#![deny(clippy::wildcard_enum_match_arm)]

mod arms;
mod builder;
mod coefficients;
mod graph;
mod key;
mod knowledge;
mod order;
mod search;
mod setting;
mod shapes;
#[cfg(test)]
mod tests;
#[cfg(any(test, feature = "trial"))]
pub mod walk;
mod weights;

use crate::diag::{Diagnostic, Failure, codes};
use crate::program::Program;

pub(crate) use crate::program::turn::renamed;
pub use coefficients::{Coefficients, Fit, Form, Piece};
pub use graph::{Leaf, Plan, Step, StepId};
pub use key::KeyLayout;
pub use order::Certificate;
pub use shapes::Shape;
pub use weights::Weights;

use setting::Setting;

/// A request for a plan.
#[derive(Debug, Clone, Copy)]
pub struct PlanOptions<'w> {
    /// The code shape.
    pub shape: Shape,
    /// The frequency of each state; without, every state counts alike.
    pub weights: Option<&'w Weights>,
    /// True if the plan may do anything where the table's assumptions do not hold.
    pub assume: bool,
}

impl From<Shape> for PlanOptions<'_> {
    /// The shape, right everywhere, best where every state occurs alike.
    fn from(shape: Shape) -> Self {
        Self { shape, weights: None, assume: false }
    }
}

impl<'p> Plan<'p> {
    /// Plans a program.
    ///
    /// # Errors
    /// When the shape does not suit the program; the message says why.
    pub fn new<'w>(program: &'p Program, options: impl Into<PlanOptions<'w>>) -> Result<Self, Failure> {
        let options = options.into();
        Setting::new(program, &options).and_then(|setting| options.shape.plan(&setting)).map_err(|reason| {
            let message = format!("the plan `{}` does not suit the table `{}`", options.shape, program.name);
            Failure::new(program.source.clone(), Diagnostic::error(codes::NOT_APPLICABLE, message).help(reason))
        })
    }
}
