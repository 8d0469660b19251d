//! What WGSL admits, against what the interpreters compute.

use crate::support::parsed;
use proptest::prelude::*;
use umbrage::diag::Source;
use umbrage::eval::{Interpreter, Interval, IntervalInterpreter, NeedsFetch};
use umbrage::program::{BinaryOp, Domain, InputId, Program, Real, TernaryOp, UnaryOp, Value};
use umbrage::table::Table;

/// Both interpreters agree with the intervals at a point; returns how many outcomes are admissible there.
fn agree(
    program: &Program,
    intervals: &mut IntervalInterpreter<'_>,
    point: &[Option<Value>],
) -> Result<usize, NeedsFetch> {
    let narrow = Interpreter::<f32>::new(program).evaluate(point)?;
    let all = intervals.admissible(point).unwrap();
    assert!(all.contains(narrow.row, &narrow.values), "f32: {narrow:?} not in {all:?} at {point:?}");
    if let Ok(wide) = Interpreter::<f64>::new(program).evaluate(point) {
        let values: Vec<f32> = wide.values.iter().map(|v| *v as f32).collect();
        assert!(all.contains(wide.row, &values), "f64: {wide:?} not in {all:?} at {point:?}");
    }
    Ok(all.outcomes.len())
}

fn table(path: &str) {
    let program = Program::read(path).unwrap();
    let mut intervals = IntervalInterpreter::new(&program);
    let mut levels = vec![0; program.inputs.len()];
    let mut seed = 12345_u32;
    let mut random = move |bound: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % bound
    };
    for state in 0..program.states.count() {
        program.states.write(state, &mut levels);
        for _ in 0..6 {
            let value = |(id, input): (InputId, &umbrage::program::Input)| {
                Some(match &input.domain {
                    Domain::Discrete(_) if input.fetched.is_none() => Value::Level(levels[id.index()]),
                    Domain::Discrete(all) => Value::Level(random(all.count() as u32) as u8),
                    Domain::Word => Value::Number(f64::from(random(u32::MAX))),
                    // Many ties between distances, and values that do not subtract exactly.
                    Domain::Continuous { .. } => Value::Number(f64::from(random(11) as f32 / 10.0)),
                })
            };
            let point: Vec<_> = program.input_ids().map(value).collect();
            agree(&program, &mut intervals, &point).unwrap();
        }
    }
}

#[test]
fn smsr() {
    table("tables/smsr.ron");
}

#[test]
fn rsmss() {
    table("tables/rsmss.ron");
}

/// Case 9 of SMSR, `1 - py < dH`: lines 0 and 1 are both right exactly where rounding decides.
#[test]
fn a_boundary_is_open_only_where_rounding_decides() {
    let program = Program::read("tables/smsr.ron").unwrap();
    let row = program.rows.iter().position(|row| row.id == 9);
    let mut intervals = IntervalInterpreter::new(&program);
    let mut at = |py: f32, dh: f32| {
        let mut point: Vec<_> = program.inputs.iter().map(|input| input.default).collect();
        let mut set = |name: &str, value| point[program.input(name).unwrap().index()] = Some(value);
        let bottom = program.levels(program.input("V").unwrap()).unwrap().find("bottom").unwrap();
        set("V", Value::Level(bottom));
        set("py", Value::Number(f64::from(py)));
        set("dH", Value::Number(f64::from(dh)));
        agree(&program, &mut intervals, &point).unwrap();
        let all = intervals.admissible(&point).unwrap();
        assert!(!all.contains(row, &[0.5]) && !all.contains(None, &[1.0]));
        (all.contains(row, &[0.0]), all.contains(row, &[1.0]))
    };
    // 1 - 0.25 is exact: only a larger `dH` closes the gap.
    assert_eq!(at(0.25, 0.75), (false, true));
    assert_eq!(at(0.25, 0.75_f32.next_up()), (true, false));
    // 1 - 0.1 lies between two numbers, `below` and `above`.
    let exact = 1.0 - f64::from(0.1_f32);
    let near = exact as f32;
    let (below, above) = if f64::from(near) < exact { (near, near.next_up()) } else { (near.next_down(), near) };
    assert_eq!(at(0.1, below), (false, true));
    assert_eq!(at(0.1, above), (true, true));
    assert_eq!(at(0.1, above.next_up()), (true, false));
}

