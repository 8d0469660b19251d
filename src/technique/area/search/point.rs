//! The light of a polygon at a point by search: as peeling answers it, but for the visible part.

use glam::DVec3;

use super::super::integral::Sums;
use super::super::peel::Work;
use super::super::point::{Answer, Peeler, Query, Seen, Wanted};
use super::super::sampling::Stream;
use super::super::scalar::{Scalar, Vector, dot};
use super::{Edge, Options, Region, Searcher};
use crate::diag::Failure;

/// The light at a point, and how it was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// The light. Its pieces are the visible loops, its clips those against horizons, and an overflow says that
    /// several occluders, or faces of one, are before the light, which the method is not made for.
    pub answer: Answer,
    /// The configuration of each triangle that the light was cut into, by its number in the table and its name; none for
    /// a light without area.
    pub configurations: Vec<(u32, &'static str)>,
    /// Tests of visibility.
    pub tests: u64,
    /// For each edge of the light the places where its visibility changes, from 0 at its start to 1 at its end.
    pub discontinuities: Vec<Vec<f64>>,
}

impl Found {
    /// The number of the first triangle's configuration.
    pub(super) fn first_configuration(&self) -> Option<u32> {
        self.configurations.first().map(|(number, _)| *number)
    }
}

/// Searches whose sums are still to be evaluated.
pub(super) struct Batch<T> {
    sums: Sums<T>,
    parts: Vec<(Answer, Wanted)>,
    /// Each with the number of corners of the light.
    ways: Vec<(super::Seen, usize)>,
}

impl<T> Default for Batch<T> {
    fn default() -> Self {
        Self { sums: Sums::default(), parts: Vec::new(), ways: Vec::new() }
    }
}

/// The method with its tables, in one precision.
#[derive(Debug)]
pub struct Finder<T> {
    peeler: Peeler<T>,
    searcher: Searcher,
}

impl<T: Scalar> Finder<T> {
    /// By the tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub fn new(options: Options) -> Result<Self, Failure> {
        Ok(Self { peeler: Peeler::new()?, searcher: Searcher::new(options)? })
    }

    /// The light at some points, each with its number, which its random numbers depend on, as they do on a seed.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub fn find<'q>(
        &mut self,
        queries: impl IntoIterator<Item = (u32, Query<'q>)>,
        seed: u32,
    ) -> Result<Vec<Found>, Failure> {
        let mut batch = Batch::default();
        for (number, query) in queries {
            let scene = self.peeler.seen(&query);
            let middle = query.light.iter().sum::<DVec3>() / query.light.len() as f64;
            let mut visibility = |place| scene.as_ref().is_some_and(|scene| is_visible(middle, scene, place));
            let mut stream = Stream::new([number, 0], 0, seed);
            self.add(&mut batch, &query, scene.as_ref(), None, (&mut stream, &mut visibility));
        }
        self.finish(batch)
    }

    /// Searches the light of a query, seen as `scene`, with the edges that were found from a neighbouring point, if
    /// there is one; returns its edges.
    pub(super) fn add(
        &mut self,
        batch: &mut Batch<T>,
        query: &Query<'_>,
        scene: Option<&Seen<T>>,
        neighbour: Option<&[Edge]>,
        (stream, visibility): (&mut Stream, &mut dyn FnMut(DVec3) -> bool),
    ) -> Vec<Edge> {
        let Some(scene) = scene else {
            batch.parts.push(self.peeler.nothing(query, &mut batch.sums));
            batch.ways.push((super::Seen::default(), query.light.len()));
            return Vec::new();
        };
        let seen = self.searcher.search(query.light, neighbour, stream, visibility);
        let part = self.answer(query, scene, &loops(scene, &seen.regions), &mut batch.sums);
        let edges = seen.edges.clone();
        batch.parts.push(part);
        batch.ways.push((seen, query.light.len()));
        edges
    }

    /// The light of a query and what may hide it, as its point sees them; `None` if the light has no area there.
    pub(super) fn seen(&self, query: &Query<'_>) -> Option<Seen<T>> {
        self.peeler.seen(query)
    }

    /// The answers to what was searched.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub(super) fn finish(&mut self, batch: Batch<T>) -> Result<Vec<Found>, Failure> {
        let answers = self.peeler.totals(batch.sums, batch.parts)?;
        Ok(answers.into_iter().zip(batch.ways).map(|(answer, (seen, corners))| found(answer, &seen, corners)).collect())
    }

    fn answer(
        &self,
        query: &Query<'_>,
        scene: &Seen<T>,
        loops: &[Vec<Vector<T>>],
        sums: &mut Sums<T>,
    ) -> (Answer, Wanted) {
        let apart = |corners: &[Vector<T>]| scene.cones.iter().flatten().filter(|cone| !cone.is_apart(corners)).count();
        let several = apart(&scene.panel.corners) > 1;
        let mut pieces = |horizons: &[Vector<T>], work: &mut Work, give: &mut dyn FnMut(&[Vector<T>])| {
            work.overflow |= several;
            for corners in loops {
                let clip = |corners: Vec<Vector<T>>, normal: &Vector<T>| self.peeler.inside(&corners, *normal);
                let above = horizons.iter().fold(corners.clone(), clip);
                work.clips += horizons.len() as u64;
                if !above.is_empty() {
                    work.pieces += 1;
                    give(&above);
                }
            }
        };
        self.peeler.add_up(query, &scene.panel, sums, &mut pieces)
    }
}

fn found(answer: Answer, seen: &super::Seen, corners: usize) -> Found {
    let mut discontinuities: Vec<Vec<f64>> = seen.edges.iter().map(|edge| edge.discontinuities().to_vec()).collect();
    discontinuities.resize(corners, Vec::new());
    Found {
        answer,
        configurations: seen.regions.iter().map(|region| region.configuration).collect(),
        tests: seen.tests,
        discontinuities,
    }
}

/// The visible loops, counter-clockwise as seen from the point.
fn loops<T: Scalar>(scene: &Seen<T>, regions: &[Region]) -> Vec<Vec<Vector<T>>> {
    let of = |corners: &Vec<DVec3>| {
        let mut seen: Vec<Vector<T>> = corners.iter().map(|corner| scene.from.see(*corner)).collect();
        if !scene.panel.in_front {
            seen.reverse();
        }
        seen
    };
    regions.iter().flat_map(|region| &region.loops).map(of).collect()
}

/// Returns whether nothing hides a place on a light with this middle.
///
/// On a border of the light it is what lies just within that counts; and as cones are closed there is no seam between two
/// that share an edge.
fn is_visible<T: Scalar>(middle: DVec3, scene: &Seen<T>, place: DVec3) -> bool {
    let Some(cones) = &scene.cones else { return false };
    let towards = scene.from.see::<T>(place + (middle - place) * (1e-2 * T::NOISE.sqrt()));
    let zero = T::from_f64(0.0);
    !cones.iter().any(|cone| cone.planes.iter().all(|plane| dot(*plane, towards) >= zero))
}
