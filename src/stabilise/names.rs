//! Names for what is added to a table: those that nothing in it has.

use std::collections::BTreeSet;

use crate::diag::Span;
use crate::program::operators::Operator;
use crate::table::expr::{Expr, ExprKind, SumOver};
use crate::table::names::check;
use crate::table::{Case, CaseBody, ConstantValue, FunctionBody, Table};

/// The names that are in use.
#[derive(Debug, Clone, Default)]
pub(super) struct Taken(BTreeSet<String>);

impl Taken {
    /// Everything that a table declares or mentions, and all operators.
    pub(super) fn by(table: &Table) -> Self {
        let mut taken = Self(Operator::functions().map(|(name, _)| name.to_owned()).collect());
        let declared = (table.inputs.iter().map(|input| &input.name))
            .chain(table.levels.iter().map(|(name, _)| name))
            .chain(table.groups.iter().map(|group| &group.name))
            .chain(table.names.iter().map(|named| &named.name))
            .chain(table.imports.iter().map(|import| &import.alias))
            .chain(table.constants.iter().map(|constant| &constant.name))
            .chain(table.helpers.iter().flat_map(|helper| helper.parameters.iter().chain([&helper.name])))
            .chain(table.functions.iter().flat_map(|function| {
                let bindings = function.bindings.iter().map(|binding| &binding.name);
                function.parameters.iter().chain(bindings).chain([&function.name])
            }));
        declared.for_each(|name| taken.take(&name.value));
        for expr in expressions(table) {
            taken.mentioned(expr);
        }
        taken
    }

    /// The first of some names that is free, or else the first one with a number; it is taken from now on.
    pub(super) fn free(&mut self, names: &[&str]) -> String {
        let numbered = (2_usize..).map(|number| format!("{}_{number}", names.first().unwrap_or(&"name")));
        let mut all = names.iter().map(|name| (*name).to_owned()).chain(numbered);
        let admitted = |name: &String| !self.0.contains(name) && check(name, "a name", Span::default()).is_ok();
        // There is always a further number.
        let name = all.find(admitted).unwrap_or_default();
        self.0.insert(name.clone());
        name
    }

    /// Takes a name, of which every part may be meant.
    fn take(&mut self, name: &str) {
        self.0.extend(name.split('.').map(str::to_owned));
    }

    fn mentioned(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Name(name) => self.take(name),
            ExprKind::Call(name, _) | ExprKind::Let(name, ..) | ExprKind::Between(_, name, ..) => {
                self.take(&name.value);
            }
            ExprKind::Sum(name, over, _) => {
                self.take(&name.value);
                if let SumOver::Items(list) = over {
                    self.take(&list.value);
                }
            }
            ExprKind::With(name, set) => {
                self.take(&name.value);
                set.iter().for_each(|(name, _)| self.take(&name.value));
            }
            ExprKind::Case(_, set) | ExprKind::Record(set) => set.iter().for_each(|(name, _)| self.take(&name.value)),
            ExprKind::In(_, levels) => levels.iter().for_each(|level| self.take(&level.value)),
            ExprKind::Number(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Swizzle(..)
            | ExprKind::If(..)
            | ExprKind::List(_) => {}
        }
        expr.parts().into_iter().for_each(|part| self.mentioned(part));
    }
}

/// The expressions of a table of functions.
fn expressions(table: &Table) -> Vec<&Expr> {
    let mut all: Vec<&Expr> = table.names.iter().map(|named| &named.value).collect();
    for constant in &table.constants {
        match &constant.value {
            ConstantValue::Number(value) => all.push(value),
            ConstantValue::List(items) => all.extend(items.iter().flatten()),
        }
    }
    all.extend(table.helpers.iter().flat_map(|helper| &helper.lines).flat_map(|line| {
        line.condition.iter().chain([&line.value])
    }));
    for function in &table.functions {
        all.extend(function.bindings.iter().map(|binding| &binding.value));
        all.extend(function.domain.iter().map(|assumption| &assumption.condition));
        all.extend(function.limits.iter().flat_map(|limit| limit.at.iter().map(|(_, at)| at).chain([&limit.value])));
        all.extend(function.accuracy.iter().map(|accuracy| &accuracy.scale));
        match &function.body {
            FunctionBody::Value(value) => all.push(value),
            FunctionBody::Cases { cases, default } => {
                all.push(default);
                all.extend(cases.iter().flat_map(of_case));
            }
        }
    }
    all
}

fn of_case(case: &Case) -> Vec<&Expr> {
    match &case.body {
        CaseBody::Rows { when, lines } => {
            let lines = lines.iter().flat_map(|line| line.condition.iter().chain([&line.value]));
            lines.chain([when]).collect()
        }
        CaseBody::Image { .. } => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;

    #[test]
    fn whatever_a_table_says_is_taken() {
        let text = r#"Table(language: 1, name: "t", inputs: {"x": Range(from: 0, to: 1)},
            names: {"n": "2 * x"}, constants: {"c": 1, "l": [(1, 2)]}, helpers: {"h(a)": "let b = a; b"},
            functions: {"f": Function(parameters: ["x"], let: {"d": "x"}, value: "h(d) + sum(s in l, s.x) + (t | t = 0 .. c)")})"#;
        let table = Table::parse(Source::new("t.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let mut taken = Taken::by(&table);
        for name in ["x", "n", "c", "l", "h", "a", "b", "f", "d", "s", "t", "sin", "mix"] {
            assert_eq!(taken.free(&[name, "other"]), "other", "{name}");
            taken.0.remove("other");
        }
        // Words of other languages are no names, and what was given once is not given again.
        assert_eq!(taken.free(&["x", "float", "half_way"]), "half_way");
        assert_eq!(taken.free(&["x", "float", "half_way"]), "x_2");
        assert_eq!(taken.free(&["x"]), "x_3");
    }
}
