//! Differences between a picture of visibility, or of light, and the true one.
//!
//! Each pixel of visibility weighs what light would leave there: an error in the dark is none.

use glam::Vec3;
use image::{GrayImage, Luma};

use crate::scene::surfaces::Surfaces;

/// The difference between two pictures of visibility.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Root of the mean squared difference; 0 for equal ones.
    pub rmse: f64,
    /// 1 minus the mean structural similarity (SSIM), as the library `image-compare` computes it; 0 for equal ones.
    pub dissimilarity: f64,
}

/// The difference between two pictures of numbers, over all pixels that show a surface.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Absolute {
    /// Mean of the magnitudes.
    pub mean: f64,
    /// Root of the mean of the squares.
    pub rmse: f64,
    /// The largest magnitude.
    pub most: f64,
}

/// The difference between numbers and the true ones.
pub fn of_numbers(surfaces: &Surfaces, values: &[f32], truth: &[f32]) -> Absolute {
    let pixels = surfaces.points.iter().zip(values.iter().zip(truth)).filter(|(point, _)| point.is_some());
    let differences = || pixels.clone().map(|(_, (value, truth))| f64::from(value - truth).abs());
    let count = differences().count().max(1) as f64;
    Absolute {
        mean: differences().sum::<f64>() / count,
        rmse: (differences().map(|apart| apart * apart).sum::<f64>() / count).sqrt(),
        most: differences().fold(0.0, f64::max),
    }
}

/// The pixels that differences are taken over, with the weight of each.
#[derive(Debug, Clone)]
pub struct Region {
    weights: Vec<f32>,
}

/// The distance from a silhouette within which a pixel counts as near, in pixels.
pub const NEAR: usize = 8;

impl Region {
    /// All pixels that show a surface. `weights` has the light of each pixel, were there no shadow.
    pub fn surfaces(surfaces: &Surfaces, weights: &[f32]) -> Self {
        let weight = |(point, weight): (&Option<_>, &f32)| if point.is_some() { *weight } else { 0.0 };
        Self { weights: surfaces.points.iter().zip(weights).map(weight).collect() }
    }

    /// The pixels that show a surface within [`NEAR`] pixels of a true silhouette of a shadow on it, where light
    /// could reach.
    pub fn silhouettes(surfaces: &Surfaces, weights: &[f32], truth: &[f32]) -> Self {
        let (width, height) = (surfaces.width as usize, surfaces.height as usize);
        let object = |pixel: usize| surfaces.points[pixel].as_ref().map(|point| point.object);
        let on_silhouette = |pixel: usize| {
            let right = (pixel % width + 1 < width).then_some(pixel + 1);
            let below = (pixel + width < truth.len()).then_some(pixel + width);
            let mut neighbours = [right, below].into_iter().flatten();
            object(pixel).is_some()
                && weights[pixel] > 0.0
                && (!matches!(truth[pixel], 0.0 | 1.0)
                    || neighbours.any(|other| object(other) == object(pixel) && truth[other] != truth[pixel]))
        };
        let mut grown: Vec<bool> = (0..truth.len()).map(on_silhouette).collect();
        // A square grows along rows, then along columns.
        for vertical in [false, true] {
            grown = (0..truth.len())
                .map(|pixel| {
                    let (x, y) = (pixel % width, pixel / width);
                    let (at, end) = if vertical { (y, height) } else { (x, width) };
                    let index = |at: usize| if vertical { at * width + x } else { y * width + at };
                    (at.saturating_sub(NEAR)..(at + NEAR + 1).min(end)).any(|at| grown[index(at)])
                })
                .collect();
        }
        let all = Self::surfaces(surfaces, weights).weights;
        Self { weights: grown.into_iter().zip(all).map(|(near, weight)| if near { weight } else { 0.0 }).collect() }
    }

    /// The share of the picture that it is.
    fn share(&self) -> f64 {
        self.weights.iter().filter(|weight| **weight > 0.0).count() as f64 / self.weights.len().max(1) as f64
    }

    /// Root of the mean of squares: of the light that is wrong, over the light that there is.
    fn rms(&self, value: impl Fn(usize) -> f64) -> f64 {
        let weights = || self.weights.iter().map(|weight| f64::from(*weight)).enumerate();
        let wrong: f64 = weights().map(|(pixel, weight)| (weight * value(pixel)).powi(2)).sum();
        let all: f64 = weights().map(|(_, weight)| weight * weight).sum();
        (wrong / all.max(f64::MIN_POSITIVE)).sqrt()
    }
}

/// The light that is wrong, over the light that there is: the root mean square of the difference from the true light
/// of all pixels that show a surface, relative to that of the true light.
pub fn of_light(surfaces: &Surfaces, light: &[[f32; 3]], truth: &[[f32; 3]]) -> f64 {
    let pixels = surfaces.points.iter().zip(light.iter().zip(truth));
    let (mut wrong, mut all) = (0.0, 0.0);
    for (_, (light, truth)) in pixels.filter(|(point, _)| point.is_some()) {
        let [light, truth] = [light, truth].map(|colour| Vec3::from_array(*colour).as_dvec3());
        wrong += (light - truth).length_squared();
        all += truth.length_squared();
    }
    (wrong / all.max(f64::MIN_POSITIVE)).sqrt()
}

/// The difference of visibility from the truth, within a region.
pub fn difference(surfaces: &Surfaces, value: &[f32], truth: &[f32], region: &Region) -> Difference {
    // The library compares whole pictures: outside of the region they are equal, and that is taken out again.
    let grey = |values: &[f32]| {
        let mut image = GrayImage::new(surfaces.width, surfaces.height);
        for (index, pixel) in image.pixels_mut().enumerate() {
            *pixel = Luma([(values[index] * region.weights[index] * 255.0).round() as u8]);
        }
        image
    };
    let algorithm = image_compare::Algorithm::MSSIMSimple;
    let share = region.share();
    // It refuses pictures of different sizes only.
    let similarity = image_compare::gray_similarity_structure(&algorithm, &grey(value), &grey(truth));
    let dissimilarity = similarity.map_or(f64::NAN, |found| (1.0 - found.score) / share.max(f64::MIN_POSITIVE));
    Difference { rmse: region.rms(|pixel| f64::from(value[pixel] - truth[pixel])), dissimilarity }
}
