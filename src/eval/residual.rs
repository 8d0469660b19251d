//! The rest of a program once the plain discrete inputs are known.
//!
//! For one discrete state most guards are decided. The [`Residual`] of a state
//! is the small decision tree that remains: fetches, tests of fetched levels,
//! comparisons, and leaves whose expressions are straight-line code. A selection
//! between sides of a few operations computes both and takes one of them, since
//! a tree that branches at each of twenty would have a million leaves; larger
//! sides are branches of the tree. Terms and trees are interned, so states that
//! mean the same share one tree.
//!
//! This does not go through [`Pool`](crate::program::Pool)'s constructors. They fold constants in
//! `f64` and drop conditions that cannot matter to the value, either of which
//! would differ from the reference: in rounding, or in what is fetched.

use std::collections::{HashMap, HashSet};
use std::marker::PhantomData;

use super::columns::Path;
use crate::program::{
    BinaryOp, Comparison, Cond, CondId, Domain, ExprId, InputId, InputSet, LevelSet, Node, Number, Program, Real,
    TernaryOp, UnaryOp,
};

/// Most nodes of one tree; a state that needs more is left to the scalar interpreter.
const MAX_NODES: usize = 4096;

/// Most tests one after the other.
const MAX_TESTS: usize = 256;

/// Most terms visited for one tree.
const MAX_STEPS: usize = 1 << 20;

/// Most operations of both sides of a selection of which one is computed in vain. About what it costs to take
/// two groups of rows through the tree instead of one.
const FEW: usize = 48;

/// A term in a [`Residual`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct TermId(u32);

impl TermId {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// An expression in which nothing branches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Term {
    Const(Number),
    Word(u32),
    Input(InputId),
    /// The index of a level.
    Index(InputId),
    Unary(UnaryOp, TermId),
    Binary(BinaryOp, TermId, TermId),
    Ternary(TernaryOp, TermId, TermId, TermId),
    /// 1 if the comparison holds, and otherwise 0.
    Compare(Test, TermId, TermId),
    /// The second if the first is not 0, and otherwise the third.
    Choose(TermId, TermId, TermId),
}

/// A comparison of two numbers, or of two words.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Test {
    pub(super) op: Comparison,
    pub(super) words: bool,
}

impl Test {
    /// Returns whether it holds.
    #[inline]
    pub(super) fn holds<T: Real>(self, a: T, b: T) -> bool {
        self.op.holds_of(self.words, a, b)
    }
}

/// A tree in a [`Residual`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct TreeId(u32);

impl TreeId {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// The work that remains.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Tree {
    /// Fetch the input, then go on.
    Need(InputId, TreeId),
    /// Does the fetched input have one of the levels?
    Level(InputId, LevelSet, [TreeId; 2]),
    /// Does the comparison hold?
    Compare(Test, TermId, TermId, [TreeId; 2]),
    /// The result: the number of the path, and a term per component.
    Leaf(u32, Vec<TermId>),
    /// Too large to write down.
    Scalar,
}

/// Numbers paths.
#[derive(Debug, Default)]
pub(super) struct Paths {
    list: Vec<Path>,
    index: HashMap<Path, u32>,
}

impl Paths {
    pub(super) fn number(&mut self, path: Path) -> u32 {
        *self.index.entry(path).or_insert_with(|| {
            self.list.push(path);
            self.list.len() as u32 - 1
        })
    }
}

/// Specialises a program, state by state.
#[derive(Debug)]
pub(super) struct Residual<'p, T> {
    program: &'p Program,
    terms: Vec<Term>,
    term_index: HashMap<Term, TermId>,
    trees: Vec<Tree>,
    tree_index: HashMap<Tree, TreeId>,
    paths: Paths,
    /// Terms of expressions, valid while one [`Known`] does not change.
    memo: HashMap<ExprId, TermId>,
    nodes: usize,
    steps: usize,
    /// Most operations of both sides of a selection that does not branch.
    few: usize,
    precision: PhantomData<T>,
}

/// The facts known on the way to a place in the tree.
#[derive(Debug, Clone)]
struct Known {
    levels: Vec<LevelSet>,
    comparisons: Vec<((Test, TermId, TermId), bool)>,
    fetched: InputSet,
    /// Rows and lines before these are known not to apply.
    row: usize,
    line: usize,
    tests: usize,
}

/// Why a walk could not go on.
enum Stop {
    Need(InputId),
    Level(InputId, LevelSet),
    Compare(Test, TermId, TermId),
    TooLarge,
}

