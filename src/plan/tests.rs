//! Random tables × all plans: what is planned is proved, what is proved gives
//! what the interpreter gives, and what is changed afterwards is refused.

mod extremes;
mod intervals;
mod mutations;

use super::walk::{Walked, Walker};
use super::*;
use crate::diag::Source;
use crate::eval::Interpreter;
use crate::points::random::Random;
use crate::program::{Domain, Value};
use crate::prove::is_unsuitable;
use crate::table::Table;

fn pick<'a>(random: &mut Random, list: &[&'a str]) -> &'a str {
    list[random.below(list.len())]
}

const SIDES: [&str; 4] = ["none", "left", "right", "both"];
const KINDS: [&str; 3] = ["thin", "long", "open"];

/// A table with inputs of every kind, guards that overlap, and a mirror that
/// some of its cases come from.
fn table(random: &mut Random) -> String {
    let cases = 3 + random.below(5);
    let mut text = String::from(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {
                "side": Levels(values: {"none": 0, "left": 1, "right": 2, "both": 3}),
                "kind": Levels(values: {"thin": 0, "long": 1, "open": 2}),
                "flag": Bool(), "near": Bool(),
                "x": Range(from: 0, to: 1), "y": Range(from: -1, to: 2),
                "far": Levels(of: "side", fetched: (cost: 2)),
            },
            symmetries: {
                "mirror": Symmetry(map: {"side": {"left": "right", "right": "left"},
                    "far": {"left": "right", "right": "left"}, "x": "1 - x"}),
                "turn": Symmetry(map: {"flag": "!flag"}, result: "1 - value"),
            },
            assume: {"a": "side != both || !near", "b": "kind != thin || x <= 0.5"},
            output: Number(clamp: (0, 1)),
            cases: ["#,
    );
    for id in 1..=cases {
        if id > 1 && id % 3 == 0 {
            text += &format!("Case(id: {id}, is: (case: {}, under: \"mirror\")),\n", id - 1);
            continue;
        }
        let guard = guard(random, 2);
        match random.below(3) {
            0 => {
                let (first, second) = (value(random, 2), value(random, 1));
                let condition = if random.below(2) == 0 { "far == left" } else { "side == left" };
                text += &format!(
                    "Case(id: {id}, when: \"{guard}\", lines: [(\"{first}\", \"{condition}\"), \"{second}\"]),\n"
                );
            }
            _ => text += &format!("Case(id: {id}, when: \"{guard}\", value: \"{}\"),\n", value(random, 2)),
        }
    }
    text + "], default: 0.5)"
}

fn guard(random: &mut Random, depth: usize) -> String {
    match random.below(if depth == 0 { 4 } else { 7 }) {
        0 => format!("side == {}", pick(random, &SIDES)),
        1 => format!("kind != {}", pick(random, &KINDS)),
        2 => pick(random, &["flag", "!near", "near", "side in {left, right}"]).to_owned(),
        3 => pick(random, &["flag", "kind == open", "x < 0.5", "far == both"]).to_owned(),
        4 => format!("({} || {})", guard(random, depth - 1), guard(random, depth - 1)),
        _ => format!("({} && {})", guard(random, depth - 1), guard(random, depth - 1)),
    }
}

fn value(random: &mut Random, depth: usize) -> String {
    match random.below(if depth == 0 { 3 } else { 8 }) {
        0 => pick(random, &["x", "y", "1 - x", "0.25", "1 + x - y"]).to_owned(),
        1 => format!("{} * x - 0.5", 1 + random.below(3)),
        2 => pick(random, &["2 - x - y", "y - x", "0.5 * y"]).to_owned(),
        3 => format!("min({}, {})", value(random, depth - 1), value(random, depth - 1)),
        4 => format!("max({}, {})", value(random, depth - 1), value(random, depth - 1)),
        5 => format!("if side == left {{ {} }} else {{ {} }}", value(random, depth - 1), value(random, depth - 1)),
        6 => {
            let either = pick(random, &["near && x < 0.5 && far == left", "far != both || y < x || flag"]);
            format!("if {either} {{ {} }} else {{ {} }}", value(random, depth - 1), value(random, depth - 1))
        }
        _ => format!("({}) * 0.5", value(random, depth - 1)),
    }
}

fn program(text: &str) -> Program {
    let table = Table::parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Program::check(&table).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn point(random: &mut Random, program: &Program, state: usize) -> Vec<Option<Value>> {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let values = program.input_ids().map(|(id, input)| match (&input.domain, input.fetched) {
        (Domain::Discrete(_), None) => Value::Level(levels[id.index()]),
        (Domain::Discrete(known), Some(_)) => Value::Level(random.below(known.count()) as u8),
        (Domain::Word, _) => Value::Number(random.below(1 << 32) as f64),
        (Domain::Continuous { lo, hi, .. }, _) => {
            Value::Number(f64::from((lo + (hi - lo) * random.below(10_000) as f64 / 9_999.0) as f32))
        }
    });
    values.map(Some).collect()
}

#[test]
fn every_plan_of_random_tables_is_proved_and_right() {
    let mut random = Random::new(7);
    let mut planned = [0; Shape::ALL.len()];
    for round in 0..120 {
        let text = table(&mut random);
        let program = program(&text);
        let weights = (0..program.states.count()).map(|_| random.below(5) as f64).collect();
        let weights = Weights::new(&program, weights, "a test").unwrap_or_else(|e| panic!("{e}"));
        let assume = round % 3 == 0;
        let points: Vec<_> = (0..program.states.count())
            .flat_map(|state| [state, state])
            .map(|state| point(&mut random, &program, state))
            .collect();
        for (number, shape) in Shape::ALL.into_iter().enumerate() {
            let options = PlanOptions { shape, weights: Some(&weights), assume };
            let proved = match Plan::proved(&program, options) {
                Ok(proved) => proved,
                Err(failure) if is_unsuitable(&failure) => continue,
                Err(failure) => panic!("{shape}: {failure}\n{text}"),
            };
            planned[number] += 1;
            let plan = proved.plan();
            let walker = Walker::new(plan);
            let mut interpreter = Interpreter::<f32>::new(&program);
            for point in &points {
                interpreter.place(point).unwrap_or_else(|e| panic!("{e:?}"));
                let holds = |interpreter: &mut Interpreter<'_, f32>| {
                    let mut all = program.assumptions.iter();
                    all.all(|assumption| interpreter.holds(assumption.condition).unwrap_or(false))
                };
                if assume && !holds(&mut interpreter) {
                    continue;
                }
                let want = interpreter.evaluate(point).unwrap_or_else(|e| panic!("{e:?}"));
                let Walked { row, values, fetched, repeated, .. } = walker.run(point).expect("all inputs are given");
                let at = format!("{shape} at {point:?}\n{text}");
                assert!(!plan.reports_case() || row == want.row, "{row:?}, not {:?}: {at}", want.row);
                assert!(repeated.is_none() && fetched.minus(want.fetched).is_empty(), "{at}");
                let same = proved.proof().identical == proved.proof().paths;
                let slack = if same { 0.0 } else { 1e-5 };
                assert!((values[0] - want.values[0]).abs() <= slack, "{values:?}, not {:?}: {at}", want.values);
            }
        }
    }
    assert!(planned.iter().all(|count| *count >= 30), "{planned:?}");
}

/// A table with a fetched input for each of some cases, or one for all of them.
fn fetching(cases: usize, fetched: usize, guard: impl Fn(usize, usize) -> String, value: &str) -> Program {
    let inputs: Vec<String> = (0..fetched).map(|i| format!("\"q{i}\": Bool(fetched: (cost: 1))")).collect();
    let rows =
        (0..cases).map(|i| format!("Case(id: {}, when: \"{}\", value: \"{value}\")", i + 1, guard(i, i % fetched)));
    let rows: Vec<String> = rows.collect();
    program(&format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"side": Bool(), "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1), {}}},
            output: Number(), cases: [{}], default: 0)"#,
        inputs.join(", "),
        rows.join(", ")
    ))
}

