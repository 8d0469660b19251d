//! The gate lets through what is right, and names the state where something is wrong.

use super::*;
use crate::plan::{LookupPlace, Shape};

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

/// Every single change of a leaf, a test or the lookup is refused. Of the
/// larger table every third step is tried, which takes in each kind.
#[test]
fn broken_plans_are_refused_with_a_counterexample() {
    for (table, stride) in TABLES.into_iter().zip([1, 3]) {
        let program = program(table);
        for shape in [Shape::Ladder, Shape::Gathered, Shape::Switch(LookupPlace::Constants)] {
            let Ok(plan) = Plan::new(&program, shape) else { continue };
            let (mut refused, mut harmless) = (0, 0);
            for step in (0..plan.steps.len()).step_by(stride) {
                let mut broken = plan.clone();
                broken.steps[step] = match broken.steps[step].clone() {
                    Step::Test { condition, then, other } => Step::Test { condition, then: other, other: then },
                    Step::Leaf(leaf) => {
                        let wrong = broken.pool.number(0.437_5);
                        Step::Leaf(Leaf { values: vec![wrong; leaf.values.len()], ..leaf })
                    }
                    Step::Fetch { next, .. } | Step::Gather { next, .. } => broken.step(next).clone(),
                    Step::Switch { mut arms } => {
                        arms.rotate_left(1);
                        Step::Switch { arms }
                    }
                    Step::Orbit { mut arms } => {
                        arms.rotate_left(1);
                        Step::Orbit { arms }
                    }
                    Step::Coefficients { mut rest } => {
                        rest.rotate_left(1);
                        Step::Coefficients { rest }
                    }
                };
                match broken.prove() {
                    Err(failure) => {
                        assert!(failure.to_string().contains("in the state H = "), "{failure}");
                        refused += 1;
                    }
                    Ok(_) => harmless += 1,
                }
            }
            // A leaf that no state reaches (the default of a table that covers a
            // branch completely, say) may be changed without harm; nothing else may.
            assert!(refused > 0 && harmless <= 2, "{table} {shape}: {refused} refused, {harmless} harmless");
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
    let plan = Plan::new(&program, Shape::Switch(LookupPlace::Buffer)).unwrap_or_else(|e| panic!("{e}"));
    for state in [0, 1, 500, program.states.count() - 1] {
        let mut broken = plan.clone();
        broken.lookup[state] = (broken.lookup[state] + 1) % 20;
        let failure = broken.prove().expect_err("another case is taken");
        assert!(failure.to_string().contains("the table takes"), "{failure}");
    }
}
