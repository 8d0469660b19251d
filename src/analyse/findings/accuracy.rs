//! U0219, U0220: functions that are not what they claim to be.
//!
//! A limit is compared with what the function comes to there, or close by, in
//! `f64`. An accuracy is tried out: at points of the domain the `f32` result is
//! compared with the `f64` one, which stands for the exact one (whether the
//! formula itself is right, it cannot tell). What may differ is what the
//! rounding of the inputs can change, and of the scale half a unit in the last
//! place, each times the claimed factor.

use super::{Analysis, Run};
use crate::diag::{Diagnostic, codes};
use crate::eval::Interpreter;
use crate::points::Samples;
use crate::program::{Accuracy, Function, InputId, Limit, Program, Value};
use crate::show::{Precision, sentence};

/// Points at which a claim is tried out.
const POINTS: usize = 48;

/// Half a unit in the last place of 1 in `f32`.
const HALF_UNIT: f64 = 1.0 / 16_777_216.0;

/// The distance from a limit at which the function is evaluated, and its largest distance from the limit there.
const STEP: f64 = 1e-3;
const CLOSE: f64 = 1e-4;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::LIMIT_BROKEN, codes::BUDGET_EXCEEDED], run: Run::Program(findings) };

/// Tries out what a function claims.
fn findings(program: &Program) -> Vec<Diagnostic> {
    let Some(function) = &program.function else { return Vec::new() };
    let mut found: Vec<Diagnostic> =
        function.limits.iter().filter_map(|limit| check_limit(program, function, limit)).collect();
    // What an exhibit says of its accuracy is meant for the form that is to be made of it.
    if program.exhibit.is_none() {
        found.extend(function.accuracy.as_ref().and_then(|claim| check_accuracy(program, function, claim)));
    }
    found
}

/// The error that each component of a function may have at a point
/// of `f32` numbers; `None` without a claim, or where the function is not finite.
pub fn allowance(program: &Program, wide: &mut Interpreter<'_, f64>, point: &[Option<Value>]) -> Option<Vec<f64>> {
    let claim = program.function.as_ref()?.accuracy.as_ref()?;
    let exact = wide.evaluate(point).ok()?.values;
    let scale = wide.number(claim.scale).ok()?;
    let mut allowed = vec![HALF_UNIT * scale.abs(); exact.len()];
    for input in 0..point.len() {
        let Some(Value::Number(number)) = point[input] else { continue };
        let mut moved = point.to_vec();
        let mut change = vec![0.0_f64; exact.len()];
        for direction in [-1.0, 1.0] {
            let half = 0.5 * (f64::from((number.abs() as f32).next_up()) - number.abs());
            moved[input] = Some(Value::Number(number + direction * half));
            let values = wide.evaluate(&moved).ok()?.values;
            for ((change, value), exact) in change.iter_mut().zip(values).zip(&exact) {
                *change = change.max((value - exact).abs());
            }
        }
        allowed.iter_mut().zip(change).for_each(|(allowed, change)| *allowed += change);
    }
    allowed.iter_mut().for_each(|allowed| *allowed *= claim.times);
    allowed.iter().all(|allowed| allowed.is_finite()).then_some(allowed)
}

/// The point at which a function is least accurate.
struct Worst {
    /// The error, of what is allowed.
    times: f64,
    point: Vec<Option<Value>>,
    exact: Vec<f64>,
    got: Vec<f64>,
}

fn check_accuracy(program: &Program, function: &Function, claim: &Accuracy) -> Option<Diagnostic> {
    let (mut wide, mut narrow) = (Interpreter::<f64>::new(program), Interpreter::<f32>::new(program));
    let mut worst: Option<Worst> = None;
    for point in Samples::new(program).take(POINTS) {
        let exact = wide.evaluate(&point).ok()?.values;
        let got = program.output.numbers(&narrow.evaluate(&point).ok()?.values);
        let Some(allowed) = allowance(program, &mut wide, &point) else { continue };
        for ((exact_one, got_one), allowed) in exact.iter().zip(&got).zip(allowed) {
            // What is smaller than any normal number may be flushed to zero.
            let error = (exact_one - got_one).abs() - f64::from(f32::MIN_POSITIVE);
            let times = if error.is_nan() { f64::INFINITY } else { error / allowed.max(f64::MIN_POSITIVE) };
            if times > 1.0 && worst.as_ref().is_none_or(|worst| times > worst.times) {
                worst = Some(Worst { times, point: point.clone(), exact: exact.clone(), got: got.clone() });
            }
        }
    }
    let Worst { times, point, exact, got } = worst?;
    let message = format!("the function `{}` is less accurate than it claims", function.name);
    Some(
        Diagnostic::error(codes::BUDGET_EXCEEDED, message)
            .at(
                claim.span,
                format!("its error is {:.3} times what the inputs and the scale allow", times * claim.times),
            )
            .help(format!(
                "at {}: f32 gives {}, f64 {}",
                place(program, &point),
                sentence(&program.output, &got, Precision::F32),
                sentence(&program.output, &exact, Precision::F64)
            ))
            .help("write it in a form that loses less, or claim less"),
    )
}

