//! The border of a shadow between two discontinuities: the point closest to an edge, or points on several rays.
//!
//! Rays start at an apex and end on the far edge, at a place from 0 at its start to 1 at its end (Ouellette and Fiume
//! 1999, section 3.3).

use glam::DVec3;

use super::Search;
use super::line::Line;

/// Two edges that meet in an apex, and a discontinuity on each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wedge {
    pub(super) apex: DVec3,
    /// The ends of the far edge.
    pub(super) far: [DVec3; 2],
    /// The discontinuities between the apex and each of them.
    pub(super) chord: [DVec3; 2],
    /// The visibility of the far edge.
    pub(super) far_seen: bool,
}

/// A place between the ends of the far edge that was looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Look {
    at: f64,
    /// Distance of the border from the line of the far edge; that of the apex is 1.
    distance: f64,
    /// The border, where it lies beyond the chord.
    border: Option<DVec3>,
}

impl Wedge {
    /// The ray to a place on the far edge.
    pub(super) fn ray(&self, at: f64) -> Line {
        Line { from: self.apex, to: Line { from: self.far[0], to: self.far[1] }.at(at) }
    }

    /// The parameter at which the ray to a place on the far edge meets the chord.
    pub(super) fn meets(&self, at: f64, chord: [DVec3; 2]) -> f64 {
        let share = |index: usize| chord[index].distance(self.apex) / self.far[index].distance(self.apex);
        // Of a triangle without area there is nothing to be met.
        let along = 1.0 / ((1.0 - at) / share(0) + at / share(1));
        if along.is_finite() { along.clamp(0.0, 1.0) } else { 0.0 }
    }

    /// Distance of a place from the line of the far edge; that of the apex is 1.
    fn distance(&self, place: DVec3) -> f64 {
        let along = (self.far[1] - self.far[0]).normalize_or_zero();
        let off = |place: DVec3| {
            let towards = place - self.far[0];
            (towards - along * towards.dot(along)).length()
        };
        let all = off(self.apex);
        if all > 0.0 { (off(place) / all).min(1.0) } else { 0.0 }
    }
}

impl Search<'_> {
    /// The point of the border that comes closest to the far edge, beyond the chord; `None` if the border does not
    /// bulge towards that edge, or the search does not find it.
    pub(super) fn closest(&mut self, wedge: &Wedge) -> Option<DVec3> {
        let end = |index: usize| Look { at: index as f64, distance: wedge.distance(wedge.chord[index]), border: None };
        let mut looks = vec![end(0), end(1)];
        let ends = [looks[0].distance, looks[1].distance];
        let mut places = [0.0, self.stream.uniform(), 1.0];
        let first = self.look(wedge, &mut looks, places[1]);
        let goes_on = self.tables.is_worth_beginning(
            first.border.is_some(),
            first.at,
            [ends[0], first.distance, ends[1]],
            self.options.rule,
        );
        if !goes_on {
            return None;
        }
        while places[2] - places[0] > self.options.spacing {
            let known = places.map(|place| self.look(wedge, &mut looks, place).distance);
            let between = [0.5 * (places[0] + places[1]), 0.5 * (places[1] + places[2])];
            let mut halves = [None; 2];
            let next = loop {
                match self.tables.step(places, known, halves) {
                    Ok(next) => break next,
                    Err(half) => halves[half] = Some(self.look(wedge, &mut looks, between[half]).distance),
                }
            };
            // Neighbouring numbers have nothing between them.
            if next[2] - next[0] >= places[2] - places[0] && next[1] == places[1] {
                break;
            }
            places = next;
        }
        let last = self.look(wedge, &mut looks, places[1]);
        last.border.filter(|_| last.distance < ends[0].min(ends[1]))
    }

    /// The border at a place of the far edge, which is looked at once.
    fn look(&mut self, wedge: &Wedge, looks: &mut Vec<Look>, at: f64) -> Look {
        if let Some(known) = looks.iter().find(|look| look.at == at) {
            return *known;
        }
        let (ray, chord) = (wedge.ray(at), wedge.meets(at, wedge.chord));
        let border = (self.sees(ray.at(chord)) != wedge.far_seen).then(|| {
            let line = Line { from: ray.at(chord), to: ray.to };
            let along = self.bisect(line, (0.0, 1.0), !wedge.far_seen, self.options.spacing / 10.0);
            line.at(along)
        });
        let look = Look { at, distance: wedge.distance(border.unwrap_or(ray.at(chord))), border };
        looks.push(look);
        look
    }

    /// Places on the far edge, one within each of as many equal parts, which leave some room between each other.
    pub(super) fn spread(&mut self) -> Vec<f64> {
        let count = self.options.rays;
        let place = |index: u32| {
            let off = 0.8 * (self.stream.uniform() - 0.5);
            (f64::from(index) + off) / f64::from(count + 1)
        };
        (1..=count).map(place).collect()
    }

    /// The border on the ray to a place of the far edge, whose ends differ.
    pub(super) fn border(&mut self, wedge: &Wedge, at: f64) -> DVec3 {
        let ray = wedge.ray(at);
        ray.at(self.bisect(ray, (0.0, 1.0), !wedge.far_seen, self.options.tolerance))
    }

    /// The two borders on a ray whose ends are equal, the far one first, if there is something between the two chords.
    pub(super) fn borders(&mut self, wedge: &Wedge, near: [DVec3; 2], at: f64) -> Option<[DVec3; 2]> {
        let ray = wedge.ray(at);
        let middle = 0.5 * (wedge.meets(at, near) + wedge.meets(at, wedge.chord));
        if self.sees(ray.at(middle)) == wedge.far_seen {
            return None;
        }
        let first = self.bisect(ray, (0.0, middle), wedge.far_seen, self.options.tolerance);
        let second = self.bisect(ray, (middle, 1.0), !wedge.far_seen, self.options.tolerance);
        Some([ray.at(second), ray.at(first)])
    }
}
