//! Builds plans.
//!
//! The one subtle part is laziness. A condition such as `n_top == both &&
//! n_bottom == both` fetches its second input only if the first part holds, so
//! a test that needs a fetch is taken apart into tests and fetches in the order
//! in which the program would demand them. What is already known on the way
//! removes tests that are decided.

use std::cell::RefCell;
use std::collections::HashMap;

use super::key::KeyLayout;
use super::knowledge::Knowledge;
use super::setting::Setting;
use super::{Coefficients, Leaf, Plan, Step, StepId};
use crate::program::claims::Claims;
use crate::program::{Cond, CondId, ExprId, InputId, InputSet, LevelSet, Pool, Program};

/// Most steps of a plan.
const MAX_STEPS: usize = 200_000;
/// Deepest chain of tests that depend on fetched inputs.
const MAX_DEPTH: usize = 400;
/// Most tests, guards and lines that are gone through, over all ways to come to them.
const MAX_TAKEN_APART: usize = 2_000_000;
/// The advice against too many paths.
const SPLIT: &str = "split cases in which many lines or choices depend on fetched inputs";

pub(super) type Result<T> = std::result::Result<T, String>;
/// Rows that may be taken, with what is left of their guards.
pub(super) type Guarded = Vec<(usize, CondId)>;
/// The continuation for one outcome of a condition.
type Next<'a, 'p> = &'a dyn Fn(&mut Builder<'p>, &Knowledge) -> Result<StepId>;

pub(super) struct Builder<'p> {
    pub(super) program: &'p Program,
    pub(super) pool: Pool,
    steps: Vec<Step>,
    index: HashMap<Step, StepId>,
    depth: usize,
    /// Decisions taken apart so far.
    taken_apart: usize,
}

/// A chain of rows that is being made.
struct Chain<'a> {
    rows: &'a [(usize, CondId)],
    /// The knowledge in front of it.
    known: &'a Knowledge,
    /// By place, the fetched inputs that the rows from there on, or the default, mention.
    mentioned: Vec<InputSet>,
    /// The steps made from a place on, where some of those inputs were fetched.
    made: RefCell<HashMap<(usize, InputSet), StepId>>,
}

impl<'a> Chain<'a> {
    fn new(builder: &Builder<'_>, rows: &'a [(usize, CondId)], known: &'a Knowledge) -> Self {
        let program = builder.program;
        let values = |values: &[ExprId]| {
            values.iter().fold(InputSet::default(), |all, value| all.or(program.pool.expr_facts(*value).inputs))
        };
        let mut mentioned = vec![values(&program.default).and(program.fetched)];
        for (row, guard) in rows.iter().rev() {
            let lines = program.rows[*row].lines.iter();
            let inputs = lines.fold(builder.pool.cond_facts(*guard).inputs, |all, line| {
                all.or(program.pool.cond_facts(line.condition).inputs).or(values(&line.values))
            });
            let behind = mentioned.last().copied().unwrap_or_default();
            mentioned.push(behind.or(inputs.and(program.fetched)));
        }
        mentioned.reverse();
        Self { rows, known, mentioned, made: RefCell::default() }
    }

    /// The first row from a place on whose guard needs an input that is not yet fetched.
    fn next_fetching(&self, builder: &Builder<'_>, from: usize, known: &Knowledge) -> Option<(usize, CondId)> {
        let needs =
            |(_, guard): &(usize, CondId)| !builder.missing(builder.pool.cond_facts(*guard).inputs, known).is_empty();
        let place = self.rows[from..].iter().position(needs)? + from;
        Some((place, self.rows[place].1))
    }
}

impl<'p> Builder<'p> {
    pub(super) fn new(program: &'p Program) -> Self {
        Self { program, pool: program.pool.clone(), steps: Vec::new(), index: HashMap::new(), depth: 0, taken_apart: 0 }
    }

