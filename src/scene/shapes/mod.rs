//! Procedural shapes. Each stands on the plane y = 0 around the origin, with y up.

pub(crate) mod letters;
pub(crate) mod solid;
pub(crate) mod teapot;

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::points::random::Random;
use crate::scene::shapes::solid::{Form, Solid, Triangle, bar, block, polygon, surface};

/// A shape that is computed rather than read from a file.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A rectangle that receives shadows. It is no caster: the shadow map is fitted to the others.
    Ground {
        /// Extent in x and z.
        size: [f64; 2],
    },
    /// A block.
    Block {
        /// Extent in x, y and z.
        size: [f64; 3],
    },
    /// A ball.
    Ball {
        /// Its radius.
        radius: f64,
    },
    /// A round column.
    Column {
        /// Its radius.
        radius: f64,
        /// Its height.
        height: f64,
    },
    /// A round column that is closed below as well.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// Its height.
        height: f64,
    },
    /// A cone on its base.
    Cone {
        /// The radius of its base.
        radius: f64,
        /// Its height.
        height: f64,
    },
    /// Upright bars with two rails.
    Fence {
        /// Number of bars.
        bars: u32,
        /// Width and depth of a bar.
        width: f64,
        /// Distance from a bar to the next.
        gap: f64,
        /// Height of the bars.
        height: f64,
    },
    /// Crossed bars in a frame.
    Lattice {
        /// Openings across and up.
        cells: [u32; 2],
        /// Extent across and up.
        size: [f64; 2],
        /// Width and depth of a bar.
        width: f64,
    },
    /// Leaves scattered in a ball.
    Foliage {
        /// Number of leaves.
        leaves: u32,
        /// Radius of the ball.
        radius: f64,
        /// Length of a leaf.
        length: f64,
        /// Seed of the arrangement.
        seed: u64,
    },
    /// A line of capital letters and digits, standing.
    Text {
        /// The letters.
        text: String,
        /// Height of the letters.
        height: f64,
        /// Width of a stroke.
        stroke: f64,
    },
    /// A flat convex polygon, where its corners are.
    Polygon {
        /// At least three, one after the other around it.
        corners: Vec<DVec3>,
    },
    /// The Utah teapot, of its original size: about 6.4 long.
    Teapot {
        /// Subdivisions of each of its patches.
        divisions: u32,
    },
}

/// Subdivisions of round shapes: fine enough for straight silhouette pieces to be shorter than texels of most maps.
const ROUND: u32 = 96;

impl Shape {
    /// Its surface.
    pub(super) fn solid(&self) -> Solid {
        let mut out = Solid::default();
        match self {
            Shape::Ground { size: [x, z] } => {
                let (x, z) = (x / 2.0, z / 2.0);
                let corner = |x, z| DVec3::new(x, 0.0, z);
                polygon(&mut out, &[corner(-x, -z), corner(-x, z), corner(x, z), corner(x, -z)]);
            }
            Shape::Block { size: [x, y, z] } => {
                block(&mut out, DVec3::new(-x / 2.0, 0.0, -z / 2.0), DVec3::new(x / 2.0, *y, z / 2.0));
            }
            Shape::Ball { radius } => {
                surface(&mut out, ROUND, ROUND / 2, |u, v| {
                    let (around, down) = (u * TAU, v * TAU / 2.0);
                    let normal = DVec3::new(
                        libm::sin(down) * libm::sin(around),
                        libm::cos(down),
                        libm::sin(down) * libm::cos(around),
                    );
                    (normal * *radius + DVec3::Y * *radius, normal)
                });
                out.stand_for(0, Form::Ball { centre: DVec3::Y * *radius, radius: *radius });
            }
            Shape::Column { radius, height } => column(&mut out, *radius, *height),
            Shape::Cylinder { radius, height } => {
                column(&mut out, *radius, *height);
                lid(&mut out, *radius, 0.0);
            }
            Shape::Cone { radius, height } => {
                surface(&mut out, ROUND, 1, |u, v| {
                    let place = rim(u) * (radius * v) + DVec3::Y * (height * (1.0 - v));
                    (place, (rim(u) * *height + DVec3::Y * *radius).normalize())
                });
                lid(&mut out, *radius, 0.0);
                out.stand_for(0, Form::Cone { apex: DVec3::Y * *height, base: DVec3::ZERO, radius: *radius });
            }
            Shape::Fence { bars, width, gap, height } => fence(&mut out, *bars, *width, *gap, *height),
            Shape::Lattice { cells, size, width } => lattice(&mut out, *cells, *size, *width),
            Shape::Foliage { leaves, radius, length, seed } => foliage(&mut out, *leaves, *radius, *length, *seed),
            Shape::Text { text, height, stroke } => letters::write(&mut out, text, *height, *stroke),
            Shape::Polygon { corners } => polygon(&mut out, corners),
            Shape::Teapot { divisions } => teapot::build(&mut out, *divisions),
        }
        out
    }

