//! Expressions that are numbers.

use umbrage::program::operators::{Operator, UnaryOp};

use super::Maker;
use super::expression::{BETWEEN, Construct, OR, POSTFIX, PREFIX, PRIMARY, PRODUCT, Piece, SUM, Scope, Type, Visible};

/// The constructs that make numbers.
pub(super) const ALL: &[Construct] = &[
    (6, sum),
    (5, product),
    (3, affine),
    (2, quotient),
    (1, remainder),
    (2, negative),
    (3, usual),
    (4, function),
    (3, code),
    (2, component),
    (2, of_vectors),
    (1, of_record),
    (1, series),
    (1, counted),
    (1, indexed),
    (1, interpolated),
    (1, iterated),
    (1, polynomial),
    (1, between),
    (1, third),
    (2, super::whole::number),
];

const NUMBER: Type = Type::Number;

impl Maker<'_, '_> {
    /// Returns whether every level of a set means a place in a list of so many items.
    fn places(&self, set: usize, count: usize) -> bool {
        let set = &self.sets[set];
        match set.integers {
            true => set.codes.iter().all(|code| code.parse::<usize>().is_ok_and(|place| place < count)),
            false => set.levels.len() == count,
        }
    }
}

fn infix(maker: &mut Maker<'_, '_>, scope: &Scope, depth: usize, symbol: &str, strength: u8) -> Piece {
    let a = maker.operand(scope, &NUMBER, depth, strength);
    let b = maker.operand(scope, &NUMBER, depth, strength + 1);
    Piece::new(strength, format!("{a} {symbol} {b}"))
}

fn sum(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let symbol = *maker.choices.pick(&["+", "-"]);
    Some(infix(maker, scope, depth, symbol, SUM))
}

fn product(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    Some(infix(maker, scope, depth, "*", PRODUCT))
}

/// `1 + x - y`: what most tables are made of.
fn affine(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, _: usize) -> Option<Piece> {
    let numbers: Vec<String> = scope.of(&NUMBER).iter().map(|visible| visible.text.clone()).collect();
    if numbers.is_empty() {
        return None;
    }
    let mut text = maker.literal();
    for _ in 0..maker.choices.within(1, 3) {
        let sign = *maker.choices.pick(&["+", "-"]);
        let factor = if maker.choices.one_in(3) { format!("{} * ", maker.literal()) } else { String::new() };
        text += &format!(" {sign} {factor}{}", maker.choices.pick(&numbers));
    }
    Some(Piece::new(SUM, text))
}

/// Divided by a constant that is not zero, or by anything.
fn quotient(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    if maker.choices.either() {
        return Some(infix(maker, scope, depth, "/", PRODUCT));
    }
    let a = maker.operand(scope, &NUMBER, depth, PRODUCT);
    let by = *maker.choices.pick(&["2", "3", "0.7", "1.1", "8", "0.1"]);
    Some(Piece::new(PRODUCT, format!("{a} / {by}")))
}

fn remainder(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let a = maker.operand(scope, &NUMBER, depth, PRODUCT);
    let by = *maker.choices.pick(&["2", "1", "0.5", "0.3"]);
    Some(Piece::new(PRODUCT, format!("{a} % {by}")))
}

fn negative(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    Some(Piece::new(PREFIX, format!("-{}", maker.operand(scope, &NUMBER, depth, PREFIX))))
}

/// A function that tables use often.
fn usual(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let name =
        *maker.choices.pick(&["min", "max", "clamp", "abs", "saturate", "step", "mix", "smoothstep", "floor", "fract"]);
    called(maker, scope, Operator::named(name)?, name, depth)
}

/// Any function of numbers.
fn function(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let all: Vec<(&str, Operator)> = Operator::functions().collect();
    let (name, operator) = *maker.choices.pick(&all);
    called(maker, scope, operator, name, depth)
}

