//! All inputs of a program at once, as sets that can be computed with.
//!
//! Every discrete input is a digit of a [`Sets`]; so is every comparison of
//! numbers, as the sign of an affine form, which can be positive, zero or
//! negative. A condition is then a set, whatever it is made of, and an analysis
//! is a few operations on sets instead of a walk through all states. That some
//! signs exclude each other (`x < 0.25` and `x > 0.5`) is not built into the
//! sets: [`Space::prune`] takes away what no real numbers can reach, and like
//! everything that finds points of sets it stands in `points`.
//!
//! A [`View`] says what the inputs mean: themselves, or their images under a
//! symmetry, possibly of images again.

mod narrowed;
mod points;
#[cfg(feature = "trial")]
mod sample;

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use super::{Map, Set, Sets};
use crate::analyse::values::real::{Boxed, Laid};
use crate::program::normal::{Affine, Lattice, Normaliser, Term};
use crate::program::operators::Bounds;
use crate::program::rational::Rational;
use crate::program::region::Sign;
use crate::program::{
    BinaryOp, Comparison, Cond, CondId, Domain, ExprId, InputId, LevelSet, LevelTerm, Node, Pool, Program, TernaryOp,
};

/// Most selection-free values that one expression may have.
const MAX_PARTS: usize = 1024;

/// Most combinations of such values that are tried.
const MAX_TRIED: usize = 16 * MAX_PARTS;

/// Number of a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(in crate::analyse) struct View(usize);

impl View {
    /// The inputs themselves.
    pub(in crate::analyse) const PLAIN: View = View(0);
}

/// Images of inputs, which are terms over what another view says.
struct Images {
    levels: HashMap<InputId, LevelTerm>,
    numbers: HashMap<InputId, ExprId>,
    inner: View,
}

/// The question that a digit after those of the inputs stands for.
enum Question {
    /// The sign of an affine form, by its number.
    Sign(usize),
    /// A comparison that has no such form: whether the first value is less than the second.
    Opaque(Box<Opaque>),
}

/// Two values of which one may be less than the other.
struct Opaque {
    sides: [ExprId; 2],
    laid: [Laid; 2],
}

/// An affine form of inputs alone, in floating point: boxes by the thousand are asked for its sign.
struct Linear {
    constant: f64,
    terms: Vec<(InputId, f64)>,
}

impl Linear {
    fn of(form: &Affine) -> Option<Self> {
        let term = |(term, factor): (&Term, &Rational)| match term {
            Term::Input(input) => Some((*input, factor.to_f64())),
            Term::Constant(_) | Term::Unary(..) | Term::Binary(..) | Term::Ternary(..) => None,
        };
        let terms = form.terms.iter().map(term).collect::<Option<_>>()?;
        Some(Self { constant: form.constant.to_f64(), terms })
    }

    fn bounds(&self, part: &Boxed) -> Bounds {
        self.terms.iter().fold((self.constant, self.constant), |(lo, hi), (input, factor)| {
            let (from, to) = part.of(*input);
            (lo + (from * factor).min(to * factor), hi + (from * factor).max(to * factor))
        })
    }
}

/// A set and the value there, for each value that an expression can have.
type Parts = Rc<Vec<(Set, ExprId)>>;

/// The inputs of a program.
pub(in crate::analyse) struct Space<'p> {
    pub(in crate::analyse) program: &'p Program,
    pub(in crate::analyse) pool: Pool,
    pub(in crate::analyse) sets: Sets,
    normaliser: Normaliser,
    /// The digit of each discrete input; those of the states come first.
    digits: Vec<Option<usize>>,
    inputs_of_digits: Vec<InputId>,
    questions: Vec<Question>,
    forms: Vec<Affine>,
    /// The forms once more, if they are of inputs alone.
    linear: Vec<Option<Linear>>,
    form_digits: HashMap<Affine, usize>,
    /// The number of the form without its constant, for each form.
    numbers_of_forms: Vec<usize>,
    numbers: HashMap<BTreeMap<Term, Rational>, usize>,
    opaque_digits: HashMap<(ExprId, ExprId), usize>,
    views: Vec<Images>,
    conditions: Map<(CondId, View), Set>,
    parts: Map<(ExprId, View), Parts>,
    /// The sets where one value is less than another; many cases compare the same ones.
    less: Map<(ExprId, ExprId), Set>,
    pruned: Map<Set, Set>,
    /// Signs of forms that were asked for together, and whether numbers have them.
    possible: HashMap<Vec<(usize, u8)>, bool>,
    too_large: bool,
}

