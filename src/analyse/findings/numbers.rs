//! U0513 to U0515: numbers: values that the clamp always cuts, operations that
//! can leave the numbers, comparisons for equality.

use super::{Analysis, Run};
use crate::analyse::sets::study::Study;
use crate::analyse::values::point::Point;
use crate::analyse::values::real;
use crate::analyse::values::rounding::Rounding;
use crate::analyse::values::search::{Asked, Search, search, undecided};
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::print::Printer;
use crate::program::{Comparison, Cond, CondId, ExprId, Node, Program, TernaryOp};

/// The values of a row, before and after the output's clamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// The row, as an index into [`Program::rows`]; `None` where no row is taken.
    pub row: Option<usize>,
    /// Smallest and largest value before the clamp.
    pub before: (f64, f64),
    /// The same after it.
    pub after: (f64, f64),
}

/// The largest distance of a range from the exact bounds.
const PRECISION: f64 = 1e-3;

/// The values that each row can give, by interval arithmetic on smaller and smaller parts
/// of the domain: never too narrow, and too wide by at most a thousandth unless
/// the value depends on too many inputs at once. Components are taken together.
pub fn ranges(program: &Program) -> Vec<Range> {
    let mut study = Study::new(program);
    (0..program.rows.len()).map(Some).chain([None]).filter_map(|row| range(&mut study, row)).collect()
}

fn range(study: &mut Study<'_>, row: Option<usize>) -> Option<Range> {
    study.space.begin();
    let pieces = study.pieces_of(row).to_vec();
    let (mut before, mut after) = (None, None);
    for piece in pieces {
        if study.space.is_void(piece.set) {
            continue;
        }
        for value in piece.values {
            let inner = words::bare(&study.space, value);
            let budget = study.space.sets.budget();
            let (lo, hi) = real::range(study.program, &study.space.pool, inner, PRECISION, budget);
            widen(&mut before, (lo, hi));
            widen(
                &mut after,
                match clamp(study, value) {
                    Some((from, to)) => (lo.clamp(from, to), hi.clamp(from, to)),
                    None => (lo, hi),
                },
            );
        }
    }
    Some(Range { row, before: before?, after: after? })
}

fn widen(range: &mut Option<(f64, f64)>, other: (f64, f64)) {
    let (lo, hi) = range.unwrap_or(other);
    *range = Some((lo.min(other.0), hi.max(other.1)));
}

/// The clamp of the output, if the value has it.
fn clamp(study: &Study<'_>, value: ExprId) -> Option<(f64, f64)> {
    let Node::Ternary(TernaryOp::Clamp, _, lo, hi) = study.space.pool.node(value) else { return None };
    Some((study.space.pool.constant(lo)?, study.space.pool.constant(hi)?))
}

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis = Analysis {
    codes: &[codes::OUT_OF_RANGE, codes::NOT_A_NUMBER, codes::FLOAT_EQUALITY, codes::NOT_ANALYSED],
    run: Run::Sets(findings),
};

/// Looks at every value and every comparison.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let mut found = beyond_the_clamp(study);
    found.extend(trouble(study));
    found.extend(equalities(study));
    found
}

/// Lines whose value, or some components of it, the clamp cuts wherever they count.
fn beyond_the_clamp(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let components = program.output.components();
    let mut found = Vec::new();
    for (row, case) in program.rows.iter().enumerate() {
        for (line, written) in case.lines.iter().enumerate() {
            // The bound and the side of it, with the components that it is so of.
            let mut cut: Vec<(f64, &str, Vec<&str>)> = Vec::new();
            for (number, component) in components.iter().enumerate() {
                let Some((bound, side)) = always_cut(study, (row, line), number) else { continue };
                match cut.iter_mut().find(|(other, beside, _)| (*other, *beside) == (bound, side)) {
                    Some((.., names)) => names.push(&component.name),
                    None => cut.push((bound, side, vec![&component.name])),
                }
            }
            for (bound, side, names) in cut {
                let (of, is) = match names.len() {
                    all if all == components.len() => ("the value".to_owned(), "is"),
                    1 => (format!("`{}` in the value", names[0]), "is"),
                    _ => {
                        let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                        (format!("{} in the value", words::list(&names)), "are")
                    }
                };
                let message = format!("{of} of case {} {is} always clamped to {bound}", case.id);
                found.push(
                    Diagnostic::warning(codes::OUT_OF_RANGE, message)
                        .at(written.span, format!("wherever this counts it is {side} {bound}"))
                        .help(format!("write {bound}, or mend the formula")),
                );
            }
        }
    }
    found
}

/// The bound of the clamp that a component of a line is beyond wherever the line counts, with the side.
fn always_cut(study: &mut Study<'_>, (row, line): (usize, usize), component: usize) -> Option<(f64, &'static str)> {
    let (lo, hi) = clamp(study, study.program.rows[row].lines[line].values[component])?;
    let pieces = study.pieces_of(Some(row)).iter().filter(|piece| piece.line == Some(line));
    let pieces: Vec<_> = pieces.cloned().collect();
    let mut sides = [true, true];
    let mut counts = false;
    for piece in pieces {
        let set = study.space.sets.and(piece.set, study.assumed);
        if study.space.is_void(set) {
            continue;
        }
        counts = true;
        let inner = words::bare(&study.space, piece.values[component]);
        let (low, high) = (study.space.pool.number(lo), study.space.pool.number(hi));
        let (above, below) = (study.space.less(high, inner), study.space.less(inner, low));
        for (side, beyond) in sides.iter_mut().zip([above, below]) {
            let inside = study.space.sets.minus(set, beyond);
            *side &= study.space.is_void(inside);
        }
    }
    match sides {
        [true, false] if counts => Some((hi, "above")),
        [false, true] if counts => Some((lo, "below")),
        _ => None,
    }
}

