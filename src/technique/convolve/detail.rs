//! Detail inside of objects: patterns of `tables/noise.ron` at places of the object's own space, and what their values
//! stand for. Everything here is in single precision and in one order of operations, as it is on devices.

use glam::DVec3;

use super::functions::Function;
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
use crate::scene::matter::{Detail, Knot, Pattern};
use crate::technique::tables::{NOISE, SHADE, columns};

/// The way from a pixel and a depth to a place in the space of a pattern.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Placement {
    /// The place of the middle of the picture at the base of depths.
    pub origin: [f32; 3],
    /// For a unit to the right.
    pub right: [f32; 3],
    /// For a unit down.
    pub down: [f32; 3],
    /// For a unit of depth.
    pub away: [f32; 3],
}

/// The units of a pixel: the same everywhere, or growing with depth.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PixelSize {
    /// At the base of depths.
    pub at_base: f32,
    /// For a unit of depth.
    pub growth: f32,
}

impl PixelSize {
    /// As a view has it, with depths relative to a base.
    pub fn new(view: &SlabView, base: f64) -> Self {
        if view.is_parallel() {
            return Self { at_base: (1.0 / view.scale_at(0.0)) as f32, growth: 0.0 };
        }
        let growth = 1.0 / view.scale_at(1.0);
        Self { at_base: (base * growth) as f32, growth: growth as f32 }
    }
}

impl Placement {
    /// For an object's detail.
    pub fn new(detail: &Detail, view: &SlabView, base: f64) -> Self {
        let [eye, right, down, forward] = view.frame();
        let scale = match detail.pattern {
            Pattern::Fbm { size, .. } | Pattern::Ridged { size, .. } => 1.0 / size,
            Pattern::Brick { .. } => 1.0,
        };
        let vector = |of: DVec3| (detail.to_object.transform_vector3(of) * scale).as_vec3().to_array();
        let origin = detail.to_object.transform_point3(eye + forward * base) * scale;
        Self { origin: origin.as_vec3().to_array(), right: vector(right), down: vector(down), away: vector(forward) }
    }

    /// The place of a depth at a pixel, which is given as its centre's distance from the middle of the picture.
    pub fn at(&self, [x, y]: [f32; 2], depth: f32, size: PixelSize) -> [f32; 3] {
        let unit = size.at_base + depth * size.growth;
        let (x, y) = (x * unit, y * unit);
        [0, 1, 2].map(|i| self.origin[i] + x * self.right[i] + y * self.down[i] + depth * self.away[i])
    }
}

/// The functions of patterns, for a row of pixels.
#[derive(Debug)]
pub struct Patterns {
    octave: Batch<'static, f32>,
    ridge: Batch<'static, f32>,
    brick: Batch<'static, f32>,
}

