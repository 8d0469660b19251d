//! Code shapes: the same leaves, reached in different ways, each proved equal
//! to the program before anything is emitted.
//!
//! A [`Plan`] is a directed acyclic graph of [`Step`]s. Fetches are steps of
//! their own, so that "at most once, and only where needed" can be read off
//! the graph and is part of what [`prove`](crate::prove::exact::prove) proves.

mod builder;
mod key;
mod knowledge;
mod order;
mod setting;
pub(crate) mod shapes;
#[cfg(test)]
mod tests;
mod weights;

use std::fmt;

use crate::diag::{Diagnostic, Failure, codes, fnv1a};
use crate::program::{CondId, ExprId, InputId, Pool, Program};

pub(crate) use crate::program::turn::renamed;
pub use crate::prove::exact::{Counterexample, Proof, Refusal};
pub use key::KeyLayout;
pub use order::Certificate;
pub use shapes::coefficients::{Coefficients, Fit, Form, Piece};
pub use weights::Weights;

use setting::Setting;

/// The code shapes that can be asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Shape {
    /// The chain of guards, as written.
    Ladder,
    /// The chain of guards in the best order that keeps the meaning.
    Ordered,
    /// A few tests that decide many guards, then chains in the best order: the published advice.
    Nested,
    /// Every fetch at one place, then a few tests and chains as in `Nested`.
    Gathered,
    /// A graph of tests on inputs with the least expected number of them.
    Tree,
    /// The packed key selects the case through a lookup, then a `switch`.
    Switch(LookupPlace),
    /// The key selects coefficients of a minimum or maximum of sums: no branch.
    Coefficients,
    /// Symmetries turn the inputs into those of few cases, whose result is turned back.
    Orbit,
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
    pub const ALL: [Shape; 9] = [
        Shape::Ladder,
        Shape::Ordered,
        Shape::Nested,
        Shape::Gathered,
        Shape::Tree,
        Shape::Switch(LookupPlace::Constants),
        Shape::Switch(LookupPlace::Buffer),
        Shape::Coefficients,
        Shape::Orbit,
    ];

    /// The name on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Shape::Ladder => "ladder",
            Shape::Ordered => "ordered",
            Shape::Nested => "nested",
            Shape::Gathered => "gathered",
            Shape::Tree => "tree",
            Shape::Switch(LookupPlace::Constants) => "switch",
            Shape::Switch(LookupPlace::Buffer) => "switch_buffer",
            Shape::Coefficients => "coefficients",
            Shape::Orbit => "orbit",
        }
    }

    /// Whether its code reads a buffer of the host, which holds the lookup.
    pub fn reads_buffer(self) -> bool {
        matches!(self, Shape::Switch(LookupPlace::Buffer) | Shape::Coefficients | Shape::Orbit)
    }

    /// Whether the case it reports is the one that the table takes. A plan
    /// that turns inputs reports the case that it evaluated.
    pub fn reports_case(self) -> bool {
        self != Shape::Orbit
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
    /// Fetches an input if a condition holds, and goes on either way, with the first level or
    /// the least number in its place. Such steps come before all others.
    Gather {
        /// The input.
        input: InputId,
        /// When it is needed.
        condition: CondId,
        /// Where to go then.
        next: StepId,
    },
    /// Goes where the lookup says; only at the root or behind [`Step::Gather`].
    Switch {
        /// The ways.
        arms: Vec<StepId>,
    },
    /// The result that coefficients give, or one of the other ways, as the lookup
    /// says: the coefficients come first in its numbering; only at the root or behind [`Step::Gather`].
    Coefficients {
        /// The ways of states without coefficients.
        rest: Vec<StepId>,
    },
    /// Turns the inputs by symmetries, goes one of the ways, turns the result back.
    /// The lowest bits of the lookup say by which symmetries, the others which way;
    /// only at the root or behind [`Step::Gather`].
    Orbit {
        /// The ways.
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
    /// What it evaluates.
    pub program: &'p Program,
    /// Which shape it has.
    pub shape: Shape,
    /// Whether it may do anything where the assumptions do not hold.
    pub assumed: bool,
    /// Where the weights come from that it was made for.
    pub weighed: Option<String>,
    /// A hash of everything that it was made from: texts, weights and options.
    pub inputs: u64,
    /// How good it is of its kind, where that is known.
    pub certificate: Option<Certificate>,
    /// The program's terms and those that planning made of them.
    pub pool: Pool,
    /// How the discrete inputs are packed into a key.
    pub key: KeyLayout,
    /// What the lookup says of every state, by [`StateSpace`](crate::program::StateSpace) number; empty if there is none.
    pub lookup: Vec<u16>,
    /// For [`Step::Coefficients`].
    pub coefficients: Coefficients,
    /// For [`Step::Orbit`]: the symmetries that inputs are turned by, one after
    /// the other, as indices into [`Program::symmetries`].
    pub symmetries: Vec<usize>,
    /// Facts that are worth knowing, for headers and summaries.
    pub notes: Vec<String>,
    steps: Vec<Step>,
    root: StepId,
}

/// A hash of everything that a plan is made from.
fn inputs(program: &Program, options: &PlanOptions<'_>) -> u64 {
    let texts = [&program.source].into_iter().chain(&program.imported).map(|source| source.fingerprint());
    let weights = options.weights.into_iter().flat_map(|w| (0..w.count()).map(|state| w.of(state).to_bits()));
    let origin = options.weights.map_or("", Weights::origin);
    let options = format!("{} {} {} {origin}", env!("CARGO_PKG_VERSION"), options.shape, options.assume);
    fnv1a(texts.chain(weights).flat_map(u64::to_le_bytes).chain(options.into_bytes()))
}

impl<'p> Plan<'p> {
    /// Plans a program.
    ///
    /// # Errors
    /// When the shape does not suit the program; the message says why.
    pub fn new<'w>(program: &'p Program, options: impl Into<PlanOptions<'w>>) -> Result<Self, Failure> {
        let options = options.into();
        let shape = options.shape;
        let made = Setting::new(program, &options).and_then(|setting| {
            let plan = match shape {
                Shape::Ordered => shapes::chain::ordered(&setting),
                Shape::Nested => shapes::chain::nested(&setting),
                Shape::Gathered => shapes::gather::gathered(&setting),
                Shape::Tree => shapes::tree::tree(&setting),
                Shape::Ladder => builder::ladder(program),
                _ if program.function.is_some() && program.states.count() == 1 => {
                    Err("it has no discrete inputs to choose by; use `ladder`".to_owned())
                }
                Shape::Switch(_) => builder::switch(&setting, shape),
                Shape::Coefficients => shapes::coefficients::plan(&setting),
                Shape::Orbit => shapes::orbit::plan(&setting),
            };
            let weighed = setting.weights.map(|weights| weights.origin().to_owned());
            let inputs = inputs(program, &options);
            plan.map(|plan| Plan { assumed: options.assume, weighed, inputs, ..plan })
        });
        made.map_err(|reason| {
            let message = format!("the plan `{shape}` does not suit the table `{}`", program.name);
            Failure::new(program.source.clone(), Diagnostic::error(codes::NOT_APPLICABLE, message).help(reason))
        })
    }

    /// Plans a program and proves the plan: the only way to something that can be emitted.
    ///
    /// # Errors
    /// When the shape does not suit the program, or, which would be a bug of
    /// the planner, when the plan is not equal to it.
    ///
    /// ```
    /// use umbrage::plan::{LookupPlace, Plan, Shape};
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/rsmss.ron")?;
    /// let proved = Plan::proved(&program, Shape::Switch(LookupPlace::Constants))?;
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
        match crate::prove::exact::prove(&self) {
            Ok(proof) => Ok(Proved { plan: self, proof }),
            Err(refusal) => Err(refusal.into_failure(self.program)),
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
            _ => None,
        }
    }

    /// The steps that evaluation can come to, each after all that follow it.
    pub fn reachable(&self) -> Vec<StepId> {
        let mut order = Vec::new();
        let mut seen = vec![false; self.steps.len()];
        // Beside each step, whether what follows it was put on the stack already.
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

/// Whether a plan was not made, or not proved, because it does not suit its
/// table: another one may.
pub fn is_unsuitable(failure: &Failure) -> bool {
    let code = failure.diagnostics.first().map(|diagnostic| diagnostic.code);
    code == Some(codes::NOT_APPLICABLE) || code == Some(codes::PROOF_TOO_LONG)
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
