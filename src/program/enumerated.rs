//! Random small tables, and what planner and prover both use of this module tried at every point of them.
//!
//! All comparisons of these tables are between numbers that differ by multiples of a quarter of `x`, `y`, `x - y`
//! or `x + y`, so that points in steps of a sixteenth meet every cell that they cut the square into, its edges and
//! corners included; and every number is a short binary fraction, so that the interpreter in `f64` is exact.

use super::claims::{Boxes, Candidates, Claim, Claims, decide};
use super::symbolic::Machine;
use super::turn::{Turn, image_of_state, is_usable};
use super::{Domain, InputId, InputSet, LevelTerm, Program, Symmetry, Value, reachable};
use crate::eval::Interpreter;
use crate::points::random::Random;

/// A value for every input.
pub(super) type Point = Vec<Option<Value>>;

fn pick<'a>(random: &mut Random, list: &[&'a str]) -> &'a str {
    list[random.below(list.len())]
}

/// A number whose differences to the others of its kind change sign only on those lines.
fn number(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        return pick(random, &["x", "y", "1 - x", "1 - y", "0", "0.25", "0.5", "1", "x + 0.25", "y - 0.5"]).to_owned();
    }
    let (a, b) = (number(random, depth - 1), number(random, depth - 1));
    match random.below(6) {
        0 => format!("min({a}, {b})"),
        1 => format!("max({a}, {b})"),
        2 => format!("clamp({a}, 0.25, 0.75)"),
        3 => format!("(if {} {{ {a} }} else {{ {b} }})", condition(random, 1)),
        _ => a,
    }
}

fn condition(random: &mut Random, depth: usize) -> String {
    if depth == 0 {
        return match random.below(9) {
            0 => format!("s == {}", pick(random, &["lo", "mid", "hi"])),
            1 => format!("s in {{{}, hi}}", pick(random, &["lo", "mid"])),
            2 => pick(random, &["a", "!a", "f", "!f"]).to_owned(),
            3 => format!("g == {}", pick(random, &["lo", "mid", "hi"])),
            4 => "s == g".to_owned(),
            5 => format!("x + y {} {}", pick(random, &["<", "<=", "=="]), pick(random, &["0.75", "1", "1.5"])),
            6 => format!("x - y {} {}", pick(random, &["<", "<="]), pick(random, &["0", "0.25", "-0.5"])),
            _ => format!("{} {} {}", number(random, 0), pick(random, &["<", "<=", "=="]), number(random, 0)),
        };
    }
    let (a, b, c) = (condition(random, depth - 1), condition(random, depth - 1), condition(random, 0));
    match random.below(6) {
        0 | 1 => format!("({a} && {b})"),
        2 | 3 => format!("({a} || {b})"),
        4 => format!("!({a})"),
        _ => format!("(if {c} {{ {a} }} else {{ {b} }})"),
    }
}

