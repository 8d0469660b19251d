//! Expressions and conditions, hash-consed: equal terms have equal ids.
//!
//! Everything is scalar. Vectors are expanded into components when a table is
//! lowered, so that every later stage handles numbers and conditions only.
//! Constructors fold constants (in `f64`, as WGSL does for constant
//! expressions) and nothing else: no rewriting that could change rounding.

use std::collections::HashMap;

use super::bits::{InputSet, LevelSet};
use super::operators::{ANY, BinaryOp, Bounded, Bounds, Comparison, TernaryAlgebra, TernaryOp, UnaryAlgebra, UnaryOp};
use super::{InputId, Real};

/// An expression in a [`Pool`].
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ExprId(u32);

impl ExprId {
    /// Its place in the pool; operands stand before what is made of them.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A condition in a [`Pool`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct CondId(u32);

impl CondId {
    /// Its place in the pool; operands stand before what is made of them.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A finite `f64` constant that can be compared and hashed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Number(u64);

impl Number {
    /// Wraps a number.
    pub fn new(value: f64) -> Self {
        Self(value.to_bits())
    }

    /// The number.
    pub fn get(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// A numeric expression. Each operation means what WGSL's operation of the same name means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant.
    Const(Number),
    /// A word that is a constant. Numbers and words are told apart by the form of an expression: a word is this,
    /// an input that is one, what an operation on bits or words gives, or a choice between words.
    Word(u32),
    /// A continuous input.
    Input(InputId),
    /// The index of the level of a discrete input. To all that tells cases apart it is a
    /// selection between constants, one for each level.
    Index(InputId),
    /// A component of the result, in the result map of a symmetry only.
    Result(u16),
    /// An operation on one number.
    Unary(UnaryOp, ExprId),
    /// An operation on two numbers.
    Binary(BinaryOp, ExprId, ExprId),
    /// An operation on three numbers.
    Ternary(TernaryOp, ExprId, ExprId, ExprId),
    /// The first value if the condition holds, else the second; the other one is not evaluated.
    Select(CondId, ExprId, ExprId),
}

/// A condition. Operands are tested from left to right, and only as far as needed.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Cond {
    /// A constant.
    Const(bool),
    /// The discrete input has one of these levels.
    Level(InputId, LevelSet),
    /// A comparison of numbers.
    Compare(Comparison, ExprId, ExprId),
    /// Negation.
    Not(CondId),
    /// All hold; at least two.
    And(Vec<CondId>),
    /// Any holds; at least two.
    Or(Vec<CondId>),
    /// The second if the first holds, else the third.
    If(CondId, CondId, CondId),
}

/// Facts about a term that need no look inside.
#[derive(Debug, Clone, Copy)]
pub struct Facts {
    /// Longest path to a leaf.
    pub depth: u32,
    /// Number of nodes when written out as a tree; saturates.
    pub size: u32,
    /// Every input that is mentioned.
    pub inputs: InputSet,
    /// True if there is a selection anywhere in it, or a level stands as a number.
    pub selects: bool,
    /// Of a number, true if it is whole wherever inputs are in their domains, and so small that `f32`
    /// computes it exactly, in whatever order.
    pub whole: bool,
    /// Of a number, what it lies between wherever inputs are in their domains, also in `f32`;
    /// everything if it may be infinite or no number.
    pub range: Bounds,
    /// True if it is a word.
    pub word: bool,
}

impl Node {
    /// Returns whether it is made of nothing else.
    pub fn is_leaf(self) -> bool {
        self.condition().is_none() && self.children().next().is_none()
    }
}

impl Facts {
    fn leaf(inputs: InputSet) -> Self {
        Self { depth: 1, size: 1, inputs, selects: false, whole: false, range: ANY, word: false }
    }

