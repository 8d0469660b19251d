//! The values that a program can take: images of intervals, points, points under symmetries.

pub(crate) mod orbit;
pub(crate) mod point;
pub(crate) mod real;
pub(crate) mod rounding;
pub(crate) mod search;
pub(crate) mod waves;
