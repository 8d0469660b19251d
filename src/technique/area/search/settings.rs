//! Settings of the search as a technique.

use crate::technique::Setting;

use super::Options;

/// Points of each curve.
pub const BOUNDARY_RAYS: Setting = Setting::whole(
    "boundary_rays",
    "points of each curve of a shadow's border; 0 looks for closest points, as the paper does",
    3,
    (0, Options::MOST_RAYS),
);

/// Tolerance of bisection.
pub const TOLERANCE: Setting =
    Setting::number("tolerance", "largest error of a discontinuity, as a part of its edge", 0.05, (1e-9, 0.5));

/// Tolerance of searches.
pub const GAP: Setting =
    Setting::number("gap", "widest part of an edge that a search leaves untested", 0.25, (1e-3, 1.0));

/// Tolerance of closest points.
pub const SPACING: Setting =
    Setting::number("spacing", "part of an edge within which a closest point is found", 0.333, (1e-6, 1.0));

/// The rule by which a search for a closest point is not begun.
pub const BULGES: Setting = Setting::word(
    "bulges",
    "bulges of a border that are looked into: those beyond a straight line in the distance, or beyond a chord",
    &["line", "chord"],
);

/// The order in which pixels learn from their neighbours.
pub const COHERENCE: Setting = Setting::word(
    "coherence",
    "neighbours that pixels learn from: along lines (on a GPU on a checkerboard), on a checkerboard, or none",
    &["lines", "checkerboard", "none"],
);

/// The truth that fractions are compared with.
pub const AGAINST: Setting = Setting::word(
    "against",
    "what the layer `error` compares visible fractions with: `nothing`, `exact` ones, or 400 rays to each light",
    &["nothing", "exact", "rays"],
);
