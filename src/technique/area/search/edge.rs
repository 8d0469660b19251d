//! Edges of lights, and the discontinuities along them: by the table `search_plan`.

use super::Search;
use super::line::Line;
use super::tables::Method;

/// An edge: the visibility of its ends, and the places where it changes between them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Edge {
    /// The visibility of its start and of its end.
    pub(super) ends: [bool; 2],
    count: usize,
    places: [f64; 2],
}

impl Edge {
    /// An edge with up to two discontinuities, in any order.
    pub(super) fn new(ends: [bool; 2], discontinuities: &[f64]) -> Self {
        let mut edge = Self { ends, count: discontinuities.len(), places: [0.0; 2] };
        edge.places[..edge.count].copy_from_slice(discontinuities);
        edge.places[..edge.count].sort_by(f64::total_cmp);
        edge
    }

    /// The places where the visibility changes, in ascending order, as parameters from 0 to 1: at most two.
    pub fn discontinuities(&self) -> &[f64] {
        &self.places[..self.count]
    }

    /// The same from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        let places = self.discontinuities().iter().map(|place| 1.0 - place);
        Self::new([self.ends[1], self.ends[0]], &places.collect::<Vec<f64>>())
    }
}

impl Search<'_> {
    /// The discontinuities of an edge, looked for first where the neighbouring pixel has some.
    pub(super) fn edge(&mut self, line: Line, ends: [bool; 2], neighbour: Option<&Edge>) -> Edge {
        let seen = ends[0];
        let known = neighbour.map(|edge| (edge.ends[0], edge.discontinuities()));
        let plan = self.tables.plan(ends, known);
        let (found, between) = match plan.method {
            Method::Bisect => {
                let place = self.bisect(line, (plan.from, plan.to), seen, self.options.tolerance);
                return Edge::new(ends, &[place]);
            }
            Method::Search => (None, (plan.from, plan.to)),
            Method::Probe => ((self.sees(line.at(plan.at)) != seen).then_some(plan.at), (plan.from, plan.to)),
        };
        match found.or_else(|| self.differing(line, between, seen)) {
            None => Edge::new(ends, &[]),
            Some(place) => {
                let first = self.bisect(line, (0.0, place), seen, self.options.tolerance);
                let second = self.bisect(line, (place, 1.0), !seen, self.options.tolerance);
                Edge::new(ends, &[first, second])
            }
        }
    }
}
