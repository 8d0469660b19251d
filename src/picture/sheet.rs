//! Pictures about pictures: colours with their legend, and contact sheets.
//!
//! Texts are drawn as SVG and laid over the pixels.

use std::fmt::Write as _;

use image::imageops::{self, FilterType};
use image::{Rgb, RgbImage};

use crate::diag::Failure;
use crate::picture;

const PAPER: Rgb<u8> = Rgb([250, 250, 248]);
const INK: &str = "#1d1f23";
const MARK: [Rgb<u8>; 2] = [Rgb([230, 40, 40]), Rgb([20, 110, 230])];

/// The colour of a case, `None` being the default: neighbours in number are far apart in hue.
pub fn case_colour(case: Option<u32>) -> Rgb<u8> {
    let Some(case) = case else { return Rgb([255, 255, 255]) };
    // Steps of the golden angle, at three levels of brightness.
    let hue = (f64::from(case) * 137.508) % 360.0 / 60.0;
    let value = [0.95, 0.75, 0.55][(case % 3) as usize];
    let channel = |offset: f64| {
        let k = (offset + hue) % 6.0;
        let share = value - value * 0.85 * k.min(4.0 - k).clamp(0.0, 1.0);
        (share * 255.0).round() as u8
    };
    Rgb([channel(5.0), channel(3.0), channel(1.0)])
}

/// Colours over a picture, and what they mean.
#[derive(Debug, Clone)]
pub struct Legend {
    /// The line above the entries.
    pub head: String,
    /// The colour of each pixel; where there is none, the picture shows through in grey.
    pub colours: Vec<Option<Rgb<u8>>>,
    /// Each colour with its meaning.
    pub entries: Vec<(Rgb<u8>, String)>,
}

/// A picture in the colours of a legend, above the legend.
///
/// # Errors
/// When the picture is too large to be drawn.
pub fn coloured(picture: &RgbImage, legend: &Legend) -> Result<RgbImage, Failure> {
    let mut image = picture.clone();
    for (pixel, colour) in image.pixels_mut().zip(&legend.colours) {
        *pixel = colour.unwrap_or_else(|| {
            let [r, g, b] = pixel.0.map(u32::from);
            let grey = ((2 * r + 5 * g + b) / 16 + 60) as u8;
            Rgb([grey; 3])
        });
    }
    let (width, line, entry) = (image.width(), 20, 318);
    let columns = (width / entry).max(1);
    let rows = (legend.entries.len() as u32).div_ceil(columns);
    let height = 34 + rows * line + 10;
    let mut text = String::new();
    label(&mut text, 10, 22, 14, &legend.head);
    for (index, (Rgb([r, g, b]), meaning)) in legend.entries.iter().enumerate() {
        let (x, y) = (10 + index as u32 / rows * entry, 34 + index as u32 % rows * line);
        let _ =
            write!(text, r##"<rect x="{x}" y="{y}" width="14" height="14" fill="rgb({r},{g},{b})" stroke="#888"/>"##);
        label(&mut text, x + 20, y + 12, 11, meaning);
    }
    let mut sheet = RgbImage::from_pixel(width, image.height() + height, PAPER);
    imageops::replace(&mut sheet, &image, 0, 0);
    overlay(&mut sheet, i64::from(image.height()), width, height, &text)?;
    Ok(sheet)
}

/// One picture of a contact sheet.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The text above it.
    pub label: String,
    /// The whole picture.
    pub picture: RgbImage,
}

