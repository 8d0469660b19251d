//! Rays: which triangle is seen first, and whether anything is in the way.
//!
//! The hierarchy works in single precision and only *finds* triangles. Where on
//! a triangle a ray ends is computed from the triangle's plane in double
//! precision, so that a shadow map and its receivers agree about depths.

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};

use super::{Scene, Triangle};

/// A scene that rays can be sent through.
#[derive(Debug)]
pub struct Rays {
    bvh: CwBvh,
    /// In the order of the hierarchy.
    faces: Vec<obvhs::triangle::Triangle>,
    /// For each face the number of its triangle.
    numbers: Vec<u32>,
    triangles: Vec<Triangle>,
    objects: Vec<u32>,
    /// How far a shadow ray starts from its surface.
    gap: f64,
}

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Where it is.
    pub place: DVec3,
    /// The normal of its triangle, on the side that is seen.
    pub normal: DVec3,
    /// The normal of the surface that the triangle stands for, on the side that is seen.
    pub smooth_normal: DVec3,
    /// Number of its object.
    pub object: u32,
    /// Number of its triangle.
    pub(crate) triangle: u32,
}

impl Rays {
    /// Builds the hierarchy of a scene.
    pub fn new(scene: &Scene) -> Self {
        let (objects, triangles): (Vec<u32>, Vec<Triangle>) =
            scene.triangles().map(|(object, triangle)| (object as u32, *triangle)).unzip();
        let single = |at: DVec3| Vec3A::from(at.as_vec3());
        let faces: Vec<obvhs::triangle::Triangle> = triangles
            .iter()
            .map(|triangle| {
                let [v0, v1, v2] = triangle.corners.map(single);
                obvhs::triangle::Triangle { v0, v1, v2 }
            })
            .collect();
        let bvh = build_cwbvh_from_tris(&faces, BvhBuildParams::fast_build(), &mut Duration::default());
        let numbers = bvh.primitive_indices.clone();
        let faces = numbers.iter().map(|number| faces[*number as usize]).collect();
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (lo, hi) = triangles.iter().flat_map(|t| t.corners).fold(start, |(lo, hi), p| (lo.min(p), hi.max(p)));
        Self { bvh, faces, numbers, triangles, objects, gap: 4e-6 * (hi - lo).max_element() }
    }

    pub(crate) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// Number of the first triangle that a ray meets.
    pub(crate) fn first(&self, (start, direction): (DVec3, DVec3)) -> Option<u32> {
        let ray = Ray::new_inf(start.as_vec3().into(), direction.as_vec3().into());
        let mut hit = RayHit::none();
        let found = self.bvh.ray_traverse(ray, &mut hit, |ray, face| self.faces[face].intersect(ray));
        found.then(|| self.numbers[hit.primitive_id as usize])
    }

    /// Where a ray meets the plane of a triangle, which need not be inside of the triangle.
    pub(crate) fn point_on(&self, number: u32, (start, direction): (DVec3, DVec3)) -> Option<SurfacePoint> {
        let Triangle { corners: [a, b, c], normals } = &self.triangles[number as usize];
        let across = (*b - *a).cross(*c - *a);
        let distance = (*a - start).dot(across) / direction.dot(across);
        if !distance.is_finite() {
            return None;
        }
        let place = start + direction * distance;
        // Shares of the corners, to blend their normals.
        let area = across.length_squared();
        let share_b = (place - *a).cross(*c - *a).dot(across) / area;
        let share_c = (*b - *a).cross(place - *a).dot(across) / area;
        let blended = normals[0] * (1.0 - share_b - share_c) + normals[1] * share_b + normals[2] * share_c;
        let towards_viewer = |normal: DVec3| if normal.dot(direction) > 0.0 { -normal } else { normal };
        let normal = across.normalize_or_zero();
        // Both normals look to the same side of the triangle.
        let smooth = if blended.dot(normal) < 0.0 { -blended } else { blended };
        let side = if normal.dot(direction) > 0.0 { -1.0 } else { 1.0 };
        Some(SurfacePoint {
            place,
            normal: towards_viewer(normal),
            smooth_normal: (smooth * side).normalize_or(towards_viewer(normal)),
            object: self.objects[number as usize],
            triangle: number,
        })
    }

    /// The point that a ray meets first.
    pub(crate) fn see(&self, ray: (DVec3, DVec3)) -> Option<SurfacePoint> {
        self.point_on(self.first(ray)?, ray)
    }

    /// Whether a point is inside of its triangle, or on its border.
    pub(crate) fn is_inside(&self, point: &SurfacePoint) -> bool {
        let [a, b, c] = self.triangles[point.triangle as usize].corners;
        let across = (b - a).cross(c - a);
        let left_of = |from: DVec3, to: DVec3| (to - from).cross(point.place - from).dot(across) >= 0.0;
        left_of(a, b) && left_of(b, c) && left_of(c, a)
    }

    /// Whether nothing is between a point and the place, or the far away, that its light comes from.
    pub(crate) fn sees_light(&self, point: &SurfacePoint, to_light: DVec3, distance: f64) -> bool {
        let start = point.place + point.normal * self.gap;
        let ray = Ray::new(start.as_vec3().into(), to_light.as_vec3().into(), 0.0, distance as f32);
        self.bvh.ray_traverse_miss(ray, |ray, face| match self.numbers[face] == point.triangle {
            true => f32::INFINITY,
            false => self.faces[face].intersect(ray),
        })
    }
}
