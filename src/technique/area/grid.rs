//! Scenes that differ in the vertices of their lights and of their occluders, to measure what these cost: the grid of
//! KT, Sakurikar and Narayanan (2021), figure 7, and finer steps along both of its axes.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::scene::light::{Light, Polygon};
use crate::scene::matter::Matter;
use crate::scene::view::Camera;
use crate::scene::{Object, Scene, Triangle};

/// A scene, and how many vertices it has.
#[derive(Debug, Clone)]
pub struct Sized {
    /// The scene.
    pub scene: Scene,
    /// Vertices of lights, those that polygons share counted once.
    pub of_lights: usize,
    /// Vertices of occluders.
    pub of_occluders: usize,
}

/// A solid without dents: its vertices, and its faces as indices of these, counter-clockwise as seen from outside.
struct Hull {
    corners: Vec<DVec3>,
    faces: Vec<Vec<usize>>,
}

/// Points around an upright axis.
fn ring(centre: DVec3, radius: f64, count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |index| {
        let angle = TAU * index as f64 / count as f64;
        centre + radius * DVec3::new(libm::sin(angle), 0.0, libm::cos(angle))
    })
}

/// A truncated cone that stands upright; a cylinder where its two radii are equal. It has twice as many vertices as
/// sides, and lids in pieces of at most eight corners.
fn cone(foot: DVec3, height: f64, radii: [f64; 2], sides: usize) -> Hull {
    let corners: Vec<DVec3> =
        ring(foot, radii[0], sides).chain(ring(foot + DVec3::Y * height, radii[1], sides)).collect();
    let next = |index: usize| (index + 1) % sides;
    let mut faces: Vec<Vec<usize>> =
        (0..sides).map(|index| vec![index, next(index), sides + next(index), sides + index]).collect();
    for start in (1..sides - 1).step_by(6) {
        let piece = std::iter::once(0).chain(start..=(start + 6).min(sides - 1));
        let piece: Vec<usize> = piece.collect();
        faces.push(piece.iter().rev().copied().collect());
        faces.push(piece.iter().map(|corner| sides + corner).collect());
    }
    Hull { corners, faces }
}

/// An ellipsoid of `rings` rings of `around` vertices and two poles, made of triangles.
fn ellipsoid(centre: DVec3, radii: DVec3, rings: usize, around: usize) -> Hull {
    let mut corners = vec![centre + DVec3::Y * radii.y];
    for down in 1..=rings {
        let angle = TAU / 2.0 * down as f64 / (rings + 1) as f64;
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        corners.extend(ring(DVec3::Y * cosine, sine, around).map(|at| centre + at * radii));
    }
    corners.push(centre - DVec3::Y * radii.y);
    let at = |ring: usize, index: usize| 1 + ring * around + index % around;
    let mut faces = Vec::new();
    for index in 0..around {
        faces.push(vec![0, at(0, index), at(0, index + 1)]);
        for ring in 1..rings {
            faces.push(vec![at(ring - 1, index), at(ring, index), at(ring, index + 1)]);
            faces.push(vec![at(ring - 1, index), at(ring, index + 1), at(ring - 1, index + 1)]);
        }
        faces.push(vec![at(rings - 1, index), corners.len() - 1, at(rings - 1, index + 1)]);
    }
    Hull { corners, faces }
}

impl Hull {
    fn cube(centre: DVec3, half: f64) -> Self {
        let corner = |index: usize| {
            let side = |axis: usize| if index >> axis & 1 == 1 { half } else { -half };
            centre + DVec3::new(side(0), side(1), side(2))
        };
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Self { corners: (0..8).map(corner).collect(), faces: faces.map(|face| face.to_vec()).to_vec() }
    }

    fn object(&self, colour: [f64; 3]) -> Object {
        let fan = |face: &Vec<usize>| -> Vec<Triangle> {
            let corner = |index: usize| self.corners[face[index]];
            (2..face.len()).map(|index| Triangle::flat([corner(0), corner(index - 1), corner(index)])).collect()
        };
        object(self.faces.iter().flat_map(fan).collect(), colour, true)
    }

    fn lights(&self, colour: [f64; 3]) -> impl Iterator<Item = Light> {
        self.faces.iter().map(move |face| {
            let corners = face.iter().map(|corner| self.corners[*corner]).collect();
            Light::Polygon(Polygon { corners, two_sided: false, colour })
        })
    }
}

fn object(triangles: Vec<Triangle>, colour: [f64; 3], casts: bool) -> Object {
    Object {
        colour,
        gloss: None,
        matter: Matter::OPAQUE,
        shine: None,
        detail: None,
        casts,
        triangles,
        parts: Vec::new(),
    }
}

fn scene(name: String, lights: &[Hull], occluders: &[Hull]) -> Sized {
    const FLOOR: f64 = 7.0;
    let corner = |x: f64, z: f64| DVec3::new(FLOOR * x, 0.0, FLOOR * z);
    let floor = [
        Triangle::flat([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0)]),
        Triangle::flat([corner(-1.0, -1.0), corner(1.0, 1.0), corner(1.0, -1.0)]),
    ];
    let colours = [[0.7, 0.45, 0.3], [0.35, 0.5, 0.65], [0.5, 0.6, 0.35]];
    let mut objects = vec![object(floor.to_vec(), [0.65, 0.63, 0.6], false)];
    objects.extend(occluders.iter().zip(colours).map(|(hull, colour)| hull.object(colour)));
    let count = |hulls: &[Hull]| hulls.iter().map(|hull| hull.corners.len()).sum();
    Sized {
        of_lights: count(lights),
        of_occluders: count(occluders),
        scene: Scene {
            title: name.clone(),
            name,
            camera: Camera { eye: DVec3::new(0.0, 4.4, 7.4), target: DVec3::new(0.0, 0.6, 0.0), angle: 44.0 },
            lights: lights.iter().flat_map(|hull| hull.lights([9.0, 8.6, 8.0])).collect(),
            ambient: 0.03,
            background: [0.02, 0.02, 0.025],
            objects,
        },
    }
}