impl<'p> Space<'p> {
    pub(in crate::analyse) fn new(program: &'p Program) -> Self {
        let mut sets = Sets::new();
        let mut digits = vec![None; program.inputs.len()];
        let mut inputs_of_digits = Vec::new();
        let states = program.states.digits().iter().map(|(input, _)| *input);
        let others = program.input_ids().map(|(input, _)| input);
        for input in states.chain(others) {
            if let (Some(levels), None) = (program.levels(input), digits[input.index()]) {
                digits[input.index()] = Some(sets.digit(levels.count()));
                inputs_of_digits.push(input);
            }
        }
        Self {
            program,
            pool: program.pool.clone(),
            sets,
            normaliser: Normaliser::default(),
            digits,
            inputs_of_digits,
            questions: Vec::new(),
            forms: Vec::new(),
            linear: Vec::new(),
            form_digits: HashMap::new(),
            numbers_of_forms: Vec::new(),
            numbers: HashMap::new(),
            opaque_digits: HashMap::new(),
            views: vec![Images { levels: HashMap::new(), numbers: HashMap::new(), inner: View::PLAIN }],
            conditions: Map::default(),
            parts: Map::default(),
            less: Map::default(),
            pruned: Map::default(),
            possible: HashMap::new(),
            too_large: false,
        }
    }

    /// Returns whether something was given up for its size. Then no answer is worth anything.
    pub(in crate::analyse) fn is_too_large(&self) -> bool {
        self.too_large || self.sets.is_full() || self.sets.budget().is_spent()
    }

    /// Lets another analysis begin, whatever work the last one took.
    pub(in crate::analyse) fn begin(&mut self) {
        self.sets.budget().refill();
        self.too_large = false;
    }

    /// The number of digits that belong to the states.
    pub(in crate::analyse) fn state_digits(&self) -> usize {
        self.program.states.digits().len()
    }

    /// The number of digits that belong to discrete inputs, fetched ones included.
    pub(in crate::analyse) fn discrete_digits(&self) -> usize {
        self.inputs_of_digits.len()
    }

    /// The input of a digit, if it belongs to one.
    pub(in crate::analyse) fn input_of(&self, digit: usize) -> Option<InputId> {
        self.inputs_of_digits.get(digit).copied()
    }

    /// The form whose sign a digit is, if it is one.
    pub(in crate::analyse) fn form_of(&self, digit: usize) -> Option<&Affine> {
        match self.questions.get(digit.checked_sub(self.inputs_of_digits.len())?)? {
            Question::Sign(form) => Some(&self.forms[*form]),
            Question::Opaque(_) => None,
        }
    }

    /// The view in which inputs are images, themselves seen through `inner`.
    pub(in crate::analyse) fn view(
        &mut self,
        levels: &[(InputId, LevelTerm)],
        numbers: &[(InputId, ExprId)],
        inner: View,
    ) -> View {
        let (levels, numbers) = (levels.iter().cloned().collect(), numbers.iter().copied().collect());
        self.views.push(Images { levels, numbers, inner });
        View(self.views.len() - 1)
    }

    /// The set where a discrete input has one of some levels.
    fn level(&mut self, input: InputId, levels: LevelSet, view: View) -> Set {
        if view == View::PLAIN {
            return self.digits[input.index()].map_or(Set::EMPTY, |digit| self.sets.atom(digit, levels));
        }
        let images = &self.views[view.0];
        let inner = images.inner;
        match images.levels.get(&input).cloned() {
            Some(term) => self.level_term(&term, levels, inner),
            None => self.level(input, levels, inner),
        }
    }

