//! The results that a WGSL implementation may give at a point.
//!
//! [`IntervalInterpreter`] evaluates a program in [`Interval`]s. Where a
//! comparison can go either way it follows both, and the union of the outcomes
//! is admissible: near the boundary of a guard that means several cases.
//!
//! Neighbours of a boundary are judged as follows: WGSL fixes no rounding mode, so an
//! operand whose exact value lies between two `f32` may be either; one whose
//! exact value is an `f32` is that value. With `py = 0.25` the guard
//! `1 - py < dH` is therefore decided for every `dH`, with `py = 0.1` it is
//! open for the two `f32` around `0.9`.
//!
//! Choices, and what is not covered:
//! - A comparison that occurs several times has one outcome within an
//!   evaluation, as if its operands had been computed once. The same holds
//!   for a jump (`step`, `floor`, …) between two values, which is followed
//!   like a comparison, so that no value between them is admitted.
//! - Fusing and anything else that merely leaves out a rounding is covered, as
//!   the intervals contain the exact result.
//! - WGSL also lets an implementation *reassociate* whole expressions, `(a + b) - a`
//!   for one. What only comes about that way is admitted if it is asked for
//!   ([`IntervalInterpreter::reordering`]): certificates of accuracy are about
//!   operations as written, and who judges a device wants to tell both apart.
//! - A fetched input may be absent. If the exact evaluation needs it, that is
//!   an error. If only other evaluations near a boundary would have needed it,
//!   they are left out: the host has followed the exact one and cannot supply
//!   what it never produced.

use std::cell::{Cell, RefCell};

use super::freely::Free;
use super::interval::Interval;
use super::walk::{Taken, Walk};
use super::{Interpreter, NeedsFetch};
use crate::program::operators::Image;
use crate::program::{
    BinaryOp, Comparison, CondId, Domain, ExprId, InputId, InputSet, LevelSet, Node, Program, Scalar, TernaryOp,
    UnaryOp, Value,
};

/// Most evaluations that are followed at one point.
const MAX_FORKS: usize = 512;

/// A result that is admissible.
#[derive(Debug, Clone, PartialEq)]
pub struct Possible {
    /// The row taken, as an index into [`Program::rows`]; `None` for the default.
    pub row: Option<usize>,
    /// The values that each component may have.
    pub values: Vec<Interval>,
    /// The inputs that may have been fetched for them.
    pub fetched: InputSet,
}

/// All results that are admissible at a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Admissible {
    /// The results; each differs from the others in its row, or in values that they do not cover.
    pub outcomes: Vec<Possible>,
    /// There were too many evaluations to follow, and everything is admitted.
    pub everything: bool,
    /// The types of the components, which say what their values are carried as.
    scalars: Vec<Scalar>,
}

impl Admissible {
    /// Returns whether a result is admissible.
    pub fn contains(&self, row: Option<usize>, values: &[f32]) -> bool {
        let fits = |possible: &Possible| possible.values.len() == values.len() && self.admits(possible, values);
        self.everything || self.outcomes.iter().any(|possible| possible.row == row && fits(possible))
    }

    /// Returns whether a result is admissible that fetched these inputs.
    pub fn contains_fetching(&self, row: Option<usize>, values: &[f32], fetched: InputSet) -> bool {
        let fits = |possible: &Possible| fetched.minus(possible.fetched).is_empty() && self.admits(possible, values);
        self.everything || self.outcomes.iter().any(|possible| possible.row == row && fits(possible))
    }

    fn admits(&self, possible: &Possible, values: &[f32]) -> bool {
        possible.values.iter().zip(values).zip(&self.scalars).all(|((interval, value), scalar)| match scalar {
            Scalar::Word => interval.is_any() || (interval.lo()..=interval.hi()).contains(&scalar.read(*value)),
            Scalar::Float | Scalar::Uint | Scalar::Int | Scalar::Bool => interval.contains(*value),
        })
    }