/// Pictures of the same size in rows of so many, labelled.
///
/// # Errors
/// When the sheet is too large to be drawn.
pub fn grid(entries: &[Entry], columns: u32) -> Result<RgbImage, Failure> {
    let (width, height) = entries.first().map_or((1, 1), |first| first.picture.dimensions());
    let (top, rows) = (24, (entries.len() as u32).div_ceil(columns.max(1)));
    let (across, down) = (columns * (width + GAP) + GAP, rows * (top + height + GAP) + GAP);
    let mut sheet = RgbImage::from_pixel(across, down, PAPER);
    let mut text = String::new();
    for (index, entry) in (0..).zip(entries) {
        let (x, y) = (GAP + index % columns * (width + GAP), GAP + index / columns * (top + height + GAP));
        label(&mut text, x, y + 16, 13, &entry.label);
        imageops::replace(&mut sheet, &entry.picture, i64::from(x), i64::from(y + top));
    }
    overlay(&mut sheet, 0, across, down, &text)?;
    Ok(sheet)
}

/// Width of a column of a contact sheet.
const COLUMN: u32 = 384;
/// Pixels of the picture per side of a zoomed inset.
const INSET: u32 = 48;
/// Space between things.
const GAP: u32 = 8;

/// Pictures of the same size side by side, labelled, each above enlarged insets of the places where they
/// differ most.
///
/// # Errors
/// When the sheet is too large to be drawn.
pub fn contact(title: &str, entries: &[Entry]) -> Result<RgbImage, Failure> {
    let Some(first) = entries.first() else { return Ok(RgbImage::from_pixel(1, 1, PAPER)) };
    let (width, height) = first.picture.dimensions();
    let small = COLUMN.min(width);
    let small_height = ((u64::from(height) * u64::from(small)).div_ceil(u64::from(width)) as u32).max(1);
    let inset = INSET.min(width).min(height);
    let zoom = (small / inset).max(1);
    let (head, cell, top) = (30, small.max(inset * zoom), 24);
    let column = cell + GAP;
    let places = places(entries, width, height, inset);
    let insets_at = |row: usize| head + top + small_height + GAP + row as u32 * (inset * zoom + GAP);
    let mut sheet = RgbImage::from_pixel(GAP + column * entries.len() as u32, insets_at(places.len()) + 2, PAPER);
    let mut text = String::new();
    label(&mut text, GAP, 21, 15, title);
    for (index, entry) in entries.iter().enumerate() {
        let left = GAP + index as u32 * column;
        label(&mut text, left, head + 16, 14, &entry.label);
        let mut whole = entry.picture.clone();
        for (place, mark) in places.iter().zip(MARK) {
            frame(&mut whole, *place, inset, mark, width.div_ceil(small));
        }
        let whole = imageops::resize(&whole, small, small_height, FilterType::Triangle);
        imageops::replace(&mut sheet, &whole, i64::from(left), i64::from(head + top));
        for (row, (place, mark)) in places.iter().zip(MARK).enumerate() {
            let part = imageops::crop_imm(&entry.picture, place[0], place[1], inset, inset).to_image();
            let mut part = imageops::resize(&part, inset * zoom, inset * zoom, FilterType::Nearest);
            let side = part.width();
            frame(&mut part, [0, 0], side, mark, 2);
            imageops::replace(&mut sheet, &part, i64::from(left), i64::from(insets_at(row)));
        }
    }
    let (width, height) = sheet.dimensions();
    overlay(&mut sheet, 0, width, height, &text)?;
    Ok(sheet)
}