    fn level_term(&mut self, term: &LevelTerm, levels: LevelSet, view: View) -> Set {
        match term {
            LevelTerm::Const(level) => {
                if levels.contains(*level) {
                    Set::ALL
                } else {
                    Set::EMPTY
                }
            }
            LevelTerm::Input(input) => self.level(*input, levels, view),
            LevelTerm::If(condition, then, other) => {
                let condition = self.condition(*condition, view);
                let (then, other) = (self.level_term(then, levels, view), self.level_term(other, levels, view));
                self.choose(condition, then, other)
            }
            LevelTerm::Map(inner, renaming) => {
                let old = renaming.iter().enumerate().filter(|(_, new)| levels.contains(**new));
                let old = old.fold(0, |set, (old, _)| set | LevelSet::one(old as u8).0);
                self.level_term(inner, LevelSet(old), view)
            }
        }
    }

    fn choose(&mut self, condition: Set, then: Set, other: Set) -> Set {
        let (then, other) = (self.sets.and(condition, then), self.sets.minus(other, condition));
        self.sets.or(then, other)
    }

    /// The set where a condition of the program holds.
    pub(in crate::analyse) fn condition(&mut self, condition: CondId, view: View) -> Set {
        if let Some(known) = self.conditions.get(&(condition, view)) {
            return *known;
        }
        let set = match self.pool.cond(condition).clone() {
            Cond::Const(true) => Set::ALL,
            Cond::Const(false) => Set::EMPTY,
            Cond::Level(input, levels) => self.level(input, levels, view),
            Cond::Compare(op, a, b) => self.compare(op, a, b, view),
            Cond::Not(a) => {
                let a = self.condition(a, view);
                self.sets.not(a)
            }
            Cond::And(list) => self.fold(&list, Set::ALL, view, Sets::and),
            Cond::Or(list) => self.fold(&list, Set::EMPTY, view, Sets::or),
            Cond::If(c, a, b) => {
                let [c, a, b] = [c, a, b].map(|part| self.condition(part, view));
                self.choose(c, a, b)
            }
        };
        if !self.is_too_large() {
            self.conditions.insert((condition, view), set);
        }
        set
    }

    fn fold(&mut self, list: &[CondId], start: Set, view: View, join: fn(&mut Sets, Set, Set) -> Set) -> Set {
        list.iter().fold(start, |set, part| {
            let part = self.condition(*part, view);
            join(&mut self.sets, set, part)
        })
    }

    fn compare(&mut self, op: Comparison, a: ExprId, b: ExprId, view: View) -> Set {
        let (left, right) = (self.parts(a, view), self.parts(b, view));
        let mut result = Set::EMPTY;
        for (here, a) in left.iter() {
            for (there, b) in right.iter() {
                let both = self.sets.and(*here, *there);
                if both.is_empty() {
                    continue;
                }
                let holds = match op {
                    Comparison::Less => self.less(*a, *b),
                    Comparison::LessEqual => self.at_most(*a, *b),
                    Comparison::Equal => self.equal(*a, *b),
                };
                let holds = self.sets.and(both, holds);
                result = self.sets.or(result, holds);
            }
        }
        result
    }

    /// The set where `a < b`, of values without selections.
    pub(in crate::analyse) fn less(&mut self, a: ExprId, b: ExprId) -> Set {
        if let Some(known) = self.less.get(&(a, b)) {
            return *known;
        }
        let set = self.less_anew(a, b);
        if !self.is_too_large() {
            self.less.insert((a, b), set);
        }
        set
    }

    fn less_anew(&mut self, a: ExprId, b: ExprId) -> Set {
        if let (Some((a, lo, hi)), Some((b, other_lo, other_hi))) = (self.clamped(a), self.clamped(b))
            && (lo, hi) == (other_lo, other_hi)
            && lo < hi
        {
            // Clamped alike, they differ where they do, unless both are beyond one bound.
            let (lo, hi) = (self.pool.number(lo), self.pool.number(hi));
            let (inner, low, high) = (self.less(a, b), self.less(lo, b), self.less(a, hi));
            let within = self.sets.and(low, high);
            return self.sets.and(inner, within);
        }
        let Some((a_form, b_form)) = self.lattice(a).zip(self.lattice(b)) else {
            return self.opaque(a, b);
        };
        // Each clause of b has a part that is larger than all of some clause of a.
        let mut all = Set::ALL;
        for clause in &b_form {
            let mut any = Set::EMPTY;
            for part in clause {
                for smaller in &a_form {
                    let mut larger = Set::ALL;
                    for other in smaller {
                        let minus = other.times(Rational::whole(-1));
                        let Some(difference) = minus.and_then(|other| part.plus(&other)) else {
                            return self.opaque(a, b);
                        };
                        let positive = self.positive(difference);
                        larger = self.sets.and(larger, positive);
                    }
                    any = self.sets.or(any, larger);
                }
            }
            all = self.sets.and(all, any);
        }
        all
    }

