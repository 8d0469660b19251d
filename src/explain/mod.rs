//! Why a table has the value it has at one point.
//!
//! An [`Explanation`] is made by asking the interpreter for the truth of every
//! condition and the value of every subexpression on the way to the result. It
//! decides nothing itself: if it disagreed with the interpreter it would be
//! wrong, not another opinion. [`text`] turns it into something to read.

pub mod code;
pub mod reach;
mod steps;
pub mod text;
pub mod why;

use crate::eval::{Interpreter, NeedsFetch};
use crate::program::print::Printer;
use crate::program::{Cond, CondId, ExprId, InputId, InputSet, Node, Program, Real, Value};
use crate::show::Precision;
use crate::table::HitPolicy;

pub use steps::Step;

/// Terms larger than this are not written out.
const LEGIBLE: u32 = 80;

/// A condition that was tested, in the notation of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tested {
    /// The condition.
    pub condition: String,
    /// The facts that decided it, such as `tV is positive_negative`.
    pub facts: Vec<String>,
}

/// The way to a result.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The point.
    pub point: Vec<Option<Value>>,
    /// For each row before the one taken: the first part of its guard that fails.
    pub refused: Vec<Tested>,
    /// The row taken, as an index into the program's rows; `None` for the default.
    pub row: Option<usize>,
    /// The rows that count as well, where all that hold do, in order.
    pub also: Vec<usize>,
    /// The parts of its guard.
    pub guard: Vec<Tested>,
    /// For each line of its value before the one that applies: what fails.
    pub refused_lines: Vec<Tested>,
    /// The line that applies; `None` where the default gives the value.
    pub line: Option<usize>,
    /// The parts of its condition; none, if it has none.
    pub line_condition: Vec<Tested>,
    /// The computation of the result, operands first.
    pub steps: Vec<Step>,
    /// The components of the result.
    pub values: Vec<f64>,
    /// The inputs that were fetched.
    pub fetched: InputSet,
    /// The type it was computed in.
    pub precision: Precision,
}

/// A fetched input is needed but not given.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Needed {
    /// The input.
    pub input: InputId,
    /// The row that asks for it, as an index into the program's rows; `None` for the default.
    pub row: Option<usize>,
}

/// Explains the result at a point, with one value per input; fetched inputs may be absent.
///
/// # Errors
/// With the first input that is needed but absent.
///
/// ```
/// use umbrage::explain::explain;
/// use umbrage::program::Program;
/// use umbrage::show::Precision;
///
/// let program = Program::read("tables/smsr.ron")?;
/// let explanation = explain(&program, &program.examples[0].inputs, Precision::F32).unwrap();
/// assert_eq!(explanation.row, Some(program.examples[0].row));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn explain(program: &Program, point: &[Option<Value>], precision: Precision) -> Result<Explanation, Needed> {
    match precision {
        Precision::F32 => Witness::<f32>::new(program, precision).explain(point),
        Precision::F64 => Witness::<f64>::new(program, precision).explain(point),
    }
}

/// Asks the interpreter, and remembers the point.
struct Witness<'p, T> {
    program: &'p Program,
    interpreter: Interpreter<'p, T>,
    precision: Precision,
    point: Vec<Option<Value>>,
}

impl<'p, T: Real> Witness<'p, T> {
    fn new(program: &'p Program, precision: Precision) -> Self {
        Self { program, interpreter: Interpreter::new(program), precision, point: Vec::new() }
    }

    fn explain(mut self, point: &[Option<Value>]) -> Result<Explanation, Needed> {
        self.point = point.to_vec();
        let program = self.program;
        let in_row = |row: Option<usize>| move |needed: NeedsFetch| Needed { input: needed.0, row };
        self.interpreter.place(point).map_err(in_row(None))?;
        let mut refused = Vec::new();
        let mut taken = None;
        for (index, row) in program.rows.iter().enumerate() {
            if self.interpreter.holds(row.guard).map_err(in_row(Some(index)))? {
                taken = Some(index);
                break;
            }
            refused.push(self.failing(row.guard).map_err(in_row(Some(index)))?);
        }
        let located = in_row(taken);
        let (mut guard, mut refused_lines, mut line, mut line_condition) = (Vec::new(), Vec::new(), None, Vec::new());
        let mut values = &program.default;
        if let Some(row) = taken.map(|index| &program.rows[index]) {
            guard = self.parts(row.guard).map_err(located)?;
            for (number, candidate) in row.lines.iter().enumerate() {
                if self.interpreter.holds(candidate.condition).map_err(located)? {
                    line_condition = self.parts(candidate.condition).map_err(located)?;
                    line = Some(number);
                    values = &candidate.values;
                    break;
                }
                refused_lines.push(self.failing(candidate.condition).map_err(located)?);
            }
        }
        let mut also = Vec::new();
        if let (HitPolicy::Collect, Some(first)) = (program.hit_policy, taken) {
            for (index, row) in program.rows.iter().enumerate().skip(first + 1) {
                if self.interpreter.holds(row.guard).map_err(located)? {
                    also.push(index);
                }
            }
        }
        let steps = steps::of(&mut self, values).map_err(located)?;
        let outcome = self.interpreter.evaluate(point).map_err(located)?;
        debug_assert_eq!((outcome.row, outcome.line), (taken, line));
        Ok(Explanation {
            point: self.point,
            refused,
            row: taken,
            also,
            guard,
            refused_lines,
            line,
            line_condition,
            steps,
            values: self.program.output.numbers(&outcome.values),
            fetched: outcome.fetched,
            precision: self.precision,
        })
    }

