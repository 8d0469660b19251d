//! Pictures and pages: drawings as SVG, SVG as pixels, and the frame of a page.
//!
//! Everything here is a function of its arguments: fonts are embedded, nothing
//! of this machine or of the time of day gets in. Knows nothing of tables.

#[cfg(feature = "render")]
pub mod heat;
mod page;
pub mod plot;
mod raster;
#[cfg(feature = "render")]
pub mod sheet;
#[cfg(feature = "render")]
pub mod srgb;

pub use page::page;
pub use raster::{data_uri, png, raster};