    fn at_most(&mut self, a: ExprId, b: ExprId) -> Set {
        let more = self.less(b, a);
        self.sets.not(more)
    }

    fn equal(&mut self, a: ExprId, b: ExprId) -> Set {
        let different = self.unequal(&[a], &[b]);
        self.sets.not(different)
    }

    /// The set where two results do not mean the same, of values without selections.
    pub(in crate::analyse) fn different(&mut self, a: &[ExprId], b: &[ExprId]) -> Set {
        if !self.program.output.has_list() {
            return self.unequal(a, b);
        }
        let [a, b] = [a, b].map(|values| {
            let mut values = values.to_vec();
            self.program.output.sort(&mut values, &|value| self.pool.constant(*value));
            values
        });
        self.unequal(&a, &b)
    }

    /// The set where some of several numbers differ, of values without selections.
    pub(in crate::analyse) fn unequal(&mut self, a: &[ExprId], b: &[ExprId]) -> Set {
        let mut result = Set::EMPTY;
        for (a, b) in a.iter().zip(b) {
            if a == b {
                continue;
            }
            let forms = (self.normaliser.normal(&self.pool, *a), self.normaliser.normal(&self.pool, *b));
            if forms.0.is_some() && forms.0 == forms.1 {
                continue;
            }
            let (less, more) = (self.less(*a, *b), self.less(*b, *a));
            let either = self.sets.or(less, more);
            result = self.sets.or(result, either);
        }
        result
    }

    fn clamped(&self, expr: ExprId) -> Option<(ExprId, f64, f64)> {
        let Node::Ternary(TernaryOp::Clamp, inner, lo, hi) = self.pool.node(expr) else { return None };
        Some((inner, self.pool.constant(lo)?, self.pool.constant(hi)?))
    }

    /// The normal form of a value without selections.
    pub(in crate::analyse) fn lattice(&mut self, expr: ExprId) -> Option<Lattice> {
        let id = self.normaliser.normal(&self.pool, expr)?;
        Some(self.normaliser.lattice_of(id).clone())
    }

    /// The set where a form is positive.
    fn positive(&mut self, form: Affine) -> Set {
        if let Some((lo, hi)) = self.bounds(&form) {
            if lo.is_positive() {
                return Set::ALL;
            }
            if !hi.is_positive() {
                return Set::EMPTY;
            }
        }
        if let Some(beside) = self.beside(&form) {
            let less = self.positive(beside);
            return self.sets.not(less);
        }
        let Some(leading) = form.terms.values().next().copied() else { return Set::EMPTY };
        let Some(canonical) = leading.reciprocal().and_then(|factor| form.times(factor)) else {
            self.too_large = true;
            return Set::EMPTY;
        };
        let digit = match self.form_digits.get(&canonical) {
            Some(digit) => *digit,
            None => {
                self.questions.push(Question::Sign(self.forms.len()));
                self.linear.push(Linear::of(&canonical));
                self.forms.push(canonical.clone());
                let next = self.numbers.len();
                let number = *self.numbers.entry(canonical.terms.clone()).or_insert(next);
                self.numbers_of_forms.push(number);
                let digit = self.sets.digit(Sign::ALL.len());
                self.form_digits.insert(canonical, digit);
                digit
            }
        };
        let wanted = if leading.is_negative() { Sign::Negative } else { Sign::Positive };
        self.sets.atom(digit, LevelSet::one(code(wanted)))
    }

