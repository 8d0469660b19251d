//! Integers of any range, as finitely many classes.
//!
//! A table compares such an input with constants and takes remainders by constants, so it cannot
//! tell all integers apart: those between two constants with the same remainder are one class. The
//! classes are the levels of the input, and everything that is said of levels holds of them.
//! Integers of few values are the case in which each is a class by itself.

use std::collections::BTreeSet;

use super::bits::LevelSet;
use super::rational::gcd;

/// The ways in which a table tells the integers of an input apart.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Cuts {
    /// Integers that begin something new.
    pub(super) starts: BTreeSet<i64>,
    /// Divisors of remainders.
    pub(super) moduli: BTreeSet<i64>,
}

/// The integers of an input, cut into classes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Classes {
    /// The first integer of each interval; of the first one, the smallest of all.
    starts: Vec<i64>,
    /// The largest integer.
    last: i64,
    /// Integers of an interval are of one class if they leave the same by this.
    modulus: i64,
}

/// Integers in a row whose classes follow from a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Piece {
    /// The first integer.
    pub first: i64,
    /// The last integer.
    pub last: i64,
    /// The class of the first integer, or that of those which leave nothing.
    pub base: usize,
    /// The divisor; `None` where each integer is a class.
    pub modulus: Option<i64>,
}

impl Classes {
    /// Each integer is a class; they are few.
    pub(super) fn each(first: i64, last: i64) -> Self {
        Self { starts: (first..=last).collect(), last, modulus: 1 }
    }

    /// The classes that cuts make, or their number, if there are too many.
    pub(super) fn new(first: i64, last: i64, cuts: &Cuts, most: usize) -> Result<Self, i64> {
        let inside = cuts.starts.iter().copied().filter(|start| (first + 1..=last).contains(start));
        let starts: Vec<i64> = [first].into_iter().chain(inside).collect();
        let modulus = cuts.moduli.iter().fold(1_i64, |all, modulus| {
            let common = gcd(u128::from(all.unsigned_abs()), u128::from(modulus.unsigned_abs()));
            (all / common as i64).saturating_mul(*modulus)
        });
        let classes = Self { starts, last, modulus };
        let count = (0..classes.starts.len()).fold(0_i64, |all, place| all.saturating_add(classes.size(place)));
        // One class would be no choice: an input has two levels at least.
        match count {
            1 => Ok(Self { starts: vec![first, first + 1], ..classes }),
            count if count > most as i64 => Err(count),
            _ => Ok(classes),
        }
    }

    /// The smallest and the largest integer.
    pub fn range(&self) -> (i64, i64) {
        (self.starts[0], self.last)
    }

    /// The integers at which something new begins, and the divisor.
    pub(super) fn cuts(&self) -> (Vec<i64>, i64) {
        (self.starts.clone(), self.modulus)
    }

    /// Returns whether each integer is a class by itself.
    pub fn is_each(&self) -> bool {
        self.count() as i64 == self.last - self.starts[0] + 1
    }

    /// The number of classes.
    pub fn count(&self) -> usize {
        (0..self.starts.len()).map(|place| self.size(place) as usize).sum()
    }

    /// The last integer of an interval.
    fn end(&self, place: usize) -> i64 {
        self.starts.get(place + 1).map_or(self.last, |next| next - 1)
    }

    /// The number of classes of an interval.
    fn size(&self, place: usize) -> i64 {
        (self.end(place) - self.starts[place] + 1).min(self.modulus)
    }

    /// Returns whether each integer of an interval is a class.
    fn is_listed(&self, place: usize) -> bool {
        self.size(place) == self.end(place) - self.starts[place] + 1
    }

    /// The class of an integer.
    pub fn find(&self, integer: i64) -> Option<u8> {
        if !(self.starts[0]..=self.last).contains(&integer) {
            return None;
        }
        let place = self.starts.partition_point(|start| *start <= integer) - 1;
        let base: i64 = (0..place).map(|before| self.size(before)).sum();
        let within = match self.is_listed(place) {
            true => integer - self.starts[place],
            false => integer.rem_euclid(self.modulus),
        };
        u8::try_from(base + within).ok()
    }

