//! Text on its way in and out: tokens, RON with places, files, the closest word.
//!
//! Nothing here knows what a table is.

pub(crate) mod closest;
pub mod file;
pub(crate) mod layout;
pub(crate) mod raw;
pub mod reach;
pub(crate) mod tokens;
