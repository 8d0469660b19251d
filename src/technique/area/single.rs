//! Points in single precision, and in double where they are beyond its range.

use super::occluder::{Occluder, is_outside};
use super::panel::Panel;
use super::point::{Answer, Peeler, Query};
use super::scalar::length;
use super::viewpoint::Viewpoint;
use crate::diag::Failure;

/// The largest distance of an occluder, in lengths of the way to the light's farthest corner: single precision takes
/// what is flatter than a millionth of that for flat.
const FARTHEST: f64 = 64.0;

/// The method in single precision; a point whose numbers are too large or too small for it is computed in double.
#[derive(Debug)]
pub struct SinglePeeler {
    narrow: Peeler<f32>,
    wide: Peeler<f64>,
}

impl SinglePeeler {
    /// By the tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub fn new() -> Result<Self, Failure> {
        Ok(Self { narrow: Peeler::new()?, wide: Peeler::new()? })
    }

    /// The light at some points.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub fn answers(&mut self, queries: &[Query<'_>]) -> Result<Vec<Answer>, Failure> {
        let mut all = self.narrow.answers(queries.iter().cloned())?;
        let is_beyond = |index: &usize| !all[*index].is_finite() || is_beyond(&queries[*index]);
        let beyond: Vec<usize> = (0..all.len()).filter(is_beyond).collect();
        let rest = beyond.iter().map(|index| queries[*index].clone());
        for (index, answer) in beyond.iter().zip(self.wide.answers(rest)?) {
            all[*index] = answer;
        }
        Ok(all)
    }
}

/// Returns whether something before a light reaches so far that single precision would take it for flat.
fn is_beyond(query: &Query<'_>) -> bool {
    let Some(from) = Viewpoint::new(query.point, query.light, query.blur) else { return false };
    let Some(panel) = Panel::<f64>::new(query.light, &from) else { return false };
    between(query, &from, &panel).any(|occluder| reaches_far(occluder, &from))
}

/// The occluders whose spheres do not lie outside one of the planes of a light.
pub(super) fn between<'q>(
    query: &'q Query<'_>,
    from: &'q Viewpoint,
    panel: &'q Panel<f64>,
) -> impl Iterator<Item = &'q Occluder> {
    let seen = |occluder: &Occluder| {
        let (centre, radius) = occluder.sphere();
        (from.see::<f64>(centre), from.length(radius))
    };
    query.occluders.iter().copied().filter(move |occluder| !is_outside(panel, seen(occluder)))
}

/// Returns whether an occluder reaches farther than single precision allows.
pub(super) fn reaches_far(occluder: &Occluder, from: &Viewpoint) -> bool {
    let (centre, radius) = occluder.sphere();
    length(from.see::<f64>(centre)) + from.length(radius) > FARTHEST
}
