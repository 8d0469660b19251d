//! JSON values of points and occluders, each checked where it stands.

use glam::DVec3;
use serde_json::value::RawValue;

use crate::cli::input::raw::Object;
use crate::cli::input::shorten;
use crate::scene::flat::{self, Fault};
use crate::text::closest::nearest;

/// Largest coordinate: products of several stay numbers.
pub(super) const FAR: f64 = 1e15;

/// A mistake in a value: the value, the reason, and how to mend it.
pub(super) struct Mistake<'s> {
    /// The value.
    pub(super) at: &'s RawValue,
    pub(super) message: String,
    pub(super) help: Option<String>,
}

pub(super) type Read<'s, T> = std::result::Result<T, Mistake<'s>>;

impl<'s> Mistake<'s> {
    pub(super) fn new(at: &'s RawValue, message: impl Into<String>) -> Self {
        Self { at, message: message.into(), help: None }
    }

    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
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
            return Err(match nearest(&name, names) {
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
pub(super) fn direction<'s>(raw: &'s RawValue, what: &str) -> Read<'s, DVec3> {
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
