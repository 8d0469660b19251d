//! Draws an island in letters. What covers each place is said by `tables/terrain.ron`,
//! which the build script has compiled into the module below; there is no other rule here.
//!
//! ```text
//! cd examples/terrain
//! cargo run
//! ```

include!(concat!(env!("OUT_DIR"), "/terrain/ordered.rs"));

/// A letter for each level of `cover`, in the order of the table.
const LETTERS: [char; 6] = ['~', '.', '"', 'T', '^', '*'];

fn main() {
    print!("{}", map(60, 22));
    println!("~ water   . sand   \" grass   T forest   ^ rock   * snow");
}

/// The island, row by row.
fn map(width: u32, height: u32) -> String {
    let mut text = String::new();
    for row in 0..height {
        for column in 0..width {
            let (x, y) = (at(column, width), at(row, height));
            let cover = terrain::terrain(elevation(x, y), rain(x), slope(x, y), river(x, y));
            text.push(LETTERS.get(cover as usize).copied().unwrap_or('?'));
        }
        text.push('\n');
    }
    text
}

/// From -1 to 1 across the map, at the middle of a letter.
fn at(index: u32, count: u32) -> f32 {
    (2 * index + 1) as f32 / count as f32 - 1.0
}

/// A mountain in the west, a hill in the east, the sea around.
fn elevation(x: f32, y: f32) -> f32 {
    let hill = |cx: f32, cy: f32, r: f32| (1.0 - ((x - cx) * (x - cx) + (y - cy) * (y - cy)) / (r * r)).max(0.0);
    let mountain = hill(-0.3, -0.1, 0.65);
    (mountain * mountain + 0.4 * hill(0.35, 0.15, 0.6) - 0.03).min(1.0)
}

fn slope(x: f32, y: f32) -> f32 {
    let d = 1.0 / 64.0;
    let (dx, dy) = (elevation(x + d, y) - elevation(x - d, y), elevation(x, y + d) - elevation(x, y - d));
    ((dx * dx + dy * dy).sqrt() / (2.0 * d)).min(4.0)
}

/// The wind comes from the west and has rained itself out in the east.
fn rain(x: f32) -> f32 {
    (0.6 - 0.6 * x).clamp(0.0, 1.0)
}

/// From the mountain to the south.
fn river(x: f32, y: f32) -> bool {
    y > 0.0 && (x + 0.25 - 0.125 * y).abs() < 0.02
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cover_occurs() {
        let map = map(60, 22);
        for letter in LETTERS {
            assert!(map.contains(letter), "{letter} is missing:\n{map}");
        }
        assert!(!map.contains('?'));
    }

    #[test]
    fn the_map_is_this_one() {
        let expected = include_str!("map.txt");
        assert_eq!(map(60, 22), expected);
    }

    #[test]
    fn the_shader_comes_from_the_same_table() {
        let wgsl = include_str!(concat!(env!("OUT_DIR"), "/terrain/ordered.wgsl"));
        assert!(wgsl.contains("fn terrain("));
    }
}
