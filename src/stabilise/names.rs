//! Names for what is added to a table: those that nothing in it has.

use std::collections::BTreeSet;

use crate::diag::Span;
use crate::program::operators::Operator;
use crate::table::expr::{Expr, ExprKind, SumOver};
use crate::table::names::check;
use crate::table::{Case, CaseBody, ConstantValue, Function, FunctionBody, Table};

/// The names that are in use.
#[derive(Debug, Clone, Default)]
pub(super) struct Taken {
    names: BTreeSet<String>,
    /// Names that values have within one function only. They go where it gets a new value.
    bindings: BTreeSet<String>,
    /// Names that the whole table sees, which a parameter of a helper would hide.
    global: BTreeSet<String>,
}

impl Taken {
    /// Everything that a table declares or mentions, and all operators.
    pub(super) fn by(table: &Table) -> Self {
        let mut taken = Self::default();
        Operator::functions().for_each(|(name, _)| taken.take(name));
        let global = (table.names.iter().map(|named| &named.name))
            .chain(table.imports.iter().map(|import| &import.alias))
            .chain(table.constants.iter().map(|constant| &constant.name))
            .chain(table.helpers.iter().map(|helper| &helper.name))
            .chain(table.functions.iter().map(|function| &function.name));
        taken.global = global.map(|name| name.value.clone()).collect();
        taken.names.extend(taken.global.iter().cloned());
        let declared = (table.inputs.iter().map(|input| &input.name))
            .chain(table.levels.iter().map(|(name, _)| name))
            .chain(table.groups.iter().map(|group| &group.name))
            .chain(table.helpers.iter().flat_map(|helper| &helper.parameters))
            .chain(table.functions.iter().flat_map(|function| &function.parameters));
        declared.for_each(|name| taken.take(&name.value));
        expressions(table).into_iter().for_each(|expr| taken.mentioned(expr));
        for function in &table.functions {
            let mut here = Self::default();
            of_function(function).into_iter().for_each(|expr| here.mentioned(expr));
            for binding in &function.bindings {
                here.names.remove(&binding.name.value);
                taken.bindings.insert(binding.name.value.clone());
            }
            taken.names.append(&mut here.names);
        }
        taken
    }

    /// The first of some names that is free for a value within a function that gets a new value, or else the first one
    /// with a number; it is taken from now on.
    pub(super) fn free(&mut self, names: &[&str]) -> String {
        self.first(names, |_| true)
    }

    /// The same for something that the whole table sees.
    pub(super) fn free_everywhere(&mut self, names: &[&str]) -> String {
        let bindings = self.bindings.clone();
        self.first(names, |name| !bindings.contains(name))
    }

    /// The first of some names that the parameter of a new helper may have.
    pub(super) fn free_parameter(&self, names: &[&str]) -> String {
        Self { names: self.global.clone(), ..Self::default() }.free(names)
    }

    fn first(&mut self, names: &[&str], suits: impl Fn(&String) -> bool) -> String {
        let numbered = (2_usize..).map(|number| format!("{}_{number}", names.first().unwrap_or(&"name")));
        let mut all = names.iter().map(|name| (*name).to_owned()).chain(numbered);
        let admitted = |name: &String| !self.names.contains(name) && check(name, "a name", Span::default()).is_ok();
        // There is always a further number.
        let name = all.find(|name| admitted(name) && suits(name)).unwrap_or_default();
        self.names.insert(name.clone());
        name
    }

    /// Takes a name, of which every part may be meant.
    fn take(&mut self, name: &str) {
        self.names.extend(name.split('.').map(str::to_owned));
    }

    fn mentioned(&mut self, expr: &Expr) {
        match &expr.kind {
            ExprKind::Name(name) => self.take(name),
            ExprKind::Call(name, _)
            | ExprKind::Let(name, ..)
            | ExprKind::Between(_, name, ..)
            | ExprKind::Iterate(_, name, ..) => {
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
            ExprKind::Level(set, level) => [set, level].into_iter().for_each(|name| self.take(&name.value)),
            ExprKind::Number(_)
            | ExprKind::Optional(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Swizzle(..)
            | ExprKind::If(..)
            | ExprKind::Index(..)
            | ExprKind::List(_) => {}
        }
        expr.parts().into_iter().for_each(|part| self.mentioned(part));
    }
}

/// The expressions of a table that are outside of its functions.
fn expressions(table: &Table) -> Vec<&Expr> {
    let mut all: Vec<&Expr> = table.names.iter().map(|named| &named.value).collect();
    for constant in &table.constants {
        match &constant.value {
            ConstantValue::Number(value) => all.push(value),
            ConstantValue::List(items) => all.extend(items.iter().flatten()),
            ConstantValue::Levels { .. } | ConstantValue::File(..) => {}
        }
    }
    all.extend(
        table
            .helpers
            .iter()
            .flat_map(|helper| &helper.lines)
            .flat_map(|line| line.condition.iter().chain([&line.value])),
    );
    all
}

fn of_function(function: &Function) -> Vec<&Expr> {
    let mut all: Vec<&Expr> = function.bindings.iter().map(|binding| &binding.value).collect();
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
    all
}

fn of_case(case: &Case) -> Vec<&Expr> {
    match &case.body {
        CaseBody::Rows { when, lines, .. } => {
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
        for name in ["x", "n", "c", "l", "h", "a", "b", "f", "s", "t", "sin", "mix"] {
            assert_eq!(taken.free(&[name, "other"]), "other", "{name}");
            taken.names.remove("other");
        }
        // It goes with the old value, and nothing else may have its name while it is there.
        assert_eq!(taken.clone().free(&["d"]), "d");
        assert_eq!(taken.free_everywhere(&["d"]), "d_2");
        // Words of other languages are no names, and what was given once is not given again.
        assert_eq!(taken.free(&["x", "float", "half_way"]), "half_way");
        assert_eq!(taken.free(&["x", "float", "half_way"]), "x_2");
        assert_eq!(taken.free(&["x"]), "x_3");
    }
}
