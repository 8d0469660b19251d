//! Directions in a word: places on an octahedron that is opened out, of 16 bits each.

/// The largest number of 16 bits.
const MOST: f32 = 65535.0;

/// The word of a direction, of any length; of none the direction away from the viewer.
pub fn packed([x, y, z]: [f32; 3]) -> u32 {
    let sum = x.abs() + y.abs() + z.abs();
    let at = if sum > 0.0 { [x / sum, y / sum] } else { [0.0; 2] };
    let [x, y] = if z < 0.0 { folded(at) } else { at };
    let word = |at: f32| ((at * 0.5 + 0.5).clamp(0.0, 1.0) * MOST + 0.5) as u32;
    word(x) | word(y) << 16
}

/// The direction of a word, of length 1.
pub fn direction(word: u32) -> [f32; 3] {
    let at = [word & 0xffff, word >> 16].map(|part| part as f32 / MOST * 2.0 - 1.0);
    let z = 1.0 - at[0].abs() - at[1].abs();
    let [x, y] = if z < 0.0 { folded(at) } else { at };
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|part| part / length)
}

/// The place of the other half of the octahedron.
fn folded([x, y]: [f32; 2]) -> [f32; 2] {
    let sign = |at: f32| if at >= 0.0 { 1.0 } else { -1.0 };
    [(1.0 - y.abs()) * sign(x), (1.0 - x.abs()) * sign(y)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_come_back() {
        for x in -8..=8 {
            for y in -8..=8 {
                for z in -8..=8 {
                    let raw = [x, y, z].map(|part| part as f32);
                    let length = raw.iter().map(|part| part * part).sum::<f32>().sqrt();
                    if length > 0.0 {
                        let back = direction(packed(raw));
                        let apart = raw.iter().zip(back).map(|(a, b)| (a / length - b).abs()).fold(0.0, f32::max);
                        // Half a step of both places, twice in z, of a direction that is 1 over the root of 3 long.
                        assert!(apart < 18.0_f32.sqrt() / MOST, "{raw:?} {back:?}");
                    }
                }
            }
        }
        assert_eq!(direction(packed([0.0; 3]))[2], 1.0);
    }
}
