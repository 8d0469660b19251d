//! Runs a program symbolically, along every path of a state.
//!
//! A state fixes the discrete inputs that are not fetched. What it leaves
//! open (the level of a fetched input, the sign of a difference of numbers) is
//! a question; a [`Machine`] answers equal questions equally and goes through
//! all answers in turn, each sequence of which is a path. Unlike the prover of
//! plans, which compares bits and so takes different-looking comparisons for
//! independent, this looks at the real numbers: a comparison is the sign of an
//! affine form, and only answers that can hold together somewhere in the
//! domain are given. For tables that are piecewise linear all that is found
//! here is therefore exact.

use std::collections::{BTreeMap, HashMap};
use std::ops::ControlFlow;

use super::normal::{Affine, Normaliser, Term};
use super::operators::{BinaryAlgebra, TernaryAlgebra, UnaryAlgebra};
use super::print::Printer;
use super::rational::Rational;
use super::region::{self, Sign};
use super::{
    BinaryOp, Comparison, Cond, CondId, ExprId, InputId, InputSet, LevelSet, LevelTerm, Node, Pool, Program, Symmetry,
    UnaryOp, Value,
};

/// Most paths of one state that are looked at. Published tables have a few dozen.
const MAX_PATHS: usize = 1 << 14;

/// The meaning of the inputs: themselves, or their images under a symmetry.
#[derive(Clone, Copy, Default)]
pub(crate) struct View<'s> {
    /// Whose images the inputs stand for.
    pub(crate) symmetry: Option<&'s Symmetry>,
    /// The components of the result, in the result map of a symmetry.
    pub(crate) result: Option<&'s [ExprId]>,
}

impl View<'_> {
    /// The inputs themselves.
    pub(crate) const PLAIN: Self = View { symmetry: None, result: None };
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Question {
    /// The level of a fetched input.
    Level(InputId),
    /// The sign of an affine form, by its number.
    Sign(usize),
    /// A comparison that is no such thing.
    Compare(Comparison, ExprId, ExprId),
}

struct Choice {
    question: Question,
    answer: u8,
    /// Answers that are still to come.
    rest: LevelSet,
    /// For the sign of a form: what was compared, and whether the form is a
    /// negative multiple of the second less the first.
    compared: Option<(ExprId, ExprId, bool)>,
}

/// Runs a program along paths.
pub(crate) struct Machine<'p> {
    program: &'p Program,
    /// The pool of the conditions.
    conditions: &'p Pool,
    pool: Pool,
    normaliser: Normaliser,
    levels: Vec<u8>,
    /// Inputs that were fetched.
    fetched: InputSet,
    /// The numbers that conditions compared.
    compared: Vec<(ExprId, ExprId)>,
    /// Fetched inputs that are not there, so that code finds the first level or the least number.
    absent: InputSet,
    choices: Vec<Choice>,
    /// The place of each question among them.
    asked: HashMap<Question, usize>,
    /// The forms asked for, and their numbers. Multiples of a form share one.
    forms: Vec<Affine>,
    form_index: HashMap<Affine, usize>,
    differences: HashMap<ExprId, Option<Difference>>,
    /// Signs that the last of some forms can have, given those of the others.
    possible: HashMap<Vec<(usize, u8)>, LevelSet>,
    gave_up: bool,
}

/// The kind of a difference of two numbers.
#[derive(Clone, Copy)]
enum Difference {
    Constant(Sign),
    /// A multiple of a form.
    Form {
        number: usize,
        negative: bool,
    },
}

impl<'p> Machine<'p> {
    pub(crate) fn new(program: &'p Program) -> Self {
        Self::over(program, &program.pool)
    }

    /// A machine for terms of another pool, which has all those of the program.
    pub(crate) fn over(program: &'p Program, pool: &'p Pool) -> Self {
        Self {
            program,
            conditions: pool,
            pool: pool.clone(),
            fetched: InputSet::default(),
            compared: Vec::new(),
            absent: InputSet::default(),
            normaliser: Normaliser::default(),
            levels: vec![0; program.inputs.len()],
            choices: Vec::new(),
            asked: HashMap::new(),
            forms: Vec::new(),
            form_index: HashMap::new(),
            differences: HashMap::new(),
            possible: HashMap::new(),
            gave_up: false,
        }
    }