impl<'p, T: Real> Residual<'p, T> {
    pub(super) fn new(program: &'p Program) -> Self {
        Self {
            program,
            terms: Vec::new(),
            term_index: HashMap::new(),
            trees: Vec::new(),
            tree_index: HashMap::new(),
            paths: Paths::default(),
            memo: HashMap::new(),
            nodes: 0,
            steps: 0,
            few: FEW,
            precision: PhantomData,
        }
    }

    pub(super) fn terms(&self) -> &[Term] {
        &self.terms
    }

    pub(super) fn trees(&self) -> &[Tree] {
        &self.trees
    }

    pub(super) fn paths(&self) -> &Vec<Path> {
        &self.paths.list
    }

    /// The trees, and the paths to add to for those that are left to the scalar interpreter.
    pub(super) fn parts(&mut self) -> (&[Tree], &mut Paths) {
        (&self.trees, &mut self.paths)
    }

    /// The tree of a state, given as the levels of all inputs that are not fetched.
    pub(super) fn specialise(&mut self, levels: &[u8]) -> TreeId {
        let known = |(id, input): (InputId, &crate::program::Input)| match &input.domain {
            Domain::Discrete(all) if input.fetched.is_some() => LevelSet::all(all.count()),
            Domain::Discrete(_) | Domain::Continuous { .. } | Domain::Word => LevelSet::one(levels[id.index()]),
        };
        let known = Known {
            levels: self.program.input_ids().map(known).collect(),
            comparisons: Vec::new(),
            fetched: InputSet::default(),
            row: 0,
            line: 0,
            tests: 0,
        };
        let before = self.trees.len();
        for few in [FEW, usize::MAX] {
            (self.nodes, self.steps, self.few) = (0, 0, few);
            if let Some(tree) = self.explore(known.clone()) {
                return tree;
            }
            self.trees.truncate(before);
            self.tree_index.retain(|_, id| id.index() < before);
        }
        self.tree(Tree::Scalar)
    }

    /// Walks the program as far as it is decided, and from there in both directions.
    fn explore(&mut self, mut known: Known) -> Option<TreeId> {
        self.nodes += 1;
        known.tests += 1;
        if self.nodes > MAX_NODES || known.tests > MAX_TESTS {
            return None;
        }
        self.memo.clear();
        let tree = match self.walk(&mut known) {
            Ok(leaf) => leaf,
            Err(Stop::TooLarge) => return None,
            Err(Stop::Need(input)) => {
                known.fetched = known.fetched.or(InputSet::one(input));
                Tree::Need(input, self.explore(known)?)
            }
            Err(Stop::Level(input, set)) => {
                let mut other = known.clone();
                known.levels[input.index()].0 &= set.0;
                other.levels[input.index()].0 &= !set.0;
                match [self.explore(known)?, self.explore(other)?] {
                    [yes, no] if yes == no => return Some(yes),
                    sides => Tree::Level(input, set, sides),
                }
            }
            Err(Stop::Compare(op, a, b)) => {
                let mut other = known.clone();
                known.comparisons.push(((op, a, b), true));
                other.comparisons.push(((op, a, b), false));
                match [self.explore(known)?, self.explore(other)?] {
                    [yes, no] if yes == no => return Some(yes),
                    sides => Tree::Compare(op, a, b, sides),
                }
            }
        };
        Some(self.tree(tree))
    }

    fn walk(&mut self, known: &mut Known) -> Result<Tree, Stop> {
        let program = self.program;
        while let Some(row) = program.rows.get(known.row) {
            if !self.holds(known, row.guard)? {
                known.row += 1;
                continue;
            }
            while let Some(line) = row.lines.get(known.line) {
                if self.holds(known, line.condition)? {
                    return self.leaf(known, Some(known.row), Some(known.line), &line.values);
                }
                known.line += 1;
            }
            return self.leaf(known, Some(known.row), None, &program.default);
        }
        self.leaf(known, None, None, &program.default)
    }

    fn leaf(
        &mut self,
        known: &Known,
        row: Option<usize>,
        line: Option<usize>,
        values: &[ExprId],
    ) -> Result<Tree, Stop> {
        let terms = values.iter().map(|value| self.number(known, *value)).collect::<Result<_, _>>()?;
        Ok(Tree::Leaf(self.paths.number(Path { row, line, fetched: known.fetched }), terms))
    }

    fn need(&self, known: &Known, input: InputId) -> Result<(), Stop> {
        match self.program.fetched.contains(input) && !known.fetched.contains(input) {
            true => Err(Stop::Need(input)),
            false => Ok(()),
        }
    }

    fn step(&mut self) -> Result<(), Stop> {
        self.steps += 1;
        if self.steps > MAX_STEPS { Err(Stop::TooLarge) } else { Ok(()) }
    }

