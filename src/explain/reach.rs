//! Inputs that reach a case: the reverse of evaluation.
//!
//! States that a guard excludes are left out without trying them; in the others
//! the interpreter is asked at points of a small lattice, defaults first, and at
//! every level of what it fetches on the way. What is found is therefore always
//! true, and what is not found may still exist between the points tried.

use std::collections::BTreeSet;

use crate::eval::{Interpreter, NeedsFetch};
use crate::program::claims::decide;
#[cfg(feature = "report")]
use crate::program::claims::{Candidates, Claim};
use crate::program::{Domain, InputId, InputSet, Program, Value};
use crate::table::HitPolicy;

/// Most evaluations for one case.
const MAX_TRIES: usize = 300_000;

/// Most combinations of continuous inputs that are tried in one state.
const MAX_COMBINATIONS: usize = 700;

/// A point that leads to a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Arrival {
    /// One value per input; fetched inputs that are not needed are absent.
    pub point: Vec<Option<Value>>,
    /// The line that applies; `None` where the default gives the value.
    pub line: Option<usize>,
    /// The components of the result.
    pub values: Vec<f64>,
    /// The number of inputs that differ from their defaults or are fetched.
    pub deviations: usize,
    /// Every assumption that can be judged there holds.
    pub assumed: bool,
}

/// The states and points that reach a case.
#[derive(Debug, Clone)]
pub struct Reach {
    /// The states that its guard, and the guards before it, do not exclude.
    pub states: Vec<usize>,
    /// These states reach the case for certain: no guard up to here depends on more than the state.
    pub exact: bool,
    /// The point with the fewest inputs that differ from their defaults.
    pub smallest: Option<Arrival>,
    /// The same for each of its lines.
    pub lines: Vec<Option<Arrival>>,
}

/// The states and points that reach a case, given as an index into [`Program::rows`].
pub fn reach(program: &Program, row: usize) -> Reach {
    let mut search = Search::new(program, row);
    let states = search.states();
    let guards =
        program.rows[first_asked(program, row)..=row].iter().map(|row| program.pool.cond_facts(row.guard).inputs);
    let digits = program.states.digits().iter().fold(InputSet::default(), |set, (id, _)| set.or(InputSet::one(*id)));
    let exact = guards.fold(InputSet::default(), InputSet::or).minus(digits).is_empty();
    let mut order: Vec<(usize, usize)> = states.iter().map(|state| (search.distance(*state), *state)).collect();
    order.sort_unstable();
    for (distance, state) in order {
        if search.done(distance) {
            break;
        }
        search.state(state, distance);
    }
    Reach { states, exact, smallest: search.smallest, lines: search.lines }
}

/// The first of the rows whose guards decide whether a row counts, up to that row: where all cases count, its own.
fn first_asked(program: &Program, row: usize) -> usize {
    match program.hit_policy {
        HitPolicy::First | HitPolicy::Unique => 0,
        HitPolicy::Collect => row,
    }
}

/// The point that a row's first example gives, if it does lead there.
pub fn example(program: &Program, row: usize) -> Option<Arrival> {
    let mut search = Search::new(program, row);
    let examples = program.examples.iter().filter(|example| example.row == row);
    examples.filter_map(|example| search.arrival(&example.inputs).ok().flatten()).next()
}

/// A point that reaches a row in a given state.
pub fn in_state(program: &Program, row: usize, state: usize) -> Option<Arrival> {
    let mut search = Search::new(program, row);
    search.state(state, search.distance(state));
    search.smallest
}

/// The first claim on every state, by number of the state; `None` where the default gives the value.
#[cfg(feature = "report")]
pub(crate) fn claims(program: &Program) -> Vec<Option<Claim>> {
    let candidates = Candidates::new(program);
    let mut levels = vec![0; program.inputs.len()];
    let first = |state: usize| {
        program.states.write(state, &mut levels);
        candidates.first(program, state, &levels)
    };
    (0..program.states.count()).map(first).collect()
}

