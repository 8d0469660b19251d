//! Statements of proofs about tables whose constants round, vanish or overflow in `f32`: each is tried in
//! the interpreter, in every state.

use super::{pick, point};
use crate::diag::Source;
use crate::eval::Interpreter;
use crate::plan::walk::Walker;
use crate::plan::{Plan, PlanOptions, Shape};
use crate::points::random::Random;
use crate::program::Program;
use crate::prove::is_unsuitable;
use crate::table::Table;

const NUMBERS: [&str; 16] = [
    "0", "1", "6", "16777216", "16777217", "1e-40", "1e-30", "1e30", "0.1", "0.3", "1.805", "0.5", "2", "3e38", "1e16",
    "0.7",
];
const CLAMPS: [&str; 5] = ["", "", "clamp: (-1e30, 1e30)", "clamp: (1e-40, 2)", "clamp: (-0.3, 16777217)"];
const RANGES: [&str; 3] = ["from: 0, to: 1", "from: -0.7, to: 0.9", "from: -1e30, to: 1e30"];
const RESULTS: [&str; 4] = ["", ", result: \"1 - value\"", ", result: \"-value\"", ", result: \"0.1 * value\""];

fn table(random: &mut Random) -> String {
    let guards = ["d in {a, b}", "e", "d == c && e", "f32(d) * 0.1 == 0.3", "x < 0.3", "!e || d == a"];
    let cases: Vec<String> = (1..=2 + random.below(3))
        .map(|id| match random.below(4) {
            0 if id > 1 => format!("Case(id: {id}, is: (case: 1, under: \"s\"))"),
            1 => format!(
                "Case(id: {id}, when: \"{} < {}\", value: \"{}\")",
                value(random, 1),
                value(random, 1),
                value(random, 2)
            ),
            _ => format!("Case(id: {id}, when: \"{}\", value: \"{}\")", pick(random, &guards), value(random, 3)),
        })
        .collect();
    format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"d": Levels(values: {{"a": 0, "b": 1, "c": 3}}), "e": Bool(), "x": Range({})}},
            symmetries: {{"s": Symmetry(map: {{"e": "!e"}}{}), "t": Symmetry(map: {{"d": {{"a": "b", "b": "c", "c": "a"}}}})}},
            output: Number({}), cases: [{}], default: "{}")"#,
        pick(random, &RANGES),
        pick(random, &RESULTS),
        pick(random, &CLAMPS),
        cases.join(", "),
        value(random, 2)
    )
}

fn value(random: &mut Random, depth: usize) -> String {
    let leaf = |random: &mut Random| match random.below(5) {
        0 | 1 => pick(random, &NUMBERS).to_owned(),
        2 => "x".to_owned(),
        _ => "f32(d)".to_owned(),
    };
    if depth == 0 {
        return leaf(random);
    }
    let mut part = || value(random, depth - 1);
    let (a, b, c) = (part(), part(), part());
    match random.below(12) {
        0 | 1 => format!("({a} + {b})"),
        2 | 3 => format!("({a} - {b})"),
        4 | 5 => format!("({a} * {b})"),
        6 => format!("({a} / {b})"),
        7 => format!("min({a}, {b})"),
        8 => format!("max(-{a}, {b})"),
        9 => format!("mix({a}, {b}, {c})"),
        10 => format!("(if d == b {{ {a} }} else {{ {b} }})"),
        _ => format!("clamp({a}, 0, 16777217)"),
    }
}

/// The statement of a proof holds of a value and the one that the table has.
fn is_said(statement: &crate::prove::Proof, got: f32, want: f32) -> bool {
    let same = got.to_bits() == want.to_bits() || got.is_nan() && want.is_nan();
    match (statement.identical == statement.paths, statement.rounding) {
        (true, _) => same,
        (false, Some(bound)) => same || (f64::from(got) - f64::from(want)).abs() <= bound,
        (false, None) => true,
    }
}

#[test]
fn what_a_proof_says_holds() {
    let mut random = Random::new(5);
    let (mut tables, mut same, mut apart) = (0, [0; Shape::ALL.len()], [0; Shape::ALL.len()]);
    for _ in 0..900 {
        let text = table(&mut random);
        let table = Table::parse(Source::new("test.ron", text.as_str())).unwrap_or_else(|e| panic!("{e}\n{text}"));
        // Some constants divide by zero or are no `f32`, and are refused.
        let Ok(program) = Program::check(&table) else { continue };
        tables += 1;
        let points: Vec<_> = (0..program.states.count())
            .flat_map(|state| [state; 4])
            .map(|state| point(&mut random, &program, state))
            .collect();
        for (number, shape) in Shape::ALL.into_iter().enumerate() {
            let proved = match Plan::proved(&program, PlanOptions::from(shape)) {
                Ok(proved) => proved,
                Err(failure) if is_unsuitable(&failure) => continue,
                Err(failure) => panic!("{shape}: {failure}\n{text}"),
            };
            let proof = proved.proof();
            match (proof.identical == proof.paths, proof.rounding) {
                (true, _) => same[number] += 1,
                (false, Some(_)) => apart[number] += 1,
                (false, None) => {}
            }
            let walker = Walker::new(proved.plan());
            let mut interpreter = Interpreter::<f32>::new(&program);
            for point in &points {
                let want = interpreter.evaluate(point).unwrap_or_else(|e| panic!("{e:?}"));
                let got = walker.run(point).unwrap_or_else(|e| panic!("{e:?}"));
                let said = is_said(proof, got.values[0], want.values[0]);
                assert!(said, "{shape}: {got:?}, not {want:?} at {point:?}: {proof}\n{text}");
            }
        }
    }
    assert!(tables > 300 && same.iter().sum::<i32>() > 1000, "{tables} tables, {same:?}, {apart:?}");
    let [coefficients, orbit] = [Shape::Coefficients, Shape::Orbit].map(|shape| apart[shape as usize]);
    assert!(coefficients > 20 && orbit > 20, "{same:?}, {apart:?}");
}

fn plan_of(text: &str, shape: Shape) -> String {
    let table = Table::parse(Source::new("test.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
    match Plan::proved(&program, shape) {
        Ok(proved) => proved.proof().to_string(),
        Err(failure) => failure.to_string(),
    }
}

/// Values in which constants are computed otherwise in `f32` than over the reals get no coefficients.
#[test]
fn coefficients_stand_for_sums_only() {
    let text = |value: &str, clamp: &str| {
        format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"d": Levels(values: {{"a": 0, "b": 1, "c": 2}}), "x": Range(from: 0, to: 1)}}, output: Number({clamp}),
                cases: [Case(id: 1, when: "d in {{a, b}}", value: "{value}")], default: "x")"#
        )
    };
    let same = "equal to the table on 3 states, 3 paths; the same operations on";
    assert_eq!(
        plan_of(&text("(f32(d) + 16777216) - 16777216", ""), Shape::Coefficients),
        format!("{same} 1, on the others equal over the reals and at most 1.8e-7 apart in f32")
    );
    // Limits that no fraction of 127 bits is.
    for clamp in ["clamp: (-1e30, 1e30)", "clamp: (1e-40, 2)"] {
        let proof = plan_of(&text("0.5", clamp), Shape::Coefficients);
        assert!(proof.starts_with(same) && proof.contains("apart in f32"), "{clamp}: {proof}");
    }
}
