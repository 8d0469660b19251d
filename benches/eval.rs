//! Evaluations per second on one core: the interpreters beside the emitted
//! Rust functions, on the same columns.
//!
//! Two kinds of points: every state equally likely, and states as they occur
//! on silhouettes (one-sided discontinuities, runs that are mostly
//! positive-negative).

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use umbrage::eval::{Batch, Columns, Interpreter, Results};
use umbrage::program::{Domain, InputId, Program, Value};

mod ladder {
    include!("../generated/rsmss/ladder.rs");
}
mod switch {
    include!("../generated/rsmss/switch.rs");
}

const ROWS: usize = 65_536;
const KINDS: [&str; 2] = ["any_state", "silhouettes"];

fn program() -> Program {
    Program::read("tables/rsmss.ron").unwrap_or_else(|error| panic!("{error}"))
}

/// Xorshift, so that every run sees the same points.
struct Random(u64);

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) % count
    }
}

fn columns(program: &Program, kind: &str) -> Columns<f32> {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut columns = Columns::new(program);
    for _ in 0..ROWS {
        let point: Vec<Option<Value>> = program
            .inputs
            .iter()
            .map(|input| {
                Some(match (&input.domain, kind, input.name.as_str()) {
                    (Domain::Discrete(_), "silhouettes", "H" | "V") => Value::Level(random.below(3) as u8),
                    // positive_negative nine times out of ten
                    (Domain::Discrete(_), "silhouettes", "tH" | "tV") => {
                        Value::Level(if random.below(10) < 9 { 1 } else { random.below(3) as u8 })
                    }
                    (Domain::Discrete(levels), ..) => Value::Level(random.below(levels.count() as u64) as u8),
                    (Domain::Word, ..) => Value::Number(random.below(1 << 32) as f64),
                    (Domain::Continuous { .. }, ..) => Value::Number(random.below(1 << 20) as f64 / f64::from(1 << 20)),
                })
            })
            .collect();
        columns.push(&point).unwrap_or_else(|error| panic!("{error}"));
    }
    columns
}

/// The columns of the emitted functions, with their keys.
struct Inputs<'c> {
    columns: &'c Columns<f32>,
    keys: Vec<u32>,
    numbers: [&'c [f32]; 4],
    fetched: Vec<&'c [u8]>,
}

impl<'c> Inputs<'c> {
    fn new(program: &Program, columns: &'c Columns<f32>) -> Self {
        let id = |name: &str| program.input(name).unwrap_or_else(|| panic!("{name}"));
        let plan = umbrage::plan::Plan::new(program, umbrage::plan::Shape::Ladder);
        let key = plan.unwrap_or_else(|error| panic!("{error}")).key;
        let keys = (0..columns.len()).map(|row| key.pack(|input| columns.levels(input)[row])).collect();
        let fetched = program.fetched.iter().map(|input: InputId| columns.levels(input)).collect();
        Self { columns, keys, numbers: ["dH", "dV", "px", "py"].map(|name| columns.numbers(id(name))), fetched }
    }
}

struct Site<'i>(&'i Inputs<'i>, usize);

macro_rules! site {
    ($($plan:ident),*) => {$(
        impl $plan::rsmss::RsmssSite for Site<'_> {
            fn n_top(&mut self) -> u32 { self.0.fetched[0][self.1].into() }
            fn n_bottom(&mut self) -> u32 { self.0.fetched[1][self.1].into() }
            fn n_left(&mut self) -> u32 { self.0.fetched[2][self.1].into() }
            fn n_right(&mut self) -> u32 { self.0.fetched[3][self.1].into() }
            fn d_cb_h(&mut self) -> u32 { self.0.fetched[4][self.1].into() }
            fn d_cb_v(&mut self) -> u32 { self.0.fetched[5][self.1].into() }
            fn d_cb_top(&mut self) -> u32 { self.0.fetched[6][self.1].into() }
            fn d_cb_bottom(&mut self) -> u32 { self.0.fetched[7][self.1].into() }
            fn d_cb_left(&mut self) -> u32 { self.0.fetched[8][self.1].into() }
            fn d_cb_right(&mut self) -> u32 { self.0.fetched[9][self.1].into() }
        }

        #[divan::bench(args = KINDS)]
        fn $plan(bencher: Bencher<'_, '_>, kind: &str) {
            let program = program();
            let columns = columns(&program, kind);
            let inputs = Inputs::new(&program, &columns);
            let mut values = vec![0.0_f32; ROWS];
            let mut cases = vec![0_u32; ROWS];
            bencher.counter(ItemsCount::new(ROWS)).bench_local(|| {
                let [d_h, d_v, px, py] = inputs.numbers;
                for row in 0..inputs.columns.len() {
                    let mut site = Site(&inputs, row);
                    let key = inputs.keys[row];
                    let result = $plan::rsmss::rsmss_key_case(key, d_h[row], d_v[row], px[row], py[row], &mut site);
                    values[row] = result.value;
                    cases[row] = result.case_id;
                }
                black_box((&values, &cases));
            });
        }
    )*};
}

site!(ladder, switch);

#[divan::bench(args = KINDS)]
fn batch(bencher: Bencher<'_, '_>, kind: &str) {
    let program = program();
    let columns = columns(&program, kind);
    let mut interpreter = Batch::<f32>::new(&program);
    let mut results = Results::default();
    bencher.counter(ItemsCount::new(ROWS)).bench_local(|| {
        let done = interpreter.evaluate_into(&columns, &mut results);
        assert!(done.is_ok(), "every input is there");
        black_box(&results);
    });
}

#[divan::bench(args = KINDS, sample_count = 20)]
fn scalar(bencher: Bencher<'_, '_>, kind: &str) {
    let program = program();
    let columns = columns(&program, kind);
    let points: Vec<_> = (0..ROWS).map(|row| columns.point(row)).collect();
    let mut interpreter = Interpreter::<f32>::new(&program);
    bencher.counter(ItemsCount::new(ROWS)).bench_local(|| {
        for point in &points {
            black_box(interpreter.evaluate(point).is_ok());
        }
    });
}

fn main() {
    divan::main();
}
