//! Expressions of every type, parenthesised as the grammar asks, or more.

use super::Maker;

/// The type of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Type {
    Number,
    Condition,
    /// A level of the set with this number.
    Level(usize),
    Vector(usize),
    /// A whole number of a range.
    Whole(i32, i32),
    /// An integer of any range, which is nothing but asked for.
    Wide,
    /// Values with names.
    Record(Vec<(String, Type)>),
    /// At most so many values of one type.
    List(Box<Type>, usize),
}

impl Type {
    /// A record of numbers.
    pub(super) fn numbers(names: &[&str]) -> Self {
        Type::Record(names.iter().map(|name| ((*name).to_owned(), Type::Number)).collect())
    }

    /// The names and types of a record; nothing for other types.
    pub(super) fn fields(&self) -> Option<&[(String, Type)]> {
        if let Type::Record(fields) = self { Some(fields) } else { None }
    }

    /// Returns whether it is calculated with, as numbers are.
    pub(super) fn is_numeric(&self) -> bool {
        match self {
            Type::Number | Type::Vector(_) => true,
            Type::Record(fields) => fields.iter().all(|(_, ty)| ty.is_numeric()),
            Type::Condition | Type::Level(_) | Type::Whole(..) | Type::Wide | Type::List(..) => false,
        }
    }
}

/// A text with the strength of what holds it together, by the grammar.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub(super) text: String,
    pub(super) strength: u8,
}

/// Strengths, from the weakest on.
pub(super) const BLOCK: u8 = 0;
pub(super) const OR: u8 = 1;
pub(super) const AND: u8 = 2;
pub(super) const COMPARISON: u8 = 3;
pub(super) const BETWEEN: u8 = 4;
pub(super) const SUM: u8 = 5;
pub(super) const PRODUCT: u8 = 6;
pub(super) const MEMBER: u8 = 7;
pub(super) const PREFIX: u8 = 8;
pub(super) const POSTFIX: u8 = 9;
pub(super) const PRIMARY: u8 = 10;

impl Piece {
    /// A text of a strength.
    pub(super) fn new(strength: u8, text: impl Into<String>) -> Self {
        Self { text: text.into(), strength }
    }

    /// A text that nothing can tear apart.
    pub(super) fn primary(text: impl Into<String>) -> Self {
        Self::new(PRIMARY, text)
    }
}

/// Something that can be mentioned by its name.
#[derive(Debug, Clone)]
pub(super) struct Visible {
    pub(super) text: String,
    pub(super) ty: Type,
    pub(super) input: bool,
}

/// A function or helper that can be called.
#[derive(Debug, Clone)]
pub(super) struct Callable {
    pub(super) name: String,
    /// Parameters with their names, in order.
    pub(super) parameters: Vec<(String, Type)>,
    pub(super) gives: Type,
    /// True if it may be called by name, or with nothing given.
    pub(super) by_name: bool,
}

/// What an expression can mention where it stands.
#[derive(Debug, Clone, Default)]
pub(super) struct Scope {
    pub(super) visible: Vec<Visible>,
    pub(super) callable: Vec<Callable>,
    /// Lists of constants, with the number of components of an item.
    pub(super) lists: Vec<(String, usize, usize)>,
    /// Cases that can be referred to.
    pub(super) cases: Vec<u32>,
}

impl Scope {
    pub(super) fn add(&mut self, visible: Visible) {
        self.visible.push(visible);
    }

    /// The same without what is not constant.
    pub(super) fn constants(&self) -> Self {
        Self { visible: Vec::new(), callable: Vec::new(), lists: self.lists.clone(), cases: Vec::new() }
    }

    /// The names of a type.
    pub(super) fn of(&self, ty: &Type) -> Vec<&Visible> {
        self.visible.iter().filter(|visible| visible.ty == *ty).collect()
    }
}

/// A construct: how often it is made, and what makes it. Where it cannot be made, it makes nothing.
pub(super) type Construct = (usize, fn(&mut Maker<'_, '_>, &Scope, &Type, usize) -> Option<Piece>);