const LAZY: &str = r#"Table(language: 1, name: "t", hit_policy: First,
    inputs: {
        "x": Range(from: 0, to: 1),
        "f": Levels(values: {"lo": 0, "hi": 1}, fetched: (cost: 1)),
    },
    output: Number(),
    cases: [Case(id: 1, when: "x * 0.1 < 0.05 && f == hi", value: 0.5)],
    default: 0.25)"#;

#[test]
fn an_absent_input_fails_only_if_the_exact_evaluation_needs_it() {
    let program = parsed(LAZY);
    let mut intervals = IntervalInterpreter::new(&program);
    let mut at = |x: f32, f: Option<u8>| {
        intervals.admissible(&[Some(Value::Number(f64::from(x))), f.map(Value::Level)]).map(|all| all.outcomes.len())
    };
    assert_eq!(at(0.25, None), Err(NeedsFetch(InputId::new(1))));
    assert_eq!(at(0.75, None), Ok(1));
    // At the boundary the exact evaluation does not need it, another one would.
    let exact = Interpreter::<f32>::new(&program).evaluate(&[Some(Value::Number(0.5)), None]);
    assert_eq!(exact.map(|o| o.row), Ok(None));
    assert_eq!(at(0.5, None), Ok(1));
    assert_eq!(at(0.5, Some(1)), Ok(2));
}

#[test]
fn jumps_admit_both_sides_and_nothing_between() {
    let program = parsed(
        r#"Table(language: 1, name: "t", hit_policy: First, inputs: { "x": Range(from: 0, to: 1) }, output: Number(),
            cases: [Case(id: 1, when: "x >= 0", value: "step(0.9, 1 - x) + floor(x)")], default: 0)"#,
    );
    let mut intervals = IntervalInterpreter::new(&program);
    let all = intervals.admissible(&[Some(Value::Number(f64::from(0.1_f32)))]).unwrap();
    let has = |value| all.contains(Some(0), &[value]);
    assert!(has(0.0) && has(1.0) && !has(0.5) && !all.everything);
}

#[test]
fn too_many_forks_admit_everything() {
    let terms: Vec<String> = (0..12).map(|k| format!("step({}, x * 0.1)", 0.05 + f64::from(k) * 1e-10)).collect();
    let program = parsed(format!(
        r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{ "x": Range(from: 0, to: 1) }}, output: Number(),
            cases: [Case(id: 1, when: "x >= 0", value: "{}")], default: 0)"#,
        terms.join(" + ")
    ));
    let all = IntervalInterpreter::new(&program).admissible(&[Some(Value::Number(0.5))]).unwrap();
    assert!(all.everything && all.contains(None, &[f32::NAN]));
}

/// An operand: a few neighbouring numbers, and the interval of them.
fn operand() -> impl Strategy<Value = (Vec<f32>, Interval)> {
    let special = prop::sample::select(vec![
        0.0_f32,
        1.0,
        -1.0,
        0.5,
        2.0,
        -0.5,
        0.1,
        1.0_f32.next_down(),
        2.0_f32.next_down(),
        1e-40,
        f32::MIN_POSITIVE,
        3.0e38,
        std::f32::consts::PI,
    ]);
    let any = prop_oneof![2 => special, 4 => -4.0_f32..4.0, 1 => -100.0_f32..100.0, 1 => any::<f32>()];
    (any.prop_filter("finite", |x| x.is_finite()), 0_usize..4).prop_map(|(start, more)| {
        let mut numbers = vec![start];
        for _ in 0..more {
            let next = numbers[numbers.len() - 1].next_up();
            numbers.extend(next.is_finite().then_some(next));
        }
        let ends = [numbers[0], numbers[numbers.len() - 1]].map(Interval::exactly);
        (numbers, ends[0].hull(ends[1]))
    })
}