    /// Follows every path of a state, until told to stop. Returns whether it was.
    /// A state with too many paths is given up; [`Self::gave_up`] tells.
    pub(crate) fn any_path(&mut self, state: usize, mut path: impl FnMut(&mut Self) -> ControlFlow<()>) -> bool {
        self.program.states.write(state, &mut self.levels);
        self.choices.clear();
        self.asked.clear();
        self.gave_up = false;
        for _ in 0..MAX_PATHS {
            self.compared.clear();
            if path(self).is_break() {
                return true;
            }
            if !self.advance() {
                return false;
            }
        }
        self.gave_up = true;
        false
    }

    /// The inputs that were fetched since the last call.
    pub(crate) fn take_fetched(&mut self) -> InputSet {
        std::mem::take(&mut self.fetched)
    }

    /// The numbers that conditions compared since the last call. They were taken for real ones.
    pub(crate) fn take_compared(&mut self) -> Vec<(ExprId, ExprId)> {
        std::mem::take(&mut self.compared)
    }

    /// Lets inputs be absent from here on, on this path or until told otherwise.
    pub(crate) fn set_absent(&mut self, inputs: InputSet) {
        self.absent = inputs;
    }

    /// Terms, those that were made on the way included.
    pub(crate) fn pool(&mut self) -> &mut Pool {
        &mut self.pool
    }

    /// Returns whether the last state had more paths than were followed.
    pub(crate) fn gave_up(&self) -> bool {
        self.gave_up
    }

    fn advance(&mut self) -> bool {
        while let Some(choice) = self.choices.last_mut() {
            if let Some(next) = choice.rest.iter().next() {
                choice.answer = next;
                choice.rest.0 &= !(1 << next);
                return true;
            }
            self.asked.remove(&choice.question);
            self.choices.pop();
        }
        false
    }

    /// The answer on this path; a new question is first answered with the lowest of `possible`.
    fn answer(&mut self, question: Question, possible: LevelSet, compared: Option<(ExprId, ExprId, bool)>) -> u8 {
        if let Some(known) = self.known(question) {
            return known;
        }
        let answer = possible.0.trailing_zeros() as u8;
        self.asked.insert(question, self.choices.len());
        self.choices.push(Choice { question, answer, rest: LevelSet(possible.0 & !(1 << answer)), compared });
        answer
    }

    /// The answer on this path, if the question was asked.
    fn known(&self, question: Question) -> Option<u8> {
        self.asked.get(&question).map(|place| self.choices[*place].answer)
    }

    fn level(&mut self, input: InputId, view: View<'_>) -> u8 {
        if let Some(symmetry) = view.symmetry
            && let Some((_, image)) = symmetry.levels.iter().find(|(mapped, _)| *mapped == input)
        {
            return self.level_term(image);
        }
        match self.program.levels(input) {
            Some(_) if self.absent.contains(input) => 0,
            Some(levels) if self.program.fetched.contains(input) => {
                self.fetched = self.fetched.or(InputSet::one(input));
                self.answer(Question::Level(input), LevelSet::all(levels.count()), None)
            }
            _ => self.levels[input.index()],
        }
    }

    /// Images are written in terms of the inputs themselves.
    fn level_term(&mut self, term: &LevelTerm) -> u8 {
        match term {
            LevelTerm::Const(level) => *level,
            LevelTerm::Input(input) => self.level(*input, View::PLAIN),
            LevelTerm::If(condition, then, other) => {
                let chosen = if self.holds(*condition, View::PLAIN) { then } else { other };
                self.level_term(chosen)
            }
            LevelTerm::Map(inner, renaming) => renaming[usize::from(self.level_term(inner))],
        }
    }

    /// Returns whether a condition holds on this path.
    pub(crate) fn holds(&mut self, condition: CondId, view: View<'_>) -> bool {
        // Resolving makes expressions but no conditions, so these are all.
        let conditions = self.conditions;
        match conditions.cond(condition) {
            Cond::Const(value) => *value,
            Cond::Level(input, levels) => levels.contains(self.level(*input, view)),
            Cond::Compare(op, a, b) => {
                let (a, b) = (self.resolve(*a, view), self.resolve(*b, view));
                self.compared.push((a, b));
                self.compare(*op, a, b)
            }
            Cond::Not(a) => !self.holds(*a, view),
            Cond::And(parts) => parts.iter().all(|part| self.holds(*part, view)),
            Cond::Or(parts) => parts.iter().any(|part| self.holds(*part, view)),
            Cond::If(c, a, b) => {
                let chosen = if self.holds(*c, view) { a } else { b };
                self.holds(*chosen, view)
            }
        }
    }

