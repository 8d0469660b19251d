//! The library without a command line and without a device.
#![allow(clippy::unwrap_used)]

mod architecture;
mod batch;
#[cfg(feature = "trial")]
mod certificates;
mod constants;
mod constructs;
mod convolution;
mod emitted_names;
mod emitted_rust;
mod generated;
mod glslang;
mod integers;
#[cfg(feature = "precise")]
mod integrals;
mod intervals;
mod limits;
#[cfg(feature = "trial")]
mod published_numbers;
#[path = "../support/mod.rs"]
mod support;
#[cfg(feature = "trial")]
mod symmetries;
#[cfg(feature = "trial")]
mod trial;
mod words;
mod wrapping;
