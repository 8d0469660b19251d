//! The findings, one file a subject.

pub(crate) mod accuracy;
pub(crate) mod continuity;
pub(crate) mod coverage;
pub(crate) mod examples;
pub(crate) mod lines;
pub(crate) mod numbers;
pub(crate) mod overlap;
pub(crate) mod style;
pub(crate) mod symmetry;
pub(crate) mod unused;
