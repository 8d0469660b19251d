//! Whole numbers: arithmetic with integers, kept in a range, and integers of any range.
//!
//! Only tables of version 2 have them. What could grow is limited, so that nothing is refused for its size.

use super::Maker;
use super::expression::{COMPARISON, Construct, MEMBER, PREFIX, PRIMARY, PRODUCT, Piece, SUM, Scope, Type};

/// The constructs that make whole numbers of a range.
pub(super) const ALL: &[Construct] = &[(6, limited)];

/// The constants that integers of any range are compared with: few, so that there are few classes.
const CONSTANTS: [&str; 4] = ["0", "1", "2", "5"];

/// A calculation, kept in the range.
fn limited(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let Type::Whole(from, to) = ty else { return None };
    let inner = calculated(maker, scope, depth)?;
    let text = match maker.choices.either() {
        true => format!("clamp({}, {from}, {to})", inner.text),
        false => format!("max(min({}, {to}), {from})", inner.text),
    };
    Some(Piece::primary(text))
}

/// A whole number of some size; none where no integer is in sight.
fn calculated(maker: &mut Maker<'_, '_>, scope: &Scope, depth: usize) -> Option<Piece> {
    if !maker.modern {
        return None;
    }
    let atom = atom(maker, scope)?;
    if depth == 0 || maker.fuel == 0 {
        return Some(atom);
    }
    maker.fuel -= 1;
    let constant = *maker.choices.pick(&["1", "2", "3", "-2", "7"]);
    Some(match maker.choices.below(8) {
        0 => Piece::new(SUM, format!("{} + {constant}", maker.held(atom, SUM, false))),
        1 => {
            let symbol = *maker.choices.pick(&["+", "-"]);
            let other = calculated(maker, scope, 0)?;
            let (a, b) = (maker.held(atom, SUM, false), maker.held(other, PRODUCT, false));
            Piece::new(SUM, format!("{a} {symbol} {b}"))
        }
        2 => {
            let other = calculated(maker, scope, 0)?;
            let (a, b) = (maker.held(atom, PRODUCT, false), maker.held(other, MEMBER, false));
            Piece::new(PRODUCT, format!("{a} * {b}"))
        }
        3 => Piece::new(PRODUCT, format!("{} / {constant}", maker.held(atom, PRODUCT, false))),
        4 => Piece::new(PRODUCT, format!("{} % {constant}", maker.held(atom, PRODUCT, false))),
        5 => {
            // No divisor that can be zero.
            let other = calculated(maker, scope, 0)?;
            let symbol = *maker.choices.pick(&["/", "%"]);
            Piece::new(PRODUCT, format!("{} {symbol} (1 + abs({}))", maker.held(atom, PRODUCT, false), other.text))
        }
        6 => Piece::new(PREFIX, format!("-{}", maker.held(atom, PREFIX, false))),
        _ => {
            let (name, other) = (*maker.choices.pick(&["min", "max"]), calculated(maker, scope, depth - 1)?);
            Piece::primary(format!("{name}({}, {})", atom.text, other.text))
        }
    })
}

/// An integer, the index of a level, a count of conditions, or what is left of an integer of any range.
fn atom(maker: &mut Maker<'_, '_>, scope: &Scope) -> Option<Piece> {
    let levels: Vec<(String, bool)> = scope
        .visible
        .iter()
        .filter_map(|visible| match visible.ty {
            Type::Level(set) => Some((visible.text.clone(), maker.sets[set].integers)),
            Type::Condition
            | Type::Number
            | Type::Wide
            | Type::Whole(..)
            | Type::Vector(_)
            | Type::Record(_)
            | Type::List(..) => None,
        })
        .collect();
    let wide: Vec<String> = scope.of(&Type::Wide).iter().map(|visible| visible.text.clone()).collect();
    let truths: Vec<String> = scope.of(&Type::Condition).iter().map(|visible| visible.text.clone()).collect();
    Some(Piece::primary(match maker.choices.below(4) {
        0 if !truths.is_empty() => format!("count({})", maker.choices.some(&truths).join(", ")),
        1 if !wide.is_empty() => match maker.choices.either() {
            true => format!("({} % 2)", maker.choices.pick(&wide)),
            false => format!("clamp({}, 0, 3)", maker.choices.pick(&wide)),
        },
        _ if !levels.is_empty() => {
            let (name, is_integer) = maker.choices.pick(&levels).clone();
            if is_integer { name } else { format!("index({name})") }
        }
        _ => return None,
    }))
}

/// Whole numbers compared.
pub(super) fn comparison(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let a = calculated(maker, scope, depth)?;
    // A bare number means nothing beside another one, and integers by themselves are levels.
    let a = format!("(0 + {})", maker.held(a, PRODUCT, false));
    if maker.choices.one_in(4) {
        return Some(Piece::new(MEMBER, format!("{a} in {{0, -1, 2}}")));
    }
    let symbol = *maker.choices.pick(&["<", "<=", ">", ">=", "==", "!="]);
    let b = match maker.choices.either() {
        true => maker.choices.pick(&["0", "1", "2.5", "-1"]).to_string(),
        false => {
            let b = calculated(maker, scope, depth)?;
            maker.held(b, SUM, false)
        }
    };
    Some(Piece::new(COMPARISON, format!("{a} {symbol} {b}")))
}

/// A whole number as a number.
pub(super) fn number(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    Some(Piece::new(PRIMARY, format!("f32({})", calculated(maker, scope, depth)?.text)))
}

/// An integer of any range, asked for.
pub(super) fn asked(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, _: usize) -> Option<Piece> {
    let wide: Vec<String> = scope.of(&Type::Wide).iter().map(|visible| visible.text.clone()).collect();
    if wide.is_empty() {
        return None;
    }
    let name = maker.choices.pick(&wide).clone();
    let constant = *maker.choices.pick(&CONSTANTS);
    let symbol = *maker.choices.pick(&["==", "!=", "<", "<=", ">", ">="]);
    Some(match maker.choices.below(5) {
        0 => Piece::new(MEMBER, format!("{name} in {{{}}}", maker.choices.some(&CONSTANTS).join(", "))),
        1 => Piece::new(COMPARISON, format!("{name} % 2 {symbol} {}", maker.choices.pick(&["0", "1"]))),
        2 => Piece::new(COMPARISON, format!("{constant} {symbol} {name}")),
        _ => Piece::new(COMPARISON, format!("{name} {symbol} {constant}")),
    })
}
