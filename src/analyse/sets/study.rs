//! The start of all analyses of a program: its rows as sets.

use super::Set;
use super::budget::STEPS;
use super::nearby::Nearby;
use super::space::{Space, View};
use crate::program::{Comparison, CondId, Domain, ExprId, InputId, Program};
use crate::table::HitPolicy;

/// A value without selections, and the set where a row gives it.
#[derive(Debug, Clone)]
pub(in crate::analyse) struct Piece {
    /// The row, as an index into [`Program::rows`]; `None` where no row applies.
    pub(in crate::analyse) row: Option<usize>,
    /// The line that gives the value; `None` for the default.
    pub(in crate::analyse) line: Option<usize>,
    /// The set.
    pub(in crate::analyse) set: Set,
    /// The value, one expression per component.
    pub(in crate::analyse) values: Vec<ExprId>,
}

/// The rows of a program, seen through one view.
pub(in crate::analyse) struct Rows {
    /// The set where each row's guard holds.
    pub(in crate::analyse) guards: Vec<Set>,
    /// The set where each row is taken.
    pub(in crate::analyse) taken: Vec<Set>,
    /// The set where no row is taken.
    pub(in crate::analyse) unclaimed: Set,
    /// The values of each row where its guard holds, taken or not.
    pub(in crate::analyse) own: Vec<Vec<Piece>>,
    /// The guards that may hold together.
    pub(in crate::analyse) nearby: Nearby,
}

/// Most earlier rows that are taken away from a row one by one; else all that come before it go together.
const FEW: usize = 8;

impl Rows {
    fn new(space: &mut Space<'_>, view: View) -> Self {
        let program = space.program;
        let guards: Vec<Set> = program.rows.iter().map(|row| space.condition(row.guard, view)).collect();
        let nearby = Nearby::new(&space.sets, &guards).with_numbers(&space.compared());
        let claimed = union(space, &guards);
        let unclaimed = space.sets.not(claimed);
        let mut rows = Rows { taken: taken(space, &guards, &nearby), guards, unclaimed, own: Vec::new(), nearby };
        for (number, row) in program.rows.iter().enumerate() {
            let guard = rows.guards[number];
            let mut pieces = Vec::new();
            let mut rest = guard;
            for (line, written) in row.lines.iter().enumerate() {
                let condition = space.condition(written.condition, view);
                let applies = space.sets.and(rest, condition);
                rest = space.sets.minus(rest, condition);
                split(space, view, applies, (Some(number), Some(line)), &written.values, &mut pieces);
            }
            split(space, view, rest, (Some(number), None), &program.default, &mut pieces);
            rows.own.push(pieces);
        }
        rows
    }

    /// The values of the program, piece by piece.
    pub(in crate::analyse) fn pieces(&self, space: &mut Space<'_>, view: View) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (taken, own) in self.taken.iter().zip(&self.own) {
            for piece in own {
                let set = space.sets.and(*taken, piece.set);
                if !set.is_empty() {
                    pieces.push(Piece { set, ..piece.clone() });
                }
            }
        }
        let default = &space.program.default;
        split(space, view, self.unclaimed, (None, None), default, &mut pieces);
        pieces
    }
}

/// The union of some sets: by halves, as those of neighbouring constants have small ones.
fn union(space: &mut Space<'_>, sets: &[Set]) -> Set {
    match sets {
        [] => Set::EMPTY,
        [one] => *one,
        several => {
            let (first, second) = several.split_at(several.len() / 2);
            let (first, second) = (union(space, first), union(space, second));
            space.sets.or(first, second)
        }
    }
}

/// The set where each row is taken: its guard holds, and that of no earlier row does.
fn taken(space: &mut Space<'_>, guards: &[Set], nearby: &Nearby) -> Vec<Set> {
    // What some rows at the beginning claim together, and their number.
    let (mut before, mut count) = (Set::EMPTY, 0);
    let mut taken = Vec::with_capacity(guards.len());
    for (row, guard) in guards.iter().enumerate() {
        let earlier: Vec<usize> = nearby.of(row).take_while(|other| *other < row).take(FEW + 1).collect();
        if earlier.len() <= FEW {
            let rest = earlier.iter().fold(*guard, |rest, other| space.sets.minus(rest, guards[*other]));
            taken.push(rest);
            continue;
        }
        before = guards[count..row].iter().fold(before, |all, other| space.sets.or(all, *other));
        count = row;
        taken.push(space.sets.minus(*guard, before));
    }
    taken
}

fn split(
    space: &mut Space<'_>,
    view: View,
    within: Set,
    (row, line): (Option<usize>, Option<usize>),
    values: &[ExprId],
    pieces: &mut Vec<Piece>,
) {
    if within.is_empty() {
        return;
    }
    for (set, values) in space.products(values, view) {
        let set = space.sets.and(within, set);
        if !set.is_empty() {
            pieces.push(Piece { row, line, set, values });
        }
    }
}

/// A program with everything that analyses share.
pub(in crate::analyse) struct Study<'p> {
    pub(in crate::analyse) program: &'p Program,
    pub(in crate::analyse) space: Space<'p>,
    pub(in crate::analyse) rows: Rows,
    /// The values of the program, piece by piece, in the order of rows, the default last.
    pub(in crate::analyse) pieces: Vec<Piece>,
    /// The set where all assumptions hold.
    pub(in crate::analyse) assumed: Set,
    /// For each row, the operations that it takes to compute all conditions up to its last line.
    work: Vec<usize>,
}