    /// The smallest integer of each class.
    pub fn members(&self) -> Vec<i64> {
        let mut members = Vec::new();
        for place in 0..self.starts.len() {
            let start = self.starts[place];
            members.extend((0..self.size(place)).map(|class| match self.is_listed(place) {
                true => start + class,
                false => start + (class - start).rem_euclid(self.modulus),
            }));
        }
        members
    }

    /// Names of the classes, as words: `3`, `even_from_2`, `1_mod_3_to_minus_4`, `from_5`.
    pub(super) fn names(&self) -> Vec<String> {
        let word = |integer: i64| integer.to_string().replace('-', "minus_");
        let mut names = Vec::new();
        for place in 0..self.starts.len() {
            let (start, end) = (self.starts[place], self.end(place));
            let range = match (place, place + 1 == self.starts.len()) {
                (0, true) => "any".to_owned(),
                (0, false) => format!("to_{}", word(end)),
                (_, true) => format!("from_{}", word(start)),
                (_, false) => format!("{}_to_{}", word(start), word(end)),
            };
            if self.is_listed(place) {
                names.extend((start..=end).map(word));
            } else if self.modulus == 1 {
                names.push(range);
            } else {
                names.extend((0..self.modulus).map(|rest| match (self.modulus, rest) {
                    (2, 0) => format!("even_{range}"),
                    (2, _) => format!("odd_{range}"),
                    (modulus, rest) => format!("{rest}_mod_{modulus}_{range}"),
                }));
            }
        }
        names
    }

