//! The batch interpreter against the reference, on the tables that come with
//! the crate: every discrete state, fetched inputs given and missing.

use umbrage::eval::{Batch, Columns, Interpreter, Missing, NeedsFetch, Outcome};
use umbrage::program::{Domain, InputId, Program, Real, Value};

/// A small generator of the xorshift family; good enough to scatter points.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    fn below(&mut self, bound: usize) -> usize {
        ((self.next() >> 32) as usize) % bound
    }

    /// Corners, halves and quarters, the neighbours of 1, and anything.
    fn unit(&mut self) -> f64 {
        const GRID: [f64; 8] = [0.0, 1.0, 0.5, 0.25, 0.75, 0.1, 1.0 - 1.0 / (1 << 24) as f64, 1e-40];
        match self.below(3) {
            0 => GRID[self.below(GRID.len())],
            _ => (self.next() >> 11) as f64 / (1_u64 << 53) as f64,
        }
    }

    fn value(&mut self, domain: &Domain) -> Value {
        match domain {
            Domain::Discrete(levels) => Value::Level(self.below(levels.count()) as u8),
            Domain::Word => Value::Number(self.below(1 << 32) as f64),
            Domain::Continuous { lo, hi, .. } => Value::Number(lo + (hi - lo) * self.unit()),
        }
    }
}

/// Points in every state; each fetched input is missing in about one of `missing` points, if that is not zero.
fn points(program: &Program, per_state: usize, missing: usize, random: &mut Random) -> Vec<Vec<Option<Value>>> {
    let mut points = Vec::new();
    let mut levels = vec![0; program.inputs.len()];
    for state in 0..program.states.count() {
        program.states.write(state, &mut levels);
        for _ in 0..per_state {
            let value = |(id, input): (InputId, &umbrage::program::Input)| match (&input.domain, input.fetched) {
                (Domain::Discrete(_), None) => Some(Value::Level(levels[id.index()])),
                (_, Some(_)) if missing > 0 && random.below(missing) == 0 => None,
                (domain, _) => Some(random.value(domain)),
            };
            points.push(program.input_ids().map(value).collect());
        }
    }
    // Neighbouring points must not be alike.
    for last in (1..points.len()).rev() {
        points.swap(last, random.below(last + 1));
    }
    points
}

fn assert_same<T: Real>(got: &Outcome<T>, expected: &Outcome<T>, point: &[Option<Value>]) {
    // One NaN is as good as another.
    let bits_of = |v: &T| if v.to_f64().is_nan() { None } else { Some(v.to_f64().to_bits()) };
    let bits = |outcome: &Outcome<T>| outcome.values.iter().map(bits_of).collect::<Vec<_>>();
    let path = |outcome: &Outcome<T>| (outcome.row, outcome.line, outcome.fetched);
    assert_eq!((path(got), bits(got)), (path(expected), bits(expected)), "{got:?} for {expected:?} at {point:?}");
}

fn check<T: Real>(program: &Program, per_state: usize) {
    let mut scalar = Interpreter::<T>::new(program);
    let mut batch = Batch::<T>::new(program);

    // Everything given: one large run.
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let all = points(program, per_state, 0, &mut random);
    let columns = Columns::from_rows(program, &all).unwrap();
    let results = batch.evaluate(&columns).unwrap();
    assert_eq!(results.len(), all.len());
    for (row, point) in all.iter().enumerate() {
        assert_same(&results.outcome(row), &scalar.evaluate(point).unwrap(), point);
    }

    // Something missing: the points that fail are reported one after the other, each with its input.
    let some = points(program, 2, 3, &mut random);
    let expected: Vec<Result<Outcome<T>, NeedsFetch>> = some.iter().map(|point| scalar.evaluate(point)).collect();
    let columns = Columns::from_rows(program, &some).unwrap();
    match expected.iter().position(Result::is_err) {
        Some(row) => {
            let input = expected[row].as_ref().map_err(|needs| needs.0).unwrap_err();
            assert_eq!(batch.evaluate(&columns).map(|_| ()), Err(Missing { row, input }));
        }
        None => assert!(program.fetched.is_empty()),
    }
    let mut good = Vec::new();
    for (point, expected) in some.iter().zip(expected) {
        match expected {
            Ok(outcome) => good.push((point, outcome)),
            Err(NeedsFetch(input)) => {
                let columns = Columns::from_rows(program, [point]).unwrap();
                assert_eq!(batch.evaluate(&columns).map(|_| ()), Err(Missing { row: 0, input }), "{point:?}");
            }
        }
    }
    let columns = Columns::from_rows(program, good.iter().map(|(point, _)| point)).unwrap();
    let results = batch.evaluate(&columns).unwrap();
    for (row, (point, outcome)) in good.iter().enumerate() {
        assert_same(&results.outcome(row), outcome, point);
    }
}

#[test]
fn smsr() {
    let program = Program::read("tables/smsr.ron").unwrap();
    check::<f32>(&program, 24);
    check::<f64>(&program, 8);
}

#[test]
fn rsmss() {
    let program = Program::read("tables/rsmss.ron").unwrap();
    check::<f32>(&program, 40);
    check::<f64>(&program, 10);
}

/// Sums, selections within selections, and whatever the printed formulas give where they are singular.
#[test]
fn functions() {
    for table in ["double_product", "double_product_printed", "spherical_gaussian", "spherical_gaussian_printed"] {
        for program in Program::read_all(format!("tables/{table}.ron")).unwrap() {
            check::<f32>(&program, 300);
            check::<f64>(&program, 40);
        }
    }
}

#[test]
fn states_with_the_same_meaning_share_their_tree() {
    let program = Program::read("tables/rsmss.ron").unwrap();
    let mut batch = Batch::<f32>::new(&program);
    batch.prepare();
    assert!(batch.arms() < 120, "{} trees for {} states", batch.arms(), program.states.count());
}

#[test]
fn columns_give_back_their_rows() {
    let program = Program::read("tables/rsmss.ron").unwrap();
    let all = points(&program, 1, 2, &mut Random(7));
    let columns = Columns::<f64>::from_rows(&program, &all).unwrap();
    for (row, point) in all.iter().enumerate() {
        assert_eq!(&columns.point(row), point);
    }
    let again = program.input_ids().map(|(id, _)| columns.column(id).clone()).collect();
    let again = Columns::from_columns(&program, again).unwrap();
    assert_eq!(again.gaps(), columns.gaps());
    assert_eq!(again.point(3), columns.point(3));
}

#[test]
fn columns_that_do_not_fit_are_refused() {
    use umbrage::eval::{Column, ColumnError};
    let program = Program::read("tables/smsr.ron").unwrap();
    let good = points(&program, 1, 0, &mut Random(7)).swap_remove(0);
    let refused = |index: usize, value: Option<Value>| {
        let mut point = good.clone();
        point[index] = value;
        Columns::<f32>::from_rows(&program, [&good, &point]).unwrap_err()
    };
    let input = InputId::new;
    assert_eq!(refused(0, None), ColumnError::Absent { row: 1, input: input(0) });
    assert_eq!(refused(0, Some(Value::Level(4))), ColumnError::Level { row: 1, input: input(0) });
    assert_eq!(refused(4, Some(Value::Level(0))), ColumnError::Kind(input(4)));
    assert_eq!(refused(0, Some(Value::Number(0.0))), ColumnError::Kind(input(0)));
    let few = Columns::<f32>::from_columns(&program, vec![Column::Levels(vec![0])]).unwrap_err();
    assert_eq!(few, ColumnError::Count { found: 1, expected: 10 });
}