impl<'p> Study<'p> {
    pub(in crate::analyse) fn new(program: &'p Program) -> Self {
        Self::within(program, STEPS)
    }

    /// The same, with so many steps for this and for each analysis.
    pub(in crate::analyse) fn within(program: &'p Program, steps: u64) -> Self {
        let mut space = Space::new(program);
        space.sets.limit(steps);
        let rows = Rows::new(&mut space, View::PLAIN);
        let pieces = rows.pieces(&mut space, View::PLAIN);
        let assumed = assumed(&mut space, View::PLAIN);
        Self { program, space, rows, pieces, assumed, work: work(program) }
    }

    /// The operations that it takes at most to find out, at a point, that a row is taken; `None` is the default.
    pub(in crate::analyse) fn work_to(&self, row: Option<usize>) -> usize {
        row.map_or(self.work.last(), |row| self.work.get(row)).copied().unwrap_or_default()
    }

    /// The values of a row where it is taken; `None` is the default.
    pub(in crate::analyse) fn pieces_of(&self, row: Option<usize>) -> &[Piece] {
        let place = |row: Option<usize>| row.unwrap_or(usize::MAX);
        let start = self.pieces.partition_point(|piece| place(piece.row) < place(row));
        let count = self.pieces[start..].partition_point(|piece| piece.row == row);
        &self.pieces[start..start + count]
    }

    /// The set where the case of a row counts: where it is taken or, if all that hold count, where it holds.
    pub(in crate::analyse) fn counts(&self, row: usize) -> Set {
        match self.program.hit_policy {
            HitPolicy::First | HitPolicy::Unique => self.rows.taken[row],
            HitPolicy::Collect => self.rows.guards[row],
        }
    }

    /// The later rows whose guards meet that of a row.
    pub(in crate::analyse) fn later(&self, row: usize) -> Vec<usize> {
        let guards = &self.rows.guards;
        let meets = |later: &usize| *later > row && self.space.sets.meets(guards[row], guards[*later]);
        self.rows.nearby.of(row).filter(meets).collect()
    }

    /// The pieces of the program and its assumptions, seen through a view.
    pub(in crate::analyse) fn seen(&mut self, view: View) -> (Vec<Piece>, Set) {
        let rows = Rows::new(&mut self.space, view);
        (rows.pieces(&mut self.space, view), assumed(&mut self.space, view))
    }

    /// The set where an image is an input that can be given: the numbers there are in their ranges.
    pub(in crate::analyse) fn inside(&mut self, image: &[(InputId, ExprId)]) -> Set {
        let program = self.program;
        image.iter().fold(Set::ALL, |all, (input, number)| match program.inputs[input.index()].domain {
            Domain::Discrete(_) | Domain::Word => all,
            Domain::Continuous { lo, hi, .. } => {
                let pool = &mut self.space.pool;
                let [lo, hi] = [lo, hi].map(|bound| pool.number(bound));
                let sides = [(lo, *number), (*number, hi)];
                let sides = sides.map(|(low, high)| pool.compare(Comparison::LessEqual, low, high));
                sides.into_iter().fold(all, |all, side| {
                    let side = self.space.condition(side, View::PLAIN);
                    self.space.sets.and(all, side)
                })
            }
        })
    }

    /// A few assumptions without which something could reach a set that nothing
    /// reaches where all hold: those that it takes to rule the set out.
    pub(in crate::analyse) fn blame(&mut self, set: Set) -> Vec<&'p str> {
        let program = self.program;
        let mut needed: Vec<usize> = (0..program.assumptions.len()).collect();
        for candidate in 0..program.assumptions.len() {
            let without: Vec<usize> = needed.iter().copied().filter(|other| *other != candidate).collect();
            let mut rest = set;
            for assumption in &without {
                let holds = self.space.condition(program.assumptions[*assumption].condition, View::PLAIN);
                rest = self.space.sets.and(rest, holds);
            }
            if self.space.is_void(rest) {
                needed = without;
            }
        }
        needed.into_iter().map(|assumption| program.assumptions[assumption].name.as_str()).collect()
    }
}

/// For each row, the operations of all conditions up to its last line, assumptions among them.
fn work(program: &Program) -> Vec<usize> {
    let of = |condition: CondId| program.pool.cond_facts(condition).size as usize;
    let assumed: usize = program.assumptions.iter().map(|assumption| of(assumption.condition)).sum();
    let rows = program.rows.iter().scan(assumed, |all, row| {
        *all += of(row.guard) + row.lines.iter().map(|line| of(line.condition)).sum::<usize>();
        Some(*all)
    });
    rows.collect()
}

/// The set where all assumptions hold.
pub(in crate::analyse) fn assumed(space: &mut Space<'_>, view: View) -> Set {
    let program = space.program;
    program.assumptions.iter().fold(Set::ALL, |set, assumption| {
        let holds = space.condition(assumption.condition, view);
        space.sets.and(set, holds)
    })
}
