//! The light of a polygon at a point behind occluders, exactly: the whole method for one point.

use std::borrow::Cow;

use glam::DVec3;

use super::clip::Clipper;
use super::cone::Cone;
use super::integral::{Integrals, Sums};
use super::occluder::{Hidden, Occluder, Silhouettes, is_outside};
use super::panel::{Horizon, Panel};
use super::peel::{Work, peel};
use super::scalar::{Scalar, Vector, dot, rounded};
use super::viewpoint::Viewpoint;
use crate::diag::Failure;

/// A point, a light, and what may be in between.
#[derive(Debug, Clone, PartialEq)]
pub struct Query<'a> {
    /// The corners of the light, 3 to 8, counter-clockwise as seen from the side that emits.
    pub light: &'a [DVec3],
    /// True if both sides emit.
    pub two_sided: bool,
    /// The point.
    pub point: DVec3,
    /// The distance from the point within which it may truly be, as where a ray has found it: surfaces nearer than that
    /// are taken to go through it.
    pub blur: f64,
    /// The normal at the point; of any length but zero.
    pub normal: DVec3,
    /// True if [`Answer::fraction`] is asked for, which the light has to be peeled a second time for.
    pub fraction: bool,
    /// The occluders.
    pub occluders: Cow<'a, [&'a Occluder]>,
    /// The shape that a glossy surface gives to light, if that is asked.
    pub shape: Option<Shape>,
}

/// A query with all that it refers to.
#[derive(Debug, Clone, PartialEq)]
pub struct Question {
    /// [`Query::light`]
    pub light: Vec<DVec3>,
    /// [`Query::two_sided`]
    pub two_sided: bool,
    /// [`Query::point`], which is exact.
    pub point: DVec3,
    /// [`Query::normal`]
    pub normal: DVec3,
    /// [`Query::occluders`]
    pub occluders: Vec<Occluder>,
    /// [`Query::shape`]
    pub shape: Option<Shape>,
}

impl Question {
    /// The query about everything that there is to know.
    pub fn query(&self) -> Query<'_> {
        Query {
            light: &self.light,
            two_sided: self.two_sided,
            point: self.point,
            blur: 0.0,
            normal: self.normal,
            fraction: true,
            occluders: self.occluders.iter().collect(),
            shape: self.shape,
        }
    }
}

/// A linear transform that takes a distribution of reflected light to a cosine (Heitz et al. 2016).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// The direction of the viewer; of any length but zero.
    pub view: DVec3,
    /// The rows of the inverse matrix, in the frame of the view's part along the surface, the direction at right angles
    /// to both, and the normal.
    pub inverse: [[f64; 3]; 3],
}

/// The light at a point.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Answer {
    /// The share of the light's area that no occluder hides, the horizon ignored; `None` where it has no area, the point
    /// lies in its plane, or it was not asked for.
    pub fraction: Option<f64>,
    /// The share that also lies above the horizon.
    pub fraction_above_horizon: Option<f64>,
    /// The form factor, from 0 to 1.
    pub form_factor: f64,
    /// The form factor without the occluders.
    pub form_factor_unshadowed: f64,
    /// The form factor of what is left after the transform of [`Query::shape`], with and without the occluders.
    pub shaped: Option<(f64, f64)>,
    /// The work for the form factor.
    pub work: Work,
}

/// The method with its tables, in one precision.
#[derive(Debug)]
pub struct Peeler<T> {
    clipper: Clipper,
    horizon: Horizon,
    silhouettes: Silhouettes,
    integrals: Integrals<T>,
}

/// Sums of a point.
pub(super) struct Wanted {
    shadowed: usize,
    unshadowed: usize,
    shaped: Option<(usize, usize)>,
}

/// Gives the visible pieces of a light above some planes through the point, by their normals, and counts the work.
pub(super) type Pieces<'p, T> = dyn FnMut(&[Vector<T>], &mut Work, &mut dyn FnMut(&[Vector<T>])) + 'p;

