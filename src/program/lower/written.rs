//! The parts of a table that its meaning does not keep, for findings about the way it is written.

use std::collections::HashSet;

use crate::diag::Spanned;
use crate::program::{ExprId, Node, Pool, Written};
use crate::table::expr::{BinaryOp, Expr, ExprKind, SumOver};
use crate::table::{CaseBody, Claim, FunctionBody, Image, ResultMap, Table};

/// Looks at all that is written in a table of cases, which was lowered to the terms of a pool.
pub(super) fn written(table: &Table, pool: &Pool) -> Written {
    let (unused_names, unused_helpers) = (unused_names(table), unused_helpers(table));
    let mut written = Written { unused_names, unused_helpers, ..Written::default() };
    let mut look = |expr: &Expr| {
        inexact(expr, &mut written);
        repeated(expr, &mut written);
    };
    for case in &table.cases {
        if let CaseBody::Rows { when, lines, .. } = &case.body {
            look(when);
            for line in lines {
                look(&line.value);
                line.condition.iter().for_each(&mut look);
            }
        }
    }
    table.names.iter().for_each(|named| look(&named.value));
    look(&table.default);
    // What became a word is exact, unless the same number stands somewhere else as well.
    let is_word = |number: f64| pool.nodes().any(|node| matches!(node, Node::Word(word) if f64::from(word) == number));
    let is_operand = |number: f64| {
        let is_it = |part: ExprId| pool.constant(part) == Some(number);
        pool.nodes().any(|node| node.children().any(is_it))
            || pool.conds().any(|condition| condition.compared().any(is_it))
    };
    written.inexact.retain(|(number, _)| !is_word(*number) || is_operand(*number));
    written
}

/// Looks at what the functions of a table share, with the first of them.
pub(super) fn shared(table: &Table, function: &str) -> Written {
    let is_first = table.functions.first().is_some_and(|first| first.name.value == function);
    Written { unused_helpers: if is_first { unused_helpers(table) } else { Vec::new() }, ..Written::default() }
}

fn inexact(expr: &Expr, written: &mut Written) {
    if let ExprKind::Number(number) = expr.kind
        && f64::from(number as f32) != number
    {
        written.inexact.push((number, expr.span));
    }
    expr.parts().into_iter().for_each(|part| inexact(part, written));
}

/// Most operands of a chain that are compared with each other.
const MAX_OPERANDS: usize = 64;

/// Finds operands of one chain of `&&` or `||` that are written alike.
fn repeated(expr: &Expr, written: &mut Written) {
    let ExprKind::Binary(op @ (BinaryOp::And | BinaryOp::Or), ..) = expr.kind else {
        expr.parts().into_iter().for_each(|part| repeated(part, written));
        return;
    };
    let mut operands: Vec<&Expr> = Vec::new();
    let mut open = vec![expr];
    while let Some(expr) = open.pop() {
        if let ExprKind::Binary(own, a, b) = &expr.kind
            && *own == op
        {
            open.extend([&**b, &**a]);
        } else {
            operands.push(expr);
        }
    }
    for (place, operand) in operands.iter().enumerate().take(MAX_OPERANDS) {
        if let Some(first) = operands[..place].iter().find(|first| alike(first, operand)) {
            written.repeated.push((operand.span, first.span));
        }
    }
    operands.into_iter().for_each(|operand| repeated(operand, written));
}

/// Returns whether two conditions are written alike, as far as conditions mostly go.
fn alike(a: &Expr, b: &Expr) -> bool {
    match (&a.kind, &b.kind) {
        (ExprKind::Number(a), ExprKind::Number(b)) => a == b,
        (ExprKind::Name(a), ExprKind::Name(b)) => a == b,
        (ExprKind::Unary(op, a), ExprKind::Unary(other, b)) => op == other && alike(a, b),
        (ExprKind::Binary(op, a, b), ExprKind::Binary(other, c, d)) => op == other && alike(a, c) && alike(b, d),
        (ExprKind::In(a, some), ExprKind::In(b, others)) => {
            alike(a, b) && some.iter().map(|level| &level.value).eq(others.iter().map(|level| &level.value))
        }
        _ => false,
    }
}

