//! Leaves, conditions and expressions → statements of some language.

use std::collections::{BTreeSet, HashMap};

use super::body::Body;
use crate::emit::language::{Type, bare, value};
use crate::plan::Leaf;
use crate::program::{
    BinaryOp, Comparison, Cond, CondId, DataType, ExprId, LevelSet, Node, Outcome, Pool, Scalar, UnaryOp,
};

/// Most choices of a result that are written where they stand; of more, those that stand in several places get a local.
const MAX_REPEATED: u32 = 64;

/// The names of choices, each with the type that it has.
type Shared = HashMap<(Scalar, ExprId), String>;

/// Counts the uses of each choice, and the choices that stand there when all are written out.
fn count_choices(
    pool: &Pool,
    choice: (Scalar, ExprId),
    uses: &mut HashMap<(Scalar, ExprId), usize>,
    sizes: &mut HashMap<(Scalar, ExprId), u32>,
) -> u32 {
    let Node::Select(_, a, b) = pool.node(choice.1) else { return 0 };
    *uses.entry(choice).or_insert(0) += 1;
    if let Some(size) = sizes.get(&choice) {
        return *size;
    }
    let [a, b] = [a, b].map(|side| count_choices(pool, (choice.0, side), uses, sizes));
    let size = a.saturating_add(b).saturating_add(1);
    sizes.insert(choice, size);
    size
}

impl Body<'_, '_> {
    pub(in crate::emit) fn leaf(&mut self, leaf: &Leaf) {
        let program = self.plan.program;
        let file = self.names.file.clone();
        let case = match leaf.row.map(|row| &program.rows[row]) {
            None => {
                self.text.comment("default: no case matches");
                self.dialect.global_constant(self.prefix, "DEFAULT")
            }
            Some(row) => {
                let line = leaf.line.map(|line| &row.lines[line]);
                let (number, place) = match (leaf.line, line) {
                    (Some(_), Some(line)) if row.lines.len() == 1 => (String::new(), program.line(line.span)),
                    (Some(number), Some(line)) => (format!(", line {}", number + 1), program.line(line.span)),
                    _ => (", no line applies, so the default".to_owned(), program.line(row.span)),
                };
                let section = if row.section.is_empty() { String::new() } else { format!("section {}; ", row.section) };
                let under =
                    if row.under.is_empty() { String::new() } else { format!(" under {}", row.under.join(", ")) };
                self.text.comment(&format!("case {}{under}{number}: {} ({section}{file}:{place})", row.id, row.doc));
                self.dialect.uint(row.id)
            }
        };
        if let Some(number) = self.hits.get(&Outcome { row: leaf.row, line: leaf.line }) {
            let call = format!("{}({});", self.dialect.global(self.prefix, "hit"), self.dialect.uint(*number));
            self.text.line(call);
        }
        let data = program.output.data_type();
        let components: Vec<(Scalar, ExprId)> =
            data.components().iter().map(|component| component.scalar).zip(leaf.values.iter().copied()).collect();
        self.computed_constants(&leaf.values, &[]);
        let numbers = components.iter().filter(|(scalar, value)| match scalar {
            Scalar::Float | Scalar::Word => true,
            Scalar::Uint | Scalar::Int => self.is_calculated(*value),
            Scalar::Bool => false,
        });
        self.declare(&numbers.map(|(_, value)| *value).collect::<Vec<_>>());
        let shared = self.shared_choices(&components);
        let components = components.iter().map(|(scalar, value)| match scalar {
            Scalar::Float | Scalar::Word => bare(&self.expr(*value)).to_owned(),
            Scalar::Uint | Scalar::Int | Scalar::Bool => bare(&self.choice(*scalar, *value, &shared)).to_owned(),
        });
        let value = value(self.dialect, self.prefix, &data, components);
        let result = self.dialect.result(self.prefix, &value, &case);
        self.text.line(format!("return {result};"));
    }

    pub(in crate::emit) fn temporary(&mut self) -> String {
        self.temporaries += 1;
        format!("{}{}t", self.names.temporary, self.temporaries)
    }