/// Earlier rows that are sure to take states in which the guard of a row could
/// hold, with the number of these states.
pub fn earlier(program: &Program, row: usize) -> Vec<(usize, usize)> {
    // Where all cases count, none comes first.
    if program.hit_policy == HitPolicy::Collect {
        return Vec::new();
    }
    let mut levels = vec![0; program.inputs.len()];
    let mut counts = vec![0; row];
    for state in 0..program.states.count() {
        program.states.write(state, &mut levels);
        let mut earlier = 0..row;
        if decide(program, &program.pool, program.rows[row].guard, &levels) != Some(false)
            && let Some(first) =
                earlier.find(|row| decide(program, &program.pool, program.rows[*row].guard, &levels) == Some(true))
        {
            counts[first] += 1;
        }
    }
    counts.into_iter().enumerate().filter(|(_, count)| *count > 0).collect()
}

struct Search<'p> {
    program: &'p Program,
    row: usize,
    interpreter: Interpreter<'p, f32>,
    /// Values of the continuous inputs that matter here, by number of deviations.
    combinations: Vec<Vec<(InputId, f64)>>,
    tries: usize,
    smallest: Option<Arrival>,
    lines: Vec<Option<Arrival>>,
}

impl<'p> Search<'p> {
    fn new(program: &'p Program, row: usize) -> Self {
        let lines = vec![None; program.rows[row].lines.len()];
        let interpreter = Interpreter::new(program);
        let combinations = combinations(program, row);
        Self { program, row, interpreter, combinations, tries: 0, smallest: None, lines }
    }

    /// The states that the guards do not exclude.
    fn states(&self) -> Vec<usize> {
        let program = self.program;
        let mut levels = vec![0; program.inputs.len()];
        let possible = (0..program.states.count()).filter(|state| {
            program.states.write(*state, &mut levels);
            let judged = |row: usize| decide(program, &program.pool, program.rows[row].guard, &levels);
            judged(self.row) != Some(false)
                && (first_asked(program, self.row)..self.row).all(|row| judged(row) != Some(true))
        });
        possible.collect()
    }

    /// The number of inputs of a state that differ from their defaults.
    fn distance(&self, state: usize) -> usize {
        let mut levels = vec![0; self.program.inputs.len()];
        self.program.states.write(state, &mut levels);
        let differs = |id: &InputId| {
            let level = Value::Level(levels[id.index()]);
            self.program.inputs[id.index()].default.is_some_and(|default| default != level)
        };
        self.program.states.digits().iter().filter(|(id, _)| differs(id)).count()
    }

    /// Returns whether states this far from the defaults have nothing better to offer.
    fn done(&self, distance: usize) -> bool {
        let settled = |found: &Option<Arrival>| found.as_ref().is_some_and(|f| f.assumed && f.deviations <= distance);
        self.tries > MAX_TRIES || settled(&self.smallest) && self.lines.iter().all(settled)
    }

    fn state(&mut self, state: usize, distance: usize) {
        let mut levels = vec![0; self.program.inputs.len()];
        self.program.states.write(state, &mut levels);
        let mut point: Vec<Option<Value>> = vec![None; self.program.inputs.len()];
        for (id, input) in self.program.input_ids() {
            point[id.index()] = match input.domain {
                _ if input.fetched.is_some() => None,
                Domain::Discrete(_) => Some(Value::Level(levels[id.index()])),
                Domain::Continuous { .. } | Domain::Word => Some(usual(input)),
            };
        }
        let combinations = std::mem::take(&mut self.combinations);
        for combination in &combinations {
            if self.done(distance + combination.len()) {
                break;
            }
            let mut point = point.clone();
            for (id, value) in combination {
                point[id.index()] = Some(Value::Number(*value));
            }
            self.follow(point);
        }
        self.combinations = combinations;
    }

