//! The gate for plans that branch or look up coefficients: plan ≡ program, state by state, symbolically.
//!
//! For each state of the discrete inputs the program is run symbolically.
//! Whatever the state does not decide (the level of a fetched input, a
//! comparison of numbers) is asked of an `Oracle`, which remembers its
//! answers; the plan then runs on the same answers. Every sequence of answers
//! is gone through, so all paths are covered. On each path
//!
//! - both must take the same row, and the same line of it;
//! - the plan fetches an input at most once, uses none that it has not
//!   fetched, and fetches none that the program does not;
//! - the results must be the same expression (then they agree in every bit) or
//!   have the same normal form over the reals (then the difference in `f32` is
//!   bounded).
//!
//! Comparisons of the same numbers, and of one number with several constants, answer each other where one
//! follows from others ([`Comparisons`](crate::program::comparisons::Comparisons)). Others that look different are treated as independent, which can
//! refuse a right plan but never accept a wrong one.

use std::collections::HashMap;

use super::oracle::{Choice, Oracle, Question};
use super::report::{Counterexample, MAX_PATHS, MAX_PATHS_OF_STATE, Proof, Refusal};
use super::{rounding, route};
use crate::plan::{Leaf, Plan, Step, StepId};
use crate::program::claims::{Candidates, Places};
use crate::program::normal::Normaliser;
use crate::program::print::Printer;
use crate::program::{Comparison, Cond, CondId, ExprId, InputId, InputSet, Node, Pool, Value};

/// The fault of a lookup.
const NO_WAY: &str = "the plan's lookup has no way for this state";

/// Most questions answered in one state, on all of its paths.
const MAX_ANSWERS: usize = 1 << 22;

/// Proves a plan in some states.
pub(super) fn prove(plan: &Plan<'_>, states: &[usize]) -> Result<Proof, Refusal> {
    let mut prover = Prover::new(plan, states);
    for state in states {
        prover.state(*state)?;
    }
    Ok(prover.proof)
}

/// Proves a plan state by state.
pub(super) struct Prover<'a, 'p> {
    plan: &'a Plan<'p>,
    /// The plan's terms, and those that resolving selections makes of them.
    pool: Pool,
    normaliser: Normaliser,
    oracle: Oracle,
    candidates: Candidates,
    /// Inputs that the plan declares but has not fetched on this path: code finds their first level
    /// or least value there. Empty while the program runs.
    absent: InputSet,
    /// The step at which the paths of each state begin.
    starts: Vec<StepId>,
    /// The findings in the states so far.
    proof: Proof,
}

/// A run of program or plan on one path. Selections in the values are not decided yet.
struct Run {
    row: Option<usize>,
    line: Option<usize>,
    values: Vec<ExprId>,
    fetched: InputSet,
    /// Inputs that are declared and not fetched.
    absent: InputSet,
}

impl<'a, 'p> Prover<'a, 'p> {
    /// A prover for some states of a plan.
    pub(super) fn new(plan: &'a Plan<'p>, states: &[usize]) -> Self {
        let program = plan.program;
        Self {
            plan,
            pool: plan.pool.clone(),
            normaliser: Normaliser::default(),
            oracle: Oracle::new(program),
            candidates: Candidates::new(program),
            absent: InputSet::default(),
            starts: route::starts(plan, states),
            proof: Proof::none(plan.assumed),
        }
    }

    /// The findings in the states that were proved.
    pub(super) fn proof(self) -> Proof {
        self.proof
    }

    /// Proves the plan in one of the states; if that fails, the findings are as before.
    pub(super) fn state(&mut self, state: usize) -> Result<(), Refusal> {
        let before = self.proof.clone();
        let done = self.every_path(state, before.paths);
        match done {
            Ok(()) => self.proof.states += 1,
            Err(_) => self.proof = before,
        }
        done
    }

    fn every_path(&mut self, state: usize, before: usize) -> Result<(), Refusal> {
        self.plan.program.states.write(state, &mut self.oracle.levels);
        self.oracle.restart();
        loop {
            self.path(state)?;
            if !self.oracle.advance(&self.pool) {
                return Ok(());
            }
            let paths = self.proof.paths;
            let too_many = paths - before >= MAX_PATHS_OF_STATE || paths - self.proof.states > MAX_PATHS;
            if too_many || self.oracle.answered > MAX_ANSWERS {
                self.oracle.restart();
                return Err(Refusal::TooLong { shape: self.plan.shape.name(), state: self.describe() });
            }
        }
    }

