//! Area lights by search: the visible part of a polygonal light from a few dozen tests of visibility, for anything that
//! rays can be cast at.
//!
//! ```text
//! corners ──sees──▶ vertices ──search_plan──▶ edges ──quad_diagonal──▶ triangles
//!     ──triangle_configuration──▶ configuration ──closest_point_…, rays──▶ points ──triangle_region──▶ loops
//! ```
//!
//! An edge of a light is visible but for stretches whose ends, its discontinuities, are found by bisection. A
//! polygon is cut into triangles; the state of a triangle's vertices and edges says how discontinuities are joined, and
//! where the border of the shadow bulges it gets a point closest to an edge, or points on several rays. Every decision is
//! a row of a table (`tables.rs`). The method is that of Ouellette and Fiume, Approximating the Location of Integrand
//! Discontinuities for Penumbral Illumination with Area Light Sources (Eurographics Workshop on Rendering 1999); rays in
//! place of closest points are our own.
//!
//! It holds for occluders that meet every segment within the light at most twice, as one convex occluder does, or the rim
//! of one convex hole. For others it returns something.

mod curve;
mod edge;
mod entry;
#[cfg(feature = "gpu")]
mod gpu;
mod line;
mod options;
mod picture;
pub mod point;
mod polygon;
#[cfg(feature = "gpu")]
mod rows;
mod settings;
mod tables;
mod triangle;

use glam::DVec3;

use super::sampling::Stream;
use crate::diag::Failure;
use crate::technique::tables::{
    BuiltIn, CLOSEST_POINT_SETUP, CLOSEST_POINT_START, CLOSEST_POINT_STEP, EDGE_INTEGRAL, QUAD_DIAGONAL, SEARCH_PLAN,
    TRIANGLE_CONFIGURATION, TRIANGLE_RAYS, TRIANGLE_REGION,
};
pub use edge::Edge;
pub use entry::{CONFIGURATION, DISCONTINUITY, ERROR, FRACTION, TESTS};
pub use options::{Options, Rule};
pub use settings::{AGAINST, BOUNDARY_RAYS, BULGES, COHERENCE, GAP, SPACING, TOLERANCE};
use tables::Tables;
pub use triangle::Region;

/// The tables of the search.
static TABLES: [&BuiltIn; 9] = [
    &SEARCH_PLAN,
    &QUAD_DIAGONAL,
    &TRIANGLE_CONFIGURATION,
    &CLOSEST_POINT_SETUP,
    &CLOSEST_POINT_START,
    &CLOSEST_POINT_STEP,
    &TRIANGLE_REGION,
    &TRIANGLE_RAYS,
    &EDGE_INTEGRAL,
];

/// The search with its tables.
#[derive(Debug)]
pub(super) struct Searcher {
    tables: Tables,
    options: Options,
}

/// The result of a search.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Seen {
    /// The edges of the light, from its first corner on.
    pub(super) edges: Vec<Edge>,
    /// The visible part of each of the triangles that it was cut into.
    pub(super) regions: Vec<Region>,
    /// Tests of visibility.
    pub(super) tests: u64,
}

/// A search of one light.
struct Search<'s> {
    tables: &'s mut Tables,
    options: Options,
    stream: &'s mut Stream,
    visibility: &'s mut dyn FnMut(DVec3) -> bool,
    tests: u64,
}

impl Searcher {
    /// By the tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub(super) fn new(options: Options) -> Result<Self, Failure> {
        Ok(Self { tables: Tables::new()?, options })
    }

    /// Searches a flat convex light of 3 to 8 corners, whose places are visible or not, with the edges that were
    /// found from a neighbouring point, if there is one.
    pub(super) fn search(
        &mut self,
        corners: &[DVec3],
        neighbour: Option<&[Edge]>,
        stream: &mut Stream,
        visibility: &mut dyn FnMut(DVec3) -> bool,
    ) -> Seen {
        let mut search = Search { tables: &mut self.tables, options: self.options, stream, visibility, tests: 0 };
        let (edges, regions) = search.polygon(corners, neighbour);
        Seen { edges, regions, tests: search.tests }
    }
}

impl Search<'_> {
    /// Returns whether a place on the light is visible, by a test.
    fn sees(&mut self, place: DVec3) -> bool {
        self.tests += 1;
        (self.visibility)(place)
    }
}

#[cfg(test)]
mod tests;
