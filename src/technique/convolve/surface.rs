//! Surfaces that are crossed: light that is put right on slopes, and light that is reflected.
//!
//! On an opaque slope iterated light is too dark (`slope_light` of `tables/light_kernel.ron`). The quotient of what is
//! right and what iterating leaves is exact on a slope without end; it depends on the drift of a walk alone, so it is
//! looked up. Reflection is that of `tables/shade.ron`, whose `microfacet_g` is looked up, too, for each exponent.

use super::functions::Function;
use super::light::SlopeLight;
use super::material::Material;
use super::octahedron::direction;
use crate::diag::Failure;
use crate::technique::tables::{LIGHT_KERNEL, SHADE};

/// Entries of the lookup over drifts, and deviations per slab between them.
pub const DRIFTS: usize = 1024;
/// The spacing of drifts.
pub const DRIFT_SPACING: f32 = 6.0 / 1024.0;
/// Entries of the lookup over cosines from 0 to 1: linear between them its error is below 10^-4 up to an exponent of 100,
/// and below 10^-3 up to 1000.
pub const COSINES: usize = 257;

/// A surface at which a pixel enters or leaves matter in a slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// The direction of its normal, as a word of [`octahedron`](super::octahedron).
    pub normal: u32,
    /// The object.
    pub object: usize,
}

/// A light as surfaces see it: mean and covariance of its slopes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lamp {
    /// The mean.
    pub mean: [f32; 2],
    /// The covariance: xx, xy, yy.
    pub covariance: [f32; 3],
}

/// The facets of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Facets {
    /// The exponent of their distribution.
    pub exponent: f64,
    /// Reflectance seen from straight above.
    pub reflectance: f64,
    /// `microfacet_g` at cosines from 0 to 1.
    pub shown: Vec<f32>,
}

/// The treatment of arriving light by surfaces.
#[derive(Debug, Clone)]
pub struct Surfaces {
    lamps: Vec<Lamp>,
    slope: Option<Slope>,
    /// Of each object, if it has any.
    facets: Vec<Option<Facets>>,
    /// Of each object: set if nothing can be seen through it.
    opaque: Vec<bool>,
    specular: Function,
}

/// The quotients of right and iterated light.
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    /// The root of a slab's thickness over the distance at which penumbras are right.
    pub scale: f32,
    /// Quotients the other way round, which are nearly linear, at drifts from [`DRIFT_SPACING`] on.
    pub inverses: Vec<f32>,
}

impl Slope {
    /// For slabs of a thickness.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new(thickness: f64, d1: f64) -> Result<Self, Failure> {
        let function = Function::of(&LIGHT_KERNEL, "slope_light")?;
        let scale = (thickness / d1).sqrt();
        let quotient = |i: usize| {
            let drift = f64::from(DRIFT_SPACING) * (i + 1) as f64;
            let given = [("c", drift / scale), ("mu_n", 0.0), ("sigma_n", 1.0), ("e", thickness), ("d1", d1)];
            let [iterated, exact] =
                function.call(&given.map(|(name, number)| (name, number.into())))?.numbers(["iterated", "exact"])?;
            Ok((iterated / exact) as f32)
        };
        Ok(Self { scale: scale as f32, inverses: (0..DRIFTS).map(quotient).collect::<Result<_, Failure>>()? })
    }

    /// The quotient on a slope with this normal, under a light.
    pub fn quotient(&self, lamp: &Lamp, [x, y, z]: [f32; 3]) -> f32 {
        let across = (x * x + y * y).sqrt();
        if z >= 0.0 || across < 1e-6 {
            return 1.0;
        }
        let (x, y, rise) = (x / across, y / across, -z / across);
        let [xx, xy, yy] = lamp.covariance;
        let variance = x * x * xx + 2.0 * (x * y) * xy + y * y * yy;
        if variance <= 0.0 {
            return 1.0;
        }
        let drift = (rise + (lamp.mean[0] * x + lamp.mean[1] * y)) / variance.sqrt() * self.scale;
        1.0 / interpolated(&self.inverses, drift / DRIFT_SPACING - 1.0)
    }
}

/// A lookup at a place between its entries, clamped to them.
fn interpolated(lookup: &[f32], place: f32) -> f32 {
    let place = place.clamp(0.0, (lookup.len() - 1) as f32);
    let before = (place as usize).min(lookup.len() - 2);
    let part = place - before as f32;
    lookup[before] + part * (lookup[before + 1] - lookup[before])
}

impl Facets {
    /// The facets of a material, if it has any.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn of(material: &Material) -> Result<Option<Self>, Failure> {
        material.shine.map(|shine| Self::new(shine.exponent, shine.reflectance)).transpose()
    }

    /// Facets of an exponent from 1 to 1000.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new(exponent: f64, reflectance: f64) -> Result<Self, Failure> {
        let function = Function::of(&SHADE, "microfacet_g")?;
        let at = |i: usize| {
            let cosine = i as f64 / (COSINES - 1) as f64;
            let answer = function.call(&[("n", exponent.into()), ("cosine", cosine.into())])?;
            Ok(answer.number("value")? as f32)
        };
        Ok(Self { exponent, reflectance, shown: (0..COSINES).map(at).collect::<Result<_, Failure>>()? })
    }

    /// `microfacet_g` at a cosine.
    fn shown(&self, cosine: f32) -> f32 {
        interpolated(&self.shown, cosine.clamp(0.0, 1.0) * (COSINES - 1) as f32)
    }
}

