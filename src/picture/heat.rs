//! Heat maps: counts and numbers as colours.

use image::{Rgb, RgbImage};

/// A map of counts: black for none, through blue and orange to white for `most`.
pub fn counts(width: u32, height: u32, counts: &[u32], most: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let count = counts.get((y * width + x) as usize).copied().unwrap_or(0);
        let part = f64::from(count) / f64::from(most.max(1));
        let ramp = |from: f64| ((part * 3.0 - from).clamp(0.0, 1.0) * 255.0).round() as u8;
        Rgb([ramp(1.0), ramp(1.5), if part < 0.5 { ramp(0.0) / 2 } else { ramp(2.0) }])
    })
}

/// A map of numbers: grey, from black for 0 to white for the largest; where some are negative, black for 0, orange for what
/// is above and blue for what is below, the brighter the larger.
pub fn numbers(width: u32, height: u32, numbers: &[f32]) -> RgbImage {
    let most = numbers.iter().filter(|number| number.is_finite()).map(|number| number.abs()).fold(0.0, f32::max);
    let is_signed = numbers.iter().any(|number| *number < 0.0);
    RgbImage::from_fn(width, height, |x, y| {
        let number = numbers.get((y * width + x) as usize).copied().unwrap_or(0.0);
        let part = if most > 0.0 { (number / most).clamp(-1.0, 1.0) } else { 0.0 };
        let level = |scale: f32| (part.abs() * scale).round() as u8;
        match (is_signed, part < 0.0) {
            (false, _) => Rgb([level(255.0); 3]),
            (true, false) => Rgb([level(255.0), level(150.0), level(40.0)]),
            (true, true) => Rgb([level(60.0), level(150.0), level(255.0)]),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grey_or_have_the_colour_of_their_sign() {
        let grey = numbers(3, 1, &[0.0, 1.0, 2.0]);
        assert_eq!([0, 1, 2].map(|x| grey.get_pixel(x, 0).0), [[0; 3], [128; 3], [255; 3]]);
        let signed = numbers(3, 1, &[-0.5, 0.0, 1.0]);
        let [below, zero, above] = [0, 1, 2].map(|x| signed.get_pixel(x, 0).0);
        assert!(below[2] > below[0] && above[0] > above[2] && zero == [0; 3], "{below:?} {above:?}");
    }

    #[test]
    fn more_is_brighter() {
        let image = counts(5, 1, &[0, 1, 2, 3, 4], 4);
        let bright = |x| image.get_pixel(x, 0).0.iter().map(|channel| u32::from(*channel)).sum::<u32>();
        assert_eq!((image.get_pixel(0, 0).0, image.get_pixel(4, 0).0), ([0; 3], [255; 3]));
        assert!((1..5).all(|x| bright(x) > bright(x - 1)));
    }
}