    fn path(&mut self, state: usize) -> Result<(), Refusal> {
        let want = self.run_program(state);
        // The plan may ask further questions; they then become part of the path.
        let got = self.run_plan(state);
        self.absent = InputSet::default();
        let got = got.map_err(|reason| self.differs(reason, &want))?;
        self.proof.paths += 1;
        if (want.row, want.line) != (got.row, got.line) {
            let name = |run: &Run| self.name(run);
            let reason = format!("the table takes {}, the plan {}", name(&want), name(&got));
            return Err(self.differs(reason, &want));
        }
        // Values that are the same before selections are decided need no decisions, unless these fetch.
        let fetches = |value: &ExprId| !self.pool.expr_facts(*value).inputs.and(self.plan.program.fetched).is_empty();
        if want.values == got.values && got.fetched.is_empty() && !want.values.iter().any(fetches) {
            self.proof.identical += 1;
            return Ok(());
        }
        let mut fetched = want.fetched;
        let values = self.results(&want.values, &mut fetched);
        let want = Run { values, fetched, ..want };
        self.absent = got.absent;
        let got = Run { values: self.results(&got.values, &mut InputSet::default()), ..got };
        self.absent = InputSet::default();
        if let Some(input) = got.fetched.minus(want.fetched).iter().next() {
            let input = &self.plan.program.inputs[input.index()].name;
            return Err(self.differs(format!("the plan fetches `{input}`, which the table does not need here"), &want));
        }
        let mut identical = true;
        for (a, b) in want.values.iter().zip(&got.values) {
            if a == b || self.decided(*a) == self.decided(*b) {
                continue;
            }
            // Selections that only one side has make further paths.
            let (a, b) = (&self.resolve(*a, &mut InputSet::default()), &self.resolve(*b, &mut InputSet::default()));
            if a == b {
                continue;
            }
            identical = false;
            let forms = (self.normaliser.normal(&self.pool, *a), self.normaliser.normal(&self.pool, *b));
            if forms.0.is_none() || forms.0 != forms.1 {
                let printer = Printer { pool: &self.pool, inputs: &self.plan.program.inputs };
                let reason = format!("the table gives {}, the plan {}", printer.expr(*a), printer.expr(*b));
                let found = self.counterexample(reason, &want);
                return Err(match forms {
                    (Some(_), Some(_)) => Refusal::Different(found),
                    (None, _) | (_, None) => Refusal::Undecided(found),
                });
            }
            let program = self.plan.program;
            let bound = |expr| rounding::error(program, &self.pool, expr);
            let (a, b) = (bound(*a), bound(*b));
            self.proof.apart(a, b);
        }
        self.proof.identical += usize::from(identical);
        Ok(())
    }

    fn name(&self, run: &Run) -> String {
        let row = match run.row {
            Some(row) => format!("case {}", self.plan.program.rows[row].id),
            None => return "the default".to_owned(),
        };
        match run.line {
            Some(line) => format!("{row}, line {}", line + 1),
            None => format!("{row} with the default value"),
        }
    }

    fn differs(&self, reason: String, want: &Run) -> Refusal {
        Refusal::Different(self.counterexample(reason, want))
    }

    fn counterexample(&self, reason: String, want: &Run) -> Box<Counterexample> {
        Box::new(Counterexample { shape: self.plan.shape.name(), state: self.describe(), reason, row: want.row })
    }

    /// The path in table notation: the state, then what was asked.
    fn describe(&self) -> Vec<String> {
        let program = self.plan.program;
        let mut state = Vec::new();
        for (input, _) in program.states.digits() {
            let declared = &program.inputs[input.index()];
            let level = self.oracle.levels[input.index()];
            state.push(format!("{} = {}", declared.name, declared.show(Value::Level(level))));
        }
        let printer = Printer { pool: &self.pool, inputs: &program.inputs };
        for Choice { question, answer, .. } in &self.oracle.choices {
            state.push(match question {
                Question::Level(input) => {
                    let declared = &program.inputs[input.index()];
                    format!("{} = {}", declared.name, declared.show(Value::Level(*answer)))
                }
                Question::Compare(op, a, b) => {
                    let symbol = match op {
                        Comparison::Less => "<",
                        Comparison::LessEqual => "<=",
                        Comparison::Equal => "==",
                    };
                    let truth = if *answer == 0 { "holds" } else { "does not hold" };
                    format!("{} {symbol} {} {truth}", printer.expr(*a), printer.expr(*b))
                }
            });
        }
        state
    }

    /// The program, by the definition of its meaning.
    fn run_program(&mut self, state: usize) -> Run {
        let program = self.plan.program;
        let (mut fetched, absent) = (InputSet::default(), InputSet::default());
        let mut places = Places::default();
        while let Some(index) = self.candidates.next(state, &mut places) {
            let row = &program.rows[index];
            if !self.holds(row.guard, &mut fetched) {
                continue;
            }
            for (number, line) in row.lines.iter().enumerate() {
                if self.holds(line.condition, &mut fetched) {
                    return Run { row: Some(index), line: Some(number), values: line.values.clone(), fetched, absent };
                }
            }
            return Run { row: Some(index), line: None, values: program.default.clone(), fetched, absent };
        }
        Run { row: None, line: None, values: program.default.clone(), fetched, absent }
    }

