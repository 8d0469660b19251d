//! Lights: those of a scene, as the viewer sees them, and those that they are split into.

use glam::{DMat2, DVec2, DVec3};

use super::functions::Function;
use super::kernel::Blur;
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::Scene;
use crate::scene::light::{Gaussian, Light};
use crate::technique::tables::LIGHT_KERNEL;

/// The widest tilt of a light to the view axis, in degrees: tangents grow without bound.
const MOST_TILTED: f64 = 80.0;

/// The largest number of lights that the table splits a light into by itself.
const MOST_BY_TABLE: u32 = 64;

/// A distant light as slopes to the view axis: a receiver looks at it through places further right and down as the slope
/// says, per unit towards the viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlopeLight {
    /// The mean slope.
    pub mean: DVec2,
    /// Deviations along the axes of the light.
    pub deviations: [f64; 2],
    /// Angle from right to the first axis, towards down, in radians.
    pub angle: f64,
    /// Colour and intensity, linear.
    pub colour: [f64; 3],
}

/// The lights that each light is split into, and what they keep of its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// The number of them.
    pub lights: u32,
    /// The share of the covariance that each keeps: with 0 they are sharp.
    pub rho: f64,
}

impl SlopeLight {
    /// The Gaussian lights of a scene, as a view sees them.
    ///
    /// The slopes of a scene are to the vertical. Where the view is not along it they are mapped as at the mean of the
    /// light, which makes a Gaussian of it again: exact for views from above, and for narrow lights.
    ///
    /// # Errors
    /// When a light does not come from the viewer's side, or is tilted too far.
    pub fn of_scene(scene: &Scene, view: &SlabView) -> Result<Vec<Self>, Failure> {
        let mut all = Vec::new();
        for (index, light) in scene.lights.iter().enumerate() {
            if let Light::Gaussian(gaussian) = light
                && gaussian.colour.iter().any(|channel| *channel > 0.0)
            {
                all.push(Self::new(gaussian, view, index + 1)?);
            }
        }
        Ok(all)
    }

    fn new(light: &Gaussian, view: &SlabView, number: usize) -> Result<Self, Failure> {
        let mean = light.mean();
        // Towards the light, as seen; the third part is towards the viewer.
        let towards = |slope: DVec3| {
            let turned = view.turned(slope);
            DVec3::new(turned.x, turned.y, -turned.z)
        };
        let axis = towards(DVec3::new(mean.x, 1.0, mean.y));
        let slopes = axis.truncate() / axis.z;
        let tilt = |slope: f64| libm::atan(slope).to_degrees().abs();
        if axis.z <= 0.0 || tilt(slopes.x).max(tilt(slopes.y)) > MOST_TILTED {
            let message = format!("light {number} is tilted more than {MOST_TILTED} degrees from the view axis");
            let error = Diagnostic::error(codes::SCENE, message);
            return Err(Failure::bare("", error.help("turn the camera, so that the light comes from behind it")));
        }
        // How the seen slopes change with those of the scene: a quotient's derivative.
        let change = |of: DVec3| (of.truncate() - slopes * of.z) / axis.z;
        let map = DMat2::from_cols(change(towards(DVec3::X)), change(towards(DVec3::Z)));
        let (s, c) = libm::sincos(light.rotation.to_radians());
        let [a, b] = light.deviations;
        let root = map * DMat2::from_cols(DVec2::new(c, s) * a, DVec2::new(-s, c) * b);
        let (deviations, angle) = axes(root);
        Ok(Self { mean: slopes, deviations, angle, colour: light.colour })
    }

    /// The blur of a stretch of depth, for slabs whose scale is `pixels` per unit.
    pub(super) fn blur(&self, function: Function, d1: f64, depth: f64, pixels: f64) -> Result<Blur, Failure> {
        let [x, y] = self.mean.to_array().map(libm::atan);
        let answer = function.call(&[
            ("tilt_x", x.into()),
            ("tilt_y", y.into()),
            ("sigma_1", self.deviations[0].into()),
            ("sigma_2", self.deviations[1].into()),
            ("alpha", self.angle.into()),
            ("d1", d1.into()),
            ("e", depth.into()),
            ("pixels_per_unit", pixels.into()),
        ])?;
        let [a11, a12, a21, a22] = answer.numbers(["a11", "a12", "a21", "a22"])?;
        let (sin, cos) = libm::sincos(self.angle);
        Ok(Blur {
            mean: answer.numbers(["mean_x", "mean_y"])?,
            variances: [a11 * a11 + a21 * a21, a12 * a12 + a22 * a22],
            axis: [cos, sin],
        })
    }

