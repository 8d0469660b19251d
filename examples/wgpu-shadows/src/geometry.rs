//! A scene as vertices, and what the passes need to know about it.

use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3};
use umbrage::scene::light::{Punctual, Spot};
use umbrage::scene::view::{Camera, View};
use umbrage::scene::{Scene, Triangle};
use umbrage::technique::revectorise::stage::Bias;
use umbrage::technique::revectorise::{DEPTH_UNIT, max_slope};

/// A corner of a face, as geometry.wgsl takes it.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Vertex {
    place: [f32; 3],
    normal: [f32; 3],
    face: [f32; 3],
    colour: [f32; 3],
    light: [f32; 4],
    anchor: [f32; 4],
    slope: [f32; 2],
}

/// The types of its fields, in order.
pub(crate) const ATTRIBUTES: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3, 4 => Float32x4, 5 => Float32x4, 6 => Float32x2
];

/// The uniform of geometry.wgsl.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct Stage {
    camera: [[f32; 4]; 4],
    eye: [f32; 3],
    size: f32,
    position: [f32; 3],
    cone: f32,
    direction: [f32; 3],
    ambient: f32,
    unit: f32,
    max_slope: f32,
    bias: f32,
    slope_bias: f32,
}

impl Stage {
    /// What a camera sees in a picture of a size, and the light of a scene in a map of `texels` per side.
    pub(crate) fn new(
        scene: &Scene,
        light: &Punctual,
        camera: &Camera,
        [width, height]: [u32; 2],
        texels: u32,
    ) -> Self {
        let (position, direction, cone) = match *light {
            Punctual::Directional(light) => (DVec3::ZERO, light.direction.normalize(), 0.0),
            Punctual::Spot(Spot { position, target, angle, .. }) => {
                (position, (target - position).normalize(), (angle / 2.0).to_radians())
            }
        };
        let bias = Bias::default();
        Self {
            camera: camera.view(width, height).matrix.as_mat4().to_cols_array_2d(),
            eye: camera.eye.as_vec3().to_array(),
            size: texels as f32,
            position: position.as_vec3().to_array(),
            cone: cone as f32,
            direction: direction.as_vec3().to_array(),
            // The last pass multiplies what is seen in shadow, which therefore must not be black.
            ambient: scene.ambient.max(0.01) as f32,
            unit: DEPTH_UNIT,
            max_slope: max_slope(texels),
            bias: bias.constant,
            slope_bias: bias.slope,
        }
    }
}

/// The corners of all faces.
pub(crate) fn vertices(scene: &Scene, light: &Punctual) -> Vec<Vertex> {
    let light = light.view(scene);
    scene.triangles().flat_map(|(object, triangle)| face(&light, scene.objects[object].colour, triangle)).collect()
}

fn face(light: &View, colour: [f64; 3], triangle: &Triangle) -> [Vertex; 3] {
    let [a, b, c] = triangle.corners;
    let face = (b - a).cross(c - a).normalize_or_zero();
    let (anchor, slope) = plane(light, triangle.corners);
    std::array::from_fn(|i| Vertex {
        place: triangle.corners[i].as_vec3().to_array(),
        // On the same side as the face, whichever way round its corners are.
        normal: (triangle.normals[i] * triangle.normals[i].dot(face).signum()).as_vec3().to_array(),
        face: face.as_vec3().to_array(),
        colour: DVec3::from_array(colour).as_vec3().to_array(),
        light: (light.matrix * triangle.corners[i].extend(1.0)).as_vec4().to_array(),
        anchor,
        slope,
    })
}

/// The plane of a face over the light's square: a place in the square, the depth there and 1; and the slopes. All
/// zero where it is seen edge-on.
fn plane(light: &View, corners: [DVec3; 3]) -> ([f32; 4], [f32; 2]) {
    let place = corners.into_iter().find_map(|corner| light.project(corner));
    let (Some((place, _)), Some(plane)) = (place, light.plane(corners)) else { return ([0.0; 4], [0.0; 2]) };
    let place = place.clamp(DVec2::ZERO, DVec2::ONE);
    let depth = plane.at(place.x, place.y);
    ([place.x as f32, place.y as f32, depth as f32, 1.0], [plane.du as f32, plane.dv as f32])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_is_laid_out_as_wgsl_does() {
        // A matrix, three vectors each with a number in its fourth place, four numbers.
        assert_eq!(size_of::<Stage>(), 64 + 3 * 16 + 16);
        assert_eq!(size_of::<Vertex>() as u64, ATTRIBUTES[6].offset + 8);
    }

    #[test]
    fn corners_lie_in_the_planes_of_their_faces() {
        for name in ["fence", "teapot"] {
            let scene = Scene::open(name).unwrap_or_else(|e| panic!("{e}"));
            let light = scene.punctual("test").unwrap_or_else(|error| panic!("{error}"));
            let seen = vertices(&scene, &light);
            let mut checked = 0;
            for vertex in seen.iter().filter(|vertex| vertex.anchor[3] == 1.0) {
                let [x, y, z, w] = vertex.light;
                let (u, v) = (0.5 + 0.5 * x / w, 0.5 - 0.5 * y / w);
                let steep = vertex.slope[0].abs().max(vertex.slope[1].abs());
                let depth = vertex.anchor[2]
                    + (u - vertex.anchor[0]) * vertex.slope[0]
                    + (v - vertex.anchor[1]) * vertex.slope[1];
                if (0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v) && steep < 10.0 {
                    assert!((depth - z / w).abs() < 1e-5, "{name}: {depth} is not {}", z / w);
                    checked += 1;
                }
            }
            assert!(checked > 100, "{name}: {checked}");
        }
    }
}