    /// The plan, step by step, with the discipline of fetching checked.
    fn run_plan(&mut self, state: usize) -> Result<Run, String> {
        let plan = self.plan;
        // What is fetched on this path, and what the code may mention: that, and what is gathered on others.
        let (mut fetched, mut declared) = (InputSet::default(), InputSet::default());
        let mut at = self.starts[state];
        loop {
            match plan.step(at) {
                Step::Switch { arms } => {
                    let arm = plan.lookup.get(state).and_then(|arm| arms.get(usize::from(*arm)));
                    at = *arm.ok_or(NO_WAY)?;
                }
                Step::Fetch { input, next } => {
                    if declared.contains(*input) || !plan.program.fetched.contains(*input) {
                        return Err(format!("the plan fetches `{}` again", plan.program.inputs[input.index()].name));
                    }
                    fetched = fetched.or(InputSet::one(*input));
                    declared = declared.or(InputSet::one(*input));
                    at = *next;
                }
                Step::Gather { input, condition, next } => {
                    if declared.contains(*input) || !plan.program.fetched.contains(*input) {
                        return Err(format!("the plan fetches `{}` again", plan.program.inputs[input.index()].name));
                    }
                    match self.tested(*condition, declared)? {
                        true => fetched = fetched.or(InputSet::one(*input)),
                        false => self.absent = self.absent.or(InputSet::one(*input)),
                    }
                    declared = declared.or(InputSet::one(*input));
                    at = *next;
                }
                Step::Test { condition, then, other } => {
                    at = if self.tested(*condition, declared)? { *then } else { *other };
                }
                Step::Coefficients { rest } => {
                    let entry = plan.lookup.get(state).map(|entry| usize::from(*entry)).ok_or(NO_WAY)?;
                    if let Some(fit) = plan.coefficients.fits.get(entry) {
                        let pieces = fit.pieces.iter();
                        let values: Vec<ExprId> =
                            pieces.map(|piece| plan.coefficients.value(&mut self.pool, piece)).collect();
                        for value in &values {
                            self.only_fetched(self.pool.expr_facts(*value).inputs, declared)?;
                        }
                        return Ok(Run { row: fit.row, line: fit.line, values, fetched, absent: self.absent });
                    }
                    at = *rest.get(entry - plan.coefficients.fits.len()).ok_or(NO_WAY)?;
                }
                Step::Orbit { arms } => {
                    let entry = plan.lookup.get(state).map(|entry| usize::from(*entry)).ok_or(NO_WAY)?;
                    let count = plan.symmetries.len();
                    if entry & ((1 << count) - 1) != 0 {
                        // Another gate is for that.
                        return Err("the plan turns the inputs".to_owned());
                    }
                    at = *arms.get(entry >> count).ok_or(NO_WAY)?;
                }
                Step::Leaf(Leaf { row, line, values }) => {
                    for value in values {
                        self.only_fetched(plan.pool.expr_facts(*value).inputs, declared)?;
                    }
                    return Ok(Run { row: *row, line: *line, values: values.clone(), fetched, absent: self.absent });
                }
            }
        }
    }

    /// Returns whether a condition of the plan holds, which may mention what is declared.
    fn tested(&mut self, condition: CondId, declared: InputSet) -> Result<bool, String> {
        self.only_fetched(self.plan.pool.cond_facts(condition).inputs, declared)?;
        Ok(self.holds(condition, &mut InputSet::default()))
    }

    fn only_fetched(&self, inputs: InputSet, fetched: InputSet) -> Result<(), String> {
        match inputs.and(self.plan.program.fetched).minus(fetched).iter().next() {
            None => Ok(()),
            Some(input) => {
                Err(format!("the plan uses `{}` without fetching it", self.plan.program.inputs[input.index()].name))
            }
        }
    }

    fn level(&mut self, input: InputId, fetched: &mut InputSet) -> u8 {
        if !self.plan.program.fetched.contains(input) {
            return self.oracle.levels[input.index()];
        }
        if self.absent.contains(input) {
            return 0;
        }
        *fetched = fetched.or(InputSet::one(input));
        let count = self.plan.program.levels(input).map_or(1, |levels| levels.count());
        self.oracle.answer(Question::Level(input), count as u8)
    }