fn called(maker: &mut Maker<'_, '_>, scope: &Scope, operator: Operator, name: &str, depth: usize) -> Option<Piece> {
    let count = match operator {
        Operator::Unary(_) => 1,
        Operator::Binary(_) => 2,
        Operator::Ternary(_) => 3,
    };
    let mut operands: Vec<String> = (0..count).map(|_| maker.operand(scope, &NUMBER, depth, OR)).collect();
    // Bounds ascend where they are constant, most of the time; what is partial is mostly kept where it is defined.
    match operator {
        Operator::Ternary(op) if op.row().ascending.is_some() && !maker.choices.one_in(4) => {
            let bounds = *maker.choices.pick(&[("0", "1"), ("0.25", "0.75"), ("-1", "0.5"), ("0.1", "0.3")]);
            let ascending = op.row().ascending?;
            operands[ascending.lower] = bounds.0.to_owned();
            operands[ascending.upper] = bounds.1.to_owned();
        }
        Operator::Unary(op) if op.row().operands.is_some() && !maker.choices.one_in(3) => {
            operands[0] = match op {
                UnaryOp::Acosh => format!("1 + abs({})", operands[0]),
                UnaryOp::Atanh => format!("0.5 * saturate({})", operands[0]),
                UnaryOp::Acos | UnaryOp::Asin => format!("clamp({}, -1, 1)", operands[0]),
                _ => format!("0.25 + abs({})", operands[0]),
            };
        }
        Operator::Unary(_) | Operator::Binary(_) | Operator::Ternary(_) => {}
    }
    Some(Piece::primary(format!("{name}({})", operands.join(", "))))
}

/// The code of a level, or one or zero for a condition.
fn code(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let levels: Vec<String> =
        scope.visible.iter().filter(|v| matches!(v.ty, Type::Level(_))).map(|v| v.text.clone()).collect();
    let inner = match levels.is_empty() || maker.choices.one_in(3) {
        true => maker.operand(scope, &Type::Condition, depth, OR),
        false => maker.choices.pick(&levels).clone(),
    };
    Some(Piece::primary(format!("f32({inner})")))
}

fn component(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let size = maker.choices.within(2, 4);
    let vector = maker.expression(scope, &Type::Vector(size), depth);
    let vector = maker.held(vector, PRIMARY, false);
    let names = *maker.choices.pick(&["xyzw", "rgba"]);
    let place = maker.choices.below(size);
    Some(Piece::new(POSTFIX, format!("{vector}.{}", &names[place..=place])))
}

fn of_vectors(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let ty = Type::Vector(maker.choices.within(2, 4));
    let a = maker.operand(scope, &ty, depth, OR);
    let name = *maker.choices.pick(&["dot", "length", "distance"]);
    if name == "length" {
        return Some(Piece::primary(format!("length({a})")));
    }
    Some(Piece::primary(format!("{name}({a}, {})", maker.operand(scope, &ty, depth, OR))))
}

fn of_record(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let records: Vec<(String, Vec<String>)> = scope
        .visible
        .iter()
        .filter_map(|v| {
            let fields = v.ty.fields()?;
            Some((v.text.clone(), fields.iter().map(|(name, _)| name.clone()).collect()))
        })
        .collect();
    let (text, names) = match records.is_empty() {
        true => {
            let names = ["area", "ss"].map(str::to_owned).to_vec();
            let fields: Vec<(String, Type)> = names.iter().map(|name| (name.clone(), Type::Number)).collect();
            let record = super::records::written(maker, scope, &fields, depth);
            (maker.held(record, PRIMARY, false), names)
        }
        false => maker.choices.pick(&records).clone(),
    };
    Some(Piece::new(POSTFIX, format!("{text}.{}", maker.choices.pick(&names))))
}

/// The sum over a list of constants.
fn series(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    if scope.lists.is_empty() {
        return None;
    }
    let (list, width, _) = maker.choices.pick(&scope.lists.clone()).clone();
    let name = maker.plain_name("n");
    let mut inner = scope.clone();
    let ty = if width == 1 { Type::Number } else { Type::Vector(width) };
    inner.add(Visible { text: name.clone(), ty, input: false });
    let item = maker.operand(&inner, &NUMBER, depth.min(2), OR);
    Some(Piece::primary(format!("sum({name} in {list}, {item})")))
}

fn counted(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let name = maker.plain_name("n");
    let from = maker.choices.within(0, 2);
    let to = from + maker.choices.within(0, 3);
    let mut inner = scope.clone();
    inner.add(Visible { text: name.clone(), ty: NUMBER, input: false });
    let item = maker.operand(&inner, &NUMBER, depth.min(2), OR);
    Some(Piece::primary(format!("sum({name} in {from} .. {to}, {item})")))
}

