//! Sets of combinations of levels, as decision diagrams.
//!
//! A digit has a few levels; a set is a subset of the product of all digits.
//! Equal sets are one node, so comparing them is comparing numbers, and a set
//! that is simple to describe is small, whatever the product is. The digits
//! are tested in ascending order; a digit that does not matter is not tested.

pub(crate) mod budget;
pub(crate) mod nearby;
pub(crate) mod space;
pub(crate) mod study;

use std::collections::{HashMap, HashSet};
use std::hash::{BuildHasherDefault, Hasher};

use crate::program::LevelSet;
use budget::Budget;

/// A set in a [`Sets`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Set(u32);

impl Set {
    /// The set of nothing.
    pub(super) const EMPTY: Set = Set(0);
    /// The set of everything.
    pub(super) const ALL: Set = Set(1);

    pub(super) fn is_empty(self) -> bool {
        self == Set::EMPTY
    }
}

/// Most nodes; a set that would need more is given up.
const MAX_NODES: usize = 4_000_000;

/// The digit of the two sets that test nothing, after all others.
const END: u32 = u32::MAX;

/// Owns sets.
pub(super) struct Sets {
    /// Digit, and where the children stand.
    nodes: Vec<(u32, u32)>,
    children: Vec<Set>,
    /// Number of levels by digit.
    levels: Vec<usize>,
    /// Open addressing: numbers of nodes, 0 for a free place.
    index: Vec<u32>,
    memo: Map<(Operation, Set, Set), Set>,
    full: bool,
    /// The work that the analysis that asks may still do.
    budget: Budget,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Operation {
    And,
    Or,
    Minus,
}

/// A map that is asked often, with small keys.
pub(super) type Map<K, V> = HashMap<K, V, BuildHasherDefault<Mixer>>;

/// A hasher for a few small numbers.
#[derive(Default)]
pub(super) struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 29
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.write_u64(u64::from(*byte)));
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(u64::from(number));
    }

    fn write_u64(&mut self, number: u64) {
        self.0 = (self.0.rotate_left(23) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }

    fn write_isize(&mut self, number: isize) {
        self.write_u64(number as u64);
    }
}

impl Sets {
    pub(super) fn new() -> Self {
        Self {
            nodes: vec![(END, 0); 2],
            children: Vec::new(),
            levels: Vec::new(),
            index: vec![0; 1 << 10],
            memo: Map::default(),
            full: false,
            budget: Budget::new(budget::STEPS),
        }
    }

    /// A further digit with a number of levels, after all others.
    pub(super) fn digit(&mut self, levels: usize) -> usize {
        self.levels.push(levels);
        self.levels.len() - 1
    }

    /// The number of levels of a digit.
    pub(super) fn levels(&self, digit: usize) -> usize {
        self.levels[digit]
    }

    /// Returns whether sets were given up for their size. Then no answer is worth anything.
    pub(super) fn is_full(&self) -> bool {
        self.full
    }

    /// Lets each analysis take so many steps.
    pub(super) fn limit(&mut self, steps: u64) {
        self.budget = Budget::new(steps);
    }

    /// The work that may still be done.
    pub(super) fn budget(&self) -> &Budget {
        &self.budget
    }

    /// The digit that a set tests first, and the rest of the set for each of its levels.
    pub(super) fn test(&self, set: Set) -> Option<(usize, &[Set])> {
        let (digit, start) = self.nodes[set.0 as usize];
        let digit = (digit != END).then_some(digit as usize)?;
        Some((digit, &self.children[start as usize..][..self.levels[digit]]))
    }

    fn first(&self, set: Set) -> u32 {
        self.nodes[set.0 as usize].0
    }

    fn child(&self, set: Set, digit: u32, level: usize) -> Set {
        match self.nodes[set.0 as usize] {
            (own, start) if own == digit => self.children[start as usize + level],
            _ => set,
        }
    }