impl Lamp {
    /// A light as surfaces see it.
    pub fn new(light: &SlopeLight) -> Self {
        let (s, c) = libm::sincos(light.angle);
        let [u, v] = light.deviations.map(|deviation| deviation * deviation);
        let covariance = [c * c * u + s * s * v, c * s * (u - v), s * s * u + c * c * v];
        Self { mean: light.mean.to_array().map(|part| part as f32), covariance: covariance.map(|part| part as f32) }
    }
}

impl Surfaces {
    /// Surfaces of some objects under some lights; with `slope`, light on slopes is put right.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new(lights: &[SlopeLight], materials: &[Material], slope: Option<Slope>) -> Result<Self, Failure> {
        Ok(Self {
            lamps: lights.iter().map(Lamp::new).collect(),
            slope,
            facets: materials.iter().map(Facets::of).collect::<Result<_, Failure>>()?,
            opaque: materials.iter().map(|material| material.matter.opacity >= 1.0).collect(),
            specular: Function::of(&SHADE, "specular")?,
        })
    }

    /// Returns whether light is anything but scattered at the surfaces of an object.
    pub fn changes(&self, object: usize) -> bool {
        self.slope.is_some() && self.opaque[object] || self.facets[object].is_some()
    }

    /// The factor for the light that arrives, which is to be no more than nothing hindered, and the share of it that is
    /// reflected besides what is scattered.
    pub fn lit(&self, light: usize, surface: &Surface) -> (f64, f64) {
        let normal = direction(surface.normal);
        let lamp = &self.lamps[light];
        let factor = match &self.slope {
            Some(slope) if self.opaque[surface.object] => slope.quotient(lamp, normal),
            _ => 1.0,
        };
        let reflected = self.facets[surface.object].as_ref().map_or(0.0, |facets| self.reflected(facets, lamp, normal));
        (factor.into(), reflected)
    }

    fn reflected(&self, facets: &Facets, lamp: &Lamp, normal: [f32; 3]) -> f64 {
        let [x, y, z] = normal;
        let towards = (lamp.mean[0] * lamp.mean[0] + lamp.mean[1] * lamp.mean[1] + 1.0).sqrt();
        let to_light = (lamp.mean[0] * x + lamp.mean[1] * y - z) / towards;
        let given = [
            ("n", facets.exponent),
            ("f0", facets.reflectance),
            ("nx", x.into()),
            ("ny", y.into()),
            ("nz", z.into()),
            ("mu_x", lamp.mean[0].into()),
            ("mu_y", lamp.mean[1].into()),
            ("g_light", facets.shown(to_light).into()),
            ("g_view", facets.shown(-z).into()),
        ];
        let answer = self.specular.call(&given.map(|(name, number)| (name, number.into())));
        answer.and_then(|answer| answer.number("value")).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_are_those_of_the_table() {
        let slope = Slope::new(1.0, 64.0).expect("built in");
        let lamp = Lamp { mean: [0.0; 2], covariance: [1.0, 0.0, 1.0] };
        let half = std::f32::consts::FRAC_1_SQRT_2;
        // A slope of 45 degrees: 0.841345 is right, and 0.164365 is left.
        let found = slope.quotient(&lamp, [half, 0.0, -half]);
        assert!((found - 0.841_345 / 0.164_365).abs() < 1e-3, "{found}");
        assert_eq!(slope.quotient(&lamp, [0.0, 0.0, -1.0]), 1.0);
        assert_eq!(slope.quotient(&lamp, [0.0, half, half]), 1.0);
        assert_eq!(slope.quotient(&Lamp { covariance: [0.0; 3], ..lamp }, [half, 0.0, -half]), 1.0);
    }

    #[test]
    fn lookups_of_facets_are_as_good_as_they_say() {
        let function = Function::of(&SHADE, "microfacet_g").expect("built in");
        for (exponent, most) in [(1.0, 1e-4), (20.0, 1e-4), (100.0, 1e-4), (1000.0, 1e-3)] {
            let facets = Facets::new(exponent, 0.04).expect("built in");
            for i in 0..999 {
                let cosine = (f64::from(i) + 0.37) / 999.0;
                let given = [("n", exponent.into()), ("cosine", cosine.into())];
                let exact = function.call(&given).and_then(|answer| answer.number("value")).expect("built in");
                let apart = (f64::from(facets.shown(cosine as f32)) - exact).abs();
                assert!(apart < most, "{exponent} {cosine}: {apart}");
            }
        }
    }

    #[test]
    fn a_covariance_turns_with_its_light() {
        let light = SlopeLight { mean: glam::DVec2::ZERO, deviations: [2.0, 1.0], angle: 0.5, colour: [1.0; 3] };
        let [xx, xy, yy] = Lamp::new(&light).covariance.map(f64::from);
        let (s, c) = 0.5_f64.sin_cos();
        let along = c * c * xx + 2.0 * c * s * xy + s * s * yy;
        assert!((along - 4.0).abs() < 1e-6 && (xx * yy - xy * xy - 4.0).abs() < 1e-5, "{xx} {xy} {yy}");
    }
}
