//! A frame as area lights see it: what hides light, what sends it, and where it arrives.

use std::sync::Arc;

use glam::DVec3;

use super::mesh::Mesh;
use super::occluder::Occluder;
use crate::diag::Failure;
use crate::scene::light::{Light, Lights, Polygon};
use crate::scene::rays::SurfacePoint;
use crate::scene::surfaces::Surfaces;
use crate::scene::{Form, Object, Scene};
use crate::technique::Frame;

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
        frame.shared("area", || {
            let scene = frame.scene;
            let corners = scene.triangles().flat_map(|(_, triangle)| triangle.corners);
            let reach = corners.map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
            Ok(Self {
                lights: lights.collect(),
                occluders: occluders(scene),
                surfaces: Arc::clone(&frame.surfaces),
                blur: 1e-9 * reach,
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
            ..*self
        }
    }

    /// The same with other surfaces in the picture.
    pub(super) fn with_surfaces(&self, surfaces: Arc<Surfaces>) -> Self {
        Self {
            lights: self.lights.clone(),
            occluders: self.occluders.clone(),
            surfaces,
            albedos: self.albedos.clone(),
            ..*self
        }
    }

    /// The light that a pixel sends to the camera, by that which its surface receives: the sum of the form factors of
    /// lights, each times its radiance.
    pub(super) fn sent(&self, point: Option<&SurfacePoint>, received: DVec3) -> DVec3 {
        let Some(point) = point else { return self.background };
        // The sky above is brighter than the ground below, as in every shaded picture.
        let sky = 0.75 + 0.25 * point.smooth_normal.y;
        self.albedos[point.object as usize] * (DVec3::splat(self.ambient * sky) + (1.0 - self.ambient) * received)
    }
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
