//! U0520 to U0522: style: constants that no `f32` equals, cases that could be
//! one, names that generated code has to change.

use std::collections::{BTreeMap, HashMap};

use super::study::Study;
use super::words;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{CondId, ExprId, LevelKind, LevelSet, Program};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{CaseBody, Table};

/// Everything about style.
pub(super) fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let mut found = mergeable(study);
    found.extend(inexact(study.program));
    found.extend(renamed(study.program));
    found
}

/// Levels of some digits, as a guard that is nothing else.
type Pattern = Vec<(usize, LevelSet)>;
/// The lines of a case: conditions with their values.
type Lines = Vec<(CondId, Vec<ExprId>)>;

/// Cases with one value whose guards differ in the levels of a single input.
fn mergeable(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut found = Vec::new();
    let mut by_value: HashMap<Lines, Vec<(usize, Pattern)>> = HashMap::new();
    for (number, row) in program.rows.iter().enumerate() {
        let guard = study.rows.guards[number];
        let patterns = study.space.sets.patterns(guard, 2);
        let [pattern] = patterns.as_slice() else { continue };
        let lines: Vec<_> = row.lines.iter().map(|line| (line.condition, line.values.clone())).collect();
        let earlier = by_value.entry(lines).or_default();
        for (first, other) in earlier.iter() {
            let Some(merged) = merged(study, other, pattern) else { continue };
            if (first + 1..number).any(|between| study.space.sets.meets(study.rows.guards[between], guard)) {
                continue;
            }
            let condition = words::condition(&mut study.space, &merged);
            let (a, b) = (&program.rows[*first], row);
            found.push(
                Diagnostic::note(codes::MERGEABLE, format!("cases {} and {} could be one", a.id, b.id))
                    .at(b.guard_span, "")
                    .at(a.guard_span, "")
                    .help(format!("they give the same, and together their guards say `{condition}`")),
            );
            break;
        }
        earlier.push((number, pattern.clone()));
    }
    found
}

/// The one pattern that two are together, if they differ in a single digit.
fn merged(study: &Study<'_>, a: &Pattern, b: &Pattern) -> Option<Pattern> {
    let levels = |pattern: &Pattern, digit| pattern.iter().find(|(own, _)| *own == digit).map(|(_, levels)| *levels);
    let mut digits: Vec<usize> = a.iter().chain(b).map(|(digit, _)| *digit).collect();
    digits.sort_unstable();
    digits.dedup();
    let mut different = digits.iter().copied().filter(|digit| levels(a, *digit) != levels(b, *digit));
    let (one, None) = (different.next()?, different.next()) else { return None };
    let both = LevelSet(levels(a, one)?.0 | levels(b, one)?.0);
    let everything = both == LevelSet::all(study.space.sets.levels(one));
    let mut pattern: Pattern = a.iter().copied().filter(|(digit, _)| *digit != one).collect();
    if !everything {
        pattern.push((one, both));
        pattern.sort_unstable_by_key(|(digit, _)| *digit);
    }
    Some(pattern)
}

/// Constants as written that no `f32` equals: one note for all of them.
fn inexact(program: &Program) -> Option<Diagnostic> {
    // Constants have no places in a program, but its source is that of a well-formed table.
    let table = Table::parse(program.source.clone()).ok()?;
    let mut numbers: Vec<(f64, Span)> = Vec::new();
    for case in &table.cases {
        if let CaseBody::Rows { when, lines } = &case.body {
            constants(when, &mut numbers);
            for line in lines {
                constants(&line.value, &mut numbers);
                line.condition.iter().for_each(|condition| constants(condition, &mut numbers));
            }
        }
    }
    table.names.iter().for_each(|named| constants(&named.value, &mut numbers));
    constants(&table.default, &mut numbers);
    numbers.retain(|(number, _)| f64::from(*number as f32) != *number);
    let mut seen: BTreeMap<u64, (f64, Span)> = BTreeMap::new();
    for (number, span) in numbers {
        seen.entry(number.to_bits()).or_insert((number, span));
    }
    let (_, (first, span)) = seen.iter().min_by_key(|(_, (_, span))| span.start)?;
    let others: Vec<String> = seen.values().filter(|(number, _)| number != first).map(|(n, _)| n.to_string()).collect();
    let message = format!("no f32 equals {first}; {} is the nearest", f64::from(*first as f32));
    let note = Diagnostic::note(codes::INEXACT, message).at(*span, "");
    Some(match others.is_empty() {
        true => note,
        false => note.help(format!("the same goes for {}", words::list(&others))),
    })
}

fn constants(expr: &Expr, found: &mut Vec<(f64, Span)>) {
    if let ExprKind::Number(number) = expr.kind {
        found.push((number, expr.span));
    }
    expr.parts().into_iter().for_each(|part| constants(part, found));
}

/// Names of levels whose constants would be the same in generated code, where constants are upper case.
fn renamed(program: &Program) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    let mut taken: BTreeMap<String, (String, Span)> = BTreeMap::new();
    let mut sets = Vec::new();
    for input in &program.inputs {
        let crate::program::Domain::Discrete(levels) = &input.domain else { continue };
        if levels.kind == LevelKind::Bool || sets.contains(&levels) {
            continue;
        }
        sets.push(levels);
        for level in &levels.names {
            let constant = format!("{}_{}", input.ident, level).to_ascii_uppercase();
            let own = format!("`{level}` of `{}`", input.name);
            match taken.get(&constant) {
                None => drop(taken.insert(constant, (own, input.span))),
                Some((other, span)) => {
                    let message = format!("generated code has to rename the constant of {own}");
                    found.push(
                        Diagnostic::note(codes::RENAMED, message)
                            .at(input.span, "")
                            .at(*span, "")
                            .help(format!("constants are upper case, and {other} is {constant} already"))
                            .help("give one of the two a name that differs in more than its capitals"),
                    );
                }
            }
        }
    }
    // File names, and words of HLSL, do not all tell capitals apart.
    let mut lower: BTreeMap<String, &crate::program::Input> = BTreeMap::new();
    for input in &program.inputs {
        if let Some(other) = lower.insert(input.ident.to_ascii_lowercase(), input) {
            let message = format!("`{}` and `{}` differ in their capitals only", other.name, input.name);
            found.push(
                Diagnostic::note(codes::RENAMED, message)
                    .at(input.span, "")
                    .at(other.span, "")
                    .help("where constants are upper case one of the two gets another name"),
            );
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    #[test]
    fn style_is_noted() {
        let found = found(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {"a": Levels(values: {"On": 0, "on": 1}), "B": Bool(), "b": Bool(), "x": Range(from: 0, to: 1)},
                output: Number(),
                cases: [
                    Case(id: 1, when: "a == On && b", value: "0.1 * x"),
                    Case(id: 2, when: "a == On && !b && B", value: "x"),
                    Case(id: 3, when: "a == on && b", value: "0.1 * x"),
                ],
                default: 0.5)"#,
        );
        let style: Vec<&String> = found.iter().filter(|message| message.starts_with("U052")).collect();
        assert_eq!(
            style,
            [
                "U0521 cases 1 and 3 could be one",
                "U0520 no f32 equals 0.1; 0.10000000149011612 is the nearest",
                "U0522 generated code has to rename the constant of `on` of `a`",
                "U0522 `B` and `b` differ in their capitals only",
            ]
        );
    }
}
