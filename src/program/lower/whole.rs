//! Whole numbers: what is one, what is calculated with them, and the ranges of results.
//!
//! A whole number is an expression like any other that is known to be whole, and never
//! so large that `f32` would round it. So every interpreter has it exactly, and code may
//! compute it as an integer or not. Only quotients and remainders differ from those of real
//! numbers, and no divisor is zero.

use std::collections::HashMap;
use std::sync::Arc;

use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result, SINCE, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::bits::InputSet;
use crate::program::domain::{LevelKind, Value};
use crate::program::operators::{BinaryOp, Comparison, Notation, TernaryOp, UnaryOp};
use crate::program::pool::{CondId, ExprId, MAX_WHOLE};
use crate::program::spans::Spans;
use crate::program::{InputId, LevelTerm, Row};
use crate::table::Output;
use crate::table::expr::Expr;

/// A line of a row, or the default: where it stands in the program.
type Place = Option<(usize, usize)>;

impl Lowering<'_> {
    /// Returns whether a term is a whole number, not counting constants, which go with any numbers.
    pub(super) fn is_whole(&self, term: &Term) -> bool {
        match term {
            Term::Whole(_) => true,
            Term::Level(set, _) => self.is_integer(*set),
            Term::Number(_) | Term::Word(_) | Term::Vector(_) | Term::Bool(_) | Term::List(_) | Term::Record(_) => {
                false
            }
        }
    }

    /// Says of an integer that a later version of the language calculates with it.
    pub(super) fn later(&self, term: &Term, error: Diagnostic) -> Diagnostic {
        match term {
            Term::Level(set, _) if self.sets[set.0].kind == LevelKind::Int && self.table.language.value < SINCE => {
                error.help(format!("from version {SINCE} of the language on integers are calculated with as they are"))
            }
            Term::Level(..)
            | Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::List(_)
            | Term::Record(_) => error,
        }
    }

    /// Returns whether levels are integers that can be calculated with.
    pub(super) fn is_integer(&self, set: SetId) -> bool {
        self.sets[set.0].kind == LevelKind::Int && self.table.language.value >= SINCE
    }

    /// The whole number that a term is; of constants, those that are whole.
    pub(super) fn whole_of(&mut self, term: &Term) -> Option<ExprId> {
        match term {
            Term::Whole(expr) => Some(*expr),
            Term::Level(set, level) if self.is_integer(*set) && !self.is_wide(*set) => {
                Some(self.level_number(*set, level, |me, level| me.sets[set.0].codes[usize::from(level)]))
            }
            Term::Number(expr) => self.pool.constant(*expr).filter(|value| value.fract() == 0.0).map(|_| *expr),
            Term::Level(..) | Term::Word(_) | Term::Vector(_) | Term::Bool(_) | Term::List(_) | Term::Record(_) => None,
        }
    }

    /// Operands as whole numbers, if one of them is; then all have to be.
    pub(super) fn wholes<const N: usize>(&mut self, terms: [&Term; N], span: Span) -> Result<Option<[ExprId; N]>> {
        if !terms.iter().any(|term| self.is_whole(term)) {
            return Ok(None);
        }
        if let Some((set, _)) = terms.iter().find_map(|term| self.wide_of(term)) {
            return Err(self.too_wide(set, span));
        }
        let found = terms.map(|term| self.whole_of(term));
        if let Some(place) = found.iter().position(Option::is_none) {
            let other = self.describe(terms[place]);
            let message = format!("a whole number and {other} do not go together");
            let error = Diagnostic::error(codes::TYPE, message).at(span, "in this operation");
            return Err(match terms[place] {
                Term::Bool(_) => error.help("`count(...)` is the number of conditions that hold"),
                Term::Level(..) => error.help("`index(...)` is the number of a level, counted from 0"),
                Term::Number(_)
                | Term::Whole(_)
                | Term::Word(_)
                | Term::Vector(_)
                | Term::List(_)
                | Term::Record(_) => error.help("`f32(...)` makes a number of a whole one"),
            });
        }
        let zero = self.pool.number(0.0);
        Ok(Some(found.map(|expr| expr.unwrap_or(zero))))
    }

    /// An operation on one whole number.
    pub(super) fn whole_unary(&mut self, op: UnaryOp, a: ExprId, span: Span) -> Result<Term> {
        if !matches!(op, UnaryOp::Negate | UnaryOp::Abs) {
            return Err(no_operation(op.row().notation, span));
        }
        let result = self.pool.unary(op, a);
        self.small(result, span)
    }

    /// An operation on two whole numbers.
    pub(super) fn whole_binary(&mut self, op: BinaryOp, a: ExprId, b: ExprId, span: Span) -> Result<Term> {
        let op = if op == BinaryOp::Divide { BinaryOp::WholeQuotient } else { op };
        let op = if op == BinaryOp::Remainder { BinaryOp::WholeRemainder } else { op };
        if !op.row().keeps_whole {
            return Err(no_operation(op.row().notation, span));
        }
        if matches!(op, BinaryOp::WholeQuotient | BinaryOp::WholeRemainder) {
            self.check_whole_divisor(b, span)?;
        }
        let result = self.pool.binary(op, a, b);
        self.small(result, span)
    }

    /// An operation on three whole numbers.
    pub(super) fn whole_ternary(&mut self, op: TernaryOp, [a, b, c]: [ExprId; 3], span: Span) -> Result<Term> {
        if op != TernaryOp::Clamp {
            return Err(no_operation(op.row().notation, span));
        }
        let result = self.ternary_number(op, [a, b, c], span)?;
        self.small(result, span)
    }

    /// Refuses whole numbers that can be larger than `f32` has exactly.
    fn small(&self, expr: ExprId, span: Span) -> Result<Term> {
        let facts = self.pool.expr_facts(expr);
        if facts.whole {
            return Ok(Term::Whole(expr));
        }
        // Of whole operands, not as wide as what may be rounded.
        let (lo, hi) = self.pool.range(self.pool.node(expr));
        let most = if -lo > hi { lo } else { hi };
        let message = match self.pool.constant(expr) {
            Some(value) => format!("a whole number here is {value}"),
            None if most.is_finite() => format!("a whole number here can be {most}"),
            None => "a whole number here can be too large".to_owned(),
        };
        Err(Diagnostic::error(codes::DOMAIN, message)
            .at(span, format!("beyond {MAX_WHOLE}"))
            .help("whole numbers are calculated as long as f32 has all of them; for more, calculate with f32(...)"))
    }

    /// Refuses to divide by what is zero somewhere.
    fn check_whole_divisor(&self, divisor: ExprId, span: Span) -> Result<()> {
        let error = || Diagnostic::error(codes::DIVISION_BY_ZERO, "division by zero");
        if self.pool.constant(divisor) == Some(0.0) {
            return Err(error().at(span, "the divisor is always zero"));
        }
        let facts = self.pool.expr_facts(divisor);
        if facts.range.0 > 0.0 || facts.range.1 < 0.0 {
            return Ok(());
        }
        let found = Spans::search(&self.pool, (facts.inputs, 1), &self.counts(), |spans| {
            let (lo, hi) = spans.span(divisor);
            (lo <= 0.0 && hi >= 0.0).then_some(())
        });
        let error = match found {
            Some(None) => return Ok(()),
            Some(Some(((), levels))) => error().at(span, format!("the divisor is zero at {}", self.shown(&levels))),
            None => error().at(span, "the divisor can be zero"),
        };
        Err(error.help("keep it away from zero where it is calculated, as `max(d, 1)` does"))
    }

    /// The number of levels of each input that has some.
    fn counts(&self) -> Vec<Option<usize>> {
        let count = |set: &Option<SetId>| set.map(|set| self.sets[set.0].count());
        self.input_sets.iter().map(count).collect()
    }

    /// Levels in the form that `--at` takes.
    fn shown(&self, levels: &[(InputId, u8)]) -> String {
        let one = |(input, level): &(InputId, u8)| {
            let input = &self.inputs[input.index()];
            format!("{}={}", input.name, input.show(Value::Level(*level)))
        };
        levels.iter().map(one).collect::<Vec<_>>().join(",")
    }

    /// A comparison of whole numbers, or of others. Constants go with both.
    pub(super) fn compared(&mut self, op: Comparison, [a, b]: [&Expr; 2], span: Span, env: &Env) -> Result<CondId> {
        let [left, right] = [a, b].map(|side| self.term(side, env, Expected::Anything));
        let (left, right) = (left?, right?);
        if let Some([x, y]) = self.words([&left, &right], false, span)? {
            return Ok(self.comparison(op, x, y));
        }
        if let Some(condition) = self.wide_compared(op, [&left, &right], span)? {
            return Ok(condition);
        }
        if let Some([x, y]) = self.compared_wholes([&left, &right], span)? {
            return Ok(self.comparison(op, x, y));
        }
        let number = |me: &Self, term: &Term, at: Span| {
            if let Term::Number(number) = term { Ok(*number) } else { Err(me.no_number(term, at)) }
        };
        let (x, y) = (number(self, &left, a.span)?, number(self, &right, b.span)?);
        Ok(self.comparison(op, x, y))
    }

    /// The sides of a comparison of whole numbers; a constant need not be whole.
    pub(super) fn compared_wholes(&mut self, [a, b]: [&Term; 2], span: Span) -> Result<Option<[ExprId; 2]>> {
        let constant = |term: &Term| self.constant_of(term);
        match (constant(a), constant(b)) {
            (None, Some(y)) if self.is_whole(a) => Ok(self.whole_of(a).map(|x| [x, y])),
            (Some(x), None) if self.is_whole(b) => Ok(self.whole_of(b).map(|y| [x, y])),
            _ => self.wholes([a, b], span),
        }
    }

    /// The constant that a number is.
    fn constant_of(&self, term: &Term) -> Option<ExprId> {
        let (Term::Number(expr) | Term::Whole(expr)) = term else { return None };
        self.pool.constant(*expr).map(|_| *expr)
    }

    /// The value of the constant that a number is.
    pub(super) fn constant_value(&self, term: &Term) -> Option<f64> {
        self.constant_of(term).and_then(|expr| self.pool.constant(expr))
    }

    /// The condition that a whole number is one of some.
    pub(super) fn whole_among(&mut self, expr: ExprId, numbers: &[Spanned<String>]) -> Result<CondId> {
        let mut any = Vec::new();
        for word in numbers {
            let number = word.value.parse::<f64>().ok().filter(|number| number.fract() == 0.0);
            let Some(number) = number else {
                return Err(type_error(word.span, &format!("`{}`", word.value), "expected a whole number"));
            };
            let number = self.pool.number(number);
            any.push(self.comparison(Comparison::Equal, expr, number));
        }
        Ok(self.pool.or(any))
    }

    /// The level of integers that a whole number is; it is one of them wherever it is needed.
    pub(super) fn level_of_whole(&mut self, set: SetId, expr: ExprId, span: Span) -> Result<Arc<LevelTerm>> {
        let codes = self.sets[set.0].codes.clone();
        let (first, last) = (codes[0], codes[codes.len() - 1]);
        let facts = self.pool.expr_facts(expr);
        let found = match first <= facts.range.0 && facts.range.1 <= last {
            true => Some(None),
            false => Spans::search(&self.pool, (facts.inputs, 1), &self.counts(), |spans| {
                let (lo, hi) = spans.span(expr);
                (lo < first || hi > last).then_some(if lo < first { lo } else { hi })
            }),
        };
        match found {
            Some(None) => {}
            Some(Some((value, levels))) => {
                return Err(Diagnostic::error(codes::DOMAIN, format!("{value} is not between {first} and {last}"))
                    .at(span, format!("as it is at {}", self.shown(&levels)))
                    .help(format!(
                        "what replaces an integer is one everywhere: limit it, as `clamp(..., {first}, {last})` does"
                    )));
            }
            None => {
                return Err(Diagnostic::error(codes::DOMAIN, format!("not seen to lie between {first} and {last}"))
                    .at(span, "depends on too many inputs"));
            }
        }
        // Of one input, its levels renamed; so symmetries are seen for what they are.
        let inputs: Vec<InputId> = facts.inputs.iter().collect();
        if let [input] = inputs.as_slice()
            && let Some(of) = self.input_sets[input.index()]
        {
            let mut renaming = Vec::new();
            let counts = self.counts();
            Spans::search(&self.pool, (InputSet::one(*input), 1), &counts, |spans| {
                renaming.push(spans.span(expr));
                None::<()>
            });
            let levels: Option<Vec<u8>> =
                renaming.iter().map(|(lo, hi)| (lo == hi).then_some((lo - first) as u8)).collect();
            if let Some(levels) = levels.filter(|levels| levels.len() == self.sets[of.0].count() && of != SetId::BOOL) {
                let inner = self.memo.level(LevelTerm::Input(*input));
                return Ok(self.memo.level(LevelTerm::Map(inner, levels.into())));
            }
        }
        let first = self.pool.number(first);
        let index = self.pool.binary(BinaryOp::Subtract, expr, first);
        Ok(self.level_with_index(set, index, &mut HashMap::new()))
    }

    /// The sum of truth values.
    pub(super) fn count(&mut self, conditions: &[CondId], span: Span) -> Result<Term> {
        let (one, mut sum) = (self.pool.number(1.0), self.pool.number(0.0));
        let zero = sum;
        for (place, condition) in conditions.iter().enumerate() {
            let truth = self.pool.select(*condition, one, zero);
            sum = if place == 0 { truth } else { self.pool.binary(BinaryOp::Add, sum, truth) };
        }
        self.small(sum, span)
    }

    /// Refuses an item of a list that can leave its range.
    pub(super) fn check_item(&self, of: &Output<SetId>, value: ExprId, span: Span) -> Result<()> {
        let Output::Int(from, to) = of else { return Ok(()) };
        let range = self.pool.expr_facts(value).range;
        if f64::from(*from) <= range.0 && range.1 <= f64::from(*to) {
            return Ok(());
        }
        let worst = if range.0 < f64::from(*from) { range.0 } else { range.1 };
        Err(self.out_of_range((worst, (*from, *to), None), span))
    }

    /// Refuses results of rows that can leave the range that is declared, with levels at which they do.
    pub(super) fn check_rows(&self, rows: &[Row], errors: &mut Vec<Diagnostic>) {
        for (row, case) in rows.iter().enumerate() {
            for (line, written) in case.lines.iter().enumerate() {
                let found = self.leaves(rows, Some((row, line)), &written.values);
                errors.extend(found.map(|error| self.out_of_range(error, written.span)));
            }
        }
    }

    /// The same of the default.
    pub(super) fn check_default(&self, rows: &[Row], default: &[ExprId], errors: &mut Vec<Diagnostic>) {
        let found = self.leaves(rows, None, default);
        errors.extend(found.map(|error| self.out_of_range(error, self.table.default.span)));
    }

    /// A result out of its range: the result, the range, and levels at which it comes about, if they were found.
    fn leaves(&self, rows: &[Row], at: Place, values: &[ExprId]) -> Option<Escape> {
        let mut ranges = Vec::new();
        whole_components(&self.output, &mut ranges);
        let outside = |(lo, hi): (f64, f64), (from, to): (i32, i32)| lo < f64::from(from) || hi > f64::from(to);
        values.iter().zip(ranges).find_map(|(value, range)| {
            let range = range?;
            let facts = self.pool.expr_facts(*value);
            if !outside(facts.range, range) {
                return None;
            }
            let before = at.map_or(rows, |(row, _)| &rows[..row]);
            let own = at.map(|(row, line)| (&rows[row], line));
            let mut inputs = facts.inputs;
            let wider = |all: InputSet, condition: CondId| all.or(self.pool.cond_facts(condition).inputs);
            if let Some((row, line)) = own {
                inputs = row.lines[..=line].iter().fold(wider(inputs, row.guard), |all, l| wider(all, l.condition));
            }
            let all = before.iter().fold(inputs, |all, row| wider(all, row.guard));
            let counts = self.counts();
            let mut test = |spans: &mut Spans<'_>| {
                let reached = own.is_none_or(|(row, line)| {
                    spans.truth(row.guard) != Some(false)
                        && spans.truth(row.lines[line].condition) != Some(false)
                        && row.lines[..line].iter().all(|line| spans.truth(line.condition) != Some(true))
                });
                // Lines may be missing, and then the default counts in spite of a case before it.
                let is_complete = |row: &Row| at.is_some() || row.lines.iter().any(|l| spans_always(self, l.condition));
                let free = before.iter().all(|row| !is_complete(row) || spans.truth(row.guard) != Some(true));
                let span = spans.span(*value);
                (reached && free && outside(span, range)).then_some(if span.0 < f64::from(range.0) {
                    span.0
                } else {
                    span.1
                })
            };
            let found = [all, inputs, facts.inputs]
                .into_iter()
                .find_map(|inputs| Spans::search(&self.pool, (inputs, 1 + before.len()), &counts, &mut test));
            match found {
                Some(None) => None,
                Some(Some((value, levels))) => Some((value, range, Some(self.shown(&levels)))),
                None => Some((facts.range.1, range, None)),
            }
        })
    }

    fn out_of_range(&self, (value, (from, to), place): Escape, span: Span) -> Diagnostic {
        let message = format!("the result can be {value}, which is not between {from} and {to}");
        let label = match place {
            Some(place) if !place.is_empty() => format!("for instance at {place}"),
            Some(_) | None => "not seen to stay in its range".to_owned(),
        };
        Diagnostic::error(codes::DOMAIN, message)
            .at(span, label)
            .at(self.table.output.span, "declared here")
            .help(format!("limit it, as with `clamp(..., {from}, {to})`, or give the output a wider range"))
    }
}

/// A result, its range, and a place where it leaves that.
type Escape = (f64, (i32, i32), Option<String>);

fn spans_always(lowering: &Lowering<'_>, condition: CondId) -> bool {
    lowering.pool.truth(condition) == Some(true)
}

/// By component, the range of whole numbers; those of lists are checked item by item.
pub(super) fn whole_components(output: &Output<SetId>, ranges: &mut Vec<Option<(i32, i32)>>) {
    match output {
        Output::Int(from, to) => ranges.push(Some((*from, *to))),
        Output::Record(fields) => fields.iter().for_each(|(_, of)| whole_components(of, ranges)),
        Output::Number(_)
        | Output::Vector(..)
        | Output::Bool
        | Output::U32
        | Output::Enumeration(_)
        | Output::List { .. } => {
            ranges.extend((0..output.size()).map(|_| None));
        }
    }
}

fn no_operation(notation: Notation, span: Span) -> Diagnostic {
    Diagnostic::error(codes::TYPE, format!("`{}` is no operation on whole numbers", notation.name()))
        .at(span, "of whole numbers here")
        .help("they have + - * / %, abs, min, max, clamp and comparisons; `f32(...)` makes a number of one")
}
