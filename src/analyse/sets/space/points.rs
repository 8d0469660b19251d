//! Points of sets: whether levels and real numbers can reach a set, and which do.

use std::collections::{BTreeMap, HashSet};

use super::narrowed::Narrowed;
use super::{Question, Space, code};
use crate::analyse::sets::Set;
use crate::analyse::values::point::{Point, Witness};
use crate::analyse::values::real::Boxed;
use crate::points::random::Random;
use crate::program::normal::{Affine, Term};
use crate::program::operators::Bounds;
use crate::program::rational::Rational;
use crate::program::region::{self, Sign};
use crate::program::{Domain, Input, InputId, LevelSet};

/// Most steps in the search for real numbers with given signs.
const MAX_STEPS: usize = 20_000;

/// Most points that are tried where what is not linear decides.
const MAX_TRIES: usize = 256;

/// The least distance from zero at which a value counts as positive or negative, as a share of the
/// terms that it is the sum of: a hundred roundings of `f32`.
const MARGIN: f64 = 6e-6;

/// More than what rounding does to the bounds of a few operations, as a share of them.
const ROUNDED: f64 = 1e-12;

/// The largest distance from zero at which a value counts as zero: a few roundings of `f64`.
const EXACT: f64 = 1e-15;

impl Space<'_> {
    /// The part of a set that real numbers and levels can reach.
    ///
    /// A combination of signs that some numbers have is kept together with
    /// others that differ from it in signs only.
    pub(in crate::analyse) fn prune(&mut self, set: Set) -> Set {
        let Some((digit, children)) = self.sets.test(set) else { return set };
        if let Some(known) = self.pruned.get(&set) {
            return *known;
        }
        let result = if digit >= self.inputs_of_digits.len() {
            if self.signs(set).is_some() { set } else { Set::EMPTY }
        } else {
            let children = children.to_vec();
            let children: Vec<Set> = children.into_iter().map(|child| self.prune(child)).collect();
            self.sets.node(digit, &children)
        };
        if !self.is_too_large() {
            self.pruned.insert(set, result);
        }
        result
    }

    /// Returns whether nothing can reach a set.
    pub(in crate::analyse) fn is_void(&mut self, set: Set) -> bool {
        // Without comparisons every combination of levels can be reached.
        if self.questions.is_empty() { set.is_empty() } else { self.prune(set).is_empty() }
    }

    /// Returns whether something can reach both sets.
    pub(in crate::analyse) fn can_meet(&mut self, a: Set, b: Set) -> bool {
        if !self.sets.meets(a, b) {
            return false;
        }
        if self.questions.is_empty() {
            return true;
        }
        let both = self.sets.and(a, b);
        !self.is_void(both)
    }

    /// The states in which something can reach a set.
    pub(in crate::analyse) fn states(&mut self, set: Set) -> Set {
        let pruned = self.prune(set);
        self.sets.shadow(pruned, self.state_digits())
    }

    /// In how many states something can reach a set.
    pub(in crate::analyse) fn count(&mut self, set: Set) -> usize {
        let states = self.states(set);
        self.sets.count(states, self.state_digits()).round() as usize
    }

    /// Signs and outcomes, by digit, with which numbers reach a set that tests only these.
    pub(super) fn signs(&mut self, set: Set) -> Option<Vec<(usize, u8)>> {
        let mut found = Vec::new();
        let mut steps = MAX_STEPS;
        self.search(set, &mut found, &mut Narrowed::default(), &mut steps).then_some(found)
    }

    fn search(&mut self, set: Set, found: &mut Vec<(usize, u8)>, narrowed: &mut Narrowed, steps: &mut usize) -> bool {
        if set.is_empty() {
            return false;
        }
        *steps = steps.saturating_sub(1);
        let Some((digit, children)) = self.sets.test(set) else { return true };
        // Out of patience: what was not refuted is taken to be possible.
        if *steps == 0 || !self.sets.budget().spend(1) {
            return true;
        }
        // Points on lines mean more than they seem to, so zero is tried last.
        let order: &[usize] = if children.len() == Sign::ALL.len() { &[0, 2, 1] } else { &[0, 1] };
        let children: Vec<(usize, Set)> = order.iter().map(|level| (*level, children[*level])).collect();
        for (level, child) in children {
            if child.is_empty() {
                continue;
            }
            found.push((digit, level as u8));
            let fits = narrowed.push(self, digit, level as u8) && self.possible(narrowed);
            if fits && self.search(child, found, narrowed, steps) {
                return true;
            }
            narrowed.pop();
            found.pop();
        }
        false
    }

    /// Returns whether some numbers lie in all of the intervals that answers leave.
    fn possible(&mut self, narrowed: &Narrowed) -> bool {
        let signs = narrowed.signs(self);
        if signs.is_empty() {
            return true;
        }
        if let Some(known) = self.possible.get(&signs) {
            return *known;
        }
        let mut work = 0;
        let possible = region::can_hold(self.program, self.signed(&signs), &mut work);
        self.sets.budget().spend(work);
        self.possible.insert(signs, possible);
        possible
    }

    pub(super) fn forms_of(&self, answers: &[(usize, u8)]) -> Vec<(usize, u8)> {
        let first = self.inputs_of_digits.len();
        let forms = answers.iter().filter_map(|(digit, sign)| match self.questions[digit - first] {
            Question::Sign(form) => Some((form, *sign)),
            Question::Opaque(_) => None,
        });
        forms.collect()
    }

    /// Forms with their signs, of which both are given by number.
    pub(super) fn signed<'a>(&'a self, signs: &'a [(usize, u8)]) -> impl Iterator<Item = (&'a Affine, Sign)> {
        signs.iter().map(|(form, sign)| (&self.forms[*form], Sign::ALL[usize::from(*sign)]))
    }

    /// An input that reaches a set, if one does.
    pub(in crate::analyse) fn witness(&mut self, set: Set) -> Option<Witness> {
        let mut rest = self.prune(set);
        let mut levels = vec![None; self.program.inputs.len()];
        loop {
            match self.sets.test(rest) {
                Some((digit, children)) if digit < self.inputs_of_digits.len() => {
                    let input = self.inputs_of_digits[digit];
                    let open = |level: &u8| !children[usize::from(*level)].is_empty();
                    let level = self.usual(input).filter(open).or((0..children.len() as u8).find(open))?;
                    levels[input.index()] = Some(level);
                    rest = children[usize::from(level)];
                }
                _ => break,
            }
        }
        let answers = self.signs(rest)?;
        let signs = self.forms_of(&answers);
        let linear = |form: &Affine| form.terms.keys().all(|term| matches!(term, Term::Input(_)));
        let point =
            region::point(self.program, self.signed(&signs).filter(|(form, _)| linear(form))).unwrap_or_default();
        // Signs of what is linear are met by the first candidate; the rest takes luck.
        let first = self.numbers(&point);
        let inside = |numbers: &Vec<Option<f64>>| self.contains(rest, numbers);
        let found = if inside(&first) { Some(first.clone()) } else { self.scattered().find(inside) };
        Some(Witness { levels, certain: found.is_some(), numbers: found.unwrap_or(first) })
    }

    /// Numbers all over the domain, the same in every run.
    fn scattered(&self) -> impl Iterator<Item = Vec<Option<f64>>> {
        let mut random = Random::new(0);
        (0..MAX_TRIES).map(move |_| {
            let mut number = |input: &Input| match &input.domain {
                Domain::Continuous { lo, hi, .. } => Some(random.unit().mul_add(hi - lo, *lo)),
                Domain::Word => Some(input.domain.point(random.unit() * f64::from(u32::MAX))),
                Domain::Discrete(_) => None,
            };
            self.program.inputs.iter().map(&mut number).collect()
        })
    }

    /// Returns whether numbers are in a set that tests only comparisons: computed, by a margin that
    /// rounding cannot take away.
    fn contains(&self, set: Set, numbers: &[Option<f64>]) -> bool {
        let numbers = numbers.iter().map(|number| number.unwrap_or_default()).collect();
        let point = Point { levels: Vec::new(), numbers };
        let mut rest = set;
        while let Some((digit, children)) = self.sets.test(rest) {
            let answer = match &self.questions[digit - self.inputs_of_digits.len()] {
                Question::Sign(form) => clear_sign(self.normaliser.value(&self.forms[*form], &point.numbers)).map(code),
                Question::Opaque(opaque) => {
                    let [a, b] = opaque.sides.map(|side| point.number(&self.pool, side));
                    clear_sign((b - a, a.abs() + b.abs())).map(|sign| u8::from(sign != Sign::Positive))
                }
            };
            let Some(answer) = answer else { return false };
            rest = children[usize::from(answer)];
        }
        !rest.is_empty()
    }

    /// An input that reaches a set with these numbers, if one does.
    pub(in crate::analyse) fn with_numbers(&self, set: Set, numbers: &[f64]) -> Option<Witness> {
        let levels = self.reach(set, &Boxed::at(numbers))?;
        let domains = self.program.inputs.iter().map(|input| &input.domain);
        let certain = domains.clone().zip(numbers).all(|(domain, number)| domain.point(*number) == *number);
        let numbers = domains.zip(numbers).map(|(domain, number)| Some(domain.point(*number))).collect();
        Some(Witness { levels, numbers, certain })
    }

    /// A box around the numbers that reach a set: the domain, cut where every way into the set compares an
    /// input with a number. Nothing if the set has no numbers.
    pub(in crate::analyse) fn around(&self, set: Set) -> Option<Boxed> {
        let first = self.inputs_of_digits.len();
        let cuts = self.sets.hull(set).into_iter().filter_map(|(digit, signs)| {
            let Question::Sign(form) = self.questions.get(digit.checked_sub(first)?)? else { return None };
            let [(input, factor)] = *self.linear[*form].as_ref()?.terms else { return None };
            // The first factor of a form is 1.
            (factor == 1.0).then(|| (input, -self.forms[*form].constant, signs))
        });
        let mut part = Boxed::domain(self.program);
        for (input, at, signs) in cuts {
            let (lo, hi) = enclosing(at);
            let (mut from, mut to) = part.of(input);
            if !signs.contains(code(Sign::Negative)) {
                from = from.max(lo);
            }
            if !signs.contains(code(Sign::Positive)) {
                to = to.min(hi);
            }
            if from > to {
                return None;
            }
            part.cut(input, (from, to));
        }
        Some(part)
    }

    /// Returns whether numbers of a box may reach a set.
    pub(in crate::analyse) fn can_be_in(&self, set: Set, part: &Boxed) -> bool {
        self.reach(set, part).is_some()
    }

    /// Levels with which numbers of a box may reach a set.
    fn reach(&self, set: Set, part: &Boxed) -> Option<Vec<Option<u8>>> {
        let mut levels = vec![None; self.program.inputs.len()];
        self.reach_memo(set, part, &mut levels, &mut HashSet::new()).then_some(levels)
    }

    fn reach_memo(&self, set: Set, part: &Boxed, levels: &mut Vec<Option<u8>>, failed: &mut HashSet<Set>) -> bool {
        let Some((digit, children)) = self.sets.test(set) else { return !set.is_empty() };
        if failed.contains(&set) {
            return false;
        }
        if !self.sets.budget().spend(1) {
            return true;
        }
        let input = self.input_of(digit);
        let allowed = match input {
            Some(_) => LevelSet::all(children.len()),
            None => self.signs_in(digit, part),
        };
        for level in allowed.iter() {
            if let Some(input) = input {
                levels[input.index()] = Some(level);
            }
            if self.reach_memo(children[usize::from(level)], part, levels, failed) {
                return true;
            }
        }
        if let Some(input) = input {
            levels[input.index()] = None;
        }
        failed.insert(set);
        false
    }

    /// The signs that the form of a digit can have in a box.
    pub(super) fn signs_in(&self, digit: usize, part: &Boxed) -> LevelSet {
        let form = match &self.questions[digit - self.inputs_of_digits.len()] {
            Question::Sign(form) => *form,
            Question::Opaque(opaque) => {
                let [a, b] = opaque.laid.each_ref().map(|side| {
                    self.sets.budget().compute(side.work());
                    side.over(part).0
                });
                let slack = ROUNDED * [a.0, a.1, b.0, b.1].into_iter().map(f64::abs).fold(0.0, f64::max);
                // Less, or not: both, if the bounds say nothing.
                let (less, not) = (a.0 - slack < b.1 || slack.is_infinite(), a.1 + slack >= b.0 || slack.is_infinite());
                return LevelSet(u64::from(less) | u64::from(not) << 1);
            }
        };
        let (lo, hi) = match &self.linear[form] {
            Some(linear) => linear.bounds(part),
            None => match self.normaliser.bounds(&self.forms[form], &|input| part.of(input)) {
                Some((lo, hi)) => {
                    let slack = ROUNDED * lo.abs().max(hi.abs());
                    (lo - slack, hi + slack)
                }
                None => return LevelSet::all(Sign::ALL.len()),
            },
        };
        let possible = [(Sign::Positive, hi > 0.0), (Sign::Zero, lo <= 0.0 && hi >= 0.0), (Sign::Negative, lo < 0.0)];
        let possible = possible.into_iter().filter(|(_, can)| *can);
        LevelSet(possible.fold(0, |set, (sign, _)| set | LevelSet::one(code(sign)).0))
    }

    /// The digits of comparisons that involve one of some inputs.
    pub(in crate::analyse) fn switches(&self, inputs: &[InputId]) -> Vec<usize> {
        let first = self.inputs_of_digits.len();
        let involved = |question: &Question| match question {
            Question::Sign(form) => {
                let terms = self.forms[*form].terms.keys();
                terms.into_iter().any(|term| matches!(term, Term::Input(input) if inputs.contains(input)))
            }
            Question::Opaque(_) => false,
        };
        (0..self.questions.len()).filter(|number| involved(&self.questions[*number])).map(|n| n + first).collect()
    }

    /// The level that an input has when nothing is said of it.
    fn usual(&self, input: InputId) -> Option<u8> {
        match self.program.inputs[input.index()].default {
            Some(crate::program::Value::Level(level)) => Some(level),
            _ => None,
        }
    }

    /// A number for every continuous input: that of the point, or one in the middle of nowhere.
    pub(super) fn numbers(&self, point: &BTreeMap<InputId, Rational>) -> Vec<Option<f64>> {
        let number = |(index, input): (usize, &Input)| {
            let (lo, hi) = input.domain.range()?;
            let known = point.get(&InputId::new(index)).copied();
            let free = || region::between(Rational::exact(lo)?, Rational::exact(hi)?, index);
            let chosen = known.or_else(free).unwrap_or(Rational::ZERO);
            Some(input.domain.point(chosen.to_f64()))
        };
        self.program.inputs.iter().enumerate().map(number).collect()
    }
}

/// Numbers on both sides of a fraction, near it; the fraction itself if it is one.
fn enclosing(fraction: Rational) -> Bounds {
    let near = fraction.to_f64();
    match Rational::exact(near) {
        Some(same) if same == fraction => (near, near),
        // Numerator and denominator may be rounded, too.
        _ => (near.next_down().next_down(), near.next_up().next_up()),
    }
}

/// The sign of a sum, given with the sum of the magnitudes of its terms, unless it is too close to call.
fn clear_sign((value, size): (f64, f64)) -> Option<Sign> {
    if value > MARGIN * size {
        Some(Sign::Positive)
    } else if value < -MARGIN * size {
        Some(Sign::Negative)
    } else {
        (value.abs() <= EXACT * size).then_some(Sign::Zero)
    }
}