    fn join(parts: impl IntoIterator<Item = Facts>) -> Self {
        parts.into_iter().fold(Self::leaf(InputSet::default()), |all, part| Self {
            depth: all.depth.max(part.depth.saturating_add(1)),
            size: all.size.saturating_add(part.size),
            inputs: all.inputs.or(part.inputs),
            selects: all.selects || part.selects,
            whole: false,
            range: ANY,
            word: false,
        })
    }
}

/// Owns expressions and conditions.
#[derive(Debug, Clone, Default)]
pub struct Pool {
    exprs: Vec<(Node, Facts)>,
    conds: Vec<(Cond, Facts)>,
    expr_index: HashMap<Node, ExprId>,
    cond_index: HashMap<Cond, CondId>,
    labels: HashMap<ExprId, String>,
    /// By input, what its domain spans, where that was told.
    domains: Vec<Bounds>,
    /// The inputs that are words.
    words: InputSet,
    /// By component, what is known of the result, where that was told.
    results: Vec<Component>,
}

/// The knowledge of a component of the result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Component {
    /// A real number, or a code.
    Any,
    /// A whole number between two others.
    Whole(Bounds),
    /// A word.
    Word,
}

/// Magnitudes beyond this are not taken for finite in `f32`, whatever was rounded on the way.
const LARGE: f64 = 1e38;

/// Whole numbers up to this one are exact in `f32`, and so are their sums, differences and products up to it.
pub(crate) const MAX_WHOLE: f64 = 16_777_216.0;

/// Returns whether a number is the same word before and after it is rounded.
fn is_one_word(number: f64) -> bool {
    let word = |number| UnaryOp::WordOfNumber.apply(number);
    word(number) == word(f64::from(number as f32))
}

/// Bounds that hold of what was rounded as well.
fn widened((lo, hi): Bounds) -> Bounds {
    let rounded = |bound: f64| bound.abs() * 1e-6 + f64::from(f32::MIN_POSITIVE);
    if (lo, hi) == ANY { ANY } else { (lo - rounded(lo), hi + rounded(hi)) }
}

impl Pool {
    /// The node of an expression.
    pub fn node(&self, id: ExprId) -> Node {
        self.exprs[id.0 as usize].0
    }

    /// The form of a condition.
    pub fn cond(&self, id: CondId) -> &Cond {
        &self.conds[id.0 as usize].0
    }

    /// Depth, size and inputs of an expression.
    pub fn expr_facts(&self, id: ExprId) -> Facts {
        self.exprs[id.0 as usize].1
    }

    /// Depth, size and inputs of a condition.
    pub fn cond_facts(&self, id: CondId) -> Facts {
        self.conds[id.0 as usize].1
    }

    /// Returns whether a condition compares numbers.
    pub fn compares(&self, id: CondId) -> bool {
        let cond = self.cond(id);
        matches!(cond, Cond::Compare(..)) || cond.children().any(|part| self.compares(part))
    }

    /// The name a table gives to an expression, if any.
    pub fn label(&self, id: ExprId) -> Option<&str> {
        self.labels.get(&id).map(String::as_str)
    }

    /// The number of expressions.
    pub fn len(&self) -> usize {
        self.exprs.len()
    }

    /// The number of conditions.
    pub fn conditions(&self) -> usize {
        self.conds.len()
    }

    /// The size of the largest expression when written out as a tree; saturates.
    pub fn largest(&self) -> u32 {
        self.exprs.iter().map(|(_, facts)| facts.size).max().unwrap_or(0)
    }

    /// Returns whether there is no expression.
    pub fn is_empty(&self) -> bool {
        self.exprs.is_empty()
    }

    /// All names of expressions, in no particular order.
    pub fn labels(&self) -> impl Iterator<Item = &str> {
        self.labels.values().map(String::as_str)
    }

    /// All expressions.
    pub fn nodes(&self) -> impl Iterator<Item = Node> {
        self.exprs.iter().map(|(node, _)| *node)
    }

    /// All conditions.
    pub fn conds(&self) -> impl Iterator<Item = &Cond> {
        self.conds.iter().map(|(cond, _)| cond)
    }

    /// Names an expression; the first name stays.
    pub fn set_label(&mut self, id: ExprId, label: &str) {
        if !self.node(id).is_leaf() {
            self.labels.entry(id).or_insert_with(|| label.to_owned());
        }
    }

