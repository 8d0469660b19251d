//! Integers of any range, which are known by their classes only.
//!
//! Which classes there are depends on what the table asks for, and that is seen only as it is
//! lowered. So a table with such inputs is lowered again with every cut that was missing, until
//! none is: what was made before is thrown away, mistakes included.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::terms::{Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::LevelTerm;
use crate::program::bits::LevelSet;
use crate::program::classes::{Classes, Cuts};
use crate::program::domain::{LevelKind, Levels, MAX_LEVELS};
use crate::program::operators::{BinaryOp, Comparison, TernaryOp};
use crate::program::pool::{CondId, ExprId};
use crate::table;

/// The cuts of inputs, by their names.
pub(super) type AllCuts = BTreeMap<String, Cuts>;

/// Lowers something until all cuts that it needs are there. That ends: each time some input falls into more
/// classes, or has another divisor, and of both there are few.
pub(super) fn refined<T>(mut lower: impl FnMut(&AllCuts) -> (T, AllCuts)) -> T {
    let mut cuts = AllCuts::new();
    loop {
        let (result, wanted) = lower(&cuts);
        if wanted.is_empty() {
            return result;
        }
        for (name, more) in wanted {
            let known = cuts.entry(name).or_default();
            known.starts.extend(more.starts);
            known.moduli.extend(more.moduli);
        }
    }
}

impl<'t> Lowering<'t> {
    /// The integers of an input.
    pub(super) fn integers(&self, input: &'t table::Input, from: i64, to: i64) -> Result<Levels> {
        let span = input.domain.span;
        let error = |message: String| Diagnostic::error(codes::DOMAIN, message).at(span, "in this domain");
        let limits = i64::from(i32::MIN)..=i64::from(i32::MAX);
        if from >= to || !limits.contains(&from) || !limits.contains(&to) {
            return Err(error("integers go from a smaller to a larger one, both within 32 bits".to_owned()));
        }
        let few = to - from < MAX_LEVELS as i64;
        let classes = match few {
            true if from.unsigned_abs().max(to.unsigned_abs()) > 1 << 24 => {
                return Err(error("few integers are calculated with, so they are within 2^24 of zero".to_owned()));
            }
            true => Classes::each(from, to),
            false => {
                let cuts = self.cuts.get(&input.name.value).cloned().unwrap_or_default();
                Classes::new(from, to, &cuts, MAX_LEVELS).map_err(|count| {
                    error(format!("the table tells {count} kinds of `{}` apart, at most {MAX_LEVELS}", input.name.value))
                        .help("every constant that it is compared with makes another kind, every divisor multiplies them")
                        .help("declare a narrow range, from: and to:, if it has few values, or a `Range` if order is all that counts")
                })?
            }
        };
        let names = match few {
            true => (from..=to).map(|integer| integer.to_string()).collect(),
            false => classes.names(),
        };
        let codes = classes.members().into_iter().map(|integer| integer as f64).collect();
        Ok(Levels { names, codes, kind: LevelKind::Int, classes: Some(classes) })
    }

    /// Returns whether levels are classes of integers.
    pub(super) fn is_wide(&self, set: SetId) -> bool {
        self.sets[set.0].is_wide()
    }

    /// The level of an integer of any range, if a term is one.
    pub(super) fn wide_of(&self, term: &Term) -> Option<(SetId, Arc<LevelTerm>)> {
        match term {
            Term::Level(set, level) if self.is_wide(*set) => Some((*set, level.clone())),
            Term::Level(..)
            | Term::Number(_)
            | Term::Whole(_)
            | Term::Word(_)
            | Term::Vector(_)
            | Term::Bool(_)
            | Term::List(_)
            | Term::Record(_) => None,
        }
    }

    /// Asks for cuts. Until they are there, what is made of the classes is worth nothing.
    fn want(&mut self, set: SetId, starts: impl IntoIterator<Item = i64>, modulus: i64) {
        let Some((name, (least, most))) =
            self.wide.get(&set.0).zip(self.sets[set.0].classes.as_ref().map(Classes::range))
        else {
            return;
        };
        let known = self.cuts.get(name);
        let missing: Vec<i64> = starts
            .into_iter()
            .filter(|start| (least + 1..=most).contains(start))
            .filter(|start| !known.is_some_and(|cuts| cuts.starts.contains(start)))
            .collect();
        let divides = modulus == 1 || known.is_some_and(|cuts| cuts.moduli.contains(&modulus));
        if missing.is_empty() && divides {
            return;
        }
        let wanted = self.wanted.entry(name.clone()).or_default();
        wanted.starts.extend(missing);
        if !divides {
            wanted.moduli.insert(modulus);
        }
    }