/// A square that shines downwards.
fn square(centre: DVec3, half: f64) -> Hull {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    Hull {
        corners: corners.map(|[x, z]| centre + half * DVec3::new(x, 0.0, z)).to_vec(),
        faces: vec![(0..4).collect()],
    }
}

/// An image of the grid: 1 to 3 lights (a square; a cylinder and a truncated cone of 20 vertices) and 0 to 3 occluders (a
/// cube, a ball of 16 vertices and an ellipsoid of 154).
pub fn image(lights: usize, occluders: usize) -> Sized {
    let all_lights = [
        square(DVec3::new(-1.6, 3.0, 0.0), 0.4),
        cone(DVec3::new(0.0, 2.6, -0.8), 0.8, [0.2, 0.2], 10),
        cone(DVec3::new(1.6, 2.6, 0.0), 0.7, [0.35, 0.15], 10),
    ];
    let all_occluders = [
        Hull::cube(DVec3::new(-1.5, 0.6, 0.2), 0.4),
        ellipsoid(DVec3::new(0.0, 0.8, 0.3), DVec3::splat(0.5), 2, 7),
        ellipsoid(DVec3::new(1.5, 0.7, 0.2), DVec3::new(0.6, 0.35, 0.45), 8, 19),
    ];
    let name = format!("lights {lights}, occluders {occluders}");
    scene(name, &all_lights[..lights.min(3)], &all_occluders[..occluders.min(3)])
}

/// A square light over an ellipsoid of `2 + rings * around` vertices.
pub fn ball(rings: usize, around: usize) -> Sized {
    let hull = ellipsoid(DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.0, 0.7, 0.8), rings, around);
    scene(format!("a ball of {} vertices", hull.corners.len()), &[square(DVec3::Y * 3.0, 0.5)], &[hull])
}

/// A cylinder of `2 * sides` vertices that shines on a cube.
pub fn lamp(sides: usize) -> Sized {
    let lamp = cone(DVec3::new(0.0, 2.4, 0.0), 0.8, [0.3, 0.3], sides);
    let name = format!("a lamp of {} vertices", lamp.corners.len());
    scene(name, &[lamp], &[Hull::cube(DVec3::new(0.0, 0.6, 0.2), 0.5)])
}

/// A line through points by least squares: its slope, its value at 0, and the share R² of the variance that it explains.
pub fn line(points: &[(f64, f64)]) -> [f64; 3] {
    let count = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|at| at.0), mean(&|at| at.1));
    let [xx, xy, yy] =
        [mean(&|at| (at.0 - x) * (at.0 - x)), mean(&|at| (at.0 - x) * (at.1 - y)), mean(&|at| (at.1 - y) * (at.1 - y))];
    let slope = xy / xx;
    [slope, y - slope * x, xy * xy / (xx * yy)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::area::mesh::Mesh;

    #[test]
    fn hulls_are_convex_and_lights_are_flat_and_shine_outwards() {
        let hulls = [
            Hull::cube(DVec3::ONE, 0.5),
            ellipsoid(DVec3::ONE, DVec3::new(0.6, 0.35, 0.45), 8, 19),
            ellipsoid(DVec3::ZERO, DVec3::ONE, 2, 7),
            cone(DVec3::ZERO, 0.7, [0.35, 0.15], 10),
            cone(DVec3::ZERO, 0.7, [0.3, 0.3], 24),
        ];
        for hull in hulls {
            let mesh = Mesh::new(hull.corners.clone(), &hull.faces);
            assert!(mesh.is_convex(), "{} vertices", hull.corners.len());
            let centre = hull.corners.iter().sum::<DVec3>() / hull.corners.len() as f64;
            for face in &hull.faces {
                let [a, b, c] = [0, 1, 2].map(|index| hull.corners[face[index]]);
                assert!((b - a).cross(c - a).dot(a - centre) > 0.0 && face.len() <= 8, "{face:?}");
            }
        }
    }

    #[test]
    fn the_grid_has_the_vertices_of_the_paper() {
        let sizes = |lights, occluders| {
            let image = image(lights, occluders);
            (image.of_lights, image.of_occluders)
        };
        assert_eq!((sizes(1, 0), sizes(2, 1), sizes(3, 2), sizes(3, 3)), ((4, 0), (24, 8), (44, 24), (44, 178)));
        assert_eq!((ball(3, 4).of_occluders, lamp(5).of_lights), (14, 10));
    }

    #[test]
    fn lines_are_fitted() {
        let [slope, start, r] = line(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]);
        assert!((slope - 2.0).abs() < 1e-12 && (start - 1.0).abs() < 1e-12 && (r - 1.0).abs() < 1e-12);
        assert!(line(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)])[2] < 1e-12);
    }
}