    /// The lights that this one is split into.
    pub fn split(&self, nodes: &[DVec2], rho: f64) -> Vec<Self> {
        let (sin, cos) = libm::sincos(self.angle);
        let share = 1.0 / nodes.len() as f64;
        let away = libm::sqrt(1.0 - rho);
        let one = |node: &DVec2| {
            let along = DVec2::new(node.x * self.deviations[0], node.y * self.deviations[1]) * away;
            let moved = DVec2::new(cos * along.x - sin * along.y, sin * along.x + cos * along.y);
            Self {
                mean: self.mean + moved,
                deviations: self.deviations.map(|deviation| deviation * libm::sqrt(rho)),
                angle: self.angle,
                colour: self.colour.map(|channel| channel * share),
            }
        };
        nodes.iter().map(one).collect()
    }
}

/// The half axes of the ellipse that a map makes of the unit circle, and the angle of the first.
fn axes(root: DMat2) -> ([f64; 2], f64) {
    let covariance = root * root.transpose();
    let [c11, c12, c22] = [covariance.x_axis.x, covariance.x_axis.y, covariance.y_axis.y];
    let (mean, half) = (0.5 * (c11 + c22), 0.5 * (c11 - c22));
    let radius = libm::hypot(half, c12);
    let angle = if radius > 0.0 { 0.5 * libm::atan2(c12, half) } else { 0.0 };
    ([mean + radius, mean - radius].map(|variance| libm::sqrt(variance.max(0.0))), angle)
}

/// The places of the lights that a light is split into, in deviations: mean 0 and covariance 1.
///
/// # Errors
/// When there are two: they lie on a line.
pub fn nodes(count: u32) -> Result<Vec<DVec2>, Failure> {
    if count == 2 {
        let error = Diagnostic::error(codes::RENDER, "a light cannot be split into two: they would lie on a line");
        return Err(Failure::bare("", error.help("split it into three or more")));
    }
    let at = |function: Function, k: u32| {
        let answer = function.call(&[("M", f64::from(count).into()), ("k", f64::from(k).into())])?;
        Ok(DVec2::from_array(answer.numbers(["x", "y"])?))
    };
    if count <= MOST_BY_TABLE {
        let function = Function::of(&LIGHT_KERNEL, "split_nodes")?;
        return (0..count).map(|k| at(function, k)).collect();
    }
    let function = Function::of(&LIGHT_KERNEL, "spiral")?;
    let raw = (0..count).map(|k| at(function, k)).collect::<Result<Vec<_>, Failure>>()?;
    let mean = raw.iter().sum::<DVec2>() / f64::from(count);
    let moved: Vec<DVec2> = raw.into_iter().map(|node| node - mean).collect();
    let spread = |of: fn(DVec2) -> f64| moved.iter().map(|node| of(*node)).sum::<f64>() / f64::from(count);
    let (c11, c12, c22) = (spread(|v| v.x * v.x), spread(|v| v.x * v.y), spread(|v| v.y * v.y));
    let whitened = Function::of(&LIGHT_KERNEL, "whitened")?;
    let stretch = |node: &DVec2| {
        let answer = whitened.call(&[
            ("x", node.x.into()),
            ("y", node.y.into()),
            ("c11", c11.into()),
            ("c12", c12.into()),
            ("c22", c22.into()),
        ])?;
        Ok(DVec2::from_array(answer.numbers(["x", "y"])?))
    };
    moved.iter().map(stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_have_mean_0_and_covariance_1() {
        for count in [1, 3, 16, 64, 65, 256] {
            let nodes = nodes(count).expect("nodes");
            let mean = nodes.iter().sum::<DVec2>() / f64::from(count);
            assert!(mean.length() < 1e-12, "{count}: {mean}");
            if count > 1 {
                let of = |of: fn(&DVec2) -> f64| nodes.iter().map(of).sum::<f64>() / f64::from(count);
                let spread = [of(|v| v.x * v.x), of(|v| v.x * v.y), of(|v| v.y * v.y)];
                assert!((spread[0] - 1.0).abs() < 1e-12 && spread[1].abs() < 1e-12 && (spread[2] - 1.0).abs() < 1e-12);
            }
        }
        assert!(nodes(2).is_err());
    }

    #[test]
    fn half_axes_of_a_turned_ellipse() {
        let (s, c) = libm::sincos(0.4);
        let root = DMat2::from_cols(DVec2::new(c, s) * 3.0, DVec2::new(-s, c) * 0.5);
        let (lengths, angle) = axes(root);
        assert!((lengths[0] - 3.0).abs() < 1e-12 && (lengths[1] - 0.5).abs() < 1e-12 && (angle - 0.4).abs() < 1e-12);
    }
}
