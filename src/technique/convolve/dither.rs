//! Phases that are drawn for each pixel of each slab: numbers of the table `noise`, so that they are the
//! same everywhere.

use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
use crate::technique::tables::{NOISE, columns};

/// The phases that are drawn from, evenly over the period of a kernel.
pub const PHASES: usize = 64;

/// The component of the function's result that is a number from 0 to 1, after its bits.
const UNIT: usize = 1;

/// Draws phases for the pixels of a picture.
#[derive(Debug)]
pub struct Dither {
    x: Vec<f64>,
    y: Vec<f64>,
    hash: Batch<'static, f64>,
}

impl Dither {
    /// For a picture of so many pixels per row and rows.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new((width, height): (usize, usize)) -> Result<Self, Failure> {
        let place = |of: fn(usize, usize) -> usize| (0..width * height).map(|pixel| of(pixel, width) as f64).collect();
        Ok(Self {
            x: place(|pixel, width| pixel % width),
            y: place(|pixel, width| pixel / width),
            hash: Batch::new(NOISE.function("hash")?),
        })
    }

    /// The phase of each pixel in a slab, as one of [`PHASES`].
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn phases(&mut self, slab: usize, seed: u32) -> Result<Vec<u8>, Failure> {
        let same = |number: f64| vec![number; self.x.len()];
        let given = [self.x.clone(), self.y.clone(), same(slab as f64), same(seed.into())];
        let given = columns(NOISE.function("hash")?, ["x", "y", "slab", "seed"], given)?;
        let hashes = self.hash.evaluate(&given).map_err(|_| lacks())?;
        Ok(hashes.values(UNIT).iter().map(|unit| (unit * PHASES as f64) as u8).collect())
    }
}

fn lacks() -> Failure {
    Failure::bare(
        "noise",
        Diagnostic::error(codes::NOT_APPLICABLE, "the function `hash` needs an input that was not given"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_are_those_of_the_table() {
        let mut dither = Dither::new((20, 8)).expect("built in");
        let phases = dither.phases(3, 1).expect("built in");
        assert_eq!(usize::from(phases[5 * 20 + 17]), ((611_497_148_usize >> 8) * PHASES) >> 24);
        assert_ne!(phases, dither.phases(4, 1).expect("built in"));
        assert_eq!(usize::from(dither.phases(0, 1).expect("built in")[0]), ((555_269_243_usize >> 8) * PHASES) >> 24);
    }
}