    fn compare(&mut self, op: Comparison, a: ExprId, b: ExprId) -> bool {
        match self.sign(a, b) {
            Some(sign) => match op {
                Comparison::Less => sign == Sign::Positive,
                Comparison::LessEqual => sign != Sign::Negative,
                Comparison::Equal => sign == Sign::Zero,
            },
            None => self.answer(Question::Compare(op, a, b), LevelSet(0b11), None) == 0,
        }
    }

    /// The sign of `b - a` on this path; `None` if the difference has no affine form.
    fn sign(&mut self, a: ExprId, b: ExprId) -> Option<Sign> {
        let (a, b) = (self.flatten(a), self.flatten(b));
        let difference = self.pool.settle(Node::Binary(BinaryOp::Subtract, b, a));
        let (number, negative) = match self.difference(difference)? {
            Difference::Constant(sign) => return Some(sign),
            Difference::Form { number, negative } => (number, negative),
        };
        let question = Question::Sign(number);
        let answer = match self.known(question) {
            Some(answer) => answer,
            None => {
                let possible = self.possible_signs(number);
                self.answer(question, possible, Some((a, b, negative)))
            }
        };
        let sign = Sign::ALL[usize::from(answer)];
        Some(if negative { sign.flip() } else { sign })
    }

    fn difference(&mut self, expr: ExprId) -> Option<Difference> {
        if let Some(known) = self.differences.get(&expr) {
            return *known;
        }
        let difference = self.normaliser.affine(&self.pool, expr).and_then(|form| {
            if let Some(order) = form.order() {
                return Some(Difference::Constant(Sign::of(order)));
            }
            let leading = form.terms.values().next().copied()?;
            let form = form.times(leading.reciprocal()?)?;
            let number = *self.form_index.entry(form).or_insert_with_key(|form| {
                self.forms.push(form.clone());
                self.forms.len() - 1
            });
            Some(Difference::Form { number, negative: leading.is_negative() })
        });
        self.differences.insert(expr, difference);
        difference
    }

    /// The answers so far about signs, without those that follow from others of forms that differ in their constant
    /// only: of the least such form that is positive, and of the greatest that is negative.
    fn tightest(&self) -> Vec<(usize, u8)> {
        let mut ends: HashMap<(&BTreeMap<Term, Rational>, u8), usize> = HashMap::new();
        for choice in &self.choices {
            let Question::Sign(form) = choice.question else { continue };
            let constant = |form: usize| self.forms[form].constant;
            let known = ends.entry((&self.forms[form].terms, choice.answer)).or_insert(form);
            let tighter = match Sign::ALL[usize::from(choice.answer)] {
                Sign::Positive => constant(form) < constant(*known),
                Sign::Negative => constant(form) > constant(*known),
                Sign::Zero => false,
            };
            if tighter {
                *known = form;
            }
        }
        let mut signs: Vec<(usize, u8)> = ends.into_iter().map(|((_, sign), form)| (form, sign)).collect();
        signs.sort_unstable();
        signs
    }

    /// The signs that a form can have, given the answers so far.
    fn possible_signs(&mut self, form: usize) -> LevelSet {
        let mut key = self.tightest();
        key.push((form, 0));
        if let Some(known) = self.possible.get(&key) {
            return *known;
        }
        let mut possible = LevelSet(0);
        let last = key.len() - 1;
        for sign in 0..Sign::ALL.len() as u8 {
            key[last].1 = sign;
            let signs = key.iter().map(|(form, sign)| (&self.forms[*form], Sign::ALL[usize::from(*sign)]));
            if region::can_hold(self.program, signs, &mut 0) {
                possible.0 |= 1 << sign;
            }
        }
        // One of them always can, as the earlier answers could; this is for arithmetic that gave up before.
        if possible.0 == 0 {
            possible = LevelSet::all(Sign::ALL.len());
        }
        key[last].1 = 0;
        self.possible.insert(key, possible);
        possible
    }

