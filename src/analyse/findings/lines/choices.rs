//! Choices inside values that never go one way.
//!
//! A choice is what is written: an `if` or `select`. In a name or helper it stands for
//! every place that uses it, and it is idle only if no use of it takes its first side. The
//! second side may be there for completeness. Selections that the compiler made, of the
//! codes of levels, are nobody's choice.

use std::collections::{HashMap, HashSet};

use crate::analyse::sets::Set;
use crate::analyse::sets::space::View;
use crate::analyse::sets::study::Study;
use crate::analyse::values::rounding::{self, Rounding};
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::print::Printer;
use crate::program::{Choice, CondId, ExprId, Node, Program};

/// The use of a selection whose first side is never taken there.
struct Idle {
    row: usize,
    condition: CondId,
    /// The set where it would be taken if assumptions did not rule that out.
    never: Set,
}

/// Everything known of the selections of a program.
#[derive(Default)]
struct Uses {
    taken: HashSet<ExprId>,
    /// The first use of those that are not taken there, with its number in the order found.
    idle: HashMap<ExprId, (usize, Idle)>,
    seen: HashSet<(ExprId, Set)>,
}

/// A warning for each choice that never goes its first way.
pub(super) fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    if program.written.choices.iter().all(|choice| choice.selections.is_empty()) {
        return Vec::new();
    }
    let mut uses = Uses::default();
    asked_in_conditions(program, &mut uses.taken);
    for (row, case) in program.rows.iter().enumerate() {
        let mut rest = study.space.sets.and(study.counts(row), study.assumed);
        for line in &case.lines {
            let condition = study.space.condition(line.condition, View::PLAIN);
            let counts = study.space.sets.and(rest, condition);
            rest = study.space.sets.minus(rest, condition);
            if !study.space.is_void(counts) {
                line.values.iter().for_each(|value| visit(study, Some(row), *value, counts, &mut uses));
            }
        }
    }
    // The default stands in for lines as well.
    program.default.iter().for_each(|value| visit(study, None, *value, Set::ALL, &mut uses));
    let mut found: Vec<(usize, Diagnostic)> = Vec::new();
    for choice in &program.written.choices {
        if choice.is_decided || choice.selections.iter().any(|selection| uses.taken.contains(selection)) {
            continue;
        }
        let first = choice.selections.iter().filter_map(|selection| uses.idle.get(selection)).min_by_key(|use_| use_.0);
        if let Some((number, idle)) = first {
            found.push((*number, finding(study, choice, idle)));
        }
    }
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, finding)| finding).collect()
}

/// Follows a value to its selections.
fn visit(study: &mut Study<'_>, row: Option<usize>, value: ExprId, within: Set, uses: &mut Uses) {
    if !study.space.pool.expr_facts(value).selects || !uses.seen.insert((value, within)) {
        return;
    }
    let node = study.space.pool.node(value);
    let Node::Select(condition, a, b) = node else {
        node.children().for_each(|part| visit(study, row, part, within, uses));
        return;
    };
    let holds = study.space.condition(condition, View::PLAIN);
    let (then, other) = (study.space.sets.and(within, holds), study.space.sets.minus(within, holds));
    match (study.space.is_void(then), row) {
        (false, _) => {
            uses.taken.insert(value);
            visit(study, row, a, then, uses);
        }
        (true, Some(row)) => {
            let number = uses.idle.len();
            uses.idle.entry(value).or_insert((number, Idle { row, condition, never: then }));
        }
        (true, None) => {}
    }
    if !study.space.is_void(other) {
        visit(study, row, b, other, uses);
    }
}

/// Selections that conditions ask for: of these nothing is said.
fn asked_in_conditions(program: &Program, taken: &mut HashSet<ExprId>) {
    let pool = &program.pool;
    let mut conditions: Vec<CondId> = Vec::new();
    for row in &program.rows {
        conditions.push(row.guard);
        conditions.extend(row.lines.iter().map(|line| line.condition));
    }
    let (mut values, mut asked, mut seen) = (Vec::new(), HashSet::new(), HashSet::new());
    loop {
        if let Some(condition) = conditions.pop() {
            if asked.insert(condition) {
                conditions.extend(pool.cond(condition).children());
                values.extend(pool.cond(condition).compared());
            }
        } else if let Some(value) = values.pop() {
            if pool.expr_facts(value).selects && seen.insert(value) {
                let node = pool.node(value);
                values.extend(node.children());
                if let Some(condition) = node.condition() {
                    taken.insert(value);
                    conditions.push(condition);
                }
            }
        } else {
            return;
        }
    }
}

fn finding(study: &mut Study<'_>, choice: &Choice, idle: &Idle) -> Diagnostic {
    let program = study.program;
    let case = &program.rows[idle.row];
    let asked = Printer { pool: &study.space.pool, inputs: &program.inputs }.cond(idle.condition);
    let message = format!("a part of the value of case {} never counts", case.id);
    let warning = Diagnostic::warning(codes::DEAD_LINE, message)
        .at(choice.span, format!("where this is asked, `{asked}` never holds"))
        .about([asked]);
    let warning = match idle.never.is_empty() {
        true => warning.at(case.guard_span, "given this guard and the choices before"),
        false => {
            let blamed: Vec<String> = study.blame(idle.never).into_iter().map(|name| format!("`{name}`")).collect();
            warning.help(format!("{} rules it out", words::list(&blamed)))
        }
    };
    match Rounding::new(&program.pool).decides(idle.condition) {
        true => warning.help(rounding::MAY_HOLD),
        false => warning.help("remove this choice, or mend the guard"),
    }
}
