//! U0514 of conditions: operations that can leave the numbers in what decides for a case or a line.
//!
//! A comparison with NaN does not hold, and what a shader makes of it is its own affair. So
//! the case that is taken depends on the driver, although the values of all cases are sound.

use std::collections::HashSet;

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::View;
use crate::analyse::sets::study::Study;
use crate::analyse::values::point::Point;
use crate::analyse::values::real;
use crate::analyse::values::search::{Asked, Search, search, undecided};
use crate::analyse::words;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::print::Printer;
use crate::program::{Cond, CondId, ExprId};

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::NOT_A_NUMBER, codes::NOT_ANALYSED], run: Run::Sets(findings) };

/// A condition of a table.
struct Asker {
    row: usize,
    /// The line; none for the guard.
    line: Option<usize>,
    condition: CondId,
    span: Span,
}

/// A number that a comparison compares, and where it is asked for.
struct Operand {
    comparison: CondId,
    written: ExprId,
    value: ExprId,
    set: Set,
}

/// Looks at every guard and at the condition of every line.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut found = Vec::new();
    let mut open = study.assumed;
    for (number, row) in program.rows.iter().enumerate() {
        let guard = Asker { row: number, line: None, condition: row.guard, span: row.guard_span };
        found.extend(trouble(study, &guard, open));
        let mut rest = study.space.sets.and(open, study.rows.guards[number]);
        open = study.space.sets.minus(open, study.rows.guards[number]);
        for (line, written) in row.lines.iter().enumerate() {
            let span = written.condition_span.unwrap_or(written.span);
            let asker = Asker { row: number, line: Some(line), condition: written.condition, span };
            found.extend(trouble(study, &asker, rest));
            let applies = study.space.condition(written.condition, View::PLAIN);
            rest = study.space.sets.minus(rest, applies);
        }
    }
    found
}

/// The first operation of a condition that can fail where it is asked for.
fn trouble(study: &mut Study<'_>, asker: &Asker, within: Set) -> Option<Diagnostic> {
    let program = study.program;
    let mut operands = Vec::new();
    collect(study, asker.condition, within, &mut HashSet::new(), &mut operands);
    let name = match asker.line {
        None => format!("the guard of case {}", program.rows[asker.row].id),
        Some(line) => format!("the condition of line {} of case {}", line + 1, program.rows[asker.row].id),
    };
    let mut note = None;
    for operand in operands {
        if study.space.is_void(operand.set) {
            continue;
        }
        let reached = |point: &Point| comes_to(study.program, asker, operand.comparison, point);
        let asked = Asked { written: operand.written, row: Some(asker.row), reached: &reached };
        match search(study, operand.set, operand.value, &asked) {
            Search::Nothing => {}
            Search::Unknown => {
                note.get_or_insert_with(|| undecided(&name, asker.span));
            }
            Search::Found { trouble, point, exact } => {
                let what = Printer { pool: &study.space.pool, inputs: &program.inputs }.expr(trouble.expr);
                let mut warning = Diagnostic::warning(codes::NOT_A_NUMBER, format!("{name} can leave the numbers"))
                    .at(asker.span, format!("`{what}` {}", trouble.what));
                let inputs = program.pool.cond_facts(asker.condition).inputs;
                let witness = point.witness(program, &vec![true; program.inputs.len()]);
                if let Some(place) = words::at(program, &witness, inputs) {
                    warning = warning.help(format!("for instance {} {place}", if exact { "at" } else { "near" }));
                }
                return Some(warning.help("ask first if the operation has a result, as in `x >= 0 && sqrt(x) < 1`"));
            }
        }
    }
    note
}

