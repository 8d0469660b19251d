//! Choices made of bytes: equal bytes, equal choices.
//!
//! Whatever is random here is a function of a string of bytes, read by `arbitrary`. A fault is
//! then made smaller by making its bytes fewer and smaller, whatever they stand for: where
//! bytes run out, or are zero, the first and simplest of the possibilities is chosen. So
//! possibilities are listed from the simplest on.

use arbitrary::Unstructured;

/// A source of choices.
pub(crate) struct Choices<'b>(Unstructured<'b>);

impl<'b> Choices<'b> {
    /// Choices that some bytes make.
    pub(crate) fn new(bytes: &'b [u8]) -> Self {
        Self(Unstructured::new(bytes))
    }

    /// A number below `end`, at least zero.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.within(0, end.saturating_sub(1))
    }

    /// A number from `lo` to `hi`, both included.
    pub(crate) fn within(&mut self, lo: usize, hi: usize) -> usize {
        // Few bytes make few choices of a large range; a byte is enough for a small one.
        let width = hi.saturating_sub(lo);
        let offset = match width {
            0 => 0,
            1..=0xff => usize::from(self.0.int_in_range(0..=width as u8).unwrap_or(0)),
            0x100..=0xffff => usize::from(self.0.int_in_range(0..=width as u16).unwrap_or(0)),
            _ => self.0.int_in_range(0..=width as u64).unwrap_or(0) as usize,
        };
        lo + offset
    }

    /// True once in so many times; false where bytes have run out.
    pub(crate) fn one_in(&mut self, times: usize) -> bool {
        times <= 1 || self.below(times) == times - 1
    }

    /// True half the time.
    pub(crate) fn either(&mut self) -> bool {
        self.one_in(2)
    }

    /// One of a list; the first where bytes have run out.
    ///
    /// # Panics
    /// If there is none.
    pub(crate) fn pick<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// The place of one of some weights, taken as often as its weight says.
    pub(crate) fn weighted(&mut self, weights: impl Iterator<Item = usize> + Clone) -> usize {
        let mut left = self.below(weights.clone().sum());
        for (place, weight) in weights.enumerate() {
            if left < weight {
                return place;
            }
            left -= weight;
        }
        0
    }

    /// A list in another order.
    pub(crate) fn shuffled<T>(&mut self, mut list: Vec<T>) -> Vec<T> {
        for last in (1..list.len()).rev() {
            // The last stays where it is when bytes have run out.
            let from = last - self.below(last + 1);
            list.swap(last, from);
        }
        list
    }

    /// Some of a list, in order, at least one if there is one.
    pub(crate) fn some<T: Clone>(&mut self, list: &[T]) -> Vec<T> {
        let keep = self.within(1, list.len().max(1));
        let order: Vec<usize> = self.shuffled((0..list.len()).collect());
        let mut kept: Vec<usize> = order.into_iter().take(keep).collect();
        kept.sort_unstable();
        kept.into_iter().map(|place| list[place].clone()).collect()
    }

    /// A byte.
    pub(crate) fn byte(&mut self) -> u8 {
        self.0.int_in_range(0..=u8::MAX).unwrap_or(0)
    }

    /// A number from which other random numbers are made.
    pub(crate) fn seed(&mut self) -> u64 {
        self.0.int_in_range(0..=u64::MAX).unwrap_or(0)
    }
}

/// The bytes of a case: as many as a large one makes use of.
pub(crate) fn bytes_of(seed: u64, target: &str, number: u64) -> Vec<u8> {
    const LENGTH: usize = 6144;
    let name = target.bytes().fold(seed, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    let mut random = umbrage::points::random::Random::new(name ^ number.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    // Short ones make small tables, on which more of what goes wrong can be seen.
    let length = LENGTH >> random.below(4);
    let words = (0..length / 4).map(|_| random.below(1 << 32) as u32);
    words.flat_map(u32::to_le_bytes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_bytes_the_first_is_chosen() {
        let mut choices = Choices::new(&[]);
        assert_eq!((choices.below(9), choices.within(3, 700), choices.one_in(2)), (0, 3, false));
        assert_eq!(choices.weighted([3, 4].into_iter()), 0);
        assert_eq!(choices.shuffled(vec![1, 2, 3]), [1, 2, 3]);
        assert_eq!(choices.some(&[1, 2, 3]), [1]);
    }

    #[test]
    fn cases_differ_by_seed_target_and_number() {
        let first = bytes_of(1, "tables", 0);
        assert_eq!(first, bytes_of(1, "tables", 0));
        for other in [bytes_of(2, "tables", 0), bytes_of(1, "csv", 0), bytes_of(1, "tables", 1)] {
            assert_ne!(first, other);
        }
    }
}