    /// The constant an expression is, if it is one.
    pub fn constant(&self, id: ExprId) -> Option<f64> {
        let Node::Const(number) = self.node(id) else { return None };
        Some(number.get())
    }

    /// The word that an expression is, if it is a constant one.
    pub fn word(&self, id: ExprId) -> Option<u32> {
        let Node::Word(word) = self.node(id) else { return None };
        Some(word)
    }

    /// The constant number or word that an expression is, as a number.
    pub fn known(&self, id: ExprId) -> Option<f64> {
        self.constant(id).or_else(|| self.word(id).map(f64::from))
    }

    /// Returns whether an expression is a word.
    pub fn is_word(&self, id: ExprId) -> bool {
        self.expr_facts(id).word
    }

    /// The truth value a condition is, if it is constant.
    pub fn truth(&self, id: CondId) -> Option<bool> {
        let Cond::Const(value) = self.cond(id) else { return None };
        Some(*value)
    }

    pub(super) fn intern(&mut self, node: Node) -> ExprId {
        if let Some(id) = self.expr_index.get(&node) {
            return *id;
        }
        let facts = if let Node::Input(input) | Node::Index(input) = node {
            Facts { selects: matches!(node, Node::Index(_)), ..Facts::leaf(InputSet::one(input)) }
        } else {
            let condition = node.condition().map(|condition| self.cond_facts(condition));
            let facts = Facts::join(node.children().map(|part| self.expr_facts(part)).chain(condition));
            Facts { selects: facts.selects || condition.is_some(), ..facts }
        };
        let range = self.range(node);
        let whole = self.is_whole(node, range);
        let word = self.gives_word(node);
        let exact =
            whole || word || matches!(node, Node::Const(number) if f64::from(number.get() as f32) == number.get());
        let facts = Facts { range: if exact { range } else { widened(range) }, whole, word, ..facts };
        let id = ExprId(self.exprs.len() as u32);
        self.exprs.push((node, facts));
        self.expr_index.insert(node, id);
        id
    }

    /// The numbers that an expression lies between.
    pub(crate) fn range(&self, node: Node) -> Bounds {
        let of = |part: ExprId| self.expr_facts(part).range;
        let image: Bounded = match node {
            Node::Const(number) => ((number.get(), number.get()), None),
            Node::Word(word) => ((f64::from(word), f64::from(word)), None),
            Node::Input(input) | Node::Index(input) => (self.domains.get(input.index()).copied().unwrap_or(ANY), None),
            Node::Result(component) => (self.result_range(component).unwrap_or(ANY), None),
            Node::Unary(op, a) if op.row().is_plain => op.image(of(a)),
            Node::Binary(op, a, b) if op.row().is_plain || op == BinaryOp::Divide => op.image(of(a), of(b)),
            // What the others give where their operands are rounded is another question.
            Node::Unary(..) | Node::Binary(..) => (ANY, None),
            Node::Ternary(op, a, b, c) => match (op.row().algebra, [of(a), of(b), of(c)]) {
                (TernaryAlgebra::Opaque, _) => (ANY, None),
                (TernaryAlgebra::Clamp | TernaryAlgebra::ProductAndSum | TernaryAlgebra::Mix, parts) => {
                    if parts.contains(&ANY) { (ANY, None) } else { op.image(parts[0], parts[1], parts[2]) }
                }
            },
            Node::Select(_, a, b) => ((of(a).0.min(of(b).0), of(a).1.max(of(b).1)), None),
        };
        match image {
            (range @ (lo, hi), None) if lo > -LARGE && hi < LARGE => range,
            _ => ANY,
        }
    }

    fn result_range(&self, component: u16) -> Option<Bounds> {
        match self.results.get(usize::from(component))? {
            Component::Any => None,
            Component::Whole(range) => Some(*range),
            Component::Word => Some((0.0, f64::from(u32::MAX))),
        }
    }

