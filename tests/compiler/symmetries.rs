//! The one meaning of a symmetry, `V(x) = R(V(m(x)))`, asked of everything that uses it: derived cases,
//! symbolic runs, findings and plans, in random tables, by enumeration. The maps lead anywhere, and results
//! have no inverse or another one.

use umbrage::analyse::{self, trial};
use umbrage::diag::{Source, codes};
use umbrage::eval::Interpreter;
use umbrage::plan::walk::Walker;
use umbrage::plan::{Plan, Shape};
use umbrage::points::random::Random;
use umbrage::program::{LevelTerm, Program, Value};
use umbrage::prove::is_unsuitable;
use umbrage::table::Table;

const LEVELS: [&str; 3] = ["a", "b", "c"];
/// A result as a table writes it, and what it does.
type Result = (&'static str, fn(f64) -> f64);

const RESULTS: [Result; 6] = [
    ("value", |v| v),
    ("1 - value", |v| 1.0 - v),
    ("2 * value", |v| 2.0 * v),
    ("0", |_| 0.0),
    ("value + 1", |v| v + 1.0),
    ("-0.5 * value", |v| -0.5 * v),
];

/// A table, and what becomes of results.
fn table(random: &mut Random) -> (String, fn(f64) -> f64) {
    let map: Vec<String> = LEVELS.iter().map(|level| format!("\"{level}\": \"{}\"", pick(random, &LEVELS))).collect();
    let also = pick(random, &["", ", \"e\": \"!e\"", ", \"x\": \"-x\"", ", \"x\": \"-x\", \"e\": \"true\""]);
    let (result, apply) = RESULTS[random.below(RESULTS.len())];
    let values = ["x", "2 * x", "4 * x", "0", "1", "0.5", "1 - x", "x + 1", "-0.5 * x"];
    let cases: Vec<String> = (1..=1 + random.below(4))
        .map(|id| match random.below(3) {
            0 if id > 1 => format!("Case(id: {id}, is: (case: 1, under: \"s\"))"),
            _ => {
                let guard = match random.below(3) {
                    0 => format!("d == {}", pick(random, &LEVELS)),
                    1 => format!("d == {} && e", pick(random, &LEVELS)),
                    _ => format!("d != {} || !e", pick(random, &LEVELS)),
                };
                format!("Case(id: {id}, when: \"{guard}\", value: \"{}\")", pick(random, &values))
            }
        })
        .collect();
    let text = format!(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {{"d": Levels(values: {{"a": 0, "b": 1, "c": 2}}), "e": Bool(), "x": Range(from: -1, to: 1)}},
            symmetries: {{"s": Symmetry(map: {{"d": {{{}}}{also}}}, result: "{result}")}},
            output: Number(), cases: [{}], default: "{}")"#,
        map.join(", "),
        cases.join(", "),
        pick(random, &values)
    );
    (text, apply)
}

fn pick<'a>(random: &mut Random, list: &[&'a str]) -> &'a str {
    list[random.below(list.len())]
}

fn program(text: &str) -> Program {
    let table = Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table));
    table.unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The findings that say that the symmetry is broken.
fn found(program: &Program) -> Vec<String> {
    let broken = analyse::findings(program).into_iter().filter(|found| found.code == codes::SYMMETRY_BROKEN);
    broken.map(|found| found.message).collect()
}

type Point = Vec<Option<Value>>;

/// Points that tell all of these values from each other.
fn points(program: &Program, state: usize) -> Vec<Point> {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let of = |x| vec![Some(Value::Level(levels[0])), Some(Value::Level(levels[1])), Some(Value::Number(x))];
    [-0.625, 0.0, 0.375, 1.0].map(of).to_vec()
}

