//! U0520 to U0523: style: constants that no `f32` equals, cases that could be
//! one, names that generated code has to change, operands that are written twice.

use std::collections::{BTreeMap, HashMap};

use super::{Analysis, Run};
use crate::analyse::sets::study::Study;
use crate::analyse::words;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{Comparison, Cond, CondId, ExprId, LevelKind, LevelSet, Program};
use crate::table::HitPolicy;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::INEXACT, codes::MERGEABLE, codes::RENAMED, codes::REPEATED], run: Run::Sets(findings) };

/// Everything about style.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    // Where all cases count, two of them are not one.
    let mut found = match study.program.hit_policy {
        HitPolicy::First | HitPolicy::Unique => mergeable(study),
        HitPolicy::Collect => Vec::new(),
    };
    found.extend(inexact(study.program));
    found.extend(beside_integers(study.program));
    found.extend(renamed(study.program));
    found.extend(repeated(study.program));
    found
}

/// Operands that stand twice in one chain of `&&` or `||`: one of them is mostly meant to be another.
fn repeated(program: &Program) -> Vec<Diagnostic> {
    let finding = |(second, first): &(Span, Span)| {
        Diagnostic::warning(codes::REPEATED, "a condition asks for the same thing twice")
            .at(*second, "here again")
            .at(*first, "asked for before")
            .help("remove one, or look for what was meant")
    };
    program.written.repeated.iter().map(finding).collect()
}

/// Levels of some digits, as a guard that is nothing else.
type Pattern = Vec<(usize, LevelSet)>;
/// The lines of a case: conditions with their values.
type Lines = Vec<(CondId, Vec<ExprId>)>;

/// Cases with one value whose guards differ in the levels of a single input.
fn mergeable(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut found = Vec::new();
    let mut values: HashMap<Lines, usize> = HashMap::new();
    // By value, digit, and all of the pattern but that digit: the cases so far, with their levels of it.
    let mut alike: HashMap<(usize, usize, Pattern), Vec<(usize, LevelSet)>> = HashMap::new();
    for (number, row) in program.rows.iter().enumerate() {
        let guard = study.rows.guards[number];
        let Some(pattern) = study.space.sets.as_pattern(guard) else { continue };
        let lines: Vec<_> = row.lines.iter().map(|line| (line.condition, line.values.clone())).collect();
        let count = values.len();
        let value = *values.entry(lines).or_insert(count);
        let mut earlier = Vec::new();
        for (place, (digit, levels)) in pattern.iter().copied().enumerate() {
            let mut rest = pattern.clone();
            rest.remove(place);
            let alike = alike.entry((value, digit, rest)).or_default();
            let others = alike.iter().filter(|(_, other)| *other != levels);
            earlier.extend(others.map(|(first, other)| (*first, place, LevelSet(levels.0 | other.0))));
            alike.push((number, levels));
        }
        earlier.sort_unstable_by_key(|(first, ..)| *first);
        let free = |(first, ..): &&(usize, usize, LevelSet)| {
            let mut between = study.rows.nearby.of(number).filter(|row| (first + 1..number).contains(row));
            !between.any(|row| study.space.sets.meets(study.rows.guards[row], guard))
        };
        let Some((first, place, levels)) = earlier.iter().find(free).copied() else { continue };
        let mut merged = pattern;
        merged[place].1 = levels;
        merged.retain(|(digit, levels)| *levels != LevelSet::all(study.space.sets.levels(*digit)));
        let condition = words::condition(&mut study.space, &merged);
        let (a, b) = (&program.rows[first], row);
        found.push(
            Diagnostic::note(codes::MERGEABLE, format!("cases {} and {} could be one", a.id, b.id))
                .at(b.guard_span, "")
                .at(a.guard_span, "")
                .help(format!("they give the same, and together their guards say `{condition}`")),
        );
    }
    found
}

/// Constants as written that no `f32` equals: one note for all of them.
fn inexact(program: &Program) -> Option<Diagnostic> {
    let mut seen: BTreeMap<u64, (f64, Span)> = BTreeMap::new();
    for (number, span) in &program.written.inexact {
        seen.entry(number.to_bits()).or_insert((*number, *span));
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

/// Guards and conditions that compare with an integer so large that `f32` takes one beside it for the same: numbers
/// that name something, as dates do, then fall on the wrong side.
fn beside_integers(program: &Program) -> Vec<Diagnostic> {
    let pool = &program.pool;
    let mut found = Vec::new();
    for row in &program.rows {
        let lines = row.lines.iter().map(|line| (line.condition, line.condition_span.unwrap_or(line.span)));
        let mut asked = std::iter::once((row.guard, row.guard_span)).chain(lines);
        let confused = asked.find_map(|(condition, span)| {
            let mut open = vec![condition];
            while let Some(condition) = open.pop() {
                open.extend(pool.cond(condition).children());
                if let Cond::Compare(op, a, b) = pool.cond(condition)
                    && let Some(pair) = confused(*op, pool.constant(*a), pool.constant(*b))
                {
                    return Some((pair, span));
                }
            }
            None
        });
        let Some(((beside, constant), span)) = confused else { continue };
        let message = format!("case {} compares with {constant}, from which f32 does not tell {beside}", row.id);
        found.push(
            Diagnostic::warning(codes::INEXACT, message).at(span, format!("{beside} falls on the wrong side")).help(
                "from 16777216 on f32 leaves out integers: ask for parts of the number, for instance year and day",
            ),
        );
    }
    found
}

/// The integer beside a constant for which a comparison comes out otherwise in `f32`, with the constant.
fn confused(op: Comparison, a: Option<f64>, b: Option<f64>) -> Option<(f64, f64)> {
    let (constant, holds): (f64, Box<dyn Fn(f64) -> [bool; 2]>) = match (a, b) {
        (Some(a), None) => (a, Box::new(move |x| [op.holds(a, x), op.holds(a as f32, x as f32)])),
        (None, Some(b)) => (b, Box::new(move |x| [op.holds(x, b), op.holds(x as f32, b as f32)])),
        (Some(_), Some(_)) | (None, None) => return None,
    };
    let beside = [constant - 1.0, constant + 1.0].into_iter().find(|x| {
        let [exact, rounded] = holds(*x);
        exact != rounded
    });
    (constant.fract() == 0.0).then_some((beside?, constant))
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
    fn what_is_asked_twice_is_found() {
        let twice = |guard: &str| {
            let found = found(&format!(
                r#"Table(language: 1, name: "t", hit_policy: First,
                    inputs: {{"a": Bool(), "b": Bool(), "s": Int(from: 0, to: 3), "x": Range(from: 0, to: 1)}},
                    names: {{"n": "a && s == 1"}},
                    output: Number(),
                    cases: [Case(id: 1, when: {guard}, value: "x")],
                    default: "if n || b {{ 0 }} else {{ 1 }}")"#
            ));
            found.iter().filter(|message| message.starts_with("U0523")).count()
        };
        for guard in
            [r#""a && b && a""#, r#""s == 1 || b || x < 0.5 || s == 1""#, r#""!(b && (s in {1, 2} && s in {1, 2}))""#]
        {
            assert_eq!(twice(guard), 1, "{guard}");
        }
        // The same value of different inputs, and what a name stands for.
        for guard in
            [r#"{"a": true, "b": true}"#, r#""n && a""#, r#""a && b || a && s == 1""#, r#""x < 0.5 && x < 0.75""#]
        {
            assert_eq!(twice(guard), 0, "{guard}");
        }
    }

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