    /// Follows [`Interpreter::holds`](super::Interpreter::holds) step by step.
    fn holds(&mut self, known: &Known, condition: CondId) -> Result<bool, Stop> {
        self.step()?;
        match self.program.pool.cond(condition) {
            Cond::Const(value) => Ok(*value),
            Cond::Level(input, set) => {
                self.need(known, *input)?;
                let possible = known.levels[input.index()].0;
                match possible & set.0 {
                    0 => Ok(false),
                    some if some == possible => Ok(true),
                    some => Err(Stop::Level(*input, LevelSet(some))),
                }
            }
            Cond::Compare(op, a, b) => {
                let test = self.test(*op, *a);
                let (a, b) = (self.number(known, *a)?, self.number(known, *b)?);
                if let (Some(a), Some(b)) = (self.constant(a), self.constant(b)) {
                    return Ok(test.holds(a, b));
                }
                let decided = known.comparisons.iter().find(|(known, _)| *known == (test, a, b));
                decided.map(|(_, outcome)| *outcome).ok_or(Stop::Compare(test, a, b))
            }
            Cond::Not(a) => Ok(!self.holds(known, *a)?),
            Cond::And(parts) => {
                for part in parts {
                    if !self.holds(known, *part)? {
                        return Ok(false);
                    }
                }
                Ok(true)
            }
            Cond::Or(parts) => {
                for part in parts {
                    if self.holds(known, *part)? {
                        return Ok(true);
                    }
                }
                Ok(false)
            }
            Cond::If(condition, then, other) => match self.holds(known, *condition)? {
                true => self.holds(known, *then),
                false => self.holds(known, *other),
            },
        }
    }

