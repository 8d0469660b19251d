//! Options of the search, and their values where nothing else is said.

/// The rule by which a search for a closest point is not begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Rule {
    /// That of the paper: the border has to lie beyond a straight line in the distance.
    #[default]
    Line,
    /// The border has to lie beyond the chord between two discontinuities.
    Chord,
}

/// Options of a search. Tolerances are parts of what is searched, between 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Points of each curve of a shadow's border, 0 to 5; 0 looks for closest points instead, as the paper does.
    pub rays: u32,
    /// Largest error of a discontinuity along its edge.
    pub tolerance: f64,
    /// Widest gap that a search leaves untested.
    pub gap: f64,
    /// Distance of places at which a closest point has been found.
    pub spacing: f64,
    /// The rule by which a search for a closest point is not begun.
    pub rule: Rule,
}

impl Options {
    /// Most points of a curve.
    pub const MOST_RAYS: u32 = 5;
}

impl Default for Options {
    /// The tolerances of Ouellette and Fiume, and three points of each curve.
    fn default() -> Self {
        Self { rays: 3, tolerance: 0.05, gap: 0.25, spacing: 0.333, rule: Rule::Line }
    }
}
