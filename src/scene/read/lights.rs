//! The lights of a scene, and flat polygons, from RON.

use glam::DVec3;
use serde::Deserialize;

use super::{FAR, Read, Result, SMALL};
use crate::diag::{Diagnostic, codes};
use crate::scene::flat::{self, Fault};
use crate::scene::light::{Directional, Gaussian, Light, Polygon, Spot};
use crate::text::raw::Raw;

/// Most corners of a light.
const MAX_CORNERS: usize = 8;
/// Largest tilt of a light, in degrees.
const MAX_TILT: f64 = 80.0;
/// Largest deviation of a slope.
const MAX_DEVIATION: f64 = 1000.0;

#[derive(Deserialize)]
#[serde(rename = "Light", deny_unknown_fields)]
enum LightRon<'a> {
    Directional {
        #[serde(borrow)]
        direction: Raw<'a>,
        #[serde(default)]
        colour: Option<Raw<'a>>,
    },
    Spot {
        position: Raw<'a>,
        target: Raw<'a>,
        angle: Raw<'a>,
        #[serde(default)]
        colour: Option<Raw<'a>>,
    },
    Polygon {
        corners: Raw<'a>,
        #[serde(default)]
        two_sided: bool,
        #[serde(default)]
        colour: Option<Raw<'a>>,
    },
    Gaussian {
        #[serde(default)]
        tilts: Option<Raw<'a>>,
        deviations: Raw<'a>,
        #[serde(default)]
        rotation: Option<Raw<'a>>,
        #[serde(default)]
        colour: Option<Raw<'a>>,
    },
}

impl<'a> Read<'a> {
    /// The lights of a scene, of which one is written as `light` and several as `lights`.
    pub(super) fn lights(
        &self,
        light: Option<Raw<'a>>,
        lights: Option<Raw<'a>>,
    ) -> std::result::Result<Vec<Light>, Vec<Diagnostic>> {
        let alone = |error: Diagnostic| vec![error];
        match (light, lights) {
            (Some(light), None) => Ok(vec![self.light(light).map_err(alone)?]),
            (None, Some(list)) => {
                let raws: Vec<Raw<'a>> = self.reader.get(list).map_err(alone)?;
                if raws.is_empty() {
                    return Err(alone(self.wrong(list, "the list of lights is empty").help("list at least one light")));
                }
                let mut problems = Vec::new();
                let keep = |raw: Raw<'a>| self.light(raw).map_err(|error| problems.push(error)).ok();
                let lights: Vec<Light> = raws.into_iter().filter_map(keep).collect();
                if problems.is_empty() { Ok(lights) } else { Err(problems) }
            }
            (Some(light), Some(list)) => {
                let error = self.wrong(list, "the scene has both `light` and `lights`");
                let error = error.at(self.reader.span(light), "`light` is here");
                Err(alone(error.help("move the light of `light` into the list of `lights`")))
            }
            (None, None) => {
                let error = Diagnostic::error(codes::SCENE, "the scene has no light");
                Err(alone(error.help("add for instance `light: Directional(direction: (0.3, -1, 0.2))`")))
            }
        }
    }