    /// Follows [`Interpreter::number`](super::Interpreter::number) step by step.
    fn number(&mut self, known: &Known, expr: ExprId) -> Result<TermId, Stop> {
        if let Some(term) = self.memo.get(&expr) {
            return Ok(*term);
        }
        self.step()?;
        let term = match self.program.pool.node(expr) {
            Node::Const(number) => self.fixed(T::from_f64(number.get())),
            Node::Word(word) => self.term(Term::Word(word)),
            Node::Input(input) => {
                self.need(known, input)?;
                self.term(Term::Input(input))
            }
            Node::Index(input) => {
                self.need(known, input)?;
                match known.levels[input.index()] {
                    one if one.0.is_power_of_two() => self.fixed(T::from_f64(f64::from(one.0.trailing_zeros()))),
                    _ => self.term(Term::Index(input)),
                }
            }
            Node::Result(_) => self.fixed(T::from_f64(f64::NAN)),
            Node::Unary(op, a) => {
                let a = self.number(known, a)?;
                match self.constant(a) {
                    Some(a) => self.made(op.row().gives_word, T::unary(op, a)),
                    None => self.term(Term::Unary(op, a)),
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.number(known, a)?, self.number(known, b)?);
                match (self.constant(a), self.constant(b)) {
                    (Some(a), Some(b)) => self.made(op.row().is_on_words, T::binary(op, a, b)),
                    _ => self.term(Term::Binary(op, a, b)),
                }
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.number(known, a)?, self.number(known, b)?, self.number(known, c)?);
                match (self.constant(a), self.constant(b), self.constant(c)) {
                    (Some(a), Some(b), Some(c)) => self.fixed(T::ternary(op, a, b, c)),
                    _ => self.term(Term::Ternary(op, a, b, c)),
                }
            }
            Node::Select(condition, then, other) => match self.selection(known, condition, then, other) {
                Some(term) => term,
                None => match self.holds(known, condition)? {
                    true => self.number(known, then)?,
                    false => self.number(known, other)?,
                },
            },
        };
        self.memo.insert(expr, term);
        Ok(term)
    }

    /// A selection as a term, if its sides are small and nothing that it may need is yet to be fetched.
    fn selection(&mut self, known: &Known, condition: CondId, then: ExprId, other: ExprId) -> Option<TermId> {
        let mut seen = HashSet::new();
        if self.few < usize::MAX && !(self.adds_few(then, &mut seen) && self.adds_few(other, &mut seen)) {
            return None;
        }
        let condition = self.truth(known, condition).ok()?;
        if let Some(truth) = self.constant(condition) {
            return self.number(known, if truth == T::from_f64(0.0) { other } else { then }).ok();
        }
        let (then, other) = (self.number(known, then).ok()?, self.number(known, other).ok()?);
        Some(self.choose(condition, then, other))
    }

    /// Returns whether an expression, with what was seen before it, is not too much that is not computed anyway.
    fn adds_few(&self, expr: ExprId, seen: &mut HashSet<ExprId>) -> bool {
        if self.memo.contains_key(&expr) || !seen.insert(expr) {
            return true;
        }
        if seen.len() > self.few {
            return false;
        }
        self.program.pool.node(expr).children().all(|part| self.adds_few(part, seen))
    }

    /// A condition as a term that is 1 or 0. All of it is computed, so it stops at what is yet to be fetched.
    fn truth(&mut self, known: &Known, condition: CondId) -> Result<TermId, Stop> {
        self.step()?;
        let [no, yes] = [0.0, 1.0].map(|value| self.fixed(T::from_f64(value)));
        match self.program.pool.cond(condition) {
            Cond::Const(_) | Cond::Level(..) => Ok(if self.holds(known, condition)? { yes } else { no }),
            Cond::Compare(op, a, b) => match self.holds(known, condition) {
                Ok(holds) => Ok(if holds { yes } else { no }),
                Err(Stop::Compare(..)) => {
                    let test = self.test(*op, *a);
                    let (a, b) = (self.number(known, *a)?, self.number(known, *b)?);
                    Ok(self.term(Term::Compare(test, a, b)))
                }
                Err(stop) => Err(stop),
            },
            Cond::Not(a) => {
                let a = self.truth(known, *a)?;
                Ok(self.choose(a, no, yes))
            }
            Cond::And(parts) => parts.iter().try_fold(yes, |all, part| {
                let part = self.truth(known, *part)?;
                Ok(self.choose(all, part, no))
            }),
            Cond::Or(parts) => parts.iter().try_fold(no, |any, part| {
                let part = self.truth(known, *part)?;
                Ok(self.choose(any, yes, part))
            }),
            Cond::If(condition, then, other) => {
                let condition = self.truth(known, *condition)?;
                let (then, other) = (self.truth(known, *then)?, self.truth(known, *other)?);
                Ok(self.choose(condition, then, other))
            }
        }
    }

    fn choose(&mut self, condition: TermId, then: TermId, other: TermId) -> TermId {
        match self.constant(condition) {
            Some(truth) if truth == T::from_f64(0.0) => other,
            Some(_) => then,
            None if then == other => then,
            None => self.term(Term::Choose(condition, then, other)),
        }
    }

    fn constant(&self, term: TermId) -> Option<T> {
        match self.terms[term.index()] {
            Term::Const(number) => Some(T::from_f64(number.get())),
            Term::Word(word) => Some(T::from_word(word)),
            Term::Input(_)
            | Term::Index(_)
            | Term::Unary(..)
            | Term::Binary(..)
            | Term::Ternary(..)
            | Term::Compare(..)
            | Term::Choose(..) => None,
        }
    }

    /// The comparison of two expressions, of which one is `a`.
    fn test(&self, op: Comparison, a: ExprId) -> Test {
        Test { op, words: self.program.pool.is_word(a) }
    }

    /// The result of an operation on constants.
    fn made(&mut self, is_word: bool, value: T) -> TermId {
        if is_word { self.term(Term::Word(value.to_word())) } else { self.fixed(value) }
    }

    fn fixed(&mut self, value: T) -> TermId {
        self.term(Term::Const(Number::new(value.to_f64())))
    }

    fn term(&mut self, term: Term) -> TermId {
        *self.term_index.entry(term).or_insert_with(|| {
            self.terms.push(term);
            TermId(self.terms.len() as u32 - 1)
        })
    }

    fn tree(&mut self, tree: Tree) -> TreeId {
        if let Some(id) = self.tree_index.get(&tree) {
            return *id;
        }
        let id = TreeId(self.trees.len() as u32);
        self.trees.push(tree.clone());
        self.tree_index.insert(tree, id);
        id
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Table;

    /// Even the printed sums over a dozen nodes, each with selections of its own.
    #[test]
    fn no_function_is_left_to_the_scalar_interpreter() {
        for table in ["double_product", "double_product_printed", "spherical_gaussian", "spherical_gaussian_printed"] {
            let table = Table::read(format!("tables/{table}.ron")).unwrap_or_else(|e| panic!("{e}"));
            for program in Program::check_all(&table).unwrap_or_else(|e| panic!("{e}")) {
                let mut residual = Residual::<f32>::new(&program);
                let root = residual.specialise(&vec![0; program.inputs.len()]);
                assert_ne!(residual.trees()[root.index()], Tree::Scalar, "{}", program.name);
                // Far from where a tree is given up. The largest, of the moments, branches over its three forms.
                assert!(residual.trees().len() < MAX_NODES / 16, "{}: {}", program.name, residual.trees().len());
            }
        }
    }
}