    /// Returns whether a node is a word.
    pub(super) fn gives_word(&self, node: Node) -> bool {
        match node {
            Node::Word(_) => true,
            Node::Input(input) => self.words.contains(input),
            Node::Result(component) => self.results.get(usize::from(component)) == Some(&Component::Word),
            Node::Unary(op, _) => op.row().gives_word,
            Node::Binary(op, ..) => op.row().is_on_words,
            Node::Select(_, a, _) => self.is_word(a),
            Node::Const(_) | Node::Index(_) | Node::Ternary(..) => false,
        }
    }

    /// Returns whether a number that lies between some others is whole, and `f32` has all that it is made of.
    fn is_whole(&self, node: Node, (lo, hi): Bounds) -> bool {
        let small = lo >= -MAX_WHOLE && hi <= MAX_WHOLE;
        let of = |part: ExprId| self.expr_facts(part).whole;
        small
            && match node {
                Node::Const(number) => number.get().fract() == 0.0,
                Node::Index(_) => true,
                Node::Result(component) => {
                    matches!(self.results.get(usize::from(component)), Some(Component::Whole(_)))
                }
                Node::Word(_) | Node::Input(_) => false,
                // Of a word that is small, the number.
                Node::Unary(UnaryOp::NumberOfWord, _) => true,
                Node::Unary(op, a) => {
                    matches!(op.row().algebra, UnaryAlgebra::Negate | UnaryAlgebra::Absolute) && of(a)
                }
                Node::Binary(op, a, b) => op.row().keeps_whole && of(a) && of(b),
                Node::Ternary(op, a, b, c) => {
                    op.row().algebra == TernaryAlgebra::Clamp && [a, b, c].into_iter().all(of)
                }
                Node::Select(_, a, b) => of(a) && of(b),
            }
    }

    fn intern_cond(&mut self, cond: Cond) -> CondId {
        if let Some(id) = self.cond_index.get(&cond) {
            return *id;
        }
        let facts = if let Cond::Level(input, _) = &cond {
            Facts::leaf(InputSet::one(*input))
        } else {
            let compared = cond.compared().map(|part| self.expr_facts(part));
            Facts::join(compared.chain(cond.children().map(|part| self.cond_facts(part))))
        };
        let id = CondId(self.conds.len() as u32);
        self.conds.push((cond.clone(), facts));
        self.cond_index.insert(cond, id);
        id
    }

    /// A constant.
    pub fn number(&mut self, value: f64) -> ExprId {
        // One zero: WGSL lets an implementation ignore its sign.
        self.intern(Node::Const(Number::new(if value == 0.0 { 0.0 } else { value })))
    }

    /// A constant word.
    pub fn constant_word(&mut self, word: u32) -> ExprId {
        self.intern(Node::Word(word))
    }

    /// A value of an input that is no level, as a constant.
    pub fn value_of(&mut self, input: InputId, value: f64) -> ExprId {
        if self.words.contains(input) { self.constant_word(value as u32) } else { self.number(value) }
    }

    /// Says that an input is a word, before it is mentioned.
    pub(crate) fn declare_word(&mut self, input: InputId) {
        self.words = self.words.or(InputSet::one(input));
    }

    /// Says between which numbers an input lies, before it is mentioned.
    pub fn declare(&mut self, input: InputId, domain: Bounds) {
        if self.domains.len() <= input.index() {
            self.domains.resize(input.index() + 1, ANY);
        }
        self.domains[input.index()] = domain;
    }

    /// Says what is known of each component of the result, before it is mentioned.
    pub(crate) fn declare_results(&mut self, components: Vec<Component>) {
        self.results = components;
    }

    /// An empty pool for programs with the results of another one's.
    pub(crate) fn of_results(other: &Pool) -> Self {
        Self { results: other.results.clone(), ..Self::default() }
    }

    /// A continuous input.
    pub fn input(&mut self, input: InputId) -> ExprId {
        self.intern(Node::Input(input))
    }

    /// The index of the level of a discrete input that has several.
    pub fn index(&mut self, input: InputId) -> ExprId {
        self.intern(Node::Index(input))
    }

    /// A component of the result, for the result map of a symmetry.
    pub fn result(&mut self, component: usize) -> ExprId {
        debug_assert!(u16::try_from(component).is_ok());
        self.intern(Node::Result(component as u16))
    }