fn check_limit(program: &Program, function: &Function, limit: &Limit) -> Option<Diagnostic> {
    let mut wide = Interpreter::<f64>::new(program);
    for mut point in Samples::new(program).take(POINTS / 4) {
        for (input, value) in &limit.at {
            point[input.index()] = Some(Value::Number(*value));
        }
        wide.place(&point).ok()?;
        let claimed = limit.values.iter().map(|value| wide.number(*value)).collect::<Result<Vec<f64>, _>>().ok()?;
        let there = wide.evaluate(&point).ok()?.values;
        let found = match there.iter().all(|value| value.is_finite()) {
            true => there,
            false => beside(&mut wide, &point, &limit.at)?,
        };
        let differs = |(claimed, found): (&f64, &f64)| {
            let difference = (claimed - found).abs();
            difference.is_nan() || difference > CLOSE * claimed.abs().max(1.0)
        };
        if claimed.iter().zip(&found).any(differs) {
            let message = format!("the function `{}` has another limit than it claims", function.name);
            return Some(
                Diagnostic::error(codes::LIMIT_BROKEN, message)
                    .at(limit.span, format!("claims {}", sentence(&program.output, &claimed, Precision::F64)))
                    .help(format!(
                        "at {} it comes to {}",
                        place(program, &point),
                        sentence(&program.output, &found, Precision::F64)
                    )),
            );
        }
    }
    None
}

/// The mean of the function's values on both sides of a point.
fn beside(wide: &mut Interpreter<'_, f64>, point: &[Option<Value>], at: &[(InputId, f64)]) -> Option<Vec<f64>> {
    let mut sum: Vec<f64> = Vec::new();
    for direction in [-0.5, 0.5] {
        let mut moved = point.to_vec();
        for (input, value) in at {
            moved[input.index()] = Some(Value::Number(value + direction * STEP));
        }
        let values = wide.evaluate(&moved).ok()?.values;
        sum.resize(values.len(), 0.0);
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += 0.5 * value);
    }
    Some(sum)
}

fn place(program: &Program, point: &[Option<Value>]) -> String {
    let values = program.inputs.iter().zip(point);
    let shown = values.filter_map(|(input, value)| Some(format!("{} = {}", input.name, input.show((*value)?))));
    shown.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use crate::diag::Source;
    use crate::program::Program;
    use crate::table::Table;

    fn found(function: &str) -> Vec<String> {
        let text = format!(
            r#"Table(language: 1, name: "t",
                inputs: {{"x": Range(from: -10, to: 10), "s": Range(from: -2, to: 2)}},
                functions: {{"f": Function(parameters: ["x", "s"], {function})}})"#
        );
        let programs = Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check_all(&table));
        let programs = programs.unwrap_or_else(|e| panic!("{e}"));
        super::findings(&programs[0]).iter().map(|d| format!("{} {}", d.code, d.message)).collect()
    }

    #[test]
    fn limits_are_tried_out() {
        let printed = r#"value: "sin(s * x) / s""#;
        assert_eq!(found(&format!(r#"{printed}, limits: [(at: {{"s": 0}}, value: "x")]"#)), [""; 0]);
        assert_eq!(
            found(&format!(r#"{printed}, limits: [(at: {{"s": 0}}, value: "x * x")]"#)),
            ["U0219 the function `f` has another limit than it claims"]
        );
        assert_eq!(
            found(r#"value: "cos(s) / s", limits: [(at: {"s": 0}, value: "1")]"#),
            ["U0219 the function `f` has another limit than it claims"]
        );
    }

    #[test]
    fn accuracies_are_tried_out() {
        assert_eq!(found(r#"value: "sin(s) + x", error: (times: 4, scale: "1 + abs(x)")"#), [""; 0]);
        assert_eq!(
            found(r#"value: "(1000 + x) - 1000 - x + s", error: (times: 4, scale: "abs(s)")"#),
            ["U0220 the function `f` is less accurate than it claims"]
        );
    }
}