impl Patterns {
    /// The functions of patterns.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new() -> Result<Self, Failure> {
        Ok(Self {
            octave: Batch::new(NOISE.function("fbm_octave")?),
            ridge: Batch::new(NOISE.function("ridged_octave")?),
            brick: Batch::new(NOISE.function("brick")?),
        })
    }

    /// The values of a pattern at places.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn values(&mut self, pattern: &Pattern, places: &[[f32; 3]]) -> Result<Vec<f32>, Failure> {
        let count = places.len();
        let mut at = [0, 1, 2].map(|axis| places.iter().map(|place| place[axis]).collect::<Vec<f32>>());
        let same = |number: f64| vec![number as f32; count];
        let lacks = |_| {
            let message = "a pattern of the table `noise` needs an input that was not given";
            Failure::bare("noise", Diagnostic::error(codes::NOT_APPLICABLE, message))
        };
        Ok(match *pattern {
            Pattern::Fbm { octaves, lacunarity, gain, .. } => {
                let octave = NOISE.function("fbm_octave")?;
                let (mut height, mut sum) = (vec![1.0; count], vec![0.0; count]);
                for _ in 0..octaves {
                    let [x, y, z] = at;
                    let given = [x, y, z, same(lacunarity), same(gain), height, sum];
                    let names = ["px", "py", "pz", "lacunarity", "gain", "height", "total"];
                    let next = self.octave.evaluate(&columns(octave, names, given)?).map_err(lacks)?;
                    at = [0, 1, 2].map(|axis| next.values(axis).to_vec());
                    (height, sum) = (next.values(3).to_vec(), next.values(4).to_vec());
                }
                sum
            }
            Pattern::Ridged { octaves, lacunarity, power, offset, gain, .. } => {
                let ridge = NOISE.function("ridged_octave")?;
                let (mut height, mut weight, mut sum) = (vec![1.0; count], vec![1.0; count], vec![0.0; count]);
                for _ in 0..octaves {
                    let [x, y, z] = at;
                    let [ratio, power, offset, gain] = [lacunarity, power, offset, gain].map(same);
                    let given = [x, y, z, ratio, power, offset, gain, height, weight, sum];
                    let names = ["px", "py", "pz", "lacunarity", "H", "offset", "gain", "height", "weight", "total"];
                    let next = self.ridge.evaluate(&columns(ridge, names, given)?).map_err(lacks)?;
                    at = [0, 1, 2].map(|axis| next.values(axis).to_vec());
                    height = next.values(3).to_vec();
                    (weight, sum) = (next.values(4).to_vec(), next.values(5).to_vec());
                }
                sum
            }
            Pattern::Brick { size, mortar } => {
                let brick = NOISE.function("brick")?;
                let [x, y, z] = at;
                let given = [x, y, z, same(size[0]), same(size[1]), same(size[2]), same(mortar)];
                let names = ["px", "py", "pz", "bx", "by", "bz", "mortar"];
                self.brick.evaluate(&columns(brick, names, given)?).map_err(lacks)?.values(0).to_vec()
            }
        })
    }
}

/// The matter that a value of a pattern stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Meant {
    /// Its colour.
    pub colour: [f32; 3],
    /// Opacity of the reference length.
    pub opacity: f32,
    /// The share of what is absorbed that goes on all the same.
    pub transport: [f32; 3],
    /// The absorption of a unit of length.
    pub extinction: f32,
}

/// The numbers of a knot as devices have them: value, colour, opacity, transport, extinction.
pub type Numbers = [f32; 9];

/// The numbers of a knot whose opacity is that of a length.
pub fn numbers(knot: &Knot, length: f64) -> Numbers {
    let Knot { value, colour: [r, g, b], opacity, transport: [s, t, u] } = *knot;
    let extinction = (-libm::log1p(-opacity) / length).min(MOST_EXTINCTION);
    [value, r, g, b, opacity, s, t, u, extinction].map(|number| number as f32)
}

/// The transfer function at a value: linear between knots, and clamped to them.
pub fn meant(knots: &[Numbers], value: f32) -> Meant {
    let mut next = 1;
    while next + 1 < knots.len() && knots[next][0] <= value {
        next += 1;
    }
    let (before, after) = (&knots[next - 1], &knots[next]);
    let width = after[0] - before[0];
    let share = if width > 0.0 { ((value - before[0]) / width).clamp(0.0, 1.0) } else { 1.0 };
    let mixed = |i: usize| before[i] + share * (after[i] - before[i]);
    Meant {
        colour: [mixed(1), mixed(2), mixed(3)],
        opacity: mixed(4),
        transport: [mixed(5), mixed(6), mixed(7)],
        extinction: mixed(8),
    }
}

/// The functions that integrate between two values.
#[derive(Debug, Clone, Copy)]
pub(super) struct Integrals {
    piece: Function,
    whole: Function,
}

