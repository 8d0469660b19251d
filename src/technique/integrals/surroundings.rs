//! A scene as the integrals see it: balls and plates under lobes of light.
//!
//! The subdivision has a frame of its own, in which z is up: the pole of its polar
//! angles is the zenith. Places, normals and axes are turned here.

use glam::DVec3;

use super::NAME;
use super::visibility::{Cap, Facet, Occluders};
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::light::{Gaussian, Light, Lights};
use crate::scene::rays::{Rays, SurfacePoint};
use crate::scene::surfaces::Surfaces;
use crate::scene::{Form, Scene};

/// A spherical Gaussian: `amplitude * exp(sharpness * (axis . direction - 1))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Unit vector of the largest value.
    pub axis: DVec3,
    /// Its narrowness: one over the square of its deviation.
    pub sharpness: f64,
    /// The largest value, per colour channel.
    pub amplitude: DVec3,
}

/// A ball, which shades and is shaded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Its centre; z is up.
    pub centre: DVec3,
    /// Its radius.
    pub radius: f64,
}

/// A flat convex polygon with two sides, which shades and is shaded.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// Its corners, one after the other around it; z is up.
    pub corners: Vec<DVec3>,
}

/// Balls and plates under lobes of light.
///
/// The ground of a scene is lit and hides nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    /// The balls.
    pub balls: Vec<Ball>,
    /// The plates.
    pub plates: Vec<Plate>,
    /// The light.
    pub lobes: Vec<Lobe>,
    /// For each object and each of its parts, the body that it is.
    bodies: Vec<Vec<Body>>,
    /// For each object the share of light that its surface sends on.
    albedos: Vec<DVec3>,
}

/// The body that a surface belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Body {
    /// The ground.
    Ground,
    /// The ball with this index.
    Ball(usize),
    /// The plate with this index.
    Plate(usize),
}

/// A place on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Its place; z is up.
    pub place: DVec3,
    /// Its unit normal, on the side that is seen; z is up.
    pub normal: DVec3,
    /// The share of light that it sends on.
    pub albedo: DVec3,
    /// The body that it belongs to, and which therefore does not hide its sky.
    pub body: Body,
}

/// A vector of the scene, where y is up, in the frame where z is.
fn upright(vector: DVec3) -> DVec3 {
    DVec3::new(vector.x, -vector.z, vector.y)
}

impl Lobe {
    /// The lobe of a distant light whose deviations are the same along both axes.
    ///
    /// Near its axis a spherical Gaussian of sharpness 1/σ² is the Gaussian of slopes of deviation σ. Its integral
    /// over all directions is that of the light: π times the colour, as of a directional light.
    pub(super) fn of(light: &Gaussian) -> Option<Self> {
        let [deviation, other] = light.deviations;
        if deviation != other || deviation <= 0.0 {
            return None;
        }
        let sharpness = 1.0 / (deviation * deviation);
        let amplitude = DVec3::from_array(light.colour) * (0.5 * sharpness / (1.0 - libm::exp(-2.0 * sharpness)));
        Some(Self { axis: upright(light.axis()), sharpness, amplitude })
    }

    /// Its value in a direction.
    pub fn value(&self, direction: DVec3) -> DVec3 {
        self.amplitude * libm::exp(self.sharpness * (self.axis.dot(direction) - 1.0))
    }
}

fn refused(message: String, help: &str) -> Failure {
    Failure::bare("", Diagnostic::error(codes::SCENE, message).help(help))
}

impl Surroundings {
    /// The balls, plates and lobes of a scene.
    ///
    /// # Errors
    /// When the scene has no Gaussian light, or one that is wider along one axis than along the other, or an object
    /// that is neither balls nor flat polygons.
    pub fn new(scene: &Scene) -> Result<Self, Failure> {
        let lights = Lights::GAUSSIAN.of_scene(scene, NAME)?;
        let lobes = lights.iter().filter_map(|light| match light {
            Light::Gaussian(light) => Some(light),
            Light::Directional(_) | Light::Spot(_) | Light::Polygon(_) => None,
        });
        let lobe = |light: &Gaussian| {
            let [first, second] = light.deviations;
            Lobe::of(light).ok_or_else(|| {
                let message = format!(
                    "`{NAME}` takes Gaussian lights with two equal deviations above 0, and the scene `{}` has one \
                     with {first} and {second}",
                    scene.name
                );
                refused(message, "make its `deviations` equal and above 0, or choose another technique")
            })
        };
        let lobes = lobes.map(lobe).collect::<Result<Vec<Lobe>, Failure>>()?;
        let (mut balls, mut plates, mut bodies) = (Vec::new(), Vec::new(), Vec::new());
        for (index, object) in scene.objects.iter().enumerate() {
            let wrong = || {
                let message = format!(
                    "`{NAME}` takes balls and flat polygons, and object {} of the scene `{}` is neither",
                    index + 1,
                    scene.name
                );
                refused(message, "shapes that it takes are `Ground`, `Ball`, `Foliage` and `Polygon`")
            };
            if !object.is_exact() {
                return Err(wrong());
            }
            let body = |form: &Form| match form {
                _ if !object.casts => Ok(Body::Ground),
                Form::Ball { centre, radius } => {
                    balls.push(Ball { centre: upright(*centre), radius: *radius });
                    Ok(Body::Ball(balls.len() - 1))
                }
                Form::Polygon { corners } => {
                    plates.push(Plate { corners: corners.iter().copied().map(upright).collect() });
                    Ok(Body::Plate(plates.len() - 1))
                }
                Form::Box { .. } | Form::Cone { .. } => Err(wrong()),
            };
            bodies.push(object.parts.iter().map(|part| &part.form).map(body).collect::<Result<Vec<Body>, Failure>>()?);
        }
        let albedos = scene.objects.iter().map(|object| DVec3::from_array(object.colour)).collect();
        Ok(Self { balls, plates, lobes, bodies, albedos })
    }

