//! Expressions that are conditions, and conditions that are written as data.

use super::Maker;
use super::expression::{AND, COMPARISON, Construct, MEMBER, OR, PREFIX, Piece, SUM, Scope, Type};
use super::inputs::Kind;

/// The constructs that make conditions.
pub(super) const ALL: &[Construct] = &[
    (5, both),
    (4, one_of),
    (3, not),
    (5, comparison),
    (5, level),
    (2, equivalent),
    (1, truth),
    (3, super::whole::comparison),
    (4, super::whole::asked),
];

const CONDITION: Type = Type::Condition;

/// The simplest condition: that of a level, or of a number.
pub(super) fn leaf(maker: &mut Maker<'_, '_>, scope: &Scope) -> Piece {
    let made = match maker.choices.either() {
        true => comparison(maker, scope, &CONDITION, 0),
        false => level(maker, scope, &CONDITION, 0),
    };
    made.or_else(|| comparison(maker, scope, &CONDITION, 0)).unwrap_or_else(|| Piece::primary("true"))
}

fn both(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let [a, b] = [AND, AND + 1].map(|strength| maker.operand(scope, &CONDITION, depth, strength));
    Some(Piece::new(AND, format!("{a} && {b}")))
}

fn one_of(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let [a, b] = [OR, OR + 1].map(|strength| maker.operand(scope, &CONDITION, depth, strength));
    Some(Piece::new(OR, format!("{a} || {b}")))
}

fn not(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    Some(Piece::new(PREFIX, format!("!{}", maker.operand(scope, &CONDITION, depth, PREFIX))))
}

/// Two numbers, of which at least one is no constant.
fn comparison(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let numbers: Vec<String> = scope.of(&Type::Number).iter().map(|visible| visible.text.clone()).collect();
    if numbers.is_empty() {
        return None;
    }
    let symbol = *maker.choices.pick(&["<", "<=", ">", ">=", "<", ">", "==", "!="]);
    let mut a = match depth {
        0 => maker.choices.pick(&numbers).clone(),
        _ => maker.operand(scope, &Type::Number, depth, SUM),
    };
    let mut b = match maker.choices.below(3) {
        0 => maker.choices.pick(&["0.5", "0.25", "0.1", "0", "1", "0.75", "0.3"]).to_string(),
        1 => maker.choices.pick(&numbers).clone(),
        _ => maker.operand(scope, &Type::Number, depth, SUM),
    };
    if maker.choices.one_in(4) {
        std::mem::swap(&mut a, &mut b);
    }
    Some(Piece::new(COMPARISON, format!("{a} {symbol} {b}")))
}

/// A level compared with one or with several.
fn level(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let levels: Vec<(String, usize)> = scope
        .visible
        .iter()
        .filter_map(|visible| match visible.ty {
            Type::Level(set) => Some((visible.text.clone(), set)),
            Type::Number
            | Type::Condition
            | Type::Whole(..)
            | Type::Wide
            | Type::Vector(_)
            | Type::Record(_)
            | Type::List(..) => None,
        })
        .collect();
    if levels.is_empty() {
        return None;
    }
    let (name, set) = maker.choices.pick(&levels).clone();
    match maker.choices.below(5) {
        0 | 1 => {
            let symbol = *maker.choices.pick(&["==", "!="]);
            let other = maker.level_of(set);
            Some(Piece::new(COMPARISON, format!("{name} {symbol} {other}")))
        }
        2 => {
            let symbol = *maker.choices.pick(&["==", "!="]);
            let other = maker.operand(scope, &Type::Level(set), depth.min(1), SUM);
            Some(Piece::new(COMPARISON, format!("{name} {symbol} {other}")))
        }
        form => {
            let all = if form == 3 { maker.sets[set].levels.clone() } else { maker.sets[set].codes.clone() };
            let some = maker.choices.some(&all);
            Some(Piece::new(MEMBER, format!("{name} in {{{}}}", some.join(", "))))
        }
    }
}

