//! Chains of guards: in the best order, and below a few first tests.
//!
//! Two cases keep their order if there is a state that both may claim. If
//! their values differ there, the result would change; if not, the number of
//! the case would. A guard that fetches also stays behind all that stand before
//! it, so that nothing is fetched that the table would not.

use super::Definition;
use crate::plan::builder::{Builder, Guarded, Result};
use crate::plan::key::KeyLayout;
use crate::plan::knowledge::Knowledge;
use crate::plan::order::{Certificate, Tests};
use crate::plan::setting::Setting;
use crate::plan::{Plan, StepId};
use crate::program::claims::decide;
use crate::program::{CondId, LevelKind, LevelSet, Pool, Program};

pub(super) static ORDERED: Definition = Definition {
    name: "ordered",
    summary: "the chain of guards in the best order that keeps the meaning",
    reads_buffer: false,
    needs_key: false,
    holds_data: false,
    plan: ordered,
};

pub(super) static NESTED: Definition = Definition {
    name: "nested",
    summary: "a few tests that decide many guards, then chains in the best order: the published advice",
    reads_buffer: false,
    needs_key: false,
    holds_data: false,
    plan: nested,
};

/// Tests before the chains of a nested plan.
pub(super) const FIRST_TESTS: usize = 2;

/// The guards, in the best order.
fn ordered<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    let mut builder = Builder::new(program);
    let everywhere: Vec<usize> = (0..setting.states.len()).collect();
    let chain = Chain::new(&mut builder.pool, setting, &everywhere, &Knowledge::none(program))?;
    let root = builder.rows(&chain.rows, &Knowledge::none(program))?;
    let mut plan = builder.finish(setting, KeyLayout::new(program)?, Vec::new(), root);
    plan.certificate = Some(Certificate { written: written(setting)?, planned: chain.cost, bound: chain.bound });
    Ok(plan)
}

/// The cost of the guards in the order written.
pub(super) fn written(setting: &Setting<'_, '_>) -> Result<f64> {
    let everywhere: Vec<usize> = (0..setting.states.len()).collect();
    let (tests, rows) = tests(setting, &everywhere)?;
    Ok(tests.cost(&(0..rows.len()).collect::<Vec<_>>()))
}

/// The tests that decide most guards first, then the guards that are left, in the best order.
fn nested<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    let mut builder = Builder::new(program);
    let everywhere: Vec<usize> = (0..setting.states.len()).collect();
    let mut certificate = Certificate { written: written(setting)?, planned: 0.0, bound: 0.0 };
    let known = Knowledge::none(program);
    let root = nest(&mut builder, setting, &everywhere, &known, FIRST_TESTS, &mut certificate)?;
    let mut plan = builder.finish(setting, KeyLayout::new(program)?, Vec::new(), root);
    plan.certificate = Some(certificate);
    Ok(plan)
}

/// A chain of what may be taken in some states, given by their place in the setting.
struct Chain {
    rows: Guarded,
    cost: f64,
    bound: f64,
}

impl Chain {
    fn new(pool: &mut Pool, setting: &Setting<'_, '_>, states: &[usize], known: &Knowledge) -> Result<Self> {
        let (tests, rows) = tests(setting, states)?;
        let (order, bound) = tests.best();
        let guards = &setting.program.rows;
        let rows = order.iter().map(|test| (rows[*test], known.cond(pool, guards[rows[*test]].guard)));
        Ok(Self { rows: rows.collect(), cost: tests.cost(&order), bound })
    }
}

