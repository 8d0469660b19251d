//! How far a technique is from the true shadow.

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

/// The pixels that differences are taken over.
#[derive(Debug, Clone)]
pub struct Region {
    pixels: Vec<bool>,
}

/// How far from a silhouette a pixel still counts as near, in pixels.
pub const NEAR: usize = 8;

impl Region {
    /// All pixels that show a surface.
    pub fn surfaces(surfaces: &Surfaces) -> Self {
        Self { pixels: surfaces.points.iter().map(Option::is_some).collect() }
    }

    /// The pixels that show a surface within [`NEAR`] pixels of a true silhouette of a shadow on it.
    pub fn silhouettes(surfaces: &Surfaces, truth: &[f32]) -> Self {
        let (width, height) = (surfaces.width as usize, surfaces.height as usize);
        let object = |pixel: usize| surfaces.points[pixel].as_ref().map(|point| point.object);
        let on_silhouette = |pixel: usize| {
            let right = (pixel % width + 1 < width).then_some(pixel + 1);
            let below = (pixel + width < truth.len()).then_some(pixel + width);
            let mut beside = [right, below].into_iter().flatten();
            object(pixel).is_some()
                && (!matches!(truth[pixel], 0.0 | 1.0)
                    || beside.any(|other| object(other) == object(pixel) && truth[other] != truth[pixel]))
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
        let surfaces = Self::surfaces(surfaces).pixels;
        Self { pixels: grown.into_iter().zip(surfaces).map(|(near, surface)| near && surface).collect() }
    }

    /// The share of the picture that it is.
    fn share(&self) -> f64 {
        self.pixels.iter().filter(|inside| **inside).count() as f64 / self.pixels.len().max(1) as f64
    }

    fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        let inside = self.pixels.iter().enumerate().filter(|(_, inside)| **inside).map(|(pixel, _)| pixel);
        let (sum, count) = inside.fold((0.0, 0_usize), |(sum, count), pixel| (sum + value(pixel), count + 1));
        sum / count.max(1) as f64
    }
}

/// The difference of a technique from the truth, within a region.
pub fn difference(surfaces: &Surfaces, value: &[f32], truth: &[f32], region: &Region) -> Difference {
    let square = |pixel: usize| f64::from(value[pixel] - truth[pixel]).powi(2);
    // The library compares whole pictures: outside of the region they are equal, and that is taken out again.
    let grey = |values: &[f32]| {
        let mut image = GrayImage::new(surfaces.width, surfaces.height);
        for (index, pixel) in image.pixels_mut().enumerate() {
            let value = if region.pixels[index] { values[index] } else { truth[index] };
            *pixel = Luma([(value * 255.0).round() as u8]);
        }
        image
    };
    let algorithm = image_compare::Algorithm::MSSIMSimple;
    let share = region.share();
    // It refuses pictures of different sizes only.
    let similarity = image_compare::gray_similarity_structure(&algorithm, &grey(value), &grey(truth));
    let dissimilarity = similarity.map_or(f64::NAN, |found| (1.0 - found.score) / share.max(f64::MIN_POSITIVE));
    Difference { rmse: region.mean(square).sqrt(), dissimilarity }
}
