//! Data that the host gives to the skeleton of the sweep: records of steps, rows of samples, materials.

use encase::ShaderType;
use glam::{UVec2, Vec3, Vec4};

use crate::scene::matter::Pattern;
use crate::technique::convolve::detail::Placement;
use crate::technique::convolve::fine::Placed;
use crate::technique::convolve::light::SlopeLight;
use crate::technique::convolve::material::{Material, Through};
use crate::technique::convolve::stack::Stack;
use crate::technique::convolve::stencil::{Gather, Stencil};
use crate::technique::convolve::surface::Lamp;
use crate::technique::convolve::sweep::Step;

/// The kinds of gathers of the skeleton.
const SAME: u32 = 0;
const DITHERED: u32 = 1;
const MAGNIFIED: u32 = 2;

/// The `rows` of the skeleton: colours of lights, gathers, samples.
pub(super) struct Rows {
    /// The rows.
    pub(super) words: Vec<[u32; 4]>,
    /// The gather of each light before, which the next one often is again, with its row.
    known: Vec<Option<(Gather<f32>, [u32; 4])>>,
}

impl Rows {
    /// The rows of lights.
    pub(super) fn new(lights: &[SlopeLight]) -> Self {
        let of_light = |light: &SlopeLight| {
            let [r, g, b] = light.colour.map(|channel| channel as f32);
            let Lamp { mean: [x, y], covariance: [xx, xy, yy] } = Lamp::new(light);
            [[r, g, b, 1.0], [x, y, xx, xy], [yy, 0.0, 0.0, 0.0]].map(|row| row.map(f32::to_bits))
        };
        let mut words: Vec<[u32; 4]> = lights.iter().flat_map(of_light).collect();
        if words.is_empty() {
            // An array must have an element.
            words.push([0; 4]);
        }
        Self { words, known: lights.iter().map(|_| None).collect() }
    }

    /// A step, after rows for its gathers.
    pub(super) fn record(&mut self, step: &Step<f32>, stack: &Stack) -> RecordRow {
        let gathers: Vec<[u32; 4]> =
            step.gathers.iter().enumerate().map(|(light, gather)| self.gather(light, gather)).collect();
        let first = self.words.len() as u32;
        self.words.extend(gathers);
        let (front, back) = stack.slab(step.slab);
        RecordRow {
            front: front as f32,
            back: back as f32,
            thickness: stack.thickness as f32,
            slab: step.slab as u32,
            gathers: first,
        }
    }

    fn gather(&mut self, light: usize, gather: &Gather<f32>) -> [u32; 4] {
        if let Some((known, row)) = &self.known[light]
            && known == gather
        {
            return *row;
        }
        let row = match gather {
            Gather::Same(stencil) => self.stencil(stencil),
            Gather::Dithered(stencils) => {
                let all: Vec<[u32; 4]> = stencils.iter().map(|stencil| self.stencil(stencil)).collect();
                let first = self.words.len() as u32;
                let count = all.len() as u32;
                self.words.extend(all);
                [first, count, DITHERED, 0]
            }
            Gather::Magnified { samples, beyond } => {
                let first = self.words.len() as u32;
                let bits = |number: f64| (number as f32).to_bits();
                self.words.extend(
                    samples.iter().map(|sample| [bits(sample.at[0]), bits(sample.at[1]), bits(sample.weight), 0]),
                );
                [first, samples.len() as u32, MAGNIFIED, bits(*beyond)]
            }
        };
        self.known[light] = Some((gather.clone(), row));
        row
    }

    fn stencil(&mut self, stencil: &Stencil<f32>) -> [u32; 4] {
        let first = self.words.len() as u32;
        let word = |offset: i64| offset as i32 as u32;
        self.words.extend(stencil.taps().iter().map(|(dy, dx, weight)| [word(*dx), word(*dy), weight.to_bits(), 0]));
        [first, stencil.len() as u32, SAME, 0]
    }
}

/// A `Frame` of the skeleton.
#[derive(ShaderType)]
pub(super) struct FrameRow {
    pub(super) size: UVec2,
    pub(super) lights: u32,
    pub(super) clamps: u32,
    pub(super) coverage: f32,
    pub(super) last: u32,
    pub(super) fresh: u32,
    pub(super) seed: u32,
    pub(super) compensates: u32,
    pub(super) drift: f32,
    pub(super) pixel_at_base: f32,
    pub(super) pixel_growth: f32,
    pub(super) integrates: u32,
}

/// A `Record` of the skeleton.
#[derive(ShaderType)]
pub(super) struct RecordRow {
    front: f32,
    back: f32,
    thickness: f32,
    slab: u32,
    gathers: u32,
}

/// The patterns of the skeleton; 0 is none.
const FBM: u32 = 1;
const RIDGED: u32 = 2;
const BRICK: u32 = 3;

/// A `Material` of the skeleton.
#[derive(ShaderType, Default)]
pub(super) struct MaterialRow {
    colour: Vec3,
    alpha: f32,
    through: Vec3,
    opacity: f32,
    transport: Vec3,
    length: f32,
    pub(super) exponent: f32,
    pub(super) reflectance: f32,
    pub(super) shown: u32,
    pattern: u32,
    numbers: Vec4,
    origin: Vec3,
    octaves: u32,
    right: Vec3,
    first_knot: u32,
    down: Vec3,
    knots: u32,
    away: Vec3,
}

impl MaterialRow {
    /// A material without detail or facets.
    pub(super) fn new(material: &Material, (alpha, through): Through) -> Self {
        let narrow = |numbers: [f64; 3]| Vec3::from_array(numbers.map(|number| number as f32));
        Self {
            colour: narrow(material.colour),
            alpha: alpha as f32,
            through: narrow(through),
            opacity: material.matter.opacity as f32,
            transport: narrow(material.matter.transport),
            length: material.matter.length as f32,
            ..Self::default()
        }
    }

    /// Puts detail into it, whose knots begin at a place in the lookups.
    pub(super) fn set_detail(&mut self, placed: &Placed, first_knot: usize) {
        let Placement { origin, right, down, away } = placed.placement;
        [self.origin, self.right, self.down, self.away] = [origin, right, down, away].map(Vec3::from_array);
        (self.first_knot, self.knots) = (first_knot as u32, placed.knots.len() as u32);
        let (pattern, octaves, numbers) = match placed.pattern {
            Pattern::Fbm { octaves, lacunarity, gain, .. } => (FBM, octaves, [lacunarity, gain, 0.0, 0.0]),
            Pattern::Ridged { octaves, lacunarity, power, offset, gain, .. } => {
                (RIDGED, octaves, [lacunarity, power, offset, gain])
            }
            Pattern::Brick { size: [x, y, z], mortar } => (BRICK, 0, [x, y, z, mortar]),
        };
        (self.pattern, self.octaves) = (pattern, octaves);
        self.numbers = Vec4::from_array(numbers.map(|number| number as f32));
    }
}
