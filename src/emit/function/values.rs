//! The computation of numbers: once, and only on the ways that need them.
//!
//! An expression is a graph, generated code is text. What occurs more than once
//! gets a local. A selection whose sides could fail (divide by zero, take a
//! root) or cost much becomes a conditional statement, with what only one side
//! needs inside of it; selections by the same condition share a statement. What
//! several statements need, and what cannot fail, is computed before them.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::body::Body;
use super::scope::Scope;
use crate::emit::language::{Type, bare, call};
use crate::program::{CondId, ExprId, Node, Pool, Scalar, UnaryOp};

/// Deepest nesting of a printed expression; what is deeper gets a local.
/// Front ends recurse, and some give up at about seventy levels.
const MAX_NESTING: usize = 24;

/// Largest side of a selection that is written in place.
pub(super) const MAX_PLAIN: u32 = 40;

/// The values that a block of statements needs whichever way its selections go.
#[derive(Default)]
struct Needs {
    /// The expressions, operands first.
    order: Vec<ExprId>,
    /// The number of uses of each.
    uses: HashMap<ExprId, usize>,
}

impl Body<'_, '_> {
    /// Declares locals so that the values can be printed: for what the table
    /// names, what occurs more than once, and what nests too deeply.
    pub(in crate::emit) fn declare(&mut self, values: &[ExprId]) {
        let mut needs = Needs::default();
        for value in values {
            self.visit(*value, &mut needs);
        }
        let mut shared: HashSet<ExprId> =
            needs.uses.iter().filter(|(_, count)| **count > 1).map(|(expr, _)| *expr).collect();
        let choices: Vec<ExprId> = needs.order.iter().copied().filter(|e| self.is_choice(*e)).collect();
        if !choices.is_empty() {
            self.share_with_sides(&choices, &mut needs, &mut shared);
        }
        let mut depths: HashMap<ExprId, usize> = HashMap::new();
        // What waits for a conditional statement comes after it; all else, before.
        let mut waits: HashSet<ExprId> = HashSet::new();
        for expr in &needs.order {
            let operands = self.operands_of(*expr);
            if self.is_choice(*expr) || operands.iter().any(|operand| waits.contains(operand)) {
                waits.insert(*expr);
            }
        }
        let (late, early): (Vec<ExprId>, Vec<ExprId>) = needs.order.iter().partition(|expr| waits.contains(expr));
        for expr in early.into_iter().chain(late) {
            if self.scope.value(expr).is_some() {
                continue;
            }
            if self.is_choice(expr) {
                self.choose(expr, &choices);
                depths.insert(expr, 0);
                continue;
            }
            self.local(expr, values.contains(&expr), shared.contains(&expr), &mut depths);
        }
    }

    /// Declares locals so that a condition can be printed, if its operands are large.
    pub(in crate::emit) fn operands(&mut self, condition: CondId) {
        if self.plan.pool.cond_facts(condition).size > MAX_PLAIN {
            self.declare(&compared(&self.plan.pool, condition));
        }
    }

    /// One expression that is needed in any case.
    fn local(&mut self, expr: ExprId, is_result: bool, shared: bool, depths: &mut HashMap<ExprId, usize>) {
        let pool = &self.plan.pool;
        let node = pool.node(expr);
        if let Node::Unary(op @ (UnaryOp::PortableSin | UnaryOp::PortableCos), argument) = node {
            let pair = match self.scope.pair(argument) {
                Some(pair) => pair.to_owned(),
                None => {
                    let pair = self.temporary();
                    let function = self.dialect.global(self.prefix, "sincos");
                    let value = call(&function, &[&self.expr(argument)]);
                    self.text.line(self.dialect.local(&Type::PAIR, &pair, &value, self.prefix));
                    self.scope.name_pair(argument, pair.clone());
                    pair
                }
            };
            self.scope.name(expr, self.dialect.of_pair(&pair, op == UnaryOp::PortableCos));
            depths.insert(expr, 0);
            return;
        }
        let depth = 1 + node.children().filter_map(|c| depths.get(&c)).max().copied().unwrap_or(0);
        depths.insert(expr, depth);
        let label = pool.label(expr);
        if node.is_leaf() || !(shared || depth >= MAX_NESTING || (label.is_some() && !is_result)) {
            return;
        }
        let name = self.name_for(expr);
        let value = self.expr(expr);
        self.text.line(self.dialect.local(&self.type_of(expr), &name, bare(&value), self.prefix));
        self.scope.name(expr, name);
        depths.insert(expr, 0);
    }

    /// A name that nothing in sight has: that of the table, if it can be had.
    fn name_for(&mut self, expr: ExprId) -> String {
        let label = self.plan.pool.label(expr).map(|label| label.replace('.', "_"));
        match label.filter(|label| !self.names.hides(label) && self.scope.take(label)) {
            Some(label) => label,
            None => self.temporary(),
        }
    }

    /// A selection as a conditional statement, together with the others by its condition.
    fn choose(&mut self, expr: ExprId, choices: &[ExprId]) {
        let Node::Select(condition, ..) = self.plan.pool.node(expr) else { return };
        let mut group: Vec<(ExprId, String, ExprId, ExprId)> = Vec::new();
        for other in choices {
            if let Node::Select(c, yes, no) = self.plan.pool.node(*other)
                && c == condition
                && self.scope.value(*other).is_none()
            {
                group.push((*other, self.name_for(*other), yes, no));
            }
        }
        for (expr, name, ..) in &group {
            let scalar = if self.plan.pool.is_word(*expr) { Scalar::Word } else { Scalar::Float };
            self.text.line(self.dialect.later(scalar, name));
        }
        let test = self.condition(condition);
        self.text.open(self.dialect.if_open(bare(&test)));
        for outcome in [true, false] {
            let side_begins = self.scope.mark();
            self.scope.decide(condition, outcome);
            let side = |yes: ExprId, no: ExprId| if outcome { yes } else { no };
            let values: Vec<ExprId> = group.iter().map(|(_, _, yes, no)| side(*yes, *no)).collect();
            self.declare(&values);
            for ((_, name, ..), value) in group.iter().zip(values) {
                let value = self.expr(value);
                self.text.line(format!("{name} = {};", bare(&value)));
            }
            self.scope.forget(side_begins);
            match outcome {
                true => self.text.otherwise(),
                false => self.text.close(),
            }
        }
        for (expr, name, ..) in group {
            self.scope.name(expr, name);
        }
    }