    /// The set that tests `digit` and goes on with one of `children`.
    pub(super) fn node(&mut self, digit: usize, children: &[Set]) -> Set {
        if children.iter().all(|child| *child == children[0]) {
            return children[0];
        }
        if self.nodes.len() >= MAX_NODES {
            self.full = true;
            return Set::EMPTY;
        }
        if self.nodes.len() * 2 > self.index.len() {
            self.grow();
        }
        let mut place = self.place(digit as u32, children);
        loop {
            match self.index[place] {
                0 => break,
                known => {
                    let (own, start) = self.nodes[known as usize];
                    if own == digit as u32 && self.children[start as usize..][..children.len()] == *children {
                        return Set(known);
                    }
                }
            }
            place = (place + 1) & (self.index.len() - 1);
        }
        let number = self.nodes.len() as u32;
        self.nodes.push((digit as u32, self.children.len() as u32));
        self.children.extend_from_slice(children);
        self.index[place] = number;
        Set(number)
    }

    fn place(&self, digit: u32, children: &[Set]) -> usize {
        let mut mixer = Mixer::default();
        mixer.write_u32(digit);
        children.iter().for_each(|child| mixer.write_u32(child.0));
        mixer.finish() as usize & (self.index.len() - 1)
    }

    fn grow(&mut self) {
        self.index = vec![0; self.index.len() * 2];
        for number in 2..self.nodes.len() {
            let (digit, start) = self.nodes[number];
            let count = self.levels[digit as usize];
            let mut place = self.place(digit, &self.children[start as usize..][..count]);
            while self.index[place] != 0 {
                place = (place + 1) & (self.index.len() - 1);
            }
            self.index[place] = number as u32;
        }
    }

    /// The set where a digit has one of some levels.
    pub(super) fn atom(&mut self, digit: usize, levels: LevelSet) -> Set {
        let child = |level: usize| if levels.contains(level as u8) { Set::ALL } else { Set::EMPTY };
        let children: Vec<Set> = (0..self.levels[digit]).map(child).collect();
        self.node(digit, &children)
    }

    pub(super) fn and(&mut self, a: Set, b: Set) -> Set {
        self.apply(Operation::And, a.min(b), a.max(b))
    }

    pub(super) fn or(&mut self, a: Set, b: Set) -> Set {
        self.apply(Operation::Or, a.min(b), a.max(b))
    }

    /// The part of `a` that is not in `b`.
    pub(super) fn minus(&mut self, a: Set, b: Set) -> Set {
        self.apply(Operation::Minus, a, b)
    }

    pub(super) fn not(&mut self, a: Set) -> Set {
        self.minus(Set::ALL, a)
    }

    fn apply(&mut self, operation: Operation, a: Set, b: Set) -> Set {
        if !self.budget.spend(1) {
            return Set::EMPTY;
        }
        let decided = match (operation, a, b) {
            (Operation::And, Set::EMPTY, _) | (Operation::And, _, Set::EMPTY) => Some(Set::EMPTY),
            (Operation::And, Set::ALL, other) | (Operation::And, other, Set::ALL) => Some(other),
            (Operation::Or, Set::ALL, _) | (Operation::Or, _, Set::ALL) => Some(Set::ALL),
            (Operation::Or, Set::EMPTY, other) | (Operation::Or, other, Set::EMPTY) => Some(other),
            (Operation::Minus, Set::EMPTY, _) | (Operation::Minus, _, Set::ALL) => Some(Set::EMPTY),
            (Operation::Minus, _, Set::EMPTY) => Some(a),
            (Operation::And | Operation::Or, ..) if a == b => Some(a),
            (Operation::Minus, ..) if a == b => Some(Set::EMPTY),
            _ => None,
        };
        if let Some(decided) = decided {
            return decided;
        }
        if let Some(known) = self.memo.get(&(operation, a, b)) {
            return *known;
        }
        let digit = self.first(a).min(self.first(b));
        let mut children = [Set::EMPTY; crate::program::MAX_LEVELS];
        let count = self.levels[digit as usize];
        for (level, child) in children[..count].iter_mut().enumerate() {
            let (a, b) = (self.child(a, digit, level), self.child(b, digit, level));
            *child = match operation {
                Operation::And | Operation::Or => self.apply(operation, a.min(b), a.max(b)),
                Operation::Minus => self.apply(operation, a, b),
            };
        }
        let result = self.node(digit as usize, &children[..count]);
        if !self.budget.is_spent() {
            self.memo.insert((operation, a, b), result);
        }
        result
    }

