//! Points as JSON → queries, each mistake at its place.

use glam::DVec3;
use serde_json::Value;
use serde_json::value::RawValue;

use super::occluders;
use super::values::{FAR, Mistake, Read, direction, entries, faulty, items, polygon, vector};
use crate::cli::input::raw::{self, Object};
use crate::cli::input::{Problems, shorten};
use crate::diag::{Diagnostic, Source, Span, codes};
use crate::technique::area::{Question, Shape};

const SHAPE: &str = "a point is an object as in {\"light\": [[x,y,z], ...], \"point\": [x,y,z], \"normal\": [x,y,z], \
                     \"occluders\": [...]}; `id`, `two_sided` and `ltc` may be left out";

/// A point that was asked about.
pub(super) struct Row {
    /// Its name, as it was given.
    pub(super) id: Value,
    /// The question.
    pub(super) question: Question,
}

/// Reads all points of a text.
///
/// # Errors
/// With every mistake, as far as they are shown.
pub(super) fn rows(source: &std::sync::Arc<Source>) -> std::result::Result<Vec<Row>, Vec<Diagnostic>> {
    let malformed = |error: &serde_json::Error| vec![raw::malformed(codes::BAD_POINT, source, error).help(SHAPE)];
    let objects: Vec<&RawValue> = match source.text.trim_start().starts_with('[') {
        true => serde_json::from_str(&source.text).map_err(|error| malformed(&error))?,
        false => {
            let lines = serde_json::Deserializer::from_str(&source.text).into_iter::<&RawValue>();
            lines.collect::<serde_json::Result<_>>().map_err(|error| malformed(&error))?
        }
    };
    let (mut rows, mut problems) = (Vec::with_capacity(objects.len()), Problems::default());
    for object in objects {
        let id = name(object);
        match row(object, &id) {
            Ok(row) => rows.push(row),
            Err(mistake) => problems.push(|| described(source, &id, mistake)),
        }
    }
    if problems.is_empty() { Ok(rows) } else { Err(problems.into_failure(source.clone()).diagnostics) }
}

fn described(source: &Source, id: &Value, mistake: Mistake<'_>) -> Diagnostic {
    let place = raw::span(source, mistake.at);
    let named = match id {
        Value::Null => String::new(),
        Value::String(name) => format!(", id `{}`", shorten(name)),
        other => format!(", id {}", shorten(&other.to_string())),
    };
    let message = format!("line {}{named}: {}", source.line(place.start), mistake.message);
    let first_line = crate::cli::input::first_line(&source.text, place);
    let shown = Span::new(first_line.start, first_line.end.min(first_line.start + 200));
    let error = Diagnostic::error(codes::BAD_POINT, message).at(shown, "here");
    error.help(mistake.help.unwrap_or_else(|| SHAPE.to_owned()))
}

fn light<'s>(raw: &'s RawValue) -> Read<'s, Vec<DVec3>> {
    let count = items(raw, "the light")?.len();
    if !(3..=8).contains(&count) {
        let message = format!("a light has 3 to 8 corners, and this one has {count}");
        return Err(Mistake::new(raw, message).help("divide it into several lights"));
    }
    polygon(raw, "the light")?.map_err(|fault| faulty(raw, "the light", fault))
}

fn shape<'s>(raw: &'s RawValue) -> Read<'s, Shape> {
    let [view, inverse] = entries(raw, "`ltc`", ["view", "minv"])?;
    let missing = |name: &str| Mistake::new(raw, format!("`ltc` has no `{name}`"));
    let view = direction(view.ok_or_else(|| missing("view"))?, "`view`")?;
    let matrix = inverse.ok_or_else(|| missing("minv"))?;
    let expected = || Mistake::new(matrix, "`minv` is three rows of three numbers");
    let inverse: [[f64; 3]; 3] = serde_json::from_str(matrix.get()).map_err(|_| expected())?;
    match inverse.as_flattened().iter().all(|number| number.abs() <= FAR) {
        true => Ok(Shape { view, inverse }),
        false => Err(Mistake::new(matrix, format!("`minv` has a number beyond {FAR:e}"))),
    }
}

/// The name of a point, which mistakes in it say as well.
fn name(raw: &RawValue) -> Value {
    let entries = serde_json::from_str::<Object<'_>>(raw.get());
    let id = entries.ok().and_then(|Object(all)| all.into_iter().find(|(name, _)| name == "id"));
    id.and_then(|(_, id)| serde_json::from_str(id.get()).ok()).unwrap_or_default()
}

fn row<'s>(raw: &'s RawValue, id: &Value) -> Read<'s, Row> {
    const NAMES: [&str; 7] = ["id", "light", "two_sided", "point", "normal", "occluders", "ltc"];
    let [_, corners, two_sided, point, normal, bodies, ltc] = entries(raw, "a point", NAMES)?;
    let given = |value: Option<&'s RawValue>, name: &str| {
        value.ok_or_else(|| Mistake::new(raw, format!("the point has no `{name}`")))
    };
    let two_sided = match two_sided {
        Some(two_sided) => serde_json::from_str(two_sided.get())
            .map_err(|_| Mistake::new(two_sided, "`two_sided` is true or false"))?,
        None => false,
    };
    let question = Question {
        light: light(given(corners, "light")?)?,
        two_sided,
        point: vector(given(point, "point")?, "`point`")?,
        normal: direction(given(normal, "normal")?, "`normal`")?,
        occluders: match bodies {
            Some(bodies) => {
                let bodies = items(bodies, "`occluders`")?;
                bodies.into_iter().map(occluders::occluder).collect::<Read<'s, Vec<_>>>()?
            }
            None => Vec::new(),
        },
        shape: ltc.map(shape).transpose()?,
    };
    Ok(Row { id: id.clone(), question })
}
