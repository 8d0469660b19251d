//! The substance of objects, and ways through it: opacities by `tables/shade.ron`.

use super::functions::Function;
use crate::diag::Failure;
use crate::scene::matter::{Detail, Matter as Contents, Shine};
use crate::technique::tables::SHADE;

/// An object's substance.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Its colour, linear.
    pub colour: [f64; 3],
    /// Its contents.
    pub matter: Contents,
    /// Facets of its surface.
    pub shine: Option<Shine>,
    /// The pattern of its contents.
    pub detail: Option<Detail>,
}

/// Opacity, and the share of light that goes on by colour.
pub(super) type Through = (f64, [f64; 3]);

/// The functions of `tables/shade.ron` that ways through matter have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ways {
    opacity: Function,
    transmittance: Function,
}

/// The functions of ways.
///
/// # Errors
/// Never with the tables that come with Umbrage.
pub(super) fn ways() -> Result<Ways, Failure> {
    Ok(Ways { opacity: Function::of(&SHADE, "opacity")?, transmittance: Function::of(&SHADE, "transmittance")? })
}

impl Ways {
    /// Opacity and transmittance of a way through a material.
    pub(super) fn of(&self, contents: &Contents, path: f64) -> Through {
        let Contents { opacity, length, transport } = *contents;
        let given = [("alpha_ref", opacity.into()), ("e_ref", length.into()), ("path", path.into())];
        let alpha = self.opacity.call(&given).and_then(|answer| answer.number("value")).unwrap_or(0.0);
        let goes_on = |transport: f64| {
            let given = [given[0], given[1], given[2], ("transport", transport.into())];
            self.transmittance.call(&given).and_then(|answer| answer.number("value")).unwrap_or(1.0)
        };
        (alpha, transport.map(goes_on))
    }
}
