//! Examples, found by evaluating the table.

use umbrage::diag::Source;
use umbrage::eval::Interpreter;
use umbrage::points::random::Random;
use umbrage::program::{Domain, Input, Program, Reading, Value};
use umbrage::table::Table;

use super::Maker;
use super::cases::Draft;

/// Adds examples to some cases of a table, where its values can be written down.
pub(super) fn add(maker: &mut Maker<'_, '_>, draft: &mut Draft) {
    // What is imported lies in no directory yet.
    if !draft.beside.is_empty() {
        return;
    }
    let source = Source::new("t.ron", draft.plain());
    let Ok(program) = Table::parse(source).and_then(|table| Program::check(&table)) else { return };
    let (mut narrow, mut wide) = (Interpreter::<f32>::new(&program), Interpreter::<f64>::new(&program));
    let mut random = Random::new(maker.choices.seed());
    for _ in 0..6 {
        let point: Vec<Option<Value>> = program.inputs.iter().map(|input| Some(value(input, &mut random))).collect();
        let (Ok(one), Ok(two)) = (narrow.evaluate(&point), wide.evaluate(&point)) else { continue };
        let exact = one.values.iter().zip(&two.values).all(|(a, b)| f64::from(*a) == *b);
        let (Some(row), true, true) = (one.row, exact, one.row == two.row) else { continue };
        let (Some(expected), Some(case)) =
            (written(&program, &two.values), draft.cases.iter_mut().find(|case| case.id == program.rows[row].id))
        else {
            continue;
        };
        let given = program.input_ids().filter(|(id, input)| input.fetched.is_none() || one.fetched.contains(*id));
        let inputs: Vec<String> = given
            .filter_map(|(id, input)| Some(format!("\"{}\": {}", input.name, shown(input, point[id.index()]?))))
            .collect();
        case.examples.push(format!("({{{}}}, {expected})", inputs.join(", ")));
    }
}

fn value(input: &Input, random: &mut Random) -> Value {
    match &input.domain {
        Domain::Discrete(levels) => Value::Level(random.below(levels.count()) as u8),
        Domain::Word => Value::Number(random.below(1 << 32) as f64),
        Domain::Continuous { lo, hi, .. } => {
            let value = lo + (hi - lo) * random.below(9) as f64 / 8.0;
            Value::Number(f64::from(value as f32).clamp(*lo, *hi))
        }
    }
}

fn shown(input: &Input, value: Value) -> String {
    match (value, &input.domain) {
        (Value::Level(level), Domain::Discrete(levels)) => {
            let name = &levels.shown(level);
            if name.starts_with(|c: char| c.is_alphabetic()) && name != "true" && name != "false" {
                format!("\"{name}\"")
            } else {
                name.clone()
            }
        }
        (Value::Number(number), _) => format!("{number}"),
        (Value::Level(level), Domain::Continuous { .. } | Domain::Word) => level.to_string(),
    }
}

/// The expected value; none if it is no number that can be written, or out of bounds.
fn written(program: &Program, values: &[f64]) -> Option<String> {
    if values.iter().any(|value| !value.is_finite()) {
        return None;
    }
    Some(format!("\"{}\"", said(&program.output.read(values))))
}

/// A result as an expression.
fn said(reading: &Reading<'_>) -> String {
    let all = |items: &[Reading<'_>]| items.iter().map(said).collect::<Vec<_>>().join(", ");
    match reading {
        Reading::Number(number) => plain(*number),
        Reading::Bool(value) => value.to_string(),
        Reading::Int(value) => value.to_string(),
        Reading::Level(_, name) => (*name).to_owned(),
        Reading::Vector(parts) => {
            let parts: Vec<String> = parts.iter().map(|value| plain(*value)).collect();
            format!("vec{}({})", parts.len(), parts.join(", "))
        }
        Reading::List(items) => format!("[{}]", all(items)),
        Reading::Record(fields) => {
            let fields: Vec<String> = fields.iter().map(|(name, field)| format!("{name}: {}", said(field))).collect();
            format!("{{{}}}", fields.join(", "))
        }
    }
}

/// A number without an exponent's sign in front.
fn plain(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value}") }
}
