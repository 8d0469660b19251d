//! The code shapes, one file each.

pub(crate) mod chain;
pub(crate) mod coefficients;
pub(crate) mod gather;
pub(crate) mod orbit;
pub(crate) mod tree;
