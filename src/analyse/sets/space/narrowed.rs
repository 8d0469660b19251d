//! The intervals that signs of forms leave of the numbers that the forms are about.
//!
//! Forms that differ in their constant only, such as `x - 0.25` and `x - 0.5`, are about one number. Their
//! signs leave an interval of it, which is found by comparing constants, whatever their number. Where no
//! two inputs stand in one form, that decides which signs are possible together; otherwise the two ends
//! of each interval do, among which linear programming then looks.

use std::collections::BTreeMap;

use super::{Question, Space};
use crate::program::normal::Term;
use crate::program::rational::Rational;
use crate::program::region::Sign;

/// An end of an interval, and the form with its sign that says so; none for the end of a domain.
#[derive(Clone, Copy)]
struct End {
    at: Rational,
    open: bool,
    sign: Option<(usize, u8)>,
}

/// An interval; an end that is not there is not bounded.
#[derive(Clone, Copy, Default)]
struct Interval {
    lo: Option<End>,
    hi: Option<End>,
}

impl Interval {
    fn is_empty(&self) -> bool {
        matches!((self.lo, self.hi), (Some(lo), Some(hi)) if lo.at > hi.at || lo.at == hi.at && (lo.open || hi.open))
    }
}

/// The intervals that answers leave, and how to go back.
#[derive(Default)]
pub(super) struct Narrowed {
    /// By number of what forms are about.
    intervals: BTreeMap<usize, Interval>,
    /// For each answer, what it narrowed, as that was before.
    before: Vec<Option<(usize, Option<Interval>)>>,
}

impl Narrowed {
    /// Takes one more answer; false if it contradicts those before.
    pub(super) fn push(&mut self, space: &Space<'_>, digit: usize, level: u8) -> bool {
        let Question::Sign(form) = space.questions[digit - space.inputs_of_digits.len()] else {
            self.before.push(None);
            return true;
        };
        let number = space.numbers_of_forms[form];
        let known = self.intervals.get(&number).copied();
        self.before.push(Some((number, known)));
        let mut interval = known.unwrap_or_else(|| domain(space, form));
        let sign = Sign::ALL[usize::from(level)];
        let end = End { at: -space.forms[form].constant, open: sign != Sign::Zero, sign: Some((form, level)) };
        if sign != Sign::Negative && interval.lo.is_none_or(|lo| lo.at < end.at || lo.at == end.at && end.open) {
            interval.lo = Some(end);
        }
        if sign != Sign::Positive && interval.hi.is_none_or(|hi| hi.at > end.at || hi.at == end.at && end.open) {
            interval.hi = Some(end);
        }
        self.intervals.insert(number, interval);
        !interval.is_empty()
    }

    /// Takes the last answer back.
    pub(super) fn pop(&mut self) {
        if let Some((number, before)) = self.before.pop().flatten() {
            match before {
                Some(interval) => self.intervals.insert(number, interval),
                None => self.intervals.remove(&number),
            };
        }
    }

    /// The signs of forms that decide whether the answers are possible together, none if it is clear that they are.
    pub(super) fn signs(&self, space: &Space<'_>) -> Vec<(usize, u8)> {
        let signs = self.intervals.values().flat_map(|interval| [interval.lo, interval.hi]);
        let mut signs: Vec<(usize, u8)> = signs.flatten().filter_map(|end| end.sign).collect();
        signs.sort_unstable();
        signs.dedup();
        let alone = |(form, _): &(usize, u8)| {
            let mut terms = space.forms[*form].terms.keys();
            matches!((terms.next(), terms.next()), (Some(Term::Input(_)), None))
        };
        if signs.iter().all(alone) {
            signs.clear();
        }
        signs
    }
}

/// The domain of the input that a form is about, if it is about one alone.
fn domain(space: &Space<'_>, form: usize) -> Interval {
    let mut terms = space.forms[form].terms.keys();
    let (Some(Term::Input(input)), None) = (terms.next(), terms.next()) else { return Interval::default() };
    let Some((lo, hi)) = space.program.inputs[input.index()].domain.range() else { return Interval::default() };
    let end = |at: f64| Some(End { at: Rational::exact(at)?, open: false, sign: None });
    Interval { lo: end(lo), hi: end(hi) }
}