    /// The conjuncts of a condition that holds.
    fn parts(&mut self, condition: CondId) -> Result<Vec<Tested>, NeedsFetch> {
        let program = self.program;
        match program.pool.cond(condition) {
            Cond::Const(true) => Ok(Vec::new()),
            Cond::And(parts) => parts.iter().map(|part| self.tested(*part)).collect(),
            _ => Ok(vec![self.tested(condition)?]),
        }
    }

    /// The first conjunct that fails.
    fn failing(&mut self, condition: CondId) -> Result<Tested, NeedsFetch> {
        let program = self.program;
        if let Cond::And(parts) = program.pool.cond(condition) {
            for part in parts {
                if !self.interpreter.holds(*part)? {
                    return self.tested(*part);
                }
            }
        }
        self.tested(condition)
    }

    fn tested(&mut self, condition: CondId) -> Result<Tested, NeedsFetch> {
        let mut facts = Vec::new();
        self.facts(condition, &mut facts)?;
        Ok(Tested { condition: self.cond(condition), facts })
    }

    /// Collects the facts that decide a condition, in order.
    fn facts(&mut self, condition: CondId, facts: &mut Vec<String>) -> Result<(), NeedsFetch> {
        let program = self.program;
        match program.pool.cond(condition) {
            Cond::Const(_) => {}
            Cond::Level(input, _) => self.input_fact(*input, facts),
            Cond::Compare(_, a, b) => {
                for side in [*a, *b] {
                    if program.pool.known(side).is_none() {
                        let value = self.value(side)?;
                        note(facts, format!("{} is {value}", self.expr(side)));
                    }
                }
            }
            Cond::Not(a) => self.facts(*a, facts)?,
            Cond::And(parts) | Cond::Or(parts) => {
                let stop = matches!(program.pool.cond(condition), Cond::Or(_));
                for part in parts {
                    let holds = self.interpreter.holds(*part)?;
                    // What decides a junction is the whole reason for it.
                    if holds == stop {
                        facts.clear();
                        return self.facts(*part, facts);
                    }
                    self.facts(*part, facts)?;
                }
            }
            Cond::If(chooser, then, other) => {
                self.facts(*chooser, facts)?;
                let chosen = if self.interpreter.holds(*chooser)? { *then } else { *other };
                let mut more = Vec::new();
                self.facts(chosen, &mut more)?;
                more.into_iter().for_each(|fact| note(facts, fact));
            }
        }
        Ok(())
    }

    fn input_fact(&self, input: InputId, facts: &mut Vec<String>) {
        let declared = &self.program.inputs[input.index()];
        if let Some(value) = self.point[input.index()] {
            note(facts, format!("{} is {}", declared.name, declared.show(value)));
        }
    }

    /// The value of an expression, as it is shown.
    fn value(&mut self, expr: ExprId) -> Result<String, NeedsFetch> {
        let value = self.interpreter.number(expr)?;
        Ok(match self.program.pool.is_word(expr) {
            true => value.to_word().to_string(),
            false => self.precision.show(value.to_f64()),
        })
    }

    fn printer(&self) -> Printer<'p> {
        Printer { pool: &self.program.pool, inputs: &self.program.inputs }
    }

    fn cond(&self, condition: CondId) -> String {
        match self.program.pool.cond_facts(condition).size {
            0..=LEGIBLE => self.printer().cond(condition),
            size => format!("a condition of {size} parts"),
        }
    }

    /// An expression by its name in the table, or written out.
    fn expr(&self, expr: ExprId) -> String {
        match (self.program.pool.label(expr), self.program.pool.expr_facts(expr).size) {
            (Some(label), _) => label.to_owned(),
            (None, 0..=LEGIBLE) => self.printer().expr(expr),
            (None, size) => format!("an expression of {size} parts"),
        }
    }

    fn node(&self, expr: ExprId) -> Node {
        self.program.pool.node(expr)
    }
}

fn note(facts: &mut Vec<String>, fact: String) {
    if !facts.contains(&fact) {
        facts.push(fact);
    }
}
