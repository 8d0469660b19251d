//! U0518: lists that can have more items than their output allows.
//!
//! A list of more than its output allows has no place for the rest, and generated code would say that
//! it has. So this is an error unless it is shown to happen nowhere, assumptions or not: a table has a
//! result at every point.

use std::collections::HashMap;

use super::{Analysis, Run};
use crate::analyse::sets::study::Study;
use crate::analyse::words;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{ExprId, Node, Output, Pool, Program};
use crate::table::HitPolicy;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis = Analysis { codes: &[codes::OVERLONG], run: Run::Program(findings) };

/// Looks at the lengths of all lists.
fn findings(program: &Program) -> Vec<Diagnostic> {
    let mut lengths = Vec::new();
    collect(&program.output, 0, &mut lengths);
    let mut known = HashMap::new();
    let lines = program.rows.iter().flat_map(|row| row.lines.iter().map(|line| &line.values));
    let mut all = lines.chain([&program.default]);
    let suspicious =
        all.any(|values| lengths.iter().any(|(at, max)| most(&program.pool, values[*at], &mut known) > *max as f64));
    // Mostly no combination of conditions is too long: then there is nothing to show.
    if !suspicious {
        return Vec::new();
    }
    let mut study = Study::new(program);
    if study.space.is_too_large() {
        let message = "the table is too intricate to show that its lists are short enough";
        return vec![
            Diagnostic::error(codes::OVERLONG, message)
                .at(program.hit_policy_span, "")
                .help("allow as many items as there could be with all conditions together, or split the table"),
        ];
    }
    let mut found: Vec<Diagnostic> = Vec::new();
    let mut said: Vec<(Option<usize>, Option<usize>)> = Vec::new();
    for piece in study.pieces.clone() {
        let place = (piece.row, piece.line);
        let length = |at: usize| study.space.pool.constant(piece.values[at]).unwrap_or(f64::INFINITY);
        let over = lengths.iter().map(|(at, max)| (length(*at), *max)).find(|(length, max)| *length > *max as f64);
        let Some((length, max)) = over.filter(|_| !said.contains(&place)) else { continue };
        let Some(witness) = study.space.witness(piece.set) else { continue };
        said.push(place);
        let relevant = piece.row.map_or(program.idle(), |row| words::mentioned(program, row));
        let can = if witness.certain { "gives" } else { "may give" };
        let called = match program.hit_policy {
            HitPolicy::Collect if piece.row.is_some() => {
                format!("with all that hold as well, {}", words::called(program, place))
            }
            HitPolicy::First | HitPolicy::Unique | HitPolicy::Collect => words::called(program, place),
        };
        let message = format!("{called} {can} a list of {length} items");
        let error = Diagnostic::error(codes::OVERLONG, message)
            .at(span(program, place), format!("the output allows at most {max}"));
        found.push(match words::at(program, &witness, relevant) {
            Some(point) => error.help(format!("for instance at {point}")),
            None => error,
        });
    }
    found.into_iter().map(|error| error.help("raise `max`, or let the conditions exclude each other")).collect()
}

/// The lengths among the components of an output, and the most that each can be.
fn collect(output: &Output, at: usize, found: &mut Vec<(usize, usize)>) {
    match output {
        Output::Number(_)
        | Output::Vector(..)
        | Output::Bool
        | Output::Int(..)
        | Output::U32
        | Output::Enumeration(_) => {}
        Output::Record(fields) => {
            fields.iter().fold(at, |at, (_, of)| {
                collect(of, at, found);
                at + of.size()
            });
        }
        Output::List { of, max, .. } => {
            found.push((at, *max));
            (0..*max).for_each(|index| collect(of, at + 1 + index * of.size(), found));
        }
    }
}

/// The most that a choice between constants can be.
fn most(pool: &Pool, expr: ExprId, known: &mut HashMap<ExprId, f64>) -> f64 {
    if let Some(most) = known.get(&expr) {
        return *most;
    }
    let found = match pool.node(expr) {
        Node::Const(number) => number.get(),
        Node::Select(_, a, b) => most(pool, a, known).max(most(pool, b, known)),
        Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..) => f64::INFINITY,
    };
    known.insert(expr, found);
    found
}

/// The place of a value.
fn span(program: &Program, (row, line): (Option<usize>, Option<usize>)) -> Span {
    let case = row.map(|row| &program.rows[row]);
    let line = case.zip(line).map(|(case, line)| case.lines[line].span);
    line.or(case.map(|case| case.span)).unwrap_or(program.hit_policy_span)
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    /// The findings about lengths of a table whose list may have two items.
    fn overlong(policy: &str, cases: &str) -> Vec<String> {
        let all = found(&format!(
            r#"Table(language: 2, name: "t", hit_policy: {policy},
                levels: {{"side": {{"left": 0, "right": 1}}}},
                inputs: {{"a": Bool(), "b": Bool(), "c": Bool(), "x": Range(from: 0, to: 1)}},
                names: {{"three": "[side::left if a, side::right if b, side::left if c]"}},
                assume: {{"few": "!a || !b"}},
                output: List(of: side, max: 2),
                cases: [{cases}],
                default: "[]")"#
        ));
        all.into_iter().filter(|finding| finding.starts_with("U0518")).collect()
    }

    #[test]
    fn lists_that_fit_are_shown_to() {
        for value in [
            "[left if a, right if !a, left if b]",
            "[left if x < 0.5, right if x > 0.5] ++ [left]",
            "if a { [left] } else { three }",
        ] {
            assert_eq!(
                overlong("First", &format!(r#"Case(id: 1, when: "true", value: "{value}")"#)),
                [""; 0],
                "{value}"
            );
        }
        let apart = r#"Case(id: 1, when: "a", value: "[left, right]"), Case(id: 2, when: "!a && b", value: left), Case(id: 3, when: "x > 0.5 && !a", value: right)"#;
        assert_eq!(
            overlong(
                "Collect",
                &apart.replace("value: left", "value: \"left\"").replace("value: right", "value: \"right\"")
            ),
            [""; 0]
        );
    }

    #[test]
    fn lists_that_can_be_too_long_are_refused() {
        let found = overlong(
            "First",
            r#"Case(id: 1, when: "c", value: "three"), Case(id: 2, when: "x < 0.5", value: "[left] ++ three")"#,
        );
        assert_eq!(found, ["U0518 case 1 gives a list of 3 items", "U0518 case 2 gives a list of 3 items"]);
        let found = overlong(
            "Collect",
            r#"Case(id: 1, when: "a", value: "left"), Case(id: 2, when: "x < 0.5", value: "[left, right if b]")"#,
        );
        assert_eq!(found, ["U0518 with all that hold as well, case 1 gives a list of 3 items"]);
    }
}
