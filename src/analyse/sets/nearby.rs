//! Finds the rows that may hold together with a row, without trying every pair.
//!
//! A guard lies in a box, the levels of each digit that something in it has.
//! Rows whose boxes are apart never meet, and that is found for all rows at
//! once, a word of them at a time: ten thousand rows are ten thousand short
//! passes instead of fifty million looks.

use super::{Map, Set, Sets};
use crate::program::LevelSet;
use crate::program::region::Sign;

/// The boxes of all guards.
pub(in crate::analyse) struct Nearby {
    /// For each row, the digits of which not all levels occur; `None` if its guard never holds.
    hulls: Vec<Option<Vec<(usize, LevelSet)>>>,
    /// For each digit and level, the rows in whose boxes it is, as bits.
    rows: Vec<Vec<Vec<u64>>>,
    /// The rows that hold somewhere, as bits.
    all: Vec<u64>,
    /// Numbers that are compared with constants.
    numbers: Vec<Compared>,
}

/// A number that is compared with constants, and what guards leave of it.
struct Compared {
    /// For each row, the first and the last part of the number that its guard leaves.
    spans: Vec<(usize, usize)>,
    /// For each part, the rows whose guards leave it, as bits.
    rows: Vec<Vec<u64>>,
}

/// Most parts that a number is divided into here.
const MAX_PARTS: usize = 2048;

impl Nearby {
    pub(in crate::analyse) fn new(sets: &Sets, guards: &[Set]) -> Self {
        let hulls: Vec<_> = guards.iter().map(|guard| (!guard.is_empty()).then(|| sets.hull(*guard))).collect();
        let mut all = vec![0; guards.len().div_ceil(64)];
        let holding = hulls.iter().enumerate().filter(|(_, hull)| hull.is_some());
        holding.for_each(|(row, _)| all[row / 64] |= 1 << (row % 64));
        // Every row is in all levels of a digit until its box says otherwise.
        let tested = hulls.iter().flatten().flatten().map(|(digit, _)| digit + 1).max().unwrap_or(0);
        let mut rows: Vec<Vec<Vec<u64>>> = (0..tested).map(|digit| vec![all.clone(); sets.levels(digit)]).collect();
        for (row, hull) in hulls.iter().enumerate() {
            for (digit, levels) in hull.iter().flatten() {
                let outside = LevelSet(LevelSet::all(sets.levels(*digit)).0 & !levels.0);
                outside.iter().for_each(|level| rows[*digit][usize::from(level)][row / 64] &= !(1 << (row % 64)));
            }
        }
        Self { hulls, rows, all, numbers: Vec::new() }
    }

    /// The same, with what guards leave of numbers. `compared` gives, for each number, the digits that are
    /// the signs of its differences from constants, with the constants ascending.
    pub(super) fn with_numbers(mut self, compared: &[Vec<usize>]) -> Self {
        for digits in compared {
            // Between two constants, at one, and so on, from the lowest up; a few of them together.
            let parts = 2 * digits.len() + 1;
            let together = parts.div_ceil(MAX_PARTS);
            let places: Map<usize, usize> =
                digits.iter().enumerate().map(|(place, digit)| (*digit, 2 * place + 1)).collect();
            let span = |hull: &[(usize, LevelSet)]| {
                hull.iter().fold((0, parts - 1), |(from, to), (digit, signs)| {
                    let Some(at) = places.get(digit) else { return (from, to) };
                    let part = |sign: u8| match Sign::ALL[usize::from(sign)] {
                        Sign::Positive => (at + 1, parts - 1),
                        Sign::Zero => (*at, *at),
                        Sign::Negative => (0, at - 1),
                    };
                    let (low, high) = signs.iter().map(part).fold((parts, 0), |(a, b), (c, d)| (a.min(c), b.max(d)));
                    (from.max(low), to.min(high))
                })
            };
            let spans = self.hulls.iter().map(|hull| {
                let (from, to) = span(hull.as_deref().unwrap_or_default());
                (from / together, to / together)
            });
            let spans: Vec<(usize, usize)> = spans.collect();
            let mut rows = vec![vec![0; self.all.len()]; parts.div_ceil(together)];
            for (row, (from, to)) in spans.iter().enumerate() {
                (*from..=*to).for_each(|part| rows[part][row / 64] |= 1 << (row % 64));
            }
            self.numbers.push(Compared { spans, rows });
        }
        self
    }

    /// The rows whose boxes meet that of a row, itself included, in ascending order.
    pub(in crate::analyse) fn of(&self, row: usize) -> impl Iterator<Item = usize> + '_ {
        let hull = self.hulls[row].as_deref();
        let word = move |place: usize| {
            let in_digit = |(digit, levels): &(usize, LevelSet)| {
                levels.iter().fold(0, |rows, level| rows | self.rows[*digit][usize::from(level)][place])
            };
            let boxes =
                hull.map_or(0, |hull| hull.iter().fold(self.all[place], |rows, levels| rows & in_digit(levels)));
            self.numbers.iter().fold(boxes, |rows, number| match rows {
                0 => 0,
                _ => {
                    let (from, to) = number.spans[row];
                    rows & (from..=to).fold(0, |all, part| all | number.rows[part][place])
                }
            })
        };
        let words = (0..self.all.len()).map(move |place| (place, word(place))).filter(|(_, word)| *word != 0);
        // The rows of a word are its bits, as the levels of a set are.
        words.flat_map(|(place, word)| LevelSet(word).iter().map(move |bit| 64 * place + usize::from(bit)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::space::View;
    use super::super::study::Study;
    use super::*;
    use crate::program::Program;

    #[test]
    fn no_row_that_meets_another_is_missed() {
        for table in ["tables/smsr.ron", "tables/rsmss.ron", "docs/examples/first.ron"] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            let mut study = Study::new(&program);
            let guards: Vec<Set> =
                program.rows.iter().map(|row| study.space.condition(row.guard, View::PLAIN)).collect();
            let nearby = Nearby::new(&study.space.sets, &guards);
            for (row, guard) in guards.iter().enumerate() {
                let near: Vec<usize> = nearby.of(row).collect();
                let meeting = (0..guards.len()).filter(|other| study.space.sets.meets(*guard, guards[*other]));
                assert!(meeting.clone().all(|other| near.contains(&other)), "{table}, row {row}: {near:?}");
            }
        }
    }

    #[test]
    fn rows_without_a_guard_are_near_all_but_those_that_never_hold() {
        let mut sets = Sets::new();
        sets.digit(2);
        assert!(Nearby::new(&sets, &[Set::ALL, Set::EMPTY, Set::ALL]).of(0).eq([0, 2]));
        let some = sets.atom(0, LevelSet(1));
        let nearby = Nearby::new(&sets, &[some, Set::EMPTY, Set::ALL]);
        assert!(nearby.of(2).eq([0, 2]) && nearby.of(1).next().is_none());
    }
}
