//! Finds the rows that can be taken in each state, without looking at every row in
//! every state: the levels that a guard asks for span a box of states, and only
//! inside of it the guard is looked at.

use super::{Cond, CondId, InputId, LevelSet, Pool, Program};

/// Most claims that are kept. A row whose guard asks for no level claims every state.
const MAX_CLAIMS: usize = 1 << 24;

/// A row that claims a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Claim {
    /// The row.
    pub(crate) row: usize,
    /// True if its guard holds there whatever the other inputs are.
    pub(crate) always: bool,
}

/// The claims on every state.
#[derive(Debug, Clone)]
pub(crate) struct Claims {
    starts: Vec<u32>,
    claims: Vec<u32>,
}

impl Claims {
    /// The claims of a program's rows; `None` if there are too many.
    pub(crate) fn new(program: &Program) -> Option<Self> {
        let mut found: Vec<(u32, u32)> = Vec::new();
        let mut boxes = Boxes::new(program);
        for (row, case) in program.rows.iter().enumerate() {
            boxes.each(&program.pool, case.guard, &mut |state, holds| {
                if holds != Some(false) && found.len() <= MAX_CLAIMS {
                    found.push((state as u32, (row as u32) << 1 | u32::from(holds == Some(true))));
                }
            });
            if found.len() > MAX_CLAIMS {
                return None;
            }
        }
        let mut starts = vec![0_u32; program.states.count() + 1];
        for (state, _) in &found {
            starts[*state as usize + 1] += 1;
        }
        for state in 1..starts.len() {
            starts[state] += starts[state - 1];
        }
        let mut next = starts.clone();
        let mut claims = vec![0; found.len()];
        // Rows come in order, so those of a state do, too.
        for (state, claim) in found {
            let place = &mut next[state as usize];
            claims[*place as usize] = claim;
            *place += 1;
        }
        Some(Self { starts, claims })
    }

    /// The row that claims a state, by its place in the order of those that do.
    pub(crate) fn row(&self, state: usize, place: usize) -> Option<usize> {
        let (from, to) = (self.starts[state] as usize, self.starts[state + 1] as usize);
        self.claims[from..to].get(place).map(|claim| (claim >> 1) as usize)
    }

    /// The claims on a state, in the order of rows.
    pub(crate) fn of(&self, state: usize) -> impl Iterator<Item = Claim> + '_ {
        let range = self.starts[state] as usize..self.starts[state + 1] as usize;
        self.claims[range].iter().map(|claim| Claim { row: (claim >> 1) as usize, always: claim & 1 == 1 })
    }
}

/// The rows to look at in each state: those that claim it, and those that fetch before they say no.
pub(crate) struct Candidates {
    /// `None` to look at all rows.
    claims: Option<Claims>,
    fetching: Vec<usize>,
    rows: usize,
}

/// The numbers of rows that claim a state, and of those that fetch, that were looked at.
#[derive(Default)]
pub(crate) struct Places {
    claimed: usize,
    fetching: usize,
}

impl Candidates {
    pub(crate) fn new(program: &Program) -> Self {
        let fetches =
            |row: &usize| !program.pool.cond_facts(program.rows[*row].guard).inputs.and(program.fetched).is_empty();
        let rows = program.rows.len();
        Self { claims: Claims::new(program), fetching: (0..rows).filter(fetches).collect(), rows }
    }

    /// The next row of a state.
    pub(crate) fn next(&self, state: usize, places: &mut Places) -> Option<usize> {
        let Some(claims) = &self.claims else {
            places.claimed += 1;
            return (places.claimed <= self.rows).then_some(places.claimed - 1);
        };
        let (claimed, fetching) = (claims.row(state, places.claimed), self.fetching.get(places.fetching).copied());
        let row = claimed.into_iter().chain(fetching).min()?;
        places.claimed += usize::from(claimed == Some(row));
        places.fetching += usize::from(fetching == Some(row));
        Some(row)
    }