/// A wide operand: an interval, and numbers of it.
fn wide() -> impl Strategy<Value = (Vec<f32>, Interval)> {
    let width = prop_oneof![2 => 0.0_f32..1.0, 2 => 0.0_f32..10.0, 1 => 0.0_f32..1000.0];
    (-8.0_f32..8.0, width, prop::collection::vec(0.0_f32..=1.0, 6)).prop_map(|(lo, width, shares)| {
        let hi = lo + width;
        let numbers = shares.into_iter().map(|share| (lo + share * width).clamp(lo, hi));
        (numbers.chain([lo, hi]).collect(), Interval::exactly(lo).hull(Interval::exactly(hi)))
    })
}

/// The operations on numbers; those on words, which `f32` carries otherwise, have tests of their own.
fn unary_of_numbers() -> impl Iterator<Item = UnaryOp> {
    UnaryOp::ALL.iter().copied().filter(|op| !op.row().gives_word && *op != UnaryOp::NumberOfWord)
}

fn binary_of_numbers() -> impl Iterator<Item = BinaryOp> {
    BinaryOp::ALL.iter().copied().filter(|op| !op.row().is_on_words)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// The exact result, rounded once or not at all, is admissible for every operation and operand.
    #[test]
    fn operations_contain_their_results((xs, x) in operand(), (ys, y) in operand(), (zs, z) in operand()) {
        for op in unary_of_numbers() {
            let all = Interval::unary(op, x);
            for x in &xs {
                let wide = f64::unary(op, f64::from(*x)) as f32;
                prop_assert!(all.contains(f32::unary(op, *x)) && all.contains(wide), "{op:?} {x:e}: {all:?}");
            }
        }
        for op in binary_of_numbers() {
            let all = Interval::binary(op, x, y);
            for (x, y) in xs.iter().flat_map(|x| ys.iter().map(move |y| (*x, *y))) {
                let wide = f64::binary(op, f64::from(x), f64::from(y)) as f32;
                prop_assert!(all.contains(f32::binary(op, x, y)) && all.contains(wide), "{op:?} {x:e} {y:e}: {all:?}");
            }
        }
        for op in TernaryOp::ALL.iter().copied() {
            let all = Interval::ternary(op, x, y, z);
            for (x, y) in xs.iter().flat_map(|x| ys.iter().map(move |y| (*x, *y))) {
                for z in &zs {
                    let wide = f64::ternary(op, f64::from(x), f64::from(y), f64::from(*z)) as f32;
                    let narrow = f32::ternary(op, x, y, *z);
                    prop_assert!(all.contains(narrow) && all.contains(wide), "{op:?} {x:e} {y:e} {z:e}: {all:?}");
                }
            }
        }
    }

    /// The same for wide intervals, at points inside of them.
    #[test]
    fn wide_intervals_contain_the_results_inside((xs, x) in wide(), (ys, y) in wide(), (zs, z) in wide()) {
        for op in unary_of_numbers() {
            let all = Interval::unary(op, x);
            for x in &xs {
                prop_assert!(all.contains(f32::unary(op, *x)), "{op:?} {x:e}: {all:?}");
            }
        }
        for op in binary_of_numbers() {
            let all = Interval::binary(op, x, y);
            for (x, y) in xs.iter().flat_map(|x| ys.iter().map(move |y| (*x, *y))) {
                prop_assert!(all.contains(f32::binary(op, x, y)), "{op:?} {x:e} {y:e}: {all:?}");
            }
        }
        for op in TernaryOp::ALL.iter().copied() {
            let all = Interval::ternary(op, x, y, z);
            for (x, (y, z)) in xs.iter().flat_map(|x| ys.iter().zip(&zs).map(move |rest| (*x, rest))) {
                prop_assert!(all.contains(f32::ternary(op, x, *y, *z)), "{op:?} {x:e} {y:e} {z:e}: {all:?}");
            }
        }
    }

    /// A single basic operation admits the two neighbours of its exact result and nothing else.
    #[test]
    fn basic_operations_are_as_tight_as_the_rules(x in -4.0_f32..4.0, y in -4.0_f32..4.0) {
        for op in [BinaryOp::Add, BinaryOp::Subtract, BinaryOp::Multiply] {
            let all = Interval::binary(op, Interval::exactly(x), Interval::exactly(y));
            let (exact, near) = (f64::binary(op, f64::from(x), f64::from(y)), f32::binary(op, x, y));
            prop_assume!(near == 0.0 || near.is_normal());
            if exact == f64::from(near) && op == BinaryOp::Multiply {
                prop_assert!(all.lo() == exact && all.hi() == exact);
            } else if exact != f64::from(near) {
                let other = if exact > f64::from(near) { near.next_up() } else { near.next_down() };
                let ends = (all.lo().min(all.hi()), all.lo().max(all.hi()));
                prop_assert_eq!(ends, (f64::from(near.min(other)), f64::from(near.max(other))));
            }
        }
    }
}

