//! Random points of sets, for trials.

use super::Space;
use crate::analyse::sets::Set;
use crate::analyse::values::point::Point;
use crate::points::random::Random;
use crate::program::InputId;
use crate::program::region;

impl Space<'_> {
    /// Some input that reaches a set, if one does.
    pub(in crate::analyse) fn sample(&mut self, set: Set, random: &mut Random) -> Option<Point> {
        let mut rest = self.prune(set);
        let program = self.program;
        let count = |input: InputId| program.levels(input).map_or(1, |levels| levels.count());
        let mut levels: Vec<u8> = program.input_ids().map(|(id, _)| random.below(count(id)) as u8).collect();
        while let Some((digit, children)) = self.sets.test(rest)
            && let Some(input) = self.input_of(digit)
        {
            let open: Vec<usize> = (0..children.len()).filter(|level| !children[*level].is_empty()).collect();
            let level = *open.get(random.below(open.len()))?;
            levels[input.index()] = level as u8;
            rest = children[level];
        }
        let answers = self.signs(rest)?;
        let signs = self.forms_of(&answers);
        let point = region::point(program, self.signed(&signs)).unwrap_or_default();
        let mut numbers: Vec<f64> = self.numbers(&point).into_iter().map(Option::unwrap_or_default).collect();
        for (id, input) in program.input_ids() {
            if let (Some((lo, hi)), false) = (input.domain.range(), point.contains_key(&id)) {
                let between = lo + (hi - lo) * (random.below(255) as f64 + 0.5) / 256.0;
                numbers[id.index()] = input.domain.point(between);
            }
        }
        Some(Point { levels, numbers })
    }
}
