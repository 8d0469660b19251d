//! Area lights, exactly: what a polygonal light sends past polygonal occluders.
//!
//! ```text
//! light, point ──Panel──▶ corners ──Horizon──▶ above ──┐
//! occluders ──Silhouettes──▶ Cones ────────────────────┴─peel─▶ pieces ──Integrals──▶ form factor
//! ```
//!
//! Nothing is projected: a polygon is its corners as seen from the point, an occluder the planes
//! through the point along its silhouette, and what is visible is left when these are peeled off
//! (`peel.rs`). Every decision is a row of a table: the horizon's clip (`horizon_clip`), the clip
//! against a plane (`clip_step`), the silhouettes of boxes (`box_silhouette`) and meshes
//! (`edge_silhouette`), the edge integral (`edge_integral`), and what gloss makes of light (`ltc_matrix`,
//! `ltc_albedo`, `ltc`). The method is that of KT,
//! Sakurikar and Narayanan, Fast Analytic Soft Shadows from Area Lights (Graphics Interface 2021),
//! with half-spaces in place of its polygon clipping.

mod clip;
mod cone;
mod entry;
mod gloss;
#[cfg(feature = "gpu")]
mod gpu;
#[cfg(feature = "gpu")]
pub mod grid;
mod integral;
mod lit;
pub mod mesh;
mod occluder;
mod panel;
mod peel;
mod picture;
pub mod point;
mod received;
mod sampling;
mod scalar;
pub mod search;
mod single;
mod tabulated;
mod tiles;
mod viewpoint;

pub use entry::{
    AREA_RATIO, AREA_SAMPLES, AREA_UNSHADOWED, CLIPS, EXACT, Entry, OVERFLOW, PEEL, PIECES, RADIUS, SAMPLES,
};
#[cfg(feature = "gpu")]
pub use gpu::PointPeeler;
pub use lit::{FACTOR, OCCLUDERS, SILHOUETTES, TRIANGLES};
pub use occluder::Occluder;
pub use peel::{Bounds, Work};
pub use point::{Answer, Peeler, Query, Question, Shape};
pub use scalar::Scalar;
pub use single::SinglePeeler;

#[cfg(test)]
mod tests;
