//! The gate lets through what is right, and names the state where something is wrong.

use std::collections::BTreeMap;

use super::agrees;
use crate::plan::Shape;
use crate::plan::*;
use crate::points::random::Random;

const TABLES: [&str; 2] = ["tables/smsr.ron", "tables/rsmss.ron"];

fn program(path: &str) -> Program {
    Program::read(path).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn the_tables_are_proved_in_every_shape() {
    for table in TABLES {
        let program = program(table);
        for shape in Shape::ALL {
            let proved = match Plan::proved(&program, shape) {
                Err(failure) if shape == Shape::Gathered && program.fetched.is_empty() => {
                    assert!(failure.to_string().contains("it fetches nothing"), "{failure}");
                    continue;
                }
                proved => proved.unwrap_or_else(|e| panic!("{e}")),
            };
            assert_eq!(proved.proof().states, program.states.count());
            let computes = matches!(shape, Shape::Coefficients | Shape::Orbit);
            assert!(computes || proved.proof().identical == proved.proof().paths, "{table} {shape}");
        }
    }
}

/// The part that a mutation changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    Leaf,
    Order,
    Fetch,
    Way,
    Lookup,
    Coefficient,
}

/// A plan with each of its steps changed, and of each kind of data some.
fn changed<'p>(plan: &Plan<'p>) -> Vec<(Change, Plan<'p>)> {
    let mut all = Vec::new();
    let mut with = |kind: Change, change: &dyn Fn(&mut Plan<'p>)| {
        let mut broken = plan.clone();
        change(&mut broken);
        all.push((kind, broken));
    };
    for id in plan.reachable() {
        let step = id.0 as usize;
        match plan.steps[step].clone() {
            Step::Test { condition, then, other } => {
                with(Change::Order, &|plan| plan.steps[step] = Step::Test { condition, then: other, other: then });
            }
            Step::Leaf(leaf) => with(Change::Leaf, &|plan| {
                let wrong = plan.pool.number(0.437_5);
                plan.steps[step] = Step::Leaf(Leaf { values: vec![wrong; leaf.values.len()], ..leaf.clone() });
            }),
            Step::Fetch { next, .. } | Step::Gather { next, .. } => {
                with(Change::Fetch, &|plan| plan.steps[step] = plan.step(next).clone());
            }
            Step::Switch { arms } | Step::Coefficients { rest: arms } | Step::Orbit { arms } => {
                for place in 0..arms.len() {
                    with(Change::Way, &|plan| match &mut plan.steps[step] {
                        Step::Switch { arms } | Step::Coefficients { rest: arms } | Step::Orbit { arms } => {
                            arms[place] = arms[(place + 1) % arms.len()];
                        }
                        Step::Test { .. } | Step::Fetch { .. } | Step::Gather { .. } | Step::Leaf(_) => {
                            unreachable!("it was one of these")
                        }
                    });
                }
            }
        }
    }
    for state in (0..plan.lookup.len()).step_by(17) {
        with(Change::Lookup, &|plan| plan.lookup[state] ^= 1);
    }
    let fits = plan.coefficients.fits.iter().enumerate();
    for (fit, old) in fits.step_by(if plan.coefficients.fits.len() > 20 { 5 } else { 1 }) {
        for form in 0..old.pieces[0].forms.len() {
            for factor in 0..=plan.coefficients.inputs.len() {
                with(Change::Coefficient, &|plan| {
                    let form = &mut plan.coefficients.fits[fit].pieces[0].forms[form];
                    *form.factors.get_mut(factor).unwrap_or(&mut form.constant) -= 0.125;
                });
            }
        }
    }
    all
}

/// Of every shape, each leaf, each order of two ways, each fetch and each way is changed by itself,
/// and of a large lookup or many coefficients some. All of that is refused, but for what makes no
/// difference: a sum below the clamp, and a state that a symmetry maps to itself.
#[test]
fn broken_plans_are_refused_with_a_counterexample() {
    for table in TABLES {
        let program = program(table);
        for shape in Shape::ALL {
            let Ok(plan) = Plan::new(&program, shape) else { continue };
            let mut refused: BTreeMap<Change, usize> = BTreeMap::new();
            for (kind, broken) in changed(&plan) {
                match broken.clone().prove() {
                    Err(failure) => {
                        assert!(failure.to_string().contains("in the state "), "{failure}");
                        *refused.entry(kind).or_default() += 1;
                    }
                    Ok(_) => {
                        let may_be = shape == Shape::Coefficients && kind == Change::Coefficient
                            || shape == Shape::Orbit && matches!(kind, Change::Way | Change::Lookup);
                        assert!(may_be, "{table} {shape}: a changed {kind:?} is not refused");
                        agrees(&broken, &mut Random::new(3));
                    }
                }
            }
            let kinds: Vec<Change> = changed(&plan).into_iter().map(|(kind, _)| kind).collect();
            assert!(kinds.iter().all(|kind| refused.contains_key(kind)), "{table} {shape}: {refused:?}");
        }
    }
}

/// Seventeen comparisons in a value decide between more paths than a state may have. It takes a
/// fetched input as well, so that all of them are gone through.
#[test]
fn what_has_too_many_paths_is_not_proved() {
    let parts: Vec<String> = (1..=17).map(|i| format!("(if x < {i} * y {{ {i} }} else {{ 0.5 }})")).collect();
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), "far": Range(from: 0, to: 1, fetched: (cost: 1))}},
            output: Number(), cases: [Case(id: 1, when: "x < 2", value: "far + {}")], default: 0)"#,
        parts.join(" + ")
    );
    let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
    let failure = Plan::proved(&program, Shape::Ladder).expect_err("there are too many paths").to_string();
    assert!(
        failure.contains("error[U0604]: t.ron: the plan `ladder` of `t` has too many paths to be proved"),
        "{failure}"
    );
    assert!(failure.contains("a state may have 65536 paths"), "{failure}");
    assert!(failure.contains("make a comparison an input of the table"), "{failure}");
}

#[test]
fn a_wrong_lookup_is_refused() {
    let program = program(TABLES[1]);
    let plan = Plan::new(&program, Shape::SwitchBuffer).unwrap_or_else(|e| panic!("{e}"));
    for state in [0, 1, 500, program.states.count() - 1] {
        let mut broken = plan.clone();
        broken.lookup[state] = (broken.lookup[state] + 1) % 20;
        let failure = broken.prove().expect_err("another case is taken");
        assert!(failure.to_string().contains("the table takes"), "{failure}");
    }
}