/// A table with states, fetched levels, numbers, assumptions and symmetries.
pub(super) fn table(random: &mut Random) -> Program {
    let cases: Vec<String> = (1..=2 + random.below(4))
        .map(|id| match random.below(3) {
            0 => format!(
                "Case(id: {id}, when: \"{}\", lines: [(\"{}\", \"{}\"), \"{}\"])",
                condition(random, 1),
                number(random, 1),
                condition(random, 1),
                number(random, 1)
            ),
            _ => format!("Case(id: {id}, when: \"{}\", value: \"{}\")", condition(random, 2), number(random, 2)),
        })
        .collect();
    let levels = pick(
        random,
        &[
            "\"s\": {\"lo\": \"hi\", \"hi\": \"lo\"}, \"g\": {\"lo\": \"hi\", \"hi\": \"lo\"}",
            "\"s\": {\"lo\": \"mid\", \"mid\": \"hi\", \"hi\": \"lo\"}",
            "\"a\": \"!a\", \"f\": \"f\"",
            "\"s\": {\"mid\": \"lo\"}, \"g\": {\"mid\": \"lo\"}, \"a\": \"s == lo\"",
        ],
    );
    let numbers = pick(random, &["\"x\": \"1 - x\"", "\"x\": \"y\", \"y\": \"x\"", "\"y\": \"1 - y\", \"x\": \"x\""]);
    let result = pick(random, &["value", "1 - value", "2 * value", "value + 0.25"]);
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            levels: {{"height": {{"lo": 0, "mid": 1, "hi": 2}}}},
            inputs: {{
                "a": Bool(), "s": Levels(of: "height"), "f": Bool(fetched: (cost: 1)),
                "g": Levels(of: "height", fetched: (cost: 1)), "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1),
            }},
            symmetries: {{
                "one": Symmetry(map: {{{levels}}}, result: "{result}"),
                "two": Symmetry(map: {{{numbers}}}),
                "three": Symmetry(map: {{"a": "!a", "x": "1 - x", "y": "1 - y"}}, result: "1 - value"),
            }},
            assume: {{"p": "{}", "q": "{}"}},
            output: Number(), cases: [{}], default: "{}")"#,
        condition(random, 1),
        condition(random, 2),
        cases.join(", "),
        number(random, 1)
    );
    let table = crate::table::Table::parse(crate::diag::Source::new("t.ron", text.as_str()));
    table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The points of a state: all fetched levels, and the square in steps of a part.
pub(super) fn points(program: &Program, state: usize, steps: usize) -> Vec<Point> {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let mut points: Vec<Point> = vec![Vec::new()];
    for (id, input) in program.input_ids() {
        let values: Vec<Value> = match (&input.domain, input.fetched) {
            (Domain::Discrete(_), None) => vec![Value::Level(levels[id.index()])],
            (Domain::Discrete(levels), Some(_)) => (0..levels.count()).map(|l| Value::Level(l as u8)).collect(),
            (Domain::Word, _) => unreachable!("there is none"),
            (Domain::Continuous { lo, hi, .. }, _) => {
                (0..=steps).map(|i| Value::Number(lo + (hi - lo) * i as f64 / steps as f64)).collect()
            }
        };
        let with = |point: &Point, value| point.iter().copied().chain([Some(value)]).collect();
        points = points.iter().flat_map(|point| values.iter().map(move |value| with(point, *value))).collect();
    }
    points
}

pub(super) fn level(point: &Point, input: InputId) -> u8 {
    match point[input.index()] {
        Some(Value::Level(level)) => level,
        _ => 0,
    }
}

/// An interpreter at a point.
pub(super) fn at<'p>(program: &'p Program, point: &Point) -> Interpreter<'p, f64> {
    let mut interpreter = Interpreter::new(program);
    interpreter.place(point).unwrap_or_else(|e| panic!("{e:?}"));
    interpreter
}

/// The image of a point, by the declaration alone.
fn image(program: &Program, symmetry: &Symmetry, point: &Point) -> Point {
    fn of(program: &Program, term: &LevelTerm, point: &Point) -> u8 {
        match term {
            LevelTerm::Const(level) => *level,
            LevelTerm::Input(input) => level(point, *input),
            LevelTerm::If(condition, then, other) => {
                let holds = at(program, point).holds(*condition).unwrap_or_else(|e| panic!("{e:?}"));
                of(program, if holds { then } else { other }, point)
            }
            LevelTerm::Map(inner, renaming) => renaming[usize::from(of(program, inner, point))],
        }
    }
    let mut image = point.clone();
    for (input, term) in &symmetry.levels {
        image[input.index()] = Some(Value::Level(of(program, term, point)));
    }
    for (input, number) in &symmetry.numbers {
        let value = at(program, point).number(*number).unwrap_or_else(|e| panic!("{e:?}"));
        image[input.index()] = Some(Value::Number(value));
    }
    image
}

