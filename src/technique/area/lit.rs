//! A frame as area lights see it: what hides light, what sends it, and where it arrives.

use std::sync::Arc;

use glam::DVec3;

use super::gloss::{Seen, Sheen, sheens};
use super::mesh::Mesh;
use super::occluder::Occluder;
use super::received::Received;
use crate::diag::Failure;
use crate::scene::light::{Light, Lights, Polygon};
use crate::scene::matter::Gloss;
use crate::scene::rays::SurfacePoint;
use crate::scene::surfaces::Surfaces;
use crate::scene::{Form, Object, Scene};
use crate::technique::rendered::LIGHT;
use crate::technique::setting::{Range, Setting, Value};
use crate::technique::{Frame, Rendered, Samples};

/// Layer of the sums of the form factors of lights.
pub const FACTOR: &str = "form_factor";
/// Solids by their silhouettes: a word of [`OCCLUDERS`].
pub const SILHOUETTES: &str = "silhouettes";
/// Every surface by its triangles, as if it were no solid: a word of [`OCCLUDERS`].
pub const TRIANGLES: &str = "triangles";

/// The way in which occluders are taken.
pub const OCCLUDERS: Setting = Setting {
    name: "occluders",
    doc: "solids by their silhouettes, or everything by its triangles, to compare",
    default: Value::Word(SILHOUETTES),
    range: Range::Word(&[SILHOUETTES, TRIANGLES]),
    label: "",
};

/// Polygonal lights, occluders, and the surfaces that the camera sees.
#[derive(Debug)]
pub(super) struct Lit {
    pub(super) lights: Vec<Polygon>,
    pub(super) occluders: Vec<Occluder>,
    pub(super) surfaces: Arc<Surfaces>,
    /// The distance within which places that rays have found are known.
    pub(super) blur: f64,
    /// For each object the share of light that its surface sends on.
    albedos: Vec<DVec3>,
    /// The place of the camera.
    pub(super) eye: DVec3,
    /// For each object its gloss.
    pub(super) glosses: Vec<Option<Gloss>>,
    /// For each pixel what the gloss of its surface makes of light.
    pub(super) sheens: Arc<Vec<Option<Sheen>>>,
    ambient: f64,
    background: DVec3,
}

impl Lit {
    /// The polygonal lights and the occluders of a frame.
    ///
    /// # Errors
    /// When the scene has no polygonal light.
    pub(super) fn of(frame: &Frame<'_>, technique: &str) -> Result<Arc<Self>, Failure> {
        let lights = Lights::POLYGON.of_scene(frame.scene, technique)?;
        let lights = lights.into_iter().filter_map(|light| match light {
            Light::Polygon(polygon) => Some(polygon.clone()),
            Light::Directional(_) | Light::Spot(_) | Light::Gaussian(_) => None,
        });
        let taken = frame.settings.word(&OCCLUDERS);
        frame.shared(("area", taken), || {
            let scene = frame.scene;
            let corners = scene.triangles().flat_map(|(_, triangle)| triangle.corners);
            let glosses: Vec<Option<Gloss>> = scene.objects.iter().map(|object| object.gloss).collect();
            let reach = corners.map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
            Ok(Self {
                lights: lights.collect(),
                occluders: match taken == TRIANGLES {
                    true => triangles(scene),
                    false => occluders(scene),
                },
                surfaces: Arc::clone(&frame.surfaces),
                blur: 1e-9 * reach,
                eye: scene.camera.eye,
                sheens: Arc::new(sheens_of(&frame.surfaces, &glosses, scene.camera.eye)?),
                glosses,
                albedos: scene.objects.iter().map(|object| DVec3::from_array(object.colour)).collect(),
                ambient: scene.ambient,
                background: DVec3::from_array(scene.background),
            })
        })
    }

    /// The same with nothing in the way of light.
    pub(super) fn without_occluders(&self) -> Self {
        Self {
            lights: self.lights.clone(),
            occluders: Vec::new(),
            surfaces: Arc::clone(&self.surfaces),
            albedos: self.albedos.clone(),
            glosses: self.glosses.clone(),
            sheens: Arc::clone(&self.sheens),
            ..*self
        }
    }

