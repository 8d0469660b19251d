//! Points of the input space, and the ways to choose them.

use crate::program::Value;

#[cfg(any(feature = "gpu", feature = "trial"))]
pub mod comparison;
pub mod random;
mod sample;

pub use sample::Samples;

/// A point: one value per input; fetched ones may be absent until they are asked for.
pub type Point = Vec<Option<Value>>;

/// The parts of a point that is written down, `H=left,dV=0.5`, as `explain --at` takes it and findings give it.
/// They stand between commas; those in parentheses belong to a name, `light(0,1)=0.5`.
pub fn parts(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_i32;
    text.split(move |c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth <= 0
    })
}