/// A light and what may hide it, as seen from a point.
pub(super) struct Seen<T> {
    pub(super) from: Viewpoint,
    pub(super) panel: Panel<T>,
    /// `None` if everything is hidden.
    pub(super) cones: Option<Vec<Cone<T>>>,
}

impl Wanted {
    fn new<T: Scalar>(query: &Query<'_>, sums: &mut Sums<T>) -> Self {
        let (shadowed, unshadowed) = (sums.begin(), sums.begin());
        Self { shadowed, unshadowed, shaped: query.shape.map(|_| (sums.begin(), sums.begin())) }
    }
}

impl Answer {
    /// Returns whether nothing was too large or too small for the precision that it was computed in.
    pub fn is_finite(&self) -> bool {
        let shares = [self.fraction, self.fraction_above_horizon].into_iter().flatten();
        let factors = [self.form_factor, self.form_factor_unshadowed];
        let shaped = self.shaped.into_iter().flat_map(|(with, without)| [with, without]);
        shares.chain(factors).chain(shaped).all(f64::is_finite)
    }
}

impl<T: Scalar> Peeler<T> {
    /// By the tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub fn new() -> Result<Self, Failure> {
        let clipper = Clipper::new()?;
        Ok(Self { silhouettes: Silhouettes::new()?, horizon: Horizon::new()?, clipper, integrals: Integrals::new()? })
    }

    /// The light at some points.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub fn answers<'q>(&mut self, queries: impl IntoIterator<Item = Query<'q>>) -> Result<Vec<Answer>, Failure> {
        let mut sums = Sums::default();
        let parts: Vec<(Answer, Wanted)> = queries.into_iter().map(|query| self.answer(&query, &mut sums)).collect();
        self.totals(sums, parts)
    }

    /// The answers, once the sums that they want are evaluated.
    pub(super) fn totals(&mut self, sums: Sums<T>, parts: Vec<(Answer, Wanted)>) -> Result<Vec<Answer>, Failure> {
        let totals = self.integrals.evaluate(sums)?;
        Ok(parts
            .into_iter()
            .map(|(answer, wanted)| Answer {
                form_factor: totals[wanted.shadowed],
                form_factor_unshadowed: totals[wanted.unshadowed],
                shaped: wanted.shaped.map(|(with, without)| (totals[with], totals[without])),
                ..answer
            })
            .collect())
    }

    fn answer(&self, query: &Query<'_>, sums: &mut Sums<T>) -> (Answer, Wanted) {
        let Some(scene) = self.seen(query) else { return self.nothing(query, sums) };
        let mut pieces = |horizons: &[Vector<T>], work: &mut Work, give: &mut dyn FnMut(&[Vector<T>])| {
            let corners = self.above(&scene.panel, horizons);
            work.clips += horizons.len() as u64;
            match &scene.cones {
                Some(cones) if !corners.is_empty() => peel(&self.clipper, corners, cones, work, give),
                _ => {}
            }
        };
        self.add_up(query, &scene.panel, sums, &mut pieces)
    }

    /// The answer where there is no light.
    pub(super) fn nothing(&self, query: &Query<'_>, sums: &mut Sums<T>) -> (Answer, Wanted) {
        (Answer::default(), Wanted::new(query, sums))
    }

    /// A light and what may hide it, as seen from a point; `None` if the light has no area there.
    pub(super) fn seen(&self, query: &Query<'_>) -> Option<Seen<T>> {
        let from = Viewpoint::new(query.point, query.light, query.blur)?;
        let panel = Panel::<T>::new(query.light, &from)?;
        let cones = self.cones(&query.occluders, &from, &panel);
        Some(Seen { from, panel, cones })
    }

    /// The part of a light above some planes through the point, of which the first is the horizon.
    fn above(&self, panel: &Panel<T>, horizons: &[Vector<T>]) -> Vec<Vector<T>> {
        let Some((horizon, others)) = horizons.split_first() else { return panel.corners.clone() };
        let above = self.horizon.above(&self.clipper, &panel.corners, *horizon);
        others.iter().fold(above, |corners, normal| self.inside(&corners, *normal))
    }

    /// The part of a loop above a plane through the point.
    pub(super) fn inside(&self, corners: &[Vector<T>], normal: Vector<T>) -> Vec<Vector<T>> {
        let heights: Vec<T> = corners.iter().map(|corner| dot(normal, *corner)).collect();
        self.clipper.inside(corners, &heights)
    }

    /// Adds up the visible pieces of a light, of which `pieces` gives those above some planes through the point.
    pub(super) fn add_up(
        &self,
        query: &Query<'_>,
        panel: &Panel<T>,
        sums: &mut Sums<T>,
        pieces: &mut Pieces<'_, T>,
    ) -> (Answer, Wanted) {
        let wanted = Wanted::new(query, sums);
        let mut answer = Answer::default();
        let normal = unit(query.normal);
        let world: Vector<T> = rounded(normal.to_array());
        if query.fraction {
            let mut share = 0.0;
            pieces(&[], &mut Work::default(), &mut |piece| share += panel.share(piece));
            answer.fraction = Some(share);
        }

        let mut work = Work::default();
        let emits = query.two_sided || panel.in_front;
        let is_far = panel.is_far();
        let mut add = |sum: usize, piece: &[Vector<T>]| match is_far {
            true => sums.add_far(sum, piece, world),
            false => sums.add(sum, piece, world),
        };
        let mut share = 0.0;
        pieces(&[world], &mut work, &mut |piece| {
            share += panel.share(piece);
            if emits {
                add(wanted.shadowed, piece);
            }
        });
        (answer.fraction_above_horizon, answer.work) = (Some(share), work);
        let above = self.above(panel, &[world]);
        if emits && !above.is_empty() {
            add(wanted.unshadowed, &above);
        }
        if let (Some(shape), Some((shadowed, unshadowed)), true) = (query.shape, wanted.shaped, emits) {
            let frame = shape.rows(normal).map(rounded::<T>);
            let up = [T::from_f64(0.0), T::from_f64(0.0), T::from_f64(1.0)];
            let mut add = |sum: usize, piece: &[Vector<T>]| {
                let turned: Vec<Vector<T>> = piece.iter().map(|corner| frame.map(|row| dot(row, *corner))).collect();
                sums.add(sum, &turned, up);
            };
            let horizons = [world, frame[2]];
            pieces(&horizons, &mut Work::default(), &mut |piece| add(shadowed, piece));
            let above = self.above(panel, &horizons);
            if !above.is_empty() {
                add(unshadowed, &above);
            }
        }
        (answer, wanted)
    }

    /// The cones of what can hide a part of the light; `None` if everything is hidden.
    fn cones(&self, occluders: &[&Occluder], from: &Viewpoint, panel: &Panel<T>) -> Option<Vec<Cone<T>>> {
        let mut cones = Vec::new();
        for occluder in occluders {
            let (centre, radius) = occluder.sphere();
            if is_outside(panel, (from.see(centre), from.length(radius))) {
                continue;
            }
            match self.silhouettes.hidden(occluder, from, panel) {
                Hidden::All => return None,
                Hidden::Cones(more) => cones.extend(more),
            }
        }
        Some(cones)
    }
}

/// A vector of any length but zero, made as long as 1; its squares may be too large or too small for a number.
pub(super) fn unit(vector: DVec3) -> DVec3 {
    (vector / vector.abs().max_element()).normalize()
}

impl Shape {
    /// The rows of the inverse matrix in the axes of the world, at a point with a unit normal.
    pub(super) fn rows(&self, normal: DVec3) -> [Vector<f64>; 3] {
        let view = unit(self.view);
        let along = view - normal * view.dot(normal);
        // With the view along the normal any direction will do.
        let first = if along.length() > 1e-9 { along.normalize() } else { normal.any_orthonormal_vector() };
        let frame = [first, normal.cross(first), normal];
        self.inverse.map(|row| (frame[0] * row[0] + frame[1] * row[1] + frame[2] * row[2]).to_array())
    }
}