/// The partial operands of the comparisons of a condition, each with the set where it is asked for.
fn collect(
    study: &mut Study<'_>,
    condition: CondId,
    within: Set,
    seen: &mut HashSet<(CondId, Set)>,
    operands: &mut Vec<Operand>,
) {
    if within.is_empty() || !seen.insert((condition, within)) {
        return;
    }
    let cond = study.space.pool.cond(condition).clone();
    match &cond {
        Cond::Const(_) | Cond::Level(..) => {}
        Cond::Compare(_, a, b) => {
            for written in [*a, *b] {
                if !real::is_partial(&study.space.pool, written) {
                    continue;
                }
                let parts = study.space.parts(written, View::PLAIN);
                for (set, value) in parts.iter() {
                    let set = study.space.sets.and(*set, within);
                    operands.push(Operand { comparison: condition, written, value: *value, set });
                }
            }
        }
        Cond::Not(a) => collect(study, *a, within, seen, operands),
        Cond::And(parts) | Cond::Or(parts) => {
            let all = matches!(cond, Cond::And(_));
            let mut rest = within;
            for part in parts {
                collect(study, *part, rest, seen, operands);
                let holds = study.space.condition(*part, View::PLAIN);
                rest = if all { study.space.sets.and(rest, holds) } else { study.space.sets.minus(rest, holds) };
            }
        }
        Cond::If(c, a, b) => {
            collect(study, *c, within, seen, operands);
            let holds = study.space.condition(*c, View::PLAIN);
            let (then, other) = (study.space.sets.and(within, holds), study.space.sets.minus(within, holds));
            collect(study, *a, then, seen, operands);
            collect(study, *b, other, seen, operands);
        }
    }
}

/// Returns whether the program comes to a comparison in a condition at a point.
fn comes_to(program: &crate::program::Program, asker: &Asker, comparison: CondId, point: &Point) -> bool {
    let pool = &program.pool;
    let row = &program.rows[asker.row];
    let before = program.rows[..asker.row].iter().any(|row| point.holds(pool, row.guard));
    let here = match asker.line {
        None => true,
        Some(line) => {
            let earlier = row.lines[..line].iter().any(|line| point.holds(pool, line.condition));
            point.holds(pool, row.guard) && !earlier
        }
    };
    !before && here && point.is_admitted(program) && point.asks(pool, asker.condition, comparison)
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn trouble(cases: &str) -> Vec<String> {
        let found = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: -1, to: 1), "d": Range(from: 0, to: 1), "b": Bool()}},
                output: Number(), cases: [{cases}], default: 0)"#
        ));
        found.into_iter().filter(|message| message.starts_with("U0514") || message.starts_with("U055")).collect()
    }

    #[test]
    fn nan_that_decides_is_found() {
        let guard = "U0514 the guard of case 1 can leave the numbers";
        assert_eq!(trouble(r#"Case(id: 1, when: "!(sqrt(x) < 0.5)", value: 1)"#), [guard]);
        assert_eq!(trouble(r#"Case(id: 1, when: "b && (if b { log(x) < 0.5 } else { true })", value: 1)"#), [guard]);
        let line = r#"Case(id: 1, when: "b", lines: [(1, "!(sqrt(x) < 0.5)"), 2])"#;
        assert_eq!(trouble(line), ["U0514 the condition of line 1 of case 1 can leave the numbers"]);
    }

    /// An earlier question keeps the operation away: in the same guard, in an earlier one, in a choice.
    #[test]
    fn what_is_asked_first_excuses() {
        for cases in [
            r#"Case(id: 1, when: "x >= 0 && sqrt(x) < 0.5", value: 1)"#,
            r#"Case(id: 1, when: "x < 0 || sqrt(x) < 0.5", value: 1)"#,
            r#"Case(id: 1, when: "x < 0", value: 1), Case(id: 2, when: "sqrt(x) < 0.5", value: 2)"#,
            r#"Case(id: 1, when: "sqrt(if x < 0 { 0 } else { x }) < 0.5", value: 1)"#,
            r#"Case(id: 1, when: "b", lines: [(1, "x < 0"), (2, "sqrt(x) < 0.5"), 3])"#,
            r#"Case(id: 1, when: "x * x > 0.5 && 1 / (x * x) < 1.5", value: 1)"#,
        ] {
            assert_eq!(trouble(cases), [""; 0], "{cases}");
        }
    }
}
