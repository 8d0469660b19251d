//! U0505: inputs, names and helpers that nothing uses.
//!
//! An input that no result depends on still costs its place in the generated
//! signature, and more often than not its name is a misprint's victim.

use std::collections::HashSet;

use crate::diag::{Diagnostic, Span, codes};
use crate::program::{InputSet, Program};
use crate::table::expr::{Expr, ExprKind, SumOver};
use crate::table::{CaseBody, FunctionBody, Image, Table};

/// Looks for unused inputs, then for unused names, then for unused helpers.
pub(super) fn findings(program: &Program) -> Vec<Diagnostic> {
    let mut found = inputs(program);
    // Names and helpers are gone from a program, but its source is that of a well-formed table. What the functions
    // of a table share is looked at with the first of them.
    let Ok(table) = Table::parse(program.source.clone()) else { return found };
    let first = table.functions.first().map(|function| function.name.value.as_str());
    match &program.function {
        None => found.extend(names(&table).into_iter().chain(helpers(&table))),
        Some(function) if Some(function.name.as_str()) == first => found.extend(helpers(&table)),
        Some(_) => {}
    }
    found
}

fn warning(kind: &str, name: &str, span: Span, label: &str) -> Diagnostic {
    Diagnostic::warning(codes::UNUSED_INPUT, format!("the {kind} `{name}` is never used")).at(span, label)
}

fn inputs(program: &Program) -> Vec<Diagnostic> {
    // The functions of a table may share one list of parameters.
    let idle = if program.function.is_some() { InputSet::default() } else { program.idle() };
    let unused = program.input_ids().filter(|(id, _)| idle.contains(*id));
    let describe = |input: &crate::program::Input| {
        warning("input", &input.name, input.span, "no case and no default depends on it")
            .help("remove it, or check the spelling where it was meant to be used")
    };
    unused.map(|(_, input)| describe(input)).collect()
}

fn names(table: &Table) -> Vec<Diagnostic> {
    let mut mentioned = HashSet::new();
    for case in &table.cases {
        if let CaseBody::Rows { when, lines } = &case.body {
            mentions(when, &mut mentioned);
            for line in lines {
                mentions(&line.value, &mut mentioned);
                line.condition.iter().for_each(|c| mentions(c, &mut mentioned));
            }
        }
    }
    mentions(&table.default, &mut mentioned);
    table.assumptions.iter().for_each(|a| mentions(&a.condition, &mut mentioned));
    for symmetry in &table.symmetries {
        symmetry.result.iter().for_each(|r| mentions(r, &mut mentioned));
        for (_, image) in &symmetry.map {
            if let Image::Expr(expr) = image {
                mentions(expr, &mut mentioned);
            }
        }
    }
    // What a used name mentions is used, until nothing is added.
    let mut pending: Vec<_> = table.names.iter().collect();
    loop {
        let (used, rest): (Vec<_>, Vec<_>) = pending.into_iter().partition(|n| mentioned.contains(&*n.name.value));
        pending = rest;
        if used.is_empty() {
            break;
        }
        used.iter().for_each(|named| mentions(&named.value, &mut mentioned));
    }
    let describe = |name: &crate::diag::Spanned<String>| {
        warning("name", &name.value, name.span, "no case, default, assumption or symmetry leads here")
            .help("remove it, or check the spelling where it was meant to be used")
    };
    pending.into_iter().map(|named| describe(&named.name)).collect()
}