    /// Of a word less another one, the form that is positive where this is not: what is more than a word is the next
    /// one at least. So all that is asked of a word is whether it is less than others, and nothing lies between two.
    fn beside(&self, form: &Affine) -> Option<Affine> {
        let mut terms = form.terms.iter();
        let (Some((term, factor)), None) = (terms.next(), terms.next()) else { return None };
        let is_word = match term {
            Term::Input(input) => self.program.inputs[input.index()].domain == Domain::Word,
            Term::Unary(op, _) => op.row().gives_word,
            Term::Binary(op, ..) => op.row().is_on_words,
            Term::Constant(_) | Term::Ternary(..) => false,
        };
        let is_whole = is_word && *factor == Rational::ONE && form.constant.to_f64().fract() == 0.0;
        is_whole
            .then(|| form.times(Rational::whole(-1)))
            .flatten()
            .and_then(|form| Some(Affine { constant: form.constant.plus(Rational::ONE)?, ..form }))
    }

    /// The bounds of a form, each input taken for itself.
    fn bounds(&self, form: &Affine) -> Option<(Rational, Rational)> {
        let (mut lo, mut hi) = (form.constant, form.constant);
        for (term, factor) in &form.terms {
            let Term::Input(input) = term else { return None };
            let (from, to) = self.program.inputs[input.index()].domain.range()?;
            let (a, b) = (Rational::exact(from)?.times(*factor)?, Rational::exact(to)?.times(*factor)?);
            lo = lo.plus(a.min(b))?;
            hi = hi.plus(a.max(b))?;
        }
        Some((lo, hi))
    }

    /// For each number that several forms are about, the digits of these, the constants that they compare it with ascending.
    pub(in crate::analyse) fn compared(&self) -> Vec<Vec<usize>> {
        let mut compared = vec![Vec::new(); self.numbers.len()];
        for (form, number) in self.numbers_of_forms.iter().enumerate() {
            compared[*number].push(form);
        }
        compared.retain(|forms| forms.len() > 1);
        for forms in &mut compared {
            forms.sort_by_key(|form| -self.forms[*form].constant);
            forms.iter_mut().for_each(|form| *form = self.form_digits[&self.forms[*form]]);
        }
        compared
    }

    fn opaque(&mut self, a: ExprId, b: ExprId) -> Set {
        let digit = match self.opaque_digits.get(&(a, b)) {
            Some(digit) => *digit,
            None => {
                let laid = [a, b].map(|side| Laid::new(&self.pool, side));
                self.questions.push(Question::Opaque(Box::new(Opaque { sides: [a, b], laid })));
                let digit = self.sets.digit(2);
                self.opaque_digits.insert((a, b), digit);
                digit
            }
        };
        self.sets.atom(digit, LevelSet(1))
    }