/// The guards that may hold in some states, and their rows.
fn tests(setting: &Setting<'_, '_>, states: &[usize]) -> Result<(Tests, Vec<usize>)> {
    let program = setting.program;
    let claims = setting.claims()?;
    let mut place = vec![usize::MAX; program.rows.len()];
    for state in states {
        claims.of(setting.states[*state]).for_each(|claim| place[claim.row] = 0);
    }
    let rows: Vec<usize> = (0..program.rows.len()).filter(|row| place[*row] == 0).collect();
    rows.iter().enumerate().for_each(|(number, row)| place[*row] = number);
    let mut tests = Tests { weights: vec![0.0; rows.len()], before: vec![Vec::new(); rows.len()], passed: 0.0 };
    for state in states {
        let share = setting.shares[*state];
        let (mut taken, mut sure, mut last) = (Vec::new(), false, None);
        for claim in claims.of(setting.states[*state]) {
            let number = place[claim.row];
            // What comes before it among the claims comes before it in the order; the rest follows from that.
            tests.before[number].extend(last.replace(number));
            if !sure {
                taken.push(number);
                sure = claim.always;
            }
        }
        // Where other inputs decide between some, each is thought to be as likely.
        let part = share / (taken.len() + usize::from(!sure)) as f64;
        taken.iter().for_each(|number| tests.weights[*number] += part);
        tests.passed += if sure { 0.0 } else { part };
    }
    for (number, row) in rows.iter().enumerate() {
        if !program.pool.cond_facts(program.rows[*row].guard).inputs.and(program.fetched).is_empty() {
            tests.before[number].extend(0..number);
        }
        tests.before[number].sort_unstable();
        tests.before[number].dedup();
    }
    Ok((tests, rows))
}

/// Tests that decide most, so many of them one below the other, then chains.
pub(super) fn nest(
    builder: &mut Builder<'_>,
    setting: &Setting<'_, '_>,
    states: &[usize],
    known: &Knowledge,
    tests_left: usize,
    certificate: &mut Certificate,
) -> Result<StepId> {
    let split = if tests_left == 0 { None } else { most_deciding(builder, setting, states)? };
    let Some(condition) = split else {
        let chain = Chain::new(&mut builder.pool, setting, states, known)?;
        certificate.planned += chain.cost;
        certificate.bound += chain.bound;
        return builder.rows(&chain.rows, known);
    };
    let share: f64 = states.iter().map(|state| setting.shares[*state]).sum();
    certificate.planned += share;
    certificate.bound += share;
    let (yes, no) = parted(builder, setting, states, condition);
    let then = known.with(&builder.pool, condition, true);
    let then = nest(builder, setting, &yes, &then, tests_left - 1, certificate)?;
    let other = known.with(&builder.pool, condition, false);
    let other = nest(builder, setting, &no, &other, tests_left - 1, certificate)?;
    builder.test(condition, then, other)
}

/// The states in which a condition holds, and the others.
fn parted(
    builder: &Builder<'_>,
    setting: &Setting<'_, '_>,
    states: &[usize],
    condition: CondId,
) -> (Vec<usize>, Vec<usize>) {
    let program = setting.program;
    let mut levels = vec![0; program.inputs.len()];
    states.iter().partition(|state| {
        program.states.write(setting.states[**state], &mut levels);
        decide(program, &builder.pool, condition, &levels) == Some(true)
    })
}

/// The condition that rules out most cases, on one side or the other; of
/// equally good ones that which divides the cases most evenly.
fn most_deciding(builder: &mut Builder<'_>, setting: &Setting<'_, '_>, states: &[usize]) -> Result<Option<CondId>> {
    let claims = setting.claims()?;
    let mut best: Option<((usize, usize), CondId)> = None;
    for condition in candidates(setting.program, &mut builder.pool) {
        let (yes, no) = parted(builder, setting, states, condition);
        if yes.is_empty() || no.is_empty() {
            continue;
        }
        let rows = |states: &[usize]| {
            let mut rows: Vec<usize> =
                states.iter().flat_map(|state| claims.of(setting.states[*state])).map(|claim| claim.row).collect();
            rows.sort_unstable();
            rows.dedup();
            rows
        };
        let (yes, no) = (rows(&yes), rows(&no));
        let both = yes.iter().filter(|row| no.binary_search(row).is_ok()).count();
        let ruled_out = yes.len() + no.len() - 2 * both;
        let score = (ruled_out, (yes.len() - both).min(no.len() - both));
        if ruled_out > 0 && best.as_ref().is_none_or(|(known, _)| score > *known) {
            best = Some((score, condition));
        }
    }
    Ok(best.map(|(_, condition)| condition))
}