/// An item of a list of constants, by a number, a condition or a level.
fn indexed(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    if scope.lists.is_empty() {
        return None;
    }
    let (list, width, count) = maker.choices.pick(&scope.lists.clone()).clone();
    let levels: Vec<String> = (scope.visible.iter())
        .filter(|visible| matches!(visible.ty, Type::Level(set) if maker.places(set, count)))
        .map(|visible| visible.text.clone())
        .collect();
    let place = match maker.choices.below(3) {
        0 if count > 1 => maker.operand(scope, &Type::Condition, depth.min(1), OR),
        1 if !levels.is_empty() => maker.choices.pick(&levels).clone(),
        _ => maker.choices.below(count).to_string(),
    };
    maker.later = true;
    let second = maker.choices.below(width);
    Some(match width {
        1 => Piece::new(POSTFIX, format!("{list}[{place}]")),
        _ if maker.choices.either() => Piece::new(POSTFIX, format!("{list}[{place}, {second}]")),
        _ => Piece::new(POSTFIX, format!("{list}[{place}].{}", &"xyzw"[second..=second])),
    })
}

fn interpolated(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    if scope.lists.is_empty() {
        return None;
    }
    let (list, width, _) = maker.choices.pick(&scope.lists.clone()).clone();
    maker.later = true;
    let at = maker.operand(scope, &NUMBER, depth.min(2), OR);
    Some(match width {
        1 => Piece::primary(format!("lookup({list}, {at})")),
        _ if maker.choices.either() => {
            let second = maker.operand(scope, &NUMBER, depth.min(1), OR);
            Piece::primary(format!("lookup({list}, {at}, {second})"))
        }
        _ => Piece::new(POSTFIX, format!("lookup({list}, {at}).y")),
    })
}

fn iterated(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let name = maker.plain_name("t");
    let first = maker.operand(scope, &NUMBER, depth.min(1), OR);
    let mut inner = scope.clone();
    inner.add(Visible { text: name.clone(), ty: NUMBER, input: false });
    let step = maker.operand(&inner, &NUMBER, depth.min(2), OR);
    maker.later = true;
    let count = maker.choices.below(4);
    Some(Piece::primary(format!("iterate({count}, {name} = {first}, {step})")))
}

fn polynomial(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let at = maker.operand(scope, &NUMBER, depth, OR);
    let lists: Vec<String> =
        scope.lists.iter().filter(|(_, width, _)| *width == 1).map(|(name, ..)| name.clone()).collect();
    if !lists.is_empty() && maker.choices.either() {
        return Some(Piece::primary(format!("poly({at}, {})", maker.choices.pick(&lists))));
    }
    let mut parts = vec![maker.literal()];
    for _ in 0..maker.choices.within(1, 4) {
        let sign = *maker.choices.pick(&["", "-"]);
        parts.push(format!("{sign}{}", *maker.choices.pick(&["1", "0.5", "1 / 6", "1 / 120", "0.1"])));
    }
    Some(Piece::primary(format!("poly({at}, [{}])", parts.join(", "))))
}

/// `F | x = lo .. hi`
fn between(maker: &mut Maker<'_, '_>, scope: &Scope, _: &Type, depth: usize) -> Option<Piece> {
    let name = maker.plain_name("t");
    let mut inner = scope.clone();
    inner.add(Visible { text: name.clone(), ty: NUMBER, input: false });
    let of = maker.operand(&inner, &NUMBER, depth, SUM);
    let [lo, hi] = [(); 2].map(|()| maker.operand(scope, &NUMBER, depth.min(1), SUM));
    Some(Piece::new(BETWEEN, format!("{of} | {name} = {lo} .. {hi}")))
}

/// A constant that is written as an expression.
fn third(maker: &mut Maker<'_, '_>, _: &Scope, _: &Type, _: usize) -> Option<Piece> {
    Some(Piece::new(PRODUCT, *maker.choices.pick(&["1 / 3", "2 / 7", "0.3 * 0.7", "1 / 720"])))
}
