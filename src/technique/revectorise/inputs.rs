//! From a fragment's neighbourhood to the inputs of a table.
//!
//! The techniques' tables name their inputs as the papers do. A [`Vocabulary`]
//! says once per table which quantity each input is, by its name, and which of
//! its levels stands for what; after that a fragment is a [`Point`] of the table.
//! Fetched inputs are searched for when the interpreter asks for them.

use super::Settings;
use super::probe::{Axis, End, Ends, Probe, Sides};
use crate::diag::{Diagnostic, Failure, codes};
pub(crate) use crate::points::Point;
use crate::program::{InputId, Program, Value};

/// The quantities that an input of a table can be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Quantity {
    /// Discontinuity along an axis.
    Discontinuity(Axis),
    /// Entering or exiting.
    Kind,
    /// Type of the run along an axis.
    RunType(Axis),
    /// Position in the run along an axis.
    Position(Axis),
    /// Place in the texel.
    Place(Axis),
    /// True if the discontinuity along an axis dominates.
    Dominance(Axis),
    /// Discontinuity of a neighbouring texel across the way to it.
    Neighbour(Axis, usize),
    /// The break of the sides along an axis, in the direction that the state decides.
    Break(Axis),
    /// The break of the sides along an axis, in one of the two directions across.
    BreakTowards(Axis, usize),
}

const QUANTITIES: [(&str, Quantity); 21] = {
    use Axis::{Horizontal, Vertical};
    use Quantity as Q;
    [
        ("H", Q::Discontinuity(Horizontal)),
        ("V", Q::Discontinuity(Vertical)),
        ("b", Q::Kind),
        ("tH", Q::RunType(Horizontal)),
        ("tV", Q::RunType(Vertical)),
        ("dH", Q::Position(Horizontal)),
        ("dV", Q::Position(Vertical)),
        ("px", Q::Place(Horizontal)),
        ("py", Q::Place(Vertical)),
        ("domH", Q::Dominance(Horizontal)),
        ("domV", Q::Dominance(Vertical)),
        ("n_top", Q::Neighbour(Horizontal, 0)),
        ("n_bottom", Q::Neighbour(Horizontal, 1)),
        ("n_left", Q::Neighbour(Vertical, 0)),
        ("n_right", Q::Neighbour(Vertical, 1)),
        ("d_cb_h", Q::Break(Horizontal)),
        ("d_cb_v", Q::Break(Vertical)),
        ("d_cb_top", Q::BreakTowards(Horizontal, 0)),
        ("d_cb_bottom", Q::BreakTowards(Horizontal, 1)),
        ("d_cb_left", Q::BreakTowards(Vertical, 0)),
        ("d_cb_right", Q::BreakTowards(Vertical, 1)),
    ]
};

impl Quantity {
    /// The names of the levels that [`Facts`] numbers 0, 1, 2, …; none for a number.
    fn words(self) -> &'static [&'static str] {
        use Axis::{Horizontal, Vertical};
        match self {
            Quantity::Discontinuity(Horizontal)
            | Quantity::Neighbour(Horizontal, _)
            | Quantity::Break(Horizontal)
            | Quantity::BreakTowards(Horizontal, _) => &["none", "left", "right", "both"],
            Quantity::Discontinuity(Vertical)
            | Quantity::Neighbour(Vertical, _)
            | Quantity::Break(Vertical)
            | Quantity::BreakTowards(Vertical, _) => &["none", "top", "bottom", "both"],
            Quantity::Kind => &["entering", "exiting"],
            Quantity::RunType(_) => &["dual_negative", "positive_negative", "dual_positive"],
            Quantity::Dominance(_) => &["false", "true"],
            Quantity::Position(_) | Quantity::Place(_) => &[],
        }
    }
}

/// The quantities that a table asks for, and its words for them.
#[derive(Debug)]
pub struct Vocabulary<'p> {
    program: &'p Program,
    inputs: Vec<(Quantity, Vec<u8>)>,
    /// True if the table tells entering from exiting; otherwise it speaks of lit fragments only.
    has_kind: bool,
}

impl<'p> Vocabulary<'p> {
    /// Reads the names of a table's inputs and levels.
    ///
    /// # Errors
    /// When an input is none of the quantities that a shadow map has.
    pub fn new(program: &'p Program) -> Result<Self, Failure> {
        let mut inputs = Vec::new();
        for input in &program.inputs {
            let refuse = |message: String| {
                let known: Vec<&str> = QUANTITIES.iter().map(|(name, _)| *name).collect();
                let error = Diagnostic::error(codes::FOREIGN_INPUT, message)
                    .at(input.span, "declared here")
                    .help(format!("a shadow map provides: {}", known.join(", ")));
                Failure::new(program.source.clone(), error)
            };
            let Some((_, quantity)) = QUANTITIES.iter().find(|(name, _)| *name == input.name) else {
                return Err(refuse(format!("`{}` is nothing that the renderer can provide", input.name)));
            };
            let id = InputId::new(inputs.len());
            let levels = match (program.levels(id), quantity.words()) {
                (None, []) => Vec::new(),
                (Some(levels), [_, ..]) => {
                    let find = |word: &&str| {
                        levels.find(word).ok_or_else(|| refuse(format!("`{}` has no level `{word}`", input.name)))
                    };
                    quantity.words().iter().map(find).collect::<Result<_, _>>()?
                }
                _ => return Err(refuse(format!("`{}` is of another kind than the renderer provides", input.name))),
            };
            inputs.push((*quantity, levels));
        }
        let has_kind = inputs.iter().any(|(quantity, _)| *quantity == Quantity::Kind);
        Ok(Self { program, inputs, has_kind })
    }

