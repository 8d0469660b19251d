//! Sets as bits of a word: of the levels of an input, and of the inputs of a program.

use super::InputId;

/// A set of levels of one input, as a bit mask.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct LevelSet(pub u64);

impl LevelSet {
    /// The set of the first `count` levels.
    pub fn all(count: usize) -> Self {
        Self(if count >= 64 { u64::MAX } else { (1 << count) - 1 })
    }

    /// The set of one level.
    pub fn one(level: u8) -> Self {
        Self(1 << level)
    }

    /// Returns whether `level` is in the set.
    pub fn contains(self, level: u8) -> bool {
        self.0 >> level & 1 == 1
    }

    /// The levels, ascending.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let level = (rest != 0).then(|| rest.trailing_zeros() as u8)?;
            rest &= rest - 1;
            Some(level)
        })
    }
}

/// A set of inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct InputSet(u128);

impl InputSet {
    /// Most inputs a table may have.
    pub const CAPACITY: usize = 128;

    /// The set of one input.
    pub fn one(input: InputId) -> Self {
        Self(1 << input.index())
    }

    /// Returns whether `input` is in the set.
    pub fn contains(self, input: InputId) -> bool {
        self.0 >> input.index() & 1 == 1
    }

    /// Inputs in both.
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Inputs in either.
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Inputs in `self` but not in `other`.
    pub fn minus(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns whether there is none.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The inputs, ascending.
    pub fn iter(self) -> impl Iterator<Item = InputId> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let input = (rest != 0).then(|| InputId::new(rest.trailing_zeros() as usize))?;
            rest &= rest - 1;
            Some(input)
        })
    }
}