/// The corners of at most two squares that do not meet, in which the entries differ most.
fn places(entries: &[Entry], width: u32, height: u32, side: u32) -> Vec<[u32; 2]> {
    // The pictures themselves are compared: what differs out of the light's reach is not seen.
    let spread = |x: u32, y: u32| {
        let channel = |channel: usize| {
            let values = entries.iter().map(|entry| entry.picture.get_pixel(x, y).0[channel]);
            let (lo, hi) = values.fold((u8::MAX, 0), |(lo, hi), value| (lo.min(value), hi.max(value)));
            f64::from(hi.saturating_sub(lo))
        };
        (0..3).map(channel).fold(0.0, f64::max)
    };
    // Sums over all rectangles from the top left corner give the sum over any square.
    let stride = width as usize + 1;
    let mut sums = vec![0.0; stride * (height as usize + 1)];
    for y in 0..height as usize {
        let mut row = 0.0;
        for x in 0..width as usize {
            row += spread(x as u32, y as u32);
            sums[(y + 1) * stride + x + 1] = sums[y * stride + x + 1] + row;
        }
    }
    let sum = |[x, y]: [u32; 2]| {
        let at = |x: u32, y: u32| sums[y as usize * stride + x as usize];
        at(x + side, y + side) + at(x, y) - at(x + side, y) - at(x, y + side)
    };
    let step = (side / 4).max(1) as usize;
    let corners = (0..=height - side).step_by(step).flat_map(|y| (0..=width - side).step_by(step).map(move |x| [x, y]));
    let corners: Vec<[u32; 2]> = corners.collect();
    let mut chosen: Vec<[u32; 2]> = Vec::new();
    for _ in 0..2 {
        let apart =
            |at: &&[u32; 2]| chosen.iter().all(|c| c[0].abs_diff(at[0]) >= side || c[1].abs_diff(at[1]) >= side);
        let best = corners.iter().filter(apart).max_by(|a, b| sum(**a).total_cmp(&sum(**b)));
        match best {
            Some(best) if sum(*best) > 0.0 => chosen.push(*best),
            _ => break,
        }
    }
    chosen
}

/// Draws the border of a square inwards.
fn frame(image: &mut RgbImage, [x, y]: [u32; 2], side: u32, colour: Rgb<u8>, thick: u32) {
    for dy in 0..side {
        for dx in 0..side {
            let inner = |d: u32| (thick..side.saturating_sub(thick)).contains(&d);
            if !(inner(dx) && inner(dy)) {
                image.put_pixel(x + dx, y + dy, colour);
            }
        }
    }
}

fn label(svg: &mut String, x: u32, y: u32, size: u32, text: &str) {
    let text = text.replace('&', "&amp;").replace('<', "&lt;");
    let _ =
        write!(svg, r#"<text x="{x}" y="{y}" font-family="sans-serif" font-size="{size}" fill="{INK}">{text}</text>"#);
}

/// Draws SVG elements over a picture, from a row on.
fn overlay(image: &mut RgbImage, top: i64, width: u32, height: u32, elements: &str) -> Result<(), Failure> {
    let svg = format!(r#"<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}">{elements}</svg>"#);
    let drawn = picture::raster(&svg, 1.0)?;
    for (x, y, pixel) in drawn.enumerate_pixels() {
        let share = f32::from(pixel.0[3]) / 255.0;
        let at = image.get_pixel_mut(x, y + top as u32);
        for (channel, over) in at.0.iter_mut().zip(pixel.0) {
            *channel = (f32::from(*channel) * (1.0 - share) + f32::from(over) * share).round() as u8;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn insets_go_where_pictures_differ_most() {
        let grey = RgbImage::from_pixel(64, 64, Rgb([100; 3]));
        let (mut a, mut b) = (grey.clone(), grey.clone());
        // Many small differences weigh less than few large ones.
        for x in 0..16 {
            for y in 0..16 {
                a.put_pixel(x, y, Rgb([101; 3]));
                b.put_pixel(40 + x / 2, 44 + y / 2, Rgb([100, 0, 100]));
            }
        }
        let entries = [a, b].map(|picture| Entry { label: String::new(), picture });
        let places = places(&entries, 64, 64, 16);
        let inside = |[x, y]: [u32; 2]| x <= 40 && x + 16 >= 48 && y <= 44 && y + 16 >= 52;
        assert!(inside(places[0]) && places[1] == [0, 0], "{places:?}");
    }

    #[test]
    fn equal_pictures_have_no_insets() {
        let picture = RgbImage::from_pixel(32, 32, Rgb([9; 3]));
        let entries = [picture.clone(), picture].map(|picture| Entry { label: String::new(), picture });
        assert!(places(&entries, 32, 32, 8).is_empty());
    }
}