const UNARY: [&str; 28] = [
    "abs",
    "sign",
    "ceil",
    "floor",
    "trunc",
    "round",
    "fract",
    "saturate",
    "sqrt",
    "inverseSqrt",
    "exp",
    "exp2",
    "log",
    "log2",
    "sin",
    "cos",
    "tan",
    "portableSin",
    "portableCos",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
];

/// An expression of `x`, `y` and `s`, as text.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec!["x", "y", "0.1", "0.5", "1", "3", "0.7"]).prop_map(str::to_owned);
    leaf.prop_recursive(4, 24, 3, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            (pair.clone(), prop::sample::select(vec!["+", "-", "*", "/", "%"]))
                .prop_map(|((a, b), op)| format!("({a} {op} {b})")),
            (pair.clone(), prop::sample::select(vec!["min", "max", "step", "atan2", "pow"]))
                .prop_map(|((a, b), f)| format!("{f}({a}, {b})")),
            (inner.clone(), prop::sample::select(UNARY.to_vec())).prop_map(|(a, f)| format!("{f}({a})")),
            (pair.clone(), inner.clone(), prop::sample::select(vec!["mix", "fma", "clamp", "smoothstep"]))
                .prop_map(|((a, b), c, f)| format!("{f}({a}, {b}, {c})")),
            inner.clone().prop_map(|a| format!("sum(n in 1 .. 3, {a} / n)")),
            inner.clone().prop_map(|a| format!("poly({a}, [1, -1 / 6, 1 / 120])")),
            (pair, inner.clone(), inner).prop_map(|((a, b), c, d)| format!("(if {a} < {b} {{ {c} }} else {{ {d} }})")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None, ..ProptestConfig::default() })]

    /// On random programs: the intervals contain both interpreters' results, and the batch interpreter agrees.
    #[test]
    fn random_programs(
        guards in prop::collection::vec((expression(), expression(), 0_u8..3), 1..4),
        values in prop::collection::vec(expression(), 4),
        points in prop::collection::vec((0_u8..11, 0_u8..11, 0_u8..2), 12),
    ) {
        let case = |(k, ((a, b, s), value)): (usize, (&(String, String, u8), &String))| {
            let level = ["", "s && ", "!s && "][usize::from(*s)];
            format!(r#"Case(id: {}, when: "{level}{a} <= {b}", value: "{value}"),"#, k + 1)
        };
        let cases: String = guards.iter().zip(&values).enumerate().map(case).collect();
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{ "x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1, fetched: (cost: 1)), "s": Bool() }},
                output: Number(), cases: [{cases}], default: "{}")"#,
            values[3]
        );
        // What is constant may divide by zero or exchange bounds, which is refused.
        let parsed = Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table));
        let Ok(program) = parsed else { return Err(TestCaseError::reject("refused")) };
        let mut intervals = IntervalInterpreter::new(&program);
        let mut batch = umbrage::eval::Batch::<f32>::new(&program);
        let number = |tenths: u8| Some(Value::Number(f64::from(f32::from(tenths) / 10.0)));
        for (x, y, s) in points {
            for y in [number(y), None] {
                let point = [number(x), y, Some(Value::Level(s))];
                let fetched = agree(&program, &mut intervals, &point);
                let columns = umbrage::eval::Columns::from_rows(&program, [point]).unwrap();
                match batch.evaluate(&columns) {
                    Ok(results) => {
                        let expected = Interpreter::<f32>::new(&program).evaluate(&point).unwrap();
                        let got = results.outcome(0);
                        prop_assert_eq!((got.row, got.fetched), (expected.row, expected.fetched));
                        prop_assert_eq!(got.values[0].to_bits(), expected.values[0].to_bits());
                    }
                    Err(missing) => prop_assert_eq!(fetched, Err(NeedsFetch(missing.input))),
                }
            }
        }
    }
}