    pub(super) fn finish(self, setting: &Setting<'p, '_>, key: KeyLayout, lookup: Vec<u16>, root: StepId) -> Plan<'p> {
        Plan {
            program: self.program,
            shape: setting.options.shape,
            assumed: setting.options.assume,
            weights_origin: setting.options.weights.map(|weights| weights.origin().to_owned()),
            inputs: setting.inputs,
            certificate: None,
            notes: Vec::new(),
            pool: self.pool,
            key,
            lookup,
            coefficients: Coefficients::default(),
            symmetries: Vec::new(),
            steps: self.steps,
            root,
        }
    }

    /// The number of steps made.
    pub(super) fn len(&self) -> usize {
        self.steps.len()
    }

    /// Returns whether a test or a result mentions an input.
    pub(super) fn mentions(&self, input: InputId) -> bool {
        self.steps.iter().any(|step| match step {
            Step::Test { condition, .. } | Step::Gather { condition, .. } => {
                self.pool.cond_facts(*condition).inputs.contains(input)
            }
            Step::Leaf(leaf) => leaf.values.iter().any(|value| self.pool.expr_facts(*value).inputs.contains(input)),
            // Another input may stand behind one that is mentioned.
            Step::Orbit { .. } => true,
            Step::Fetch { .. } | Step::Switch { .. } | Step::Coefficients { .. } => false,
        })
    }

    /// A step that was made.
    pub(super) fn step(&self, id: StepId) -> &Step {
        &self.steps[id.0 as usize]
    }

    pub(super) fn push(&mut self, step: Step) -> Result<StepId> {
        if let Some(id) = self.index.get(&step) {
            return Ok(*id);
        }
        if self.steps.len() >= MAX_STEPS {
            return Err(format!("it would need more than {MAX_STEPS} steps"));
        }
        let id = StepId(self.steps.len() as u32);
        self.steps.push(step.clone());
        self.index.insert(step, id);
        Ok(id)
    }

    pub(super) fn test(&mut self, condition: CondId, then: StepId, other: StepId) -> Result<StepId> {
        match self.pool.truth(condition) {
            Some(true) => Ok(then),
            Some(false) => Ok(other),
            None if then == other => Ok(then),
            None => self.push(Step::Test { condition, then, other }),
        }
    }

    /// The rows that can be taken in a state, with what is left of their guards.
    pub(super) fn rows_of_state(&mut self, claims: &Claims, state: usize, levels: &[u8]) -> Guarded {
        let program = self.program;
        let mut rows = Vec::new();
        let mut known = None;
        for claim in claims.of(state) {
            if claim.always {
                rows.push((claim.row, self.pool.always(true)));
                break;
            }
            let known = known.get_or_insert_with(|| {
                let mut known = Knowledge::none(program);
                for (input, _) in program.states.digits() {
                    known.restrict(*input, LevelSet::one(levels[input.index()]));
                }
                known
            });
            rows.push((claim.row, known.cond(&mut self.pool, program.rows[claim.row].guard)));
        }
        rows
    }

    /// The fetched inputs among some that were not fetched yet.
    pub(super) fn missing(&self, inputs: InputSet, known: &Knowledge) -> InputSet {
        inputs.and(self.program.fetched).minus(known.fetched)
    }

    /// A chain of rows, then the default.
    pub(super) fn rows(&mut self, rows: &[(usize, CondId)], known: &Knowledge) -> Result<StepId> {
        let chain = Chain::new(self, rows, known);
        self.chain(&chain, 0, known.fetched)
    }

    /// The chain from row number `from` on, with some inputs fetched.
    fn chain(&mut self, chain: &Chain<'_>, from: usize, fetched: InputSet) -> Result<StepId> {
        // Places that are come to without another fetch are built from the last one, so that only
        // fetches nest.
        let mut places = vec![from];
        let known = chain.known.with_fetched(fetched);
        while let Some(last) = places.last()
            && let Some((place, guard)) = chain.next_fetching(self, *last, &known)
            && self.may_be(guard, false, &known)
        {
            places.push(place + 1);
        }
        let mut step = self.chain_at(chain, places.pop().unwrap_or(from), &known)?;
        for place in places.into_iter().rev() {
            step = self.chain_at(chain, place, &known)?;
        }
        Ok(step)
    }

    fn chain_at(&mut self, chain: &Chain<'_>, from: usize, known: &Knowledge) -> Result<StepId> {
        // Inputs that nothing from here on mentions make no difference.
        let place = (from, known.fetched.and(chain.mentioned[from]));
        if let Some(step) = chain.made.borrow().get(&place) {
            return Ok(*step);
        }
        let step = self.descend(|me| {
            // Guards that need nothing fetched are tested as they stand, and the
            // chain is built from its end, so that its length costs no stack.
            let fetching = chain.next_fetching(me, from, known);
            let free = fetching.map_or(chain.rows.len(), |(place, _)| place);
            let mut next = match fetching {
                None => {
                    let program = me.program;
                    me.leaf(None, None, program.default.clone(), known)?
                }
                Some((_, guard)) => {
                    let row = chain.rows[free].0;
                    let yes = |me: &mut Self, known: &Knowledge| me.lines(row, 0, known);
                    // Later guards stay as written: only what was fetched is remembered.
                    let no = |me: &mut Self, after: &Knowledge| me.chain(chain, free + 1, after.fetched);
                    me.branch(guard, known, &yes, &no)?
                }
            };
            for (row, guard) in chain.rows[from..free].iter().rev() {
                let inside = known.with(&me.pool, *guard, true);
                let then = me.lines(*row, 0, &inside)?;
                next = me.test(*guard, then, next)?;
            }
            Ok(next)
        })?;
        chain.made.borrow_mut().insert(place, step);
        Ok(step)
    }

    /// Returns whether a condition can come out as `value` before anything more is fetched. It may say no
    /// where it can: a plan then nests deeper than it must.
    fn may_be(&self, condition: CondId, value: bool, known: &Knowledge) -> bool {
        match self.pool.cond(condition) {
            Cond::Not(inner) => self.may_be(*inner, !value, known),
            Cond::And(parts) if !value => parts.iter().any(|part| self.may_be(*part, false, known)),
            Cond::Or(parts) if value => parts.iter().any(|part| self.may_be(*part, true, known)),
            Cond::Const(_) | Cond::Level(..) | Cond::Compare(..) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {
                self.missing(self.pool.cond_facts(condition).inputs, known).is_empty()
            }
        }
    }

    fn descend(&mut self, inner: impl FnOnce(&mut Self) -> Result<StepId>) -> Result<StepId> {
        if self.depth >= MAX_DEPTH {
            return Err(format!("tests of fetched inputs nest deeper than {MAX_DEPTH}; {SPLIT}"));
        }
        self.taken_apart += 1;
        if self.taken_apart > MAX_TAKEN_APART {
            return Err(format!("its tests of fetched inputs take more than {MAX_TAKEN_APART} decisions; {SPLIT}"));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    /// The lines of a row, from number `from` on.
    fn lines(&mut self, row: usize, from: usize, known: &Knowledge) -> Result<StepId> {
        let program = self.program;
        let lines = &program.rows[row].lines;
        // As in a chain: tests that need nothing fetched are built from the last one.
        let mut free: Vec<(CondId, usize, Knowledge)> = Vec::new();
        let mut known = known.clone();
        let mut at = from;
        let mut next = loop {
            let Some(line) = lines.get(at) else {
                break self.leaf(Some(row), None, program.default.clone(), &known)?;
            };
            let condition = known.cond(&mut self.pool, line.condition);
            let facts = self.pool.cond_facts(condition);
            match self.pool.truth(condition) {
                Some(true) => break self.leaf(Some(row), Some(at), line.values.clone(), &known)?,
                Some(false) => {}
                None if self.missing(facts.inputs, &known).is_empty() => {
                    free.push((condition, at, known.with(&self.pool, condition, true)));
                    known = known.with(&self.pool, condition, false);
                }
                None => {
                    let yes =
                        |me: &mut Self, known: &Knowledge| me.leaf(Some(row), Some(at), line.values.clone(), known);
                    let no = |me: &mut Self, known: &Knowledge| me.lines(row, at + 1, known);
                    break self.branch(condition, &known, &yes, &no)?;
                }
            }
            at += 1;
        };
        for (condition, line, inside) in free.into_iter().rev() {
            let then = self.leaf(Some(row), Some(line), lines[line].values.clone(), &inside)?;
            next = self.test(condition, then, next)?;
        }
        Ok(next)
    }

    /// A result, with everything fetched that it needs, and nothing else.
    fn leaf(
        &mut self,
        row: Option<usize>,
        line: Option<usize>,
        values: Vec<ExprId>,
        known: &Knowledge,
    ) -> Result<StepId> {
        let values: Vec<ExprId> = values.into_iter().map(|value| known.expr(&mut self.pool, value)).collect();
        if let Some(condition) = values.iter().find_map(|value| self.lazy_choice(*value, known)) {
            let go = |me: &mut Self, known: &Knowledge| me.leaf(row, line, values.clone(), known);
            return self.branch(condition, known, &go, &go);
        }
        let inputs = values.iter().fold(InputSet::default(), |all, v| all.or(self.pool.expr_facts(*v).inputs));
        let missing: Vec<InputId> = self.missing(inputs, known).iter().collect();
        let mut step = self.push(Step::Leaf(Leaf { row, line, values }))?;
        for input in missing.into_iter().rev() {
            step = self.push(Step::Fetch { input, next: step })?;
        }
        Ok(step)
    }

    /// The outermost choice in an expression that decides about a fetch.
    fn lazy_choice(&self, expr: ExprId, known: &Knowledge) -> Option<CondId> {
        if self.missing(self.pool.expr_facts(expr).inputs, known).is_empty() {
            return None;
        }
        let node = self.pool.node(expr);
        node.condition().or_else(|| node.children().find_map(|part| self.lazy_choice(part, known)))
    }

    /// Tests a condition, fetching what it needs in the order it needs it.
    fn branch(&mut self, condition: CondId, known: &Knowledge, yes: Next<'_, 'p>, no: Next<'_, 'p>) -> Result<StepId> {
        self.descend(|me| me.branch_inner(condition, known, yes, no))
    }

    fn branch_inner(
        &mut self,
        condition: CondId,
        known: &Knowledge,
        yes: Next<'_, 'p>,
        no: Next<'_, 'p>,
    ) -> Result<StepId> {
        let asked = condition;
        let condition = known.cond(&mut self.pool, asked);
        match self.pool.truth(condition) {
            Some(true) => return yes(self, known),
            Some(false) => return no(self, known),
            None => {}
        }
        let missing = self.missing(self.pool.cond_facts(condition).inputs, known);
        if missing.is_empty() {
            let then = yes(self, &known.with(&self.pool, condition, true))?;
            let other = no(self, &known.with(&self.pool, condition, false))?;
            return self.test(condition, then, other);
        }
        // A value that hangs on the condition asks for it again, and what is known of its parts need
        // not answer that: where one of two does not hold, it is open which.
        let yes: Next<'_, 'p> = &|me, known| yes(me, &known.with_outcome([asked, condition], true));
        let no: Next<'_, 'p> = &|me, known| no(me, &known.with_outcome([asked, condition], false));
        match self.pool.cond(condition).clone() {
            Cond::Const(_) => yes(self, known),
            Cond::Not(inner) => self.branch(inner, known, no, yes),
            Cond::And(parts) => {
                let (first, rest) = self.split(&parts, known, |pool, parts| pool.and(parts));
                self.branch(first, known, &|me, known| me.branch(rest, known, yes, no), no)
            }
            Cond::Or(parts) => {
                let (first, rest) = self.split(&parts, known, |pool, parts| pool.or(parts));
                self.branch(first, known, yes, &|me, known| me.branch(rest, known, yes, no))
            }
            Cond::If(c, a, b) => self
                .branch(c, known, &|me, known| me.branch(a, known, yes, no), &|me, known| me.branch(b, known, yes, no)),
            Cond::Level(input, _) => self.fetch(input, known, condition, yes, no),
            Cond::Compare(_, a, b) => match self.lazy_choice(a, known).or_else(|| self.lazy_choice(b, known)) {
                Some(choice) => {
                    let go = |me: &mut Self, known: &Knowledge| me.branch(condition, known, yes, no);
                    self.branch(choice, known, &go, &go)
                }
                None => match missing.iter().next() {
                    Some(input) => self.fetch(input, known, condition, yes, no),
                    None => yes(self, known),
                },
            },
        }
    }

    /// The parts that need no fetch are tested first, together, wherever they stand: they may make
    /// the fetches of others needless. Without such parts the first one comes alone.
    fn split(
        &mut self,
        parts: &[CondId],
        known: &Knowledge,
        join: fn(&mut Pool, Vec<CondId>) -> CondId,
    ) -> (CondId, CondId) {
        let needs_none = |part: &CondId| self.missing(self.pool.cond_facts(*part).inputs, known).is_empty();
        let (mut first, mut rest): (Vec<CondId>, Vec<CondId>) = parts.iter().partition(|part| needs_none(part));
        if first.is_empty() {
            first.push(rest.remove(0));
        }
        (join(&mut self.pool, first), join(&mut self.pool, rest))
    }

    fn fetch(
        &mut self,
        input: InputId,
        known: &Knowledge,
        condition: CondId,
        yes: Next<'_, 'p>,
        no: Next<'_, 'p>,
    ) -> Result<StepId> {
        let next = self.branch(condition, &known.with_fetched(InputSet::one(input)), yes, no)?;
        self.push(Step::Fetch { input, next })
    }
}
