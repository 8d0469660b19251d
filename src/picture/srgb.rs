//! The sRGB transfer function: linear light to the values of a picture, and back.

use image::{Rgb, Rgb32FImage, RgbImage};

/// Encodes linear light as the values of an sRGB picture, 8 bits each.
pub fn encode(linear: &Rgb32FImage) -> RgbImage {
    let mut image = RgbImage::new(linear.width(), linear.height());
    for (out, pixel) in image.pixels_mut().zip(linear.pixels()) {
        *out = Rgb(pixel.0.map(level));
    }
    image
}

/// Decodes the values of an sRGB picture.
pub fn decode(encoded: &RgbImage) -> Rgb32FImage {
    let mut image = Rgb32FImage::new(encoded.width(), encoded.height());
    for (out, pixel) in image.pixels_mut().zip(encoded.pixels()) {
        *out = Rgb(pixel.0.map(linear));
    }
    image
}

/// The value of an amount of light; amounts beyond 0 and 1 are clamped.
fn level(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::powf(linear, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

/// The amount of light of a value.
fn linear(level: u8) -> f32 {
    let value = f32::from(level) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { libm::powf((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_come_back_and_the_ends_are_the_ends() {
        assert!((0..=255).all(|value| level(linear(value)) == value));
        assert_eq!([level(-1.0), level(0.0), level(1.0), level(7.0)], [0, 0, 255, 255]);
        // One half by the standard's formula.
        assert_eq!(level(0.5), 188);
    }
}
