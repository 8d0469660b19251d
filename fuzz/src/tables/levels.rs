//! Expressions that are levels, and lists of them.

use super::Maker;
use super::expression::{Construct, OR, Piece, SUM, Scope, Type};

/// The constructs that make levels: those of any type are enough.
pub(super) const ALL: &[Construct] = &[];

/// The constructs that make lists.
pub(super) const LISTS: &[Construct] = &[(8, items), (4, joined)];

/// `[a, b if c]`
pub(super) fn items(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let Type::List(of, most) = ty else { return None };
    let count = maker.choices.below(most + 1);
    let mut items = Vec::new();
    for _ in 0..count {
        let item = maker.operand(scope, of, depth.min(1), OR);
        items.push(match maker.modern && maker.choices.one_in(4) {
            true => format!("{item} if {}", maker.operand(scope, &Type::Condition, depth.min(1), OR)),
            false => item,
        });
    }
    Some(Piece::primary(format!("[{}]", items.join(", "))))
}

/// `a ++ b`
fn joined(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let Type::List(of, most) = ty else { return None };
    if !maker.modern {
        return None;
    }
    let first = maker.choices.below(most + 1);
    let [a, b] = [(first, SUM), (most - first, SUM + 1)]
        .map(|(most, strength)| maker.operand(scope, &Type::List(of.clone(), most), depth, strength));
    Some(Piece::new(SUM, format!("{a} ++ {b}")))
}
