//! Code shapes: the same leaves, reached in different ways, each proved equal
//! to the program before anything is emitted.
//!
//! A [`Plan`] is a directed acyclic graph of [`Step`]s. Fetches are steps of
//! their own, so that "at most once, and only where needed" can be read off
//! the graph and is part of what [`prove`](prove::prove) proves.

mod build;
mod key;
mod knowledge;
pub mod prove;
mod rounding;
mod weights;

use std::fmt;

use crate::diag::{Diagnostic, Failure, codes};
use crate::program::{CondId, ExprId, InputId, Pool, Program};

pub use key::KeyLayout;
pub use prove::{Counterexample, Proof};
pub use weights::Weights;

/// The code shapes that can be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// An ordered chain of guards, as written.
    Ladder,
    /// The packed key selects the case through a lookup, then a `switch`.
    Switch(LookupPlace),
}

/// Where a `switch` finds the case of a key.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LookupPlace {
    /// In the code, as packed integer constants.
    Constants,
    /// In a buffer of the host, which supplies a function that reads a word of it.
    Buffer,
}

impl Shape {
    /// Every shape, in the order of reports.
    pub const ALL: [Shape; 3] =
        [Shape::Ladder, Shape::Switch(LookupPlace::Constants), Shape::Switch(LookupPlace::Buffer)];

    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Ladder => "ladder",
            Shape::Switch(LookupPlace::Constants) => "switch",
            Shape::Switch(LookupPlace::Buffer) => "switch_buffer",
        }
    }

    /// The shape with a name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|shape| shape.name() == name)
    }
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What plan to make.
#[derive(Debug, Clone, Copy)]
pub struct PlanOptions<'w> {
    /// The code shape.
    pub shape: Shape,
    /// How often each state occurs; without, every state counts alike.
    pub weights: Option<&'w Weights>,
    /// Whether the plan may do anything where the table's assumptions do not hold.
    pub assume: bool,
}

impl From<Shape> for PlanOptions<'_> {
    /// The shape, right everywhere, best where every state occurs alike.
    fn from(shape: Shape) -> Self {
        Self { shape, weights: None, assume: false }
    }
}

/// Number of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct StepId(u32);

/// A step of a decision.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Step {
    /// Goes one of two ways. The condition mentions no input that is not yet fetched.
    Test {
        /// The condition.
        condition: CondId,
        /// Where to go if it holds.
        then: StepId,
        /// Where to go if not.
        other: StepId,
    },
    /// Fetches an input.
    Fetch {
        /// The input.
        input: InputId,
        /// Where to go then.
        next: StepId,
    },
    /// Goes where the lookup says; only at the root.
    Switch {
        /// The ways.
        arms: Vec<StepId>,
    },
    /// The result.
    Leaf(Leaf),
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
    /// What it evaluates.
    pub program: &'p Program,
    /// Which shape it has.
    pub shape: Shape,
    /// The program's terms and those that planning made of them.
    pub pool: Pool,
    /// How the discrete inputs are packed into a key.
    pub key: KeyLayout,
    /// For [`Step::Switch`]: the arm of every state, by [`StateSpace`](crate::program::StateSpace) number.
    pub lookup: Vec<u16>,
    steps: Vec<Step>,
    root: StepId,
}

impl<'p> Plan<'p> {
    /// Plans a program.
    ///
    /// # Errors
    /// When the shape does not suit the program; the message says why.
    pub fn new<'w>(program: &'p Program, options: impl Into<PlanOptions<'w>>) -> Result<Self, Failure> {
        let options = options.into();
        let shape = options.shape;
        let built = match shape {
            Shape::Switch(_) if program.function.is_some() && program.states.count() == 1 => {
                Err("it has no discrete inputs to choose by; use `ladder`".to_owned())
            }
            Shape::Ladder => build::ladder(program),
            Shape::Switch(_) => build::switch(program, shape),
        };
        built.map_err(|reason| {
            let message = format!("the plan `{shape}` does not suit the table `{}`", program.name);
            Failure::new(program.source.clone(), Diagnostic::error(codes::NOT_APPLICABLE, message).help(reason))
        })
    }

    /// Plans a program and proves the plan: the only way to something that can be emitted.
    ///
    /// # Errors
    /// When the shape does not suit the program, or, which would be a bug of
    /// the planner, when the plan is not equal to it.
    pub fn proved<'w>(program: &'p Program, options: impl Into<PlanOptions<'w>>) -> Result<Proved<'p>, Failure> {
        Self::new(program, options)?.prove()
    }

    /// Proves the plan.
    ///
    /// # Errors
    /// With a counterexample if the plan is not equal to its program.
    pub fn prove(self) -> Result<Proved<'p>, Failure> {
        match prove::prove(&self) {
            Ok(proof) => Ok(Proved { plan: self, proof }),
            Err(counterexample) => Err(counterexample.into_failure(self.program)),
        }
    }

    /// A step.
    pub fn step(&self, id: StepId) -> &Step {
        &self.steps[id.0 as usize]
    }

    /// Where evaluation starts.
    pub fn root(&self) -> StepId {
        self.root
    }
}

/// A plan that was proved equal to its program.
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

    /// What the proof found.
    pub fn proof(&self) -> &Proof {
        &self.proof
    }
}
