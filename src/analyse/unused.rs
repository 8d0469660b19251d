//! U0505: inputs and names that nothing uses.
//!
//! An input that no result depends on still costs its place in the generated
//! signature, and more often than not its name is a misprint's victim.

use std::collections::HashSet;

use crate::diag::{Diagnostic, Span, codes};
use crate::program::{InputSet, Program};
use crate::table::expr::{Expr, ExprKind, SumOver};
use crate::table::{CaseBody, Image, Table};

/// Looks for unused inputs, then for unused names.
pub(super) fn findings(program: &Program) -> Vec<Diagnostic> {
    let mut found = inputs(program);
    // Names are gone from a program, but its source is that of a well-formed table.
    // The names of a table of functions are for all of them, so one cannot tell.
    if program.function.is_none()
        && let Ok(table) = Table::parse(program.source.clone())
    {
        found.extend(names(&table));
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