/// Tests for a level of one input, or for a level of the same name of either of two inputs.
fn candidates(program: &Program, pool: &mut Pool) -> Vec<CondId> {
    let digits = program.states.digits();
    let mut found = Vec::new();
    for (place, (input, count)) in digits.iter().enumerate() {
        let Some(levels) = program.levels(*input) else { continue };
        // Of two levels, one says all.
        let first = usize::from(*count == 2);
        for (level, name) in levels.names.iter().enumerate().skip(first) {
            let one = pool.level(*input, LevelSet::one(level as u8), *count);
            found.push(one);
            if levels.kind != LevelKind::Named {
                continue;
            }
            for (other, count) in &digits[place + 1..] {
                let others = program.levels(*other).filter(|levels| levels.kind == LevelKind::Named);
                if let Some(level) = others.and_then(|levels| levels.names.iter().position(|n| n == name)) {
                    let either = pool.level(*other, LevelSet::one(level as u8), *count);
                    found.push(pool.or([one, either]));
                }
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Shape;
    use crate::plan::Weights;
    use crate::program::print::Printer;

    /// The advice of the supplement to RSMSS: first by the kind of
    /// discontinuity, then by whether one axis has both sides.
    #[test]
    fn nesting_follows_the_published_advice() {
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        let plan = Plan::new(&program, Shape::Nested).unwrap_or_else(|e| panic!("{e}"));
        let condition = |step| {
            let crate::plan::Step::Test { condition, then, .. } = plan.step(step) else { panic!("no test") };
            (*condition, *then)
        };
        let (first, then) = condition(plan.root());
        let (second, _) = condition(then);
        let printer = Printer { pool: &plan.pool, inputs: &program.inputs };
        assert_eq!(printer.cond(first), "b == exiting");
        assert_eq!(printer.cond(second), "H == both || V == both");
    }

    /// The orders that are built for what was counted are the best there are.
    #[test]
    fn the_orders_of_the_published_tables_are_optimal() {
        for name in ["smsr", "rsmss"] {
            let program = Program::read(format!("tables/{name}.ron")).unwrap_or_else(|e| panic!("{e}"));
            let file = format!("profiles/{name}.ron");
            let profile = crate::profile::read(file.as_ref()).unwrap_or_else(|e| panic!("{e}"));
            let fitted = crate::profile::fit(&program, profile, &file).unwrap_or_else(|e| panic!("{e}"));
            let weights = fitted.weights(&program, &file).unwrap_or_else(|e| panic!("{e}"));
            for shape in [Shape::Ordered, Shape::Nested] {
                let options = crate::plan::PlanOptions { shape, weights: Some(&weights), assume: false };
                let plan = Plan::new(&program, options).unwrap_or_else(|e| panic!("{e}"));
                let certificate = plan.certificate.expect("ordered plans have one");
                assert!(certificate.is_optimal(), "{name} {shape}: {certificate}");
                println!("{name} {shape}: {certificate}");
            }
        }
    }

    #[test]
    fn frequent_cases_come_first_as_far_as_precedence_lets_them() {
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        // Only case 22 occurs, which shares states with seven cases before it.
        let state = program.states.index(|input| match program.inputs[input.index()].name.as_str() {
            "V" | "tH" | "tV" => 1,
            _ => 0,
        });
        let mut weights = vec![0.0; program.states.count()];
        weights[state] = 1.0;
        let weights = Weights::new(&program, weights, "one state").unwrap_or_else(|e| panic!("{e}"));
        let options = crate::plan::PlanOptions { shape: Shape::Ordered, weights: Some(&weights), assume: false };
        let proved = Plan::proved(&program, options).unwrap_or_else(|e| panic!("{e}"));
        let certificate = proved.plan().certificate.expect("ordered plans have one");
        assert_eq!(certificate.written, 22.0);
        assert!(certificate.is_optimal(), "{certificate}");
        assert_eq!(certificate.planned, 8.0);
    }
}