    /// The values without selections that an expression has, and where.
    pub(in crate::analyse) fn parts(&mut self, expr: ExprId, view: View) -> Parts {
        if view == View::PLAIN && !self.pool.expr_facts(expr).selects {
            return Rc::new(vec![(Set::ALL, expr)]);
        }
        if let Some(known) = self.parts.get(&(expr, view)) {
            return known.clone();
        }
        let parts = match self.pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Result(_) => vec![(Set::ALL, expr)],
            Node::Input(input) => {
                let inner = self.views[view.0].inner;
                let image = self.views[view.0].numbers.get(&input).copied();
                match view == View::PLAIN {
                    true => vec![(Set::ALL, expr)],
                    false => self.parts(image.unwrap_or(expr), inner).to_vec(),
                }
            }
            Node::Index(input) => {
                let count = self.program.levels(input).map_or(0, |levels| levels.count()) as u8;
                let level = |level| (self.level(input, LevelSet::one(level), view), self.pool.number(f64::from(level)));
                (0..count).map(level).collect()
            }
            Node::Unary(op, a) => {
                let parts = self.parts(a, view);
                parts.iter().map(|(set, a)| (*set, self.pool.unary(op, *a))).collect()
            }
            Node::Binary(op, a, b) => {
                let parts = self.products(&[a, b], view);
                parts.into_iter().map(|(set, list)| (set, self.pool.binary(op, list[0], list[1]))).collect()
            }
            Node::Ternary(op, a, b, c) => {
                let parts = self.products(&[a, b, c], view);
                parts.into_iter().map(|(set, list)| (set, self.pool.ternary(op, list[0], list[1], list[2]))).collect()
            }
            Node::Select(condition, a, b) => {
                let holds = self.condition(condition, view);
                let (then, other) = (self.parts(a, view), self.parts(b, view));
                let then: Vec<_> = then.iter().map(|(set, value)| (self.sets.and(*set, holds), *value)).collect();
                let other = other.iter().map(|(set, value)| (self.sets.minus(*set, holds), *value));
                then.into_iter().chain(other.collect::<Vec<_>>()).collect()
            }
        };
        let parts = Rc::new(self.merged(parts));
        if !self.is_too_large() {
            self.parts.insert((expr, view), parts.clone());
        }
        parts
    }

    /// The values that several expressions have together.
    pub(in crate::analyse) fn products(&mut self, list: &[ExprId], view: View) -> Vec<(Set, Vec<ExprId>)> {
        let mut result: Vec<(Set, Vec<ExprId>)> = vec![(Set::ALL, Vec::new())];
        for expr in list {
            let parts = self.parts(*expr, view);
            // Most of what is put together is nowhere, if it depends on the same levels.
            if result.len() * parts.len() > MAX_TRIED || self.sets.budget().is_spent() {
                self.too_large = true;
                return Vec::new();
            }
            let mut next = Vec::with_capacity(result.len() * parts.len());
            for (set, values) in &result {
                for (part, value) in parts.iter() {
                    let both = self.sets.and(*set, *part);
                    if !both.is_empty() {
                        if next.len() == MAX_PARTS {
                            self.too_large = true;
                            return Vec::new();
                        }
                        next.push((both, values.iter().copied().chain([*value]).collect()));
                    }
                }
            }
            result = next;
        }
        result
    }

    /// The same parts, each value once and nothing empty.
    fn merged(&mut self, parts: Vec<(Set, ExprId)>) -> Vec<(Set, ExprId)> {
        let mut result: Vec<(Set, ExprId)> = Vec::with_capacity(parts.len());
        for (set, value) in parts {
            match result.iter_mut().find(|(_, known)| *known == value) {
                _ if set.is_empty() => {}
                Some((known, _)) => *known = self.sets.or(*known, set),
                None => result.push((set, value)),
            }
        }
        result
    }

    /// The result map of a symmetry, of values without selections.
    pub(in crate::analyse) fn with_result(&mut self, map: &[ExprId], values: &[ExprId]) -> Vec<ExprId> {
        map.iter().map(|component| self.component_with_result(*component, values)).collect()
    }

    fn component_with_result(&mut self, map: ExprId, values: &[ExprId]) -> ExprId {
        match self.pool.node(map) {
            Node::Result(component) => values.get(usize::from(component)).copied().unwrap_or(map),
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) => map,
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.component_with_result(part, values));
                self.pool.fold(node)
            }
            Node::Select(condition, then, other) => {
                let [then, other] = [then, other].map(|part| self.component_with_result(part, values));
                let condition = self.condition_with_result(condition, values);
                self.pool.select(condition, then, other)
            }
        }
    }

    /// The conditions of a result map compare codes, which are constants.
    fn condition_with_result(&mut self, condition: CondId, values: &[ExprId]) -> CondId {
        let part = |me: &mut Self, condition| me.condition_with_result(condition, values);
        match self.pool.cond(condition).clone() {
            Cond::Const(_) | Cond::Level(..) => condition,
            Cond::Compare(op, a, b) => {
                let [a, b] = [a, b].map(|side| self.component_with_result(side, values));
                self.pool.compare(op, a, b)
            }
            Cond::Not(a) => {
                let a = part(self, a);
                self.pool.not(a)
            }
            Cond::And(parts) => {
                let parts: Vec<CondId> = parts.into_iter().map(|a| part(self, a)).collect();
                self.pool.and(parts)
            }
            Cond::Or(parts) => {
                let parts: Vec<CondId> = parts.into_iter().map(|a| part(self, a)).collect();
                self.pool.or(parts)
            }
            Cond::If(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|a| part(self, a));
                self.pool.cond_if(a, b, c)
            }
        }
    }

    /// The set where `b` is more than `a + by`, of values without selections.
    pub(in crate::analyse) fn exceeds(&mut self, a: ExprId, b: ExprId, by: f64) -> Set {
        let by = self.pool.number(by);
        let raised = self.pool.binary(BinaryOp::Add, a, by);
        self.less(raised, b)
    }
}

fn code(sign: Sign) -> u8 {
    Sign::ALL.iter().position(|other| *other == sign).unwrap_or_default() as u8
}