    /// Returns whether an operation can be folded once its operands are known, without a
    /// trace in the result: the folded constant, rounded to `f32`, must be what
    /// the operation gives in `f32`, and it must not be one that shading
    /// languages refuse. Folding is free in a table as written, where it is part
    /// of the meaning; this is for operands that become known later.
    pub fn folds(&self, node: Node) -> bool {
        if self.gives_word(node) {
            // Words are the same on every device, what a number is rounded to may be not.
            let Node::Unary(UnaryOp::WordOfNumber, a) = node else { return true };
            return self.constant(a).is_none_or(is_one_word);
        }
        let known = |id| self.constant(id);
        let agree = |wide: f64, narrow: f32| narrow.is_finite() && wide as f32 == narrow;
        match node {
            Node::Unary(op, a) => known(a).is_none_or(|a| agree(op.apply(a), f32::unary(op, a as f32))),
            Node::Binary(op, a, b) => match (op, known(a), known(b)) {
                (BinaryOp::Divide | BinaryOp::Remainder, _, Some(0.0)) => false,
                (_, Some(a), Some(b)) => agree(op.apply(a, b), f32::binary(op, a as f32, b as f32)),
                _ => true,
            },
            Node::Ternary(op, a, b, c) => match [a, b, c].map(known) {
                operands if op.misordered(operands).is_some() => false,
                [Some(a), Some(b), Some(c)] => agree(op.apply(a, b, c), f32::ternary(op, a as f32, b as f32, c as f32)),
                _ => true,
            },
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => {
                true
            }
        }
    }

    /// An operation whose operands a call made known: folded if [`Pool::folds`] says so, else left as it is.
    pub fn rebuild(&mut self, node: Node) -> ExprId {
        if self.folds(node) { self.fold(node) } else { self.intern(node) }
    }

    /// A node made of what is in the pool: folded if its operands are constants, a selection made if it is decided.
    pub fn fold(&mut self, node: Node) -> ExprId {
        match node {
            Node::Unary(op, a) => self.unary(op, a),
            Node::Binary(op, a, b) => self.binary(op, a, b),
            Node::Ternary(op, a, b, c) => self.ternary(op, a, b, c),
            Node::Select(condition, a, b) => self.select(condition, a, b),
            Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) => self.intern(node),
        }
    }

    /// A comparison whose operands became known later: decided if `f32` and `f64` agree, else left as it is.
    pub fn recompare(&mut self, op: Comparison, a: ExprId, b: ExprId) -> CondId {
        match (self.constant(a), self.constant(b)) {
            (Some(x), Some(y)) if op.holds(x, y) != op.holds(x as f32, y as f32) => {
                self.intern_cond(Cond::Compare(op, a, b))
            }
            _ => self.compare(op, a, b),
        }
    }

    /// An operation on one number.
    pub fn unary(&mut self, op: UnaryOp, a: ExprId) -> ExprId {
        match self.known(a) {
            Some(a) => self.made(op.row().gives_word, op.apply(a)),
            None => self.intern(Node::Unary(op, a)),
        }
    }

    /// An operation on two numbers.
    pub fn binary(&mut self, op: BinaryOp, a: ExprId, b: ExprId) -> ExprId {
        match (self.known(a), self.known(b)) {
            (Some(a), Some(b)) => self.made(op.row().is_on_words, op.apply(a, b)),
            _ => self.intern(Node::Binary(op, a, b)),
        }
    }

    /// The result of an operation on constants.
    fn made(&mut self, is_word: bool, value: f64) -> ExprId {
        if is_word { self.constant_word(value as u32) } else { self.number(value) }
    }

    /// An operation on three numbers.
    pub fn ternary(&mut self, op: TernaryOp, a: ExprId, b: ExprId, c: ExprId) -> ExprId {
        match (self.constant(a), self.constant(b), self.constant(c)) {
            (Some(a), Some(b), Some(c)) => self.number(op.apply(a, b, c)),
            _ => self.intern(Node::Ternary(op, a, b, c)),
        }
    }

