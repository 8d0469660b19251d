//! U0517: formulas that are one number wherever they count.
//!
//! A formula of the author that the clamp, the domains and the condition of its line leave one number is
//! no formula: `px + py + 1` clamped to 1, `px - px`. Mostly a sign or a name in it is another than meant.

use super::{Analysis, Run};
use crate::analyse::sets::study::{Piece, Study};
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::{ExprId, InputSet, Node, TernaryOp};

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis = Analysis { codes: &[codes::SETTLED], run: Run::Sets(findings) };

/// Looks at every line of every case that is written with numbers.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let numbers = program.continuous();
    let components = program.output.components();
    let mut found = Vec::new();
    for (row, case) in program.rows.iter().enumerate() {
        for (number, line) in case.lines.iter().enumerate() {
            for (component, value) in line.values.iter().enumerate() {
                if program.pool.expr_facts(*value).inputs.and(numbers).is_empty() {
                    continue;
                }
                let Some(constant) = settled(study, (row, number), component, numbers) else { continue };
                let place = words::called(program, (Some(row), Some(number)));
                let constant = words::short(constant);
                let of = match components.as_slice() {
                    [_] => "of".to_owned(),
                    several => format!("for `{}` in", several[component].name),
                };
                let message = format!("the formula {of} {place} is {constant} wherever it counts");
                found.push(
                    Diagnostic::warning(codes::SETTLED, message)
                        .at(line.span, "no input makes a difference here")
                        .about([format!("line {}", number + 1), constant.clone()])
                        .help(format!("look for a sign or a name that is meant to be another, or write {constant}")),
                );
            }
        }
    }
    found
}

/// The number that a component of a line is wherever it counts, if it is one. What choices leave of the formula
/// must still mention numbers: a named value may well be a constant in one case and a formula in others.
fn settled(study: &mut Study<'_>, (row, line): (usize, usize), component: usize, numbers: InputSet) -> Option<f64> {
    let pieces: Vec<Piece> =
        study.pieces_of(Some(row)).iter().filter(|piece| piece.line == Some(line)).cloned().collect();
    let mut known: Option<f64> = None;
    let mut is_formula = false;
    for piece in pieces {
        let set = study.space.sets.and(piece.set, study.assumed);
        if study.space.is_void(set) {
            continue;
        }
        let value = piece.values[component];
        is_formula |= !study.space.pool.expr_facts(value).inputs.and(numbers).is_empty();
        let candidates = match known {
            Some(constant) => vec![constant],
            None => candidates(study, value),
        };
        known = Some(candidates.into_iter().find(|constant| {
            let constant = study.space.pool.number(*constant);
            let different = study.space.unequal(&[value], &[constant]);
            let different = study.space.sets.and(set, different);
            study.space.is_void(different)
        })?);
    }
    known.filter(|_| is_formula)
}

/// The numbers that a value can be everywhere: what it is without inputs, and the ends of its clamp.
fn candidates(study: &mut Study<'_>, value: ExprId) -> Vec<f64> {
    let pool = &study.space.pool;
    let ends = match pool.node(value) {
        Node::Ternary(TernaryOp::Clamp, _, lo, hi) => [pool.constant(lo), pool.constant(hi)],
        Node::Const(number) => [Some(number.get()), None],
        Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Unary(..)
        | Node::Binary(..)
        | Node::Ternary(..)
        | Node::Select(..) => [None; 2],
    };
    let bare = words::bare(&study.space, value);
    let alone = study.space.lattice(bare).and_then(|clauses| match clauses.as_slice() {
        [clause] => match clause.as_slice() {
            [form] if form.terms.is_empty() => Some(form.constant.to_f64()),
            _ => None,
        },
        _ => None,
    });
    ends.into_iter().chain([alone]).flatten().collect()
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn settled(value: &str) -> Vec<String> {
        let all = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Bool(), "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}},
                assume: {{"low": "!s || x <= 0.25"}},
                output: Number(clamp: (0, 1)),
                cases: [Case(id: 1, when: "s", lines: [("{value}", "y > 0.5"), "y"])],
                default: 0)"#
        ));
        all.into_iter().filter(|finding| finding.starts_with("U0517")).collect()
    }

    #[test]
    fn formulas_that_are_one_number_are_found() {
        for value in ["x + 1", "x - x + 1", "x + if y < 0.75 { 1 } else { 1 + x }"] {
            assert_eq!(settled(value), ["U0517 the formula of line 1 of case 1 is 1 wherever it counts"], "{value}");
        }
        // By the assumption.
        assert_eq!(settled("x - 0.25"), ["U0517 the formula of line 1 of case 1 is 0 wherever it counts"]);
        for value in [
            "x + y - 1",
            "1",
            "if y < 0.75 { 1 } else { x }",
            "x + y",
            "y - x",
            "max(x, 0.25) + x",
            "if s { 0.25 } else { x }",
        ] {
            assert_eq!(settled(value), [""; 0], "{value}");
        }
    }
}