fn equivalent(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let symbol = *maker.choices.pick(&["==", "!="]);
    let [a, b] = [(); 2].map(|()| maker.operand(scope, &CONDITION, depth, SUM));
    Some(Piece::new(COMPARISON, format!("{a} {symbol} {b}")))
}

fn truth(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, _: usize) -> Option<Piece> {
    let bools: Vec<String> = scope.of(&CONDITION).iter().map(|visible| visible.text.clone()).collect();
    if bools.is_empty() {
        return None;
    }
    let word = *maker.choices.pick(&["true", "false", "1", "0"]);
    Some(Piece::new(MEMBER, format!("{} in {{{word}}}", maker.choices.pick(&bools))))
}

impl Maker<'_, '_> {
    /// A condition as it stands in RON: an expression, or data.
    pub(super) fn guard(&mut self, scope: &Scope, depth: usize) -> String {
        match self.choices.weighted([6, 2, if depth > 0 { 2 } else { 0 }].into_iter()) {
            0 => self.quoted(scope, &CONDITION, depth),
            1 => self.items(scope).unwrap_or_else(|| self.quoted(scope, &CONDITION, depth)),
            _ => match self.choices.below(3) {
                0 => format!("Not({})", self.guard(scope, depth - 1)),
                word => {
                    let word = if word == 1 { "All" } else { "Any" };
                    let parts: Vec<String> =
                        (0..self.choices.within(1, 3)).map(|_| self.guard(scope, depth - 1)).collect();
                    format!("{word}([{}])", parts.join(", "))
                }
            },
        }
    }

    /// `{"H": ["left", "right"], "b": true}`; none if there is nothing discrete.
    fn items(&mut self, scope: &Scope) -> Option<String> {
        let discrete: Vec<(String, Type)> = scope
            .visible
            .iter()
            .filter(|visible| matches!(visible.ty, Type::Level(_) | Type::Condition))
            .map(|visible| (visible.text.clone(), visible.ty.clone()))
            .collect();
        if discrete.is_empty() {
            return None;
        }
        let mut chosen = self.choices.some(&discrete);
        chosen.truncate(3);
        let mut parts = Vec::new();
        for (name, ty) in chosen {
            let value = match ty {
                Type::Level(set) => {
                    let by_code = self.choices.one_in(4) || self.sets[set].integers;
                    let all = if by_code { self.sets[set].codes.clone() } else { self.sets[set].levels.clone() };
                    let quoted = |level: &String| if by_code { level.clone() } else { format!("\"{level}\"") };
                    match self.choices.either() {
                        true => quoted(self.choices.pick(&all)),
                        false => {
                            format!("[{}]", self.choices.some(&all).iter().map(quoted).collect::<Vec<_>>().join(", "))
                        }
                    }
                }
                _ => self.choices.pick(&["true", "false"]).to_string(),
            };
            parts.push((name, value));
        }
        Some(super::map(&parts))
    }

    /// What an input can be replaced by in a reference: a constant of its domain, or something of its type.
    pub(super) fn replacement(&mut self, kind: Kind) -> String {
        let scope =
            Scope { visible: self.scope.visible.iter().filter(|v| v.input).cloned().collect(), ..Scope::default() };
        match kind {
            Kind::Bool => self.operand(&scope, &CONDITION, 1, OR),
            Kind::Levels(set) => self.operand(&scope, &Type::Level(set), 1, OR),
            Kind::Wide(_) => self.choices.pick(&["0", "3", "100"]).to_string(),
            Kind::Range(lo, hi) => {
                let numbers: Vec<String> = scope.of(&Type::Number).iter().map(|visible| visible.text.clone()).collect();
                match self.choices.below(3) {
                    0 => self.inside((lo, hi)),
                    1 => self.choices.pick(&numbers).clone(),
                    _ => format!("{} - {}", self.inside((lo, hi)), self.choices.pick(&numbers)),
                }
            }
        }
    }
}