    /// The first row that may take a state, with its claim; `None` where the default gives the value.
    #[cfg(feature = "report")]
    pub(crate) fn first(&self, program: &Program, state: usize, levels: &[u8]) -> Option<Claim> {
        let decided = |row: usize| (row, decide(program, &program.pool, program.rows[row].guard, levels));
        let (row, holds) = self.of(state).map(decided).find(|(_, holds)| *holds != Some(false))?;
        Some(Claim { row, always: holds == Some(true) })
    }

    /// The rows of a state, in order.
    pub(crate) fn of(&self, state: usize) -> impl Iterator<Item = usize> + '_ {
        let mut places = Places::default();
        std::iter::from_fn(move || self.next(state, &mut places))
    }
}

/// Goes through the states in which a condition may hold.
pub(crate) struct Boxes<'p> {
    program: &'p Program,
    levels: Vec<u8>,
}

impl<'p> Boxes<'p> {
    pub(crate) fn new(program: &'p Program) -> Self {
        Self { program, levels: vec![0; program.inputs.len()] }
    }

    /// The levels of each input of a state that a condition leaves possible; `None` if it cannot hold.
    fn hull(&self, pool: &Pool, condition: CondId) -> Option<Vec<LevelSet>> {
        let full = || self.program.states.digits().iter().map(|(_, count)| LevelSet::all(*count)).collect::<Vec<_>>();
        match pool.cond(condition) {
            Cond::Const(false) => None,
            Cond::Const(true) | Cond::Compare(..) | Cond::If(..) => Some(full()),
            Cond::Level(input, levels) => {
                let mut hull = full();
                if let Some(place) = self.place(*input) {
                    hull[place].0 &= levels.0;
                    if hull[place].0 == 0 {
                        return None;
                    }
                }
                Some(hull)
            }
            Cond::Not(inner) => {
                let mut hull = full();
                if let Cond::Level(input, levels) = pool.cond(*inner)
                    && let Some(place) = self.place(*input)
                {
                    hull[place].0 &= !levels.0;
                    if hull[place].0 == 0 {
                        return None;
                    }
                }
                Some(hull)
            }
            Cond::And(parts) => {
                let mut hull = full();
                for part in parts {
                    for (all, one) in hull.iter_mut().zip(self.hull(pool, *part)?) {
                        all.0 &= one.0;
                        if all.0 == 0 {
                            return None;
                        }
                    }
                }
                Some(hull)
            }
            Cond::Or(parts) => {
                let mut union: Option<Vec<LevelSet>> = None;
                for hull in parts.iter().filter_map(|part| self.hull(pool, *part)) {
                    match &mut union {
                        None => union = Some(hull),
                        Some(union) => union.iter_mut().zip(hull).for_each(|(all, one)| all.0 |= one.0),
                    }
                }
                union
            }
        }
    }

    fn place(&self, input: InputId) -> Option<usize> {
        self.program.states.digits().iter().position(|(digit, _)| *digit == input)
    }

    /// The number of states that [`Self::each`] would look at.
    pub(crate) fn size(&self, pool: &Pool, condition: CondId) -> usize {
        self.hull(pool, condition).map_or(0, |hull| hull.iter().map(|levels| levels.0.count_ones() as usize).product())
    }

    /// Calls `visit` with every state in which a condition may hold, and with
    /// whether it does: `None` if that depends on other inputs. Some states in
    /// which it does not are visited as well.
    pub(crate) fn each(&mut self, pool: &Pool, condition: CondId, visit: &mut dyn FnMut(usize, Option<bool>)) {
        let Some(hull) = self.hull(pool, condition) else { return };
        let program = self.program;
        let digits = program.states.digits();
        for ((input, _), levels) in digits.iter().zip(&hull) {
            self.levels[input.index()] = levels.0.trailing_zeros() as u8;
        }
        loop {
            let state = program.states.index(|input| self.levels[input.index()]);
            visit(state, decide(program, pool, condition, &self.levels));
            // The next state of the box: the last input varies fastest.
            let mut place = digits.len();
            loop {
                if place == 0 {
                    return;
                }
                place -= 1;
                let (input, _) = digits[place];
                let level = &mut self.levels[input.index()];
                let above = hull[place].0 & !LevelSet::all(usize::from(*level) + 1).0;
                if above != 0 {
                    *level = above.trailing_zeros() as u8;
                    break;
                }
                *level = hull[place].0.trailing_zeros() as u8;
            }
        }
    }
}

