//! U0501: examples that the table contradicts.

use super::accuracy::allowance;
use super::{Analysis, Run};
use crate::diag::{Diagnostic, codes};
use crate::eval::Interpreter;
use crate::program::{Example, Program, Scalar};
use crate::show::{Precision, sentence};
use crate::table::HitPolicy;

/// Returns whether a computed component is what an example expects.
///
/// Expected values are written in decimal and computed ones are `f32`, so the
/// two may differ by a few roundings: one millionth, relative above one. Whole
/// numbers (levels, lengths) are far apart on this scale and so compared exactly.
pub fn agrees(expected: f64, got: f64) -> bool {
    (expected - got).abs() <= 1e-6 * expected.abs().max(1.0)
}

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::EXAMPLE_FAILS], run: Run::Program(findings) };

/// Runs every example with the interpreter.
pub(in crate::analyse) fn findings(program: &Program) -> Vec<Diagnostic> {
    let mut interpreter = Interpreter::<f32>::new(program);
    program.examples.iter().filter_map(|example| run(program, &mut interpreter, example)).collect()
}

fn run(program: &Program, interpreter: &mut Interpreter<'_, f32>, example: &Example) -> Option<Diagnostic> {
    let row = &program.rows[example.row];
    let fails = |what: String| Diagnostic::error(codes::EXAMPLE_FAILS, format!("an example of case {} {what}", row.id));
    let outcome = match interpreter.evaluate(&example.inputs) {
        Ok(outcome) => outcome,
        Err(needed) => {
            let input = &program.inputs[needed.0.index()];
            return Some(
                fails(format!("needs `{}`, which it leaves out", input.name))
                    .at(example.span, format!("`{}` is fetched at this point", input.name))
                    .help(format!("give `{}` a value in the example", input.name)),
            );
        }
    };
    let expected = sentence(&program.output, &example.expected, Precision::F32);
    let got = program.output.numbers(&outcome.values);
    let got_shown = sentence(&program.output, &got, Precision::F32);
    let taken = outcome.row.map(|taken| &program.rows[taken]);
    let counts = match program.hit_policy {
        HitPolicy::First | HitPolicy::Unique => taken.is_some_and(|taken| taken.id == row.id),
        // Of a case with images, any of its rows.
        HitPolicy::Collect => program
            .rows
            .iter()
            .filter(|other| other.id == row.id)
            .any(|other| interpreter.holds(other.guard).unwrap_or(false)),
    };
    if !counts {
        let error = match taken {
            Some(taken) if program.hit_policy == HitPolicy::Collect => fails("does not make its guard hold".to_owned())
                .at(example.span, format!("here case {} holds, and the result is {got_shown}", taken.id)),
            Some(taken) => fails(format!("is taken by case {}", taken.id))
                .at(
                    example.span,
                    format!("expected case {} and {expected}, got case {} and {got_shown}", row.id, taken.id),
                )
                .at(taken.guard_span, format!("this guard of case {} holds as well, and comes first", taken.id)),
            None => fails("matches no case".to_owned())
                .at(example.span, format!("expected case {} and {expected}, got the default, {got_shown}", row.id)),
        };
        return Some(error.at(row.guard_span, format!("the guard of case {}", row.id)));
    }
    // A function that claims an accuracy is held to it.
    let agree = match allowance(program, &mut Interpreter::new(program), &example.inputs) {
        Some(allowed) => got
            .iter()
            .zip(&example.expected)
            .zip(allowed)
            .all(|((got, expected), allowed)| (got - expected).abs() <= allowed),
        None => got.iter().zip(&example.expected).zip(program.output.components()).all(|((got, expected), of)| {
            if of.scalar == Scalar::Word { got == expected } else { agrees(*expected, *got) }
        }),
    };
    if agree {
        return None;
    }
    let error = fails("has another value".to_owned()).at(example.span, format!("expected {expected}, got {got_shown}"));
    Some(match taken.zip(outcome.line).map(|(taken, line)| &taken.lines[line]) {
        Some(line) => error.at(line.span, "computed here"),
        None => error.help("no line of the case applies, so the default gives the value"),
    })
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    /// The findings about an example; that the cases overlap is another matter.
    fn with_example(example: &str) -> Vec<String> {
        let all = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"s": Bool(), "x": Range(from: 0, to: 1), "f": Bool(fetched: (cost: 1))}},
                output: Number(),
                cases: [
                    Case(id: 1, when: "s", value: "x / 3"),
                    Case(id: 2, when: "x > 0.5 && f", value: "x", examples: [{example}]),
                ],
                default: 0)"#
        ));
        all.into_iter().filter(|finding| finding.starts_with("U0501")).collect()
    }

    #[test]
    fn examples_are_run() {
        assert_eq!(with_example(r#"({"s": false, "x": 0.75, "f": true}, 0.75)"#), [""; 0]);
        assert_eq!(with_example(r#"({"s": false, "x": 0.7, "f": true}, 0.7)"#), [""; 0]);
        assert_eq!(
            with_example(r#"({"s": false, "x": 0.75, "f": true}, 0.5)"#),
            ["U0501 an example of case 2 has another value"]
        );
        assert_eq!(
            with_example(r#"({"s": true, "x": 0.75, "f": true}, 0.25)"#),
            ["U0501 an example of case 2 is taken by case 1"]
        );
        assert_eq!(
            with_example(r#"({"s": false, "x": 0.25, "f": true}, 0)"#),
            ["U0501 an example of case 2 matches no case"]
        );
        assert_eq!(
            with_example(r#"({"s": false, "x": 0.75}, 0.75)"#),
            ["U0501 an example of case 2 needs `f`, which it leaves out"]
        );
    }
}
