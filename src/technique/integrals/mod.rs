//! Lighting by integral expansions: a demonstration of the double product tables.
//!
//! The light around a shading point is a few spherical Gaussians, the occluders
//! are balls and flat polygons, and the surface is diffuse: of a scene it takes
//! objects of these forms, and Gaussian lights that are as wide along one axis as
//! along the other. For each point the sphere of directions
//! is divided into cells ([`cells`]) in which every Gaussian is nearly linear in
//! the direction and the border of the visible part nearly straight; what each
//! cell sends is then a closed form, and that is a *table*: this module divides
//! and adds up ([`picture`]), the coefficients of the Gaussians and the moments
//! of the pieces come from `tables/spherical_gaussian.ron` and
//! `tables/double_product.ron` by the batch interpreter or by
//! shaders made from them.
//!
//! The subdivision is a reconstruction: the publication's algorithm was not
//! available. What is known and what is not says `docs/integrals.md`.

pub mod brute_force;
pub mod cells;
mod entry;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod picture;
mod seen;
mod surroundings;
mod tables;
mod visibility;

pub use brute_force::{BRUTE_FORCE, DIRECTIONS};
pub use entry::{BORDER, CELLS, DEPTH, EDGES, Entry, INTEGRALS, LOBE};
pub use surroundings::{Ball, Body, Lobe, Plate, Surface, Surroundings};
pub use visibility::{Cap, Facet, Occluders};

pub use picture::Shaded;
pub use tables::{Moments, Tables};

/// The technique's name, in the registry and in refusals.
const NAME: &str = "integrals";

/// The fineness of the division of the sphere of directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Largest error of the border's distance in a cell, in radians: the e_r of the publication.
    pub border: f64,
    /// Largest error of a lobe's linear approximation, relative to its largest value.
    pub lobe: f64,
    /// Most divisions of a cell of the base grid.
    pub depth: u32,
}

impl Settings {
    /// Coarse, as in a first look.
    pub const DEFAULT: Settings = Settings { border: 0.1, lobe: 0.1, depth: 6 };

    /// Both thresholds the same.
    pub fn with_threshold(threshold: f64) -> Self {
        Self { border: threshold, lobe: threshold, ..Self::DEFAULT }
    }
}
