//! Matter inside of surfaces: how much it hides, and what light does in it.

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