    /// An expression with selections decided and images put in.
    pub(crate) fn resolve(&mut self, expr: ExprId, view: View<'_>) -> ExprId {
        let facts = self.pool.expr_facts(expr);
        let absent = !facts.inputs.and(self.absent).is_empty();
        if view.symmetry.is_none() && view.result.is_none() && !facts.selects && !absent {
            self.fetched = self.fetched.or(facts.inputs.and(self.program.fetched));
            return expr;
        }
        self.resolve_memo(expr, view, &mut HashMap::new())
    }

    fn resolve_memo(&mut self, expr: ExprId, view: View<'_>, memo: &mut HashMap<ExprId, ExprId>) -> ExprId {
        if let Some(done) = memo.get(&expr) {
            return *done;
        }
        let result = match self.pool.node(expr) {
            Node::Const(_) | Node::Word(_) => return expr,
            Node::Result(component) => {
                view.result.and_then(|values| values.get(usize::from(component)).copied()).unwrap_or(expr)
            }
            Node::Input(input) => {
                let image = view.symmetry.and_then(|s| s.numbers.iter().find(|(mapped, _)| *mapped == input));
                match image {
                    Some((_, image)) => self.resolve(*image, View::PLAIN),
                    None if self.absent.contains(input) => {
                        self.pool.value_of(input, self.program.inputs[input.index()].least())
                    }
                    None => {
                        self.fetched = self.fetched.or(InputSet::one(input).and(self.program.fetched));
                        expr
                    }
                }
            }
            Node::Index(input) => {
                let level = self.level(input, view);
                self.pool.number(f64::from(level))
            }
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.resolve_memo(part, view, memo));
                self.pool.settle(node)
            }
            Node::Select(c, a, b) => {
                let chosen = if self.holds(c, view) { a } else { b };
                self.resolve_memo(chosen, view, memo)
            }
        };
        memo.insert(expr, result);
        result
    }

    /// A resolved expression with every minimum and maximum decided, so that it is affine if it can be.
    fn flatten(&mut self, expr: ExprId) -> ExprId {
        match self.pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Result(_) | Node::Input(_) | Node::Index(_) | Node::Select(..) => {
                expr
            }
            Node::Unary(op, a) => {
                let a = self.flatten(a);
                let zero = self.pool.number(0.0);
                match op.row().algebra {
                    UnaryAlgebra::Absolute => {
                        let negated = self.pool.settle(Node::Unary(UnaryOp::Negate, a));
                        self.larger(a, negated)
                    }
                    UnaryAlgebra::Saturate => {
                        let one = self.pool.number(1.0);
                        let raised = self.larger(a, zero);
                        self.smaller(raised, one)
                    }
                    UnaryAlgebra::Negate | UnaryAlgebra::Opaque => self.pool.settle(Node::Unary(op, a)),
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.flatten(a), self.flatten(b));
                match op.row().algebra {
                    BinaryAlgebra::Minimum => self.smaller(a, b),
                    BinaryAlgebra::Maximum => self.larger(a, b),
                    BinaryAlgebra::Sum
                    | BinaryAlgebra::Difference
                    | BinaryAlgebra::Product
                    | BinaryAlgebra::Quotient
                    | BinaryAlgebra::Opaque => self.pool.settle(Node::Binary(op, a, b)),
                }
            }
            Node::Ternary(op, a, b, c) => {
                let [a, b, c] = [a, b, c].map(|part| self.flatten(part));
                match op.row().algebra {
                    TernaryAlgebra::Clamp => {
                        let raised = self.larger(a, b);
                        self.smaller(raised, c)
                    }
                    TernaryAlgebra::ProductAndSum | TernaryAlgebra::Mix | TernaryAlgebra::Opaque => {
                        self.pool.settle(Node::Ternary(op, a, b, c))
                    }
                }
            }
        }
    }

    fn smaller(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match self.sign(a, b) {
            Some(Sign::Positive | Sign::Zero) => a,
            Some(Sign::Negative) => b,
            None => self.pool.settle(Node::Binary(BinaryOp::Min, a, b)),
        }
    }

    fn larger(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match self.sign(a, b) {
            Some(Sign::Positive | Sign::Zero) => b,
            Some(Sign::Negative) => a,
            None => self.pool.settle(Node::Binary(BinaryOp::Max, a, b)),
        }
    }

    /// Returns whether two resolved results are equal on this path, over the reals.
    pub(crate) fn equal(&mut self, a: &[ExprId], b: &[ExprId]) -> bool {
        a.iter().zip(b).all(|(a, b)| self.equal_numbers(*a, *b))
    }

    /// Returns whether resolved results are small enough to be compared.
    pub(crate) fn has_forms(&mut self, values: &[ExprId]) -> bool {
        values.iter().all(|value| self.normaliser.normal(&self.pool, *value).is_some())
    }

    fn equal_numbers(&mut self, a: ExprId, b: ExprId) -> bool {
        if a == b {
            return true;
        }
        let forms = (self.normaliser.normal(&self.pool, a), self.normaliser.normal(&self.pool, b));
        if let (Some(a), Some(b)) = forms
            && a == b
        {
            return true;
        }
        // Different forms may still agree on what the path leaves of the domain.
        self.sign(a, b) == Some(Sign::Zero)
    }

    /// The value of a row on this path, its guard aside: the first line that applies, else the default.
    pub(crate) fn row_values(&mut self, row: usize, view: View<'_>) -> Vec<ExprId> {
        let program = self.program;
        let line = program.rows[row].lines.iter().find(|line| self.holds(line.condition, view));
        let values = line.map_or(&program.default, |line| &line.values);
        values.iter().map(|value| self.resolve(*value, view)).collect()
    }

    /// The row taken and the result on this path.
    pub(crate) fn run(&mut self, view: View<'_>) -> (Option<usize>, Vec<ExprId>) {
        let program = self.program;
        match program.rows.iter().position(|row| self.holds(row.guard, view)) {
            Some(row) => (Some(row), self.row_values(row, view)),
            None => (None, program.default.iter().map(|value| self.resolve(*value, view)).collect()),
        }
    }

    /// The row taken, of those that can be, its line, and the result on this path.
    pub(crate) fn run_to_line(
        &mut self,
        rows: impl IntoIterator<Item = usize>,
    ) -> (Option<usize>, Option<usize>, Vec<ExprId>) {
        let program = self.program;
        let row = rows.into_iter().find(|row| self.holds(program.rows[*row].guard, View::PLAIN));
        let lines = row.map_or(&[][..], |row| &program.rows[row].lines);
        let line = lines.iter().position(|line| self.holds(line.condition, View::PLAIN));
        let values = line.map_or(&program.default, |line| &lines[line].values);
        (row, line, values.iter().map(|value| self.resolve(*value, View::PLAIN)).collect())
    }

    /// The path in table notation: the state, then what was asked.
    pub(crate) fn describe(&self) -> String {
        let inputs = &self.program.inputs;
        let level = |input: InputId, level: u8| {
            let input = &inputs[input.index()];
            format!("{} = {}", input.name, input.show(Value::Level(level)))
        };
        let state = self.program.states.digits().iter().map(|(input, _)| level(*input, self.levels[input.index()]));
        let printer = Printer { pool: &self.pool, inputs };
        let asked = self.choices.iter().map(|choice| match (&choice.question, choice.compared) {
            (Question::Level(input), _) => level(*input, choice.answer),
            (Question::Sign(_), Some((a, b, negative))) => {
                let sign = Sign::ALL[usize::from(choice.answer)];
                let symbol = match if negative { sign.flip() } else { sign } {
                    Sign::Positive => "<",
                    Sign::Zero => "==",
                    Sign::Negative => ">",
                };
                format!("{} {symbol} {}", printer.expr(a), printer.expr(b))
            }
            (Question::Compare(op, a, b), _) => {
                let symbol = match op {
                    Comparison::Less => "<",
                    Comparison::LessEqual => "<=",
                    Comparison::Equal => "==",
                };
                let outcome = if choice.answer == 0 { "holds" } else { "does not hold" };
                format!("{} {symbol} {} {outcome}", printer.expr(*a), printer.expr(*b))
            }
            (Question::Sign(_), None) => String::new(),
        });
        state.chain(asked).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests;