    /// Returns whether all of `a` is in `b`.
    pub(super) fn within(&mut self, a: Set, b: Set) -> bool {
        self.minus(a, b).is_empty()
    }

    /// Returns whether some combination is in both.
    pub(super) fn meets(&self, a: Set, b: Set) -> bool {
        match (a, b) {
            (Set::EMPTY, _) | (_, Set::EMPTY) => return false,
            (Set::ALL, _) | (_, Set::ALL) => return true,
            _ if !self.budget.spend(1) => return false,
            _ => {}
        }
        let digit = self.first(a).min(self.first(b));
        let levels = 0..self.levels[digit as usize];
        let own = |level| (self.child(a, digit, level), self.child(b, digit, level));
        let mut last = None;
        // Levels that lead to the same are asked once; most sets have few different ones.
        levels.map(own).any(|pair| last.replace(pair) != Some(pair) && self.meets(pair.0, pair.1))
    }

    /// The set of the digits before `end` that leave something of a set.
    pub(super) fn shadow(&mut self, set: Set, end: usize) -> Set {
        self.shadow_memo(set, end, &mut Map::default())
    }

    fn shadow_memo(&mut self, set: Set, end: usize, memo: &mut Map<Set, Set>) -> Set {
        match self.test(set) {
            None => return set,
            Some((digit, _)) if digit >= end => return Set::ALL,
            Some(_) => {}
        }
        if let Some(known) = memo.get(&set) {
            return *known;
        }
        let (digit, children) = self.test(set).map(|(digit, children)| (digit, children.to_vec())).unwrap_or_default();
        let children: Vec<Set> = children.into_iter().map(|child| self.shadow_memo(child, end, memo)).collect();
        let result = self.node(digit, &children);
        memo.insert(set, result);
        result
    }

    /// A set as it is where a digit has a level; the digit does not matter any more.
    pub(super) fn fix(&mut self, set: Set, digit: usize, level: usize) -> Set {
        self.fix_memo(set, digit, level, &mut Map::default())
    }

    fn fix_memo(&mut self, set: Set, digit: usize, level: usize, memo: &mut Map<Set, Set>) -> Set {
        let (tested, children) = match self.test(set) {
            Some((tested, children)) if tested == digit => return children[level],
            Some((tested, children)) if tested < digit => (tested, children.to_vec()),
            _ => return set,
        };
        if let Some(known) = memo.get(&set) {
            return *known;
        }
        let children: Vec<Set> = children.into_iter().map(|child| self.fix_memo(child, digit, level, memo)).collect();
        let result = self.node(tested, &children);
        memo.insert(set, result);
        result
    }

    /// The number of combinations of the digits before `end` in a set that tests no others.
    pub(super) fn count(&self, set: Set, end: usize) -> f64 {
        let all: f64 = self.levels[..end].iter().map(|count| *count as f64).product();
        all * self.share(set, &mut Map::default())
    }

    fn share(&self, set: Set, memo: &mut Map<Set, f64>) -> f64 {
        let Some((_, children)) = self.test(set) else {
            return if set.is_empty() { 0.0 } else { 1.0 };
        };
        if let Some(known) = memo.get(&set) {
            return *known;
        }
        let sum: f64 = children.iter().map(|child| self.share(*child, memo)).sum();
        let share = sum / children.len() as f64;
        memo.insert(set, share);
        share
    }