    /// Returns whether values are admissible with whichever row.
    pub fn contains_values(&self, values: &[f32]) -> bool {
        self.everything || self.outcomes.iter().any(|possible| self.contains(possible.row, values))
    }

    fn add(&mut self, new: Possible) {
        let covers = |a: &Possible, b: &Possible| {
            a.row == b.row && a.fetched == b.fetched && a.values.iter().zip(&b.values).all(|(a, b)| a.covers(*b))
        };
        if self.outcomes.iter().any(|old| covers(old, &new)) {
            return;
        }
        self.outcomes.retain(|old| !covers(&new, old));
        self.outcomes.push(new);
    }
}

/// A decision of an evaluation that could go either way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Choice {
    Comparison(CondId),
    Jump(ExprId),
}

/// Why an evaluation could not go on.
pub(super) enum Stop {
    Open(Choice),
    Missing,
}

/// Evaluates a program in intervals, at single points.
#[derive(Debug)]
pub struct IntervalInterpreter<'p> {
    program: &'p Program,
    exact: Interpreter<'p, f32>,
    point: Vec<Option<Value>>,
    choices: Vec<(Choice, bool)>,
    /// The inputs that the evaluation under way has fetched.
    fetched: Cell<InputSet>,
    /// The error that every continuous input may have.
    slack: f64,
    /// True if sums and products may be computed in any order.
    reordering: bool,
    /// The results of operations in this evaluation, so that what is shared is computed once.
    known: RefCell<Vec<Option<Known>>>,
}

/// The result of an operation.
#[derive(Debug, Clone, Copy)]
struct Known {
    value: Interval,
    /// The same as a sum of products.
    free: Free,
}

impl From<Interval> for Known {
    fn from(value: Interval) -> Self {
        Self { value, free: Free::leaf(value) }
    }
}

impl<'p> IntervalInterpreter<'p> {
    /// An interpreter of `program`.
    pub fn new(program: &'p Program) -> Self {
        let known = RefCell::new(vec![None; program.pool.len()]);
        Self {
            known,
            program,
            exact: Interpreter::new(program),
            point: Vec::new(),
            choices: Vec::new(),
            fetched: Cell::default(),
            slack: 0.0,
            reordering: false,
        }
    }

    /// From now on also admits what sums and products are if they are computed in another order, or no longer does.
    pub fn reordering(&mut self, admitted: bool) {
        self.reordering = admitted;
    }

    /// All results admissible at some point near a point: for code that
    /// computes the same over the reals, but not by the same operations.
    ///
    /// # Errors
    /// With the first input that the exact evaluation needs but that is absent.
    pub fn admissible_near(&mut self, point: &[Option<Value>], slack: f64) -> Result<Admissible, NeedsFetch> {
        self.slack = slack;
        let found = self.admissible(point);
        self.slack = 0.0;
        found
    }

    /// All results admissible at a point. Numbers are rounded to `f32` first.
    ///
    /// # Errors
    /// With the first input that the exact evaluation needs but that is absent.
    pub fn admissible(&mut self, point: &[Option<Value>]) -> Result<Admissible, NeedsFetch> {
        self.exact.place(point)?;
        self.point.clear();
        self.point.extend_from_slice(point);
        self.point.resize(self.program.inputs.len(), None);
        self.choices.clear();
        let components = self.program.output.components().into_iter();
        let scalars = components.map(|component| component.scalar).collect();
        let mut all = Admissible { outcomes: Vec::new(), everything: false, scalars };
        let (mut forks, mut checked) = (0, false);
        self.known.get_mut().fill(None);
        self.fetched.set(InputSet::default());
        loop {
            match self.evaluate() {
                Ok(possible) => all.add(possible),
                Err(Stop::Open(choice)) => {
                    self.choices.push((choice, true));
                    continue;
                }
                Err(Stop::Missing) if checked => {}
                Err(Stop::Missing) => {
                    self.exact.evaluate(point)?;
                    checked = true;
                }
            }
            forks += 1;
            // On to the next evaluation: the last choice that was taken one way is taken the other way.
            while self.choices.pop_if(|(_, taken)| !*taken).is_some() {}
            match self.choices.last_mut() {
                None => return Ok(all),
                Some(_) if forks >= MAX_FORKS => {
                    // Give the exact evaluation a chance to fail before everything is admitted.
                    self.exact.evaluate(point)?;
                    all.everything = true;
                    return Ok(all);
                }
                Some((_, taken)) => *taken = false,
            }
            self.known.get_mut().fill(None);
            self.fetched.set(InputSet::default());
        }
    }