    /// The surfaces that rays have found.
    pub fn surfaces(&self, rays: &Rays, seen: &Surfaces) -> Vec<Option<Surface>> {
        seen.points.iter().map(|point| self.surface(rays, point.as_ref()?)).collect()
    }

    fn surface(&self, rays: &Rays, point: &SurfacePoint) -> Option<Surface> {
        let object = point.object as usize;
        Some(Surface {
            place: upright(point.place),
            normal: upright(point.smooth_normal),
            albedo: *self.albedos.get(object)?,
            body: *self.bodies.get(object)?.get(rays.part(point)?)?,
        })
    }

    /// The parts of the sky that are hidden at a surface, as directions.
    pub fn occluders(&self, surface: &Surface) -> Occluders {
        let balls = self.balls.iter().enumerate().filter(|(index, _)| surface.body != Body::Ball(*index));
        let plates = self.plates.iter().enumerate().filter(|(index, _)| surface.body != Body::Plate(*index));
        Occluders {
            caps: balls.map(|(_, ball)| Cap::of_ball(ball.centre - surface.place, ball.radius)).collect(),
            facets: plates
                .map(|(_, plate)| Facet::new(plate.corners.iter().map(|corner| *corner - surface.place)))
                .collect(),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use std::path::Path;

    use super::*;
    use crate::diag::Source;
    use crate::points::random::Random;

    /// The surroundings and the surfaces of a picture of the scene `studio`.
    pub(in crate::technique::integrals) fn studio(width: u32, height: u32) -> (Surroundings, Vec<Option<Surface>>) {
        let scene = Scene::open("studio").unwrap_or_else(|error| panic!("{error}"));
        let surroundings = Surroundings::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        let rays = Rays::exact(&scene);
        let surfaces = surroundings.surfaces(&rays, &Surfaces::new(&scene, &rays, width, height));
        (surroundings, surfaces)
    }

    #[test]
    fn what_hides_the_sky_is_what_rays_hit() {
        let scene = Scene::open("studio").unwrap_or_else(|error| panic!("{error}"));
        let surroundings = Surroundings::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        let rays = Rays::exact(&scene);
        let mut random = Random::new(11);
        let mut hidden = 0;
        for _ in 0..20_000 {
            let mut part = || 2.0 * random.unit() - 1.0;
            let towards = DVec3::new(part(), -1.0, part()).normalize();
            let Some(point) = rays.see((scene.camera.eye, towards)) else { continue };
            let surface = surroundings.surface(&rays, &point).expect("all of it is exact");
            let direction = DVec3::new(part(), part().abs(), part()).normalize();
            if point.normal.dot(direction) > 0.0 {
                // Beyond everything but the ground, which hides nothing above.
                let open = rays.is_open(point.place, point.place + 20.0 * direction);
                let hides = surroundings.occluders(&surface).hide()(upright(direction));
                assert_eq!(hides, !open, "{surface:?} {direction}");
                hidden += usize::from(hides);
            }
        }
        assert!(hidden > 50, "{hidden}");
    }

    #[test]
    fn other_lights_and_shapes_are_refused_by_name() {
        let said = |light: &str, shape: &str| {
            let text = format!(
                "Scene(camera: (eye: (0, 3, 6), target: (0, 0, 0)), light: {light}, objects: [\
                 (shape: Ground(size: (9, 9))), (shape: {shape})])"
            );
            let source = Source::new("scene.ron", text);
            let scene = Scene::parse("test", &source, Path::new("")).unwrap_or_else(|error| panic!("{error}"));
            Surroundings::new(&scene).expect_err("refused").to_string()
        };
        let (round, ball) = ("Gaussian(deviations: (0.2, 0.2))", "Ball(radius: 1)");
        let all = [
            said("Directional(direction: (0, -1, 0))", ball),
            said("Gaussian(deviations: (0.2, 0.3))", ball),
            said("Gaussian(deviations: (0, 0))", ball),
            said(round, "Column(radius: 1, height: 1)"),
            said(round, "Block(size: (1, 1, 1))"),
        ];
        insta::assert_snapshot!(all.join("\n"));
    }
}
