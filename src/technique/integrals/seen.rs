//! A frame as the integrals see it: made once for the technique and its truth.

use std::sync::Arc;

use glam::DVec3;

use super::{Surface, Surroundings};
use crate::diag::Failure;
use crate::scene::rays::Rays;
use crate::scene::surfaces::Surfaces;
use crate::technique::{Frame, Samples};

/// The things that hide and send light in a frame, and the surfaces that the camera sees.
#[derive(Debug)]
pub(super) struct Seen {
    pub(super) surroundings: Surroundings,
    /// Row by row from the top; `None` where nothing is hit.
    pub(super) surfaces: Vec<Option<Surface>>,
    background: [f32; 3],
    /// Rows of pixels.
    pub(super) height: u32,
}

impl Seen {
    /// The surroundings and the surfaces of a frame.
    ///
    /// # Errors
    /// As [`Surroundings::new`].
    pub(super) fn of(frame: &Frame<'_>) -> Result<Arc<Self>, Failure> {
        frame.shared("integrals", || {
            let surroundings = Surroundings::new(frame.scene)?;
            // Balls are traced exactly, so the surfaces of the frame, which are triangles, do not do.
            let rays = Rays::exact(frame.scene);
            let (width, height) = frame.size();
            let surfaces = surroundings.surfaces(&rays, &Surfaces::new(frame.scene, &rays, width, height));
            let background = frame.scene.background.map(|channel| channel as f32);
            Ok(Self { surroundings, surfaces, background, height })
        })
    }

    /// Light as a layer, with the background where nothing is hit.
    pub(super) fn layer(&self, light: Vec<Option<DVec3>>) -> Samples {
        let colour = |light: Option<DVec3>| light.map_or(self.background, |light| light.as_vec3().to_array());
        Samples::Colours(light.into_iter().map(colour).collect())
    }
}