    /// The table.
    pub fn program(&self) -> &'p Program {
        self.program
    }

    /// Returns whether the table is asked about shadowed fragments too. A table that is not leaves them in shadow.
    pub(crate) fn has_kind(&self) -> bool {
        self.has_kind
    }

    /// The facts about a fragment that the table is asked with. `None` where it is not asked: away from
    /// silhouettes, and on runs that are too long to be searched.
    pub(crate) fn facts<'a>(&self, probe: Probe<'a>, settings: &Settings) -> Option<Facts<'a>> {
        // The rule of isolated texels belongs to the technique that treats both kinds of fragment.
        let isolated_counts = !self.has_kind;
        let sides = |axis| probe.discontinuity(axis, isolated_counts);
        let (h, v) = (sides(Axis::Horizontal), sides(Axis::Vertical));
        if !h.any() && !v.any() {
            return None;
        }
        let run = |axis: Axis, across: Sides| match across.any() {
            true => Run::new(probe.ends(axis, across, !isolated_counts), probe.place[axis as usize], settings),
            false => Some(Run::default()),
        };
        let runs = [run(Axis::Horizontal, v)?, run(Axis::Vertical, h)?];
        Some(Facts { probe, sides: [h, v], runs })
    }

    /// The fragment as a point of the table, without what is fetched.
    pub(crate) fn point(&self, facts: &Facts<'_>) -> Point {
        let value = |(index, (quantity, levels)): (usize, &(Quantity, Vec<u8>))| {
            let fetched = self.program.fetched.contains(InputId::new(index));
            (!fetched).then(|| facts.value(*quantity, levels))
        };
        self.inputs.iter().enumerate().map(value).collect()
    }

    /// The value of an input that the table asks for.
    pub(crate) fn fetch(&self, facts: &Facts<'_>, input: InputId) -> Value {
        let (quantity, levels) = &self.inputs[input.index()];
        facts.value(*quantity, levels)
    }
}

/// The run of texels along an edge, seen from a fragment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Run {
    /// -1 if both ends are negative, 1 if both are positive, 0 otherwise and for a run that is not walked.
    pub(crate) kind: i8,
    /// 0 at the negative end, 1 at the positive one.
    pub(crate) position: f32,
}

impl Default for Run {
    fn default() -> Self {
        Self { kind: 0, position: 0.0 }
    }
}

impl Run {
    /// The run between two ends, for a fragment at `place` in its texel; `None` if it is longer than the limit.
    fn new(ends: Ends, place: f32, settings: &Settings) -> Option<Self> {
        let [Some(small), Some(large)] = ends else { return None };
        let length = small.steps + large.steps - 1;
        if length > settings.search_limit {
            return None;
        }
        let length = length as f32;
        let [to_small, to_large] = distances(small, large, place);
        let (kind, position) = match (small.positive, large.positive) {
            (false, false) => (-1, 0.0),
            (true, false) => (0, 1.0 - to_small / length),
            (false, true) => (0, 1.0 - to_large / length),
            (true, true) => (1, 1.5 - to_small.max(to_large) / length),
        };
        Some(Self { kind, position: position.clamp(0.0, 1.0) })
    }
}

/// The distances from a place in a texel to the borders of the two end texels beside it, in texels.
pub(crate) fn distances(small: End, large: End, place: f32) -> [f32; 2] {
    [(small.steps - 1) as f32 + place, large.steps as f32 - place]
}

/// The facts about a fragment that every state of a table may ask for; the rest is searched on demand.
#[derive(Debug)]
pub(crate) struct Facts<'a> {
    probe: Probe<'a>,
    sides: [Sides; 2],
    runs: [Run; 2],
}

impl Facts<'_> {
    fn value(&self, quantity: Quantity, levels: &[u8]) -> Value {
        let level = |index: usize| Value::Level(levels[index]);
        let sides = |sides: Sides| level(usize::from(sides.small) + 2 * usize::from(sides.large));
        match quantity {
            Quantity::Discontinuity(axis) => sides(self.sides[axis as usize]),
            Quantity::Kind => level(usize::from(!self.probe.lit)),
            Quantity::RunType(axis) => level((self.runs[axis as usize].kind + 1) as usize),
            Quantity::Position(axis) => Value::Number(f64::from(self.runs[axis as usize].position)),
            Quantity::Place(axis) => Value::Number(f64::from(self.probe.place[axis as usize])),
            Quantity::Dominance(axis) => level(usize::from(self.dominates(axis))),
            Quantity::Neighbour(axis, side) => sides(self.probe.sides_at(axis.across().steps()[side], axis)),
            Quantity::Break(axis) => sides(self.break_along(axis)),
            Quantity::BreakTowards(axis, side) => sides(self.probe.nearer_breaks(axis)[side]),
        }
    }

    /// Returns whether, at a corner, the neighbour opposite to the discontinuity across still has one along the axis.
    fn dominates(&self, axis: Axis) -> bool {
        let [h, v] = self.sides;
        if !h.one() || !v.one() {
            return false;
        }
        let [small, large] = axis.across().steps();
        let away = if self.sides[axis.across() as usize].small { large } else { small };
        self.probe.sides_at(away, axis).any()
    }

    /// The break of sides along an axis: away from a one-sided discontinuity across, else the nearest.
    fn break_along(&self, axis: Axis) -> Sides {
        let across = self.sides[axis.across() as usize];
        let [small, large] = axis.across().steps();
        match (across.small, across.large) {
            (true, false) => self.probe.break_in(large, axis),
            (false, true) => self.probe.break_in(small, axis),
            _ => self.probe.nearest_break(axis),
        }
    }
}

#[cfg(test)]
#[path = "inputs_tests.rs"]
mod tests;