    /// Evaluates a point, and at every value of each fetched input that it asks for.
    fn follow(&mut self, point: Vec<Option<Value>>) {
        let mut pending = vec![point];
        while let Some(point) = pending.pop() {
            if self.tries > MAX_TRIES {
                return;
            }
            match self.arrival(&point) {
                Ok(Some(arrival)) => self.note(arrival),
                Ok(None) => {}
                Err(NeedsFetch(input)) => {
                    let values: Vec<Value> = match &self.program.inputs[input.index()].domain {
                        Domain::Discrete(levels) => {
                            (0..levels.count()).map(|level| Value::Level(level as u8)).collect()
                        }
                        domain @ (Domain::Continuous { .. } | Domain::Word) => {
                            lattice(domain).map(Value::Number).into()
                        }
                    };
                    // The first value is to be tried first, and the list is worked off from its end.
                    for value in values.into_iter().rev() {
                        let mut more = point.clone();
                        more[input.index()] = Some(value);
                        pending.push(more);
                    }
                }
            }
        }
    }

    /// The arrival of a point, if it reaches the case in question.
    fn arrival(&mut self, point: &[Option<Value>]) -> Result<Option<Arrival>, NeedsFetch> {
        self.tries += 1;
        let outcome = self.interpreter.evaluate(point)?;
        let Some(line) = self.line(outcome.row, outcome.line)? else { return Ok(None) };
        // An assumption about something that is not fetched here cannot be judged.
        let program = self.program;
        let judged = program.assumptions.iter().all(|a| self.interpreter.holds(a.condition).unwrap_or(true));
        let deviations = program.input_ids().filter(|(id, input)| {
            point[id.index()].is_some_and(|value| input.fetched.is_some() || value != usual(input))
        });
        Ok(Some(Arrival {
            line,
            values: program.output.numbers(&outcome.values),
            deviations: deviations.count(),
            assumed: judged,
            point: point.to_vec(),
        }))
    }

    /// The line of the case in question that gives a part of the result, where its row or another one was taken; nothing
    /// if the case has no part in it.
    fn line(&mut self, row: Option<usize>, line: Option<usize>) -> Result<Option<Option<usize>>, NeedsFetch> {
        if row == Some(self.row) {
            return Ok(Some(line));
        }
        let case = &self.program.rows[self.row];
        if self.program.hit_policy != HitPolicy::Collect || !self.interpreter.holds(case.guard)? {
            return Ok(None);
        }
        for (number, line) in case.lines.iter().enumerate() {
            if self.interpreter.holds(line.condition)? {
                return Ok(Some(Some(number)));
            }
        }
        Ok(Some(None))
    }

    fn note(&mut self, arrival: Arrival) {
        let better = |old: &Option<Arrival>| match old {
            None => true,
            Some(old) => (!arrival.assumed, arrival.deviations) < (!old.assumed, old.deviations),
        };
        if let Some(line) = arrival.line
            && better(&self.lines[line])
        {
            self.lines[line] = Some(arrival.clone());
        }
        if better(&self.smallest) {
            self.smallest = Some(arrival);
        }
    }
}

/// The default of an input, or else its first level or the middle of its range.
fn usual(input: &crate::program::Input) -> Value {
    input.default.unwrap_or(match &input.domain {
        Domain::Discrete(_) => Value::Level(0),
        Domain::Continuous { lo, hi, .. } => Value::Number(lo / 2.0 + hi / 2.0),
        Domain::Word => Value::Number(0.0),
    })
}

/// Five numbers of a range.
fn lattice(domain: &Domain) -> [f64; 5] {
    let (lo, hi) = domain.span();
    [0.5, 0.25, 0.75, 0.0, 1.0].map(|share| domain.point(lo * (1.0 - share) + hi * share))
}