    /// Evaluates the program under the choices made so far.
    fn evaluate(&self) -> Result<Possible, Stop> {
        let Taken { row, values, .. } = (&mut &*self).taken()?;
        let values =
            values.iter().map(|value| self.number(*value).map(|known| known.value)).collect::<Result<_, _>>()?;
        Ok(Possible { row, values, fetched: self.fetched.get() })
    }

    fn look_at(&self, input: InputId) {
        if self.program.fetched.contains(input) {
            self.fetched.set(self.fetched.get().or(InputSet::one(input)));
        }
    }

    fn choice(&self, choice: Choice) -> Result<bool, Stop> {
        let made = self.choices.iter().find(|(made, _)| *made == choice);
        made.map(|(_, taken)| *taken).ok_or(Stop::Open(choice))
    }

    fn number(&self, expr: ExprId) -> Result<Known, Stop> {
        if let Some(known) = self.known.borrow()[expr.index()] {
            return Ok(known);
        }
        let value = self.operation(expr)?;
        self.known.borrow_mut()[expr.index()] = Some(value);
        Ok(value)
    }

    fn operation(&self, expr: ExprId) -> Result<Known, Stop> {
        Ok(match self.program.pool.node(expr) {
            Node::Const(number) => Interval::constant(number.get()).into(),
            Node::Word(word) => Interval::word(f64::from(word)).into(),
            Node::Input(input) => match self.point[input.index()] {
                Some(Value::Number(number)) => {
                    self.look_at(input);
                    match self.program.inputs[input.index()].domain {
                        Domain::Word => Interval::word(number).into(),
                        Domain::Continuous { .. } | Domain::Discrete(_) => {
                            Interval::near(number as f32, self.slack).into()
                        }
                    }
                }
                _ => return Err(Stop::Missing),
            },
            Node::Index(input) => match self.point[input.index()] {
                Some(Value::Level(level)) => {
                    self.look_at(input);
                    Interval::exactly(f32::from(level)).into()
                }
                _ => return Err(Stop::Missing),
            },
            // Occurs in the result map of a symmetry only, which is never evaluated at a point.
            Node::Result(_) => Interval::ANY.into(),
            Node::Unary(op, a) => {
                let a = self.number(a)?;
                let image = Interval::unary(op, a.value);
                if self.is_whole(expr) {
                    return Ok(image.into());
                }
                match op.row().image == Image::Steps {
                    true => self.jump(expr, image)?.into(),
                    false => self.reordered(image, || {
                        let whole = || Free::leaf(Interval::unary(UnaryOp::Floor, a.value));
                        let part = (op == UnaryOp::Fract).then(|| a.free.subtract(whole()));
                        part.or_else(|| (op == UnaryOp::Negate).then(|| a.free.negate()))
                    }),
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                let image = Interval::binary(op, a.value, b.value);
                if self.is_whole(expr) || op.row().is_on_words {
                    return Ok(image.into());
                }
                let free = || match op {
                    BinaryOp::Add => Some(a.free.add(b.free)),
                    BinaryOp::Subtract => Some(a.free.subtract(b.free)),
                    BinaryOp::Multiply => Some(a.free.multiply(b.free)),
                    BinaryOp::Divide => Some(a.free.over(b.value)),
                    BinaryOp::Remainder => {
                        let whole =
                            Interval::unary(UnaryOp::Trunc, Interval::binary(BinaryOp::Divide, a.value, b.value));
                        Some(a.free.subtract(b.free.multiply(Free::leaf(whole))))
                    }
                    BinaryOp::WholeQuotient
                    | BinaryOp::WholeRemainder
                    | BinaryOp::WordAdd
                    | BinaryOp::WordSubtract
                    | BinaryOp::WordMultiply
                    | BinaryOp::WordQuotient
                    | BinaryOp::WordRemainder
                    | BinaryOp::WordAnd
                    | BinaryOp::WordOr
                    | BinaryOp::WordXor
                    | BinaryOp::ShiftLeft
                    | BinaryOp::ShiftRight
                    | BinaryOp::WordMax
                    | BinaryOp::WordMin
                    | BinaryOp::Atan2
                    | BinaryOp::Max
                    | BinaryOp::Min
                    | BinaryOp::Pow
                    | BinaryOp::Step => None,
                };
                match op == BinaryOp::Step {
                    true => {
                        let value = self.jump(expr, image)?;
                        Known { value, free: Free::one_less(value) }
                    }
                    false => self.reordered(image, free),
                }
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.number(a)?, self.number(b)?, self.number(c)?);
                self.reordered(Interval::ternary(op, a.value, b.value, c.value), || match op {
                    TernaryOp::Fma => Some(a.free.multiply(b.free).add(c.free)),
                    TernaryOp::Mix => Some(Free::mix(a.free, b.free, c.free)),
                    TernaryOp::Clamp | TernaryOp::Smoothstep => None,
                })
            }
            Node::Select(condition, then, other) => match (&mut &*self).decide(condition)? {
                true => self.number(then)?,
                false => self.number(other)?,
            },
        })
    }