    /// The classes as code computes them, smallest integers first.
    pub fn pieces(&self) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::new();
        let mut base = 0;
        for place in 0..self.starts.len() {
            let (first, last, size) = (self.starts[place], self.end(place), self.size(place));
            let each = self.is_listed(place);
            match pieces.last_mut() {
                Some(before) if each && before.modulus.is_none() => before.last = last,
                _ => pieces.push(Piece { first, last, base, modulus: (!each).then_some(self.modulus) }),
            }
            base += size as usize;
        }
        pieces
    }

    /// Some classes as a condition of the table language on an input, and how strongly its parts are bound: 1 if
    /// there are several, 2 if there is one of several conditions, 3 if there is one.
    pub(super) fn condition(&self, name: &str, levels: LevelSet) -> (String, u8) {
        // Intervals of which the same remainders are asked for go together.
        let mut runs: Vec<(i64, i64, Vec<i64>)> = Vec::new();
        let mut class = 0;
        for place in 0..self.starts.len() {
            let (first, last, size) = (self.starts[place], self.end(place), self.size(place));
            let own: Vec<u8> = (class..class + size as u8).filter(|class| levels.contains(*class)).collect();
            let all = own.len() == size as usize;
            let rests: Vec<i64> = if all { Vec::new() } else { own.iter().map(|c| i64::from(c - class)).collect() };
            class += size as u8;
            if own.is_empty() {
                continue;
            }
            if !all && self.is_listed(place) {
                runs.extend(rests.iter().map(|rest| (first + rest, first + rest, Vec::new())));
                continue;
            }
            match runs.last_mut() {
                Some(before) if before.1 + 1 == first && before.2 == rests => before.1 = last,
                _ => runs.push((first, last, rests)),
            }
        }
        let (least, most) = self.range();
        let parts: Vec<(String, u8)> = runs
            .into_iter()
            .map(|(first, last, rests)| {
                let mut parts = Vec::new();
                match (first == least, last == most) {
                    _ if first == last => parts.push(format!("{name} == {first}")),
                    (first_of_all, last_of_all) => {
                        if !first_of_all {
                            parts.push(format!("{name} >= {first}"));
                        }
                        if !last_of_all {
                            parts.push(format!("{name} <= {last}"));
                        }
                    }
                }
                if !rests.is_empty() {
                    let mut signed: Vec<String> = Vec::new();
                    for rest in rests {
                        if last >= 0 || rest == 0 {
                            signed.push(rest.to_string());
                        }
                        if first < 0 && rest != 0 {
                            signed.push((rest - self.modulus).to_string());
                        }
                    }
                    parts.push(match signed.as_slice() {
                        [one] => format!("{name} % {} == {one}", self.modulus),
                        several => format!("{name} % {} in {{{}}}", self.modulus, several.join(", ")),
                    });
                }
                match parts.len() {
                    0 => ("true".to_owned(), 3),
                    1 => (parts.concat(), 3),
                    _ => (parts.join(" && "), 2),
                }
            })
            .collect();
        match parts.as_slice() {
            [] => ("false".to_owned(), 3),
            [one] => one.clone(),
            several => (several.iter().map(|(part, _)| part.as_str()).collect::<Vec<_>>().join(" || "), 1),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn classes(first: i64, last: i64, starts: &[i64], moduli: &[i64]) -> Classes {
        let cuts = Cuts { starts: starts.iter().copied().collect(), moduli: moduli.iter().copied().collect() };
        Classes::new(first, last, &cuts, 64).expect("few")
    }

    #[test]
    fn every_integer_is_of_the_class_of_its_member() {
        for (first, last, starts, moduli) in [
            (0, i64::from(i32::MAX), vec![1, 2], vec![2]),
            (-100, 100, vec![-3, 0, 7, 8, 50], vec![3]),
            (-20, 90, vec![], vec![4, 6]),
            (5, 400, vec![100], vec![]),
        ] {
            let classes = classes(first, last, &starts, &moduli);
            let (members, names) = (classes.members(), classes.names());
            assert_eq!((members.len(), names.len()), (classes.count(), classes.count()));
            for (class, member) in members.iter().enumerate() {
                assert_eq!(classes.find(*member), Some(class as u8), "{member}");
            }
            for integer in (first..=last).take(500) {
                let class = classes.find(integer).expect("inside");
                let member = members[usize::from(class)];
                assert!(member <= integer);
                // No cut lies between, and no remainder tells them apart.
                assert!(!starts.iter().any(|start| member < *start && *start <= integer));
                assert!(moduli.iter().all(|modulus| (integer - member) % modulus == 0));
            }
            assert_eq!((classes.find(first - 1), classes.find(last + 1)), (None, None));
        }
    }

    #[test]
    fn classes_have_names_and_conditions() {
        let naturals = classes(0, i64::from(i32::MAX), &[1, 2], &[2]);
        assert_eq!(naturals.names(), ["0", "1", "even_from_2", "odd_from_2"]);
        let said = |levels| naturals.condition("k", LevelSet(levels)).0;
        assert_eq!(said(0b0100), "k >= 2 && k % 2 == 0");
        assert_eq!(said(0b1100), "k >= 2");
        assert_eq!(said(0b0011), "k <= 1");
        assert_eq!(said(0b1001), "k == 0 || k >= 2 && k % 2 == 1");
        let signed = classes(-100, 100, &[0], &[3]);
        let said = |levels| signed.condition("k", LevelSet(levels)).0;
        assert_eq!(said(0b000010), "k <= -1 && k % 3 == -2");
        assert_eq!(said(0b010010), "k % 3 in {1, -2}");
        assert_eq!(said(0b111111), "true");
    }

    #[test]
    fn pieces_have_the_classes_of_their_integers() {
        let classes = classes(-100, 100, &[-3, -2, -1, 7, 50], &[3]);
        for piece in classes.pieces() {
            for integer in piece.first..=piece.last {
                let within = match piece.modulus {
                    None => integer - piece.first,
                    Some(modulus) => integer.rem_euclid(modulus),
                };
                assert_eq!(classes.find(integer), Some((piece.base as i64 + within) as u8), "{integer}");
            }
        }
        let few = Cuts { starts: (0..100).collect(), moduli: BTreeSet::new() };
        assert_eq!(Classes::new(0, 1000, &few, 64), Err(100));
    }
}
