//! Patterns inside of objects, and the matter that their values stand for.

use glam::DAffine3;
use serde::Deserialize;

use super::{Read, Result};
use crate::scene::matter::{Detail, Knot, Matter, Pattern};
use crate::text::raw::Raw;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum PatternRon<'a> {
    Fbm {
        #[serde(borrow)]
        size: Raw<'a>,
        #[serde(default)]
        octaves: Option<Raw<'a>>,
        #[serde(default)]
        lacunarity: Option<Raw<'a>>,
        #[serde(default)]
        gain: Option<Raw<'a>>,
    },
    Ridged {
        size: Raw<'a>,
        #[serde(default)]
        octaves: Option<Raw<'a>>,
        #[serde(default)]
        lacunarity: Option<Raw<'a>>,
        #[serde(default)]
        power: Option<Raw<'a>>,
        #[serde(default)]
        offset: Option<Raw<'a>>,
        #[serde(default)]
        gain: Option<Raw<'a>>,
    },
    Brick {
        size: Raw<'a>,
        mortar: Raw<'a>,
    },
}

#[derive(Deserialize)]
#[serde(rename = "Knot", deny_unknown_fields)]
struct KnotRon<'a> {
    #[serde(borrow)]
    value: Raw<'a>,
    opacity: Raw<'a>,
    #[serde(default)]
    colour: Option<Raw<'a>>,
    #[serde(default)]
    transport: Option<Raw<'a>>,
}

/// Most knots of a transfer function.
const MOST_KNOTS: usize = 256;
/// Largest value of a knot: what the tables are made for.
const MOST_VALUE: f64 = 1e4;
/// Smallest part of a pattern.
const SMALLEST: f64 = 1e-3;
/// Largest part of a pattern.
const LARGEST: f64 = 4096.0;

impl<'a> Read<'a> {
    /// The detail of an object with this colour and matter, from a pattern and a transfer function. Without the latter a
    /// value of 0 is nothing, and one of 1 the object's own matter.
    pub(super) fn detail(
        &self,
        object: Raw<'a>,
        (detail, transfer): (Option<Raw<'a>>, Option<Raw<'a>>),
        (colour, matter): ([f64; 3], Matter),
        to_object: DAffine3,
    ) -> Result<Option<Detail>> {
        let Some(raw) = detail else {
            return match transfer {
                None => Ok(None),
                Some(raw) => {
                    let error = self.wrong(raw, "the object has no pattern whose values this could be for");
                    Err(error.help("give it one: `detail: Fbm(size: 0.5)`, for instance"))
                }
            };
        };
        let pattern = self.pattern(raw)?;
        let own = |value: f64, opacity: f64| Knot { value, colour, opacity, transport: matter.transport };
        let knots = match transfer {
            None => vec![own(0.0, 0.0), own(1.0, matter.opacity)],
            Some(raw) => self.knots(raw, colour, matter)?,
        };
        if knots.len() < 2 || knots.len() > MOST_KNOTS {
            let message = format!("{} knots are no transfer function", knots.len());
            let error = self.wrong(transfer.unwrap_or(object), &message);
            return Err(error.help(format!("list 2 to {MOST_KNOTS} knots")));
        }
        Ok(Some(Detail { pattern, to_object, knots }))
    }

    fn pattern(&self, raw: Raw<'a>) -> Result<Pattern> {
        let length = |raw| self.number(raw, SMALLEST, LARGEST);
        let octaves = |raw: Option<Raw<'a>>| self.or(raw, 4, |raw| self.count(raw, 12));
        let or =
            |raw: Option<Raw<'a>>, usual: f64, lo: f64, hi: f64| self.or(raw, usual, |raw| self.number(raw, lo, hi));
        Ok(match self.reader.get(raw)? {
            PatternRon::Fbm { size, octaves: count, lacunarity, gain } => Pattern::Fbm {
                size: length(size)?,
                octaves: octaves(count)?,
                lacunarity: or(lacunarity, 2.0, 1.0, 4.0)?,
                gain: or(gain, 0.5, 0.0, 16.0)?,
            },
            PatternRon::Ridged { size, octaves: count, lacunarity, power, offset, gain } => Pattern::Ridged {
                size: length(size)?,
                octaves: octaves(count)?,
                lacunarity: or(lacunarity, 2.0, 1.0, 4.0)?,
                power: or(power, 1.0, 0.0, 4.0)?,
                offset: or(offset, 1.0, 0.0, 4.0)?,
                gain: or(gain, 2.0, 0.0, 16.0)?,
            },
            PatternRon::Brick { size, mortar } => {
                Pattern::Brick { size: self.triple(size, SMALLEST, LARGEST)?, mortar: self.number(mortar, 0.0, 1.0)? }
            }
        })
    }

    fn knots(&self, raw: Raw<'a>, colour: [f64; 3], matter: Matter) -> Result<Vec<Knot>> {
        let all: Vec<Raw<'a>> = self.reader.get(raw)?;
        let mut knots: Vec<Knot> = Vec::new();
        for raw in all {
            let ron: KnotRon<'_> = self.reader.get(raw)?;
            let value = self.number(ron.value, -MOST_VALUE, MOST_VALUE)?;
            if knots.last().is_some_and(|last| last.value > value) {
                let error = self.wrong(ron.value, "a knot has a smaller value than the one before");
                return Err(error.help("order knots by their values"));
            }
            knots.push(Knot {
                value,
                colour: self.or(ron.colour, colour, |raw| self.colour(raw))?,
                opacity: self.number(ron.opacity, 0.0, 1.0)?,
                transport: self.or(ron.transport, matter.transport, |raw| self.colour(raw))?,
            });
        }
        Ok(knots)
    }
}
