//! Rays: the first surface that is met, and tests for anything in the way.
//!
//! Balls and cones are traced as the triangles that stand for them ([`Rays::new`]) or exactly
//! ([`Rays::exact`]). There are two kinds of tests: from a point that a ray has found
//! towards a light without extent, and of any open segment.
//!
//! The hierarchy works in single precision and only *finds* triangles. Where on
//! a triangle a ray ends is computed from the triangle's plane in double
//! precision, so that a shadow map and its receivers agree about depths.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::{Ray, RayHit};

use super::round::Round;
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
    /// For each triangle the number of the part of its object that it stands for.
    parts: Vec<Option<u32>>,
    /// Solids that are traced exactly; their triangles are not in the hierarchy.
    solids: Vec<Exact>,
    /// Distance of the start of a shadow ray from its surface.
    gap: f64,
    /// Largest coordinate, which tells how fine numbers of a precision are.
    reach: f64,
}

/// A ball or a cone that is traced exactly.
#[derive(Debug)]
struct Exact {
    solid: Round,
    /// The first of the triangles that stand for it.
    triangle: u32,
}

/// Tests of open segments by one thread, counted.
///
/// The count is kept by the thread, and added to the shared one, if there is one,
/// when the thread is done: counting costs nothing that could be measured.
#[derive(Debug)]
pub struct Tests<'r> {
    rays: &'r Rays,
    count: Cell<u64>,
    shared: Option<&'r AtomicU64>,
}

/// A point of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// Its place.
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

impl Drop for Tests<'_> {
    fn drop(&mut self) {
        if let Some(shared) = self.shared {
            shared.fetch_add(self.count.get(), Ordering::Relaxed);
        }
    }
}

impl Tests<'_> {
    /// Returns whether nothing lies between two places; see [`Rays::is_open`].
    pub fn is_open(&self, from: DVec3, to: DVec3) -> bool {
        self.count.set(self.count.get() + 1);
        self.rays.is_open(from, to)
    }

    /// The number of tests so far.
    pub fn count(&self) -> u64 {
        self.count.get()
    }
}

impl Rays {
    /// Builds the hierarchy of a scene, of triangles alone.
    pub fn new(scene: &Scene) -> Self {
        Self::build(scene, false)
    }

    /// Builds the hierarchy of a scene in which balls and cones are traced exactly.
    pub fn exact(scene: &Scene) -> Self {
        Self::build(scene, true)
    }

    fn build(scene: &Scene, exact: bool) -> Self {
        let (objects, triangles): (Vec<u32>, Vec<Triangle>) =
            scene.triangles().map(|(object, triangle)| (object as u32, *triangle)).unzip();
        let (mut parts, mut solids) = (vec![None; triangles.len()], Vec::new());
        let mut first = 0;
        for object in &scene.objects {
            for (number, part) in object.parts.iter().enumerate() {
                parts[first + part.triangles.start..first + part.triangles.end].fill(Some(number as u32));
                if let (Some(solid), true) = (Round::of(&part.form), exact) {
                    solids.push(Exact { solid, triangle: (first + part.triangles.start) as u32 });
                }
            }
            first += object.triangles.len();
        }
        let is_round = |number: u32| {
            let object = &scene.objects[objects[number as usize] as usize];
            let part = parts[number as usize].and_then(|part| object.parts.get(part as usize));
            part.is_some_and(|part| Round::of(&part.form).is_some())
        };
        let traced: Vec<u32> = (0..triangles.len() as u32).filter(|number| !exact || !is_round(*number)).collect();
        let single = |at: DVec3| Vec3A::from(at.as_vec3());
        let face = |number: &u32| {
            let [v0, v1, v2] = triangles[*number as usize].corners.map(single);
            obvhs::triangle::Triangle { v0, v1, v2 }
        };
        let faces: Vec<obvhs::triangle::Triangle> = traced.iter().map(face).collect();
        let bvh = build_cwbvh_from_tris(&faces, BvhBuildParams::fast_build(), &mut Duration::default());
        let numbers = bvh.primitive_indices.iter().map(|index| traced[*index as usize]).collect();
        let faces = bvh.primitive_indices.iter().map(|index| faces[*index as usize]).collect();
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (lo, hi) = triangles.iter().flat_map(|t| t.corners).fold(start, |(lo, hi), p| (lo.min(p), hi.max(p)));
        let (gap, reach) = (4e-6 * (hi - lo).max_element(), lo.abs().max(hi.abs()).max_element());
        Self { bvh, faces, numbers, triangles, objects, parts, solids, gap, reach }
    }

