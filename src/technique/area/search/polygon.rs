//! Polygons: vertices and edges once, then cut along diagonals into triangles, by the table `quad_diagonal`.
//!
//! A diagonal whose ends differ has one discontinuity, which bisection finds for sure. A polygon of five or more sides
//! has such a diagonal unless all of its vertices are equal: its diagonals connect all of them.

use glam::DVec3;

use super::Search;
use super::edge::Edge;
use super::line::Line;
use super::tables::Across;
use super::triangle::Region;

/// A corner of a polygon, by its number in the light, and the edge that starts there.
type Corner = (usize, Edge);

impl Search<'_> {
    /// The edges of a light, each searched once, and the visible part of each of the triangles that it is cut into.
    pub(super) fn polygon(&mut self, corners: &[DVec3], neighbour: Option<&[Edge]>) -> (Vec<Edge>, Vec<Region>) {
        let count = corners.len();
        let seen: Vec<bool> = corners.iter().map(|corner| self.sees(*corner)).collect();
        let edge = |search: &mut Self, index: usize| {
            let next = (index + 1) % count;
            let line = Line { from: corners[index], to: corners[next] };
            search.edge(line, [seen[index], seen[next]], neighbour.and_then(|edges| edges.get(index)))
        };
        let edges: Vec<Edge> = (0..count).map(|index| edge(self, index)).collect();
        let mut rest: Vec<Vec<Corner>> = vec![edges.iter().copied().enumerate().collect()];
        let mut regions = Vec::new();
        while let Some(polygon) = rest.pop() {
            if let [a, b, c] = polygon[..] {
                regions.push(self.triangle([a, b, c].map(|(corner, _)| corners[corner]), [a.1, b.1, c.1]));
                continue;
            }
            let (first, second, diagonal) = match polygon[..] {
                [a, b, c, d] => self.cut_quad(corners, [a, b, c, d]),
                _ => self.cut(corners, &polygon),
            };
            let ((from, _), (to, _)) = (polygon[first], polygon[second]);
            let near = polygon[first..second].iter().copied().chain([(to, diagonal.reversed())]).collect();
            let beyond = polygon[second..].iter().chain(&polygon[..first]).copied();
            rest.push([(from, diagonal)].into_iter().chain(beyond).collect());
            rest.push(near);
        }
        (edges, regions)
    }

    /// The diagonal that a quadrilateral is cut along, between two of its corners in ascending order.
    fn cut_quad(&mut self, corners: &[DVec3], quad: [Corner; 4]) -> (usize, usize, Edge) {
        let places = quad.map(|(corner, _)| corners[corner]);
        let seen = quad.map(|(_, edge)| edge.ends[0]);
        // Drawn even where it plays no part, so that streams stay together.
        let drawn = self.stream.below(2);
        let lines = [0, 1].map(|first| Line { from: places[first], to: places[first + 2] });
        let crossing = crossing(lines);
        let mut middle = None;
        let (first, across) = loop {
            match self.tables.diagonal(seen, drawn, middle) {
                Some(found) => break found,
                None => middle = Some(self.sees(lines[0].at(crossing[0]))),
            }
        };
        let (line, ends) = (lines[first], [seen[first], seen[first + 2]]);
        let diagonal = match across {
            Across::Search | Across::Bisect => self.edge(line, ends, None),
            Across::BisectHalves => {
                let near = self.bisect(line, (0.0, crossing[first]), ends[0], self.options.tolerance);
                let far = self.bisect(line, (crossing[first], 1.0), !ends[0], self.options.tolerance);
                Edge::new(ends, &[near, far])
            }
        };
        (first, first + 2, diagonal)
    }

    /// The same of a polygon with more corners: the diagonal whose ends differ that cuts off most, or, if all vertices
    /// are equal, one at random.
    fn cut(&mut self, corners: &[DVec3], polygon: &[Corner]) -> (usize, usize, Edge) {
        let count = polygon.len();
        let diagonals = (0..count).flat_map(|first| {
            let last = if first == 0 { count - 1 } else { count };
            (first + 2..last).map(move |second| (first, second))
        });
        let diagonals: Vec<(usize, usize)> = diagonals.collect();
        let drawn = diagonals[self.stream.below(diagonals.len())];
        let seen = |index: usize| polygon[index].1.ends[0];
        let differ = diagonals.iter().filter(|(first, second)| seen(*first) != seen(*second));
        let cut_off = |(first, second): &(usize, usize)| (second - first).min(count - (second - first));
        // The first of several that cut off as much.
        let (first, second) = differ.rev().max_by_key(|diagonal| cut_off(diagonal)).copied().unwrap_or(drawn);
        let line = Line { from: corners[polygon[first].0], to: corners[polygon[second].0] };
        (first, second, self.edge(line, [seen(first), seen(second)], None))
    }
}

/// The parameters at which two lines in a plane cross each other.
fn crossing([a, b]: [Line; 2]) -> [f64; 2] {
    let (along_a, along_b) = (a.to - a.from, b.to - b.from);
    let normal = along_a.cross(along_b);
    let square = normal.length_squared();
    let offset = b.from - a.from;
    let parameter = |along: DVec3| offset.cross(along).dot(normal) / square;
    // Of a quadrilateral without area any place is as good.
    [along_b, along_a].map(parameter).map(|place| if place.is_finite() { place.clamp(0.0, 1.0) } else { 0.5 })
}
