//! Points as JSON → queries, each mistake at its place.

use glam::DVec3;
use serde_json::Value;
use serde_json::value::RawValue;

use super::occluders;
use crate::cli::input::raw::{self, Object};
use crate::cli::input::{Problems, shorten};
use crate::diag::{Diagnostic, Source, Span, codes};
use crate::scene::flat::{self, Fault};
use crate::technique::area::{Occluder, Query, Shape};
use crate::text::closest::nearest;

const SHAPE: &str = "a point is an object as in {\"light\": [[x,y,z], ...], \"point\": [x,y,z], \"normal\": [x,y,z], \
                     \"occluders\": [...]}; `id`, `two_sided` and `ltc` may be left out";

/// Largest coordinate: products of several stay numbers.
const FAR: f64 = 1e15;

/// A point that was asked about.
pub(super) struct Row {
    /// Its name, as it was given.
    pub(super) id: Value,
    light: Vec<DVec3>,
    two_sided: bool,
    point: DVec3,
    normal: DVec3,
    occluders: Vec<Occluder>,
    shape: Option<Shape>,
}

impl Row {
    /// The question.
    pub(super) fn query(&self) -> Query<'_> {
        Query {
            light: &self.light,
            two_sided: self.two_sided,
            point: self.point,
            blur: 0.0,
            normal: self.normal,
            occluders: self.occluders.iter().collect(),
            shape: self.shape,
        }
    }
}

/// A mistake in a value: the value, the reason, and how to mend it.
pub(super) struct Mistake<'s> {
    at: Option<&'s RawValue>,
    message: String,
    help: Option<String>,
}

pub(super) type Read<'s, T> = std::result::Result<T, Mistake<'s>>;

impl<'s> Mistake<'s> {
    pub(super) fn new(at: &'s RawValue, message: impl Into<String>) -> Self {
        Self { at: Some(at), message: message.into(), help: None }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
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
            Err(mistake) => problems.push(|| described(source, object, &id, mistake)),
        }
    }
    if problems.is_empty() { Ok(rows) } else { Err(problems.into_failure(source.clone()).diagnostics) }
}

fn described(source: &Source, object: &RawValue, id: &Value, mistake: Mistake<'_>) -> Diagnostic {
    let place = raw::span(source, mistake.at.unwrap_or(object));
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

/// The entries of an object that has no others than these.
pub(super) fn entries<'s, const N: usize>(
    raw: &'s RawValue,
    what: &str,
    names: [&str; N],
) -> Read<'s, [Option<&'s RawValue>; N]> {
    let Ok(Object(entries)) = serde_json::from_str::<Object<'s>>(raw.get()) else {
        return Err(Mistake::new(raw, format!("{what} is an object")));
    };
    let mut found = [None; N];
    for (name, value) in entries {
        let Some(place) = names.iter().position(|known| *known == name) else {
            let mistake = Mistake::new(value, format!("{what} has no field `{}`", shorten(&name)));
            return Err(match nearest(&name, names.into_iter()) {
                Some(close) => mistake.help(format!("did you mean `{close}`?")),
                None => mistake.help(format!("the fields are {}", names.join(", "))),
            });
        };
        if found[place].replace(value).is_some() {
            return Err(Mistake::new(value, format!("`{name}` is given twice")).help("remove one of the two"));
        }
    }
    Ok(found)
}

/// The items of an array.
pub(super) fn items<'s>(raw: &'s RawValue, what: &str) -> Read<'s, Vec<&'s RawValue>> {
    serde_json::from_str(raw.get()).map_err(|_| Mistake::new(raw, format!("{what} is an array")))
}

/// Three numbers.
pub(super) fn vector<'s>(raw: &'s RawValue, what: &str) -> Read<'s, DVec3> {
    let expected = || Mistake::new(raw, format!("{what} is [x, y, z], three numbers"));
    let numbers: [f64; 3] = serde_json::from_str(raw.get()).map_err(|_| expected())?;
    match numbers.iter().all(|number| number.abs() <= FAR) {
        true => Ok(DVec3::from_array(numbers)),
        false => Err(Mistake::new(raw, format!("{what} has a coordinate beyond {FAR:e}")).help("use a larger unit")),
    }
}

/// Three numbers that give a direction.
fn direction<'s>(raw: &'s RawValue, what: &str) -> Read<'s, DVec3> {
    let vector = vector(raw, what)?;
    match vector == DVec3::ZERO {
        true => Err(Mistake::new(raw, format!("{what} has no direction")).help("any length but zero will do")),
        false => Ok(vector),
    }
}

/// The corners of a flat convex polygon, each place once; fewer than three where it has no area.
pub(super) fn polygon<'s>(raw: &'s RawValue, what: &str) -> Read<'s, std::result::Result<Vec<DVec3>, Fault>> {
    let corner = |raw: &&'s RawValue| vector(raw, &format!("a corner of {what}"));
    let mut corners = items(raw, what)?.iter().map(corner).collect::<Read<'s, Vec<DVec3>>>()?;
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 {
        return Ok(Ok(Vec::new()));
    }
    Ok(match flat::check(&corners) {
        Ok(()) => Ok(corners),
        Err(Fault::Area) => Ok(Vec::new()),
        Err(fault) => Err(fault),
    })
}

fn light<'s>(raw: &'s RawValue) -> Read<'s, Vec<DVec3>> {
    let count = items(raw, "the light")?.len();
    if !(3..=8).contains(&count) {
        let message = format!("a light has 3 to 8 corners, and this one has {count}");
        return Err(Mistake::new(raw, message).help("divide it into several lights"));
    }
    polygon(raw, "the light")?.map_err(|fault| faulty(raw, "the light", fault))
}

/// The refusal of corners.
pub(super) fn faulty<'s>(raw: &'s RawValue, what: &str, fault: Fault) -> Mistake<'s> {
    let (message, help) = match fault {
        Fault::Repeated(corner) => {
            (format!("corner {} of {what} repeats an earlier one", corner + 1), "name each once")
        }
        Fault::Area => (format!("{what} has no area"), "its corners lie on a line"),
        Fault::Plane(corner, distance) => (
            format!("corner {} of {what} is {distance:.3e} off the plane of the others", corner + 1),
            "divide it into triangles",
        ),
        Fault::Convex(side, corner) => (
            format!("{what} is not convex: corner {} lies outside of the side from corner {}", corner + 1, side + 1),
            "divide it into convex polygons, and name corners in their order around it",
        ),
    };
    Mistake::new(raw, message).help(help)
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
    Ok(Row {
        id: id.clone(),
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
    })
}
