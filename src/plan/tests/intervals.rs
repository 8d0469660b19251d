//! Tables that compare one number with many constants: proved on as many paths as there are
//! intervals, searched by halves, and right at every constant and beside it.

use super::{agrees, program};
use crate::eval::Interpreter;
use crate::plan::walk::{Walked, Walker};
use crate::plan::*;
use crate::points::random::Random;
use crate::program::Value;
use crate::prove::is_unsuitable;

/// A table of `count` intervals of 0 to 1, each closed below and open above.
fn intervals(count: usize, guard: &str) -> String {
    let place = |i: usize| format!("{:?}", i as f64 / count as f64);
    let cases = (0..count).map(|i| {
        let (from, to) = (place(i), place(i + 1));
        format!("Case(id: {i}, when: \"x >= {from} && x < {to}{guard}\", value: \"{i} + y\"),")
    });
    format!(
        r#"Table(language: 1, name: "t", hit_policy: Unique,
            inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), "s": Bool(),
                "q": Bool(fetched: (cost: 1))}},
            output: Number(), cases: [{}], default: 0)"#,
        cases.collect::<String>()
    )
}

/// The most tests on a way through a plan.
fn depth(plan: &Plan<'_>, at: StepId) -> usize {
    let deepest = plan.step(at).next().into_iter().map(|next| depth(plan, next)).max().unwrap_or(0);
    deepest + usize::from(matches!(plan.step(at), Step::Test { .. }))
}

#[test]
fn intervals_have_a_path_each_and_are_searched() {
    let program = program(&intervals(300, ""));
    for shape in [Shape::Ladder, Shape::Ordered, Shape::Nested, Shape::Tree, Shape::Switch] {
        let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{e}"));
        // In both states: the intervals, what is below them, and what is above.
        assert_eq!(proved.proof().paths, 2 * 302, "{shape}");
        assert_eq!(proved.proof().identical, proved.proof().paths, "{shape}");
        agrees(proved.plan(), &mut Random::new(9));
    }
    let tree = Plan::new(&program, Shape::Tree).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(depth(&tree, tree.root()), 9);
    assert_eq!(tree.notes[0], "at most 9 tests find where `x` lies among 301 comparisons with constants");
}

/// An input that only some cases need is fetched for these only, below a search and in a chain.
#[test]
fn intervals_and_fetched_inputs_go_together() {
    let program = program(&intervals(40, " && (s || q)"));
    for shape in [Shape::Ladder, Shape::Ordered, Shape::Nested, Shape::Gathered, Shape::Tree, Shape::Switch] {
        let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{e}"));
        assert!(proved.proof().paths <= 2 * (2 * 40 + 2), "{shape}: {}", proved.proof().paths);
    }
    let tree = Plan::new(&program, Shape::Tree).unwrap_or_else(|e| panic!("{e}"));
    assert!(depth(&tree, tree.root()) <= 9, "{}", depth(&tree, tree.root()));
}

/// Sums over comparisons of one number, and lines, have few paths, too.
#[test]
fn choices_of_one_number_have_few_paths() {
    let parts: Vec<String> = (1..=30).map(|i| format!("(if x < {} {{ q }} else {{ 0.5 }})", i as f64 / 32.0)).collect();
    let lines: Vec<String> = (1..=30).map(|i| format!("(\"{i} + q\", \"x < {}\")", i as f64 / 32.0)).collect();
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), "q": Range(from: 0, to: 1, fetched: (cost: 1))}},
            output: Number(), cases: [Case(id: 1, when: "y < 0.5", value: "{}"),
                Case(id: 2, when: true, lines: [{}, 0])], default: 0)"#,
        parts.join(" + "),
        lines.join(", ")
    );
    let program = program(&text);
    for shape in [Shape::Ladder, Shape::Tree] {
        let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(proved.proof().paths, 62, "{shape}");
    }
    let tree = Plan::new(&program, Shape::Tree).unwrap_or_else(|e| panic!("{e}"));
    assert!(depth(&tree, tree.root()) <= 12, "{}", depth(&tree, tree.root()));
}