    /// A choice between two numbers.
    pub fn select(&mut self, condition: CondId, then: ExprId, other: ExprId) -> ExprId {
        match self.truth(condition) {
            Some(true) => then,
            Some(false) => other,
            None if then == other => then,
            None => self.intern(Node::Select(condition, then, other)),
        }
    }

    /// A constant condition.
    pub fn always(&mut self, value: bool) -> CondId {
        self.intern_cond(Cond::Const(value))
    }

    /// The input, which has `count` levels, has one of `levels`.
    pub fn level(&mut self, input: InputId, levels: LevelSet, count: usize) -> CondId {
        let all = LevelSet::all(count);
        match levels.0 & all.0 {
            0 => self.always(false),
            some if some == all.0 => self.always(true),
            some => self.intern_cond(Cond::Level(input, LevelSet(some))),
        }
    }

    /// A comparison of numbers.
    pub fn compare(&mut self, op: Comparison, a: ExprId, b: ExprId) -> CondId {
        match (self.known(a), self.known(b)) {
            (Some(a), Some(b)) => self.always(op.holds(a, b)),
            _ => self.intern_cond(Cond::Compare(op, a, b)),
        }
    }

    /// Negation.
    pub fn not(&mut self, a: CondId) -> CondId {
        match self.cond(a) {
            Cond::Const(value) => {
                let value = !value;
                self.always(value)
            }
            Cond::Not(inner) => *inner,
            Cond::Level(..) | Cond::Compare(..) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {
                self.intern_cond(Cond::Not(a))
            }
        }
    }

    /// All of the conditions.
    pub fn and(&mut self, items: impl IntoIterator<Item = CondId>) -> CondId {
        self.junction(items, true)
    }

    /// Any of the conditions.
    pub fn or(&mut self, items: impl IntoIterator<Item = CondId>) -> CondId {
        self.junction(items, false)
    }

    /// Flattens, drops neutral operands and repetitions, stops at a deciding one.
    fn junction(&mut self, items: impl IntoIterator<Item = CondId>, is_and: bool) -> CondId {
        let mut flat: Vec<CondId> = Vec::new();
        for item in items {
            let parts = match self.cond(item) {
                Cond::And(parts) if is_and => parts.clone(),
                Cond::Or(parts) if !is_and => parts.clone(),
                Cond::Const(_)
                | Cond::Level(..)
                | Cond::Compare(..)
                | Cond::Not(_)
                | Cond::And(_)
                | Cond::Or(_)
                | Cond::If(..) => vec![item],
            };
            for part in parts {
                match self.truth(part) {
                    Some(value) if value == is_and => {}
                    // What follows is never tested; what stands before still is.
                    Some(_) if flat.is_empty() => return part,
                    Some(_) => return self.finish_junction(flat, Some(part), is_and),
                    None if flat.contains(&part) => {}
                    None => flat.push(part),
                }
            }
        }
        self.finish_junction(flat, None, is_and)
    }

    fn finish_junction(&mut self, flat: Vec<CondId>, decided: Option<CondId>, is_and: bool) -> CondId {
        match (decided, flat.as_slice()) {
            // Conditions have no effects, so a decided junction is its constant.
            (Some(constant), _) => constant,
            (None, []) => self.always(is_and),
            (None, [one]) => *one,
            (None, _) => self.intern_cond(if is_and { Cond::And(flat) } else { Cond::Or(flat) }),
        }
    }

    /// A choice between two conditions.
    pub fn cond_if(&mut self, condition: CondId, then: CondId, other: CondId) -> CondId {
        match (self.truth(condition), self.truth(then), self.truth(other)) {
            (Some(true), ..) => then,
            (Some(false), ..) => other,
            _ if then == other => then,
            (None, Some(true), Some(false)) => condition,
            (None, Some(false), Some(true)) => self.not(condition),
            (None, None, Some(false)) => self.and([condition, then]),
            (None, Some(true), None) => self.or([condition, other]),
            _ => self.intern_cond(Cond::If(condition, then, other)),
        }
    }
}
