//! The decision at a point, as `umbrage explain` makes it.

use serde_json::{Map, Value as Json, json};
use umbrage::diag::{Diagnostic, Failure, codes};
use umbrage::explain::{self, Explanation, Tested, reach};
use umbrage::program::{Domain, Input, Program, Value};
use umbrage::show::{Precision, sentence};

use crate::message::Message;
use crate::places::Places;

/// The point that the page names: an object of inputs and values in words. What it leaves out is absent.
pub(crate) fn point(program: &Program, words: &Json) -> Result<Vec<Option<Value>>, Failure> {
    let mut point = vec![None; program.inputs.len()];
    for (name, word) in words.as_object().into_iter().flatten() {
        // A point of a table that was changed since may name what is no more.
        let Some(at) = program.inputs.iter().position(|input| input.is_called(name)) else { continue };
        let value = program.inputs[at].parse(word.as_str().unwrap_or_default().trim());
        let refuse = |message| Failure::new(program.source.clone(), Diagnostic::error(codes::BAD_VALUE, message));
        point[at] = Some(value.map_err(refuse)?);
    }
    Ok(point)
}

/// A point in words, without what is absent.
pub(crate) fn words(program: &Program, point: &[Option<Value>]) -> Json {
    let given = program.inputs.iter().zip(point);
    let given = given.filter_map(|(input, value)| Some((input.name.clone(), json!(input.show((*value)?)))));
    Json::Object(given.collect::<Map<_, _>>())
}

/// The value of an input that stands where nothing is said of it.
pub(crate) fn least(input: &Input) -> Value {
    input.default.unwrap_or_else(|| match &input.domain {
        Domain::Discrete(_) => Value::Level(0),
        Domain::Continuous { lo, hi, .. } => Value::Number(lo / 2.0 + hi / 2.0),
        Domain::Word => Value::Number(0.0),
    })
}

/// Explains a point.
pub(crate) fn explain(program: &Program, words: &Json) -> Result<Message, Failure> {
    let mut point = point(program, words)?;
    for (place, input) in point.iter_mut().zip(&program.inputs).filter(|(_, input)| input.fetched.is_none()) {
        place.get_or_insert(least(input));
    }
    Ok(Message::of(match explain::explain(program, &point, Precision::F32) {
        Ok(explanation) => explained(program, &explanation),
        Err(needed) => json!({
            "point": self::words(program, &point),
            "needs": program.inputs[needed.input.index()].name,
            "by": needed.row.map(|row| program.rows[row].id),
        }),
    }))
}

/// A point of a state: one that leads to its case, where there is one.
pub(crate) fn state(program: &Program, state: usize) -> Result<Message, Failure> {
    let state = state.min(program.states.count() - 1);
    let found = (0..program.rows.len()).find_map(|row| reach::in_state(program, row, state));
    let point = found.map_or_else(
        || {
            let mut levels = vec![0; program.inputs.len()];
            program.states.write(state, &mut levels);
            let value = |(input, level): (&Input, &u8)| match (input.fetched, &input.domain) {
                (Some(_), _) => None,
                (None, Domain::Discrete(_)) => Some(Value::Level(*level)),
                (None, Domain::Continuous { .. } | Domain::Word) => Some(least(input)),
            };
            program.inputs.iter().zip(&levels).map(value).collect()
        },
        |arrival| arrival.point,
    );
    Ok(Message::of(json!({ "point": words(program, &point) })))
}

fn explained(program: &Program, explanation: &Explanation) -> Json {
    let places = Places::new(&program.source);
    let tested = |tested: &Tested| json!({ "condition": tested.condition, "facts": tested.facts });
    let all = |tests: &[Tested]| tests.iter().map(tested).collect::<Vec<_>>();
    let refused = program.rows.iter().zip(&explanation.refused).map(
        |(row, test)| json!({ "case": row.id, "doc": row.doc, "at": places.span(row.span), "fails": tested(test) }),
    );
    let steps = explanation.steps.iter().map(|step| {
        json!({
            "name": step.name, "formula": step.formula, "numbers": step.numbers,
            "because": step.because, "value": step.value,
        })
    });
    let row = explanation.row.map(|row| &program.rows[row]);
    let line = explanation.line.zip(row).map(|(line, row)| &row.lines[line]);
    let fetched: Vec<_> = explanation.fetched.iter().map(|input| &program.inputs[input.index()]).collect();
    json!({
        "point": words(program, &explanation.point),
        "refused": refused.collect::<Vec<_>>(),
        "case": row.map(|row| json!({
            "id": row.id, "doc": row.doc, "section": row.section, "lines": row.lines.len(),
            "at": places.span(row.span), "line": program.line(row.span),
        })),
        "also": explanation.also.iter().map(|row| program.rows[*row].id).collect::<Vec<_>>(),
        "guard": all(&explanation.guard),
        "refused_lines": all(&explanation.refused_lines),
        "line": line.map(|line| json!({ "at": places.span(line.span), "line": program.line(line.span) })),
        "value_line": explanation.line.map(|line| line + 1),
        "line_condition": all(&explanation.line_condition),
        "steps": steps.collect::<Vec<_>>(),
        "fetched": fetched.iter().map(|input| input.name.as_str()).collect::<Vec<_>>(),
        "cost": fetched.iter().filter_map(|input| input.fetched).sum::<f64>(),
        "value": sentence(&program.output, &explanation.values, explanation.precision),
    })
}