/// Names and groups that no case, default, assumption or symmetry leads to.
fn unused_names(table: &Table) -> Vec<Spanned<String>> {
    if table.names.is_empty() && table.groups.is_empty() {
        return Vec::new();
    }
    let mut mentioned = HashSet::new();
    for case in &table.cases {
        if let CaseBody::Rows { when, lines, .. } = &case.body {
            mentions(when, &mut mentioned);
            for line in lines {
                mentions(&line.value, &mut mentioned);
                line.condition.iter().for_each(|c| mentions(c, &mut mentioned));
            }
        }
    }
    mentions(&table.default, &mut mentioned);
    table.claims.iter().flat_map(Claim::exprs).for_each(|expr| mentions(expr, &mut mentioned));
    table.assumptions.iter().for_each(|a| mentions(&a.condition, &mut mentioned));
    for symmetry in &table.symmetries {
        symmetry.result.iter().flat_map(ResultMap::exprs).for_each(|r| mentions(r, &mut mentioned));
        for (_, image) in &symmetry.map {
            if let Image::Expr(expr) = image {
                mentions(expr, &mut mentioned);
            }
        }
    }
    // What a table of cases is not called with means what it means here.
    let called =
        table.imports.iter().filter_map(|import| import.table.as_deref()).filter(|other| !other.cases.is_empty());
    mentioned.extend(called.flat_map(|other| &other.inputs).map(|input| input.name.value.as_str()));
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
    let groups = table.groups.iter().map(|group| &group.name).filter(|name| !mentioned.contains(&*name.value));
    pending.into_iter().map(|named| &named.name).chain(groups).cloned().collect()
}

/// Helpers that nothing calls but helpers that nothing calls.
fn unused_helpers(table: &Table) -> Vec<Spanned<String>> {
    if table.helpers.is_empty() {
        return Vec::new();
    }
    let mut open: Vec<&Expr> = vec![&table.default];
    open.extend(table.names.iter().map(|named| &named.value));
    open.extend(table.assumptions.iter().map(|assumption| &assumption.condition));
    open.extend(table.claims.iter().flat_map(Claim::exprs));
    open.extend(table.symmetries.iter().filter_map(|symmetry| symmetry.result.as_ref()).flat_map(ResultMap::exprs));
    let case = |case: &'_ crate::table::Case| -> Vec<Expr> {
        let CaseBody::Rows { when, lines, .. } = &case.body else { return Vec::new() };
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
    unused.map(|helper| helper.name.clone()).collect()
}

/// Every name that an expression mentions; of `v.xy` also `v`.
fn mentions<'t>(expr: &'t Expr, found: &mut HashSet<&'t str>) {
    let mut all = |parts: &[&'t Expr]| parts.iter().for_each(|part| mentions(part, found));
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Level(..) => {}
        ExprKind::Name(name) => {
            found.insert(name);
            if let Some((base, _)) = name.rsplit_once('.') {
                found.insert(base);
            }
        }
        ExprKind::Unary(_, a) | ExprKind::In(a, _) | ExprKind::Swizzle(a, _) => all(&[a]),
        ExprKind::Binary(_, a, b) | ExprKind::Let(_, a, b) | ExprKind::Optional(a, b) => all(&[a, b]),
        ExprKind::If(c, a, b) => all(&[c, a, b]),
        ExprKind::Call(_, items) | ExprKind::List(items) => items.iter().for_each(|item| mentions(item, found)),
        ExprKind::Case(_, set) | ExprKind::With(_, set) | ExprKind::Record(set) => {
            set.iter().for_each(|(_, value)| mentions(value, found));
        }
        ExprKind::Between(body, _, lo, hi) => all(&[body, lo, hi]),
        ExprKind::Sum(_, SumOver::Items(_), term) => all(&[term]),
        ExprKind::Sum(_, SumOver::Range(lo, hi), term) => all(&[lo, hi, term]),
        ExprKind::Iterate(count, _, start, step) => all(&[count, start, step]),
        ExprKind::Index(list, indices) => {
            mentions(list, found);
            indices.iter().for_each(|index| mentions(index, found));
        }
    }
}
