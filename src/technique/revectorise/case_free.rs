//! The formulation without cases that the authors published later, in its
//! filtered variant: the baseline that the tables are measured against.
//!
//! Four signed distances to the ends of the two runs give one number per axis;
//! the two numbers give the visibility. There are no dominance tests, no
//! neighbours and no breaks, but both axes are always walked.

use super::Settings;
use super::inputs::distances;
use super::probe::{Axis, End, Probe};

/// The visibility of a fragment.
pub(crate) fn filtered(probe: &Probe<'_>, settings: &Settings) -> f32 {
    let lit = f32::from(u8::from(probe.lit));
    let sides = [Axis::Horizontal, Axis::Vertical].map(|axis| probe.discontinuity(axis, true));
    if !sides[0].any() && !sides[1].any() {
        return lit;
    }
    if sides.iter().all(|sides| sides.small && sides.large) {
        return 1.0 - lit;
    }
    let [x, y] = [Axis::Horizontal, Axis::Vertical].map(|axis| {
        let ends = probe.ends(axis, sides[axis.across() as usize], true);
        // A walk without an end counts as one that lost its edge just past the limit.
        let [small, large] = ends.map(|end| end.unwrap_or(End { steps: settings.search_limit + 1, positive: false }));
        relative(small, large, probe.place[axis as usize], settings)
    });
    let sign = 2.0 * lit - 1.0;
    if x * y < 0.0 {
        1.0 - lit + sign * x.max(y)
    } else if x * y == 0.0 {
        lit
    } else {
        (1.0 - lit + sign * (x + y)).clamp(0.0, 1.0)
    }
}

/// The place of a fragment between the ends of its run along an axis: 0 between two negative ends, negative (as a
/// mark) between two positive ones, else the distance to the positive end as a share of the length.
fn relative(small: End, large: End, place: f32, settings: &Settings) -> f32 {
    let [to_small, to_large] = distances(small, large, place);
    let length = (small.steps + large.steps - 1).min(settings.search_limit) as f32;
    match (small.positive, large.positive) {
        (false, false) => 0.0,
        (true, false) => to_small / length,
        (false, true) => to_large / length,
        (true, true) => -4.0 * to_small.min(to_large) / length,
    }
}