    /// The classes whose integers a test accepts, which does not tell those of one class apart.
    fn classes_where(&self, set: SetId, accepts: impl Fn(i64) -> bool) -> LevelSet {
        let members = self.sets[set.0].codes.iter().enumerate().filter(|(_, code)| accepts(**code as i64));
        LevelSet(members.fold(0, |all, (level, _)| all | LevelSet::one(level as u8).0))
    }

    /// A comparison of an integer of any range with a constant: `integer op constant`, or the other way round.
    pub(super) fn wide_comparison(
        &mut self,
        op: Comparison,
        (set, term): (SetId, &LevelTerm),
        constant: f64,
        is_right: bool,
    ) -> CondId {
        // The first integer at which the outcome changes; beyond 32 bits it does so nowhere.
        let limit = |value: f64| value.clamp(-1e12, 1e12) as i64;
        let (floor, ceil) = (limit(constant.floor()), limit(constant.ceil()));
        let starts = match (op, is_right) {
            (Comparison::Less, false) | (Comparison::LessEqual, true) => vec![ceil],
            (Comparison::LessEqual, false) | (Comparison::Less, true) => vec![floor + 1],
            (Comparison::Equal, _) if floor == ceil => vec![floor, floor + 1],
            (Comparison::Equal, _) => Vec::new(),
        };
        self.want(set, starts, 1);
        let levels = self.classes_where(set, |integer| match is_right {
            false => op.holds(integer as f64, constant),
            true => op.holds(constant, integer as f64),
        });
        self.level_in(set, term, levels)
    }

    /// The condition that an integer of any range is one of some.
    pub(super) fn wide_among(&mut self, term: (SetId, &LevelTerm), integers: &[Spanned<String>]) -> Result<CondId> {
        let mut any = Vec::new();
        for word in integers {
            match word.value.parse::<f64>() {
                Ok(integer) => any.push(self.wide_comparison(Comparison::Equal, term, integer, false)),
                Err(_) => return Err(self.unknown_level(term.0, &word.value, word.span)),
            }
        }
        Ok(self.pool.or(any))
    }

    /// The remainder of an integer of any range by a constant.
    pub(super) fn wide_remainder(
        &mut self,
        (set, term): (SetId, &LevelTerm),
        modulus: f64,
        span: Span,
    ) -> Result<Term> {
        let modulus = match modulus {
            0.0 => {
                return Err(Diagnostic::error(codes::DIVISION_BY_ZERO, "division by zero")
                    .at(span, "the divisor is always zero"));
            }
            modulus if modulus.abs() > MAX_LEVELS as f64 => {
                return Err(Diagnostic::error(codes::DOMAIN, format!("a remainder by {modulus}"))
                    .at(span, format!("integers of a large range are divided by {MAX_LEVELS} at most")));
            }
            modulus => modulus.abs() as i64,
        };
        self.want(set, [0], modulus);
        Ok(Term::Whole(self.of_classes(set, term, |integer| integer % modulus)))
    }

    /// A function of an integer of any range that has few values, and changes at some integers only.
    fn of_classes(&mut self, set: SetId, term: &LevelTerm, value: impl Fn(i64) -> i64) -> ExprId {
        let mut values: Vec<i64> = self.sets[set.0].codes.iter().map(|code| value(*code as i64)).collect();
        values.sort_unstable();
        values.dedup();
        // What most integers come to stands last.
        let last = values.pop().unwrap_or_default();
        let mut result = self.pool.number(last as f64);
        for candidate in values.into_iter().rev() {
            let levels = self.classes_where(set, |integer| value(integer) == candidate);
            let is_it = self.level_in(set, term, levels);
            let candidate = self.pool.number(candidate as f64);
            result = self.pool.select(is_it, candidate, result);
        }
        result
    }

    /// An integer of any range kept between constants, if that leaves few.
    fn wide_limited(
        &mut self,
        (set, term): (SetId, &LevelTerm),
        (lo, hi): (Option<f64>, Option<f64>),
        span: Span,
    ) -> Result<Term> {
        let (least, most) = self.sets[set.0].classes.as_ref().map_or((0, 0), Classes::range);
        let whole = |bound: Option<f64>, other: i64| match bound {
            None => Some(other),
            Some(bound) => (bound.fract() == 0.0 && bound.abs() <= 16_777_216.0).then_some(bound as i64),
        };
        let bounds = whole(lo, least).zip(whole(hi, most)).filter(|(lo, hi)| lo <= hi && hi - lo < MAX_LEVELS as i64);
        let Some((lo, hi)) = bounds.map(|(lo, hi)| (lo.max(least.min(hi)), hi.min(most.max(lo)))) else {
            return Err(self.too_wide(set, span));
        };
        self.want(set, lo + 1..=hi, 1);
        Ok(Term::Whole(self.of_classes(set, term, |integer| integer.clamp(lo, hi))))
    }