    /// The same with other surfaces in the picture.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub(super) fn with_surfaces(&self, surfaces: Arc<Surfaces>) -> Result<Self, Failure> {
        Ok(Self {
            lights: self.lights.clone(),
            occluders: self.occluders.clone(),
            sheens: Arc::new(sheens_of(&surfaces, &self.glosses, self.eye)?),
            surfaces,
            albedos: self.albedos.clone(),
            glosses: self.glosses.clone(),
            ..*self
        })
    }

    /// The reflection of light by the gloss of the surface at a pixel, if it has any.
    pub(super) fn sheen(&self, pixel: usize) -> Option<Sheen> {
        self.sheens[pixel]
    }

    /// The layers of the light that pixels send to the camera, and of the form factors, by what their surfaces receive.
    pub(super) fn rendered(&self, received: &[Received]) -> Rendered {
        let sent = received.iter().enumerate().map(|(pixel, received)| self.sent(pixel, *received));
        let light = sent.map(|light| light.as_vec3().to_array()).collect();
        let factors = received.iter().map(|received| received.factor as f32).collect();
        Rendered::default().with(LIGHT, Samples::Colours(light)).with(FACTOR, Samples::Numbers(factors))
    }

    /// The light that a pixel sends to the camera, by that which its surface receives.
    fn sent(&self, pixel: usize, received: Received) -> DVec3 {
        let Some(point) = &self.surfaces.points[pixel] else { return self.background };
        // The sky above is brighter than the ground below, as in every shaded picture.
        let sky = 0.75 + 0.25 * point.smooth_normal.y;
        let diffuse = DVec3::splat(self.ambient * sky) + (1.0 - self.ambient) * received.diffuse;
        let glossy = self.sheen(pixel).map_or(0.0, |sheen| (1.0 - self.ambient) * sheen.share);
        self.albedos[point.object as usize] * diffuse + glossy * received.glossy
    }
}

/// The reflection of light by the gloss of each pixel's surface.
fn sheens_of(surfaces: &Surfaces, glosses: &[Option<Gloss>], eye: DVec3) -> Result<Vec<Option<Sheen>>, Failure> {
    let seen = |point: &SurfacePoint| -> Option<Seen> {
        Some((glosses[point.object as usize]?, point.smooth_normal, eye - point.place))
    };
    let seen: Vec<Option<Seen>> = surfaces.points.iter().map(|point| point.as_ref().and_then(seen)).collect();
    let mut found = sheens(&seen.iter().flatten().copied().collect::<Vec<Seen>>())?.into_iter();
    Ok(seen.into_iter().map(|seen| seen.and_then(|_| found.next())).collect())
}

/// The occluders of a scene, all of them triangles.
fn triangles(scene: &Scene) -> Vec<Occluder> {
    let casting = scene.objects.iter().filter(|object| object.casts);
    casting.flat_map(|object| &object.triangles).map(|triangle| Occluder::polygon(triangle.corners.to_vec())).collect()
}

/// The occluders of a scene: exact forms as they are, everything else as meshes.
fn occluders(scene: &Scene) -> Vec<Occluder> {
    scene.objects.iter().filter(|object| object.casts).flat_map(of_object).collect()
}

fn of_object(object: &Object) -> Vec<Occluder> {
    let mut is_exact = vec![false; object.triangles.len()];
    let mut all = Vec::new();
    for part in &object.parts {
        match &part.form {
            Form::Polygon { corners } => all.push(Occluder::polygon(corners.clone())),
            Form::Box { centre, halves } => all.push(Occluder::block(*centre, *halves)),
            // Light is hidden by the triangles that stand for it.
            Form::Ball { .. } | Form::Cone { .. } => {
                let triangles = object.triangles[part.triangles.clone()].iter();
                all.push(Occluder::mesh(mesh(triangles.map(|triangle| triangle.corners))));
            }
        }
        is_exact[part.triangles.clone()].fill(true);
    }
    let others = object.triangles.iter().zip(is_exact).filter(|(_, is_exact)| !is_exact);
    let others = mesh(others.map(|(triangle, _)| triangle.corners));
    if others.is_closed() {
        all.push(Occluder::mesh(others));
    } else {
        // One by one, so that those out of the way can be left out.
        let face = |face: &Vec<usize>| Occluder::polygon(face.iter().map(|at| others.corners()[*at]).collect());
        all.extend(others.faces().iter().map(face));
    }
    all
}

fn mesh(triangles: impl Iterator<Item = [DVec3; 3]>) -> Mesh {
    let corners: Vec<DVec3> = triangles.flatten().collect();
    let faces: Vec<Vec<usize>> =
        (0..corners.len() / 3).map(|index| vec![3 * index, 3 * index + 1, 3 * index + 2]).collect();
    Mesh::new(corners, &faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_of_an_object_hides_light_in_its_own_form() {
        let scene = Scene::open("table").unwrap_or_else(|error| panic!("{error}"));
        let ball = scene.objects.iter().find(|object| object.triangles.len() > 100).expect("a ball");
        let part = mesh(ball.triangles.iter().map(|triangle| triangle.corners));
        assert!(part.is_convex(), "{} faces", part.faces().len());
        let all = occluders(&scene);
        // Boxes: the top and four legs; the seat, four legs and the back; and two balls.
        assert_eq!(all.len(), 5 + 6 + 2);
    }
}