/// Helpers that nothing calls but helpers that nothing calls.
fn helpers(table: &Table) -> Vec<Diagnostic> {
    let mut open: Vec<&Expr> = vec![&table.default];
    open.extend(table.names.iter().map(|named| &named.value));
    open.extend(table.assumptions.iter().map(|assumption| &assumption.condition));
    open.extend(table.symmetries.iter().filter_map(|symmetry| symmetry.result.as_ref()));
    let case = |case: &'_ crate::table::Case| -> Vec<Expr> {
        let CaseBody::Rows { when, lines } = &case.body else { return Vec::new() };
        let lines = lines.iter().flat_map(|line| [Some(&line.value), line.condition.as_ref()]).flatten();
        std::iter::once(when).chain(lines).cloned().collect()
    };
    let mut cases: Vec<Expr> = table.cases.iter().flat_map(case).collect();
    for function in &table.functions {
        open.extend(function.bindings.iter().map(|binding| &binding.value));
        open.extend(function.domain.iter().map(|assumption| &assumption.condition));
        open.extend(function.limits.iter().map(|limit| &limit.value));
        open.extend(function.accuracy.iter().map(|accuracy| &accuracy.scale));
        match &function.body {
            FunctionBody::Value(value) => open.push(value),
            FunctionBody::Cases { cases: own, default } => {
                open.push(default);
                cases.extend(own.iter().flat_map(case));
            }
        }
    }
    open.extend(&cases);
    let mut used: HashSet<&str> = HashSet::new();
    while let Some(expr) = open.pop() {
        open.extend(expr.parts());
        if let ExprKind::Call(name, _) | ExprKind::With(name, _) = &expr.kind
            && let Some(helper) = table.helpers.iter().find(|helper| helper.name.value == name.value)
            && used.insert(&helper.name.value)
        {
            open.extend(helper.lines.iter().flat_map(|line| [Some(&line.value), line.condition.as_ref()]).flatten());
        }
    }
    let unused = table.helpers.iter().filter(|helper| !used.contains(helper.name.value.as_str()));
    let describe = |helper: &crate::table::Helper| {
        let message = format!("the helper `{}` is never used", helper.name.value);
        Diagnostic::note(codes::UNUSED_INPUT, message)
            .at(helper.name.span, "nothing that is computed calls it")
            .help("remove it, or check the spelling where it was meant to be called")
    };
    unused.map(describe).collect()
}

/// Every name that an expression mentions; of `v.xy` also `v`.
fn mentions<'t>(expr: &'t Expr, found: &mut HashSet<&'t str>) {
    let mut all = |parts: &[&'t Expr]| parts.iter().for_each(|part| mentions(part, found));
    match &expr.kind {
        ExprKind::Number(_) => {}
        ExprKind::Name(name) => {
            found.insert(name);
            if let Some((base, _)) = name.rsplit_once('.') {
                found.insert(base);
            }
        }
        ExprKind::Unary(_, a) | ExprKind::In(a, _) | ExprKind::Swizzle(a, _) => all(&[a]),
        ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) => all(&[a, b]),
        ExprKind::If(c, a, b) => all(&[c, a, b]),
        ExprKind::Call(_, items) | ExprKind::List(items) => items.iter().for_each(|item| mentions(item, found)),
        ExprKind::Case(_, set) | ExprKind::With(_, set) | ExprKind::Record(set) => {
            set.iter().for_each(|(_, value)| mentions(value, found));
        }
        ExprKind::Between(body, _, lo, hi) => all(&[body, lo, hi]),
        ExprKind::Sum(_, SumOver::Items(_), term) => all(&[term]),
        ExprKind::Sum(_, SumOver::Range(lo, hi), term) => all(&[lo, hi, term]),
    }
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    #[test]
    fn unused_helpers_are_found() {
        let text = r#"Table(language: 1, name: "t", inputs: {"x": Range(from: 0, to: 1)},
            helpers: {"used(a)": "inner(a) + 1", "inner(a)": "a * a", "lost(a)": "also_lost(a)", "also_lost(a)": "a",
                      "limit(a)": "a"},
            functions: {
                "f": Function(parameters: ["x"], value: "used(x)"),
                "g": Function(parameters: ["x"], value: "x", error: (times: 4, scale: "limit(x)")),
            })"#;
        let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text));
        let programs = table.and_then(|table| crate::program::Program::check_all(&table));
        let programs = programs.unwrap_or_else(|e| panic!("{e}"));
        let found: Vec<_> = programs.iter().flat_map(super::findings).map(|d| d.message).collect();
        assert_eq!(found, ["the helper `lost` is never used", "the helper `also_lost` is never used"]);
    }

    #[test]
    fn unused_declarations_are_found() {
        let found = found(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {"s": Bool(), "x": Range(from: 0, to: 1), "spare": Bool(), "f": Bool(fetched: (cost: 1))},
                names: {"a": "x + b", "b": "x * 2", "lost": "also_lost * 2", "also_lost": "x", "assumed": "s"},
                assume: {"A": "assumed || !spare"},
                output: Number(),
                cases: [Case(id: 1, when: "s", value: "a")],
                default: 0)"#,
        );
        assert_eq!(
            found,
            [
                "U0505 the input `spare` is never used",
                "U0505 the input `f` is never used",
                "U0505 the name `lost` is never used",
                "U0505 the name `also_lost` is never used",
                "U0503 no case claims 2 of the 4 states; they get the default",
            ]
        );
    }
}