#[test]
fn decisions_and_claims_are_those_of_enumeration() {
    let mut random = Random::new(21);
    let (mut decided, mut open) = (0, 0);
    for _ in 0..60 {
        let program = table(&mut random);
        let claims = Claims::new(&program).unwrap_or_else(|| panic!("few"));
        let candidates = Candidates::new(&program);
        let mut levels = vec![0; program.inputs.len()];
        for state in 0..program.states.count() {
            program.states.write(state, &mut levels);
            let points = points(&program, state, 4);
            let mut expected = Vec::new();
            for (row, case) in program.rows.iter().enumerate() {
                let decision = decide(&program, &program.pool, case.guard, &levels);
                let mut holds = points.iter().map(|point| at(&program, point).holds(case.guard) == Ok(true));
                match decision {
                    Some(value) => {
                        decided += 1;
                        assert!(holds.all(|holds| holds == value), "case {} in state {state}", case.id);
                    }
                    None => open += 1,
                }
                if decision != Some(false) {
                    expected.push(Claim { row, always: decision == Some(true) });
                }
            }
            assert!(claims.of(state).eq(expected.iter().copied()), "state {state}");
            // The rows to look at are enough to find the one that is taken, and what is fetched on the way.
            for point in &points {
                let want = at(&program, point).evaluate(point).unwrap_or_else(|e| panic!("{e:?}"));
                let mut interpreter = at(&program, point);
                let mut rows = candidates.of(state);
                let taken = rows.find(|row| interpreter.holds(program.rows[*row].guard) == Ok(true));
                assert_eq!(taken, want.row, "state {state}");
                let upto = |row: &usize| want.row.is_none_or(|taken| *row <= taken);
                let through: Vec<usize> = candidates.of(state).filter(upto).collect();
                let every: Vec<usize> = (0..program.rows.len()).filter(upto).collect();
                assert_eq!(asked(&program, point, &through), asked(&program, point, &every), "state {state}");
            }
        }
        boxes_visit_every_state(&program);
    }
    assert!(decided > 300 && open > 300, "{decided} {open}");
}

/// The fetched inputs that the guards of some rows ask for at a point.
fn asked(program: &Program, point: &Point, rows: &[usize]) -> InputSet {
    let is_asked = |input: &InputId| {
        // Absent, it is missed.
        let mut without = point.clone();
        without[input.index()] = None;
        let mut interpreter = at(program, &without);
        rows.iter().any(|row| interpreter.holds(program.rows[*row].guard).is_err())
    };
    program.fetched.iter().filter(is_asked).fold(InputSet::default(), |all, input| all.or(InputSet::one(input)))
}

/// A condition is looked at once in each state in which it may hold.
fn boxes_visit_every_state(program: &Program) {
    let mut levels = vec![0; program.inputs.len()];
    let conditions = program.rows.iter().map(|row| row.guard).chain(program.assumptions.iter().map(|a| a.condition));
    for condition in conditions {
        let mut visited = std::collections::BTreeMap::new();
        let mut boxes = Boxes::new(program);
        boxes.each(&program.pool, condition, &mut |state, holds| {
            assert_eq!(visited.insert(state, holds), None, "state {state} is visited once");
        });
        assert!(visited.len() == boxes.size(&program.pool, condition));
        for state in 0..program.states.count() {
            program.states.write(state, &mut levels);
            let decision = decide(program, &program.pool, condition, &levels);
            let expected = if visited.contains_key(&state) { Some(decision) } else { None };
            assert_eq!(visited.get(&state).copied(), expected);
            assert!(decision == Some(false) || expected.is_some(), "state {state} is left out");
        }
    }
}

