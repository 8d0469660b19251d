//! Printed integrals against the forms to compute with: evaluations per second, side by side with the error
//! that `umbrage stabilise` and the accuracy test measure.
//!
//! Divan times the batch interpreter in `f32`; `items` are evaluations of one function.

use divan::Bencher;
use divan::counter::ItemsCount;
use umbrage::eval::{Batch, Columns};
use umbrage::program::{Domain, Program, Value};

/// Evaluations per run.
const COUNT: usize = 4096;

fn main() {
    divan::main();
}

const FORMS: [(&str, &str); 6] = [
    ("double_product_printed", "B"),
    ("double_product", "B"),
    ("double_product", "moments"),
    ("double_product_printed", "C4"),
    ("double_product", "C4"),
    ("spherical_gaussian", "beta"),
];

/// Small cells, as a renderer has them: the printed forms are at their usual work here, not at a singularity.
fn columns(program: &Program) -> Columns<f32> {
    let mut columns = Columns::new(program);
    for row in 0..COUNT {
        let part =
            |place: usize| (0.618_033_988_75 * (row + 1) as f64 + 0.414_213_562_37 * (place * row) as f64).fract();
        let (phi0, theta) = (part(1) * 5.0, 0.3 + part(2) * 2.0);
        let point: Vec<Option<Value>> = program
            .inputs
            .iter()
            .enumerate()
            .map(|(place, input)| {
                let number = match input.name.as_str() {
                    "phi0" => phi0,
                    "phi1" => phi0 + 0.05 + 0.3 * part(3),
                    "theta0" => theta,
                    "theta_a" | "theta_b" => theta + 0.3 * part(place),
                    "k" => part(4) - 0.45,
                    "b" => theta + 0.2 - (part(4) - 0.45) * phi0,
                    "a" => part(5) - 0.5,
                    _ => match input.domain {
                        Domain::Continuous { lo, hi, .. } => lo.max(-1.0) + (hi.min(1.0) - lo.max(-1.0)) * part(place),
                        Domain::Discrete(_) => 0.0,
                    },
                };
                Some(Value::Number(number))
            })
            .collect();
        columns.push(&point).expect("numbers for all parameters");
    }
    columns
}

#[divan::bench(args = FORMS.map(|(table, function)| format!("{table}.{function}")))]
fn batch(bencher: Bencher<'_, '_>, form: &str) {
    let (table, function) = form.split_once('.').expect("table.function");
    let path = format!("{}/tables/{table}.ron", env!("CARGO_MANIFEST_DIR"));
    let program = Program::read_function(path, Some(function)).expect("a function of the table");
    let columns = columns(&program);
    let mut batch = Batch::new(&program);
    let mut results = batch.evaluate(&columns).expect("no fetched inputs");
    bencher.counter(ItemsCount::new(COUNT)).bench_local(|| batch.evaluate_into(&columns, &mut results));
}
