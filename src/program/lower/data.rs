//! Constant data that is indexed: by constants, by levels and whole numbers of inputs, and by
//! numbers between which it is interpolated.
//!
//! An index by a level becomes a choice between constants. What is indexed is known to lie in the
//! list before anything runs, or it is refused.

use std::ops::RangeInclusive;
use std::rc::Rc;
use std::sync::Arc;

use super::memo::Items;
use super::scope::Env;
use super::terms::{Call, Expected, Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::LevelTerm;
use crate::program::bits::LevelSet;
use crate::program::domain::LevelKind;
use crate::program::operators::{BinaryOp, Comparison};
use crate::program::pool::{CondId, ExprId};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{Constant, ConstantValue, Table};
use crate::text::closest::nearest;

/// Most numbers of a list that is interpolated, in all.
const MAX_KNOTS: usize = 1024;

/// The place in a list that an index means.
enum At {
    Known(usize),
    /// A whole number, and the places that it lies between.
    Whole(ExprId, RangeInclusive<usize>),
    /// A level, and the place that each level means.
    Level(SetId, Arc<LevelTerm>, Vec<usize>),
}

impl<'t> Lowering<'t> {
    /// `curve[i]`, `m[i, j]`, `m[i][j]`
    pub(super) fn item(&mut self, list: &Expr, indices: &[Expr], span: Span, env: &Env) -> Result<Term> {
        self.scopes[env.scope].since(2, span, "data that is indexed")?;
        let (mut base, mut all) = (list, vec![indices]);
        while let ExprKind::Index(inner, before) = &base.kind {
            all.insert(0, before);
            base = inner;
        }
        let indices: Vec<&Expr> = all.into_iter().flatten().collect();
        let (scope, index, constant) = self.indexed(base, env)?;
        if let ConstantValue::Levels { of, items } = &constant.value {
            if scope != 0 {
                let message = format!("`{}` is a list of levels of an imported table", constant.name.value);
                return Err(Diagnostic::error(codes::TYPE, message).at(span, "lists of numbers are imported"));
            }
            return self.item_of_levels(constant, of, items, &indices, span, env);
        }
        let rows = self.rows_of_constant(index, &constant.name, base.span, scope)?;
        let width = rows.first().map_or(0, Vec::len);
        if indices.len() > usize::from(width > 1) + 1 {
            return Err(too_many_indices(&constant.name, span));
        }
        let first = self.index(indices[0], rows.len(), (scope, constant), env)?;
        let second = indices.get(1).map(|second| self.index(second, width, (scope, constant), env)).transpose()?;
        let number = |place: &[usize]| rows[place[0]][place[1]];
        if let Some(second) = second {
            return Ok(Term::Number(self.choose_item(&[first, second], &number, &mut Vec::new())));
        }
        if width > 4 {
            let message = format!("the items of `{}` have {width} numbers each", constant.name.value);
            return Err(Diagnostic::error(codes::TYPE, message)
                .at(span, "one index of two")
                .help(format!("write a second index: `{}[i, j]`", constant.name.value)));
        }
        let mut at = vec![first, At::Known(0)];
        let mut parts = Vec::new();
        for part in 0..width {
            at[1] = At::Known(part);
            parts.push(self.choose_item(&at, &number, &mut Vec::new()));
        }
        Ok(if width == 1 { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// An item of a list of levels.
    fn item_of_levels(
        &mut self,
        constant: &Constant,
        of: &Spanned<String>,
        items: &[Vec<Spanned<String>>],
        indices: &[&Expr],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let (set, levels) = self.levels_of_constant(of, items)?;
        let width = levels.first().map_or(0, Vec::len);
        if indices.len() > usize::from(width > 1) + 1 {
            return Err(too_many_indices(&constant.name, span));
        }
        let first = self.index(indices[0], levels.len(), (0, constant), env)?;
        let second = match indices.get(1) {
            Some(second) => self.index(second, width, (0, constant), env)?,
            None if width > 1 => {
                return Err(Diagnostic::error(codes::TYPE, format!("`{}` has two dimensions", constant.name.value))
                    .at(span, "one index of two")
                    .help(format!("write a second index: `{}[i, j]`", constant.name.value)));
            }
            None => At::Known(0),
        };
        let either = |me: &mut Self, condition, a, b| me.memo.level(LevelTerm::If(condition, a, b));
        // Items of the first dimension, of which the second index picks one.
        let of = |me: &mut Self, row: &[u8]| match &second {
            At::Level(_, term, places) => {
                let map: Vec<u8> = places.iter().map(|place| row[*place]).collect();
                me.memo.level(LevelTerm::Map(term.clone(), map.into()))
            }
            At::Known(_) | At::Whole(..) => {
                me.pick(&second, &mut |me, place| me.memo.level(LevelTerm::Const(row[place])), &either)
            }
        };
        let term = match (&first, &second) {
            (At::Level(_, term, places), At::Known(second)) => {
                let map: Vec<u8> = places.iter().map(|place| levels[*place][*second]).collect();
                self.memo.level(LevelTerm::Map(term.clone(), map.into()))
            }
            _ => self.pick(&first, &mut |me, place| of(me, &levels[place]), &either),
        };
        Ok(Term::Level(set, term))
    }

    /// The levels of a list, item by item, and their set.
    pub(super) fn levels_of_constant(
        &mut self,
        of: &Spanned<String>,
        items: &[Vec<Spanned<String>>],
    ) -> Result<(SetId, Vec<Vec<u8>>)> {
        let set = self.find_set(of)?;
        let mut levels = Vec::new();
        for row in items {
            let row = row.iter().map(|word| match self.sets[set.0].find(&word.value) {
                Some(level) => Ok(level),
                None => Err(self.unknown_level(set, &word.value, word.span)),
            });
            levels.push(row.collect::<Result<Vec<u8>>>()?);
        }
        Ok((set, levels))
    }

    /// The constant that is indexed, its place, and the scope of its table.
    fn indexed(&self, base: &Expr, env: &Env) -> Result<(usize, usize, &'t Constant)> {
        let Some(written) = base.name() else {
            return Err(Diagnostic::error(codes::TYPE, "only constant data is indexed")
                .at(base.span, "expected the name of a list of `constants`"));
        };
        let (scope, name) = self.in_import(written, env.scope).unwrap_or((env.scope, written));
        let constants: &'t [Constant] = &self.scopes[scope].constants;
        let lists = || constants.iter().filter(|c| !matches!(c.value, ConstantValue::Number(_)));
        let hidden = env.locals.iter().any(|(local, _)| local.value == written);
        let found = constants.iter().position(|constant| constant.name.value == name && !hidden);
        if let Some(index) = found.filter(|index| !matches!(constants[*index].value, ConstantValue::Number(_))) {
            return Ok((scope, index, &constants[index]));
        }
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{written}` is not a list of constants"))
            .at(base.span, "only constant data is indexed");
        Err(match nearest(name, lists().map(|c| c.name.value.as_str())) {
            Some(close) => error.did_you_mean(written, &written.replace(name, close)),
            None => error.help("declare a list: constants: {\"curve\": [0, 0.25, 1]}"),
        })
    }

    /// The place that an index means, of so many.
    fn index(&mut self, index: &Expr, count: usize, (scope, constant): (usize, &Constant), env: &Env) -> Result<At> {
        let name = &constant.name.value;
        let outside = |what: String| {
            Diagnostic::error(codes::DOMAIN, format!("an index that is beyond `{name}`"))
                .at(index.span, format!("{what}, of {count} items that are counted from 0"))
        };
        let declared = |error: Diagnostic, label: &str| match scope {
            0 => error.at(constant.name.span, label),
            // Places in another file cannot be shown here.
            _ => error,
        };
        let outside = |what: String| declared(outside(what), "declared here");
        match self.term(index, env, Expected::Anything)? {
            Term::Number(number) => match self.pool.constant(number) {
                Some(place) if place.fract() == 0.0 && (0.0..count as f64).contains(&place) => {
                    Ok(At::Known(place as usize))
                }
                Some(place) => Err(outside(format!("this is {place}"))),
                None => Err(Diagnostic::error(codes::NOT_CONSTANT, "an index that is a number is constant")
                    .at(index.span, "depends on inputs")
                    .help("what may be anywhere in a list is an `Int` input, a level or a condition")
                    .help(format!("`lookup({name}, x)` interpolates at a number from 0 to 1"))),
            },
            Term::Whole(number) | Term::Word(number) => {
                let (lo, hi) = self.pool.expr_facts(number).range;
                if !(lo >= 0.0 && hi < count as f64) {
                    let what = if lo < 0.0 { lo } else { hi };
                    return Err(outside(format!("this can be {what}")).help("limit it with `clamp`, `min`, `%` or `&`"));
                }
                Ok(match self.pool.known(number) {
                    Some(place) => At::Known(place as usize),
                    None => At::Whole(number, lo as usize..=hi as usize),
                })
            }
            Term::Level(set, term) => {
                let levels = &self.sets[set.0];
                let places: Vec<f64> = match levels.kind {
                    LevelKind::Int => levels.codes.clone(),
                    LevelKind::Named | LevelKind::Bool => (0..levels.count()).map(|level| level as f64).collect(),
                };
                if let Some(place) = places.iter().find(|place| !(0.0..count as f64).contains(*place)) {
                    return Err(outside(format!("this can be {place}")));
                }
                if levels.kind == LevelKind::Named && levels.count() != count {
                    let message = format!("`{name}` has {count} items for {} levels", levels.count());
                    let error = Diagnostic::error(codes::DOMAIN, message)
                        .at(index.span, format!("the levels are: {}", levels.names.join(", ")));
                    return Err(declared(error, "expected an item for each of them, in their order"));
                }
                let places: Vec<usize> = places.into_iter().map(|place| place as usize).collect();
                Ok(match *term {
                    LevelTerm::Const(level) => At::Known(places[usize::from(level)]),
                    LevelTerm::Input(_) | LevelTerm::If(..) | LevelTerm::Map(..) => At::Level(set, term, places),
                })
            }
            Term::Bool(condition) if count >= 2 => {
                let term = self.truth_as_level(condition);
                Ok(At::Level(SetId::BOOL, self.memo.level(term), vec![0, 1]))
            }
            Term::Bool(_) => Err(outside("this can be 1".to_owned())),
            other @ (Term::Vector(_) | Term::List(_) | Term::Record(_)) => {
                Err(type_error(index.span, &self.describe(&other), "expected a whole number, a level or a condition"))
            }
        }
    }

    /// The number at a place, where some indices are levels.
    fn choose_item(&mut self, at: &[At], number: &dyn Fn(&[usize]) -> f64, place: &mut Vec<usize>) -> ExprId {
        let Some((first, rest)) = at.split_first() else { return self.pool.number(number(place)) };
        let mut of = |me: &mut Self, chosen: usize| {
            place.push(chosen);
            let value = me.choose_item(rest, number, place);
            place.pop();
            value
        };
        self.pick(first, &mut of, &|me, condition, a, b| me.pool.select(condition, a, b))
    }

    /// The thing at a place; `either` chooses between two things by a condition.
    fn pick<T>(
        &mut self,
        at: &At,
        of: &mut dyn FnMut(&mut Self, usize) -> T,
        either: &dyn Fn(&mut Self, CondId, T, T) -> T,
    ) -> T {
        let (last, others) = match at {
            At::Known(place) => (*place, Vec::new()),
            At::Level(_, _, places) => (places[places.len() - 1], places[..places.len() - 1].to_vec()),
            At::Whole(_, places) => (*places.end(), (*places.start()..*places.end()).collect()),
        };
        let mut value = of(self, last);
        for (level, place) in others.into_iter().enumerate().rev() {
            let condition = match at {
                At::Known(_) => continue,
                At::Level(set, term, _) => self.level_in(*set, term, LevelSet::one(level as u8)),
                At::Whole(whole, _) => {
                    let place = match self.pool.is_word(*whole) {
                        true => self.pool.constant_word(place as u32),
                        false => self.pool.number(place as f64),
                    };
                    self.pool.compare(Comparison::Equal, *whole, place)
                }
            };
            let then = of(self, place);
            value = either(self, condition, then, value);
        }
        value
    }

    /// The numbers of a list of constants, item by item.
    pub(super) fn rows_of_constant(
        &mut self,
        index: usize,
        name: &Spanned<String>,
        at: Span,
        scope: usize,
    ) -> Result<Items> {
        if let Some(known) = self.memo.lists.get(&(scope, index)) {
            return Ok(known.clone());
        }
        let table: &'t Table = self.scopes[scope];
        let rows: Vec<Vec<f64>> = match &table.constants[index].value {
            ConstantValue::List(items) => {
                let width = items.first().map_or(0, Vec::len);
                if let Some(odd) = items.iter().find(|item| item.len() != width || width == 0) {
                    let message = format!("the items of `{}` differ in length", name.value);
                    let at = odd.first().map_or(at, |number| number.span);
                    return Err(Diagnostic::error(codes::NOT_CONSTANT, message).at(at, format!("not {width} numbers")));
                }
                let numbers = |me: &mut Self, item: &[Expr]| -> Result<Vec<f64>> {
                    item.iter().map(|number| me.constant_number(number, index, scope)).collect()
                };
                items.iter().map(|item| numbers(self, item)).collect::<Result<_>>()?
            }
            ConstantValue::File(_, data) => data.as_ref().map_or(Vec::new(), |data| data.rows.clone()),
            ConstantValue::Number(_) | ConstantValue::Levels { .. } => {
                return Err(type_error(at, "something else", "expected a list of numbers"));
            }
        };
        let rows: Items = Rc::new(rows);
        self.memo.lists.insert((scope, index), rows.clone());
        Ok(rows)
    }

    /// `lookup(curve, x)`, `lookup(m, x, y)`: interpolated between the items, and clamped.
    pub(super) fn lookup(&mut self, call: Call<'_>) -> Result<Term> {
        let Call { arguments, span, env, .. } = call;
        if !(2..=3).contains(&arguments.len()) {
            let message = format!("`lookup` takes 2 or 3 arguments, not {}", arguments.len());
            return Err(Diagnostic::error(codes::CALL, message)
                .at(span, "wrong number of arguments")
                .help("`lookup(curve, x)`, or of two dimensions `lookup(m, x, y)`, at numbers from 0 to 1"));
        }
        let (scope, index, constant) = self.indexed(&arguments[0], env)?;
        let rows = self.rows_of_constant(index, &constant.name, arguments[0].span, scope)?;
        let width = rows.first().map_or(0, Vec::len);
        if rows.is_empty() {
            let message = format!("`{}` has no items", constant.name.value);
            return Err(Diagnostic::error(codes::TOO_MANY_TERMS, message).at(arguments[0].span, "an empty list"));
        }
        if rows.len() * width > MAX_KNOTS {
            let message = format!("`{}` has {} numbers", constant.name.value, rows.len() * width);
            return Err(Diagnostic::error(codes::TOO_MANY_TERMS, message)
                .at(arguments[0].span, format!("interpolated between here, at most {MAX_KNOTS}"))
                .help("every segment is written out; take fewer knots, or let the host sample a texture in a fetch"));
        }
        let along = self.scaled(&arguments[1], rows.len(), env)?;
        if let Some(second) = arguments.get(2) {
            let across = self.scaled(second, width, env)?;
            let mut knots = Vec::new();
            for row in rows.iter() {
                let row: Vec<ExprId> = row.iter().map(|number| self.pool.number(*number)).collect();
                knots.push(self.interpolated(across, &row, (0, width), span)?);
            }
            return self.interpolated(along, &knots, (0, knots.len()), span).map(Term::Number);
        }
        if width > 4 {
            return Err(Diagnostic::error(codes::TYPE, format!("`{}` has two dimensions", constant.name.value))
                .at(span, "one coordinate of two")
                .help(format!("`lookup({}, x, y)`", constant.name.value)));
        }
        let mut parts = Vec::new();
        for part in 0..width {
            let knots: Vec<ExprId> = rows.iter().map(|row| self.pool.number(row[part])).collect();
            parts.push(self.interpolated(along, &knots, (0, knots.len()), span)?);
        }
        Ok(if width == 1 { Term::Number(parts[0]) } else { Term::Vector(parts) })
    }

    /// A coordinate from 0 to 1 as one that counts knots.
    fn scaled(&mut self, coordinate: &Expr, knots: usize, env: &Env) -> Result<ExprId> {
        let number = self.numeric(coordinate, env)?;
        let last = self.pool.number((knots - 1) as f64);
        self.binary_number(BinaryOp::Multiply, number, last, coordinate.span)
    }

    /// The value at a coordinate that counts knots, as a tree of choices between segments. Of those, number 0 lies
    /// before the first knot and the last one behind the last; the tree is that of some of them, from one to another.
    fn interpolated(&mut self, at: ExprId, knots: &[ExprId], (lo, hi): (usize, usize), span: Span) -> Result<ExprId> {
        if lo < hi {
            let middle = usize::midpoint(lo, hi);
            let knot = self.pool.number(middle as f64);
            let before = self.comparison(Comparison::Less, at, knot);
            let left = self.interpolated(at, knots, (lo, middle), span)?;
            let right = self.interpolated(at, knots, (middle + 1, hi), span)?;
            return Ok(self.pool.select(before, left, right));
        }
        if lo == 0 || lo == knots.len() || knots[lo - 1] == knots[lo] {
            return Ok(knots[lo.saturating_sub(1)]);
        }
        let (from, to) = (knots[lo - 1], knots[lo]);
        let begin = self.pool.number((lo - 1) as f64);
        let along = self.binary_number(BinaryOp::Subtract, at, begin, span)?;
        let change = self.binary_number(BinaryOp::Subtract, to, from, span)?;
        let change = self.binary_number(BinaryOp::Multiply, along, change, span)?;
        self.binary_number(BinaryOp::Add, from, change, span)
    }
}

fn too_many_indices(name: &Spanned<String>, span: Span) -> Diagnostic {
    Diagnostic::error(codes::TYPE, format!("`{}` has fewer dimensions than that", name.value))
        .at(span, "an index too many")
}