/// A condition that was found false in parts is not asked again: it once nested without end.
#[test]
fn a_choice_that_fetches_is_decided_once() {
    for condition in ["x < 0.5 && y < 0.5 && q0", "x < 0.5 || y < 0.5 || q0", "!(x < y && side && q0) || q1 && x < 0.1"]
    {
        let value = format!("if {condition} {{ x }} else {{ y }}");
        let program = fetching(3, 2, |i, q| format!("x < {i} * y && q{q}"), &value);
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Switch] {
            Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

/// Many guards that may fetch, in one state: their number costs neither stack nor, where later
/// ones ask for other inputs, twice the steps for each.
#[test]
fn many_guards_may_fetch() {
    for (cases, fetched) in [(40, 40), (300, 1), (300, 2)] {
        let guard = |i: usize, q: usize| format!("x < {i} * y && q{q}");
        let program = fetching(cases, fetched, guard, "x");
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Switch] {
            let plan = Plan::new(&program, shape).unwrap_or_else(|e| panic!("{e}"));
            assert!(plan.steps.len() <= 12 * cases, "{shape} of {cases}: {} steps", plan.steps.len());
        }
    }
    let long: Vec<String> = (0..1000).map(|i| format!("(\"{i}\", \"x < {i} * y\")")).collect();
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)}},
            output: Number(), cases: [Case(id: 1, when: true, lines: [{}, 0])], default: 0)"#,
        long.join(", ")
    );
    Plan::proved(&program(&text), Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
}