    /// Collects what an expression needs in any case; a choice needs what its condition compares.
    fn visit(&self, expr: ExprId, needs: &mut Needs) {
        let count = needs.uses.entry(expr).or_insert(0);
        *count += 1;
        if *count > 1 || self.scope.value(expr).is_some() {
            return;
        }
        for operand in self.operands_of(expr) {
            self.visit(operand, needs);
        }
        needs.order.push(expr);
    }

    fn operands_of(&self, expr: ExprId) -> Vec<ExprId> {
        let pool = &self.plan.pool;
        match pool.node(expr) {
            Node::Select(c, a, b) => match self.scope.outcome(c) {
                Some(outcome) => vec![if outcome { a } else { b }],
                None if self.is_choice(expr) => compared(pool, c),
                None => {
                    let large = pool.cond_facts(c).size > MAX_PLAIN;
                    [a, b].into_iter().chain(if large { compared(pool, c) } else { Vec::new() }).collect()
                }
            },
            node @ (Node::Const(_)
            | Node::Word(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Result(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)) => node.children().collect(),
        }
    }

    /// Returns whether an expression is a selection that becomes a conditional statement.
    fn is_choice(&self, expr: ExprId) -> bool {
        let pool = &self.plan.pool;
        let Node::Select(c, a, b) = pool.node(expr) else { return false };
        self.scope.outcome(c).is_none() && [a, b].iter().any(|side| !self.is_plain(*side))
    }

    /// Returns whether an expression is small and cannot fail.
    fn is_plain(&self, expr: ExprId) -> bool {
        let pool = &self.plan.pool;
        let mut open = vec![expr];
        pool.expr_facts(expr).size <= MAX_PLAIN
            && std::iter::from_fn(|| {
                let expr = open.pop()?;
                open.extend(pool.node(expr).children());
                Some(expr)
            })
            .all(|expr| cannot_fail(pool.node(expr)))
    }

    /// Marks what the sides of choices share with the block, and adds to the
    /// block what the sides of several choices share, if it cannot fail.
    fn share_with_sides(&self, choices: &[ExprId], needs: &mut Needs, shared: &mut HashSet<ExprId>) {
        let pool = &self.plan.pool;
        // By condition: statements are.
        let mut reached: HashMap<CondId, BTreeSet<ExprId>> = HashMap::new();
        for choice in choices {
            if let Node::Select(condition, yes, no) = pool.node(*choice) {
                let seen = reached.entry(condition).or_default();
                for side in [yes, no] {
                    reach(pool, side, &self.scope, seen);
                }
            }
        }
        let needed: HashSet<ExprId> = needs.order.iter().copied().collect();
        let mut statements: HashMap<ExprId, usize> = HashMap::new();
        for expr in reached.values().flatten() {
            *statements.entry(*expr).or_insert(0) += 1;
        }
        let mut safe: HashMap<ExprId, bool> = HashMap::new();
        let mut several: Vec<ExprId> = Vec::new();
        for (expr, count) in &statements {
            if needed.contains(expr) {
                shared.insert(*expr);
            } else if *count > 1 && is_safe(pool, *expr, &mut safe) {
                several.push(*expr);
            }
        }
        // Operands have lower numbers than what is made of them.
        several.sort_unstable();
        for expr in several {
            self.visit(expr, needs);
            shared.insert(expr);
        }
    }
}

/// Everything below an expression.
fn reach(pool: &Pool, expr: ExprId, scope: &Scope, seen: &mut BTreeSet<ExprId>) {
    if scope.value(expr).is_some() || !seen.insert(expr) {
        return;
    }
    let node = pool.node(expr);
    node.children().for_each(|operand| reach(pool, operand, scope, seen));
    if let Some(condition) = node.condition() {
        compared(pool, condition).into_iter().for_each(|operand| reach(pool, operand, scope, seen));
    }
}

/// Returns whether nothing in an expression can fail or is selected.
fn is_safe(pool: &Pool, expr: ExprId, known: &mut HashMap<ExprId, bool>) -> bool {
    if let Some(known) = known.get(&expr) {
        return *known;
    }
    let node = pool.node(expr);
    let portable = matches!(node, Node::Unary(UnaryOp::PortableSin | UnaryOp::PortableCos, _));
    let safe = !matches!(node, Node::Select(..))
        && (portable || cannot_fail(node))
        && node.children().all(|operand| is_safe(pool, operand, known));
    known.insert(expr, safe);
    safe
}

/// Returns whether an operation is cheap and has a finite result for all finite operands that are not huge.
fn cannot_fail(node: Node) -> bool {
    match node {
        Node::Const(_)
        | Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Ternary(..)
        | Node::Select(..) => true,
        Node::Unary(op, _) => op.row().is_plain,
        Node::Binary(op, ..) => op.row().is_plain,
    }
}

/// The numbers that a condition compares.
fn compared(pool: &Pool, condition: CondId) -> Vec<ExprId> {
    let cond = pool.cond(condition);
    cond.compared().chain(cond.children().flat_map(|part| compared(pool, part))).collect()
}