    /// One combination of a set that is not empty: the digits that matter, with their levels.
    pub(super) fn pick(&self, set: Set) -> Vec<(usize, u8)> {
        let mut found = Vec::new();
        let mut rest = set;
        while let Some((digit, children)) = self.test(rest) {
            let Some(level) = children.iter().position(|child| !child.is_empty()) else { break };
            found.push((digit, level as u8));
            rest = children[level];
        }
        found
    }

    /// The set as a union of few patterns, each some levels of some digits; at
    /// most `most` of them. A pattern is as wide as it can be, so patterns may
    /// overlap.
    pub(super) fn patterns(&mut self, set: Set, most: usize) -> Vec<Vec<(usize, LevelSet)>> {
        let mut found = Vec::new();
        let mut rest = set;
        while !rest.is_empty() && found.len() < most {
            let mut pattern: Vec<(usize, LevelSet)> =
                self.pick(rest).into_iter().map(|(digit, level)| (digit, LevelSet::one(level))).collect();
            for place in 0..pattern.len() {
                for level in 0..self.levels[pattern[place].0] as u8 {
                    let old = pattern[place].1;
                    if old.contains(level) {
                        continue;
                    }
                    pattern[place].1 = LevelSet(old.0 | LevelSet::one(level).0);
                    if !self.covers(set, &pattern) {
                        pattern[place].1 = old;
                    }
                }
            }
            let levels = &self.levels;
            pattern.retain(|(digit, some)| *some != LevelSet::all(levels[*digit]));
            let covered = self.pattern(&pattern);
            rest = self.minus(rest, covered);
            found.push(pattern);
        }
        found
    }

    /// The levels of each digit that something in the set has, for the digits of which not all occur.
    pub(super) fn hull(&self, set: Set) -> Vec<(usize, LevelSet)> {
        let mut hull: Vec<LevelSet> = self.levels.iter().map(|_| LevelSet(0)).collect();
        let mut seen = HashSet::from([set]);
        // Digits that are not tested on the way from one node to the next can have any level.
        let mut open = vec![(0, set)];
        while let Some((from, set)) = open.pop() {
            let test = self.test(set);
            let to = test.map_or(self.levels.len(), |(digit, _)| digit);
            (from..to).for_each(|digit| hull[digit] = LevelSet::all(self.levels[digit]));
            let Some((digit, children)) = test else { continue };
            for (level, child) in children.iter().enumerate().filter(|(_, child)| !child.is_empty()) {
                hull[digit].0 |= LevelSet::one(level as u8).0;
                // What follows is looked at once, what lies between every time.
                let next = self.test(*child).map_or(self.levels.len(), |(digit, _)| digit);
                match seen.insert(*child) {
                    true => open.push((digit + 1, *child)),
                    false => (digit + 1..next).for_each(|digit| hull[digit] = LevelSet::all(self.levels[digit])),
                }
            }
        }
        let some = |(digit, levels): &(usize, LevelSet)| *levels != LevelSet::all(self.levels[*digit]);
        hull.into_iter().enumerate().filter(some).collect()
    }

    /// The set as some levels of each of some digits, if it is nothing else.
    pub(super) fn as_pattern(&self, set: Set) -> Option<Vec<(usize, LevelSet)>> {
        let mut pattern = Vec::new();
        let mut rest = set;
        while let Some((digit, children)) = self.test(rest) {
            let mut ways = children.iter().filter(|child| !child.is_empty());
            rest = *ways.next()?;
            if ways.any(|child| *child != rest) {
                return None;
            }
            let open = children.iter().enumerate().filter(|(_, child)| !child.is_empty());
            pattern.push((digit, LevelSet(open.fold(0, |all, (level, _)| all | LevelSet::one(level as u8).0))));
        }
        (!rest.is_empty()).then_some(pattern)
    }