    pub(crate) fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The triangles that rays are tested against.
    #[cfg(feature = "gpu")]
    pub(crate) fn faces(&self) -> &[obvhs::triangle::Triangle] {
        &self.faces
    }

    /// The largest coordinate.
    #[cfg(feature = "gpu")]
    pub(crate) fn reach(&self) -> f64 {
        self.reach
    }

    /// The solids that are traced exactly.
    #[cfg(feature = "gpu")]
    pub(crate) fn solids(&self) -> impl Iterator<Item = Round> {
        self.solids.iter().map(|exact| exact.solid)
    }

    /// Number of the first triangle that a ray meets; balls and cones apart that are traced exactly.
    pub(crate) fn first(&self, ray: (DVec3, DVec3)) -> Option<u32> {
        self.first_face(ray).map(|(number, _)| number)
    }

    /// The first triangle that a ray meets, and roughly how far away.
    fn first_face(&self, (start, direction): (DVec3, DVec3)) -> Option<(u32, f32)> {
        let ray = Ray::new_inf(start.as_vec3().into(), direction.as_vec3().into());
        let mut hit = RayHit::none();
        let found = self.bvh.ray_traverse(ray, &mut hit, |ray, face| self.faces[face].intersect(ray));
        found.then(|| (self.numbers[hit.primitive_id as usize], hit.t))
    }