    /// Returns whether an expression is a whole number, which is exact in any order.
    fn is_whole(&self, expr: ExprId) -> bool {
        self.program.pool.expr_facts(expr).whole
    }

    /// The result of an operation, with those of other orders if they are admitted and it is a sum or product.
    fn reordered(&self, image: Interval, free: impl FnOnce() -> Option<Free>) -> Known {
        match if self.reordering { free() } else { None } {
            Some(free) => Known { value: free.interval().map_or(image, |other| image.hull(other)), free },
            None => image.into(),
        }
    }

    /// The image under a function with whole results: of two that are neighbours, one or the other.
    fn jump(&self, expr: ExprId, image: Interval) -> Result<Interval, Stop> {
        if image.hi() - image.lo() != 1.0 {
            return Ok(image);
        }
        let upper = self.choice(Choice::Jump(expr))?;
        Ok(Interval::word(if upper { image.hi() } else { image.lo() }))
    }
}

impl<'p> Walk<'p> for &IntervalInterpreter<'p> {
    type Stop = Stop;

    fn program(&self) -> &'p Program {
        self.program
    }

    fn has_level(&mut self, input: InputId, levels: LevelSet) -> Result<bool, Stop> {
        match self.point[input.index()] {
            Some(Value::Level(level)) => {
                self.look_at(input);
                Ok(levels.contains(level))
            }
            Some(Value::Number(_)) | None => Err(Stop::Missing),
        }
    }

    fn compare(&mut self, condition: CondId, op: Comparison, a: ExprId, b: ExprId) -> Result<bool, Stop> {
        let (a, b) = (self.number(a)?, self.number(b)?);
        let decided = match self.reordering && !(a.free.is_leaf() && b.free.is_leaf()) {
            true => a.free.compare(op, b.free),
            false => a.value.compare(op, b.value),
        };
        decided.map_or_else(|| self.choice(Choice::Comparison(condition)), Ok)
    }
}
