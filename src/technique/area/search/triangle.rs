//! Triangles: from the discontinuities of their edges to their visible part, by the tables `triangle_configuration`,
//! `closest_point_setup`, `triangle_region` and `triangle_rays`.

use glam::DVec3;

use super::Search;
use super::curve::Wedge;
use super::edge::Edge;
use super::line::Line;
use super::tables::{Setup, label};

/// The visible part of a triangle.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    /// Its configuration, by its number in `triangle_configuration` and its name.
    pub configuration: (u32, &'static str),
    /// Its visible loops, counter-clockwise if the triangle is.
    pub loops: Vec<Vec<DVec3>>,
    /// The same as triangles, in the same orientation.
    pub triangles: Vec<[DVec3; 3]>,
}

impl Region {
    /// The integral of a function of places over the visible part, by the middles of the sides of its triangles: exact
    /// up to quadratic functions. It is for light that no closed form is known of.
    pub fn integral(&self, mut of: impl FnMut(DVec3) -> f64) -> f64 {
        let whole = self.triangles.iter().map(|[a, b, c]| (*b - *a).cross(*c - *a)).sum::<DVec3>().normalize_or_zero();
        let mut part = |[a, b, c]: &[DVec3; 3]| {
            let area = 0.5 * (*b - *a).cross(*c - *a).dot(whole);
            let middles = [0.5 * (*a + *b), 0.5 * (*b + *c), 0.5 * (*c + *a)];
            area / 3.0 * middles.into_iter().map(&mut of).sum::<f64>()
        };
        self.triangles.iter().map(&mut part).sum()
    }
}

/// A triangle on the way to its region.
struct Found {
    configuration: usize,
    /// The vertex that comes first in the configuration.
    rotation: usize,
    /// The visibility of each vertex.
    seen: [bool; 3],
    points: [DVec3; label::COUNT],
}

impl Found {
    /// The levels that tables of regions are asked for: configuration, rotation, and the visibility of its first vertex.
    fn state(&self) -> [usize; 3] {
        [self.configuration, self.rotation, usize::from(self.seen[self.rotation])]
    }

    fn wedge(&self, setup: &Setup) -> Wedge {
        Wedge {
            apex: self.points[setup.apex],
            far: setup.far.map(|label| self.points[label]),
            chord: setup.chord.map(|label| self.points[label]),
            far_seen: self.seen[setup.far[0]],
        }
    }
}

impl Search<'_> {
    /// The visible part of a triangle, by its corners and the edges that start there.
    pub(super) fn triangle(&mut self, corners: [DVec3; 3], edges: [Edge; 3]) -> Region {
        let seen = edges.map(|edge| edge.ends[0]);
        let (configuration, rotation) =
            self.tables.configuration(seen, edges.map(|edge| edge.discontinuities().len() == 2));
        let mut points = [DVec3::ZERO; label::COUNT];
        for (index, edge) in edges.iter().enumerate() {
            points[label::V + index] = corners[index];
            let line = Line { from: corners[index], to: corners[(index + 1) % 3] };
            for (place, first) in edge.discontinuities().iter().zip([label::A, label::B]) {
                points[first + index] = line.at(*place);
            }
        }
        let mut found = Found { configuration, rotation, seen, points };
        let halves = [false, true].map(|other| self.tables.setup(configuration, rotation, other));
        if halves[1].is_some() {
            self.cross(&mut found);
        }
        let setups: Vec<Setup> = halves.into_iter().flatten().collect();
        let (loops, triangles) = match self.options.rays {
            0 => self.closest_points(&mut found, &setups),
            _ => {
                let loops = self.curves(&mut found, &setups);
                let triangles = loops.iter().flat_map(|labels| fan(labels)).collect();
                (loops, triangles)
            }
        };
        let place = |label: &usize| found.points[*label];
        Region {
            configuration: (configuration as u32, self.tables.name(configuration)),
            loops: loops.iter().map(|labels| labels.iter().map(place).collect()).collect(),
            triangles: triangles.iter().map(|labels| labels.map(|label| found.points[label])).collect(),
        }
    }

    /// Finds K, in the middle of what reaches in over an edge, and H, where the line from there to the opposite vertex
    /// leaves it.
    fn cross(&mut self, found: &mut Found) {
        let (edge, opposite) = (found.rotation, (found.rotation + 2) % 3);
        let middle = 0.5 * (found.points[label::A + edge] + found.points[label::B + edge]);
        let line = Line { from: middle, to: found.points[label::V + opposite] };
        let along = self.bisect(line, (0.0, 1.0), !found.seen[opposite], self.options.tolerance);
        (found.points[label::K], found.points[label::H]) = (middle, line.at(along));
    }

    /// Finds X and Y, as far as there are any, and returns the labels of visible loops and triangles.
    fn closest_points(&mut self, found: &mut Found, setups: &[Setup]) -> (Vec<Vec<usize>>, Vec<[usize; 3]>) {
        let mut exist = [false; 2];
        for setup in setups {
            if let Some(point) = self.closest(&found.wedge(setup)) {
                exist[usize::from(setup.is_y)] = true;
                found.points[if setup.is_y { label::Y } else { label::X }] = point;
            }
        }
        self.tables.region(found.state(), exist)
    }

    /// Finds the points of curves and returns the labels of visible loops.
    fn curves(&mut self, found: &mut Found, setups: &[Setup]) -> Vec<Vec<usize>> {
        let mut count = 0;
        for setup in setups {
            let wedge = found.wedge(setup);
            let first = if setup.is_y { label::Y_OF_RAYS } else { label::X };
            let apex_seen = found.seen.get(setup.apex).copied().unwrap_or(!wedge.far_seen);
            count = 0;
            for at in self.spread() {
                if apex_seen != wedge.far_seen {
                    found.points[first + count] = self.border(&wedge, at);
                } else {
                    // A strip crosses the ray: a far border on the far chord, and a near one on the other
                    // discontinuities of the same edges.
                    let other = |label: usize| if label < label::B { label + 3 } else { label - 3 };
                    let near = setup.chord.map(|label| found.points[other(label)]);
                    let Some([far, near]) = self.borders(&wedge, near, at) else { continue };
                    (found.points[first + count], found.points[label::Y_OF_RAYS + count]) = (far, near);
                }
                count += 1;
            }
        }
        self.tables.loops(found.state(), count)
    }
}

/// A loop as triangles that start at its first point; those of a loop that is not convex may overlap, and are then
/// turned over where they count twice.
fn fan(labels: &[usize]) -> impl Iterator<Item = [usize; 3]> {
    let rest = labels.get(1..).unwrap_or_default();
    rest.windows(2).map(|pair| [labels[0], pair[0], pair[1]])
}