    /// Returns whether a set has everything where each of some digits, in ascending order, has one of some levels.
    fn covers(&self, set: Set, pattern: &[(usize, LevelSet)]) -> bool {
        let mut seen: HashSet<Set, BuildHasherDefault<Mixer>> = [set].into_iter().collect();
        let mut open = vec![set];
        while let Some(set) = open.pop() {
            if set.is_empty() || !self.budget.spend(1) {
                return false;
            }
            let Some((digit, children)) = self.test(set) else { continue };
            let place = pattern.binary_search_by_key(&digit, |(digit, _)| *digit);
            let levels = place.map_or(LevelSet::all(children.len()), |place| pattern[place].1);
            let next = levels.iter().map(|level| children[usize::from(level)]);
            open.extend(next.filter(|child| seen.insert(*child)));
        }
        true
    }

    /// The set where each of some digits has one of some levels.
    pub(super) fn pattern(&mut self, pattern: &[(usize, LevelSet)]) -> Set {
        let mut pattern = pattern.to_vec();
        pattern.sort_unstable_by_key(|(digit, _)| *digit);
        // From the last digit, so that each takes one step.
        pattern.into_iter().rev().fold(Set::ALL, |rest, (digit, levels)| {
            let child = |level: usize| if levels.contains(level as u8) { rest } else { Set::EMPTY };
            let children: Vec<Set> = (0..self.levels[digit]).map(child).collect();
            self.node(digit, &children)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> (Sets, [Set; 3]) {
        let mut sets = Sets::new();
        for levels in [3, 2, 4] {
            sets.digit(levels);
        }
        let atoms = [(0, 0b011), (1, 0b10), (2, 0b0110)].map(|(digit, levels)| sets.atom(digit, LevelSet(levels)));
        (sets, atoms)
    }

    #[test]
    fn sets_are_counted() {
        let (mut sets, [a, b, c]) = three();
        let ab = sets.and(a, b);
        let either = sets.or(ab, c);
        assert_eq!(sets.count(either, 3), 8.0 + 12.0 - 4.0);
        assert_eq!(sets.count(Set::ALL, 3), 24.0);
        let rest = sets.minus(either, c);
        assert_eq!(sets.count(rest, 3), 4.0);
        assert!(sets.within(rest, ab) && !sets.meets(rest, c));
        assert_eq!(sets.shadow(rest, 2), ab);
    }

    #[test]
    fn equal_sets_are_one() {
        let (mut sets, [a, b, c]) = three();
        let (ab, ac, bc) = (sets.and(a, b), sets.and(a, c), sets.or(b, c));
        let left = sets.and(a, bc);
        assert_eq!(left, sets.or(ab, ac));
        let twice = sets.not(left);
        assert_eq!(sets.not(twice), left);
    }

    #[test]
    fn hulls_are_as_narrow_as_they_can_be() {
        let (mut sets, [a, b, c]) = three();
        let (ab, bc) = (sets.and(a, b), sets.and(b, c));
        let either = sets.or(ab, bc);
        assert_eq!(sets.hull(either), [(1, LevelSet(0b10))]);
        assert_eq!(sets.hull(ab), [(0, LevelSet(0b011)), (1, LevelSet(0b10))]);
        assert_eq!(sets.hull(Set::ALL), []);
        assert_eq!(sets.as_pattern(ab), Some(sets.hull(ab)));
        assert_eq!((sets.as_pattern(either), sets.as_pattern(Set::EMPTY)), (None, None));
        let second = sets.minus(either, a);
        assert_eq!(sets.hull(second), [(0, LevelSet(0b100)), (1, LevelSet(0b10)), (2, LevelSet(0b0110))]);
    }

    #[test]
    fn patterns_are_wide() {
        let (mut sets, [a, b, c]) = three();
        let ab = sets.and(a, b);
        let either = sets.or(ab, c);
        let patterns = sets.patterns(either, 10);
        assert_eq!(patterns.len(), 2, "{patterns:?}");
        assert_eq!(sets.patterns(Set::ALL, 10), [vec![]]);
    }
}
