//! The emitted Rust of the published tables, as it is checked in, gives what
//! the interpreter gives.

use umbrage::eval::Interpreter;
use umbrage::program::{Domain, InputId, Program, Value};

#[allow(unreachable_pub, missing_docs)]
mod ladder {
    include!("../../generated/smsr/ladder.rs");
    include!("../../generated/rsmss/ladder.rs");
}
#[allow(unreachable_pub, missing_docs)]
mod switch {
    include!("../../generated/smsr/switch.rs");
    include!("../../generated/rsmss/switch.rs");
}

/// Answers fetches from a point and counts them.
struct Counting<'p> {
    program: &'p Program,
    point: &'p [Option<Value>],
    counts: Vec<usize>,
}

impl Counting<'_> {
    fn fetch(&mut self, name: &str) -> u32 {
        let input = self.program.input(name).unwrap();
        self.counts[input.index()] += 1;
        match self.point[input.index()] {
            Some(Value::Level(level)) => u32::from(level),
            other => panic!("{name}: {other:?}"),
        }
    }
}

macro_rules! site {
    ($site:path: $($name:ident)*) => {
        impl $site for Counting<'_> {
            $(fn $name(&mut self) -> u32 {
                self.fetch(stringify!($name))
            })*
        }
    };
}

site!(ladder::rsmss::RsmssSite: n_top n_bottom n_left n_right d_cb_h d_cb_v d_cb_top d_cb_bottom d_cb_left d_cb_right);
site!(switch::rsmss::RsmssSite: n_top n_bottom n_left n_right d_cb_h d_cb_v d_cb_top d_cb_bottom d_cb_left d_cb_right);

/// SplitMix64.
fn next(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Points in every state: quarters, which meet the lines of many guards exactly, and anything.
fn points(program: &Program, per_state: usize) -> Vec<Vec<Option<Value>>> {
    let mut random = 1;
    let mut levels = vec![0; program.inputs.len()];
    let mut points = Vec::new();
    for state in 0..program.states.count() {
        program.states.write(state, &mut levels);
        for number in 0..per_state {
            let value = |(id, input): (InputId, &umbrage::program::Input)| match (&input.domain, input.fetched) {
                (Domain::Discrete(_), None) => Value::Level(levels[id.index()]),
                (Domain::Discrete(known), Some(_)) => Value::Level((next(&mut random) % known.count() as u64) as u8),
                (Domain::Continuous { .. }, _) if number % 2 == 0 => {
                    Value::Number((next(&mut random) % 5) as f64 / 4.0)
                }
                _ => Value::Number(f64::from((next(&mut random) >> 40) as f32 / (1 << 24) as f32)),
            };
            points.push(program.input_ids().map(value).map(Some).collect());
        }
    }
    points
}

fn number(point: &[Option<Value>], program: &Program, name: &str) -> f32 {
    let input = program.input(name).unwrap();
    match (point[input.index()], program.levels(input)) {
        (Some(Value::Number(number)), _) => number as f32,
        (Some(Value::Level(level)), Some(levels)) => levels.codes[usize::from(level)] as f32,
        other => panic!("{name}: {other:?}"),
    }
}

macro_rules! check {
    ($program:expr, $point:expr, $outcome:expr, $result:expr, $default:expr) => {
        let (program, outcome, result) = ($program, $outcome, $result);
        let case = outcome.row.map_or($default, |row| program.rows[row].id);
        assert_eq!(result.case_id, case, "{:?}", $point);
        assert_eq!(result.value, outcome.values[0], "{:?}", $point);
    };
}

#[test]
fn emitted_smsr_equals_the_interpreter() {
    let program = Program::read("tables/smsr.ron").unwrap();
    let mut interpreter = Interpreter::<f32>::new(&program);
    for point in points(&program, 24) {
        let outcome = interpreter.evaluate(&point).unwrap();
        let n = |name| number(&point, &program, name);
        let flag = |name| n(name) != 0.0;
        macro_rules! run {
            ($module:path) => {{
                use $module as m;
                let result = m::smsr_case(
                    n("H"),
                    n("V"),
                    n("tH"),
                    n("tV"),
                    n("dH"),
                    n("dV"),
                    n("px"),
                    n("py"),
                    flag("domH"),
                    flag("domV"),
                );
                check!(&program, &point, &outcome, result, m::SMSR_DEFAULT);
                let key = m::smsr_pack(n("H"), n("V"), n("tH"), n("tV"), flag("domH"), flag("domV"));
                assert_eq!(m::smsr_key(key, n("dH"), n("dV"), n("px"), n("py")), result.value);
            }};
        }
        run!(ladder::smsr);
        run!(switch::smsr);
    }
}

#[test]
fn emitted_rsmss_equals_the_interpreter() {
    let program = Program::read("tables/rsmss.ron").unwrap();
    let mut interpreter = Interpreter::<f32>::new(&program);
    let mut fetches = 0;
    for point in points(&program, 24) {
        let outcome = interpreter.evaluate(&point).unwrap();
        let n = |name| number(&point, &program, name);
        let flag = |name| n(name) != 0.0;
        macro_rules! run {
            ($module:path) => {{
                use $module as m;
                let mut site = Counting { program: &program, point: &point, counts: vec![0; program.inputs.len()] };
                let result = m::rsmss_case(
                    n("H"),
                    n("V"),
                    n("b"),
                    n("tH"),
                    n("tV"),
                    n("dH"),
                    n("dV"),
                    n("px"),
                    n("py"),
                    flag("domH"),
                    flag("domV"),
                    &mut site,
                );
                check!(&program, &point, &outcome, result, m::RSMSS_DEFAULT);
                for (input, count) in program.input_ids().zip(&site.counts) {
                    let most = usize::from(outcome.fetched.contains(input.0));
                    assert!(*count <= most, "{} is fetched {count} times at {point:?}", input.1.name);
                    fetches += count;
                }
            }};
        }
        run!(ladder::rsmss);
        run!(switch::rsmss);
    }
    assert!(fetches > 1000, "cases that fetch are among the points");
}
