//! Searches along a segment: for the one place where the visibility changes, and for a place that differs.
//!
//! Parameters run from 0 at the start of the segment to 1 at its end, and tolerances are measured in them
//! (Ouellette and Fiume 1999, section 2).

use glam::DVec3;

use super::Search;

/// Gaps that are narrower than the widest by no more than this part of it are ties in every precision.
const ALIKE: f64 = 1e-5;

/// A segment on a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    pub(super) from: DVec3,
    pub(super) to: DVec3,
}

impl Line {
    /// The place at a parameter.
    pub(super) fn at(self, parameter: f64) -> DVec3 {
        self.from * (1.0 - parameter) + self.to * parameter
    }
}

impl Search<'_> {
    /// The place between `from` and `to` where the visibility changes, which is `seen` at `from` and the opposite at
    /// `to`, with an error of at most `tolerance`. The first place to be tested is random, so that errors do not form
    /// bands.
    pub(super) fn bisect(&mut self, line: Line, (from, to): (f64, f64), seen: bool, tolerance: f64) -> f64 {
        let (mut a, mut b) = (from, to);
        let mut middle = a + (b - a) * self.stream.uniform();
        while (b - a).abs() >= 2.0 * tolerance {
            if self.sees(line.at(middle)) == seen {
                a = middle;
            } else {
                b = middle;
            }
            let next = 0.5 * (a + b);
            // Neighbouring numbers have nothing between them.
            if next == middle {
                break;
            }
            middle = next;
        }
        0.5 * (a + b)
    }

    /// A place between `from` and `to` whose visibility is not `seen`, as both ends are; `None` if no gap as wide as
    /// the tolerance is left without a test.
    pub(super) fn differing(&mut self, line: Line, (from, to): (f64, f64), seen: bool) -> Option<f64> {
        let mut tested = vec![from, to];
        let mut next = from + (to - from) * self.stream.uniform();
        loop {
            if self.sees(line.at(next)) != seen {
                return Some(next);
            }
            let place = tested.partition_point(|other| *other < next);
            tested.insert(place, next);
            let gap = |index: usize| tested[index + 1] - tested[index];
            let widest = (0..tested.len() - 1).map(gap).fold(0.0, f64::max);
            if widest < self.options.gap {
                return None;
            }
            let wide = |index: &usize| gap(*index) >= widest * (1.0 - ALIKE);
            let ties: Vec<usize> = (0..tested.len() - 1).filter(wide).collect();
            let chosen = match *ties {
                [only] => only,
                _ => ties[self.stream.below(ties.len())],
            };
            next = 0.5 * (tested[chosen] + tested[chosen + 1]);
        }
    }
}