/// The constructs of expressions of any type.
const ANY: &[Construct] = &[(3, conditional), (2, selection), (1, block), (2, call), (2, reference)];

impl Maker<'_, '_> {
    /// An expression of a type, with operations nested so deep.
    pub(super) fn expression(&mut self, scope: &Scope, ty: &Type, depth: usize) -> Piece {
        if depth == 0 || self.fuel == 0 {
            return self.leaf(scope, ty);
        }
        self.fuel -= 1;
        let own: &[Construct] = match ty {
            Type::Number => super::numbers::ALL,
            Type::Condition => super::conditions::ALL,
            Type::Level(_) => super::levels::ALL,
            Type::Vector(_) => super::vectors::ALL,
            Type::Record(_) => super::records::ALL,
            Type::Whole(..) => super::whole::ALL,
            Type::Wide => &[],
            Type::List(..) => super::levels::LISTS,
        };
        let all = || own.iter().chain(ANY);
        // Now and then a leaf where more could stand, so that not all expressions are equally deep.
        let place = self
            .choices
            .weighted(std::iter::once(4).chain(all().map(|(weight, _)| *weight)).collect::<Vec<_>>().into_iter());
        let made = place
            .checked_sub(1)
            .and_then(|place| all().nth(place))
            .and_then(|(_, make)| make(self, scope, ty, depth - 1));
        made.unwrap_or_else(|| self.leaf(scope, ty))
    }

    /// The text of an expression that stands by itself.
    pub(super) fn text(&mut self, scope: &Scope, ty: &Type, depth: usize) -> String {
        self.expression(scope, ty, depth).text
    }

    /// An expression in a string of RON; a bare literal now and then without.
    pub(super) fn quoted(&mut self, scope: &Scope, ty: &Type, depth: usize) -> String {
        let text = self.text(scope, ty, depth);
        self.in_quotes(text)
    }

    /// A text in quotes, of which numbers and truths have no need.
    pub(super) fn in_quotes(&mut self, text: String) -> String {
        // RON reads neither `2.` nor `.5` nor `7e+0` in every place where the language does.
        let bare = text == "true" || text == "false" || text.bytes().all(|byte| byte.is_ascii_digit());
        if bare && self.choices.either() { text } else { format!("\"{text}\"") }
    }

    /// An operand that has to hold together at least so strongly.
    pub(super) fn operand(&mut self, scope: &Scope, ty: &Type, depth: usize, strength: u8) -> String {
        let piece = self.expression(scope, ty, depth);
        let needless = self.choices.one_in(6);
        self.held(piece, strength, needless)
    }

    /// A piece, in parentheses if it needs them or they are wanted.
    pub(super) fn held(&mut self, piece: Piece, strength: u8, needless: bool) -> String {
        match piece.strength {
            // A block stands in braces only; a condition that always holds chooses it.
            BLOCK => format!("if true {{ {} }} else {{ {} }}", piece.text, piece.text),
            held if held < strength || needless => format!("({})", piece.text),
            _ => piece.text,
        }
    }

    /// The simplest expression of a type.
    pub(super) fn leaf(&mut self, scope: &Scope, ty: &Type) -> Piece {
        let known: Vec<String> = scope.of(ty).iter().map(|visible| visible.text.clone()).collect();
        if !known.is_empty() && !self.choices.one_in(4) {
            return Piece::primary(self.choices.pick(&known).clone());
        }
        match ty {
            Type::Number => Piece::primary(self.literal()),
            Type::Condition => super::conditions::leaf(self, scope),
            Type::Level(set) => {
                let level = self.level_of(*set);
                let own = self.sets[*set].name.clone().filter(|_| self.modern);
                match own.filter(|_| self.alone || self.choices.one_in(4)) {
                    Some(set) => Piece::primary(format!("{set}::{level}")),
                    None => Piece::primary(level),
                }
            }
            Type::Vector(size) => {
                let parts: Vec<String> = (0..*size).map(|_| self.leaf(scope, &Type::Number).text).collect();
                Piece::primary(format!("vec{size}({})", parts.join(", ")))
            }
            Type::Whole(from, to) => {
                Piece::new(PREFIX, (i64::from(*from) + self.choices.below((to - from + 1) as usize) as i64).to_string())
            }
            Type::Wide => Piece::primary("1"),
            Type::Record(fields) => super::records::written(self, scope, fields, 0),
            Type::List(..) => super::levels::items(self, scope, ty, 0).unwrap_or_else(|| Piece::primary("[]")),
        }
    }

