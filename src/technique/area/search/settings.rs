//! Settings of the search as a technique.

use crate::technique::Setting;
use crate::technique::setting::{Range, Value};

use super::Options;

/// Points of each curve.
pub const BOUNDARY_RAYS: Setting = Setting {
    name: "boundary_rays",
    doc: "points of each curve of a shadow's border; 0 looks for closest points, as the paper does",
    default: Value::Whole(3),
    range: Range::Whole(0, Options::MOST_RAYS),
    label: "",
};

/// Tolerance of bisection.
pub const TOLERANCE: Setting = Setting {
    name: "tolerance",
    doc: "largest error of a discontinuity, as a part of its edge",
    default: Value::Number(0.05),
    range: Range::Number(1e-9, 0.5),
    label: "",
};

/// Tolerance of searches.
pub const GAP: Setting = Setting {
    name: "gap",
    doc: "widest part of an edge that a search leaves untested",
    default: Value::Number(0.25),
    range: Range::Number(1e-3, 1.0),
    label: "",
};

/// Tolerance of closest points.
pub const SPACING: Setting = Setting {
    name: "spacing",
    doc: "part of an edge within which a closest point is found",
    default: Value::Number(0.333),
    range: Range::Number(1e-6, 1.0),
    label: "",
};

/// The rule by which a search for a closest point is not begun.
pub const BULGES: Setting = Setting {
    name: "bulges",
    doc: "bulges of a border that are looked into: those beyond a straight line in the distance, or beyond a chord",
    default: Value::Word("line"),
    range: Range::Word(&["line", "chord"]),
    label: "",
};

/// The order in which pixels learn from their neighbours.
pub const COHERENCE: Setting = Setting {
    name: "coherence",
    doc: "neighbours that pixels learn from: along lines (on a GPU on a checkerboard), on a checkerboard, or none",
    default: Value::Word("lines"),
    range: Range::Word(&["lines", "checkerboard", "none"]),
    label: "",
};

/// The truth that fractions are compared with.
pub const AGAINST: Setting = Setting {
    name: "against",
    doc: "what the layer `error` compares visible fractions with: `nothing`, `exact` ones, or 400 rays to each light",
    default: Value::Word("nothing"),
    range: Range::Word(&["nothing", "exact", "rays"]),
    label: "",
};