    fn holds(&mut self, condition: CondId, fetched: &mut InputSet) -> bool {
        // Resolving makes expressions but no conditions, so the plan has them all.
        let plan = self.plan;
        match plan.pool.cond(condition) {
            Cond::Const(value) => *value,
            Cond::Level(input, levels) => levels.contains(self.level(*input, fetched)),
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.resolve(*a, fetched), self.resolve(*b, fetched));
                let compared = self.pool.recompare(*op, a, b);
                match self.pool.truth(compared) {
                    Some(value) => value,
                    None => self.oracle.compare(&self.pool, *op, a, b),
                }
            }
            Cond::Not(a) => !self.holds(*a, fetched),
            Cond::And(parts) => parts.iter().all(|part| self.holds(*part, fetched)),
            Cond::Or(parts) => parts.iter().any(|part| self.holds(*part, fetched)),
            Cond::If(c, a, b) => {
                let chosen = if self.holds(*c, fetched) { a } else { b };
                self.holds(*chosen, fetched)
            }
        }
    }

    /// The results of a path. Without fetched inputs it does not matter which
    /// selections are made: if both sides have the same one, it stays as it is,
    /// so that functions with many selections do not have a path for every combination.
    fn results(&mut self, values: &[ExprId], fetched: &mut InputSet) -> Vec<ExprId> {
        match self.plan.program.fetched.is_empty() {
            true => values.to_vec(),
            false => self.resolve_all(values, fetched),
        }
    }

    /// An expression in which those selections are made that this path has decided already.
    fn decided(&mut self, expr: ExprId) -> ExprId {
        self.decided_memo(expr, &mut HashMap::new())
    }

    fn decided_memo(&mut self, expr: ExprId, memo: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if !self.pool.expr_facts(expr).selects {
            return expr;
        }
        if let Some(done) = memo.get(&expr) {
            return *done;
        }
        let result = match self.pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Result(_) | Node::Input(_) => expr,
            Node::Index(input) => {
                let level = self.oracle.levels[input.index()];
                self.pool.number(f64::from(level))
            }
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.decided_memo(part, memo));
                self.pool.settle(node)
            }
            Node::Select(c, a, b) => match self.decides(c) {
                Some(true) => self.decided_memo(a, memo),
                Some(false) => self.decided_memo(b, memo),
                None => {
                    let (a, b) = (self.decided_memo(a, memo), self.decided_memo(b, memo));
                    self.pool.select(c, a, b)
                }
            },
        };
        memo.insert(expr, result);
        result
    }

    /// Returns whether a condition holds, if this path has decided that already.
    fn decides(&self, condition: CondId) -> Option<bool> {
        match self.plan.pool.cond(condition) {
            Cond::Const(value) => Some(*value),
            Cond::Level(input, levels) => Some(levels.contains(self.oracle.levels[input.index()])),
            Cond::Compare(op, a, b) => self.oracle.compared(&self.pool, *op, *a, *b),
            Cond::Not(a) => self.decides(*a).map(|value| !value),
            Cond::And(parts) => match parts.iter().map(|part| self.decides(*part)).find(|d| *d != Some(true)) {
                None => Some(true),
                Some(first) => first,
            },
            Cond::Or(parts) => match parts.iter().map(|part| self.decides(*part)).find(|d| *d != Some(false)) {
                None => Some(false),
                Some(first) => first,
            },
            Cond::If(c, a, b) => self.decides(*c).and_then(|chosen| self.decides(if chosen { *a } else { *b })),
        }
    }

    fn resolve_all(&mut self, values: &[ExprId], fetched: &mut InputSet) -> Vec<ExprId> {
        values.iter().map(|value| self.resolve(*value, fetched)).collect()
    }

    /// An expression with every selection decided by the oracle. Nothing else
    /// changes: constants are folded only where that leaves every bit as it is.
    fn resolve(&mut self, expr: ExprId, fetched: &mut InputSet) -> ExprId {
        self.resolve_memo(expr, fetched, &mut HashMap::new())
    }

    fn resolve_memo(&mut self, expr: ExprId, fetched: &mut InputSet, memo: &mut HashMap<ExprId, ExprId>) -> ExprId {
        let facts = self.pool.expr_facts(expr);
        if !facts.selects && facts.inputs.and(self.absent).is_empty() {
            *fetched = fetched.or(facts.inputs.and(self.plan.program.fetched));
            return expr;
        }
        if let Some(done) = memo.get(&expr) {
            return *done;
        }
        let result = match self.pool.node(expr) {
            Node::Input(input) if self.absent.contains(input) => {
                let least = self.plan.program.inputs[input.index()].least();
                self.pool.value_of(input, least)
            }
            Node::Index(input) => {
                let level = self.level(input, fetched);
                self.pool.number(f64::from(level))
            }
            Node::Const(_) | Node::Word(_) | Node::Result(_) | Node::Input(_) => expr,
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.resolve_memo(part, fetched, memo));
                self.pool.settle(node)
            }
            Node::Select(c, a, b) => {
                let chosen = if self.holds(c, fetched) { a } else { b };
                self.resolve_memo(chosen, fetched, memo)
            }
        };
        memo.insert(expr, result);
        result
    }
}