impl Integrals {
    /// The functions of `tables/shade.ron`.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub(super) fn new() -> Result<Self, Failure> {
        Ok(Self { piece: Function::of(&SHADE, "piece_of_ramp")?, whole: Function::of(&SHADE, "preintegrated")? })
    }

    /// Opacity and colour of a way on which the pattern goes from one value to another.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub(super) fn between(&self, knots: &[Numbers], ends: [f32; 2], path: f64) -> Result<(f64, [f64; 3]), Failure> {
        let [lo, hi] = [knots[0][0], knots[knots.len() - 1][0]];
        let [front, back] = ends.map(|value| value.clamp(lo, hi));
        let middle = meant(knots, 0.5 * (front + back));
        let mut alpha = 0.0;
        let mut colour = [0.0; 3];
        for channel in 0..3 {
            let (mut tau, mut tau_c) = (0.0, 0.0);
            for pair in knots.windows(2) {
                let given = [
                    ("s_front", front.into()),
                    ("s_back", back.into()),
                    ("s0", pair[0][0].into()),
                    ("s1", pair[1][0].into()),
                    ("tau0", pair[0][8].into()),
                    ("tau1", pair[1][8].into()),
                    ("colour0", pair[0][1 + channel].into()),
                    ("colour1", pair[1][1 + channel].into()),
                ];
                let sums = self.piece.call(&given.map(|(name, number): (_, f64)| (name, number.into())))?;
                let [more, more_c] = sums.numbers(["tau", "tau_c"])?;
                (tau, tau_c) = (tau + more, tau_c + more_c);
            }
            let given = [
                ("sum_tau", tau),
                ("sum_tau_c", tau_c),
                ("s_front", front.into()),
                ("s_back", back.into()),
                ("path", path),
                ("tau_mid", middle.extinction.into()),
                ("c_mid", middle.colour[channel].into()),
                ("range", (hi - lo).into()),
            ];
            let answer = self.whole.call(&given.map(|(name, number)| (name, number.into())))?;
            [alpha, colour[channel]] = answer.numbers(["alpha", "colour"])?;
        }
        Ok((alpha, colour))
    }
}

/// The most that extinction can be, for a unit of length: what the table is made for.
const MOST_EXTINCTION: f64 = 1e4;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn octaves_add_up_to_the_functions_of_the_table() {
        let mut patterns = Patterns::new().expect("built in");
        let places = [[0.25, 0.5, 0.75], [1.5, -2.25, 3.125]];
        let fbm = Pattern::Fbm { size: 1.0, octaves: 3, lacunarity: 2.0, gain: 0.5 };
        let found = patterns.values(&fbm, &places).expect("built in");
        assert!((found[0] + 0.144_715_31).abs() < 1e-6, "{found:?}");
        let ridged = Pattern::Ridged { size: 1.0, octaves: 3, lacunarity: 2.0, power: 1.0, offset: 1.0, gain: 2.0 };
        let found = patterns.values(&ridged, &places).expect("built in");
        assert!((found[0] - 1.064_565_7).abs() < 1e-5, "{found:?}");
        let brick = Pattern::Brick { size: [1.0, 0.5, 1.0], mortar: 0.125 };
        assert_eq!(patterns.values(&brick, &[[0.5, 0.25, 0.5], [0.5, 0.75, 0.5]]).expect("built in"), [1.0, 0.0]);
    }

    #[test]
    fn values_beyond_the_knots_are_clamped() {
        let knot = |value, opacity| [value, 1.0, 0.5, 0.0, opacity, 0.0, 0.0, 0.0, 0.0];
        let knots = [knot(0.0, 0.0), knot(0.5, 1.0), knot(0.5, 0.25), knot(1.0, 1.0)];
        let opacity = |value| meant(&knots, value).opacity;
        assert_eq!([-3.0, 0.25, 0.75, 9.0].map(opacity), [0.0, 0.5, 0.625, 1.0]);
        // At a step the value belongs to what comes behind it.
        assert_eq!(opacity(0.5), 0.25);
    }

    /// The value of the specification, and both ways alike.
    #[test]
    fn pre_integration_of_a_ramp() {
        let knot = |value: f64, extinction: f64| {
            let opacity = -libm::expm1(-extinction * 0.05);
            numbers(&Knot { value, colour: [value; 3], opacity, transport: [0.0; 3] }, 0.05)
        };
        let knots = [knot(0.0, 0.0), knot(0.5, 20.0), knot(1.0, 20.0)];
        let integrals = Integrals::new().expect("built in");
        for ends in [[0.25, 0.75], [0.75, 0.25]] {
            let (alpha, colour) = integrals.between(&knots, ends, 0.05).expect("built in");
            assert!((alpha - 0.583_137_98).abs() < 1e-6, "{alpha}");
            assert!((colour[1] - 11.0 / 21.0).abs() < 1e-6, "{colour:?}");
        }
    }
}
