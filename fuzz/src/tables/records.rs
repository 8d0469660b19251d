//! Expressions that are records.

use super::Maker;
use super::expression::{Construct, OR, PRODUCT, Piece, SUM, Scope, Type};

/// The constructs that make records.
pub(super) const ALL: &[Construct] = &[(6, written_out), (2, infix)];

/// `{a: x, b: y}`
pub(super) fn written(maker: &mut Maker<'_, '_>, scope: &Scope, fields: &[(String, Type)], depth: usize) -> Piece {
    let parts: Vec<String> =
        fields.iter().map(|(name, ty)| format!("{name}: {}", maker.operand(scope, ty, depth, OR))).collect();
    Piece::primary(format!("{{{}}}", parts.join(", ")))
}

fn written_out(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    ty.fields().map(|fields| written(maker, scope, fields, depth))
}

/// Records of the same names, or one and a number.
fn infix(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    if !ty.is_numeric() {
        return None;
    }
    let (symbol, strength) = *maker.choices.pick(&[("+", SUM), ("-", SUM), ("*", PRODUCT)]);
    let a = maker.operand(scope, ty, depth, strength);
    let other = if maker.choices.either() { Type::Number } else { ty.clone() };
    let b = maker.operand(scope, &other, depth, strength + 1);
    Some(Piece::new(strength, format!("{a} {symbol} {b}")))
}