/// At a point of each state a plan gives what the interpreter gives, and takes its case.
pub(super) fn agrees(plan: &Plan<'_>, random: &mut Random) {
    let walker = Walker::new(plan);
    let mut interpreter = Interpreter::<f32>::new(plan.program);
    for state in 0..plan.program.states.count() {
        let point = point(random, plan.program, state);
        let want = interpreter.evaluate(&point).unwrap_or_else(|e| panic!("{e:?}"));
        let Walked { row, values, .. } = walker.run(&point).expect("all inputs are given");
        assert!(!plan.reports_case() || row == want.row, "{} at {point:?}", plan.shape);
        let near = values.iter().zip(&want.values).all(|(a, b)| (a - b).abs() <= 1e-5);
        assert!(near, "{} at {point:?}: {values:?}, not {:?}", plan.shape, want.values);
    }
}

/// One coefficient, one entry of the lookup, one leaf, one order, one fetch.
#[test]
fn changed_plans_of_random_tables_are_refused() {
    let mut random = Random::new(11);
    let mut refused = [0; 7];
    for _ in 0..40 {
        let program = program(&table(&mut random));
        if let Ok(plan) = Plan::new(&program, Shape::Coefficients) {
            // Each set of coefficients is used by some state, and the clamp hides few changes.
            let mut broken = plan.clone();
            let fit = random.below(broken.coefficients.fits.len());
            for form in &mut broken.coefficients.fits[fit].pieces[0].forms {
                form.constant += 0.125;
            }
            let before = refused[0];
            refused[0] += usize::from(broken.prove().is_err());
            if refused[0] == before {
                let value =
                    plan.coefficients.fits[fit].pieces[0].forms.iter().all(|f| f.factors.iter().all(|f| *f == 0.0));
                assert!(value, "only a constant beyond the clamp may be changed");
            }
        }
        if let Ok(plan) = Plan::new(&program, Shape::Orbit) {
            for state in 0..plan.lookup.len() {
                let mut broken = plan.clone();
                // Another symmetry, so that inputs or result come out otherwise.
                broken.lookup[state] ^= 2;
                refused[1] += usize::from(broken.prove().is_err());
            }
        }
        for shape in [Shape::Ordered, Shape::Nested, Shape::Tree, Shape::Gathered, Shape::Orbit] {
            let Ok(plan) = Plan::new(&program, shape) else { continue };
            for step in plan.reachable() {
                let mut broken = plan.clone();
                let place = step.0 as usize;
                match broken.steps[place].clone() {
                    Step::Leaf(leaf) => {
                        let wrong = broken.pool.number(0.437_5);
                        broken.steps[place] = Step::Leaf(Leaf { values: vec![wrong], ..leaf });
                        refused[2] += usize::from(broken.prove().is_err());
                    }
                    Step::Test { condition, then, other } if then != other => {
                        // Two tests that follow each other, exchanged: refused, or it made no difference.
                        if let Step::Test { condition: second, then: there, other: rest } = *plan.step(other) {
                            let mut exchanged = plan.clone();
                            let behind = StepId(exchanged.steps.len() as u32);
                            exchanged.steps.push(Step::Test { condition, then, other: rest });
                            exchanged.steps[place] = Step::Test { condition: second, then: there, other: behind };
                            match exchanged.clone().prove() {
                                Err(_) => refused[6] += 1,
                                Ok(_) => agrees(&exchanged, &mut random),
                            }
                        }
                        broken.steps[place] = Step::Test { condition, then: other, other: then };
                        refused[3] += usize::from(broken.prove().is_err());
                    }
                    Step::Gather { input, condition, next } => {
                        // Never, always, and where it is not needed.
                        let (always, not) = (broken.pool.always(true), broken.pool.not(condition));
                        broken.steps[place] = broken.step(next).clone();
                        refused[4] += usize::from(broken.clone().prove().is_err());
                        for condition in [always, not] {
                            broken.steps[place] = Step::Gather { input, condition, next };
                            refused[5] += usize::from(broken.clone().prove().is_err());
                        }
                    }
                    Step::Test { .. }
                    | Step::Fetch { .. }
                    | Step::Switch { .. }
                    | Step::Coefficients { .. }
                    | Step::Orbit { .. } => {}
                }
            }
        }
    }
    assert!(refused.iter().all(|count| *count > 20), "{refused:?}");
}