/// Every wrong outcome and every wrong leaf of a search is refused.
#[test]
fn changed_searches_are_refused() {
    let program = program(&intervals(24, " && s"));
    let plan = Plan::new(&program, Shape::Tree).unwrap_or_else(|e| panic!("{e}"));
    for step in plan.reachable() {
        let mut broken = plan.clone();
        broken.steps[step.0 as usize] = match broken.steps[step.0 as usize].clone() {
            Step::Test { condition, then, other } => Step::Test { condition, then: other, other: then },
            Step::Leaf(leaf) => Step::Leaf(Leaf { line: None, row: leaf.row.map_or(Some(3), |_| None), ..leaf }),
            step @ (Step::Fetch { .. }
            | Step::Gather { .. }
            | Step::Switch { .. }
            | Step::Coefficients { .. }
            | Step::Orbit { .. }) => step,
        };
        assert!(broken.prove().is_err(), "{step:?}");
    }
}

const CONSTANTS: [&str; 6] = ["0", "0.1", "0.25", "0.100000000001", "0.5", "0.75"];

fn guard(random: &mut Random, depth: usize) -> String {
    if depth > 0 && random.below(3) > 0 {
        let (a, b) = (guard(random, depth - 1), guard(random, depth - 1));
        return match random.below(5) {
            0 => format!("!({a})"),
            1 => format!("({a} || {b})"),
            2 => format!("(if {a} {{ {b} }} else {{ s }})"),
            _ => format!("({a} && {b})"),
        };
    }
    // A root of what may be negative is no number there, and fails every comparison.
    let number = ["x", "x", "y", "x + y", "sqrt(x - 0.25)", "q"][random.below(6)];
    let op = ["<", "<=", "==", ">=", ">", "!="][random.below(6)];
    match random.below(8) {
        0 => ["s", "x < y", "y <= x", "x == y", "k"][random.below(5)].to_owned(),
        1 => format!("{} {op} {number}", CONSTANTS[random.below(6)]),
        _ => format!("{number} {op} {}", CONSTANTS[random.below(6)]),
    }
}

#[test]
fn random_comparisons_are_planned_proved_and_right() {
    let mut random = Random::new(31);
    let numbers = [0.0, 0.05, 0.1, f64::from(0.1_f32), 0.2, 0.25, 0.3, 0.5, 0.5625, 0.75, 1.0];
    let (mut planned, mut searched) = (0, 0);
    for _ in 0..150 {
        let cases = (1..=(4 + random.below(5))).map(|id| {
            let (when, line) = (guard(&mut random, 3), guard(&mut random, 1));
            format!("Case(id: {id}, when: \"{when}\", lines: [(\"{id}\", \"{line}\"), \"x + {id}\"]),")
        });
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), "s": Bool(),
                    "q": Range(from: 0, to: 1, fetched: (cost: 1)), "k": Bool(fetched: (cost: 1))}},
                output: Number(), cases: [{}], default: 0)"#,
            cases.collect::<String>()
        );
        let program = program(&text);
        let point = |random: &mut Random| {
            let mut number = || Some(Value::Number(numbers[random.below(numbers.len())]));
            let (x, y, q) = (number(), number(), number());
            let (s, k) = (random.below(2) as u8, random.below(2) as u8);
            vec![x, y, Some(Value::Level(s)), q, Some(Value::Level(k))]
        };
        let points: Vec<_> = (0..60).map(|_| point(&mut random)).collect();
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Nested, Shape::Gathered, Shape::Tree, Shape::Switch] {
            let proved = match Plan::proved(&program, shape) {
                Ok(proved) => proved,
                Err(failure) if is_unsuitable(&failure) => continue,
                Err(failure) => panic!("{shape}: {failure}\n{text}"),
            };
            planned += 1;
            searched += usize::from(proved.plan().notes.iter().any(|note| note.starts_with("at most")));
            let walker = Walker::new(proved.plan());
            let mut interpreter = Interpreter::<f32>::new(&program);
            for point in &points {
                let want = interpreter.evaluate(point).unwrap_or_else(|e| panic!("{e:?}"));
                let Walked { row, line, values, fetched, repeated } = walker.run(point).expect("all inputs are given");
                let at = format!("{shape} at {point:?}\n{text}");
                assert_eq!((row, values), (want.row, want.values.clone()), "{line:?}: {at}");
                assert!(repeated.is_none() && fetched.minus(want.fetched).is_empty(), "{at}");
            }
        }
    }
    assert!(planned > 600 && searched > 20, "{planned} {searched}");
}