/// The image of a point, computed from the declaration alone.
fn image(program: &Program, point: &Point) -> Point {
    fn level(program: &Program, term: &LevelTerm, point: &Point) -> u8 {
        match term {
            LevelTerm::Const(level) => *level,
            LevelTerm::Input(input) => match point[input.index()] {
                Some(Value::Level(level)) => level,
                _ => panic!("no level"),
            },
            LevelTerm::If(condition, then, other) => {
                let mut interpreter = Interpreter::<f64>::new(program);
                interpreter.place(point).expect("all inputs are given");
                level(program, if interpreter.holds(*condition).expect("given") { then } else { other }, point)
            }
            LevelTerm::Map(inner, renaming) => renaming[usize::from(level(program, inner, point))],
        }
    }
    let symmetry = &program.symmetries[0];
    let mut image = point.clone();
    for (input, term) in &symmetry.levels {
        image[input.index()] = Some(Value::Level(level(program, term, point)));
    }
    for (input, number) in &symmetry.numbers {
        let mut interpreter = Interpreter::<f64>::new(program);
        interpreter.place(point).expect("all inputs are given");
        image[input.index()] = Some(Value::Number(interpreter.number(*number).expect("given")));
    }
    image
}

#[test]
fn a_symmetry_has_one_meaning() {
    let mut random = Random::new(3);
    let (mut held, mut broken, mut derived, mut turned) = (0, 0, 0, 0);
    for _ in 0..400 {
        let (text, apply) = table(&mut random);
        let program = program(&text);
        let value = |point: &Point| {
            let outcome = Interpreter::<f64>::new(&program).evaluate(point).expect("all inputs are given");
            (outcome.row, outcome.values[0])
        };
        let violations = trial::violations(&program, &program.symmetries[0]);
        let mut has_everywhere = true;
        for state in 0..program.states.count() {
            let mut has = true;
            for point in points(&program, state) {
                let (row, here) = value(&point);
                let said = apply(value(&image(&program, &point)).1);
                has &= here == said;
                // A derived case is made by the equation: case 1 at the image, mapped.
                let id = row.map(|row| program.rows[row].id);
                if text.contains(&format!("Case(id: {}, is:", id.unwrap_or(0))) {
                    derived += 1;
                    let of = image(&program, &point);
                    let mut interpreter = Interpreter::<f64>::new(&program);
                    interpreter.place(&of).expect("all inputs are given");
                    assert_eq!(interpreter.holds(program.rows[0].guard), Ok(true), "{text}");
                    let case = interpreter.number(program.rows[0].lines[0].values[0]).expect("given");
                    assert_eq!(here, apply(case), "{point:?}\n{text}");
                }
            }
            let differs = violations.iter().any(|violation| violation.state == state);
            assert_eq!(!differs, has, "state {state} of\n{text}");
            has_everywhere &= has;
            *(if has { &mut held } else { &mut broken }) += 1;
        }
        let findings = found(&program);
        assert_eq!(findings.is_empty(), has_everywhere, "{findings:?}\n{text}");
        let proved = match Plan::proved(&program, Shape::Orbit) {
            Ok(proved) => proved,
            Err(failure) if is_unsuitable(&failure) => continue,
            Err(failure) => panic!("{failure}\n{text}"),
        };
        turned += 1;
        let walker = Walker::new(proved.plan());
        for point in (0..program.states.count()).flat_map(|state| points(&program, state)) {
            let want = Interpreter::<f32>::new(&program).evaluate(&point).expect("given").values[0];
            let got = walker.run(&point).expect("all inputs are given").values[0];
            assert!((got - want).abs() <= 1e-6, "{got}, not {want}, at {point:?}\n{text}");
        }
    }
    assert!(held > 300 && broken > 300 && derived > 50 && turned > 50, "{held} {broken} {derived} {turned}");
}

/// A renaming that leads both levels to one, and a result without an inverse.
#[test]
fn a_result_without_inverse_turns_nothing_back() {
    let text = r#"Table(language: 1, name: "t", hit_policy: First,
        inputs: {"d": Levels(values: {"a": 0, "b": 1})},
        symmetries: {"s": Symmetry(map: {"d": {"b": "a"}}, result: "0")},
        output: Number(), cases: [Case(id: 8, when: "d == b", value: "1")], default: "0")"#;
    assert_eq!(found(&program(text)), ["case 8 and the default contradict each other as images"]);
    let failure = Plan::proved(&program(text), Shape::Orbit).unwrap_err();
    assert!(
        failure.to_string().contains("none of its symmetries turns a state into another one where the table has it"),
        "{failure}"
    );
    // Where the image is zero, it is as the symmetry says.
    let proved = program(&text.replace("value: \"1\"", "value: \"0\""));
    let proved = Plan::proved(&proved, Shape::Orbit).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(proved.proof().states, 2);
}