    /// Declares locals for the constants of operations that must not be
    /// evaluated by the shader's compiler: it would refuse `1.0 / 0.0`, compute
    /// what has constant operands only more exactly than the table does, or not know how.
    pub(in crate::emit) fn computed_constants(&mut self, exprs: &[ExprId], conditions: &[CondId]) {
        let mut found = Vec::new();
        let (mut seen_exprs, mut seen_conds) = (BTreeSet::new(), BTreeSet::new());
        let (mut exprs, mut conditions) = (exprs.to_vec(), conditions.to_vec());
        let pool = &self.plan.pool;
        loop {
            if let Some(condition) = conditions.pop() {
                if !seen_conds.insert(condition) {
                    continue;
                }
                let cond = pool.cond(condition);
                if cond.compared().all(|part| pool.constant(part).is_some()) {
                    found.extend(cond.compared().next());
                }
                exprs.extend(cond.compared());
                conditions.extend(cond.children());
            } else if let Some(expr) = exprs.pop() {
                if !seen_exprs.insert(expr) {
                    continue;
                }
                let node = pool.node(expr);
                conditions.extend(node.condition());
                let known = node.condition().is_none() && node.children().all(|child| pool.constant(child).is_some());
                if known || !pool.folds(node) {
                    found.extend(node.children().filter(|child| pool.constant(*child).is_some()));
                }
                exprs.extend(node.children());
            } else {
                break;
            }
        }
        for constant in found {
            if self.scope.value(constant).is_none() {
                let name = self.temporary();
                let value = self.expr(constant);
                self.text.line(self.dialect.local(&self.type_of(constant), &name, bare(&value), self.prefix));
                self.scope.name(constant, name);
            }
        }
    }

    /// The type that an expression has in code.
    pub(super) fn type_of(&self, expr: ExprId) -> Type {
        if self.plan.pool.is_word(expr) { Scalar::Word.into() } else { Type::FLOAT }
    }

    pub(in crate::emit) fn expr(&self, expr: ExprId) -> String {
        if let Some(name) = self.scope.value(expr) {
            return name.to_owned();
        }
        let of = |e: ExprId| self.expr(e);
        match self.plan.pool.node(expr) {
            Node::Const(number) => self.dialect.number(number.get()),
            Node::Word(word) => self.dialect.word(word),
            Node::Input(input) => {
                let ident = &self.plan.program.inputs[input.index()].ident;
                self.renamed.get(ident).unwrap_or(ident).clone()
            }
            Node::Index(input) => {
                let ident = &self.plan.program.inputs[input.index()].ident;
                self.dialect.converted(Scalar::Uint, Scalar::Float, ident)
            }
            // In the result map of a symmetry.
            Node::Result(component) => self.result.get(usize::from(component)).cloned().unwrap_or_default(),
            // A whole number that may be negative is an integer first.
            Node::Unary(UnaryOp::WordOfWhole, a) => match self.plan.pool.expr_facts(a).range.0 < 0.0 {
                true => self.dialect.unary(self.prefix, UnaryOp::WordOfWhole, &self.whole(a, Scalar::Int)),
                false => self.whole(a, Scalar::Uint),
            },
            Node::Unary(op, a) => self.dialect.unary(self.prefix, op, &of(a)),
            Node::Binary(BinaryOp::WholeQuotient | BinaryOp::WholeRemainder, ..) => {
                self.dialect.converted(Scalar::Int, Scalar::Float, &self.whole(expr, Scalar::Int))
            }
            Node::Binary(op, a, b) => self.dialect.binary(self.prefix, op, &of(a), &of(b)),
            Node::Ternary(op, a, b, c) => self.dialect.ternary(self.prefix, op, &of(a), &of(b), &of(c)),
            Node::Select(c, a, b) => {
                if let Some(outcome) = self.scope.outcome(c) {
                    return of(if outcome { a } else { b });
                }
                let (a, b) = (of(a), of(b));
                self.dialect.select(bare(&self.condition(c)), bare(&a), bare(&b))
            }
        }
    }

