//! The neighbourhood of a fragment in the shadow map:
//! discontinuities, walks, neighbours, breaks.
//!
//! This is the reference of the search that every technique shares, written to
//! be read: no read is saved, every loop has an end. x grows to the right and y
//! downwards, like the rows of the map; places are relative to the fragment's
//! texel. "Opposite" means shadowed where the fragment is lit and lit where it is
//! shadowed.

use super::{Receiver, Settings, ShadowMap};

/// A step from a texel to a neighbour.
pub(crate) type Step = [i32; 2];

pub(crate) const LEFT: Step = [-1, 0];
pub(crate) const RIGHT: Step = [1, 0];
pub(crate) const TOP: Step = [0, -1];
pub(crate) const BOTTOM: Step = [0, 1];

/// The neighbours along an axis that are opposite to the fragment.
///
/// `small` is the side of the smaller coordinate (left, top), `large` the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Sides {
    pub(crate) small: bool,
    pub(crate) large: bool,
}

impl Sides {
    pub(crate) const BOTH: Sides = Sides { small: true, large: true };
    pub(crate) const NONE: Sides = Sides { small: false, large: false };

    /// Returns whether there is any.
    pub(crate) fn any(self) -> bool {
        self.small || self.large
    }

    /// Returns whether there is exactly one.
    pub(crate) fn one(self) -> bool {
        self.small != self.large
    }

    fn and(self, other: Sides) -> Sides {
        Sides { small: self.small && other.small, large: self.large && other.large }
    }
}

/// A direction of texture space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Axis {
    /// Along rows.
    Horizontal,
    /// Along columns.
    Vertical,
}

impl Axis {
    /// The steps to the smaller and to the larger coordinate.
    pub(crate) fn steps(self) -> [Step; 2] {
        match self {
            Axis::Horizontal => [LEFT, RIGHT],
            Axis::Vertical => [TOP, BOTTOM],
        }
    }

    pub(crate) fn across(self) -> Axis {
        match self {
            Axis::Horizontal => Axis::Vertical,
            Axis::Vertical => Axis::Horizontal,
        }
    }
}

/// The end of a walk.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct End {
    /// Number of the end texel, the neighbour being 1.
    pub(crate) steps: u32,
    /// True if the texel is opposite; otherwise it lost the discontinuity.
    pub(crate) positive: bool,
}

/// The two ends of a run, towards the smaller and the larger coordinate.
/// `None` for a walk that reached the limit.
pub(crate) type Ends = [Option<End>; 2];

/// A shadow map seen from one fragment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Probe<'a> {
    map: &'a ShadowMap,
    receiver: Receiver,
    texel: [i32; 2],
    /// Place of the fragment in its texel, 0 at the left and at the top border.
    pub(crate) place: [f32; 2],
    /// True if the fragment passes the depth test.
    pub(crate) lit: bool,
    settings: Settings,
}

impl<'a> Probe<'a> {
    /// Looks at a receiver's texel.
    pub(crate) fn new(map: &'a ShadowMap, receiver: &Receiver, settings: &Settings) -> Self {
        let (texel, place) = receiver.texel(map.size);
        Self { map, receiver: *receiver, texel, place, lit: true, settings: *settings }.tested()
    }

    /// The same place in a texel some steps away, on the same plane.
    pub(crate) fn shifted(&self, by: Step) -> Self {
        let texel = [self.texel[0] + by[0], self.texel[1] + by[1]];
        let receiver = Receiver { z: self.receiver.depth_at(by[0], by[1]), ..self.receiver };
        Self { texel, receiver, ..*self }.tested()
    }

    fn tested(mut self) -> Self {
        self.lit = self.is_lit([0, 0], 0.0);
        self
    }

    /// The depth test at a texel, with the plane lifted towards the light.
    fn is_lit(&self, at: Step, lift: f32) -> bool {
        let z = self.receiver.depth_at(at[0], at[1]) - lift;
        self.map.get(self.texel[0] + at[0], self.texel[1] + at[1]).is_none_or(|depth| z <= depth)
    }

    fn opposite(&self, at: Step) -> bool {
        self.is_lit(at, 0.0) != self.lit
    }

    /// Returns whether all four neighbours of a texel have the state opposite to its own.
    fn isolated(&self, at: Step) -> bool {
        let own = self.opposite(at);
        [LEFT, RIGHT, TOP, BOTTOM].into_iter().all(|step| self.opposite(plus(at, step, 1)) != own)
    }

