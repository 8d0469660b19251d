//! Random points, lights and occluders in whole coordinates, a quarter of them degenerate.

use glam::DVec3;

use super::Question;
use super::exact::Whole;
use crate::points::random::Random;
use crate::technique::area::Occluder;

/// A random scene around the origin.
pub(super) struct Scene {
    pub(super) light: Vec<Whole>,
    pub(super) normal: Whole,
    /// For each occluder the flat polygons that it consists of.
    pub(super) occluders: Vec<Vec<Vec<Whole>>>,
    /// The same as the technique takes them.
    pub(super) bodies: Vec<Occluder>,
}

fn place(at: Whole) -> DVec3 {
    DVec3::from_array(at.map(|x| x as f64))
}

fn within(random: &mut Random, most: i64) -> i64 {
    random.below(2 * most as usize + 1) as i64 - most
}

fn vector(random: &mut Random, most: i64) -> Whole {
    std::array::from_fn(|_| within(random, most))
}

fn add(a: Whole, b: Whole, factor: i64) -> Whole {
    std::array::from_fn(|axis| a[axis] + factor * b[axis])
}

/// A flat convex polygon of up to `most` corners around a place.
fn polygon(random: &mut Random, around: Whole, extent: i64, most: usize) -> Vec<Whole> {
    loop {
        let (u, v) = (vector(random, 3), vector(random, 3));
        let points: Vec<[i64; 2]> = (0..12).map(|_| [within(random, extent), within(random, extent)]).collect();
        let outline = hull(points);
        let corners: Vec<Whole> = outline.iter().map(|[a, b]| add(add(around, u, *a), v, *b)).collect();
        let flat = u[0] * v[1] == u[1] * v[0] && u[1] * v[2] == u[2] * v[1] && u[2] * v[0] == u[0] * v[2];
        if !flat && (3..=most).contains(&corners.len()) {
            return corners;
        }
    }
}

/// The corners of the convex hull, none of them on a line with its neighbours.
fn hull(mut points: Vec<[i64; 2]>) -> Vec<[i64; 2]> {
    points.sort_unstable();
    points.dedup();
    let turn = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = [i64; 2]>| {
        let mut chain: Vec<[i64; 2]> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && turn(a, b, point) <= 0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut all = half(&mut points.iter().copied());
    all.extend(half(&mut points.iter().rev().copied()));
    all
}

/// The faces of a box.
fn faces(centre: Whole, halves: [Whole; 3]) -> Vec<Vec<Whole>> {
    let mut all = Vec::new();
    for axis in 0..3 {
        let (u, v) = (halves[(axis + 1) % 3], halves[(axis + 2) % 3]);
        for sign in [-1, 1] {
            let middle = add(centre, halves[axis], sign);
            all.push([(-1, -1), (1, -1), (1, 1), (-1, 1)].map(|(a, b)| add(add(middle, u, a), v, b)).to_vec());
        }
    }
    all
}

impl Scene {
    /// The scene of a number.
    pub(super) fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let around = add([0; 3], vector(&mut random, 20), 2);
        let light: Vec<Whole> = polygon(&mut random, around, 6, 8).iter().map(|at| add([0; 3], *at, 2)).collect();
        let mut normal = vector(&mut random, 3);
        if normal == [0; 3] {
            normal = [0, 0, 1];
        }
        let mut scene = Self { light, normal, occluders: Vec::new(), bodies: Vec::new() };
        let is_degenerate = random.below(4) == 0;
        for _ in 0..random.below(if is_degenerate { 4 } else { 9 }) {
            // Between the point and the light, more or less.
            let share = random.below(10) as i64;
            let target = scene.light[random.below(scene.light.len())];
            let near: Whole = std::array::from_fn(|axis| target[axis] * share / 8 + within(&mut random, 6));
            match random.below(if is_degenerate { 7 } else { 2 }) {
                0 => scene.polygon(polygon(&mut random, near, 5, 8)),
                1 => {
                    let shapes = [
                        [[4, 0, 0], [0, 5, 0], [0, 0, 3]],
                        [[3, 4, 0], [4, -3, 0], [0, 0, 5]],
                        [[1, 2, 2], [2, 1, -2], [2, -2, 1]],
                    ];
                    scene.block(near, shapes[random.below(3)]);
                }
                // Exactly before the light, or before a triangle of it.
                2 => {
                    let corners: Vec<Whole> = scene.light.iter().map(|at| at.map(|x| x / 2)).collect();
                    let count = corners.len();
                    let first = random.below(count);
                    let some = random.below(2) == 0;
                    let part = if some { 3 } else { count };
                    scene.polygon((0..part).map(|index| corners[(first + index) % count]).collect());
                }
                // A fan of triangles that abut.
                3 => {
                    let corners = polygon(&mut random, near, 5, 8);
                    for pair in corners[1..].windows(2) {
                        scene.polygon(vec![corners[0], pair[0], pair[1]]);
                    }
                }
                // The same twice, once the other way round.
                4 => {
                    let mut corners = polygon(&mut random, near, 5, 8);
                    scene.polygon(corners.clone());
                    corners.reverse();
                    scene.polygon(corners);
                }
                // Two boxes face to face.
                5 => {
                    let halves = [[3, 4, 0], [4, -3, 0], [0, 0, 5]];
                    scene.block(near, halves);
                    scene.block(add(near, halves[0], 2), halves);
                }
                // In the plane of the light.
                _ => scene.polygon(scene.light.clone()),
            }
        }
        scene
    }

    fn polygon(&mut self, corners: Vec<Whole>) {
        self.bodies.push(Occluder::polygon(corners.iter().copied().map(place).collect()));
        self.occluders.push(vec![corners]);
    }

    fn block(&mut self, centre: Whole, halves: [Whole; 3]) {
        // The origin outside, for what is inside has no silhouette.
        let square = |a: Whole| -> i64 { a.iter().map(|x| x * x).sum() };
        let along = |half: Whole| -> i64 { (0..3).map(|axis| centre[axis] * half[axis]).sum() };
        if halves.iter().all(|half| along(*half).abs() <= square(*half)) {
            return;
        }
        self.bodies.push(Occluder::block(place(centre), halves.map(place)));
        self.occluders.push(faces(centre, halves));
    }

    /// The scene as the technique takes it.
    pub(super) fn question(&self) -> Question {
        Question {
            light: self.light.iter().copied().map(place).collect(),
            two_sided: true,
            point: DVec3::ZERO,
            normal: place(self.normal),
            occluders: self.bodies.clone(),
            shape: None,
        }
    }
}
