//! Expressions that are vectors.

use umbrage::program::operators::Operator;

use super::Maker;
use super::expression::{Construct, OR, POSTFIX, PREFIX, PRIMARY, PRODUCT, Piece, SUM, Scope, Type};

/// The constructs that make vectors.
pub(super) const ALL: &[Construct] =
    &[(6, joined), (3, infix), (2, scaled), (2, function), (2, swizzle), (1, direction), (1, negative)];

fn size(ty: &Type) -> usize {
    match ty {
        Type::Vector(size) => *size,
        Type::Number
        | Type::Condition
        | Type::Level(_)
        | Type::Whole(..)
        | Type::Wide
        | Type::Record(_)
        | Type::List(..) => 1,
    }
}

/// Numbers and vectors joined, or one number for all.
fn joined(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let size = size(ty);
    if maker.choices.one_in(4) {
        return Some(Piece::primary(format!("vec{size}({})", maker.operand(scope, &Type::Number, depth, OR))));
    }
    let (mut parts, mut left) = (Vec::new(), size);
    while left > 0 {
        let width = if left >= 2 && left < size + 1 && maker.choices.one_in(4) { 2 } else { 1 };
        let ty = if width == 1 || width == size { Type::Number } else { Type::Vector(width) };
        parts.push(maker.operand(scope, &ty, depth, OR));
        left -= if ty == Type::Number { 1 } else { width };
    }
    Some(Piece::primary(format!("vec{size}({})", parts.join(", "))))
}

fn infix(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let (symbol, strength) = *maker.choices.pick(&[("+", SUM), ("-", SUM), ("*", PRODUCT), ("/", PRODUCT)]);
    let a = maker.operand(scope, ty, depth, strength);
    let b = maker.operand(scope, ty, depth, strength + 1);
    Some(Piece::new(strength, format!("{a} {symbol} {b}")))
}

/// A number goes with a vector.
fn scaled(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let mut types = [ty.clone(), Type::Number];
    if maker.choices.either() {
        types.reverse();
    }
    let a = maker.operand(scope, &types[0], depth, PRODUCT);
    let b = maker.operand(scope, &types[1], depth, PRODUCT + 1);
    Some(Piece::new(PRODUCT, format!("{a} * {b}")))
}

/// A function of numbers, component by component.
fn function(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let name = *maker.choices.pick(&["abs", "min", "max", "mix", "clamp", "floor", "saturate", "step", "sin", "exp"]);
    let count = match Operator::named(name)? {
        Operator::Unary(_) => 1,
        Operator::Binary(_) => 2,
        Operator::Ternary(_) => 3,
    };
    let mut operands = vec![maker.operand(scope, ty, depth, OR)];
    for _ in 1..count {
        let ty = if maker.choices.one_in(3) { Type::Number } else { ty.clone() };
        operands.push(maker.operand(scope, &ty, depth, OR));
    }
    if name == "clamp" {
        (operands[1], operands[2]) = ("0".to_owned(), "1".to_owned());
    }
    Some(Piece::primary(format!("{name}({})", operands.join(", "))))
}

fn swizzle(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let of = maker.choices.within(2, 4);
    let vector = maker.expression(scope, &Type::Vector(of), depth);
    let vector = maker.held(vector, PRIMARY, false);
    let names = *maker.choices.pick(&["xyzw", "rgba"]);
    let parts: String = (0..size(ty))
        .map(|place| {
            let place = if maker.choices.either() { maker.choices.below(of) } else { place.min(of - 1) };
            &names[place..=place]
        })
        .collect();
    Some(Piece::new(POSTFIX, format!("{vector}.{parts}")))
}

fn direction(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let a = maker.operand(scope, ty, depth, OR);
    if *ty == Type::Vector(3) && maker.choices.either() {
        return Some(Piece::primary(format!("cross({a}, {})", maker.operand(scope, ty, depth, OR))));
    }
    Some(Piece::primary(format!("normalize({a})")))
}

fn negative(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    Some(Piece::new(PREFIX, format!("-{}", maker.operand(scope, ty, depth, PREFIX))))
}