/// Operations that can yield infinity or NaN.
fn trouble(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut found: Vec<Diagnostic> = Vec::new();
    for piece in study.pieces.clone() {
        let set = study.space.sets.and(piece.set, study.assumed);
        let written = match piece.row.zip(piece.line) {
            Some((row, line)) => &program.rows[row].lines[line].values,
            None => &program.default,
        };
        for (value, written) in piece.values.iter().zip(written) {
            if !real::is_partial(&study.space.pool, *value) || study.space.is_void(set) {
                continue;
            }
            let span = match (piece.row.map(|row| &program.rows[row]), piece.line) {
                (Some(row), Some(line)) => row.lines[line].span,
                (Some(row), None) => row.span,
                (None, _) => program.hit_policy_span,
            };
            let name = piece.row.map_or("the default".to_owned(), |row| format!("case {}", program.rows[row].id));
            let reached = |point: &Point| {
                let outcome = point.outcome(program);
                point.is_admitted(program) && (outcome.row, outcome.line) == (piece.row, piece.line)
            };
            let asked = Asked { written: *written, row: piece.row, reached: &reached };
            let (trouble, point, exact) = match search(study, set, *value, &asked) {
                Search::Found { trouble, point, exact } => (trouble, point, exact),
                Search::Nothing => continue,
                Search::Unknown => {
                    found.push(undecided(&format!("the value of {name}"), span));
                    continue;
                }
            };
            let message = format!("the value of {name} can leave the numbers");
            if found.iter().any(|other| other.message == message && other.labels[0].span == span) {
                continue;
            }
            let what = Printer { pool: &study.space.pool, inputs: &program.inputs }.expr(trouble.expr);
            let mut warning =
                Diagnostic::warning(codes::NOT_A_NUMBER, message).at(span, format!("`{what}` {}", trouble.what));
            let mut witness = point.witness(program, &vec![true; program.inputs.len()]);
            if let Some(known) = study.space.with_numbers(set, &point.numbers) {
                witness.levels = known.levels;
            }
            let relevant = study.space.pool.expr_facts(*value).inputs;
            if let Some(place) = words::at(program, &witness, relevant) {
                warning = warning.help(format!("for instance {} {place}", if exact { "at" } else { "near" }));
            }
            found.push(warning.help("guard against it with a line of its own, or with max, clamp or select"));
        }
    }
    found
}

/// Comparisons for equality in guards, conditions and values. In assumptions they are how a line is described.
fn equalities(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let pool = &program.pool;
    let mut rounding = Rounding::new(pool);
    let mut found = Vec::new();
    for row in &program.rows {
        let mut seen = Vec::new();
        conditions_in(program, row.guard, &mut seen);
        let guard = equality(program, &mut rounding, &seen).map(|(a, b)| (row.guard_span, a, b));
        let mut lines = row.lines.iter().filter_map(|line| {
            let mut seen = Vec::new();
            conditions_in(program, line.condition, &mut seen);
            line.values.iter().for_each(|value| choices_in(program, *value, &mut seen));
            equality(program, &mut rounding, &seen).map(|(a, b)| (line.span, a, b))
        });
        let Some((span, a, b)) = guard.or_else(|| lines.next()) else { continue };
        let printer = Printer { pool, inputs: &program.inputs };
        let text = format!("{} == {}", printer.expr(a), printer.expr(b));
        found.push(
            Diagnostic::warning(codes::FLOAT_EQUALITY, format!("case {} compares numbers for equality", row.id))
                .at(span, format!("`{text}` holds on a line that rounding misses"))
                .help("declare the input as Levels if it has few values, or compare with < or <="),
        );
    }
    found
}

/// The first comparison for equality of numbers that are not exact: sums of codes and of truth values are.
fn equality(program: &Program, rounding: &mut Rounding<'_>, conditions: &[CondId]) -> Option<(ExprId, ExprId)> {
    conditions.iter().find_map(|condition| {
        let Cond::Compare(Comparison::Equal, a, b) = program.pool.cond(*condition) else { return None };
        (!(rounding.is_exact(*a) && rounding.is_exact(*b))).then_some((*a, *b))
    })
}

fn conditions_in(program: &Program, condition: CondId, found: &mut Vec<CondId>) {
    if found.contains(&condition) {
        return;
    }
    found.push(condition);
    let cond = program.pool.cond(condition);
    cond.compared().for_each(|part| choices_in(program, part, found));
    cond.children().for_each(|part| conditions_in(program, part, found));
}

fn choices_in(program: &Program, value: ExprId, found: &mut Vec<CondId>) {
    if !program.pool.expr_facts(value).selects {
        return;
    }
    let node = program.pool.node(value);
    node.children().for_each(|part| choices_in(program, part, found));
    if let Some(condition) = node.condition() {
        conditions_in(program, condition, found);
    }
}