    /// Returns whether the shadow map is fitted to it.
    pub(super) fn casts(&self) -> bool {
        !matches!(self, Shape::Ground { .. })
    }
}

fn rim(u: f64) -> DVec3 {
    DVec3::new(libm::sin(u * TAU), 0.0, libm::cos(u * TAU))
}

fn column(out: &mut Solid, radius: f64, height: f64) {
    surface(out, ROUND, 1, |u, v| (rim(u) * radius + DVec3::Y * height * (1.0 - v), rim(u)));
    lid(out, radius, height);
}

/// The top of a column, or its bottom, at height 0.
fn lid(out: &mut Solid, radius: f64, height: f64) {
    let middle = DVec3::Y * height;
    for i in 0..ROUND {
        let [a, b] = [i, i + 1].map(|i| rim(f64::from(i) / f64::from(ROUND)) * radius + middle);
        out.triangles.push(Triangle::flat(if height > 0.0 { [middle, a, b] } else { [middle, b, a] }));
    }
}

fn fence(out: &mut Solid, bars: u32, width: f64, gap: f64, height: f64) {
    let pitch = width + gap;
    let length = f64::from(bars) * pitch - gap;
    for index in 0..bars {
        let x = f64::from(index) * pitch - length / 2.0;
        block(out, DVec3::new(x, 0.0, -width / 2.0), DVec3::new(x + width, height, width / 2.0));
    }
    for y in [0.2 * height, 0.85 * height] {
        let half = DVec3::new(length / 2.0, width / 2.0, width / 4.0);
        let centre = DVec3::Y * y;
        block(out, centre - half, centre + half);
    }
}

fn lattice(out: &mut Solid, [across, up]: [u32; 2], [width, height]: [f64; 2], thick: f64) {
    let share = |index: u32, count: u32| f64::from(index) / f64::from(count);
    for index in 0..=across {
        let x = width * (share(index, across) - 0.5);
        bar(out, [x, 0.0], [x, height], thick, thick);
    }
    for index in 0..=up {
        let y = height * share(index, up);
        bar(out, [-width / 2.0, y], [width / 2.0, y], thick, thick);
    }
}

fn foliage(out: &mut Solid, leaves: u32, radius: f64, length: f64, seed: u64) {
    let mut random = Random::new(seed);
    let mut signed = || 2.0 * random.unit() - 1.0;
    for _ in 0..leaves {
        let place = loop {
            let place = DVec3::new(signed(), signed(), signed());
            if place.length_squared() <= 1.0 {
                break place * (radius - length / 2.0).max(0.0) + DVec3::Y * radius;
            }
        };
        let turn = DQuat::from_xyzw(signed(), signed(), signed(), signed() + 1e-3);
        let turn = turn.normalize();
        let at = |along: f64, across: f64| place + turn * DVec3::new(along * length, 0.0, across * length);
        polygon(out, &[at(-0.5, 0.0), at(0.05, 0.22), at(0.5, 0.0), at(0.05, -0.22)]);
    }
}