/// Decides a condition in a state; `None` if that depends on other inputs.
pub(crate) fn decide(program: &Program, pool: &Pool, condition: CondId, levels: &[u8]) -> Option<bool> {
    match pool.cond(condition) {
        Cond::Const(value) => Some(*value),
        Cond::Level(input, _) if program.fetched.contains(*input) => None,
        Cond::Level(input, set) => Some(set.contains(levels[input.index()])),
        Cond::Compare(..) => None,
        Cond::Not(a) => decide(program, pool, *a, levels).map(|value| !value),
        Cond::And(parts) => junction(program, pool, parts, levels, false),
        Cond::Or(parts) => junction(program, pool, parts, levels, true),
        Cond::If(c, a, b) => match decide(program, pool, *c, levels) {
            Some(true) => decide(program, pool, *a, levels),
            Some(false) => decide(program, pool, *b, levels),
            // Whatever the chooser is, both may say the same.
            None => decide(program, pool, *a, levels).filter(|yes| decide(program, pool, *b, levels) == Some(*yes)),
        },
    }
}

fn junction(program: &Program, pool: &Pool, parts: &[CondId], levels: &[u8], deciding: bool) -> Option<bool> {
    let mut all_known = true;
    for part in parts {
        match decide(program, pool, *part, levels) {
            Some(value) if value == deciding => return Some(deciding),
            Some(_) => {}
            None => all_known = false,
        }
    }
    all_known.then_some(!deciding)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An `if` whose chooser is not known is known where both branches say the same.
    #[test]
    fn branches_that_agree_need_no_chooser() {
        let text = r#"Table(language: 1, name: "agree", hit_policy: First,
            inputs: {"b": Bool(), "x": Range(from: 0, to: 1)}, output: Number(),
            cases: [
                Case(id: 1, when: "if x < 0.5 { b } else { b && x < 2 }", value: 1),
                Case(id: 2, when: "if x < 0.5 { !b } else { b || !b }", value: 2),
            ],
            default: 0)"#;
        let table = crate::table::Table::parse(crate::diag::Source::new("agree.ron", text));
        let program = table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"));
        let candidates = Candidates::new(&program);
        let mut levels = vec![0; program.inputs.len()];
        let mut first = |state: usize| {
            program.states.write(state, &mut levels);
            candidates.first(&program, state, &levels)
        };
        // Without b, case 1 fails on both sides of 0.5 and case 2 holds on both.
        assert_eq!(first(0), Some(Claim { row: 1, always: true }));
        // With b, the two sides of case 1 differ in what they ask.
        assert_eq!(first(1), Some(Claim { row: 0, always: false }));
    }

    #[test]
    fn boxes_find_what_looking_everywhere_finds() {
        for table in ["tables/smsr.ron", "tables/rsmss.ron", "docs/examples/first.ron"] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            let claims = Claims::new(&program).expect("few");
            let mut levels = vec![0; program.inputs.len()];
            for state in 0..program.states.count() {
                program.states.write(state, &mut levels);
                let all = program.rows.iter().enumerate().filter_map(|(row, case)| {
                    let holds = decide(&program, &program.pool, case.guard, &levels);
                    (holds != Some(false)).then_some(Claim { row, always: holds == Some(true) })
                });
                assert!(claims.of(state).eq(all), "{table}, state {state}");
            }
        }
    }
}
