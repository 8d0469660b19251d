//! The meaning of a table, by its definition: rows in order, lines in order, then the default.

use super::Meaning;
use super::script::Script;
use super::terms::Terms;
use crate::program::{InputId, Program};

/// The number of a case and a line: rows and lines count from 1, and 0 is the default.
pub(super) fn way(row: Option<usize>, line: Option<usize>) -> usize {
    // A row has fewer lines than this, as it has fewer operations.
    const LINES: usize = 1 << 20;
    row.map_or(0, |row| (row + 1) * LINES + line.map_or(0, |line| line + 1))
}

/// The case, the result and the fetches of a table.
pub(super) fn meaning(program: &Program, script: &mut Script) -> Meaning {
    let mut terms = Terms::new(&program.pool, script.inputs.clone());
    script.comment("The table.");
    let default: Vec<String> = program.default.iter().map(|value| terms.expr(script, *value)).collect();
    let fetched: Vec<InputId> = program.fetched.iter().collect();
    let of_default = |terms: &mut Terms<'_>, script: &mut Script, input: InputId| {
        let reads: Vec<String> = program.default.iter().map(|value| terms.reads(script, *value, input)).collect();
        format!("(or false {})", reads.join(" "))
    };
    // What comes to pass if no row so far is taken, from the last row to the first.
    let mut rest_way = way(None, None).to_string();
    let mut rest_values = default.clone();
    let mut rest_fetches: Vec<String> = fetched.iter().map(|input| of_default(&mut terms, script, *input)).collect();
    for (number, row) in program.rows.iter().enumerate().rev() {
        script.comment(&format!("case {}", row.id));
        let mut own_way = way(Some(number), None).to_string();
        let mut own_values = default.clone();
        let mut own_fetches: Vec<String> = fetched.iter().map(|input| of_default(&mut terms, script, *input)).collect();
        for (place, line) in row.lines.iter().enumerate().rev() {
            let applies = terms.cond(script, line.condition);
            own_way = format!("(ite {applies} {} {own_way})", way(Some(number), Some(place)));
            for (own, value) in own_values.iter_mut().zip(&line.values) {
                *own = format!("(ite {applies} {} {own})", terms.expr(script, *value));
            }
            for (own, input) in own_fetches.iter_mut().zip(&fetched) {
                let reads: Vec<String> = line.values.iter().map(|value| terms.reads(script, *value, *input)).collect();
                let asks = terms.asks(script, line.condition, *input);
                *own = format!("(or {asks} (ite {applies} (or false {}) {own}))", reads.join(" "));
            }
        }
        let taken = terms.cond(script, row.guard);
        rest_way = script.define("Int", &format!("(ite {taken} {own_way} {rest_way})"));
        for (rest, own) in rest_values.iter_mut().zip(&own_values) {
            *rest = script.define("Real", &format!("(ite {taken} {own} {rest})"));
        }
        for ((rest, own), input) in rest_fetches.iter_mut().zip(&own_fetches).zip(&fetched) {
            let asks = terms.asks(script, row.guard, *input);
            *rest = script.define("Bool", &format!("(or {asks} (ite {taken} {own} {rest}))"));
        }
    }
    Meaning { way: rest_way, values: rest_values, fetches: fetched.into_iter().zip(rest_fetches).collect() }
}

/// Leaves out what the assumptions do not admit.
pub(super) fn assume(program: &Program, script: &mut Script) {
    let mut terms = Terms::new(&program.pool, script.inputs.clone());
    script.comment("The assumptions.");
    for assumption in &program.assumptions {
        let holds = terms.cond(script, assumption.condition);
        script.line(&format!("(assert {holds})"));
    }
}