    fn light(&self, raw: Raw<'a>) -> Result<Light> {
        let intensity = |raw: Option<Raw<'a>>| self.or(raw, [1.0; 3], |raw| self.triple(raw, 0.0, FAR));
        match self.reader.get(raw)? {
            LightRon::Directional { direction: at, colour } => {
                let direction = self.place(at)?;
                if direction.length() < SMALL {
                    let error = self.wrong(at, "the light has no direction");
                    return Err(error.help("say which way it goes, for instance (0.3, -1, 0.2)"));
                }
                Ok(Light::Directional(Directional { direction, colour: intensity(colour)? }))
            }
            LightRon::Spot { position, target, angle, colour } => {
                let (place, aim) = (self.place(position)?, self.place(target)?);
                if (aim - place).length() < SMALL {
                    let error = self.wrong(target, "the light points at its own place");
                    return Err(error.help("move `position` or `target`"));
                }
                let (angle, colour) = (self.angle(angle)?, intensity(colour)?);
                Ok(Light::Spot(Spot { position: place, target: aim, angle, colour }))
            }
            LightRon::Polygon { corners, two_sided, colour } => {
                let corners = self.polygon(corners, MAX_CORNERS)?;
                Ok(Light::Polygon(Polygon { corners, two_sided, colour: intensity(colour)? }))
            }
            LightRon::Gaussian { tilts, deviations, rotation, colour } => Ok(Light::Gaussian(Gaussian {
                tilts: self.or(tilts, [0.0; 2], |raw| self.tilts(raw))?,
                deviations: self.deviations(deviations)?,
                rotation: self.or(rotation, 0.0, |raw| self.number(raw, -360.0, 360.0))?,
                colour: intensity(colour)?,
            })),
        }
    }

    fn tilts(&self, raw: Raw<'a>) -> Result<[f64; 2]> {
        let (x, z): (f64, f64) = self.reader.get(raw)?;
        match [x, z].into_iter().find(|tilt| !(-MAX_TILT..=MAX_TILT).contains(tilt)) {
            None => Ok([x, z]),
            Some(tilt) => {
                let error = self.wrong(raw, &format!("a tilt of {tilt} degrees is out of range"));
                Err(error.help(format!("expected -{MAX_TILT} to {MAX_TILT}: 0 is straight above, 90 the horizon")))
            }
        }
    }

    fn deviations(&self, raw: Raw<'a>) -> Result<[f64; 2]> {
        let both: (f64, f64) = self.reader.get(raw)?;
        let both = [both.0, both.1];
        match both.into_iter().find(|deviation| *deviation < 0.0) {
            None => self.check(raw, &both, 0.0, MAX_DEVIATION).map(|()| both),
            Some(deviation) => {
                let error = self.wrong(raw, &format!("a deviation of {deviation} is negative"));
                Err(error.help("expected the standard deviations of the slope, 0 for a sharp light"))
            }
        }
    }

    /// The corners of a flat convex polygon.
    pub(super) fn polygon(&self, raw: Raw<'a>, most: usize) -> Result<Vec<DVec3>> {
        let raws: Vec<Raw<'a>> = self.reader.get(raw)?;
        if !(3..=most).contains(&raws.len()) {
            let error = self.wrong(raw, &format!("a polygon with {} corners is out of range", raws.len()));
            return Err(error.help(format!("expected 3 to {most} corners")));
        }
        let corners = raws.iter().map(|raw| self.place(*raw)).collect::<Result<Vec<DVec3>>>()?;
        let number = |index: usize| index + 1;
        match flat::check(&corners) {
            Ok(()) => Ok(corners),
            Err(Fault::Repeated(index)) => {
                let error = self.wrong(raws[index], &format!("corner {} repeats an earlier corner", number(index)));
                Err(error.help("a polygon is closed by itself: leave the corner out"))
            }
            Err(Fault::Area) => {
                let error = self.wrong(raw, "the polygon has no area");
                Err(error.help("its corners lie on a line, or it covers as much backwards as forwards"))
            }
            Err(Fault::Plane(index, off)) => {
                let message = format!("corner {} is {off:.3} off the plane of the polygon", number(index));
                Err(self.wrong(raws[index], &message).help("a polygon is flat: move the corner, or use two polygons"))
            }
            Err(Fault::Convex(side, corner)) => {
                let next = number((side + 1) % corners.len());
                let message = format!("the polygon is not convex at corner {}", number(corner));
                let error = self.wrong(raws[corner], &message);
                let help =
                    format!("it lies on the outer side of the edge from corner {} to corner {next}", number(side));
                Err(error.help(help).help("list the corners of a convex polygon one after the other around it"))
            }
        }
    }
}
