//! Expressions that are levels, and lists of them.

use super::Maker;
use super::expression::{Construct, OR, Piece, Scope, Type};

/// The constructs that make levels: those of any type are enough.
pub(super) const ALL: &[Construct] = &[];

/// The constructs that make lists.
pub(super) const LISTS: &[Construct] = &[(8, items)];

/// `[a, b]`
pub(super) fn items(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let Type::List(of, most) = ty else { return None };
    let count = maker.choices.below(most + 1);
    let items: Vec<String> = (0..count).map(|_| maker.operand(scope, of, depth.min(1), OR)).collect();
    Some(Piece::primary(format!("[{}]", items.join(", "))))
}