/// Values of the continuous inputs that guards, lines and assumptions look at:
/// none changed, then one, and so on.
fn combinations(program: &Program, row: usize) -> Vec<Vec<(InputId, f64)>> {
    let conditions = program.rows[..=row].iter().map(|row| row.guard);
    let conditions = conditions.chain(program.rows[row].lines.iter().map(|line| line.condition));
    let conditions = conditions.chain(program.assumptions.iter().map(|assumption| assumption.condition));
    let inputs = conditions.fold(InputSet::default(), |set, id| set.or(program.pool.cond_facts(id).inputs));
    let choices: Vec<(InputId, Vec<f64>)> = inputs
        .iter()
        .filter_map(|id| match &program.inputs[id.index()] {
            input if input.fetched.is_some() => None,
            input => match &input.domain {
                domain @ (Domain::Continuous { .. } | Domain::Word) => {
                    let usual = usual(input);
                    Some((id, lattice(domain).into_iter().filter(|value| Value::Number(*value) != usual).collect()))
                }
                Domain::Discrete(_) => None,
            },
        })
        .collect();
    let mut all: Vec<Vec<(InputId, f64)>> = vec![Vec::new()];
    let mut last: BTreeSet<usize> = [0].into();
    // Every combination with one more change than the ones before, changes in the order of inputs.
    while !last.is_empty() && all.len() < MAX_COMBINATIONS {
        let mut next = BTreeSet::new();
        for base in last {
            let base = all[base].clone();
            let changed = base.last().map(|(id, _)| *id);
            for (id, values) in choices.iter().filter(|(id, _)| changed.is_none_or(|changed| *id > changed)) {
                for value in values {
                    next.insert(all.len());
                    all.push(base.iter().copied().chain([(*id, *value)]).collect());
                }
            }
        }
        last = next;
    }
    all.truncate(MAX_COMBINATIONS);
    all
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::diag::codes;

    fn rsmss() -> Program {
        Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"))
    }

    /// Every case and every line of the published tables is reached, and by what the interpreter confirms.
    /// A line that the table itself calls dead is reached where the assumptions fail.
    #[test]
    fn every_line_is_reached() {
        for file in ["tables/rsmss.ron", "tables/smsr.ron", "docs/examples/first.ron"] {
            let program = Program::read(file).unwrap_or_else(|e| panic!("{e}"));
            for (index, row) in program.rows.iter().enumerate() {
                let found = reach(&program, index);
                assert!(found.smallest.is_some(), "{file}: case {}", row.id);
                for (number, line) in found.lines.iter().enumerate() {
                    let arrival = line.as_ref().unwrap_or_else(|| panic!("{file}: case {}, line {number}", row.id));
                    let dead = row.allow.iter().any(|allow| allow.code.value == codes::DEAD_LINE.0);
                    assert!(arrival.assumed || dead, "{file}: case {}, line {number}: {arrival:?}", row.id);
                    assert_eq!(arrival.line, Some(number));
                }
            }
        }
    }

    #[test]
    fn the_smallest_point_is_small() {
        let program = rsmss();
        let row = program.rows.iter().position(|row| row.id == 19).unwrap();
        let found = reach(&program, row);
        // The corner itself, the two dominances, and the positions that I4_p and I4_q ask for there.
        assert_eq!(found.smallest.unwrap().deviations, 6);
        assert!(found.exact);
        assert_eq!(found.states.len(), 2 * 2 * 2 * 2, "dual negative corners are case 1");
    }

    #[test]
    fn examples_lead_to_their_cases() {
        let program = rsmss();
        assert!((0..program.rows.len()).all(|row| example(&program, row).is_some()));
        // Of the corners of case 19, case 1 takes those with a dual negative run: 5 of 9 pairs of types.
        let row = program.rows.iter().position(|row| row.id == 19).unwrap();
        assert_eq!(earlier(&program, row), [(0, 4 * 5)]);
        let state = reach(&program, row).states[3];
        assert_eq!(claims(&program)[state], Some(Claim { row, always: true }));
        assert!(in_state(&program, row, state).is_some());
    }
}
