//! Matter inside of surfaces: how much it hides, what light does in it, and its patterns; and the gloss of surfaces.

use glam::DAffine3;

/// The filling of an object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matter {
    /// Opacity of a way through it as long as `length`, from 0 to 1.
    pub opacity: f64,
    /// The reference length.
    pub length: f64,
    /// The share of what it absorbs that goes on as light all the same, by colour: 0 absorbs, 1 casts no shadow.
    pub transport: [f64; 3],
}

/// A rough mirror on top of a surface: facets distributed as in GGX.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gloss {
    /// From 0, a mirror, to 1; the square root of the width of the distribution.
    pub roughness: f64,
    /// Share of light that a facet reflects that is seen from straight above, from 0 to 1.
    pub reflectance: f64,
}

impl Matter {
    /// Nothing can be seen through it, and no light comes through.
    pub const OPAQUE: Self = Self { opacity: 1.0, length: 1.0, transport: [0.0; 3] };
}

/// Facets of a surface that reflect light, as far as they do not scatter it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shine {
    /// The exponent of the distribution of their normals, from 1 to 1000: the larger, the smoother.
    pub exponent: f64,
    /// Reflectance seen from straight above, from 0 to 1.
    pub reflectance: f64,
}

/// A pattern in the space of an object, before it is placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pattern {
    /// Octaves of noise.
    Fbm {
        /// The length of a cell of the first octave.
        size: f64,
        /// The number of octaves, from 1 to 12.
        octaves: u32,
        /// The frequency of an octave over that of the one before, from 1 to 4.
        lacunarity: f64,
        /// The height of an octave over that of the one before.
        gain: f64,
    },
    /// Octaves of ridges.
    Ridged {
        /// The length of a cell of the first octave.
        size: f64,
        /// The number of octaves, from 1 to 12.
        octaves: u32,
        /// The frequency of an octave over that of the one before, from 1 to 4.
        lacunarity: f64,
        /// Octaves lose this power of their frequency.
        power: f64,
        /// The height of ridges.
        offset: f64,
        /// The strength with which a ridge brings out the next one.
        gain: f64,
    },
    /// Bricks: 1 in a brick, 0 in the mortar.
    Brick {
        /// Length, height and depth of a brick.
        size: [f64; 3],
        /// The width of joints, in bricks along each axis.
        mortar: f64,
    },
}

/// A pattern inside of an object, and the matter that its values stand for.
#[derive(Debug, Clone, PartialEq)]
pub struct Detail {
    /// The pattern.
    pub pattern: Pattern,
    /// The way from places of the world to the space of the pattern.
    pub to_object: DAffine3,
    /// Matter by value, ascending, two or more; linear between, and clamped.
    pub knots: Vec<Knot>,
}

/// The matter of a value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// The value.
    pub value: f64,
    /// The colour of the matter, linear.
    pub colour: [f64; 3],
    /// The opacity of the reference length of the object's matter.
    pub opacity: f64,
    /// The share of what it absorbs that goes on all the same, by colour.
    pub transport: [f64; 3],
}
