//! SVG to pixels, with fonts that are part of the program.

use std::io::Cursor;
use std::sync::{Arc, OnceLock};

use base64::Engine as _;
use image::{ExtendedColorType, ImageEncoder, RgbaImage};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{self, fontdb};

use crate::diag::{Diagnostic, Failure, codes};

/// Longest side of a picture, in pixels.
const MAX_SIDE: f64 = 16384.0;

/// The embedded fonts: one for text, one for formulas.
fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let load = || {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
        fonts.load_font_data(epaint_default_fonts::HACK_REGULAR.to_vec());
        fonts.set_sans_serif_family("Ubuntu");
        fonts.set_serif_family("Ubuntu");
        fonts.set_monospace_family("Hack");
        Arc::new(fonts)
    };
    FONTS.get_or_init(load).clone()
}

/// Draws an SVG document, enlarged by `scale`, on a transparent ground.
///
/// Of the fonts only the generic families `sans-serif` and `monospace` exist.
///
/// # Errors
/// When the text is no SVG document, or the picture would be too large.
pub fn raster(svg: &str, scale: f32) -> Result<RgbaImage, Failure> {
    let fail = |why: String| {
        let error = Diagnostic::error(codes::UNWRITABLE, format!("the picture cannot be drawn: {why}"));
        Failure::bare("picture", error.help("write it as SVG instead, or make it smaller"))
    };
    let options = usvg::Options { fontdb: fonts(), font_family: "Ubuntu".to_owned(), ..usvg::Options::default() };
    let tree = usvg::Tree::from_str(svg, &options).map_err(|e| fail(e.to_string()))?;
    let side = |length: f32| (f64::from(length) * f64::from(scale)).ceil();
    let (width, height) = (side(tree.size().width()), side(tree.size().height()));
    if !(1.0..=MAX_SIDE).contains(&width) || !(1.0..=MAX_SIDE).contains(&height) {
        return Err(fail(format!("{width} x {height} pixels, and a side has 1 to {MAX_SIDE}")));
    }
    let mut pixels = Pixmap::new(width as u32, height as u32).ok_or_else(|| fail("it is too large".to_owned()))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    let bytes = pixels.pixels().iter().flat_map(|pixel| {
        let colour = pixel.demultiply();
        [colour.red(), colour.green(), colour.blue(), colour.alpha()]
    });
    RgbaImage::from_raw(width as u32, height as u32, bytes.collect()).ok_or_else(|| fail("it is too large".to_owned()))
}

/// A picture as the bytes of a PNG file.
///
/// # Errors
/// When the encoder refuses it.
pub fn png(picture: &RgbaImage) -> Result<Vec<u8>, Failure> {
    encode(picture.as_raw(), picture.width(), picture.height(), ExtendedColorType::Rgba8)
}

/// A picture as a PNG inside a `data:` address.
///
/// # Errors
/// When the encoder refuses it.
pub fn data_uri(picture: &RgbaImage) -> Result<String, Failure> {
    let grey = |pixel: &image::Rgba<u8>| pixel.0[0] == pixel.0[1] && pixel.0[1] == pixel.0[2] && pixel.0[3] == 255;
    let bytes = match picture.pixels().all(grey) {
        true => {
            let grey: Vec<u8> = picture.pixels().map(|pixel| pixel.0[0]).collect();
            encode(&grey, picture.width(), picture.height(), ExtendedColorType::L8)?
        }
        false => png(picture)?,
    };
    Ok(format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes)))
}

fn encode(bytes: &[u8], width: u32, height: u32, kind: ExtendedColorType) -> Result<Vec<u8>, Failure> {
    use image::codecs::png::{CompressionType, FilterType, PngEncoder};
    let mut out = Cursor::new(Vec::new());
    PngEncoder::new_with_quality(&mut out, CompressionType::Best, FilterType::Adaptive)
        .write_image(bytes, width, height, kind)
        .map_err(|e| {
            let message = format!("the picture cannot be encoded: {e}");
            Failure::bare("picture", Diagnostic::error(codes::UNWRITABLE, message))
        })?;
    Ok(out.into_inner())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn text_pictures_and_shapes_are_drawn() {
        let black = |x: u32, y: u32| image::Rgba(if x == y { [0, 0, 0, 255] } else { [255; 4] });
        let grey = data_uri(&RgbaImage::from_fn(2, 2, black)).unwrap();
        let svg = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20"><rect width="20" height="20" fill="#f00"/>
            <image x="20" width="20" height="20" style="image-rendering:optimizeSpeed" href="{grey}"/>
            <text x="2" y="16" font-family="sans-serif" font-size="16" fill="#00f">M</text></svg>"##
        );
        let picture = raster(&svg, 2.0).unwrap();
        assert_eq!(picture.dimensions(), (80, 40));
        assert_eq!(picture.get_pixel(1, 1).0, [255, 0, 0, 255]);
        assert_eq!(picture.get_pixel(42, 2).0, [0, 0, 0, 255]);
        assert_eq!(picture.get_pixel(78, 2).0, [255, 255, 255, 255]);
        assert!(picture.pixels().any(|pixel| pixel.0 == [0, 0, 255, 255]), "the letter is there");
        assert!(png(&picture).unwrap().starts_with(b"\x89PNG"));
    }

    #[test]
    fn what_cannot_be_drawn_is_refused() {
        assert!(raster("no picture", 1.0).unwrap_err().to_string().contains("cannot be drawn"));
        let large = r#"<svg xmlns="http://www.w3.org/2000/svg" width="9000" height="1"/>"#;
        assert!(raster(large, 2.0).unwrap_err().to_string().contains("18000 x 2 pixels"));
        assert!(raster(large, f32::NAN).is_err());
    }
}
