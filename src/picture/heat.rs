//! Heat maps: counts as colours.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_is_brighter() {
        let image = counts(5, 1, &[0, 1, 2, 3, 4], 4);
        let bright = |x| image.get_pixel(x, 0).0.iter().map(|channel| u32::from(*channel)).sum::<u32>();
        assert_eq!((image.get_pixel(0, 0).0, image.get_pixel(4, 0).0), ([0; 3], [255; 3]));
        assert!((1..5).all(|x| bright(x) > bright(x - 1)));
    }
}
