//! Capital letters and digits as strokes.

use glam::{DAffine3, DVec3};

use super::solid::{Solid, bar};

/// The strokes of a letter on a grid of 0 to 4 across and 0 to 6 up: polylines, each corner two digits.
fn strokes(letter: char) -> Option<&'static [&'static str]> {
    Some(match letter {
        'A' => &["002640", "1333"],
        'B' => &["000636454433", "0333424130", "0030"],
        'C' => &["4536160501103041"],
        'D' => &["000626443220", "2000"],
        'E' => &["46060040", "0333"],
        'F' => &["460600", "0333"],
        'G' => &["453616050110304143", "4323"],
        'H' => &["0006", "4046", "0343"],
        'I' => &["2026"],
        'J' => &["4641301001"],
        'K' => &["0006", "460340"],
        'L' => &["060040"],
        'M' => &["0006234640"],
        'N' => &["00064046"],
        'O' => &["01051636454130", "301001"],
        'P' => &["00063645443303"],
        'Q' => &["010516364541301001", "2240"],
        'R' => &["00063645443303", "2340"],
        'S' => &["45361605041333424130", "301001"],
        'T' => &["0646", "2620"],
        'U' => &["060110304146"],
        'V' => &["062046"],
        'W' => &["0610243046"],
        'X' => &["0046", "0640"],
        'Y' => &["062346", "2320"],
        'Z' => &["06460040"],
        '0' => &["010516364541301001", "0145"],
        '1' => &["152620", "1030"],
        '2' => &["05163645440040"],
        '3' => &["0646234241301001"],
        '4' => &["36024230", "4222"],
        '5' => &["46060434434130", "3000"],
        '6' => &["46260301103041423303"],
        '7' => &["064610"],
        '8' => &["1304051636454433", "134233", "130201103041423313"],
        '9' => &["00204345361605041343"],
        '-' => &["0343"],
        '.' => &["2020"],
        ' ' => &[],
        _ => return None,
    })
}

/// The characters that can be written.
pub(in crate::scene) const KNOWN: &str = "A to Z, 0 to 9, space, `-` and `.`";

/// The first character of a text that cannot be written.
pub(in crate::scene) fn unknown(text: &str) -> Option<char> {
    text.chars().find(|letter| strokes(*letter).is_none())
}

/// Writes a text, standing on y = 0 around the origin.
pub(in crate::scene) fn write(out: &mut Solid, text: &str, height: f64, stroke: f64) {
    let unit = height / 6.0;
    let advance = 4.0 * unit + 2.2 * stroke;
    let start = -(text.chars().count() as f64 * advance - 2.2 * stroke) / 2.0;
    for (index, letter) in text.chars().enumerate() {
        let left = start + index as f64 * advance;
        for line in strokes(letter).unwrap_or_default() {
            let digits: Vec<f64> = line.bytes().map(|digit| f64::from(digit - b'0')).collect();
            let corners: Vec<[f64; 2]> = digits.chunks_exact(2).map(|at| [left + at[0] * unit, at[1] * unit]).collect();
            let mut bars = Solid::default();
            for ends in corners.windows(2) {
                bar(&mut bars, ends[0], ends[1], stroke, stroke);
            }
            // Strokes go half their width below the line.
            let lift = DAffine3::from_translation(DVec3::Y * stroke / 2.0);
            out.add(&bars, &lift, 1.0);
        }
    }
}