    /// Declares locals for choices that several components of a result have in common, if there are many.
    fn shared_choices(&mut self, components: &[(Scalar, ExprId)]) -> Shared {
        let pool = &self.plan.pool;
        let (mut uses, mut sizes) = (HashMap::new(), HashMap::new());
        let choices = components.iter().filter(|(scalar, _)| !matches!(scalar, Scalar::Float | Scalar::Word));
        let size = choices.fold(0_u32, |all, (scalar, value)| {
            all.saturating_add(count_choices(pool, (*scalar, *value), &mut uses, &mut sizes))
        });
        let mut shared = Shared::new();
        if size <= MAX_REPEATED {
            return shared;
        }
        let several = uses.into_iter().filter(|(_, count)| *count > 1).map(|(choice, _)| choice);
        let mut several: Vec<(Scalar, ExprId)> = several.collect();
        // Operands have lower numbers than what is made of them.
        several.sort_unstable_by_key(|(scalar, value)| (*value, *scalar as u8));
        for (scalar, value) in several {
            let name = self.temporary();
            let text = self.choice(scalar, value, &shared);
            let ty = Type::Data(DataType::Scalar(scalar));
            self.text.line(self.dialect.local(&ty, &name, bare(&text), self.prefix));
            shared.insert((scalar, value), name);
        }
        shared
    }

    /// A component that is no real number: constants, and choices between such.
    fn choice(&self, scalar: Scalar, expr: ExprId, shared: &Shared) -> String {
        if let Some(name) = shared.get(&(scalar, expr)) {
            return name.clone();
        }
        let known = |expr| self.plan.pool.constant(expr);
        match (self.plan.pool.node(expr), scalar) {
            (Node::Select(c, a, b), Scalar::Bool) if known(a) == Some(1.0) && known(b) == Some(0.0) => {
                self.condition(c)
            }
            (Node::Select(c, a, b), Scalar::Bool) if known(a) == Some(0.0) && known(b) == Some(1.0) => {
                format!("!({})", bare(&self.condition(c)))
            }
            (Node::Select(c, a, b), _) => {
                let condition = self.condition(c);
                let [a, b] = [a, b].map(|side| self.choice(scalar, side, shared));
                self.dialect.select(bare(&condition), &a, &b)
            }
            (_, Scalar::Uint | Scalar::Int) => self.whole(expr, scalar),
            (_, Scalar::Float | Scalar::Word) => self.expr(expr),
            (_, Scalar::Bool) => known(expr).is_some_and(|value| value != 0.0).to_string(),
        }
    }

    pub(in crate::emit) fn condition(&self, condition: CondId) -> String {
        let joined = |parts: &[CondId], symbol: &str| {
            let parts: Vec<String> = parts.iter().map(|part| self.condition(*part)).collect();
            format!("({})", parts.join(symbol))
        };
        match self.plan.pool.cond(condition) {
            Cond::Const(value) => value.to_string(),
            Cond::Level(input, levels) => self.level(*input, *levels),
            Cond::Compare(op, a, b) => {
                let symbol = match op {
                    Comparison::Less => "<",
                    Comparison::LessEqual => "<=",
                    Comparison::Equal => "==",
                };
                format!("({} {symbol} {})", self.expr(*a), self.expr(*b))
            }
            Cond::Not(a) => match self.plan.pool.cond(*a) {
                Cond::Level(input, levels) => {
                    let count = self.plan.program.levels(*input).map_or(0, |known| known.count());
                    self.level(*input, LevelSet(LevelSet::all(count).0 & !levels.0))
                }
                Cond::Const(_) | Cond::Compare(..) | Cond::Not(_) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {
                    format!("!({})", bare(&self.condition(*a)))
                }
            },
            Cond::And(parts) => joined(parts, " && "),
            Cond::Or(parts) => joined(parts, " || "),
            Cond::If(c, a, b) => {
                let [c, a, b] = [c, a, b].map(|part| self.condition(*part));
                self.dialect.select(bare(&c), bare(&a), bare(&b))
            }
        }
    }
}