    /// A level by its name, or by its code where the name is a number.
    pub(super) fn level_of(&mut self, set: usize) -> String {
        let levels = self.sets[set].levels.clone();
        self.choices.pick(&levels).clone()
    }
}

fn conditional(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let condition = maker.operand(scope, &Type::Condition, depth, OR);
    let then = maker.text(scope, ty, depth);
    let mut text = format!("if {condition} {{ {then} }}");
    if maker.choices.one_in(4) {
        let second = maker.operand(scope, &Type::Condition, depth, OR);
        text += &format!(" else if {second} {{ {} }}", maker.text(scope, ty, depth));
    }
    Some(Piece::primary(format!("{text} else {{ {} }}", maker.text(scope, ty, depth))))
}

fn selection(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let [other, then] = [(); 2].map(|()| maker.operand(scope, ty, depth, OR));
    let condition = maker.operand(scope, &Type::Condition, depth, OR);
    Some(Piece::primary(format!("select({other}, {then}, {condition})")))
}

/// `let a = x; b`, which stands where an expression begins, or in braces.
fn block(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let name = maker.plain_name("t");
    let of = match maker.choices.below(4) {
        0 | 1 => Type::Number,
        2 => Type::Condition,
        _ => Type::Vector(maker.choices.within(2, 4)),
    };
    let value = maker.operand(scope, &of, depth, OR);
    let mut inner = scope.clone();
    inner.add(Visible { text: name.clone(), ty: of, input: false });
    let body = maker.text(&inner, ty, depth);
    Some(Piece::new(BLOCK, format!("let {name} = {value}; {body}")))
}

/// A call of a function or helper: in order, by name, or with nothing given.
fn call(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, depth: usize) -> Option<Piece> {
    let known: Vec<_> = scope.callable.iter().filter(|callable| callable.gives == *ty).cloned().collect();
    if known.is_empty() {
        return None;
    }
    let callee = maker.choices.pick(&known).clone();
    let named =
        callee.by_name && callee.parameters.iter().all(|(name, ty)| scope.of(ty).iter().any(|v| v.text == *name));
    let form = if named { maker.choices.below(3) } else { 0 };
    let given = match form {
        0 => callee.parameters.clone(),
        1 => maker.choices.some(&callee.parameters),
        _ => Vec::new(),
    };
    let mut arguments = Vec::new();
    for (name, ty) in given {
        // A bare level has no meaning here.
        let value = match ty {
            Type::Level(_) => scope.of(&ty).first()?.text.clone(),
            ty => maker.operand(scope, &ty, depth.min(1), OR),
        };
        arguments.push(if form == 1 { format!("{name} = {value}") } else { value });
    }
    Some(Piece::primary(format!("{}({})", callee.name, arguments.join(", "))))
}

/// `case(3, V = none, x = 1 - x)`
fn reference(maker: &mut Maker<'_, '_>, scope: &Scope, ty: &Type, _: usize) -> Option<Piece> {
    if scope.cases.is_empty() || *ty != maker.output {
        return None;
    }
    let mut text = format!("case({}", maker.choices.pick(&scope.cases.clone()));
    let count = maker.inputs.len();
    for place in 0..count {
        // A call of a fetch is not replaced.
        if !maker.inputs[place].name.contains('(') && maker.choices.one_in(3) {
            let (name, kind) = (maker.inputs[place].name.clone(), maker.inputs[place].kind);
            text += &format!(", {name} = {}", maker.replacement(kind));
        }
    }
    Some(Piece::primary(text + ")"))
}