    /// The neighbours of a texel along an axis that are opposite to the fragment.
    pub(crate) fn sides_at(&self, at: Step, axis: Axis) -> Sides {
        let [small, large] = axis.steps().map(|step| self.opposite(plus(at, step, 1)));
        Sides { small, large }
    }

    /// The discontinuity of the fragment's texel along an axis. An isolated texel
    /// counts as opposite only if asked to.
    pub(crate) fn discontinuity(&self, axis: Axis, isolated_counts: bool) -> Sides {
        let counts = |step: Step| self.opposite(step) && (isolated_counts || !self.isolated(step));
        let [small, large] = axis.steps().map(counts);
        Sides { small, large }
    }

    /// Walks from the fragment's texel until it meets an opposite texel or one where none of
    /// `sides`, the fragment's discontinuity across the walk, is left. With `isolated_ends` an
    /// isolated opposite texel is a negative end.
    fn walk(&self, step: Step, axis: Axis, sides: Sides, isolated_ends: bool) -> Option<End> {
        // How far this walk has lifted the receiver, so that its own surface ends no run.
        let mut lift = 0.0;
        for steps in 1..=self.settings.search_limit {
            let at = plus([0, 0], step, steps);
            if self.lit {
                self.raise(&mut lift, at);
            }
            if self.is_lit(at, lift) != self.lit {
                return Some(End { steps, positive: !(isolated_ends && self.isolated(at)) });
            }
            let mut kept = false;
            for (side, wanted) in axis.across().steps().into_iter().zip([sides.small, sides.large]) {
                if wanted && !kept {
                    let beside = plus(at, side, 1);
                    if !self.lit {
                        self.raise(&mut lift, beside);
                    }
                    kept = self.is_lit(beside, lift) != self.lit;
                }
            }
            if !kept {
                return Some(End { steps, positive: false });
            }
        }
        None
    }

    /// Lifts a walk's receiver where it is within the threshold of the surface that the light sees.
    fn raise(&self, lift: &mut f32, at: Step) {
        let z = self.receiver.depth_at(at[0], at[1]) - *lift;
        if let Some(depth) = self.map.get(self.texel[0] + at[0], self.texel[1] + at[1])
            && (z - depth).abs() < self.settings.walk_bias
        {
            *lift += self.settings.walk_bias;
        }
    }

    /// Walks along an axis in both directions.
    pub(crate) fn ends(&self, axis: Axis, sides: Sides, isolated_ends: bool) -> Ends {
        axis.steps().map(|step| self.walk(step, axis, sides, isolated_ends))
    }

    /// The first texel of a run with both sides that does not have both any more: how far away it
    /// is, and what it has. `None` if the run ends before. Where the search ends without either,
    /// the break is one without sides.
    fn break_towards(&self, step: Step, sides_along: Axis) -> Option<(u32, Sides)> {
        for steps in 1..=self.settings.search_limit {
            let at = plus([0, 0], step, steps);
            if self.opposite(at) && !self.isolated(at) {
                return None;
            }
            let sides = self.sides_at(at, sides_along);
            if sides != Sides::BOTH {
                return Some((steps, sides));
            }
        }
        Some((self.settings.search_limit + 1, Sides::NONE))
    }

    /// The break of a run with both sides along `sides_along`, met in one direction; both sides if there is none.
    pub(crate) fn break_in(&self, step: Step, sides_along: Axis) -> Sides {
        self.break_towards(step, sides_along).map_or(Sides::BOTH, |(_, sides)| sides)
    }

    /// The breaks met in both directions, but only the nearer one: the other walk has both sides.
    pub(crate) fn nearer_breaks(&self, sides_along: Axis) -> [Sides; 2] {
        let breaks = sides_along.across().steps().map(|step| self.break_towards(step, sides_along));
        let distance = |found: Option<(u32, Sides)>| found.map_or(u32::MAX, |(steps, _)| steps);
        let nearest = distance(breaks[0]).min(distance(breaks[1]));
        breaks.map(|found| match found {
            Some((steps, sides)) if steps == nearest => sides,
            _ => Sides::BOTH,
        })
    }

    /// The nearer break of both directions; of equally near ones the sides that both still have.
    pub(crate) fn nearest_break(&self, sides_along: Axis) -> Sides {
        let [small, large] = self.nearer_breaks(sides_along);
        small.and(large)
    }
}

/// A place some steps further.
pub(crate) fn plus(at: Step, step: Step, times: u32) -> Step {
    let times = times as i32;
    [at[0] + step[0] * times, at[1] + step[1] * times]
}