    /// An operation of which one operand is an integer of any range.
    pub(super) fn wide_binary(&mut self, op: BinaryOp, a: &Term, b: &Term, span: Span) -> Result<Option<Term>> {
        let (wide, other, first) = match (self.wide_of(a), self.wide_of(b)) {
            (None, None) => return Ok(None),
            (Some(wide), _) => (wide, self.constant_value(b), true),
            (None, Some(wide)) => (wide, self.constant_value(a), false),
        };
        let term = (wide.0, &*wide.1);
        match (op, other) {
            (BinaryOp::Remainder, Some(modulus)) if first && modulus.fract() == 0.0 => {
                self.wide_remainder(term, modulus, span).map(Some)
            }
            (BinaryOp::Min, Some(hi)) => self.wide_limited(term, (None, Some(hi)), span).map(Some),
            (BinaryOp::Max, Some(lo)) => self.wide_limited(term, (Some(lo), None), span).map(Some),
            _ => Err(self.too_wide(wide.0, span)),
        }
    }

    /// A limit of an integer of any range.
    pub(super) fn wide_ternary(&mut self, op: TernaryOp, terms: [&Term; 3], span: Span) -> Result<Option<Term>> {
        let Some(wide) = terms.into_iter().find_map(|term| self.wide_of(term)) else { return Ok(None) };
        match (op, self.constant_value(terms[1]), self.constant_value(terms[2])) {
            (TernaryOp::Clamp, Some(lo), Some(hi)) if self.wide_of(terms[0]).is_some() && lo <= hi => {
                self.wide_limited((wide.0, &wide.1), (Some(lo), Some(hi)), span).map(Some)
            }
            _ => Err(self.too_wide(wide.0, span)),
        }
    }

    /// The class of another table's integers that an integer is of, which is told apart here as it is there.
    pub(super) fn class_in(&mut self, levels: &Levels, term: &Term, span: Span) -> Result<(SetId, Arc<LevelTerm>)> {
        let refused = |me: &Self| {
            let message = format!("expected one of {}", levels.describe());
            Err(type_error(span, &me.describe(term), &message).help("give a constant, or an `Int` input"))
        };
        let Some(classes) = &levels.classes else { return refused(self) };
        if let Some(integer) = self.constant_value(term) {
            let level = levels.find(&integer.to_string());
            let level = level.map(|level| self.memo.level(LevelTerm::Const(level)));
            return level.map_or_else(|| refused(self), |level| Ok((SetId::BOOL, level)));
        }
        let Term::Level(set, level) = term else { return refused(self) };
        if !self.is_integer(*set) {
            return refused(self);
        }
        if self.is_wide(*set) {
            let (starts, modulus) = classes.cuts();
            self.want(*set, starts, modulus);
        }
        let map = self.sets[set.0].codes.iter().map(|code| classes.find(*code as i64));
        match map.collect::<Option<Vec<u8>>>() {
            Some(map) => Ok((*set, self.memo.level(LevelTerm::Map(level.clone(), map.into())))),
            None => refused(self),
        }
    }

    /// The refusal of a number that is known by its class only.
    pub(super) fn too_wide(&self, set: SetId, span: Span) -> Diagnostic {
        let name = self.wide.get(&set.0).map_or("an integer", String::as_str);
        Diagnostic::error(codes::TYPE, format!("`{name}` has more values than are calculated with"))
            .at(span, "more than 64 integers")
            .help(format!(
                "compare it with constants, take the remainder by a constant, or limit it, as `min({name}, 3)` does"
            ))
            .help("where the number itself counts, let the host pass it as a `Range` as well")
    }

    /// A comparison with an integer of any range, if a side is one.
    pub(super) fn wide_compared(&mut self, op: Comparison, [a, b]: [&Term; 2], span: Span) -> Result<Option<CondId>> {
        match (self.wide_of(a), self.wide_of(b)) {
            (None, None) => Ok(None),
            (Some((set, term)), None) if self.constant_value(b).is_some() => {
                let constant = self.constant_value(b).unwrap_or_default();
                Ok(Some(self.wide_comparison(op, (set, &term), constant, false)))
            }
            (None, Some((set, term))) if self.constant_value(a).is_some() => {
                let constant = self.constant_value(a).unwrap_or_default();
                Ok(Some(self.wide_comparison(op, (set, &term), constant, true)))
            }
            (Some((set, _)), _) | (_, Some((set, _))) => {
                let error = self.too_wide(set, span);
                Err(Diagnostic { message: "integers of any range are compared with constants".to_owned(), ..error })
            }
        }
    }
}