#[test]
fn reachable_states_are_those_of_enumeration() {
    let mut random = Random::new(22);
    let (mut some, mut none) = (0, 0);
    for _ in 0..60 {
        let program = table(&mut random);
        let occurs = |state: &usize| {
            let admitted = |point: &Point| {
                let mut interpreter = at(&program, point);
                program.assumptions.iter().all(|assumption| interpreter.holds(assumption.condition) == Ok(true))
            };
            points(&program, *state, 16).iter().any(admitted)
        };
        let expected: Vec<usize> = (0..program.states.count()).filter(occurs).collect();
        some += expected.len();
        none += program.states.count() - expected.len();
        assert_eq!(reachable(&program), expected);
    }
    assert!(some > 100 && none > 30, "{some} {none}");
}

#[test]
fn turns_are_those_of_enumeration() {
    let mut random = Random::new(23);
    let mut compared = 0;
    for _ in 0..40 {
        let program = table(&mut random);
        let usable: Vec<usize> =
            (0..program.symmetries.len()).filter(|index| is_usable(&program, &program.symmetries[*index])).collect();
        assert!(usable.len() >= 2, "{usable:?}");
        let mut machine = Machine::new(&program);
        for state in 0..program.states.count() {
            for word in 0..1_usize << usable.len() {
                let used =
                    || usable.iter().enumerate().filter(|(bit, _)| word >> bit & 1 == 1).map(|(_, index)| *index);
                let turn = Turn::new(&program, machine.pool(), &usable, word, state);
                let turn = turn.unwrap_or_else(|| panic!("all of them are usable"));
                // The value that the symmetries say, by their equation: images in order, results in reverse.
                let said = |point: &Point| {
                    let turned = used().fold(point.clone(), |p, index| image(&program, &program.symmetries[index], &p));
                    let outcome = at(&program, &turned).evaluate(&turned).unwrap_or_else(|e| panic!("{e:?}"));
                    let maps = used().collect::<Vec<_>>().into_iter().rev();
                    let maps = maps.filter_map(|index| program.symmetries[index].result.as_ref());
                    (turned, maps.fold(outcome.values[0], |value, map| mapped(&program, map[0], value)))
                };
                let after =
                    used().try_fold(state, |at, index| image_of_state(&program, &program.symmetries[index], at));
                let points = points(&program, state, 4);
                for point in &points {
                    let (turned, _) = said(point);
                    assert_eq!(after, Some(program.states.index(|input| level(&turned, input))));
                }
                machine.any_path(state, |machine| {
                    let values = turn.said(machine);
                    for point in points.iter().filter(|point| machine.is_at(point)) {
                        compared += 1;
                        assert_eq!(machine.value_at(values[0], point), said(point).1, "state {state}, word {word}");
                    }
                    std::ops::ControlFlow::Continue(())
                });
                sources_are_what_images_depend_on(&program, &turn, &points, &said);
            }
        }
    }
    assert!(compared > 20_000, "{compared}");
}

/// A fetched input of the image changes with those behind it only.
fn sources_are_what_images_depend_on(
    program: &Program,
    turn: &Turn,
    points: &[Point],
    said: &dyn Fn(&Point) -> (Point, f64),
) {
    for input in program.fetched.iter() {
        let sources = turn.sources(&program.pool, input);
        let mut seen = std::collections::HashMap::new();
        for point in points {
            let key: Vec<u8> = sources.iter().map(|source| level(point, source)).collect();
            let image = level(&said(point).0, input);
            assert_eq!(*seen.entry(key).or_insert(image), image, "{}", program.inputs[input.index()].name);
        }
    }
}

/// A result map at a value.
fn mapped(program: &Program, map: super::ExprId, value: f64) -> f64 {
    use super::Node;
    match program.pool.node(map) {
        Node::Result(_) => value,
        Node::Const(number) => number.get(),
        Node::Binary(op, a, b) => op.apply(mapped(program, a, value), mapped(program, b, value)),
        Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Unary(..) | Node::Ternary(..) | Node::Select(..) => {
            panic!("these maps are sums")
        }
    }
}
