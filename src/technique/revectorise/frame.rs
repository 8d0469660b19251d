//! The data that passes exchange: shadow map, receivers, visibility.
//!
//! **Receivers are fixed point.** The depth and the slopes of a receiver are
//! multiples of [`DEPTH_UNIT`], small enough for `f32` to compute
//! [`Receiver::depth_at`] without any rounding, whatever a compiler does about
//! fused operations. So CPU and GPU decide each depth test alike.

use crate::technique::rendered;

/// The unit of receivers' depths, 2^-22: multiples of it up to 4 are exact in `f32`.
pub const DEPTH_UNIT: f32 = 1.0 / (1 << 22) as f32;

/// Rounds a depth to the fixed point of receivers, within `limit` in magnitude.
pub fn fixed_depth(depth: f32, limit: f32) -> f32 {
    // A surface seen edge-on has a slope of infinity, and no slope at all where it is a point.
    let depth = if depth.is_nan() { 0.0 } else { depth.clamp(-limit, limit) };
    (depth / DEPTH_UNIT).round_ties_even() * DEPTH_UNIT
}

/// The steepest slope of a receiver in a map of a size, per texel: exact as far as the map reaches.
pub fn max_slope(size: u32) -> f32 {
    4.0 / size as f32
}

/// Depths seen from the light, one per texel.
#[derive(Debug, Clone, PartialEq)]
pub struct ShadowMap {
    /// Texels per side.
    pub size: u32,
    /// Row by row from the top; 0 is near the light, 1 is far or empty. The depth
    /// bias is added already. `v` of a receiver grows with the row.
    pub depth: Vec<f32>,
}

impl ShadowMap {
    /// The depth of a texel; `None` outside the map, where everything is lit.
    pub fn get(&self, x: i32, y: i32) -> Option<f32> {
        let size = self.size as i32;
        ((0..size).contains(&x) && (0..size).contains(&y)).then(|| self.depth[(y * size + x) as usize])
    }
}

/// The kinds of pixels, by what has to be done about them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum ReceiverKind {
    /// Nothing is there: visibility 1.
    #[default]
    Background = 0,
    /// A surface that faces the light: the technique decides.
    Facing = 1,
    /// A surface that faces away from the light: visibility 0.
    Away = 2,
}

/// The point of a surface that a pixel shows, seen from the light.
///
/// The surface is continued as a plane: a test of a neighbouring texel asks
/// whether the *plane* is lit there. A receiver that leans away from the light
/// would otherwise shadow itself in the neighbours that lie deeper, and a walk
/// along a silhouette would end after a few texels. With slopes of zero this is
/// the test of the published techniques.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Receiver {
    /// Place in the map, 0 at the left and 1 at the right border; may lie outside.
    pub u: f32,
    /// Place in the map, 0 at the top and 1 at the bottom border; may lie outside.
    pub v: f32,
    /// Depth of the plane at the centre of the texel that the point is in, within 0 to 1.
    pub z: f32,
    /// Its kind, which says what has to be done about it.
    pub kind: ReceiverKind,
    /// Change of the depth from a texel to the next on the right, within [`max_slope`].
    pub dz_dx: f32,
    /// Change of the depth from a texel to the next below, within [`max_slope`].
    pub dz_dy: f32,
}

impl Receiver {
    /// The texel that the point is in, and the place in it: `floor(uv * size)` and the rest.
    pub fn texel(&self, size: u32) -> ([i32; 2], [f32; 2]) {
        let (x, y) = (self.u * size as f32, self.v * size as f32);
        ([x.floor() as i32, y.floor() as i32], [x - x.floor(), y - y.floor()])
    }

    /// Depth of the plane `dx`, `dy` texels away; exact along a row or a column of the map.
    pub fn depth_at(&self, dx: i32, dy: i32) -> f32 {
        self.z + self.dz_dx * dx as f32 + self.dz_dy * dy as f32
    }
}

/// The receivers of a picture, made for one size of shadow map.
#[derive(Debug, Clone, PartialEq)]
pub struct Receivers {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Row by row from the top.
    pub points: Vec<Receiver>,
}

/// Settings of search and filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Longest run that is revectorised, in texels, and with it the length of every walk. A longer
    /// run keeps the result of the plain depth test in all of its texels, so that no end is invented.
    pub search_limit: u32,
    /// The threshold e of the depth bias along walks: how close to the light's surface a receiver may
    /// be for the walk to lift it (the authors use 2.5e-5 or 2.5e-6). Zero, the default, does nothing;
    /// receivers with slopes do not need it.
    pub walk_bias: f32,
    /// Texels per side of the kernel of [`Variant::Pcf`](super::Variant::Pcf) and
    /// [`Variant::Rpcf`](super::Variant::Rpcf); odd.
    pub pcf: u32,
}

impl Settings {
    /// Long walks, no bias along them, a small kernel.
    pub const DEFAULT: Settings = Settings { search_limit: 128, walk_bias: 0.0, pcf: 3 };
}

impl Default for Settings {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The share of the light that reaches each pixel, and the case that decided it.
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    /// 0 in full shadow, 1 in full light; row by row from the top.
    pub value: Vec<f32>,
    /// The case of the table that was taken: its id, [`Visibility::DEFAULT`] where no case
    /// matched, [`Visibility::NONE`] where no table was evaluated.
    pub case: Vec<u32>,
    /// The discrete state it was taken in, as a number of the table's
    /// [`StateSpace`](crate::program::StateSpace); [`Visibility::NONE`] where no table was evaluated.
    pub state: Vec<u32>,
}

impl Visibility {
    /// No table was evaluated at the pixel.
    pub const NONE: u32 = rendered::NONE;
    /// The table was evaluated, and none of its cases matched.
    pub const DEFAULT: u32 = rendered::DEFAULT;

    /// Nothing decided yet: all in light.
    pub fn new(pixels: usize) -> Self {
        Self { value: vec![1.0; pixels], case: vec![Self::NONE; pixels], state: vec![Self::NONE; pixels] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_along_a_plane_are_exact() {
        let receiver = Receiver {
            z: fixed_depth(0.734_561, 1.0),
            dz_dx: fixed_depth(0.000_123_4, max_slope(1024)),
            dz_dy: fixed_depth(-1.0, max_slope(1024)),
            ..Receiver::default()
        };
        for step in [-1023, -500, -3, 1, 77, 499] {
            let exact = f64::from(receiver.z)
                + f64::from(receiver.dz_dx) * f64::from(step)
                + f64::from(receiver.dz_dy) * f64::from(-step);
            assert_eq!(f64::from(receiver.depth_at(step, -step)), exact);
        }
    }

    #[test]
    fn a_point_is_in_the_texel_left_and_above_of_it() {
        let receiver = Receiver { u: 0.25, v: -0.01, ..Receiver::default() };
        let (texel, place) = receiver.texel(8);
        assert_eq!((texel, place[0]), ([2, -1], 0.0));
        assert!((place[1] - 0.92).abs() < 1e-6);
    }
}