    /// The point where a ray meets the plane of a triangle, inside of the triangle or not.
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
        let face = self.first_face(ray);
        let entries = self.solids.iter().filter_map(|exact| Some((exact, exact.solid.entry(ray)?)));
        let nearest = entries.min_by(|(_, (a, _)), (_, (b, _))| a.total_cmp(b));
        match (face, nearest) {
            (Some((_, distance)), Some((exact, entry))) if entry.0 < f64::from(distance) => {
                Some(self.on_solid(exact, ray, entry))
            }
            (Some((number, _)), _) => self.point_on(number, ray),
            (None, Some((exact, entry))) => Some(self.on_solid(exact, ray, entry)),
            (None, None) => None,
        }
    }

    fn on_solid(
        &self,
        Exact { triangle, .. }: &Exact,
        (start, direction): (DVec3, DVec3),
        (distance, normal): (f64, DVec3),
    ) -> SurfacePoint {
        let (place, object) = (start + direction * distance, self.objects[*triangle as usize]);
        SurfacePoint { place, normal, smooth_normal: normal, object, triangle: *triangle }
    }

    /// The number of the part of its object that a point lies on, if that has an exact form.
    pub fn part(&self, point: &SurfacePoint) -> Option<usize> {
        self.parts[point.triangle as usize].map(|part| part as usize)
    }

    /// Returns whether nothing lies between two places. The ends are excluded: surfaces that they lie on block
    /// nothing there, nor do surfaces seen edge-on; the inside of a closed surface is as open as its outside,
    /// but for balls and cones that are traced exactly.
    pub fn is_open(&self, from: DVec3, to: DVec3) -> bool {
        let length = (to - from).length();
        // Places that a ray has found are as exact as double precision makes them.
        let end = 1e-9 * self.reach;
        if length <= 2.0 * end {
            return true;
        }
        if self.solids.iter().any(|exact| exact.solid.meets(from, to)) {
            return false;
        }
        let direction = (to - from) / length;
        let ray = Ray::new(from.as_vec3().into(), direction.as_vec3().into(), 0.0, length as f32 * 1.000_001);
        self.bvh.ray_traverse_miss(ray, |_, face| {
            let distance = self.crossing(self.numbers[face], (from, direction));
            if distance.is_some_and(|distance| distance > end && distance < length - end) { 0.0 } else { f32::INFINITY }
        })
    }

    /// Tests of open segments for a thread, whose count is added to a shared one, if given, when the thread is done.
    pub fn tests<'r>(&'r self, shared: Option<&'r AtomicU64>) -> Tests<'r> {
        Tests { rays: self, count: Cell::new(0), shared }
    }

    /// Distance to where a ray crosses a triangle.
    fn crossing(&self, number: u32, (start, direction): (DVec3, DVec3)) -> Option<f64> {
        let [a, b, c] = self.triangles[number as usize].corners;
        let across = (b - a).cross(c - a);
        let distance = (a - start).dot(across) / direction.dot(across);
        if !distance.is_finite() {
            return None;
        }
        let place = start + direction * distance;
        // The hierarchy may have found only one of two faces that meet near here, and not the one that is met: each
        // is wider by more than single precision can tell apart, so that there is no gap between them.
        let slack = 4.0 * f64::from(f32::EPSILON) * self.reach;
        let least = -slack * across.length();
        let left_of = |from: DVec3, to: DVec3| {
            let side = (to - from).cross(place - from).dot(across);
            side >= 0.0 || side >= least * (to - from).length()
        };
        (left_of(a, b) && left_of(b, c) && left_of(c, a)).then_some(distance)
    }

    /// Returns whether a point is inside of its triangle, or on its border.
    pub(crate) fn is_inside(&self, point: &SurfacePoint) -> bool {
        let [a, b, c] = self.triangles[point.triangle as usize].corners;
        let across = (b - a).cross(c - a);
        let left_of = |from: DVec3, to: DVec3| (to - from).cross(point.place - from).dot(across) >= 0.0;
        left_of(a, b) && left_of(b, c) && left_of(c, a)
    }

    /// Returns whether nothing lies between a point and the light in a direction, at a distance that may be infinite.
    /// Balls and cones that are traced exactly are left out.
    pub(crate) fn sees_light(&self, point: &SurfacePoint, to_light: DVec3, distance: f64) -> bool {
        let start = point.place + point.normal * self.gap;
        let ray = Ray::new(start.as_vec3().into(), to_light.as_vec3().into(), 0.0, distance as f32);
        self.bvh.ray_traverse_miss(ray, |ray, face| {
            if self.numbers[face] == point.triangle { f32::INFINITY } else { self.faces[face].intersect(ray) }
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::diag::Source;
    use crate::points::random::Random;
    use crate::scene::Form;

    fn scene(objects: &str) -> Scene {
        let text = format!(
            "Scene(camera: (eye: (0, 3, 6), target: (0, 0, 0)), light: Directional(direction: (0, -1, 0)), objects: [{objects}])"
        );
        Scene::parse("test", &Source::new("scene.ron", text), Path::new("")).unwrap_or_else(|error| panic!("{error}"))
    }

    const OBJECTS: &str = "(shape: Ground(size: (8, 8))), (shape: Ball(radius: 0.7), at: (1, 0.2, 0), scale: 1.5), \
        (shape: Block(size: (1, 2, 0.5)), at: (-1, 0.5, 0.5), turn: (10, 30, 0), copies: (count: 2, step: (0, 0, -1.5))), \
        (shape: Polygon(corners: [(0, 1, 2), (1, 1, 2), (1.5, 2, 2), (0.5, 3, 2), (-0.5, 2, 2)])), \
        (shape: Cone(radius: 0.8, height: 1.2), at: (0, 0.3, -1.5), turn: (20, 0, 30), scale: 1.2)";

    /// Returns whether a segment meets the interior of a form: a slow way that shares nothing with the fast one.
    fn meets(form: &Form, from: DVec3, to: DVec3) -> bool {
        match form {
            Form::Ball { centre, radius } => {
                (0..=20_000).any(|i| (from.lerp(to, f64::from(i) / 20_000.0) - *centre).length() < *radius)
            }
            Form::Cone { apex, base, radius } => (0..=20_000).any(|i| {
                let (down, axis) = (from.lerp(to, f64::from(i) / 20_000.0) - *apex, *base - *apex);
                let depth = down.dot(axis) / axis.length_squared();
                depth > 0.0 && depth < 1.0 && (down - depth * axis).length() < depth * radius
            }),
            Form::Polygon { corners } => {
                let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                let (a, b) = ((from - corners[0]).dot(normal), (to - corners[0]).dot(normal));
                let place = from.lerp(to, a / (a - b));
                let left = |i: usize| {
                    let (p, q) = (corners[i], corners[(i + 1) % corners.len()]);
                    (q - p).cross(place - p).dot(normal) > 0.0
                };
                a * b < 0.0 && (0..corners.len()).all(left)
            }
            Form::Box { centre, halves } => {
                // Its surface is met where the segment is inside all three pairs of faces, from one end to the other.
                let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
                for half in halves {
                    let at = |place: DVec3| (place - *centre).dot(*half) / half.length_squared();
                    let (a, b) = (at(from), at(to));
                    let (one, other) = ((-1.0 - a) / (b - a), (1.0 - a) / (b - a));
                    enters = enters.max(one.min(other));
                    leaves = leaves.min(one.max(other));
                }
                enters < leaves && (enters > 0.0 || leaves < 1.0)
            }
        }
    }

    #[test]
    fn segments_are_open_where_they_meet_no_exact_form() {
        let scene = scene(OBJECTS);
        assert!(scene.objects.iter().all(crate::scene::Object::is_exact));
        assert_eq!(scene.objects[2].parts.len(), 2);
        let rays = Rays::exact(&scene);
        let forms: Vec<&Form> = scene.objects.iter().flat_map(|object| &object.parts).map(|part| &part.form).collect();
        let mut random = Random::new(7);
        let mut place = || DVec3::new(random.unit() - 0.5, random.unit() - 0.2, random.unit() - 0.5) * 5.0;
        let mut open = 0;
        for _ in 0..2000 {
            let (from, to) = (place(), place());
            let expected = !forms.iter().any(|form| meets(form, from, to));
            assert_eq!(rays.is_open(from, to), expected, "{from} {to}");
            open += u32::from(expected);
        }
        assert!((300..1700).contains(&open), "{open}");
    }

    #[test]
    fn the_surfaces_of_its_ends_do_not_block_a_segment() {
        let scene = scene(OBJECTS);
        for rays in [Rays::new(&scene), Rays::exact(&scene)] {
            let eye = scene.camera.eye;
            let view = scene.camera.view(40, 30);
            let mut seen = 0;
            for pixel in 0..40 * 30 {
                let ray = view.ray((f64::from(pixel % 40) + 0.5) / 40.0, (f64::from(pixel / 40) + 0.5) / 30.0);
                let Some(point) = rays.see(ray) else { continue };
                assert!(rays.is_open(point.place, eye) && rays.is_open(eye, point.place), "{point:?}");
                // Beyond the surface lies its other side.
                let behind = point.place + 0.01 * ray.1;
                assert!(!rays.is_open(eye, behind), "{point:?}");
                seen += 1;
            }
            assert!(seen > 500, "{seen}");
        }
    }

    #[test]
    fn flat_surfaces_have_no_seams() {
        let rays = Rays::new(&scene("(shape: Ground(size: (8, 8))), (shape: Ground(size: (8, 8)), at: (8, 0, 0))"));
        // Through the diagonal of a rectangle, and through the side that two of them share.
        for i in 0..1000 {
            let at = -3.9 + 0.0078 * f64::from(i);
            for (x, z) in [(at, at), (4.0, at)] {
                let [from, to] = [DVec3::new(x - 0.3, 1.0, z + 0.7), DVec3::new(x + 0.3, -1.0, z - 0.7)];
                assert!(!rays.is_open(from, to), "{x} {z}");
            }
        }
        // In the plane of the ground.
        assert!(rays.is_open(DVec3::new(-9.0, 0.0, 0.1), DVec3::new(20.0, 0.0, 0.3)));
    }

    #[test]
    fn tests_are_counted_over_threads() {
        let scene = scene(OBJECTS);
        let rays = Rays::new(&scene);
        let count = AtomicU64::new(0);
        std::thread::scope(|scope| {
            for thread in 1..=4_u32 {
                let (rays, count) = (&rays, &count);
                scope.spawn(move || {
                    let tests = rays.tests(Some(count));
                    for i in 0..10 * thread {
                        tests.is_open(DVec3::ZERO, DVec3::new(f64::from(i), 1.0, 0.0));
                    }
                    assert_eq!(tests.count(), u64::from(10 * thread));
                });
            }
        });
        assert_eq!(count.load(Ordering::Relaxed), 100);
        let tests = rays.tests(None);
        tests.is_open(DVec3::ZERO, DVec3::ONE);
        assert_eq!(tests.count(), 1);
    }
}
